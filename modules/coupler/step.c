/* The recipe of POROUS 4.3: what happens in one time step, in this order. */
#include "bw_coupler.h"
#include "coupler_internal.h"
#include "rigid_joined.h"
#include "solid_films.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static double substeps(const bw_coupler *c, double dt)
{
  /* The squares of their frequencies add: a particle held by its bonds and pressed on all sides. */
  const double rate = hypot(1.0 / bw_solid_dt_max(c->solid), 1.0 / bw_solid_dt_contact(c->solid));
  const double n = ceil(dt * rate / c->config.solid_safety);
  const double joined = bw_coupler__joined_parts(c, dt);
  return n < joined ? joined : n; /* fmax would hide NaN */
}

int bw_coupler_substeps(const bw_coupler *c, double dt)
{
  const double n = substeps(c, dt);
  return n < (double)INT_MAX ? (int)n : INT_MAX;
}

bw_status bw_coupler_check_substeps(const bw_coupler *c, double dt)
{
  const double n = substeps(c, dt);
  /* Written so that NaN fails. */
  BW_REQUIRE(
      n <= BW_COUPLER_MOST_SUBSTEPS, BW_EINPUT,
      "a step of %g takes %.3g solid sub-steps of %.3g (solid_safety %g), more than %d: take a "
      "shorter step, a softer or heavier solid, or larger particles",
      dt, n, dt / n, c->config.solid_safety, BW_COUPLER_MOST_SUBSTEPS);
  /* Written so that what nobody computes alone is met. */
  static const double most = 1e3;
  const double *g = c->config.gravity, h = bw_grid_look(bw_ns_channel_grid(c->fluid))->spacing[0];
  const double fall = hypot(hypot(g[0], g[1]), g[2]) * dt * dt / h;
  BW_REQUIRE(
      fall <= most, BW_EINPUT,
      "coupling.gravity: by [%g, %g, %g] a body falls %.3g cells in a step of %g, at most %g; "
      "check its unit",
      g[0], g[1], g[2], fall, dt, most);
  return BW_OK;
}

bool bw_coupler__probes_look(const bw_coupler *c)
{
  const bool loads = c->config.load == BW_LOAD_PROBES || bw_coupler__solid_films_any(c);
  return c->watched || (loads && !c->held);
}

/* What p/rho acts with in sub-step r: u^{n+1} - u^n holds -dt sum_r gamma_r grad p_r. Gathered
 * where probes can read it, and only when they will. */
static void add_pressure(bw_coupler *c, int r)
{
  static const double gamma[3] = {8.0 / 15, 2.0 / 15, 1.0 / 3};
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_real *p = bw_ns_channel_pressure(c->fluid);
  const bw_real weight = (bw_real)gamma[r];
  bw_real *restrict mean = c->p_mean;
  /* Until the third sub-step the mean is not complete. */
  c->p_mean_known = false;
  if (!bw_coupler__probes_look(c)) return;
  /* Only the box that probes can read is gathered. */
  if (r == 0) bw_coupler__find_reach(c);
  for (int k = c->reach[2][0]; k <= c->reach[2][1]; k++)
    for (int j = c->reach[1][0]; j <= c->reach[1][1]; j++) {
      const ptrdiff_t begin = bw_at(g, c->reach[0][0], j, k), end = bw_at(g, c->reach[0][1], j, k);
#pragma omp simd
      for (ptrdiff_t i = begin; i <= end; i++)
        mean[i] = (r > 0 ? mean[i] : (bw_real)0) + weight * p[i];
    }
  c->p_mean_known = r == 2;
}

