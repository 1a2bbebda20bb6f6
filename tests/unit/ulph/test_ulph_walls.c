/* Walls: a tank at rest stays at rest, a wall that moves carries the fluid, and what cannot be is
 * refused with what would do.
 * TEST ranks=1,2,3 */
#include "ulph_test.h"

enum { N = 12 };

static void rest(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = v[1] = v[2] = 0;
  *p = 9810 * (1 - x[1]);
}

static bw_ulph_config tank_config(int d)
{
  bw_ulph_config c = bw_ulph_config_default();
  c.dimensions = d, c.dx = 1.0 / N, c.rho0 = 1000, c.speed = 3.2, c.gravity[1] = -9.81;
  return c;
}

/* A tank of water 1 high and wide (and 0.5 deep) with walls that are `thick` times dx. */
static bw_status tank(const bw_ulph_config *c, double thick, bool moves, double water, bw_ulph **u)
{
  const double t = thick * c->dx, origin[3] = {0};
  const bw_shape fluid = {.kind = BW_SHAPE_BOX, .upper = {water, 1, 0.5}};
  const bw_shape wall[2] = {
      {.kind = BW_SHAPE_BOX, .lower = {-t, -t, -t}, .upper = {1 + t, 1.5, 0.5 + t}},
      {.kind = BW_SHAPE_BOX, .remove = true, .upper = {1, 9, 0.5}}};
  const bw_ulph_wall walls = {.count = 2, .shape = wall, .moves = moves};
  size_t n = 0;
  double *x = NULL;
  bw_check_ok(bw_ulph_fill(bw_check_world(), c, origin, 1, &fluid, &n, &x));
  const bw_status st = bw_ulph_create(bw_check_world(), c, n, x, 1, &walls, u);
  bw_release(&x);
  return st;
}

START_TEST(a_tank_stays_at_rest)
{
  for (int d = 2; d <= 3; d++) {
    const bw_ulph_config c = tank_config(d);
    const double lower[3] = {-9, -9, -9}, upper[3] = {9, 9, 9};
    const double floor_lower[3] = {0.2, -0.9 / N, 0.1}, floor_upper[3] = {0.8, 0, 0.4};
    bw_ulph *u = NULL;
    bw_check_ok(tank(&c, 4, false, 1, &u));
    bw_check_ok(bw_ulph_start(u, rest, NULL));
    const bw_ulph_ledger first = bw_ulph_account(u);
    ulph_advance(u, d == 2 ? 300 : 40);
    const bw_ulph_ledger now = bw_ulph_account(u);
    /* 1e-6 of rho g H^2 L is what a tank may have after long; rows settle by 0.2 dx at most. */
    ck_assert_double_le(now.kinetic, 1e-5 * 2 * first.potential);
    bw_check_near(bw_ulph_reach(u, 1, lower, upper), 1, 0.2 / N);
    bw_check_near(bw_ulph_reach(u, 0, lower, upper), 1, 0.2 / N);
    /* Wall particles of the first layer are half a spacing below the floor. Sound of the settling
     * rows, of a weight of rho g 0.2 dx, passes by. */
    const double expected = 9810 * (1 + 0.5 / N);
    bw_check_near(bw_ulph_wall_pressure(u, floor_lower, floor_upper) / expected, 1, 0.2 / N);
    bw_check_near(bw_ulph_depth(u, (double[3]){0.5, 0, 0.25}, 0.2), 1, 0.01);
    ck_assert_int_eq(bw_ulph_outside(u, (double[3]){0}, (double[3]){1, 1.1, 0.5}), 0);
    /* The walls carry the weight. */
    double force[3];
    bw_ulph_wall_force(u, force);
    bw_check_near(force[1] / (-9.81 * now.mass), 1, 0.05);
    bw_ulph_destroy(&u);
  }
}
END_TEST

