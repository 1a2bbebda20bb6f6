/* state.h -- what the validations of the state-based laws share: bodies and rows of
 * validation/pd_bond/body.h, Lame's constants, claims. */
#pragma once
#include "../pd_bond/body.h"

#include <string.h>

static const double STATE_PI = 3.14159265358979323846;

static inline void state_claim(bw_validation *v, const char *claim, const char *quantity,
                               double measured, double reference, double tolerance,
                               bw_claim_kind kind, const char *source, const char *extra)
{
  bw_validation_row(v, &(bw_claim){.claim = claim,
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = kind,
                                   .source = source,
                                   .extra = extra});
}

/* lam (lam* in plane stress) and mu. */
static inline void state_lame(bw_pd_geometry geometry, double E, double nu, double *lam, double *mu)
{
  *mu = E / (2 * (1 + nu));
  *lam =
      geometry == BW_PD_PLANE_STRESS ? E * nu / (1 - nu * nu) : E * nu / ((1 + nu) * (1 - 2 * nu));
}

/* rho w^2 of a wave A sin(k x0) along direction d, from the acceleration of the body displaced by
 * it, projected on it. */
static inline bw_status state_operator(bw_solid *pd, double k, size_t d, double *out)
{
  const double amplitude = 1e-6;
  body_rows r;
  double sum[2] = {0};
  BW_TRY(body_rows_make(pd, &r));
  for (size_t i = 0; i < 3 * bw_solid_count(pd); i++)
    r.X[i] = r.X0[i];
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    r.X[3 * i + d] += amplitude * sin(k * r.X0[3 * i]);
  bw_solid_set_state(pd, r.X, r.V);
  BW_TRY(bw_solid_evaluate(pd));
  bw_solid_get_acceleration(pd, r.F);
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    const double phase = sin(k * r.X0[3 * i]);
    sum[0] -= bw_solid_density(pd, i) * r.F[3 * i + d] * phase;
    sum[1] += amplitude * phase * phase;
  }
  bw_comm_sum(bw_solid_comm(pd), 2, sum);
  *out = sum[0] / sum[1];
  body_rows_release(&r);
  return BW_OK;
}
