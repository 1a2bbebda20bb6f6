/* What the state-based laws have in common. */
#include "pd_state.h"

static const double PI = 3.14159265358979323846;

bw_status bw_pd_state__check_poisson(const bw_pd_body_config *c)
{
  for (int g = 0; g < c->n_group; g++) {
    const double nu = c->material[g].nu;
    BW_REQUIRE(isnan(nu) || (nu > -1 && nu < BW_PD_STATE_MOST_NU), BW_EINPUT,
               "solid: nu = %g of group %d must be above -1 and below %g; what keeps its volume "
               "is not elastic in all directions, take 0.49",
               nu, g, BW_PD_STATE_MOST_NU);
  }
  return BW_OK;
}

void bw_pd_state__resolve_poisson(bw_pd_body_config *c)
{
  for (int g = 0; g < c->n_group; g++)
    if (isnan(c->material[g].nu))
      c->material[g].nu = c->geometry == BW_PD_PLANE_STRESS ? 1.0 / 3 : 0.25;
}

bw_real *bw_pd_state__row(const bw_pd_body *pd, const bw_pd_level *level, int g, int h)
{
  return level->row + (size_t)((g * pd->config.n_group + h) * level->stencil.n) * BW_PD_ROW;
}

bw_status bw_pd_state__full_sums(const bw_pd_body *pd, const bw_pd_level *level, double *crossing,
                                 double *moment)
{
  const double ds = level->ds, dv = level->dv;
  *crossing = *moment = 0;
  if (pd->config.disorder > 0) {
    /* The mean of xi.n > 0 over all directions n is |xi|/pi in the plane, |xi|/4 in space. */
    double mean[3];
    BW_TRY(bw_pd_body_cloud_means(pd, mean));
    *moment = dv * ds * mean[1];
    *crossing = *moment / (pd->dimension == 3 ? 4 : PI);
    return BW_OK;
  }
  const bw_pd_stencil *s = &level->stencil;
  for (int q = 0; q < s->same; q++) {
    const double w = s->fraction[q] * dv, along = ds * s->offset[3 * q];
    *moment += w * s->r0[q];
    *crossing += along > 0 ? w * along : 0;
  }
  return BW_OK;
}

double bw_pd_state__micromodulus(const bw_pd_body *pd, int group)
{
  const double E = pd->config.material[group].E, d = pd->level[0].horizon;
  const double t = pd->config.thickness;
  const double c[] = {12 * E / (PI * d * d * d * d), 9 * E / (PI * t * d * d * d),
                      48 * E / (5 * PI * t * d * d * d)};
  return c[pd->config.geometry];
}
