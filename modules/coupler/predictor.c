/* What the fluid is told of the surface's motion in a step that is not repeated (bw_coupler.h,
 * "Motions faster than the step"): with a predictor the mean velocity that the solid would have
 * under the load that it felt last.
 *
 * The solid goes through its sub-steps without breaking, under F'_{n-1} and its weight, and is put
 * back; (X_p - X_n)/dt is its mean velocity. The true step differs by the load's change alone,
 * F'_n - F'_{n-1} = w (F_n - F'_{n-1}): on a particle by dt/2 of that over its density. So the work
 * that comes from nowhere, sum F'.(V_told dt - dX) (book.c), is of the order of w dt^2, whatever
 * waves the lattice has, while a sample of the velocity is off by dt/2 of the acceleration.
 *
 * A mode of frequency omega, theta = omega dt, with mass m and added mass G grows by the real part
 * of the load's work over its own motion of the same step, H(e^{i theta}) (1 - cos theta)/(theta m)
 * without the e^{-i theta/2} (sin(theta/2)/(theta/2))^-1 of a sample: for small w it loses
 * w G (1 - cos theta)/(theta^2 m) of its amplitude a step, at every theta. No mode is fed, and the
 * virtual mass has nothing to cure: it is left out.
 *
 * A body without waves is told V_n + dt/(2 m) F'_{n-1}, so that changes of its velocity come to the
 * fluid as 3/2 of the last one less half of that before: what swings with the step meets twice the
 * added mass (relaxation.c). */
#include "coupler_internal.h"
#include "rigid_joined.h"

#include <string.h>

bw_status bw_coupler__predictor_create(bw_coupler *c)
{
  if (!c->config.predictor) return BW_OK;
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
  double *X = c->X, *V = c->scratch[0];
  if (!c->config.predictor) return BW_OK;
  const bw_coupler__work work = c->work; /* of films, too: what they do here is undone */
  bw_timer_start(c->timer, BW_PART_SOLID);
  bw_coupler__state_capture_solid(c, &c->predicted);
  bw_solid_get_position(c->solid, X);
  bw_status st = advance(c, dt);
  bw_solid_get_position(c->solid, V);
  for (size_t i = 0; i < 3 * c->n; i++)
    V[i] = (V[i] - X[i]) / dt;
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
