/* Claim: laminar flow in a square duct (walls in y and z, constant gradient) is that of the series
 *   u = 4 G a^2/(pi^3 nu) sum_{n odd} [1 - cosh(n pi (z/a - 1/2))/cosh(n pi/2)] sin(n pi y/a)/n^3,
 * Q = 0.0351443 G a^4/nu, U_max/U_mean = 2.0963 (White, Viscous Fluid Flow).
 * Measured: from rest to t nu/a^2 = 1.2 (e^(-2 pi^2 1.2) = 5e-11 of the transient is left) on 8, 16
 * and 32 cells across; the largest error over all points, the flow rate; the duct turned by 90
 * degrees (uniform y against z) has to give the same field.
 * Tolerance: order 2 within 5 %, as the corners, where u_yy + u_zz = -G/nu meets 0 = 0, add terms
 * of h^4 log h. Largest error on 32 cells: as in plane flow the mirror ghost shifts the cells at a
 * wall by G h^2/(8 nu) = 1.7e-3 U_max; claimed 2e-3. Q and U_max/U_mean extrapolated from 16 and 32
 * cells: what is left is of the fourth order, (pi/16)^4/24 = 6e-5 of them, claimed 2e-4. No point
 * lies in the centre: the four next to it have u_c + (h/2)^2 (u_yy + u_zz)/2 = u_c - G h^2/(8 nu).
 * Symmetry: round-off of 1e4 steps, 1e-10.
 *
 * Inflow. The Poiseuille inflow of a duct is the same profile, scaled to the bulk velocity; also
 * with sides 1:2 (U_max/U_mean = 1.9918 by the series). Measured and claimed as above, on 16 and 32
 * cells across the short side, but for the largest error: scaling divides by a flow rate that the
 * mirror ghosts shift, too, so G h^2/(8 nu) over the mean is claimed. That the profile crosses the
 * box unchanged is a unit test (test_ns_sides).
 *
 * TEST ranks=1,2 */
#include "flow.h"

#include <stdio.h>

/* The first term left out is 4/pi^3/121^3 = 7e-8 on a wall's neighbours, 1e-6 of U_max. */
enum { TERMS = 60 };

static double cosh_ratio(double s, double half)
{
  return (exp(s - half) + exp(-s - half)) / (1.0 + exp(-2.0 * half));
}

/* Section 0 <= y <= 1, 0 <= z <= b; G = nu = 1. */
static double section_velocity(double y, double z, double b)
{
  const double pi = acos(-1.0);
  double sum = 0.0;
  for (int q = 0; q < TERMS; q++) {
    const double n = 2 * q + 1;
    sum += (1.0 - cosh_ratio(n * pi * fabs(z - 0.5 * b), 0.5 * n * pi * b)) * sin(n * pi * y) /
           (n * n * n);
  }
  return 4.0 / (pi * pi * pi) * sum;
}

static double section_mean(double b)
{
  const double pi = acos(-1.0);
  double sum = 0.0;
  for (int q = 0; q < TERMS; q++) {
    const double n = 2 * q + 1, x = 0.5 * n * pi * b;
    sum += 2.0 / (n * pi) * (1.0 - tanh(x) / x) / (n * n * n);
  }
  return 4.0 / (pi * pi * pi) * sum;
}

static void series(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = section_velocity(x[1], x[2], 1.0);
  u[1] = u[2] = 0.0;
}

typedef struct {
  double error, bulk, centre, asymmetry;
} duct;

/* a = nu = G = 1. */
static bw_status steady(const bw_comm *comm, int n, duct *d)
{
  const flow_box box = {
      .n = {2, n, n}, .length = {2.0 / n, 1.0, 1.0}, .periodic = {true, false, false}};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 1.0, c.forcing = BW_FORCING_GRADIENT, c.forcing_value = 1.0;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  BW_TRY(flow_run_share(ns, 1.2, 0.95));
  d->error = flow_error(ns, series, NULL);
  d->bulk = bw_ns_channel_summary(ns).bulk_velocity;
  const bw_grid_view *g = bw_grid_look(grid);
  bw_real *const *u = bw_ns_channel_velocity(ns);
  double all[32 * 32] = {0.0}; /* [z][y] of the section */
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      all[(k + g->lo[2] - 1) * n + j + g->lo[1] - 1] = (double)u[0][bw_at(g, 1, j, k)];
  bw_comm_sum(comm, n * n, all);
  d->asymmetry = 0.0;
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++)
      d->asymmetry = fmax(d->asymmetry, fabs(all[k * n + j] - all[j * n + k]));
  d->centre = all[(n / 2) * n + n / 2] + 0.125 / (n * n); /* from the point to the centre */
  flow_destroy(&grid, &ns);
  return BW_OK;
}

