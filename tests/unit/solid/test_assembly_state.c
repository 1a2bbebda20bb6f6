/* Sets of solids whose state is changed from outside: checkpoints, retiring, what is refused.
 * TEST ranks=1,2,3 */
#include "assembly_scene.h"

/* In the middle of a bounce both solids go on from a checkpoint, in a new set. */
START_TEST(a_restart_in_a_bounce_goes_on)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  scene t = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.2 * bw_solid_assembly_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 2000)
    steps(&s, 1, dt);
  ck_assert_double_gt(book(&s).contact, 0);
  pd_restart_from(s.plate, t.plate);
  pd_restart_from(s.ball, t.ball);
  const bw_solid_ledger before = book(&s), after = book(&t);
  bw_check_near(energy(&after), energy(&before), 1e3 * BW_REAL_EPSILON);
  steps(&s, 60, dt);
  steps(&t, 60, dt);
  pd_check_same(s.ball, t.ball, bw_solid_get_position, 1e4 * BW_REAL_EPSILON);
  pd_check_same(s.plate, t.plate, bw_solid_get_position, 1e4 * BW_REAL_EPSILON);
  scene_release(&s);
  scene_release(&t);
}
END_TEST

/* Retired in the middle of a bounce: no pairs any more, what was stored is booked or flies on. */
START_TEST(a_retired_ball_is_left_alone)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.2 * bw_solid_assembly_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 2000)
    steps(&s, 1, dt);
  ck_assert_int_gt(bw_solid_assembly_pairs(s.set), 0);
  bool *gone = NULL;
  bw_check_ok(BW_ALLOCATE(&gone, bw_solid_count(s.ball)));
  for (size_t i = 0; i < bw_solid_count(s.ball); i++)
    gone[i] = true;
  bw_check_ok(bw_solid_retire(s.ball, gone));
  const double before = upward(&s);
  steps(&s, 20, dt);
  ck_assert_int_eq(bw_solid_assembly_pairs(s.set), 0);
  ck_assert_double_eq(book(&s).contact, 0);
  ck_assert_double_eq(upward(&s), before);
  bw_release(&gone);
  scene_release(&s);
}
END_TEST

/* Whatever takes the forces of one solid alone anew, with the same state: the next step has those
 * of both, once. What was left out or counted twice would be missing from the momentum. */
static void check_anew(void (*touch)(bw_solid *))
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.1 * bw_solid_assembly_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 4000)
    steps(&s, 1, dt);
  touch(s.ball);
  const bw_solid_ledger before = book(&s);
  touch(s.ball);
  steps(&s, 40, dt);
  const bw_solid_ledger after = book(&s);
  for (int k = 0; k < 3; k++)
    bw_check_near(after.momentum[k], before.momentum[k], 1e4 * BW_REAL_EPSILON);
  bw_check_near(energy(&after) / energy(&before), 1, 0.002);
  scene_release(&s);
}

static void set_again(bw_solid *ball)
{
  const size_t m = bw_solid_count(ball);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * m));
  bw_check_ok(BW_ALLOCATE(&V, 3 * m));
  bw_solid_get_position(ball, X);
  bw_solid_get_velocity(ball, V);
  bw_solid_set_state(ball, X, V);
  bw_release(&X);
  bw_release(&V);
}

static void evaluate_alone(bw_solid *ball)
{
  bw_check_ok(bw_solid_evaluate(ball));
}

/* The state of a ball whose forces were taken alone, in a set of its own: the same motion. */
static void check_restart_anew(void (*touch)(bw_solid *))
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  scene t = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.1 * bw_solid_assembly_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 4000)
    steps(&s, 1, dt);
  touch(s.ball);
  pd_restart_from(s.plate, t.plate);
  pd_restart_from(s.ball, t.ball);
  steps(&s, 20, dt);
  steps(&t, 20, dt);
  pd_check_same(s.plate, t.plate, bw_solid_get_velocity, 1e4 * BW_REAL_EPSILON);
  pd_check_same(s.ball, t.ball, bw_solid_get_velocity, 1e4 * BW_REAL_EPSILON);
  scene_release(&s);
  scene_release(&t);
}

START_TEST(forces_of_one_taken_alone_do_not_lose_the_others)
{
  check_restart_anew(set_again);
  check_restart_anew(evaluate_alone);
  check_anew(set_again);
  check_anew(evaluate_alone);
}
END_TEST

static void refused(bw_solid_config c, bw_solid_config d, const char *word)
{
  pd_body one = pd_box(4, 4, 1);
  bw_solid *two[] = {pd_make(bw_check_world(), &c, &one), pd_make(bw_check_world(), &d, &one)};
  bw_solid_assembly *set = NULL;
  bw_check_status(bw_solid_assembly_create(2, two, &set), BW_EINPUT);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "%s", bw_last_message());
  ck_assert_ptr_null(set);
  for (int b = 0; b < 2; b++)
    bw_solid_destroy(&two[b]);
  pd_body_release(&one);
}

START_TEST(what_does_not_go_together_is_named)
{
  bw_solid_config c = pd_soft(BW_PD_3D), d = c;
  d.origin[0] = 3;
  d.integrator = BW_SOLID_RK3;
  refused(c, d, "rk3");
  d = c;
  refused(c, d, "pierce");
  d.origin[0] = 30, d.period[1] = 4;
  refused(c, d, "period[1]");
  c = pd_soft(BW_PD_PLANE_STRESS), d = c;
  d.origin[0] = 3, d.thickness = 2;
  refused(c, d, "thickness");
  pd_body one = pd_box(4, 4, 1);
  bw_solid *s = pd_make(bw_check_world(), &c, &one);
  bw_solid_assembly *set = NULL;
  bw_check_status(bw_solid_assembly_create(2, (bw_solid *[]){s, s}, &set), BW_EINPUT);
  bw_check_ok(bw_solid_assembly_create(1, &s, &set));
  bw_check_status(bw_solid_assembly_step(set, 2 * bw_solid_dt_max(s)), BW_ECFL);
  bw_check_ok(bw_solid_assembly_step(set, bw_solid_assembly_dt(set)));
  bw_solid_assembly_destroy(&set);
  bw_solid_destroy(&s);
  pd_body_release(&one);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_restart_in_a_bounce_goes_on),
                                      BW_TEST(a_retired_ball_is_left_alone),
                                      BW_TEST(forces_of_one_taken_alone_do_not_lose_the_others),
                                      BW_TEST(what_does_not_go_together_is_named)};
BW_CHECK_MAIN("solid_assembly_state", tests)
