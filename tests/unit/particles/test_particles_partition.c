/* The division of sites among ranks without a list of all: the owners are those of the serial
 * algorithm, whoever passes which site; counts beyond 2^31.
 * TEST ranks=1,2,3,4,7 */
#include "bw_particles_order.h"
#include "bw_particles_partition.h"
#include "particles_key.h"
#include "particles_test.h"
#include "serial_bisection.h"

enum { BY_BLOCKS, BY_TURNS, ALL_BY_FIRST, ALL_BY_LAST, SCATTERED, WAYS };

/* Who passes row q? */
static int passed_by(int way, size_t q, size_t n)
{
  const int size = bw_comm_size(bw_check_world());
  switch (way) {
  case BY_BLOCKS:
    return (int)(q * (size_t)size / n);
  case BY_TURNS:
    return (int)(q % (size_t)size);
  case ALL_BY_FIRST:
    return 0;
  case ALL_BY_LAST:
    return size - 1;
  default:
    return (int)(scramble(q) % (uint64_t)size);
  }
}

static bw_particles_partition *divided(const body *b, int way)
{
  bw_particles_partition *p = NULL;
  body mine = body_of(b->n);
  for (size_t q = 0; q < b->n; q++) {
    const int32_t *s = b->site + 3 * q;
    if (passed_by(way, q, b->n) == bw_comm_rank(bw_check_world()))
      body_add(&mine, s[0], s[1], s[2]);
  }
  bw_check_ok(bw_particles_partition_create(bw_check_world(), mine.n, mine.site, &p));
  bw_release(&mine.site);
  return p;
}

static int32_t *serial_owners(const body *b)
{
  int32_t *part = NULL, lower[3], upper[3];
  serial_item *item = NULL;
  bw_check_ok(BW_ALLOCATE(&part, b->n));
  bw_check_ok(BW_ALLOCATE(&item, b->n));
  for (size_t q = 0; q < b->n; q++)
    item[q].row = (int32_t)q;
  bw_particles_extent(b->n, b->site, lower, upper);
  serial_bisect(0, bw_comm_size(bw_check_world()), b->n, b->site, lower, item, part);
  bw_release(&item);
  return part;
}

/* Owners of all sites and counts of all ranks, for two ways to pass the sites that change from call
 * to call; releases the body. */
static void check_against_serial(body b)
{
  static int calls = 0;
  const int size = bw_comm_size(bw_check_world());
  int32_t *want = serial_owners(&b);
  int64_t *count = NULL;
  bw_check_ok(BW_ALLOCATE(&count, (size_t)size));
  for (size_t q = 0; q < b.n; q++)
    count[want[q]]++;
  for (int turn = 0; turn < 2; turn++) {
    const int way = calls++ % WAYS;
    bw_particles_partition *p = divided(&b, way);
    for (size_t q = 0; q < b.n; q++) {
      const int32_t *s = b.site + 3 * q;
      const int got = bw_particles_partition_owner(p, s);
      if (got != want[q])
        ck_abort_msg("way %d: site (%d,%d,%d) went to %d instead of %d", way, s[0], s[1], s[2], got,
                     want[q]);
    }
    ck_assert_int_eq(bw_particles_partition_total(p), (int64_t)b.n);
    for (int r = 0; r < size; r++)
      ck_assert_int_eq(bw_particles_partition_count(p, r), count[r]);
    bw_particles_partition_destroy(&p);
    ck_assert_ptr_null(p);
  }
  bw_release(&count);
  bw_release(&want);
  bw_release(&b.site);
}

START_TEST(scattered_sites)
{
  check_against_serial(body_scattered(20000, 60));
  check_against_serial(body_scattered(5000, (1 << 20) - 1));
}
END_TEST

