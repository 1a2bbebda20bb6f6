/* A fluid by itself: a channel at rest that a pressure gradient sets in motion; the velocity on
 * the centre line against the exact series.
 * BUILD modules=ns_channel
 * TEST  ranks=1,2 */
#include "bw_ns_channel.h"
#include <math.h>
#include <stdio.h>
/* U_max = G H^2/(8 nu) = 1 with H = 1 */
static const double pi = 3.141592653589793, nu = 0.1, gradient = 0.8;

static double exact(double t)
{
  double u = 1.0;
  for (int n = 0; n < 20; n++)
    u -=
        (n % 2 ? -32.0 : 32.0) * exp(-pow((2 * n + 1) * pi, 2) * nu * t) / pow((2 * n + 1) * pi, 3);
  return u;
}

static bw_status simulate(const bw_comm *world, bw_grid **grid, bw_ns_channel **fluid)
{
  bw_grid_config box = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    box.n[d] = d == 1 ? 33 : 4, box.length[d] = 1.0, box.periodic[d] = d != 1;
  bw_ns_channel_config flow = bw_ns_channel_config_default(); /* walls at rest */
  flow.nu = nu;
  flow.forcing = BW_FORCING_GRADIENT, flow.forcing_value = gradient;
  for (int s = 0; s < 2; s++)
    flow.side[0][s].kind = flow.side[2][s].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_grid_create(world, &box, grid));
  BW_TRY(bw_ns_channel_create(*grid, &flow, fluid));
  const bw_grid_view *g = bw_grid_look(*grid);
  const int centre = 17 - g->lo[1]; /* local number of the row in the middle */
  for (int sample = 1; sample <= 5; sample++) {
    while (bw_ns_channel_time(*fluid) < 0.5 * sample - 1e-9)
      BW_TRY(bw_ns_channel_step(*fluid, 1e-3));
    double u = 0.0; /* the ranks without the point add nothing */
    if (centre >= 1 && centre <= g->m[1] && g->lo[2] == 0)
      u = (double)bw_ns_channel_velocity(*fluid)[0][bw_at(g, 1, centre, 1)];
    bw_comm_sum(world, 1, &u);
    const double t = bw_ns_channel_time(*fluid), series = exact(t);
    if (bw_comm_rank(world) == 0) printf("t = %.1f  u = %.5f  exact %.5f\n", t, u, series);
    /* the walls' mirror ghosts cost dy^2/8 times the curvature 8: 0.9e-3 */
    BW_REQUIRE(fabs(u - series) < 1e-3, BW_EDIVERGED, "u = %g is not %g", u, series);
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_grid *grid = NULL;
  bw_ns_channel *fluid = NULL;
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  const bw_status status = simulate(world, &grid, &fluid);
  bw_ns_channel_destroy(&fluid);
  bw_grid_destroy(&grid);
  return bw_finish(&world, status);
}
