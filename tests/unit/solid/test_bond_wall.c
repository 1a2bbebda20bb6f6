/* Walls, and pieces that leave.
 * BUILD modules=solid_tools
 * TEST ranks=1,2,3,4 */
#include "bw_solid_load.h"
#include "pd_test.h"

#include <string.h>

static const double ROUND_OFF = 1e3 * BW_REAL_EPSILON;
static const bw_pd_wall floor_at_0 = {.normal = {0, 1, 0}, .offset = 0};

static bw_solid_config soft_contact(void)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.contact = true;
  return c;
}

static double lowered;

static void lower(const double X0[3], double u[3])
{
  (void)X0;
  u[1] = -lowered;
}

/* A particle at y < ds/2 from a wall: its image is 2 y away; half a pair's energy. Nothing beyond
 * ds/2. Oblique plane: the push is along its normal. */
START_TEST(one_particle_in_closed_form)
{
  const bw_solid_config c = soft_contact();
  const bw_pd_wall oblique = {.normal = {0.6, 0.8, 0}, .offset = 0.1};
  pd_body one = pd_box(1, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &one);
  bw_check_ok(bw_solid_set_walls(pd, 1, &oblique));
  const double k = 15 * bw_solid_micromodulus(pd) * 0.125;
  for (int q = 0; q < 2; q++) { /* at (1/4, 1/4 - lowered, 1/4) */
    lowered = q == 0 ? 0.2 : -0.01;
    const double y = 0.6 * 0.25 + 0.8 * (0.25 - lowered) - 0.1, r = 2 * y;
    ck_assert_int_eq(r < 0.5, q == 0);
    const double push = q == 0 ? k / 2 * (0.5 / r - 1) : 0;
    const double energy = q == 0 ? 0.5 * k * 0.125 * (0.5 * log(0.5 / r) - 0.5 + r) : 0;
    double A[3];
    pd_set(pd, lower, NULL);
    const bw_solid_ledger l = ledger_of(pd);
    pd_gather(pd, bw_solid_get_acceleration, A);
    for (int d = 0; d < 3; d++)
      bw_check_near(A[d], push * oblique.normal[d], ROUND_OFF * k);
    bw_check_near(l.contact, energy, ROUND_OFF * k);
  }
  bw_solid_destroy(&pd);
  pd_body_release(&one);
}
END_TEST

static double speed = 0.1;

static void towards_middle(const double X0[3], double v[3])
{
  v[1] = X0[1] > 0 ? -speed : speed;
  v[0] = 0.3 * speed * X0[1] * (X0[1] > 0 ? 1 : -1); /* and sheared, alike on both sides */
}

/* What a wall does to a body is what its mirror image would do, through a whole bounce. */
START_TEST(a_wall_is_a_mirror)
{
  enum { SIDE = 3, GAP = 2, COUNT = SIDE * SIDE * SIDE };
  bw_solid_config c = soft_contact();
  pd_body two = pd_box(SIDE, 2 * SIDE, SIDE), one = pd_box(SIDE, SIDE, SIDE);
  for (int64_t q = 0; q < two.n; q++)
    two.site[3 * q + 1] += two.site[3 * q + 1] < SIDE ? -SIDE - GAP : GAP - SIDE;
  for (int64_t q = 0; q < one.n; q++)
    one.site[3 * q + 1] += GAP;
  bw_solid *pair = pd_make(bw_check_world(), &c, &two);
  bw_solid *single = pd_make(bw_check_world(), &c, &one);
  bw_check_ok(
      bw_solid_precrack(pair, (double[]){-9, 0, -9}, (double[]){9, 0, -9}, (double[]){-9, 0, 9}));
  bw_check_ok(bw_solid_set_walls(single, 1, &floor_at_0));
  pd_set(pair, NULL, towards_middle);
  pd_set(single, NULL, towards_middle);
  const double dt = 0.2 * bw_solid_dt_max(pair);
  double Xp[6 * COUNT], Xs[3 * COUNT], most = 0;
  for (int q = 0; q < 40; q++) {
    pd_steps(pair, (int)(0.6 / dt), dt);
    pd_steps(single, (int)(0.6 / dt), dt);
    pd_gather(pair, bw_solid_get_position, Xp);
    pd_gather(single, bw_solid_get_position, Xs);
    most = fmax(most, ledger_of(single).contact);
    for (int z = 0; z < SIDE; z++)
      for (int i = 0; i < SIDE * SIDE; i++)
        for (int d = 0; d < 3; d++)
          bw_check_near(Xp[3 * (z * 2 * SIDE * SIDE + SIDE * SIDE + i) + d],
                        Xs[3 * (z * SIDE * SIDE + i) + d], 1e4 * ROUND_OFF);
  }
  ck_assert_double_gt(most, 0);
  ck_assert_double_gt(ledger_of(single).momentum[1], 0); /* it bounced */
  bw_solid_destroy(&pair);
  bw_solid_destroy(&single);
  pd_body_release(&two);
  pd_body_release(&one);
}
END_TEST

