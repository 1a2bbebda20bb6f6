/* Random packs of balls.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape_pack.h"

#include <string.h>

static bw_shape_pack_config pack_config(bool planar)
{
  bw_shape_pack_config c = bw_shape_pack_config_default();
  for (int d = 0; d < 3; d++)
    c.lower[d] = 1, c.upper[d] = 11, c.periodic[d] = d == 0;
  c.radius_min = 0.6, c.radius_max = 0.9;
  c.gap = 0.05, c.fraction = 0.25, c.planar = planar;
  return c;
}

/* Nearest distance of any two, images too, is the gap; the fraction is reached and not by more than
 * a ball; images are what crosses the periodic sides. */
static void check_pack(bool planar)
{
  const bw_shape_pack_config c = pack_config(planar);
  int balls, count;
  bw_shape *s = NULL;
  bw_check_ok(bw_shape_pack_spheres(&c, &balls, &count, &s));
  const double pi = acos(-1.0), box = planar ? 100 : 1000;
  double filled = 0, last = 0;
  int crossing = 0;
  for (int a = 0; a < count; a++) {
    for (int b = 0; b < a; b++) {
      double d2 = 0;
      for (int d = 0; d < (planar ? 2 : 3); d++)
        d2 += pow(s[a].centre[d] - s[b].centre[d], 2);
      ck_assert_double_ge(sqrt(d2), s[a].radius + s[b].radius + c.gap - 1e-12);
    }
    /* an image reaches into the box from outside */
    ck_assert(s[a].centre[0] > 1 - s[a].radius && s[a].centre[0] < 11 + s[a].radius);
    ck_assert(a < balls || s[a].centre[0] < 1 || s[a].centre[0] > 11);
    if (a >= balls) continue;
    last = planar ? pi * pow(s[a].radius, 2) : 4.0 / 3 * pi * pow(s[a].radius, 3);
    filled += last;
    crossing += s[a].centre[0] - s[a].radius < 1 || s[a].centre[0] + s[a].radius > 11;
    ck_assert(s[a].radius >= 0.6 && s[a].radius <= 0.9);
  }
  ck_assert(filled >= 0.25 * box && filled - last < 0.25 * box);
  ck_assert_int_eq(count - balls, crossing);
  ck_assert_int_gt(crossing, 0);
  bw_release(&s);
}

START_TEST(packs_keep_their_distance)
{
  check_pack(false);
  check_pack(true);
}
END_TEST

static void refuse_pack(const bw_shape_pack_config *c, const char *word)
{
  int balls, count;
  bw_shape *s = NULL;
  bw_check_status(bw_shape_pack_spheres(c, &balls, &count, &s), BW_EINPUT);
  ck_assert_ptr_null(s);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "message \"%s\" lacks \"%s\"",
                bw_last_message(), word);
}

START_TEST(impossible_packs_are_refused_by_name)
{
  const bw_shape_pack_config good = pack_config(false);
  bw_shape_pack_config c = good;
  c.fraction = 0.7, c.max_attempts = 2000;
  refuse_pack(&c, "no place");
  c = good, c.radius_min = NAN;
  refuse_pack(&c, "radius_min = nan");
  c = good, c.radius_max = 0.5;
  refuse_pack(&c, "radius_max = 0.5");
  c = good, c.upper[1] = 1;
  refuse_pack(&c, "upper[1] = 1");
  c = good, c.upper[0] = 2.5;
  refuse_pack(&c, "would meet itself");
  c = good, c.gap = INFINITY;
  refuse_pack(&c, "gap = inf");
  c = good, c.fraction = 0;
  refuse_pack(&c, "fraction = 0");
  c = good, c.max_attempts = 0;
  refuse_pack(&c, "max_attempts = 0");
  c = good, c.radius_min = 1e-6;
  refuse_pack(&c, "too many");
}
END_TEST

START_TEST(packs_follow_their_seed)
{
  bw_shape_pack_config c = pack_config(false);
  int balls, count;
  bw_shape *s[3] = {NULL};
  for (int q = 0; q < 3; q++) {
    c.seed = q < 2 ? 5 : 6;
    bw_check_ok(bw_shape_pack_spheres(&c, &balls, &count, &s[q]));
  }
  for (int d = 0; d < 3; d++) {
    ck_assert_double_eq(s[0][7].centre[d], s[1][7].centre[d]);
    ck_assert_double_ne(s[0][7].centre[d], s[2][7].centre[d]);
  }
  for (int q = 0; q < 3; q++)
    bw_release(&s[q]);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(packs_keep_their_distance),
                                      BW_TEST(packs_follow_their_seed),
                                      BW_TEST(impossible_packs_are_refused_by_name)};
BW_CHECK_MAIN("shape.pack", tests)
