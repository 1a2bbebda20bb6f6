/* What gauges see of the fluid: values at places, forces on bodies, sums over the box. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

/* Index (global) of the last point at or below x of a line of points, and the part of the way to
 * the next. `face`: points are on faces i dx, else on centres (i - 1/2) dx. */
static int below(const bw_grid_view *g, int d, bool face, double x, double *part)
{
  if (d != 1 || g->uniform_y) {
    const double at = x / g->spacing[d] + (face ? 0.0 : 0.5), i = floor(at);
    *part = at - i;
    return (int)i;
  }
  const double *y = face ? g->y_face : g->y_centre;
  int i = face ? 0 : -1;
  while (i < g->n[1] && y[i + 1] <= x)
    i++;
  *part = (x - y[i]) / (y[i + 1] - y[i]);
  return i;
}

/* Linear in each direction between the points of a field; component 0 .. 2 on its faces, 3 on
 * centres. On the rank that owns the cell. */
static double at_place(const bw_scene *s, int component, const double x[3])
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  const bw_real *f = component < 3 ? bw_ns_channel_velocity(s->fluid)[component]
                                   : bw_ns_channel_pressure(s->fluid);
  int i[3];
  double part[3], value = 0.0;
  if (f == NULL) return 0.0;
  for (int d = 0; d < 3; d++) {
    i[d] = 1, part[d] = 0.0;
    if (g->n[d] > 1) i[d] = below(g, d, component == d, x[d], &part[d]) - g->lo[d];
    /* One layer of halo is all that there has to be. */
    const int least = g->n[d] > 1 ? 0 : 1;
    i[d] = i[d] < least ? least : i[d] > g->m[d] ? g->m[d] : i[d];
  }
  for (int corner = 0; corner < 8; corner++) {
    double weight = 1.0;
    int at[3];
    for (int d = 0; d < 3; d++) {
      const int up = corner >> d & 1;
      weight *= up ? part[d] : 1.0 - part[d];
      at[d] = i[d] + (g->n[d] > 1 ? up : 0);
    }
    if (weight != 0.0) value += weight * (double)f[bw_at(g, at[0], at[1], at[2])];
  }
  return value;
}

void bw_scene__sample(bw_scene *s, bool pressure, size_t n, const double x[], double value[])
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  const size_t width = pressure ? 1 : 3;
  const double rho = s->config.fluid.density, drive = bw_ns_channel_driving(s->fluid);
  memset(value, 0, width * n * sizeof *value);
  for (size_t q = 0; q < n; q++) {
    double at[3], inside[3];
    for (int d = 0; d < 3; d++) {
      at[d] = fmin(fmax(x[3 * q + (size_t)d], 0.0), g->length[d]);
      if (g->n[d] == 1) at[d] = 0.5 * g->length[d];
      /* The upper face of the box belongs to the last cell. */
      inside[d] = fmin(at[d], g->length[d] * (1.0 - 1e-12));
    }
    if (bw_grid_owner(s->grid, inside) != bw_comm_rank(s->comm)) continue;
    if (pressure) /* with the gradient that drives the flow, which the field is without */
      value[q] = rho * (at_place(s, 3, at) - drive * at[s->flow.forcing_axis]);
    else
      for (int k = 0; k < 3; k++)
        value[3 * q + (size_t)k] = at_place(s, k, at);
  }
  bw_comm_sum(s->comm, width * n, value);
}

static void point_value(bw_scene *s, const bw_scene_gauge_config *g, bool pressure, double value[3])
{
  double other[3] = {0};
  bw_scene__sample(s, pressure, 1, g->point, value);
  if (bw_scene__given(g->minus)) bw_scene__sample(s, pressure, 1, g->minus, other);
  for (int k = 0; k < (pressure ? 1 : 3); k++)
    value[k] -= other[k];
}

bw_status bw_scene__warn_leak(bw_scene *s)
{
  bw_coupler_report r;
  if (s->coupler == NULL) return BW_OK;
  BW_TRY(bw_coupler_measure(s->coupler, &r));
  bw_coupler_warn_slip(s->coupler, &r, s->log);
  bw_coupler_warn_end(s->coupler, s->log);
  return BW_OK;
}

