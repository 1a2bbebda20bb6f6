/* One time step: velocity Verlet or low-storage RK3 (ERRATA 5), with the energy book.
 *
 * State between steps: u, v; a = L/rho, extra = (C + D)/rho at u; external force f. Verlet:
 *   v += dt/2 (a + extra + f), u += dt v, evaluate, v += dt/2 (a + extra + f), break bonds;
 * damping thus is that of the half-step velocity. RK3 evaluates after every stage; the last one
 * serves the next step. Bonds are checked at the end of the step: what breaks held during all of
 * it and is gone from the force the next step starts with. */
#include "solid_internal.h"

#include <math.h>
#include <string.h>

/* Mass of an own particle over that of the first group's on level 0. */
static double weight_of(const bw_pd_body *pd, size_t i)
{
  return pd->points.weight == NULL ? 1 : (double)pd->points.weight[i];
}

/* Prescribed particles have their velocity; the book takes the energy of the jump. */
static void impose(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  double change = 0;
  for (size_t q = 0; q < pd->held.n; q++)
    for (int k = 0; k < 3; k++) {
      const size_t i = (size_t)pd->held.particle[q];
      /* A jump of velocity is work of whoever prescribes it. */
      bw_real *v = &pd->v[k][i];
      const double before = (double)*v;
      *v = (bw_real)pd->held.velocity[3 * q + (size_t)k];
      change += weight_of(pd, i) * ((double)*v * (double)*v - before * before);
    }
  s->book.external += 0.5 * bw_pd_body_unit_mass(pd) * change;
}

/* load.damp by all kinds of damping, in the law's sweep where it can. */
static void internal_forces(bw_pd_body *pd, bool check)
{
  const bool damped = bw_pd_body_damped(pd);
  const bool fused = damped && pd->damping.mean == 0 && pd->law->damps;
  /* Copies are told where all are now; velocities only where damping reads them. */
  bw_pd_body_refresh(pd, damped);
  /* a = L/rho of the present motion, and load.damp where the law does it on the way. */
  bw_pd_body_internal_force(pd, check, fused);
  if (fused)
    bw_pd_body_damp_absolute(pd);
  else if (damped)
    bw_pd_body_damp(pd, 0, NULL);
}

static void still_retired(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  /* They are in the kernels' loops still; what came of that is put to zero. */
  for (int k = 0; k < pd->dimension; k++)
    for (size_t q = 0; q < s->n_retired; q++) {
      const int32_t i = s->retired[q];
      pd->a[k][i] = pd->load.extra[k][i] = pd->load.damp[k][i] = 0;
    }
}

/* Its push joins load.extra, which is empty but for contact. */
static bw_status push_outside(bw_solid *s)
{
  if (s->outside.who == NULL) return BW_OK;
  bw_solid_get_position(s, s->outside_X);
  return s->outside.push(s->outside.who, s, s->outside_X);
}

bw_status bw_solid__evaluate(bw_solid *s, bool check)
{
  bw_pd_body *pd = s->body;
  const bool damped = bw_pd_body_damped(pd), outside = s->outside.who != NULL;
  const bool contact = s->contact != NULL;
  s->evaluated++;
  s->restored = false;
  internal_forces(pd, check);
  /* Zeroed once more after the last load went, then left alone. */
  if (contact || damped || outside || s->loaded)
    for (int k = 0; k < pd->dimension; k++)
      memset(pd->load.extra[k], 0, pd->n * sizeof(bw_real));
  s->loaded = contact || damped || outside;
  /* A particle beyond a wall is an error of its rank alone, which goes on to where all agree. */
  bw_status st = contact ? bw_pd_contact_update(s->contact) : BW_OK;
  if (contact && st == BW_OK) bw_pd_contact_force(s->contact);
  /* Collective, and called whatever has happened on this rank. */
  const bw_status pushed = push_outside(s);
  st = st == BW_OK ? pushed : st;
  /* extra = (C + D)/rho is complete; damp alone is kept for the ledger. */
  for (int k = 0; damped && k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++)
      pd->load.extra[k][i] += pd->load.damp[k][i];
  still_retired(s);
  /* From here on the forces are those of u and v. */
  pd->current = true;
  return st;
}

