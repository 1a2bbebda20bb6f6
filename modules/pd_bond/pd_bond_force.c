/* The bond force 3.39 and the bond energy, block by block.
 *
 * With q = 1/(r S), S = w_h + w_l, T = r^2 S^2 the volume-corrected coefficient is
 *   2 c0 Gamma dV/(rho r0) (r - r0)/(r S) = k q (q r^2 S - r0):
 * one reciprocal root holds the length and the correction. In a cloud it is
 *   2 c0 Gamma dV/rho (r/r0 - 1)/(r S) = K Gamma q (q r^2 S/r0 - 1), with 1/r0 another root. */
#include "pd_bond_sweep.h"

#include <math.h>

/* The sweeps are compiled once per geometry, correction, check, damping, and for lattices and
 * clouds: nothing of that is decided inside their loops. */

/* Acceleration = force times bond vector; inverse2 = 1/r^2. */
typedef struct {
  vec force, inverse2;
} coefficients;

/* The bonds' own factors in units of the row's stiffness. */
INLINE vec stored(const sweep *s, const bw_pd_slot *slot)
{
  return vec_whole(s->alpha + (slot - s->slot) * BW_PD_LANES);
}

INLINE coefficients cloud_coefficient(const sweep *s, const bw_pd_slot *slot, const bw_real *row,
                                      const bond *x, vec wh, bw_pd_surface_correction surface)
{
  const vec q0 = vec_rsqrt(x->rest2);
  const vec k = vec_all(row[BW_PD_STIFFNESS]) * gamma_of(s, x->rest2 * q0);
  if (surface == BW_PD_SURFACE_VOLUME) {
    const vec sum = wh + vec_load(s->w + slot->base), t = x->r2 * sum;
    const vec q = vec_rsqrt(t * sum), qs = q * sum;
    return (coefficients){k * q * vec_fma(t * q, q0, vec_all(-1)), qs * qs};
  }
  const vec q = vec_rsqrt(x->r2), c = k * q * vec_fma(x->r2 * q, q0, vec_all(-1));
  return (coefficients){surface == BW_PD_SURFACE_NONE ? c : c * (wh + vec_load(s->w + slot->base)),
                        q * q};
}

INLINE coefficients coefficient(const sweep *s, const bw_pd_slot *slot, const bw_real *row,
                                const bond *x, vec wh, bw_pd_surface_correction surface, bool cloud)
{
  if (cloud) return cloud_coefficient(s, slot, row, x, wh, surface);
  const vec r2 = x->r2;
  const vec k = vec_all(row[BW_PD_STIFFNESS]), minus_r0 = vec_all(row[BW_PD_MINUS_R0]);
  if (surface == BW_PD_SURFACE_VOLUME) {
    const vec sum = wh + vec_load(s->w + slot->base), t = r2 * sum;
    const vec q = vec_rsqrt(t * sum), qs = q * sum;
    return (coefficients){k * q * vec_fma(q, t, minus_r0), qs * qs};
  }
  const vec q = vec_rsqrt(r2), c = k * vec_fma(minus_r0, q, vec_all(1));
  if (surface == BW_PD_SURFACE_NONE) return (coefficients){c, q * q};
  if (surface == BW_PD_SURFACE_TENSOR) return (coefficients){c * stored(s, slot), q * q};
  return (coefficients){c * (wh + vec_load(s->w + slot->base)), q * q};
}

/* Adds the pair damping of a slot (3.41, ERRATA 4): along the bond, like the force. */
INLINE void add_damping(const sweep *s, const bw_pd_slot *slot, const bw_real *row, const bond *x,
                        vec inverse2, const vec vh[3], int dimension, bool cloud, vec sum[3])
{
  vec along = vec_all(0);
  for (int k = 0; k < dimension; k++)
    along = vec_fma(vec_load(s->v[k] + slot->base) - vh[k], x->z[k], along);
  const vec c = vec_keep(lanes_of(slot->mask),
                         weight_of(s, row, x, cloud) * vec_all(s->pair) * along * inverse2);
  for (int k = 0; k < dimension; k++)
    sum[k] = vec_fma(c, x->z[k], sum[k]);
}

