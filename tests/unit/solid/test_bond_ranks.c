/* The answer does not depend on the number of ranks; restart on another number; periods.
 * TEST ranks=1,2,3,4 */
#include "pd_test.h"

static void shake(const double X0[3], double v[3])
{
  v[0] = 0.3 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.2 * cos(3 * X0[1]) + 0.1 * X0[0];
  v[2] = 0.2 * sin(X0[2] * X0[0]);
}

/* A block with a hole, so that rows are ragged and cuts go through them. */
static pd_body holed(void)
{
  pd_body b = pd_box(13, 7, 6);
  int64_t kept = 0;
  for (int64_t q = 0; q < b.n; q++) {
    const int32_t *s = b.site + 3 * q;
    const double r2 = pow(s[0] - 6, 2) + pow(s[1] - 3, 2) + pow(s[2] - 5, 2);
    if (r2 < 5) continue;
    for (int k = 0; k < 3; k++)
      b.site[3 * kept + k] = s[k];
    kept++;
  }
  b.n = kept;
  return b;
}

/* Four ways to run: RK3 or damped Verlet, on a lattice or in a cloud. */
enum { WAYS = 4 };
static bw_solid_config breaking(int way)
{
  const bool damped = way % 2 == 1;
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.G0 = 0.003;
  c.damping.pair = damped ? 0.02 : 0;
  c.damping.mean = damped ? 0.01 : 0;
  c.surface_correction = way == 1 ? BW_PD_SURFACE_TENSOR : BW_PD_SURFACE_VOLUME;
  c.integrator = damped ? BW_SOLID_VERLET : BW_SOLID_RK3;
  c.disorder = way < 2 ? 0 : 0.3;
  return c;
}

