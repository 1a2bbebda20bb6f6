/* Damping of three kinds (ERRATA 4), as accelerations:
 *   pair      + k/rho sum_l [(V_l - V_h).e] e Gamma dV     over bonds that hold, e as they lie now
 *   mean      - k/rho (V_h - mean of V_l over the family)  members by bonds that hold
 *   absolute  - k/rho V_h */
#include "bw_pd_tensor.h"
#include "pd_sweep.h"
#include "pd_walk.h"

bool bw_pd_body_damped(const bw_pd_body *pd)
{
  return pd->damping.pair > 0 || pd->damping.mean > 0 || pd->damping.absolute > 0;
}

typedef struct {
  vec pair[3], difference[3], count;
} damping_sums;

INLINE void add_slot(const sweep *all, const bw_real *rows, const bw_pd_slot *slot, const owners *h,
                     const vec vh[3], bool cloud, damping_sums *s)
{
  /* The present bond, as the force sees it. */
  const bw_real *row = rows + slot->direction * BW_PD_ROW;
  const bond x = bond_of(all, slot, row, h, 3, cloud);
  vec dv[3], along = vec_all(0);
  for (int k = 0; k < 3; k++) {
    dv[k] = vec_load(all->v[k] + slot->base) - vh[k];
    along = vec_fma(dv[k], x.z[k], along);
  }
  /* Pairs: the part of the difference along the bond, (dv.z) z/r^2 (3.41, ERRATA 4). */
  const vec q = vec_rsqrt(x.r2);
  const lanes holds = lanes_of(slot->mask);
  const vec c = vec_keep(holds, weight_of(all, row, &x, cloud) * along * q * q);
  /* Mean: the difference itself, over the bonds that hold (FSI 9). */
  s->count += vec_keep(holds, vec_all(1));
  for (int k = 0; k < 3; k++) {
    s->pair[k] = vec_fma(c, x.z[k], s->pair[k]);
    s->difference[k] += vec_keep(holds, dv[k]);
  }
}

static void block_damping(const bw_pd_body *pd, const bw_pd_block *block)
{
  /* Geometry of a slot is that of all groups; only the density differs, lane by lane. */
  const sweep all = sweep_of(pd);
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(&all, block, 3, cloud);
  const bool mixed = block->group == BW_PD_MIXED;
  const vec pair = over_density(&all, block, pd->damping.pair, mixed);
  const vec mean = over_density(&all, block, pd->damping.mean, mixed);
  const bw_real *rows = rows_of(&all, block);
  vec vh[3];
  damping_sums s = {0};
  /* Copies' velocities lie in storage beside the owners'. */
  for (int k = 0; k < 3; k++)
    vh[k] = vec_load(pd->vs[k] + block->first);
  for (uint32_t q = block->slot; q < bw_pd_body_slot_end(block); q++)
    if (pd->bonds.slot[q].mask != 0) add_slot(&all, rows, &pd->bonds.slot[q], &h, vh, cloud, &s);
  /* load.damp is written, not added to: absolute damping comes on top. */
  vec some; /* a particle without bonds has no mean */
  for (int k = 0; k < BW_PD_LANES; k++)
    some[k] = s.count[k] > 1 ? s.count[k] : 1;
  for (int k = 0; k < 3; k++)
    vec_put_owners(block, pair * s.pair[k] + mean * (s.difference[k] / some), pd->load.damp[k]);
}

static void add_absolute(bw_pd_body *pd, size_t from, size_t to)
{
  for (int k = 0; k < 3; k++)
    for (size_t i = from; i < to; i++) {
      const double rho = bw_pd_body_material(pd, i)->rho;
      pd->load.damp[k][i] -= (bw_real)(pd->damping.absolute / rho) * pd->v[k][i];
    }
}

void bw_pd_body_damp_absolute(bw_pd_body *pd)
{
  if (pd->damping.absolute > 0) add_absolute(pd, 0, pd->n);
}

/* Own velocities and the copies' have to be current. */
void bw_pd_body_damp(bw_pd_body *pd, size_t n, const uint32_t list[])
{
  const size_t blocks = list == NULL ? pd->bonds.n_block : n;
  for (size_t q = 0; q < blocks; q++) {
    const bw_pd_block *block = &pd->bonds.block[list == NULL ? q : list[q]];
    const size_t from = (size_t)block->own;
    block_damping(pd, block);
    if (pd->damping.absolute > 0)
      add_absolute(pd, from, from + (size_t)__builtin_popcount(block->mask));
  }
}

/* The law's partner of this bound says why a sum of dyads bounds a network (pd_tensor_bound.h). */
bw_status bw_pd_body_damping_bound(bw_pd_body *pd)
{
  double most = 0;
  bw_status st = BW_OK;
  for (size_t b = 0; b < pd->bonds.n_block && st == BW_OK; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    double t[BW_PD_LANES][BW_PD_SYMMETRIC] = {{0}}, value[BW_PD_LANES][3];
    for (bw_pd_walk x = bw_pd_walk_families(pd, block); bw_pd_walk_next(&x);)
      bw_pd_tensor_add_dyad(x.weight, x.rest.xi, x.rest.r0, t[x.lane]);
    st = bw_pd_tensor_principal(BW_PD_LANES, t[0], value[0], NULL);
    for (int lane = 0; lane < BW_PD_LANES && st == BW_OK; lane++)
      most = fmax(most, value[lane][0]);
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_comm_max(pd->comm, 1, &most);
  pd->damping.most_weight = most;
  return BW_OK;
}
