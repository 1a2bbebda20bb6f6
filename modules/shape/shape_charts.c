/* The surface of each kind of shape, in pieces over rectangles of two parameters. */
#include "shape_internal.h"

#include <math.h>

typedef bw_shape__chart chart;

static const double PI = 3.14159265358979323846;

static int pieces(double length, double spacing, int least)
{
  return (int)fmax(least, fmin(round(length / spacing), 1e6));
}

/* ---- boxes: u and v along the two other axes, from the middle of the face ---- */

static void map_face(const chart *c, double u, double v, double y[3], double normal[3])
{
  const int a = c->axis == 0 ? 1 : 0, b = c->axis == 2 ? 1 : 2;
  for (int d = 0; d < 3; d++)
    y[d] = c->centre[d], normal[d] = 0.0;
  y[c->axis] += c->side * c->half[c->axis];
  y[a] += u;
  if (c->dims == 3) y[b] += v;
  normal[c->axis] = c->side;
}

static double area_of_face(const chart *c, const double u[2], const double v[2])
{
  return (u[1] - u[0]) * (c->dims == 3 ? v[1] - v[0] : 1.0);
}

bw_status bw_shape__charts_box(const bw_shape *s, int dims, const bw_shape__extent *e,
                               double spacing, bw_shape__take take, void *to)
{
  (void)e;
  chart c = {.dims = dims, .map = map_face, .area = area_of_face};
  for (int d = 0; d < dims; d++) {
    c.centre[d] = 0.5 * (s->lower[d] + s->upper[d]);
    c.half[d] = 0.5 * (s->upper[d] - s->lower[d]);
  }
  for (int face = 0; face < 2 * dims; face++) {
    c.axis = face / 2;
    c.side = face % 2 == 0 ? -1.0 : 1.0;
    const int a = c.axis == 0 ? 1 : 0, b = c.axis == 2 ? 1 : 2;
    c.u[0] = -c.half[a], c.u[1] = c.half[a];
    c.v[0] = -c.half[b], c.v[1] = c.half[b];
    c.n[0] = pieces(2.0 * c.half[a], spacing, 1);
    c.n[1] = dims == 3 ? pieces(2.0 * c.half[b], spacing, 1) : 1;
    BW_TRY(take(to, &c));
  }
  return BW_OK;
}

/* ---- balls: u the angle from the z axis, v around it; in 2D u around the centre ---- */

static void map_ball(const chart *c, double u, double v, double y[3], double normal[3])
{
  normal[0] = c->dims == 3 ? sin(u) * cos(v) : cos(u);
  normal[1] = c->dims == 3 ? sin(u) * sin(v) : sin(u);
  normal[2] = c->dims == 3 ? cos(u) : 0.0;
  for (int d = 0; d < 3; d++)
    y[d] = c->centre[d] + c->radius * normal[d];
}

static double area_of_ball(const chart *c, const double u[2], const double v[2])
{
  if (c->dims == 2) return c->radius * (u[1] - u[0]);
  return c->radius * c->radius * (cos(u[0]) - cos(u[1])) * (v[1] - v[0]);
}

static bw_status ball(const double centre[3], double radius, int dims, double spacing,
                      bw_shape__take take, void *to)
{
  chart c = {.dims = dims, .radius = radius, .map = map_ball, .area = area_of_ball};
  for (int d = 0; d < dims; d++)
    c.centre[d] = centre[d];
  c.n[0] = c.n[1] = 1;
  if (dims == 2) {
    c.u[1] = 2.0 * PI, c.v[1] = 1.0;
    c.n[0] = pieces(2.0 * PI * radius, spacing, 4);
    return take(to, &c);
  }
  /* Bands of equal width, each in as many patches as go around it. */
  const int bands = pieces(PI * radius, spacing, 2);
  c.v[1] = 2.0 * PI;
  for (int q = 0; q < bands; q++) {
    c.u[0] = PI * q / bands;
    c.u[1] = PI * (q + 1) / bands;
    c.n[1] = pieces(2.0 * PI * radius * sin(0.5 * (c.u[0] + c.u[1])), spacing, 3);
    BW_TRY(take(to, &c));
  }
  return BW_OK;
}

bw_status bw_shape__charts_sphere(const bw_shape *s, int dims, const bw_shape__extent *e,
                                  double spacing, bw_shape__take take, void *to)
{
  (void)e;
  return ball(s->centre, s->radius, dims, spacing, take, to);
}

/* All pores that reach into the extent. */
bw_status bw_shape__charts_pores(const bw_shape *s, int dims, const bw_shape__extent *e,
                                 double spacing, bw_shape__take take, void *to)
{
  const bw_shape__basis *basis = bw_shape__basis_of(s->kind);
  for (int q = 0; q < basis->count; q++) {
    double lo[3] = {0.0, 0.0, 0.0}, hi[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dims; d++) {
      lo[d] = ceil((e->lower[d] - s->radius - s->centre[d]) / s->pitch - basis->at[q][d]);
      hi[d] = floor((e->upper[d] + s->radius - s->centre[d]) / s->pitch - basis->at[q][d]);
    }
    for (double k = lo[2]; k <= hi[2]; k++)
      for (double j = lo[1]; j <= hi[1]; j++)
        for (double i = lo[0]; i <= hi[0]; i++) {
          const double cell[3] = {i, j, k};
          double centre[3] = {0.0, 0.0, 0.0};
          for (int d = 0; d < dims; d++)
            centre[d] = s->centre[d] + s->pitch * (cell[d] + basis->at[q][d]);
          BW_TRY(ball(centre, s->radius, dims, spacing, take, to));
        }
  }
  return BW_OK;
}

/* ---- cylinders: u along the axis, v around it ---- */

static void map_tube(const chart *c, double u, double v, double y[3], double normal[3])
{
  const int a = (c->axis + 1) % 3, b = (c->axis + 2) % 3;
  normal[c->axis] = 0.0;
  normal[a] = cos(v);
  normal[b] = sin(v);
  y[c->axis] = u;
  y[a] = c->centre[a] + c->radius * normal[a];
  y[b] = c->centre[b] + c->radius * normal[b];
}

static double area_of_tube(const chart *c, const double u[2], const double v[2])
{
  return c->radius * (u[1] - u[0]) * (v[1] - v[0]);
}

bw_status bw_shape__charts_cylinder(const bw_shape *s, int dims, const bw_shape__extent *e,
                                    double spacing, bw_shape__take take, void *to)
{
  if (dims == 2) {
    BW_REQUIRE(s->axis == 2, BW_EINPUT,
               "surface: a planar body needs its cylinders along z, one is along axis %d", s->axis);
    return ball(s->centre, s->radius, dims, spacing, take, to);
  }
  chart c = {.dims = dims,
             .axis = s->axis,
             .radius = s->radius,
             .centre = {s->centre[0], s->centre[1], s->centre[2]},
             .u = {e->lower[s->axis], e->upper[s->axis]},
             .v = {0.0, 2.0 * PI},
             .map = map_tube,
             .area = area_of_tube};
  c.n[0] = pieces(c.u[1] - c.u[0], spacing, 1);
  c.n[1] = pieces(2.0 * PI * s->radius, spacing, 4);
  return take(to, &c);
}
