/* Signed distances: of each kind of shape with its gradient, and of bodies. */
#include "bw_shape_surface.h"
#include "shape_internal.h"

#include <math.h>

/* Distance from a point or an axis, less the radius; the gradient leads away from it. */
static double round_distance(const double z[3], int dims, int skip, double radius, double g[3])
{
  double squared = 0.0;
  for (int d = 0; d < 3; d++)
    if (d < dims && d != skip) squared += z[d] * z[d];
  const double r = sqrt(squared);
  for (int d = 0; d < 3; d++)
    g[d] = d < dims && d != skip && r > 0.0 ? z[d] / r : 0.0;
  if (r == 0.0) g[skip == 0 ? 1 : 0] = 1.0; /* any direction is as good */
  return r - radius;
}

double bw_shape__distance_sphere(const bw_shape *s, int dims, const double y[3], double g[3])
{
  const double z[3] = {y[0] - s->centre[0], y[1] - s->centre[1], y[2] - s->centre[2]};
  return round_distance(z, dims, -1, s->radius, g);
}

double bw_shape__distance_cylinder(const bw_shape *s, int dims, const double y[3], double g[3])
{
  const double z[3] = {y[0] - s->centre[0], y[1] - s->centre[1], y[2] - s->centre[2]};
  return round_distance(z, dims, s->axis, s->radius, g);
}

double bw_shape__distance_box(const bw_shape *s, int dims, const double y[3], double g[3])
{
  double squared = 0.0, most = -INFINITY, out[3] = {0.0, 0.0, 0.0};
  int face = 0;
  for (int d = 0; d < dims; d++) {
    const double z = y[d] - 0.5 * (s->lower[d] + s->upper[d]);
    const double beyond = fabs(z) - 0.5 * (s->upper[d] - s->lower[d]);
    g[d] = 0.0;
    if (beyond > most) most = beyond, face = d;
    if (beyond > 0.0) out[d] = copysign(beyond, z), squared += beyond * beyond;
  }
  /* Inside, the nearest face decides; outside, the nearest point of face, edge or corner. */
  for (int d = 0; d < 3; d++)
    g[d] = squared > 0.0 ? out[d] / sqrt(squared) : 0.0;
  if (!(squared > 0.0)) {
    g[face] = copysign(1.0, y[face] - 0.5 * (s->lower[face] + s->upper[face]));
    return most;
  }
  return sqrt(squared);
}

/* The nearest pore of the lattice: that of the nearest image of each basis point. */
double bw_shape__distance_pores(const bw_shape *s, int dims, const double y[3], double g[3])
{
  const bw_shape__basis *basis = bw_shape__rows[s->kind].basis;
  double least = INFINITY;
  for (int q = 0; q < basis->count; q++) {
    double z[3] = {0.0, 0.0, 0.0}, h[3];
    for (int d = 0; d < dims; d++) {
      const double t = (y[d] - s->centre[d]) / s->pitch - basis->at[q][d];
      z[d] = (t - round(t)) * s->pitch;
    }
    const double here = round_distance(z, dims, -1, s->radius, h);
    if (here >= least) continue;
    least = here;
    for (int d = 0; d < 3; d++)
      g[d] = h[d];
  }
  return least;
}

double bw_shape__distance_mask(const bw_shape *s, int dims, const double y[3], double g[3])
{
  (void)s, (void)dims, (void)y;
  g[0] = g[1] = g[2] = NAN;
  return NAN;
}

double bw_shape__distance(const bw_shape *s, int dims, const double x[3], double g[3])
{
  double y[3], h[3];
  const double sign = s->outside ? -1.0 : 1.0;
  const double own = bw_shape__rows[s->kind].distance(s, dims, bw_shape__own(s, x, y), h);
  for (int d = 0; d < 3; d++) {
    g[d] = sign * h[d];
    if (s->frame == NULL) continue;
    g[d] = 0.0;
    for (int a = 0; a < 3; a++)
      g[d] += sign * h[a] * s->frame->axes[a][d];
  }
  return sign * own;
}

double bw_shape__composed(int count, const bw_shape shape[], int dims, const double x[3],
                          double g[3])
{
  double distance = INFINITY, h[3];
  g[0] = g[1] = g[2] = 0.0;
  for (int q = 0; q < count; q++) {
    const double sign = shape[q].remove ? -1.0 : 1.0;
    const double d = sign * bw_shape__distance(&shape[q], dims, x, h);
    const bool decides = shape[q].remove ? d > distance : d < distance;
    if (!decides && !isnan(d)) continue;
    distance = d;
    for (int k = 0; k < 3; k++)
      g[k] = sign * h[k];
    if (isnan(d)) break;
  }
  return distance;
}

/* The composition, and the ends of what is endless: where the other shapes that are added end. */
static double of_body(int count, const bw_shape shape[], int dims, const double x[3], double g[3])
{
  double distance = bw_shape__composed(count, shape, dims, x, g);
  bool endless = false, cut[3];
  for (int q = 0; q < count; q++)
    endless = endless || (!shape[q].remove && bw_shape__rows[shape[q].kind].endless) ||
              (!shape[q].remove && shape[q].outside);
  if (!endless) return distance;
  bw_shape__extent space;
  bw_shape__space(count, shape, dims, &space, cut);
  for (int d = 0; d < dims; d++) {
    if (!cut[d] || !isfinite(space.lower[d])) continue;
    const double below = space.lower[d] - x[d], above = x[d] - space.upper[d];
    if (!(fmax(below, above) > distance)) continue;
    distance = fmax(below, above);
    g[0] = g[1] = g[2] = 0.0;
    g[d] = above > below ? 1.0 : -1.0;
  }
  return distance;
}

double bw_shape_distance(int count, const bw_shape shape[], bool planar, const double x[3])
{
  double g[3];
  return of_body(count, shape, planar ? 2 : 3, x, g);
}

void bw_shape_normal(int count, const bw_shape shape[], bool planar, const double x[3],
                     double normal[3])
{
  (void)of_body(count, shape, planar ? 2 : 3, x, normal);
}
