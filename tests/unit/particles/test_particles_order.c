/* The order of a lattice by any permutation of axes, against the comparison of sites by hand.
 * TEST ranks=1 */
#include "bw_particles_order.h"
#include "particles_test.h"

static const int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

/* Does a come before b, axis[2] decided first? */
static bool before(const int axis[3], const int32_t a[3], const int32_t b[3])
{
  for (int k = 2; k >= 0; k--)
    if (a[axis[k]] != b[axis[k]]) return a[axis[k]] < b[axis[k]];
  return false;
}

/* Sites that rise strictly and are as many as before are the same sites, once each. */
static void check_order(const int axis[3], const body *b)
{
  int32_t *order = NULL;
  bool *seen = NULL;
  bw_check_ok(BW_ALLOCATE(&order, b->n));
  bw_check_ok(BW_ALLOCATE(&seen, b->n));
  bw_check_ok(bw_particles_lattice_order(axis, b->n, b->site, order));
  for (size_t q = 0; q < b->n; q++) {
    ck_assert(order[q] >= 0 && (size_t)order[q] < b->n && !seen[order[q]]);
    seen[order[q]] = true;
    if (q > 0)
      ck_assert(before(axis, b->site + 3 * (size_t)order[q - 1], b->site + 3 * (size_t)order[q]));
  }
  bw_release(&order);
  bw_release(&seen);
}

START_TEST(sites_are_in_order_for_any_axes)
{
  const int lower[3] = {-3, 1000000, -40}, size[3] = {13, 20, 31};
  body b = body_box(lower, size, porous), c = body_scattered(3000, 1 << 19);
  for (int q = 0; q < 6; q++) {
    check_order(axes[q], &b);
    check_order(axes[q], &c);
  }
  bw_release(&b.site);
  bw_release(&c.site);
}
END_TEST

START_TEST(extent_and_limits)
{
  int32_t lower[3], upper[3], order[2];
  const int32_t two[6] = {5, -2, 7, 3, 9, 7}, far[6] = {0, 0, 0, 0, 0, 1 << 21};
  bw_particles_extent(2, two, lower, upper);
  const int32_t low[3] = {3, -2, 7}, high[3] = {5, 9, 7};
  ck_assert_mem_eq(lower, low, sizeof low);
  ck_assert_mem_eq(upper, high, sizeof high);
  bw_particles_extent(0, NULL, lower, upper);
  ck_assert(lower[0] == 0 && upper[0] == 0);
  bw_check_ok(bw_particles_lattice_order(axes[0], 0, NULL, order));
  bw_check_status(bw_particles_lattice_order(axes[0], 2, far, order), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "direction 2"));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(sites_are_in_order_for_any_axes),
                                      BW_TEST(extent_and_limits)};
BW_CHECK_MAIN("particles.order", tests)
