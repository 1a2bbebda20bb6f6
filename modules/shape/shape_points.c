/* Points with areas on the surface that shapes make together. */
#include "bw_memory.h"
#include "bw_shape_surface.h"
#include "shape_internal.h"

#include <math.h>
#include <string.h>

enum { CUT = 8 }; /* parts of a patch that an edge cuts, per direction */

typedef struct {
  int count, dims, own;  /* own: number of the shape whose patches come now */
  const bw_shape *shape; /* (count) */
  double spacing, shift; /* faces that lie in each other are told apart this far off [L] */
  int64_t n, room;
  double *point, *normal, *area;
} surface;

typedef struct {
  double x[3], normal[3]; /* in space; out of the body */
  double beside;          /* from the pores beside the own one [L]; INFINITY: there are none */
} place;

/* ---- which part of a shape's surface is the body's ---- */

static place place_of(const surface *s, const bw_shape__chart *c, double u, double v)
{
  const bw_shape *own = &s->shape[s->own];
  const bw_shape_frame *f = own->frame;
  const double sign = own->remove != own->outside ? -1.0 : 1.0;
  double y[3], m[3];
  place p;
  c->map(c, u, v, y, m);
  p.beside = bw_shape__basis_of(own->kind) != NULL
                 ? bw_shape__beside_pores(own, s->dims, c->centre, y)
                 : INFINITY;
  for (int d = 0; d < 3; d++) {
    p.x[d] = f == NULL ? y[d] : f->about[d];
    p.normal[d] = f == NULL ? sign * m[d] : 0.0;
    for (int a = 0; a < 3 && f != NULL; a++) {
      p.x[d] += f->axes[a][d] * (y[a] - f->about[a]);
      p.normal[d] += sign * f->axes[a][d] * m[a];
    }
  }
  return p;
}

static void shifted(const surface *s, const place *p, double by, double x[3])
{
  for (int d = 0; d < 3; d++)
    x[d] = p->x[d] + by * s->shift * p->normal[d];
}

/* Positive where the body's surface is that of the shape `own`: it adds to what is empty or removes
 * from what is solid, no pore of its own opens into another there, and no later shape changes
 * anything. No point on the surface is nearer
 * to where this changes sign than its magnitude. Of faces that lie in each other the later one
 * counts where both look the same way, neither where they look at each other. */
static double shown(const surface *s, const place *p)
{
  const bw_shape *own = &s->shape[s->own];
  double x[2][3], g[3];
  shifted(s, p, 1.0, x[0]);
  shifted(s, p, -1.0, x[1]);
  double f = own->remove ? -bw_shape__composed(s->own, s->shape, s->dims, x[1], g)
                         : bw_shape__composed(s->own, s->shape, s->dims, x[0], g);
  f = fmin(f, p->beside);
  for (int q = s->own + 1; q < s->count; q++)
    for (int side = 0; side < 2; side++)
      f = fmin(f, bw_shape__distance(&s->shape[q], s->dims, x[side], g));
  return f;
}

/* ---- the list ---- */

static bw_status put(surface *s, const place *p, double area)
{
  if (s->n == s->room) {
    const int64_t room = 2 * s->room + 1024;
    BW_TRY(BW_ENLARGE(&s->point, 3 * (size_t)s->n, 3 * (size_t)room));
    BW_TRY(BW_ENLARGE(&s->normal, 3 * (size_t)s->n, 3 * (size_t)room));
    BW_TRY(BW_ENLARGE(&s->area, (size_t)s->n, (size_t)room));
    s->room = room;
  }
  memcpy(s->point + 3 * s->n, p->x, sizeof p->x);
  memcpy(s->normal + 3 * s->n, p->normal, sizeof p->normal);
  s->area[s->n++] = area;
  return BW_OK;
}

/* ---- patches ---- */

/* Part of a triangle in which a linear function with these values at the corners is positive. */
static double part_of_triangle(double a, double b, double c)
{
  const double value[3] = {a, b, c};
  int odd = 0, positive = 0;
  for (int k = 0; k < 3; k++)
    positive += value[k] >= 0.0;
  if (positive == 0 || positive == 3) return positive == 3 ? 1.0 : 0.0;
  while ((value[odd] >= 0.0) != (positive == 1))
    odd++; /* the corner that is alone on its side */
  const double p = value[odd], q = value[(odd + 1) % 3], r = value[(odd + 2) % 3];
  const double alone = p / (p - q) * (p / (p - r));
  return positive == 1 ? alone : 1.0 - alone;
}

