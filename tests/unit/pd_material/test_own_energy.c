/* An energy of one's own: stress is its derivative, small strains are Hooke's, plane stress has
 * none across, a stretch has its closed form.
 * TEST ranks=1 */
#include "bw_check.h"
#include "mooney_rivlin.h"

static const double DEFORMED[9] = {0.2, -0.1, 0.05, 0.15, -0.1, 0.1, -0.05, 0.12, 0.25};

static bw_pd_material_point rubber(bw_pd_material_plane plane, double part)
{
  bw_pd_material_point m = bw_pd_material_elastic_point(plane, BW_PD_MATERIAL_LINEAR, 3, 0.4);
  m.own = &mooney_rivlin;
  m.parameter[0] = part;
  return m;
}

static void same(const double H[9], double factor, lanes out[9])
{
  for (int q = 0; q < 9; q++)
    out[q] = lanes_all(factor * H[q]);
}

START_TEST(stress_is_the_derivative_of_energy)
{
  const double step = 1e-5;
  for (int p = BW_PD_MATERIAL_SPACE; p <= BW_PD_MATERIAL_PLANE_STRAIN; p++) {
    const bw_pd_material_point m = rubber((bw_pd_material_plane)p, 0.3);
    const bool space = p == BW_PD_MATERIAL_SPACE;
    lanes P[9], G[9], other[9], W;
    same(DEFORMED, 1, G);
    bw_pd_material_stress(&m, G, P, NULL);
    if (p == BW_PD_MATERIAL_PLANE_STRESS) bw_check_near(P[8][3], 0, 1e-14);
    for (int q = 0; q < (space ? 9 : 5); q++) {
      if (!space && q == 2) continue;
      same(DEFORMED, 1, G);
      G[q][0] += step, G[q][1] -= step;
      bw_pd_material_stress(&m, G, other, &W);
      bw_check_near((W[0] - W[1]) / (2 * step), P[q][5], 1e-8); /* the step's square */
    }
  }
}
END_TEST

START_TEST(small_strains_are_those_of_hooke)
{
  for (int p = BW_PD_MATERIAL_SPACE; p <= BW_PD_MATERIAL_PLANE_STRAIN; p++) {
    const bw_pd_material_plane plane = (bw_pd_material_plane)p;
    const bw_pd_material_point m = rubber(plane, 0.3);
    const bw_pd_material_point hooke =
        bw_pd_material_elastic_point(plane, BW_PD_MATERIAL_LINEAR, 3, 0.4);
    lanes P[9], Q[9], G[9];
    same(DEFORMED, 1e-6, G);
    bw_pd_material_stress(&m, G, P, NULL);
    same(DEFORMED, 1e-6, G);
    bw_pd_material_stress(&hooke, G, Q, NULL);
    for (int q = 0; q < (p == BW_PD_MATERIAL_SPACE ? 9 : 5); q++)
      bw_check_near(P[q][0], Q[q][0], 1e-11); /* 3 times the strain squared */
  }
}
END_TEST

START_TEST(stretched_between_held_sides)
{
  const bw_pd_material_point m = rubber(BW_PD_MATERIAL_SPACE, 0.25);
  const double c2 = 0.125 * m.mu, c1 = 0.375 * m.mu;
  for (double a = 0.5; a < 3; a += 0.1) {
    lanes G[9], P[9];
    same((double[9]){a - 1}, 1, G);
    bw_pd_material_stress(&m, G, P, NULL);
    /* I1 = a^2 + 2, I2 = 2 a^2 + 1, J = a. */
    const double want = 2 * c1 * a + 4 * c2 * a + ((m.lam - 4 * c2) * log(a) - 2 * c1 - 4 * c2) / a;
    bw_check_near(P[0][0], want, 1e-13 * m.lam * a);
  }
}
END_TEST

START_TEST(without_a_second_part_it_is_neo_hookean)
{
  const bw_pd_material_point m = rubber(BW_PD_MATERIAL_PLANE_STRESS, 0);
  const bw_pd_material_point other =
      bw_pd_material_elastic_point(m.plane, BW_PD_MATERIAL_NEO_HOOKEAN, 3, 0.4);
  lanes G[9], P[9], Q[9], V, W;
  same(DEFORMED, 1, G);
  bw_pd_material_stress(&m, G, P, &V);
  same(DEFORMED, 1, G);
  bw_pd_material_stress(&other, G, Q, &W);
  for (int q = 0; q < 9; q++)
    bw_check_near(P[q][2], Q[q][2], 1e-13);
  bw_check_near(V[0], W[0], 1e-13);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(stress_is_the_derivative_of_energy), BW_TEST(small_strains_are_those_of_hooke),
    BW_TEST(stretched_between_held_sides), BW_TEST(without_a_second_part_it_is_neo_hookean)};
BW_CHECK_MAIN("pd_material: an energy of one's own", tests)