/* Cubes and other boxes, where axes tie and planes of equal coordinates are cut. */
START_TEST(boxes_and_porous_bodies)
{
  static const int size[5][3] = {{24, 24, 24}, {31, 30, 31}, {7, 48, 48}, {48, 36, 24}, {5, 3, 2}};
  const int lower[3] = {-11, 500, 3};
  for (int q = 0; q < 5; q++) {
    check_against_serial(body_box(lower, size[q], full));
    check_against_serial(body_box(lower, size[q], porous));
  }
}
END_TEST

START_TEST(plates_and_lines)
{
  static const int size[6][3] = {{150, 100, 1}, {3, 120, 70}, {90, 2, 90},
                                 {5000, 1, 1},  {1, 1, 777},  {1, 2000, 2}};
  const int lower[3] = {0, -20, 7};
  for (int q = 0; q < 6; q++)
    check_against_serial(body_box(lower, size[q], full));
}
END_TEST

/* Fewer particles than ranks, one, none: some ranks own nothing. */
START_TEST(few_particles)
{
  for (int n = 1; n <= 8; n++) {
    const int lower[3] = {-n, 4, 0}, size[3] = {n, 1, 1};
    check_against_serial(body_box(lower, size, full));
  }
  const int32_t anywhere[3] = {5, 6, -7};
  body none = body_of(1);
  bw_particles_partition *p = divided(&none, BY_TURNS);
  ck_assert_int_eq(bw_particles_partition_total(p), 0);
  ck_assert_int_eq(bw_particles_partition_owner(p, anywhere), 0);
  bw_particles_partition_destroy(&p);
  bw_release(&none.site);
}
END_TEST

/* Sites that nobody occupies, inside and far outside, have one owner, the same on all ranks, and
 * that of the nearest occupied site when they lie beyond a face of a full box. */
START_TEST(every_site_has_an_owner)
{
  const int lower[3] = {-11, 500, 3}, size[3] = {24, 20, 16};
  body b = body_box(lower, size, full);
  bw_particles_partition *p = divided(&b, BY_TURNS);
  for (uint64_t key = 0; key < 2000; key++) {
    int32_t s[3], near[3];
    for (size_t k = 0; k < 3; k++) {
      const int reach = key % 2 == 0 ? 40 : 1 << 29;
      s[k] = lower[k] + (int32_t)((fraction_of(3 * key + k) - 0.5) * reach);
      const int32_t last = lower[k] + size[k] - 1;
      near[k] = s[k] < lower[k] ? lower[k] : s[k] > last ? last : s[k];
    }
    int64_t owner = bw_particles_partition_owner(p, s);
    ck_assert(owner >= 0 && owner < bw_comm_size(bw_check_world()));
    const int64_t mine = owner;
    bw_comm_max_int(bw_check_world(), 1, &owner);
    ck_assert_int_eq(mine, owner);
    const int out = (s[0] != near[0]) + (s[1] != near[1]) + (s[2] != near[2]);
    if (out <= 1 && s[0] == near[0]) ck_assert_int_eq(owner, bw_particles_partition_owner(p, near));
  }
  bw_particles_partition_destroy(&p);
  bw_release(&b.site);
}
END_TEST

START_TEST(particles_on_one_site_stay_together)
{
  body b = body_of(400);
  for (int q = 0; q < 400; q++)
    body_add(&b, q / 100, 0, 0);
  bw_particles_partition *p = divided(&b, SCATTERED);
  int64_t sum = 0;
  for (int r = 0; r < bw_comm_size(bw_check_world()); r++) {
    ck_assert_int_eq(bw_particles_partition_count(p, r) % 100, 0);
    sum += bw_particles_partition_count(p, r);
  }
  ck_assert_int_eq(sum, 400);
  bw_particles_partition_destroy(&p);
  bw_release(&b.site);
}
END_TEST

