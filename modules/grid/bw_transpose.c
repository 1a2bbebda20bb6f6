#include "bw_transpose.h"
#include "bw_memory.h"
#include "grid_internal.h"

#include <string.h>

/* x-entries that make one cache line: the copy of a row into its blocks writes whole lines. */
enum { LINE = 64 / (int)sizeof(bw_real) };

/* One block as the X side knows it. */
typedef struct {
  int first, width;
  size_t offset; /* in `own`, of [m_y][m_z][width] */
} piece;

struct bw_transpose {
  bw_grid *grid;
  int n_pieces; /* over all ranks of the row, in order of x-entry */
  piece *pieces;
  int n_blocks, first_block;         /* this rank's among the pieces */
  int peers, me;                     /* ranks in the row */
  int *peer_lo, *peer_m;             /* (peers) their part of z */
  size_t *own_start, *own_count;     /* (peers) their part of `own` */
  size_t *other_start, *other_count; /* (peers) what they hold of my columns, in `other` */
  bw_real *own;                      /* X side: pieces of all columns, my rows */
  bw_real *other;                    /* Z side: my columns, rows of the other ranks */
  const piece *open;
  bw_real *block; /* the open block; NULL for one rank */
  bw_real **part; /* (peers) where its rows come from */
};

/* Wide enough that an inner loop over one row of a block has at least 64 entries. */
static int full_width(int n_z)
{
  const int lines = 64 / (LINE * n_z);
  return LINE * (lines > 1 ? lines : 1);
}

static int count_pieces(int columns, int grain, int peers, int width)
{
  int n = 0;
  for (int p = 0; p < peers; p++) {
    const int own = grain * (bw_grid__block_start(columns / grain, peers, p + 1) -
                             bw_grid__block_start(columns / grain, peers, p));
    n += (own + width - 1) / width;
  }
  return n;
}

/* Pieces follow each other by destination; blocks start on cache lines, and a few lines apart so
 * that the same row of different blocks does not fall into the same cache sets. */
static size_t lay_out(bw_transpose *t, int columns, int grain, int width)
{
  const bw_grid_view *v = bw_grid_look(t->grid);
  const size_t rows = (size_t)v->m[1] * (size_t)v->m[2];
  size_t at = 0;
  int q = 0;
  /* In the order of the ranks that own the columns: what goes to one rank is one stretch of
   * `own`. */
  for (int p = 0; p < t->peers; p++) {
    const int lo = grain * bw_grid__block_start(columns / grain, t->peers, p);
    const int hi = grain * bw_grid__block_start(columns / grain, t->peers, p + 1);
    t->own_start[p] = at;
    if (p == t->me) t->first_block = q;
    /* All pieces have the full width but perhaps the last one of each rank. */
    for (int c = lo; c < hi; c += width, q++) {
      t->pieces[q] = (piece){c, hi - c < width ? hi - c : width, at};
      at += (rows * (size_t)t->pieces[q].width + 3 * LINE - 1) / LINE * LINE;
    }
    /* What stays here is used where it lies and never sent. */
    t->own_count[p] = p == t->me ? 0 : at - t->own_start[p];
    if (p == t->me) t->n_blocks = q - t->first_block;
  }
  return at;
}

/* What a rank with m_z planes sends for piece q, and where my piece starts in its message. */
static size_t piece_size(const bw_transpose *t, int q, int m_z)
{
  const size_t rows = (size_t)bw_grid_look(t->grid)->m[1] * (size_t)m_z;
  return (rows * (size_t)t->pieces[q].width + 3 * LINE - 1) / LINE * LINE;
}

static size_t lay_out_other(bw_transpose *t)
{
  size_t at = 0;
  /* The other ranks lay out my columns as I do theirs, with their own number of planes: the lengths
   * of their messages follow without asking them. */
  for (int p = 0; p < t->peers; p++) {
    t->other_start[p] = at;
    if (p == t->me) continue;
    for (int b = 0; b < t->n_blocks; b++)
      at += piece_size(t, t->first_block + b, t->peer_m[p]);
    t->other_count[p] = at - t->other_start[p];
  }
  return at;
}

static bw_status build(bw_transpose *t, int columns, int grain)
{
  const bw_grid_view *v = bw_grid_look(t->grid);
  const int width = full_width(v->n[2]);
  t->peers = v->ranks[2];
  t->me = v->coord[2];
  BW_REQUIRE(grain >= 1 && columns >= 1 && columns % grain == 0, BW_EINPUT,
             "transpose: %d x-entries are no multiple of the grain %d", columns, grain);
  const size_t peers = (size_t)t->peers;
  /* Sizes are known before anything is laid out: nothing grows later. */
  t->n_pieces = count_pieces(columns, grain, t->peers, width);
  BW_TRY(BW_ALLOCATE(&t->pieces, (size_t)t->n_pieces));
  BW_TRY(BW_ALLOCATE(&t->part, peers));
  BW_TRY(BW_ALLOCATE(&t->peer_m, peers));
  BW_TRY(BW_ALLOCATE(&t->own_start, peers));
  BW_TRY(BW_ALLOCATE(&t->own_count, peers));
  BW_TRY(BW_ALLOCATE(&t->other_start, peers));
  BW_TRY(BW_ALLOCATE(&t->other_count, peers));
  for (int p = 0; p < t->peers; p++)
    t->peer_m[p] =
        bw_grid__block_start(v->n[2], t->peers, p + 1) - bw_grid__block_start(v->n[2], t->peers, p);
  /* The X side: all columns of this rank's rows. */
  BW_TRY(BW_ALLOCATE(&t->own, lay_out(t, columns, grain, width)));
  /* One rank holds all of z: a block is opened in place, there is no other side to gather from. */
  if (t->peers == 1) return BW_OK;
  /* The Z side: this rank's columns of the rows of the others, and one whole block gathered from
   * both. */
  BW_TRY(BW_ALLOCATE(&t->other, lay_out_other(t)));
  return BW_ALLOCATE(&t->block, (size_t)v->m[1] * (size_t)v->n[2] * (size_t)width);
}