/* Part of a rectangle that is shown; f: at its corners (00, 01, 10, 11). */
static double part_of_cell(const surface *s, const bw_shape__chart *c, const double u[2],
                           const double v[2], const double f[4])
{
  double most = 0.0;
  for (int k = 0; k < 4; k++)
    most = fmax(most, fabs(f[k]));
  if (most > 4.0 * s->shift)
    return 0.5 * (part_of_triangle(f[0], f[2], f[3]) + part_of_triangle(f[0], f[1], f[3]));
  /* All corners lie on edges, or in a face that lies in another: the middle decides. */
  const place middle = place_of(s, c, 0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
  return shown(s, &middle) > 0.0 ? 1.0 : 0.0;
}

/* The place in the middle of what is left of a patch, or where most is shown if that is a hole. */
static place middle_of(const surface *s, const bw_shape__chart *c, const double mean[2],
                       const double most[2])
{
  const place p = place_of(s, c, mean[0], mean[1]);
  return shown(s, &p) >= 0.0 ? p : place_of(s, c, most[0], most[1]);
}

/* What is left of a patch that an edge cuts: its area from the sign at the corners of small cells,
 * its point in the middle of those cells that are left. */
static bw_status take_cut(surface *s, const bw_shape__chart *c, const double u[2],
                          const double v[2])
{
  const int across = s->dims == 3 ? CUT : 1;
  double f[CUT + 1][CUT + 1], us[CUT + 1], vs[CUT + 1], best = -INFINITY;
  double sum = 0.0, mean[2] = {0.0, 0.0}, most[2] = {u[0], v[0]};
  for (int a = 0; a <= CUT; a++)
    us[a] = u[0] + (u[1] - u[0]) * a / CUT;
  for (int b = 0; b <= across; b++)
    vs[b] = v[0] + (v[1] - v[0]) * b / across;
  for (int a = 0; a <= CUT; a++)
    for (int b = 0; b <= across; b++) {
      const place p = place_of(s, c, us[a], vs[b]);
      f[a][b] = shown(s, &p);
      if (f[a][b] > best) best = f[a][b], most[0] = us[a], most[1] = vs[b];
    }
  for (int a = 0; a < CUT; a++)
    for (int b = 0; b < across; b++) {
      const double corner[4] = {f[a][b], f[a][b + 1], f[a + 1][b], f[a + 1][b + 1]};
      const double area = part_of_cell(s, c, us + a, vs + b, corner) * c->area(c, us + a, vs + b);
      sum += area;
      mean[0] += 0.5 * area * (us[a] + us[a + 1]);
      mean[1] += 0.5 * area * (vs[b] + vs[b + 1]);
    }
  if (!(sum > 1e-12 * c->area(c, u, v))) return BW_OK; /* nothing but round-off */
  mean[0] /= sum, mean[1] /= sum;
  const place p = middle_of(s, c, mean, most);
  return put(s, &p, sum);
}

static bw_status take_patch(surface *s, const bw_shape__chart *c, const double u[2],
                            const double v[2])
{
  const place middle = place_of(s, c, 0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
  double reach = 0.0;
  for (int corner = 0; corner < 4; corner++) {
    const place p = place_of(s, c, u[corner & 1], v[corner >> 1]);
    double squared = 0.0;
    for (int d = 0; d < s->dims; d++)
      squared += (p.x[d] - middle.x[d]) * (p.x[d] - middle.x[d]);
    reach = fmax(reach, sqrt(squared));
  }
  /* `shown` changes by no more than the way; patches are curved, so that theirs is a little
   * more. */
  const double f = shown(s, &middle), safe = 1.2 * reach + 4.0 * s->shift;
  if (f > safe) return put(s, &middle, c->area(c, u, v));
  return f < -safe ? BW_OK : take_cut(s, c, u, v);
}

static bw_status take_chart(void *to, const bw_shape__chart *c)
{
  surface *s = to;
  for (int a = 0; a < c->n[0]; a++)
    for (int b = 0; b < c->n[1]; b++) {
      const double u[2] = {c->u[0] + (c->u[1] - c->u[0]) * a / c->n[0],
                           c->u[0] + (c->u[1] - c->u[0]) * (a + 1) / c->n[0]};
      const double v[2] = {c->v[0] + (c->v[1] - c->v[0]) * b / c->n[1],
                           c->v[0] + (c->v[1] - c->v[0]) * (b + 1) / c->n[1]};
      BW_TRY(take_patch(s, c, u, v));
    }
  return BW_OK;
}

/* ---- bodies ---- */

/* The space of the body seen from the frame of a shape. */
static bw_shape__extent seen_from(const bw_shape *s, int dims, const bw_shape__extent *space)
{
  bw_shape__extent e = *space;
  if (s->frame == NULL) return e;
  for (int d = 0; d < dims; d++) {
    e.lower[d] = e.upper[d] = s->frame->about[d];
    for (int k = 0; k < dims; k++) {
      const double w = s->frame->axes[d][k];
      const double p = w * (space->lower[k] - s->frame->about[k]);
      const double q = w * (space->upper[k] - s->frame->about[k]);
      e.lower[d] += fmin(p, q);
      e.upper[d] += fmax(p, q);
    }
  }
  return e;
}

/* The shapes and, where something endless ends with the others, the box that ends it. */
static bw_status with_ends(int count, const bw_shape shape[], int dims, bw_shape__extent *space,
                           bw_shape **all, int *counted)
{
  bool cut[3] = {false, false, false};
  bw_shape ends = {.kind = BW_SHAPE_BOX, .remove = true, .outside = true};
  (void)bw_shape__space(count, shape, dims, space, cut); /* checked by the caller */
  for (int d = 0; d < dims; d++) {
    /* In other directions the box is so large that its faces are nowhere near the body. */
    const double more = cut[d] ? 0.0 : space->upper[d] - space->lower[d];
    ends.lower[d] = space->lower[d] - more;
    ends.upper[d] = space->upper[d] + more;
  }
  BW_TRY(BW_ALLOCATE(all, (size_t)count + 1));
  memcpy(*all, shape, (size_t)count * sizeof *shape);
  (*all)[count] = ends;
  *counted = count + (cut[0] || cut[1] || cut[2]);
  return BW_OK;
}

static bw_status check(int count, const bw_shape shape[], bool planar, double spacing)
{
  const double origin[3] = {0.0, 0.0, 0.0};
  bw_shape__region g;
  BW_REQUIRE(isfinite(spacing) && spacing > 0.0, BW_EINPUT,
             "surface: spacing = %g has to be positive", spacing);
  const bw_shape_lattice lattice = bw_shape_lattice_straight(spacing, origin, planar);
  return bw_shape__region_make(count, shape, &lattice, &g);
}

bw_status bw_shape_points(int count, const bw_shape shape[], bool planar, double spacing,
                          int64_t *n, double **point, double **normal, double **area)
{
  surface s = {.dims = planar ? 2 : 3, .spacing = spacing, .shift = 1e-7 * spacing};
  bw_shape__extent space;
  bw_shape *all = NULL;
  bw_status st = check(count, shape, planar, spacing);
  BW_THEN(st, with_ends(count, shape, s.dims, &space, &all, &s.count));
  s.shape = all;
  for (s.own = 0; st == BW_OK && s.own < s.count; s.own++) {
    const bw_shape *own = &all[s.own];
    const bw_shape__extent e = seen_from(own, s.dims, &space);
    st = bw_shape__rows[own->kind].charts(own, s.dims, &e, spacing, take_chart, &s);
  }
  if (st == BW_OK && s.n == 0)
    st = BW_FAIL(BW_EINPUT, "surface: the body has none; all of it was removed");
  bw_release(&all);
  if (st != BW_OK) {
    s.n = 0;
    bw_release(&s.point);
    bw_release(&s.normal);
    bw_release(&s.area);
  }
  *n = s.n;
  *point = s.point;
  *normal = s.normal;
  *area = s.area;
  return st;
}
