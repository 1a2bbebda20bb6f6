/* Contact: bodies that meet are pushed apart; momentum and energy are kept.
 * TEST ranks=1,2,3,4 */
#include "pd_test.h"

/* Two blocks of 4 x 3 x 3 cells with a gap of 5 cells (more than the horizon) along x. */
static pd_body two_blocks(void)
{
  pd_body b = pd_box(8, 3, 3);
  for (int64_t q = 0; q < b.n; q++)
    if (b.site[3 * q] > 3) b.site[3 * q] += 5;
  return b;
}

static void towards(const double X0[3], double v[3])
{
  v[0] = X0[0] < 3 ? 0.1 : -0.1;
  v[1] = X0[0] < 3 ? 0.005 : 0; /* past each other: no symmetry to hide behind */
}

/* Kinetic energy and momentum of the block that starts on the left. */
static double left_momentum(const bw_solid *pd)
{
  const size_t n = (size_t)bw_solid_total(pd);
  double V[3 * 72], p = 0;
  pd_gather(pd, bw_solid_get_velocity, V);
  for (size_t i = 0; i < n; i++)
    if (i % 8 < 4) p += V[3 * i];
  return p * 2 * 0.125;
}

static void check_collision(bw_solid_config c, bool wall_between)
{
  pd_body body = two_blocks();
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, towards);
  const bw_solid_ledger start = ledger_of(pd);
  const double before = left_momentum(pd), dt = 0.1 * bw_solid_dt_max(pd);
  double most = 0, closest = 1e9;
  for (int q = 0; q < (int)(24 / dt); q++) {
    pd_steps(pd, 1, dt);
    if (q % 10 != 0) continue;
    most = fmax(most, ledger_of(pd).contact);
    double X[3 * 72];
    pd_gather(pd, bw_solid_get_position, X);
    for (size_t i = 0; i < 9; i++) /* facing columns 3 and 4 of every row */
      closest = fmin(closest, X[3 * (8 * i + 4)] - X[3 * (8 * i + 3)]);
  }
  const bw_solid_ledger end = ledger_of(pd);
  const double after = left_momentum(pd);
  if (wall_between) {
    ck_assert_double_gt(most, 1e-3 * start.kinetic);
    ck_assert_double_lt(after, -0.2 * before); /* the rest of it now is vibration */
    ck_assert_double_gt(closest, 0.25);        /* half a cell */
    ck_assert_double_eq(end.contact, 0);
  } else {
    ck_assert_double_lt(closest, 0);
    bw_check_near(after, before, 1e3 * BW_REAL_EPSILON);
  }
  for (int k = 0; k < 3; k++) {
    bw_check_near(end.momentum[k], start.momentum[k], 1e4 * BW_REAL_EPSILON);
    bw_check_near(end.angular[k], start.angular[k], 1e5 * BW_REAL_EPSILON);
  }
  /* Verlet at a tenth of the limit: (w dt)^2/8 = 0.5 %, contact being about as stiff as bonds */
  bw_check_near((end.kinetic + end.elastic) / (start.kinetic + start.elastic), 1, 0.005);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(bodies_bounce)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  check_collision(c, false);
  c.contact = true;
  check_collision(c, true);
}
END_TEST

/* Half of what one meets is beyond the period: the blocks part and meet around the back. */
static void apart(const double X0[3], double v[3])
{
  v[0] = X0[0] < 3 ? -0.1 : 0.1;
  v[1] = 0;
}

START_TEST(bodies_meet_through_a_period)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  c.period[0] = 9; /* 18 cells: 5 behind */
  pd_body body = two_blocks();
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, apart);
  const double before = left_momentum(pd), dt = 0.2 * bw_solid_dt_max(pd);
  ck_assert_double_lt(before, 0);
  pd_steps(pd, (int)(24 / dt), dt);
  ck_assert_double_gt(left_momentum(pd), -0.2 * before);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static void meet(const double X0[3], double v[3])
{
  v[0] = X0[0] < 1 ? 0.02 : -0.02;
}

/* Two particles collide in steps of dt_contact, begun at ten places within a step: w dt = 1 with
 * w^2 = 2 k_c dV/(rho ds), and they part with 0.9 to 1.1 of their speed. */
START_TEST(the_step_of_contact_resolves_a_collision)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.horizon_ratio = 1;
  pd_body two = pd_box(2, 1, 1);
  two.site[3] = 2; /* no family */
  bw_solid *pd = pd_make(bw_check_world(), &c, &two);
  ck_assert(isinf(bw_solid_dt_contact(pd)));
  bw_solid_destroy(&pd);
  c.contact = true;
  for (int q = 0; q < 10; q++) {
    pd = pd_make(bw_check_world(), &c, &two);
    const double dt = bw_solid_dt_contact(pd);
    const double w2 = 2 * 15 * bw_solid_micromodulus(pd) * 0.125 / (c.rho * c.ds);
    bw_check_near(dt * sqrt(w2), 1, 1e-12);
    pd_set(pd, NULL, meet);
    const double start = ledger_of(pd).kinetic;
    pd_steps(pd, 1, (0.1 * q + 0.05) * dt);
    pd_steps(pd, (int)(0.6 / (0.04 * dt)) + 8, dt);
    const bw_solid_ledger end = ledger_of(pd);
    ck_assert_double_eq(end.contact, 0);
    ck_assert_double_lt(end.closest, 1);
    bw_check_near(end.kinetic / start, 1, 0.2);
    bw_solid_destroy(&pd);
  }
  pd_body_release(&two);
}
END_TEST

static double approach;

