/* Rigid bodies: contact, walls, surface points, refusals.
 * TEST ranks=1,2,3 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_rigid.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

static bw_rigid_config spaced(double spacing)
{
  bw_rigid_config c = bw_rigid_config_default();
  c.spacing = spacing;
  return c;
}

/* Two balls meet off their line of centres: they turn, and momentum, angular momentum and energy
 * are what they were. */
START_TEST(a_collision_keeps_what_it_must)
{
  const bw_shape balls[] = {
      {.kind = BW_SHAPE_SPHERE, .centre = {0, 0, 0}, .radius = 0.5},
      {.kind = BW_SHAPE_BOX, .lower = {0.8, 0, -0.5}, .upper = {1.8, 1, 0.5}}};
  const bw_rigid_body b[] = {
      {.count = 1, .shape = &balls[0], .density = 1.0, .velocity = {1, 0, 0}},
      {.count = 1, .shape = &balls[1], .density = 2.0}};
  bw_rigid_config c = spaced(0.08);
  c.stiffness = 1000.0;
  bw_rigid *r = NULL;
  bw_check_ok(bw_rigid_create(bw_check_world(), &c, 2, b, &r));
  const double energy = bw_rigid_energy_of(r).kinetic, dt = 0.2 * bw_rigid_dt_max(r);
  double before[6] = {0.0}, most = 0.0, spin = 0.0;
  for (int q = 0; bw_rigid_time(r) < 1.5; q++) {
    double sum[6] = {0.0};
    for (int k = 0; k < 2; k++) {
      const bw_rigid_state s = bw_rigid_state_of(r, k);
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        sum[d] += s.mass * s.velocity[d];
        sum[3 + d] += s.mass * (s.position[e] * s.velocity[f] - s.position[f] * s.velocity[e]);
        for (int a = 0; a < 3; a++) /* balls and cubes: inertia is a number */
          sum[3 + d] += a == d ? s.inertia[0] * s.spin[d] : 0.0;
      }
      spin = fmax(spin, fabs(s.spin[2]));
    }
    const bw_rigid_energy e = bw_rigid_energy_of(r);
    if (q == 0) memcpy(before, sum, sizeof sum);
    for (int d = 0; d < 3; d++)
      bw_check_near(sum[d], before[d], 1e-12);
    for (int d = 3; d < 6; d++) /* the cube's moments are alike to what its points leave */
      bw_check_near(sum[d], before[d], 1e-3);
    most = fmax(most, e.contact);
    bw_check_near((e.kinetic + e.contact) / energy, 1.0, 0.02);
    bw_check_ok(bw_rigid_step(r, dt));
  }
  ck_assert_msg(most > 0.2 * energy, "they did not meet: %g of %g", most, energy);
  ck_assert_msg(spin > 0.05, "the collision was central: %g", spin);
  bw_check_near(bw_rigid_energy_of(r).contact, 0.0, 0.0);
  bw_rigid_destroy(&r);
}
END_TEST

/* A ball at rest on a floor sinks in until k V = m g, V = pi r d^2 the volume below. */
START_TEST(a_wall_bears_the_weight)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {0, 0.5, 0}, .radius = 0.5};
  bw_rigid_config c = spaced(0.02);
  c.stiffness = 400.0;
  c.gravity[1] = -1.0;
  c.walled[1][0] = true;
  const bw_rigid_body b = {
      .count = 1, .shape = &ball, .density = 1.0, .damping = {2, 2, 2, 0, 0, 0}};
  bw_rigid *r = NULL;
  bw_check_ok(bw_rigid_create(bw_check_world(), &c, 1, &b, &r));
  while (bw_rigid_time(r) < 8.0)
    bw_check_ok(bw_rigid_step(r, fmin(bw_rigid_dt_max(r), 0.05)));
  const bw_rigid_state s = bw_rigid_state_of(r, 0);
  /* pressure k depth over the cap: k pi r d^2 to first order in d/r */
  const double d = sqrt(s.mass / (c.stiffness * PI * 0.5));
  bw_check_near(s.position[1], 0.5 - d, 0.1 * d);
  bw_check_near(s.velocity[1], 0.0, 1e-2);
  bw_rigid_destroy(&r);
}
END_TEST

