/* What a crack would release that is not there.
 *
 * With K of the bonds that hold, K_c without those that cross the crack, and u at rest, K u = F on
 * free rows, the new rest is u + d with K_c d = (K - K_c) u = g. The potential energy falls by
 *   u.(K - K_c) u/2 + g.d/2 = g.(u + d)/2.
 * g is zero but for particles whose families the crack meets, so that the sum belongs to it, and
 * forces, also of a body that is not quite at rest, do not come in. Cracks that are many horizons
 * apart have sums of their own in one solve. */
#include "bw_memory.h"
#include "bw_pd_material_criterion.h"
#include "bw_solid_failure.h"
#include "bw_solid_stress.h"
#include "pd_law.h"
#include "pd_walk.h"

#include <math.h>
#include <string.h>

enum { GAUGES = BW_SOLID_FAILURE_GAUGES, MOST = 2000 }; /* products of one solve, at most */
static const double RESIDUAL = 0.02; /* of g: the energy is right to its square */
/* What touches the crack's plane or edge is cut, within what a principal direction is known to: of
 * the flaw, well above rounding in the stress and well below a spacing. */
static const double TOUCH = 4e6 * BW_REAL_EPSILON < 1e-3 ? 4e6 * BW_REAL_EPSILON : 1e-3;

/* A crack to be tried. */
typedef struct {
  int64_t id;
  double X0[3], axis[3][3]; /* middle; normal and two directions along it */
  double tension, released; /* largest principal stress; G */
  bool done;                /* tried */
} crack;

typedef struct {
  bw_pd_body *pd;
  double flaw, apart;             /* length; least distance of two cracks of one solve [L] */
  size_t n, first;                /* cracks of all ranks; where this rank's begin */
  size_t own, *at;                /* this rank's; (own) their particles */
  crack *crack;                   /* (n) the same on all ranks */
  size_t n_now, *now;             /* (n_now) cracks of the present solve */
  int32_t *near;                  /* (n of particles) the one that is near */
  uint8_t *mask;                  /* (n_slot) of the bonds that hold */
  bool *broken;                   /* (n_block) */
  double *mass;                   /* (n) preconditioner */
  double *u, *g, *d, *r, *p, *kp; /* (n,3) */
  double *X0;                     /* (n,3) */
} trial;

static double dot3(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* out = K x with the bonds that hold now. Collective. */
static void product(trial *t, const double x[], double out[])
{
  bw_pd_body *pd = t->pd;
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < pd->n; i++)
      pd->vs[k][pd->points.place[i]] = (bw_real)x[3 * i + (size_t)k];
    bw_pd_body_fill_places(pd, pd->vs[k]);
  }
  pd->law->tangent(pd, pd->vs, out);
}

/* Whether the line from p to q goes through the crack. */
static bool meets(const trial *t, const crack *c, const double p[3], const double q[3])
{
  double a[3], b[3], x[3];
  for (int k = 0; k < 3; k++)
    a[k] = p[k] - c->X0[k], b[k] = q[k] - c->X0[k];
  const double da = dot3(c->axis[0], a), db = dot3(c->axis[0], b);
  /* What lies on the crack counts as above it. */
  const double touch = -TOUCH * t->flaw;
  if ((da > touch) == (db > touch)) return false;
  for (int k = 0; k < 3; k++)
    x[k] = a[k] + da / (da - db) * (b[k] - a[k]);
  const double half = 0.5 * t->flaw * (1 + TOUCH);
  return fabs(dot3(c->axis[1], x)) <= half &&
         (t->pd->dimension == 2 || fabs(dot3(c->axis[2], x)) <= half);
}

