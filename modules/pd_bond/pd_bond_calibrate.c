/* Material constants from the lattice's own sums instead of the integrals.
 *
 * Stiffness: 1/4 c0 sum |xi| Gamma dV, the energy density of a full family dilated by e, over e^2,
 * is that of elasticity. Fracture: every direction xi holds xi.n Gamma dV/2 of its bonds' energy
 * c0 s^2 |xi| per area of a plane normal to the lattice direction n, so
 *   G0 = 1/2 c0 s0^2 sum_{xi.n > 0} |xi| xi.n Gamma dV.
 * alpha = 1 but with the correction by tensor, whose factors refer to that c0 always.
 * V0 of the volume method is the full family's own volume: alpha = 1 in the bulk.
 * In a cloud every family differs: the sums are means over many, and of all directions n. */
#include "pd_bond_internal.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* With the fixed Poisson ratios 3 E, E/(1 - nu) = 3E/2 and 2 (lambda + mu) = 8E/5. */
double bw_pd_bond__classical_dilation(const bw_pd_bond_config *c)
{
  const double factor[] = {3, 1.5, 1.6};
  return factor[c->geometry] * c->E;
}

static void lattice_sums(bw_pd_bond *pd)
{
  const bw_pd_stencil *s = &pd->stencil;
  memset(&pd->full, 0, sizeof pd->full);
  for (int q = 0; q < s->n; q++) {
    const double w = s->fraction[q] * pd->dv, along = pd->config.ds * s->offset[3 * q];
    pd->full.volume += w;
    pd->full.moment += w * s->r0[q];
    pd->full.crossing += along > 0 ? s->bulk[q] * w * s->r0[q] * along : 0;
  }
}

/* The mean of xi.n > 0 over all n is |xi|/pi in the plane and |xi|/4 in space. */
static bw_status cloud_sums(bw_pd_bond *pd)
{
  const double ds = pd->config.ds;
  double mean[3];
  BW_TRY(bw_pd_bond__cloud_means(pd, mean));
  pd->full.volume = pd->dv * mean[0];
  pd->full.moment = pd->dv * ds * mean[1];
  pd->full.crossing = pd->dv * ds * ds * mean[2] / (pd->dimension == 3 ? 4 : PI);
  return BW_OK;
}

bw_status bw_pd_bond__full_family(bw_pd_bond *pd)
{
  const bw_pd_bond_config *c = &pd->config;
  if (c->calibration == BW_PD_CALIBRATION_NONE && c->surface_correction != BW_PD_SURFACE_TENSOR)
    return BW_OK;
  if (c->disorder > 0) return cloud_sums(pd);
  lattice_sums(pd);
  return BW_OK;
}

/* After material and the sums, and after every change of G0. */
void bw_pd_bond__calibrate(bw_pd_bond *pd)
{
  const bw_pd_bond_config *c = &pd->config;
  const double d = pd->horizon;
  const bool lattice = c->calibration == BW_PD_CALIBRATION_LATTICE;
  pd->full_volume = pd->dimension == 3 ? 4.0 / 3 * PI * d * d * d : PI * d * d * c->thickness;
  if (lattice || c->surface_correction == BW_PD_SURFACE_TENSOR)
    pd->c0 = 4 * bw_pd_bond__classical_dilation(c) / pd->full.moment;
  if (!lattice) return;
  pd->full_volume = pd->full.volume;
  pd->s0 = sqrt(2 * c->G0 / (pd->c0 * pd->full.crossing));
}
