/* Bonds at small strain, their row sums, and their stress. */
#include "pd_bond.h"

#include <math.h>
#include <string.h>

/* kx of one block: sum of k xi (x) xi.(x_h - x_l), k = c0 alpha Gamma V/|xi|^3. */
static void block_product(const bw_pd_body *pd, const bw_pd_block *block, bw_real *const x[3],
                          double kx[])
{
  double sum[BW_PD_LANES][3] = {{0}};
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(slot->mask >> lane & 1)) continue;
      const int32_t h = block->first + lane, l = slot->base + lane;
      const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
      double along = 0;
      for (int k = 0; k < 3; k++)
        along += rest.xi[k] * ((double)x[k][h] - (double)x[k][l]);
      along *= bw_pd_bond__micromodulus(pd, h, l) * rest.fraction * pd->level->dv /
               (rest.r0 * rest.r0 * rest.r0) * bw_pd_bond__alpha(pd, block, slot, lane);
      for (int k = 0; k < 3; k++)
        sum[lane][k] += along * rest.xi[k];
    }
  }
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask >> lane & 1)
      memcpy(kx + 3 * (size_t)bw_pd_body_owner(block, lane), sum[lane], sizeof sum[lane]);
}

void bw_pd_bond__tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    block_product(pd, &pd->bonds.block[b], x, kx);
}

/* 1/2 sum of c0 alpha Gamma V/|xi|; a particle without bonds gets what the stiffest has. */
static double row_of(const bw_pd_body *pd, const bw_pd_block *block, int lane)
{
  const int32_t h = block->first + lane;
  double sum = 0;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    if (!(slot->mask >> lane & 1)) continue;
    const int32_t l = slot->base + lane;
    const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
    sum += bw_pd_bond__micromodulus(pd, h, l) * bw_pd_bond__alpha(pd, block, slot, lane) *
           rest.fraction / rest.r0;
  }
  sum *= 0.5 * pd->level->dv;
  const double rho = bw_pd_body_material(pd, (size_t)bw_pd_body_owner(block, lane))->rho;
  return sum > 0 ? sum : 0.25 * pd->frequency2 * rho + 1e-300;
}

void bw_pd_bond__rows(const bw_pd_body *pd, double row[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      const bw_pd_block *block = &pd->bonds.block[b];
      if (block->mask >> lane & 1) row[bw_pd_body_owner(block, lane)] = row_of(pd, block, lane);
    }
}

/* 1/2 sum_l c0 alpha s |xi + eta| e (x) e Gamma dV_l over the bonds that hold. */
void bw_pd_bond__virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3])
{
  const int32_t h = block->first + lane;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    if (!(slot->mask >> lane & 1)) continue;
    const int32_t l = slot->base + lane;
    const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
    double y[3], r2 = 0;
    for (int k = 0; k < 3; k++) {
      y[k] = rest.xi[k] + ((double)pd->u[k][l] - (double)pd->u[k][h]);
      r2 += y[k] * y[k];
    }
    const double r = sqrt(r2), w = rest.fraction * pd->level->dv;
    const double c = bw_pd_bond__micromodulus(pd, h, l) * bw_pd_bond__alpha(pd, block, slot, lane);
    const double f = r > 0 ? 0.5 * c * w * (r - rest.r0) / (rest.r0 * r) : 0;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        sum[a][b] += f * y[a] * y[b];
  }
}
