/* channel_rows.h -- the statistics of a turbulent channel as rows beside Moser, Kim & Mansour's:
 * what channel_turbulence.c and channel_eddy.c claim. */
#pragma once
#include "../../cases/channel_turbulence/channel_flow.h"
#include "bw_validation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct {
  double scalar, velocity, sublayer, line, stress, peak;
  const char *grid;
} channel_tolerances;

/* ---- the reference: y/h, y+, U+, u_rms, v_rms, w_rms, -uv of the half channel ---- */
enum { Y_H, Y, U, U_RMS, V_RMS, W_RMS, UV, COLUMNS, MOST = 128 };
typedef struct {
  int n;
  double row[MOST][COLUMNS];
} channel_table;

static inline bw_status channel_read_reference(channel_table *t)
{
  BW_TRY(bw_validation_table("channel/channel_MKM1999_retau180.csv", COLUMNS, MOST, &t->row[0][0],
                             &t->n));
  BW_REQUIRE(t->n == 65, BW_EINPUT, "the reference has %d rows, 65 expected", t->n);
  return BW_OK;
}

/* Lagrange's cubic through the four rows around y+; the last ones beyond the end. */
static inline double channel_at(const channel_table *t, int column, double y_plus)
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

static inline double channel_highest(const channel_table *t, int column)
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
  const channel_table *t;
  const channel_tolerances *tolerance;
  double u_tau;
  bw_ns_estimate *work; /* (n1 + 1) */
} channel_report;

static inline void channel_add_row(channel_report *r, const char *quantity, const char *claim,
                                   double measured, double reference, double tolerance,
                                   double interval)
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

static inline void channel_scalar_rows(channel_report *r)
{
  const channel_tolerances *o = r->tolerance;
  const double half = 0.5 * r->f->config->reynolds;
  const bw_ns_estimate u = channel_u_tau(r->f, r->work);
  channel_add_row(r, "Re_tau", "friction Reynolds number", half * u.mean, 179.0, o->scalar,
                  half * u.interval);
  /* 15.6803: integral of the reference profile, data/channel/channel_scalars_retau180.csv */
  channel_add_row(r, "U_b_plus", "bulk velocity in wall units", 1.0 / u.mean, 15.6803, o->scalar,
                  u.interval / (u.mean * u.mean));
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_U, true, r->work);
  const bw_ns_estimate centre = r->work[(r->f->config->cells[1] + 1) / 2];
  channel_add_row(r, "U_c_plus", "centre line velocity in wall units", centre.mean / u.mean,
                  r->t->row[r->t->n - 1][U], o->scalar, centre.interval / u.mean);
}

static inline void channel_mean_rows(channel_report *r)
{
  const double Re = r->f->config->reynolds;
  double worst[2] = {0.0, 0.0}, interval[2] = {0.0, 0.0};
  const double *y = bw_grid_look(r->f->grid)->y_centre;
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_U, true, r->work);
  for (int j = 1; y[j] < 0.5; j++) {
    const double y_plus = y[j] * r->u_tau * Re, want = channel_at(r->t, U, y_plus);
    const double error = fabs(r->work[j].mean / r->u_tau / want - 1.0);
    const int part = y_plus < 5.0;
    if (error < worst[part]) continue;
    worst[part] = error;
    interval[part] = r->work[j].interval / (r->u_tau * want);
  }
  channel_add_row(r, "U_plus_max_error", "mean profile above y+ = 5, relative", worst[0], 0.0,
                  r->tolerance->velocity, interval[0]);
  channel_add_row(r, "U_plus_sublayer_max_error", "mean profile below y+ = 5, relative", worst[1],
                  0.0, r->tolerance->sublayer, interval[1]);
}

static inline void channel_stress_rows(channel_report *r)
{
  const bw_grid_view *g = bw_grid_look(r->f->grid);
  const double tau = r->u_tau * r->u_tau, Re = r->f->config->reynolds;
  double line = 0.0, uv = 0.0, line_interval = 0.0, uv_interval = 0.0;
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_TOTAL, true, r->work);
  for (int j = 0; j <= g->n[1] / 2; j++) {
    const double error = fabs(r->work[j].mean / tau - (1.0 - 2.0 * g->y_face[j]));
    if (error >= line) line_interval = r->work[j].interval / tau, line = error;
  }
  channel_add_row(r, "total_stress_max_error", "total stress is a straight line, over tau_w", line,
                  0.0, r->tolerance->line, line_interval);
  bw_ns_statistics_profile(r->f->statistics, BW_NS_PROFILE_UV, true, r->work);
  for (int j = 0; j <= g->n[1] / 2; j++) {
    const double error =
        fabs(-r->work[j].mean / tau - channel_at(r->t, UV, g->y_face[j] * r->u_tau * Re));
    if (error >= uv) uv_interval = r->work[j].interval / tau, uv = error;
  }
  channel_add_row(r, "uv_max_error", "Reynolds stress, over tau_w", uv, 0.0, r->tolerance->stress,
                  uv_interval);
}

static inline void channel_peak_rows(channel_report *r)
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
    channel_add_row(r, peak[q].quantity, peak[q].claim, most.mean / r->u_tau,
                    channel_highest(r->t, peak[q].column), r->tolerance->peak,
                    most.interval / r->u_tau);
  }
}

/* From the checkpoint where there is one, to the end of the statistics; saved now and then. */
static inline bw_status channel_advance_all(channel_flow *f, double until, const char *checkpoint)
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
