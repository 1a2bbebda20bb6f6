/* What gauges see of a fluid of particles, and of its forces on the solid in it. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

void bw_scene__water_where(const bw_scene *s, double x[3])
{
  const bw_ulph_config *f = &s->water->config;
  double v[3], a[3];
  memset(x, 0, 3 * sizeof *x);
  if (f->motion != NULL) f->motion(bw_ulph_time(s->water->fluid), f->motion_context, x, v, a);
}

/* Where a gauge looks now: its region, or all of the box and what is above its open sides. */
static void look(const bw_scene *s, const bw_scene_gauge_config *g, double lower[3],
                 double upper[3])
{
  double at[3];
  bw_scene__water_where(s, at);
  for (int d = 0; d < 3; d++) {
    const bool flat = d == 2 && s->planar;
    const double from = bw_scene__is_open(&s->config, d, 0) ? -1e30 : 0.0;
    const double to = bw_scene__is_open(&s->config, d, 1) ? 1e30 : s->config.domain.length[d];
    lower[d] = (g->has_region ? g->region.from[d] : from) + at[d];
    upper[d] = (g->has_region ? g->region.to[d] : to) + at[d];
    if (flat) lower[d] = -1.0, upper[d] = 1.0;
  }
}

void bw_scene__water_gather(bw_scene *s, double dt)
{
  bw_scene__water *w = s->water;
  for (int k = 0; k < s->config.n_gauges; k++) {
    const bw_scene_gauge_config *g = &s->config.gauges[k];
    double lower[3], upper[3];
    if (!bw_scene__listed(g->of, "wall_pressure")) continue;
    look(s, g, lower, upper);
    w->patch[k] += dt * bw_ulph_wall_pressure(w->fluid, lower, upper);
  }
  w->covered += dt;
}

/* Mean since the last row, through which the sound of the fluid passes; at the start as it is. */
static double wall_pressure(const bw_scene *s, int gauge)
{
  double lower[3], upper[3];
  if (s->water->covered > 0.0) return s->water->patch[gauge] / s->water->covered;
  look(s, &s->config.gauges[gauge], lower, upper);
  return bw_ulph_wall_pressure(s->water->fluid, lower, upper);
}

/* Where there is no fluid the cell of the history stays empty. */
static double reach(const bw_scene *s, int gauge, int axis)
{
  double lower[3], upper[3];
  look(s, &s->config.gauges[gauge], lower, upper);
  const double most = bw_ulph_reach(s->water->fluid, axis, lower, upper);
  return isfinite(most) ? most : NAN;
}

static double depth(const bw_scene *s, const bw_scene_gauge_config *g)
{
  double at[3], x[3];
  bw_scene__water_where(s, at);
  for (int d = 0; d < 3; d++)
    x[d] = g->point[d] + at[d];
  return bw_ulph_depth(s->water->fluid, x, isnan(g->width) ? 2.0 * s->water->config.dx : g->width);
}

static int64_t outside(const bw_scene *s)
{
  const bw_scene_gauge_config everywhere = {.has_region = false};
  double lower[3], upper[3];
  look(s, &everywhere, lower, upper);
  return bw_ulph_outside(s->water->fluid, lower, upper);
}

/* The force on the bodies of these names: the sum over their particles. Collective. */
static bw_status force_on(bw_scene *s, const char *names, double force[3])
{
  const bw_scene__solid *q = &s->solid[0];
  double *F = NULL;
  memset(force, 0, 3 * sizeof *force);
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&F, 3 * q->n)));
  bw_coupler_particles_load(s->water->both, F);
  for (size_t i = 0; i < q->n; i++)
    if (bw_scene__listed(names, s->config.bodies[bw_scene__body_of(q, i)].name))
      for (size_t d = 0; d < 3; d++)
        force[d] += F[3 * i + d];
  bw_release(&F);
  bw_comm_sum(s->comm, 3, force);
  return BW_OK;
}

/* The book of energy, in the order of the row in the table of quantities. */
static void energies(const bw_scene *s, double depth_of_layer, double value[])
{
  const bw_ulph_ledger l = bw_ulph_account(s->water->fluid);
  const double all[] = {l.kinetic,   l.potential, l.compression, l.walls,  l.viscous, l.artificial,
                        l.diffusion, l.tension,   l.shifting,    l.ghosts, l.bodies,  l.gap};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++)
    value[k] = depth_of_layer * all[k];
}

static void work(const bw_scene *s, double value[3])
{
  if (s->water->both == NULL) return;
  const bw_coupler_particles_report r = bw_coupler_particles_measure(s->water->both);
  value[0] = r.given, value[1] = r.late, value[2] = r.received;
}

bw_status bw_scene__measure_water(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS])
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  const char *word = what->word;
  /* Forces are those of the last step. */
  if (strcmp(word, "force") == 0 && (s->steps == 0 || s->water->both == NULL)) return BW_OK;
  /* In two dimensions the fluid knows masses and forces per length across. */
  const double layer = s->planar ? s->config.thickness : 1.0;
  if (strcmp(word, "force") == 0) return force_on(s, g->body, value);
  if (strcmp(word, "depth") == 0) value[0] = depth(s, g);
  if (strcmp(word, "front") == 0) value[0] = reach(s, gauge, 0);
  if (strcmp(word, "height") == 0) value[0] = reach(s, gauge, 1);
  if (strcmp(word, "wall_pressure") == 0) value[0] = wall_pressure(s, gauge);
  if (strcmp(word, "outside") == 0) value[0] = (double)outside(s);
  if (strcmp(word, "mass") == 0) value[0] = layer * bw_ulph_account(s->water->fluid).mass;
  if (strcmp(word, "kinetic_energy") == 0)
    value[0] = layer * bw_ulph_account(s->water->fluid).kinetic;
  if (strcmp(word, "fluid_energy") == 0) energies(s, layer, value);
  if (strcmp(word, "work") == 0) work(s, value);
  if (strcmp(word, "wall_force") == 0) {
    bw_ulph_wall_force(s->water->fluid, value);
    for (int d = 0; d < 3; d++)
      value[d] *= layer;
  }
  return BW_OK;
}
