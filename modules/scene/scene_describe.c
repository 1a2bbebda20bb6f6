/* What a scene says of itself before it runs: blocks, knobs, sizes, limits, warnings. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

/* Particles of each level, and what they cost beside a body of the finest ones alone: half as many
 * each way, as the step is that of the finest anyway. Collective. */
static void describe_levels(const bw_scene *s, const bw_solid *p, bw_log *log)
{
  const bw_solid_config *c = bw_solid_settings(p);
  int64_t count[BW_PD_FINEST + 1] = {0};
  double all = 0, fine = 0;
  int finest = 0;
  for (size_t i = 0; i < bw_solid_count(p); i++)
    count[bw_solid_level(p, i)]++;
  bw_comm_sum_int(s->comm, BW_PD_FINEST + 1, count);
  for (int b = 0; b < c->finer.n; b++)
    finest = c->finer.box[b].level > finest ? c->finer.box[b].level : finest;
  finest = c->finer.refine.level > finest ? c->finer.refine.level : finest;
  for (int l = 0; l <= finest; l++) {
    bw_log_info(log, "           level %d: %lld particles of %g, horizon %g", l,
                (long long)count[l], ldexp(c->ds, -l), ldexp(bw_solid_horizon(p), -l));
    all += (double)count[l];
    fine += ldexp((double)count[l], (s->planar ? 2 : 3) * (finest - l));
  }
  bw_log_info(log,
              "           a body of the finest alone: %.0f particles; these are at best %.3g times "
              "faster",
              fine, fine / all);
}

/* The critical stretch of a law that has one for all bonds, and that breaks; else nothing. */
static const char *stretch_words(double stretch, char out[48])
{
  out[0] = '\0';
  if (isfinite(stretch)) snprintf(out, 48, ", critical stretch %.3g", stretch);
  return out;
}

static void describe_solids(bw_scene *s, bw_log *log)
{
  for (int q = 0; q < s->n_solids; q++) {
    const bw_solid *p = s->solid[q].solid;
    char names[256] = "";
    for (int k = 0; k < s->solid[q].n_bodies; k++) {
      const size_t used = strlen(names);
      snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
               s->config.bodies[s->solid[q].body[k]].name);
    }
    /* Of a plan no particle is made: numbers are those of a sample of the material. */
    if (s->sketched) {
      const double ds = s->config.bodies[s->solid[q].body[0]].spacing;
      const bw_solid_sample *a = &s->solid[q].sample;
      char stretch[48];
      bw_log_info(log, "solid      %s: about %.3g particles of %g, horizon %g%s", names,
                  s->solid[q].sites, ds, a->horizon, stretch_words(a->critical_stretch, stretch));
      bw_log_info(log, "           step at most about %.3g for bonds, %.3g for contact", a->dt_max,
                  a->dt_contact);
      continue;
    }
    char stretch[48];
    bw_log_info(log, "solid      %s: %lld particles of %g, horizon %g%s", names,
                (long long)bw_solid_total(p), bw_solid_settings(p)->ds, bw_solid_horizon(p),
                stretch_words(bw_solid_critical_stretch(p), stretch));
    if (bw_solid_settings(p)->finer.n > 0 || bw_solid_settings(p)->finer.refine.level > 0)
      describe_levels(s, p, log);
    bw_log_info(log, "           step at most %.3g for bonds, %.3g for contact", bw_solid_dt_max(p),
                bw_solid_dt_contact(p));
  }
  if (s->assembly != NULL)
    bw_log_info(log, "contact    between all solids; step at most %.3g for all together",
                bw_solid_assembly_dt(s->assembly));
}

static void describe_fluid(bw_scene *s, bw_log *log)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  bw_log_info(log, "fluid      %d x %d x %d cells of %g x %g x %g", g->n[0], g->n[1], g->n[2],
              g->spacing[0], g->spacing[1], g->spacing[2]);
  if (s->speed > 0.0)
    bw_log_info(log, "           fastest speed that the file names %g; cell Reynolds number %.3g",
                s->speed, s->speed * g->spacing[1] / s->config.fluid.viscosity);
  if (s->inner.n > 0 || s->markers != NULL || (s->planned && s->n_solids == 0 && !s->rigid)) {
    int64_t n[2] = {(int64_t)s->inner.n, (int64_t)s->wall.n};
    bw_comm_sum_int(s->comm, 2, n);
    s->n_markers = n[0];
    bw_log_info(log, "surfaces   %lld markers, %lld probes on the true surfaces", (long long)n[0],
                (long long)n[1]);
  }
}

