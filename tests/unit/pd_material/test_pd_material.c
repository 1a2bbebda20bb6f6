/* Materials at a point: stress is the derivative of the energy, turned bodies have turned stresses,
 * plane stress has none across, and what yields keeps its book.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_pd_material.h"

#include <math.h>

typedef bw_pd_material_lanes lanes;

static const bw_pd_material_plane planes[] = {BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_PLANE_STRESS,
                                              BW_PD_MATERIAL_PLANE_STRAIN};
static const double DEFORMED[9] = {0.2, -0.1, 0.05, 0.15, -0.1, 0.1, -0.05, 0.12, 0.25};

static void same(const double H[9], lanes out[9])
{
  for (int q = 0; q < 9; q++)
    for (int k = 0; k < BW_PD_MATERIAL_LANES; k++)
      out[q][k] = H[q];
}

START_TEST(stress_is_the_derivative_of_energy)
{
  const double step = 1e-5;
  for (int e = BW_PD_MATERIAL_LINEAR; e <= BW_PD_MATERIAL_HENCKY; e++)
    for (int p = 0; p < 3; p++) {
      const bw_pd_material_point m =
          bw_pd_material_elastic_point(planes[p], (bw_pd_material_elastic)e, 3, 0.3);
      const bool space = planes[p] == BW_PD_MATERIAL_SPACE;
      lanes P[9], G[9], other[9], W;
      same(DEFORMED, G);
      bw_pd_material_stress(&m, G, P, NULL);
      /* What is done to one lane is done to all. */
      for (int q = 0; q < 9; q++)
        for (int k = 1; k < BW_PD_MATERIAL_LANES; k++) {
          ck_assert_double_eq(P[q][k], P[q][0]);
          ck_assert_double_eq(G[q][k], G[q][0]);
        }
      if (planes[p] == BW_PD_MATERIAL_PLANE_STRESS) bw_check_near(P[8][3], 0, 1e-13);
      if (planes[p] == BW_PD_MATERIAL_PLANE_STRAIN) ck_assert_double_eq(G[8][0], 0);
      for (int q = 0; q < (space ? 9 : 5); q++) {
        if (!space && q == 2) continue;
        same(DEFORMED, G);
        G[q][0] += step, G[q][1] -= step;
        bw_pd_material_stress(&m, G, other, &W);
        bw_check_near((W[0] - W[1]) / (2 * step), P[q][5], 1e-8);
      }
    }
}
END_TEST

/* Saint Venant and Kirchhoff's law in plane stress: no stress across makes the strain across
 * E_33 = -nu/(1 - nu) (E_11 + E_22), and the stretch sqrt(1 + 2 E_33). */
START_TEST(a_sheet_gets_thinner)
{
  const double nu = 0.3, H[9] = {0.2, -0.1, 0, 0.15, -0.1, 0, 0, 0, 0};
  const bw_pd_material_point m =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_PLANE_STRESS, BW_PD_MATERIAL_SAINT_VENANT, 3, nu);
  lanes G[9], P[9];
  same(H, G);
  bw_pd_material_stress(&m, G, P, NULL);
  const double E[2] = {H[0] + 0.5 * (H[0] * H[0] + H[3] * H[3]),
                       H[4] + 0.5 * (H[1] * H[1] + H[4] * H[4])};
  const double across = sqrt(1 - 2 * nu / (1 - nu) * (E[0] + E[1])) - 1;
  for (int k = 0; k < BW_PD_MATERIAL_LANES; k++)
    bw_check_near(G[8][k], across, 1e-14);
}
END_TEST

/* A point that is nearly or wholly turned inside out, too. */
START_TEST(neo_hookean_beyond_the_flat)
{
  const bw_pd_material_point m =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_NEO_HOOKEAN, 3, 0.4);
  const double step = 1e-6;
  for (double h = -1.5; h < -0.5; h += 0.01) {
    lanes G[9], P[9], W;
    same((double[9]){h}, G);
    G[0][0] += step, G[0][1] -= step;
    bw_pd_material_stress(&m, G, P, &W);
    bw_check_near((W[0] - W[1]) / (2 * step) / P[0][2], 1, 1e-6);
    ck_assert_double_lt(P[0][2], 0);
  }
}
END_TEST

/* Q about (1,2,3)/sqrt(14) by 1.1 rad. */
static void rotation(double Q[9])
{
  const double n[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)}, c = cos(1.1), s = sin(1.1);
  const double cross[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      Q[3 * i + j] = c * (i == j) + (1 - c) * n[i] * n[j] + s * cross[3 * i + j];
}

static void times(const double A[9], const double B[9], double C[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      C[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        C[3 * i + j] += A[3 * i + k] * B[3 * k + j];
    }
}

START_TEST(turned_bodies_have_turned_stress)
{
  double Q[9], F[9], H[9], QP[9], one[9];
  rotation(Q);
  for (int q = 0; q < 9; q++)
    F[q] = DEFORMED[q] + (q % 4 == 0);
  times(Q, F, H);
  for (int q = 0; q < 9; q += 4)
    H[q] -= 1;
  for (int e = BW_PD_MATERIAL_SAINT_VENANT; e <= BW_PD_MATERIAL_HENCKY; e++) {
    const bw_pd_material_point m =
        bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, (bw_pd_material_elastic)e, 3, 0.3);
    lanes G[9], P[9], turned[9], W, W_turned;
    same(DEFORMED, G);
    bw_pd_material_stress(&m, G, P, &W);
    same(H, G);
    bw_pd_material_stress(&m, G, turned, &W_turned);
    for (int q = 0; q < 9; q++)
      one[q] = P[q][0];
    times(Q, one, QP);
    for (int q = 0; q < 9; q++)
      bw_check_near(turned[q][0], QP[q], 1e-13);
    bw_check_near(W_turned[0], W[0], 1e-13);
  }
}
END_TEST