/* Break bonds and renew the damping of the blocks that lost some. */
static void break_bonds(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  const bool broke = bw_pd_body_break_hits(pd);
  /* A law of several passes has evaluated all forces anew, also on who is retired. */
  if (pd->law->n_sweep > 1) still_retired(s);
  if (!broke || !bw_pd_body_damped(pd)) return;
  /* The old damping of these blocks goes out of extra, the new one into it. */
  for (int side = 0; side < 2; side++) {
    const bw_real sign = side == 0 ? -1 : 1;
    if (side == 1) bw_pd_body_damp(pd, pd->bonds.n_hit, pd->bonds.hit);
    for (size_t q = 0; q < pd->bonds.n_hit; q++) {
      const bw_pd_block *block = &pd->bonds.block[pd->bonds.hit[q]];
      const int32_t end = block->own + __builtin_popcount(block->mask);
      for (int k = 0; k < pd->dimension; k++)
        for (int32_t i = block->own; i < end; i++)
          pd->load.extra[k][i] += sign * pd->load.damp[k][i];
    }
  }
  still_retired(s);
}

/* The walls' share of the momentum, with the integrator's weight h. */
static void push_walls(bw_solid *s, double h, const double force[3])
{
  for (int k = 0; k < 3; k++)
    s->book.wall[k] += h * force[k];
}

static void wall_force(bw_solid *s, double force[3])
{
  memset(force, 0, 3 * sizeof *force);
  if (s->contact != NULL) memcpy(force, bw_pd_contact_wall_force(s->contact), 3 * sizeof *force);
}

/* The prescribed particles' share of the book over a time dt with the present forces. */
static void prescribed_work(bw_solid *s, double dt)
{
  const bw_pd_body *pd = s->body;
  /* Whoever holds a particle bears the forces on it: their power has the other sign. */
  double power = 0;
  for (size_t q = 0; q < pd->held.n; q++) {
    const size_t i = (size_t)pd->held.particle[q];
    const double weight = weight_of(pd, i);
    for (int k = 0; k < pd->dimension; k++)
      power -= weight * (double)(pd->a[k][i] + pd->load.extra[k][i]) * (double)pd->v[k][i];
  }
  s->book.external += dt * bw_pd_body_unit_mass(pd) * power;
}

/* v += h (a + extra + f) for the free ones; adds to work[]: external, damping, by the mass of the
 * first group. Without contact and damping (`loaded`) extra is not read; nor weight with one
 * group. */
static inline __attribute__((always_inline)) void kick_all(bw_pd_body *pd, bw_real h, bool loaded,
                                                           bool one_group, double work[2])
{
  const bw_real *mobile = pd->held.mobile, *weight = pd->points.weight;
  double external = 0, damping = 0;
  /* One pass moves and books; sums are in double whatever the precision of the motion. */
  for (int k = 0; k < pd->dimension; k++) {
    bw_real *restrict v = pd->v[k];
    const bw_real *a = pd->a[k], *extra = pd->load.extra[k], *f = pd->load.f[k];
    const bw_real *damp = pd->load.damp[k];
#pragma omp simd reduction(+ : external, damping)
    for (size_t i = 0; i < pd->n; i++) {
      const bw_real before = v[i], internal = loaded ? a[i] + extra[i] : a[i];
      const bw_real heavy = one_group ? 1 : weight[i];
      v[i] = before + mobile[i] * (h * (internal + f[i]));
      external += (double)(heavy * (mobile[i] * f[i] * (before + v[i])));
      if (loaded) damping -= (double)(heavy * (damp[i] * (before + v[i])));
    }
  }
  work[0] = external;
  work[1] = damping;
}

/* The work of a force in a kick is its product with the mean of the velocities before and after:
 * the kinetic energy changes by exactly their sum. */
static void kick(bw_solid *s, double h)
{
  bw_pd_body *pd = s->body;
  /* Three loops from one source: arrays that hold nothing are not read. */
  double work[2], on_walls[3];
  if (pd->points.weight != NULL)
    kick_all(pd, (bw_real)h, true, false, work);
  else if (s->loaded)
    kick_all(pd, (bw_real)h, true, true, work);
  else
    kick_all(pd, (bw_real)h, false, true, work);
  /* (before + v) h/2: the mean velocity is in the sum, h and a half are here. */
  const double scale = 0.5 * h * bw_pd_body_unit_mass(pd);
  s->book.external += scale * work[0];
  if (bw_pd_body_damped(pd)) s->book.damping += scale * work[1];
  if (pd->held.n > 0) prescribed_work(s, h);
  wall_force(s, on_walls);
  push_walls(s, h, on_walls);
}

/* u += dt (alpha v + beta v_before); returns whether every move is finite and within a horizon.
 * before = NULL: no second term. */