/* A block falls on the floor under gravity and bounces. The book closes to the order of the
 * integrator; momentum, the walls' impulse and gravity's balance to round-off. */
static void check_fall(bw_solid_integrator integrator)
{
  const double g[3] = {0.0, -0.004, 0.0};
  bw_solid_config c = soft_contact();
  c.integrator = integrator;
  pd_body body = pd_box(4, 3, 3);
  for (int64_t q = 0; q < body.n; q++)
    body.site[3 * q + 1] += 2;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const bw_pd_wall box[2] = {floor_at_0, {.normal = {-1, 0, 0}, .offset = -2.5}};
  bw_check_ok(bw_solid_set_walls(pd, 2, box));
  double *F = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * bw_solid_count(pd)));
  bw_solid_load_gravity(pd, g, F);
  bw_solid_set_force(pd, F);
  bw_check_ok(bw_solid_load_launch(pd, (double[3]){0.03, 0, 0}, (double[3]){0}, (double[3]){0}));
  const double dt = 0.1 * bw_solid_dt_max(pd), mass = 36 * 2 * 0.125;
  const double start = pd_energy(pd), scale = mass * 0.004 * 1.0;
  const bw_solid_ledger first = ledger_of(pd);
  double fastest = 0, worst = 0;
  const int steps = (int)(60 / dt);
  for (int q = 0; q < steps; q += 50) {
    pd_steps(pd, 50, dt);
    const bw_solid_ledger l = ledger_of(pd);
    fastest = fmax(fastest, l.momentum[1] / mass);
    worst = fmax(worst, fabs(pd_energy(pd) - start) / scale);
    for (int d = 0; d < 3; d++) {
      const double pushed = mass * g[d] * (q + 50) * dt;
      bw_check_near(l.momentum[d] - first.momentum[d] + l.wall[d], pushed, ROUND_OFF);
    }
  }
  const bw_solid_ledger end = ledger_of(pd);
  ck_assert_double_lt(worst, 0.005);         /* Verlet at a tenth: (w dt)^2/8 */
  ck_assert_double_gt(fastest, 0.5 * 0.089); /* fell by 1: sqrt(2 g) = 0.089; some now vibrates */
  ck_assert_double_gt(end.wall[0], mass * 0.03); /* it came back from the side as well */
  ck_assert_double_lt(end.momentum[0], 0);
  bw_release(&F);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(a_block_falls_and_bounces)
{
  check_fall(BW_SOLID_VERLET);
  check_fall(BW_SOLID_RK3);
}
END_TEST

static void squeeze(const double X0[3], double u[3])
{
  u[1] = X0[1] > 0 ? -0.01 : 0;
}

/* What bonds hold to a foundation beyond the wall does not meet the wall, until they are cut. */
START_TEST(a_foundation_exempts_until_its_bonds_break)
{
  const bw_solid_config c = soft_contact();
  pd_body body = pd_box(3, 4, 3);
  for (int64_t q = 0; q < body.n; q++) {
    body.site[3 * q + 1] -= 2;
    if (body.site[3 * q + 1] < 0) body.kind[q] = BW_PD_PRESCRIBED;
  }
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(bw_solid_set_walls(pd, 1, &floor_at_0));
  pd_set(pd, squeeze, NULL);
  ck_assert_double_eq(ledger_of(pd).contact, 0);
  bw_check_ok(
      bw_solid_precrack(pd, (double[]){-9, 0, -9}, (double[]){9, 0, -9}, (double[]){-9, 0, 9}));
  const double k = 15 * bw_solid_micromodulus(pd) * 0.125, r = 2 * 0.24, pair = 0.49;
  const double on_floor = 0.5 * k * 0.125 * (0.5 * log(0.5 / r) - 0.5 + r);
  const double on_below = k * 0.125 * (0.5 * log(0.5 / pair) - 0.5 + pair);
  bw_check_near(ledger_of(pd).contact, 9 * (on_floor + on_below), ROUND_OFF * k);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static void upwards(const double X0[3], double u[3])
{
  (void)X0;
  u[1] = 1;
}

static void downwards(const double X0[3], double u[3])
{
  (void)X0;
  u[1] = -1;
}

START_TEST(walls_that_make_no_sense_are_refused)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body body = pd_box(2, 2, 2);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_status(bw_solid_set_walls(pd, 1, &floor_at_0), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "contact"));
  bw_solid_destroy(&pd);
  c.contact = true;
  pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(bw_solid_set_walls(pd, 1, &floor_at_0));
  const bw_pd_wall in_body = {{0, 1, 0}, 0.3}, skew = {{0, 1, 1}, 0}, all[7] = {{{0}, 0}};
  bw_check_status(bw_solid_set_walls(pd, 1, &in_body), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "beyond the wall"));
  /* Beyond it at first or now: either is enough. */
  pd_set(pd, upwards, NULL);
  bw_check_status(bw_solid_set_walls(pd, 1, &in_body), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "beyond the wall"));
  pd_set(pd, downwards, NULL);
  bw_check_status(bw_solid_set_walls(pd, 1, &floor_at_0), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "beyond the wall"));
  pd_set(pd, NULL, NULL);
  bw_check_status(bw_solid_set_walls(pd, 1, &skew), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "unit"));
  bw_check_status(bw_solid_set_walls(pd, 7, all), BW_EINPUT);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* One particle with two and a half of its own spacings a step against a wall. */