/* lam + 2 mu without strain; of St. Venant-Kirchhoff stretched by a it is (lam + 2 mu)(3 a^2 - 1)/2
 * along the stretch. */
START_TEST(largest_tangent)
{
  const double a = 1.3, stretched[9] = {a - 1}, none[9] = {0};
  for (int e = BW_PD_MATERIAL_LINEAR; e <= BW_PD_MATERIAL_HENCKY; e++) {
    const bw_pd_material_point m =
        bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, (bw_pd_material_elastic)e, 3, 0.3);
    bw_check_near(bw_pd_material_largest_tangent(&m, none) / (m.lam + 2 * m.mu), 1, 1e-8);
  }
  const bw_pd_material_point svk =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_SAINT_VENANT, 3, 0.3);
  bw_check_near(bw_pd_material_largest_tangent(&svk, stretched) /
                    ((svk.lam + 2 * svk.mu) * (3 * a * a - 1) / 2),
                1, 1e-8);
}
END_TEST

/* A path of shear and stretch: never beyond the cone, the book adds up, nothing is won; and there
 * and back at half the step the same to the second order. */
static double along(bw_pd_material_plane plane, const bw_pd_material_yield *yield, int steps,
                    double sigma[6])
{
  bw_pd_material_point m = bw_pd_material_elastic_point(plane, BW_PD_MATERIAL_HENCKY, 100, 0.3);
  m.yield = *yield;
  bw_pd_material_state s[2] = {0};
  double work = 0, before[9] = {0}, dissipated = 0, stored = 0;
  for (int q = 1; q <= steps; q++) {
    const double t = (double)q / steps;
    const double F[9] = {0.02 * t, 0.08 * t, 0, -0.01 * t, -0.03 * t * t, 0, 0, 0, 0};
    lanes H[9], P[9], W;
    same(F, H);
    const bw_pd_material_state *old = &s[q % 2];
    bw_pd_material_state *next = &s[(q + 1) % 2];
    lanes P0[9];
    bw_pd_material_state_stress(&m, old, P0, NULL);
    bw_pd_material_rate(&m, old, H, next, P, &W);
    for (int c = 0; c < 9; c++) {
      work += 0.5 * (P0[c][0] + P[c][0]) * (next->H[c][0] - before[c]);
      before[c] = next->H[c][0];
    }
    ck_assert_double_ge(next->dissipated[0], dissipated - 1e-6);
    dissipated = next->dissipated[0], stored = W[0];
    double mean = 0, J2 = 0;
    for (int k = 0; k < 3; k++)
      mean += next->sigma[k][0] / 3;
    for (int k = 0; k < 3; k++)
      J2 += 0.5 * pow(next->sigma[k][0] - mean, 2) + pow(next->sigma[3 + k][0], 2);
    ck_assert_double_le(sqrt(J2) + 3 * yield->alpha * mean,
                        yield->k + yield->hardening * next->flow[0] + 1e-12);
    if (plane == BW_PD_MATERIAL_PLANE_STRESS) bw_check_near(next->sigma[2][0], 0, 1e-11);
    for (int k = 0; k < 6; k++)
      sigma[k] = next->sigma[k][0];
  }
  bw_check_near(stored + dissipated, work, 1e-12);
  return dissipated;
}

START_TEST(what_yields_keeps_its_book)
{
  const bw_pd_material_yield cone =
      bw_pd_material_drucker_prager(BW_PD_MATERIAL_COMPRESSION_CONE, 1, 0.4, 0.1);
  const bw_pd_material_yield j2 = bw_pd_material_j2(2, 5), *yield[] = {&cone, &j2};
  for (int y = 0; y < 2; y++)
    for (int p = 0; p < 3; p++) {
      double coarse[6], fine[6], finest[6];
      along(planes[p], yield[y], 100, coarse);
      along(planes[p], yield[y], 200, fine);
      ck_assert_double_gt(along(planes[p], yield[y], 400, finest), 0);
      double first = 0, second = 0;
      for (int k = 0; k < 6; k++)
        first += fabs(coarse[k] - fine[k]), second += fabs(fine[k] - finest[k]);
      ck_assert_double_gt(first / second, 1.8); /* the return is of first order */
    }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(stress_is_the_derivative_of_energy),
                                      BW_TEST(a_sheet_gets_thinner),
                                      BW_TEST(neo_hookean_beyond_the_flat),
                                      BW_TEST(turned_bodies_have_turned_stress),
                                      BW_TEST(largest_tangent),
                                      BW_TEST(what_yields_keeps_its_book)};
BW_CHECK_MAIN("pd_material", tests)
