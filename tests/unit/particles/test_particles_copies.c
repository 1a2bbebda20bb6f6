/* Copies of what other ranks own, asked for by site or by identity or given unasked: which there
 * are, values out, sums back, all against what every rank can work out from the whole body.
 * TEST ranks=1,2,3,4 */
#include "bw_particles_copies.h"
#include "bw_particles_order.h"
#include "bw_particles_partition.h"
#include "bw_real.h"
#include "particles_test.h"

#include <malloc.h>

enum { REACH = 2, PERIOD = 24, WIDTH = 24 };

/* A porous body, periodic in direction 0, and this rank's part of it with its copies. */
typedef struct {
  body all;
  bw_particles_map row; /* site -> row of all */
  bw_particles_partition *partition;
  body own;
  bw_particles_map near; /* place -> own particle or copy */
  size_t n_copies;       /* asked for */
  int32_t *place, *home; /* (n_copies,3) where it is seen, and the site it is an image of */
  int *owner;            /* (n_copies) */
  bw_particles_copies *copies;
} world;

static void home_of(const int32_t place[3], int32_t home[3])
{
  memcpy(home, place, 3 * sizeof *home);
  home[0] = (place[0] % PERIOD + PERIOD) % PERIOD;
}

static int32_t find_site(const void *context, const void *key)
{
  const world *w = context;
  const int32_t number = bw_particles_map_get(&w->near, key);
  return number < (int32_t)w->own.n ? number : -1;
}

/* Identity: the row in the list of all, as 64 bits. */
static int32_t find_row(const void *context, const void *key)
{
  const world *w = context;
  int64_t row;
  memcpy(&row, key, sizeof row);
  return row < (int64_t)w->all.n ? find_site(w, w->all.site + 3 * row) : -1;
}

static void take_part(world *w)
{
  const bw_comm *comm = bw_check_world();
  const int lower[3] = {0, 0, 0}, size[3] = {PERIOD, 18, 15};
  w->all = body_box(lower, size, porous);
  bw_check_ok(bw_particles_map_create_own(w->all.n, w->all.site, 0, &w->row));
  const size_t n = bw_comm_rank(comm) == 0 ? w->all.n : 0;
  bw_check_ok(bw_particles_partition_create(comm, n, w->all.site, &w->partition));
  w->own = body_of(w->all.n);
  for (size_t q = 0; q < w->all.n; q++) {
    const int32_t *s = w->all.site + 3 * q;
    if (bw_particles_partition_owner(w->partition, s) == bw_comm_rank(comm))
      body_add(&w->own, s[0], s[1], s[2]);
  }
  bw_check_ok(bw_particles_map_create_own(w->own.n, w->own.site, REACH, &w->near));
}

/* Places within reach of own particles where no own particle is, every one once. */
static void list_places(world *w)
{
  const size_t most = w->own.n * 124 + 1;
  bw_check_ok(BW_ALLOCATE(&w->place, 3 * most));
  bw_check_ok(BW_ALLOCATE(&w->home, 3 * most));
  bw_check_ok(BW_ALLOCATE(&w->owner, most));
  for (size_t i = 0; i < w->own.n; i++)
    for (int o = 0; o < 125; o++) {
      const int32_t *s = w->own.site + 3 * i;
      const int32_t there[3] = {s[0] + o % 5 - 2, s[1] + o / 5 % 5 - 2, s[2] + o / 25 - 2};
      int32_t found;
      if (bw_particles_map_get(&w->near, there) >= 0) continue;
      bw_check_ok(bw_particles_map_put(&w->near, there, (int32_t)(w->own.n + w->n_copies), &found));
      memcpy(w->place + 3 * w->n_copies, there, sizeof there);
      home_of(there, w->home + 3 * w->n_copies);
      w->owner[w->n_copies] = bw_particles_partition_owner(w->partition, w->home + 3 * w->n_copies);
      w->n_copies++;
    }
}

/* Keep the places that are occupied, as their owners tell, and check that against the list of
 * all. */
