/* A bound of the largest frequency of the intact network: that of its tensors
 * (pd_tensor_bound.h). */
#include "pd_bond.h"
#include "pd_tensor_bound.h"
#include "pd_walk.h"

bw_status bw_pd_bond__bound(bw_pd_body *pd)
{
  double most = 0;
  bw_status st = BW_OK;
  for (size_t q = 0; q < pd->bonds.n_block && st == BW_OK; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    bw_pd_tensors T = {{0}};
    for (bw_pd_walk b = bw_pd_walk_families(pd, block); bw_pd_walk_next(&b);)
      bw_pd_tensor_add_dyad(bw_pd_bond__micromodulus(pd, b.h, b.l) *
                                bw_pd_bond__alpha(pd, block, b.slot, b.lane) * b.weight / b.rest.r0,
                            b.rest.xi, b.rest.r0, T[b.lane]);
    st = bw_pd_body_bound_block(pd, block, T, &most);
  }
  return bw_pd_body_bound_all(pd, st, most);
}
