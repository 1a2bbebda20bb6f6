/* bw_shape_way.h -- is there a way through a porous medium, and how much of it is connected?
 *
 * A box of cells, some of them solid; the others are open. Cells are connected over their faces.
 * The question is which open cells are connected to the side of the box where the coordinate
 * `axis` is 0, and whether the opposite side is among them.
 *
 * How      every rank holds one slab of cells, cut across the longest axis of the box. It floods
 *          its own slab as far as it gets, gives the border layers to the neighbours, and goes on
 *          from what they give, until nothing changes anywhere. A way that winds through the slabs
 *          takes one exchange each time it enters another one.
 * Memory   per rank, one byte a cell of its slab (the number of cells over that of ranks), the
 *          front of the flood, two layers, and 20 bytes for each of the sites that it gives. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_comm bw_comm; /* bw_comm.h */

/* The box: cell (i,j,k) with 0 <= i < cells[0] and so on is site (i,j,k). */
typedef struct {
  int64_t cells[3]; /* 1 .. 2^31 - 1 each */
  int axis;         /* 0, 1, 2: from the side at 0 to the opposite one */
  bool periodic[3]; /* the first and the last layer are neighbours; not along `axis` */
} bw_shape_way_box;

/* What was found; the same on all ranks. */
typedef struct {
  bool through;    /* an open cell of the last layer is connected to one of the first */
  int64_t open;    /* open cells; over the cells of the box it is the porosity */
  int64_t reached; /* open cells that are connected to the first layer */
} bw_shape_way;

/* `site` (n,3): solid cells that this rank knows of. Each solid cell is given by one rank at least,
 * whichever; what lies outside the box is left out. Nothing is kept. BW_EINPUT names a box that
 * cannot be, BW_EMEM; any error is returned by all ranks. Collective. */
bw_status bw_shape_find_way(const bw_comm *comm, const bw_shape_way_box *box, int64_t n,
                            const int32_t site[], bw_shape_way *way) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
