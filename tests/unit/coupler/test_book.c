/* The book of the coupling, and what is said of loads that do not suit.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2 timeout=600 */
#include "cube_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A free cube, taken along by the stream. By the reaction the load is what the markers gave, so
 * that nothing is unseen, to the rounding of moments that are carried; by probes it is not. */
START_TEST(the_book_is_that_of_the_load)
{
  for (int load = BW_LOAD_PROBES; load <= BW_LOAD_REACTION; load++) {
    scene s = build(0.3, 0.1);
    bw_coupler_report r;
    s.coupler->config.load = (bw_coupler_load_kind)load;
    s.coupler->config.count_work = true;
    bw_coupler_hold_solid(s.coupler, false);
    for (int q = 0; q < 20; q++)
      bw_check_ok(bw_coupler_step(s.coupler, 1e-3));
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    ck_assert_double_gt(fabs(r.work_given), 0.0);
    ck_assert_double_gt(fabs(r.work_received), 0.0);
    const bool seen = fabs(r.work_unseen) < 10.0 * ROUND_OFF * fabs(r.work_given);
    ck_assert(seen == (load == BW_LOAD_REACTION));
    ck_assert(bw_coupler_sound(s.coupler));
    destroy(&s);
  }
}
END_TEST

/* Without relaxation nothing of the load is held back for a later step. */
START_TEST(a_load_that_is_felt_at_once_is_not_late)
{
  scene s = build(0.3, 1.0);
  bw_coupler_report r;
  s.coupler->config.load = BW_LOAD_REACTION;
  s.coupler->config.count_work = true;
  s.coupler->config.virtual_mass = 0.0;
  bw_coupler_hold_solid(s.coupler, false);
  for (int q = 0; q < 5; q++)
    bw_check_ok(bw_coupler_step(s.coupler, 1e-3));
  bw_check_ok(bw_coupler_measure(s.coupler, &r));
  ck_assert_double_gt(fabs(r.work_given), 0.0);
  ck_assert_double_le(fabs(r.work_late), ROUND_OFF * fabs(r.work_given));
  destroy(&s);
}
END_TEST

/* A free body loaded by probes: said once; by the reaction: not at all. */
START_TEST(a_load_that_does_not_suit_is_said_once)
{
  char text[256] = "";
  for (int load = BW_LOAD_PROBES; load <= BW_LOAD_REACTION; load++) {
    scene s = build(0.3, 0.1);
    bw_log *log = NULL;
    bw_log_config config = bw_log_config_default();
    bw_coupler_report r = {.probes_blocked = 0};
    config.err = tmpfile();
    ck_assert_ptr_nonnull(config.err);
    bw_check_ok(bw_log_create(bw_check_world(), &config, &log));
    s.coupler->config.load = (bw_coupler_load_kind)load;
    bw_coupler_warn_load(s.coupler, &r, log); /* held: it says nothing yet */
    ck_assert_int_eq(ftell(config.err), 0);
    bw_coupler_hold_solid(s.coupler, false);
    bw_coupler_warn_load(s.coupler, &r, log);
    const long said = ftell(config.err);
    bw_coupler_warn_load(s.coupler, &r, log);
    ck_assert_int_eq(ftell(config.err), said);
    const bool speaks = bw_comm_rank(bw_check_world()) == 0 && load == BW_LOAD_PROBES;
    ck_assert((said > 0) == speaks);
    rewind(config.err);
    if (speaks) ck_assert_ptr_nonnull(fgets(text, sizeof text, config.err));
    if (speaks) ck_assert_ptr_nonnull(strstr(text, "coupling.load: reaction"));
    bw_log_destroy(&log);
    fclose(config.err);
    destroy(&s);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(the_book_is_that_of_the_load),
                                      BW_TEST(a_load_that_is_felt_at_once_is_not_late),
                                      BW_TEST(a_load_that_does_not_suit_is_said_once)};
BW_CHECK_MAIN("coupler.book", tests)
