/* Several solids in one space: contact between lattices of their own spacing, turn and material.
 * TEST ranks=1,2,3 */
#include "bw_solid_set.h"
#include "pd_test.h"

#include <string.h>

static const double TURN = 17 * 3.14159265358979323846 / 180;

static void turn_about_y(bw_solid_config *c, double angle)
{
  const double axes[3][3] = {{cos(angle), 0, -sin(angle)}, {0, 1, 0}, {sin(angle), 0, cos(angle)}};
  memcpy(c->axes, axes, sizeof axes);
}

static pd_body ball_sites(int radius)
{
  const int side = 2 * radius + 1;
  pd_body b = pd_box(side, side, side);
  int64_t kept = 0;
  for (int64_t q = 0; q < b.n; q++) {
    const int32_t *s = b.site + 3 * q;
    const double r2 = pow(s[0] - radius, 2) + pow(s[1] - radius, 2) + pow(s[2] - radius, 2);
    if (r2 > (radius + 0.3) * (radius + 0.3)) continue;
    memmove(b.site + 3 * kept++, s, 3 * sizeof *s);
  }
  b.n = kept;
  return b;
}

/* A plate turned by 17 degrees and a ball of spacing 0.7 above it. */
typedef struct {
  bw_solid *plate, *ball;
  bw_solid_set *set;
} scene;

static double speed[3];

static void thrown(const double X0[3], double v[3])
{
  (void)X0;
  memcpy(v, speed, sizeof speed);
}

static bw_solid_config plate_config(void)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.ds = 1;
  c.rho = 8;
  c.E = 40;
  turn_about_y(&c, TURN);
  /* The middle of the plate's upper face is at the origin. */
  const double half[3] = {6, 6, 3};
  for (int k = 0; k < 3; k++)
    c.origin[k] = 0;
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++)
      c.origin[k] -= c.axes[a][k] * half[a];
  return c;
}

static bw_solid_config ball_config(double height)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.ds = 0.7;
  c.rho = 3;
  c.E = 7;
  const double middle = 0.7 * 3.5;
  const double at[3] = {0.3, -0.2, height};
  for (int k = 0; k < 3; k++)
    c.origin[k] = at[k] - middle;
  return c;
}

static scene throw_ball(const bw_comm *comm, bw_solid_config plate, bw_solid_config ball,
                        uint8_t kind, double v)
{
  scene s = {0};
  pd_body flat = pd_box(12, 12, 3), round = ball_sites(3);
  memset(flat.kind, kind, (size_t)flat.n);
  s.plate = pd_make(comm, &plate, &flat);
  s.ball = pd_make(comm, &ball, &round);
  bw_check_ok(bw_solid_set_create(2, (bw_solid *[]){s.plate, s.ball}, &s.set));
  memcpy(speed, (double[]){0.1 * v, 0.05 * v, -v}, sizeof speed);
  pd_set(s.ball, NULL, thrown);
  pd_body_release(&flat);
  pd_body_release(&round);
  return s;
}

static void scene_release(scene *s)
{
  bw_solid_set_destroy(&s->set);
  bw_solid_destroy(&s->plate);
  bw_solid_destroy(&s->ball);
}

static bw_solid_ledger book(const scene *s)
{
  bw_solid_ledger l = {0};
  bw_check_ok(bw_solid_set_account(s->set, &l));
  return l;
}

static double energy(const bw_solid_ledger *l)
{
  return l->kinetic + l->elastic + l->contact + l->retired + l->damping + l->fracture - l->external;
}

static void steps(const scene *s, int n, double dt)
{
  for (int q = 0; q < n; q++)
    bw_check_ok(bw_solid_set_step(s->set, dt));
}

/* Upward momentum of the ball. */
static double upward(const scene *s)
{
  return ledger_of(s->ball).momentum[2];
}

static const double THROW = 0.15; /* some 0.12 of the plate's wave speed */
static const double HEIGHT = 3; /* of the ball's middle: its lowest particle is 0.9 over the face */
static const double FLIGHT = 27; /* there and back again */

/* Error of the energy over a bounce, relative, its root mean square over the time in contact, in steps of
 * `factor` of the stable one. */
