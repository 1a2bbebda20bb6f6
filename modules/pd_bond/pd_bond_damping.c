/* Damping of three kinds (ERRATA 4), as accelerations:
 *   pair      + k/rho sum_l [(V_l - V_h).e] e Gamma dV     over bonds that hold, e present
 * direction mean      - k/rho (V_h - mean of V_l over the family)  family members by bonds that
 * hold absolute  - k/rho V_h */
#include "pd_bond_sweep.h"

bool bw_pd_bond__damped(const bw_pd_bond *pd)
{
  return pd->damping_pair > 0 || pd->damping_mean > 0 || pd->damping_absolute > 0;
}

typedef struct {
  vec pair[3], difference[3], count;
} damping_sums;

INLINE void add_slot(const sweep *all, const bw_pd_slot *slot, const owners *h, const vec vh[3],
                     bool cloud, damping_sums *s)
{
  const bw_real *row = all->row + slot->direction * BW_PD_ROW;
  const bond x = bond_of(all, slot, row, h, 3, cloud);
  vec dv[3], along = vec_all(0);
  for (int k = 0; k < 3; k++) {
    dv[k] = vec_load(all->v[k] + slot->base) - vh[k];
    along = vec_fma(dv[k], x.z[k], along);
  }
  const vec q = vec_rsqrt(x.r2);
  const lanes holds = lanes_of(slot->mask);
  const vec c = vec_keep(holds, weight_of(all, row, &x, cloud) * along * q * q);
  s->count += vec_keep(holds, vec_all(1));
  for (int k = 0; k < 3; k++) {
    s->pair[k] = vec_fma(c, x.z[k], s->pair[k]);
    s->difference[k] += vec_keep(holds, dv[k]);
  }
}

static void block_damping(const bw_pd_bond *pd, const bw_pd_block *block)
{
  const sweep all = sweep_of(pd);
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(&all, block, 3, cloud);
  const bw_real mean = (bw_real)(pd->damping_mean / pd->config.rho);
  vec vh[3];
  damping_sums s = {0};
  for (int k = 0; k < 3; k++)
    vh[k] = vec_load(pd->vs[k] + block->first);
  for (uint32_t q = block->slot; q < bw_pd_bond__slot_end(block); q++)
    if (pd->slot[q].mask != 0) add_slot(&all, &pd->slot[q], &h, vh, cloud, &s);
  vec some; /* a particle without bonds has no mean */
  for (int k = 0; k < BW_PD_LANES; k++)
    some[k] = s.count[k] > 1 ? s.count[k] : 1;
  for (int k = 0; k < 3; k++)
    vec_put_owners(block, vec_all(all.pair) * s.pair[k] + vec_all(mean) * (s.difference[k] / some),
                   pd->damp[k]);
}

static void add_absolute(bw_pd_bond *pd, size_t from, size_t to)
{
  const bw_real absolute = (bw_real)(pd->damping_absolute / pd->config.rho);
  for (int k = 0; k < 3; k++)
    for (size_t i = from; i < to; i++)
      pd->damp[k][i] -= absolute * pd->v[k][i];
}

void bw_pd_bond__damping_absolute(bw_pd_bond *pd)
{
  if (pd->damping_absolute > 0) add_absolute(pd, 0, pd->n);
}

/* Own velocities and the copies' have to be current. */
void bw_pd_bond__damping(bw_pd_bond *pd, size_t n, const uint32_t list[])
{
  const size_t blocks = list == NULL ? pd->n_block : n;
  for (size_t q = 0; q < blocks; q++) {
    const bw_pd_block *block = &pd->block[list == NULL ? q : list[q]];
    const size_t from = (size_t)block->own;
    block_damping(pd, block);
    if (pd->damping_absolute > 0)
      add_absolute(pd, from, from + (size_t)__builtin_popcount(block->mask));
  }
}