/* Starts with constant acceleration. */
static void accelerate(double t, void *context, double x[3], double v[3], double a[3])
{
  (void)context;
  x[0] = 0.5 * t * t, v[0] = t, a[0] = 1;
  x[1] = x[2] = v[1] = v[2] = a[1] = a[2] = 0;
}

START_TEST(moving_walls_carry_the_fluid)
{
  bw_ulph_config c = tank_config(2);
  c.motion = accelerate;
  bw_ulph *u = NULL;
  bw_check_ok(tank(&c, 4, true, 1, &u));
  bw_check_ok(bw_ulph_start(u, rest, NULL));
  while (bw_ulph_time(u) < 0.25)
    bw_check_ok(bw_ulph_step(u, bw_ulph_dt_max(u)));
  const bw_ulph_ledger l = bw_ulph_account(u);
  const double t = bw_ulph_time(u);
  /* The mean velocity follows; the surface sloshes, which takes up to a fifth of the momentum. */
  bw_check_near(l.momentum[0] / (l.mass * t), 1, 0.25);
  /* The walls' work is what the fluid has gained. */
  ck_assert_double_gt(l.walls, 0.4 * l.mass * t * t * 0.5);
  ck_assert_double_le(fabs(l.gap), 1e-3 * l.first);
  ck_assert_int_eq(bw_ulph_outside(u, (double[3]){0.5 * t * t - 0.01, 0, 0},
                                   (double[3]){1.01 + 0.5 * t * t, 1.3, 0}),
                   0);
  bw_ulph_destroy(&u);
}
END_TEST

static void tension(const double x[3], void *context, double v[3], double *p)
{
  (void)x, (void)context;
  v[0] = v[1] = v[2] = 0;
  *p = -1;
}

/* The same tank in another unit of length has the same particles. */
START_TEST(units_do_not_show)
{
  int64_t particles[2] = {0, 0};
  for (int q = 0; q < 2; q++) {
    bw_ulph_config c = tank_config(2);
    const double unit = q == 0 ? 1 : 100, t = 6 * unit / N, origin[3] = {0};
    c.dx *= unit, c.speed *= unit, c.gravity[1] *= unit;
    const bw_shape fluid = {.kind = BW_SHAPE_BOX, .upper = {unit, unit, unit}};
    const bw_shape wall[2] = {
        {.kind = BW_SHAPE_BOX, .lower = {-t, -t, -t}, .upper = {unit + t, 1.5 * unit, unit + t}},
        {.kind = BW_SHAPE_BOX, .remove = true, .upper = {unit, 9 * unit, unit}}};
    const bw_ulph_wall walls = {.count = 2, .shape = wall};
    size_t n = 0;
    double *x = NULL;
    bw_ulph *u = NULL;
    bw_check_ok(bw_ulph_fill(bw_check_world(), &c, origin, 1, &fluid, &n, &x));
    bw_check_ok(bw_ulph_create(bw_check_world(), &c, n, x, 1, &walls, &u));
    particles[q] = (int64_t)(u->fluid.own + u->wall.own);
    bw_release(&x);
    bw_ulph_destroy(&u);
  }
  bw_comm_sum_int(bw_check_world(), 2, particles);
  ck_assert_int_gt(particles[0], N * N);
  ck_assert_int_eq(particles[1], particles[0]);
}
END_TEST

/* Walls do not pull (their pressure is 0 at least): beside one, fluid under a uniform tension of -1
 * feels the gradient of the difference form, V M^-1 times the sum of w V x over wall particles
 * alone, as nothing else differs from it. On its lattice of spacing dx, M is that of all of them.
 * p is a difference of densities, of which it is a millionth. */