/* Forces of the coupler, on all that is in the flow. Collective. */
static bw_status coupled_force(bw_scene *s, double value[BW_SCENE__COMPONENTS])
{
  bw_coupler_report r;
  BW_TRY(bw_coupler_measure(s->coupler, &r));
  bw_coupler_warn_slip(s->coupler, &r, s->log);
  for (int d = 0; d < 3; d++) {
    value[d] = r.force_reaction[d];
    value[3 + d] = r.force_probe[d];
    value[6 + d] = r.force_control_volume[d];
  }
  return BW_OK;
}

/* Of the coupler, on the bodies that a gauge names, by the route that loads them. Collective. */
static bw_status some_force(bw_scene *s, const bw_scene_gauge_config *g,
                            double value[BW_SCENE__COMPONENTS])
{
  const bw_scene__solid *q = &s->solid[0];
  bool *on = NULL;
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&on, q->n)));
  for (size_t i = 0; i < q->n; i++)
    on[i] = bw_scene__listed(g->body, s->config.bodies[bw_scene__body_of(q, i)].name);
  const int route =
      s->config.numerics.load == BW_LOAD_PROBES ? BW_SCENE__BY_PROBES : BW_SCENE__BY_REACTION;
  const bw_status st = bw_coupler_force_on(s->coupler, on, value + 3 * (ptrdiff_t)route);
  bw_release(&on);
  return st;
}

/* Of the flow along each axis, in the region or the whole box; empty along an axis in which nothing
 * but rounding flows. Collective. */
static void tortuosity(bw_scene *s, const bw_scene_gauge_config *g, double value[3])
{
  static const double origin[3] = {0};
  const double *lower = g->has_region ? g->region.from : origin;
  double upper[3];
  memcpy(upper, g->has_region ? g->region.to : s->config.domain.length, sizeof upper);
  if (s->planar) upper[2] = s->config.domain.length[2];
  for (int axis = 0; axis < (s->planar ? 2 : 3); axis++)
    value[axis] = bw_ns_channel_tortuosity(s->fluid, axis, lower, upper);
  for (int axis = 0; axis < 3; axis++)
    if (fabs(value[axis]) > 1e6) value[axis] = NAN;
}

/* Least gap of a film in the last step, empty where there is none; or what films have taken.
 * Collective. */
static double film_value(const bw_scene *s, bool of_gap)
{
  double energy = 0.0, gap = INFINITY;
  if (s->coupler != NULL) {
    energy += bw_coupler_film_energy(s->coupler);
    gap = fmin(gap, bw_coupler_film_gap(s->coupler));
  }
  if (s->floats != NULL) {
    energy += bw_coupler_rigid_film_energy(s->floats);
    gap = fmin(gap, bw_coupler_rigid_film_gap(s->floats));
  }
  if (!of_gap) return energy;
  return isinf(gap) ? NAN : gap;
}

bw_status bw_scene__measure_fluid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS])
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  if (what->source == BW_SCENE__OF_POINT) {
    point_value(s, g, what->n == 1, value);
    return BW_OK;
  }
  /* Forces are those of the last step. */
  if (strcmp(what->word, "force") == 0 && s->steps == 0) return BW_OK;
  if (strcmp(what->word, "force") == 0 && bw_scene__some_of_coupled(&s->config, g))
    return some_force(s, g, value);
  if (strcmp(what->word, "force") == 0)
    return s->coupler != NULL ? coupled_force(s, value)
                              : bw_scene__surface_force(s, g->body, value);
  if (strcmp(what->word, "tortuosity") == 0) {
    tortuosity(s, g, value);
    return BW_OK;
  }
  if (strncmp(what->word, "film_", 5) == 0) {
    value[0] = film_value(s, strcmp(what->word, "film_gap") == 0);
    return BW_OK;
  }
  if (strcmp(what->word, "divergence") == 0) {
    value[0] = bw_ns_channel_divergence(s->fluid);
    return BW_OK;
  }
  const bw_ns_summary all = bw_ns_channel_summary(s->fluid);
  if (strcmp(what->word, "flow_rate") == 0)
    value[0] = all.inflow, value[1] = all.outflow;
  else if (strcmp(what->word, "bulk_velocity") == 0)
    value[0] = all.bulk_velocity;
  else
    value[0] = s->config.fluid.density * all.kinetic_energy;
  return BW_OK;
}