START_TEST(through_a_wall_is_an_error)
{
  const bw_solid_config c = soft_contact();
  pd_body body = pd_box(2, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(bw_solid_set_walls(pd, 1, &floor_at_0));
  const double dt = bw_solid_dt_max(pd), v = -0.6 / dt;
  bw_check_ok(bw_solid_load_launch(pd, (double[3]){0, v, 0}, (double[3]){0}, (double[3]){0}));
  bw_check_status(bw_solid_step(pd, dt), BW_EDIVERGED);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "through the wall"));
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static void first_one_below(const double X0[3], double u[3])
{
  u[1] = X0[0] < 1 ? -X0[1] - 0.2 : 0;
}

/* One rank alone holds the particle that is beyond the wall. */
START_TEST(a_book_that_cannot_be_made_is_an_error_on_all_ranks)
{
  const bw_solid_config c = soft_contact();
  pd_body body = pd_box(4, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_solid_ledger ledger = {.kinetic = -1};
  bw_check_ok(bw_solid_set_walls(pd, 1, &floor_at_0));
  pd_set(pd, first_one_below, NULL);
  for (int q = 0; q < 2; q++) {
    bw_check_status(bw_solid_account(pd, &ledger), BW_EDIVERGED);
    /* Nor does a rank step alone while the others know better. */
    bw_check_status(bw_solid_step(pd, 1e-3 * bw_solid_dt_max(pd)), BW_EDIVERGED);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), "through the wall"));
    ck_assert_double_eq(ledger.kinetic, -1); /* as it was */
    /* Nor can a step begin; nobody goes on to wait for the one that cannot. */
    pd_set(pd, first_one_below, NULL);
    bw_check_status(bw_solid_step(pd, 0.1 * bw_solid_dt_max(pd)), BW_EDIVERGED);
  }
  pd_set(pd, NULL, NULL);
  ck_assert_double_eq(ledger_of(pd).kinetic, 0);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static void part(const double X0[3], double v[3])
{
  v[0] = X0[0] < 2 ? -0.04 : 0.02;
  v[1] = 0.02 * (X0[0] - 1) * X0[2];
  v[2] = -0.03 * (X0[0] - 1);
}

/* Two blocks that cracked off each other and part, spinning and vibrating. */
static bw_solid *two_pieces(const bw_comm *comm, const pd_body *body, double damping)
{
  bw_solid_config c = soft_contact();
  c.damping.pair = damping;
  bw_solid *pd = pd_make(comm, &c, body);
  bw_check_ok(
      bw_solid_precrack(pd, (double[]){2, -9, -9}, (double[]){2, 9, -9}, (double[]){2, -9, 9}));
  pd_set(pd, NULL, part);
  return pd;
}

static void retire_left(bw_solid *pd)
{
  const size_t n = bw_solid_count(pd);
  double *X0 = NULL;
  bool *gone = NULL;
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_check_ok(BW_ALLOCATE(&gone, n));
  bw_solid_get_reference(pd, X0);
  for (size_t i = 0; i < n; i++)
    gone[i] = X0[3 * i] < 2;
  bw_check_ok(bw_solid_retire(pd, gone));
  bw_release(&X0);
  bw_release(&gone);
}

