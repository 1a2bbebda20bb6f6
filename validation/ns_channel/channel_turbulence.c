/* Claim: the statistics of channel turbulence at Re_b = 5600 are those of spectral simulations
 * (FSI section 3, second test; figures 4a and 4b).
 *
 * Reference: Moser, Kim & Mansour (1999), Re_tau 178.12 at Re_b 5586: data/channel. For Re_tau it
 * is 179.0: theirs, Lee & Moser's (182.09 at 5714) and del Alamo & Jimenez's (186.34 at 5856)
 * become 178.5, 178.9 and 179.1 at 5600 with Re_tau ~ Re_b^0.88 (Pope 2000, 7.54).
 *
 * Measured: Re_tau = (h/2) u_tau/nu with u_tau of the mean wall shear; U_b+, U_c+ (mean of the
 * cells next to the centre line); U+ over y+, relative to the reference; total stress against the
 * straight line and u'v', both over tau_w; peaks of the rms profiles. Beside each: the 95 % half
 * width of batch means.
 *
 * --full: 192 x 128 x 160 cells in 2 pi h x h x pi h, 40 h/U_b to spin up and 80 (10 eddy
 * turnovers) of statistics, on from $BW_BUILD_DIR/verification/channel_turbulence/checkpoint.h5 if
 * there is one (which may be longer). Tolerances: those that were set as the goal before the run
 * (1.5 % of Re_tau, U_b+, U_c+; 2 % of U+ above y+ = 5 and 3 % below; 1 % of tau_w for the line, 3
 * % for u'v'; 4 % of the peaks).
 *
 * Quick: a box of 2 h x h x 0.8 h, 32 x 64 x 32 cells (22 x 5.6 x 9 wall units), 30 and 60 h/U_b.
 * It can say that turbulence of about the right strength lives on the coarse cells, not more:
 * laminar flow has Re_tau 91.7 (-49 %) and no stress; boxes this small hold a healthy wall layer
 * (Jimenez & Moin 1991, JFM 225). Tolerances: 10 % for scalars, 15 % for profiles, a fifth and a
 * third of the distance to laminar flow; the coarse cells take some 6 % of it (96 x 64 x 80 cells
 * of the whole box, coarser in z, 9 %: docs/verification), sampling 1 % of Re_tau in 8 eddy
 * turnovers.
 *
 * Budgets, in both forms: total stress T = nu dU/dy - <uv> over a time S,
 *   T(y) = T(0) - G y + int_0^y (U(S) - U(0))/S dy
 * with fluxes of the fields at the ends of steps by the trapezoidal rule, whose error is
 * dt^2/12 (T'(S) - T'(0))/S: with T' below tau_w/(0.1 h/U_b), dt 0.01, S 3 it is 5e-5 tau_w;
 * claimed 5e-4. A wrong sign, edge or factor in a flux shows in full. Energy: the scheme's
 * convection and pressure do no work, so G U_b is the change of kinetic energy and nu
 * <(du_i/dx_j)^2> with the scheme's own differences, but for what RK3 loses: dt^3
 * (energy_conservation.c), seen here as 1e-2 of G U_b at half the largest step and an eighth of
 * that for every halving, so 7e-4 at the 0.2 of it that is used; claimed 2e-3. The flow rate is
 * exact to round-off: 1e-12.
 *
 * BUILD modules=ns_channel,checkpoint
 * TEST  ranks=1 timeout=3600 */
#include "channel_rows.h"

static const channel_tolerances goal = {0.015, 0.02, 0.03, 0.01, 0.03, 0.04, "192 x 128 x 160"};
static const channel_tolerances rough = {
    0.10, 0.15, 0.15, 0.05, 0.15, 0.15, "32 x 64 x 32, 2 h x h x 0.8 h"};

/* ---- budgets over `steps` equal steps ---- */
typedef struct {
  bw_ns_statistics *inner, *ends[2]; /* fields between the steps, the first and the last */
  int steps;
  double time, gradient, bulk, power; /* span; means of G and G U_b; largest |U_b - 1| */
} budget;

static void budget_destroy(budget *b)
{
  bw_ns_statistics_destroy(&b->inner);
  for (int q = 0; q < 2; q++)
    bw_ns_statistics_destroy(&b->ends[q]);
}

static bw_status budget_sample(channel_flow *f, int steps, double dt, budget *b)
{
  *b = (budget){.steps = steps, .time = steps * dt};
  BW_TRY(bw_ns_statistics_create(f->fluid, &b->inner));
  for (int q = 0; q < 2; q++)
    BW_TRY(bw_ns_statistics_create(f->fluid, &b->ends[q]));
  bw_ns_statistics_sample(b->ends[0]);
  for (int step = 1; step <= steps; step++) {
    BW_TRY(bw_ns_channel_step(f->fluid, dt));
    const bw_ns_summary now = bw_ns_channel_summary(f->fluid);
    bw_ns_statistics_sample(step < steps ? b->inner : b->ends[1]);
    b->gradient += now.pressure_gradient / steps;
    b->power += now.pressure_gradient * now.bulk_velocity / steps;
    b->bulk = fmax(b->bulk, fabs(now.bulk_velocity - 1.0));
  }
  return BW_OK;
}

