/* The places around own particles that somebody else occupies, found without a list of all, against
 * a search with such a list: same places, same order, same owners; periodic and not; in the plane.
 * TEST ranks=1,2,3,4 */
#include "bw_particles_halo.h"
#include "particles_test.h"

static const int32_t ball[18][3] = {{0, 0, -2}, {0, -1, -1}, {-1, 0, -1}, {0, 0, -1}, {1, 0, -1},
                                    {0, 1, -1}, {-2, 0, 0},  {-1, 0, 0},  {0, -1, 0}, {0, 1, 0},
                                    {1, 0, 0},  {2, 0, 0},   {0, -1, 1},  {-1, 0, 1}, {0, 0, 1},
                                    {1, 0, 1},  {0, 1, 1},   {0, 0, 2}};

static int32_t row_of(const bw_particles_lattice *lattice, const bw_particles_map *all,
                      const int32_t place[3], int32_t home[3])
{
  memcpy(home, place, 3 * sizeof *home);
  for (int k = 0; k < 3; k++) {
    const int32_t p = lattice->period[k];
    while (p > 0 && home[k] < lattice->lower[k])
      home[k] += p;
    while (p > 0 && home[k] >= lattice->lower[k] + p)
      home[k] -= p;
  }
  return bw_particles_map_get(all, home);
}

/* What the halo of these own particles is, by the list of all. */
static void check_halo(const bw_particles_lattice *lattice, const body *all, const body *own,
                       const bw_particles_map *near, const bw_particles_halo *halo)
{
  bw_particles_map everybody, mine;
  size_t at = 0;
  int32_t home[3], found;
  bw_check_ok(bw_particles_map_create_own(all->n, all->site, 0, &everybody));
  bw_check_ok(bw_particles_map_create_own(own->n, own->site, 2, &mine));
  for (size_t i = 0; i < own->n; i++)
    for (int q = 0; q < lattice->n_offset; q++) {
      const int32_t *s = own->site + 3 * i, *o = lattice->offset + 3 * q;
      const int32_t place[3] = {s[0] + o[0], s[1] + o[1], s[2] + o[2]};
      const int32_t row = row_of(lattice, &everybody, place, home);
      if (row < 0 && bw_particles_map_get(near, place) >= 0) ck_abort_msg("an empty place");
      if (row < 0 || bw_particles_map_get(&mine, place) >= 0) continue;
      bw_check_ok(bw_particles_map_put(&mine, place, (int32_t)(own->n + at), &found));
      if (at >= halo->n || memcmp(halo->place + 3 * at, place, sizeof place) != 0 ||
          memcmp(halo->home + 3 * at, home, sizeof home) != 0 ||
          halo->owner[at] != bw_particles_partition_owner(lattice->partition, home) ||
          bw_particles_map_get(near, place) != (int32_t)(own->n + at))
        ck_abort_msg("place %zu is not (%d,%d,%d)", at, place[0], place[1], place[2]);
      at++;
    }
  ck_assert_uint_eq(at, halo->n);
  bw_particles_map_destroy(&everybody);
  bw_particles_map_destroy(&mine);
}

/* Returns the places of all ranks; releases the body. */
static int64_t check_body(body all, const int32_t lower[3], const int32_t period[3])
{
  const bw_comm *comm = bw_check_world();
  bw_particles_partition *partition = NULL;
  bw_particles_map near;
  bw_particles_halo halo;
  body own = body_of(all.n);
  const size_t n = bw_comm_rank(comm) == 0 ? all.n : 0;
  bw_check_ok(bw_particles_partition_create(comm, n, all.site, &partition));
  for (size_t q = 0; q < all.n; q++) {
    const int32_t *s = all.site + 3 * q;
    if (bw_particles_partition_owner(partition, s) == bw_comm_rank(comm))
      body_add(&own, s[0], s[1], s[2]);
  }
  bw_particles_lattice lattice = {.partition = partition, .n_offset = 18, .offset = ball[0]};
  memcpy(lattice.lower, lower, sizeof lattice.lower);
  memcpy(lattice.period, period, sizeof lattice.period);
  bw_check_ok(bw_particles_map_create_own(own.n, own.site, 2, &near));
  bw_check_ok(bw_particles_halo_create(comm, &lattice, own.n, own.site, &near, &halo));
  check_halo(&lattice, &all, &own, &near, &halo);
  int64_t places = (int64_t)halo.n;
  bw_comm_sum_int(comm, 1, &places);
  bw_particles_halo_destroy(&halo);
  ck_assert_ptr_null(halo.place);
  bw_particles_map_destroy(&near);
  bw_particles_partition_destroy(&partition);
  bw_release(&own.site);
  bw_release(&all.site);
  return places;
}

START_TEST(halos_of_porous_and_scattered_bodies)
{
  static const int32_t none[3] = {0, 0, 0};
  const int lower[3] = {-5, 7, 100}, size[3] = {20, 17, 13};
  const bool alone = bw_comm_size(bw_check_world()) == 1;
  const int64_t places = check_body(body_box(lower, size, porous), none, none);
  if (alone)
    ck_assert_int_eq(places, 0);
  else
    ck_assert_int_gt(places, 100);
  check_body(body_scattered(3000, 12), none, none);
  check_body(body_scattered(1000, 1 << 18), none, none); /* hashed maps */
}
END_TEST

/* Periods as wide as the body, and wider by less than the reach, on any rank and across ranks. */
START_TEST(images_across_periods)
{
  const int lower[3] = {-5, 7, 100}, size[3] = {20, 17, 13};
  const int32_t periods[4][3] = {{20, 0, 0}, {0, 17, 13}, {20, 17, 13}, {21, 19, 0}};
  const int32_t below[3] = {-5, 7, 100};
  for (int q = 0; q < 4; q++)
    ck_assert_int_gt(check_body(body_box(lower, size, porous), below, periods[q]), 50);
  /* So narrow that a particle meets its own images. */
  const int thin[3] = {1, 12, 2};
  const int32_t narrow[3] = {1, 0, 2};
  ck_assert_int_gt(check_body(body_box(lower, thin, full), below, narrow), 40);
}
END_TEST

START_TEST(planes_and_ranks_without_particles)
{
  static const int32_t none[3] = {0, 0, 0};
  const int lower[3] = {0, 0, 0}, plane[3] = {60, 40, 1}, two[3] = {2, 1, 1};
  check_body(body_box(lower, plane, full), none, none);
  check_body(body_box(lower, two, full), none, none);
  check_body(body_of(1), none, none);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(halos_of_porous_and_scattered_bodies),
                                      BW_TEST(images_across_periods),
                                      BW_TEST(planes_and_ranks_without_particles)};
BW_CHECK_MAIN("particles.halo", tests)