static void describe_water(const bw_scene *s, bw_log *log)
{
  const bw_scene__water *w = s->water;
  const double c0 = bw_ulph_c0(w->fluid);
  bw_log_info(log, "fluid      %s%.0f particles %g apart, %.0f of walls",
              w->sampled ? "about " : "", w->sites, w->config.dx, w->walls);
  bw_log_info(log, "           sound %g, 1/%.3g of it is the largest speed expected, %g", c0,
              c0 / w->config.speed, w->config.speed);
  bw_log_info(log, "           kinematic viscosity: physical %.3g, artificial %.3g",
              w->config.mu / w->config.rho0, bw_ulph_artificial_nu(w->fluid));
}

static void describe_rigid(bw_scene *s, bw_log *log)
{
  for (int b = 0; b < s->config.n_bodies; b++) {
    if (s->rigid_of[b] < 0 || s->config.bodies[b].motion != BW_SCENE_RIGID) continue;
    const bw_rigid_state a = bw_rigid_state_of(s->rigid, s->rigid_of[b]);
    bw_log_info(log,
                "rigid      %s: mass %.5g, centre (%g, %g, %g), principal moments %.4g, %.4g, %.4g",
                s->config.bodies[b].name, a.mass, a.position[0], a.position[1], a.position[2],
                a.inertia[0], a.inertia[1], a.inertia[2]);
  }
  bw_log_info(log, "           step at most %.3g for springs and contact",
              bw_rigid_dt_max(s->rigid));
}

/* One iteration of the forcing leaves what a memory would settle. */
static void warn_of_slip(const bw_scene *s, bw_log *log)
{
  const bw_scene_numerics *n = &s->config.numerics;
  if (s->grid == NULL || s->config.n_bodies == 0 || n->memory > 0.0) return;
  if (n->forcing_iterations > 1) return;
  bw_log_warn(log,
              "numerics.memory = 0 with numerics.forcing_iterations = %d leaves some 15 %% of the "
              "flow as slip at the bodies: take a memory of 0.2, or 2 iterations or more",
              n->forcing_iterations);
}

/* Pieces of a solid in a fluid of particles meet each other and the sides of the box alone. */
static void warn_of_walls(const bw_scene *s, bw_log *log)
{
  for (int b = 0; b < s->config.n_bodies && s->n_solids > 0; b++)
    if (s->solid[0].contact && bw_scene__is_wall(&s->config, b))
      bw_log_warn(log,
                  "bodies.%s is a wall of the fluid, and bodies that move go through it; if they "
                  "may come there make it prescribed, a horizon away from them",
                  s->config.bodies[b].name);
}

/* Films that bear any suction hold what breaks together. */
static void warn_of_films(const bw_scene *s, bw_log *log)
{
  const bw_scene_fluid *fluid = &s->config.fluid;
  bool breaks = false;
  for (int b = 0; b < s->config.n_bodies; b++)
    breaks = breaks || s->config.bodies[b].motion == BW_SCENE_BREAKABLE;
  if (breaks && !isnan(fluid->film_roughness) && isnan(fluid->film_least))
    bw_log_warn(log,
                "films bear any suction, so that faces of a crack hold each other and more bonds "
                "break beside them; give fluid.film_least, at which the fluid cavitates");
}

/* Cells across what is thin, and steps of the solid. */
void bw_scene__warn(bw_scene *s, bw_log *log)
{
  warn_of_films(s, log);
  bw_scene__warn_solids(s, log);
  for (int b = 0; b < s->config.n_bodies; b++) {
    const bw_scene_body *body = &s->config.bodies[b];
    bw_scene__shapes shapes;
    double least = HUGE_VAL;
    const bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
    for (int d = 0; st == BW_OK && d < (s->planar ? 2 : 3); d++)
      least = fmin(least, shapes.upper[d] - shapes.lower[d]);
    bw_scene__shapes_release(&shapes);
    if (st != BW_OK) continue;
    if (bw_scene__deforms(body)) bw_scene__warn_layers(s, b, least / body->spacing, log);
    if (s->grid != NULL && least < 7.5 * bw_grid_look(s->grid)->spacing[1] &&
        !bw_scene__deforms(body))
      bw_log_warn(log,
                  "bodies.%s is %.2g cells across: forces on it are some 10 %% off below 8; take "
                  "more cells",
                  body->name, least / bw_grid_look(s->grid)->spacing[1]);
  }
}

/* Faster than this the layer around a rigid body is thinner than cells. Measured with a sphere 8
 * cells across that falls: its velocity is that by Schiller and Naumann's drag, less some per cent
 * for the walls, at cell Reynolds numbers of 4 and 11, and 5 % above it at 39. */
