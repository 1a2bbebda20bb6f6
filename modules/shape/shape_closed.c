/* Is a surface of triangles closed? Every edge has to be run along as often one way as the other:
 * by two facets for a single body, by more where bodies touch. Where one side of an edge is cut
 * into pieces and the other is not, the pieces count. Facets that run the same way along an edge
 * point to different sides: they are turned to one, that of the larger area. */
#include "bw_memory.h"
#include "shape_stl.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A corner of a triangle, to be sorted by its place. */
typedef struct {
  float x[3];
  uint32_t corner; /* 3 triangle + 0, 1, 2 */
} placed;

/* A side of a triangle: vertices low < high, seen from triangle `of`. */
typedef struct {
  uint32_t low, high, of;
  int32_t way; /* +1: the triangle runs from low to high, -1: back */
} side;

/* Vertices, sides, and those of edges that are run along more often one way than the other. */
typedef struct {
  const char *path;
  bw_shape__triangles *t;
  uint32_t *number; /* (3 n): the vertex at each corner */
  uint32_t *corner; /* (3 n at most): a corner at each vertex */
  side *sides;      /* (n_sides of 3 n at most), by their ends */
  side *piece; /* (n_pieces of `room`): sides of edges that do not balance, cut, by their ends */
  size_t n_sides, n_pieces, room;
} edges;

static int by_place(const void *a, const void *b)
{
  const float *x = ((const placed *)a)->x, *y = ((const placed *)b)->x;
  for (int d = 0; d < 3; d++)
    if (x[d] != y[d]) return (x[d] > y[d]) - (x[d] < y[d]);
  return 0;
}

static int by_ends(const void *a, const void *b)
{
  const side *p = a, *q = b;
  if (p->low != q->low) return (p->low > q->low) - (p->low < q->low);
  if (p->high != q->high) return (p->high > q->high) - (p->high < q->high);
  if (p->way != q->way) return (p->way > q->way) - (p->way < q->way);
  return (p->of > q->of) - (p->of < q->of);
}

/* Vertices are what lies at the same place. */
static bw_status number_vertices(edges *e)
{
  const size_t n = 3 * (size_t)e->t->n;
  placed *v = NULL;
  BW_TRY(BW_ALLOCATE(&v, n));
  for (size_t q = 0; q < n; q++) {
    memcpy(v[q].x, e->t->corner + 3 * q, sizeof v[q].x);
    v[q].corner = (uint32_t)q;
  }
  qsort(v, n, sizeof *v, by_place);
  uint32_t next = 0;
  for (size_t q = 0; q < n; q++) {
    if (q > 0 && by_place(&v[q - 1], &v[q]) != 0) next++;
    e->number[v[q].corner] = next;
    e->corner[next] = v[q].corner;
  }
  bw_release(&v);
  return BW_OK;
}

static const float *place(const edges *e, uint32_t vertex)
{
  return e->t->corner + 3 * (size_t)e->corner[vertex];
}

/* Sides with two different ends, sorted. */
static void list_sides(edges *e)
{
  for (uint32_t f = 0; f < e->t->n; f++)
    for (uint32_t c = 0; c < 3; c++) {
      const uint32_t a = e->number[3 * f + c], b = e->number[3 * f + (c + 1) % 3];
      if (a == b) continue; /* a needle has nothing there */
      e->sides[e->n_sides++] = a < b ? (side){a, b, f, 1} : (side){b, a, f, -1};
    }
  qsort(e->sides, e->n_sides, sizeof *e->sides, by_ends);
}

/* The next edge of sorted sides from `at` on: the end of its sides, and their sum. */
static size_t next_edge(const side sides[], size_t n, size_t at, int64_t *sum)
{
  size_t end = at;
  *sum = 0;
  for (; end < n && sides[end].low == sides[at].low && sides[end].high == sides[at].high; end++)
    *sum += sides[end].way;
  return end;
}

/* All sides of edges whose sum is not 0, and if wanted of those that more or fewer than two share:
 * how many, and where they go; to NULL: they are counted. */
