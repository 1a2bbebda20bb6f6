/* Claim      A dam break meets the end wall when it does in the experiment, and presses on its
 *            foot as it does there.
 * Reference  data/particle_fluid/lobovsky_3mm.csv (Lobovsky et al., J. Fluids Struct. 48 (2014)
 *            407): tank 1.61 m, column H = 0.3 m high and 2 H long, sensor 3 mm above the bed.
 * Measured   20 (60) dx per H, t* = t sqrt(g/H) to 4.3. Pressure on the patch of the wall within
 *            (10 mm or dx) of the bed, averaged over 0.05 in t*. Arrival: first sample above 0.1.
 * Tolerance  Arrival 2.43 within 0.05 at 60 dx, 0.15 at 20, where a sheet of one particle is the
 *            front; impulse from arrival to 3.5 within 15 %. Plateau at t* = 4: 0.6 +- 0.1 at 60
 *            dx; at 20 it is reported. The peak scatters by 50 % between repetitions of the
 *            experiment and is not judged.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double H = 0.3, RHO = 1000, LENGTH = 1.61;
enum { SAMPLES = 86, MOST = 128 };

static bw_status follow(bw_validation *v, int cells, double p[SAMPLES])
{
  bw_ulph_config c = bw_ulph_config_default();
  bw_ulph *u = NULL;
  const double dx = H / cells, unit = sqrt(H / tank_g);
  c.dimensions = 2, c.dx = dx, c.rho0 = RHO, c.gravity[1] = -tank_g;
  c.speed = 2 * sqrt(tank_g * H);
  /* The wall stands on the lattice: a length of a whole number of dx. */
  const double length = dx * rint(LENGTH / dx);
  const tank t = {.size = {length, 2 * H, 0}, .upper = {2 * H, H, 0}};
  const double lower[3] = {length, 0, 0}, upper[3] = {length + dx, fmax(dx, 0.01), 0};
  bw_status st = tank_create(bw_validation_comm(v), &c, &t, &u);
  for (int q = 0; q < SAMPLES && st == BW_OK; q++) {
    double sum = 0, weight = 0;
    while (st == BW_OK && bw_ulph_time(u) < 0.05 * (q + 1) * unit) {
      const double dt = bw_ulph_dt_max(u);
      st = bw_ulph_step(u, dt);
      sum += dt * bw_ulph_wall_pressure(u, lower, upper), weight += dt;
    }
    p[q] = sum / weight / (RHO * tank_g * H);
  }
  bw_ulph_destroy(&u);
  return st;
}

/* Integral of straight pieces between t0 and t1. */
static double impulse(int n, double (*table)[2], double t0, double t1)
{
  double sum = 0;
  for (int q = 1; q < n; q++) {
    const double a = fmax(t0, table[q - 1][0]), b = fmin(t1, table[q][0]);
    if (b <= a) continue;
    const double slope = (table[q][1] - table[q - 1][1]) / (table[q][0] - table[q - 1][0]);
    sum += (b - a) * (table[q - 1][1] + slope * (0.5 * (a + b) - table[q - 1][0]));
  }
  return sum;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  double p[SAMPLES], table[MOST][2], ours[SAMPLES][2], arrival = NAN, plateau = 0;
  int rows = 0;
  BW_TRY(bw_validation_table("particle_fluid/lobovsky_3mm.csv", 2, MOST, table[0], &rows));
  BW_TRY(follow(v, full ? 60 : 20, p));
  for (int q = 0; q < SAMPLES; q++) {
    ours[q][0] = 0.05 * (q + 0.5), ours[q][1] = p[q];
    if (isnan(arrival) && p[q] > 0.1) arrival = 0.05 * (q + 0.5);
    if (q >= 74) plateau += p[q] / (SAMPLES - 74);
  }
  const double theirs = impulse(rows, table, 2.43, 3.5);
  const double mine = impulse(SAMPLES, ours, arrival, arrival + 3.5 - 2.43);
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } row[] = {{"arrival", arrival, 2.43, (full ? 0.05 : 0.15) / 2.43},
             {"plateau", plateau, 0.6, full ? 0.1 / 0.6 : INFINITY},
             {"impulse_over_experiment", mine / theirs, 1, 0.15}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++)
    bw_validation_row(v, &(bw_claim){.claim = "a dam break presses on a wall as in the experiment",
                                     .quantity = row[q].quantity,
                                     .measured = row[q].measured,
                                     .reference = row[q].reference,
                                     .tolerance = row[q].tolerance,
                                     .kind = BW_PUBLISHED,
                                     .source = "Lobovsky et al. 2014, sensor at 3 mm"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.wall_pressure", run);
}
