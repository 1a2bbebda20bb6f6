/* Cells inside a closed surface, layer by layer, by the winding number.
 *
 * Everything is measured in cells: cell (i,j,k) has its centre at (i+1/2, j+1/2, k+1/2). The line
 * along x through the centres of a row crosses the surface where it enters (+1) or leaves (-1) a
 * body; the sum of the crossings before a centre is the winding number there. Centres are moved by
 * a hair along +x, +y and +z, a different one in each direction: so a face through centres,
 * whichever way it looks, has all of them on one side, and a lower face keeps what an upper one
 * gives away. */
#include "bw_memory.h"
#include "shape_internal.h"
#include "shape_source.h"
#include "shape_stl.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A triangle and where it begins in z, to be sorted by it. */
typedef struct {
  float from;
  uint32_t of;
} begin;

/* What the reader keeps. */
typedef struct {
  bw_shape__triangles t;
  begin *order;           /* (n), by the smallest z */
  double factor, move[3]; /* cells = factor corner + move */
  double hair;            /* how far centres are moved, in cells */
  bool checked;           /* no part is inside out */
} surface;

/* The work on one layer. */
typedef struct {
  const surface *s;
  int64_t size[3];
  uint32_t *active; /* triangles that may cross the layer */
  uint32_t n;
  int32_t *change; /* (size[1], size[0] + 1): of the winding number before cell i */
  int32_t *net;    /* (size[1]): of all crossings of a line; 0 unless rounding was in the way */
  uint8_t *row;
  int64_t inverted[3];     /* a cell with a negative number ... */
  bool negative, positive; /* ... and whether there is one, and one with a positive one */
} sweep;

static void forget(void *state)
{
  surface *s = state;
  bw_release(&s->t.corner);
  bw_release(&s->order);
  bw_release(&s);
}

/* Corners (3,3) in cells. */
static void corners_of(const surface *s, uint32_t q, double p[3][3])
{
  const float *c = s->t.corner + 9 * (size_t)q;
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++)
      p[k][d] = s->factor * (double)c[3 * k + d] + s->move[d];
}

/* Which side of the edge a to b, seen along x, is the point (y, z) on? Twice the area of the
 * triangle they make, by the same numbers whichever end comes first, so that the two triangles of
 * an edge agree, and 0 is not a third answer. */
static double side_of(const double a[3], const double b[3], double y, double z, int *way)
{
  const bool swap = a[1] > b[1] || (a[1] == b[1] && a[2] > b[2]);
  const double *p = swap ? b : a, *q = swap ? a : b;
  const double area = (q[1] - p[1]) * (z - p[2]) - (q[2] - p[2]) * (y - p[1]);
  *way = (area >= 0.0) == swap ? -1 : 1;
  return swap ? -area : area;
}

/* The line (y, z) along x against a triangle: +1 where it enters the body, -1 where it leaves, 0
 * where it passes by. *x: where. */
static int crossing(double p[3][3], double y, double z, double *x)
{
  int way[3];
  double area[3];
  for (int c = 0; c < 3; c++)
    area[c] = side_of(p[(c + 1) % 3], p[(c + 2) % 3], y, z, &way[c]);
  if (way[0] != way[1] || way[1] != way[2]) return 0;
  const double sum = area[0] + area[1] + area[2];
  const double at = (area[0] * p[0][0] + area[1] * p[1][0] + area[2] * p[2][0]) / sum;
  /* Seen edge on a triangle has no area; rounding must not carry x beyond it. */
  *x = fmin(fmax(at, fmin(fmin(p[0][0], p[1][0]), p[2][0])), fmax(fmax(p[0][0], p[1][0]), p[2][0]));
  return -way[0];
}

/* Moved centres of a row; `more` times as far where the first place was in the way. */
static double line_y(const surface *s, int64_t j, int more)
{
  return (double)j + 0.5 + 1.3 * s->hair * more;
}

static double line_z(const surface *s, int64_t k, int more)
{
  return (double)k + 0.5 + 0.7 * s->hair * more;
}

static void cross_line(sweep *w, double p[3][3], int64_t j, int64_t k, int more)
{
  double x = 0.0;
  const int sign = crossing(p, line_y(w->s, j, more), line_z(w->s, k, more), &x);
  if (sign == 0) return;
  /* The first cell whose moved centre lies behind the crossing. */
  const double first = floor(x - 0.5 - w->s->hair) + 1.0;
  const int64_t i = (int64_t)fmin(fmax(first, 0.0), (double)w->size[0]);
  w->change[i + (w->size[0] + 1) * j] += sign;
  w->net[j] += sign;
}

/* Lines that the triangle may cross in this layer: those between the ends of the cut, and one more
 * on each side. */
