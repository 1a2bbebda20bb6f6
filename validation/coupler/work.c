/* Claim: what the fluid gives the solid receives, momentum to round-off, work to the order of the
 * step.
 *
 * A free block, 20 times as heavy as the fluid, is braked by it (Re = 25).
 * Measured   from step 20 on, when the impulsive start is over: impulse and work of the markers'
 *            reaction (report: force_reaction, work_given) against the block's momentum and the
 *            work in its ledger.
 * Reference  Newton's third law. The reaction of step n acts on the solid during step n, and is
 *            booked with the surface's velocity at its beginning on the fluid's side, with the
 *            velocities during the sub-steps on the solid's: dV/2 apart.
 * Tolerance  impulse: every step's F dt goes into the momentum by the sub-steps of Verlet with a
 *            constant F, but its first half kick still holds the force of the step before, once
 *            at each end of the interval: dt/(2 K) of a force that has changed by less than a
 *            half, over 100 steps: 1e-2/K of the impulse.
 *            work: F dt/(2 m V) of it, and 1 % as the requirement; half at half the step.
 *            Loaded by probes the block gets what they see: reported beside.
 * Relaxed    F' = (1 - w) F' before + w F follows F late: F - F' = (1 - w)/w (F' - F' before). Its
 *            work is booked (report: work_late), -20 % of that received with w = 0.1 here, where
 *            the impulsive start is still being handed on: given = late + received, by the same
 *            argument and to the same 1 %.
 * BUILD modules=coupler,shape
 * TEST  ranks=1 */
#include "block.h"
#include "bw_real.h"
#include "bw_validation.h"

#include <stdio.h>

typedef struct {
  double impulse, momentum, given, late, received, slip;
  int substeps;
} account;

static bw_status brake(const bw_comm *comm, bw_coupler_load_kind load, double dt, double w,
                       account *a)
{
  const int start = (int)lround(20.0 * DT / dt), end = 6 * start;
  block_scene s;
  bw_coupler_report r, r0 = {.work_given = NAN};
  bw_solid_ledger e = {.external = NAN}, e0 = e;
  *a = (account){0};
  bw_status st = block_create(
      comm,
      &(block_set_up){
          .ratio = 20.0, .w = w, .virtual_mass = 1.0, .dt = DT, .load = load, .speed = 1.0},
      &s);
  a->substeps = st == BW_OK ? bw_coupler_substeps(s.coupler, dt) : 0;
  for (int n = 1; st == BW_OK && n <= end; n++) {
    st = bw_coupler_step(s.coupler, dt);
    BW_THEN(st, bw_coupler_measure(s.coupler, &r));
    if (st != BW_OK) break;
    if (n > start) a->impulse += dt * r.force_reaction[0];
    if (n != start) continue;
    st = bw_solid_account(s.solid, &e0);
    r0 = r;
  }
  BW_THEN(st, bw_solid_account(s.solid, &e));
  if (st == BW_OK) {
    a->momentum = e.momentum[0] - e0.momentum[0];
    a->received = e.external - e0.external;
    a->given = r.work_given - r0.work_given;
    a->late = r.work_late - r0.work_late;
    a->slip = r.slip_rms;
  }
  block_destroy(&s);
  return st;
}

static const char law[] = "Newton's third law";

static bw_status relaxed(bw_validation *v, double w)
{
  account a;
  char text[64], extra[96];
  BW_TRY(brake(bw_validation_comm(v), BW_LOAD_REACTION, DT, w, &a));
  snprintf(text, sizeof text, "work given and received + late, w = %g", w);
  snprintf(extra, sizeof extra, "\"w\": %g, \"late_over_received\": %.4f", w, a.late / a.received);
  bw_validation_row(v, &(bw_claim){text, "work_relaxed", a.given, a.received + a.late, 0.01,
                                   BW_CONSERVATION, law, extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  account a, half, probes;
  BW_TRY(brake(comm, BW_LOAD_REACTION, DT, 1.0, &a));
  BW_TRY(brake(comm, BW_LOAD_REACTION, 0.5 * DT, 1.0, &half));
  BW_TRY(brake(comm, BW_LOAD_PROBES, DT, 1.0, &probes));
  const double e1 = a.given / a.received - 1.0, e2 = half.given / half.received - 1.0;
  const double kicks = 100.0 * a.substeps, lost = 0.07; /* of its speed, while kicked */
  const double round_off = kicks * BW_REAL_EPSILON / lost;
  const bw_claim rows[] = {
      {"impulse given and received", "momentum", a.momentum, a.impulse,
       1e-2 / a.substeps + round_off, BW_CONSERVATION, law, NULL},
      {"work given and received", "work", a.given, a.received, 0.01, BW_CONSERVATION, law, NULL},
      {"work at half the step", "work_half", half.given, half.received, 0.005, BW_CONSERVATION, law,
       NULL},
      {"mismatch falls with the step", "work_error_ratio", e2 / e1, 0.5, 0.3, BW_ORDER,
       "first order", NULL},
      {"slip at the markers, of the block's first speed", "slip", a.slip, 0.0, INFINITY,
       BW_ANALYTIC, "no slip", NULL},
      {"impulse received by probes of that given", "momentum_probes", probes.momentum,
       probes.impulse, INFINITY, BW_CONSERVATION, law, NULL},
      {"work received by probes of that given", "work_probes", probes.received, probes.given,
       INFINITY, BW_CONSERVATION, law, NULL}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_validation_row(v, &rows[q]);
  static const double w[] = {0.3, 0.1, 0.03};
  for (size_t q = 0; q < sizeof w / sizeof *w; q++)
    BW_TRY(relaxed(v, w[q]));
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.work", run);
}
