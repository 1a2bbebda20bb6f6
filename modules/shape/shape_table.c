/* The table of shapes: what is inside, where they end, what they need. */
#include "shape_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef bw_shape__extent extent;

static const double TIE = BW_SHAPE__TIE;

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

/* Pores of one cubic lattice. The nearest image of each basis point is enough, also where pores
 * overlap. */
static bool inside_pores(const bw_shape *s, int dims, double tie, const double x[3])
{
  (void)tie;
  const bw_shape__basis *basis = bw_shape__basis_of(s->kind);
  bool in = false;
  for (int q = 0; q < basis->count; q++) {
    double squared = 0.0;
    for (int d = 0; d < dims; d++) {
      double z = (x[d] - s->centre[d]) / s->pitch - basis->at[q][d];
      z -= round(z);
      squared += z * z * s->pitch * s->pitch;
    }
    in = in || within_radius(s, squared);
  }
  return in;
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

const bw_shape__row bw_shape__rows[BW_SHAPE_COUNT] = {
    [BW_SHAPE_BOX] = {"box", inside_box, bounds_box, bw_shape__distance_box, bw_shape__charts_box,
                      .needs_box = true},
    [BW_SHAPE_SPHERE] = {"sphere", inside_sphere, bounds_sphere, bw_shape__distance_sphere,
                         bw_shape__charts_sphere, .needs_radius = true},
    [BW_SHAPE_CYLINDER] = {"cylinder", inside_cylinder, bounds_cylinder,
                           bw_shape__distance_cylinder, bw_shape__charts_cylinder,
                           .needs_radius = true, .needs_axis = true, .endless = true},
    [BW_SHAPE_PORES_SC] = {"pores_sc", inside_pores, bounds_endless, bw_shape__distance_pores,
                           bw_shape__charts_pores, .needs_radius = true, .needs_pitch = true,
                           .endless = true},
    [BW_SHAPE_PORES_BCC] = {"pores_bcc", inside_pores, bounds_endless, bw_shape__distance_pores,
                            bw_shape__charts_pores, .needs_radius = true, .needs_pitch = true,
                            .endless = true},
    [BW_SHAPE_PORES_FCC] = {"pores_fcc", inside_pores, bounds_endless, bw_shape__distance_pores,
                            bw_shape__charts_pores, .needs_radius = true, .needs_pitch = true,
                            .endless = true},
    [BW_SHAPE_MASK] = {"mask", inside_mask, bounds_mask, bw_shape__distance_mask,
                       bw_shape__charts_mask, .needs_mask = true},
};

const char *bw_shape_name(bw_shape_kind kind)
{
  return (unsigned)kind < BW_SHAPE_COUNT ? bw_shape__rows[kind].name : "unknown";
}

bw_status bw_shape__check(int number, const bw_shape *s, int dims)
{
  BW_REQUIRE((unsigned)s->kind < BW_SHAPE_COUNT, BW_EINPUT,
             "shape %d: kind %d is none of the %d shapes there are", number, (int)s->kind,
             (int)BW_SHAPE_COUNT);
  const bw_shape__row *row = &bw_shape__rows[s->kind];
  /* Only what this kind reads is looked at; the rest may hold anything. */
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
  /* A length that was left out is 0, and refused as such. */
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
  /* Frames are for all kinds. */
  if (s->frame != NULL) {
    char what[64];
    snprintf(what, sizeof what, "shape %d (%s): frame", number, row->name);
    BW_TRY(bw_shape__check_axes(what, s->frame->axes, dims));
    for (int d = 0; d < dims; d++)
      BW_REQUIRE(isfinite(s->frame->about[d]), BW_EINPUT,
                 "shape %d (%s): frame.about[%d] = %g is not finite", number, row->name, d,
                 s->frame->about[d]);
  }
  return BW_OK;
}

bw_status bw_shape__check_axes(const char *what, const double axes[3][3], int dims)
{
  const double limit = 1e-9;
  for (int a = 0; a < 3; a++)
    for (int b = a; b < 3; b++) {
      const double *p = axes[a], *q = axes[b];
      const double dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
      BW_REQUIRE(fabs(dot - (a == b)) <= limit, BW_EINPUT,
                 "%s: the product of axes %d and %d is %g, not %d; bw_shape_turn makes orthonormal "
                 "ones",
                 what, a, b, dot, a == b);
    }
  double right = 0.0;
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    right += axes[0][d] * (axes[1][e] * axes[2][f] - axes[1][f] * axes[2][e]);
  }
  BW_REQUIRE(right > 0.0, BW_EINPUT, "%s: the axes are left-handed; exchange two of them", what);
  BW_REQUIRE(dims == 3 || fabs(axes[2][2] - 1.0) <= limit, BW_EINPUT,
             "%s: a planar body turns about z only, axis 2 is (%g, %g, %g)", what, axes[2][0],
             axes[2][1], axes[2][2]);
  return BW_OK;
}

extent bw_shape__bounds(const bw_shape *s, int dims)
{
  const extent own = bw_shape__rows[s->kind].bounds(s);
  if (s->frame == NULL) return own;
  const bw_shape_frame *f = s->frame;
  extent e;
  for (int d = 0; d < 3; d++) {
    e.lower[d] = e.upper[d] = f->about[d];
    for (int a = 0; a < dims; a++) {
      const double w = f->axes[a][d];
      if (w == 0.0) continue; /* 0 times an endless direction is nothing */
      const double p = w * (own.lower[a] - f->about[a]), q = w * (own.upper[a] - f->about[a]);
      e.lower[d] += fmin(p, q);
      e.upper[d] += fmax(p, q);
    }
    /* Which of its faces a box keeps turns with it: a hair more, so that no range cuts one off. */
    const double hair = 1e3 * TIE * (e.upper[d] - e.lower[d]);
    e.lower[d] -= hair;
    e.upper[d] += hair;
  }
  return e;
}

void bw_shape_turn(const double axis[3], double angle, double axes[3][3])
{
  const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  const double c = cos(angle), s = sin(angle);
  const double n[3] = {axis[0] / length, axis[1] / length, axis[2] / length};
  /* Rodrigues: row a is the unit vector e_a turned. */
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, g = (a + 2) % 3;
    for (int d = 0; d < 3; d++)
      axes[a][d] = (1.0 - c) * n[a] * n[d];
    axes[a][a] += c;
    axes[a][b] += s * n[g];
    axes[a][g] -= s * n[b];
  }
}
