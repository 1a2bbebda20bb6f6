/* Distances and points of a surface that is known at the voxels of a mask. */
#include "bw_memory.h"
#include "shape_field.h"

#include <math.h>
#include <string.h>

void bw_shape__field_destroy(bw_shape_field **field)
{
  if (*field == NULL) return;
  bw_release(&(*field)->away);
  bw_release(field);
}

double bw_shape__field_at(const bw_shape_field *f, const double x[3], double g[3])
{
  int64_t cell[3] = {0, 0, 0};
  double t[3] = {0.0, 0.0, 0.0}, beyond = 0.0, value = 0.0;
  for (int d = 0; d < f->dims; d++) {
    const double at = (x[d] - f->first[d]) / f->h[d], most = (double)f->n[d] - 1.0;
    const double near = fmin(fmax(at, 0.0), most);
    beyond += (at - near) * (at - near) * f->h[d] * f->h[d];
    cell[d] = (int64_t)fmin(near, most - 1.0);
    t[d] = near - (double)cell[d];
  }
  g[0] = g[1] = g[2] = 0.0;
  /* Sum over the corners of the cell: weights are products of t and 1 - t. */
  for (int c = 0; c < (f->dims == 3 ? 8 : 4); c++) {
    double weight[3] = {1.0, 1.0, 1.0}, slope[3] = {0.0, 0.0, 0.0};
    int64_t at = 0;
    for (int d = f->dims - 1; d >= 0; d--) {
      const int up = c >> d & 1;
      weight[d] = up ? t[d] : 1.0 - t[d];
      slope[d] = (up ? 1.0 : -1.0) / f->h[d];
      at = at * f->n[d] + cell[d] + up;
    }
    const double away = (double)f->away[at];
    value += weight[0] * weight[1] * weight[2] * away;
    for (int d = 0; d < f->dims; d++)
      g[d] += slope[d] * weight[(d + 1) % 3] * weight[(d + 2) % 3] * away;
  }
  const double size = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  for (int d = 0; d < 3; d++)
    g[d] = size > 0.0 ? g[d] / size : d == 0;
  return value + sqrt(beyond);
}

double bw_shape__distance_mask(const bw_shape *s, int dims, const double y[3], double g[3])
{
  (void)dims;
  if (s->mask->surface != NULL) return bw_shape__field_at(s->mask->surface, y, g);
  g[0] = g[1] = g[2] = NAN;
  return NAN;
}

/* ---- points: one for each cube of about the spacing that the surface cuts ---- */

/* A patch as a chart of one place: `centre` is it, `half` the normal there, `radius` the area. */
static void map_patch(const bw_shape__chart *c, double u, double v, double y[3], double normal[3])
{
  (void)u, (void)v;
  memcpy(y, c->centre, sizeof c->centre);
  memcpy(normal, c->half, sizeof c->half);
}

static double area_of_patch(const bw_shape__chart *c, const double u[2], const double v[2])
{
  return c->radius * (u[1] - u[0]) * (v[1] - v[0]);
}

/* What the surface leaves in a cube: its area as a vector, and the mean place of it. */
typedef struct {
  double vector[3], middle[3], area;
} patch;

/* Where the surface cuts the edge from p to q, with the values a and b of other sign. */
static void cut(const double p[3], const double q[3], double a, double b, double x[3])
{
  for (int d = 0; d < 3; d++)
    x[d] = p[d] + a / (a - b) * (q[d] - p[d]);
}

/* Adds a segment (dims 2) or a triangle that looks along `out`. */
static void add(patch *s, int dims, const double *const x[3], const double out[3])
{
  double v[3] = {0.0, 0.0, 0.0}, p[3], q[3];
  for (int d = 0; d < 3; d++) {
    p[d] = x[1][d] - x[0][d];
    q[d] = dims == 3 ? x[2][d] - x[0][d] : 0.0;
  }
  if (dims == 3)
    for (int d = 0; d < 3; d++)
      v[d] = 0.5 * (p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3]);
  else
    v[0] = p[1], v[1] = -p[0];
  const double area = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double sign = v[0] * out[0] + v[1] * out[1] + v[2] * out[2] < 0.0 ? -1.0 : 1.0;
  s->area += area;
  for (int d = 0; d < 3; d++) {
    s->vector[d] += sign * v[d];
    s->middle[d] += area * (x[0][d] + x[1][d] + (dims == 3 ? x[2][d] : 0.0)) / dims;
  }
}

/* The surface in a triangle or tetrahedron with the corners x and the values there. */
static void take_simplex(patch *s, int dims, const double x[4][3], const double value[4])
{
  int in[4], out[4], n_in = 0, n_out = 0;
  double way[3], at[4][3];
  for (int k = 0; k <= dims; k++)
    if (value[k] < 0.0)
      in[n_in++] = k;
    else
      out[n_out++] = k;
  if (n_in == 0 || n_out == 0) return;
  int n = 0;
  /* Edges from inside to outside, so that four of them go around: in0 out0, in0 out1, in1 out1,
   * in1 out0. */
  for (int a = 0; a < n_in; a++)
    for (int b = 0; b < n_out; b++) {
      const int o = out[a % 2 == 0 ? b : n_out - 1 - b];
      cut(x[in[a]], x[o], value[in[a]], value[o], at[n++]);
    }
  for (int d = 0; d < 3; d++)
    way[d] = x[out[0]][d] - x[in[0]][d];
  const double *const first[3] = {at[0], at[1], at[2]}, *const second[3] = {at[0], at[2], at[3]};
  add(s, dims, first, way);
  if (n == 4) add(s, dims, second, way);
}

