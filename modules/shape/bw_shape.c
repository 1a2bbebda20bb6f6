#include "bw_shape.h"
#include "bw_memory.h"
#include <math.h>
#include <string.h>

/* Ties (a centre exactly on a surface) must not depend on rounding, or mirrored bodies would
 * not be mirror images: the surface is moved by this part of ds (boxes) or radius (balls). */
static const double TIE = 1e-9;

/* Where a shape may be; an endless direction is -INFINITY .. INFINITY. */
typedef struct {
  double lower[3], upper[3];
} extent;

typedef struct {
  const char *name;
  bool (*inside)(const bw_shape *s, int dims, double tie, const double x[3]);
  extent (*bounds)(const bw_shape *s);
  bool needs_box, needs_radius, needs_pitch, needs_axis, needs_mask;
} shape_row;

/* Half-open, so that a box of n ds holds n sites and two that touch share none. */
static bool inside_box(const bw_shape *s, int dims, double tie, const double x[3])
{
  bool in = true;
  for (int d = 0; d < dims; d++)
    in = in && x[d] >= s->lower[d] - tie && x[d] < s->upper[d] - tie;
  return in;
}

static extent bounds_box(const bw_shape *s)
{
  extent e;
  memcpy(e.lower, s->lower, sizeof e.lower);
  memcpy(e.upper, s->upper, sizeof e.upper);
  return e;
}

static bool within_radius(const bw_shape *s, double squared)
{
  return squared <= s->radius * s->radius * (1.0 + TIE);
}

static bool inside_sphere(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  double squared = 0.0;
  for (int d = 0; d < dims; d++)
    squared += (x[d] - s->centre[d]) * (x[d] - s->centre[d]);
  return within_radius(s, squared);
}

/* A hair more than the ball, so that the half-open range of sites keeps its poles. */
static extent bounds_sphere(const bw_shape *s)
{
  const double reach = s->radius * (1.0 + 1e3 * TIE);
  extent e;
  for (int d = 0; d < 3; d++)
    e.lower[d] = s->centre[d] - reach, e.upper[d] = s->centre[d] + reach;
  return e;
}

static bool inside_cylinder(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  double squared = 0.0;
  for (int d = 0; d < dims; d++)
    if (d != s->axis) squared += (x[d] - s->centre[d]) * (x[d] - s->centre[d]);
  return within_radius(s, squared);
}

static extent bounds_cylinder(const bw_shape *s)
{
  extent e = bounds_sphere(s);
  e.lower[s->axis] = -INFINITY;
  e.upper[s->axis] = INFINITY;
  return e;
}

/* Pores of one cubic lattice: basis (count,3) in units of the pitch. The nearest image of each
 * basis point is enough, also where pores overlap. */
static bool inside_pores(const bw_shape *s, int dims, int count, const double basis[][3],
                         const double x[3])
{
  bool in = false;
  for (int q = 0; q < count; q++) {
    double squared = 0.0;
    for (int d = 0; d < dims; d++) {
      double z = (x[d] - s->centre[d]) / s->pitch - basis[q][d];
      z -= round(z);
      squared += z * z * s->pitch * s->pitch;
    }
    in = in || within_radius(s, squared);
  }
  return in;
}

static bool inside_sc(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  static const double basis[1][3] = {{0.0, 0.0, 0.0}};
  return inside_pores(s, dims, 1, basis, x);
}

static bool inside_bcc(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  static const double basis[2][3] = {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}};
  return inside_pores(s, dims, 2, basis, x);
}

static bool inside_fcc(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  static const double basis[4][3] = {
      {0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}};
  return inside_pores(s, dims, 4, basis, x);
}

static extent bounds_endless(const bw_shape *s)
{
  (void)s;
  const extent e = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
  return e;
}

static bool inside_mask(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  return bw_shape_mask_at(s->mask, dims, x);
}

