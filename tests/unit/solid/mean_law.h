/* mean_law.h -- a law of two passes whose particles remember: springs, and the mean stretch of a
 * family.
 *
 *   theta_h = 1/m_h sum_l s_hl Gamma dV_l,  m_h = sum_l Gamma dV_l   over the family
 * A particle stores psi = 1/2 K (1 - g a) theta^2 per volume, a the largest theta^2 there was so
 * far, besides its springs' c |xi| s^2/2. The derivative by a bond's length has parts of both ends,
 *   f_hl = c s + (p_h + p_l)/|xi|,   p_h = K (1 - g a_h) theta_h/m_h,
 * so that the second pass reads what the first has found at neighbours. While theta^2 grows, a =
 * theta^2 and psi falls by 1/2 K g a da: a particle has dissipated K g a^2/4 per volume. No bond
 * breaks. */
#pragma once
#define BW_PD_SPRING mean_spring /* its steepest, for `bound` and `rows` */
#include "bw_memory.h"
#include "pd_springs.h"

typedef struct {
  double c, K, g;     /* [M/(L^5 T^2)], [M/(L T^2)], [-] */
  bw_real *p, *a, *m; /* storage: p is sent, a is saved, m is constant */
  bw_real *q;         /* storage: p of the tangent, sent by it */
} mean_state;

static mean_state *mean_of(const bw_pd_body *pd)
{
  return (mean_state *)pd->state;
}

/* By Cauchy's inequality m theta^2 <= sum s^2 Gamma dV: no more than springs K (1/m_h +
 * 1/m_l)/|xi|^2. */
static bw_pd_spring mean_spring(const bw_pd_body *pd, const bw_pd_walk *b, double r)
{
  const mean_state *law = mean_of(pd);
  const double s = r / b->rest.r0 - 1, both = 1 / (double)law->m[b->h] + 1 / (double)law->m[b->l];
  return (bw_pd_spring){.force = law->c * s + (double)(law->p[b->h] + law->p[b->l]) / b->rest.r0,
                        .energy = 0.5 * law->c * b->rest.r0 * s * s,
                        .stiffness = law->c / b->rest.r0,
                        .steepest = law->c / b->rest.r0 + law->K * both / pow(b->rest.r0, 2)};
}

static bw_status mean_check(const bw_pd_body_config *config, const void *options)
{
  (void)options;
  BW_REQUIRE(config->n_group == 1, BW_EINPUT, "mean: of one material");
  return BW_OK;
}

static bw_status mean_prepare(bw_pd_body *pd, const void *options)
{
  bw_status st = BW_ALLOCATE((mean_state **)&pd->state, 1);
  if (st == BW_OK) {
    mean_state *law = mean_of(pd);
    *law = *(const mean_state *)options;
    BW_THEN(st, bw_pd_body_add_field(pd, 0, false, &law->p));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, true, &law->a));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, false, &law->m));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, false, &law->q));
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (bw_pd_walk x = bw_pd_walk_families(pd, &pd->bonds.block[b]); bw_pd_walk_next(&x);)
      mean_of(pd)->m[x.h] += (bw_real)x.weight;
  bw_pd_body_fill_places(pd, mean_of(pd)->m);
  return BW_OK;
}

static void mean_constants(bw_pd_body *pd)
{
  (void)pd; /* given as options */
}

/* theta of a block's lanes, and what they remember with it. */
static void mean_first(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping)
{
  const mean_state *law = mean_of(pd);
  (void)check, (void)damping;
  for (size_t q = first; q < last; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    double y[3], sum[BW_PD_LANES] = {0};
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);)
      sum[b.lane] += (bw_pd_walk_present(&b, y) / b.rest.r0 - 1) * b.weight;
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const int32_t h = block->first + lane;
      const double theta = sum[lane] / (double)law->m[h];
      law->a[h] = (bw_real)fmax((double)law->a[h], theta * theta);
      law->p[h] = (bw_real)(law->K * (1 - law->g * (double)law->a[h]) * theta / (double)law->m[h]);
    }
  }
}

static bool mean_breaks(bw_pd_body *pd, bw_pd_block *block)
{
  (void)pd, (void)block;
  return false;
}

/* psi = 1/2 p^2 m^2/(K (1 - g a)) besides the springs. */
static double mean_energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked)
{
  const mean_state *law = mean_of(pd);
  double energy = bw_pd_springs_energy(pd, block, asked);
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask & asked & 1u << lane)) continue;
    const int32_t h = block->first + lane;
    energy += 0.5 * pow((double)law->p[h] * (double)law->m[h], 2) * pd->level->dv /
              (law->K * (1 - law->g * (double)law->a[h]));
  }
  return energy;
}

static double mean_dissipated(const bw_pd_body *pd)
{
  double sum = 0;
  for (size_t i = 0; i < pd->n; i++)
    sum += pow((double)mean_of(pd)->a[pd->points.place[i]], 2);
  return 0.25 * mean_of(pd)->K * mean_of(pd)->g * pd->level->dv * sum;
}

/* The same two passes at small strain, a = 0: q = K theta/m of the displacement x. Collective. */
static void mean_tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  const mean_state *law = mean_of(pd);
  bw_pd_springs_tangent(pd, x, kx);
  for (size_t i = 0; i < pd->n; i++)
    law->q[pd->points.place[i]] = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (size_t q = 0; q < pd->bonds.n_block; q++) {
      const bw_pd_block *block = &pd->bonds.block[q];
      for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);) {
        const double r2 = b.rest.r0 * b.rest.r0, both = (double)(law->q[b.h] + law->q[b.l]);
        for (int k = 0; k < 3; k++)
          if (pass == 0)
            law->q[b.h] += (bw_real)(law->K * b.weight / pow((double)law->m[b.h], 2) *
                                     b.rest.xi[k] * ((double)x[k][b.l] - (double)x[k][b.h]) / r2);
          else
            kx[3 * bw_pd_walk_owner(&b) + (size_t)k] -= both * b.weight * b.rest.xi[k] / r2;
      }
    }
    if (pass == 0) bw_pd_body_fill_places(pd, law->q);
  }
}

static double mean_micromodulus(const bw_pd_body *pd, int group)
{
  (void)group;
  return mean_of(pd)->c;
}

static void mean_destroy(bw_pd_body *pd)
{
  bw_release(&pd->state);
}

static const bw_pd_law_key mean_keys[] = {{NULL, NULL, NULL}};
static const bw_pd_law mean_law = {.name = "mean",
                                   .keys = mean_keys,
                                   .check = mean_check,
                                   .prepare = mean_prepare,
                                   .constants = mean_constants,
                                   .n_sweep = 2,
                                   .sweep = {mean_first, bw_pd_springs_sweep},
                                   .breaks = mean_breaks,
                                   .bond_energy = bw_pd_springs_bond_energy,
                                   .energy = mean_energy,
                                   .dissipated = mean_dissipated,
                                   .bound = bw_pd_springs_bound,
                                   .tangent = mean_tangent,
                                   .rows = bw_pd_springs_rows,
                                   .virial = bw_pd_springs_virial,
                                   .micromodulus = mean_micromodulus,
                                   .destroy = mean_destroy};