START_TEST(a_body_too_wide_is_refused_on_all_ranks)
{
  const int last = bw_comm_size(bw_check_world()) - 1;
  const int32_t site[6] = {0, 0, 0, 0, 1 << 21, 0};
  bw_particles_partition *p = NULL;
  const bool both = last == 0, one = bw_comm_rank(bw_check_world()) == last;
  const int32_t *mine = one && !both ? site + 3 : site;
  bw_check_status(bw_particles_partition_create(bw_check_world(), both ? 2 : 1, mine, &p),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "2097153 steps in direction 1"));
  ck_assert_ptr_null(p);
}
END_TEST

/* How many sites of a full box have keys below `key`, axis 0 fastest. */
static int64_t keys_below(const int64_t size[3], uint64_t key)
{
  static const int axis[3] = {0, 1, 2};
  int64_t at[3];
  bw_particles__unkey(axis, key, at);
  if (at[2] >= size[2]) return size[0] * size[1] * size[2];
  if (at[1] >= size[1]) return size[0] * size[1] * (at[2] + 1);
  const int64_t row = at[0] < size[0] ? at[0] : size[0];
  return row + size[0] * (at[1] + size[1] * at[2]);
}

/* The cut of a box so large that it is only counted: its site is known in closed form. */
static void check_cut(const int64_t size[3], int left, int parts)
{
  static const int axis[3] = {0, 1, 2};
  const int64_t n = size[0] * size[1] * size[2], none[3] = {0, 0, 0};
  const int64_t last[3] = {size[0] - 1, size[1] - 1, size[2] - 1};
  const int64_t cut = bw_particles__cut_index(n, left, parts);
  int rounds = 0;
  bw_particles__selection s =
      bw_particles__select(cut, bw_particles__key(axis, none), bw_particles__key(axis, last));
  for (; !bw_particles__selected(&s); rounds++)
    bw_particles__narrow(&s, keys_below(size, bw_particles__pivot(&s)));
  const int64_t want[3] = {cut % size[0], cut / size[0] % size[1], cut / size[0] / size[1]};
  ck_assert_uint_eq(s.low, bw_particles__key(axis, want));
  ck_assert_int_eq(s.below, cut);
  ck_assert_int_le(rounds, 63);
}

/* 2^31 to 2^45 particles, and the widest box of all. Nothing is allocated. */
START_TEST(cuts_beyond_2_31)
{
  static const int64_t size[6][3] = {{2048, 1024, 1024},          {1291, 1291, 1290},
                                     {1 << 15, 1 << 15, 16},      {1 << 21, 1, 1 << 21},
                                     {1 << 15, 1 << 15, 1 << 15}, {32749, 32719, 32713}};
  static const int parts[6] = {2, 3, 7, 1000, 65537, 1 << 20};
  for (int b = 0; b < 6; b++)
    for (int q = 0; q < 6; q++)
      check_cut(size[b], parts[q] / 2, parts[q]);
}
END_TEST

/* Against the same quotient in 128 bits; parts of a cut add up. */
START_TEST(cut_indices_do_not_overflow)
{
  for (int e = 31; e <= 62; e++)
    for (uint64_t key = 0; key < 50; key++) {
      const int64_t n = ((int64_t)1 << e) + (int64_t)(scramble(key) % 1000003);
      const int parts = 2 + (int)(scramble(key + 1000) % ((1u << 30) - 2)), left = parts / 2;
      __extension__ typedef __int128 wide;
      const int64_t got = bw_particles__cut_index(n, left, parts);
      ck_assert(got == (int64_t)((wide)n * left / parts));
      ck_assert(got >= 0 && got < n);
    }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(scattered_sites),
                                      BW_TEST(boxes_and_porous_bodies),
                                      BW_TEST(plates_and_lines),
                                      BW_TEST(few_particles),
                                      BW_TEST(every_site_has_an_owner),
                                      BW_TEST(particles_on_one_site_stay_together),
                                      BW_TEST(a_body_too_wide_is_refused_on_all_ranks),
                                      BW_TEST(cuts_beyond_2_31),
                                      BW_TEST(cut_indices_do_not_overflow)};
BW_CHECK_MAIN("particles.partition", tests)
