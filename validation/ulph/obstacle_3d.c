/* Claim      A dam break in three dimensions meets a block when it does in the experiment, and
 *            presses on it as it does there.
 * Reference  data/particle_fluid/kleefsman_p1.csv (J. Comput. Phys. 206 (2005) 363, SPHERIC test
 *            2): tank 3.22 x 1 x 1 m, water 1.228 x 0.55 x 1 m, block 0.161 m high and long, 0.403
 *            m wide, sensor on its face to the water, 0.021 m above the bed.
 * Measured   11 (27) dx per depth, half of the tank with a free-slip wall in the middle plane;
 *            pressure on the lower part of the face, of 0.06 m (3 dx at 27) square, averaged over
 *            0.1 in t* = t sqrt(g/H). Arrival: first sample above 0.3.
 * Tolerance  Arrival 5 %, and plateau, the mean of t* 3 to 4, 15 %, at 27 dx. At 11, where a sheet
 *            of one particle is the front, the arrival is reported (1.85, 10 % late) and the run
 *            ends before the plateau. Mass: round-off; particles change ranks all the time.
 * BUILD modules=shape
 * TEST  ranks=2 */
#include "tank.h"

static const double H = 0.55, RHO = 1000;
enum { SAMPLES = 40, MOST = 64 };

static bw_status follow(bw_validation *v, int cells, int samples, double p[SAMPLES], double *kept)
{
  bw_ulph_config c = bw_ulph_config_default();
  bw_ulph *u = NULL;
  const double dx = H / cells, unit = sqrt(H / tank_g);
  c.dimensions = 3, c.dx = dx, c.rho0 = RHO, c.gravity[1] = -tank_g;
  c.speed = 2 * sqrt(tank_g * H);
  const double far = dx * rint(3.22 / dx), wide = dx * rint(0.5 / dx);
  const double face = dx * rint((3.22 - 0.6635 - 0.161) / dx), block = dx * rint(0.161 / dx);
  const double half = dx * rint(0.2015 / dx);
  tank t = {.size = {far, 1, wide}, .upper = {dx * rint(1.228 / dx), H, wide}};
  /* The block goes on below the bed and beyond the middle plane: all of it is wall. */
  t.obstacle[0][0] = face, t.obstacle[0][1] = -4 * dx, t.obstacle[0][2] = -4 * dx;
  t.obstacle[1][0] = face + block, t.obstacle[1][1] = block, t.obstacle[1][2] = half;
  const double lower[3] = {face, 0, 0}, upper[3] = {face + dx, 0.06, 0.06};
  bw_status st = tank_create(bw_validation_comm(v), &c, &t, &u);
  const double mass = st == BW_OK ? bw_ulph_account(u).mass : 1;
  for (int q = 0; q < samples && st == BW_OK; q++) {
    double sum = 0, weight = 0;
    while (st == BW_OK && bw_ulph_time(u) < 0.1 * (q + 1) * unit) {
      const double dt = bw_ulph_dt_max(u);
      st = bw_ulph_step(u, dt);
      sum += dt * bw_ulph_wall_pressure(u, lower, upper), weight += dt;
    }
    p[q] = sum / weight / (RHO * tank_g * H);
  }
  if (st == BW_OK) *kept = bw_ulph_account(u).mass / mass;
  bw_ulph_destroy(&u);
  return st;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  double p[SAMPLES], table[MOST][2], arrival = NAN, plateau = 0, theirs = 0, kept = 0;
  int rows = 0, n = 0;
  BW_TRY(bw_validation_table("particle_fluid/kleefsman_p1.csv", 2, MOST, table[0], &rows));
  const int samples = full ? SAMPLES : 22;
  BW_TRY(follow(v, full ? 27 : 11, samples, p, &kept));
  for (int q = 0; q < samples; q++) {
    if (isnan(arrival) && p[q] > 0.3) arrival = 0.1 * (q + 0.5);
    if (q >= 30) plateau += p[q] / 10;
  }
  for (int r = 0; r < rows; r++)
    if (table[r][0] > 3 && table[r][0] < 4.1) theirs += table[r][1], n++;
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } row[] = {{"mass", kept, 1, 1e-12},
             {"arrival", arrival, 1.68, full ? 0.05 : INFINITY},
             {"plateau", plateau, theirs / n, 0.15}};
  /* The quick form ends before the plateau. */
  for (size_t q = 0; q < (full ? 3 : 2); q++)
    bw_validation_row(v, &(bw_claim){.claim = "a dam break presses on a block as in the experiment",
                                     .quantity = row[q].quantity,
                                     .measured = row[q].measured,
                                     .reference = row[q].reference,
                                     .tolerance = row[q].tolerance,
                                     .kind = BW_PUBLISHED,
                                     .source = "Kleefsman et al. 2005, sensor P1"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.obstacle_3d", run);
}
