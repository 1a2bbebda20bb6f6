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
#include "../../cases/channel_turbulence/channel_flow.h"
#include "bw_validation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct {
  double scalar, velocity, sublayer, line, stress, peak;
  const char *grid;
} tolerances;

static const tolerances goal = {0.015, 0.02, 0.03, 0.01, 0.03, 0.04, "192 x 128 x 160"};
static const tolerances rough = {
    0.10, 0.15, 0.15, 0.05, 0.15, 0.15, "32 x 64 x 32, 2 h x h x 0.8 h"};

/* ---- the reference: y/h, y+, U+, u_rms, v_rms, w_rms, -uv of the half channel ---- */
enum { Y_H, Y, U, U_RMS, V_RMS, W_RMS, UV, COLUMNS, MOST = 128 };
typedef struct {
  int n;
  double row[MOST][COLUMNS];
} table;

static bw_status read_reference(table *t)
{
  BW_TRY(bw_validation_table("channel/channel_MKM1999_retau180.csv", COLUMNS, MOST, &t->row[0][0],
                             &t->n));
  BW_REQUIRE(t->n == 65, BW_EINPUT, "the reference has %d rows, 65 expected", t->n);
  return BW_OK;
}

/* Lagrange's cubic through the four rows around y+; the last ones beyond the end. */
static double at(const table *t, int column, double y_plus)
{
  int q = 0;
  while (q < t->n - 4 && t->row[q + 2][Y] < y_plus)
    q++;
  double value = 0.0;
  for (int a = q; a < q + 4; a++) {
    double weight = 1.0;
    for (int b = q; b < q + 4; b++)
      if (b != a) weight *= (y_plus - t->row[b][Y]) / (t->row[a][Y] - t->row[b][Y]);
    value += weight * t->row[a][column];
  }
  return value;
}

static double highest(const table *t, int column)
{
  double most = 0.0;
  for (int q = 0; q < t->n; q++)
    most = fmax(most, t->row[q][column]);
  return most;
}

/* ---- rows ---- */
typedef struct {
  bw_validation *v;
  const channel_flow *f;
  const table *t;
  const tolerances *tolerance;
  double u_tau;
  bw_ns_estimate *work; /* (n1 + 1) */
} report;

static void row(report *r, const char *quantity, const char *claim, double measured,
                double reference, double tolerance, double interval)
{
  char extra[256];
  snprintf(extra, sizeof extra,
           "\"grid\": \"%s\", \"ci95\": %.2g, \"batches\": %d, \"eddy_turnovers\": %.3g",
           r->tolerance->grid, interval, bw_ns_statistics_batches(r->f->statistics),
           (double)bw_ns_statistics_samples(r->f->statistics) * r->f->config->interval * 2.0 *
               r->u_tau);
  const bw_claim c = {.claim = claim,
                      .quantity = quantity,
                      .measured = measured,
                      .reference = reference,
                      .tolerance = tolerance,
                      .kind = BW_PUBLISHED,
                      .source = "Moser, Kim & Mansour 1999, Phys. Fluids 11, 943, Re_tau 178.12",
                      .extra = extra};
  bw_validation_row(r->v, &c);
}

static void scalar_rows(report *r)
{
  const tolerances *o = r->tolerance;
  const double half = 0.5 * r->f->config->reynolds;
  const bw_ns_estimate u = channel_u_tau(r->f, r->work);
  row(r, "Re_tau", "friction Reynolds number", half * u.mean, 179.0, o->scalar, half * u.interval);
  /* 15.6803: integral of the reference profile, data/channel/channel_scalars_retau180.csv */
  row(r, "U_b_plus", "bulk velocity in wall units", 1.0 / u.mean, 15.6803, o->scalar,
      u.interval / (u.mean * u.mean));
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_U, true, r->work);
  const bw_ns_estimate centre = r->work[(r->f->config->cells[1] + 1) / 2];
  row(r, "U_c_plus", "centre line velocity in wall units", centre.mean / u.mean,
      r->t->row[r->t->n - 1][U], o->scalar, centre.interval / u.mean);
}

