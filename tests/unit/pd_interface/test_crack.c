/* Tip, branches, fork and angle of a crack drawn by hand.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_pd_crack.h"

/* A lattice 60 x 41 of spacing 0.5, rows dealt out to the ranks: a stem two rows thick along
 * y = 10 up to x = 10, from there two branches that part by +-1/2 in slope. */
typedef struct {
  size_t n;
  double *X0, *damage;
} plate;

static bool drawn(double x, double y)
{
  const double off = x < 10.0 ? 0.0 : 0.5 * (x - 10.0);
  return x < 25.0 && (fabs(y - 10.0 - off) < 0.5 || fabs(y - 10.0 + off) < 0.5);
}

static plate plate_create(void)
{
  const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  plate p = {0};
  bw_check_ok(BW_ALLOCATE(&p.X0, 3 * 60 * 40));
  bw_check_ok(BW_ALLOCATE(&p.damage, 60 * 40));
  for (int j = 0; j < 40; j++)
    for (int i = 0; i < 60; i++) {
      if (j % size != me) continue;
      const double x = 0.5 * (i + 0.5), y = 0.5 * (j + 0.5);
      p.X0[3 * p.n] = x, p.X0[3 * p.n + 1] = y;
      p.damage[p.n++] = drawn(x, y) ? 0.4 : 0.3;
    }
  return p;
}

START_TEST(a_drawn_fork_is_measured)
{
  plate p = plate_create();
  const bw_pd_crack_config c = bw_pd_crack_config_default();
  bw_pd_crack k;
  bw_check_ok(bw_pd_crack_collect(bw_check_world(), &c, p.n, p.X0, p.damage, &k));
  bw_check_near(k.s[k.n - 1], 24.75, 1e-12);
  for (size_t q = 1; q < k.n; q++)
    ck_assert(k.s[q] > k.s[q - 1] || (k.s[q] == k.s[q - 1] && k.t[q] > k.t[q - 1]));
  const double gap = 0.75;
  double middle[2];
  ck_assert_int_eq(bw_pd_crack_branches(&k, 5.25, 0.25, gap, 2, middle), 1);
  bw_check_near(middle[0], 10.0, 1e-12);
  ck_assert_int_eq(bw_pd_crack_branches(&k, 20.25, 0.25, gap, 2, middle), 2);
  bw_check_near(middle[0], 10.0 - 0.5 * 10.25, 0.26);
  bw_check_near(middle[1], 10.0 + 0.5 * 10.25, 0.26);
  ck_assert_int_eq(bw_pd_crack_branches(&k, 27.25, 0.25, gap, 2, middle), 0);
  /* two rows about each branch: parted by a sound one when 2 off > 2 rows + gap, x ~ 11.5 */
  bw_check_near(bw_pd_crack_fork(&k, 0.25, 0.5, 3, gap), 11.5, 0.05);
  bw_check_near(bw_pd_crack_angle(&k, 12.25, 24.75, 0.5, gap), 2 * atan(0.5), 0.03);
  ck_assert(isnan(bw_pd_crack_angle(&k, 2.25, 8.75, 0.5, gap)));
  ck_assert(isnan(bw_pd_crack_fork(&k, 20.25, 0.5, 20, gap)));
  bw_pd_crack_release(&k);
  bw_release(&p.X0);
  bw_release(&p.damage);
}
END_TEST

START_TEST(no_crack_is_no_crack)
{
  plate p = plate_create();
  bw_pd_crack_config c = bw_pd_crack_config_default();
  c.level = 0.5;
  bw_pd_crack k;
  bw_check_ok(bw_pd_crack_collect(bw_check_world(), &c, p.n, p.X0, p.damage, &k));
  ck_assert_uint_eq(k.n, 0);
  ck_assert_int_eq(bw_pd_crack_branches(&k, 5.0, 1.0, 1.0, 0, NULL), 0);
  ck_assert(isnan(bw_pd_crack_fork(&k, 0.0, 0.5, 2, 1.0)));
  bw_pd_crack_release(&k);
  bw_release(&p.X0);
  bw_release(&p.damage);
}
END_TEST

/* Eleven steps of (4, -3)/5 from (1, 2), each with a partner 0.1 to either side; two strangers out
 * of the window and one that is not joined lie beside. */
