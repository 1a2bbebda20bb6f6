/* Claim: a constant gradient ends in Poiseuille's parabola; constant flow rate finds the gradient.
 * Reference: u = G y (H - y)/(2 nu), U_b = G H^2/(12 nu). The scheme's own steady solution is known
 * in closed form on a uniform grid: second differences of the parabola are exact, and the mirror
 * ghost shifts it by G dy^2/(8 nu) at every point (solve u_0 = -u_1 for the constant).
 * Measured: from rest to t nu/H^2 = 3 (e^(-3 pi^2) = 1e-13 of the transient is left) on 8, 16, 32
 * cells; then the gradient that U_b = 1 needs, uniform and stretched.
 * Tolerance: the shift to round-off of 1e4 steps and the transient (1e-10 relative to U_max);
 * order 2 to 1e-6, since the error is dy^2 exactly. Gradient: uniform, the discrete relation
 * U_b = G (H^2 + 2 dy^2)/(12 nu) to 1e-9 (the mean of y(H - y) over midpoints is
 * H^2/6 + dy^2/12, plus the shift dy^2/4: H^2/6 (1 + 2 dy^2/H^2)); stretched, 1 %.
 * TEST ranks=1,2 */
#include "flow.h"

static const double nu = 1.0, height = 1.0;

static void parabola(const double x[3], double t, void *context, double u[3])
{
  const double g = *(const double *)context;
  (void)t;
  u[0] = g * x[1] * (height - x[1]) / (2.0 * nu);
  u[1] = u[2] = 0.0;
}

static bw_status steady(const bw_comm *comm, int n, double stretch, bw_ns_forcing forcing,
                        double value, double *error, double *shift_error, double *gradient)
{
  const flow_box box = {.n = {4, n, 1},
                        .length = {4.0, height, 1.0},
                        .periodic = {true, false, true},
                        .stretch = stretch};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu, c.forcing = forcing, c.forcing_value = value;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  BW_TRY(flow_run_share(ns, 3.0, 0.9));
  double shift = value * height * height / (n * n) / (8.0 * nu), most = 0.0;
  *error = flow_error(ns, parabola, &value);
  const bw_grid_view *g = bw_grid_look(grid);
  for (int j = 1; j <= g->m[1]; j++) {
    double x[3], u[3];
    flow_point(g, 0, 1, j, 1, x);
    parabola(x, 0, &value, u);
    most =
        fmax(most, fabs((double)bw_ns_channel_velocity(ns)[0][bw_at(g, 1, j, 1)] - u[0] - shift));
  }
  bw_comm_max(comm, 1, &most);
  *shift_error = most;
  *gradient = bw_ns_channel_summary(ns).pressure_gradient;
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  double e[3], s[3], g, unused;
  for (int q = 0; q < 3; q++)
    BW_TRY(steady(comm, 8 << q, 0, BW_FORCING_GRADIENT, 8.0, &e[q], &s[q], &unused));
  const char *source = "plane Poiseuille flow and its second-order discrete solution";
  bw_validation_row(v, &(bw_claim){"profile is the parabola shifted by G dy^2/(8 nu)",
                                   "shift_error_over_u_max", s[2], 0.0, 1e-10, BW_ANALYTIC, source,
                                   NULL});
  bw_validation_row(v, &(bw_claim){"profile is of second order", "order",
                                   bw_validation_order(2, e[1], 1, e[2]), 2.0, 1e-6, BW_ORDER,
                                   source, NULL});
  BW_TRY(steady(comm, 16, 0, BW_FORCING_FLOW_RATE, 1.0, &unused, &unused, &g));
  const double dy = height / 16;
  bw_validation_row(v, &(bw_claim){"gradient for U_b = 1, uniform", "gradient", g,
                                   12 * nu / (height * height + 2 * dy * dy), 1e-9, BW_ANALYTIC,
                                   source, NULL});
  BW_TRY(steady(comm, 24, 1.5, BW_FORCING_FLOW_RATE, 1.0, &unused, &unused, &g));
  bw_validation_row(v, &(bw_claim){"gradient for U_b = 1, stretched", "gradient", g, 12.0, 0.01,
                                   BW_ANALYTIC, source, NULL});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.poiseuille", run);
}
