/* Steps that are stable, and steps that resolve a collision. */
#include "solid_internal.h"

#include <math.h>

/* Verlet with lagged damping is stable for w^2 dt^2 + 2 g dt < 4; the stability region of RK3 holds
 * the triangle i sqrt(3), -2.51. */
double bw_solid_dt_max(const bw_solid *s)
{
  const bw_pd_body *pd = s->body;
  const bw_pd_dampings *d = &pd->damping;
  /* Where levels change the step is that of the finest from the start. */
  const double w2 =
      s->levels == NULL ? pd->frequency2 : fmax(pd->frequency2, s->levels->frequency2);
  if (w2 == 0) return INFINITY;
  double rho = INFINITY; /* the lightest group is damped fastest */
  for (int g = 0; g < pd->config.n_group; g++)
    rho = fmin(rho, pd->config.material[g].rho);
  /* Rate of damping: pairs and mean take twice as much where neighbours move against each other. */
  const double w = sqrt(w2);
  const double g = (2 * d->pair * d->most_weight + 2 * d->mean + d->absolute) / rho;
  if (s->config.integrator == BW_SOLID_RK3) return 1 / (w / sqrt(3.0) + g / 2.51);
  return 4 / (g + sqrt(g * g + 4 * w * w));
}

double bw_solid_dt_contact(const bw_solid *s)
{
  return s->contact == NULL ? INFINITY : bw_pd_contact_time(s->contact);
}
