/* Distances from the solid, and the widest way through: on rank 0, which gathers the cells. */
#include "bw_comm.h"
#include "bw_memory.h"
#include "bw_shape_pores.h"

#include <math.h>
#include <string.h>

/* Squares of distances; beyond FAR there is nothing. */
enum { FAR = 1 << 30 };

typedef struct {
  const bw_shape_pores_box *box;
  int axis; /* the way that is looked for: its sides are open */
  int64_t n, stride[3];
  uint8_t *solid;  /* (n) */
  int32_t *square; /* (n): of the distance, 0 in the solid */
  int32_t *order;  /* (n): cells by falling distance */
  int32_t *parent; /* (n + 2): the tree that a cell is joined to; the two sides are the last */
  int32_t *line;   /* (longest side) */
} field;

static bool periodic(const field *f, int d)
{
  return f->box->periodic[d] && d != f->axis;
}

static bool walled(const field *f, int d)
{
  return f->box->wall[d] && d != f->axis;
}

/* ---- distances ---- */

/* The least of square[q] + (q - at)^2 over a line of `m` numbers, looking further out as long as
 * something nearer can be there; `wall`: there is solid behind both ends. */
static int32_t nearest(const int32_t square[], int64_t m, int64_t at, bool around, bool wall)
{
  int64_t best = square[at];
  for (int64_t r = 1; r * r < best && r <= m; r++)
    for (int side = -1; side <= 1; side += 2) {
      int64_t q = at + side * r;
      const bool out = q < 0 || q >= m;
      if (out && around) q = (q % m + m) % m;
      if (out && !around && !wall) continue;
      const int64_t here = (out && !around ? 0 : square[q]) + r * r;
      best = here < best ? here : best;
    }
  return best < FAR ? (int32_t)best : FAR;
}

/* The squares of a line are exact once all directions have been gone through (Euclid). */
static void spread(field *f, int d)
{
  const int64_t m = f->box->cells[d], step = f->stride[d];
  for (int64_t cell = 0; cell < f->n; cell++) {
    if (cell / step % m != 0) continue; /* lines begin in the first layer */
    for (int64_t q = 0; q < m; q++)
      f->line[q] = f->square[cell + q * step];
    for (int64_t q = 0; q < m; q++)
      f->square[cell + q * step] = nearest(f->line, m, q, periodic(f, d), walled(f, d));
  }
}

static void find_distances(field *f)
{
  for (int64_t cell = 0; cell < f->n; cell++)
    f->square[cell] = f->solid[cell] ? 0 : FAR;
  for (int d = 0; d < 3; d++)
    spread(f, d);
}

/* The ball that fits around a cell. */
static double diameter(int32_t square)
{
  return square > 0 ? fmax(1.0, 2.0 * sqrt((double)square) - 1.0) : 0.0;
}

/* ---- the widest way ---- */

/* The neighbour of a cell in direction d, or -1 where there is none. */
static int64_t neighbour(const field *f, int64_t cell, int d, int side)
{
  const int64_t m = f->box->cells[d], at = cell / f->stride[d] % m, to = at + side;
  if (to >= 0 && to < m) return cell + side * f->stride[d];
  return periodic(f, d) && m > 1 ? cell + (side > 0 ? 1 - m : m - 1) * f->stride[d] : -1;
}

static int32_t root(int32_t parent[], int32_t cell)
{
  while (parent[cell] != cell) {
    parent[cell] = parent[parent[cell]];
    cell = parent[cell];
  }
  return cell;
}

static void join(int32_t parent[], int32_t a, int32_t b)
{
  a = root(parent, a), b = root(parent, b);
  /* The smaller number is the root: paths are halved, so that trees stay flat enough. */
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
}

/* Open cells by falling distance, counted first: how many. */
static bw_status sort_cells(field *f, int64_t *open)
{
  enum { BINS = 1 << 20 };
  int64_t *begin = NULL;
  BW_TRY(BW_ALLOCATE(&begin, BINS + 1));
  for (int64_t cell = 0; cell < f->n; cell++) {
    const int32_t key = f->square[cell] < BINS ? f->square[cell] : BINS - 1;
    if (key > 0) begin[BINS - key]++;
  }
  for (int64_t bin = 1; bin <= BINS; bin++)
    begin[bin] += begin[bin - 1];
  *open = begin[BINS];
  /* begin[] is where each bin ends now: each is filled from there down. */
  for (int64_t cell = f->n - 1; cell >= 0; cell--) {
    const int32_t key = f->square[cell] < BINS ? f->square[cell] : BINS - 1;
    if (key > 0) f->order[--begin[BINS - key]] = (int32_t)cell;
  }
  bw_release(&begin);
  return BW_OK;
}

