/* Storage numbering, runs, blocks and slots of bonds. */
#include "bw_memory.h"
#include "bw_particles_order.h"
#include "pd_body.h"

#include <string.h>

/* A box numbering may have this many places per particle, and this many anyway. */
enum { PLACES_PER_PARTICLE = 4, PLACES_FREE = 1 << 16 };

static bw_status number_box(bw_pd_body *pd, const int32_t lower[3], const int64_t size[3])
{
  for (size_t e = 0; e < pd->n_extended; e++) {
    /* The fastest axis of the lattice is the fastest of the numbering: blocks run along it. */
    int64_t place = 0;
    for (int k = 2; k >= 0; k--) {
      const int d = pd->points.axis[k];
      place = place * size[d] + (pd->points.site[3 * e + (size_t)d] - lower[d]);
    }
    pd->points.place[e] = (int32_t)place;
  }
  return BW_OK;
}

static bw_status number_packed(bw_pd_body *pd)
{
  int32_t *order = NULL;
  /* Without holes: storage is as long as there are particles. */
  BW_TRY(BW_ALLOCATE(&order, pd->n_extended));
  const bw_status st =
      bw_pd_body_order(pd, pd->n_extended, pd->points.site, pd->points.level, order);
  for (size_t q = 0; q < pd->n_extended && st == BW_OK; q++)
    pd->points.place[order[q]] = (int32_t)q;
  bw_release(&order);
  return st;
}

static bw_status number(bw_pd_body *pd)
{
  int32_t lower[3] = {0};
  int64_t size[3] = {0};
  double places = pd->n_extended > 0;
  /* The box of the sites, copies among them. */
  for (int k = 0; k < 3 && pd->n_extended > 0; k++) {
    int32_t upper = lower[k] = pd->points.site[k];
    for (size_t e = 1; e < pd->n_extended; e++) {
      const int32_t x = pd->points.site[3 * e + (size_t)k];
      lower[k] = x < lower[k] ? x : lower[k];
      upper = x > upper ? x : upper;
    }
    size[k] = (int64_t)upper - lower[k] + 1;
    places *= (double)size[k];
  }
  /* A box keeps neighbours of successive places successive; a thin body in a wide box would be
   * mostly holes. */
  const bool box =
      pd->finest == 0 && places <= PLACES_PER_PARTICLE * (double)pd->n_extended + PLACES_FREE;
  pd->points.n_storage = box ? (size_t)places : pd->n_extended;
  BW_TRY(box ? number_box(pd, lower, size) : number_packed(pd));
  BW_TRY(BW_ALLOCATE(&pd->points.occupant, pd->points.n_storage));
  /* Holes may be loaded, and are masked out; nobody stands there. */
  memset(pd->points.occupant, 0xff,
         pd->points.n_storage * sizeof *pd->points.occupant); /* all -1 */
  for (size_t e = 0; e < pd->n_extended; e++)
    pd->points.occupant[pd->points.place[e]] = (int32_t)e;
  return BW_OK;
}

/* Maximal stretches of own particles in successive places. */
static bw_status runs(bw_pd_body *pd)
{
  /* Counted in the first pass, written in the second. */
  for (int pass = 0; pass < 2; pass++) {
    size_t r = 0;
    for (size_t i = 0; i < pd->n; i++) {
      const bool follows = i > 0 && pd->points.place[i] == pd->points.place[i - 1] + 1;
      if (!follows) r++;
      if (pass == 0) continue;
      if (!follows) pd->bonds.run[r - 1] = (bw_pd_run){pd->points.place[i], (int32_t)i, 0};
      pd->bonds.run[r - 1].n++;
    }
    pd->bonds.n_run = r;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->bonds.run, r));
  }
  return BW_OK;
}

static bool alike(const bw_pd_body *pd, size_t i, const bw_pd_block *block)
{
  return pd->points.level == NULL || pd->points.level[i] == block->level;
}

/* Greedy: a block starts at the first own particle not yet in one. */
static bw_status blocks(bw_pd_body *pd)
{
  for (int pass = 0; pass < 2; pass++) {
    size_t b = 0;
    for (size_t i = 0; i < pd->n;) {
      /* Lanes that are a hole or a copy stay out of the mask. */
      const int32_t first = pd->points.place[i];
      bw_pd_block block = {.first = first, .own = (int32_t)i, .exact = -1};
      if (pd->points.level != NULL) block.level = pd->points.level[i];
      /* All of one level: its directions are those of all lanes. */
      for (; i < pd->n && pd->points.place[i] < first + BW_PD_LANES && alike(pd, i, &block); i++)
        block.mask |= (uint8_t)(1u << (pd->points.place[i] - first));
      if (pass == 1) pd->bonds.block[b] = block;
      b++;
    }
    pd->bonds.n_block = b;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->bonds.block, b + 1));
  }
  return BW_ALLOCATE(&pd->bonds.hit, pd->bonds.n_block);
}

