/* pd_springs.h -- the members of a law of springs, all made of one function.
 *
 * A spring pulls along its bond, by what this bond alone does. A source that says
 *   #define BW_PD_SPRING my_spring
 *   #include "pd_springs.h"
 * writes my_spring(pd, b, r), what the bond b does when it is r long, and puts the members below
 * that are of use to it in the table of its law. They are compiled together with my_spring: nothing
 * is called per bond.
 *   L_h = sum_l f e Gamma dV_l,   energy 1/2 sum_h sum_l w Gamma dV_h dV_l,   f = dw/dr
 * over the bonds that hold, e the present direction. A law whose speed matters writes a sweep that
 * takes BW_PD_LANES bonds at a time, as pd_bond does. */
#pragma once
#include "pd_law.h"
#include "pd_tensor_bound.h"
#include "pd_walk.h"

#ifndef BW_PD_SPRING
#error "say which function is the spring: #define BW_PD_SPRING name"
#endif

/* What a bond does at a length. */
typedef struct {
  double force;     /* f, positive when it pulls [M/(L^5 T^2)] */
  double energy;    /* w [M/(L^4 T^2)] */
  double stiffness; /* df/dr [M/(L^6 T^2)] */
  double steepest;  /* the largest df/dr at any length at which it holds [M/(L^6 T^2)] */
  bool beyond;      /* it breaks */
} bw_pd_spring;

static bw_pd_spring BW_PD_SPRING(const bw_pd_body *pd, const bw_pd_walk *b, double r);

/* The only pass: a = L/rho, and the blocks that hold a bond beyond its limit. */
static inline void bw_pd_springs_sweep(bw_pd_body *pd, size_t first, size_t last, bool check,
                                       bool damping)
{
  (void)damping; /* the body does it: such a law does not say that it damps */
  for (size_t q = first; q < last; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    double y[3], L[BW_PD_LANES][3] = {{0}};
    bool beyond = false;
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)~block->gone); bw_pd_walk_next(&b);) {
      const double r = bw_pd_walk_present(&b, y);
      const bw_pd_spring s = BW_PD_SPRING(pd, &b, r);
      for (int k = 0; k < 3; k++)
        L[b.lane][k] += s.force * b.weight / r * y[k];
      beyond |= s.beyond;
    }
    bw_pd_body_put_acceleration(pd, block, L);
    if (check && beyond) pd->bonds.hit[pd->bonds.n_hit++] = (uint32_t)q;
  }
}

/* Member `breaks`. What these bonds pull with now is no longer part of the acceleration. */
static inline bool bw_pd_springs_breaks(bw_pd_body *pd, bw_pd_block *block)
{
  bool any = false;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)~block->gone); bw_pd_walk_next(&b);) {
    double y[3];
    const double r = bw_pd_walk_present(&b, y);
    const bw_pd_spring s = BW_PD_SPRING(pd, &b, r);
    if (!s.beyond || bw_pd_walk_unbreakable(&b)) continue;
    const size_t i = bw_pd_walk_owner(&b);
    const double a = s.force * b.weight / (r * bw_pd_body_material(pd, i)->rho);
    for (int k = 0; k < pd->dimension; k++)
      pd->a[k][i] -= (bw_real)(a * y[k]);
    bw_pd_body_cut(pd, block, b.slot, b.lane);
    any = true;
  }
  return any;
}

/* Half of a bond's energy. */
static inline double bw_pd_springs_half(const bw_pd_body *pd, const bw_pd_walk *b)
{
  double y[3];
  return 0.5 * BW_PD_SPRING(pd, b, bw_pd_walk_present(b, y)).energy * b->weight *
         bw_pd_body_level_at(pd, b->h)->dv;
}

static inline double bw_pd_springs_bond_energy(const bw_pd_body *pd, const bw_pd_block *block,
                                               const bw_pd_slot *slot, int lane)
{
  const bw_pd_walk b = bw_pd_walk_at(pd, block, slot, lane);
  return bw_pd_springs_half(pd, &b);
}

static inline double bw_pd_springs_energy(const bw_pd_body *pd, const bw_pd_block *block,
                                          uint8_t asked)
{
  double sum = 0;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, asked); bw_pd_walk_next(&b);)
    sum += bw_pd_springs_half(pd, &b);
  return sum;
}

/* The bond at its rest length. */
static inline bw_pd_spring bw_pd_springs_rest(const bw_pd_body *pd, const bw_pd_walk *b)
{
  return BW_PD_SPRING(pd, b, b->rest.r0);
}

/* Member `bound`, of the intact network where it is steepest (pd_tensor_bound.h). Collective. */
static inline bw_status bw_pd_springs_bound(bw_pd_body *pd)
{
  double most = 0;
  bw_status st = BW_OK;
  for (size_t q = 0; q < pd->bonds.n_block && st == BW_OK; q++) {
    bw_pd_tensors T = {{0}};
    for (bw_pd_walk b = bw_pd_walk_families(pd, &pd->bonds.block[q]); bw_pd_walk_next(&b);)
      bw_pd_tensor_add_dyad(bw_pd_springs_rest(pd, &b).steepest * b.weight, b.rest.xi, b.rest.r0,
                            T[b.lane]);
    st = bw_pd_body_bound_block(pd, &pd->bonds.block[q], T, &most);
  }
  return bw_pd_body_bound_all(pd, st, most);
}

static inline void bw_pd_springs_tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  for (size_t q = 0; q < 3 * pd->n; q++)
    kx[q] = 0;
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);) {
      double along = 0, *row = kx + 3 * bw_pd_walk_owner(&b);
      for (int k = 0; k < 3; k++)
        along += b.rest.xi[k] * ((double)x[k][b.h] - (double)x[k][b.l]);
      along *= bw_pd_springs_rest(pd, &b).stiffness * b.weight / (b.rest.r0 * b.rest.r0);
      for (int k = 0; k < 3; k++)
        row[k] += along * b.rest.xi[k];
    }
  }
}

static inline void bw_pd_springs_rows(const bw_pd_body *pd, double row[])
{
  for (size_t i = 0; i < pd->n; i++)
    row[i] = 0;
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);)
      row[bw_pd_walk_owner(&b)] += 0.5 * bw_pd_springs_rest(pd, &b).steepest * b.weight;
  }
  bw_pd_body_fill_rows(pd, row);
}

/* 1/2 sum_l f y (x) y/|y| Gamma dV_l */
static inline void bw_pd_springs_virial(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                                        double sum[3][3])
{
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    double y[3];
    const double r = bw_pd_walk_present(&b, y);
    const double f = 0.5 * BW_PD_SPRING(pd, &b, r).force * b.weight / r;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        sum[i][j] += f * y[i] * y[j];
  }
}
