/* Materials at a point under a homogeneous deformation.
 *
 * Claim      Stresses of uniaxial stretch with held sides, of simple shear and of a turn are those
 *            of the closed forms; a stress in rate form turns with the body.
 * Reference  Stretch a: St. Venant-Kirchhoff P = (lam + 2 mu)(a^3 - a)/2; neo-Hookean P = mu (a -
 *            1/a) + lam ln(a)/a; Hencky sigma = (lam + 2 mu) ln(a)/a; Jaumann's rate sigma = (lam +
 *            2 mu) ln a. Shear g: St. Venant-Kirchhoff P12 = mu g + (lam/2 + mu) g^3; neo-Hookean
 *            sigma12 = mu g, sigma11 = mu g^2; Jaumann's rate sigma12 = mu sin g, sigma11 = mu (1 -
 *            cos g). Plane stress: sigma33 = 0, and of the linear law sigma = E/(1 - nu^2) e.
 * Measured   one point; the rate form in 160 and 320 steps.
 * Tolerance  closed forms: 1e-12, some hundred roundings. Rate form: of second order, to 0.1. Its
 *            error has even powers of the step alone, so that the extrapolation from both numbers
 *            of steps leaves the fourth power of the strain of a step, in parts of mu.
 * TEST  ranks=1 */
#include "bw_pd_material.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

typedef bw_pd_material_lanes lanes;
static const double E = 2.5, NU = 0.3, A = 1.5, G = 0.8;

static void claim(bw_validation *v, const char *quantity, double measured, double reference,
                  double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "stress of a homogeneous deformation",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "closed form"});
}

static bw_pd_material_point material(bw_pd_material_plane plane, bw_pd_material_elastic elastic)
{
  return bw_pd_material_elastic_point(plane, elastic, E, NU);
}

/* P of F = 1 + H. */
static void stress(const bw_pd_material_point *m, const double H[9], double P[9])
{
  lanes h[9], p[9];
  for (int q = 0; q < 9; q++)
    for (int k = 0; k < BW_PD_MATERIAL_LANES; k++)
      h[q][k] = H[q];
  bw_pd_material_stress(m, h, p, NULL);
  for (int q = 0; q < 9; q++)
    P[q] = p[q][0];
}

static void elastic(bw_validation *v)
{
  const bw_pd_material_point svk = material(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_SAINT_VENANT);
  const bw_pd_material_point nh = material(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_NEO_HOOKEAN);
  const bw_pd_material_point hencky = material(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_HENCKY);
  const bw_pd_material_point plate = material(BW_PD_MATERIAL_PLANE_STRESS, BW_PD_MATERIAL_LINEAR);
  const double lam = svk.lam, mu = svk.mu, stretch[9] = {A - 1}, shear[9] = {0, G};
  double P[9];
  stress(&svk, stretch, P);
  claim(v, "svk_stretch", P[0], (lam + 2 * mu) * (A * A * A - A) / 2, 1e-12);
  stress(&nh, stretch, P);
  claim(v, "neo_hookean_stretch", P[0], mu * (A - 1 / A) + lam * log(A) / A, 1e-12);
  /* The face across the stretch keeps its area: P11 is sigma11. */
  stress(&hencky, stretch, P);
  claim(v, "hencky_stretch", P[0], (lam + 2 * mu) * log(A) / A, 1e-12);
  stress(&svk, shear, P);
  claim(v, "svk_shear_12", P[1], mu * G + (lam / 2 + mu) * G * G * G, 1e-12);
  /* sigma = P F^T with J = 1. */
  stress(&nh, shear, P);
  claim(v, "neo_hookean_shear_12", P[1], mu * G, 1e-12);
  claim(v, "neo_hookean_shear_11", P[0] + G * P[1], mu * G * G, 1e-12);
  stress(&plate, (double[9]){1e-3}, P);
  claim(v, "linear_plane_stress", P[0], E / (1 - NU * NU) * 1e-3, 1e-12);
  for (int e = BW_PD_MATERIAL_LINEAR; e <= BW_PD_MATERIAL_HENCKY; e++) {
    const bw_pd_material_point m = material(BW_PD_MATERIAL_PLANE_STRESS, (bw_pd_material_elastic)e);
    stress(&m, (double[9]){0.3, 0.1, 0, 0.05, -0.1}, P);
    claim(v, "plane_stress_sigma33", P[8], 0, 1e-12);
  }
}