static bool drift(bw_pd_body *pd, double alpha, double beta, bw_real *const before[3])
{
  const double horizon = pd->level[pd->finest].horizon;
  const bw_real limit2 = (bw_real)(horizon * horizon);
  const int dimension = pd->dimension;
  int bad = 0;
  for (size_t r = 0; r < pd->bonds.n_run; r++) {
    /* A run is contiguous in storage and among own particles: the loop has no indirection. */
    const bw_pd_run run = pd->bonds.run[r];
    bw_real *restrict ux = pd->u[0] + run.place, *restrict uy = pd->u[1] + run.place;
    bw_real *restrict uz = pd->u[2] + run.place;
    const bw_real *vx = pd->v[0] + run.own, *vy = pd->v[1] + run.own, *vz = pd->v[2] + run.own;
    const bw_real *wx = before[0] + run.own, *wy = before[1] + run.own;
    const bw_real *wz = before[2] + run.own;
    const bw_real al = (bw_real)alpha, be = (bw_real)beta;
#pragma omp simd reduction(+ : bad)
    for (int32_t i = 0; i < run.n; i++) {
      const bw_real dx = al * vx[i] + be * wx[i], dy = al * vy[i] + be * wy[i];
      const bw_real dz = dimension == 3 ? al * vz[i] + be * wz[i] : 0;
      ux[i] += dx;
      uy[i] += dy;
      uz[i] += dz;
      /* NaN fails the comparison, so that it counts as bad. */
      bad += !(dx * dx + dy * dy + dz * dz <= limit2);
    }
  }
  return bad == 0;
}

/* The first particle that left; called only when there is one. */
static bw_status diverged(const bw_pd_body *pd, double dt)
{
  double horizon = 0;
  for (size_t i = 0; i < pd->n; i++) {
    /* The sweep only said that there is one; here it gets its name. */
    horizon = bw_pd_body_level(pd, i)->horizon;
    double v2 = 0, X0[3];
    for (int k = 0; k < 3; k++)
      v2 += (double)pd->v[k][i] * (double)pd->v[k][i];
    if (sqrt(v2) * dt <= 0.5 * horizon) continue;
    bw_pd_body_reference(pd, i, X0);
    return BW_FAIL(BW_EDIVERGED,
                   "solid_step: particle %lld (at first at %g, %g, %g) moves at %g, more than a "
                   "horizon %g in dt = %g; the force on it or dt is too large",
                   (long long)pd->points.id[i], X0[0], X0[1], X0[2], sqrt(v2), horizon, dt);
  }
  return BW_FAIL(BW_EDIVERGED, "solid_step: a particle moved more than a horizon %g in dt = %g",
                 horizon, dt);
}

bw_status bw_solid__leap(bw_solid *s, double dt)
{
  bw_solid__drag_on(s, dt);
  kick(s, 0.5 * dt);
  /* v is at the half step, u still at the beginning. */
  return drift(s->body, dt, 0, s->body->v) ? BW_OK : diverged(s->body, dt);
}

void bw_solid__land(bw_solid *s, double dt)
{
  /* u is at the end, a and extra too; v follows. */
  kick(s, 0.5 * dt);
  bw_solid__drag_off(s, dt);
}

static bw_status step_verlet(bw_solid *s, double dt)
{
  const bw_status moved = bw_solid__leap(s, dt);
  /* Everybody evaluates, also a rank that has diverged: the exchanges are collective. */
  const bw_status seen = bw_solid__evaluate(s, true);
  bw_solid__land(s, dt);
  return moved != BW_OK ? moved : seen;
}

/* Rates of the book: work of external forces and of damping. */
static void power(const bw_pd_body *pd, double rate[2])
{
  /* Work per time of what acts now: the integrator's weights come on it later. */
  const bool damped = bw_pd_body_damped(pd);
  double external = 0, damping = 0;
  for (int k = 0; k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++) {
      const double weight = weight_of(pd, i);
      /* Free particles feel F; damping takes what it takes from all. */
      external += weight * (double)(pd->held.mobile[i] * pd->load.f[k][i] * pd->v[k][i]);
      damping -= weight * (double)(pd->load.damp[k][i] * pd->v[k][i]);
    }
  /* Prescribed ones are worked on by whoever moves them. */
  for (size_t q = 0; q < pd->held.n; q++)
    for (int k = 0; k < pd->dimension; k++) {
      const size_t i = (size_t)pd->held.particle[q];
      external -=
          weight_of(pd, i) * (double)(pd->a[k][i] + pd->load.extra[k][i]) * (double)pd->v[k][i];
    }
  rate[0] = external * bw_pd_body_unit_mass(pd);
  rate[1] = damped ? damping * bw_pd_body_unit_mass(pd) : 0;
}