START_TEST(tension_is_met_by_the_difference_form_beside_a_wall)
{
  bw_ulph_config c = tank_config(2);
  bw_ulph *u = NULL;
  double moment = 0, beside = 0;
  c.gravity[1] = 0;
  bw_check_ok(tank(&c, 4, false, 1, &u));
  bw_check_ok(bw_ulph_start(u, tension, NULL));
  /* Rows j = 0, -1, .. of the wall and of the fluid, seen from the first row of the fluid. */
  for (int j = -4; j <= 4; j++)
    for (int i = -4; i <= 4; i++) {
      const double y = j * c.dx, r2 = (i * i + j * j) * c.dx * c.dx;
      const double w = vec_weight((vec){r2}, 1 / (u->R * u->R))[0];
      moment += w * y * y;
      beside -= j < 0 ? w * y : 0;
    }
  int64_t found = 0;
  for (size_t i = 0; i < bw_ulph_count(u); i++) {
    const bw_ulph__particle *p = u->own + i;
    if (p->x[1] > c.dx || fabs(p->x[0] - 0.5) > 0.2) continue;
    bw_check_near(p->a[0] * c.rho0 * c.dx, 0, 1e-6);
    bw_check_near(p->a[1] * c.rho0, beside / moment, 1e-6);
    found++;
  }
  bw_comm_sum_int(bw_check_world(), 1, &found);
  ck_assert_int_ge(found, 4);
  bw_ulph_destroy(&u);
}
END_TEST

static void expect(const char *words)
{
  ck_assert_msg(strstr(bw_last_message(), words) != NULL, "no '%s' in: %s", words,
                bw_last_message());
}

START_TEST(bad_input_is_refused)
{
  bw_ulph *u = NULL;
  bw_ulph_config c = tank_config(2);
  c.c0 = 20;
  bw_check_status(tank(&c, 4, false, 1, &u), BW_EINPUT);
  expect("at least 32");
  c = tank_config(2), c.speed = 0.1, c.c0 = 20;
  /* sqrt(9.81 (1 + dx/12...)) */
  bw_check_status(tank(&c, 4, false, 1, &u), BW_EINPUT);
  expect("it must be at least 3");
  c = tank_config(2);
  bw_check_status(tank(&c, 2, false, 1, &u), BW_EINPUT);
  expect("wall 0 is thinner than 3 dx");
  bw_check_status(tank(&c, 4, false, 1.2, &u), BW_EINPUT);
  expect("is inside wall 0");
  bw_check_status(tank(&c, 4, true, 1, &u), BW_EINPUT);
  expect("wall 0 moves, but");
  c.dx = NAN;
  bw_check_status(bw_ulph_create(bw_check_world(), &c, 0, NULL, 0, NULL, &u), BW_EINPUT);
  expect("dx is nan");
  c = tank_config(2), c.delta = 1;
  bw_check_status(bw_ulph_create(bw_check_world(), &c, 0, NULL, 0, NULL, &u), BW_EINPUT);
  expect("delta is 1");
  c = tank_config(2);
  bw_check_status(bw_ulph_create(bw_check_world(), &c, 0, NULL, 0, NULL, &u), BW_EINPUT);
  expect("there is no fluid");
  const int me = bw_comm_rank(bw_check_world());
  const double twice[6] = {0.02 * me, 0, 0, 0.02 * me + 0.01, 0, 0};
  bw_check_status(bw_ulph_create(bw_check_world(), &c, 2, twice, 0, NULL, &u), BW_EINPUT);
  expect("overlap");
  ck_assert_ptr_null(u);
}
END_TEST

START_TEST(steps_that_cannot_be_are_refused)
{
  const bw_ulph_config c = tank_config(2);
  bw_ulph *u = NULL;
  bw_check_ok(tank(&c, 4, false, 1, &u));
  bw_check_status(bw_ulph_step(u, 3 * c.dx / bw_ulph_c0(u)), BW_ECFL);
  bw_check_status(bw_ulph_step(u, NAN), BW_ECFL);
  bw_ulph_destroy(&u);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_tank_stays_at_rest), BW_TEST(moving_walls_carry_the_fluid),
    BW_TEST(units_do_not_show),    BW_TEST(tension_is_met_by_the_difference_form_beside_a_wall),
    BW_TEST(bad_input_is_refused), BW_TEST(steps_that_cannot_be_are_refused),
};
BW_CHECK_MAIN("ulph walls", tests)