bw_status bw_transpose_create(bw_grid *grid, int columns, int grain, bw_transpose **out)
{
  bw_transpose *t = NULL;
  bw_status st = BW_ALLOCATE(&t, 1);
  if (st == BW_OK) {
    t->grid = grid;
    st = build(t, columns, grain);
  }
  st = bw_comm_agree(bw_grid_comm(grid), st);
  if (st != BW_OK) bw_transpose_destroy(&t);
  *out = t;
  return st;
}

void bw_transpose_destroy(bw_transpose **transpose)
{
  bw_transpose *t = *transpose;
  if (t == NULL) return;
  bw_release(&t->pieces);
  bw_release(&t->part);
  bw_release(&t->peer_m);
  bw_release(&t->own_start);
  bw_release(&t->own_count);
  bw_release(&t->other_start);
  bw_release(&t->other_count);
  bw_release(&t->own);
  bw_release(&t->other);
  bw_release(&t->block);
  bw_release(transpose);
}

int bw_transpose_blocks(const bw_transpose *t)
{
  return t->n_blocks;
}

bw_columns bw_transpose_columns(const bw_transpose *t, int b)
{
  const piece *p = &t->pieces[t->first_block + b];
  return (bw_columns){p->first, p->width};
}

/* Of a size known here: two vector moves, not a call. */
static void copy_line(const bw_real *from, bw_real *to)
{
  memcpy(to, from, LINE * sizeof *to);
}

void bw_transpose_put(bw_transpose *t, int j, int k, int rows, const bw_real *row, ptrdiff_t stride)
{
  /* A piece is [m_y][m_z][width]: so many of its rows lie before this one. */
  const size_t before = (size_t)j * (size_t)bw_grid_look(t->grid)->m[2] + (size_t)k;
  for (int q = 0; q < t->n_pieces; q++) {
    const piece *p = &t->pieces[q];
    const bw_real *from = row + p->first;
    const size_t width = (size_t)p->width;
    bw_real *to = t->own + p->offset + before * width;
    if (p->width == LINE)
      for (int r = 0; r < rows; r++, from += stride, to += LINE)
        copy_line(from, to);
    else
      for (int r = 0; r < rows; r++, from += stride, to += width)
        memcpy(to, from, width * sizeof *to);
  }
}

void bw_transpose_get(const bw_transpose *t, int j, int k, int rows, bw_real *row, ptrdiff_t stride)
{
  const size_t before = (size_t)j * (size_t)bw_grid_look(t->grid)->m[2] + (size_t)k;
  for (int q = 0; q < t->n_pieces; q++) {
    const piece *p = &t->pieces[q];
    const size_t width = (size_t)p->width;
    const bw_real *from = t->own + p->offset + before * width;
    bw_real *to = row + p->first;
    if (p->width == LINE)
      for (int r = 0; r < rows; r++, from += LINE, to += stride)
        copy_line(from, to);
    else
      for (int r = 0; r < rows; r++, from += width, to += stride)
        memcpy(to, from, width * sizeof *to);
  }
}

void bw_transpose_to_z(bw_transpose *t)
{
  bw_grid_swap(t->grid, 2, t->own_start, t->own_count, t->own, t->other_start, t->other_count,
               t->other);
}

void bw_transpose_to_x(bw_transpose *t)
{
  bw_grid_swap(t->grid, 2, t->other_start, t->other_count, t->other, t->own_start, t->own_count,
               t->own);
}

bw_real *bw_transpose_open(bw_transpose *t, int b)
{
  const piece *own = &t->pieces[t->first_block + b];
  t->open = own;
  /* A whole block is where it was put. */
  if (t->peers == 1) return t->own + own->offset;
  /* Where block b begins in what each rank sent: behind the blocks before it, which have as many
   * planes as that rank. */
  for (int p = 0; p < t->peers; p++) {
    t->part[p] = p == t->me ? t->own + own->offset : t->other + t->other_start[p];
    for (int c = 0; p != t->me && c < b; c++)
      t->part[p] += piece_size(t, t->first_block + c, t->peer_m[p]);
  }
  return t->block;
}

/* Copy row j between the open block and the parts of the ranks it comes from. */
static void move_row(const bw_transpose *t, int j, bool back)
{
  const size_t width = (size_t)t->open->width;
  bw_real *whole = t->block + (size_t)j * (size_t)bw_grid_look(t->grid)->n[2] * width;
  /* Along z the parts of the ranks follow each other in the order of the ranks. */
  for (int p = 0; p < t->peers; p++) {
    const size_t n = (size_t)t->peer_m[p] * width;
    bw_real *part = t->part[p] + (size_t)j * n;
    if (back)
      memcpy(part, whole, n * sizeof *part);
    else
      memcpy(whole, part, n * sizeof *part);
    whole += n;
  }
}

void bw_transpose_fetch(bw_transpose *t, int j)
{
  if (t->peers > 1) move_row(t, j, false);
}

void bw_transpose_store(bw_transpose *t, int j)
{
  if (t->peers > 1) move_row(t, j, true);
}

size_t bw_transpose_volume(const bw_transpose *t)
{
  size_t n = 0;
  for (int p = 0; p < t->peers; p++)
    n += t->own_count[p] + t->other_count[p];
  return n * sizeof(bw_real);
}
