/* Claim: between inflow and outflow the parabola that enters leaves; a vortex crosses the outflow
 * and is gone; mass balances at every step.
 * Reference: Poiseuille's parabola 6 U_b y/H (1 - y/H) at the outlet; a vortex that a uniform
 * stream carries out of the box leaves the stream behind (perturbation energy 0).
 * Measured: (1) 2D channel 4H long, Re_H = 20, uniform inflow, to steady state: largest
 * |u - parabola| half a height before the outlet on 16 and 32 cells; |Q_out/Q_in - 1|.
 * (2) Gaussian vortex of radius 0.1 H and top swirl 0.1 U in a uniform stream between free-slip
 * sides, Re = 1e3 on its diameter: perturbation energy when its centre would be 1 H beyond the
 * outlet, over the energy at the start; the largest ever on the way; also swirl 0.5 U.
 * Tolerance: (1) order 2 within 10 %, mass 1e-13 (sums of some thousand terms). (2) A convective
 * condition with the speed U reflects a wave of the perturbation's own speed u' by u'/(2U + u'):
 * 5 % in amplitude, 0.25 % in energy, doubled by the pressure's part (equal for a potential flow):
 * 0.5 %; on the way never more than the start and that much. Swirl 0.5 U: 0.2^2 twice, 8 %.
 * (3) Back-flow: the same vortex with radius 0.15 H and a swirl of 1.5 U and of 10 U, nu = 1e-4, on
 * 64 x 32 cells to the same time. Fluid has to come back through the outlet (fastest inwards at
 * least 0.1 U, or the claim is empty), and the kinetic energy in the box, which nothing but the
 * uniform stream feeds, is never above the first: tolerance 0.
 *
 * TEST ranks=1,2 */
#include "flow.h"

#include <stdio.h>

static void parabola(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = 6.0 * x[1] * (1.0 - x[1]);
  u[1] = u[2] = 0.0;
}

/* Largest deviation from the parabola at x = 3.5 H. */
static double outlet_error(bw_ns_channel *ns)
{
  const bw_grid *grid = bw_ns_channel_grid(ns);
  const bw_grid_view *g = bw_grid_look(grid);
  const int i = g->n[0] - g->n[0] / 8;
  double most = 0.0;
  for (int j = 1; j <= g->m[1]; j++) {
    double x[3], u[3];
    flow_point(g, 0, i, j, 1, x);
    parabola(x, 0, NULL, u);
    const double here = (double)bw_ns_channel_velocity(ns)[0][bw_at(g, i, j, 1)];
    most = fmax(most, fabs(here - u[0]));
  }
  bw_comm_max(bw_grid_comm(grid), 1, &most);
  return most;
}

static bw_status developing(const bw_comm *comm, int n, double *error, double *mass)
{
  const flow_box box = {
      .n = {4 * n, n, 1}, .length = {4.0, 1.0, 0.1}, .periodic = {false, false, true}};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 0.05;
  c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = 1.0;
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  *mass = 0.0;
  while (bw_ns_channel_time(ns) < 12.0) {
    BW_TRY(bw_ns_channel_step(ns, 0.5 * bw_ns_channel_dt_max(ns)));
    const bw_ns_summary s = bw_ns_channel_summary(ns);
    *mass = fmax(*mass, fabs(s.outflow / s.inflow - 1.0));
  }
  *error = outlet_error(ns);
  flow_destroy(&grid, &ns);
  return BW_OK;
}

typedef struct {
  double swirl, x, y, radius; /* top swirl velocity, centre, where it is reached */
} gaussian;

/* Stream 1 and a vortex u_theta = swirl s exp((1 - s^2)/2), s = r/radius. */
static void vortex(const double x[3], double t, void *context, double u[3])
{
  const gaussian *v = context;
  (void)t;
  const double a = (x[0] - v->x) / v->radius, b = (x[1] - v->y) / v->radius;
  const double f = v->swirl * exp(0.5 * (1.0 - a * a - b * b));
  u[0] = 1.0 - b * f;
  u[1] = a * f;
  u[2] = 0.0;
}

static double perturbation_energy(bw_ns_channel *ns)
{
  const bw_ns_summary s = bw_ns_channel_summary(ns);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  const double volume = g->length[0] * g->length[1] * g->length[2];
  return s.kinetic_energy - (s.bulk_velocity - 0.5) * volume; /* int (u - U)^2/2 with U = 1 */
}

/* A uniform stream through a box 2 H long, and the vortex. */
static bw_status create_crossing(const bw_comm *comm, int n, double nu, gaussian *v, bw_grid **grid,
                                 bw_ns_channel **ns)
{
  const flow_box box = {
      .n = {2 * n, n, 1}, .length = {2.0, 1.0, 0.1}, .periodic = {false, false, true}};
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu;
  c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = 1.0;
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  c.side[1][0].kind = c.side[1][1].kind = BW_SIDE_FREE_SLIP;
  BW_TRY(flow_create(comm, &box, &c, grid, ns));
  return bw_ns_channel_set_velocity(*ns, vortex, v, 0.0);
}