/* In a cloud a direction of the stencil is a bond only where the particles are near enough. */
static bool beyond_family(const bw_pd_body *pd, int direction, int32_t h, int32_t l)
{
  return pd->config.disorder > 0 && !pd->level->stencil.sure[direction] &&
         !(bw_pd_body_rest(pd, direction, h, l).r0 < pd->level->reach);
}

/* Slots of one direction of a block, to out[] when not NULL; returns how many. */
static int direction_slots(const bw_pd_body *pd, const bw_particles_map *near,
                           const bw_pd_block *block, int direction, bw_pd_slot out[BW_PD_LANES])
{
  /* Lanes whose neighbour in this direction is at the same distance in storage share a slot. */
  const int32_t *o = bw_pd_body_level_of(pd, block)->stencil.offset + 3 * direction;
  int n = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const int32_t *s = pd->points.site + 3 * (size_t)bw_pd_body_owner(block, lane);
    if (pd->finest > 0 && !bw_pd_body_leads(pd, block->level, direction, s)) continue;
    const int32_t e =
        bw_particles_map_get(near, (const int32_t[3]){s[0] + o[0], s[1] + o[1], s[2] + o[2]});
    /* Nobody stands there: the family is cut by a surface. */
    if (e < 0) continue;
    const int32_t base = pd->points.place[e] - lane;
    if (beyond_family(pd, direction, block->first + lane, pd->points.place[e])) continue;
    int q = 0;
    while (q < n && out[q].base != base)
      q++;
    if (q == n) out[n++] = (bw_pd_slot){.base = base, .direction = (uint16_t)direction};
    /* A bond of the family holds until something breaks it. */
    out[q].family |= (uint8_t)(1u << lane);
    out[q].mask = out[q].family;
  }
  return n;
}

/* The group of a block's owners and of all their neighbours, also of those whose bonds break later;
 * BW_PD_MIXED where they differ. */
static uint8_t group_of(const bw_pd_body *pd, const bw_pd_block *block)
{
  int group = -1;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const int own = bw_pd_body_group_at(pd, block->first + lane);
    if (group >= 0 && own != group) return BW_PD_MIXED;
    group = own;
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      const bw_pd_slot *slot = &pd->bonds.slot[q];
      if (!(slot->family >> lane & 1)) continue;
      if (bw_pd_body_group_at(pd, slot->base + lane) != group) return BW_PD_MIXED;
    }
  }
  return (uint8_t)group;
}

/* Kernels look a block's material up once: here its group is decided. */
static void block_groups(bw_pd_body *pd)
{
  if (pd->config.n_group == 1) return; /* 0 everywhere */
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    pd->bonds.block[b].group = group_of(pd, &pd->bonds.block[b]);
}

/* near: site -> extended index. */
bw_status bw_pd_body_slots(bw_pd_body *pd, const bw_particles_map *near)
{
  /* Order matters: places, then how far off its site each stands, then who is near enough. */
  BW_TRY(number(pd));
  if (pd->config.disorder > 0) BW_TRY(bw_pd_body_scatter(pd));
  BW_TRY(runs(pd));
  BW_TRY(blocks(pd));
  bw_pd_slot some[BW_PD_LANES];
  /* Slots in the order of the stencil within each block: sums run alike on any number of ranks. */
  for (int pass = 0; pass < 2; pass++) {
    size_t q = 0;
    for (size_t b = 0; b < pd->bonds.n_block; b++) {
      BW_REQUIRE(q < UINT32_MAX, BW_EINPUT, "solid: too many bonds on one rank; use more ranks");
      pd->bonds.block[b].slot = (uint32_t)q;
      const int directions = pd->level[pd->bonds.block[b].level].stencil.n;
      for (int d = 0; d < directions; d++) {
        const int n = direction_slots(pd, near, &pd->bonds.block[b], d, some);
        if (pass == 1) memcpy(pd->bonds.slot + q, some, (size_t)n * sizeof *some);
        q += (size_t)n;
      }
    }
    pd->bonds.block[pd->bonds.n_block].slot = (uint32_t)q;
    pd->bonds.n_slot = q;
    if (pass == 0) BW_TRY(BW_ALLOCATE(&pd->bonds.slot, q));
  }
  /* Each bond counts from both of its ends, on whichever rank. */
  for (size_t q = 0; q < pd->bonds.n_slot; q++)
    pd->bonds.directed += __builtin_popcount(pd->bonds.slot[q].family);
  block_groups(pd);
  return BW_OK;
}
