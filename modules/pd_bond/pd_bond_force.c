/* The bond force 3.39 and the bond energy, block by block.
 *
 * With q = 1/(r S), S = w_h + w_l, T = r^2 S^2 the volume-corrected coefficient is
 *   2 c0 Gamma dV/(rho r0) (r - r0)/(r S) = k q (q r^2 S - r0):
 * one reciprocal root holds the length and the correction. */
#include "pd_bond_vector.h"

#include <math.h>

/* The sweeps are compiled once per geometry, correction and check: nothing of that is decided
 * inside their loops. */
#define INLINE static inline __attribute__((always_inline))

typedef struct {
  const bw_pd_block *block;
  const bw_pd_slot *slot;
  const bw_real *row, *u[3], *w;
  bw_real *a[3];
} sweep;

typedef struct {
  vec z[3], r2;
} bond;

/* Present bond vectors of a slot, with the block's displacement uh. */
INLINE bond bond_of(const sweep *s, const bw_pd_slot *slot, const bw_real *row, const vec uh[3],
                    int dimension)
{
  bond x;
  for (int k = 0; k < dimension; k++)
    x.z[k] = (vec_load(s->u[k] + slot->base) - uh[k]) + vec_all(row[BW_PD_XI + k]);
  x.r2 = x.z[0] * x.z[0];
  for (int k = 1; k < dimension; k++)
    x.r2 = vec_fma(x.z[k], x.z[k], x.r2);
  return x;
}

/* Force coefficient: acceleration = coefficient times bond vector. */
INLINE vec coefficient(const sweep *s, const bw_pd_slot *slot, const bw_real *row, vec r2, vec wh,
                       bw_pd_surface_correction surface)
{
  const vec k = vec_all(row[BW_PD_STIFFNESS]), minus_r0 = vec_all(row[BW_PD_MINUS_R0]);
  if (surface == BW_PD_SURFACE_VOLUME) {
    const vec sum = wh + vec_load(s->w + slot->base), t = r2 * sum;
    const vec q = vec_rsqrt(t * sum);
    return k * q * vec_fma(q, t, minus_r0);
  }
  const vec q = vec_rsqrt(r2), c = k * vec_fma(minus_r0, q, vec_all(1));
  return surface == BW_PD_SURFACE_NONE ? c : c * (wh + vec_load(s->w + slot->base));
}

/* Acceleration of one block's owners; returns whether a bond that holds is beyond s0. */
INLINE bool block_force(const sweep *s, const bw_pd_block *block, int dimension,
                        bw_pd_surface_correction surface, bool check)
{
  vec uh[3], sum[3], wh = vec_load(s->w + block->first);
  lanes beyond = lanes_of(0);
  for (int k = 0; k < dimension; k++) {
    uh[k] = vec_load(s->u[k] + block->first);
    sum[k] = vec_all(0);
  }
  const bw_pd_slot *end = s->slot + block[1].slot;
  for (const bw_pd_slot *slot = s->slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const lanes holds = lanes_of(slot->mask);
    const bw_real *row = s->row + slot->direction * BW_PD_ROW;
    const bond x = bond_of(s, slot, row, uh, dimension);
    const vec c = vec_keep(holds, coefficient(s, slot, row, x.r2, wh, surface));
    for (int k = 0; k < dimension; k++)
      sum[k] = vec_fma(c, x.z[k], sum[k]);
    if (check) beyond |= vec_above(x.r2, vec_all(row[BW_PD_LIMIT2])) & holds;
  }
  for (int k = 0; k < dimension; k++)
    vec_put_owners(block, sum[k], s->a[k]);
  return check && lanes_bits(beyond) != 0;
}

/* All blocks, or those of a list; returns how many were noted in hit. */
INLINE size_t sweep_blocks(const sweep *s, size_t n, const uint32_t list[], int dimension,
                           bw_pd_surface_correction surface, bool check, uint32_t hit[])
{
  size_t n_hit = 0;
  for (size_t q = 0; q < n; q++) {
    const uint32_t b = list == NULL ? (uint32_t)q : list[q];
    const bool beyond = block_force(s, &s->block[b], dimension, surface, check);
    if (check && beyond) hit[n_hit++] = b;
  }
  return n_hit;
}