static extent bounds_mask(const bw_shape *s)
{
  extent e;
  for (int d = 0; d < 3; d++) {
    e.lower[d] = s->mask->lower[d];
    e.upper[d] = s->mask->lower[d] + s->mask->spacing[d] * (double)s->mask->size[d];
  }
  return e;
}

static const shape_row rows[BW_SHAPE_COUNT] = {
    [BW_SHAPE_BOX] = {"box", inside_box, bounds_box, .needs_box = true},
    [BW_SHAPE_SPHERE] = {"sphere", inside_sphere, bounds_sphere, .needs_radius = true},
    [BW_SHAPE_CYLINDER] = {"cylinder", inside_cylinder, bounds_cylinder, .needs_radius = true,
                           .needs_axis = true},
    [BW_SHAPE_PORES_SC] = {"pores_sc", inside_sc, bounds_endless, .needs_radius = true,
                           .needs_pitch = true},
    [BW_SHAPE_PORES_BCC] = {"pores_bcc", inside_bcc, bounds_endless, .needs_radius = true,
                            .needs_pitch = true},
    [BW_SHAPE_PORES_FCC] = {"pores_fcc", inside_fcc, bounds_endless, .needs_radius = true,
                            .needs_pitch = true},
    [BW_SHAPE_MASK] = {"mask", inside_mask, bounds_mask, .needs_mask = true},
};

const char *bw_shape_name(bw_shape_kind kind)
{
  return (unsigned)kind < BW_SHAPE_COUNT ? rows[kind].name : "unknown";
}

static bw_status check_shape(int number, const bw_shape *s, int dims)
{
  BW_REQUIRE((unsigned)s->kind < BW_SHAPE_COUNT, BW_EINPUT,
             "shape %d: kind %d is none of the %d shapes there are", number, (int)s->kind,
             (int)BW_SHAPE_COUNT);
  const shape_row *row = &rows[s->kind];
  for (int d = 0; d < dims; d++) {
    if (row->needs_box)
      BW_REQUIRE(isfinite(s->lower[d]) && isfinite(s->upper[d]) && s->upper[d] > s->lower[d],
                 BW_EINPUT,
                 "shape %d (%s): lower[%d] = %g has to be below upper[%d] = %g, both finite",
                 number, row->name, d, s->lower[d], d, s->upper[d]);
    else
      BW_REQUIRE(isfinite(s->centre[d]), BW_EINPUT, "shape %d (%s): centre[%d] = %g is not finite",
                 number, row->name, d, s->centre[d]);
  }
  if (row->needs_radius)
    BW_REQUIRE(isfinite(s->radius) && s->radius > 0.0, BW_EINPUT,
               "shape %d (%s): radius = %g has to be positive and finite", number, row->name,
               s->radius);
  if (row->needs_pitch)
    BW_REQUIRE(isfinite(s->pitch) && s->pitch > 0.0, BW_EINPUT,
               "shape %d (%s): pitch = %g has to be positive and finite", number, row->name,
               s->pitch);
  if (row->needs_mask)
    BW_REQUIRE(s->mask != NULL, BW_EINPUT, "shape %d (%s): mask is missing", number, row->name);
  if (row->needs_axis)
    BW_REQUIRE(s->axis >= 0 && s->axis <= 2, BW_EINPUT,
               "shape %d (%s): axis = %d has to be 0, 1 or 2", number, row->name, s->axis);
  return BW_OK;
}

/* Sites lo[d] <= site[d] < hi[d] that can be solid: the union of the finite extents of what is
 * added; an endless shape ends where the others end. */
