/* Storage numbering, runs, blocks and slots of bonds; surface factors. */
#include "bw_memory.h"
#include "pd_bond_internal.h"

#include <math.h>
#include <string.h>

/* A box numbering may have this many places per particle, and this many anyway. */
enum { PLACES_PER_PARTICLE = 4, PLACES_FREE = 1 << 16 };

static bw_status number_box(bw_pd_bond *pd, const int32_t lower[3], const int64_t size[3])
{
  for (size_t e = 0; e < pd->n_extended; e++) {
    int64_t place = 0;
    for (int k = 2; k >= 0; k--) {
      const int d = pd->axis[k];
      place = place * size[d] + (pd->site[3 * e + (size_t)d] - lower[d]);
    }
    pd->place[e] = (int32_t)place;
  }
  return BW_OK;
}

static bw_status number_packed(bw_pd_bond *pd)
{
  int32_t *order = NULL;
  BW_TRY(BW_ALLOCATE(&order, pd->n_extended));
  const bw_status st = bw_pd_bond__lattice_order(pd->axis, pd->n_extended, pd->site, order);
  for (size_t q = 0; q < pd->n_extended && st == BW_OK; q++)
    pd->place[order[q]] = (int32_t)q;
  bw_release(&order);
  return st;
}

static bw_status number(bw_pd_bond *pd)
{
  int32_t lower[3] = {0};
  int64_t size[3] = {0};
  double places = pd->n_extended > 0;
  for (int k = 0; k < 3 && pd->n_extended > 0; k++) {
    int32_t upper = lower[k] = pd->site[k];
    for (size_t e = 1; e < pd->n_extended; e++) {
      const int32_t x = pd->site[3 * e + (size_t)k];
      lower[k] = x < lower[k] ? x : lower[k];
      upper = x > upper ? x : upper;
    }
    size[k] = (int64_t)upper - lower[k] + 1;
    places *= (double)size[k];
  }
  const bool box = places <= PLACES_PER_PARTICLE * (double)pd->n_extended + PLACES_FREE;
  pd->n_storage = box ? (size_t)places : pd->n_extended;
  BW_TRY(box ? number_box(pd, lower, size) : number_packed(pd));
  BW_TRY(BW_ALLOCATE(&pd->occupant, pd->n_storage));
  memset(pd->occupant, 0xff, pd->n_storage * sizeof *pd->occupant); /* all -1 */
  for (size_t e = 0; e < pd->n_extended; e++)
    pd->occupant[pd->place[e]] = (int32_t)e;
  return BW_OK;
}

/* Maximal stretches of own particles in successive places. */
static bw_status runs(bw_pd_bond *pd)
{
  for (int pass = 0; pass < 2; pass++) {
    size_t r = 0;
    for (size_t i = 0; i < pd->n; i++) {
      const bool follows = i > 0 && pd->place[i] == pd->place[i - 1] + 1;
      if (!follows) r++;
      if (pass == 0) continue;
      if (!follows) pd->run[r - 1] = (bw_pd_run){pd->place[i], (int32_t)i, 0};
      pd->run[r - 1].n++;
    }
    pd->n_run = r;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->run, r));
  }
  return BW_OK;
}

/* Greedy: a block starts at the first own particle not yet in one. */
static bw_status blocks(bw_pd_bond *pd)
{
  for (int pass = 0; pass < 2; pass++) {
    size_t b = 0;
    for (size_t i = 0; i < pd->n;) {
      const int32_t first = pd->place[i];
      bw_pd_block block = {.first = first, .own = (int32_t)i};
      for (; i < pd->n && pd->place[i] < first + BW_PD_LANES; i++)
        block.mask |= (uint8_t)(1u << (pd->place[i] - first));
      if (pass == 1) pd->block[b] = block;
      b++;
    }
    pd->n_block = b;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->block, b + 1));
  }
  return BW_ALLOCATE(&pd->hit, pd->n_block);
}

/* In a cloud a direction of the stencil is a bond only where the particles are near enough. */
static bool beyond_family(const bw_pd_bond *pd, int direction, int32_t h, int32_t l)
{
  return !pd->stencil.sure[direction] && !(bw_pd_bond__rest(pd, direction, h, l).r0 <
                                           pd->config.ds * bw_pd_bond__family_reach(&pd->config));
}

