/* Families: how many directions, their volume fractions, bonds of a block.
 * TEST ranks=1,2,3,4 */
#include "pd_test.h"

static bw_solid *single(bw_pd_geometry geometry, double m, bw_pd_volume_fraction fraction)
{
  bw_solid_config c = pd_soft(geometry);
  pd_body one = pd_box(1, 1, 1);
  c.horizon_ratio = m;
  c.volume_fraction = fraction;
  bw_solid *pd = pd_make(bw_check_world(), &c, &one);
  pd_body_release(&one);
  return pd;
}

/* Lattice points within sqrt(n) of the origin, without it: n = 12 has 178 in space (OEIS A117609)
 * and 36 in the plane (A057655); n = 9 has 122. |xi| < 3.5 ds means n < 12.25. */
START_TEST(directions_are_the_lattice_points_of_the_ball)
{
  bw_solid *pd = single(BW_PD_3D, 3, BW_PD_FRACTION_DEFAULT);
  ck_assert_int_eq(bw_solid_max_family(pd), 178);
  bw_solid_destroy(&pd);
  pd = single(BW_PD_PLANE_STRESS, 3, BW_PD_FRACTION_DEFAULT);
  ck_assert_int_eq(bw_solid_max_family(pd), 36);
  bw_solid_destroy(&pd);
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body one = pd_box(1, 1, 1);
  c.horizon_ratio = 3.015;
  c.family_reach = BW_PD_REACH_HORIZON;
  pd = pd_make(bw_check_world(), &c, &one);
  ck_assert_int_eq(bw_solid_max_family(pd), 122);
  pd_body_release(&one);
  bw_solid_destroy(&pd);
}
END_TEST

/* POROUS 3.3.5: the fraction of sub-cells whose centre is inside, which is off by at most the
 * cells the surface passes, some 3 parts in n. */
static double counted_fraction(double m, const double o[3], bool planar, int n)
{
  int64_t inside = 0;
  for (int z = 0; z < (planar ? 1 : n); z++)
    for (int y = 0; y < n; y++)
      for (int x = 0; x < n; x++) {
        const double p[3] = {o[0] + (x + 0.5) / n - 0.5, o[1] + (y + 0.5) / n - 0.5,
                             planar ? 0 : o[2] + (z + 0.5) / n - 0.5};
        inside += p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= m * m;
      }
  return (double)inside / ((double)n * n * (planar ? 1 : n));
}

static void compare_with_count(bw_pd_geometry geometry, double m)
{
  const bool planar = geometry != BW_PD_3D;
  const int n = planar ? 200 : 40;
  bw_solid *pd = single(geometry, m, BW_PD_FRACTION_EXACT);
  for (int q = 0; q < bw_solid_max_family(pd); q++) {
    const double *xi = bw_solid_stencil_offset(pd, q);
    const double o[3] = {xi[0] / 0.5, xi[1] / 0.5, xi[2] / 0.5};
    bw_check_near(bw_solid_stencil_fraction(pd, q), counted_fraction(m, o, planar, n), 3.0 / n);
  }
  bw_solid_destroy(&pd);
}

START_TEST(exact_fractions_agree_with_counted_cells)
{
  compare_with_count(BW_PD_3D, 2);
  compare_with_count(BW_PD_3D, 3.015);
  compare_with_count(BW_PD_PLANE_STRESS, 3);
  compare_with_count(BW_PD_PLANE_STRAIN, 1.6);
}
END_TEST

static double fraction_of(const bw_solid *pd, double x, double y, double z)
{
  for (int q = 0; q < bw_solid_max_family(pd); q++) {
    const double *xi = bw_solid_stencil_offset(pd, q);
    if (fabs(xi[0] / 0.5 - x) + fabs(xi[1] / 0.5 - y) + fabs(xi[2] / 0.5 - z) < 1e-9)
      return bw_solid_stencil_fraction(pd, q);
  }
  return NAN;
}

/* The cell centred on the horizon, m = 3. Plane: the integral of sqrt(9 - y^2) - 5/2 over
 * |y| < 1/2. Space: 1/2 - <s2>/6 - <s2^2>/216 - <s2^3>/3888 - ..., s2 = y^2 + z^2 over the unit
 * square, with means 1/6, 7/180 and 3/280; the next term is below 1e-7. Linear: 1/2 (3.33). */
START_TEST(fraction_of_the_cell_on_the_horizon)
{
  bw_solid *pd = single(BW_PD_PLANE_STRESS, 3, BW_PD_FRACTION_EXACT);
  bw_check_near(fraction_of(pd, 0, -3, 0), 0.5 * sqrt(8.75) + 9 * asin(1.0 / 6) - 2.5, 1e-12);
  bw_solid_destroy(&pd);
  pd = single(BW_PD_3D, 3, BW_PD_FRACTION_EXACT);
  const double series = 0.5 - 1.0 / 36 - 7.0 / 180 / 216 - 3.0 / 280 / 3888;
  bw_check_near(fraction_of(pd, 0, 0, 3), series, 1e-7);
  bw_solid_destroy(&pd);
  pd = single(BW_PD_PLANE_STRESS, 3, BW_PD_FRACTION_LINEAR);
  bw_check_near(fraction_of(pd, 3, 0, 0), 0.5, 1e-12);
  bw_check_near(fraction_of(pd, 2, 2, 0), 3.5 - sqrt(8.0), 1e-12);
  bw_check_near(fraction_of(pd, 3, 1, 0), 3.5 - sqrt(10.0), 1e-12); /* ERRATA 2: beyond 3 */
  bw_check_near(fraction_of(pd, 2, 1, 0), 1, 1e-12);
  bw_solid_destroy(&pd);
}
END_TEST

