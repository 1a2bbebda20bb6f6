/* Two state-based laws in one body: force and energy, momenta, breaking, ranks, restarts, statics.
 * BUILD modules=solid_tools
 * TEST  ranks=1,2,3 */
#include "state_test.h"

/* Ordinary, then correspondence or the other way round, twice as stiff and dense. */
static bw_solid_config with(bw_pd_geometry geometry, bw_pd_state_mixed_options *o, bool first)
{
  bw_solid_config c = pd_soft(geometry);
  *o = bw_pd_state_mixed_options_default();
  o->correspondence_group[first ? 0 : 1] = true;
  c.law = &bw_pd_state_mixed_law, c.law_options = o;
  c.horizon_ratio = 2, c.nu = 0.4;
  c.more.n = 1;
  c.more.material[0] = (bw_pd_material){.rho = c.rho, .E = 2 * c.E, .nu = 0.2, .G0 = INFINITY};
  return c;
}

START_TEST(force_is_the_derivative_of_energy)
{
  bw_pd_state_mixed_options o;
  for (int first = 0; first < 2; first++) {
    bw_solid_config c = with(BW_PD_3D, &o, first == 1);
    check_force(&c);
    c.disorder = 0.3;
    check_force(&c);
  }
}
END_TEST

START_TEST(rest_by_relaxation_and_by_the_linear_solve)
{
  bw_pd_state_mixed_options o;
  const bw_solid_config c = with(BW_PD_3D, &o, false);
  check_rest(&c);
}
END_TEST

START_TEST(the_book_closes_and_momenta_stay)
{
  bw_pd_state_mixed_options o;
  bw_solid_config c = with(BW_PD_3D, &o, false);
  bw_solid_ledger end;
  const double coarse = state_departure(&c, 0.4, 5, &end), fine = state_departure(&c, 0.2, 5, &end);
  ck_assert_double_gt(coarse / fine, 3.5); /* second order: 4 */
  ck_assert_double_lt(coarse, STATE_SWING(0.4));
  c.G0 = 2e-4, c.more.material[0].G0 = 2e-4;
  const double broken = state_departure(&c, 0.2, 5, &end);
  ck_assert_int_gt(end.broken, 10);
  ck_assert_double_lt(broken, STATE_SWING(0.2));
}
END_TEST

/* Nothing but the joint can break, and it does, from both ends alike. */
START_TEST(a_joint_breaks)
{
  bw_pd_state_mixed_options o;
  bw_solid_config c = with(BW_PD_3D, &o, false);
  bw_solid_ledger end;
  c.more.joint_G0[0][1] = c.more.joint_G0[1][0] = 2e-4;
  const double broken = state_departure(&c, 0.2, 5, &end);
  ck_assert_int_gt(end.broken, 10);
  ck_assert_double_lt(broken, STATE_SWING(0.2));
}
END_TEST

START_TEST(same_on_any_number_of_ranks_and_after_a_restart)
{
  bw_pd_state_mixed_options o;
  bw_solid_config c = with(BW_PD_3D, &o, true);
  c.G0 = 2e-3, c.more.material[0].G0 = 2e-3;
  state_check_ranks(&c);
  o.correspondence.yield[0] = bw_pd_material_j2(0.05, 0.3);
  state_check_ranks(&c);
}
END_TEST

START_TEST(turned_bodies_are_at_rest)
{
  bw_pd_state_mixed_options o;
  const bw_solid_config c = with(BW_PD_3D, &o, false);
  state_check_turn(&c);
}
END_TEST

/* All groups of one law: that law, to the bits of what is left of the other's modulus. */
START_TEST(one_law_alone_is_that_law)
{
  for (int q = 0; q < 2; q++) {
    bw_pd_state_mixed_options o;
    bw_solid_config c = with(BW_PD_3D, &o, false);
    o.correspondence_group[0] = o.correspondence_group[1] = q == 1;
    bw_solid_config one = c;
    one.law = q == 1 ? &bw_pd_state_correspondence_law : &bw_pd_state_ordinary_law;
    one.law_options = NULL;
    pd_body body = pd_box(9, 6, 5);
    bw_solid *a = law_make(bw_check_world(), &c, &body);
    bw_solid *b = law_make(bw_check_world(), &one, &body);
    pd_set(a, NULL, state_shake);
    pd_set(b, NULL, state_shake);
    pd_steps(a, 30, 0.4 * bw_solid_dt_max(b));
    pd_steps(b, 30, 0.4 * bw_solid_dt_max(b));
    pd_check_same(a, b, bw_solid_get_position, ROUND_OFF);
    bw_check_near(ledger_of(a).elastic, ledger_of(b).elastic, ROUND_OFF);
    bw_solid_destroy(&a);
    bw_solid_destroy(&b);
    pd_body_release(&body);
  }
}
END_TEST

START_TEST(what_it_refuses)
{
  bw_pd_state_mixed_options o;
  bw_solid_config c = with(BW_PD_3D, &o, false);
  pd_body body = pd_box(4, 4, 4);
  bw_solid *pd = NULL;
  c.law_options = NULL;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, body.n, body.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "which group has which"));
  c.law_options = &o, c.nu = 0.5;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, body.n, body.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "nu = "));
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(force_is_the_derivative_of_energy),
                                      BW_TEST(rest_by_relaxation_and_by_the_linear_solve),
                                      BW_TEST(the_book_closes_and_momenta_stay),
                                      BW_TEST(a_joint_breaks),
                                      BW_TEST(same_on_any_number_of_ranks_and_after_a_restart),
                                      BW_TEST(turned_bodies_are_at_rest),
                                      BW_TEST(one_law_alone_is_that_law),
                                      BW_TEST(what_it_refuses)};
BW_CHECK_MAIN("mixed", tests)
