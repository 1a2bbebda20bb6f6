/* A dam break of particles meets a rubber plate that stands in the floor of the tank, in two
 * dimensions, on any number of ranks.
 * BUILD modules=coupler_particles,shape,solid
 * TEST  ranks=1,2 */
#include "bw_coupler_particles.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include <math.h>
#include <stdio.h>

enum { WIDE = 5, HIGH = 20, FOOT = 4 };

/* Five layers 2 mm apart, the lower four rows held in the floor. */
static bw_status plate(const bw_comm *world, bw_solid **out)
{
  bw_solid_config c = bw_solid_config_default(); /* SI units */
  int32_t site[WIDE * (HIGH + FOOT)][3];
  uint8_t kind[WIDE * (HIGH + FOOT)];
  c.geometry = BW_PD_PLANE_STRAIN;
  c.ds = 0.002, c.rho = 1100, c.E = 1e6;
  c.choice.law = BW_SOLID_CORRESPONDENCE, c.choice.poisson_ratio = 0.4;
  c.horizon_ratio = 1.5, c.family_reach = BW_PD_REACH_HORIZON;
  c.origin[0] = 0.15, c.origin[1] = -FOOT * c.ds;
  for (int q = 0; q < WIDE * (HIGH + FOOT); q++) {
    site[q][0] = q % WIDE, site[q][1] = q / WIDE, site[q][2] = 0;
    kind[q] = site[q][1] < FOOT ? BW_PD_PRESCRIBED : BW_PD_FREE;
  }
  return bw_solid_create_same(world, &c, WIDE * (HIGH + FOOT), site[0], kind, out);
}

static bw_status collapse(const bw_comm *world)
{
  bw_ulph_config config = bw_ulph_config_default();
  bw_coupler_particles_config between = bw_coupler_particles_config_default();
  const double origin[3] = {0};
  const bw_shape water = {.upper = {0.08, 0.12}};
  const bw_shape tank[2] = {{.lower = {-0.016, -0.016}, .upper = {0.316, 0.2}},
                            {.upper = {0.3, 1}, .remove = true}};
  const bw_ulph_wall wall = {.count = 2, .shape = tank};
  bw_ulph *fluid = NULL;
  bw_solid *solid = NULL;
  bw_coupler_particles *both = NULL;
  size_t n = 0;
  double *x = NULL;
  config.dimensions = 2, config.dx = 0.004, config.rho0 = 1000;
  config.gravity[1] = between.gravity[1] = -9.81;
  config.speed = 2 * sqrt(9.81 * 0.12);
  bw_status st = plate(world, &solid);
  BW_THEN(st, bw_ulph_fill(world, &config, origin, 1, &water, &n, &x));
  BW_THEN(st, bw_ulph_create(world, &config, n, x, 1, &wall, &fluid));
  BW_THEN(st, bw_coupler_particles_create(&between, &config, fluid, solid, 1, &wall, &both));
  BW_THEN(st, bw_ulph_start(fluid, NULL, NULL));
  while (st == BW_OK && bw_ulph_time(fluid) < 0.2)
    st = bw_coupler_particles_step(both, bw_coupler_particles_dt_max(both));
  if (st == BW_OK) {
    const bw_coupler_particles_report r = bw_coupler_particles_measure(both);
    if (bw_comm_rank(world) == 0)
      printf("t = %.3f s, the water pushes the plate with %.3g N/m and has given it %.3g J/m\n",
             bw_ulph_time(fluid), r.force[0], r.given);
    if (!(r.given > 0 && r.impulse[0] > 0)) st = BW_FAIL(BW_EDIVERGED, "no water has arrived");
  }
  bw_coupler_particles_destroy(&both);
  bw_ulph_destroy(&fluid);
  bw_solid_destroy(&solid);
  bw_release(&x);
  return st;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  return bw_finish(&world, collapse(world));
}