static size_t collect(const side sides[], size_t n, bool shared, side to[])
{
  size_t found = 0;
  int64_t sum;
  for (size_t q = 0, end; q < n; q = end) {
    end = next_edge(sides, n, q, &sum);
    if (sum == 0 && (!shared || end - q == 2)) continue;
    if (to != NULL) memcpy(to + found, sides + q, (end - q) * sizeof *to);
    found += end - q;
  }
  return found;
}

/* ---- edges that one side has in pieces ---- */

/* Where on the edge a vertex lies, from 0 to 1 and ends excluded; NaN: beside it. */
static double on_edge(const edges *e, const side *s, uint32_t vertex)
{
  const float *a = place(e, s->low), *b = place(e, s->high), *x = place(e, vertex);
  double along = 0.0, length = 0.0, off = 0.0, size = 0.0;
  for (int d = 0; d < 3; d++) {
    const double ab = (double)b[d] - (double)a[d];
    along += ab * ((double)x[d] - (double)a[d]);
    length += ab * ab;
    size = fmax(size, fmax(fabs((double)a[d]), fabs((double)b[d])));
  }
  const double t = along / length;
  for (int d = 0; d < 3; d++) {
    const double ab = (double)b[d] - (double)a[d];
    off = fmax(off, fabs((double)x[d] - (double)a[d] - t * ab));
  }
  /* Corners are single precision, each rounded by itself. */
  return t > 0.0 && t < 1.0 && off <= 4.0 * (double)FLT_EPSILON * size ? t : NAN;
}