/* Fluid with no slip at the markers, POROUS 3.70-3.73 and 3.79-3.82. */
bw_status bw_coupler__advance_fluid(bw_coupler *c, double dt)
{
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  c->stepped = true;
  if (c->films != NULL) {
    BW_TRY(bw_coupler__solid_films_find(c));
    if (c->config.films.flux) BW_TRY(bw_coupler__solid_films_open(c, dt));
  }
  bw_timer_start(c->timer, BW_PART_FORCING);
  /* Markers of the surface at t, with its velocity; their force of the step begins at zero. */
  bw_status st = bw_coupler__place_markers(c);
  bw_ibm_mdf_begin_step(c->ibm);
  if (c->floats != NULL) BW_THEN(st, bw_coupler_rigid_begin(c->floats));
  bw_timer_stop(c->timer, BW_PART_FORCING);
  if (st != BW_OK) return st;
  for (int r = 0; r < 3; r++) {
    bw_timer_start(c->timer, BW_PART_MOMENTUM);
    bw_ns_channel_predict(c->fluid, r, dt); /* u*: convection, diffusion, old pressure */
    bw_timer_stop(c->timer, BW_PART_MOMENTUM);
    bw_timer_start(c->timer, BW_PART_FORCING);
    /* Slits are closed to the grid: before the markers, which are not to remember what is not
     * theirs, and after them. */
    if (c->films != NULL) bw_coupler__solid_films_brake(c, dt, false);
    bw_ibm_mdf_force(c->ibm, u, dt); /* u^: no slip on the moving surface */
    if (c->floats != NULL) bw_coupler_rigid_force(c->floats, dt);
    if (c->films != NULL) bw_coupler__solid_films_brake(c, dt, true);
    bw_timer_stop(c->timer, BW_PART_FORCING);
    bw_timer_start(c->timer, BW_PART_MOMENTUM);
    const double before = bw_ns_channel_cost(c->fluid).poisson;
    bw_ns_channel_project(c->fluid, r, dt); /* div u = 0, pressure updated */
    bw_timer_stop(c->timer, BW_PART_MOMENTUM);
    /* The time of the Poisson solve is taken out of the projection's. */
    bw_timer_move(c->timer, BW_PART_MOMENTUM, BW_PART_POISSON,
                  bw_ns_channel_cost(c->fluid).poisson - before);
    bw_timer_start(c->timer, BW_PART_PROBES);
    add_pressure(c, r); /* what the probes will read */
    bw_timer_stop(c->timer, BW_PART_PROBES);
  }
  /* u and p at t + dt. Are they finite, and is the step still possible? */
  return bw_ns_channel_check(c->fluid, dt);
}

bw_status bw_coupler__load_solid(bw_coupler *c, double dt, double relaxation)
{
  bw_timer_start(c->timer, BW_PART_PROBES);
  const bool probes = c->config.load == BW_LOAD_PROBES;
  bw_status st = BW_OK;
  /* The reaction loads the solid or tells the work that the fluid gave. */
  if (!probes || c->config.count_work) bw_coupler__reaction_force(c);
  if (c->config.count_work) bw_coupler__count_work(c, dt);
  if (probes) st = bw_coupler__probe_force(c, dt);
  /* Forces act on the surface, outside the centres: they bring a moment with them. */
  bw_coupler__carry_force(c, !probes);
  /* Where a film stands for the grid, what the grid did between the faces goes out of it. */
  if (c->films != NULL) BW_THEN(st, bw_coupler__solid_films_replace(c, dt, relaxation));
  bw_coupler__free_inside(c, dt);
  /* F' <- (1 - w) F' + w F against the added mass (bw_coupler.h). */
  bw_coupler__relax_load(c, dt, relaxation);
  /* The surface's acceleration over the step to come will be told from it. */
  memcpy(c->V_before, c->V, 3 * c->n * sizeof *c->V_before);
  /* With weight and buoyancy: from here on the solid knows its load. */
  bw_coupler__push_solid(c);
  if (c->floats != NULL) BW_THEN(st, bw_coupler__rigid_find_load(c->floats, dt));
  bw_timer_stop(c->timer, BW_PART_PROBES);
  return st;
}