static void lines_of(const sweep *w, double p[3][3], double z, int64_t lines[2])
{
  double least = INFINITY, most = -INFINITY;
  for (int c = 0; c < 3; c++) {
    const double *a = p[c], *b = p[(c + 1) % 3];
    const double rise = b[2] - a[2];
    double y[2] = {a[1], b[1]};
    if (fabs(rise) > 1e-6)
      y[0] = y[1] = a[1] + fmin(fmax((z - a[2]) / rise, 0.0), 1.0) * (b[1] - a[1]);
    least = fmin(least, fmin(y[0], y[1]));
    most = fmax(most, fmax(y[0], y[1]));
  }
  lines[0] = (int64_t)fmin(fmax(floor(least) - 1.0, 0.0), (double)w->size[1]);
  lines[1] = (int64_t)fmin(fmax(ceil(most) + 1.0, 0.0), (double)w->size[1]);
}

/* Lines that were left as often as entered are done. The others ran so close to an edge that
 * rounding decided: they are moved a little further. */
static bw_status mend_lines(const bw_shape_source *from, sweep *w, int64_t k)
{
  enum { TRIES = 16 };
  for (int64_t j = 0; j < w->size[1]; j++)
    for (int more = 2; w->net[j] != 0; more++) {
      BW_REQUIRE(more < TRIES, BW_EINPUT,
                 "%s: the line along x through cell (0, %lld, %lld) meets edges wherever it is put",
                 from->path, (long long)j, (long long)k);
      int32_t *change = w->change + (w->size[0] + 1) * j;
      memset(change, 0, (size_t)(w->size[0] + 1) * sizeof *change);
      w->net[j] = 0;
      for (uint32_t q = 0; q < w->n; q++) {
        double p[3][3];
        corners_of(w->s, w->active[q], p);
        cross_line(w, p, j, k, more);
      }
    }
  return BW_OK;
}

/* Sums along the lines; rows of cells to the mask. */
static void put_layer(bw_shape_source *from, sweep *w, int64_t k, bw_shape_mask *into)
{
  for (int64_t j = 0; j < w->size[1]; j++) {
    const int32_t *change = w->change + (w->size[0] + 1) * j;
    int64_t number = 0;
    for (int64_t i = 0; i < w->size[0]; i++) {
      number += change[i];
      w->positive = w->positive || number > 0;
      if (number < 0 && !w->negative) {
        w->negative = true;
        w->inverted[0] = i, w->inverted[1] = j, w->inverted[2] = k;
      }
      w->row[i] = number != 0;
    }
    bw_shape__put_row(from, j, k, w->row, into);
  }
}

static bw_status do_layer(bw_shape_source *from, sweep *w, int64_t k, uint32_t *next,
                          bw_shape_mask *into)
{
  const surface *s = w->s;
  const double z = line_z(s, k, 1), reach = 32.0 * s->hair;
  uint32_t kept = 0;
  memset(w->change, 0, (size_t)(w->size[1] * (w->size[0] + 1)) * sizeof *w->change);
  memset(w->net, 0, (size_t)w->size[1] * sizeof *w->net);
  /* Those that begin up to here come in; those that have ended go. */
  while (*next < s->t.n && s->factor * (double)s->order[*next].from + s->move[2] <= z + reach)
    w->active[w->n++] = s->order[(*next)++].of;
  for (uint32_t q = 0; q < w->n; q++) {
    double p[3][3];
    int64_t lines[2];
    corners_of(s, w->active[q], p);
    if (fmax(fmax(p[0][2], p[1][2]), p[2][2]) < z - reach) continue;
    w->active[kept++] = w->active[q];
    lines_of(w, p, z, lines);
    for (int64_t j = lines[0]; j < lines[1]; j++)
      cross_line(w, p, j, k, 1);
  }
  w->n = kept;
  BW_TRY(mend_lines(from, w, k));
  put_layer(from, w, k, into);
  return BW_OK;
}

/* Winding numbers of both signs: a part is inside out that lies in no other. */
static bw_status check_sense(const bw_shape_source *from, const sweep *w, surface *s)
{
  double x[3];
  for (int d = 0; d < 3; d++)
    x[d] = from->v.lower[d] + ((double)w->inverted[d] + 0.5) * from->v.spacing[d];
  BW_REQUIRE(!(w->negative && w->positive), BW_EINPUT,
             "%s: a part of the surface is inside out: its normals point inwards around (%g, %g, "
             "%g), where no other part encloses it as a cavity; turn its facets",
             from->path, x[0], x[1], x[2]);
  s->checked = true;
  return BW_OK;
}

static bw_status read_layers(bw_shape_source *from, int64_t first, int64_t to, bw_shape_mask *into)
{
  surface *s = from->state;
  sweep w = {.s = s};
  memcpy(w.size, from->v.size, sizeof w.size);
  const double all = (double)w.size[0] * (double)w.size[1] * (double)w.size[2];
  BW_REQUIRE(all < 1e11, BW_EINPUT, "%s: %g cells are more than can be gone through", from->path,
             all);
  const size_t lines = (size_t)w.size[1], cells = (size_t)w.size[0];
  /* Whether a part is inside out shows in the whole body only: once all layers are gone through. */
  const int64_t begin_at = s->checked ? first : 0, end_at = s->checked ? to : w.size[2];
  bw_status st = BW_ALLOCATE(&w.active, s->t.n);
  BW_THEN(st, BW_ALLOCATE(&w.change, lines * (cells + 1)));
  BW_THEN(st, BW_ALLOCATE(&w.net, lines));
  BW_THEN(st, BW_ALLOCATE(&w.row, cells));
  uint32_t next = 0;
  for (int64_t k = begin_at; k < end_at && st == BW_OK; k++)
    st = do_layer(from, &w, k, &next, into);
  if (st == BW_OK && !s->checked) {
    st = check_sense(from, &w, s);
    into->about.inside_out = w.negative;
  }
  bw_release(&w.active);
  bw_release(&w.change);
  bw_release(&w.net);
  bw_release(&w.row);
  return st;
}

