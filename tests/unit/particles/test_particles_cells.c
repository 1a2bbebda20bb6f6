/* Cells of moving points against a comparison of all pairs: with and without periods, of few and of
 * many cells; the order of the lists; points that are lost.
 * TEST ranks=1 */
#include "bw_particles_cells.h"
#include "particles_test.h"

enum { MOST = 1500 };

static double y[3 * MOST];

/* n points over a box of these edges, some beyond it by a few times its length. */
static void scatter(size_t n, const double size[3])
{
  for (size_t q = 0; q < 3 * n; q++) {
    y[q] = size[q % 3] * (fraction_of(q) - 0.3);
    if (q / 3 % 10 == 0) y[q] += size[q % 3] * floor(5 * fraction_of(q + 77777) - 2);
  }
}

static bool nearer(const double period[3], const double a[3], const double b[3], double r)
{
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    double d = fabs(b[k] - a[k]);
    if (period[k] > 0) d = fabs(d - period[k] * rint(d / period[k]));
    sum += d * d;
  }
  return sum < r * r;
}

static int rising(const void *a, const void *b)
{
  const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
  return (p > q) - (p < q);
}

/* Neighbours of the points from `first` on among themselves; returns how many pairs there are. */
static size_t check_pairs_from(size_t first, size_t n, double r, const double period[3])
{
  bw_particles_cells g;
  static int32_t near[MOST];
  size_t pairs = 0, found;
  bw_check_ok(bw_particles_cells_create(n, y, r, period, &g));
  for (size_t i = first; i < n; i++) {
    bw_check_ok(bw_particles_cells_near(&g, y, y + 3 * i, r, MOST, near, &found));
    qsort(near, found, sizeof *near, rising);
    size_t at = 0;
    while (at < found && near[at] < (int32_t)first)
      at++;
    pairs += found - at;
    for (size_t j = first; j < n; j++)
      if (nearer(period, y + 3 * i, y + 3 * j, r)) {
        if (at >= found || near[at] != (int32_t)j) ck_abort_msg("%zu does not find %zu", i, j);
        at++;
      }
    ck_assert_uint_eq(at, found);
  }
  bw_particles_cells_destroy(&g);
  return pairs;
}

static size_t check_all_pairs(size_t n, double r, const double period[3])
{
  return check_pairs_from(0, n, r, period);
}

START_TEST(all_pairs_without_periods)
{
  const double none[3] = {0}, cube[3] = {1, 1, 1}, flat[3] = {4, 4, 0}, rod[3] = {1e-3, 900, 1e-3};
  scatter(MOST, cube);
  ck_assert_uint_gt(check_all_pairs(MOST, 0.13, none), 3 * MOST);
  ck_assert_uint_gt(check_all_pairs(MOST, 2.0, none), 100 * MOST); /* few cells */
  scatter(MOST, flat);
  ck_assert_uint_gt(check_all_pairs(MOST, 0.2, none), 3 * MOST);
  scatter(MOST, rod);
  ck_assert_uint_gt(check_all_pairs(MOST, 3.0, none), 3 * MOST);
}
END_TEST

/* Periods of 1, 2, 3 and many cells; in one cell a period is shorter than twice the distance. */
START_TEST(all_pairs_with_periods)
{
  static const double period[6][3] = {{1, 1, 1},     {1, 0, 0},     {0, 0.27, 1},
                                      {0.4, 0.3, 1}, {0.2, 0.2, 0}, {0.14, 5, 0.28}};
  const double size[3] = {1, 1, 1};
  scatter(MOST, size);
  for (int q = 0; q < 6; q++)
    ck_assert_uint_gt(check_all_pairs(MOST, 0.13, period[q]), 3 * MOST);
  const double shorter[3] = {0.1, 0.1, 0.1};
  check_all_pairs(MOST, 0.13, shorter);
}
END_TEST

/* What a sum over neighbours depends on: cells as `around` has them, in each the last point
 * first. */
START_TEST(the_order_of_neighbours_is_fixed)
{
  const double size[3] = {1, 1, 1}, period[3] = {0, 0.9, 0};
  static int32_t near[MOST];
  int32_t around[27][3];
  bw_particles_cells g;
  scatter(MOST, size);
  bw_check_ok(bw_particles_cells_create(MOST, y, 0.13, period, &g));
  for (size_t i = 0; i < MOST; i++) {
    size_t found, at = 0;
    bw_check_ok(bw_particles_cells_near(&g, y, y + 3 * i, 0.13, MOST, near, &found));
    const int count = bw_particles_cells_around(&g, g.cell + 3 * i, around);
    ck_assert_int_eq(count, 27);
    for (int c = 0; c < count; c++)
      for (int32_t q = MOST - 1; q >= 0; q--)
        if (memcmp(g.cell + 3 * q, around[c], sizeof around[c]) == 0 &&
            nearer(period, y + 3 * i, y + 3 * q, 0.13)) {
          if (at >= found || near[at] != q)
            ck_abort_msg("neighbour %zu of %zu is not %d", at, i, q);
          at++;
        }
  }
  /* Axis 0 fastest. */
  const int32_t step[3] = {around[1][0] - around[0][0], around[1][1] - around[0][1],
                           around[1][2] - around[0][2]};
  ck_assert(step[0] == 1 && step[1] == 0 && step[2] == 0);
  bw_particles_cells_destroy(&g);
}
END_TEST

