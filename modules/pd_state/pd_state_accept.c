/* The end of a step: what particles remember becomes what they start from, and what the
 * stabilisation of those that have flowed gives up is booked. */
#include "pd_state_correspondence.h"

#include <string.h>

/* What the stabilisation of a lane holds per volume and beta: sum w z^2 Gamma dV/2. */
static double held(const bw_pd_body *pd, const bw_pd_block *block, int lane)
{
  const bw_pd_state_family f = bw_pd_state__family(pd, block, lane, NULL);
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  double H[9] = {0}, sum = 0;
  if (!f.spans) return 0;
  bw_pd_state__gradient(pd, block, lane, &f, NULL, H);
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    const double w = bw_pd_correspondence_weight(pd, level, b.rest.r0) * b.weight, *xi = b.rest.xi;
    for (int i = 0; i < pd->dimension; i++) {
      const double z = ((double)pd->u[i][b.l] - (double)pd->u[i][b.h]) -
                       (H[3 * i] * xi[0] + H[3 * i + 1] * xi[1] + H[3 * i + 2] * xi[2]);
      sum += 0.5 * w * z * z;
    }
  }
  return sum;
}

/* Where more has flowed, beta falls: what it held beyond that is dissipated. With the mean of both
 * ends of the step, as forces do work by the trapezoidal rule: (beta_0 - beta_1) z_0.z_1/2. */
static void book(const bw_pd_body *pd, const bw_pd_block *block)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    const int32_t h = block->first + lane;
    if (!(block->mask >> lane & 1) || !(o->whole[h] > 0)) continue;
    const double before = (double)o->accepted[15][h], now = (double)o->trial[15][h];
    if (now == before) continue;
    const double fall =
        bw_pd_correspondence_secant(pd, h, before) - bw_pd_correspondence_secant(pd, h, now);
    const double last = (double)o->lately[h], z2 = held(pd, block, lane);
    o->lately[h] = (bw_real)z2;
    o->trial[BW_PD_REMEMBERED - 1][h] +=
        (bw_real)(fall * (double)o->whole[h] * (last > 0 ? 0.5 * (last + z2) : z2));
  }
}

void bw_pd_state__accept(bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  if (!o->remembers) return;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    book(pd, &pd->bonds.block[q]);
  for (int q = 0; q < BW_PD_REMEMBERED; q++)
    memcpy(o->accepted[q], o->trial[q], pd->points.n_storage * sizeof(bw_real));
}
