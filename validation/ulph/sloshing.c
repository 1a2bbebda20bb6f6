/* Claim      Water in a tank that is shaken along x sloshes as potential flow says, until the wave
 *            is about to break; the walls' work is found again in the book.
 * Reference  data/particle_fluid/sloshing_potential_h0.5_T1.875.csv: fully nonlinear potential
 *            flow by an independent program (slosh_potential.py beside it), two resolutions of
 *            which agree to 0.6 mm. Tank 1.73 m, depth 0.5 m, x = 0.032 cos(2 pi t/1.875) m from
 *            rest (ULPH 4.3); elevation 0.05 m from the left wall.
 * Measured   dx = 25 (5) mm, depth of the column (a hat of 0.05 m), every 0.02 s to 4.5 s.
 * Tolerance  3 mm, the largest difference, at 5 mm; at 25 mm the differences are reported (43 mm at
 *            the steepest troughs, 14 mm on average; at 12.5 mm 9.0 and 2.9 mm: order 2). Book:
 *            1e-3 of the first energy.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double LENGTH = 1.73, H = 0.5, PERIOD = 1.875, STROKE = 0.032, END = 4.5, RHO = 1000;
enum { MOST = 1024 };

/* The tank is built where it is at the start. */
static void shake(double t, void *context, double x[3], double v[3], double a[3])
{
  const double w = 2 * acos(-1) / PERIOD;
  (void)context;
  x[0] = STROKE * (cos(w * t) - 1), v[0] = -STROKE * w * sin(w * t);
  a[0] = -STROKE * w * w * cos(w * t);
  x[1] = x[2] = v[1] = v[2] = a[1] = a[2] = 0;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  static double table[MOST][5];
  bw_ulph_config c = bw_ulph_config_default();
  tank_water water = {H, RHO};
  bw_ulph *u = NULL;
  double worst = 0, square = 0, peak[2] = {0, 0};
  int rows = 0, n = 0;
  BW_TRY(bw_validation_table("particle_fluid/sloshing_potential_h0.5_T1.875.csv", 5, MOST, table[0],
                             &rows));
  /* A whole number of dx goes into the tank. */
  const int cells = (int)rint(LENGTH / (full ? 0.005 : 0.025));
  c.dimensions = 2, c.dx = LENGTH / cells, c.rho0 = RHO, c.gravity[1] = -tank_g, c.speed = 1.5;
  c.motion = shake;
  const double depth = c.dx * rint(H / c.dx), width = 2 * c.dx < 0.05 ? 0.05 - c.dx : c.dx;
  water.surface = depth;
  const tank t = {.size = {LENGTH, 2 * H, 0}, .upper = {LENGTH, depth, 0}, .moves = true};
  bw_status st = tank_create(bw_validation_comm(v), &c, &t, &u);
  BW_THEN(st, bw_ulph_start(u, tank_rest, &water));
  for (int q = 1; q < rows && st == BW_OK && table[q][0] <= END + 1e-9; q++) {
    double x[3], speed[3], a[3];
    st = tank_run(u, table[q][0]);
    shake(table[q][0], NULL, x, speed, a);
    x[0] += 0.05;
    const double eta = bw_ulph_depth(u, x, width) - depth;
    worst = fmax(worst, fabs(eta - table[q][1]));
    square += pow(eta - table[q][1], 2), n++;
    peak[0] = fmax(peak[0], eta), peak[1] = fmax(peak[1], table[q][1]);
  }
  if (st == BW_OK) {
    const bw_ulph_ledger l = bw_ulph_account(u);
    const struct {
      const char *quantity;
      double measured, reference, tolerance;
      bw_claim_kind kind;
    } row[] = {{"largest_difference_m", worst, 0, full ? 0.003 : INFINITY, BW_INDEPENDENT_CODE},
               {"root_mean_square_m", sqrt(square / n), 0, INFINITY, BW_INDEPENDENT_CODE},
               {"highest_m", peak[0], peak[1], INFINITY, BW_INDEPENDENT_CODE},
               {"book_gap", l.gap / l.first, 0, 1e-3, BW_CONSERVATION},
               {"ghosts_over_first_energy", l.ghosts / l.first, 0, INFINITY, BW_CONSERVATION}};
    for (size_t q = 0; q < sizeof row / sizeof *row; q++)
      bw_validation_row(v, &(bw_claim){.claim = "a shaken tank sloshes as potential flow",
                                       .quantity = row[q].quantity,
                                       .measured = row[q].measured,
                                       .reference = row[q].reference,
                                       .tolerance = row[q].tolerance,
                                       .kind = row[q].kind,
                                       .source = "nonlinear potential flow, 45 modes"});
  }
  bw_ulph_destroy(&u);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.sloshing", run);
}