/* Which crack of this solve is within `apart`/2 of each particle, -1: none. */
static void find_near(trial *t)
{
  for (size_t i = 0; i < t->pd->n; i++) {
    t->near[i] = -1;
    for (size_t q = 0; q < t->n_now && t->near[i] < 0; q++) {
      double r2 = 0;
      for (size_t k = 0; k < (size_t)t->pd->dimension; k++)
        r2 += pow(t->X0[3 * i + k] - t->crack[t->now[q]].X0[k], 2);
      if (r2 < 0.25 * t->apart * t->apart) t->near[i] = (int32_t)t->now[q];
    }
  }
}

/* Bonds that meet a crack of this solve are taken away, without a book. */
static void cut(trial *t)
{
  bw_pd_body *pd = t->pd;
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    bw_pd_block *block = &pd->bonds.block[q];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);) {
      const size_t i = bw_pd_walk_owner(&b);
      double y[3];
      if (t->near[i] < 0) continue;
      for (size_t k = 0; k < 3; k++)
        y[k] = t->X0[3 * i + k] + b.rest.xi[k];
      /* From the end that is first in lattice order, so that both decide alike. */
      const bool forward =
          bw_pd_body_is_first(&bw_pd_body_level_of(pd, block)->stencil, b.slot->direction);
      const crack *c = &t->crack[t->near[i]];
      if (!meets(t, c, forward ? &t->X0[3 * i] : y, forward ? y : &t->X0[3 * i])) continue;
      b.slot->mask = (uint8_t)(b.slot->mask & ~(1u << b.lane));
      block->broken = true;
    }
  }
  pd->bonds.events++; /* laws that keep sums of families look at them again */
}

static void mend(trial *t)
{
  bw_pd_body *pd = t->pd;
  for (size_t q = 0; q < pd->bonds.n_slot; q++)
    pd->bonds.slot[q].mask = t->mask[q];
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    pd->bonds.block[q].broken = t->broken[q];
  pd->bonds.events--;
}

static double sum_of(const trial *t, const double a[], const double b[])
{
  double sum = 0;
  for (size_t x = 0; x < 3 * t->pd->n; x++)
    sum += a[x] * b[x];
  bw_comm_sum(t->pd->comm, 1, &sum);
  return sum;
}

/* r.r/mass of the free rows. Collective. */
static double weighted(const trial *t)
{
  double sum = 0;
  for (size_t i = 0; i < t->pd->n; i++)
    for (size_t k = 0; k < (size_t)t->pd->dimension; k++)
      sum += (double)t->pd->held.mobile[i] * t->r[3 * i + k] * t->r[3 * i + k] / t->mass[i];
  bw_comm_sum(t->pd->comm, 1, &sum);
  return sum;
}

/* p = r/mass + keep p on free rows. */
static void turn(trial *t, double keep)
{
  for (size_t i = 0; i < t->pd->n; i++)
    for (size_t k = 0; k < (size_t)t->pd->dimension; k++)
      t->p[3 * i + k] =
          (double)t->pd->held.mobile[i] * t->r[3 * i + k] / t->mass[i] + keep * t->p[3 * i + k];
}

/* K_c d = g by conjugate gradients from d = 0. Collective. */
static bw_status relax(trial *t)
{
  const size_t n3 = 3 * t->pd->n;
  memset(t->d, 0, n3 * sizeof *t->d);
  memset(t->p, 0, n3 * sizeof *t->p);
  memcpy(t->r, t->g, n3 * sizeof *t->r);
  double now = weighted(t), before = now;
  const double enough = RESIDUAL * RESIDUAL * now;
  for (int q = 0; q < MOST && now > enough; q++) {
    turn(t, q > 0 ? now / before : 0);
    product(t, t->p, t->kp);
    const double step = now / sum_of(t, t->p, t->kp);
    for (size_t x = 0; x < n3; x++) {
      t->d[x] += step * t->p[x];
      t->r[x] -= step * t->kp[x];
    }
    before = now;
    now = weighted(t);
    BW_REQUIRE(isfinite(now), BW_EDIVERGED,
               "solid_failure: a crack's relaxation is not finite; is the body held?");
  }
  return BW_OK;
}

