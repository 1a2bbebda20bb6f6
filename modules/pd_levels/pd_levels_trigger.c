/* How near to breaking particles are. */
#include "bw_memory.h"
#include "bw_pd_levels.h"
#include "pd_law.h"
#include "pd_sweep.h"

#include <string.h>

enum { TAME = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE }; /* kinds of which nothing is asked */

/* Lanes of a slot with an unbreakable end. */
static uint8_t unbreakable(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                           uint8_t asked)
{
  uint8_t out = 0;
  for (int k = 0; k < BW_PD_LANES; k++)
    if (asked >> k & 1) {
      const uint8_t kinds = pd->points.kind[pd->points.occupant[block->first + k]] |
                            pd->points.kind[pd->points.occupant[slot->base + k]];
      if (kinds & BW_PD_UNBREAKABLE) out |= (uint8_t)(1u << k);
    }
  return out;
}

/* r > |xi| + share (limit - |xi|): the stretch is beyond that share of the critical one. */
INLINE lanes beyond(vec r2, vec r0, vec limit, double share)
{
  const vec r = vec_fma(limit - r0, vec_all((bw_real)share), r0);
  return vec_above(r2, r * r);
}

/* Squared length that a bond will have after `time` if its ends move on as they do. */
INLINE vec later(const sweep *s, const bw_pd_block *block, const bw_pd_slot *slot, const bond *x,
                 double time)
{
  vec r2 = vec_all(0);
  for (int k = 0; k < 3; k++) {
    const vec apart = vec_load(s->v[k] + slot->base) - vec_load(s->v[k] + block->first);
    const vec z = vec_fma(apart, vec_all((bw_real)time), x->z[k]);
    r2 = vec_fma(z, z, r2);
  }
  return r2;
}

/* Lanes of a block with a bond that is hot, and with one that is warm. */
static void look_at(const sweep *s, const bw_pd_block *block, const bw_pd_levels_glance *g,
                    uint8_t out[2])
{
  /* In the finest particles nothing has to be foreseen: they may break. */
  const bool foresee = block->level < s->pd->finest;
  const double soon = 0.5 * (1 + g->hot);
  const owners h = owners_of(s, block, 3, false);
  const bw_real *rows = rows_of(s, block);
  const bool mixed = block->group == BW_PD_MIXED;
  for (const bw_pd_slot *slot = s->slot + block->slot; slot < s->slot + bw_pd_body_slot_end(block);
       slot++) {
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const bond x = bond_of(s, slot, row, &h, 3, false);
    const vec limit2 = limit_of(s, block, slot, row, &x, false, mixed);
    const vec r0 = vec_all(row[BW_PD_R0]), limit = limit2 * vec_rsqrt(limit2);
    lanes is = beyond(x.r2, r0, limit, g->hot);
    if (foresee) is |= beyond(later(s, block, slot, &x, g->time), r0, limit, soon);
    uint8_t found[2] = {slot->mask & lanes_bits(is),
                        slot->mask & lanes_bits(beyond(x.r2, r0, limit, g->warm))};
    if ((found[0] | found[1]) == 0) continue;
    const uint8_t never = unbreakable(s->pd, block, slot, found[0] | found[1]);
    out[0] |= (uint8_t)(found[0] & ~never);
    out[1] |= (uint8_t)(found[1] & ~never);
  }
}

/* Collective. */
static void by_stretch(bw_pd_body *pd, const bw_pd_levels_glance *g, uint8_t flag[])
{
  bw_pd_body_refresh(pd, true);
  const sweep s = sweep_of(pd);
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    uint8_t lane_bits[2] = {0, 0};
    look_at(&s, block, g, lane_bits);
    for (int lane = 0; (lane_bits[0] | lane_bits[1]) != 0 && lane < BW_PD_LANES; lane++)
      if ((block->mask & ~block->gone) >> lane & 1)
        flag[bw_pd_body_owner(block, lane)] =
            (uint8_t)((lane_bits[0] >> lane & 1 ? BW_PD_LEVELS_HOT : 0) |
                      (lane_bits[1] >> lane & 1 ? BW_PD_LEVELS_WARM : 0));
  }
}

/* value (n) <- energy per volume of those that may break, over the largest of all; 0 where even
 * that one is of rounding: strains of some units in the last place. Collective. */
static void energies(const bw_pd_body *pd, double value[])
{
  const double noise = 1e2 * BW_REAL_EPSILON, least = pd->config.material[0].E * noise * noise;
  double most = 0;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(block, lane);
      const bool tame = (pd->points.kind[i] & TAME) != 0;
      value[i] =
          tame ? 0
               : pd->law->energy(pd, block, (uint8_t)(1u << lane)) / bw_pd_body_level(pd, i)->dv;
      most = fmax(most, value[i]);
    }
  }
  bw_comm_max(pd->comm, 1, &most);
  for (size_t i = 0; i < pd->n; i++)
    value[i] = most > least ? value[i] / most : 0;
}

bw_status bw_pd_levels_look(bw_pd_body *pd, const bw_pd_levels_glance *g, uint8_t flag[])
{
  double *value = NULL;
  memset(flag, 0, pd->n);
  if (g->trigger == BW_PD_LEVELS_STRETCH) {
    by_stretch(pd, g, flag);
    return BW_OK;
  }
  BW_TRY(bw_comm_agree(pd->comm, BW_ALLOCATE(&value, pd->n)));
  if (g->trigger == BW_PD_LEVELS_ENERGY)
    energies(pd, value);
  else
    bw_pd_body_get_damage(pd, value);
  for (size_t i = 0; i < pd->n; i++)
    if (!(pd->points.kind[i] & (TAME | BW_PD_RETIRED)))
      flag[i] = (uint8_t)((value[i] > g->hot ? BW_PD_LEVELS_HOT : 0) |
                          (value[i] > g->warm ? BW_PD_LEVELS_WARM : 0));
  bw_release(&value);
  return BW_OK;
}
