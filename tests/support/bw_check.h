/* bw_check.h -- a Check program under MPI: every rank runs every test, in one process.
 *
 *   static const bw_check_test tests[] = {BW_TEST(function), ...};
 *   BW_CHECK_MAIN("module", tests)
 * Inside a test, bw_check_world() is the communicator of all ranks. A test that fails on one of
 * several ranks ends all of them at once, as the others may be waiting for it. */
#pragma once
#include "bw_comm.h"
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
  const char *name;
  const TTest **function; /* made by START_TEST */
} bw_check_test;
#define BW_TEST(function)                                                                          \
  {                                                                                                \
#function, &function                                                                           \
  }

static bw_comm *bw_check_world_;
static inline bw_comm *bw_check_world(void)
{
  return bw_check_world_;
}

/* |got - want| <= tolerance max(1, |want|) */
#define bw_check_near(got, want, tolerance)                                                        \
  ck_assert_msg(fabs((double)(got) - (double)(want)) <=                                            \
                    (tolerance)*fmax(1.0, fabs((double)(want))),                                   \
                "%s = %.17g, expected %.17g +- %g", #got, (double)(got), (double)(want),           \
                (double)(tolerance))
#define bw_check_ok(call) ck_assert_msg((call) == BW_OK, "%s failed: %s", #call, bw_last_message())
#define bw_check_status(call, code)                                                                \
  ck_assert_msg((call) == (code), "%s did not return %s: %s", #call, #code, bw_last_message())

/* One test by itself; returns how many failures. In this process: a forked child cannot use MPI. */
static inline int bw_check_one(const char *suite_name, const bw_check_test *test)
{
  Suite *suite = suite_create(suite_name);
  TCase *one = tcase_create(test->name);
  tcase_add_test(one, *test->function);
  suite_add_tcase(suite, one);
  SRunner *runner = srunner_create(suite);
  srunner_set_fork_status(runner, CK_NOFORK);
  srunner_run_all(runner, CK_SILENT);
  const int failed = srunner_ntests_failed(runner);
  if (failed > 0) {
    printf("on rank %d of %d, ", bw_comm_rank(bw_check_world_), bw_comm_size(bw_check_world_));
    srunner_print(runner, CK_NORMAL);
  }
  srunner_free(runner);
  return failed;
}

static inline int bw_check_run(int argc, char **argv, const char *suite_name, int n,
                               const bw_check_test tests[])
{
  if (bw_init(&argc, &argv, &bw_check_world_) != BW_OK) return EXIT_FAILURE;
  int failed = 0;
  for (int q = 0; q < n; q++) {
    failed += bw_check_one(suite_name, &tests[q]);
    if (failed > 0 && bw_comm_size(bw_check_world_) > 1)
      bw_comm_abort(bw_check_world_, EXIT_FAILURE);
  }
  if (bw_comm_rank(bw_check_world_) == 0)
    printf("%s: %d of %d tests hold\n", suite_name, n - failed, n);
  const int code = bw_finish(&bw_check_world_, BW_OK);
  return code != 0 || failed != 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}

#define BW_CHECK_MAIN(name, tests)                                                                 \
  int main(int argc, char **argv)                                                                  \
  {                                                                                                \
    return bw_check_run(argc, argv, name, (int)(sizeof(tests) / sizeof *(tests)), tests);          \
  }
