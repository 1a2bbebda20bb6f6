/* 10^5 points move through a box over many steps: they migrate to the owner of their place, copies
 * are given to the ranks that are near, neighbours are found, values go out and sums come back. All
 * is compared with what every rank works out by itself for a sample of points, from a list of all
 * that only this test has. Direction 0 is periodic, in 1 points fly away, in 2 they bounce.
 * TEST ranks=1,2,3,4 */
#include "bw_particles_cells.h"
#include "bw_particles_copies.h"
#include "bw_particles_migrate.h"
#include "particles_test.h"

enum { POINTS = 100000, STEPS = 8, DIVIDE_EVERY = 4, LOOK_EVERY = 2, SAMPLE = 20 };

/* About 14 neighbours; the period is no multiple of it. */
static const double REACH = 0.042, PERIOD[3] = {2, 0, 0};

/* What travels with a point, 24 bytes. */
typedef struct {
  int64_t id;
  int32_t more[3];
  float weight;
} row;

typedef struct {
  bw_particles_space *space;
  size_t n;
  double *x;             /* (n,3) */
  row *rows;             /* (n) */
  double *all;           /* (POINTS,3) of the present step: the oracle */
  double *start, *speed; /* (POINTS,3) */
  double most;           /* largest number of points of a rank over the mean, just divided */
  int64_t arrived;       /* points that came from another rank, but for the first step */
  size_t pairs;
} motion;

/* Where the point is after so many steps: a function of its identity, so that nothing adds up. */
static double place(const motion *m, size_t id, int k, int step)
{
  const double x = m->start[3 * id + (size_t)k] + m->speed[3 * id + (size_t)k] * step;
  if (k != 2) return x;
  const double phase = x - 2 * floor(x / 2); /* between walls at 0 and 1 */
  return phase < 1 ? phase : 2 - phase;
}

/* Weights are small integers: sums are exact in any order. */
static row row_of(int64_t id)
{
  return (row){id, {(int32_t)id, (int32_t)-id, 5}, (float)(1 + id % 7)};
}

static void begin(motion *m)
{
  const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  bw_check_ok(BW_ALLOCATE(&m->all, 3 * POINTS));
  bw_check_ok(BW_ALLOCATE(&m->start, 3 * POINTS));
  bw_check_ok(BW_ALLOCATE(&m->speed, 3 * POINTS));
  bw_check_ok(BW_ALLOCATE(&m->x, 3 * POINTS));
  bw_check_ok(BW_ALLOCATE(&m->rows, POINTS));
  for (size_t q = 0; q < 3 * POINTS; q++) {
    m->start[q] = (q % 3 == 0 ? PERIOD[0] : 1) * fraction_of(q);
    m->speed[q] = 0.1 * (fraction_of(q + 3 * POINTS) - 0.3);
  }
  /* To begin with, points lie anywhere. */
  for (size_t id = 0; id < POINTS; id++)
    if ((int)(scramble(id) % (uint64_t)size) == me) {
      memcpy(m->x + 3 * m->n, m->start + 3 * id, 3 * sizeof *m->x);
      m->rows[m->n++] = row_of((int64_t)id);
    }
}

static void move(motion *m, int step)
{
  for (size_t id = 0; id < POINTS; id++)
    for (int k = 0; k < 3; k++)
      m->all[3 * id + (size_t)k] = place(m, id, k, step);
  for (size_t i = 0; i < m->n; i++)
    memcpy(m->x + 3 * i, m->all + 3 * m->rows[i].id, 3 * sizeof *m->x);
}

static void divide_space(motion *m)
{
  bw_particles_space_config config = bw_particles_space_config_default();
  config.edge = REACH;
  memcpy(config.period, PERIOD, sizeof PERIOD);
  bw_particles_space_destroy(&m->space);
  bw_check_ok(bw_particles_space_create(bw_check_world(), &config, m->n, m->x, &m->space));
}

