/* Shape tensors K = sum w xi xi Gamma dV, their inverses, and who is left without a plane. */
#include "pd_state_correspondence.h"

/* Below this part of a full family's tr K/d the least eigenvalue of K is that of bonds in a plane
 * or line: the particle's own law becomes central springs (momentum and angular momentum stay; a
 * pseudo-inverse would break the latter). */
static const double FLAT = 0.02;

/* The least eigenvalue of a symmetric tensor of `dimension`, in closed form. */
double bw_pd_state__least(const double K[6], int dimension)
{
  if (dimension == 2) return 0.5 * (K[0] + K[1]) - hypot(0.5 * (K[0] - K[1]), K[5]);
  const double mean = (K[0] + K[1] + K[2]) / 3;
  const double a = K[0] - mean, b = K[1] - mean, c = K[2] - mean, d = K[3], e = K[4], f = K[5];
  const double size = sqrt((a * a + b * b + c * c + 2 * (d * d + e * e + f * f)) / 6);
  if (!(size > 0)) return mean;
  /* Roots of x^3 - 3 x = det/size^3 are 2 cos of three angles. */
  const double det = a * (b * c - d * d) - f * (f * c - d * e) + e * (f * d - b * e);
  const double third = acos(fmax(-1, fmin(1, det / (2 * size * size * size)))) / 3;
  return mean + 2 * size * cos(third + 2.0 / 3 * 3.14159265358979323846);
}

static void invert(const double K[6], int dimension, double out[6])
{
  if (dimension == 2) {
    const double det = K[0] * K[1] - K[5] * K[5];
    out[0] = K[1] / det, out[1] = K[0] / det, out[5] = -K[5] / det;
    out[2] = out[3] = out[4] = 0;
    return;
  }
  const double c00 = K[1] * K[2] - K[3] * K[3], c01 = K[4] * K[3] - K[5] * K[2];
  const double c02 = K[5] * K[3] - K[4] * K[1];
  const double det = K[0] * c00 + K[5] * c01 + K[4] * c02;
  out[0] = c00 / det, out[5] = c01 / det, out[4] = c02 / det;
  out[1] = (K[0] * K[2] - K[4] * K[4]) / det;
  out[3] = (K[4] * K[5] - K[0] * K[3]) / det;
  out[2] = (K[0] * K[1] - K[5] * K[5]) / det;
}

bw_pd_state_family bw_pd_state__family(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                                       const bw_pd_slot *without)
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  bw_pd_state_family f = {.spans = false};
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    if (b.slot == without) continue;
    const double w = bw_pd_correspondence_weight(pd, level, b.rest.r0) * b.weight, *xi = b.rest.xi;
    for (int k = 0; k < 3; k++) {
      f.K[k] += w * xi[k] * xi[k];
      f.K[3 + k] += w * xi[(k + 1) % 3] * xi[(k + 2) % 3];
    }
  }
  f.kappa = (f.K[0] + f.K[1] + f.K[2]) / pd->dimension;
  f.spans = bw_pd_state__least(f.K, pd->dimension) >
            FLAT * bw_pd_correspondence_of(pd)->kappa[block->level];
  if (f.spans) invert(f.K, pd->dimension, f.inverse);
  return f;
}

/* K^-1 and beta of a block's owners. */
static void block_shapes(const bw_pd_body *pd, const bw_pd_block *block)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const int32_t h = block->first + lane;
    const int g = bw_pd_body_group_at(pd, h);
    const bw_pd_state_family f = bw_pd_state__family(pd, block, lane, NULL);
    for (int c = 0; c < 6; c++)
      o->inverse[c][h] = (bw_real)f.inverse[c];
    /* kappa of what is left, so that z keeps its weight against H. */
    o->beta[h] = (bw_real)(f.spans ? bw_pd_correspondence_beta(pd, h, f.kappa)
                                   : -o->spring[block->level][g]);
    if (o->whole == NULL) continue;
    o->whole[h] = (bw_real)(f.spans ? o->options.stabilisation * o->small[g].mu / f.kappa
                                    : -o->spring[block->level][g]);
  }
}

void bw_pd_state__shapes(const bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  if (o->seen == pd->bonds.events) return;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    /* A restart may have mended what was cut. */
    if (o->seen >= 0 && !block->broken && !o->cut[b]) continue;
    block_shapes(pd, block);
    o->cut[b] = block->broken;
  }
  o->seen = pd->bonds.events;
}
