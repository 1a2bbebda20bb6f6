/* pd_state_ordinary.h -- state of the ordinary law. */
#pragma once
#include "pd_state.h"

typedef struct {
  bw_pd_state_ordinary_options options;
  double crossing[BW_PD_FINEST + 1]; /* of each level: sum of Gamma dV xi.n over half of a full
                                        family [L^4] */
  double lam[BW_PD_GROUPS], mu[BW_PD_GROUPS]; /* lam* and mu [M/(L T^2)] */
  bool dilates;                               /* some lam* is not mu: theta counts */
  bool breakable;                             /* some limit is finite */
  bw_real *q;             /* storage: sum of w |xi|^2 Gamma dV over the family */
  bw_real *stiff;         /* storage: d (d + 2) mu/q */
  bw_real *swell;         /* storage: d^2 (lam* - mu)/q^2 */
  bw_real *own, *reverse; /* (n_exact, lanes) of bonds near jumps between levels: w Gamma dV in the
                             family of the owner, and in that of the partner [w L^3]; NULL: none */
  bw_real *pull;          /* storage: d (lam* - mu) theta/q; copies after the first pass */
} bw_pd_ordinary;

static inline bw_pd_ordinary *bw_pd_ordinary_of(const bw_pd_body *pd)
{
  return (bw_pd_ordinary *)pd->state;
}

/* w of a bond. */
static inline double bw_pd_ordinary_influence(const bw_pd_ordinary *o, double r0)
{
  return o->options.influence == BW_PD_STATE_INVERSE ? 1 / r0 : 1;
}

/* Columns of the kernel rows: LIMIT2 is twice the energy of a bond that breaks, over w, by the
 * owner's level; this one by the partner's. */
enum { BW_PD_PARTNER_LIMIT = BW_PD_MINUS_R0 };

/* Where own and reverse have a bond's numbers; of blocks that are near a jump. */
static inline size_t bw_pd_ordinary_near(const bw_pd_body *pd, const bw_pd_block *block,
                                         const bw_pd_slot *slot)
{
  return ((size_t)block->exact + (size_t)(slot - pd->bonds.slot) - block->slot) * BW_PD_LANES;
}

/* w Gamma dV of a bond in the family of its owner. */
static inline double bw_pd_ordinary_weight(const bw_pd_body *pd, const bw_pd_block *block,
                                           const bw_pd_walk *b)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  return o->own != NULL && block->exact >= 0
             ? (double)o->own[bw_pd_ordinary_near(pd, block, b->slot) + (size_t)b->lane]
             : bw_pd_ordinary_influence(o, b->rest.r0) * b->weight;
}

/* Whether a bond is beyond its limit. Local. */
bool bw_pd_state__ordinary_beyond(const bw_pd_body *pd, const bw_pd_level *level,
                                  const bw_pd_walk *b);

/* pd_state_ordinary_sweep.c: q of all families, copies too. Collective. */
void bw_pd_state__ordinary_moments(bw_pd_body *pd);
/* pd_state_ordinary_weights.c: own, reverse and q of a body of several levels. BW_EMEM, BW_EINPUT:
 * too many bonds near jumps. Collective. */
bw_status bw_pd_state__ordinary_levels(bw_pd_body *pd) BW_MUST_CHECK;

/* pd_state_ordinary_sweep.c: the passes, and the product with the tangent. */
void bw_pd_state__ordinary_dilate(bw_pd_body *pd, size_t first, size_t last, bool check,
                                  bool damping);
void bw_pd_state__ordinary_force(bw_pd_body *pd, size_t first, size_t last, bool check,
                                 bool damping);
void bw_pd_state__ordinary_tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[]);
