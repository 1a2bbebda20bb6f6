/* A disc of soft solid, free in a channel: the stream takes it along. The solid, its surface and
 * the coupled step; the surface is closed, the mass stays, and the disc ends up with the stream.
 * BUILD modules=coupler
 * TEST  ranks=1,2 */
#include "bw_coupler.h"
#include "bw_memory.h"
#include <math.h>
#include <stdio.h>

enum { CELLS = 32, ACROSS = 8 };                    /* over the channel; of the disc's diameter */
static const double H = 1.0, spacing = 1.0 / CELLS; /* bulk velocity and density of the fluid: 1 */

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_pd_interface *surface;
  bw_coupler *coupler;
} scene;

static bw_status make_fluid(const bw_comm *world, scene *s)
{
  bw_grid_config box = bw_grid_config_default();
  box.n[0] = 2 * CELLS, box.n[1] = CELLS, box.n[2] = 1;
  box.length[0] = 2 * H, box.length[1] = H, box.length[2] = spacing;
  box.periodic[0] = box.periodic[2] = true;
  box.halo = 2;
  bw_ns_channel_config flow = bw_ns_channel_config_default(); /* walls in y */
  flow.nu = 0.05, flow.forcing = BW_FORCING_FLOW_RATE, flow.forcing_value = 1.0;
  for (int side = 0; side < 2; side++)
    flow.side[0][side].kind = flow.side[2][side].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_grid_create(world, &box, &s->grid));
  return bw_ns_channel_create(s->grid, &flow, &s->fluid);
}

/* Particles at the fluid's spacing whose centres lie within the disc. */
static bw_status make_solid(const bw_comm *world, scene *s)
{
  int32_t site[3 * ACROSS * ACROSS];
  int64_t n = 0;
  for (int32_t j = 0; j < ACROSS; j++)
    for (int32_t i = 0; i < ACROSS; i++)
      if (hypot(i - 3.5, j - 3.5) < 0.5 * ACROSS)
        site[3 * n] = i, site[3 * n + 1] = j, site[3 * n++ + 2] = 0;
  bw_solid_config material = bw_solid_config_default();
  material.geometry = BW_PD_PLANE_STRAIN, material.thickness = spacing;
  material.ds = spacing, material.rho = 1.0, material.E = 1000.0, material.damping.mean = 100.0;
  material.origin[0] = 0.5 * H, material.origin[1] = 0.5 * H - 0.5 * ACROSS * spacing;
  material.origin[2] = 0.5 * spacing;
  material.period[0] = 2 * H; /* it may swim across the seam */
  return bw_solid_create_same(world, &material, n, site, NULL, &s->solid);
}

/* The sum of A N over the surface is nothing where it is closed. */
static bw_status look_at_surface(const bw_comm *world, scene *s)
{
  const bw_pd_interface_config c = bw_pd_interface_config_default();
  BW_TRY(bw_pd_interface_create(s->solid, &c, &s->surface));
  BW_TRY(bw_pd_interface_update(s->surface)); /* after each motion of the solid */
  const bw_pd_surface rim = bw_pd_interface_surface(s->surface);
  double sum[4] = {0.0, 0.0, 0.0, 0.0}; /* A N, A */
  for (size_t q = 0; q < rim.n; q++) {
    for (int d = 0; d < 3; d++)
      sum[d] += rim.A[q] * rim.N[3 * q + (size_t)d];
    sum[3] += rim.A[q];
  }
  bw_comm_sum(world, 4, sum);
  if (bw_comm_rank(world) == 0)
    printf("surface %.4f, of a circle %.4f\n", sum[3] / spacing, 0.7854);
  BW_REQUIRE(hypot(sum[0], sum[1]) < 1e-10 * sum[3], BW_EDIVERGED, "the surface is not closed");
  return BW_OK;
}

static bw_status couple(scene *s)
{
  bw_coupler_config c = bw_coupler_config_default();
  c.rho = 1.0, c.nu = 0.05;
  c.load = BW_LOAD_REACTION;
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  for (int step = 0; step < 200; step++) { /* the stream sets in around a disc that is held */
    if (step == 50) bw_coupler_hold_solid(s->coupler, false);
    BW_TRY(bw_coupler_step(s->coupler, 4e-3));
  }
  return BW_OK;
}

static bw_status simulate(const bw_comm *world, scene *s)
{
  bw_coupler_report r;
  BW_TRY(make_fluid(world, s));
  BW_TRY(make_solid(world, s));
  BW_TRY(look_at_surface(world, s));
  BW_TRY(couple(s));
  BW_TRY(bw_coupler_measure(s->coupler, &r));
  double V[3 * ACROSS * ACROSS], sum[2] = {0.0, (double)bw_solid_count(s->solid)};
  bw_solid_get_velocity(s->solid, V);
  for (size_t i = 0; i < bw_solid_count(s->solid); i++)
    sum[0] += V[3 * i];
  bw_comm_sum(world, 2, sum);
  const double speed = sum[0] / sum[1];
  if (bw_comm_rank(world) == 0)
    printf("the disc moves at %.3f U_b, %lld markers, slip %.1e U_b\n", speed, (long long)r.markers,
           r.slip_rms);
  /* On the axis the stream is at 1.5 U_b; a disc of a quarter of the channel lags a little. */
  BW_REQUIRE(speed > 1.0 && speed < 1.5, BW_EDIVERGED, "the disc moves at %g U_b", speed);
  BW_REQUIRE(r.mass_out == 0.0 && r.mass_left == 0.0, BW_EDIVERGED, "mass is gone");
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  scene s = {NULL, NULL, NULL, NULL, NULL};
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  const bw_status status = simulate(world, &s);
  bw_coupler_destroy(&s.coupler);
  bw_pd_interface_destroy(&s.surface);
  bw_solid_destroy(&s.solid);
  bw_ns_channel_destroy(&s.fluid);
  bw_grid_destroy(&s.grid);
  return bw_finish(&world, status);
}
