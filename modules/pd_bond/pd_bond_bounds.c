/* A bound of the largest frequency of a network of bonds.
 *
 * The network of springs k along e has u.Ku = 1/2 sum_hl k (e.(u_l - u_h))^2, and (a - b)^2 is at
 * most 2 a^2 + 2 b^2, so that u.Ku <= sum_h u_h.(2 T_h) u_h with T_h = sum_l k e e: no eigenvalue
 * of K is above twice the largest one of all T_h. (ERRATA 6 has T's trace there, three times as
 * much in the bulk.) What is left: the sharpest wave of the lattice allows a step 1.17 times as
 * long in 3D and 1.19 times in the plane with m = 3, 1.10 and 1.12 times with m = 2, and just this
 * one with m = 1. The same holds for the pair damping, with Gamma dV for k. Turned bodies have the
 * same bound; a strain s changes T by some 3 s of itself. */
#include "bw_pd_tensor.h"
#include "pd_bond.h"

#include <math.h>

typedef double tensors[BW_PD_LANES][BW_PD_SYMMETRIC];

/* T of a block's lanes, of the intact network. */
static void block_tensors(const bw_pd_body *pd, const bw_pd_block *block, tensors t)
{
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(slot->family >> lane & 1)) continue;
      const int32_t h = block->first + lane, l = slot->base + lane;
      const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
      const double w = rest.fraction * pd->level->dv;
      const double c0 = bw_pd_bond__micromodulus(pd, h, l);
      bw_pd_tensor_add_dyad(c0 * bw_pd_bond__alpha(pd, block, slot, lane) * w / rest.r0, rest.xi,
                            rest.r0, t[lane]);
    }
  }
}

/* With masses the eigenvalues of a particle's tensor count over its own density. */
bw_status bw_pd_bond__bound(bw_pd_body *pd)
{
  double most = 0;
  bw_status st = BW_OK;
  for (size_t b = 0; b < pd->bonds.n_block && st == BW_OK; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    tensors t = {{0}};
    double value[BW_PD_LANES][3];
    block_tensors(pd, block, t);
    st = bw_pd_tensor_principal(BW_PD_LANES, t[0], value[0], NULL);
    for (int lane = 0; lane < BW_PD_LANES && st == BW_OK; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(block, lane);
      most = fmax(most, 2 * value[lane][0] / bw_pd_body_material(pd, i)->rho);
    }
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_comm_max(pd->comm, 1, &most);
  pd->frequency2 = most;
  return BW_OK;
}
