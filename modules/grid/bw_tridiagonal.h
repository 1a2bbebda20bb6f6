/* bw_tridiagonal.h -- many tridiagonal systems along y or z, over all the ranks there.
 *
 *   lower_j x_{j-1} + (diagonal_j + shift_l) x_j + upper_j x_{j+1} = scale f_j,   j = 1 .. n[d]
 * for lines l that share their coefficients but for the shift; cyclic or not.
 * Method: Thomas' algorithm; with several ranks in d (or cyclic systems) the last row of each rank
 * is a separator: `reduce` eliminates the rows between separators, `join` solves the small systems
 * of separators (lines dealt out over the ranks: three numbers per line, rank and direction ahead,
 * two back), `finish` is Thomas with the separators known. The matrix is one that needs no pivoting
 * (diagonally dominant by rows, weakly is enough).
 * Use, per solve:
 *   set; if (coupled) { reduce every line; join; }  finish every line.
 * Lines are handed over in batches of at most BW_TRIDIAGONAL_LINES, row j of a batch at
 * f + (j-1) pitch, contiguous; first: its position among this rank's lines, below the `lines` of
 * create, which is the same on all ranks of a line of blocks in d. */
#pragma once
#include "bw_grid.h"

BW_BEGIN_DECLS

/* The coefficients, work space and messages of the systems along one direction. */
typedef struct bw_tridiagonal bw_tridiagonal;

/* The longest batch: its work space stays in the second-level cache. */
enum { BW_TRIDIAGONAL_LINES = 128 /* lines */ };

/* *out = a solver for `lines` lines of this rank along d = 1 (y) or 2 (z). `grid` is borrowed until
 * destroy. BW_EMEM. Collective. */
bw_status bw_tridiagonal_create(bw_grid *grid, int d, size_t lines,
                                bw_tridiagonal **out) BW_MUST_CHECK;

/* Free *t and set it to NULL; NULL inside is fine. Local. */
void bw_tridiagonal_destroy(bw_tridiagonal **t);

/* Coefficients of all rows, [0..n-1] for j = 1..n[d] (copied). Not cyclic: lower[0] and
 * upper[n-1] must be 0. `cyclic`: only where the grid is periodic in d. Local. */
void bw_tridiagonal_set(bw_tridiagonal *t, const double lower[], const double diagonal[],
                        const double upper[], bool cyclic);

/* Do reduce and join have work to do (several ranks in d, or cyclic)? Local. */
bool bw_tridiagonal_coupled(const bw_tridiagonal *t);

/* A batch of lines. */
typedef struct {
  size_t first;         /* position of the first line among this rank's */
  int n;                /* lines, <= BW_TRIDIAGONAL_LINES */
  ptrdiff_t pitch;      /* reals from row to row of f */
  const bw_real *shift; /* (n) added to the diagonal of each line */
  bw_real scale;        /* factor of f */
  int pinned; /* so many of the first lines are singular (constants solve them for f = 0, and f has
                 no mean): x = 0 in the last row is added to make them regular */
} bw_tridiagonal_batch;

/* Eliminate the rows between separators of a batch and note what the separators need to know. f is
 * the right-hand side, as in the head. Local. */
void bw_tridiagonal_reduce(bw_tridiagonal *t, const bw_tridiagonal_batch *batch, const bw_real *f);

/* Solve for the separators of all lines, each of which has been reduced. Collective over a line of
 * blocks. */
void bw_tridiagonal_join(bw_tridiagonal *t);

/* f, the right-hand side as it was for reduce, becomes the solution x. Local. */
void bw_tridiagonal_finish(bw_tridiagonal *t, const bw_tridiagonal_batch *batch, bw_real *f);

/* Bytes one join sends to other ranks, from this rank. Local. */
size_t bw_tridiagonal_volume(const bw_tridiagonal *t);

BW_END_DECLS