static void drop_empty(world *w)
{
  int32_t *index = NULL;
  size_t kept = 0;
  const bw_particles_question question = {w->n_copies, w->owner,  3 * sizeof *w->home,
                                          w->home,     find_site, w};
  bw_check_ok(BW_ALLOCATE(&index, w->n_copies));
  bw_check_ok(bw_particles_ask(bw_check_world(), &question, index));
  for (size_t c = 0; c < w->n_copies; c++) {
    const bool there = bw_particles_map_get(&w->row, w->home + 3 * c) >= 0;
    if (there != (index[c] >= 0)) ck_abort_msg("place %zu: found %d", c, index[c]);
    if (!there) continue;
    memmove(w->place + 3 * kept, w->place + 3 * c, 3 * sizeof *w->place);
    memmove(w->home + 3 * kept, w->home + 3 * c, 3 * sizeof *w->home);
    w->owner[kept++] = w->owner[c];
  }
  ck_assert(kept > 0 && kept < w->n_copies);
  w->n_copies = kept;
  bw_release(&index);
}

static world made(void)
{
  world w = {0};
  take_part(&w);
  list_places(&w);
  drop_empty(&w);
  const bw_particles_question question = {w.n_copies, w.owner,   3 * sizeof *w.home,
                                          w.home,     find_site, &w};
  bw_check_ok(bw_particles_copies_create(bw_check_world(), w.own.n, &question, WIDTH, &w.copies));
  ck_assert_uint_eq(bw_particles_copies_count(w.copies), w.n_copies);
  return w;
}

static void unmake(world *w)
{
  bw_particles_copies_destroy(&w->copies);
  ck_assert_ptr_null(w->copies);
  bw_particles_partition_destroy(&w->partition);
  bw_particles_map_destroy(&w->row);
  bw_particles_map_destroy(&w->near);
  bw_release(&w->all.site);
  bw_release(&w->own.site);
  bw_release(&w->place);
  bw_release(&w->home);
  bw_release(&w->owner);
}

/* Home site of an own particle or a copy. */
static const int32_t *site_of(const world *w, size_t e)
{
  return e < w->own.n ? w->own.site + 3 * e : w->home + 3 * (e - w->own.n);
}

/* What a particle holds in the tests: 40 bytes, more than WIDTH and no multiple of it. */
typedef struct {
  int64_t number[4];
  float tail[2];
} value;

static value value_of(const int32_t s[3])
{
  const int64_t n = s[0] + 100 * s[1] + 10000 * s[2];
  return (value){{n, -n, n * n, 7 - n}, {(float)s[0], (float)n}};
}

START_TEST(values_go_out)
{
  world w = made();
  const size_t all = w.own.n + w.n_copies;
  value *own = NULL, *got = NULL;
  bw_check_ok(BW_ALLOCATE(&own, w.own.n));
  bw_check_ok(BW_ALLOCATE(&got, all));
  for (size_t i = 0; i < w.own.n; i++)
    own[i] = value_of(w.own.site + 3 * i);
  for (int turn = 0; turn < 2; turn++) {
    /* The second time from the own values that are in place already. */
    bw_particles_copies_values(w.copies, sizeof *own, turn == 0 ? own : got, got);
    for (size_t e = 0; e < all; e++) {
      const value want = value_of(site_of(&w, e));
      if (memcmp(&want, &got[e], sizeof want) != 0) ck_abort_msg("value %zu of %zu", e, all);
    }
    memset(got + w.own.n, 0, w.n_copies * sizeof *got);
  }
  bw_release(&own);
  bw_release(&got);
  unmake(&w);
}
END_TEST

/* Of every site: how many copies there are, and a sum over their holders that tells these apart.
 * Every rank works it out from the whole body. */
static double holders_of(const world *w, size_t row)
{
  const int size = bw_comm_size(bw_check_world());
  const int32_t *home = w->all.site + 3 * row;
  double sum = 0;
  for (int image = -1; image <= 1; image++) {
    bool held[64] = {false};
    const int32_t s[3] = {home[0] + image * PERIOD, home[1], home[2]};
    for (int o = 0; o < 125; o++) {
      const int32_t from[3] = {s[0] + o % 5 - 2, s[1] + o / 5 % 5 - 2, s[2] + o / 25 - 2};
      if (bw_particles_map_get(&w->row, from) < 0) continue;
      const int r = bw_particles_partition_owner(w->partition, from);
      if (image == 0 && r == bw_particles_partition_owner(w->partition, home)) continue;
      held[r] = true;
    }
    for (int r = 0; r < size; r++)
      if (held[r]) sum += 1000 * (r + 1) + image + 2;
  }
  return sum;
}

