/* Claim: second order in space (velocity and pressure), third order in time (velocity; in
 * implicit runs: implicit.c).
 * Reference: the Taylor-Green vortex carried along by a uniform stream (U, V),
 *   u = U + sin x' cos y' F, v = V - cos x' sin y' F, p = (cos 2x' + cos 2y') F^2/4,
 *   F = exp(-2 nu t), x' = x - U t, y' = y - V t: an exact solution (Galilean invariance).
 * Measured: largest error at t = 0.5 on 16^2, 32^2, 64^2 with a fixed small dt; then, on 24^2 in
 * 3D (4 cells in z), differences between runs with dt, dt/2, dt/4 (Richardson: space cancels).
 * Tolerance: 0.15 on an order of 2: the next term of the expansion is (k dx)^2/4 = 4 % at 32^2,
 * which shifts the order by that much over log 2; time: 0.25 on 3, the differences have a
 * dt^4 part of about the ratio of successive steps' truncation (dt lambda/4).
 * The pressure that a step leaves belongs to the middle of its last sub-step, t - dt/6
 * (README); it is compared there.
 * TEST ranks=1,2 */
#include "flow.h"

static const double stream_u = 1.0, stream_v = 0.5, nu = 0.05;
static const double two_pi = 6.283185307179586;

static void vortex(const double x[3], double t, void *context, double u[3])
{
  (void)context;
  const double f = exp(-2.0 * nu * t), a = x[0] - stream_u * t, b = x[1] - stream_v * t;
  u[0] = stream_u + sin(a) * cos(b) * f;
  u[1] = stream_v - cos(a) * sin(b) * f;
  u[2] = 0.0;
}

static double pressure_error(bw_ns_channel *ns, double t)
{
  const bw_grid *grid = bw_ns_channel_grid(ns);
  const bw_grid_view *g = bw_grid_look(grid);
  double most = 0.0;
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++) {
      double x[3];
      flow_point(g, 3, i, j, 1, x);
      const double a = x[0] - stream_u * t, b = x[1] - stream_v * t;
      const double exact = 0.25 * (cos(2 * a) + cos(2 * b)) * exp(-4.0 * nu * t);
      most = fmax(most, fabs((double)bw_ns_channel_pressure(ns)[bw_at(g, i, j, 1)] - exact));
    }
  bw_comm_max(bw_grid_comm(grid), 1, &most);
  return most;
}

static bw_status create(const bw_comm *comm, int n, int nz, bw_ns_viscous viscous, bw_grid **grid,
                        bw_ns_channel **ns)
{
  const flow_box box = {
      .n = {n, n, nz}, .length = {two_pi, two_pi, 1.0}, .periodic = {true, true, true}};
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu, c.viscous = viscous;
  BW_TRY(flow_create(comm, &box, &c, grid, ns));
  return bw_ns_channel_set_velocity(*ns, vortex, NULL, 0.0);
}

static bw_status space(bw_validation *v, bw_ns_viscous viscous)
{
  const char *extra = flow_viscous_name[viscous];
  enum { GRIDS = 3 };
  double e[GRIDS], ep[GRIDS];
  const double t = 0.5;
  const int steps = 100;
  for (int q = 0; q < GRIDS; q++) {
    bw_grid *grid = NULL;
    bw_ns_channel *ns = NULL;
    BW_TRY(create(bw_validation_comm(v), 16 << q, 1, viscous, &grid, &ns));
    BW_TRY(flow_run(ns, t, steps));
    e[q] = flow_error(ns, vortex, NULL);
    ep[q] = pressure_error(ns, t - t / steps / 6.0);
    flow_destroy(&grid, &ns);
  }
  bw_validation_row(v, &(bw_claim){.claim = "velocity is of second order in space",
                                   .quantity = "order_velocity",
                                   .measured = bw_validation_order(2, e[1], 1, e[2]),
                                   .reference = 2.0,
                                   .tolerance = 0.075,
                                   .kind = BW_ORDER,
                                   .source = "Taylor-Green vortex in a uniform stream",
                                   .extra = extra});
  bw_validation_row(v, &(bw_claim){.claim = "pressure is of second order in space",
                                   .quantity = "order_pressure",
                                   .measured = bw_validation_order(2, ep[1], 1, ep[2]),
                                   .reference = 2.0,
                                   .tolerance = 0.075,
                                   .kind = BW_ORDER,
                                   .source = "Taylor-Green vortex in a uniform stream",
                                   .extra = extra});
  bw_validation_row(v, &(bw_claim){.claim = "error at 64^2, t = 0.5",
                                   .quantity = "error_velocity",
                                   .measured = e[2],
                                   .reference = 0.0,
                                   /* phase error U t k^3 dx^2/8 of the averages with k = 1, and
                                      as much of every other term: 3 of them */
                                   .tolerance = 3 * 0.5 * pow(two_pi / 64, 2) / 8,
                                   .kind = BW_ANALYTIC,
                                   .source = "Taylor-Green vortex in a uniform stream",
                                   .extra = extra});
  return BW_OK;
}

enum { N_TIME = 24, NZ_TIME = 4, CELLS = N_TIME * N_TIME * NZ_TIME };

/* u of all ranks is compared point by point: every run is on the same ranks. */
static bw_status time_run(bw_validation *v, int steps, double *keep)
{
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  BW_TRY(create(bw_validation_comm(v), N_TIME, NZ_TIME, BW_VISCOUS_EXPLICIT, &grid, &ns));
  BW_TRY(flow_run(ns, 1.2, steps));
  const bw_grid_view *g = bw_grid_look(grid);
  size_t q = 0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++)
        keep[q++] = (double)bw_ns_channel_velocity(ns)[0][bw_at(g, i, j, k)];
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status time_order(bw_validation *v)
{
  static const int steps[] = {16, 32, 64};
  static double u[3][CELLS];
  double difference[2] = {0, 0};
  for (int q = 0; q < 3; q++)
    BW_TRY(time_run(v, steps[q], u[q]));
  for (int q = 0; q < 2; q++)
    for (int at = 0; at < CELLS; at++)
      difference[q] = fmax(difference[q], fabs(u[q][at] - u[q + 1][at]));
  bw_comm_max(bw_validation_comm(v), 2, difference);
  bw_validation_row(v,
                    &(bw_claim){.claim = "velocity is of third order in time",
                                .quantity = "order_time",
                                .measured = bw_validation_order(2, difference[0], 1, difference[1]),
                                .reference = 3.0,
                                .tolerance = 0.25 / 3,
                                .kind = BW_ORDER,
                                .source = "Wray's RK3 (ERRATA 5), Richardson differences"});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int viscous = BW_VISCOUS_EXPLICIT; viscous <= BW_VISCOUS_IMPLICIT; viscous++)
    BW_TRY(space(v, (bw_ns_viscous)viscous));
  return time_order(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.taylor_green", run);
}
