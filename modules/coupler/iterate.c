/* Iterated coupling: a step is repeated until the surface moves as the fluid was told. */
#include "coupler_internal.h"

#include <math.h>
#include <string.h>

enum { GUESS, RESIDUAL, BEFORE };

/* The markers move at the guess; where they are does not change. */
static bw_status give_guess(bw_coupler *c)
{
  memcpy(c->marker_V, c->iterate[GUESS], 3 * c->n_surface * sizeof *c->marker_V);
  c->markers_moved = true;
  return c->block > 1 ? bw_coupler__blocks_follow(c) : BW_OK;
}

/* Residual: velocity that the solid reached less the guess. sums: its square, the square of that
 * velocity, residual before times difference of the residuals, square of this difference. */
static void compare(bw_coupler *c, double sums[4])
{
  double *r = c->iterate[RESIDUAL], *r0 = c->iterate[BEFORE];
  const double *guess = c->iterate[GUESS];
  memset(sums, 0, 4 * sizeof *sums);
  double *V = c->accel; /* scratch */
  bw_coupler__marker_velocity(c, V);
  for (size_t i = 0; i < 3 * c->n_surface; i++) {
    r0[i] = r[i];
    r[i] = V[i] - guess[i];
    sums[0] += r[i] * r[i];
    sums[1] += V[i] * V[i];
    sums[2] += r0[i] * (r[i] - r0[i]);
    sums[3] += (r[i] - r0[i]) * (r[i] - r0[i]);
  }
  bw_comm_sum(bw_pd_bond_comm(c->solid), 4, sums);
}

bw_status bw_coupler__iterate(bw_coupler *c, double dt)
{
  const int most = c->config.coupling_iterations;
  const bw_coupler__work work = c->work;
  double omega = c->config.load_relaxation, sums[4];
  bw_coupler__state_capture(c, &c->start);
  memcpy(c->iterate[GUESS], c->marker_V, 3 * c->n_surface * sizeof *c->marker_V);
  for (int k = 1;; k++) {
    c->work = work;
    BW_TRY(give_guess(c));
    BW_TRY(bw_coupler__advance_fluid(c, dt));
    BW_TRY(bw_coupler__load_solid(c, dt, 1.0));
    BW_TRY(bw_coupler__advance_solid(c, dt));
    compare(c, sums);
    c->iterations = k;
    c->residual = sums[0] > 0.0 ? sqrt(sums[0] / fmax(sums[1], 1e-300)) : 0.0;
    if (c->residual <= c->config.coupling_residual) return BW_OK;
    if (k == most) break;
    if (k > 1 && sums[3] > 0.0) omega *= -sums[2] / sums[3]; /* Aitken */
    for (size_t i = 0; i < 3 * c->n_surface; i++)
      c->iterate[GUESS][i] += omega * c->iterate[RESIDUAL][i];
    BW_TRY(bw_coupler__state_restore(c, &c->start));
  }
  c->unconverged++;
  return BW_OK;
}
