/* A rigid ball settles in a box of oil: a fluid, a body, and the loop in which they meet.
 * BUILD modules=coupler,rigid,ns_channel
 * TEST  ranks=1,2 */
#include "bw_coupler_rigid.h"

#include <stdio.h>

typedef struct {
  bw_grid *grid;
  bw_ns_channel *oil;
  bw_rigid *ball;
  bw_coupler_rigid *coupler;
} scene;

static void scene_destroy(scene *s)
{
  bw_coupler_rigid_destroy(&s->coupler);
  bw_rigid_destroy(&s->ball);
  bw_ns_channel_destroy(&s->oil);
  bw_grid_destroy(&s->grid);
}

/* A closed box, 3 x 4 x 3 diameters, 6 cells to each. */
static bw_status make_oil(const bw_comm *world, scene *s)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config oil = bw_ns_channel_config_default();
  for (int d = 0; d < 3; d++) {
    grid.n[d] = d == 1 ? 24 : 18;
    grid.length[d] = grid.n[d] / 6.0;
    grid.periodic[d] = false;
    oil.side[d][0].kind = oil.side[d][1].kind = BW_SIDE_WALL;
  }
  grid.halo = 2;
  oil.nu = 0.1;
  BW_TRY(bw_grid_create(world, &grid, &s->grid));
  return bw_ns_channel_create(s->grid, &oil, &s->oil);
}

static bw_status make_ball(const bw_comm *world, scene *s)
{
  const bw_shape sphere = {.kind = BW_SHAPE_SPHERE, .centre = {1.5, 2.5, 1.5}, .radius = 0.5};
  const bw_rigid_body body = {.count = 1, .shape = &sphere, .density = 1.5};
  bw_rigid_config config = bw_rigid_config_default();
  config.spacing = 1.0 / 6.0; /* that of the grid: the surface points are the markers */
  BW_TRY(bw_rigid_create(world, &config, 1, &body, &s->ball));
  bw_coupler_rigid_config c = bw_coupler_rigid_config_default();
  c.rho = 1.0, c.nu = 0.1;
  c.gravity[1] = -1.0;
  return bw_coupler_rigid_create(&c, s->oil, s->ball, &s->coupler);
}

static bw_status settle(const bw_comm *world, scene *s)
{
  BW_TRY(make_oil(world, s));
  BW_TRY(make_ball(world, s));
  const double dt = 0.5 * bw_ns_channel_dt_max(s->oil);
  for (int step = 0; step < 60; step++)
    BW_TRY(bw_coupler_rigid_step(s->coupler, dt));
  bw_coupler_rigid_report r;
  BW_TRY(bw_coupler_rigid_measure(s->coupler, &r));
  const bw_rigid_state b = bw_rigid_state_of(s->ball, 0);
  if (bw_comm_rank(world) == 0)
    printf("y %.3f, velocity %.4f, force %.4f, slip %.1e\n", b.position[1], b.velocity[1],
           r.force[1], r.slip);
  BW_REQUIRE(b.velocity[1] < 0.0 && r.force[1] > 0.0, BW_EDIVERGED, "the ball does not settle");
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  scene s = {.grid = NULL};
  bw_status st = bw_init(&argc, &argv, &world);
  if (st == BW_OK) st = settle(world, &s);
  scene_destroy(&s);
  return bw_finish(&world, st);
}
