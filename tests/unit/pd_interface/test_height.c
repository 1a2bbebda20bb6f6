/* Where the surface is above the particles, and how it bends.
 * BUILD modules=shape
 * TEST ranks=1,2,3 */
#include "body.h"

#include <math.h>

static const double pi_number = 3.14159265358979323846;

static const bw_shape ball[] = {
    {.kind = BW_SHAPE_SPHERE, .centre = {0.2, -0.3, 0.1}, .radius = 10.0},
};
static const bw_shape disc[] = {
    {.kind = BW_SHAPE_CYLINDER, .centre = {0.3, -0.2, 0}, .radius = 15.0, .axis = 2},
};

/* Means over the surface of radius and bend, the surface being H outside the centres along N, and
 * the scatter (rms) of the radius. */
static void roundness(const body *b, const double centre[3], int dims, double out[3])
{
  const bw_pd_surface s = bw_pd_interface_surface(b->pi);
  double sum[4] = {0.0, 0.0, 0.0, 0.0};
  for (size_t q = 0; q < s.n; q++) {
    double r2 = 0.0;
    ck_assert(s.smooth[q]);
    for (size_t d = 0; d < (size_t)dims; d++)
      r2 += pow(s.X[3 * q + d] + s.H[q] * s.N[3 * q + d] - centre[d], 2);
    sum[0] += s.A[q] * sqrt(r2);
    sum[1] += s.A[q] * s.bend[q];
    sum[2] += s.A[q];
    sum[3] += s.A[q] * r2;
  }
  bw_comm_sum(bw_check_world(), 4, sum);
  out[0] = sum[0] / sum[2];
  out[1] = sum[1] / sum[2];
  out[2] = sqrt(sum[3] / sum[2] - out[0] * out[0]);
}

/* Heights: round bodies are, in the mean, as large as their particles' own volume, where ds/2 above
 * each centre would be 0.08 (plane) and 0.13 ds (space) more (ERRATA 33): half of the
 * smaller. bend: 1/R, sqrt(2)/R; a fit over three spacings sees it to (3/R)^2, a tenth. Particles
 * of a staircase are at depths that spread evenly over about ds, and so scatter by ds/sqrt(12) each
 * by itself; the mean over a family has less than half of it. */
START_TEST(surfaces_have_their_heights_and_bends)
{
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  bw_solid_config c = body_config(false);
  const double scatter = 0.5 / sqrt(12.0);
  double seen[3];
  body b = body_create(1, ball, &c, &ic);
  roundness(&b, ball[0].centre, 3, seen);
  const double R = cbrt(3.0 * (double)b.n / (4.0 * pi_number));
  bw_check_near(seen[0], R, 0.04);
  bw_check_near(seen[1] * R, sqrt(2.0), 0.1 * sqrt(2.0));
  ck_assert_double_lt(seen[2], scatter);
  body_destroy(&b);
  c = body_config(true);
  b = body_create(1, disc, &c, &ic);
  roundness(&b, disc[0].centre, 2, seen);
  const double flat = sqrt((double)b.n / pi_number);
  bw_check_near(seen[0], flat, 0.04);
  bw_check_near(seen[1] * flat, 1.0, 0.1);
  ck_assert_double_lt(seen[2], scatter);
  body_destroy(&b);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(surfaces_have_their_heights_and_bends)};
BW_CHECK_MAIN("pd_interface.height", tests)
