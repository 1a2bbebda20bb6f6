/* pd_bond_sweep.h -- the bonds of a slot, BW_PD_LANES at a time.
 *
 * On a lattice xi, |xi| and Gamma are constants of the direction. In a cloud they follow from the
 * places of both ends, which load as the displacements do: no memory per bond but the slots. Both
 * ways a bond seen from its two ends is exactly opposite. `cloud` and `dimension` are constants
 * wherever speed matters: what is not used is not computed. */
#pragma once
#include "pd_bond_vector.h"

#define INLINE static inline __attribute__((always_inline))

typedef struct {
  const bw_pd_block *block;
  const bw_pd_slot *slot;
  const uint16_t *alpha;                           /* (slots, BW_PD_LANES) or NULL */
  const bw_real *row, *u[3], *shift[3], *w, *v[3]; /* storage */
  bw_real *a[3], *damp[3];                         /* own */
  bw_real pair;                                    /* k_d/rho */
  bw_real reach, slope; /* a cloud's Gamma: 0 <= reach - slope |xi| <= 1 */
} sweep;

INLINE sweep sweep_of(const bw_pd_bond *pd)
{
  const bool sharp = pd->config.volume_fraction == BW_PD_FRACTION_NONE;
  return (sweep){.block = pd->block,
                 .slot = pd->slot,
                 .row = pd->stencil.row,
                 .u = {pd->u[0], pd->u[1], pd->u[2]},
                 .shift = {pd->shift[0], pd->shift[1], pd->shift[2]},
                 .w = pd->w,
                 .alpha = pd->alpha,
                 .v = {pd->vs[0], pd->vs[1], pd->vs[2]},
                 .a = {pd->a[0], pd->a[1], pd->a[2]},
                 .damp = {pd->damp[0], pd->damp[1], pd->damp[2]},
                 .pair = (bw_real)(pd->damping_pair / pd->config.rho),
                 .reach = (bw_real)(sharp ? 1 : pd->config.horizon_ratio + 0.5),
                 .slope = (bw_real)(sharp ? 0 : 1 / pd->config.ds)};
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
    vec xi = vec_all(row[BW_PD_XI + k]);
    if (cloud) {
      xi = (vec_load(s->shift[k] + slot->base) - h->shift[k]) + xi;
      x.rest2 = k == 0 ? xi * xi : vec_fma(xi, xi, x.rest2);
    }
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
INLINE vec limit_of(const bw_real *row, const bond *x, bool cloud)
{
  const vec limit = vec_all(row[BW_PD_LIMIT2]);
  return cloud ? limit * x->rest2 : limit;
}
