/* Damage, bonds one by one, and values of the copies. */
#include "pd_law.h"

#include <math.h>
#include <string.h>

/* What a bond counts for in its owner's family. */
static double share(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                    int lane)
{
  const double gamma =
      bw_pd_body_rest(pd, slot->direction, block->first + lane, slot->base + lane).fraction;
  const bw_pd_level *own = bw_pd_body_level_of(pd, block);
  if (slot->direction < own->stencil.same) return gamma;
  /* Between levels by its stiffness, beside that of a bond of the own level. */
  const bw_pd_level *other = pd->level + own->stencil.other[slot->direction];
  return gamma * bw_pd_level_coarser(own, other)->stiff / own->stiff * other->dv / own->dv;
}

void bw_pd_body_get_damage(const bw_pd_body *pd, double damage[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(pd->bonds.block[b].mask >> lane & 1)) continue;
      /* POROUS 3.28 counts volume: a partner at the rim counts for the part of its cell. */
      double family = 0, intact = 0;
      for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++) {
        if (!(pd->bonds.slot[q].family >> lane & 1)) continue;
        const double gamma = share(pd, &pd->bonds.block[b], &pd->bonds.slot[q], lane);
        family += gamma;
        if (pd->bonds.slot[q].mask >> lane & 1) intact += gamma;
      }
      /* A particle that never had a bond is whole. */
      damage[bw_pd_body_owner(&pd->bonds.block[b], lane)] = family > 0 ? 1 - intact / family : 0;
    }
}

/* The block of own particle h: the last that starts at or before it. */
static size_t block_of(const bw_pd_body *pd, size_t h)
{
  /* Blocks are in the order of own particles: halving finds it. */
  size_t low = 0, high = pd->bonds.n_block;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if ((size_t)pd->bonds.block[middle].own <= h)
      low = middle;
    else
      high = middle;
  }
  return low;
}

int bw_pd_body_links(const bw_pd_body *pd, size_t h, bw_pd_link link[])
{
  const bw_pd_block *block = &pd->bonds.block[block_of(pd, h)];
  const int lane = pd->points.place[h] - block->first;
  int n = 0;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    /* Bonds that broke stay listed: they are family still. */
    if (!(slot->family >> lane & 1)) continue;
    link[n++] = (bw_pd_link){.neighbour = pd->points.occupant[slot->base + lane],
                             .slot = (int16_t)slot->direction,
                             .intact = (slot->mask >> lane & 1) != 0};
  }
  return n;
}

bw_pd_extended bw_pd_body_get_extended(bw_pd_body *pd)
{
  double X[3];
  /* A step leaves the copies current; who set a state has not told them yet. */
  if (!pd->current) bw_pd_body_refresh(pd, false);
  for (size_t e = 0; e < pd->n_extended; e++) {
    bw_pd_body_reference(pd, e, X);
    for (size_t k = 0; k < 3; k++)
      pd->halo.extended_X[3 * e + k] = (bw_real)(X[k] + (double)pd->u[k][pd->points.place[e]]);
  }
  return (bw_pd_extended){.n = pd->n_extended, .id = pd->points.id, .X = pd->halo.extended_X};
}

bw_pd_motion bw_pd_body_get_motion(bw_pd_body *pd, bool velocity)
{
  /* Velocities of copies are not kept current: they are asked for. */
  if (velocity || !pd->current) bw_pd_body_refresh(pd, velocity);
  bw_pd_motion m = {.place = pd->points.place};
  for (int k = 0; k < 3; k++) {
    m.u[k] = pd->u[k];
    m.v[k] = velocity ? pd->vs[k] : NULL;
  }
  return m;
}

void bw_pd_body_fill_extended(bw_pd_body *pd, size_t bytes, const void *own, void *all)
{
  bw_particles_copies_values(pd->halo.copies, bytes, own, all);
}

void bw_pd_body_sum_extended(bw_pd_body *pd, double *all)
{
  bw_particles_copies_sum(pd->halo.copies, 3, all);
}

double bw_pd_body_length(const bw_pd_body *pd, int32_t h, const bw_pd_slot *slot, int lane,
                         const double xi[3])
{
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    /* The difference first: displacements may be much larger than what a bond stretches. */
    const bw_real z = (pd->u[k][slot->base + lane] - pd->u[k][h]) + (bw_real)xi[k];
    r2 += (double)z * (double)z;
  }
  return sqrt(r2);
}

void bw_pd_body_cut(bw_pd_body *pd, bw_pd_block *block, bw_pd_slot *slot, int lane)
{
  /* Each end books half of what the bond held, so that the sum over ranks counts it once. */
  pd->bonds.released += pd->law->bond_energy(pd, block, slot, lane);
  slot->mask = (uint8_t)(slot->mask ^ (1u << lane));
  block->broken = true;
  pd->bonds.events++;
}

void bw_pd_body_get_broken(const bw_pd_body *pd, uint16_t broken[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    uint16_t lost[BW_PD_LANES] = {0};
    for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++) {
      const unsigned gone = (unsigned)(pd->bonds.slot[q].family & ~pd->bonds.slot[q].mask);
      if (gone == 0) continue; /* nearly always */
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        lost[lane] = (uint16_t)(lost[lane] + (gone >> lane & 1u));
    }
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (pd->bonds.block[b].mask >> lane & 1)
        broken[bw_pd_body_owner(&pd->bonds.block[b], lane)] = lost[lane];
  }
}