/* The next set of cracks that do not feel each other; returns whether there is one. */
static bool choose(trial *t)
{
  t->n_now = 0;
  for (size_t q = 0; q < t->n; q++) {
    bool alone = !t->crack[q].done;
    for (size_t j = 0; j < t->n_now && alone; j++) {
      double r2 = 0;
      for (int k = 0; k < t->pd->dimension; k++)
        r2 += pow(t->crack[t->now[j]].X0[k] - t->crack[q].X0[k], 2);
      alone = r2 >= t->apart * t->apart;
    }
    if (!alone) continue;
    t->crack[q].done = true;
    t->now[t->n_now++] = q;
  }
  find_near(t);
  return t->n_now > 0;
}

/* One solve of several cracks. Collective. */
static bw_status release(trial *t)
{
  bw_pd_body *pd = t->pd;
  const double area = pd->dimension == 2 ? t->flaw * pd->config.thickness : t->flaw * t->flaw;
  product(t, t->u, t->g);
  cut(t);
  product(t, t->u, t->kp);
  for (size_t x = 0; x < 3 * pd->n; x++)
    t->g[x] -= t->kp[x];
  const bw_status st = relax(t);
  mend(t);
  BW_TRY(st);
  for (size_t i = 0; i < pd->n; i++) {
    if (t->near[i] < 0) continue;
    crack *c = &t->crack[t->near[i]];
    const double dv = bw_pd_body_level(pd, i)->dv;
    for (size_t k = 0; k < 3; k++)
      c->released += 0.5 * dv * t->g[3 * i + k] * (t->u[3 * i + k] + t->d[3 * i + k]) / area;
  }
  return BW_OK;
}

/* Cracks at the particles that are pulled, of all ranks. Collective. */
static bw_status collect(bw_solid *s, trial *t, double part)
{
  bw_pd_body *pd = t->pd;
  double *stress = NULL, most = 0;
  crack *mine = NULL;
  size_t bytes = 0;
  bw_status st = BW_ALLOCATE(&stress, 6 * pd->n);
  BW_THEN(st, BW_ALLOCATE(&mine, pd->n));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) bw_solid_stress_compute(s, NULL, stress);
  for (size_t i = 0; st == BW_OK && i < pd->n; i++) {
    double value[3];
    crack *c = &mine[i];
    bw_pd_material_principal_stress(stress + 6 * i, value, c->axis);
    c->id = pd->points.id[i], c->tension = value[0];
    /* Of the two normals the one whose largest component is positive. */
    int top = 0;
    for (int k = 1; k < 3; k++)
      if (fabs(c->axis[0][k]) > fabs(c->axis[0][top]) * (1 + 1e-9)) top = k;
    const double sign = c->axis[0][top] < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++)
      c->axis[0][k] *= sign;
    bw_pd_body_reference(pd, i, c->X0);
    most = fmax(most, value[0]);
    /* In the plane the crack's direction is in it: the normal turned by a right angle. */
    if (pd->dimension == 3) continue;
    c->axis[1][0] = -c->axis[0][1], c->axis[1][1] = c->axis[0][0], c->axis[1][2] = 0;
  }
  bw_comm_max(pd->comm, 1, &most);
  for (size_t i = 0; st == BW_OK && i < pd->n; i++) {
    /* A plate that is pulled out of its plane does not crack along it. */
    const bool across = pd->dimension == 2 && fabs(mine[i].axis[0][2]) > 0.5;
    if (!(mine[i].tension > 0 && mine[i].tension >= part * most) || across) continue;
    t->at[t->own] = i;
    mine[t->own++] = mine[i];
  }
  t->first = (size_t)bw_comm_prefix_sum(pd->comm, (int64_t)t->own);
  BW_THEN(st, bw_comm_allgather(pd->comm, t->own * sizeof *mine, mine, &bytes, (void **)&t->crack));
  t->n = bytes / sizeof *t->crack;
  BW_THEN(st, bw_comm_agree(pd->comm, BW_ALLOCATE(&t->now, t->n)));
  bw_release(&stress);
  bw_release(&mine);
  return st;
}

