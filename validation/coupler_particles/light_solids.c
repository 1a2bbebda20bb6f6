/* Claim      Solids lighter than the fluid are stable at the default step down to a limit, which is
 *            found by bisection.
 * Reference  Archimedes: a block of any density lies still where it floats.
 * Measured   A block 20 x 10 dx, set 2 dx too high, in 40 x 24 dx of water, as in float_and_sink,
 *            for 4 heave times sqrt(10 dx/g) (10): held if it stays within 5 dx of where it floats
 *            and nothing is faster than sound. The quick form tries 0.2; the full one bisects
 *            between that and 0.005 in the logarithm, to a tenth.
 * Tolerance  0.2 has to hold. The limit is reported (0.010).
 * BUILD modules=shape,solid
 * TEST  ranks=1 */
#include "wet.h"

static const double DX = 0.01;

/* Does the block stay where it belongs? */
static bool holds(bw_validation *v, double ratio, double heaves)
{
  const double h = 10 * DX, depth = 24 * DX, draught = ratio * h - 2 * DX;
  const double under = draught > 0 ? draught : 0;
  wet_scene s = wet_water(DX, sqrt(wet_g * depth));
  wet w;
  double u[2] = {0}, farthest = 0;
  s.solid.ds = DX, s.solid.rho = ratio * 1000, s.solid.E = 2e7 * ratio / 0.6;
  s.solid.horizon_ratio = 2;
  wet_tank(&s, 40 * DX, 40 * DX);
  s.surface = depth;
  s.n_fluid = 2, s.in_fluid[0] = wet_box(0, 0, 40 * DX, depth);
  s.in_fluid[1] = s.in_solid[0] =
      wet_box(10 * DX, depth - DX * rint(under / DX), 30 * DX, depth - DX * rint(under / DX) + h);
  s.in_fluid[1].remove = true;
  s.n_solid = 1;
  bw_status st = wet_make(bw_validation_comm(v), &s, &w);
  for (int q = 1; q <= 4 * heaves && st == BW_OK; q++) {
    const double lower[2] = {-9, -9}, upper[2] = {9, 9};
    st = wet_run(&w, 0.25 * q * sqrt(h / wet_g));
    if (st == BW_OK) wet_moved(&w, lower, upper, u);
    farthest = fmax(farthest, hypot(u[0], u[1]));
  }
  wet_free(&w);
  return st == BW_OK && farthest < 5 * DX;
}

static void row(bw_validation *v, const char *quantity, double measured, double reference,
                double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "light solids are stable",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "Archimedes"});
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  const double heaves = full ? 10 : 4;
  row(v, "holds_at_a_fifth", holds(v, 0.2, heaves), 1, 0);
  if (!full) return BW_OK;
  double stable = 0.2, lost = 0.005;
  if (holds(v, lost, heaves)) stable = lost;
  while (stable / lost > 1.1) {
    const double middle = sqrt(stable * lost);
    if (holds(v, middle, heaves))
      stable = middle;
    else
      lost = middle;
  }
  row(v, "lightest_that_holds_over_the_fluid", stable, 0, INFINITY);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler_particles.light_solids", run);
}
