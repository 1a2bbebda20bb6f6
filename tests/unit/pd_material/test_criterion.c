/* Criteria of failure against their closed forms, in stresses turned at random.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_pd_material_criterion.h"

static const double PI = 3.14159265358979323846, LAM = 1.2, MU = 0.9;

/* p along axes turned by Euler's angles. */
static void turned(const double p[3], double a, double b, double sigma[6])
{
  const double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b);
  const double R[3][3] = {{ca * cb, -sa, ca * sb}, {sa * cb, ca, sa * sb}, {-sb, 0, cb}};
  double S[3][3] = {{0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        S[i][j] += R[i][k] * p[k] * R[j][k];
  for (int q = 0; q < 6; q++)
    sigma[q] = S[q < 3 ? q : (q + 1) % 3][q < 3 ? q : (q + 2) % 3];
}

static double used(bw_pd_material_criterion_kind kind, double limit, double friction,
                   const double p[3])
{
  const bw_pd_material_criterion c = {kind, limit, friction};
  double sigma[6], least = INFINITY, most = -INFINITY;
  /* However it is turned, the answer is the same. */
  for (int q = 0; q < 20; q++) {
    turned(p, 0.7 * q, 1.3 * q, sigma);
    const double x = bw_pd_material_used(&c, LAM, MU, sigma);
    least = fmin(least, x), most = fmax(most, x);
  }
  bw_check_near(least, most, 1e-13);
  return most;
}

START_TEST(uniaxial_tension)
{
  const double p[3] = {0.7, 0, 0}, phi = 0.5;
  bw_check_near(used(BW_PD_MATERIAL_RANKINE, 0.7, 0, p), 1, 1e-13);
  bw_check_near(used(BW_PD_MATERIAL_ENERGY, 0.7, 0, p), 1, 1e-13);
  bw_check_near(used(BW_PD_MATERIAL_MISES, 0.7, 0, p), 1, 1e-13);
  /* Mohr-Coulomb's strength in tension is 2 c cos/(1 + sin), in pressure 2 c cos/(1 - sin). */
  const double c = 0.7 * (1 + sin(phi)) / (2 * cos(phi));
  bw_check_near(used(BW_PD_MATERIAL_MOHR_COULOMB, c, phi, p), 1, 1e-13);
  const double pressed[3] = {-2 * c * cos(phi) / (1 - sin(phi)), 0, 0};
  bw_check_near(used(BW_PD_MATERIAL_MOHR_COULOMB, c, phi, pressed), 1, 1e-13);
}
END_TEST

START_TEST(energy_is_that_of_hooke)
{
  /* W = lam/2 tr^2 + mu e:e of a strain; 2 E W over the square of the limit. */
  const double e[3] = {0.3, -0.1, 0.2}, E = MU * (3 * LAM + 2 * MU) / (LAM + MU);
  const double trace = e[0] + e[1] + e[2];
  double p[3], W = 0.5 * LAM * trace * trace;
  for (int k = 0; k < 3; k++)
    p[k] = LAM * trace + 2 * MU * e[k], W += MU * e[k] * e[k];
  bw_check_near(used(BW_PD_MATERIAL_ENERGY, 0.4, 0, p), sqrt(2 * E * W) / 0.4, 1e-13);
}
END_TEST

START_TEST(the_cone_is_mohr_coulombs_in_plane_strain)
{
  /* Without dilation the stress across is the mean of the others at collapse. */
  for (double phi = 0; phi < 1.2; phi += 0.2) {
    const double s1 = 0.3, s3 = -0.9, p[3] = {s1, 0.5 * (s1 + s3), s3};
    bw_check_near(used(BW_PD_MATERIAL_CONE, 0.6, phi, p),
                  used(BW_PD_MATERIAL_MOHR_COULOMB, 0.6, phi, p), 1e-13);
  }
}
END_TEST

START_TEST(principal_stresses_in_order)
{
  const double p[3] = {-0.4, 1.1, 0.2};
  double sigma[6], value[3], axis[3][3];
  turned(p, 0.4, PI / 5, sigma);
  bw_pd_material_principal_stress(sigma, value, axis);
  bw_check_near(value[0], 1.1, 1e-13);
  bw_check_near(value[1], 0.2, 1e-13);
  bw_check_near(value[2], -0.4, 1e-13);
  /* sigma n = value n. */
  for (int a = 0; a < 3; a++) {
    const double *n = axis[a];
    bw_check_near(sigma[0] * n[0] + sigma[5] * n[1] + sigma[4] * n[2], value[a] * n[0], 1e-13);
    bw_check_near(sigma[5] * n[0] + sigma[1] * n[1] + sigma[3] * n[2], value[a] * n[1], 1e-13);
    bw_check_near(sigma[4] * n[0] + sigma[3] * n[1] + sigma[2] * n[2], value[a] * n[2], 1e-13);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(uniaxial_tension), BW_TEST(energy_is_that_of_hooke),
                                      BW_TEST(the_cone_is_mohr_coulombs_in_plane_strain),
                                      BW_TEST(principal_stresses_in_order)};
BW_CHECK_MAIN("pd_material: criteria of failure", tests)