/* Each copy holds a number of its holder and image; the owner gets their sum beside its own. Small
 * integers, so that it is exact also in single precision. */
START_TEST(sums_come_back)
{
  enum { COMPONENTS = 5 };
  world w = made();
  const size_t all = w.own.n + w.n_copies;
  const int me = bw_comm_rank(bw_check_world());
  double *x = NULL;
  ck_assert_int_le(bw_comm_size(bw_check_world()), 64);
  bw_check_ok(BW_ALLOCATE(&x, COMPONENTS * all));
  for (size_t e = 0; e < all; e++)
    for (size_t k = 0; k < COMPONENTS; k++) {
      const int32_t *s = site_of(&w, e);
      const int image = e < w.own.n ? 0 : (w.place[3 * (e - w.own.n)] - s[0]) / PERIOD;
      x[COMPONENTS * e + k] = (e < w.own.n ? 50 : 1000 * (me + 1) + image + 2) * (double)(k + 1);
    }
  bw_particles_copies_sum(w.copies, COMPONENTS, x);
  for (size_t i = 0; i < w.own.n; i++) {
    const double want =
        50 + holders_of(&w, (size_t)bw_particles_map_get(&w.row, w.own.site + 3 * i));
    for (size_t k = 0; k < COMPONENTS; k++)
      if (x[COMPONENTS * i + k] != want * (double)(k + 1))
        ck_abort_msg("particle %zu: %g instead of %g", i, x[COMPONENTS * i + k], want);
  }
  bw_release(&x);
  unmake(&w);
}
END_TEST

/* Numbers of very different size: the sum is that in the order of the rows, to the last bit. */
START_TEST(sums_are_in_the_order_of_the_rows)
{
  world w = made();
  const size_t all = w.own.n + w.n_copies, rows = bw_particles_copies_rows(w.copies);
  const int32_t *asked = bw_particles_copies_asked(w.copies);
  double *x = NULL, *want = NULL;
  bw_real *answer = NULL, *reply = NULL;
  bw_check_ok(BW_ALLOCATE(&x, all));
  bw_check_ok(BW_ALLOCATE(&want, all));
  bw_check_ok(BW_ALLOCATE(&answer, w.n_copies));
  bw_check_ok(BW_ALLOCATE(&reply, rows));
  for (size_t e = 0; e < all; e++)
    want[e] = x[e] = pow(10, 20 * fraction_of(e + 1000000 * w.own.n)) / 3;
  for (size_t c = 0; c < w.n_copies; c++)
    answer[c] = (bw_real)x[w.own.n + c];
  bw_particles_copies_in(w.copies, sizeof *answer, answer, reply);
  for (size_t q = 0; q < rows; q++)
    want[asked[q]] += (double)reply[q];
  bw_particles_copies_sum(w.copies, 1, x);
  ck_assert_mem_eq(x, want, all * sizeof *x);
  bw_release(&x);
  bw_release(&want);
  bw_release(&answer);
  bw_release(&reply);
  unmake(&w);
}
END_TEST

/* The same copies asked for by identity, and packed by the caller in the object's own room. */
START_TEST(identities_and_own_packing)
{
  world w = made();
  int64_t *id = NULL;
  bw_particles_copies *c = NULL;
  bw_check_ok(BW_ALLOCATE(&id, w.n_copies));
  for (size_t k = 0; k < w.n_copies; k++)
    id[k] = bw_particles_map_get(&w.row, w.home + 3 * k);
  const bw_particles_question question = {w.n_copies, w.owner, sizeof *id, id, find_row, &w};
  bw_check_ok(bw_particles_copies_create(bw_check_world(), w.own.n, &question, WIDTH, &c));
  const size_t rows = bw_particles_copies_rows(c);
  int32_t *reply = bw_particles_copies_reply(c);
  const int32_t *asked = bw_particles_copies_asked(c), *answer = bw_particles_copies_answer(c);
  for (size_t q = 0; q < rows; q++)
    memcpy(reply + 3 * q, w.own.site + 3 * (size_t)asked[q], 3 * sizeof *reply);
  bw_particles_copies_out(c, 3 * sizeof *reply, reply, bw_particles_copies_answer(c));
  ck_assert_mem_eq(answer, w.home, 3 * w.n_copies * sizeof *answer);
  bw_particles_copies_destroy(&c);
  bw_release(&id);
  unmake(&w);
}
END_TEST