static bw_status site_range(int count, const bw_shape shape[], double ds, const double origin[3],
                            int dims, int64_t lo[3], int64_t hi[3])
{
  for (int d = 0; d < dims; d++) {
    double lower = INFINITY, upper = -INFINITY;
    for (int q = 0; q < count; q++) {
      const extent e = rows[shape[q].kind].bounds(&shape[q]);
      if (shape[q].remove || shape[q].outside || !isfinite(e.lower[d])) continue;
      lower = fmin(lower, e.lower[d]);
      upper = fmax(upper, e.upper[d]);
    }
    BW_REQUIRE(upper > lower, BW_EINPUT,
               "shapes: nothing that is added ends in direction %d; add a box to cut from", d);
    const double a = ceil((lower - origin[d]) / ds - 0.5 - TIE);
    const double b = ceil((upper - origin[d]) / ds - 0.5 - TIE);
    BW_REQUIRE(a > (double)INT32_MIN && b < (double)INT32_MAX, BW_EINPUT,
               "shapes: %g .. %g in direction %d is more than 2^31 sites of ds = %g", lower, upper,
               d, ds);
    lo[d] = (int64_t)a;
    hi[d] = (int64_t)b;
  }
  if (dims == 2) lo[2] = 0, hi[2] = 1;
  return BW_OK;
}

/* Is the site solid, and of which particle kind? The last shape that holds it decides. */
static bool solid_at(int count, const bw_shape shape[], int dims, double tie, const double x[3],
                     uint8_t *kind)
{
  bool solid = false;
  for (int q = 0; q < count; q++) {
    if (shape[q].remove && !solid) continue; /* nothing there to take away */
    if (rows[shape[q].kind].inside(&shape[q], dims, tie, x) == shape[q].outside) continue;
    solid = !shape[q].remove;
    *kind = shape[q].particle_kind;
  }
  return solid;
}

/* Count the solid sites, and write them when site is not NULL. */
static int64_t scan(int count, const bw_shape shape[], double ds, const double origin[3], int dims,
                    const int64_t lo[3], const int64_t hi[3], int32_t *site, uint8_t *kind)
{
  int64_t n = 0;
  double x[3] = {0.0, 0.0, 0.0};
  for (int64_t k = lo[2]; k < hi[2]; k++)
    for (int64_t j = lo[1]; j < hi[1]; j++)
      for (int64_t i = lo[0]; i < hi[0]; i++) {
        const int64_t at[3] = {i, j, k};
        for (int d = 0; d < dims; d++)
          x[d] = origin[d] + ((double)at[d] + 0.5) * ds;
        uint8_t what = 0;
        if (!solid_at(count, shape, dims, TIE * ds, x, &what)) continue;
        if (site != NULL) {
          for (int d = 0; d < 3; d++)
            site[3 * n + d] = (int32_t)at[d];
          kind[n] = what;
        }
        n++;
      }
  return n;
}

bw_status bw_shape_fill(int count, const bw_shape shape[], double ds, const double origin[3],
                        bool planar, int64_t *n, int32_t **site, uint8_t **kind)
{
  *n = 0;
  *site = NULL;
  *kind = NULL;
  const int dims = planar ? 2 : 3;
  BW_REQUIRE(isfinite(ds) && ds > 0.0, BW_EINPUT, "shapes: ds = %g has to be positive", ds);
  BW_REQUIRE(count > 0, BW_EINPUT, "shapes: the list is empty; a body needs one at least");
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(isfinite(origin[d]), BW_EINPUT, "shapes: origin[%d] = %g is not finite", d,
               origin[d]);
  for (int q = 0; q < count; q++)
    BW_TRY(check_shape(q, &shape[q], dims));
  int64_t lo[3], hi[3];
  BW_TRY(site_range(count, shape, ds, origin, dims, lo, hi));
  const int64_t found = scan(count, shape, ds, origin, dims, lo, hi, NULL, NULL);
  BW_REQUIRE(found > 0, BW_EINPUT,
             "shapes: no site of spacing %g is inside the body; it is thinner than ds or all of "
             "it was removed",
             ds);
  bw_status st = BW_ALLOCATE(site, 3 * (size_t)found);
  BW_THEN(st, BW_ALLOCATE(kind, (size_t)found));
  if (st != BW_OK) {
    bw_release(site);
    return st;
  }
  *n = scan(count, shape, ds, origin, dims, lo, hi, *site, *kind);
  return BW_OK;
}
