/* The kernels' defining properties for many shifts, and published second moments.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_kernel_delta.h"

enum { SHIFTS = 4001 };
/* a sum of at most four numbers below 1, each with a few rounding errors */
static const double ROUND_OFF = 1.0e-15;

typedef struct {
  double sum, even, first, second, squares;
} moments;

static moments moments_of(const bw_kernel_delta *k, double t)
{
  moments m = {0};
  for (int i = -5; i <= 5; i++) {
    const double w = k->phi(t - i);
    m.sum += w;
    m.even += i % 2 == 0 ? w : 0.0;
    m.first += (t - i) * w;
    m.second += (t - i) * (t - i) * w;
    m.squares += w * w;
  }
  return m;
}

static double shift(int q)
{
  return -2.0 + 4.0 * q / (SHIFTS - 1);
}

START_TEST(moments_hold_for_every_shift)
{
  for (int id = 0; id < BW_KERNEL_COUNT; id++) {
    const bw_kernel_delta *k = bw_kernel_delta_get((bw_kernel_delta_id)id);
    for (int q = 0; q < SHIFTS; q++) {
      const moments m = moments_of(k, shift(q));
      bw_check_near(m.sum, 1.0, ROUND_OFF);
      bw_check_near(m.first, 0.0, 2.0 * ROUND_OFF);
      if (k->sum_of_squares > 0.0) bw_check_near(m.squares, k->sum_of_squares, ROUND_OFF);
    }
  }
}
END_TEST

/* Peskin 2002 asks the 4-point kernel for equal weight on even and odd nodes (his eq. 6.12). */
START_TEST(four_point_kernel_balances_even_and_odd)
{
  for (int q = 0; q < SHIFTS; q++)
    bw_check_near(moments_of(bw_kernel_delta_get(BW_KERNEL_PESKIN4), shift(q)).even, 0.5,
                  ROUND_OFF);
}
END_TEST

/* Closed forms of the sum of squares of the hat: t^2 + (1-t)^2. */
START_TEST(hat_has_the_known_sum_of_squares)
{
  for (int q = 0; q <= 20; q++) {
    const double t = q / 20.0;
    const moments m = moments_of(bw_kernel_delta_get(BW_KERNEL_HAT2), t);
    bw_check_near(m.squares, t * t + (1.0 - t) * (1.0 - t), ROUND_OFF);
  }
}
END_TEST

/* A jump anywhere would show as a step that does not shrink with the interval; the slope of
 * every kernel is at most 1.5 away from square-root ends, where phi changes as sqrt(3 d)/3. */
START_TEST(continuous_even_and_zero_outside)
{
  static const double knots[] = {0.0, 0.5, 1.0, 1.5, 2.0};
  const double d = 1.0e-12, bound = 1.2 * sqrt(3.0 * d);
  for (int id = 0; id < BW_KERNEL_COUNT; id++) {
    const bw_kernel_delta *k = bw_kernel_delta_get((bw_kernel_delta_id)id);
    for (int q = 0; q < 5; q++) {
      bw_check_near(k->phi(knots[q] + d), k->phi(knots[q] - d), bound);
      ck_assert_double_eq(k->phi(knots[q]), k->phi(-knots[q]));
    }
    ck_assert_double_eq(k->phi(k->radius), 0.0);
    ck_assert_double_eq(k->phi(k->radius + 0.3), 0.0);
    ck_assert_double_eq(k->phi(-7.0), 0.0);
    ck_assert(k->phi(k->radius - 0.01) > 0.0); /* the radius is not larger than it must be */
  }
}
END_TEST

/* Roma, Peskin & Berger, J. Comput. Phys. 153 (1999) 509: moments evaluated independently. */
START_TEST(roma_second_moment_as_published)
{
  static const double row[][3] = {{0.00, 0.333333333, 0.666666667},
                                  {0.10, 0.328371407, 0.661628593},
                                  {0.25, 0.303704060, 0.633795940},
                                  {0.37, 0.273880407, 0.589219593},
                                  {0.50, 0.250000000, 0.500000000}};
  for (int q = 0; q < 5; q++) {
    const moments m = moments_of(bw_kernel_delta_get(BW_KERNEL_ROMA3), row[q][0]);
    bw_check_near(m.second, row[q][1], 6.0e-10); /* printed to nine digits */
    bw_check_near(m.even, row[q][2], 6.0e-10);
  }
}
END_TEST

/* Every node with phi != 0 is among the weights, at its place. */
START_TEST(weights_cover_the_support)
{
  static double s[SHIFTS], w[BW_KERNEL_MAX_SUPPORT * SHIFTS];
  static int first[SHIFTS];
  for (int q = 0; q < SHIFTS; q++)
    s[q] = 7.0 + shift(q);
  for (int id = 0; id < BW_KERNEL_COUNT; id++) {
    const bw_kernel_delta *k = bw_kernel_delta_get((bw_kernel_delta_id)id);
    bw_kernel_delta_weights(k, SHIFTS, s, first, w);
    for (int q = 0; q < SHIFTS; q++) {
      double sum = 0.0;
      for (int i = 0; i < k->support; i++) {
        /* vector and scalar code may differ in a fused rounding */
        bw_check_near(w[i * SHIFTS + q], k->phi(s[q] - (first[q] + i)), ROUND_OFF);
        sum += w[i * SHIFTS + q];
      }
      bw_check_near(sum, 1.0, ROUND_OFF);
      ck_assert(first[q] > s[q] - k->radius && first[q] + k->support - 1 <= s[q] + k->radius);
    }
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(moments_hold_for_every_shift),     BW_TEST(four_point_kernel_balances_even_and_odd),
    BW_TEST(hat_has_the_known_sum_of_squares), BW_TEST(continuous_even_and_zero_outside),
    BW_TEST(roma_second_moment_as_published),  BW_TEST(weights_cover_the_support)};
BW_CHECK_MAIN("kernel_delta", tests)