/* Solid sub-cycled until it has caught up with the fluid, POROUS 3.47-3.49. */
bw_status bw_coupler__advance_solid(bw_coupler *c, double dt, double relaxation)
{
  const int n = bw_coupler_substeps(c, dt);
  /* Contact may have become so stiff on the way. */
  BW_TRY(bw_coupler_check_substeps(c, dt));
  bw_status st = BW_OK;
  bw_timer_start(c->timer, BW_PART_SOLID);
  BW_THEN(st, bw_coupler__resist(c, dt, relaxation));
  for (int q = 0; q < n && c->floats == NULL; q++)
    BW_THEN(st, bw_coupler__step_solid(c, dt / n));
  if (c->floats != NULL) BW_THEN(st, bw_coupler__step_joined(c, dt, n, true));
  /* Spin and velocities are those of t; the next reader makes them anew. */
  c->motion_known = false;
  bw_coupler__book_motion(c, dt);
  bw_coupler__carry_over(c, dt, relaxation);
  bw_timer_stop(c->timer, BW_PART_SOLID);
  return st;
}

static bw_status move_surface(bw_coupler *c)
{
  bw_timer_start(c->timer, BW_PART_SURFACE);
  const bw_status st = bw_coupler__follow_surface(c);
  bw_timer_stop(c->timer, BW_PART_SURFACE);
  return st;
}

/* Work of one step of this rank, for the cost per unit. */
static void count_work(bw_coupler *c, double dt)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const double cells = 3.0 * g->m[0] * g->m[1] * g->m[2];
  const bool rk3 = bw_solid_settings(c->solid)->integrator == BW_SOLID_RK3;
  bw_timer_work(c->timer, BW_PART_MOMENTUM, cells);
  bw_timer_work(c->timer, BW_PART_POISSON, cells);
  /* Three sub-steps, each with all iterations over all markers. */
  bw_timer_work(c->timer, BW_PART_FORCING,
                3.0 * c->config.iterations * (double)(c->block > 1 ? c->blocks.n : c->n_surface));
  if (!c->held)
    bw_timer_work(c->timer, BW_PART_SOLID, c->bonds * bw_coupler_substeps(c, dt) * (rk3 ? 3 : 1));
}

static bw_status step(bw_coupler *c, double dt)
{
  if (dt != c->checked_dt)
    BW_TRY(bw_ns_channel_check(c->fluid, dt)); /* later: by the step before */
  /* Every step ends with a check of the same dt. */
  c->checked_dt = dt;
  count_work(c, dt);
  c->steps++;
  c->iterations = 1;
  /* A held solid: the fluid alone, around markers that do not move. */
  if (c->held) {
    bw_status st = bw_coupler__advance_fluid(c, dt);
    bw_coupler__remember(c);
    if (c->floats != NULL) BW_THEN(st, bw_coupler__step_floats(c, dt));
    return st;
  }
  BW_TRY(bw_coupler__choose(c, dt)); /* how much of a new load holds */
  bw_coupler__book_open(c);
  if (c->config.coupling_iterations > 1) {
    /* The same phases, repeated until both sides agree. */
    BW_TRY(bw_coupler__iterate(c, dt));
  } else {
    BW_TRY(bw_coupler__predict(c, dt));       /* how the surface will move */
    BW_TRY(bw_coupler__advance_fluid(c, dt)); /* u, p at t + dt around the solid at t */
    const double w = c->config.load_relaxation;
    BW_TRY(bw_coupler__load_solid(c, dt, w));    /* stress of the new flow */
    BW_TRY(bw_coupler__advance_solid(c, dt, w)); /* X, V, bonds at t + dt */
  }
  bw_coupler__remember(c);       /* what the markers needed, for the next step */
  BW_TRY(bw_coupler__let_go(c)); /* pieces that have passed an outflow */
  return move_surface(c);        /* surface and markers at t + dt */
}

bw_status bw_coupler_step(bw_coupler *c, double dt)
{
  const bw_status st = step(c, dt);
  if (st != BW_OK) return bw_coupler__book_explain(c, st);
  return c->held ? BW_OK : bw_coupler__book_close(c); /* is it physics still? */
}