static bw_status begin(bw_solid *s, trial *t)
{
  bw_pd_body *pd = t->pd;
  double **rows[] = {&t->u, &t->g, &t->d, &t->r, &t->p, &t->kp, &t->X0};
  bw_status st = BW_ALLOCATE(&t->mask, pd->bonds.n_slot);
  BW_THEN(st, BW_ALLOCATE(&t->broken, pd->bonds.n_block));
  BW_THEN(st, BW_ALLOCATE(&t->mass, pd->n));
  BW_THEN(st, BW_ALLOCATE(&t->at, pd->n));
  BW_THEN(st, BW_ALLOCATE(&t->near, pd->n));
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    BW_THEN(st, BW_ALLOCATE(rows[q], 3 * pd->n));
  BW_TRY(bw_comm_agree(pd->comm, st));
  for (size_t q = 0; q < pd->bonds.n_slot; q++)
    t->mask[q] = pd->bonds.slot[q].mask;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    t->broken[q] = pd->bonds.block[q].broken;
  bw_solid_get_reference(s, t->X0);
  bw_solid_get_position(s, t->u);
  for (size_t x = 0; x < 3 * pd->n; x++)
    t->u[x] -= t->X0[x];
  pd->law->rows(pd, t->mass);
  return BW_OK;
}

static void end(trial *t)
{
  double **rows[] = {&t->u, &t->g, &t->d, &t->r, &t->p, &t->kp, &t->X0, &t->mass};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_release(rows[q]);
  bw_release(&t->mask);
  bw_release(&t->broken);
  bw_release(&t->at);
  bw_release(&t->now);
  bw_release(&t->near);
  bw_release(&t->crack);
  t->pd->current = false; /* the velocity's copies were used */
}

/* Each rank has summed over its own particles: a crack may have some on several. Collective. */
static bw_status hand_over(const trial *t, double G0, double used[])
{
  double *sum = NULL;
  BW_TRY(bw_comm_agree(t->pd->comm, BW_ALLOCATE(&sum, t->n)));
  for (size_t q = 0; q < t->n; q++)
    sum[q] = t->crack[q].released;
  bw_comm_sum(t->pd->comm, t->n, sum);
  for (size_t i = 0; i < t->pd->n; i++)
    used[GAUGES * i + BW_SOLID_FAILURE_GRIFFITH] = 0;
  for (size_t q = 0; q < t->own; q++)
    used[GAUGES * t->at[q] + BW_SOLID_FAILURE_GRIFFITH] = sqrt(fmax(0, sum[t->first + q]) / G0);
  bw_release(&sum);
  return BW_OK;
}

bw_status bw_solid_failure_griffith(bw_solid *s, const bw_solid_strength *k, double part,
                                    double used[])
{
  bw_pd_body *pd = bw_solid_body(s);
  BW_REQUIRE(k->G0 > 0 && k->flaw > 0 && part >= 0 && part <= 1, BW_EINPUT,
             "solid_failure: G0 = %g and flaw = %g must be positive, part = %g from 0 to 1", k->G0,
             k->flaw, part);
  /* A crack is felt by the families of the families it meets; what relaxes reaches further. */
  trial t = {.pd = pd, .flaw = k->flaw, .apart = k->flaw + 8 * pd->level[0].reach};
  if (!pd->current) bw_pd_body_refresh(pd, false);
  bw_status st = begin(s, &t);
  BW_THEN(st, collect(s, &t, part));
  while (st == BW_OK && choose(&t))
    st = release(&t);
  BW_THEN(st, hand_over(&t, k->G0, used));
  end(&t);
  return st;
}
