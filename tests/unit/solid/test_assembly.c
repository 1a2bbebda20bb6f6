/* Several solids in one space: contact between lattices of their own spacing, turn and material.
 * TEST ranks=1,2,3 */
#include "assembly_scene.h"

/* Error of the energy over a bounce, relative, its root mean square over the time in contact, in
 * steps of `factor` of the stable one. */
static double bounce(double factor, double height)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(height), BW_PD_FREE, THROW);
  const bw_solid_ledger start = book(&s);
  const double dt = factor * bw_solid_assembly_dt(s.set);
  double error2 = 0, most = 0, touching = 0;
  for (int q = 0; q < (int)lround(FLIGHT / dt); q++) {
    steps(&s, 1, dt);
    const bw_solid_ledger now = book(&s);
    if (now.contact > 0) error2 += pow(energy(&now) / start.kinetic - 1, 2), touching++;
    most = fmax(most, now.contact / start.kinetic);
  }
  const bw_solid_ledger end = book(&s);
  ck_assert_double_gt(most, 0.01);
  ck_assert_double_eq(end.contact, 0);
  ck_assert_double_lt(end.closest, 1);
  ck_assert_double_gt(end.closest, BW_SOLID_TOO_CLOSE);
  ck_assert_double_gt(upward(&s), 0.2 * 3 * 0.343 * (double)bw_solid_total(s.ball) * THROW);
  for (int k = 0; k < 3; k++) {
    bw_check_near(end.momentum[k], start.momentum[k], 1e4 * BW_REAL_EPSILON);
    bw_check_near(end.angular[k], start.angular[k], 1e5 * BW_REAL_EPSILON);
  }
  scene_release(&s);
  return sqrt(error2 / touching);
}

#ifdef __SANITIZE_ADDRESS__ /* slow: the way is gone once, orders are not measured */
enum { THROWS = 1, ORDERS = 0 };
#else
enum { THROWS = 8, ORDERS = 1 };
#endif

/* Root mean square over throws from a little further away each. */
static double bounces(double factor)
{
  double sum = 0;
  for (int q = 0; q < THROWS; q++)
    sum += pow(bounce(factor, HEIGHT + 0.0137 * q), 2);
  return sqrt(sum / THROWS);
}

/* Verlet: half the step, a quarter of the error. Where two begin to touch the force has a kink, and
 * how far into a step that falls changes the factor of dt^2 from one contact to the next, by a
 * factor of two for one bounce; over eight throws a third of it is left either way. */
START_TEST(a_ball_bounces_off_a_turned_plate)
{
  const double coarse = bounces(0.2);
  ck_assert_double_lt(coarse, 0.001);
  if (!ORDERS || BW_REAL_EPSILON > 1e-10) return; /* rounding hides the order */
  const double fine = bounces(0.1);
  ck_assert_double_gt(coarse / fine, 2.7);
  ck_assert_double_lt(coarse / fine, 5.3);
}
END_TEST

START_TEST(a_bounce_does_not_depend_on_ranks)
{
  bw_comm *self = pd_alone();
  bw_solid_config plate = plate_config(), ball = ball_config(HEIGHT);
  plate.damping.pair = 0.01;
  ball.contact = true;
  scene many = throw_ball(bw_check_world(), plate, ball, BW_PD_FREE, THROW);
  scene one = throw_ball(self, plate, ball, BW_PD_FREE, THROW);
  ck_assert_double_eq(bw_solid_assembly_dt(many.set), bw_solid_assembly_dt(one.set));
  const double dt = 0.4 * bw_solid_assembly_dt(one.set);
  for (int q = 0; q < 6; q++) {
    steps(&many, (int)(FLIGHT / 6 / dt), dt);
    steps(&one, (int)(FLIGHT / 6 / dt), dt);
    const bw_solid_ledger a = book(&many), b = book(&one);
    ck_assert_int_eq(bw_solid_assembly_pairs(many.set), bw_solid_assembly_pairs(one.set));
    bw_check_near(a.kinetic, b.kinetic, 1e-12 + 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.contact, b.contact, 1e-12 + 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.damping, b.damping, 1e-12 + 1e3 * BW_REAL_EPSILON);
  }
  ck_assert_double_gt(upward(&many), 0);
  pd_check_same(many.plate, one.plate, bw_solid_get_position, 1e-12 + 1e3 * BW_REAL_EPSILON);
  pd_check_same(many.ball, one.ball, bw_solid_get_position, 1e-12 + 1e3 * BW_REAL_EPSILON);
  pd_check_same(many.ball, one.ball, bw_solid_get_velocity, 1e-12 + 1e4 * BW_REAL_EPSILON);
  scene_release(&many);
  scene_release(&one);
  bw_comm_destroy(&self);
}
END_TEST

/* A plate that is held gives no energy, and the ball comes back with its own. One that moves up
 * does work, which is booked: energy is that of the start and the work. */
