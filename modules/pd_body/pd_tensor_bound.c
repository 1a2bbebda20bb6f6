/* What all laws whose bonds act as springs do alike with tensors, rows and accelerations. */
#include "pd_tensor_bound.h"
#include "pd_law.h"

#include <math.h>

bw_status bw_pd_body_bound_block(const bw_pd_body *pd, const bw_pd_block *block, bw_pd_tensors T,
                                 double *most)
{
  double value[BW_PD_LANES][3];
  BW_TRY(bw_pd_tensor_principal(BW_PD_LANES, T[0], value[0], NULL));
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const size_t i = (size_t)bw_pd_body_owner(block, lane);
    *most = fmax(*most, 2 * value[lane][0] / bw_pd_body_material(pd, i)->rho);
  }
  return BW_OK;
}

bw_status bw_pd_body_bound_all(bw_pd_body *pd, bw_status st, double most)
{
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_comm_max(pd->comm, 1, &most);
  pd->frequency2 = most;
  return BW_OK;
}

void bw_pd_body_put_acceleration(bw_pd_body *pd, const bw_pd_block *block, double L[BW_PD_LANES][3])
{
  int32_t i = block->own;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const double rho = bw_pd_body_material(pd, (size_t)i)->rho;
    for (int k = 0; k < pd->dimension; k++)
      pd->a[k][i] = (bw_real)(L[lane][k] / rho);
    i++;
  }
}

void bw_pd_body_fill_rows(const bw_pd_body *pd, double row[])
{
  for (size_t i = 0; i < pd->n; i++)
    if (!(row[i] > 0)) row[i] = 0.25 * pd->frequency2 * bw_pd_body_material(pd, i)->rho + 1e-300;
}
