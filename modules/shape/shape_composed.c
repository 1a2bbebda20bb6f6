/* Signed distances of bodies: of their shapes, added and removed in order. */
#include "bw_shape_surface.h"
#include "shape_internal.h"

#include <math.h>

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
