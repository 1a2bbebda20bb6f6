/* What keeps motions faster than the step from being fed (bw_coupler.h, "Motions faster than the
 * step"): a virtual mass on the solid's side, whose force is given back with the next load. */
#include "bw_coupler.h"
#include "coupler_internal.h"

#include <string.h>

bw_status bw_coupler__resist(bw_coupler *c, double dt, double relaxation)
{
  double *k = c->scratch[0], *V = c->scratch[2];
  const double mass = c->config.virtual_mass * relaxation * c->config.rho * c->h;
  /* An iterated step agrees with the fluid's answer to its own motion: nothing is late; with a
   * predictor nothing is fed. */
  if (mass == 0.0 || c->config.coupling_iterations > 1 || c->config.predictor) return BW_OK;
  /* m_v/(dt V_h) per volume of a particle, towards the velocity that the fluid was told. */
  for (size_t q = 0; q < c->n_surface; q++) {
    const size_t p = (size_t)c->particle[q];
    k[q] = mass * c->area[q] / (dt * bw_solid_volume_of(c->solid, p));
    memcpy(V + 3 * q, c->V_before + 3 * p, 3 * sizeof *V);
  }
  return bw_solid_set_drag(c->solid, c->n_surface, c->particle, k, V);
}

void bw_coupler__carry_over(bw_coupler *c, double dt, double relaxation)
{
  double *impulse = c->X;
  const double work = bw_solid_get_drag(c->solid, impulse);
  /* What the drag took is still owed: it joins the next load. */
  c->work.late -= work;
  c->book.received += work;
  if (c->felt != NULL) memcpy(c->felt, c->F, 3 * c->n * sizeof *c->felt);
  for (size_t i = 0; i < 3 * c->n; i++)
    c->F[i] = (1.0 - relaxation) * c->F[i] - relaxation * impulse[i] / dt;
}