/* Slots of one direction of a block, to out[] when not NULL; returns how many. */
static int direction_slots(const bw_pd_bond *pd, const bw_pd_map *near, const bw_pd_block *block,
                           int direction, bw_pd_slot out[BW_PD_LANES])
{
  const int32_t *o = pd->stencil.offset + 3 * direction;
  int n = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const int32_t *s = pd->site + 3 * (size_t)bw_pd_bond__owner(block, lane);
    const int32_t e =
        bw_pd_map_get(near, (const int32_t[3]){s[0] + o[0], s[1] + o[1], s[2] + o[2]});
    if (e < 0) continue;
    const int32_t base = pd->place[e] - lane;
    if (beyond_family(pd, direction, block->first + lane, pd->place[e])) continue;
    int q = 0;
    while (q < n && out[q].base != base)
      q++;
    if (q == n) out[n++] = (bw_pd_slot){.base = base, .direction = (uint16_t)direction};
    out[q].family |= (uint8_t)(1u << lane);
    out[q].mask = out[q].family;
  }
  return n;
}

/* near: site -> extended index. */
bw_status bw_pd_bond__slots(bw_pd_bond *pd, const bw_pd_map *near)
{
  BW_TRY(number(pd));
  if (pd->config.disorder > 0) BW_TRY(bw_pd_bond__scatter(pd));
  BW_TRY(runs(pd));
  BW_TRY(blocks(pd));
  bw_pd_slot some[BW_PD_LANES];
  for (int pass = 0; pass < 2; pass++) {
    size_t q = 0;
    for (size_t b = 0; b < pd->n_block; b++) {
      BW_REQUIRE(q < UINT32_MAX, BW_EINPUT, "pd_bond: too many bonds on one rank; use more ranks");
      pd->block[b].slot = (uint32_t)q;
      for (int d = 0; d < pd->stencil.n; d++) {
        const int n = direction_slots(pd, near, &pd->block[b], d, some);
        if (pass == 1) memcpy(pd->slot + q, some, (size_t)n * sizeof *some);
        q += (size_t)n;
      }
    }
    pd->block[pd->n_block].slot = (uint32_t)q;
    pd->n_slot = q;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->slot, q));
  }
  for (size_t q = 0; q < pd->n_slot; q++)
    pd->bonds_directed += __builtin_popcount(pd->slot[q].family);
  return BW_OK;
}

/* Own factors: volume method, V_h/V_0 (3.44, ERRATA 11); energy method, the ratio of the classical
 * energy of an isotropic dilation to that of the family (Madenci & Oterkus 2014, section 4.2,
 * reduced to one scalar per particle). */
static bw_real surface_factor(const bw_pd_bond *pd, double volume, double first_moment)
{
  const double energy = 0.25 * pd->c0 * first_moment;
  switch (pd->config.surface_correction) {
  case BW_PD_SURFACE_VOLUME:
    return (bw_real)(volume / pd->full_volume);
  case BW_PD_SURFACE_ENERGY:
    return (bw_real)(bw_pd_bond__classical_dilation(&pd->config) / energy);
  default:
    return 1;
  }
}

/* Sums over the family of every own particle: of Gamma dV and of Gamma dV |xi|. A particle without
 * family gets the factor 1, which nothing uses. Collective. */
bw_status bw_pd_bond__surface_factors(bw_pd_bond *pd)
{
  double *volume = NULL, *moment = NULL;
  bw_status st = BW_ALLOCATE(&volume, pd->n);
  BW_THEN(st, BW_ALLOCATE(&moment, pd->n));
  st = bw_comm_agree(pd->comm, st);
  for (size_t b = 0; b < pd->n_block && st == BW_OK; b++)
    for (uint32_t q = pd->block[b].slot; q < pd->block[b + 1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        if (!(pd->slot[q].family >> lane & 1)) continue;
        const int32_t h = bw_pd_bond__owner(&pd->block[b], lane);
        const bw_pd_rest rest = bw_pd_bond__rest(
            pd, pd->slot[q].direction, pd->block[b].first + lane, pd->slot[q].base + lane);
        volume[h] += rest.fraction * pd->dv;
        moment[h] += rest.fraction * pd->dv * rest.r0;
      }
  for (size_t p = 0; p < pd->n_storage && st == BW_OK; p++)
    pd->w[p] = 1;
  for (size_t h = 0; h < pd->n && st == BW_OK; h++)
    if (volume[h] > 0) pd->w[pd->place[h]] = surface_factor(pd, volume[h], moment[h]);
  if (st == BW_OK) bw_pd_bond__fill_places(pd, pd->w);
  bw_release(&volume);
  bw_release(&moment);
  return st;
}

/* alpha of the bond of a lane of a slot (3.43). */
double bw_pd_bond__alpha(const bw_pd_bond *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                         int lane)
{
  const double sum = (double)pd->w[block->first + lane] + (double)pd->w[slot->base + lane];
  switch (pd->config.surface_correction) {
  case BW_PD_SURFACE_VOLUME:
    return 2 / sum;
  case BW_PD_SURFACE_ENERGY:
    return sum / 2;
  case BW_PD_SURFACE_TENSOR:
    return BW_PD_ALPHA_UNIT * pd->alpha[(slot - pd->slot) * BW_PD_LANES + lane];
  default:
    return 1;
  }
}
