/* Drucker-Prager and J2 at a point.
 *
 * Claim      A point that yields has the strengths of the closed forms, for all four cones that
 *            stand for Mohr-Coulomb.
 * Reference  sqrt(J2) + alpha I1 = k without dilation. Triaxial compression at a pressure p: q =
 *            sqrt3 (k + 3 alpha p)/(1 - sqrt3 alpha), extension the same with a plus; plane strain:
 *            s1 - s3 = 2 (k + 3 alpha p)/(1 - 3 alpha); oedometer: s_a = -(K e + (2/sqrt3)(k + 3
 *            alpha K e)); shear: k; tension from all sides: k/(3 alpha). The values of these for
 *            E = 30 MPa, nu = 0.25, c = 5 kPa, phi = 13 degrees by an integration of another
 *            program (numpy), to their four decimals. J2 with hardening in uniaxial stress, in a
 *            plate: sigma = s0 + H p. Mohr-Coulomb in plane strain.
 * Measured   strains of 1e-6 a step, lateral strains so that the pressure on the sides stays. The
 *            rate form measures strain per present length and stress per present area: at a
 *            strength neither matters, and under an oedometer e is -ln(1 - e).
 * Tolerance  1e-8: the balance of the lateral pressure, 1e-9 of it, and roundings of 6000 steps.
 *            Against the digits of the other program half of the last one.
 * TEST  ranks=1 */
#include "bw_pd_material.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

typedef bw_pd_material_lanes lanes;
static const double E = 30e6, NU = 0.25, COHESION = 5e3, PRESSURE = 10e3, S3 = 1.73205080756887729;
static const double FRICTION = 13 * 3.14159265358979323846 / 180;
static const char *const cones[] = {"compression_cone", "extension_cone", "plane_strain_associated",
                                    "plane_strain_isochoric"};

static void claim(bw_validation *v, const char *cone, const char *quantity, double measured,
                  double reference, double tolerance, const char *source)
{
  char extra[80];
  snprintf(extra, sizeof extra, "\"cone\": \"%s\"", cone);
  bw_validation_row(v, &(bw_claim){.claim = "strength of a point",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = source[0] == 'c' ? BW_ANALYTIC : BW_INDEPENDENT_CODE,
                                   .source = source,
                                   .extra = extra});
}

/* A step to the stretches F (3); returns the stress along y, and the state when `keep`. */
static double step(const bw_pd_material_point *m, bw_pd_material_state *s, const double F[3],
                   bool keep)
{
  bw_pd_material_state next;
  lanes H[9] = {{0}}, P[9];
  for (int k = 0; k < 3; k++)
    for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++)
      H[4 * k][lane] = F[k] - 1;
  bw_pd_material_rate(m, s, H, &next, P, NULL);
  if (keep) *s = next;
  return next.sigma[1][0];
}

/* Compressed (sign -1) or drawn along x with the pressure kept on y and, unless it is held, z. */
static void triaxial(const bw_pd_material_point *m, double sign, bool held, bw_pd_material_state *s)
{
  double F[3] = {1, 1, 1};
  *s = (bw_pd_material_state){0};
  for (int k = 0; k < 3; k++)
    for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++)
      s->sigma[k][lane] = -PRESSURE;
  for (int q = 0; q < 6000; q++) {
    const double along = sign * 2e-6;
    double side = -NU / (held ? 1 - NU : 1) * along, most = 0, residual[2] = {0};
    /* Secants for the lateral stretch that keeps the pressure. */
    for (int pass = 0; pass < 40; pass++) {
      const double next[3] = {F[0] * (1 + along), F[1] * (1 + side),
                              held ? F[2] : F[2] * (1 + side)};
      residual[1] = step(m, s, next, false) + PRESSURE;
      if (fabs(residual[1]) < 1e-9 * PRESSURE) break;
      const double slope =
          pass == 0 ? m->lam + 2 * m->mu : (residual[1] - residual[0]) / (side - most);
      most = side, residual[0] = residual[1];
      side -= residual[1] / slope;
    }
    F[0] *= 1 + along, F[1] *= 1 + side;
    if (!held) F[2] *= 1 + side;
    step(m, s, F, true);
  }
}

/* n steps of one F. */
static void strained(const bw_pd_material_point *m, const double rate[9], int n,
                     bw_pd_material_state *s)
{
  *s = (bw_pd_material_state){0};
  for (int q = 1; q <= n; q++) {
    bw_pd_material_state next;
    lanes H[9] = {{0}}, P[9];
    for (int c = 0; c < 9; c++)
      H[c][0] = rate[c] * q;
    bw_pd_material_rate(m, s, H, &next, P, NULL);
    *s = next;
  }
}

