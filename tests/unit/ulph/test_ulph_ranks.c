/* The same dam break on any number of ranks, and after a restart on another division: to the last
 * bit. The book: what changes momentum and angular momentum stands on its lines.
 * TEST ranks=1,2,3 */
#include "ulph_test.h"

enum { STEPS = 90, BEFORE = 50 };

/* By value: zeros that are summed over ranks lose their sign. */
static void check_equal(const double a[], const double b[], size_t n)
{
  for (size_t q = 0; q < BW_ULPH_ROW * n; q++)
    if (a[q] != b[q])
      ck_abort_msg("number %zu of particle %zu: %.17g, %.17g", q % BW_ULPH_ROW, q / BW_ULPH_ROW,
                   a[q], b[q]);
}

static void same_as_alone(int d, int n)
{
  bw_comm *self = NULL;
  double numbers[2][BW_ULPH_NUMBERS];
  bw_check_ok(bw_comm_self(&self));
  bw_ulph *one = ulph_dam(self, d, n, 2), *all = ulph_dam(bw_check_world(), d, n, 2);
  ulph_advance(one, STEPS);
  ulph_advance(all, STEPS);
  ck_assert_int_ge(bw_ulph_rebuilds(all), 4);
  double *a = ulph_all(self, one, numbers[0]), *b = ulph_all(bw_check_world(), all, numbers[1]);
  check_equal(a, b, (size_t)bw_ulph_total(one));
  ck_assert_double_eq(bw_ulph_time(one), bw_ulph_time(all));
  bw_release(&a);
  bw_release(&b);
  bw_ulph_destroy(&one);
  bw_ulph_destroy(&all);
  bw_comm_destroy(&self);
}

START_TEST(any_number_of_ranks_gives_the_same_bits)
{
  same_as_alone(2, 12);
  same_as_alone(3, 6);
}
END_TEST

/* Who is near is found anew only when somebody may have come: as if it were in each step. */
START_TEST(lists_of_who_is_near_miss_nobody)
{
  double numbers[2][BW_ULPH_NUMBERS];
  const bw_comm *comm = bw_check_world();
  bw_ulph *kept = ulph_dam(comm, 2, 12, 2), *found = ulph_dam(comm, 2, 12, 2);
  ulph_advance(kept, STEPS);
  for (int q = 0; q < STEPS; q++) {
    found->strayed = INFINITY;
    ulph_advance(found, 1);
  }
  double *a = ulph_all(comm, kept, numbers[0]), *b = ulph_all(comm, found, numbers[1]);
  check_equal(a, b, (size_t)bw_ulph_total(kept));
  bw_release(&a);
  bw_release(&b);
  bw_ulph_destroy(&kept);
  bw_ulph_destroy(&found);
}
END_TEST

/* Rows go to ranks by turns, whoever had them. */
static void restart(bw_ulph *from, bw_ulph *to)
{
  const bw_comm *comm = bw_check_world();
  double numbers[BW_ULPH_NUMBERS], *rows = NULL, *all = ulph_all(comm, from, numbers);
  const int64_t total = bw_ulph_total(from);
  int64_t *id = NULL;
  size_t n = 0;
  bw_check_ok(BW_ALLOCATE(&rows, BW_ULPH_ROW * (size_t)total));
  bw_check_ok(BW_ALLOCATE(&id, (size_t)total));
  for (int64_t q = 0; q < total; q++)
    if (q % bw_comm_size(comm) == bw_comm_rank(comm)) {
      memcpy(rows + BW_ULPH_ROW * n, all + BW_ULPH_ROW * q, BW_ULPH_ROW * sizeof *rows);
      id[n++] = q;
    }
  bw_check_ok(bw_ulph_state_set(to, n, id, rows, numbers));
  /* A row that is missing is noticed. */
  if (bw_comm_rank(comm) == 0) id[0] = id[1];
  bw_check_status(bw_ulph_state_set(from, n, id, rows, numbers), BW_EINPUT);
  bw_release(&rows);
  bw_release(&id);
  bw_release(&all);
}

START_TEST(a_restart_goes_on_to_the_last_bit)
{
  const bw_comm *comm = bw_check_world();
  double numbers[2][BW_ULPH_NUMBERS];
  bw_ulph *whole = ulph_dam(comm, 2, 12, 2), *part = ulph_dam(comm, 2, 12, 2);
  bw_ulph *rest = ulph_dam(comm, 2, 12, 2);
  ulph_advance(whole, STEPS);
  ulph_advance(part, BEFORE);
  restart(part, rest);
  ulph_advance(rest, STEPS - BEFORE);
  double *a = ulph_all(comm, whole, numbers[0]), *b = ulph_all(comm, rest, numbers[1]);
  check_equal(a, b, (size_t)bw_ulph_total(whole));
  ck_assert(memcmp(numbers[0], numbers[1], sizeof numbers[0]) == 0);
  bw_release(&a);
  bw_release(&b);
  bw_ulph_destroy(&whole);
  bw_ulph_destroy(&part);
  bw_ulph_destroy(&rest);
}
END_TEST

/* Momentum and spin now are those of the lines, to the round-off of what they are sums of. */
START_TEST(the_book_of_momentum_closes)
{
  for (int shifting = 0; shifting <= 2; shifting += 2) {
    bw_ulph *u = ulph_dam(bw_check_world(), 2, 12, shifting);
    const double mass = bw_ulph_account(u).mass;
    ulph_advance(u, 150);
    const bw_ulph_ledger l = bw_ulph_account(u);
    double size[2] = {0, 0};
    ck_assert_double_eq_tol(l.mass, mass, 1e-13 * mass);
    for (int k = 0; k < 3; k++) {
      double push = l.momentum[k], turn = l.spin[k];
      for (int who = 0; who < 4; who++) {
        push -= l.push[who][k], turn -= l.turn[who][k];
        size[0] = fmax(size[0], fabs(l.push[who][k]));
        size[1] = fmax(size[1], fabs(l.turn[who][k]));
      }
      ck_assert_double_le(fabs(push), 1e-12 * fmax(size[0], 1));
      ck_assert_double_le(fabs(turn), 1e-12 * fmax(size[1], 1));
    }
    ck_assert_double_gt(size[0], 100);
    ck_assert((fabs(l.push[3][0]) > 0) == (shifting > 0));
    /* The energy closes to a thousandth of the first potential energy. */
    ck_assert_double_le(fabs(l.gap), 1e-3 * l.first);
    ck_assert_double_lt(l.artificial, 0);
    bw_ulph_destroy(&u);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(any_number_of_ranks_gives_the_same_bits),
    BW_TEST(lists_of_who_is_near_miss_nobody),
    BW_TEST(a_restart_goes_on_to_the_last_bit),
    BW_TEST(the_book_of_momentum_closes),
};
BW_CHECK_MAIN("ulph ranks", tests)
