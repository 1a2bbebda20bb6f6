/* Claim      What ULPH (Wang et al. 2024) does and this code does not: its sum for the load on a
 *            solid (equation 57) overloads a wall, its midpoint steps (56) feed every wave, its
 *            speed of sound makes water more viscous. Its filter (24) is in ulph.rest.
 * Reference  Load: a pressure p on a flat wall is p per area. Steps: the amplitude of a wave does
 *            not grow. Sound: 10 times the largest speed, 2 sqrt(g H).
 * Measured   Equation 57 as scanned, sum p_B (A_A/V_A) x/|x|, summed over lattices of 3 dx (2D, 3D)
 *            and 3.6 dx (3D) reach, of all layers of the solid below a unit of the surface. Growth
 *            of the shortest wave of the lattice in 10^4 steps of 0.3 dx/c0 (the paper's) by
 *            midpoint and by kick, drift, kick, of the largest frequency that the operators have,
 *            2 c0/(2.6 dx).
 * Tolerance  The paper's have to miss: loads above 10 (errata: 11.7 and 78), growth above 2. Ours:
 *            growth 0 to 1e-9, round-off of 10^4 steps. The ratio of artificial viscosities is that
 *            of the speeds of sound, to round-off.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

/* Load by equation 57 on all solid below one particle of the surface, over that of the pressure:
 * solid layers at depths of k + 1/2, fluid at heights of j + 1/2. */
static double load_57(int d, double reach)
{
  const int n = (int)ceil(reach);
  double sum = 0;
  for (int layer = 0; layer < n; layer++)
    for (int j = 0; j < n; j++)
      for (int i = -n; i <= n; i++)
        for (int k = d == 3 ? -n : 0; k <= (d == 3 ? n : 0); k++) {
          const double y = layer + j + 1, r = sqrt(i * i + y * y + k * k);
          if (r < reach) sum += y / r;
        }
  return sum;
}

/* Amplitude of x'' = -x after so many steps of theta: energies at the end over those at the start,
 * the largest of the last turn. */
static double growth(bool midpoint, double theta, int steps)
{
  double x = 1, v = 0, most = 0;
  for (int q = 0; q < steps; q++) {
    if (midpoint) {
      const double xm = x + 0.5 * theta * v, vm = v - 0.5 * theta * x;
      x += theta * vm, v -= theta * xm;
    } else {
      v -= 0.5 * theta * x;
      x += theta * v;
      v -= 0.5 * theta * x;
    }
    /* The energy that kick, drift, kick keeps. */
    const double kept = x * x * (midpoint ? 1 : 1 - 0.25 * theta * theta) + v * v;
    most = q == steps - 1 ? kept : most;
  }
  return sqrt(most / (midpoint ? 1 : 1 - 0.25 * theta * theta));
}

/* Artificial viscosity of a column of 0.05715 m with the speed of sound c0; NaN: the default. */
static bw_status viscosity(bw_validation *v, double c0, double *nu)
{
  const double a = 0.05715;
  bw_ulph_config c = bw_ulph_config_default();
  const tank t = {.size = {2 * a, 2 * a, 0}, .upper = {a, a, 0}};
  bw_ulph *u = NULL;
  c.dimensions = 2, c.dx = a / 8, c.rho0 = 1000, c.gravity[1] = -tank_g, c.c0 = c0;
  c.speed = 2 * sqrt(tank_g * a);
  BW_TRY(tank_create(bw_validation_comm(v), &c, &t, &u));
  *nu = bw_ulph_artificial_nu(u);
  bw_ulph_destroy(&u);
  return BW_OK;
}

static void row(bw_validation *v, const char *quantity, double measured, double reference,
                double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "what ULPH does and this code does not",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "docs/errata.md, ULPH 56, 57, 7"});
}

static bw_status run(bw_validation *v)
{
  const double theta = 0.3 * 2 / 2.6, speed = 2 * sqrt(tank_g * 0.05715);
  const double loads[] = {load_57(2, 3), load_57(3, 3), load_57(3, 3.6)};
  double ours = NAN, papers = NAN;
  row(v, "load_57_in_2D_over_pressure", loads[0], 11.7, 0.005);
  row(v, "load_57_in_3D_over_pressure", loads[1], 0, INFINITY);
  row(v, "load_57_in_3D_reach_3.6_over_pressure", loads[2], 78, 0.005);
  row(v, "load_57_misses", loads[0] > 10 && loads[1] > 10, 1, 0);
  row(v, "midpoint_feeds_waves", growth(true, theta, 10000) > 2, 1, 0);
  row(v, "growth_by_midpoint", growth(true, theta, 10000), 1, INFINITY);
  row(v, "growth_by_kick_drift_kick", growth(false, theta, 10000), 1, 1e-9);
  BW_TRY(viscosity(v, NAN, &ours));
  BW_TRY(viscosity(v, 40, &papers));
  row(v, "viscosity_with_c0_of_Table_2_over_ours", papers / ours, 40 / (10 * speed), 1e-12);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.papers_choices", run);
}