/* Owner r gives its particle i to the ranks r, r + 1, .. r + i; nobody asks. */
START_TEST(owners_may_give_unasked)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  int32_t own[64];
  int destination[64];
  size_t rows = 0;
  bw_particles_copies *c = NULL;
  for (int i = 0; i < 4; i++)
    for (int k = 0; k <= i; k++, rows++)
      own[rows] = i, destination[rows] = (me + k) % size;
  bw_check_ok(bw_particles_copies_offer(comm, 4, rows, own, destination, 8, &c));
  ck_assert_uint_eq(bw_particles_copies_rows(c), rows);
  ck_assert_uint_eq(bw_particles_copies_count(c), rows); /* all do alike */
  double x[4 + 64];
  for (int i = 0; i < 4; i++)
    x[i] = 10 * me + i;
  bw_particles_copies_values(c, sizeof *x, x, x);
  size_t at = 4;
  for (int r = 0; r < size; r++)
    for (int i = 0; i < 4; i++)
      for (int k = 0; k <= i; k++)
        if ((r + k) % size == me) ck_assert_double_eq(x[at++], 10 * r + i);
  ck_assert_uint_eq(at, 4 + rows);
  for (size_t q = 4; q < at; q++)
    x[q] = 1;
  bw_particles_copies_sum(c, 1, x);
  for (int i = 0; i < 4; i++)
    ck_assert_double_eq(x[i], 10 * me + i + (i + 1));
  bw_particles_copies_destroy(&c);
}
END_TEST

static int32_t even_only(const void *context, const void *key)
{
  (void)context;
  int64_t id;
  memcpy(&id, key, sizeof id);
  return id % 2 == 0 ? (int32_t)(id / 2) : -1;
}

/* One rank asks for what is not there: all refuse, and the message names it. */
START_TEST(a_missing_particle_is_named)
{
  const bw_comm *comm = bw_check_world();
  const int last = bw_comm_size(comm) - 1;
  const int owner[2] = {last, last};
  const int64_t good[2] = {0, 2}, odd[2] = {0, 4711}, beyond[2] = {2, 4};
  bw_particles_question question = {2, owner, sizeof *good, good, even_only, NULL};
  bw_particles_copies *c = NULL;
  bw_check_ok(bw_particles_copies_create(comm, 2, &question, 8, &c));
  bw_particles_copies_destroy(&c);
  if (bw_comm_rank(comm) == 0) question.key = odd;
  bw_check_status(bw_particles_copies_create(comm, 2, &question, 8, &c), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "4711"));
  ck_assert_ptr_null(c);
  question.key = beyond; /* number 2 where there are two particles */
  bw_check_status(bw_particles_copies_create(comm, 2, &question, 8, &c), BW_EINPUT);
  question.key = good;
  bw_check_status(bw_particles_copies_create(comm, 2, &question, 7, &c), BW_EINPUT);
  const int32_t own[1] = {2};
  bw_check_status(bw_particles_copies_offer(comm, 2, 1, own, owner, 8, &c), BW_EINPUT);
}
END_TEST

static size_t taken_from_the_system(void)
{
  const struct mallinfo2 m = mallinfo2();
  return m.uordblks + m.hblkhd;
}

/* On one rank, where no message makes the MPI library allocate: images alone. */
START_TEST(moves_allocate_nothing)
{
  if (bw_comm_size(bw_check_world()) > 1) return;
  world w = made();
  double *x = NULL;
  bw_check_ok(BW_ALLOCATE(&x, 3 * (w.own.n + w.n_copies)));
  const size_t before = taken_from_the_system();
  bw_particles_copies_values(w.copies, 3 * sizeof *x, x, x);
  bw_particles_copies_sum(w.copies, 3, x);
  ck_assert_uint_eq(taken_from_the_system(), before);
  bw_release(&x);
  unmake(&w);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(values_go_out),
                                      BW_TEST(sums_come_back),
                                      BW_TEST(sums_are_in_the_order_of_the_rows),
                                      BW_TEST(identities_and_own_packing),
                                      BW_TEST(owners_may_give_unasked),
                                      BW_TEST(a_missing_particle_is_named),
                                      BW_TEST(moves_allocate_nothing)};
BW_CHECK_MAIN("particles.copies", tests)
