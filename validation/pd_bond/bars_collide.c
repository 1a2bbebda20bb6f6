/* Two equal elastic bars collide and part.
 *
 * Claim      They touch for the time a wave takes to the far ends and back, 2 L/c, and part
 *            with exchanged velocities; the momentum of both together stays.
 * Reference  1D wave theory (St Venant): duration 2 L/c, c = sqrt(9 E/(8 rho)) (plane stress,
 *            sideways periodic), velocities exchanged; conservation of momentum.
 * Measured   mean velocity of each bar after they parted; time from first to last contact
 *            energy.
 * Tolerance  total momentum: rounding, 1e-12 of each bar's. Velocities: the front, some 5
 *            horizons wide (pd_bond.bar_front), is reflected as a ripple that stays in the
 *            bars: at most the energy of its part of the way, 5 delta of 2 L, half of that in
 *            the velocity. Duration: 5 delta of 2 L, and the soft contact's own time, 2 ds/c.
 *            The loss falls like width over length, L^(-2/3) as the front grows with the cube
 *            root of time; a half of that either way (steady front: -1; one that grows with the
 *            root of time: -1/2).
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"

enum { WIDE = 4, GAP = 3 };
static const double E = 5, RHO = 2;

static int two_bars(const int32_t site[3], const void *data)
{
  const int length = *(const int *)data;
  return site[0] >= length && site[0] < length + GAP ? -1 : BW_PD_FREE;
}

typedef struct {
  double middle, speed;
} approach;

static void towards(const double X0[3], double V[3], const void *data)
{
  const approach *a = data;
  V[0] = X0[0] < a->middle ? a->speed : -a->speed;
  V[1] = V[2] = 0;
}

static double bar_velocity(const bw_solid *pd, body_rows *r, int bar, double middle)
{
  const double far = 1e9;
  bw_solid_get_velocity(pd, r->V);
  return body_mean(pd, r->X0, (double[3]){bar == 0 ? -far : middle, -far, -far},
                   (double[3]){bar == 0 ? middle : far, far, far}, r->V, 3);
}

static void claim(bw_validation *v, const char *quantity, const char *extra, double measured,
                  double reference, double tolerance, bw_claim_kind kind)
{
  bw_validation_row(v, &(bw_claim){.claim = "two bars collide and part",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = kind,
                                   .source = "St Venant 1867, waves in bars",
                                   .extra = extra});
}

static bw_status measure(bw_validation *v, int length, double mach, double *loss)
{
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E;
  c.calibration = BW_PD_CALIBRATION_LATTICE, c.contact = true;
  c.period[1] = WIDE;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){2 * length + GAP, WIDE, 1}, two_bars,
                   &length, &pd));
  BW_TRY(body_rows_make(pd, &r));
  const double speed = sqrt(1.125 * E / RHO), given = mach * speed, delta = 3;
  const approach start = {length + 0.5 * GAP, given};
  BW_TRY(bw_solid_load_velocity(pd, towards, &start));
  const double dt = 0.3 * bw_solid_dt_max(pd);
  double first = 0, last = 0, time = 0;
  const double end = GAP / (2 * given) + 4 * length / speed;
  while (time < end) {
    BW_TRY(bw_solid_step(pd, dt));
    time += dt;
    bw_solid_ledger e;
    BW_TRY(bw_solid_account(pd, &e));
    if (e.contact <= 0) continue;
    last = time;
    if (first == 0) first = time;
  }
  char extra[80];
  snprintf(extra, sizeof extra, "\"speed_over_c\": %g, \"length_over_horizon\": %g", mach,
           length / delta);
  const double a = bar_velocity(pd, &r, 0, start.middle), b = bar_velocity(pd, &r, 1, start.middle);
  const double front = 5 * delta / (2 * length);
  claim(v, "left_after", extra, a / given, -1, 0.5 * front, BW_ANALYTIC);
  claim(v, "right_after", extra, b / given, 1, 0.5 * front, BW_ANALYTIC);
  claim(v, "momentum", extra, (a + b) / given, 0, 1e-12, BW_CONSERVATION);
  claim(v, "duration", extra, (last - first) * speed / (2 * length), 1, front + 1.0 / length,
        BW_ANALYTIC);
  *loss = 1 - b / given;
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  double loss, longer;
  BW_TRY(measure(v, 150, 1e-3, &loss));
  BW_TRY(measure(v, 150, 1e-2, &loss));
  BW_TRY(measure(v, 450, 1e-2, &longer));
  claim(v, "order_of_loss", NULL, bw_validation_order(1. / 150, loss, 1. / 450, longer), 2. / 3,
        0.5, BW_ORDER);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.bars_collide", run);
}