/* A cube with this lower corner by Kuhn's simplices, which fit those of its neighbours: from the
 * lowest corner to the highest along the axes in every order. */
static void take_cube(const bw_shape_field *f, const double corner[3], const double h[3], patch *s)
{
  static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 0, 1}, {1, 2, 0}, {2, 1, 0}};
  double value[8], place[8][3], g[3];
  const int dims = f->dims == 3 ? 3 : 2, corners = 1 << dims;
  int negative = 0;
  for (int c = 0; c < corners; c++) {
    for (int d = 0; d < 3; d++)
      place[c][d] = corner[d] + (c >> d & 1 ? h[d] : 0.0);
    value[c] = bw_shape__field_at(f, place[c], g);
    negative += value[c] < 0.0;
  }
  if (negative == 0 || negative == corners) return;
  for (int q = 0; q < (dims == 3 ? 6 : 2); q++) {
    double x[4][3], a[4];
    int c = 0;
    for (int k = 0; k <= dims; k++) {
      memcpy(x[k], place[c], sizeof x[k]);
      a[k] = value[c];
      if (k < dims) c |= 1 << order[q][k];
    }
    take_simplex(s, dims, (const double(*)[3])x, a);
  }
}

/* The same in parts, where the surface may be: chords of a curved one are too short. */
static void take_parts(const bw_shape_field *f, const double corner[3], const double h[3], patch *s)
{
  enum { PARTS = 3 };
  double middle[3], part[3], g[3], half = 0.0;
  for (int d = 0; d < 3; d++) {
    middle[d] = corner[d] + 0.5 * h[d];
    part[d] = h[d] / PARTS;
    half += 0.25 * h[d] * h[d];
  }
  /* No place is further from the surface than from another place and that one from it; a tenth is
   * for what the distances miss. */
  if (fabs(bw_shape__field_at(f, middle, g)) > 1.1 * sqrt(half)) return;
  for (int q = 0; q < (f->dims == 3 ? PARTS * PARTS * PARTS : PARTS * PARTS); q++) {
    const double at[3] = {corner[0] + part[0] * (q % PARTS),
                          corner[1] + part[1] * (q / PARTS % PARTS),
                          corner[2] + part[2] * (q / (PARTS * PARTS))};
    take_cube(f, at, part, s);
  }
}

/* Hands the patch over: its mean place, moved onto the surface. */
static bw_status give(const bw_shape_field *f, const patch *s, bw_shape__take take, void *to)
{
  bw_shape__chart c = {.u = {0.0, 1.0},
                       .v = {0.0, 1.0},
                       .n = {1, 1},
                       .dims = f->dims,
                       .map = map_patch,
                       .area = area_of_patch};
  double g[3];
  const double *v = s->vector;
  c.radius = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  /* A sliver whose two sides look at each other has no normal, and nearly no area. */
  if (!(c.radius > 1e-3 * s->area)) return BW_OK;
  for (int d = 0; d < 3; d++) {
    c.centre[d] = s->middle[d] / s->area;
    c.half[d] = v[d] / c.radius;
  }
  const double away = bw_shape__field_at(f, c.centre, g);
  for (int d = 0; d < f->dims; d++)
    c.centre[d] -= away * g[d];
  return take(to, &c);
}

bw_status bw_shape__charts_mask(const bw_shape *s, int dims, const bw_shape__extent *e,
                                double spacing, bw_shape__take take, void *to)
{
  const bw_shape_field *f = s->mask->surface;
  double h[3] = {0.0, 0.0, 0.0}, lower[3] = {0.0, 0.0, 0.0};
  int64_t n[3] = {1, 1, 1};
  (void)e;
  BW_REQUIRE(f != NULL, BW_EINPUT,
             "surface: a mask has no smooth surface until bw_shape_mask_find_surface has found it; "
             "take its sites instead");
  for (int d = 0; d < dims; d++) {
    const double length = (double)(f->n[d] - 1) * f->h[d];
    n[d] = (int64_t)fmax(1.0, round(length / spacing));
    h[d] = length / (double)n[d];
    lower[d] = f->first[d];
  }
  for (int64_t k = 0; k < n[2]; k++)
    for (int64_t j = 0; j < n[1]; j++)
      for (int64_t i = 0; i < n[0]; i++) {
        const double corner[3] = {lower[0] + h[0] * (double)i, lower[1] + h[1] * (double)j,
                                  lower[2] + h[2] * (double)k};
        patch here = {.area = 0.0};
        take_parts(f, corner, h, &here);
        if (here.area > 0.0) BW_TRY(give(f, &here, take, to));
      }
  return BW_OK;
}
