/* The correspondence law through what a solid does: force and energy, momenta, breaking to pieces,
 * memory, ranks, restarts, statics, refusals.
 * BUILD modules=solid_tools
 * TEST  ranks=1,2,3 */
#include "bw_solid_stress.h"
#include "state_test.h"

static bw_solid_config with(bw_pd_geometry geometry, double nu,
                            const bw_pd_state_correspondence_options *options)
{
  bw_solid_config c = pd_soft(geometry);
  c.law = bw_solid_law_by_name("correspondence");
  c.law_options = options;
  c.horizon_ratio = 2;
  c.nu = nu;
  return c;
}

START_TEST(force_is_the_derivative_of_energy)
{
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  bw_solid_config c = with(BW_PD_3D, 0.4, &o);
  for (int e = BW_PD_MATERIAL_LINEAR; e <= BW_PD_MATERIAL_HENCKY; e++) {
    o.elastic = (bw_pd_material_elastic)e;
    o.weight = e % 2 == 0 ? BW_PD_STATE_CUBIC : BW_PD_STATE_UNIFORM;
    check_force(&c);
  }
  c.disorder = 0.3;
  check_force(&c);
}
END_TEST

START_TEST(rest_by_relaxation_and_by_the_linear_solve)
{
  bw_solid_config c = with(BW_PD_3D, 0.4, NULL);
  check_rest(&c);
  c.disorder = 0.2;
  check_rest(&c);
}
END_TEST

START_TEST(the_book_closes_to_the_order_of_the_integrator)
{
  bw_solid_config c = with(BW_PD_3D, 0.4, NULL);
  bw_solid_ledger end;
  const double coarse = state_departure(&c, 0.4, 5, &end), fine = state_departure(&c, 0.2, 5, &end);
  ck_assert_double_gt(coarse / fine, 3.5); /* second order: 4 */
  ck_assert_double_lt(coarse, STATE_SWING(0.4));
  c.G0 = 2e-4;
  const double broken = state_departure(&c, 0.2, 5, &end);
  ck_assert_int_gt(end.broken, 10);
  ck_assert_double_gt(end.fracture, 0);
  ck_assert_double_lt(broken, STATE_SWING(0.2));
}
END_TEST

START_TEST(same_on_any_number_of_ranks_and_after_a_restart)
{
  bw_solid_config c = with(BW_PD_3D, 0.4, NULL);
  c.G0 = 2e-3;
  state_check_ranks(&c);
  c = with(BW_PD_PLANE_STRESS, 0.2, NULL);
  c.G0 = 2e-3;
  c.disorder = 0.2;
  state_check_ranks(&c);
}
END_TEST

START_TEST(turned_bodies_are_at_rest)
{
  const bw_solid_config c = with(BW_PD_3D, 0.45, NULL), plane = with(BW_PD_PLANE_STRESS, 0.2, NULL);
  state_check_turn(&c);
  state_check_turn(&plane);
}
END_TEST

static bw_pd_state_correspondence_options yielding(void)
{
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  o.yield[0] = bw_pd_material_j2(0.05, 0.3);
  o.breaks = BW_PD_STATE_BREAKS_BY_FLOW;
  o.limit = 0.1;
  return o;
}

/* What particles dissipate is booked, and a memory survives ranks and restarts. */
START_TEST(yield_keeps_the_book_and_is_remembered)
{
  bw_pd_state_correspondence_options o = yielding();
  bw_solid_config c = with(BW_PD_3D, 0.3, &o);
  bw_solid_ledger end;
  const double coarse = state_departure(&c, 0.2, 3, &end), fine = state_departure(&c, 0.1, 3, &end);
  ck_assert_double_gt(end.plastic, 0.02);
  ck_assert_double_gt(coarse / fine, 2.5); /* second order, but for the kink where yield begins */
  state_check_ranks(&c);
  c.geometry = BW_PD_PLANE_STRESS;
  state_check_ranks(&c);
}
END_TEST

/* Forces evaluated once more between steps change nothing. */
START_TEST(a_state_may_be_evaluated_more_than_once)
{
  const bw_pd_state_correspondence_options o = yielding();
  const bw_solid_config c = with(BW_PD_3D, 0.3, &o);
  pd_body body = pd_box(7, 4, 4);
  bw_solid *a = pd_make(bw_check_world(), &c, &body), *b = pd_make(bw_check_world(), &c, &body);
  const double dt = 0.3 * bw_solid_dt_max(a);
  pd_set(a, NULL, state_shake);
  pd_set(b, NULL, state_shake);
  for (int q = 0; q < 30; q++) {
    pd_steps(a, 1, dt);
    pd_steps(b, 1, dt);
    bw_check_ok(bw_solid_evaluate(b));
    bw_check_ok(bw_solid_evaluate(b));
  }
  ck_assert_double_gt(ledger_of(a).plastic, 0);
  /* A step to where one is: rounding. */
  pd_check_same(a, b, bw_solid_get_position, ROUND_OFF);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&body);
}
END_TEST

