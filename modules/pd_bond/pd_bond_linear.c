/* Bonds at small strain, their row sums, and their stress. */
#include "pd_bond.h"
#include "pd_law.h"
#include "pd_walk.h"

#include <string.h>

/* c0 alpha of a bond. */
static double factor(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_walk *b)
{
  return bw_pd_bond__micromodulus(pd, b->h, b->l) * bw_pd_bond__alpha(pd, block, b->slot, b->lane);
}

/* kx of one block: sum of k xi (x) xi.(x_h - x_l), k = c0 alpha Gamma V/|xi|^3. */
static void block_product(const bw_pd_body *pd, const bw_pd_block *block, bw_real *const x[3],
                          double kx[])
{
  double sum[BW_PD_LANES][3] = {{0}};
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);) {
    const double r0 = b.rest.r0;
    double along = 0;
    for (int k = 0; k < 3; k++)
      along += b.rest.xi[k] * ((double)x[k][b.h] - (double)x[k][b.l]);
    along *= bw_pd_bond__micromodulus(pd, b.h, b.l) * b.weight / (r0 * r0 * r0) *
             bw_pd_bond__alpha(pd, block, b.slot, b.lane);
    for (int k = 0; k < 3; k++)
      sum[b.lane][k] += along * b.rest.xi[k];
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

static double block_dv(const bw_pd_body *pd, const bw_pd_block *block)
{
  return bw_pd_body_level_of(pd, block)->dv;
}

/* 1/2 sum of c0 alpha Gamma V/|xi|. */
void bw_pd_bond__rows(const bw_pd_body *pd, double row[])
{
  memset(row, 0, pd->n * sizeof *row);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);)
      row[bw_pd_walk_owner(&b)] += factor(pd, block, &b) * b.rest.fraction / b.rest.r0 *
                                   (bw_pd_body_level_at(pd, b.l)->dv / block_dv(pd, block));
  }
  for (size_t i = 0; i < pd->n; i++)
    row[i] *= 0.5 * bw_pd_body_level(pd, i)->dv;
  bw_pd_body_fill_rows(pd, row);
}

/* 1/2 sum_l c0 alpha s |xi + eta| e (x) e Gamma dV_l over the bonds that hold. */
void bw_pd_bond__virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3])
{
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    double y[3];
    const double r = bw_pd_walk_present(&b, y), r0 = b.rest.r0;
    const double f = r > 0 ? 0.5 * factor(pd, block, &b) * b.weight * (r - r0) / (r0 * r) : 0;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        sum[i][j] += f * y[i] * y[j];
  }
}