static void check_held(double rise)
{
  scene s =
      throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_PRESCRIBED, THROW);
  double *V = NULL;
  bw_check_ok(BW_ALLOCATE(&V, 3 * bw_solid_count(s.plate)));
  for (size_t i = 0; i < bw_solid_count(s.plate); i++)
    V[3 * i + 2] = rise;
  bw_solid_set_prescribed(s.plate, V);
  const bw_solid_ledger start = book(&s);
  const double dt = 0.1 * bw_solid_assembly_dt(s.set);
  steps(&s, (int)lround(FLIGHT / dt), dt);
  const bw_solid_ledger end = book(&s);
  ck_assert_double_gt(upward(&s), -0.2 * start.momentum[2]);
  bw_check_near(energy(&end) / start.kinetic, 1, 0.002); /* (w dt)^2/8 */
  if (rise == 0)
    bw_check_near(end.external, 0, 1e3 * BW_REAL_EPSILON);
  else /* beyond what gives the plate its speed */
    ck_assert_double_gt(end.external - 0.5 * 8 * 432 * rise * rise, 0.1 * start.kinetic);
  bw_release(&V);
  scene_release(&s);
}

START_TEST(a_held_body_pushes_and_its_work_is_booked)
{
  check_held(0);
  check_held(0.03);
}
END_TEST

START_TEST(a_body_that_passes_far_away_costs_no_pairs)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(9), BW_PD_FREE, THROW);
  speed[0] = 1, speed[2] = 0;
  pd_set(s.ball, NULL, thrown);
  ck_assert_int_eq(bw_solid_assembly_pairs(s.set), 0);
  for (int q = 0; q < 40; q++) {
    steps(&s, 1, 0.8 * bw_solid_assembly_dt(s.set));
    ck_assert_int_eq(bw_solid_assembly_pairs(s.set), 0);
  }
  ck_assert(isinf(book(&s).closest));
  scene_release(&s);
}
END_TEST

/* Two particles of two bodies: the force and the energy of the smaller reach and the harmonic
 * mean. */
START_TEST(a_pair_takes_the_smaller_reach_and_the_harmonic_mean)
{
  bw_solid_config c = pd_soft(BW_PD_3D), d = pd_soft(BW_PD_3D);
  pd_body one = pd_box(1, 1, 1);
  d.ds = 0.8, d.E = 11, d.rho = 5;
  for (int k = 0; k < 3; k++)
    c.origin[k] = -0.25, d.origin[k] = -0.4;
  d.origin[1] += 0.4;
  bw_solid *a = pd_make(bw_check_world(), &c, &one), *b = pd_make(bw_check_world(), &d, &one);
  bw_solid_assembly *set = NULL;
  bw_check_ok(bw_solid_assembly_create(2, (bw_solid *[]){a, b}, &set));
  bw_solid_ledger l;
  bw_check_ok(bw_solid_assembly_account(set, &l));
  double A[3], B[3];
  pd_gather(a, bw_solid_get_acceleration, A);
  pd_gather(b, bw_solid_get_acceleration, B);
  const double p = bw_solid_micromodulus(a), q = bw_solid_micromodulus(b);
  const double k = 15 * 2 * p * q / (p + q) * 0.125 * 0.512, e = 1e3 * BW_REAL_EPSILON;
  bw_check_near(A[1] * 2 * 0.125 / (-k * (0.5 / 0.4 - 1)), 1, e);
  bw_check_near(B[1] * 5 * 0.512 / (k * (0.5 / 0.4 - 1)), 1, e);
  bw_check_near(l.contact / (k * (0.5 * log(0.5 / 0.4) - 0.1)), 1, e);
  bw_check_near(l.closest, 0.8, e);
  const double w2 = k * (1 / (2 * 0.125) + 1 / (5 * 0.512)) / 0.5;
  bw_check_near(bw_solid_assembly_dt(set) * sqrt(w2), 1, 1e-12); /* no bonds */
  bw_solid_assembly_destroy(&set);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&one);
}
END_TEST

static void towards(const double X0[3], double v[3])
{
  v[0] = X0[0] < 3 ? 0.1 : -0.1;
  v[1] = X0[0] < 3 ? 0.005 : 0;
  v[2] = 0;
}

/* Two blocks on one lattice: as two solids in a set they bounce like one solid with contact. With
 * finer particles where one block meets the other the two share the smaller reach. */