static double bounce(double factor, double height)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(height), BW_PD_FREE, THROW);
  const bw_solid_ledger start = book(&s);
  const double dt = factor * bw_solid_set_dt(s.set);
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

/* Root mean square over throws from a little further away each. */
static double bounces(double factor)
{
  enum { THROWS = 8 };
  double sum = 0;
  for (int q = 0; q < THROWS; q++)
    sum += pow(bounce(factor, HEIGHT + 0.0137 * q), 2);
  return sqrt(sum / THROWS);
}

/* Verlet: half the step, a quarter of the error. Where two begin to touch the force has a kink, and how
 * far into a step that falls changes the factor of dt^2 from one contact to the next, by a factor of
 * two for one bounce; over eight throws a third of it is left either way. */
START_TEST(a_ball_bounces_off_a_turned_plate)
{
  const double coarse = bounces(0.2), fine = bounces(0.1);
  ck_assert_double_lt(coarse, 0.001);
  if (BW_REAL_EPSILON > 1e-10) return; /* rounding hides the order */
  ck_assert_double_gt(coarse / fine, 2.7);
  ck_assert_double_lt(coarse / fine, 5.3);
}
END_TEST

static void compare(const bw_solid *a, const bw_solid *b, pd_getter get, double tolerance)
{
  const size_t n = (size_t)bw_solid_total(a);
  double *x = NULL, *y = NULL;
  bw_check_ok(BW_ALLOCATE(&x, 3 * n));
  bw_check_ok(BW_ALLOCATE(&y, 3 * n));
  pd_gather(a, get, x);
  pd_gather(b, get, y);
  for (size_t q = 0; q < 3 * n; q++)
    bw_check_near(x[q], y[q], tolerance);
  bw_release(&x);
  bw_release(&y);
}

START_TEST(a_bounce_does_not_depend_on_ranks)
{
  bw_comm *self = pd_alone();
  bw_solid_config plate = plate_config(), ball = ball_config(HEIGHT);
  plate.damping_pair = 0.01;
  ball.contact = true;
  scene many = throw_ball(bw_check_world(), plate, ball, BW_PD_FREE, THROW);
  scene one = throw_ball(self, plate, ball, BW_PD_FREE, THROW);
  ck_assert_double_eq(bw_solid_set_dt(many.set), bw_solid_set_dt(one.set));
  const double dt = 0.4 * bw_solid_set_dt(one.set);
  for (int q = 0; q < 6; q++) {
    steps(&many, (int)(FLIGHT / 6 / dt), dt);
    steps(&one, (int)(FLIGHT / 6 / dt), dt);
    const bw_solid_ledger a = book(&many), b = book(&one);
    ck_assert_int_eq(bw_solid_set_pairs(many.set), bw_solid_set_pairs(one.set));
    bw_check_near(a.kinetic, b.kinetic, 1e-12 + 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.contact, b.contact, 1e-12 + 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.damping, b.damping, 1e-12 + 1e3 * BW_REAL_EPSILON);
  }
  ck_assert_double_gt(upward(&many), 0);
  compare(many.plate, one.plate, bw_solid_get_position, 1e-12 + 1e3 * BW_REAL_EPSILON);
  compare(many.ball, one.ball, bw_solid_get_position, 1e-12 + 1e3 * BW_REAL_EPSILON);
  compare(many.ball, one.ball, bw_solid_get_velocity, 1e-12 + 1e4 * BW_REAL_EPSILON);
  scene_release(&many);
  scene_release(&one);
  bw_comm_destroy(&self);
}
END_TEST

/* A plate that is held gives no energy, and the ball comes back with its own. One that moves up does
 * work, which is booked: energy is that of the start and the work. */
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
  const double dt = 0.1 * bw_solid_set_dt(s.set);
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
  ck_assert_int_eq(bw_solid_set_pairs(s.set), 0);
  for (int q = 0; q < 40; q++) {
    steps(&s, 1, 0.8 * bw_solid_set_dt(s.set));
    ck_assert_int_eq(bw_solid_set_pairs(s.set), 0);
  }
  ck_assert(isinf(book(&s).closest));
  scene_release(&s);
}
END_TEST

