/* body.h -- boxes of lattice sites, and columns over their particles, for validations of pd_bond.
 */
#pragma once
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_solid_load.h"
#include "bw_solid_static.h"
#include "bw_solid_stress.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

/* kind of a site, or a negative number: none there. */
typedef int (*body_choice)(const int32_t site[3], const void *data);

static inline bw_status body_make(const bw_comm *comm, const bw_solid_config *c, const int size[3],
                                  body_choice choice, const void *data, bw_solid **pd)
{
  const size_t cells = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  int64_t n = 0;
  bw_status st = BW_ALLOCATE(&site, 3 * cells);
  BW_THEN(st, BW_ALLOCATE(&kind, cells));
  for (int64_t q = 0; st == BW_OK && q < (int64_t)cells; q++) {
    int32_t *s = site + 3 * n;
    s[0] = (int32_t)(q % size[0]);
    s[1] = (int32_t)(q / size[0] % size[1]);
    s[2] = (int32_t)(q / size[0] / size[1]);
    const int what = choice == NULL ? BW_PD_FREE : choice(s, data);
    if (what >= 0) kind[n++] = (uint8_t)what;
  }
  BW_THEN(st, bw_solid_create_same(comm, c, n, site, kind, pd));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

/* Mean of value[stride i] over the particles with lower <= X0 < upper; NaN when there is none. */
static inline double body_mean(const bw_solid *pd, const double X0[], const double lower[3],
                               const double upper[3], const double value[], size_t stride)
{
  double sum[2] = {0};
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    bool in = true;
    for (size_t k = 0; k < 3; k++)
      in = in && X0[3 * i + k] >= lower[k] && X0[3 * i + k] < upper[k];
    if (in) sum[0] += value[stride * i], sum[1]++;
  }
  bw_comm_sum(bw_solid_comm(pd), 2, sum);
  return sum[1] > 0 ? sum[0] / sum[1] : NAN;
}

/* What a body's particles have: rows by own particle, all allocated together. */
typedef struct {
  double *X0, *X, *V, *F, *gradient, *stress;
} body_rows;

static inline bw_status body_rows_make(const bw_solid *pd, body_rows *r)
{
  const size_t n = bw_solid_count(pd);
  *r = (body_rows){0};
  BW_TRY(BW_ALLOCATE(&r->X0, 3 * n));
  BW_TRY(BW_ALLOCATE(&r->X, 3 * n));
  BW_TRY(BW_ALLOCATE(&r->V, 3 * n));
  BW_TRY(BW_ALLOCATE(&r->F, 3 * n));
  BW_TRY(BW_ALLOCATE(&r->gradient, 9 * n));
  BW_TRY(BW_ALLOCATE(&r->stress, 6 * n));
  bw_solid_get_reference(pd, r->X0);
  return BW_OK;
}

static inline void body_rows_release(body_rows *r)
{
  bw_release(&r->X0);
  bw_release(&r->X);
  bw_release(&r->V);
  bw_release(&r->F);
  bw_release(&r->gradient);
  bw_release(&r->stress);
}

/* r->X holds the displacement of the prescribed particles on entry; on exit r->stress is that of
 * the body at rest with it (linear solve). */
static inline bw_status body_at_rest(bw_solid *pd, body_rows *r)
{
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = 1e-6;
  BW_TRY(bw_solid_static_linear(pd, &config, r->X, &report));
  for (size_t k = 0; k < 3 * bw_solid_count(pd); k++)
    r->X[k] += r->X0[k];
  bw_solid_set_state(pd, r->X, r->V);
  bw_solid_stress_compute(pd, NULL, r->stress);
  return BW_OK;
}

/* A body of `side` sites in each of `dims` directions, held along its edge. */
typedef struct {
  int dims, side, edge;
} body_framed;

static inline int body_frame(const int32_t site[3], const void *data)
{
  const body_framed *q = data;
  for (int k = 0; k < q->dims; k++)
    if (site[k] < q->edge || site[k] >= q->side - q->edge) return BW_PD_PRESCRIBED;
  return BW_PD_FREE;
}