/* Join cells, wide ones first, until one connects the sides: that cell, or -1. */
static int64_t narrowest(field *f, int64_t open)
{
  const int32_t first = (int32_t)f->n, last = first + 1;
  const int64_t m = f->box->cells[f->axis];
  for (int32_t q = 0; q <= last; q++)
    f->parent[q] = q < first ? -1 : q;
  for (int64_t q = 0; q < open; q++) {
    const int32_t cell = f->order[q];
    const int64_t at = cell / f->stride[f->axis] % m;
    f->parent[cell] = cell;
    /* Neighbours that have come in before are at least as wide. */
    for (int d = 0; d < 3; d++)
      for (int side = -1; side <= 1; side += 2) {
        const int64_t to = neighbour(f, cell, d, side);
        if (to >= 0 && f->parent[to] >= 0) join(f->parent, cell, (int32_t)to);
      }
    if (at == 0) join(f->parent, cell, first);
    if (at == m - 1) join(f->parent, cell, last);
    if (root(f->parent, first) == root(f->parent, last)) return cell;
  }
  return -1;
}

static bw_status find_throat(field *f, int axis, bw_shape_pores *pores)
{
  int64_t open = 0;
  f->axis = axis;
  find_distances(f);
  BW_TRY(sort_cells(f, &open));
  const int64_t cell = narrowest(f, open);
  if (cell < 0) return BW_OK;
  pores->throat[axis] = diameter(f->square[cell]);
  for (int d = 0; d < 3; d++)
    pores->at[axis][d] = cell / f->stride[d] % f->box->cells[d];
  return BW_OK;
}

/* Sizes of pores from the distances that are there. */
static void find_sizes(const field *f, bw_shape_pores *pores)
{
  double sum = 0.0;
  int64_t n = 0;
  for (int64_t cell = 0; cell < f->n; cell++) {
    bool top = f->square[cell] > 0;
    for (int d = 0; d < 3 && top; d++)
      for (int side = -1; side <= 1; side += 2) {
        const int64_t to = neighbour(f, cell, d, side);
        top = top && (to < 0 || f->square[to] <= f->square[cell]);
      }
    if (!top) continue;
    sum += diameter(f->square[cell]);
    n++;
    pores->largest = fmax(pores->largest, diameter(f->square[cell]));
  }
  pores->typical = n > 0 ? sum / (double)n : 0.0;
}

/* ---- gathering ---- */

/* Numbers (n at most) of the sites within the box: how many. */
static size_t number_cells(const bw_shape_pores_box *b, int64_t n, const int32_t site[],
                           int32_t cell[])
{
  size_t m = 0;
  for (int64_t q = 0; q < n; q++) {
    const int32_t *at = site + 3 * q;
    bool in = true;
    for (int d = 0; d < 3; d++)
      in = in && at[d] >= 0 && at[d] < b->cells[d];
    if (in) cell[m++] = (int32_t)(at[0] + b->cells[0] * (at[1] + b->cells[1] * at[2]));
  }
  return m;
}

/* All that rank 0 does. */
static bw_status find_all(const bw_shape_pores_box *box, size_t n, const int32_t cell[],
                          bw_shape_pores *pores)
{
  field f = {.box = box, .n = 1};
  int64_t longest = 1;
  for (int d = 0; d < 3; d++) {
    f.stride[d] = f.n;
    f.n *= box->cells[d];
    longest = box->cells[d] > longest ? box->cells[d] : longest;
  }
  bw_status st = BW_ALLOCATE(&f.solid, (size_t)f.n);
  BW_THEN(st, BW_ALLOCATE(&f.square, (size_t)f.n));
  BW_THEN(st, BW_ALLOCATE(&f.order, (size_t)f.n));
  BW_THEN(st, BW_ALLOCATE(&f.parent, (size_t)f.n + 2));
  BW_THEN(st, BW_ALLOCATE(&f.line, (size_t)longest));
  for (size_t q = 0; q < n && st == BW_OK; q++)
    f.solid[cell[q]] = 1;
  /* The axis along x comes last: its distances are those that know all walls across the stream. */
  for (int axis = 2; axis >= 0; axis--)
    BW_THEN(st, find_throat(&f, axis, pores));
  if (st == BW_OK) find_sizes(&f, pores);
  pores->known = st == BW_OK;
  bw_release(&f.solid);
  bw_release(&f.square);
  bw_release(&f.order);
  bw_release(&f.parent);
  bw_release(&f.line);
  return st;
}

bw_status bw_shape_find_pores(const bw_comm *comm, const bw_shape_pores_box *box, int64_t n,
                              const int32_t site[], bw_shape_pores *pores)
{
  double all = 1.0;
  *pores = (bw_shape_pores){0};
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(box->cells[d] > 0, BW_EINPUT, "pores: cells[%d] = %lld has to be positive", d,
               (long long)box->cells[d]);
    all *= (double)box->cells[d];
  }
  if (all > (double)BW_SHAPE_PORES_MOST) return BW_OK;
  int32_t *mine = NULL, *cell = NULL;
  size_t bytes = 0;
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&mine, (size_t)n));
  if (st == BW_OK)
    st = bw_comm_gather(comm, sizeof *mine * number_cells(box, n, site, mine), mine, &bytes,
                        (void **)&cell);
  if (st == BW_OK) {
    if (bw_comm_rank(comm) == 0) st = find_all(box, bytes / sizeof *cell, cell, pores);
    st = bw_comm_agree(comm, st);
  }
  bw_comm_broadcast(comm, sizeof *pores, pores);
  bw_release(&mine);
  bw_release(&cell);
  return st;
}
