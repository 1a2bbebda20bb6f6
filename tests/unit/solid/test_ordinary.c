/* The ordinary state-based law through what a solid does: force and energy, the bond law as a
 * special case, breaking, ranks, restarts, statics, stress, refusals.
 * BUILD modules=solid_tools
 * TEST  ranks=1,2,3 */
#include "bw_solid_stress.h"
#include "state_test.h"

static const bw_pd_state_ordinary_options INVERSE = {.influence = BW_PD_STATE_INVERSE};

static bw_solid_config with(bw_pd_geometry geometry, double nu)
{
  bw_solid_config c = pd_soft(geometry);
  c.law = bw_solid_law_by_name("ordinary");
  c.nu = nu;
  return c;
}

START_TEST(force_is_the_derivative_of_energy)
{
  bw_solid_config c = with(BW_PD_3D, 0.45);
  check_force(&c);
  c.nu = -0.3;
  c.law_options = &INVERSE;
  check_force(&c);
  c.disorder = 0.3;
  check_force(&c);
}
END_TEST

START_TEST(rest_by_relaxation_and_by_the_linear_solve)
{
  bw_solid_config c = with(BW_PD_3D, 0.4);
  check_rest(&c);
  c.disorder = 0.2;
  check_rest(&c);
}
END_TEST

/* With w = 1/|xi| and the bond law's own Poisson's ratio q is what the correction by energy
 * compares, and both laws are one. */
START_TEST(with_the_ratio_of_bonds_it_is_the_bond_law)
{
  const bw_pd_geometry geometry[] = {BW_PD_3D, BW_PD_PLANE_STRAIN, BW_PD_PLANE_STRESS};
  for (int q = 0; q < 3; q++) {
    bw_solid_config bonds = pd_soft(geometry[q]), c = with(geometry[q], NAN);
    bonds.surface_correction = BW_PD_SURFACE_ENERGY;
    bonds.calibration = BW_PD_CALIBRATION_LATTICE;
    c.law_options = &INVERSE;
    pd_body body = pd_box(9, 6, q == 0 ? 5 : 1);
    bw_solid *a = pd_make(bw_check_world(), &c, &body);
    bw_solid *b = pd_make(bw_check_world(), &bonds, &body);
    pd_set(a, NULL, state_shake);
    pd_set(b, NULL, state_shake);
    pd_steps(a, 60, 0.5 * bw_solid_dt_max(b));
    pd_steps(b, 60, 0.5 * bw_solid_dt_max(b));
    pd_check_same(a, b, bw_solid_get_position, ROUND_OFF);
    pd_check_same(a, b, bw_solid_get_acceleration, 20 * ROUND_OFF);
    bw_check_near(ledger_of(a).elastic, ledger_of(b).elastic, ROUND_OFF);
    bw_solid_destroy(&a);
    bw_solid_destroy(&b);
    pd_body_release(&body);
  }
}
END_TEST

START_TEST(the_book_closes_to_the_order_of_the_integrator)
{
  bw_solid_config c = with(BW_PD_3D, 0.4);
  bw_solid_ledger end;
  const double coarse = state_departure(&c, 0.4, 5, &end), fine = state_departure(&c, 0.2, 5, &end);
  ck_assert_double_gt(coarse / fine, 3.5); /* second order: 4 */
  ck_assert_double_lt(coarse, STATE_SWING(0.4));
  c.G0 = 2e-4;
  const double broken = state_departure(&c, 0.2, 5, &end);
  ck_assert_int_gt(end.broken, 10);
  /* What breaks in a family that is pressed may raise its energy: either sign. */
  ck_assert_double_gt(fabs(end.fracture), 0);
  ck_assert_double_lt(broken, STATE_SWING(0.2));
}
END_TEST

/* Far beyond s0, bonds stay while breaking is off, and go when it is on. */
START_TEST(breaking_can_be_turned_off)
{
  bw_solid_config c = with(BW_PD_3D, 0.4);
  c.G0 = 1e-9;
  pd_body body = pd_box(6, 4, 4);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, state_tremble);
  bw_solid_enable_breakage(pd, false);
  pd_steps(pd, 5, 0.2 * bw_solid_dt_max(pd));
  ck_assert_int_eq(ledger_of(pd).broken, 0);
  bw_solid_enable_breakage(pd, true);
  pd_steps(pd, 5, 0.2 * bw_solid_dt_max(pd));
  ck_assert_int_gt(ledger_of(pd).broken, 0);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

START_TEST(same_on_any_number_of_ranks_and_after_a_restart)
{
  bw_solid_config c = with(BW_PD_3D, 0.4);
  c.G0 = 2e-3;
  state_check_ranks(&c);
  c = with(BW_PD_PLANE_STRESS, 0.2);
  c.G0 = 2e-3;
  c.disorder = 0.2;
  state_check_ranks(&c);
}
END_TEST

START_TEST(turned_bodies_are_at_rest)
{
  const bw_solid_config c = with(BW_PD_3D, 0.45), plane = with(BW_PD_PLANE_STRESS, 0.2);
  state_check_turn(&c);
  state_check_turn(&plane);
}
END_TEST

static void swell(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = 1e-3 * X0[k];
}

/* q is the family's own: a dilation has the bulk modulus also at faces, where the virial divided
 * by J of (1 + e)^3 is 3 K e (1 + e)/(1 + e)^3. */
START_TEST(stress_of_a_dilation_at_faces_too)
{
  const bw_solid_config c = with(BW_PD_3D, 0.45);
  pd_body body = pd_box(7, 6, 5);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  double *stress = NULL;
  bw_check_ok(BW_ALLOCATE(&stress, 6 * bw_solid_count(pd)));
  pd_set(pd, swell, NULL);
  bw_solid_stress_compute(pd, NULL, stress);
  const double K = c.E / (3 * (1 - 2 * c.nu)), want = 3 * K * 1e-3 / pow(1.001, 2);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    bw_check_near((stress[6 * i] + stress[6 * i + 1] + stress[6 * i + 2]) / (3 * want), 1,
                  1e4 * ROUND_OFF); /* a strain of 1e-3 */
  bw_release(&stress);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

START_TEST(what_it_refuses)
{
  pd_body two = pd_box(2, 1, 1);
  bw_solid *pd = NULL;
  const double nu[] = {0.5, -1, 0.4999};
  for (int q = 0; q < 3; q++) {
    const bw_solid_config c = with(BW_PD_3D, nu[q]);
    bw_check_status(bw_solid_create_same(bw_check_world(), &c, two.n, two.site, NULL, &pd),
                    BW_EINPUT);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), "nu = "));
  }
  pd_body_release(&two);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(force_is_the_derivative_of_energy),
                                      BW_TEST(rest_by_relaxation_and_by_the_linear_solve),
                                      BW_TEST(with_the_ratio_of_bonds_it_is_the_bond_law),
                                      BW_TEST(the_book_closes_to_the_order_of_the_integrator),
                                      BW_TEST(breaking_can_be_turned_off),
                                      BW_TEST(same_on_any_number_of_ranks_and_after_a_restart),
                                      BW_TEST(turned_bodies_are_at_rest),
                                      BW_TEST(stress_of_a_dilation_at_faces_too),
                                      BW_TEST(what_it_refuses)};
BW_CHECK_MAIN("ordinary", tests)