static void close_up(const double X0[3], double u[3])
{
  u[0] = X0[0] > 0.5 ? -approach : 0;
}

/* Two particles whose bond was cut, at distance r: pushed apart with 15 c0 (ds/r - 1) dV/rho. */
START_TEST(a_broken_bond_repels_in_closed_form)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  pd_body two = pd_box(2, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &two);
  double A[6];
  approach = 0.1;
  pd_set(pd, close_up, NULL);
  const double bonded = ledger_of(pd).contact;
  ck_assert_double_eq(bonded, 0); /* an intact bond: no contact */
  bw_check_ok(bw_solid_precrack(pd, (double[]){0.5, -1, -1}, (double[]){0.5, 1, -1},
                                (double[]){0.5, -1, 1}));
  const bw_solid_ledger l = ledger_of(pd);
  pd_gather(pd, bw_solid_get_acceleration, A);
  const double k = 15 * bw_solid_micromodulus(pd) * 0.125, r = 0.4;
  bw_check_near(A[0] / (-k / 2 * (0.5 / r - 1)), 1, 1e3 * BW_REAL_EPSILON);
  bw_check_near(A[3] / (k / 2 * (0.5 / r - 1)), 1, 1e3 * BW_REAL_EPSILON);
  bw_check_near(l.contact / (k * 0.125 * (0.5 * log(0.5 / r) - 0.5 + r)), 1, 1e3 * BW_REAL_EPSILON);
  approach = -0.01;
  pd_set(pd, close_up, NULL);
  ck_assert_double_eq(ledger_of(pd).contact, 0);
  pd_gather(pd, bw_solid_get_acceleration, A);
  ck_assert_double_eq(A[0], 0);
  bw_solid_destroy(&pd);
  pd_body_release(&two);
}
END_TEST

/* Two that push each other part when one of them is retired: what contact held is booked, and a
 * restart of a state that was only set goes on as this one does. */
START_TEST(contact_of_the_retired_is_booked_and_a_set_state_restarts)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  pd_body two = pd_box(2, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &two), *next = pd_make(bw_check_world(), &c, &two);
  double X[6], Y[6];
  approach = 0.1;
  bw_check_ok(bw_solid_precrack(pd, (double[]){0.5, -1, -1}, (double[]){0.5, 1, -1},
                                (double[]){0.5, -1, 1}));
  pd_set(pd, close_up, NULL);
  pd_restart_from(pd, next); /* nobody has evaluated the forces of this state */
  const double start = pd_energy(pd), dt = 0.1 * bw_solid_dt_contact(pd);
  ck_assert_double_gt(start, 0);
  pd_steps(pd, 3, dt);
  pd_steps(next, 3, dt);
  pd_gather(pd, bw_solid_get_position, X);
  pd_gather(next, bw_solid_get_position, Y);
  for (int k = 0; k < 6; k++)
    bw_check_near(X[k], Y[k], 10 * BW_REAL_EPSILON);
  const double before = pd_energy(pd);
  ck_assert_double_gt(ledger_of(pd).contact, 0);
  bool gone[2] = {false, false};
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    gone[i] = bw_solid_id(pd)[i] == 0;
  bw_check_ok(bw_solid_retire(pd, gone));
  ck_assert_double_eq(ledger_of(pd).contact, 0);
  bw_check_near(pd_energy(pd) / before, 1, 100 * BW_REAL_EPSILON);
  bw_solid_destroy(&pd);
  bw_solid_destroy(&next);
  pd_body_release(&two);
}
END_TEST

static void squeezed(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = -0.02 * (X0[k] - 2.5);
}

static void stirred(const double X0[3], double v[3])
{
  const bool inside = fmax(fabs(X0[0] - 2.5), fmax(fabs(X0[1] - 2.5), fabs(X0[2] - 2.5))) < 2.2;
  for (int k = 0; k < 3; k++)
    v[k] = inside ? 0.15 * sin(40 * X0[(k + 1) % 3] + 17 * X0[k]) : 0;
}

static double mechanical(bw_solid *pd)
{
  const bw_solid_ledger now = ledger_of(pd);
  return now.kinetic + now.elastic + now.contact;
}

/* A block in a shell it is too large for, stirred so that its bonds break and particles press each
 * other while some of their bonds hold: at 0.8 of what bonds and contact allow together its energy
 * only falls. At 0.8 of what bonds allow alone, which contact allows as well, it grows twofold. */
START_TEST(rubble_makes_no_energy)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.G0 = 0.01;
  c.contact = true;
  pd_body body = pd_box(10, 10, 10);
  for (int64_t q = 0; q < body.n; q++)
    for (int k = 0; k < 3; k++)
      if (body.site[3 * q + k] % 9 == 0) body.kind[q] = BW_PD_PRESCRIBED;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const double dt = 0.8 / hypot(1 / bw_solid_dt_max(pd), 1 / bw_solid_dt_contact(pd));
  pd_set(pd, squeezed, stirred);
  pd_steps(pd, 200, dt);
  const double then = mechanical(pd);
  ck_assert_int_gt(ledger_of(pd).broken, 20000); /* of 48441 */
  pd_steps(pd, 800, dt);
  ck_assert_double_lt(mechanical(pd), then);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(bodies_bounce),
    BW_TEST(the_step_of_contact_resolves_a_collision),
    BW_TEST(bodies_meet_through_a_period),
    BW_TEST(a_broken_bond_repels_in_closed_form),
    BW_TEST(contact_of_the_retired_is_booked_and_a_set_state_restarts),
    BW_TEST(rubble_makes_no_energy)};
BW_CHECK_MAIN("pd_bond.contact", tests)