static void migrate(motion *m, int step)
{
  const bw_comm *comm = bw_check_world();
  const uint64_t rows_before = bw_particles_checksum(comm, m->n, sizeof *m->rows, m->rows);
  const uint64_t x_before = bw_particles_checksum(comm, m->n, 3 * sizeof *m->x, m->x);
  size_t n = 0;
  double *x = NULL;
  void *rows = NULL;
  int64_t numbers[2] = {0, 0};
  for (size_t i = 0; i < m->n; i++)
    numbers[1] += bw_particles_space_owner(m->space, m->x + 3 * i) != bw_comm_rank(comm);
  bw_check_ok(bw_particles_migrate(m->space, m->n, m->x, sizeof *m->rows, m->rows, &n, &x, &rows));
  numbers[0] = (int64_t)n;
  bw_comm_sum_int(comm, 2, numbers);
  ck_assert_int_eq(numbers[0], POINTS);
  if (step > 0) m->arrived += numbers[1];
  ck_assert(bw_particles_checksum(comm, n, sizeof *m->rows, rows) == rows_before);
  ck_assert(bw_particles_checksum(comm, n, 3 * sizeof *x, x) == x_before);
  bw_release(&m->x);
  bw_release(&m->rows);
  m->x = x;
  m->rows = rows;
  m->n = n;
  for (size_t i = 0; i < n; i++) {
    const row want = row_of(m->rows[i].id);
    if (memcmp(x + 3 * i, m->all + 3 * want.id, 3 * sizeof *x) != 0 ||
        want.weight != m->rows[i].weight || want.more[1] != m->rows[i].more[1])
      ck_abort_msg("point %lld is not itself", (long long)want.id);
    if (bw_particles_space_owner(m->space, x + 3 * i) != bw_comm_rank(comm))
      ck_abort_msg("point %lld is with a rank that does not own its place", (long long)want.id);
  }
  double most = (double)n * bw_comm_size(comm) / POINTS;
  bw_comm_max(comm, 1, &most);
  if (step % DIVIDE_EVERY == 0) m->most = fmax(m->most, most);
}

/* Own points and copies: positions and rows of all, and the cells they are in. */
typedef struct {
  bw_particles_copies *copies;
  size_t n;
  double *x;
  row *rows;
  bw_particles_cells cells;
} surroundings;

static surroundings look_around(const motion *m)
{
  surroundings s = {0};
  size_t rows = 0;
  int32_t *own = NULL;
  int *destination = NULL;
  bw_check_ok(bw_particles_space_near(m->space, m->n, m->x, REACH, &rows, &own, &destination));
  bw_check_ok(bw_particles_copies_offer(bw_check_world(), m->n, rows, own, destination,
                                        3 * sizeof *s.x, &s.copies));
  s.n = m->n + bw_particles_copies_count(s.copies);
  bw_check_ok(BW_ALLOCATE(&s.x, 3 * s.n));
  bw_check_ok(BW_ALLOCATE(&s.rows, s.n));
  bw_particles_copies_values(s.copies, 3 * sizeof *s.x, m->x, s.x);
  bw_particles_copies_values(s.copies, sizeof *s.rows, m->rows, s.rows);
  bw_check_ok(bw_particles_cells_create(s.n, s.x, REACH, PERIOD, &s.cells));
  bw_release(&own);
  bw_release(&destination);
  return s;
}

static void forget(surroundings *s)
{
  bw_particles_copies_destroy(&s->copies);
  bw_particles_cells_destroy(&s->cells);
  bw_release(&s->x);
  bw_release(&s->rows);
}

/* A copy is where the point of its identity is, and belongs to somebody else. */
static void check_copies(const motion *m, const surroundings *s)
{
  for (size_t e = m->n; e < s->n; e++) {
    const row want = row_of(s->rows[e].id);
    if (memcmp(s->x + 3 * e, m->all + 3 * want.id, 3 * sizeof *s->x) != 0 ||
        want.weight != s->rows[e].weight)
      ck_abort_msg("copy %zu is not of point %lld", e, (long long)want.id);
    if (bw_particles_space_owner(m->space, s->x + 3 * e) == bw_comm_rank(bw_check_world()))
      ck_abort_msg("point %lld is copied to its owner", (long long)want.id);
  }
}