START_TEST(room_and_refusals)
{
  const double size[3] = {1, 1, 1}, none[3] = {0}, wrong[3] = {0, -1, 0}, nan[3] = {0, 0, NAN};
  const double centre[3] = {0.2, 0.2, 0.2};
  int32_t near[3] = {-7, -7, -7};
  size_t found;
  bw_particles_cells g;
  scatter(100, size);
  bw_check_ok(bw_particles_cells_create(100, y, 5, none, &g));
  bw_check_ok(bw_particles_cells_near(&g, y, centre, 1, 2, near, &found));
  ck_assert_uint_gt(found, 2);
  ck_assert(near[0] >= 0 && near[1] >= 0 && near[2] == -7);
  bw_check_status(bw_particles_cells_near(&g, y, centre, 5.1, 3, near, &found), BW_EINPUT);
  bw_check_status(bw_particles_cells_near(&g, y, centre, NAN, 3, near, &found), BW_EINPUT);
  bw_particles_cells_destroy(&g);
  bw_check_status(bw_particles_cells_create(100, y, 0, none, &g), BW_EINPUT);
  bw_check_status(bw_particles_cells_create(100, y, NAN, none, &g), BW_EINPUT);
  bw_check_status(bw_particles_cells_create(100, y, 1, wrong, &g), BW_EINPUT);
  bw_check_status(bw_particles_cells_create(100, y, 1, nan, &g), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "direction 2"));
  bw_check_ok(bw_particles_cells_create(0, NULL, 1, none, &g));
  bw_check_ok(bw_particles_cells_near(&g, y, centre, 1, 3, near, &found));
  ck_assert_uint_eq(found, 0);
  bw_particles_cells_destroy(&g);
}
END_TEST

/* Positions of a run that went wrong, the first one among them: the others are found as before. */
START_TEST(lost_points_do_no_harm)
{
  static const double lost[8] = {NAN, 1e300, -1e300, INFINITY, -INFINITY, 1e12, -3e9, 1e-300};
  static const double periods[3][3] = {{0, 0, 0}, {1, 1, 1}, {0, 1e-9, 1e300}};
  const double size[3] = {1, 1, 1};
  for (int p = 0; p < 3; p++)
    for (size_t first = 0; first < 8; first++) {
      scatter(300, size);
      for (size_t q = 0; q < 40; q++)
        y[3 * q + q % 3] = lost[(first + q) % 8];
      if (p < 2) {
        ck_assert_uint_gt(check_pairs_from(40, 300, 0.2, periods[p]), 300);
        continue;
      }
      /* Absurd periods: what counts is that it ends. */
      bw_particles_cells g;
      size_t found;
      bw_check_ok(bw_particles_cells_create(300, y, 0.2, periods[p], &g));
      for (size_t i = 0; i < 300; i++)
        bw_check_ok(bw_particles_cells_near(&g, y, y + 3 * i, 0.2, 0, NULL, &found));
      bw_particles_cells_destroy(&g);
    }
}
END_TEST

/* A first point that is lost does not put the others into one cell, nor do points that are nowhere
 * fill one: a search would then go through all pairs. */
START_TEST(lost_points_fill_no_cell)
{
  const double size[3] = {1, 1, 1}, none[3] = {0};
  bw_particles_cells g;
  int32_t a[3], b[3];
  scatter(300, size);
  y[0] = 1e300;
  bw_check_ok(bw_particles_cells_create(300, y, 0.1, none, &g));
  const double left[3] = {0.1, 0.1, 0.1}, right[3] = {0.35, 0.1, 0.1};
  bw_particles_cells_of(&g, left, a);
  bw_particles_cells_of(&g, right, b);
  ck_assert_int_ge(b[0] - a[0], 2);
  bw_particles_cells_destroy(&g);

  for (size_t q = 0; q < 100; q++)
    y[3 * q + q % 3] = NAN;
  bw_check_ok(bw_particles_cells_create(100, y, 0.1, none, &g));
  for (size_t q = 0; q < g.buckets; q++)
    ck_assert_int_eq(g.head[q], -1);
  bw_particles_cells_destroy(&g);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(all_pairs_without_periods),        BW_TEST(all_pairs_with_periods),
    BW_TEST(the_order_of_neighbours_is_fixed), BW_TEST(room_and_refusals),
    BW_TEST(lost_points_do_no_harm),           BW_TEST(lost_points_fill_no_cell)};
BW_CHECK_MAIN("particles.cells", tests)
