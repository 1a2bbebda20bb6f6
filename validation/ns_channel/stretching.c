/* Claim: second order in space on stretched grids, also on those that a table gives.
 *
 * Reference: the slowest mode of Stokes flow between walls, closed form (stokes_mode.h): velocity
 * and pressure, all derivatives, no slip.
 *
 * Measured: largest error of u and v over the largest u on n x n cells, n = 16, 32, 64, at s t = 1;
 * faces by tanh (strength 1.5), by a table of L (j/n - 0.8 sin(2 pi j/n)/(2 pi)), and by
 * Chebyshev's L (1 - cos(pi j/n))/2, whose cells grow by the factor 3 at the wall. All implicit,
 * 400 steps: the time error is (s dt)^2/12 = 5e-7.
 *
 * Tolerance: order 2 within 10 % between 32 and 64 cells: the next terms are (2 pi/32)^2 = 4 %,
 * larger in the middle of a stretched grid, where cells have twice the mean height.
 * TEST ranks=1,2 */
#include "stokes_mode.h"

enum { LARGEST = 64 };

static double sine(double part)
{
  return part - 0.8 * sin(2.0 * stokes_pi * part) / (2.0 * stokes_pi);
}

static double chebyshev(double part)
{
  return 0.5 * (1.0 - cos(stokes_pi * part));
}

/* face NULL: tanh. */
static bw_status error_of(const bw_comm *comm, int n, double (*face)(double), double *error)
{
  double y[LARGEST + 1];
  stokes_mode m = stokes_slowest(1.0);
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_grid_config g = bw_grid_config_default();
  bw_ns_channel_config c = bw_ns_channel_config_default();
  for (int j = 0; j <= n; j++)
    y[j] = face != NULL ? face((double)j / n) : 0.0;
  g.n[0] = g.n[1] = n, g.n[2] = 1;
  g.length[0] = g.length[1] = g.length[2] = 1.0;
  g.periodic[0] = g.periodic[2] = true;
  g.y_stretch = face != NULL ? BW_STRETCH_TABLE : BW_STRETCH_TANH, g.y_table = y;
  for (int s = 0; s < 2; s++)
    c.side[0][s].kind = c.side[2][s].kind = BW_SIDE_PERIODIC;
  c.nu = 1.0, c.viscous = BW_VISCOUS_IMPLICIT;
  BW_TRY(bw_grid_create(comm, &g, &grid));
  BW_TRY(bw_ns_channel_create(grid, &c, &ns));
  BW_TRY(bw_ns_channel_set_velocity(ns, stokes_velocity, &m, 0.0));
  BW_TRY(flow_run(ns, 1.0 / m.rate, 400));
  *error = flow_error(ns, stokes_velocity, &m) * exp(1.0) / stokes_largest(&m);
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const struct {
    const char *name;
    double (*face)(double);
  } kind[] = {{"tanh", NULL}, {"table, sine", sine}, {"table, Chebyshev", chebyshev}};
  for (size_t q = 0; q < sizeof kind / sizeof *kind; q++) {
    double e[3];
    for (int n = 0; n < 3; n++)
      BW_TRY(error_of(bw_validation_comm(v), 16 << n, kind[q].face, &e[n]));
    bw_validation_row(v, &(bw_claim){kind[q].name, "order_velocity",
                                     bw_validation_order(2.0, e[1], 1.0, e[2]), 2.0, 0.1, BW_ORDER,
                                     "slowest Stokes mode between walls, closed form", NULL});
    bw_validation_row(v, &(bw_claim){kind[q].name, "error_at_64_cells", e[2], 0.0, INFINITY,
                                     BW_ANALYTIC, "slowest Stokes mode between walls, closed form",
                                     NULL});
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.stretching", run);
}
