/* Water of particles falls out of a corner of a tank, in two dimensions, on any number of ranks.
 * BUILD modules=ulph,shape
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_ulph.h"
#include <math.h>
#include <stdio.h>

static bw_status collapse(const bw_comm *world)
{
  bw_ulph_config config = bw_ulph_config_default(); /* SI units */
  config.dimensions = 2;
  config.dx = 0.01;
  config.rho0 = 1000;
  config.gravity[1] = -9.81;
  config.speed = 2 * sqrt(9.81 * 0.2); /* of the front; sound is 10 times as fast */

  const double origin[3] = {0};
  const bw_shape water = {.upper = {0.1, 0.2}};
  const bw_shape tank[2] = {{.lower = {-0.04, -0.04}, .upper = {0.44, 0.3}}, /* its outside */
                            {.upper = {0.4, 1}, .remove = true}};            /* and its inside */
  const bw_ulph_wall wall = {.count = 2, .shape = tank};
  size_t n = 0;
  double *x = NULL;
  bw_ulph *fluid = NULL;
  bw_status st = bw_ulph_fill(world, &config, origin, 1, &water, &n, &x);
  BW_THEN(st, bw_ulph_create(world, &config, n, x, 1, &wall, &fluid));
  while (st == BW_OK && bw_ulph_time(fluid) < 0.15)
    st = bw_ulph_step(fluid, bw_ulph_dt_max(fluid));
  bw_release(&x);
  if (st != BW_OK) {
    bw_ulph_destroy(&fluid);
    return st;
  }
  const double all[2][3] = {{0, 0, 0}, {0.4, 0.3, 0}};
  const double front = bw_ulph_reach(fluid, 0, all[0], all[1]);
  const bw_ulph_ledger e = bw_ulph_account(fluid);
  if (bw_comm_rank(world) == 0)
    printf("t = %.3f s, front at %.3f m, kinetic energy %.3g J/m of %.3g at the start\n",
           bw_ulph_time(fluid), front, e.kinetic, e.first);
  bw_ulph_destroy(&fluid);
  return front > 0.2 && front < 0.3 ? BW_OK : BW_FAIL(BW_EDIVERGED, "the front is at %g", front);
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  return bw_finish(&world, collapse(world));
}
