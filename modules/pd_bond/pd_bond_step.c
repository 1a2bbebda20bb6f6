/* One time step: velocity Verlet or low-storage RK3 (ERRATA 5), with the energy book.
 *
 * State between steps: u, v; a = L/rho, extra = (C + D)/rho at u; external force f. Verlet:
 *   v += dt/2 (a + extra + f), u += dt v, evaluate, v += dt/2 (a + extra + f), break bonds;
 * damping thus is that of the half-step velocity. RK3 evaluates after every stage; the last one
 * serves the next step. Bonds are checked at the end of the step: what breaks held during all of
 * it and is gone from the force the next step starts with. */
#include "pd_bond_internal.h"

#include <math.h>
#include <string.h>

/* Prescribed particles have their velocity; the book takes the energy of the jump. */
void bw_pd_bond__impose(bw_pd_bond *pd)
{
  double change = 0;
  for (size_t q = 0; q < pd->n_prescribed; q++)
    for (int k = 0; k < 3; k++) {
      bw_real *v = &pd->v[k][pd->prescribed[q]];
      const double before = (double)*v;
      *v = (bw_real)pd->prescribed_v[3 * q + (size_t)k];
      change += (double)*v * (double)*v - before * before;
    }
  pd->done_external += 0.5 * pd->config.rho * pd->dv * change;
}

/* Forces at the present u (and v for damping). Collective. */
bw_status bw_pd_bond__evaluate(bw_pd_bond *pd, bool check)
{
  const bool damped = bw_pd_bond__damped(pd);
  const bool fused = damped && pd->damping_mean == 0;
  bw_pd_bond__refresh(pd, damped);
  bw_pd_bond__force(pd, check, fused);
  if (fused)
    bw_pd_bond__damping_absolute(pd);
  else if (damped)
    bw_pd_bond__damping(pd, 0, NULL);
  if (pd->config.contact || damped || pd->loaded)
    for (int k = 0; k < pd->dimension; k++)
      memset(pd->extra[k], 0, pd->n * sizeof(bw_real));
  pd->loaded = pd->config.contact || damped;
  if (pd->config.contact) {
    BW_TRY(bw_pd_bond__contact_update(pd));
    bw_pd_bond__contact_force(pd);
  }
  for (int k = 0; damped && k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++)
      pd->extra[k][i] += pd->damp[k][i];
  bw_pd_bond__still_retired(pd);
  pd->current = true;
  return BW_OK;
}

/* Break bonds and renew the damping of the blocks that lost some. */
static void break_bonds(bw_pd_bond *pd)
{
  if (!bw_pd_bond__break_hits(pd) || !bw_pd_bond__damped(pd)) return;
  for (int side = 0; side < 2; side++) {
    const bw_real sign = side == 0 ? -1 : 1;
    if (side == 1) bw_pd_bond__damping(pd, pd->n_hit, pd->hit);
    for (size_t q = 0; q < pd->n_hit; q++) {
      const bw_pd_block *block = &pd->block[pd->hit[q]];
      const int32_t end = block->own + __builtin_popcount(block->mask);
      for (int k = 0; k < pd->dimension; k++)
        for (int32_t i = block->own; i < end; i++)
          pd->extra[k][i] += sign * pd->damp[k][i];
    }
  }
  bw_pd_bond__still_retired(pd);
}

/* The walls' share of the momentum, with the integrator's weight h. */
static void push_walls(bw_pd_bond *pd, double h, const double force[3])
{
  for (int k = 0; k < 3; k++)
    pd->done_wall[k] += h * force[k];
}

/* The prescribed particles' share of the book over a time dt with the present forces. */
static void prescribed_work(bw_pd_bond *pd, double dt)
{
  double power = 0;
  for (size_t q = 0; q < pd->n_prescribed; q++) {
    const size_t i = (size_t)pd->prescribed[q];
    for (int k = 0; k < pd->dimension; k++)
      power -= (double)(pd->a[k][i] + pd->extra[k][i]) * (double)pd->v[k][i];
  }
  pd->done_external += dt * pd->config.rho * pd->dv * power;
}

/* v += h (a + extra + f) for the free ones; adds to work[]: external, damping. Without contact and
 * damping (`loaded`) extra is not read. */
static inline __attribute__((always_inline)) void kick_all(bw_pd_bond *pd, bw_real h, bool loaded,
                                                           double work[2])
{
  const bw_real *mobile = pd->mobile;
  double external = 0, damping = 0;
  for (int k = 0; k < pd->dimension; k++) {
    bw_real *restrict v = pd->v[k];
    const bw_real *a = pd->a[k], *extra = pd->extra[k], *f = pd->f[k], *damp = pd->damp[k];
#pragma omp simd reduction(+ : external, damping)
    for (size_t i = 0; i < pd->n; i++) {
      const bw_real before = v[i], internal = loaded ? a[i] + extra[i] : a[i];
      v[i] = before + mobile[i] * (h * (internal + f[i]));
      external += (double)(mobile[i] * f[i] * (before + v[i]));
      if (loaded) damping -= (double)(damp[i] * (before + v[i]));
    }
  }
  work[0] = external;
  work[1] = damping;
}

/* The work of a force in a kick is its product with the mean of the velocities before and after:
 * the kinetic energy changes by exactly their sum. */
static void kick(bw_pd_bond *pd, double h)
{
  double work[2];
  if (pd->loaded)
    kick_all(pd, (bw_real)h, true, work);
  else
    kick_all(pd, (bw_real)h, false, work);
  const double scale = 0.5 * h * pd->config.rho * pd->dv;
  pd->done_external += scale * work[0];
  if (bw_pd_bond__damped(pd)) pd->done_damping += scale * work[1];
  if (pd->n_prescribed > 0) prescribed_work(pd, h);
  push_walls(pd, h, pd->wall_force);
}

