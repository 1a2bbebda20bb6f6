/* bw_shape_pores.h -- how wide are the pores of a medium, and the throats between them?
 *
 * A box of cells, some of them solid. The distance of an open cell is that from its centre to the
 * centre of the nearest solid one, in cells: r. A ball of 2 r - 1 cells fits around it: in a slit
 * this is its width, or one less where the width is even. The widest way through the box along an
 * axis is the one whose narrowest cell has the largest distance; that cell is the throat, found by
 * joining cells in the order of falling distance until both sides are connected. All of these are
 * estimates: they know a medium only by its cells.
 *
 * Memory   rank 0 holds the whole box, 20 bytes a cell; boxes beyond BW_SHAPE_PORES_MOST cells are
 *          not looked at. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_comm bw_comm; /* bw_comm.h */

/* Cells of a box that is looked at. */
#define BW_SHAPE_PORES_MOST INT64_C(64000000)

/* The box: cell (i,j,k) with 0 <= i < cells[0] and so on is site (i,j,k). */
typedef struct {
  int64_t cells[3]; /* 1 at least, BW_SHAPE_PORES_MOST in all */
  bool periodic[3]; /* the first and the last layer are neighbours, but for a way along this axis */
  bool wall[3];     /* beyond the sides is solid, but for a way along this axis */
} bw_shape_pores_box;

/* Diameters [cells]; the same on all ranks. */
typedef struct {
  bool known;       /* false: the box is too large, nothing below is set */
  double largest;   /* ball that fits */
  double typical;   /* mean over the cells from which no neighbour is further from the solid */
  double throat[3]; /* ball that passes along each axis; 0: none does */
  int64_t at[3][3]; /* the narrowest cell of the widest way along each axis */
} bw_shape_pores;

/* `site` (n,3): solid cells that this rank knows of, each given by one rank at least; what lies
 * outside the box is left out. BW_EINPUT for a box without cells, BW_EMEM; any error is returned by
 * all ranks. Collective. */
bw_status bw_shape_find_pores(const bw_comm *comm, const bw_shape_pores_box *box, int64_t n,
                              const int32_t site[], bw_shape_pores *pores) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
