/* bw_transpose.h -- rows that are whole in x become columns that are whole in z, and back.
 *
 * For solvers that transform along x, then along z, and then couple in y. Numbers come in rows of
 * `columns` x-entries (a transformed x-row); entry c of the row (j, k) is a number of the column
 * (c, j) along z. Columns are divided over the ranks[2] blocks of a row of pencils and cut into
 * blocks of a few entries whose y-z plane fits the cache:
 *   X side  rows, put and taken one by one (all x, local j, local k)
 *   Z side  blocks [m_y][n_z][width]       (a few x-entries, local j, all k)
 * y is never divided anew: solve over the ranks in y with bw_tridiagonal.h.
 * When one rank holds all of z no message is sent and a block is opened in place.
 * Indices j, k of this header are local and start at 0.
 * Life  create -> { put every row, to_z, open each block, to_x, get every row } -> destroy.
 * Nothing is allocated after create. */
#pragma once
#include "bw_grid.h"

BW_BEGIN_DECLS

/* The plan of a transpose, with its buffers. */
typedef struct bw_transpose bw_transpose;

/* A block of the Z side: global x-entries first .. first + width - 1. */
typedef struct {
  int first, width; /* 0 .. columns-1, and the number of entries */
} bw_columns;

/* *out = a plan for rows of `columns` x-entries. `grain`: x-entries that stay together (2 for
 * interleaved complex numbers; divides columns). `grid` is borrowed until destroy. BW_EINPUT for a
 * grain that does not divide columns, BW_EMEM. Collective. */
bw_status bw_transpose_create(bw_grid *grid, int columns, int grain,
                              bw_transpose **out) BW_MUST_CHECK;

/* Free *t and set it to NULL; NULL inside is fine. Local. */
void bw_transpose_destroy(bw_transpose **t);

/* Blocks of this rank (0 is possible), widest first; all but the last have the full width. */
int bw_transpose_blocks(const bw_transpose *t); /* Local. */

/* The x-entries of block b, 0 <= b < blocks. Local. */
bw_columns bw_transpose_columns(const bw_transpose *t, int b);

/* Rows (j, k) .. (j, k + rows - 1), `stride` reals apart, into or out of the X side. Local. */
void bw_transpose_put(bw_transpose *t, int j, int k, int rows, const bw_real *row,
                      ptrdiff_t stride);
void bw_transpose_get(const bw_transpose *t, int j, int k, int rows, bw_real *row,
                      ptrdiff_t stride);

/* All numbers from the X side to the Z side, and back. Collective. */
void bw_transpose_to_z(bw_transpose *t);
void bw_transpose_to_x(bw_transpose *t);

/* Block b as [m_y][n_z][width]; one block is open at a time. Its row j is valid after fetch, and
 * changes of it are kept by store: row by row, so that it is in the cache when it is needed.
 * (With one rank in z the block is where it was and both do nothing.) Local. */
bw_real *bw_transpose_open(bw_transpose *t, int b);
void bw_transpose_fetch(bw_transpose *t, int j);
void bw_transpose_store(bw_transpose *t, int j);

/* Bytes to other ranks of one to_z and one to_x together, from this rank. Local. */
size_t bw_transpose_volume(const bw_transpose *t);

BW_END_DECLS
