/* Material constants from the lattice's own sums instead of the integrals.
 *
 * Stiffness: 1/4 c0 sum |xi| Gamma dV, the energy density of a full family dilated by e, over e^2,
 * is that of elasticity. Fracture: every direction xi holds xi.n Gamma dV/2 of its bonds' energy
 * c0 s^2 |xi| per area of a plane normal to the lattice direction n, so
 *   G0 = 1/2 c0 s0^2 sum_{xi.n > 0} |xi| xi.n Gamma dV.
 * V0 of the volume method is the full family's own volume: alpha = 1 in the bulk. */
#include "pd_bond_internal.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* With the fixed Poisson ratios 3 E, E/(1 - nu) = 3E/2 and 2 (lambda + mu) = 8E/5. */
double bw_pd_bond__classical_dilation(const bw_pd_bond_config *c)
{
  const double factor[] = {3, 1.5, 1.6};
  return factor[c->geometry] * c->E;
}

/* After material and stencil, and after every change of G0. */
void bw_pd_bond__calibrate(bw_pd_bond *pd)
{
  const bw_pd_stencil *s = &pd->stencil;
  const bw_pd_bond_config *c = &pd->config;
  const double d = pd->horizon;
  double volume = 0, moment = 0, crossing = 0;
  pd->full_volume = pd->dimension == 3 ? 4.0 / 3 * PI * d * d * d : PI * d * d * c->thickness;
  if (c->calibration == BW_PD_CALIBRATION_NONE) return;
  for (int q = 0; q < s->n; q++) {
    const double w = s->fraction[q] * pd->dv, along = c->ds * s->offset[3 * q];
    volume += w;
    moment += w * s->r0[q];
    crossing += along > 0 ? w * s->r0[q] * along : 0;
  }
  pd->full_volume = volume;
  pd->c0 = 4 * bw_pd_bond__classical_dilation(c) / moment;
  pd->s0 = sqrt(2 * c->G0 / (pd->c0 * crossing));
}