START_TEST(a_retired_piece_flies_on)
{
  enum { COUNT = 8 * 3 * 3 };
  pd_body body = pd_box(8, 3, 3);
  bw_solid *pd = two_pieces(bw_check_world(), &body, 0);
  bw_solid *kept = two_pieces(bw_check_world(), &body, 0);
  const double dt = 0.3 * bw_solid_dt_max(pd);
  double X[2][3 * COUNT], V[2][3 * COUNT], Xk[3 * COUNT];
  pd_steps(pd, 60, dt); /* until the pieces are apart */
  pd_steps(kept, 60, dt);
  const bw_solid_ledger before = ledger_of(pd);
  ck_assert_double_eq(before.contact, 0);
  const double start = pd_energy(pd);
  retire_left(pd);
  bw_check_near(pd_energy(pd), start, ROUND_OFF);
  ck_assert_double_gt(ledger_of(pd).retired, 0);
  pd_gather(pd, bw_solid_get_position, X[0]);
  pd_gather(pd, bw_solid_get_velocity, V[0]);
  pd_steps(pd, 50, dt);
  pd_steps(kept, 50, dt);
  pd_gather(pd, bw_solid_get_position, X[1]);
  pd_gather(pd, bw_solid_get_velocity, V[1]);
  pd_gather(kept, bw_solid_get_position, Xk);
  for (size_t i = 0; i < COUNT; i++)
    for (size_t d = 3 * i; d < 3 * i + 3; d++) {
      if (i % 8 < 4) { /* the retired piece */
        ck_assert_double_eq(V[1][d], V[0][d]);
        bw_check_near(X[1][d], X[0][d] + 50 * dt * V[0][d], ROUND_OFF);
      } else { /* the other one knows nothing of it */
        bw_check_near(X[1][d], Xk[d], ROUND_OFF);
      }
    }
  const bw_solid_ledger after = ledger_of(pd);
  for (int d = 0; d < 3; d++) {
    bw_check_near(after.momentum[d], before.momentum[d], ROUND_OFF);
    bw_check_near(after.angular[d], before.angular[d], ROUND_OFF);
  }
  ck_assert_int_eq(after.broken, before.broken);
  bw_check_near(pd_energy(pd), start, 1e-3 * before.kinetic); /* Verlet at 0.3 */
  bw_solid_destroy(&pd);
  bw_solid_destroy(&kept);
  pd_body_release(&body);
}
END_TEST

/* Restarted on one rank each, a retired piece stays retired and the book goes on. */
START_TEST(a_restart_knows_who_is_retired)
{
  enum { COUNT = 8 * 3 * 3 };
  bw_comm *self = pd_alone();
  pd_body body = pd_box(8, 3, 3);
  bw_solid *many = two_pieces(bw_check_world(), &body, 0.01);
  bw_solid *one = two_pieces(self, &body, 0.01);
  const bw_pd_wall side = {.normal = {-1, 0, 0}, .offset = -4.0}; /* the right one meets it */
  bw_check_ok(bw_solid_set_walls(many, 1, &side));
  bw_check_ok(bw_solid_set_walls(one, 1, &side));
  const double dt = 0.3 * bw_solid_dt_max(one);
  pd_steps(many, 20, dt);
  retire_left(many);
  pd_steps(many, 20, dt);
  pd_restart_from(many, one);
  pd_steps(many, 50, dt);
  pd_steps(one, 50, dt);
  double X[2][3 * COUNT];
  pd_gather(many, bw_solid_get_position, X[0]);
  pd_gather(one, bw_solid_get_position, X[1]);
  for (size_t d = 0; d < 3 * (size_t)COUNT; d++)
    ck_assert_double_eq(X[0][d], X[1][d]);
  const bw_solid_ledger a = ledger_of(many), b = ledger_of(one);
  ck_assert_double_ne(a.wall[0], 0);
  bw_check_near(a.wall[0], b.wall[0], ROUND_OFF);
  ck_assert_double_ne(a.retired, 0);
  bw_check_near(a.retired, b.retired, ROUND_OFF);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  bw_comm_destroy(&self);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(one_particle_in_closed_form),
                                      BW_TEST(a_wall_is_a_mirror),
                                      BW_TEST(a_block_falls_and_bounces),
                                      BW_TEST(a_foundation_exempts_until_its_bonds_break),
                                      BW_TEST(walls_that_make_no_sense_are_refused),
                                      BW_TEST(through_a_wall_is_an_error),
                                      BW_TEST(a_book_that_cannot_be_made_is_an_error_on_all_ranks),
                                      BW_TEST(a_retired_piece_flies_on),
                                      BW_TEST(a_restart_knows_who_is_retired)};
BW_CHECK_MAIN("pd_bond.wall", tests)
