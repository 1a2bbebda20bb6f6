/* Disordered clouds: where the particles are and which are bonds, by enumeration of pairs.
 * BUILD modules=solid_tools
 * TEST ranks=1,2,3,4 */
#include "bw_solid_stress.h"
#include "ledger.h"
#include "pd_cloud.h"

#include <string.h>

/* Off their sites by at most 0.3 ds and in the mean not at all; the same for a part of the body,
 * other with another seed. Pushing leaves hardly anybody near a neighbour: half of what two lack is
 * taken from either four times, third ones in the way; but for one in ten they are 0.8 ds apart. */
START_TEST(places_are_of_the_sites_alone)
{
  for (int g = 0; g < 2; g++) {
    bw_solid_config c = cloudy((bw_pd_geometry)g);
    pd_body body = pd_box(12, 10, g == 0 ? 8 : 1), part = body;
    part.n = body.n / 3;
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    bw_solid *few = pd_make(bw_check_world(), &c, &part);
    c.disorder_seed = 5;
    bw_solid *others = pd_make(bw_check_world(), &c, &part);
    double *X = rows_of(pd, bw_solid_get_reference), *Y = rows_of(few, bw_solid_get_reference);
    double *Z = rows_of(others, bw_solid_get_reference), middle[3] = {0}, moved = 0, d[3];
    int64_t near = 0;
    for (int64_t q = 0; q < body.n; q++) {
      double at[3] = {0}, nearest = INFINITY;
      for (int k = 0; k < (g == 0 ? 3 : 2); k++)
        at[k] = 0.5 * (body.site[3 * q + k] + 0.5);
      ck_assert_double_le(apart(&c, at, X + 3 * q, d) / 0.5, DISORDER + 20 * BW_REAL_EPSILON);
      for (int k = 0; k < 3; k++)
        middle[k] += d[k] / 0.5 / (double)body.n;
      for (int64_t p = 0; p < body.n; p++)
        if (p != q) nearest = fmin(nearest, apart(&c, X + 3 * p, X + 3 * q, d) / 0.5);
      near += nearest < 0.8;
    }
    ck_assert_int_lt(10 * near, body.n);
    for (int k = 0; k < 3; k++)
      bw_check_near(middle[k], 0, 4 * DISORDER / sqrt((double)body.n));
    for (int64_t q = 0; q < 3 * part.n; q++) {
      ck_assert_double_eq(X[q], Y[q]);
      moved += fabs(X[q] - Z[q]);
    }
    ck_assert_double_gt(moved, 0.1 * (double)part.n * 0.5 * DISORDER);
    bw_solid_destroy(&pd);
    bw_solid_destroy(&few);
    bw_solid_destroy(&others);
    bw_release(&X);
    bw_release(&Y);
    bw_release(&Z);
    pd_body_release(&body);
  }
}
END_TEST