START_TEST(same_motion_and_bonds_on_any_number_of_ranks)
{
  bw_comm *self = pd_alone();
  pd_body body = holed();
  for (int way = 0; way < WAYS; way++) {
    const bw_solid_config c = breaking(way);
    bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
    ck_assert_double_eq(bw_solid_dt_max(many), bw_solid_dt_max(one));
    pd_set(many, NULL, shake);
    pd_set(one, NULL, shake);
    const double dt = 0.4 * bw_solid_dt_max(one);
    pd_steps(many, 50, dt);
    pd_steps(one, 50, dt);
    pd_check_same(many, one, bw_solid_get_position,
                  1e-13 + 400 * (BW_REAL_EPSILON > 1e-10) * BW_REAL_EPSILON);
    pd_steps(many, 150, dt);
    pd_steps(one, 150, dt);
    const bw_solid_ledger a = ledger_of(many), b = ledger_of(one);
    ck_assert_int_gt(b.broken, 50);
    ck_assert_int_eq(a.broken, b.broken);
    bw_check_near(a.fracture, b.fracture, 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.damping, b.damping, 1e3 * BW_REAL_EPSILON);
    pd_check_same(many, one, bw_solid_get_velocity, 1e4 * BW_REAL_EPSILON);
    bw_solid_destroy(&many);
    bw_solid_destroy(&one);
  }
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* A plate too wide for the cache is numbered with its thickness before its width; the parts of two
 * ranks and more are not. */
START_TEST(a_wide_plate_moves_as_its_parts_do)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(72, 64, 4);
  const bw_solid_config c = pd_soft(BW_PD_3D);
  bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  pd_set(many, NULL, shake);
  pd_set(one, NULL, shake);
  pd_steps(many, 5, 0.4 * bw_solid_dt_max(one));
  pd_steps(one, 5, 0.4 * bw_solid_dt_max(one));
  pd_check_same(many, one, bw_solid_get_velocity, 1e3 * BW_REAL_EPSILON);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* Stop in the middle of cracking, go on with one rank each: the same to the last bit but for the
 * order of sums over ranks in the book. */
START_TEST(restart_on_another_number_of_ranks)
{
  bw_comm *self = pd_alone();
  pd_body body = holed();
  for (int way = 0; way < WAYS; way++) {
    const bw_solid_config c = breaking(way);
    bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
    const double dt = 0.4 * bw_solid_dt_max(one);
    bw_check_ok(bw_solid_precrack(many, (double[]){1, 1, 0.5}, (double[]){2, 1, 0.5},
                                  (double[]){1, 2, 0.5}));
    pd_set(many, NULL, shake);
    pd_steps(many, 80, dt);
    pd_restart_from(many, one);
    ck_assert_int_eq(ledger_of(many).bonds, ledger_of(one).bonds);
    ck_assert_int_eq(ledger_of(many).broken, ledger_of(one).broken);
    pd_steps(many, 100, dt);
    pd_steps(one, 100, dt);
    const bw_solid_ledger a = ledger_of(many), b = ledger_of(one);
    ck_assert_int_eq(a.broken, b.broken);
    ck_assert_int_gt(a.broken, 50);
    bw_check_near(a.fracture, b.fracture, 1e3 * BW_REAL_EPSILON);
    bw_check_near(a.damping, b.damping,
                  1e-3); /* one kick is split anew between bonds and damping */
    pd_check_same(many, one, bw_solid_get_position, 0);
    pd_check_same(many, one, bw_solid_get_velocity, 0);
    bw_solid_destroy(&many);
    bw_solid_destroy(&one);
  }
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* A body settles with damping; the next run has none: it goes on as if nobody had stopped. */
START_TEST(a_settled_state_holds_no_settling_damping)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(8, 6, 5);
  const bw_solid_config c = pd_soft(BW_PD_3D);
  bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  const double dt = 0.4 * bw_solid_dt_max(one);
  pd_set(many, NULL, shake);
  bw_solid_set_damping(many, 0, 0, 0.1 * c.rho / dt);
  pd_steps(many, 20, dt);
  bw_solid_set_damping(one, 0, 0,
                       0); /* as the run that goes on enters the next phase, then reads */
  pd_restart_from(many, one);
  bw_solid_set_damping(many, 0, 0, 0);
  pd_steps(many, 20, dt);
  pd_steps(one, 20, dt);
  pd_check_same(many, one, bw_solid_get_position, 0);
  pd_check_same(many, one, bw_solid_get_velocity, 0);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* A checkpoint holds the damping of its accelerations: the book of the next kick is the same. */
START_TEST(the_book_of_damping_goes_on)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(8, 6, 5);
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.damping.pair = 0.05;
  bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  const double dt = 0.4 * bw_solid_dt_max(one);
  pd_set(many, NULL, shake);
  pd_steps(many, 20, dt);
  pd_restart_from(many, one);
  const double before = ledger_of(many).damping;
  pd_steps(many, 1, dt);
  pd_steps(one, 1, dt);
  const double taken = ledger_of(many).damping - before;
  ck_assert_double_gt(fabs(taken), 1e-6 * ledger_of(many).kinetic);
  /* Half of it is taken by the kick with the stored damping. The book is a difference of sums. */
  bw_check_near((ledger_of(one).damping - before) / taken, 1.0,
                1e3 * BW_REAL_EPSILON * fabs(before / taken));
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* Whoever moves a particle does the work on it; a force on top of that does none. */
START_TEST(forces_on_prescribed_particles_do_no_work)
{
  pd_body body = pd_box(8, 6, 5);
  for (int64_t q = 0; q < body.n; q++)
    if (body.site[3 * q] < 2) body.kind[q] = BW_PD_PRESCRIBED;
  const bw_solid_config c = pd_soft(BW_PD_3D);
  double external[2];
  for (int pushed = 0; pushed < 2; pushed++) {
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    const size_t n = bw_solid_count(pd);
    double *V = NULL, *F = NULL;
    bw_check_ok(BW_ALLOCATE(&V, 3 * n));
    bw_check_ok(BW_ALLOCATE(&F, 3 * n));
    for (size_t i = 0; i < n; i++) {
      if (!(bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED)) continue;
      V[3 * i] = 0.01;
      F[3 * i] = 0.5 * pushed;
    }
    bw_solid_set_prescribed(pd, V);
    bw_solid_set_force(pd, F);
    pd_steps(pd, 20, 0.4 * bw_solid_dt_max(pd));
    external[pushed] = ledger_of(pd).external;
    bw_release(&V);
    bw_release(&F);
    bw_solid_destroy(&pd);
  }
  ck_assert_double_gt(external[0], 0);
  ck_assert_double_eq(external[0], external[1]);
  pd_body_release(&body);
}
END_TEST

/* The same number on any number of ranks, another one for another place, kind or horizon. */
START_TEST(a_fingerprint_tells_bodies_apart)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(8, 6, 5);
  bw_solid_config c = pd_soft(BW_PD_3D);
  bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  const uint64_t print = bw_solid_fingerprint(many);
  ck_assert(print == bw_solid_fingerprint(one));
  pd_set(many, NULL, shake);
  pd_steps(many, 5, 0.4 * bw_solid_dt_max(one));
  ck_assert(print == bw_solid_fingerprint(many));
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  for (int way = 0; way < 4; way++) {
    c = pd_soft(BW_PD_3D);
    if (way == 0) body.kind[7] = BW_PD_PRESCRIBED;
    if (way == 1) body.kind[7] = BW_PD_FREE, body.site[0] -= 1;
    if (way == 2) body.site[0] += 1, c.origin[1] = 0.25;
    if (way == 3) c.horizon_ratio *= 1.001;
    one = pd_make(self, &c, &body);
    ck_assert(print != bw_solid_fingerprint(one));
    bw_solid_destroy(&one);
  }
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* A wave along x in a bar that is periodic in y and z (also with periods below the horizon) is the
 * wave in the middle of a bulk: no edge is felt. */
static void along_x(const double X0[3], double v[3])
{
  v[0] = 0.1 * sin(X0[0]);
  v[1] = 0.05 * cos(2 * X0[0]);
  v[2] = 0;
}

static void row_of(const bw_solid *pd, const pd_body *body, int y, int z, double out[])
{
  double *X = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * (size_t)body->n));
  pd_gather(pd, bw_solid_get_velocity, X);
  for (int64_t q = 0; q < body->n; q++)
    if (body->site[3 * q + 1] == y && body->site[3 * q + 2] == z)
      for (int k = 0; k < 3; k++)
        out[3 * body->site[3 * q] + k] = X[3 * q + k];
  bw_release(&X);
}