/* u += dt (alpha v + beta v_before); returns whether every move is finite and within a horizon.
 * before = NULL: no second term. */
static bool drift(bw_pd_bond *pd, double alpha, double beta, bw_real *const before[3])
{
  const bw_real limit2 = (bw_real)(pd->horizon * pd->horizon);
  const int dimension = pd->dimension;
  int bad = 0;
  for (size_t r = 0; r < pd->n_run; r++) {
    const bw_pd_run run = pd->run[r];
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
      bad += !(dx * dx + dy * dy + dz * dz <= limit2);
    }
  }
  return bad == 0;
}

/* The first particle that left; called only when there is one. */
static bw_status diverged(const bw_pd_bond *pd, double dt)
{
  for (size_t i = 0; i < pd->n; i++) {
    double v2 = 0, X0[3];
    for (int k = 0; k < 3; k++)
      v2 += (double)pd->v[k][i] * (double)pd->v[k][i];
    if (sqrt(v2) * dt <= 0.5 * pd->horizon) continue;
    bw_pd_bond__reference(pd, i, X0);
    return BW_FAIL(BW_EDIVERGED,
                   "pd_bond_step: particle %lld (at first at %g, %g, %g) moves at %g, more than a "
                   "horizon %g in dt = %g; the force on it or dt is too large",
                   (long long)pd->id[i], X0[0], X0[1], X0[2], sqrt(v2), pd->horizon, dt);
  }
  return BW_FAIL(BW_EDIVERGED, "pd_bond_step: a particle moved more than a horizon %g in dt = %g",
                 pd->horizon, dt);
}

static bw_status step_verlet(bw_pd_bond *pd, double dt)
{
  kick(pd, 0.5 * dt);
  const bw_status moved = drift(pd, dt, 0, pd->v) ? BW_OK : diverged(pd, dt);
  const bw_status st = bw_pd_bond__evaluate(pd, true);
  kick(pd, 0.5 * dt);
  return moved != BW_OK ? moved : st;
}

/* Rates of the book: work of external forces and of damping. */
static void power(const bw_pd_bond *pd, double rate[2])
{
  const bool damped = bw_pd_bond__damped(pd);
  double external = 0, damping = 0;
  for (int k = 0; k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++) {
      external += (double)(pd->mobile[i] * pd->f[k][i] * pd->v[k][i]);
      damping -= (double)(pd->damp[k][i] * pd->v[k][i]);
    }
  for (size_t q = 0; q < pd->n_prescribed; q++)
    for (int k = 0; k < pd->dimension; k++) {
      const size_t i = (size_t)pd->prescribed[q];
      external -= (double)(pd->a[k][i] + pd->extra[k][i]) * (double)pd->v[k][i];
    }
  rate[0] = external * pd->config.rho * pd->dv;
  rate[1] = damped ? damping * pd->config.rho * pd->dv : 0;
}

static void stage_velocity(bw_pd_bond *pd, double alpha, double beta)
{
  const bw_real al = (bw_real)alpha, be = (bw_real)beta;
  for (int k = 0; k < pd->dimension; k++) {
    bw_real *restrict v = pd->v[k], *restrict vb = pd->v_before[k], *restrict ab = pd->a_before[k];
    const bw_real *a = pd->a[k], *extra = pd->extra[k], *f = pd->f[k], *mobile = pd->mobile;
#pragma omp simd
    for (size_t i = 0; i < pd->n; i++) {
      const bw_real now = mobile[i] * (a[i] + extra[i] + f[i]);
      vb[i] = v[i];
      v[i] += al * now + be * ab[i];
      ab[i] = now;
    }
  }
}

static bw_status step_rk3(bw_pd_bond *pd, double dt)
{
  static const double alpha[] = {8.0 / 15, 5.0 / 12, 3.0 / 4}, beta[] = {0, -17.0 / 60, -5.0 / 12};
  double before[2] = {0}, rate[2], wall_before[3] = {0};
  bw_status st = BW_OK;
  for (int r = 0; r < 3; r++) {
    power(pd, rate);
    pd->done_external += dt * (alpha[r] * rate[0] + beta[r] * before[0]);
    pd->done_damping += dt * (alpha[r] * rate[1] + beta[r] * before[1]);
    before[0] = rate[0], before[1] = rate[1];
    push_walls(pd, dt * alpha[r], pd->wall_force);
    push_walls(pd, dt * beta[r], wall_before);
    memcpy(wall_before, pd->wall_force, sizeof wall_before);
    const bool fine = drift(pd, dt * alpha[r], dt * beta[r], pd->v_before);
    if (!fine && st == BW_OK) st = diverged(pd, dt);
    stage_velocity(pd, dt * alpha[r], dt * beta[r]);
    const bw_status seen = bw_pd_bond__evaluate(pd, r == 2);
    st = st == BW_OK ? seen : st;
  }
  return st;
}

bw_status bw_pd_bond_step(bw_pd_bond *pd, double dt)
{
  const double limit = bw_pd_bond_dt_max(pd);
  BW_REQUIRE(dt > 0 && dt <= limit * (1 + 1e-12), BW_ECFL,
             "pd_bond_step: dt = %g must be positive and at most %g; take smaller sub-steps", dt,
             limit);
  bw_pd_bond__impose(pd);
  bw_status st = pd->current ? BW_OK : bw_pd_bond__evaluate(pd, false);
  if (st == BW_OK) st = pd->config.integrator == BW_PD_RK3 ? step_rk3(pd, dt) : step_verlet(pd, dt);
  if (st == BW_OK) break_bonds(pd);
  pd->restored = false;
  return bw_comm_agree(pd->comm, st);
}