START_TEST(what_it_refuses)
{
  pd_body row = pd_box(9, 2, 1);
  bw_solid *pd = NULL;
  bw_solid_config c = with(BW_PD_3D, 0.3, NULL);
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, row.n, row.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "particle 0 "));
  c.horizon_ratio = 1.5;
  c.G0 = 1;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, row.n, row.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "horizon_ratio = 1.5"));
  pd_body_release(&row);
}
END_TEST

/* A choice of plain numbers, as from a case file: what contradicts itself is named, what does not
 * is the same body as by the law's own options. */
START_TEST(a_choice_of_numbers)
{
  enum { WRONG = 10 };
  pd_body body = pd_box(6, 4, 4);
  bw_solid *a = NULL, *b = NULL;
  bw_solid_config c = pd_soft(BW_PD_3D), wrong[WRONG];
  static const char *const named[WRONG] = {"poisson_ratio",  "plastic",
                                           "yield_stress",   "dilation_angle",
                                           "breaks: flow",   "surface_correction",
                                           "friction_angle", "friction_angle = 10",
                                           "limit",          "nu = 0.49995"};
  c.horizon_ratio = 2;
  for (int q = 0; q < WRONG; q++)
    wrong[q] = c;
  wrong[0].choice.poisson_ratio = 0.4;
  wrong[1].choice.plastic = BW_SOLID_J2;
  for (int q = 2; q < WRONG; q++)
    wrong[q].choice.law = BW_SOLID_CORRESPONDENCE;
  wrong[2].choice.plastic = BW_SOLID_J2;
  wrong[3].choice.plastic = BW_SOLID_DRUCKER_PRAGER;
  wrong[3].choice.cohesion = 1, wrong[3].choice.friction_angle = 10;
  wrong[3].choice.dilation_angle = 20;
  wrong[4].choice.breaks = BW_PD_STATE_BREAKS_BY_FLOW, wrong[4].choice.limit = 1;
  wrong[5].surface_correction = BW_PD_SURFACE_TENSOR;
  wrong[6].choice.breaks = BW_PD_STATE_BREAKS_BY_MOHR_COULOMB, wrong[6].choice.limit = 1;
  wrong[7].choice.friction_angle = 10;
  wrong[8].choice.breaks = BW_PD_STATE_BREAKS_BY_MISES;
  wrong[9].choice.poisson_ratio = 0.49995;
  for (int q = 0; q < WRONG; q++) {
    bw_check_status(bw_solid_create_same(bw_check_world(), &wrong[q], body.n, body.site, NULL, &a),
                    BW_EINPUT);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), named[q]));
  }
  const bw_pd_state_correspondence_options o = yielding();
  const bw_solid_config same = with(BW_PD_3D, 0.3, &o);
  c.choice.law = BW_SOLID_CORRESPONDENCE, c.choice.poisson_ratio = 0.3;
  c.choice.plastic = BW_SOLID_J2, c.choice.yield_stress = 0.05, c.choice.hardening = 0.3;
  c.choice.breaks = BW_PD_STATE_BREAKS_BY_FLOW, c.choice.limit = 0.1;
  a = pd_make(bw_check_world(), &c, &body);
  b = pd_make(bw_check_world(), &same, &body);
  pd_set(a, NULL, state_shake);
  pd_set(b, NULL, state_shake);
  pd_steps(a, 40, 0.4 * bw_solid_dt_max(b));
  pd_steps(b, 40, 0.4 * bw_solid_dt_max(b));
  ck_assert_double_gt(ledger_of(a).plastic, 0);
  pd_check_same(a, b, bw_solid_get_position, 0);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_choice_of_numbers),
                                      BW_TEST(force_is_the_derivative_of_energy),
                                      BW_TEST(rest_by_relaxation_and_by_the_linear_solve),
                                      BW_TEST(the_book_closes_to_the_order_of_the_integrator),
                                      BW_TEST(same_on_any_number_of_ranks_and_after_a_restart),
                                      BW_TEST(turned_bodies_are_at_rest),
                                      BW_TEST(yield_keeps_the_book_and_is_remembered),
                                      BW_TEST(a_state_may_be_evaluated_more_than_once),
                                      BW_TEST(what_it_refuses)};
BW_CHECK_MAIN("correspondence", tests)