static const bw_shape__reader reader = {.read = read_layers, .destroy = forget};

/* ---- opening ---- */

bw_shape_surface_config bw_shape_surface_config_default(void)
{
  return (bw_shape_surface_config){.scale = NAN, .spacing = NAN};
}

static int by_begin(const void *a, const void *b)
{
  const begin *p = a, *q = b;
  if (p->from != q->from) return (p->from > q->from) - (p->from < q->from);
  return (p->of > q->of) - (p->of < q->of);
}

static bw_status sort_triangles(surface *s)
{
  BW_TRY(BW_ALLOCATE(&s->order, s->t.n));
  for (uint32_t q = 0; q < s->t.n; q++) {
    const float *c = s->t.corner + 9 * (size_t)q;
    s->order[q] = (begin){fminf(fminf(c[2], c[5]), c[8]), q};
  }
  qsort(s->order, s->t.n, sizeof *s->order, by_begin);
  return BW_OK;
}

/* The box of cells that holds all corners, on the lattice, and not so many that `scale` must be
 * wrong; and the way from corners to cells. */
static bw_status place_surface(const char *path, const bw_shape_surface_config *c, surface *s,
                               bw_shape_voxels *v, double length[3])
{
  double far = 0.0;
  s->factor = c->scale / c->spacing;
  for (int d = 0; d < 3; d++) {
    double least = INFINITY, most = -INFINITY;
    for (size_t q = 0; q < 3 * (size_t)s->t.n; q++) {
      least = fmin(least, c->scale * (double)s->t.corner[3 * q + (size_t)d]);
      most = fmax(most, c->scale * (double)s->t.corner[3 * q + (size_t)d]);
    }
    far = fmax(far, fmax(fabs(least), fabs(most)) / c->spacing);
    const double shift = c->placed ? c->at[d] - least : 0.0;
    const double from = floor((least + shift - c->origin[d]) / c->spacing);
    v->spacing[d] = c->spacing;
    v->lower[d] = c->origin[d] + from * c->spacing;
    length[d] = most - least;
    const double cells = ceil((most + shift - v->lower[d]) / c->spacing - 1e-9);
    BW_REQUIRE(fabs(from) < 1e15 && cells <= 1e6, BW_EINPUT,
               "%s: is %g long in direction %d, %g cells of %g; is scale = %g right?", path,
               length[d], d, cells, c->spacing, c->scale);
    v->size[d] = (int64_t)fmax(1.0, cells);
    s->move[d] = (shift - v->lower[d]) / c->spacing;
  }
  /* More than corners are off by, which the file holds in single precision. */
  s->hair = fmin(fmax(1e-6, 2.0 * (double)FLT_EPSILON * far), 0.01);
  return BW_OK;
}

bw_status bw_shape_mask_open_stl(const char *path, const bw_shape_surface_config *c,
                                 bw_shape_mask **out)
{
  surface *s = NULL;
  bw_shape_voxels v = {.type = BW_SHAPE_VOXEL_U8};
  double length[3];
  *out = NULL;
  BW_REQUIRE(c->scale > 0 && isfinite(c->scale) && c->spacing > 0 && isfinite(c->spacing),
             BW_EINPUT, "%s: scale = %g and spacing = %g must be positive", path, c->scale,
             c->spacing);
  BW_TRY(BW_ALLOCATE(&s, 1));
  bw_status st = bw_shape__read_triangles(path, &s->t);
  BW_THEN(st, bw_shape__check_closed(path, &s->t));
  BW_THEN(st, place_surface(path, c, s, &v, length));
  BW_THEN(st, sort_triangles(s));
  if (st != BW_OK) {
    forget(s);
    return st;
  }
  BW_TRY(bw_shape__source_create(path, &v, 1.0, 1.0, &reader, s, out));
  (*out)->about.format = "STL";
  (*out)->about.turned = s->t.turned;
  memcpy((*out)->about.length, length, sizeof length);
  return BW_OK;
}

bw_status bw_shape_mask_read_stl(const char *path, double scale, double spacing,
                                 bw_shape_mask **out)
{
  bw_shape_surface_config c = bw_shape_surface_config_default();
  c.scale = scale, c.spacing = spacing;
  return bw_shape__mask_all(bw_shape_mask_open_stl(path, &c, out), out);
}
