/* The largest step: what walls, inflows and forcing will do counts from rest on, it is the same
 * for a stream in any direction and its mirror image, and in the longest step of the factored
 * scheme the shortest waves decay as fast as the longest.
 * TEST ranks=1,2,4 */
#include "ns_support.h"

#include <math.h>

static const bool channel[3] = {true, false, true}, closed[3] = {false, false, false},
                  all[3] = {true, true, true};
static const double root3 = 1.7320508, tiny_nu = 1e-12;
/* Eight digits of the limits are given, spacings are bw_real: 1e-7 of single precision. */
static const double LIMITS = 1e-6;

/* dt_max of fluid at rest in a box of 8 x 8 x 8 cells, 1 x 2 x 4. */
static double limit_at_rest(const bool periodic[3], double stretch, const bw_ns_channel_config *c)
{
  const int n[3] = {8, 8, 8};
  const double length[3] = {1, 2, 4};
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, periodic, stretch, 1), c);
  const double limit = bw_ns_channel_dt_max(ns);
  ns_free(&ns);
  return limit;
}

START_TEST(walls_count_from_rest_on)
{
  bw_ns_channel_config c = ns_config(closed, tiny_nu);
  /* Cells of 1/8, 1/4, 1/2: a wall normal to y passes x and z. */
  c.side[1][1].velocity[0] = -3.0, c.side[1][1].velocity[2] = 2.0;
  bw_check_near(limit_at_rest(closed, 0, &c) * (3.0 * 8 + 2.0 * 2) / root3, 1.0, LIMITS);
  /* The faster of two. */
  c.side[2][0].velocity[0] = 5.0;
  bw_check_near(limit_at_rest(closed, 0, &c) * 5.0 * 8 / root3, 1.0, LIMITS);
  /* Implicit: the wall alone limits it; at rest without walls that move viscosity does. */
  c.viscous = BW_VISCOUS_IMPLICIT;
  bw_check_near(limit_at_rest(closed, 0, &c) * 5.0 * 8 / root3, 1.0, LIMITS);
}
END_TEST

/* A wall that moves along a stretched direction: cells that are thin because another wall is near
 * are not passed at its speed. Fluid at the distance y from that one has at most the share
 * 4 y/(pi dx) of it, so that the rate stays below some 4 U/(pi dx) there. */
START_TEST(thin_cells_in_a_corner_do_not_count_in_full)
{
  bw_ns_channel_config c = ns_config(closed, tiny_nu);
  c.side[0][0].velocity[1] = 1.0;
  const double uniform = limit_at_rest(closed, 0, &c);
  bw_check_near(uniform * 4.0 / root3, 1.0, LIMITS);
  /* At strength 5 the thinnest cell is 1/3000 of a uniform one. */
  const double thin = limit_at_rest(closed, 5, &c);
  ck_assert_double_gt(thin, uniform / 40);
  ck_assert_double_lt(thin, uniform);
}
END_TEST

/* At rest, without anything that moves, viscosity alone: 2.5127 over 4 nu sum 1/dx^2 of the
 * directions whose term is explicit (8, 4, 2 cells per length). */
START_TEST(explicit_directions_count)
{
  static const struct {
    bw_ns_viscous viscous;
    double sum;
  } of[] = {{BW_VISCOUS_EXPLICIT, 64 + 16 + 4}, {BW_VISCOUS_IMPLICIT_Y, 64 + 4}};
  for (int q = 0; q < 2; q++) {
    bw_ns_channel_config c = ns_config(closed, 1.0);
    c.viscous = of[q].viscous;
    /* 2.5127, and 2.47 with an implicit part (bw_ns_channel.h), to 2 per cent. */
    bw_check_near(limit_at_rest(closed, 0, &c) * 4.0 * of[q].sum, 2.49, 0.025);
  }
}
END_TEST

static void swirl(const double x[3], double t, void *context, double u[3])
{
  const double *speed = context;
  (void)x;
  u[0] = 0.0, u[1] = *speed * (1.0 + t), u[2] = 0.0;
}

START_TEST(inflows_count_from_rest_on)
{
  bw_ns_channel_config c = ns_config(closed, tiny_nu);
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = 2.0;
  /* The velocity at rest holds the inflow's after the projection: 2 everywhere inside. */
  ck_assert_double_le(limit_at_rest(closed, 0, &c), root3 / (2.0 * 8) * (1 + 1e-6));
  /* A profile: its peak, more than twice the mean in a duct that is not far from square. */
  c.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 2.0};
  ck_assert_double_lt(limit_at_rest(closed, 0, &c), root3 / (3.5 * 8));
  /* A wall that a function moves along y, cells of 1/4, at the time of the field. */
  double speed = 3.0;
  c = ns_config(closed, tiny_nu);
  c.side[0][1] = (bw_ns_side){
      .kind = BW_SIDE_WALL, .profile = BW_PROFILE_CALLBACK, .function = swirl, .context = &speed};
  bw_check_near(limit_at_rest(closed, 0, &c) * 3.0 * 4 / root3, 1.0, LIMITS);
}
END_TEST

START_TEST(forcing_counts_from_rest_on)
{
  bw_ns_channel_config c = ns_config(channel, tiny_nu);
  c.forcing = BW_FORCING_FLOW_RATE, c.forcing_value = -2.0;
  bw_check_near(limit_at_rest(channel, 0, &c) * 2.0 * 8 / root3, 1.0, LIMITS);
  /* g dt dt/dx = sqrt(3). */
  c.forcing = BW_FORCING_GRADIENT, c.forcing_value = -5.0;
  const double dt = limit_at_rest(channel, 0, &c);
  bw_check_near(5.0 * dt * dt * 8 / root3, 1.0, LIMITS);
}
END_TEST