/* All fractions and the cell itself fill the ball, but for the corners of cells whose centre is
 * beyond m + 1/2: a quarter of a per cent at m = 3, less at 5. */
START_TEST(fractions_fill_the_ball)
{
  const double pi = acos(-1.0);
  for (double m = 3; m < 6; m += 2) {
    bw_solid *pd = single(BW_PD_3D, m, BW_PD_FRACTION_EXACT);
    double sum = 1;
    for (int q = 0; q < bw_solid_max_family(pd); q++)
      sum += bw_solid_stencil_fraction(pd, q);
    const double ball = 4.0 / 3 * pi * m * m * m;
    ck_assert_double_le(sum, ball * (1 + 1e-9));
    ck_assert_double_ge(sum, ball * (1 - 0.0025));
    bw_solid_destroy(&pd);
  }
}
END_TEST

/* A block of a x b x c has sum over directions of (a - |dx|)(b - |dy|)(c - |dz|) directed bonds. */
START_TEST(bonds_of_a_block)
{
  const int size[3] = {11, 5, 7};
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body body = pd_box(size[0], size[1], size[2]);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  int64_t expected = 0;
  for (int z = -3; z <= 3; z++)
    for (int y = -3; y <= 3; y++)
      for (int x = -3; x <= 3; x++)
        if (x * x + y * y + z * z > 0 && x * x + y * y + z * z <= 12)
          expected += (size[0] - abs(x)) * (size[1] - abs(y)) * (size[2] - abs(z));
  ck_assert_int_eq(ledger_of(pd).bonds, expected / 2);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Links of every particle point where they say, through copies of other ranks too. */
static void check_links(bw_solid *pd, const double period[3])
{
  const bw_pd_extended all = bw_solid_get_extended(pd);
  bw_pd_link *link = NULL;
  int64_t *id = NULL, found = 0;
  bw_check_ok(BW_ALLOCATE(&link, (size_t)bw_solid_max_family(pd)));
  bw_check_ok(BW_ALLOCATE(&id, all.n));
  bw_solid_fill_extended(pd, sizeof *id, bw_solid_id(pd), id);
  for (size_t e = 0; e < all.n; e++)
    ck_assert_int_eq(id[e], all.id[e]);
  for (size_t h = 0; h < bw_solid_count(pd); h++) {
    const int n = bw_solid_links(pd, h, link);
    found += n;
    for (int q = 0; q < n; q++) {
      const double *xi = bw_solid_stencil_offset(pd, link[q].slot);
      ck_assert(link[q].intact);
      for (int k = 0; k < 3; k++)
        bw_check_near(all.X[3 * link[q].neighbour + k] - all.X[3 * h + (size_t)k], xi[k],
                      64 * BW_REAL_EPSILON);
    }
  }
  bw_comm_sum_int(bw_solid_comm(pd), 1, &found);
  if (period[0] > 0) ck_assert_int_eq(found, bw_solid_total(pd) * bw_solid_max_family(pd));
  ck_assert_int_eq(found, 2 * ledger_of(pd).bonds);
  bw_release(&link);
  bw_release(&id);
}

START_TEST(links_lead_to_neighbours)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body body = pd_box(9, 4, 5);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  check_links(pd, c.period);
  bw_solid_destroy(&pd);
  c.period[0] = 4.5, c.period[1] = 2, c.period[2] = 2.5;
  pd = pd_make(bw_check_world(), &c, &body);
  check_links(pd, c.period);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Scattered particles far apart: hash tables and packed numbering instead of boxes. */
START_TEST(sparse_bodies_work)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body body = pd_box(5, 4, 6);
  for (int64_t q = 0; q < body.n; q++)
    if (body.site[3 * q] > 2)
      body.site[3 * q] += 300000, body.site[3 * q + 1] += 4000, body.site[3 * q + 2] -= 5000;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  int64_t expected = 0;
  for (int64_t a = 0; a < body.n; a++)
    for (int64_t b = 0; b < body.n; b++) {
      double r2 = 0;
      for (int k = 0; k < 3; k++)
        r2 += pow(body.site[3 * a + k] - body.site[3 * b + k], 2);
      expected += r2 > 0 && r2 < 12.25;
    }
  ck_assert_int_eq(2 * ledger_of(pd).bonds, expected);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(directions_are_the_lattice_points_of_the_ball),
                                      BW_TEST(exact_fractions_agree_with_counted_cells),
                                      BW_TEST(fraction_of_the_cell_on_the_horizon),
                                      BW_TEST(fractions_fill_the_ball),
                                      BW_TEST(bonds_of_a_block),
                                      BW_TEST(links_lead_to_neighbours),
                                      BW_TEST(sparse_bodies_work)};
BW_CHECK_MAIN("pd_bond.family", tests)