/* Acceleration of one block's owners; returns whether a bond that holds is beyond s0. */
INLINE bool block_force(const sweep *s, const bw_pd_block *block, int dimension, bool cloud,
                        bw_pd_surface_correction surface, bool check, bool damping)
{
  const owners h = owners_of(s, block, dimension, cloud);
  vec vh[3], sum[3], damp[3], wh = vec_load(s->w + block->first);
  lanes beyond = lanes_of(0);
  for (int k = 0; k < dimension; k++) {
    vh[k] = vec_load(s->v[k] + block->first);
    sum[k] = damp[k] = vec_all(0);
  }
  const bw_pd_slot *end = s->slot + bw_pd_bond__slot_end(block);
  for (const bw_pd_slot *slot = s->slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const lanes holds = lanes_of(slot->mask);
    const bw_real *row = s->row + slot->direction * BW_PD_ROW;
    const bond x = bond_of(s, slot, row, &h, dimension, cloud);
    const coefficients c = coefficient(s, slot, row, &x, wh, surface, cloud);
    const vec force = vec_keep(holds, c.force);
    for (int k = 0; k < dimension; k++)
      sum[k] = vec_fma(force, x.z[k], sum[k]);
    if (check) beyond |= vec_above(x.r2, limit_of(row, &x, cloud)) & holds;
    if (damping) add_damping(s, slot, row, &x, c.inverse2, vh, dimension, cloud, damp);
  }
  for (int k = 0; k < dimension; k++) {
    vec_put_owners(block, sum[k], s->a[k]);
    if (damping) vec_put_owners(block, damp[k], s->damp[k]);
  }
  return check && lanes_bits(beyond) != 0;
}

/* Returns how many blocks were noted in hit. */
INLINE size_t sweep_blocks(const sweep *s, size_t n, int dimension, bool cloud,
                           bw_pd_surface_correction surface, bool check, bool damping,
                           uint32_t hit[])
{
  size_t n_hit = 0;
  for (size_t b = 0; b < n; b++) {
    const bool beyond = block_force(s, &s->block[b], dimension, cloud, surface, check, damping);
    if (check && beyond) hit[n_hit++] = (uint32_t)b;
  }
  return n_hit;
}

typedef size_t (*sweep_function)(const sweep *, size_t, uint32_t[]);
#define ONE(name, dimension, cloud, surface, check, damping)                                       \
  static size_t name(const sweep *s, size_t n, uint32_t hit[])                                     \
  {                                                                                                \
    return sweep_blocks(s, n, dimension, cloud, surface, check, damping, hit);                     \
  }