/* Stress after `steps` steps of a path. */
static void path(bw_pd_material_plane plane, void (*at)(double t, double H[9]), int steps,
                 const double start[6], double sigma[6])
{
  const bw_pd_material_point m = material(plane, BW_PD_MATERIAL_LINEAR);
  bw_pd_material_state s[2] = {0};
  for (int k = 0; k < 6; k++)
    s[0].sigma[k][0] = start[k];
  for (int q = 1; q <= steps; q++) {
    double H[9] = {0};
    lanes h[9] = {{0}}, P[9];
    at((double)q / steps, H);
    for (int c = 0; c < 9; c++)
      h[c][0] = H[c];
    bw_pd_material_rate(&m, &s[(q + 1) % 2], h, &s[q % 2], P, NULL);
  }
  for (int k = 0; k < 6; k++)
    sigma[k] = s[steps % 2].sigma[k][0];
}

static void stretched(double t, double H[9])
{
  H[0] = (A - 1) * t;
}

static void sheared(double t, double H[9])
{
  H[1] = 4 * t;
}

static void turned(double t, double H[9])
{
  const double angle = atan(1) * t; /* 45 degrees at the end */
  H[0] = H[4] = cos(angle) - 1;
  H[1] = -sin(angle), H[3] = sin(angle);
}

static void rate(bw_validation *v, const char *quantity, void (*at)(double, double[9]), int which,
                 double strain, double reference, double scale)
{
  const double none[6] = {0};
  double coarse[6], fine[6];
  char order[64], name[64];
  path(BW_PD_MATERIAL_SPACE, at, 160, none, coarse);
  path(BW_PD_MATERIAL_SPACE, at, 320, none, fine);
  const double e1 = coarse[which] - reference, e2 = fine[which] - reference;
  snprintf(order, sizeof order, "%s_order", quantity);
  snprintf(name, sizeof name, "%s_extrapolated", quantity);
  claim(v, order, bw_validation_order(1.0 / 160, fabs(e1), 1.0 / 320, fabs(e2)), 2, 0.1);
  claim(v, name, (4 * fine[which] - coarse[which]) / 3 / scale, reference / scale,
        pow(strain / 160, 4) / fabs(reference / scale));
}

static bw_status run(bw_validation *v)
{
  const bw_pd_material_point m = material(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_LINEAR);
  elastic(v);
  rate(v, "jaumann_stretch", stretched, 0, A - 1, (m.lam + 2 * m.mu) * log(A), m.mu);
  rate(v, "jaumann_shear_12", sheared, 5, 4, m.mu * sin(4), m.mu);
  rate(v, "jaumann_shear_11", sheared, 0, 4, m.mu * (1 - cos(4)), m.mu);
  /* R (3 1; 1 -2) R^T by 45 degrees: xx = 1/2 - 1, yy = 1/2 + 1, xy = 5/2. */
  double sigma[6];
  path(BW_PD_MATERIAL_SPACE, turned, 10, (double[6]){3, -2, 1, 0, 0, 1}, sigma);
  const double s2[6] = {-0.5, 1.5, 1, 0, 0, 2.5};
  /* Cayley's turn by an angle t per step is one by 2 atan of what F says at its middle: exact. */
  claim(v, "turn_xx", sigma[0], s2[0], 1e-12);
  claim(v, "turn_yy", sigma[1], s2[1], 1e-12);
  claim(v, "turn_xy", sigma[5], s2[5], 1e-12);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_material.homogeneous", run);
}