/* Points: the area of the surface, velocities V + W x r, a uniform pressure without force. */
START_TEST(points_follow_the_body)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 0.5};
  const bw_rigid_body b = {.count = 1,
                           .shape = &ball,
                           .density = 1.0,
                           .velocity = {0.1, 0.2, 0.3},
                           .spin = {0.5, -0.4, 0.3}};
  const bw_rigid_config c = spaced(0.05);
  bw_rigid *r = NULL;
  bw_check_ok(bw_rigid_create(bw_check_world(), &c, 1, &b, &r));
  for (int q = 0; q < 20; q++)
    bw_check_ok(bw_rigid_step(r, 0.1));
  const size_t n = bw_rigid_points(r);
  double *X = NULL, *V = NULL, *N = NULL, F[3], T[3], area = 0.0;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&N, 3 * n));
  bw_rigid_surface(r, X, V, N);
  const bw_rigid_state s = bw_rigid_state_of(r, 0);
  for (size_t q = 0; q < n; q++) {
    area += bw_rigid_point_area(r)[q];
    bw_check_near(bw_rigid_distance(r, 0, X + 3 * q), 0.0, 1e-12);
    for (size_t d = 0; d < 3; d++) {
      const size_t e = (d + 1) % 3, f = (d + 2) % 3;
      const double from[3] = {X[3 * q] - s.position[0], X[3 * q + 1] - s.position[1],
                              X[3 * q + 2] - s.position[2]};
      bw_check_near(V[3 * q + d], s.velocity[d] + s.spin[e] * from[f] - s.spin[f] * from[e], 1e-12);
      bw_check_near(N[3 * q + d], from[d] / 0.5, 1e-3);
      N[3 * q + d] *= -bw_rigid_point_area(r)[q] * (1.0 + 2.0 * X[3 * q + 1]);
    }
  }
  bw_comm_sum(bw_check_world(), 1, &area);
  bw_check_near(area, PI, 1e-9);
  /* the pressure 1 + 2 y lifts with twice the volume */
  bw_rigid_sum(r, N, F, T);
  bw_check_near(F[1], -2.0 * PI / 6.0, 2e-3);
  bw_check_near(F[0], 0.0, 1e-3);
  bw_check_near(T[2], 0.0, 1e-3);
  bw_release(&X);
  bw_release(&V);
  bw_release(&N);
  bw_rigid_destroy(&r);
}
END_TEST

START_TEST(bad_input_is_refused)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .radius = 0.5};
  const bw_shape mask = {.kind = BW_SHAPE_MASK};
  const bw_rigid_body good = {.count = 1, .shape = &ball, .density = 1.0};
  const struct {
    const char *word;
    bw_rigid_config config;
    bw_rigid_body body;
  } cases[] = {
      {"spacing", bw_rigid_config_default(), good},
      {"third of its least", spaced(0.5), good},
      {"no shape", spaced(0.1), {.density = 1.0}},
      {"mass", spaced(0.1), {.count = 1, .shape = &ball}},
      {"inertia", spaced(0.1), {.count = 1, .shape = &ball, .mass = 1.0}},
      {"two free turns",
       spaced(0.1),
       {.count = 1, .shape = &ball, .density = 1, .held = {0, 0, 0, 1, 0, 0}}},
      {"alike",
       spaced(0.1),
       {.count = 1, .shape = &ball, .density = 1, .stiffness = {0, 0, 0, 1, 0, 0}}},
      {"negative",
       spaced(0.1),
       {.count = 1, .shape = &ball, .density = 1, .damping = {-1, 0, 0, 0, 0, 0}}},
      {"", spaced(0.1), {.count = 1, .shape = &mask, .density = 1.0}},
  };
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_rigid *r = NULL;
    bw_check_status(bw_rigid_create(bw_check_world(), &cases[q].config, 1, &cases[q].body, &r),
                    BW_EINPUT);
    ck_assert_msg(strstr(bw_last_message(), cases[q].word) != NULL, "%s: %s", cases[q].word,
                  bw_last_message());
    ck_assert_ptr_null(r);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_collision_keeps_what_it_must), BW_TEST(a_wall_bears_the_weight),
    BW_TEST(points_follow_the_body), BW_TEST(bad_input_is_refused)};
BW_CHECK_MAIN("rigid.contact", tests)