#define FOUR(name, dimension, cloud, surface)                                                      \
  ONE(name, dimension, cloud, surface, false, false)                                               \
  ONE(name##_damped, dimension, cloud, surface, false, true)                                       \
  ONE(name##_check, dimension, cloud, surface, true, false)                                        \
  ONE(name##_check_damped, dimension, cloud, surface, true, true)
#define ALL(name, surface)                                                                         \
  FOUR(name##_2, 2, false, surface)                                                                \
  FOUR(name##_3, 3, false, surface)                                                                \
  FOUR(name##_cloud_2, 2, true, surface)                                                           \
  FOUR(name##_cloud_3, 3, true, surface)
ALL(plain, BW_PD_SURFACE_NONE)
ALL(volume, BW_PD_SURFACE_VOLUME)
ALL(energy, BW_PD_SURFACE_ENERGY)
FOUR(tensor_2, 2, false, BW_PD_SURFACE_TENSOR)
FOUR(tensor_3, 3, false, BW_PD_SURFACE_TENSOR)

#define ROW(name)                                                                                  \
  {                                                                                                \
    {name, name##_damped},                                                                         \
    {                                                                                              \
      name##_check, name##_check_damped                                                            \
    }                                                                                              \
  }
#define ROWS(name)                                                                                 \
  {                                                                                                \
    {ROW(name##_2), ROW(name##_3)},                                                                \
    {                                                                                              \
      ROW(name##_cloud_2), ROW(name##_cloud_3)                                                     \
    }                                                                                              \
  }
static const sweep_function function[4][2][2][2][2] = {
    ROWS(plain), ROWS(volume), ROWS(energy), {{ROW(tensor_2), ROW(tensor_3)}}};

void bw_pd_bond__force(bw_pd_bond *pd, bool check, bool damping)
{
  const sweep s = sweep_of(pd);
  const bool really = check && pd->breakage && isfinite(pd->s0);
  const bool cloud = pd->config.disorder > 0;
  const sweep_function sweep_all =
      function[pd->config.surface_correction][cloud][pd->dimension - 2][really][damping];
  const size_t hits = sweep_all(&s, pd->n_block, pd->hit);
  if (check) pd->n_hit = hits;
}

/* Lanes of a slot whose bond has an unbreakable end. */
static uint8_t unbreakable(const bw_pd_bond *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                           uint8_t lanes_asked)
{
  uint8_t out = 0;
  for (int k = 0; k < BW_PD_LANES; k++)
    if (lanes_asked >> k & 1) {
      const uint8_t kinds =
          pd->kind[pd->occupant[block->first + k]] | pd->kind[pd->occupant[slot->base + k]];
      if (kinds & BW_PD_UNBREAKABLE) out |= (uint8_t)(1u << k);
    }
  return out;
}

/* Break what is beyond s0 in one block and take its force out of a: the sweep that follows a break
 * would give the same but for the rounding of the sum. */
static bool break_block(bw_pd_bond *pd, const sweep *s, bw_pd_block *block)
{
  const bw_pd_surface_correction surface = pd->config.surface_correction;
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(s, block, 3, cloud);
  vec lost[3], wh = vec_load(s->w + block->first);
  bool any = false;
  for (int k = 0; k < 3; k++)
    lost[k] = vec_all(0);
  for (uint32_t q = block->slot; q < bw_pd_bond__slot_end(block); q++) {
    bw_pd_slot *slot = &pd->slot[q];
    const bw_real *row = s->row + slot->direction * BW_PD_ROW;
    const bond x = bond_of(s, slot, row, &h, 3, cloud);
    uint8_t over =
        slot->mask & (uint8_t)~block->gone & lanes_bits(vec_above(x.r2, limit_of(row, &x, cloud)));
    if (over == 0) continue;
    over &= (uint8_t)~unbreakable(pd, block, slot, over);
    const vec c = vec_keep(lanes_of(over), coefficient(s, slot, row, &x, wh, surface, cloud).force);
    for (int k = 0; k < 3; k++)
      lost[k] = vec_fma(c, x.z[k], lost[k]);
    for (int k = 0; k < BW_PD_LANES; k++)
      if (over >> k & 1) bw_pd_bond__break(pd, block, slot, k), any = true;
  }
  for (int lane = 0; any && lane < BW_PD_LANES; lane++)
    for (int k = 0; k < 3; k++)
      if (block->mask >> lane & 1) s->a[k][bw_pd_bond__owner(block, lane)] -= lost[k][lane];
  return any;
}

/* The blocks the force sweep noted; keeps in hit those that changed. */
bool bw_pd_bond__break_hits(bw_pd_bond *pd)
{
  const sweep s = sweep_of(pd);
  size_t kept = 0;
  for (size_t q = 0; q < pd->n_hit; q++)
    if (break_block(pd, &s, &pd->block[pd->hit[q]])) pd->hit[kept++] = pd->hit[q];
  pd->n_hit = kept;
  return kept > 0;
}

/* Half of 1/2 c0 alpha s^2 |xi| Gamma dV dV for each end: summed over ranks, every bond once. */
double bw_pd_bond__elastic_of(const bw_pd_bond *pd, const bw_pd_block *block, uint8_t lanes_asked)
{
  const sweep s = sweep_of(pd);
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(&s, block, 3, cloud);
  vec sum = vec_all(0), wh = vec_load(s.w + block->first);
  for (uint32_t q = block->slot; q < bw_pd_bond__slot_end(block); q++) {
    const bw_real *row = s.row + s.slot[q].direction * BW_PD_ROW;
    const bond x = bond_of(&s, &s.slot[q], row, &h, 3, cloud);
    vec r0 = vec_all(row[BW_PD_R0]), k = vec_all(row[BW_PD_STIFFNESS]);
    if (cloud) {
      const vec q0 = vec_rsqrt(x.rest2);
      r0 = x.rest2 * q0;
      k *= gamma_of(&s, r0) * q0;
    }
    const vec both = wh + vec_load(s.w + s.slot[q].base);
    const vec alpha = pd->config.surface_correction == BW_PD_SURFACE_VOLUME   ? 1 / both
                      : pd->config.surface_correction == BW_PD_SURFACE_ENERGY ? both
                      : pd->config.surface_correction == BW_PD_SURFACE_TENSOR
                          ? stored(&s, &s.slot[q])
                          : vec_all(1);
    const vec stretch = x.r2 * vec_rsqrt(x.r2) - r0;
    sum += vec_keep(lanes_of(s.slot[q].mask & lanes_asked), k * alpha * stretch * stretch);
  }
  return 0.25 * pd->config.rho * pd->dv * vec_sum(sum);
}

double bw_pd_bond__elastic(const bw_pd_bond *pd)
{
  double energy = 0;
  for (size_t b = 0; b < pd->n_block; b++)
    energy += bw_pd_bond__elastic_of(pd, &pd->block[b], (uint8_t)~pd->block[b].gone);
  return energy;
}
