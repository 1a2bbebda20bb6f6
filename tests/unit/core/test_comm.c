/* Ranks agree, reduce, gather; memory; status messages.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_memory.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

/* The message is that of the lowest rank that failed, the code the largest. */
START_TEST(agreement_spreads_the_message)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  ck_assert_int_eq(bw_comm_agree(comm, BW_OK), BW_OK);
  for (int failing = 0; failing < size; failing++) {
    bw_status mine = BW_OK;
    char expected[64];
    snprintf(expected, sizeof expected, "rank %d has no memory", failing);
    if (me == failing) mine = BW_FAIL(BW_EMEM, "rank %d has no memory", me);
    if (me > failing) mine = BW_FAIL(BW_EIO, "rank %d has no disk", me);
    const bw_status worst = failing == size - 1 ? BW_EMEM : BW_EIO;
    ck_assert_int_eq(bw_comm_agree(comm, mine), worst);
    ck_assert_str_eq(bw_last_message(), expected);
  }
}
END_TEST

START_TEST(reductions)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  double sum[2] = {me + 1.0, -1.0}, high[2] = {me, -me}, low[2] = {me, -me};
  int64_t sum_int = (INT64_C(1) << 40) + me, high_int[2] = {me, -(INT64_C(1) << 40) - me};
  uint64_t bits = UINT64_C(1) << (me + 50), all = 0;
  bw_comm_sum(comm, 2, sum);
  bw_comm_max(comm, 2, high);
  bw_comm_min(comm, 2, low);
  bw_comm_sum_int(comm, 1, &sum_int);
  bw_comm_max_int(comm, 2, high_int);
  bw_comm_xor(comm, 1, &bits);
  for (int r = 0; r < size; r++)
    all |= UINT64_C(1) << (r + 50);
  ck_assert_double_eq(sum[0], size * (size + 1) / 2.0);
  ck_assert_double_eq(sum[1], -size);
  ck_assert(high[0] == size - 1 && high[1] == 0.0);
  ck_assert(low[0] == 0.0 && low[1] == -(size - 1));
  ck_assert_int_eq(sum_int, size * (INT64_C(1) << 40) + size * (size - 1) / 2);
  ck_assert_int_eq(high_int[0], size - 1);
  ck_assert_int_eq(high_int[1], -(INT64_C(1) << 40));
  ck_assert(bits == all);
  bw_comm_xor(comm, 1, &bits); /* all the same: they cancel for an even number of ranks */
  ck_assert(bits == (size % 2 == 0 ? 0 : all));
}
END_TEST

START_TEST(prefix_sum_and_broadcast)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  const int64_t below = bw_comm_prefix_sum(comm, (INT64_C(1) << 33) + me);
  ck_assert_int_eq(below, me * (INT64_C(1) << 33) + me * (me - 1) / 2);
  double x[3] = {me, me + 0.25, me + 0.5};
  bw_comm_broadcast(comm, sizeof x, x);
  ck_assert(x[0] == 0.0 && x[1] == 0.25 && x[2] == 0.5);
  bw_comm_broadcast(comm, 0, NULL);
}
END_TEST

/* Rank r gives r numbers (rank 0 none), in rank order. */
static void expect_gathered(const int *got, size_t total)
{
  const int size = bw_comm_size(bw_check_world());
  size_t at = 0;
  for (int r = 0; r < size; r++)
    for (int q = 0; q < r; q++)
      ck_assert_int_eq(got[at++], 100 * r + q);
  ck_assert_uint_eq(total, at * sizeof *got);
}

START_TEST(gathering_with_empty_ranks)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  int mine[4] = {100 * me, 100 * me + 1, 100 * me + 2, 100 * me + 3};
  size_t total = 99;
  void *all = NULL;
  bw_check_ok(bw_comm_gather(comm, sizeof(int) * (size_t)me, me == 0 ? NULL : mine, &total, &all));
  if (me == 0)
    expect_gathered(all, total);
  else
    ck_assert(all == NULL && total == 0);
  bw_release(&all);
  bw_check_ok(
      bw_comm_allgather(comm, sizeof(int) * (size_t)me, me == 0 ? NULL : mine, &total, &all));
  expect_gathered(all, total);
  bw_release(&all);
  bw_check_ok(bw_comm_gather(comm, 0, NULL, &total, &all)); /* nobody has anything */
  ck_assert_uint_eq(total, 0);
  bw_release(&all);
}
END_TEST

/* In messages of a byte, one after the other: as in one call. */
START_TEST(gathering_byte_by_byte)
{
  bw_comm *cut = NULL;
  bw_check_ok(bw_comm_copy(bw_check_world(), 1, &cut));
  const char mine = (char)(65 + bw_comm_rank(cut));
  size_t total = 0;
  void *all = NULL;
  bw_check_ok(bw_comm_allgather(cut, 1, &mine, &total, &all));
  ck_assert_uint_eq(total, (size_t)bw_comm_size(cut));
  ck_assert_mem_eq(all, "ABCD", total);
  bw_release(&all);
  bw_comm_destroy(&cut);
}
END_TEST