/* All pairs nearer than m + 1/2 are bonds, no others; through periods too. */
static void check_bonds(bw_solid_config c, int nx, int ny, int nz)
{
  pd_body body = pd_box(nx, ny, nz);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  double *X = rows_of(pd, bw_solid_get_reference), d[3];
  int64_t expected = 0;
  for (int64_t a = 0; a < body.n; a++)
    for (int64_t b = 0; b < a; b++)
      expected += apart(&c, X + 3 * a, X + 3 * b, d) < c.ds * (c.horizon_ratio + 0.5);
  ck_assert_int_eq(ledger_of(pd).bonds, expected);
  bw_release(&X);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(bonds_are_the_pairs_in_reach)
{
  check_bonds(cloudy(BW_PD_3D), 9, 7, 6);
  check_bonds(cloudy(BW_PD_PLANE_STRESS), 14, 9, 1);
  bw_solid_config c = cloudy(BW_PD_3D);
  c.disorder = 0.4, c.horizon_ratio = 2;
  c.period[0] = 4.5, c.period[2] = 4;
  check_bonds(c, 9, 7, 8);
}
END_TEST

/* A line at height 2.2, among the particles of row 4, cuts the bonds that cross it left of its tip:
 * those between true places. */
START_TEST(precracks_see_the_true_places)
{
  const double y = 2.2, tip = 3.3;
  bw_solid_config c = cloudy(BW_PD_PLANE_STRESS);
  pd_body body = pd_box(13, 9, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  double *X = rows_of(pd, bw_solid_get_reference), d[3];
  int64_t expected = 0;
  for (int64_t a = 0; a < body.n; a++)
    for (int64_t b = 0; b < a; b++) {
      if (!(apart(&c, X + 3 * a, X + 3 * b, d) < 1.75)) continue;
      const double t = (y - X[3 * a + 1]) / d[1];
      expected += t > 0 && t < 1 && X[3 * a] + t * d[0] <= tip;
    }
  const int64_t before = ledger_of(pd).bonds;
  bw_check_ok(bw_solid_precrack(pd, (double[]){-1, y, 0}, (double[]){tip, y, 0}, NULL));
  ck_assert_int_gt(expected, 100);
  ck_assert_int_eq(before - ledger_of(pd).bonds, expected);
  bw_release(&X);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Calibrated, a periodic cloud has the bulk modulus and V_0 asked for in the mean of its families,
 * to the scatter of a few hundred of them. */
static void dilate(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = 1e-4 * X0[k];
}

START_TEST(calibration_takes_the_mean_family)
{
  bw_solid_config c = cloudy(BW_PD_PLANE_STRESS);
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.period[0] = c.period[1] = 15;
  pd_body body = pd_box(30, 30, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const size_t n = bw_solid_count(pd);
  double *X = NULL, *stress = NULL, sum[2] = {0};
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&stress, 6 * n));
  pd_set(pd, dilate, NULL);
  bw_solid_stress_compute(pd, NULL, stress);
  bw_solid_get_reference(pd, X);
  for (size_t i = 0; i < n; i++) {
    bool middle = true; /* images of a dilated body do not follow it */
    for (size_t k = 0; k < 2; k++)
      middle = middle && X[3 * i + k] > 2.2 && X[3 * i + k] < 12.8;
    if (middle) sum[0] += 0.5 * (stress[6 * i] + stress[6 * i + 1]), sum[1]++;
  }
  bw_comm_sum(bw_check_world(), 2, sum);
  /* E/(1 - nu) e; a family of 36 random bonds scatters by some 3 %, the mean of 440 by 0.2 % */
  bw_check_near(sum[0] / sum[1] / (1.5 * 3 * 1e-4), 1, 0.006);
  bw_release(&X);
  bw_release(&stress);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

START_TEST(impossible_clouds_are_refused)
{
  pd_body body = pd_box(3, 3, 3);
  const struct {
    double disorder, m;
    bw_pd_volume_fraction fraction;
    const char *word;
  } bad[] = {{-0.1, 3, BW_PD_FRACTION_DEFAULT, "disorder = -0.1"},
             {0.5, 3, BW_PD_FRACTION_DEFAULT, "disorder = 0.5"},
             {NAN, 3, BW_PD_FRACTION_DEFAULT, "disorder"},
             {0.3, 1, BW_PD_FRACTION_DEFAULT, "horizon_ratio"},
             {0.3, 3, BW_PD_FRACTION_EXACT, "volume_fraction"}};
  for (size_t q = 0; q < sizeof bad / sizeof *bad; q++) {
    bw_solid_config c = pd_soft(BW_PD_3D);
    bw_solid *pd = NULL;
    c.disorder = bad[q].disorder, c.horizon_ratio = bad[q].m, c.volume_fraction = bad[q].fraction;
    bw_check_status(bw_solid_create_same(bw_check_world(), &c, body.n, body.site, NULL, &pd),
                    BW_EINPUT);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), bad[q].word));
  }
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(places_are_of_the_sites_alone), BW_TEST(bonds_are_the_pairs_in_reach),
    BW_TEST(precracks_see_the_true_places), BW_TEST(calibration_takes_the_mean_family),
    BW_TEST(impossible_clouds_are_refused)};
BW_CHECK_MAIN("pd_bond.cloud", tests)
