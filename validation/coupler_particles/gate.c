/* Claim      A rubber gate that holds a column of water back bends open as in the experiment and in
 *            other computations (ULPH 4.6, Table 6).
 * Reference  Antoci, Gallati, Sibilla 2007: the free end is farthest aside, 46.4 mm, at 0.16 s;
 *            computations with the same gate 39.0 to 42.7 mm at 0.115 to 0.120 s (Khayyer, Yang,
 *            Ng; shared/reference/ulph/gate_antoci2007_displacement.csv). E is not agreed: 7.8 to
 *            12 MPa are in use; here 7.8 MPa, nu = 0.47, as in Table 6.
 * Measured   Water 0.1 x 0.14 m; gate 0.079 x 0.005 m, clamped at the top, five layers of 1 mm;
 *            fluid at 2 (1) mm. Mean displacement of the last 2 mm of the gate every 5 ms.
 * Tolerance  Farthest aside: 10 % beyond the band from 39 to 46.4 mm. When: within 0.115 to 0.16 s
 *            and a sample. At 2 mm both are reported, and the gap of the fluid's
 *            book (1e-3 of the first energy at 1 mm).
 * BUILD modules=shape,solid
 * TEST  ranks=1 */
#include "wet.h"

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  const double W = 0.1, H = 0.14, L = 0.079, a = 0.005, ds = 0.001, dx = full ? 0.001 : 0.002;
  const double t = 4 * dx, end = full ? 0.4 : 0.17, big = 10;
  wet_scene s = wet_water(dx, 2 * sqrt(wet_g * H));
  wet w;
  double most[2] = {0, 0}, when = 0, u[2];
  wet_rubber(&s, ds, 1100, 7.8e6, 0.47);
  s.surface = H;
  s.n_fluid = 1, s.in_fluid[0] = wet_box(0, 0, W, H);
  /* A floor that goes on, a wall on the left, and what holds the gate. */
  s.n_wall = 3;
  s.in_wall[0] = wet_box(-t, -t, 0, 1.2 * H);
  s.in_wall[1] = wet_box(-t, -t, 4 * W, 0);
  s.in_wall[2] = wet_box(W, L, W + fmax(t, a), 1.2 * H);
  s.n_solid = 2;
  s.in_solid[0] = wet_box(W, ds, W + a, L + 4 * ds);
  s.in_solid[0].particle_kind = BW_PD_PRESCRIBED;
  s.in_solid[1] = wet_box(W, ds, W + a, L);
  bw_status st = wet_make(bw_validation_comm(v), &s, &w);
  for (int q = 1; q * 0.005 <= end + 1e-9 && st == BW_OK; q++) {
    const double lower[2] = {-big, -big}, upper[2] = {big, 3 * ds};
    st = wet_run(&w, 0.005 * q);
    if (st != BW_OK) break;
    wet_moved(&w, lower, upper, u);
    if (u[0] > most[0]) most[0] = u[0], most[1] = u[1], when = 0.005 * q;
  }
  if (st == BW_OK) {
    const struct {
      const char *quantity;
      double measured, reference, tolerance;
    } row[] = {{"farthest_aside_m", most[0], 0.0427, full ? 0.0083 / 0.0427 : INFINITY},
               {"upwards_then_m", most[1], 0.017, INFINITY},
               {"when_s", when, 0.1375, full ? 0.0275 / 0.1375 : INFINITY}};
    for (int q = 0; q < 3; q++)
      bw_validation_row(v, &(bw_claim){.claim = "a rubber gate bends open as in the experiment",
                                       .quantity = row[q].quantity,
                                       .measured = row[q].measured,
                                       .reference = row[q].reference,
                                       .tolerance = row[q].tolerance,
                                       .kind = BW_PUBLISHED,
                                       .source = "Antoci et al. 2007 and three computations"});
    wet_book(v, &w, full ? 1e-3 : INFINITY);
  }
  wet_free(&w);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler_particles.gate", run);
}
