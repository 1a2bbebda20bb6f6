/* Energy, stress and breaking of the correspondence law, particle by particle.
 *
 *   E_h = dV [ W(F_h) + beta/2 sum w |eta - H xi|^2 Gamma dV ],
 *   on springs dV sum w c s^2 |xi|/2 Gamma dV
 * Every particle's energy is that of its own bonds: what a bond held is what its ends lose with
 * it. */
#include "pd_state_correspondence.h"

#include <string.h>

typedef bw_pd_material_lanes wide;

void bw_pd_state__gradient(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                           const bw_pd_state_family *f, const bw_pd_slot *without, double H[9])
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  double S[9] = {0};
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    if (b.slot == without) continue;
    const double w = bw_pd_correspondence_weight(pd, level, b.rest.r0) * b.weight;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        S[3 * i + j] += w * ((double)pd->u[i][b.l] - (double)pd->u[i][b.h]) * b.rest.xi[j];
  }
  const double *K = f->inverse, inverse[9] = {K[0], K[5], K[4], K[5], K[1], K[3], K[4], K[3], K[2]};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      H[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        H[3 * i + j] += S[3 * i + k] * inverse[3 * k + j];
    }
}

/* P and W of a lane at H, which gets its F33 - 1. frozen: with the stress that is remembered, as H
 * jumps when a bond goes; else that of a step to H. */
static double material(const bw_pd_body *pd, int32_t h, bool frozen, double H[9], double P[9])
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_material_point *m = &o->material[bw_pd_body_group_at(pd, h)];
  wide G[9], Q[9], W;
  for (int q = 0; q < 9; q++)
    for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++)
      G[q][lane] = H[q];
  if (!isfinite(m->yield.k)) {
    bw_pd_material_stress(m, G, Q, &W);
  } else {
    bw_pd_material_state s = bw_pd_state__remembered(pd, h), next;
    if (frozen) {
      G[8] = s.H[8];
      memcpy(s.H, G, sizeof G);
      bw_pd_material_state_stress(m, &s, Q, &W);
    } else {
      bw_pd_material_rate(m, &s, G, &next, Q, &W);
      G[8] = next.H[8];
    }
  }
  for (int q = 0; q < 9; q++)
    P[q] = Q[q][0];
  H[8] = G[8][0];
  return W[0];
}

/* beta/2 sum w |eta - H xi|^2, or the springs' energy, per volume. */
static double bonds_energy(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                           const bw_pd_state_family *f, const bw_pd_slot *without,
                           const double H[9])
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  const int g = bw_pd_body_group_at(pd, block->first + lane);
  const double beta = f->spans ? bw_pd_correspondence_beta(pd, block->first + lane, f->kappa) : 0;
  double sum = 0, y[3];
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    if (b.slot == without) continue;
    const double w = bw_pd_correspondence_weight(pd, level, b.rest.r0) * b.weight, *xi = b.rest.xi;
    if (!f->spans) {
      const double e = bw_pd_walk_present(&b, y) - b.rest.r0;
      sum += 0.5 * w * o->spring[block->level][g] * e * e / b.rest.r0;
      continue;
    }
    for (int i = 0; i < pd->dimension; i++) {
      const double z = ((double)pd->u[i][b.l] - (double)pd->u[i][b.h]) -
                       (H[3 * i] * xi[0] + H[3 * i + 1] * xi[1] + H[3 * i + 2] * xi[2]);
      sum += 0.5 * beta * w * z * z;
    }
  }
  return sum;
}

static double particle_energy(const bw_pd_body *pd, const bw_pd_block *block, int lane, bool frozen,
                              const bw_pd_slot *without)
{
  const bw_pd_state_family f = bw_pd_state__family(pd, block, lane, without);
  double H[9] = {0}, P[9], W = 0;
  if (f.spans) {
    bw_pd_state__gradient(pd, block, lane, &f, without, H);
    W = material(pd, block->first + lane, frozen, H, P);
  }
  return bw_pd_body_level_of(pd, block)->dv * (W + bonds_energy(pd, block, lane, &f, without, H));
}

double bw_pd_state__bond_energy(const bw_pd_body *pd, const bw_pd_block *block,
                                const bw_pd_slot *slot, int lane)
{
  return particle_energy(pd, block, lane, true, NULL) -
         particle_energy(pd, block, lane, true, slot);
}

double bw_pd_state__energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked)
{
  double sum = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask & asked & 1u << lane) sum += particle_energy(pd, block, lane, false, NULL);
  return sum;
}

/* J sigma = P F^T; of springs sum w c s y y/|y| Gamma dV. */
void bw_pd_state__virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3])
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_state_family f = bw_pd_state__family(pd, block, lane, NULL);
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  const int g = bw_pd_body_group_at(pd, block->first + lane);
  double H[9] = {0}, P[9], y[3];
  if (f.spans) {
    bw_pd_state__gradient(pd, block, lane, &f, NULL, H);
    material(pd, block->first + lane, false, H, P);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
          sum[i][j] += P[3 * i + k] * (H[3 * j + k] + (j == k));
    return;
  }
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    const double r = bw_pd_walk_present(&b, y);
    const double t = bw_pd_correspondence_weight(pd, level, b.rest.r0) * b.weight *
                     o->spring[block->level][g] * (1 / b.rest.r0 - 1 / r);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        sum[i][j] += t * y[i] * y[j];
  }
}
