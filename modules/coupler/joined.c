/* Rigid bodies and a solid of particles in one flow.
 *
 * Both have markers in it; within a sub-step of the fluid those of the solid force first, and the
 * memories of both settle what they do to each other where they are close. The loads of the fluid
 * act over the whole step. In it bodies and particles move together, in sub-steps of velocity
 * Verlet of all:
 *   kick the bodies dt/2, drift; a step of the solid, whose forces at its end know where the bodies
 *   are; kick dt/2 with the contact found there. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "rigid_joined.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

bw_status bw_coupler_join(bw_coupler *c, bw_coupler_rigid *bodies, bool contact)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  double period[3] = {0.0, 0.0, 0.0};
  BW_REQUIRE(c->floats == NULL, BW_EINPUT, "coupler: rigid bodies have joined it already");
  for (int d = 0; d < 3; d++)
    if (g->periodic[d] && g->n[d] > 1) period[d] = g->length[d];
  if (contact)
    BW_TRY(bw_coupler__touch_create(c->solid, bw_coupler__rigid_set(bodies), period, &c->touch));
  c->floats = bodies;
  c->inside_known = false;
  /* The states that steps go back to were made without them. */
  bw_status st = BW_OK;
  if (c->config.coupling_iterations > 1)
    st = bw_coupler__joined_room(c, &c->iteration.start.bodies);
  if (c->config.predictor) BW_THEN(st, bw_coupler__joined_room(c, &c->predicted.bodies));
  return bw_comm_agree(bw_solid_comm(c->solid), st);
}

/* ---- state ---- */

/* Rows, the fluid's load and the markers' memory, one behind the other. */
typedef struct {
  double *row, *load, *memory;
} parts;

static parts parts_of(const bw_coupler *c, double bodies[])
{
  const size_t n = (size_t)bw_rigid_count(bw_coupler__rigid_set(c->floats));
  return (parts){bodies, bodies + BW_RIGID_ROW * n, bodies + (BW_RIGID_ROW + 6) * n};
}

bw_status bw_coupler__joined_room(const bw_coupler *c, double **bodies)
{
  if (c->floats == NULL) return BW_OK;
  const bw_rigid *r = bw_coupler__rigid_set(c->floats);
  return BW_ALLOCATE(bodies,
                     (BW_RIGID_ROW + 6) * (size_t)bw_rigid_count(r) + 3 * bw_rigid_points(r) + 1);
}

void bw_coupler__joined_capture(const bw_coupler *c, double bodies[])
{
  if (c->floats == NULL) return;
  const parts p = parts_of(c, bodies);
  bw_rigid_save(bw_coupler__rigid_set(c->floats), p.row);
  bw_coupler_rigid_get_state(c->floats, p.memory, p.load);
}

bw_status bw_coupler__joined_restore(const bw_coupler *c, double time, double bodies[])
{
  if (c->floats == NULL) return BW_OK;
  const parts p = parts_of(c, bodies);
  bw_rigid_restore(bw_coupler__rigid_set(c->floats), time, p.row);
  return bw_coupler_rigid_set_state(c->floats, p.memory, p.load);
}

/* ---- steps ---- */

/* What the fluid and the solid do to the bodies now. */
static void load_bodies(const bw_coupler *c, double load[])
{
  bw_rigid *r = bw_coupler__rigid_set(c->floats);
  const ptrdiff_t n = bw_rigid_count(r);
  const double *fluid = bw_coupler__rigid_acting(c->floats);
  const double *touch = c->touch != NULL ? bw_coupler__touch_load(c->touch) : NULL;
  for (ptrdiff_t i = 0; i < 6 * n; i++)
    load[i] = fluid[i] + (touch != NULL ? touch[i] : 0.0);
  bw_rigid_load(r, load, load + 3 * n);
}

double bw_coupler__joined_parts(const bw_coupler *c, double dt)
{
  if (c->floats == NULL) return 1.0;
  const double bodies = bw_rigid_dt_max(bw_coupler__rigid_set(c->floats));
  const double touch = c->touch != NULL ? bw_coupler__touch_time(c->touch) : INFINITY;
  return ceil(fmax(dt / bodies, dt / (c->config.solid_safety * touch)));
}

bw_status bw_coupler__step_solid(bw_coupler *c, double dt)
{
  /* Films are stiffer than any sub-step: their force is that at its end. */
  if (c->films != NULL) BW_TRY(bw_coupler__solid_films_press(c, dt));
  BW_TRY(bw_solid_step(c->solid, dt));
  if (c->films != NULL) bw_coupler__solid_films_book(c, dt);
  return BW_OK;
}

bw_status bw_coupler__step_joined(bw_coupler *c, double dt, int n, bool solid)
{
  bw_rigid *r = bw_coupler__rigid_set(c->floats);
  double *load = bw_coupler__rigid_scratch(c->floats);
  /* The contact that the last step, or a restart, ended with: at the same places the same. */
  if (c->touch != NULL) BW_TRY(bw_coupler__touch_feel(c->touch));
  if (solid) BW_TRY(bw_solid_make_ready(c->solid));
  for (int q = 0; q < n; q++) {
    load_bodies(c, load);
    BW_TRY(bw_rigid_begin(r, dt / n));
    /* A solid that is held is pushed against, and stays. */
    if (solid)
      BW_TRY(bw_coupler__step_solid(c, dt / n));
    else if (c->touch != NULL)
      BW_TRY(bw_coupler__touch_feel(c->touch));
    load_bodies(c, load);
    BW_TRY(bw_rigid_end(r, dt / n));
  }
  return BW_OK;
}

bw_status bw_coupler__step_floats(bw_coupler *c, double dt)
{
  BW_TRY(bw_coupler__rigid_find_load(c->floats, dt));
  const double n = fmax(1.0, bw_coupler__joined_parts(c, dt));
  BW_REQUIRE(n <= BW_COUPLER_MOST_SUBSTEPS, BW_ECFL,
             "rigid bodies: a step of %g takes %g of the bodies': softer springs or contact", dt,
             n);
  return bw_coupler__step_joined(c, dt, (int)n, false);
}