static bool nearer(const double a[3], const double b[3])
{
  double d = fabs(b[0] - a[0]), sum;
  d -= PERIOD[0] * rint(d / PERIOD[0]);
  sum = d * d;
  for (int k = 1; k < 3; k++)
    sum += (b[k] - a[k]) * (b[k] - a[k]);
  return sum < REACH * REACH;
}

/* Neighbours by all POINTS: their number, the sum of their weights, and a mix of their identities
 * that tells which they are. */
static void brute_force(const motion *m, int64_t id, size_t *count, double *weight, uint64_t *who)
{
  *count = 0, *weight = 0, *who = 0;
  for (int64_t j = 0; j < POINTS; j++)
    if (j != id && nearer(m->all + 3 * id, m->all + 3 * j)) {
      ++*count;
      *weight += (double)row_of(j).weight;
      *who += scramble((uint64_t)j);
    }
}

/* One point of 5000, and one of 100 from which another rank's place is within reach. */
static bool in_sample(const motion *m, size_t i, int step)
{
  if ((m->rows[i].id + step) % (POINTS / SAMPLE) == 0) return true;
  if ((m->rows[i].id + step) % 100 != 0) return false;
  for (int k = 0; k < 6; k++) {
    double x[3];
    memcpy(x, m->x + 3 * i, sizeof x);
    x[k / 2] += k % 2 == 0 ? REACH : -REACH;
    if (bw_particles_space_owner(m->space, x) != bw_comm_rank(bw_check_world())) return true;
  }
  return false;
}

/* Every own point finds its neighbours and gives each of them its weight; what copies are given
 * goes back to their owners. */
static void check_neighbours(motion *m, const surroundings *s, int step)
{
  enum { ROOM = 200 };
  int32_t near[ROOM];
  double *given = NULL;
  size_t *number = NULL, found;
  uint64_t *who = NULL;
  bw_check_ok(BW_ALLOCATE(&given, s->n));
  bw_check_ok(BW_ALLOCATE(&number, m->n));
  bw_check_ok(BW_ALLOCATE(&who, m->n));
  for (size_t i = 0; i < m->n; i++) {
    if (bw_particles_cells_near(&s->cells, s->x, s->x + 3 * i, REACH, ROOM, near, &found) !=
            BW_OK ||
        found > ROOM)
      ck_abort_msg("%zu neighbours, or: %s", found, bw_last_message());
    for (size_t q = 0; q < found; q++) {
      if (near[q] == (int32_t)i) continue;
      given[near[q]] += (double)m->rows[i].weight;
      who[i] += scramble((uint64_t)s->rows[near[q]].id);
      number[i]++;
    }
    m->pairs += number[i];
  }
  bw_particles_copies_sum(s->copies, 1, given);
  for (size_t i = 0; i < m->n; i++) {
    if (!in_sample(m, i, step)) continue;
    size_t count;
    double weight;
    uint64_t mix;
    brute_force(m, m->rows[i].id, &count, &weight, &mix);
    ck_assert_uint_eq(number[i], count);
    ck_assert(who[i] == mix);
    ck_assert_double_eq(given[i], weight);
  }
  bw_release(&given);
  bw_release(&number);
  bw_release(&who);
}

START_TEST(points_move_through_a_box)
{
  motion m = {0};
  begin(&m);
  for (int step = 0; step < STEPS; step++) {
    move(&m, step);
    if (step % DIVIDE_EVERY == 0) divide_space(&m);
    migrate(&m, step);
    surroundings s = look_around(&m);
    check_copies(&m, &s);
    if (step % LOOK_EVERY == 0) check_neighbours(&m, &s, step);
    forget(&s);
  }
  /* Nothing of this is empty: points change ranks after the first step too, and have neighbours. */
  int64_t pairs = (int64_t)m.pairs;
  bw_comm_sum_int(bw_check_world(), 1, &pairs);
  ck_assert_int_gt(pairs, (int64_t)10 * POINTS * STEPS / LOOK_EVERY);
  if (bw_comm_size(bw_check_world()) > 1) ck_assert_int_gt(m.arrived, POINTS / 10);
  /* A rank has whole cells, of 3.6 points in the mean and not above 30 by chance: what each of its
   * two cuts is wrong by, of 25 000 points at least. */
  ck_assert_double_lt(m.most, 1 + 2 * 30 / 25000.0);
  bw_particles_space_destroy(&m.space);
  bw_release(&m.x);
  bw_release(&m.rows);
  bw_release(&m.all);
  bw_release(&m.start);
  bw_release(&m.speed);
}
END_TEST