/* ---- the same whichever way it goes ---- */

/* Which axis and sign stand for x, y, z: the field is turned and mirrored with the box. */
typedef struct {
  int axis[3];
  double sign[3];
} view;

static void seen(const double x[3], double t, void *context, double u[3])
{
  const view *w = context;
  double y[3], v[3];
  for (int d = 0; d < 3; d++)
    y[d] = w->sign[d] > 0 ? x[w->axis[d]] : 1.0 - x[w->axis[d]];
  ns_smooth(y, t, NULL, v);
  for (int d = 0; d < 3; d++)
    u[w->axis[d]] = w->sign[d] * v[d];
}

START_TEST(the_direction_of_the_stream_does_not_show)
{
  static const view views[] = {{{0, 1, 2}, {1, 1, 1}},   {{0, 1, 2}, {-1, 1, 1}},
                               {{0, 1, 2}, {1, -1, 1}},  {{0, 1, 2}, {1, 1, -1}},
                               {{1, 2, 0}, {1, 1, 1}},   {{2, 0, 1}, {1, -1, 1}},
                               {{1, 0, 2}, {-1, -1, 1}}, {{0, 1, 2}, {-1, -1, -1}}};
  const int n[3] = {8, 8, 8};
  const double length[3] = {1, 1, 1};
  const bw_ns_channel_config c = ns_config(closed, 1e-3);
  double first = NAN;
  for (size_t q = 0; q < sizeof views / sizeof *views; q++) {
    view w = views[q];
    bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 1), &c);
    bw_check_ok(bw_ns_channel_set_velocity(ns, seen, &w, 0.0));
    /* A step: the number comes out of the projection. */
    for (int step = 0; step < 2; step++) {
      const double limit = bw_ns_channel_dt_max(ns);
      if (q == 0 && step == 1) first = limit;
      if (step == 1) bw_check_near(limit / first, 1.0, NS_TOLERANCE(1e-12));
      bw_check_ok(bw_ns_channel_step(ns, 1e-3));
    }
    ns_free(&ns);
  }
}
END_TEST

/* ---- short waves in the factored scheme ---- */

typedef struct {
  int n[3];
  double length[3];
} waves;

/* 1 in every second cell, in all directions; free of divergence. */
static void shortest(const double x[3], double t, void *context, double u[3])
{
  const waves *w = context;
  (void)t;
  for (int c = 0; c < 3; c++) {
    double parity = 1e-6;
    for (int d = 0; d < 3; d++) {
      const double cell = x[d] * w->n[d] / w->length[d] - (d == c ? 1.0 : 0.5);
      if (w->n[d] > 1 && lround(cell) % 2 != 0) parity = -parity;
    }
    u[c] = (c == 1 ? -1.0 : c == 2 ? 0.0 : 1.0) * w->length[c] / w->n[c] * parity;
  }
}

START_TEST(short_waves_decay_like_the_longest)
{
  const waves scene[] = {{{16, 8, 1}, {1, 0.6, 1}}, {{8, 8, 8}, {1, 1.5, 0.7}}};
  const double pi = acos(-1.0), nu = 0.3;
  for (int q = 0; q < 2; q++) {
    waves w = scene[q];
    bw_ns_channel_config c = ns_config(all, nu);
    c.viscous = BW_VISCOUS_IMPLICIT;
    bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), w.n, w.length, all, 0, 1), &c);
    bw_check_ok(bw_ns_channel_set_velocity(ns, shortest, &w, 0.0));
    const double dt = bw_ns_channel_dt_max(ns);
    const double before = sqrt(bw_ns_channel_summary(ns).kinetic_energy);
    bw_check_ok(bw_ns_channel_step(ns, dt));
    double rate = 0.0;
    for (int d = 0; d < 3; d++)
      if (w.n[d] > 1) rate += nu * pi * pi / (w.length[d] * w.length[d]);
    const double left = sqrt(bw_ns_channel_summary(ns).kinetic_energy) / before;
    /* The bisection ends at 1e-9 of the step. */
    bw_check_near(log(left) / (-rate * dt), 1.0, 1e-6 + NS_TOLERANCE(1e-12));
    /* Far beyond what is stable without an implicit term. */
    double explicit_rate = 0.0;
    for (int d = 0; d < 3; d++)
      if (w.n[d] > 1) explicit_rate += 4.0 * nu * pow(w.n[d] / w.length[d], 2);
    ck_assert_double_gt(dt * explicit_rate / 2.5127, 10.0);
    bw_check_status(bw_ns_channel_step(ns, 1.01 * dt), BW_ECFL);
    ns_free(&ns);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(walls_count_from_rest_on),
                                      BW_TEST(thin_cells_in_a_corner_do_not_count_in_full),
                                      BW_TEST(explicit_directions_count),
                                      BW_TEST(inflows_count_from_rest_on),
                                      BW_TEST(forcing_counts_from_rest_on),
                                      BW_TEST(the_direction_of_the_stream_does_not_show),
                                      BW_TEST(short_waves_decay_like_the_longest)};
BW_CHECK_MAIN("ns_channel.limit", tests)