/* Two particles of two bodies: the force and the energy of the smaller reach and the harmonic mean. */
START_TEST(a_pair_takes_the_smaller_reach_and_the_harmonic_mean)
{
  bw_solid_config c = pd_soft(BW_PD_3D), d = pd_soft(BW_PD_3D);
  pd_body one = pd_box(1, 1, 1);
  d.ds = 0.8, d.E = 11, d.rho = 5;
  for (int k = 0; k < 3; k++)
    c.origin[k] = -0.25, d.origin[k] = -0.4;
  d.origin[1] += 0.4;
  bw_solid *a = pd_make(bw_check_world(), &c, &one), *b = pd_make(bw_check_world(), &d, &one);
  bw_solid_set *set = NULL;
  bw_check_ok(bw_solid_set_create(2, (bw_solid *[]){a, b}, &set));
  bw_solid_ledger l;
  bw_check_ok(bw_solid_set_account(set, &l));
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
  bw_check_near(bw_solid_set_dt(set) * sqrt(w2), 1, 1e-12); /* no bonds */
  bw_solid_set_destroy(&set);
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

/* Two blocks on one lattice: as two solids in a set they bounce like one solid with contact. */
START_TEST(two_bodies_on_one_lattice_bounce_as_one_with_contact)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  pd_body both = pd_box(8, 3, 3), left = pd_box(4, 3, 3), right = pd_box(4, 3, 3);
  for (int64_t q = 0; q < both.n; q++)
    if (both.site[3 * q] > 3) both.site[3 * q] += 5;
  for (int64_t q = 0; q < right.n; q++)
    right.site[3 * q] += 9;
  bw_solid *one = pd_make(bw_check_world(), &c, &both);
  bw_solid *two[] = {pd_make(bw_check_world(), &c, &left), pd_make(bw_check_world(), &c, &right)};
  bw_solid_set *set = NULL;
  bw_check_ok(bw_solid_set_create(2, two, &set));
  const double dt = 0.1 * bw_solid_dt_max(one);
  pd_set(one, NULL, towards);
  pd_set(two[0], NULL, towards);
  pd_set(two[1], NULL, towards);
  double most = 0, X[3 * 72], Y[3 * 72];
  for (int q = 0; q < 24; q++) {
    for (int n = 0; n < (int)(1 / dt); n++) {
      pd_steps(one, 1, dt);
      bw_check_ok(bw_solid_set_step(set, dt));
    }
    bw_solid_ledger l;
    bw_check_ok(bw_solid_set_account(set, &l));
    most = fmax(most, l.contact);
    bw_check_near(l.contact, ledger_of(one).contact, 1e3 * BW_REAL_EPSILON);
  }
  ck_assert_double_gt(most, 0.01);
  pd_gather(one, bw_solid_get_position, X);
  for (int64_t b = 0; b < 2; b++) {
    pd_gather(two[b], bw_solid_get_position, Y);
    for (int64_t q = 0; q < 36; q++)
      for (int k = 0; k < 3; k++)
        bw_check_near(Y[3 * q + k], X[3 * (q / 4 * 8 + q % 4 + 4 * b) + k], 1e4 * BW_REAL_EPSILON);
  }
  bw_solid_set_destroy(&set);
  bw_solid_destroy(&one);
  for (int b = 0; b < 2; b++)
    bw_solid_destroy(&two[b]);
  pd_body_release(&both);
  pd_body_release(&left);
  pd_body_release(&right);
}
END_TEST

/* In the middle of a bounce both solids go on from a checkpoint, in a new set. */
START_TEST(a_restart_in_a_bounce_goes_on)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  scene t = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.2 * bw_solid_set_dt(s.set);
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
  compare(s.ball, t.ball, bw_solid_get_position, 1e4 * BW_REAL_EPSILON);
  compare(s.plate, t.plate, bw_solid_get_position, 1e4 * BW_REAL_EPSILON);
  scene_release(&s);
  scene_release(&t);
}
END_TEST

