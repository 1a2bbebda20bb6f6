/* The book of the coupling stops what makes energy, within 500 steps and with a remedy, and nothing
 * else: a body in fluid at rest, plane, that begins to move; values that do not hold set by hand.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2 timeout=600 */
#include "../../../validation/coupler/block.h"
#include "bw_check.h"

#include <string.h>

enum { STEPS = 500 };
static const double SPEED = 1e-2;

/* Steps that were made before one failed; its status. */
static int march(const block_set_up *b, bw_status *st)
{
  block_scene s;
  int n = 0;
  bw_check_ok(block_create(bw_check_world(), b, &s));
  *st = BW_OK;
  while (n < STEPS && *st == BW_OK) {
    *st = bw_coupler_step(s.coupler, b->dt);
    n += *st == BW_OK;
  }
  block_destroy(&s);
  return n;
}

/* What grows ends with the coupling named as its cause, and what to change. */
START_TEST(what_grows_is_stopped)
{
  static const struct {
    block_body body;
    double ratio, w, virtual_mass;
    int iterations;
    const char *remedy;
  } bad[] = {
      {A_BLOCK, 0.3, 1.0, 0.0, 0, "smaller load_relaxation"}, /* holds from 0.55, 0.73 on */
      {A_CYLINDER, 0.3, 1.0, 0.0, 0, "smaller load_relaxation"},
      {A_PLATE, 1.0, 1.0, 0.0, 0, "smaller load_relaxation"},
      {A_PLATE, 0.1, 0.3, 1.0, 0, "smaller load_relaxation"},
      {A_PLATE, 0.002, 0.1, 1.0, 50, "smaller steps"},
  };
  for (size_t q = 0; q < sizeof bad / sizeof *bad; q++)
    for (int load = BW_LOAD_PROBES; load <= BW_LOAD_REACTION; load++) {
      const block_set_up b = {.body = bad[q].body,
                              .ratio = bad[q].ratio,
                              .w = bad[q].w,
                              .virtual_mass = bad[q].virtual_mass,
                              .iterations = bad[q].iterations,
                              .dt = DT,
                              .load = (bw_coupler_load_kind)load,
                              .speed = SPEED};
      bw_status st;
      const int n = march(&b, &st);
      ck_assert_int_lt(n, STEPS);
      ck_assert(st == BW_EDIVERGED || st == BW_ECFL);
      ck_assert_ptr_nonnull(strstr(bw_last_message(), "coupling of fluid and solid"));
      ck_assert_ptr_nonnull(strstr(bw_last_message(), bad[q].remedy));
    }
}
END_TEST

/* The same bodies with what the coupler chooses. */
START_TEST(what_holds_is_left_alone)
{
  static const double ratio[3] = {10.0, 1.0, 0.1};
  for (int body = A_BLOCK; body <= A_PLATE; body++)
    for (int q = 0; q < 6; q++) {
      const block_set_up b = {.body = (block_body)body,
                              .ratio = ratio[q / 2],
                              .w = NAN,
                              .virtual_mass = 1.0,
                              .dt = DT,
                              .load = (bw_coupler_load_kind)(q % 2),
                              .speed = SPEED};
      bw_status st;
      ck_assert_int_eq(march(&b, &st), STEPS);
      bw_check_ok(st);
    }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(what_grows_is_stopped),
                                      BW_TEST(what_holds_is_left_alone)};
BW_CHECK_MAIN("coupler.book_stops", tests)