/* Positions that are absurd have an owner, the same on all ranks, and migrate. */
START_TEST(lost_points_have_an_owner)
{
  static const double lost[6] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e15};
  const bw_comm *comm = bw_check_world();
  bw_particles_space_config config = bw_particles_space_config_default();
  bw_particles_space *space = NULL;
  double x[3 * 36], *x_out = NULL;
  void *rows_out = NULL;
  size_t n = 0;
  bw_check_status(bw_particles_space_create(comm, &config, 0, NULL, &space), BW_EINPUT);
  ck_assert_ptr_null(space);
  for (size_t q = 0; q < 36; q++)
    for (size_t k = 0; k < 3; k++)
      x[3 * q + k] = k == q % 3 ? lost[q % 6] : fraction_of(3 * q + k);
  config.edge = 0.1;
  config.period[1] = 1e-3;
  bw_check_ok(bw_particles_space_create(comm, &config, 36, x, &space));
  for (size_t q = 0; q < 36; q++) {
    int64_t owner[2] = {bw_particles_space_owner(space, x + 3 * q), 0};
    owner[1] = -owner[0];
    bw_comm_max_int(comm, 2, owner);
    ck_assert_int_eq(owner[0], -owner[1]);
  }
  bw_check_ok(bw_particles_migrate(space, 36, x, 0, NULL, &n, &x_out, &rows_out));
  int64_t total = (int64_t)n;
  bw_comm_sum_int(comm, 1, &total);
  ck_assert_int_eq(total, 36 * bw_comm_size(comm));
  size_t rows;
  int32_t *own = NULL;
  int *destination = NULL;
  bw_check_ok(bw_particles_space_near(space, n, x_out, 0.4, &rows, &own, &destination));
  bw_release(&own);
  bw_release(&destination);
  bw_check_status(bw_particles_space_near(space, n, x_out, 0.5, &rows, &own, &destination),
                  BW_EINPUT);
  bw_check_status(bw_particles_space_near(space, n, x_out, NAN, &rows, &own, &destination),
                  BW_EINPUT);
  bw_release(&x_out);
  bw_release(&rows_out);
  bw_particles_space_destroy(&space);
}
END_TEST

/* The checksum sees a changed bit and a lost or doubled row, and no order. */
START_TEST(the_checksum_tells_rows_apart)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  int32_t a[3][3] = {{1, 2, me}, {3, 4, me}, {5, 6, me}}, b[4][3];
  const uint64_t sum = bw_particles_checksum(comm, 3, sizeof a[0], a);
  /* The same rows in another order and with other ranks. */
  for (int q = 0; q < 3; q++) {
    memcpy(b[q], a[2 - q], sizeof b[q]);
    b[q][2] = (me + 1) % size;
  }
  ck_assert(bw_particles_checksum(comm, 3, sizeof b[0], b) == sum);
  memcpy(b[3], b[0], sizeof b[3]);
  ck_assert(bw_particles_checksum(comm, me == 0 ? 4 : 3, sizeof b[0], b) != sum);
  ck_assert(bw_particles_checksum(comm, me == 0 ? 2 : 3, sizeof b[0], b) != sum);
  if (me == size - 1) b[1][1] ^= 1 << 20;
  ck_assert(bw_particles_checksum(comm, 3, sizeof b[0], b) != sum);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(points_move_through_a_box),
                                      BW_TEST(lost_points_have_an_owner),
                                      BW_TEST(the_checksum_tells_rows_apart)};
BW_CHECK_MAIN("particles.motion", tests)
