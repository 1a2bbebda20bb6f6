/* A test that fails on the last rank while the others wait for it: tests/robustness/assertion.sh
 * sees that all of them end. */
#include "bw_check.h"

START_TEST(fails_on_the_last_rank)
{
  const bw_comm *world = bw_check_world();
  ck_assert_msg(bw_comm_rank(world) + 1 < bw_comm_size(world), "planted");
  bw_comm_barrier(world);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(fails_on_the_last_rank)};
BW_CHECK_MAIN("fails_on_one_rank", tests)