static int by_t(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A side in the pieces that these vertices cut it into; cut (2 `vertices`) is room to work in. */
static void cut_side(edges *e, const side *s, size_t vertices, const uint32_t vertex[],
                     double cut[])
{
  size_t n = 0;
  for (size_t q = 0; q < vertices; q++) {
    const double t = on_edge(e, s, vertex[q]);
    if (isnan(t)) continue;
    cut[2 * n] = t;
    cut[2 * n++ + 1] = vertex[q];
  }
  qsort(cut, n, 2 * sizeof *cut, by_t);
  uint32_t from = s->low;
  for (size_t q = 0; q <= n && e->n_pieces < e->room; q++) {
    const uint32_t to = q < n ? (uint32_t)cut[2 * q + 1] : s->high;
    e->piece[e->n_pieces++] =
        from < to ? (side){from, to, s->of, s->way} : (side){to, from, s->of, -s->way};
    from = to;
  }
}

static int by_value(const void *a, const void *b)
{
  const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

/* Sides (n) of edges that do not balance, cut at the ends of the others; up to MOST of them are
 * compared each with each, more stay whole. */
static bw_status cut_sides(edges *e, size_t n, const side bad[])
{
  enum { MOST = 4096 };
  uint32_t *vertex = NULL;
  double *cut = NULL;
  /* Each end of a side may cut a side of the triangle at the other side of the edge. */
  e->room = 4 * n;
  bw_status st = BW_ALLOCATE(&e->piece, e->room);
  BW_THEN(st, BW_ALLOCATE(&vertex, 2 * n));
  BW_THEN(st, BW_ALLOCATE(&cut, 4 * n));
  if (st == BW_OK) {
    for (size_t q = 0; q < n; q++)
      vertex[2 * q] = bad[q].low, vertex[2 * q + 1] = bad[q].high;
    qsort(vertex, 2 * n, sizeof *vertex, by_value);
    size_t vertices = 0;
    for (size_t q = 0; q < 2 * n && n <= MOST; q++)
      if (q == 0 || vertex[q] != vertex[q - 1]) vertex[vertices++] = vertex[q];
    for (size_t q = 0; q < n; q++)
      cut_side(e, &bad[q], vertices, vertex, cut);
    qsort(e->piece, e->n_pieces, sizeof *e->piece, by_ends);
  }
  bw_release(&vertex);
  bw_release(&cut);
  return st;
}

/* ---- facets that point to different sides ---- */

/* Triangles that hang together, and which of them have to be turned against the first. */
typedef struct {
  uint32_t *parent; /* (n) */
  uint8_t *turned;  /* (n): against the parent */
} sheets;

/* The first triangle of the sheet, and whether `q` is turned against it. */
static uint32_t first_of(sheets *s, uint32_t q, uint8_t *turned)
{
  *turned = 0;
  while (s->parent[q] != q) {
    /* Paths are halved: the grandparent becomes the parent. */
    const uint32_t up = s->parent[q];
    s->turned[q] ^= s->parent[up] != up ? s->turned[up] : 0;
    *turned ^= s->turned[q];
    s->parent[q] = s->parent[up];
    q = s->parent[q];
  }
  return q;
}

/* Where exactly two sides meet they belong to one sheet. */
static bw_status join_sides(const edges *e, const side sides[], size_t n, sheets *s)
{
  int64_t sum;
  for (size_t q = 0, end; q < n; q = end) {
    uint8_t turned[2];
    end = next_edge(sides, n, q, &sum);
    if (end - q != 2) continue;
    const uint32_t a = first_of(s, sides[q].of, &turned[0]);
    const uint32_t b = first_of(s, sides[q + 1].of, &turned[1]);
    const uint8_t need = sum != 0; /* both run the same way: one has to be turned */
    if (a != b) {
      s->parent[b] = a;
      s->turned[b] = turned[0] ^ turned[1] ^ need;
    }
    BW_REQUIRE(a != b || (turned[0] ^ turned[1]) == need, BW_EINPUT,
               "%s: the surface has no inside: around triangle %u it comes back with its sides "
               "exchanged, as a Moebius strip",
               e->path, sides[q].of);
  }
  return BW_OK;
}

static double area_of(const bw_shape__triangles *t, uint32_t q)
{
  const float *c = t->corner + 9 * (size_t)q;
  double sum = 0.0;
  for (int d = 0; d < 3; d++) {
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    const double n = ((double)c[3 + a] - (double)c[a]) * ((double)c[6 + b] - (double)c[b]) -
                     ((double)c[3 + b] - (double)c[b]) * ((double)c[6 + a] - (double)c[a]);
    sum += n * n;
  }
  return sqrt(sum);
}

static void turn_triangle(edges *e, uint32_t q)
{
  float *c = e->t->corner + 9 * (size_t)q;
  uint32_t *number = e->number + 3 * (size_t)q;
  for (int d = 0; d < 3; d++) {
    const float x = c[3 + d];
    c[3 + d] = c[6 + d], c[6 + d] = x;
  }
  const uint32_t second = number[1];
  number[1] = number[2], number[2] = second;
  e->t->turned++;
}

/* In each sheet the smaller area is turned: turn (n) says which triangles. */
static bw_status turn_smaller(edges *e, sheets *s, uint8_t turn[])
{
  double *area = NULL; /* (n): of what agrees with the first triangle less what does not */
  uint8_t turned;
  BW_TRY(BW_ALLOCATE(&area, e->t->n));
  for (uint32_t q = 0; q < e->t->n; q++) {
    const uint32_t first = first_of(s, q, &turned);
    area[first] += turned ? -area_of(e->t, q) : area_of(e->t, q);
  }
  for (uint32_t q = 0; q < e->t->n; q++) {
    const uint32_t first = first_of(s, q, &turned);
    turn[q] = turned ^ (area[first] < 0.0);
    if (turn[q]) turn_triangle(e, q);
  }
  /* A vertex is found again at the corners where it lies now. */
  for (uint32_t q = 0; q < 3 * e->t->n; q++)
    e->corner[e->number[q]] = q;
  bw_release(&area);
  return BW_OK;
}

static void turn_sides(const uint8_t turn[], side sides[], size_t n)
{
  for (size_t q = 0; q < n; q++)
    if (turn[sides[q].of]) sides[q].way = -sides[q].way;
  qsort(sides, n, sizeof *sides, by_ends);
}

static bw_status make_one_sided(edges *e)
{
  sheets s = {0};
  uint8_t *turn = NULL;
  bw_status st = BW_ALLOCATE(&s.parent, e->t->n);
  BW_THEN(st, BW_ALLOCATE(&s.turned, e->t->n));
  BW_THEN(st, BW_ALLOCATE(&turn, e->t->n));
  for (uint32_t q = 0; q < e->t->n && st == BW_OK; q++)
    s.parent[q] = q;
  BW_THEN(st, join_sides(e, e->sides, e->n_sides, &s));
  BW_THEN(st, join_sides(e, e->piece, e->n_pieces, &s));
  BW_THEN(st, turn_smaller(e, &s, turn));
  if (st == BW_OK) {
    turn_sides(turn, e->sides, e->n_sides);
    turn_sides(turn, e->piece, e->n_pieces);
  }
  bw_release(&s.parent);
  bw_release(&s.turned);
  bw_release(&turn);
  return st;
}

/* ---- what is wrong ---- */

/* The corner of the triangle that is not on the side. */
static uint32_t opposite(const edges *e, const side *s)
{
  const uint32_t *v = e->number + 3 * (size_t)s->of;
  for (int c = 0; c < 3; c++)
    if (v[c] != s->low && v[c] != s->high) return v[c];
  return s->low;
}

/* A triangle that is there twice is told from a hole: by the sides (n) of edges that do not
 * balance. */
static bw_status check_twice(const edges *e, const side bad[], size_t n)
{
  for (size_t q = 1; q < n; q++)
    BW_REQUIRE(bad[q].low != bad[q - 1].low || bad[q].high != bad[q - 1].high ||
                   bad[q].way != bad[q - 1].way || opposite(e, &bad[q]) != opposite(e, &bad[q - 1]),
               BW_EINPUT, "%s: triangles %u and %u are the same: a triangle twice", e->path,
               bad[q - 1].of, bad[q].of);
  return BW_OK;
}

/* Everything has been cut and turned: what does not balance now is the rim of a hole. */
static bw_status check_rims(const edges *e)
{
  int64_t sum;
  size_t bad = 0;
  const side *first = NULL;
  for (size_t q = 0, end; q < e->n_pieces; q = end) {
    end = next_edge(e->piece, e->n_pieces, q, &sum);
    if (sum != 0 && bad++ == 0) first = &e->piece[q];
  }
  if (bad == 0) return BW_OK;
  const float *a = place(e, first->low), *b = place(e, first->high);
  return BW_FAIL(BW_EINPUT,
                 "%s: the surface is not closed: at the edge from (%g, %g, %g) to (%g, %g, %g) of "
                 "triangle %u no other one goes on, as at %zu edges in all; fill the holes",
                 e->path, (double)a[0], (double)a[1], (double)a[2], (double)b[0], (double)b[1],
                 (double)b[2], first->of, bad);
}

static bw_status check_pairs(edges *e)
{
  side *bad = NULL;
  if (collect(e->sides, e->n_sides, false, NULL) == 0) return BW_OK;
  /* Pairs in balance stay so when their sheet is turned; others are looked at again. */
  const size_t n = collect(e->sides, e->n_sides, true, NULL);
  BW_TRY(BW_ALLOCATE(&bad, n));
  bw_status st = check_twice(e, bad, collect(e->sides, e->n_sides, false, bad));
  collect(e->sides, e->n_sides, true, bad);
  BW_THEN(st, cut_sides(e, n, bad));
  bw_release(&bad);
  BW_THEN(st, make_one_sided(e));
  BW_THEN(st, check_rims(e));
  return st;
}

bw_status bw_shape__check_closed(const char *path, bw_shape__triangles *t)
{
  edges e = {.path = path, .t = t};
  bw_status st = BW_ALLOCATE(&e.number, 3 * (size_t)t->n);
  BW_THEN(st, BW_ALLOCATE(&e.corner, 3 * (size_t)t->n));
  BW_THEN(st, number_vertices(&e));
  BW_THEN(st, BW_ALLOCATE(&e.sides, 3 * (size_t)t->n));
  if (st == BW_OK) list_sides(&e);
  BW_THEN(st, check_pairs(&e));
  bw_release(&e.number);
  bw_release(&e.corner);
  bw_release(&e.sides);
  bw_release(&e.piece);
  return st;
}
