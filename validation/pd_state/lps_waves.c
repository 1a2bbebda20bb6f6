/* Waves of the ordinary state-based law, and the largest step of a body.
 *
 * Claim      Plane waves of every length have the frequency of the family's closed sum, long ones
 *            that of elasticity; the largest step is 0.95 of the exact one.
 * Reference  rho w^2 a = (d A/q) s (s.a) + 2 B sum w n (n.a)(1 - cos k.xi) V, A = d (lam* - mu)/q,
 *            s = sum w xi sin(k.xi) V, B = d (d + 2) mu/q, written once more here; c_P^2 = (lam* +
 *            2 mu)/rho, c_S^2 = mu/rho. Steps over c_P dt/ds of plane strain at m = 3: 1.818,
 *            2.222, 3.097, 4.198 at nu = 0, 0.25, 0.4, 0.49 (another program, numpy, over the
 *            zone).
 * Measured   bodies periodic in all directions; the acceleration of a displacement A sin(k x).
 * Tolerance  sums: 1e-6, terms of second order in an amplitude of 1e-6. Elasticity, at a wave of 64
 *            spacings: (k horizon)^2/24 = 4e-3 of the square of the frequency, and what the shear
 *            moduli of the lattice miss, 3.7 % at m = 3 (pd_state.lps_moduli). Steps: 1 %, what
 *            forty products leave and the zone's grid of the other program.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "state.h"

static const double E = 5, RHO = 2, M = 3;

/* rho w^2 of a wave along x that moves along x (d = 0) or y, in a family of linear fractions
 * (plane) or whole cells (space). */
static double closed(bool planar, double lam, double mu, double k, int direction)
{
  const int r = (int)(M + 1), d = planar ? 2 : 3;
  double q = 0, s = 0, bonds = 0;
  for (int z = planar ? 0 : -r; z <= (planar ? 0 : r); z++)
    for (int y = -r; y <= r; y++)
      for (int x = -r; x <= r; x++) {
        const double r2 = x * x + y * y + z * z, length = sqrt(r2);
        if (r2 == 0 || length >= M + 0.5) continue;
        const double w = planar ? fmin(1, M + 0.5 - length) : 1, n = direction == 0 ? x : y;
        q += w * r2;
        s += w * x * sin(k * x);
        bonds += w * n * n / r2 * (1 - cos(k * x));
      }
  /* s is along x: transverse waves have no dilatation. */
  return (direction == 0 ? d * d * (lam - mu) / (q * q) * s * s : 0) +
         2 * d * (d + 2) * mu / q * bonds;
}

static bw_status waves(bw_validation *v, bw_pd_geometry geometry, double nu)
{
  enum { LENGTH = 64 };
  const bool planar = geometry != BW_PD_3D;
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  double lam, mu;
  c.geometry = geometry, c.horizon_ratio = M, c.ds = 1, c.rho = RHO, c.E = E, c.nu = nu;
  c.law = &bw_pd_state_ordinary_law;
  if (!planar) c.volume_fraction = BW_PD_FRACTION_NONE;
  c.period[0] = LENGTH, c.period[1] = 1, c.period[2] = planar ? 0 : 1;
  state_lame(geometry, E, nu, &lam, &mu);
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){LENGTH, 1, 1}, NULL, NULL, &pd));
  for (size_t d = 0; d < 2; d++)
    for (int n = 1; 2 * n <= LENGTH; n *= 2) {
      const double k = 2 * STATE_PI * n / LENGTH, unit = (d == 0 ? lam + 2 * mu : mu) * k * k;
      double got;
      char extra[120];
      if (2 * n == LENGTH) break; /* its places are where the sine is 0 */
      BW_TRY(state_operator(pd, k, d, &got));
      snprintf(extra, sizeof extra, "\"geometry\": \"%s\", \"nu\": %g, \"spacings\": %d",
               planar ? "plane strain" : "space", nu, LENGTH / n);
      const char *name = d == 0 ? "omega2_P" : "omega2_S";
      state_claim(v, "frequencies are the family's sums", name, got / unit,
                  closed(planar, lam, mu, k, (int)d) / unit, 1e-6, BW_ANALYTIC,
                  "sum over the family", extra);
      if (n == 1)
        state_claim(v, "long waves are those of elasticity", name, got / unit, 1,
                    planar ? 0.041 : INFINITY, BW_ANALYTIC, "c_P, c_S", extra);
    }
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status steps(bw_validation *v)
{
  enum { SIDE = 24 };
  static const double nu[] = {0, 0.25, 0.4, 0.49}, limit[] = {1.818, 2.222, 3.097, 4.198};
  for (int q = 0; q < 4; q++) {
    bw_solid_config c = bw_solid_config_default();
    bw_solid *pd = NULL;
    double lam, mu;
    char extra[40];
    c.geometry = BW_PD_PLANE_STRAIN, c.horizon_ratio = M, c.ds = 1, c.rho = RHO, c.E = E;
    c.nu = nu[q], c.law = &bw_pd_state_ordinary_law;
    c.period[0] = c.period[1] = SIDE;
    state_lame(c.geometry, E, nu[q], &lam, &mu);
    BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){SIDE, SIDE, 1}, NULL, NULL, &pd));
    snprintf(extra, sizeof extra, "\"nu\": %g", nu[q]);
    state_claim(v, "the largest step is the lattice's", "step",
                bw_solid_dt_max(pd) * sqrt((lam + 2 * mu) / RHO) / 0.95, limit[q], 0.01,
                BW_INDEPENDENT_CODE, "numpy", extra);
    bw_solid_destroy(&pd);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const double nu[] = {-0.3, 0.25, 0.45};
  for (int q = 0; q < 3; q++) {
    BW_TRY(waves(v, BW_PD_PLANE_STRAIN, nu[q]));
    BW_TRY(waves(v, BW_PD_3D, nu[q]));
  }
  return steps(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.lps_waves", run);
}
