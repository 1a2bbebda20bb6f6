/* bw_transpose.h -- the same numbers as x-, z- and y-pencils: each direction whole in turn.
 *
 * Arrays without halo, x fastest, of `columns` "x-entries" (n[0] reals, or 2 (n[0]/2 + 1) for
 * the interleaved spectrum of a real transform). The layouts:
 *   X  [m_z][m_y][columns]          all of x         (blocks: y over ranks[1], z over ranks[2])
 *   Z  [n_z][m_y][c_z]              all of z         (x-entries divided over ranks[2])
 *   Y  [n_z][n_y][c_zy]             all of z and y   (those c_z divided again over ranks[1])
 * A step between layouts that one block row holds entirely costs no message, and none at all
 * happens (the pointer is passed through) when the two layouts are the same. */
#pragma once
#include "bw_grid.h"

typedef struct bw_transpose bw_transpose;

/* Extents [z, y, x-entry] of a layout on this rank and where they start globally (from 0). */
typedef struct {
  int extent[3], start[3]; /* order x, y, z */
  size_t size;             /* product of the extents */
} bw_layout;

typedef enum { BW_LAYOUT_X, BW_LAYOUT_Z, BW_LAYOUT_Y } bw_layout_id;

/* `grain`: x-entries that stay together (2 for interleaved complex numbers). Collective. */
bw_status bw_transpose_create(bw_grid *grid, int columns, int grain, bw_transpose **out)
    BW_MUST_CHECK;
void bw_transpose_destroy(bw_transpose **t);

const bw_layout *bw_transpose_layout(const bw_transpose *t, bw_layout_id id); /* Local. */
size_t bw_transpose_size(const bw_transpose *t); /* reals that hold any layout. Local. */

/* Move `a` (layout `from`) to layout `to` (X<->Z, Z<->Y), using `b` as the other buffer; both
 * hold bw_transpose_size reals. Returns the one of a, b that has the result. Collective. */
bw_real *bw_transpose_move(bw_transpose *t, bw_layout_id from, bw_layout_id to, bw_real *a,
                           bw_real *b);
size_t bw_transpose_volume(const bw_transpose *t); /* bytes to other ranks per round trip */
