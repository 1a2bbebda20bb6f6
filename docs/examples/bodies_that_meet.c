/* A rigid ball and a block meet off their line of centres: they part, and turn.
 * BUILD modules=rigid
 * TEST  ranks=1,2 */
#include "bw_rigid.h"

#include <math.h>
#include <stdio.h>

static bw_status meet(const bw_comm *world)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .radius = 0.5};
  const bw_shape block = {.kind = BW_SHAPE_BOX, .lower = {0.8, 0, -0.5}, .upper = {1.8, 1, 0.5}};
  const bw_rigid_body body[2] = {
      {.count = 1, .shape = &ball, .density = 1.0, .velocity = {1, 0, 0}},
      {.count = 1, .shape = &block, .density = 2.0}};
  bw_rigid *bodies = NULL;
  bw_status st = BW_OK;
  bw_rigid_config config = bw_rigid_config_default();
  config.spacing = 0.1, config.stiffness = 1000.0;
  BW_TRY(bw_rigid_create(world, &config, 2, body, &bodies));
  while (st == BW_OK && bw_rigid_time(bodies) < 2.0)
    st = bw_rigid_step(bodies, bw_rigid_dt_max(bodies));
  const bw_rigid_state s = bw_rigid_state_of(bodies, 1);
  if (st == BW_OK && bw_comm_rank(world) == 0)
    printf("the block moves at %.3f and turns at %.3f\n", s.velocity[0], s.spin[2]);
  /* What was struck below its centre turns. */
  if (st == BW_OK && !(s.velocity[0] > 0.1 && fabs(s.spin[2]) > 0.05))
    st = BW_FAIL(BW_EDIVERGED, "they have not met");
  bw_rigid_destroy(&bodies);
  return st;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  if (st == BW_OK) st = meet(world);
  return bw_finish(&world, st);
}