/* One compiled sweep per geometry, correction and check. */
typedef size_t (*sweep_function)(const sweep *, size_t, const uint32_t[], uint32_t[]);
#define SWEEP(name, dimension, surface, check)                                                     \
  static size_t name(const sweep *s, size_t n, const uint32_t list[], uint32_t hit[])              \
  {                                                                                                \
    return sweep_blocks(s, n, list, dimension, surface, check, hit);                               \
  }
SWEEP(plain_2, 2, BW_PD_SURFACE_NONE, false)
SWEEP(plain_3, 3, BW_PD_SURFACE_NONE, false)
SWEEP(plain_2_check, 2, BW_PD_SURFACE_NONE, true)
SWEEP(plain_3_check, 3, BW_PD_SURFACE_NONE, true)
SWEEP(volume_2, 2, BW_PD_SURFACE_VOLUME, false)
SWEEP(volume_3, 3, BW_PD_SURFACE_VOLUME, false)
SWEEP(volume_2_check, 2, BW_PD_SURFACE_VOLUME, true)
SWEEP(volume_3_check, 3, BW_PD_SURFACE_VOLUME, true)
SWEEP(energy_2, 2, BW_PD_SURFACE_ENERGY, false)
SWEEP(energy_3, 3, BW_PD_SURFACE_ENERGY, false)
SWEEP(energy_2_check, 2, BW_PD_SURFACE_ENERGY, true)
SWEEP(energy_3_check, 3, BW_PD_SURFACE_ENERGY, true)

static const sweep_function function[3][2][2] = {
    {{plain_2, plain_2_check}, {plain_3, plain_3_check}},
    {{volume_2, volume_2_check}, {volume_3, volume_3_check}},
    {{energy_2, energy_2_check}, {energy_3, energy_3_check}}};

static sweep sweep_of(const bw_pd_bond *pd)
{
  return (sweep){.block = pd->block,
                 .slot = pd->slot,
                 .row = pd->stencil.row,
                 .u = {pd->u[0], pd->u[1], pd->u[2]},
                 .w = pd->w,
                 .a = {pd->a[0], pd->a[1], pd->a[2]}};
}

void bw_pd_bond__force(bw_pd_bond *pd, size_t n, const uint32_t list[], bool check)
{
  const sweep s = sweep_of(pd);
  const bool really = check && pd->breakage && isfinite(pd->s0);
  const size_t hits = function[pd->config.surface_correction][pd->dimension - 2][really](
      &s, list == NULL ? pd->n_block : n, list, pd->hit);
  if (check) pd->n_hit = hits;
}

/* Half of 1/2 c0 alpha s^2 |xi| Gamma dV dV for each end: summed over ranks, every bond once. */
double bw_pd_bond__elastic(const bw_pd_bond *pd)
{
  const sweep s = sweep_of(pd);
  double energy = 0;
  for (size_t b = 0; b < pd->n_block; b++) {
    const bw_pd_block *block = &pd->block[b];
    vec uh[3], sum = vec_all(0), wh = vec_load(s.w + block->first);
    for (int k = 0; k < 3; k++)
      uh[k] = vec_load(s.u[k] + block->first);
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      const bw_real *row = s.row + s.slot[q].direction * BW_PD_ROW;
      const vec r2 = bond_of(&s, &s.slot[q], row, uh, 3).r2;
      const vec both = wh + vec_load(s.w + s.slot[q].base);
      const vec alpha = pd->config.surface_correction == BW_PD_SURFACE_VOLUME   ? 1 / both
                        : pd->config.surface_correction == BW_PD_SURFACE_ENERGY ? both
                                                                                : vec_all(1);
      const vec stretch = r2 * vec_rsqrt(r2) - vec_all(row[BW_PD_R0]);
      sum += vec_keep(lanes_of(s.slot[q].mask),
                      vec_all(row[BW_PD_STIFFNESS]) * alpha * stretch * stretch);
    }
    energy += vec_sum(sum);
  }
  return 0.25 * pd->config.rho * pd->dv * energy;
}
