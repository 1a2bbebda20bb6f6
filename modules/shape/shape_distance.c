/* Signed distance of each kind of shape, with its gradient; shape_composed.c has that of bodies. */
#include "shape_internal.h"

#include <math.h>

const bw_shape__basis *bw_shape__basis_of(bw_shape_kind kind)
{
  static const bw_shape__basis sc = {1, {{0.0, 0.0, 0.0}}};
  static const bw_shape__basis bcc = {2, {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}}};
  static const bw_shape__basis fcc = {
      4, {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}}};
  if (kind == BW_SHAPE_PORES_SC) return &sc;
  if (kind == BW_SHAPE_PORES_BCC) return &bcc;
  return kind == BW_SHAPE_PORES_FCC ? &fcc : NULL;
}

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
  const bw_shape__basis *basis = bw_shape__basis_of(s->kind);
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

double bw_shape__beside_pores(const bw_shape *s, int dims, const double centre[3],
                              const double y[3])
{
  const bw_shape__basis *basis = bw_shape__basis_of(s->kind);
  double least = INFINITY, h[3];
  const int around[3] = {3, dims > 1 ? 3 : 1, dims > 2 ? 3 : 1};
  for (int q = 0; q < basis->count; q++)
    for (int n = 0; n < around[0] * around[1] * around[2]; n++) {
      const int step[3] = {n % 3 - 1, dims > 1 ? n / 3 % 3 - 1 : 0, dims > 2 ? n / 9 - 1 : 0};
      double z[3] = {0.0, 0.0, 0.0}, apart = 0.0;
      for (int d = 0; d < dims; d++) {
        const double from = s->centre[d] + s->pitch * basis->at[q][d];
        const double c = from + s->pitch * (round((y[d] - from) / s->pitch) + step[d]);
        z[d] = y[d] - c;
        apart = fmax(apart, fabs(c - centre[d]));
      }
      if (apart > 1e-6 * s->pitch) least = fmin(least, round_distance(z, dims, -1, s->radius, h));
    }
  return least;
}