START_TEST(periods_are_an_endless_body)
{
  const int length = 10;
  double bulk[30], thin[30];
  pd_body wide = pd_box(length, 16, 16), narrow = pd_box(length, 4, 2);
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.surface_correction = BW_PD_SURFACE_NONE;
  bw_solid *a = pd_make(bw_check_world(), &c, &wide);
  c.period[1] = 2, c.period[2] = 1;
  bw_solid *b = pd_make(bw_check_world(), &c, &narrow);
  pd_set(a, NULL, along_x);
  pd_set(b, NULL, along_x);
  /* 2 steps: the edge's news has come 3 x 2 cells far, the middle is 7 away */
  pd_steps(a, 2, 0.3);
  pd_steps(b, 2, 0.3);
  row_of(a, &wide, 8, 8, bulk);
  row_of(b, &narrow, 1, 1, thin);
  for (int q = 0; q < 3 * length; q++)
    bw_check_near(thin[q], bulk[q], 20 * BW_REAL_EPSILON);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&wide);
  pd_body_release(&narrow);
}
END_TEST

/* A lattice turned in space moves in the same way, turned. */
START_TEST(orientation_does_not_matter)
{
  pd_body body = pd_box(6, 5, 4);
  bw_solid_config c = pd_soft(BW_PD_3D);
  bw_solid *a = pd_make(bw_check_world(), &c, &body);
  const double s = 0.6, k = 0.8, R[3][3] = {{k, s, 0}, {-s, k, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c.axes[i][j] = R[i][j];
  bw_solid *b = pd_make(bw_check_world(), &c, &body);
  const size_t n = bw_solid_count(a);
  double *X = NULL, *V = NULL, *W = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&W, 3 * n));
  bw_solid_get_reference(a, X);
  for (size_t i = 0; i < n; i++) {
    shake(X + 3 * i, V + 3 * i);
    for (int q = 0; q < 3; q++)
      W[3 * i + (size_t)q] = R[0][q] * V[3 * i] + R[1][q] * V[3 * i + 1] + R[2][q] * V[3 * i + 2];
  }
  bw_solid_set_state(a, X, V);
  bw_solid_get_reference(b, X);
  bw_solid_set_state(b, X, W);
  pd_steps(a, 40, 0.3);
  pd_steps(b, 40, 0.3);
  bw_solid_get_velocity(a, V);
  bw_solid_get_velocity(b, W);
  for (size_t i = 0; i < n; i++)
    for (int q = 0; q < 3; q++)
      bw_check_near(W[3 * i + (size_t)q],
                    R[0][q] * V[3 * i] + R[1][q] * V[3 * i + 1] + R[2][q] * V[3 * i + 2],
                    1e4 * BW_REAL_EPSILON);
  bw_release(&X);
  bw_release(&V);
  bw_release(&W);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(same_motion_and_bonds_on_any_number_of_ranks),
                                      BW_TEST(a_wide_plate_moves_as_its_parts_do),
                                      BW_TEST(restart_on_another_number_of_ranks),
                                      BW_TEST(a_settled_state_holds_no_settling_damping),
                                      BW_TEST(the_book_of_damping_goes_on),
                                      BW_TEST(forces_on_prescribed_particles_do_no_work),
                                      BW_TEST(a_fingerprint_tells_bodies_apart),
                                      BW_TEST(periods_are_an_endless_body),
                                      BW_TEST(orientation_does_not_matter)};
BW_CHECK_MAIN("pd_bond.ranks", tests)