/* Of a moment over the time, by the trapezoidal rule. */
static double over_time(const budget *b, bw_ns_moment moment, int row)
{
  return (0.5 * (bw_ns_statistics_moment(b->ends[0], moment, row) +
                 bw_ns_statistics_moment(b->ends[1], moment, row)) +
          (b->steps - 1) * bw_ns_statistics_moment(b->inner, moment, row)) /
         b->steps;
}

static double change(const budget *b, bw_ns_moment moment, int row)
{
  return bw_ns_statistics_moment(b->ends[1], moment, row) -
         bw_ns_statistics_moment(b->ends[0], moment, row);
}

/* Largest distance of the total stress from its line, over tau_w. */
static double stress_error(const channel_flow *f, const budget *b)
{
  const bw_grid_view *g = bw_grid_look(f->grid);
  double worst = 0.0, line = 0.0, tau = 0.0;
  for (int j = 0; j <= g->n[1]; j++) {
    const double total =
        -over_time(b, BW_NS_MOMENT_OZ, j) / f->config->reynolds - over_time(b, BW_NS_MOMENT_UV, j);
    if (j == 0)
      tau = line = total;
    else
      line += (change(b, BW_NS_MOMENT_U, j) / b->time - b->gradient) *
              (g->y_face[j] - g->y_face[j - 1]);
    worst = fmax(worst, fabs(total - line));
  }
  return worst / tau;
}

/* dK/dt + nu <(du_i/dx_j)^2> - G U_b over G U_b, K and the rest over the volume. */
static double energy_error(const channel_flow *f, const budget *b)
{
  const bw_grid_view *g = bw_grid_look(f->grid);
  double rate = 0.0;
  for (int j = 1; j <= g->n[1]; j++) {
    const double dy = g->y_face[j] - g->y_face[j - 1];
    const double k = 0.5 * (change(b, BW_NS_MOMENT_UU, j) + change(b, BW_NS_MOMENT_WW, j)) +
                     0.25 * (change(b, BW_NS_MOMENT_VV, j - 1) + change(b, BW_NS_MOMENT_VV, j));
    const double faces = over_time(b, BW_NS_MOMENT_FACE_GRADIENTS, j - 1) +
                         over_time(b, BW_NS_MOMENT_FACE_GRADIENTS, j);
    rate += dy * (k / b->time +
                  (over_time(b, BW_NS_MOMENT_GRADIENTS, j) + 0.5 * faces) / f->config->reynolds);
  }
  return fabs(rate / b->power - 1.0);
}

static bw_status budget_rows(bw_validation *v, channel_flow *f, int steps, double dt)
{
  budget b;
  bw_status st = budget_sample(f, steps, dt, &b);
  if (st == BW_OK) {
    const bw_claim claims[] = {
        {"total stress with its unsteady part is a straight line", "unsteady_stress_max_error",
         stress_error(f, &b), 0.0, 5e-4, BW_CONSERVATION, "mean momentum equation", NULL},
        {"power of the gradient is dissipated or stored", "energy_balance_error",
         energy_error(f, &b), 0.0, 2e-3, BW_CONSERVATION, "kinetic energy equation", NULL},
        {"the flow rate is kept in every step", "bulk_velocity_max_error", b.bulk, 0.0, 1e-12,
         BW_CONSERVATION, "constant flow rate", NULL}};
    for (size_t q = 0; q < sizeof claims / sizeof *claims; q++)
      bw_validation_row(v, &claims[q]);
  }
  budget_destroy(&b);
  return st;
}

static bw_status run(bw_validation *v)
{
  const double pi = acos(-1.0);
  const bool full = bw_validation_full(v);
  const channel_config q = {.length = {full ? 2.0 * pi : 2.0, 1.0, full ? pi : 0.8},
                            .cells = {full ? 192 : 32, full ? 128 : 64, full ? 160 : 32},
                            .reynolds = 5600.0,
                            .perturbation = 0.2,
                            .interval = 0.2,
                            .courant_share = 0.95,
                            .spin_up = full ? 40.0 : 30.0};
  channel_table t;
  char path[600];
  BW_TRY(channel_read_reference(&t));
  snprintf(path, sizeof path, "%s/channel_turbulence", bw_validation_folder(v));
  if (bw_comm_rank(bw_validation_comm(v)) == 0) mkdir(path, 0777);
  strcat(path, "/checkpoint.h5");
  channel_flow f;
  channel_report r = {.v = v, .f = &f, .t = &t, .tolerance = full ? &goal : &rough};
  bw_status st = channel_create(bw_validation_comm(v), &q, &f);
  BW_THEN(st, BW_ALLOCATE(&r.work, (size_t)q.cells[1] + 1));
  BW_THEN(st, channel_advance_all(&f, q.spin_up + (full ? 80.0 : 60.0), full ? path : NULL));
  if (st == BW_OK) {
    r.u_tau = channel_u_tau(&f, r.work).mean;
    channel_scalar_rows(&r);
    channel_mean_rows(&r);
    channel_stress_rows(&r);
    channel_peak_rows(&r);
    st = budget_rows(v, &f, full ? 20 : 300, 0.2 * bw_ns_channel_dt_max(f.fluid));
  }
  bw_release(&r.work);
  channel_destroy(&f);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.channel_turbulence", run);
}
