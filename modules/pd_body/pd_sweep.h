/* pd_sweep.h -- the bonds of a slot, BW_PD_LANES at a time.
 *
 * On a lattice xi, |xi| and Gamma are constants of the direction. In a cloud they follow from the
 * places of both ends, which load as the displacements do: no memory per bond but the slots. Both
 * ways a bond seen from its two ends is exactly opposite. `cloud` and `dimension` are constants
 * wherever speed matters: what is not used is not computed. */
#pragma once
#include "pd_vector.h"

#define INLINE static inline __attribute__((always_inline))

typedef struct {
  const bw_pd_body *pd;
  const bw_pd_block *block;
  const bw_pd_slot *slot;
  const bw_pd_level *level; /* whose rows are (groups, groups, directions, BW_PD_ROW) */
  const bw_real *u[3], *shift[3], *v[3]; /* storage */
  bw_real *a[3], *damp[3];               /* own */
  bw_real reach, slope;                  /* a cloud's Gamma: 0 <= reach - slope |xi| <= 1 */
} sweep;

INLINE sweep sweep_of(const bw_pd_body *pd)
{
  /* Gamma = clamp(m + 1/2 - |xi|/ds), or 1 where cells are not cut (3.33). */
  const bool sharp = pd->config.volume_fraction == BW_PD_FRACTION_NONE;
  return (sweep){.pd = pd,
                 .block = pd->bonds.block,
                 .slot = pd->bonds.slot,
                 .level = pd->level,
                 .u = {pd->u[0], pd->u[1], pd->u[2]},
                 .shift = {pd->points.shift[0], pd->points.shift[1], pd->points.shift[2]},
                 .v = {pd->vs[0], pd->vs[1], pd->vs[2]},
                 .a = {pd->a[0], pd->a[1], pd->a[2]},
                 .damp = {pd->load.damp[0], pd->load.damp[1], pd->load.damp[2]},
                 .reach = (bw_real)(sharp ? 1 : pd->config.horizon_ratio + 0.5),
                 .slope = (bw_real)(sharp ? 0 : 1 / pd->level->ds)};
}

/* Kernel rows of a block's bonds. Where groups meet those of the first: their geometry is that of
 * all. */
INLINE const bw_real *rows_of(const sweep *s, const bw_pd_block *block)
{
  const size_t g = block->group == BW_PD_MIXED ? 0 : block->group;
  const bw_pd_level *level = s->level + block->level;
  return level->row +
         g * (size_t)(s->pd->config.n_group + 1) * (size_t)level->stencil.n * BW_PD_ROW;
}

/* A constant of the law for a slot's bonds: that of the row, or, where groups meet, of each
 * lane. */
INLINE vec constant_of(const sweep *s, const bw_pd_block *block, const bw_pd_slot *slot,
                       const bw_real *row, int column, bool mixed)
{
  if (!mixed) return vec_all(row[column]);
  /* Lanes differ in their groups: each takes its number from the table of its own pair. */
  vec x = vec_all(row[column]);
  const bw_pd_level *level = s->level + block->level;
  const size_t pair = (size_t)level->stencil.n * BW_PD_ROW;
  const bw_real *first = level->row + (size_t)slot->direction * BW_PD_ROW;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(slot->family >> lane & 1)) continue;
    const int g = bw_pd_body_group_at(s->pd, block->first + lane);
    const int h = bw_pd_body_group_at(s->pd, slot->base + lane);
    x[lane] = first[(size_t)(g * s->pd->config.n_group + h) * pair + (size_t)column];
  }
  return x;
}

/* x over the density of a block's owners. */
INLINE vec over_density(const sweep *s, const bw_pd_block *block, double x, bool mixed)
{
  const bw_pd_material *m = s->pd->config.material;
  if (!mixed) return vec_all((bw_real)(x / m[block->group].rho));
  /* Lanes that are no owners stay 0. */
  vec out = vec_all(0);
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask >> lane & 1)
      out[lane] = (bw_real)(x / m[bw_pd_body_group_at(s->pd, block->first + lane)].rho);
  return out;
}

/* A block's owners. */
typedef struct {
  vec u[3], shift[3];
} owners;

INLINE owners owners_of(const sweep *s, const bw_pd_block *block, int dimension, bool cloud)
{
  owners h;
  for (int k = 0; k < dimension; k++) {
    h.u[k] = vec_load(s->u[k] + block->first);
    if (cloud) h.shift[k] = vec_load(s->shift[k] + block->first);
  }
  return h;
}

/* Present bond vectors and their squared lengths; rest2, |xi|^2, in a cloud only. */
typedef struct {
  vec z[3], r2, rest2;
} bond;

INLINE bond bond_of(const sweep *s, const bw_pd_slot *slot, const bw_real *row, const owners *h,
                    int dimension, bool cloud)
{
  bond x;
  for (int k = 0; k < dimension; k++) {
    /* In a cloud the ends are off their sites: the difference is taken as that of displacements. */
    vec xi = vec_all(row[BW_PD_XI + k]);
    if (cloud) {
      xi = (vec_load(s->shift[k] + slot->base) - h->shift[k]) + xi;
      x.rest2 = k == 0 ? xi * xi : vec_fma(xi, xi, x.rest2);
    }
    /* xi + eta. Seen from the other end every operation gives exactly the opposite. */
    x.z[k] = (vec_load(s->u[k] + slot->base) - h->u[k]) + xi;
    x.r2 = k == 0 ? x.z[k] * x.z[k] : vec_fma(x.z[k], x.z[k], x.r2);
  }
  return x;
}

/* What is left of a row's constant in a cloud, given |xi|. */
INLINE vec gamma_of(const sweep *s, vec r0)
{
  return vec_clamp(vec_fnma(vec_all(s->slope), r0, vec_all(s->reach)));
}

/* Gamma dV. */
INLINE vec weight_of(const sweep *s, const bw_real *row, const bond *x, bool cloud)
{
  const vec weight = vec_all(row[BW_PD_WEIGHT]);
  return cloud ? weight * gamma_of(s, x->rest2 * vec_rsqrt(x->rest2)) : weight;
}

/* (|xi| (1 + s0))^2 */
INLINE vec limit_of(const sweep *s, const bw_pd_block *block, const bw_pd_slot *slot,
                    const bw_real *row, const bond *x, bool cloud, bool mixed)
{
  const vec limit = constant_of(s, block, slot, row, BW_PD_LIMIT2, mixed);
  return cloud ? limit * x->rest2 : limit;
}
