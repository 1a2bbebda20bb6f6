/* pd_walk.h -- the bonds of a block one by one, with both ends, rest length and weight.
 *
 *   for (bw_pd_walk b = bw_pd_walk_of(pd, block, lanes); bw_pd_walk_next(&b);) ...
 * For whatever is not the sweep of a fast law, which takes BW_PD_LANES bonds at a time
 * (pd_sweep.h). A slot's lanes follow each other, slots come in stencil order: each family is
 * summed in that order on any number of ranks. The bond that is looked at may be cut
 * (bw_pd_body_cut). Local. */
#pragma once
#include "pd_body.h"

#include <math.h>

typedef struct {
  const bw_pd_body *pd;
  bw_pd_slot *slot, *end; /* of the bond; where the block's slots end */
  int32_t first, own;     /* of the block */
  uint8_t mask, asked;    /* lanes of the block: own particles, and those whose bonds are walked */
  bool whole;             /* broken bonds too */
  uint8_t left;           /* lanes of the slot that are still to come */

  /* The bond. */
  int lane;
  int32_t h, l;    /* storage places of owner and neighbour */
  bw_pd_rest rest; /* xi, |xi| [L], Gamma */
  double weight;   /* Gamma dV [L^3] */
} bw_pd_walk;

static inline bw_pd_walk bw_pd_walk_begin(const bw_pd_body *pd, const bw_pd_block *block,
                                          uint8_t asked, bool whole)
{
  return (bw_pd_walk){.pd = pd,
                      .slot = pd->bonds.slot + block[0].slot - 1,
                      .end = pd->bonds.slot + block[1].slot,
                      .first = block->first,
                      .own = block->own,
                      .mask = block->mask,
                      .asked = asked,
                      .whole = whole};
}

/* The bonds that hold, of the owners in these lanes. */
static inline bw_pd_walk bw_pd_walk_of(const bw_pd_body *pd, const bw_pd_block *block,
                                       uint8_t asked)
{
  return bw_pd_walk_begin(pd, block, asked, false);
}

/* Whole families, broken bonds too. */
static inline bw_pd_walk bw_pd_walk_families(const bw_pd_body *pd, const bw_pd_block *block)
{
  return bw_pd_walk_begin(pd, block, block->mask, true);
}

/* Looks at the bond of a lane of the present slot. */
static inline void bw_pd_walk_look(bw_pd_walk *b, int lane)
{
  b->lane = lane;
  b->h = b->first + lane;
  b->l = b->slot->base + lane;
  b->rest = bw_pd_body_rest(b->pd, b->slot->direction, b->h, b->l);
  b->weight = b->rest.fraction * bw_pd_body_level_at(b->pd, b->l)->dv;
}

/* The next bond; false: there is none. */
static inline bool bw_pd_walk_next(bw_pd_walk *b)
{
  while (b->left == 0) {
    if (++b->slot >= b->end) return false;
    b->left = (uint8_t)((b->whole ? b->slot->family : b->slot->mask) & b->asked);
  }
  bw_pd_walk_look(b, __builtin_ctz(b->left));
  b->left = (uint8_t)(b->left & (b->left - 1));
  return true;
}

/* The bond of a lane of a slot, by itself. */
static inline bw_pd_walk bw_pd_walk_at(const bw_pd_body *pd, const bw_pd_block *block,
                                       const bw_pd_slot *slot, int lane)
{
  bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask);
  b.slot = pd->bonds.slot + (slot - pd->bonds.slot);
  bw_pd_walk_look(&b, lane);
  return b;
}

/* The bond's owner among the own particles. */
static inline size_t bw_pd_walk_owner(const bw_pd_walk *b)
{
  return (size_t)(b->own + __builtin_popcount(b->mask & ((1u << b->lane) - 1u)));
}

/* Its present vector y = xi + eta [L]; returns |y|. From the two ends y is exactly opposite. */
static inline double bw_pd_walk_present(const bw_pd_walk *b, double y[3])
{
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    y[k] = b->rest.xi[k] + ((double)b->pd->u[k][b->l] - (double)b->pd->u[k][b->h]);
    r2 += y[k] * y[k];
  }
  return sqrt(r2);
}

/* Whether one of its ends keeps its bonds (BW_PD_UNBREAKABLE). */
static inline bool bw_pd_walk_unbreakable(const bw_pd_walk *b)
{
  const bw_pd_points *p = &b->pd->points;
  return ((p->kind[p->occupant[b->h]] | p->kind[p->occupant[b->l]]) & BW_PD_UNBREAKABLE) != 0;
}
