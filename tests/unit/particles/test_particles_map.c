/* The map from lattice sites to numbers, dense and hashed, against a search through all sites.
 * TEST ranks=1 */
#include "particles_test.h"

static int32_t searched(const body *b, const int32_t site[3])
{
  for (size_t q = 0; q < b->n; q++)
    if (memcmp(b->site + 3 * q, site, 3 * sizeof *site) == 0) return (int32_t)q;
  return -1;
}

/* Every site and its neighbours in one direction: what the map has is what a search finds. */
static void compare_with_search(const body *b, const bw_particles_map *map)
{
  for (size_t q = 0; q < b->n; q++) {
    int32_t s[3];
    memcpy(s, b->site + 3 * q, sizeof s);
    ck_assert_int_eq(bw_particles_map_get(map, s), (int32_t)q);
    s[q % 3] += q % 2 == 0 ? 1 : -1;
    ck_assert_int_eq(bw_particles_map_get(map, s), searched(b, s));
  }
}

START_TEST(a_dense_map_gives_what_was_put)
{
  const int lower[3] = {-7, 3, 100}, size[3] = {18, 11, 9};
  body b = body_box(lower, size, porous);
  bw_particles_map map;
  bw_check_ok(bw_particles_map_create_own(b.n, b.site, 2, &map));
  ck_assert(map.dense);
  ck_assert_uint_eq(map.used, b.n);
  compare_with_search(&b, &map);
  bw_particles_map_destroy(&map);
  bw_release(&b.site);
}
END_TEST

/* 2000 sites in a box of 10^15: hashed, begun far too small, so that it grows several times. */
START_TEST(a_hashed_map_grows)
{
  body b = body_scattered(2000, 50000);
  const int32_t lower[3] = {-50001, -50001, -50001}, upper[3] = {50001, 50001, 50001};
  bw_particles_map map;
  bw_check_ok(bw_particles_map_create(1, lower, upper, &map));
  ck_assert(!map.dense);
  const size_t before = map.capacity;
  for (size_t q = 0; q < b.n; q++) {
    int32_t found;
    bw_check_ok(bw_particles_map_put(&map, b.site + 3 * q, (int32_t)q, &found));
    ck_assert_int_eq(found, -1);
  }
  ck_assert_uint_gt(map.capacity, before);
  ck_assert_uint_eq(map.used, b.n);
  compare_with_search(&b, &map);
  bw_particles_map_destroy(&map);
  bw_release(&b.site);
}
END_TEST

START_TEST(what_is_there_stays_until_it_is_replaced)
{
  const int32_t lower[3] = {0, 0, 0}, upper[3] = {4, 4, 4}, site[3] = {1, 2, 3};
  const int32_t outside[3] = {5, 0, 0}, far[3] = {INT32_MAX, INT32_MIN, 0};
  bw_particles_map map;
  int32_t found;
  bw_check_ok(bw_particles_map_create(1, lower, upper, &map));
  bw_check_ok(bw_particles_map_put(&map, site, 7, &found));
  ck_assert_int_eq(found, -1);
  bw_check_ok(bw_particles_map_put(&map, site, 8, &found));
  ck_assert_int_eq(found, 7);
  ck_assert_int_eq(bw_particles_map_get(&map, site), 7);
  bw_particles_map_replace(&map, site, 9);
  ck_assert_int_eq(bw_particles_map_get(&map, site), 9);
  ck_assert_int_eq(bw_particles_map_get(&map, outside), -1);
  ck_assert_int_eq(bw_particles_map_get(&map, far), -1);
  bw_particles_map_destroy(&map);
}
END_TEST

START_TEST(two_on_one_site_are_named)
{
  const int32_t site[12] = {0, 0, 0, 4, -5, 6, 1, 1, 1, 4, -5, 6};
  bw_particles_map map;
  bw_check_status(bw_particles_map_create_own(4, site, 0, &map), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "(1 and 3 of their rank)"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "(4,-5,6)"));
  bw_particles_map_destroy(&map);
}
END_TEST

START_TEST(no_particle_and_too_wide_a_box)
{
  const int32_t none[3] = {0, 0, 0}, lower[3] = {0, 0, 0}, upper[3] = {0, 1 << 21, 0};
  bw_particles_map map;
  bw_check_ok(bw_particles_map_create_own(0, NULL, 3, &map));
  ck_assert_int_eq(bw_particles_map_get(&map, none), -1);
  bw_particles_map_destroy(&map);
  bw_check_status(bw_particles_map_create(5, lower, upper, &map), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "direction 1"));
  bw_particles_map_destroy(&map);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_dense_map_gives_what_was_put), BW_TEST(a_hashed_map_grows),
    BW_TEST(what_is_there_stays_until_it_is_replaced), BW_TEST(two_on_one_site_are_named),
    BW_TEST(no_particle_and_too_wide_a_box)};
BW_CHECK_MAIN("particles.map", tests)
