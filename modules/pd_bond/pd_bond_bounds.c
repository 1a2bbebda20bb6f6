/* Steps that are stable, and steps that resolve a collision.
 *
 * The network of springs k along e has u.Ku = 1/2 sum_hl k (e.(u_l - u_h))^2, and (a - b)^2 is at
 * most 2 a^2 + 2 b^2, so that u.Ku <= sum_h u_h.(2 T_h) u_h with T_h = sum_l k e e: no eigenvalue
 * of K is above twice the largest one of all T_h. (ERRATA 6 has T's trace there, three times as
 * much in the bulk.) What is left: the sharpest wave of the lattice allows a step 1.17 times as
 * long in 3D and 1.19 times in the plane with m = 3, 1.10 and 1.12 times with m = 2, and just this
 * one with m = 1. The same holds for the pair damping, with Gamma dV for k. Turned bodies have the
 * same bound; a strain s changes T by some 3 s of itself. */
#include "bw_pd_stress.h"
#include "pd_bond_contact.h"

#include <math.h>

enum { STIFFNESS, WEIGHT, TENSORS };

typedef double tensors[TENSORS][BW_PD_LANES][BW_PD_SYMMETRIC];

/* Adds factor e e, in the order of bw_pd_stress. */
static void add_dyad(double factor, const bw_pd_rest *rest, double t[BW_PD_SYMMETRIC])
{
  static const int a[] = {0, 1, 2, 1, 0, 0}, b[] = {0, 1, 2, 2, 2, 1};
  for (int q = 0; q < BW_PD_SYMMETRIC; q++)
    t[q] += factor * rest->xi[a[q]] * rest->xi[b[q]] / (rest->r0 * rest->r0);
}

/* T of a block's lanes, of the intact network. */
static void block_tensors(const bw_pd_bond *pd, const bw_pd_block *block, tensors t)
{
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->slot[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(slot->family >> lane & 1)) continue;
      const bw_pd_rest rest =
          bw_pd_bond__rest(pd, slot->direction, block->first + lane, slot->base + lane);
      const double w = rest.fraction * pd->dv, alpha = bw_pd_bond__alpha(pd, block, slot, lane);
      add_dyad(pd->c0 * alpha * w / rest.r0, &rest, t[STIFFNESS][lane]);
      add_dyad(w, &rest, t[WEIGHT][lane]);
    }
  }
}

bw_status bw_pd_bond__bounds(bw_pd_bond *pd)
{
  double most[TENSORS] = {0};
  bw_status st = BW_OK;
  for (size_t b = 0; b < pd->n_block && st == BW_OK; b++) {
    tensors t = {{{0}}};
    double value[TENSORS][BW_PD_LANES][3];
    block_tensors(pd, &pd->block[b], t);
    st = bw_pd_stress_principal((size_t)TENSORS * BW_PD_LANES, t[0][0], value[0][0], NULL);
    for (int lane = 0; lane < BW_PD_LANES && st == BW_OK; lane++)
      for (int q = 0; q < TENSORS; q++)
        most[q] = fmax(most[q], value[q][lane][0]);
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_comm_max(pd->comm, TENSORS, most);
  pd->most_stiffness = most[STIFFNESS];
  pd->most_weight = most[WEIGHT];
  return BW_OK;
}

/* Verlet with lagged damping is stable for w^2 dt^2 + 2 g dt < 4; the stability region of RK3 holds
 * the triangle i sqrt(3), -2.51. */
double bw_pd_bond_dt_max(const bw_pd_bond *pd)
{
  if (pd->most_stiffness == 0) return INFINITY;
  const double rho = pd->config.rho, w = sqrt(2 * pd->most_stiffness / rho);
  const double g =
      (2 * pd->damping_pair * pd->most_weight + 2 * pd->damping_mean + pd->damping_absolute) / rho;
  if (pd->config.integrator == BW_PD_RK3) return 1 / (w / sqrt(3.0) + g / 2.51);
  return 4 / (g + sqrt(g * g + 4 * w * w));
}

double bw_pd_bond_dt_contact(const bw_pd_bond *pd)
{
  if (!pd->config.contact) return INFINITY;
  return 1 / sqrt(2 * bw_pd_contact__stiffness(pd) / pd->config.ds);
}
