/* What the fluid is told of the surface's motion in a step that is not repeated (bw_coupler.h,
 * "Motions faster than the step"): with a predictor the mean velocity that the solid would have
 * under the load that it felt last.
 *
 * The solid goes through its sub-steps without breaking, under F'_{n-1} and its weight, to X_p,
 * and is put back. The fluid is told U_n = (X_p - X_n + CATCH_UP lag)/dt, where lag is by how much
 * the surface is ahead of what the fluid was told until then: lag += X_{n+1} - X_n - U_n dt. So
 * told and true motion do not drift apart, as what is stiff answers to each change of the load
 * within a step. Within one they differ by the load's change alone, F'_n - F'_{n-1} =
 * w (F_n - F'_{n-1}): the work that comes from nowhere, sum F'.(U dt - dX) (book.c), is of the
 * order of w dt^2, whatever waves the lattice has, while a sample of the velocity is off by dt/2
 * of the acceleration.
 *
 * A mode of frequency omega, theta = omega dt, with mass m and added mass G, loses for small w
 * w G (1 - cos theta)/(theta^2 m) of its amplitude a step, at every theta: in bw_coupler.h's growth
 * the mean in place of the sample at the beginning turns the load by theta/2 and takes
 * sin(theta/2)/(theta/2) of it. No mode is fed, and the virtual mass has nothing to cure: it is
 * left out.
 *
 * A body without waves changes its velocity by y_n in step n, and the fluid is told changes of
 * b_{n+1} = 3/2 y_n - 1/2 y_{n-1} + CATCH_UP (l_{n+1} - l_n) with l_{n+1} = (1 - CATCH_UP) l_n
 * + 1/2 (y_n - y_{n-1}): what swings with the step meets 2 + 2 CATCH_UP/(2 - CATCH_UP) times the
 * added mass (relaxation.c), and light bodies hold less w. */
#include "bw_memory.h"
#include "coupler_internal.h"
#include "rigid_joined.h"

#include <string.h>

bw_status bw_coupler__predictor_create(bw_coupler *c)
{
  if (!c->config.predictor) return BW_OK;
  BW_TRY(BW_ALLOCATE(&c->felt, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->lag, 3 * c->n));
  return bw_coupler__state_create_solid(c, &c->predicted);
}

/* From X_n at V_n to X_p. Collective. */
static bw_status advance(bw_coupler *c, double dt)
{
  const int n = bw_coupler_substeps(c, dt);
  const bool breaks = bw_solid_breaks(c->solid);
  BW_TRY(bw_coupler_check_substeps(c, dt));
  memcpy(c->F, c->felt, 3 * c->n * sizeof *c->F);
  bw_coupler__push_solid(c);
  bw_solid_enable_breakage(c->solid, false);
  bw_status st = BW_OK;
  for (int q = 0; q < n && c->floats == NULL; q++)
    BW_THEN(st, bw_coupler__step_solid(c, dt / n));
  if (c->floats != NULL) BW_THEN(st, bw_coupler__step_joined(c, dt, n, true));
  bw_solid_enable_breakage(c->solid, breaks);
  return st;
}

bw_status bw_coupler__predict(bw_coupler *c, double dt)
{
  double *X = c->book.X, *V = c->scratch[0];
  if (!c->config.predictor) return BW_OK;
  const bw_coupler__work work = c->work; /* of films, too: what they do here is undone */
  bw_timer_start(c->timer, BW_PART_SOLID);
  bw_coupler__state_capture_solid(c, &c->predicted);
  bw_solid_get_position(c->solid, X);
  bw_status st = advance(c, dt);
  bw_solid_get_position(c->solid, V);
  for (size_t i = 0; i < 3 * c->n; i++)
    V[i] = (V[i] - X[i] + BW_COUPLER__CATCH_UP * c->lag[i]) / dt;
  /* The surface where it is, with this velocity and the spin that belongs to it. */
  bw_solid_set_state(c->solid, X, V);
  c->motion_known = false;
  bw_coupler__marker_velocity(c, c->marker_V);
  c->markers_moved = true;
  BW_THEN(st, bw_coupler__state_restore_solid(c, &c->predicted));
  c->work = work;
  bw_timer_stop(c->timer, BW_PART_SOLID);
  return st == BW_OK && c->block > 1 ? bw_coupler__blocks_follow(c) : st;
}
