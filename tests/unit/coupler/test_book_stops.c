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

/* What grows ends with the coupling named as its cause, and what to change. The fast ones meet the
 * fluid's own limit before a window of the book has ended; the breathing of the plate
 * (stability.c), 4 % a step, is met by the book itself. */
START_TEST(what_grows_is_stopped)
{
  static const char slower[] = "smaller load_relaxation";
  static const struct {
    block_set_up of;
    const char *says, *remedy;
  } bad[] = {
      {{A_BLOCK, 0.3, 1.0, .load = BW_LOAD_PROBES}, "likely cause", slower},   /* from 0.55 on */
      {{A_BLOCK, 0.3, 1.0, .load = BW_LOAD_REACTION}, "likely cause", slower}, /* from 0.73 on */
      {{A_PLATE, 0.1, 0.3, 1.0, .load = BW_LOAD_PROBES}, "likely cause", slower},
      {{A_PLATE, 1.0, 0.1, 1.0, .load = BW_LOAD_REACTION}, "no physics since step", slower},
      {{A_PLATE, 0.1, .iterations = 50, .load = BW_LOAD_PROBES}, "coupling", "smaller steps"},
  };
  for (size_t q = 0; q < sizeof bad / sizeof *bad; q++) {
    block_set_up b = bad[q].of;
    bw_status st;
    b.dt = DT, b.speed = SPEED;
    ck_assert_int_lt(march(&b, &st), STEPS);
    ck_assert(st == BW_EDIVERGED || st == BW_ECFL);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), bad[q].says));
    ck_assert_ptr_nonnull(strstr(bw_last_message(), bad[q].remedy));
  }
}
END_TEST

/* The same plate with what the coupler chooses. */
START_TEST(what_holds_is_left_alone)
{
  for (int q = 0; q < 4; q++) {
    const block_set_up b = {.body = A_PLATE,
                            .ratio = q / 2 == 0 ? 1.0 : 0.1,
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