/* More than the memory holds is refused on all ranks. */
START_TEST(gathering_too_much)
{
  const bw_comm *comm = bw_check_world();
  size_t total = 0;
  void *all = NULL;
  char x = 0;
  const size_t bytes = bw_comm_rank(comm) == 0 ? SIZE_MAX - 8 : 1; /* 64 more are no size_t */
  bw_check_status(bw_comm_gather(comm, bytes, &x, &total, &all), BW_EMEM);
  ck_assert_ptr_null(all);
  bw_check_status(bw_comm_allgather(comm, bytes, &x, &total, &all), BW_EMEM);
  ck_assert_ptr_null(all);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "exceeds the address space"));
  if (bw_comm_size(comm) == 1) return;
  bw_check_status(bw_comm_allgather(comm, SIZE_MAX / 2 + 1, &x, &total, &all), BW_EMEM);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "more than an address can name"));
}
END_TEST

START_TEST(a_group_of_one)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  ck_assert_int_eq(bw_comm_rank(self), 0);
  ck_assert_int_eq(bw_comm_size(self), 1);
  double x = bw_comm_rank(bw_check_world());
  bw_comm_sum(self, 1, &x);
  ck_assert_double_eq(x, bw_comm_rank(bw_check_world()));
  bw_comm_destroy(&self);
  ck_assert_ptr_null(self);
  bw_comm_destroy(&self);
}
END_TEST

/* 64 MiB of zeroed memory are resident (bw_allocate touches every page), and gone afterwards. */
START_TEST(resident_memory_grows_and_shrinks)
{
  const double MiB = 1048576.0, before = (double)bw_memory_resident() / MiB;
  unsigned char *p = NULL;
  bw_check_ok(BW_ALLOCATE(&p, (size_t)64 << 20));
  const double during = (double)bw_memory_resident() / MiB;
  bw_release(&p);
  const double after = (double)bw_memory_resident() / MiB, peak = (double)bw_memory_peak() / MiB;
  ck_assert_double_gt(before, 0.0);
  ck_assert_double_ge(during - before, 60.0);
  ck_assert_double_ge(peak - before, 60.0); /* it remembers */
#ifdef __SANITIZE_ADDRESS__ /* it keeps what was freed for a while, to find late accesses */
  (void)after;
#else
  ck_assert_double_le(after - before, 4.0);
#endif
}
END_TEST

START_TEST(memory)
{
  double *x = NULL;
  bw_check_ok(BW_ALLOCATE(&x, 1000));
  ck_assert_uint_eq((uintptr_t)x % 64, 0);
  for (int q = 0; q < 1000; q++)
    ck_assert_double_eq(x[q], 0.0);
  bw_release(&x);
  ck_assert_ptr_null(x);
  bw_release(&x);
  bw_check_ok(BW_ALLOCATE(&x, 0));
  ck_assert_ptr_nonnull(x);
  bw_release(&x);
  bw_check_ok(BW_ENLARGE(&x, 0, 3)); /* of nothing */
  for (int q = 0; q < 3; q++)
    x[q] = q + 1.0;
  bw_check_status(BW_ENLARGE(&x, 3, SIZE_MAX / 8), BW_EMEM); /* what is there stays */
  bw_check_ok(BW_ENLARGE(&x, 2, 1000));
  ck_assert_double_eq(x[0], 1.0);
  ck_assert_double_eq(x[1], 2.0);
  for (int q = 2; q < 1000; q++)
    ck_assert_double_eq(x[q], 0.0);
  bw_release(&x);
  /* count * size wraps to a small number */
  bw_check_status(BW_ALLOCATE(&x, SIZE_MAX / 8 + 2), BW_EMEM);
  ck_assert_ptr_null(x);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "exceeds the address space"));
  bw_check_status(BW_ALLOCATE(&x, SIZE_MAX / 8), BW_EMEM); /* only the rounding up wraps */
  ck_assert_ptr_null(x);
  x = (double *)8; /* a failure clears what was there: freeing it would crash */
  bw_check_status(BW_ALLOCATE(&x, SIZE_MAX / 4), BW_EMEM);
  ck_assert_ptr_null(x);
}
END_TEST

START_TEST(messages)
{
  ck_assert_int_eq(BW_FAIL(BW_ECFL, "dt = %g", 0.5), BW_ECFL);
  ck_assert_str_eq(bw_last_message(), "dt = 0.5");
  ck_assert_int_eq(BW_FAIL(BW_EIO, "again: %s", bw_last_message()), BW_EIO);
  ck_assert_str_eq(bw_last_message(), "again: dt = 0.5");
  ck_assert_str_eq(bw_status_text(BW_OK), "success");
  for (int code = 2; code <= 7; code++)
    ck_assert_str_ne(bw_status_text((bw_status)code), "unknown status");
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(agreement_spreads_the_message),
                                      BW_TEST(reductions),
                                      BW_TEST(prefix_sum_and_broadcast),
                                      BW_TEST(gathering_with_empty_ranks),
                                      BW_TEST(gathering_byte_by_byte),
                                      BW_TEST(gathering_too_much),
                                      BW_TEST(a_group_of_one),
                                      BW_TEST(memory),
                                      BW_TEST(resident_memory_grows_and_shrinks),
                                      BW_TEST(messages)};
BW_CHECK_MAIN("core.comm", tests)
