/* The energy book of a body that is drawn apart, and of one that swings for long.
 *
 * Claim      The work of tractions, gravity and prescribed motion is found again as kinetic,
 *            elastic and contact energy, damping and fracture; the total energy of a free elastic
 * body stays within a bound for any number of steps. Reference  conservation of energy. Measured a
 * notched plate with grips that are ramped up to a speed, a traction at a side, gravity and pair
 * damping, until it has snapped; every 50 steps. A shaken square for 10^5 steps (full: 10^6).
 * Tolerance  0.1 % of the work done so far, the goal of the module: Verlet at a fifth of its
 *            limit swaps (w dt)^2/8 = 2 % of the energy of the shortest waves to and fro, which
 *            hold at most 5 % of it (most is in waves as long as the plate). Shaken square: (w
 *            dt)^2/8 at half of the limit, w dt <= 1: 12.5 % of the elastic energy at most at
 *            any time, and no trend: the mean of the last tenth is within 1e-3 of the mean of
 *            the first.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"

static const double FAR = 1e9;

static int notched(const int32_t site[3], const void *data)
{
  (void)data;
  if (site[0] < 4 || site[0] >= 56) return BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE;
  return (site[0] == 29 || site[0] == 30) && site[1] < 5 ? -1 : BW_PD_FREE;
}

static void claim(bw_validation *v, const char *quantity, double measured, double reference,
                  double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "no energy is lost or made",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_CONSERVATION,
                                   .source = "conservation of energy"});
}

static bw_status snap(bw_validation *v)
{
  bw_solid_config c = bw_solid_config_default(); /* SI */
  bw_solid *pd = NULL;
  body_rows r;
  double worst = 0, time = 0;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1e-3, c.rho = 1200, c.E = 3e9, c.G0 = 300;
  c.damping.pair = 1e14, c.contact = true;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){60, 20, 1}, notched, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  BW_TRY(bw_solid_load_traction(pd, (double[3]){0, 0.017, -1}, (double[3]){0.02, FAR, 1}, 0.016,
                                (double[3]){0, 1e5, 0}, r.F));
  bw_solid_load_gravity(pd, (double[3]){0, -9.81, 0}, r.F);
  bw_solid_set_force(pd, r.F);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    r.V[3 * i] = r.X0[3 * i] > 0.03 ? 2 : 0;
  const double dt = 0.2 * bw_solid_dt_max(pd);
  const bw_solid_ramp ramp = {BW_SOLID_RAMP_SMOOTH, 0, 400 * dt};
  bw_solid_ledger e = {0};
  for (int step = 1; step <= 3000; step++, time += dt) {
    bw_solid_load_move(pd, &ramp, time, dt, r.V);
    BW_TRY(bw_solid_step(pd, dt));
    if (step % 50 != 0) continue;
    BW_TRY(bw_solid_account(pd, &e));
    const double found = e.kinetic + e.elastic + e.contact + e.damping + e.fracture;
    if (step >= 500) worst = fmax(worst, fabs(found / e.external - 1));
  }
  claim(v, "ledger_gap", worst, 0, 1e-3);
  claim(v, "snapped", e.broken > 80 && e.fracture > 0.05 * e.external, 1, 0);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static void shake(const double X0[3], double V[3], const void *data)
{
  (void)data;
  V[0] = sin(0.9 * X0[0] + 0.4 * X0[1]) * 1e-4, V[1] = cos(1.3 * X0[0] * X0[1]) * 1e-4, V[2] = 0;
}

static bw_status swing(bw_validation *v)
{
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  c.geometry = BW_PD_PLANE_STRAIN, c.ds = 1, c.rho = 2, c.E = 5;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){9, 9, 1}, NULL, NULL, &pd));
  BW_TRY(bw_solid_load_velocity(pd, shake, NULL));
  const int steps = bw_validation_full(v) ? 1000000 : 100000, every = 20;
  const double dt = 0.5 * bw_solid_dt_max(pd);
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  const double start = e.kinetic;
  double worst = 0, first = 0, last = 0;
  for (int step = 1; step <= steps; step++) {
    BW_TRY(bw_solid_step(pd, dt));
    if (step % every != 0) continue;
    BW_TRY(bw_solid_account(pd, &e));
    const double total = (e.kinetic + e.elastic) / start, share = 10.0 * every / steps;
    worst = fmax(worst, fabs(total - 1));
    if (step <= steps / 10) first += share * total;
    if (step > steps - steps / 10) last += share * total;
  }
  claim(v, "largest_excursion", worst, 0, 0.125);
  claim(v, "trend", last - first, 0, 1e-3);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(snap(v));
  return swing(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.energy_ledger", run);
}