static void stage_velocity(bw_solid *s, double alpha, double beta)
{
  bw_pd_body *pd = s->body;
  const bw_real al = (bw_real)alpha, be = (bw_real)beta;
  for (int k = 0; k < pd->dimension; k++) {
    bw_real *restrict v = pd->v[k], *restrict vb = s->v_before[k], *restrict ab = s->a_before[k];
    const bw_real *a = pd->a[k], *extra = pd->load.extra[k], *f = pd->load.f[k];
    const bw_real *mobile = pd->held.mobile;
#pragma omp simd
    for (size_t i = 0; i < pd->n; i++) {
      /* v <- v + alpha a + beta a_before; both stages are kept for the next one. */
      const bw_real now = mobile[i] * (a[i] + extra[i] + f[i]);
      vb[i] = v[i];
      v[i] += al * now + be * ab[i];
      ab[i] = now;
    }
  }
}

static bw_status step_rk3(bw_solid *s, double dt)
{
  static const double alpha[] = {8.0 / 15, 5.0 / 12, 3.0 / 4}, beta[] = {0, -17.0 / 60, -5.0 / 12};
  bw_pd_body *pd = s->body;
  double before[2] = {0}, rate[2], wall_now[3], wall_before[3] = {0};
  bw_status st = BW_OK;
  bw_solid__drag_on(s, dt);
  for (int r = 0; r < 3; r++) {
    /* The ledger is integrated with the same weights as the motion (ERRATA 5). */
    power(pd, rate);
    s->book.external += dt * (alpha[r] * rate[0] + beta[r] * before[0]);
    s->book.damping += dt * (alpha[r] * rate[1] + beta[r] * before[1]);
    before[0] = rate[0], before[1] = rate[1];
    wall_force(s, wall_now);
    push_walls(s, dt * alpha[r], wall_now);
    push_walls(s, dt * beta[r], wall_before);
    memcpy(wall_before, wall_now, sizeof wall_before);
    /* Positions take the velocity that the stage began with. */
    const bool fine = drift(pd, dt * alpha[r], dt * beta[r], s->v_before);
    if (!fine && st == BW_OK) st = diverged(pd, dt);
    /* Velocities take the acceleration at the stage's beginning, too; then forces are new. */
    stage_velocity(s, dt * alpha[r], dt * beta[r]);
    const bw_status seen = bw_solid__evaluate(s, r == 2);
    st = st == BW_OK ? seen : st;
  }
  bw_solid__drag_off(s, dt);
  return st;
}

bw_status bw_solid_evaluate(bw_solid *s)
{
  return bw_comm_agree(s->body->comm, bw_solid__evaluate(s, false));
}

bw_status bw_solid__begin(bw_solid *s)
{
  /* Forces are old when a state, walls or damping have been set since the last step. */
  impose(s);
  /* A failure of one rank is one of all before anybody moves. */
  return s->body->current ? BW_OK : bw_solid_evaluate(s);
}

bw_status bw_solid__end(bw_solid *s)
{
  const bw_pd_bonds *bonds = &s->body->bonds;
  /* What was tried in the evaluations of the step counts from now on. */
  if (s->body->law->accept != NULL) s->body->law->accept(s->body);
  break_bonds(s);
  BW_REQUIRE(bonds->astray == 0, BW_EDIVERGED,
             "solid: a bond of particle %lld is beyond its limit outside the finest level; cracks "
             "run on the finest level alone: %s",
             (long long)bonds->astray_id,
             s->levels == NULL ? "make the boxes of `levels` larger"
                               : "the buffer is too thin, make refine.buffer larger or refine.at "
                                 "smaller");
  return BW_OK;
}

bw_status bw_solid_step(bw_solid *s, double dt)
{
  /* The bound counts bonds and damping; contact has its own (bw_solid_dt_contact). */
  const double limit = bw_solid_dt_max(s);
  BW_REQUIRE(dt > 0 && dt <= limit * (1 + 1e-12), BW_ECFL,
             "solid_step: dt = %g must be positive and at most %g; take smaller sub-steps", dt,
             limit);
  BW_TRY(bw_solid__levels_time(s, dt));
  bw_status st = bw_solid__begin(s);
  if (st == BW_OK) st = s->config.integrator == BW_SOLID_RK3 ? step_rk3(s, dt) : step_verlet(s, dt);
  /* Bonds held during the whole step; now those beyond their limit go (3.34). */
  if (st == BW_OK) st = bw_solid__end(s);
  /* Forces are this run's own from now on. */
  s->restored = false;
  return bw_comm_agree(s->body->comm, st);
}
