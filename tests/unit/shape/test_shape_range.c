/* Ranges of sites and their parts: numbers beyond 32 bits, and what is refused.
 * TEST ranks=1,2 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <string.h>

#define BOX(...)                                                                                   \
  {                                                                                                \
    .kind = BW_SHAPE_BOX, __VA_ARGS__                                                              \
  }

typedef struct {
  int64_t n;
  int32_t *site;
  uint8_t *kind, *group;
} sites;

/* 2^48 sites: ranges, rows and cuts are right, and any small part can be filled. */
START_TEST(ranges_beyond_32_bits)
{
  const double side = 65536, origin[3] = {0};
  const bw_shape cube = BOX(.lower = {-side / 2, 0, 0}, .upper = {side / 2, side, side});
  const bw_shape_lattice l = bw_shape_lattice_straight(1.0, origin, false);
  int64_t lo[3], hi[3], first, rows, all = 0;
  bw_check_ok(bw_shape_range(1, &cube, &l, lo, hi));
  for (int d = 0; d < 3; d++)
    ck_assert_int_eq(hi[d] - lo[d], 65536);
  ck_assert_int_eq(lo[0], -32768);
  const int many[] = {1, 2, 3, 7, 1000003, INT32_MAX};
  for (int q = 0; q < 6; q++) {
    const int64_t even = ((int64_t)1 << 32) / many[q];
    int64_t next = 0;
    const int64_t step = many[q] <= 7 ? 1 : many[q] / 5;
    for (int64_t part = 0; part < many[q]; part += step) {
      bw_shape_part(lo, hi, (int)part, many[q], &first, &rows);
      ck_assert(rows == even || rows == even + 1);
      if (many[q] <= 7) ck_assert_int_eq(first, next);
      next = first + rows;
    }
    bw_shape_part(lo, hi, many[q] - 1, many[q], &first, &rows);
    ck_assert_int_eq(first + rows, (int64_t)1 << 32);
  }
  for (int part = 0; part < 5; part++) {
    bw_shape_part(lo, hi, part, 5, &first, &rows);
    all += rows * (hi[0] - lo[0]);
  }
  ck_assert_int_eq(all, (int64_t)1 << 48);
  int64_t n;
  bw_check_ok(bw_shape_count(1, &cube, &l, INT32_MAX - 1, INT32_MAX, &n));
  ck_assert_int_eq(n, 3 * 65536); /* 2^32 rows over 2^31 - 1 parts: 2, and 3 in the last */
  sites s;
  bw_check_ok(bw_shape_fill(1, &cube, &l, INT32_MAX - 1, INT32_MAX, &s.n, &s.site, &s.kind, NULL));
  ck_assert_int_eq(s.n, n);
  ck_assert_int_eq(s.site[3 * s.n - 3], 32767);
  ck_assert_int_eq(s.site[3 * s.n - 1], 65535);
  bw_release(&s.site);
  bw_release(&s.kind);
}
END_TEST

START_TEST(impossible_parts_and_axes_are_refused)
{
  sites s;
  int64_t lo[3], hi[3];
  const double origin[3] = {0};
  const bw_shape cube = BOX(.upper = {2, 2, 2});
  bw_shape nothing[2] = {cube, cube};
  nothing[1].remove = true;
  bw_shape_lattice l = bw_shape_lattice_straight(1.0, origin, false);
  bw_check_status(bw_shape_fill(1, &cube, &l, 3, 3, &s.n, &s.site, &s.kind, NULL), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no part 3 of 3"));
  ck_assert_ptr_null(s.site);
  bw_check_ok(bw_shape_fill(2, nothing, &l, 0, 2, &s.n, &s.site, &s.kind, NULL));
  ck_assert_int_eq(s.n, 0);
  bw_release(&s.site);
  bw_release(&s.kind);
  bw_check_status(
      bw_shape_fill_shared(bw_check_world(), 2, nothing, &l, &s.n, &s.site, &s.kind, &s.group),
      BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no site"));
  l.axes[0][0] = -1;
  bw_check_status(bw_shape_range(1, &cube, &l, lo, hi), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "left-handed"));
  l.axes[0][0] = 1.01;
  bw_check_status(bw_shape_range(1, &cube, &l, lo, hi), BW_EINPUT);
  bw_shape_turn((double[3]){1, 0, 0}, 0.5, l.axes);
  l.planar = true;
  bw_check_status(bw_shape_range(1, &cube, &l, lo, hi), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "about z"));
  l = bw_shape_lattice_straight(1e-9, origin, false);
  bw_check_status(bw_shape_range(1, &cube, &l, lo, hi), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "more than can be numbered"));
  l.ds = 5e-10;
  bw_check_status(bw_shape_range(1, &cube, &l, lo, hi), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "2^31"));
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(ranges_beyond_32_bits),
    BW_TEST(impossible_parts_and_axes_are_refused),
};
BW_CHECK_MAIN("shape.range", tests)
