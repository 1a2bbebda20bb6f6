/* Gauges of failure of a state, and the list of its weakest places. */
#include "bw_memory.h"
#include "bw_pd_material_criterion.h"
#include "bw_solid_failure.h"
#include "bw_solid_stress.h"
#include "pd_law.h"
#include "pd_walk.h"

#include <stdlib.h>

enum { GAUGES = BW_SOLID_FAILURE_GAUGES };

const char *const bw_solid_failure_name[GAUGES] = {
    "rankine", "energy", "mises", "mohr_coulomb", "drucker_prager", "stretch", "griffith"};

bw_solid_strength bw_solid_strength_of(const bw_solid *s)
{
  const double G0 = bw_solid_settings(s)->G0;
  return (bw_solid_strength){.tension = NAN,
                             .yield = NAN,
                             .cohesion = NAN,
                             .friction = NAN,
                             .stretch = bw_solid_critical_stretch(s),
                             .G0 = isfinite(G0) ? G0 : NAN,
                             .flaw = bw_solid_horizon(s)};
}

static bw_status positive(const char *name, double x)
{
  BW_REQUIRE(isnan(x) || x > 0, BW_EINPUT,
             "solid_failure: %s = %g must be positive, or NaN where it is not asked for", name, x);
  return BW_OK;
}

static bw_status check(const bw_solid_strength *k)
{
  BW_TRY(positive("tension", k->tension));
  BW_TRY(positive("yield", k->yield));
  BW_TRY(positive("cohesion", k->cohesion));
  BW_TRY(positive("stretch", k->stretch));
  BW_REQUIRE(isnan(k->friction) || (k->friction >= 0 && k->friction < 1.57), BW_EINPUT,
             "solid_failure: friction = %g must be an angle from 0 to below pi/2", k->friction);
  return BW_OK;
}

/* The largest stretch of a particle's bonds. */
static void stretches(const bw_pd_body *pd, double limit, double used[])
{
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    double most[BW_PD_LANES] = {0}, y[3];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);)
      most[b.lane] = fmax(most[b.lane], bw_pd_walk_present(&b, y) / b.rest.r0 - 1);
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask >> lane & 1)
        used[GAUGES * (size_t)bw_pd_body_owner(block, lane) + BW_SOLID_FAILURE_STRETCH] =
            most[lane] / limit;
  }
}

bw_status bw_solid_failure_compute(bw_solid *s, const bw_solid_strength *k, double used[])
{
  const bw_pd_body *pd = bw_solid_body(s);
  const double limit[] = {k->tension, k->tension, k->yield, k->cohesion, k->cohesion};
  double *stress = NULL;
  bw_status st = check(k);
  BW_THEN(st, BW_ALLOCATE(&stress, 6 * pd->n));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) bw_solid_stress_compute(s, NULL, stress);
  for (size_t i = 0; st == BW_OK && i < pd->n; i++) {
    /* Moduli of the particle's own material; the energy of a stress needs those of space. */
    const bw_pd_material *m = bw_pd_body_material(pd, i);
    const double mu = m->E / (2 * (1 + m->nu)), lam = 2 * mu * m->nu / (1 - 2 * m->nu);
    for (int c = 0; c < BW_PD_MATERIAL_CRITERIA; c++) {
      const bw_pd_material_criterion one = {(bw_pd_material_criterion_kind)c, limit[c],
                                            k->friction};
      used[GAUGES * i + (size_t)c] = bw_pd_material_used(&one, lam, mu, stress + 6 * i);
    }
  }
  if (st == BW_OK) stretches(pd, k->stretch, used);
  bw_release(&stress);
  return st;
}

/* The larger gauge first; then the smaller id, so that the list is the same on any ranks. */
static int order(const void *a, const void *b)
{
  const bw_solid_failure_place *p = a, *q = b;
  if (p->used != q->used) return p->used > q->used ? -1 : 1;
  return p->id < q->id ? -1 : p->id > q->id;
}

/* Keeps the first `most` of n rows. */
static size_t first_of(bw_solid_failure_place row[], size_t n, int most)
{
  if (n > 1) qsort(row, n, sizeof *row, order);
  return n < (size_t)most ? n : (size_t)most;
}

bw_status bw_solid_failure_list(const bw_solid *s, const double used[],
                                bw_solid_failure_gauge gauge, int most,
                                bw_solid_failure_place list[], int *n)
{
  const bw_pd_body *pd = bw_solid_body((bw_solid *)s);
  bw_solid_failure_place *mine = NULL, *all = NULL;
  size_t own = 0, bytes = 0;
  *n = 0;
  BW_TRY(bw_comm_agree(pd->comm, BW_ALLOCATE(&mine, pd->n)));
  for (size_t i = 0; i < pd->n; i++) {
    const double x = used[GAUGES * i + gauge];
    if (!(x > 0)) continue; /* pressed, retired, or not asked for */
    mine[own] = (bw_solid_failure_place){.id = pd->points.id[i], .used = x, .load = 1 / x};
    bw_pd_body_reference(pd, i, mine[own++].X0);
  }
  /* Each rank's own first ones hold the first ones of all. */
  own = first_of(mine, own, most);
  const bw_status st = bw_comm_allgather(pd->comm, own * sizeof *mine, mine, &bytes, (void **)&all);
  if (st == BW_OK) *n = (int)first_of(all, bytes / sizeof *all, most);
  for (int q = 0; q < *n; q++)
    list[q] = all[q];
  bw_release(&mine);
  bw_release(&all);
  return st;
}
