/* Exchange plans: every item arrives, in order of source; answers come back to their items.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_exchange.h"
#include "bw_memory.h"

/* Item i of rank r goes to rank (r + i) % size and carries the number 1000 r + i. */
START_TEST(items_arrive_in_order_and_answers_return)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  const size_t n = (size_t)(5 + 3 * me);
  int *destination = NULL;
  double *send = NULL, *receive = NULL;
  bw_exchange *plan = NULL;
  bw_check_ok(BW_ALLOCATE(&destination, n));
  bw_check_ok(BW_ALLOCATE(&send, n));
  for (size_t i = 0; i < n; i++)
    destination[i] = (me + (int)i) % size, send[i] = 1000.0 * me + (double)i;
  bw_check_ok(bw_exchange_create(comm, n, destination, &plan));
  bw_check_ok(BW_ALLOCATE(&receive, bw_exchange_received(plan)));
  bw_exchange_forward(plan, sizeof(double), send, receive);

  size_t q = 0;
  for (int r = 0; r < size; r++)
    for (int i = 0; i < 5 + 3 * r; i++)
      if ((r + i) % size == me) ck_assert_double_eq(receive[q++], 1000.0 * r + i);
  ck_assert_uint_eq(q, bw_exchange_received(plan));

  for (size_t k = 0; k < q; k++)
    receive[k] = -receive[k];
  double *answer = NULL;
  bw_check_ok(BW_ALLOCATE(&answer, n));
  bw_exchange_backward(plan, sizeof(double), receive, answer);
  for (size_t i = 0; i < n; i++)
    ck_assert_double_eq(answer[i], -send[i]);

  bw_release(&destination);
  bw_release(&send);
  bw_release(&receive);
  bw_release(&answer);
  bw_exchange_destroy(&plan);
}
END_TEST

/* An empty rank takes part; volume counts only what leaves the rank. */
START_TEST(empty_ranks_and_volume)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  const int destination[] = {0, 0, size - 1};
  const size_t n = me == 0 ? 3 : 0;
  bw_exchange *plan = NULL;
  bw_check_ok(bw_exchange_create(comm, n, destination, &plan));
  const size_t expected = (size_t)(me == 0 ? 2 : 0) + (size_t)(me == size - 1 ? 1 : 0);
  ck_assert_uint_eq(bw_exchange_received(plan), expected);
  ck_assert_uint_eq(bw_exchange_volume(plan, 8), me == 0 && size > 1 ? 8u : 0u);
  bw_exchange_destroy(&plan);
  ck_assert_ptr_null(plan);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(items_arrive_in_order_and_answers_return),
                                      BW_TEST(empty_ranks_and_volume)};
BW_CHECK_MAIN("core.exchange", tests)