static void one_cone(bw_validation *v, int cone, const double table[6])
{
  static const char closed[] = "closed form", other[] = "integration of one point (numpy)";
  const char *name = cones[cone];
  bw_pd_material_point m =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_LINEAR, E, NU);
  bw_pd_material_state s;
  m.yield = bw_pd_material_drucker_prager((bw_pd_material_cone)cone, COHESION, FRICTION, 0);
  const double a = m.yield.alpha, k = m.yield.k, top = k + 3 * a * PRESSURE;
  const double K = m.lam + 2 * m.mu / 3;
  const char *quantity[] = {"triaxial_compression", "triaxial_extension", "plane_strain"};
  const double strength[] = {S3 * top / (1 - S3 * a), S3 * top / (1 + S3 * a),
                             2 * top / (1 - 3 * a)};
  for (int q = 0; q < 3; q++) {
    triaxial(&m, q == 1 ? 1 : -1, q == 2, &s);
    const double measured = fabs(s.sigma[0][0] - s.sigma[1][0]);
    claim(v, name, quantity[q], measured, strength[q], 1e-8, closed);
    claim(v, name, quantity[q], measured, table[q], 1e-8, other);
  }
  /* True strain e: F = 1 - (1 - exp(-e)) after 2000 steps of the same F; at 0.01 of it the step in
   * F is constant, so that the logarithmic strain is the sum of its increments' midpoints. */
  const double shrink = -expm1(-0.01), held[9] = {-shrink / 2000}, shear[9] = {0, 2e-6};
  const double all[9] = {1e-6, 0, 0, 0, 1e-6, 0, 0, 0, 1e-6};
  strained(&m, held, 2000, &s);
  const double oedometer = -(K * 0.01 + 2 / S3 * (k + 3 * a * K * 0.01));
  claim(v, name, "oedometer", s.sigma[0][0], oedometer, 1e-8, closed);
  claim(v, name, "oedometer", s.sigma[0][0], table[3], 1e-8, other);
  strained(&m, shear, 2000, &s);
  claim(v, name, "shear", hypot(s.sigma[5][0], (s.sigma[0][0] - s.sigma[1][0]) / 2), k, 1e-8,
        closed);
  strained(&m, all, 2000, &s);
  claim(v, name, "tension", s.sigma[0][0], k / (3 * a), 1e-8, closed);
  if (cone == BW_PD_MATERIAL_PLANE_ISOCHORIC)
    claim(v, name, "mohr_coulomb_plane_strain", strength[2],
          2 * (COHESION * cos(FRICTION) + PRESSURE * sin(FRICTION)) / (1 - sin(FRICTION)), 1e-12,
          closed);
}

/* A plate pulled along x: sigma_xx from sigma_yy = sigma_zz = 0; p from the work. */
static void hardening(bw_validation *v)
{
  const double s0 = 20e3, H = 3e6;
  bw_pd_material_point m =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_PLANE_STRESS, BW_PD_MATERIAL_LINEAR, E, NU);
  bw_pd_material_state s = {0};
  m.yield = bw_pd_material_j2(s0, H);
  double F[3] = {1, 1, 1};
  for (int q = 0; q < 3000; q++) {
    const double along = 2e-6;
    double side = -NU * along, most = 0, before = 0;
    for (int pass = 0; pass < 40; pass++) {
      const double r = step(&m, &s, (double[3]){F[0] * (1 + along), F[1] * (1 + side), 1}, false);
      if (fabs(r) < 1e-9 * s0) break;
      const double slope = pass == 0 ? E : (r - before) / (side - most);
      most = side, before = r;
      side -= r / slope;
    }
    F[0] *= 1 + along, F[1] *= 1 + side;
    step(&m, &s, F, true);
  }
  /* In total ln F = sigma/E + p with sigma = s0 + H p. */
  const double e = log(F[0]);
  claim(v, "j2", "uniaxial_hardening", s.sigma[0][0], E * (s0 + H * e) / (E + H), 1e-8,
        "closed form");
}

static bw_status run(bw_validation *v)
{
  /* Triaxial compression, extension, plane strain at 10 kPa; oedometer at 0.01 [Pa]. */
  static const double table[4][6] = {{18376.5449, 13249.2446, 24721.0859, -271871.9737},
                                     {15397.2654, 11627.1762, 20173.4803, -261845.3556},
                                     {14040.1090, 10836.1938, 18179.5482, -257096.2228},
                                     {14175.6261, 10916.7411, 18376.5449, -257575.7489}};
  for (int cone = 0; cone < 4; cone++)
    one_cone(v, cone, table[cone]);
  hardening(v);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_material.drucker_prager", run);
}
