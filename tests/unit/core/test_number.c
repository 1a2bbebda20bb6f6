/* Whole numbers from floating ones: what is out of range is refused and changes nothing.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_number.h"

#include <limits.h>
#include <math.h>

START_TEST(out_of_range_is_refused)
{
  static const double never[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e19, -9.3e18};
  int i = 7;
  int64_t n = 7;
  for (size_t q = 0; q < sizeof never / sizeof *never; q++) {
    ck_assert(!bw_to_int(never[q], &i));
    ck_assert(!bw_to_int64(never[q], &n));
    ck_assert(!bw_divides(never[q], 1.0, &n));
  }
  ck_assert(!bw_to_int((double)INT_MAX + 1.0, &i));
  ck_assert(!bw_to_int((double)INT_MIN - 1.0, &i));
  ck_assert(!bw_to_int64(9007199254740994.0, &n));
  ck_assert(!bw_divides(1.0, 0.0, &n));
  ck_assert(!bw_divides(1.0, 3.0, &n));  /* less than one */
  ck_assert(!bw_divides(1.0, 0.3, &n));  /* no whole number */
  ck_assert(!bw_divides(1e13, 1.0, &n)); /* more than anybody can wait for */
  ck_assert(!bw_divides(-4.0, 1.0, &n));
  ck_assert_int_eq(i, 7);
  ck_assert_int_eq(n, 7);
}
END_TEST

START_TEST(nearest_whole_number)
{
  int i = 0;
  int64_t n = 0;
  ck_assert(bw_to_int(-2.6, &i) && i == -3);
  ck_assert(bw_to_int(INT_MAX, &i) && i == INT_MAX);
  ck_assert(bw_to_int64(9007199254740992.0, &n) && n == INT64_C(9007199254740992));
  ck_assert(bw_divides(0.3, 0.1, &n) && n == 3); /* 2.9999999999999996 */
  ck_assert(bw_divides(1e12, 1.0, &n) && n == BW_MOST_STEPS);
  /* 1e-9 of the ratio, however large that is. */
  ck_assert(bw_divides(1e6 * (1.0 + 1e-10), 1.0, &n) && n == 1000000);
  ck_assert(!bw_divides(1e6 * (1.0 + 1e-8), 1.0, &n));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(out_of_range_is_refused),
                                      BW_TEST(nearest_whole_number)};
BW_CHECK_MAIN("core.number", tests)