/* Profile of the inflow through a section of sides 1 and b, bulk velocity 1, on n cells across:
 * largest error over U_max, and the value in the centre (with its distance to the four next to it,
 * as above). */
static bw_status inflow_profile(const bw_comm *comm, int n, int b, double *error, double *centre)
{
  const flow_box box = {.n = {2, n, b * n}, .length = {1.0, 1.0, b}};
  const double mean = section_mean(b), top = section_velocity(0.5, 0.5 * b, b) / mean;
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 1.0;
  c.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 1.0};
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  const bw_grid_view *g = bw_grid_look(grid);
  double most[2] = {0.0, 0.0};
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      double x[3];
      flow_point(g, 0, 0, j, k, x);
      const double u = (double)bw_ns_channel_velocity(ns)[0][bw_at(g, 0, j, k)];
      most[0] = fmax(most[0], fabs(u - section_velocity(x[1], x[2], b) / mean) / top);
      most[1] = fmax(most[1], u);
    }
  bw_comm_max(comm, 2, most);
  *error = most[0];
  *centre = most[1] + 0.125 / (n * n) / mean;
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status inflow_rows(bw_validation *v, int b)
{
  const char *source = "series for the rectangular duct (White, Viscous Fluid Flow)";
  double error[2], centre[2];
  char extra[32];
  snprintf(extra, sizeof extra, "\"sides\": \"1:%d\"", b);
  for (int q = 0; q < 2; q++)
    BW_TRY(inflow_profile(bw_validation_comm(v), 16 << q, b, &error[q], &centre[q]));
  const bw_claim claims[] = {
      {"inflow into a duct: order of its profile", "inflow_order",
       bw_validation_order(2.0, error[0], 1.0, error[1]), 2.0, 0.05, BW_ORDER, source, extra},
      {"inflow into a duct, 32 cells: largest error over U_max", "inflow_max_error", error[1], 0.0,
       0.125 / (32 * 32) / section_mean(b), BW_ANALYTIC, source, extra},
      {"inflow into a duct: U_max/U_mean, extrapolated", "inflow_peak_over_mean",
       centre[1] + (centre[1] - centre[0]) / 3.0, b == 1 ? 2.0963 : 1.9918, 2e-4, BW_ANALYTIC,
       source, extra}};
  for (size_t q = 0; q < sizeof claims / sizeof *claims; q++)
    bw_validation_row(v, &claims[q]);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  duct d[3];
  for (int q = 0; q < 3; q++)
    BW_TRY(steady(bw_validation_comm(v), 8 << q, &d[q]));
  const double bulk = d[2].bulk + (d[2].bulk - d[1].bulk) / 3.0;
  const double centre = d[2].centre + (d[2].centre - d[1].centre) / 3.0;
  const char *source = "series for the square duct (White, Viscous Fluid Flow)";
  const bw_claim claims[] = {
      {"velocity in a square duct: order in space", "order",
       bw_validation_order(2.0, d[1].error, 1.0, d[2].error), 2.0, 0.05, BW_ORDER, source, NULL},
      {"velocity in a square duct, 32 cells: largest error over U_max", "max_error",
       d[2].error / 0.0736713, 0.0, 2e-3, BW_ANALYTIC, source, NULL},
      {"flow rate, extrapolated", "flow_rate", bulk, 0.0351443, 2e-4, BW_ANALYTIC, source, NULL},
      {"U_max/U_mean, extrapolated", "peak_over_mean", centre / bulk, 2.0963, 2e-4, BW_ANALYTIC,
       source, NULL},
      {"y and z are alike", "asymmetry", d[2].asymmetry / 0.0736713, 0.0, 1e-10, BW_CONSERVATION,
       source, NULL}};
  for (size_t q = 0; q < sizeof claims / sizeof *claims; q++)
    bw_validation_row(v, &claims[q]);
  BW_TRY(inflow_rows(v, 1));
  return inflow_rows(v, 2);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.duct", run);
}