START_TEST(a_drawn_path_is_followed)
{
  double s[64], t[64];
  size_t n = 0;
  for (int k = 0; k <= 10; k++)
    for (int side = -1; side <= 1; side += 2) {
      s[n] = 1.0 + 0.8 * k + 0.06 * side;
      t[n++] = 2.0 - 0.6 * k + 0.08 * side;
    }
  s[n] = 9.9, t[n++] = 9.0;
  s[n] = 1.0, t[n++] = 4.0;
  s[n] = 2.0, t[n++] = 6.0;
  for (size_t a = 0; a < n; a++) /* by rising s, as collected ones are */
    for (size_t b = a + 1; b < n; b++)
      if (s[b] < s[a]) {
        const double keep[2] = {s[a], t[a]};
        s[a] = s[b], t[a] = t[b];
        s[b] = keep[0], t[b] = keep[1];
      }
  bw_pd_crack k = {n, s, t};
  const double lower[2] = {0.0, -10.0}, upper[2] = {9.5, 5.0};
  bw_pd_crack_crop(&k, lower, upper);
  ck_assert_uint_eq(k.n, 23);
  bw_check_near(bw_pd_crack_reach(&k, 1.0, 2.0, NULL), sqrt(100.0 + 0.01), 1e-12);
  bw_check_ok(bw_pd_crack_join(&k, 1.0, 2.0, 1.05));
  ck_assert_uint_eq(k.n, 22);
  bw_check_ok(bw_pd_crack_join(&k, 9.0, -4.0, 1.05)); /* from its other end: against rising s */
  ck_assert_uint_eq(k.n, 22);
  double tip[2] = {0.0, 0.0};
  (void)bw_pd_crack_reach(&k, 1.0, 2.0, tip);
  bw_check_near(fabs(tip[0] - 9.0) + fabs(tip[1] + 4.0), 0.14, 1e-12);
  const bw_pd_crack_line line = bw_pd_crack_fit(&k, 1.0, 2.0, 0.5, 20.0);
  ck_assert_uint_eq(line.n, 20);
  bw_check_near(line.angle, -atan2(3.0, 4.0), 1e-12);
  bw_check_near(line.width, 0.1, 1e-12);
  const bw_pd_crack_line back = bw_pd_crack_fit(&k, 10.0, -4.7, 0.5, 20.0);
  bw_check_near(back.angle, acos(-1.0) - atan2(3.0, 4.0), 1e-12);
  const bw_pd_crack_line few = bw_pd_crack_fit(&k, 1.0, 2.0, 9.5, 20.0);
  ck_assert(isnan(few.angle) && isnan(few.width));
  bw_check_ok(bw_pd_crack_join(&k, 50.0, 50.0, 1.0));
  ck_assert_uint_eq(k.n, 0);
  ck_assert(isnan(bw_pd_crack_reach(&k, 1.0, 2.0, tip)));
}
END_TEST

/* A tip of steady speed v seen from particle to particle, looked for every dt; before it goes on,
 * one a little farther beside it cracks. */
static void track_steady(bw_pd_crack_track *track, double v, double ds, double dt, double to)
{
  for (int k = 0; k * dt < to; k++) {
    const double way = v * k * dt / ds, beside = way - floor(way) > 0.8 ? 0.1 : 0.0;
    bw_check_ok(bw_pd_crack_track_note(track, k * dt, ds * (floor(way) + beside)));
  }
}

/* What a window that starts and ends anywhere would give. */
static double highest_between_moments(const bw_pd_crack_track *track, double window, double dt,
                                      double to)
{
  double most = 0.0;
  for (double t = window; t < to; t += dt)
    most = fmax(most, bw_pd_crack_speed_at(track, window, t));
  return most;
}

START_TEST(a_steady_tip_has_its_speed)
{
  const double ds = 0.5, dt = 0.01;
  for (double v = 1.05; v < 2.5; v += 0.19) {
    bw_pd_crack_track track = {.step = 0.5 * ds};
    track_steady(&track, v, ds, dt, 40.0);
    /* arrivals are known to dt: v dt of the way v window */
    bw_check_near(bw_pd_crack_speed(&track, 2.0, NAN), v, v * dt / 2.0);
    /* any two moments: a whole number of ds in the window, the next above v */
    bw_check_near(highest_between_moments(&track, 2.0, dt, 40.0), ds / 2.0 * ceil(v * 2.0 / ds),
                  1e-9);
    bw_pd_crack_track_release(&track);
  }
}
END_TEST

START_TEST(the_fastest_stretch_is_found)
{
  bw_pd_crack_track track = {0};
  ck_assert_double_eq(bw_pd_crack_speed(&track, 1.0, NAN), 0.0);
  ck_assert_double_eq(bw_pd_crack_speed_at(&track, 1.0, 5.0), 0.0);
  const double time[] = {0, 1, 2, 2.5, 3, 3.5, 4, 6}, place[] = {0, 1, 2, 3, 4, 5, 5, 7};
  for (int k = 0; k < 8; k++)
    bw_check_ok(bw_pd_crack_track_note(&track, time[k], place[k]));
  ck_assert_uint_eq(track.n, 7); /* it did not move at 4 */
  bw_check_near(bw_pd_crack_speed(&track, 1.0, NAN), 2.0, 1e-12);
  bw_check_near(bw_pd_crack_speed(&track, 1.0, 2.5), 4.0 / 3.0,
                1e-12); /* 1 to 2.5: one more than 1 */
  bw_check_near(bw_pd_crack_speed(&track, 3.5, NAN), 5.0 / 3.5, 1e-12);
  ck_assert_double_eq(bw_pd_crack_speed(&track, 10.0, NAN), 0.0);
  bw_check_near(bw_pd_crack_speed_at(&track, 2.0, 4.2), 1.5, 1e-12); /* 5 less 2 */
  bw_pd_crack_track_release(&track);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_drawn_fork_is_measured), BW_TEST(no_crack_is_no_crack),
    BW_TEST(a_drawn_path_is_followed), BW_TEST(a_steady_tip_has_its_speed),
    BW_TEST(the_fastest_stretch_is_found)};
BW_CHECK_MAIN("pd_interface.crack", tests)
