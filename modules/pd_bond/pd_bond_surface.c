/* Surface corrections by one factor per particle. */
#include "bw_memory.h"
#include "pd_bond.h"
#include "pd_walk.h"

/* Own factors: volume method, V_h/V_0 (3.44, ERRATA 11); energy method, the ratio of the classical
 * energy of an isotropic dilation to that of the family (Madenci & Oterkus 2014, section 4.2,
 * reduced to one scalar per particle). */
static bw_real surface_factor(const bw_pd_body *pd, double volume, double first_moment)
{
  /* 1/4 c0 sum |xi| Gamma dV is what a dilation e stores per volume, over e^2. As the classical one
   * it is proportional to E: the ratio is that of any group. */
  const bw_pd_bond_state *state = bw_pd_bond__state(pd);
  const double energy = 0.25 * state->c0[0][0] * first_moment;
  switch (state->options.surface_correction) {
  case BW_PD_SURFACE_VOLUME:
    return (bw_real)(volume / state->full_volume);
  case BW_PD_SURFACE_ENERGY:
    return (bw_real)(bw_pd_bond__classical_dilation(&pd->config, pd->config.material[0].E) /
                     energy);
  default:
    return 1;
  }
}

/* Sums over the family of every own particle: of Gamma dV and of Gamma dV |xi|. A particle without
 * family gets the factor 1, which nothing uses. Collective. */
bw_status bw_pd_bond__surface_factors(bw_pd_body *pd)
{
  bw_real *w = bw_pd_bond__state(pd)->w;
  double *volume = NULL, *moment = NULL;
  bw_status st = BW_ALLOCATE(&volume, pd->n);
  BW_THEN(st, BW_ALLOCATE(&moment, pd->n));
  st = bw_comm_agree(pd->comm, st);
  for (size_t q = 0; q < pd->bonds.n_block && st == BW_OK; q++)
    for (bw_pd_walk b = bw_pd_walk_families(pd, &pd->bonds.block[q]); bw_pd_walk_next(&b);) {
      volume[bw_pd_walk_owner(&b)] += b.weight;
      moment[bw_pd_walk_owner(&b)] += b.weight * b.rest.r0;
    }
  for (size_t p = 0; p < pd->points.n_storage && st == BW_OK; p++)
    w[p] = 1;
  for (size_t h = 0; h < pd->n && st == BW_OK; h++)
    if (volume[h] > 0) w[pd->points.place[h]] = surface_factor(pd, volume[h], moment[h]);
  /* A bond reads the factors of both ends; those of copies come from their owners. */
  if (st == BW_OK) bw_pd_body_fill_places(pd, w);
  bw_release(&volume);
  bw_release(&moment);
  return st;
}

/* alpha of the bond of a lane of a slot (3.43). */
double bw_pd_bond__alpha(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                         int lane)
{
  const bw_pd_bond_state *state = bw_pd_bond__state(pd);
  const double sum = (double)state->w[block->first + lane] + (double)state->w[slot->base + lane];
  if (block->exact >= 0) {
    const size_t row = (size_t)block->exact + (size_t)(slot - pd->bonds.slot) - block->slot;
    const bool whole = state->options.surface_correction == BW_PD_SURFACE_TENSOR;
    return (whole ? BW_PD_ALPHA_UNIT : 1) *
           (double)pd->bonds.exact[row * BW_PD_LANES + (size_t)lane];
  }
  switch (state->options.surface_correction) {
  case BW_PD_SURFACE_VOLUME:
    return 2 / sum;
  case BW_PD_SURFACE_ENERGY:
    return sum / 2;
  case BW_PD_SURFACE_TENSOR:
    return BW_PD_ALPHA_UNIT * pd->bonds.factor[(slot - pd->bonds.slot) * BW_PD_LANES + lane];
  default:
    return 1;
  }
}