/* Perturbation energy left and largest, over the first. */
static bw_status crossing(const bw_comm *comm, double swirl, double *left, double *largest)
{
  gaussian v = {swirl, 1.0, 0.55, 0.1};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  BW_TRY(create_crossing(comm, 48, 2e-4, &v, &grid, &ns));
  const double start = perturbation_energy(ns);
  *largest = 0.0;
  while (bw_ns_channel_time(ns) < 2.0) {
    BW_TRY(bw_ns_channel_step(ns, fmin(0.005, 0.9 * bw_ns_channel_dt_max(ns))));
    *left = perturbation_energy(ns) / start;
    *largest = fmax(*largest, *left);
  }
  flow_destroy(&grid, &ns);
  return BW_OK;
}

/* Largest kinetic energy over the first, and the fastest inwards through the outlet. */
static bw_status back_flow(const bw_comm *comm, double swirl, double *largest, double *inwards)
{
  gaussian v = {swirl, 1.0, 0.55, 0.15};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  BW_TRY(create_crossing(comm, 32, 1e-4, &v, &grid, &ns));
  const bw_grid_view *g = bw_grid_look(grid);
  const double start = bw_ns_channel_summary(ns).kinetic_energy;
  *largest = *inwards = 0.0;
  while (bw_ns_channel_time(ns) < 2.0) {
    BW_TRY(bw_ns_channel_step(ns, fmin(0.005, 0.8 * bw_ns_channel_dt_max(ns))));
    *largest = fmax(*largest, bw_ns_channel_summary(ns).kinetic_energy / start);
    for (int j = 1; j <= g->m[1]; j++)
      *inwards = fmax(*inwards, -(double)bw_ns_channel_velocity(ns)[0][bw_at(g, g->n[0], j, 1)]);
  }
  bw_comm_max(comm, 1, inwards);
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status back_flow_rows(bw_validation *v, double swirl)
{
  double largest, inwards;
  char extra[128];
  BW_TRY(back_flow(bw_validation_comm(v), swirl, &largest, &inwards));
  snprintf(extra, sizeof extra, "\"swirl\": %g, \"fastest_inwards\": %.3f, \"largest\": %.6f",
           swirl, inwards, largest);
  bw_validation_row(v, &(bw_claim){"fluid comes back through the outlet", "fastest_inwards",
                                   fmin(inwards, 0.1), 0.1, 0.0, BW_CONSERVATION,
                                   "the vortex is faster than the stream", extra});
  bw_validation_row(v, &(bw_claim){"back-flow brings no energy", "largest_energy",
                                   fmax(largest, 1.0), 1.0, 0.0, BW_CONSERVATION,
                                   "only a uniform stream feeds the box", extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  double coarse, fine, mass, left, largest;
  BW_TRY(developing(comm, 16, &coarse, &mass));
  BW_TRY(developing(comm, 32, &fine, &mass));
  bw_validation_row(v, &(bw_claim){"a uniform inflow becomes the parabola", "order",
                                   bw_validation_order(2, coarse, 1, fine), 2.0, 0.1, BW_ORDER,
                                   "plane Poiseuille flow", NULL});
  bw_validation_row(v, &(bw_claim){"what enters leaves", "max_net_flux_over_inflow", mass, 0.0,
                                   450 * BW_REAL_EPSILON, BW_CONSERVATION, "mass balance", NULL});
  BW_TRY(crossing(comm, 0.1, &left, &largest));
  bw_validation_row(v,
                    &(bw_claim){"a weak vortex leaves", "energy_left", left, 0.0, 5e-3, BW_ANALYTIC,
                                "nothing stays in a uniform stream", "\"swirl\": 0.1"});
  bw_validation_row(v, &(bw_claim){"it leaves without a peak", "largest_energy", largest, 1.0, 5e-3,
                                   BW_ANALYTIC, "nothing stays in a uniform stream",
                                   "\"swirl\": 0.1"});
  BW_TRY(crossing(comm, 0.5, &left, &largest));
  bw_validation_row(v, &(bw_claim){"a strong vortex leaves", "energy_left", left, 0.0, 0.08,
                                   BW_ANALYTIC, "nothing stays in a uniform stream",
                                   "\"swirl\": 0.5"});
  bw_validation_row(v, &(bw_claim){"it leaves without a peak", "largest_energy", largest, 1.0, 0.08,
                                   BW_ANALYTIC, "nothing stays in a uniform stream",
                                   "\"swirl\": 0.5"});
  BW_TRY(back_flow_rows(v, 1.5));
  return back_flow_rows(v, 10.0);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.inflow_outflow", run);
}