static void bounce_as_one(bool finer)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  if (finer) c.surface_correction = BW_PD_SURFACE_NONE;
  c.finer.n = finer;
  c.finer.box[0] = (bw_pd_box){1, {1.1, -1, -1}, {2.5, 3, 3}};
  pd_body both = pd_box(8, 3, 3), left = pd_box(4, 3, 3), right = pd_box(4, 3, 3);
  for (int64_t q = 0; q < both.n; q++)
    if (both.site[3 * q] > 3) both.site[3 * q] += 5;
  for (int64_t q = 0; q < right.n; q++)
    right.site[3 * q] += 9;
  bw_solid *one = pd_make(bw_check_world(), &c, &both);
  bw_solid *two[] = {pd_make(bw_check_world(), &c, &left), NULL};
  c.finer.n = 0;
  two[1] = pd_make(bw_check_world(), &c, &right);
  bw_solid_assembly *set = NULL;
  bw_check_ok(bw_solid_assembly_create(2, two, &set));
  const double dt = (finer ? 0.25 : 0.1) * bw_solid_dt_max(one);
  pd_set(one, NULL, towards);
  pd_set(two[0], NULL, towards);
  pd_set(two[1], NULL, towards);
  double most = 0;
  const bw_solid_ledger start = ledger_of(one);
  for (int q = 0; q < 24; q++) {
    for (int n = 0; n < (int)(1 / dt); n++) {
      pd_steps(one, 1, dt);
      bw_check_ok(bw_solid_assembly_step(set, dt));
    }
    bw_solid_ledger l;
    bw_check_ok(bw_solid_assembly_account(set, &l));
    most = fmax(most, l.contact);
    bw_check_near(l.contact, ledger_of(one).contact, 1e3 * BW_REAL_EPSILON);
  }
  ck_assert_double_gt(most, 0.01);
  const bw_solid_ledger end = ledger_of(one);
  bw_check_near(energy(&end) / start.kinetic, 1, 0.005);
  for (int k = 0; k < 3; k++)
    bw_check_near(end.momentum[k], start.momentum[k], 1e4 * BW_REAL_EPSILON);
  /* Particle by particle, as far as their numbers are known without a search. */
  double X[3 * 72], Y[3 * 72];
  if (!finer) pd_gather(one, bw_solid_get_position, X);
  for (int64_t b = 0; b < 2 && !finer; b++) {
    pd_gather(two[b], bw_solid_get_position, Y);
    for (int64_t q = 0; q < 36; q++)
      for (int k = 0; k < 3; k++)
        bw_check_near(Y[3 * q + k], X[3 * (q / 4 * 8 + q % 4 + 4 * b) + k], 1e4 * BW_REAL_EPSILON);
  }
  bw_solid_assembly_destroy(&set);
  bw_solid_destroy(&one);
  for (int b = 0; b < 2; b++)
    bw_solid_destroy(&two[b]);
  pd_body_release(&both);
  pd_body_release(&left);
  pd_body_release(&right);
}

START_TEST(two_bodies_on_one_lattice_bounce_as_one_with_contact)
{
  bounce_as_one(false);
}
END_TEST

START_TEST(two_bodies_of_several_levels_bounce_as_one_with_contact)
{
  bounce_as_one(true);
}
END_TEST

/* In the plane, with bodies that break where they hit. */
START_TEST(discs_that_break_keep_their_book)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS), d = pd_soft(BW_PD_PLANE_STRESS);
  c.G0 = d.G0 = 2e-3;
  c.contact = d.contact = true;
  d.ds = 0.35;
  d.E = 9;
  d.origin[0] = 4.5, d.origin[1] = 0.5;
  const double a = cos(0.4), b = sin(0.4);
  memcpy(d.axes, (double[3][3]){{a, b, 0}, {-b, a, 0}, {0, 0, 1}}, sizeof d.axes);
  pd_body left = pd_box(6, 6, 1), right = pd_box(7, 7, 1);
  scene s = {.plate = pd_make(bw_check_world(), &c, &left),
             .ball = pd_make(bw_check_world(), &d, &right)};
  bw_check_ok(bw_solid_assembly_create(2, (bw_solid *[]){s.plate, s.ball}, &s.set));
  memcpy(speed, (double[]){-0.4, 0, 0}, sizeof speed);
  pd_set(s.ball, NULL, thrown);
  const bw_solid_ledger start = book(&s);
  const double dt = 0.1 * bw_solid_assembly_dt(s.set);
  steps(&s, (int)(8 / dt), dt);
  const bw_solid_ledger end = book(&s);
  ck_assert_int_gt(end.broken, 0);
  bw_check_near(energy(&end) / start.kinetic, 1, 0.005);
  for (int k = 0; k < 3; k++) {
    bw_check_near(end.momentum[k], start.momentum[k], 1e4 * BW_REAL_EPSILON);
    bw_check_near(end.angular[k], start.angular[k], 1e5 * BW_REAL_EPSILON);
  }
  scene_release(&s);
  pd_body_release(&left);
  pd_body_release(&right);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_ball_bounces_off_a_turned_plate),
    BW_TEST(a_bounce_does_not_depend_on_ranks),
    BW_TEST(a_held_body_pushes_and_its_work_is_booked),
    BW_TEST(a_body_that_passes_far_away_costs_no_pairs),
    BW_TEST(a_pair_takes_the_smaller_reach_and_the_harmonic_mean),
    BW_TEST(two_bodies_on_one_lattice_bounce_as_one_with_contact),
    BW_TEST(two_bodies_of_several_levels_bounce_as_one_with_contact),
    BW_TEST(discs_that_break_keep_their_book)};
BW_CHECK_MAIN("solid_assembly", tests)
