/* What deforms in a flow: the coupler around the one solid of the scene. */
#include "scene_impl.h"

#include <math.h>
#include <string.h>

/* Sides that particles of the solid stand beyond are walls that it leans on. */
static void find_leaning(bw_scene *s, bw_coupler_config *c)
{
  const bw_scene__solid *q = &s->solid[0];
  const bw_ns_channel_config *fluid = bw_ns_channel_settings(s->fluid);
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < q->n; i++)
    for (size_t d = 0; d < 3; d++) {
      /* Particles whose face lies on the wall touch it; those beyond are held under it. */
      const double near = 0.75 * bw_solid_spacing(q->solid, i);
      lower[d] = fmin(lower[d], q->X0[3 * i + d] - near);
      upper[d] = fmax(upper[d], q->X0[3 * i + d] + near);
    }
  bw_comm_min(s->comm, 3, lower);
  bw_comm_max(s->comm, 3, upper);
  for (int d = 0; d < (s->planar ? 2 : 3); d++) {
    const bool walls[2] = {fluid->side[d][0].kind == BW_SIDE_WALL,
                           fluid->side[d][1].kind == BW_SIDE_WALL};
    c->walled[d][0] = walls[0] && lower[d] < 0.0;
    c->walled[d][1] = walls[1] && upper[d] > s->config.domain.length[d];
  }
}

bw_status bw_scene__coupled_create(bw_scene *s)
{
  const bw_scene_numerics *n = &s->config.numerics;
  bw_coupler_config c = bw_coupler_config_default();
  c.rho = s->config.fluid.density;
  c.nu = s->config.fluid.viscosity;
  c.kernel = (bw_kernel_delta_id)n->kernel;
  c.iterations = n->forcing_iterations;
  c.memory = n->memory;
  c.retraction = n->retraction;
  c.marker_spacing = n->marker_spacing;
  c.probe_length = n->probe_length;
  c.probe_profile = (bw_probe_profile)n->probe_profile;
  c.solid_safety = n->solid_share;
  c.load = (bw_coupler_load_kind)n->load;
  c.load_relaxation = n->load_relaxation;
  c.check_relaxation = true;
  c.predictor = n->predictor;
  c.virtual_mass = n->virtual_mass;
  c.coupling_iterations = n->coupling_iterations;
  c.coupling_residual = n->coupling_residual;
  for (int d = 0; d < 3; d++)
    c.gravity[d] = s->config.gravity[d];
  find_leaning(s, &c);
  c.films.on = !isnan(s->config.fluid.film_roughness);
  c.films.flux = s->config.fluid.film_flux != 0;
  c.films.limit = s->config.fluid.film_limit, c.films.roughness = s->config.fluid.film_roughness;
  if (!isnan(s->config.fluid.film_least)) c.films.least = s->config.fluid.film_least;
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid[0].solid, &s->coupler));
  if (s->floats == NULL) return BW_OK;
  const bool contact = strcmp(s->config.contact.between, "none") != 0;
  return bw_scene__rigid_named(s, bw_coupler_join(s->coupler, s->floats, contact));
}