static void mean_row(report *r)
{
  const double Re = r->f->config->reynolds;
  double worst[2] = {0.0, 0.0}, interval[2] = {0.0, 0.0};
  const double *y = bw_grid_look(r->f->grid)->y_centre;
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_U, true, r->work);
  for (int j = 1; y[j] < 0.5; j++) {
    const double y_plus = y[j] * r->u_tau * Re, want = at(r->t, U, y_plus);
    const double error = fabs(r->work[j].mean / r->u_tau / want - 1.0);
    const int part = y_plus < 5.0;
    if (error < worst[part]) continue;
    worst[part] = error;
    interval[part] = r->work[j].interval / (r->u_tau * want);
  }
  row(r, "U_plus_max_error", "mean profile above y+ = 5, relative", worst[0], 0.0,
      r->tolerance->velocity, interval[0]);
  row(r, "U_plus_sublayer_max_error", "mean profile below y+ = 5, relative", worst[1], 0.0,
      r->tolerance->sublayer, interval[1]);
}

static void stress_rows(report *r)
{
  const bw_grid_view *g = bw_grid_look(r->f->grid);
  const double tau = r->u_tau * r->u_tau, Re = r->f->config->reynolds;
  double line = 0.0, uv = 0.0, line_interval = 0.0, uv_interval = 0.0;
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_TOTAL, true, r->work);
  for (int j = 0; j <= g->n[1] / 2; j++) {
    const double error = fabs(r->work[j].mean / tau - (1.0 - 2.0 * g->y_face[j]));
    if (error >= line) line_interval = r->work[j].interval / tau, line = error;
  }
  row(r, "total_stress_max_error", "total stress is a straight line, over tau_w", line, 0.0,
      r->tolerance->line, line_interval);
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_UV, true, r->work);
  for (int j = 0; j <= g->n[1] / 2; j++) {
    const double error = fabs(-r->work[j].mean / tau - at(r->t, UV, g->y_face[j] * r->u_tau * Re));
    if (error >= uv) uv_interval = r->work[j].interval / tau, uv = error;
  }
  row(r, "uv_max_error", "Reynolds stress, over tau_w", uv, 0.0, r->tolerance->stress, uv_interval);
}

static void peak_rows(report *r)
{
  static const struct {
    const char *quantity, *claim;
    bw_ns_profile_kind kind;
    int column;
  } peak[] = {{"u_rms_peak", "peak of u rms in wall units", BW_NS_PROFILE_U_RMS, U_RMS},
              {"v_rms_peak", "peak of v rms in wall units", BW_NS_PROFILE_V_RMS, V_RMS},
              {"w_rms_peak", "peak of w rms in wall units", BW_NS_PROFILE_W_RMS, W_RMS}};
  for (int q = 0; q < 3; q++) {
    bw_ns_estimate most = {0.0, 0.0};
    bw_ns_statistics_profile(r->f->statistics, peak[q].kind, true, r->work);
    for (int j = 1; j <= r->f->config->cells[1] / 2; j++)
      if (r->work[j].mean > most.mean) most = r->work[j];
    row(r, peak[q].quantity, peak[q].claim, most.mean / r->u_tau, highest(r->t, peak[q].column),
        r->tolerance->peak, most.interval / r->u_tau);
  }
}

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

/* From the checkpoint where there is one, to the end of the statistics; saved now and then. */
static bw_status advance_all(channel_flow *f, double until, const char *checkpoint)
{
  struct stat there;
  double found = checkpoint != NULL && stat(checkpoint, &there) == 0 ? 1.0 : 0.0;
  bw_comm_max(bw_grid_comm(f->grid), 1, &found);
  BW_TRY(found > 0.0 ? channel_load(f, checkpoint) : channel_start(f));
  while (bw_ns_channel_time(f->fluid) < until * (1.0 - 1e-12)) {
    BW_TRY(channel_advance(f));
    if (checkpoint != NULL && f->intervals % 25 == 0) BW_TRY(channel_save(f, checkpoint));
  }
  return BW_OK;
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
  table t;
  char path[600];
  BW_TRY(read_reference(&t));
  snprintf(path, sizeof path, "%s/channel_turbulence", bw_validation_folder(v));
  if (bw_comm_rank(bw_validation_comm(v)) == 0) mkdir(path, 0777);
  strcat(path, "/checkpoint.h5");
  channel_flow f;
  report r = {.v = v, .f = &f, .t = &t, .tolerance = full ? &goal : &rough};
  bw_status st = channel_create(bw_validation_comm(v), &q, &f);
  BW_THEN(st, BW_ALLOCATE(&r.work, (size_t)q.cells[1] + 1));
  BW_THEN(st, advance_all(&f, q.spin_up + (full ? 80.0 : 60.0), full ? path : NULL));
  if (st == BW_OK) {
    r.u_tau = channel_u_tau(&f, r.work).mean;
    scalar_rows(&r);
    mean_row(&r);
    stress_rows(&r);
    peak_rows(&r);
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