/* Retired in the middle of a bounce: no pairs any more, what was stored is booked or flies on. */
START_TEST(a_retired_ball_is_left_alone)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.2 * bw_solid_set_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 2000)
    steps(&s, 1, dt);
  ck_assert_int_gt(bw_solid_set_pairs(s.set), 0);
  bool *gone = NULL;
  bw_check_ok(BW_ALLOCATE(&gone, bw_solid_count(s.ball)));
  for (size_t i = 0; i < bw_solid_count(s.ball); i++)
    gone[i] = true;
  bw_check_ok(bw_solid_retire(s.ball, gone));
  const double before = upward(&s);
  steps(&s, 20, dt);
  ck_assert_int_eq(bw_solid_set_pairs(s.set), 0);
  ck_assert_double_eq(book(&s).contact, 0);
  ck_assert_double_eq(upward(&s), before);
  bw_release(&gone);
  scene_release(&s);
}
END_TEST

/* A new state of one solid alone: forces between are those of the new state, once. */
START_TEST(a_new_state_of_one_takes_the_forces_of_both_anew)
{
  scene s = throw_ball(bw_check_world(), plate_config(), ball_config(HEIGHT), BW_PD_FREE, THROW);
  const double dt = 0.1 * bw_solid_set_dt(s.set);
  int n = 0;
  while (book(&s).contact < 0.02 && n++ < 4000)
    steps(&s, 1, dt);
  const size_t m = bw_solid_count(s.ball);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * m));
  bw_check_ok(BW_ALLOCATE(&V, 3 * m));
  bw_solid_get_position(s.ball, X);
  bw_solid_get_velocity(s.ball, V);
  bw_solid_set_state(s.ball, X, V); /* what it was */
  const bw_solid_ledger before = book(&s);
  steps(&s, 40, dt);
  const bw_solid_ledger after = book(&s);
  for (int k = 0; k < 3; k++)
    bw_check_near(after.momentum[k], before.momentum[k], 1e4 * BW_REAL_EPSILON);
  bw_check_near(energy(&after) / energy(&before), 1, 0.002);
  bw_release(&X);
  bw_release(&V);
  scene_release(&s);
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
  bw_check_ok(bw_solid_set_create(2, (bw_solid *[]){s.plate, s.ball}, &s.set));
  memcpy(speed, (double[]){-0.4, 0, 0}, sizeof speed);
  pd_set(s.ball, NULL, thrown);
  const bw_solid_ledger start = book(&s);
  const double dt = 0.1 * bw_solid_set_dt(s.set);
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

static void refused(bw_solid_config c, bw_solid_config d, const char *word)
{
  pd_body one = pd_box(4, 4, 1);
  bw_solid *two[] = {pd_make(bw_check_world(), &c, &one), pd_make(bw_check_world(), &d, &one)};
  bw_solid_set *set = NULL;
  bw_check_status(bw_solid_set_create(2, two, &set), BW_EINPUT);
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
  bw_solid_set *set = NULL;
  bw_check_status(bw_solid_set_create(2, (bw_solid *[]){s, s}, &set), BW_EINPUT);
  bw_check_ok(bw_solid_set_create(1, &s, &set));
  bw_check_status(bw_solid_set_step(set, 2 * bw_solid_dt_max(s)), BW_ECFL);
  bw_check_ok(bw_solid_set_step(set, bw_solid_set_dt(set)));
  bw_solid_set_destroy(&set);
  bw_solid_destroy(&s);
  pd_body_release(&one);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_ball_bounces_off_a_turned_plate),
                                      BW_TEST(a_bounce_does_not_depend_on_ranks),
                                      BW_TEST(a_held_body_pushes_and_its_work_is_booked),
                                      BW_TEST(a_body_that_passes_far_away_costs_no_pairs),
                                      BW_TEST(a_pair_takes_the_smaller_reach_and_the_harmonic_mean),
                                      BW_TEST(two_bodies_on_one_lattice_bounce_as_one_with_contact),
                                      BW_TEST(a_restart_in_a_bounce_goes_on),
                                      BW_TEST(a_retired_ball_is_left_alone),
                                      BW_TEST(a_new_state_of_one_takes_the_forces_of_both_anew),
                                      BW_TEST(discs_that_break_keep_their_book),
                                      BW_TEST(what_does_not_go_together_is_named)};
BW_CHECK_MAIN("solid_set", tests)