void bw_scene__warn_speed(bw_scene *s)
{
  enum { MOST = 20 };
  if (s->floats == NULL || s->too_fast) return;
  const double h = bw_grid_look(s->grid)->spacing[0], nu = s->config.fluid.viscosity;
  const double cell = bw_scene__rigid_speed(s) * h / nu;
  if (!(cell > MOST)) return;
  s->too_fast = true;
  bw_log_warn(s->log,
              "a rigid body moves at a cell Reynolds number of %.3g at t = %g: above %d the layer "
              "around it is thinner than cells; take %.1f times as many in each direction",
              cell, s->time, MOST, cell / MOST);
}

/* What the first step may be at most. */
static double first_limit(bw_scene *s)
{
  if (s->water != NULL) return bw_scene__water_limit(s);
  if (s->grid == NULL) return bw_scene__solid_limit(s);
  return bw_scene__fluid_limit(s);
}

/* Refuses steps of the file that the first step would refuse. What the flow becomes may bear less;
 * that is found where it happens. */
static bw_status check_step(bw_scene *s)
{
  const double most = first_limit(s) * (1.0 + 1e-12);
  const char *who = bw_scene__has_flow(&s->config) ? "fluid and its sides" : "bodies";
  for (int q = -1; q < s->config.n_phases; q++) {
    const double step = q < 0 ? s->config.numerics.step : s->config.phases[q].step;
    char key[48] = "numerics.step";
    if (q >= 0) snprintf(key, sizeof key, "phases.%d.step", q);
    BW_REQUIRE(!(step > most), BW_EINPUT,
               "%s = %g: the %s at the start bear at most %.3g; take a shorter one, or leave it "
               "out",
               key, step, who, most);
  }
  return BW_OK;
}

/* Of the whole run where its end is known, else of a thousand steps. Steps end where a row of the
 * history is written, in equal parts of the time between two. */
static void tell_cost(const bw_scene *s, double dt, double end, bw_log *log)
{
  const double asked = s->config.output.sample_every, row = isnan(asked) ? end / 200.0 : asked;
  const double each = row > 0.0 ? row / ceil(row / dt * (1.0 - 1e-12)) : dt;
  const double steps = isnan(end) ? 1000.0 : fmax(1.0, end / each);
  bw_scene__cost c = bw_scene__cost_of_step(s, isnan(end) ? dt : each);
  c.cells *= steps, c.markers *= steps, c.particles *= steps;
  bw_scene__cost_tell(s, &c, isnan(end) ? "of a thousand steps about " : "about ", log);
}

bw_status bw_scene_describe(bw_scene *s, bw_log *log)
{
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  BW_TRY(bw_comm_agree(s->comm, out == NULL ? BW_FAIL(BW_EMEM, "no memory for a text") : BW_OK));
  fprintf(out, "what runs, and why:\n");
  bw_scene_blocks(s, out);
  static const char *const words[] = {"quick", "standard", "careful"};
  fprintf(out, "accuracy: %s (", words[s->config.accuracy]);
  bw_scene__promise(s, out);
  fprintf(out, ") sets\n");
  bw_scene_knobs(&s->config, out);
  fclose(out);
  /* The log ends its lines by itself. */
  if (length > 0 && text[length - 1] == '\n') text[length - 1] = '\0';
  bw_log_info(log, "%s", text);
  bw_release(&text);
  /* Sizes and limits of what runs, then how many steps that makes. */
  if (s->grid != NULL) describe_fluid(s, log);
  if (s->water != NULL) describe_water(s, log);
  describe_solids(s, log);
  if (s->rigid != NULL) describe_rigid(s, log);
  if (s->coupler != NULL && s->alive) {
    const double dt = bw_scene__limit(s);
    BW_TRY(bw_coupler_check_substeps(s->coupler, dt));
    bw_log_info(log, "coupling   %d sub-steps of the solid in a step of %.3g",
                bw_coupler_substeps(s->coupler, dt), dt);
  }
  BW_TRY(check_step(s));
  const double limit = bw_scene__limit(s), end = bw_scene__end(s);
  bw_log_info(log, "time step  %.3g now%s%.3g", limit,
              isnan(end) ? "; end by " : ", steps in all about ",
              isnan(end) ? (double)s->config.n_phases : end / limit);
  tell_cost(s, limit, end, log);
  bw_scene__warn(s, log);
  warn_of_slip(s, log);
  warn_of_walls(s, log);
  BW_TRY(bw_scene__look_at_gaps(s, log));
  return s->planned ? bw_scene__plan_describe(s, log) : BW_OK;
}
