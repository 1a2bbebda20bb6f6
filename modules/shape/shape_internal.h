/* shape_internal.h -- shared by the sources of the module: the table of shapes, masks in making. */
#pragma once
#include "bw_shape.h"
#include "bw_shape_mask.h"

/* Ties (a centre exactly on a surface) must not depend on rounding, or mirrored bodies would
 * not be mirror images: the surface is moved by this part of ds (boxes) or radius (balls). */
#define BW_SHAPE__TIE 1e-9

/* Where a shape may be; an endless direction is -INFINITY .. INFINITY. */
typedef struct {
  double lower[3], upper[3];
} bw_shape__extent;

/* Pores in one cell of a cubic lattice: at (count,3), in units of the pitch. */
typedef struct {
  int count;
  double at[4][3];
} bw_shape__basis;

/* A piece of a shape's surface over a rectangle of parameters u, v, in n[0] x n[1] patches; in 2D
 * it is a line along u, and v is ignored. All in the shape's own frame. */
typedef struct bw_shape__chart {
  double u[2], v[2];                 /* first and last value */
  int n[2];                          /* patches */
  double centre[3], half[3], radius; /* of the shape, as far as `map` and `area` use them */
  int axis;                          /* box: of the face's normal; cylinder: its own */
  double side;                       /* box: +1 for the upper of two faces, -1 */
  int dims;
  /* The place y (3) of (u, v) and the normal (3) there, out of the shape. */
  void (*map)(const struct bw_shape__chart *c, double u, double v, double y[3], double normal[3]);
  /* The exact area between u[0] and u[1], v[0] and v[1]. */
  double (*area)(const struct bw_shape__chart *c, const double u[2], const double v[2]);
} bw_shape__chart;

/* Receives charts; `to` is its own. */
typedef bw_status (*bw_shape__take)(void *to, const bw_shape__chart *c);

/* A kind of shape: x (3) is in the shape's own frame, `tie` a length. */
typedef struct {
  const char *name;
  bool (*inside)(const bw_shape *s, int dims, double tie, const double x[3]);
  bw_shape__extent (*bounds)(const bw_shape *s);
  /* Signed distance of x and its gradient g (3), a unit vector. */
  double (*distance)(const bw_shape *s, int dims, const double x[3], double g[3]);
  /* The surface within the extent `e` (endless ones end there) in patches of about `spacing`. */
  bw_status (*charts)(const bw_shape *s, int dims, const bw_shape__extent *e, double spacing,
                      bw_shape__take take, void *to);
  bool needs_box, needs_radius, needs_pitch, needs_axis, needs_mask;
  bool endless; /* in some direction */
} bw_shape__row;
extern const bw_shape__row bw_shape__rows[BW_SHAPE_COUNT];

/* Where the pores of a cell are, of a kind that has a pitch; NULL for the others. */
const bw_shape__basis *bw_shape__basis_of(bw_shape_kind kind);

double bw_shape__distance_box(const bw_shape *s, int dims, const double x[3], double g[3]);
double bw_shape__distance_sphere(const bw_shape *s, int dims, const double x[3], double g[3]);
double bw_shape__distance_cylinder(const bw_shape *s, int dims, const double x[3], double g[3]);
double bw_shape__distance_pores(const bw_shape *s, int dims, const double x[3], double g[3]);
/* Of y, in the shape's own frame, from the nearest pore but that at `centre`; negative inside. */
double bw_shape__beside_pores(const bw_shape *s, int dims, const double centre[3],
                              const double y[3]);
double bw_shape__distance_mask(const bw_shape *s, int dims, const double x[3], double g[3]);
bw_status bw_shape__charts_box(const bw_shape *s, int dims, const bw_shape__extent *e,
                               double spacing, bw_shape__take take, void *to) BW_MUST_CHECK;
bw_status bw_shape__charts_sphere(const bw_shape *s, int dims, const bw_shape__extent *e,
                                  double spacing, bw_shape__take take, void *to) BW_MUST_CHECK;
bw_status bw_shape__charts_cylinder(const bw_shape *s, int dims, const bw_shape__extent *e,
                                    double spacing, bw_shape__take take, void *to) BW_MUST_CHECK;
bw_status bw_shape__charts_pores(const bw_shape *s, int dims, const bw_shape__extent *e,
                                 double spacing, bw_shape__take take, void *to) BW_MUST_CHECK;
bw_status bw_shape__charts_mask(const bw_shape *s, int dims, const bw_shape__extent *e,
                                double spacing, bw_shape__take take, void *to) BW_MUST_CHECK;

/* Signed distance of one shape (`outside` counts, `remove` does not) and its gradient g (3) at x in
 * space, and of what shapes make together without ends for the endless ones. Local. */
double bw_shape__distance(const bw_shape *s, int dims, const double x[3], double g[3]);
double bw_shape__composed(int count, const bw_shape shape[], int dims, const double x[3],
                          double g[3]);

/* BW_EINPUT names the shape by `number`. Local. */
bw_status bw_shape__check(int number, const bw_shape *s, int dims) BW_MUST_CHECK;

/* Are the rows of axes orthonormal and right-handed, and in 2D a turn about z? `what` names them.
 * Local. */
bw_status bw_shape__check_axes(const char *what, const double axes[3][3], int dims) BW_MUST_CHECK;

/* The extent in space, a hair too large where the shape has a frame. Local. */
bw_shape__extent bw_shape__bounds(const bw_shape *s, int dims);

/* x (3) in the shape's own frame: x itself, or y, which is written. Local. */
static inline const double *bw_shape__own(const bw_shape *s, const double x[3], double y[3])
{
  const bw_shape_frame *f = s->frame;
  if (f == NULL) return x;
  for (int a = 0; a < 3; a++) {
    y[a] = f->about[a];
    for (int d = 0; d < 3; d++)
      y[a] += f->axes[a][d] * (x[d] - f->about[d]);
  }
  return y;
}

/* The box (dims) that holds the body: of all that is added, less what is taken away outside of a
 * shape later. cut[d]: something endless is added, which ends where the others end; not finite
 * where there is none. Is it finite in all directions? Local. */
bool bw_shape__space(int count, const bw_shape shape[], int dims, bw_shape__extent *space,
                     bool cut[3]);

/* The sites to look at, made from shapes and lattice once; `shape` is borrowed. */
typedef struct {
  int count, dims;
  const bw_shape *shape;
  double ds, origin[3];
  bool turned;
  double axes[3][3];
  bw_shape__extent space; /* of all that is added; endless shapes end here */
  int64_t lo[3], hi[3];
} bw_shape__region;

/* Checks all and finds the range. Errors as bw_shape_range. Local. */
bw_status bw_shape__region_make(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                                bw_shape__region *region) BW_MUST_CHECK;
