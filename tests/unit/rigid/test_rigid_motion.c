/* Rigid bodies: mass of shapes, the asymmetric top, springs, what is held, restart.
 * TEST ranks=1,2,3 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_rigid.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

static bw_rigid *make(const bw_rigid_config *c, int n, const bw_rigid_body *b)
{
  bw_rigid *r = NULL;
  bw_check_ok(bw_rigid_create(bw_check_world(), c, n, b, &r));
  return r;
}

static bw_rigid_config spaced(double spacing)
{
  bw_rigid_config c = bw_rigid_config_default();
  c.spacing = spacing;
  return c;
}

/* A ball, a box that leans, a planar ring: closed forms, to second order in 1/150. */
START_TEST(mass_is_that_of_the_shapes)
{
  const bw_shape_frame leaning = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}},
                                  {0.1, 0.2, 0.3}};
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 0.5};
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {1, 2, 3}, .frame = &leaning};
  const bw_rigid_body bodies[] = {{.count = 1, .shape = &ball, .density = 2.0},
                                  {.count = 1, .shape = &box, .density = 0.5}};
  const bw_rigid_config c = spaced(0.1);
  bw_rigid *r = make(&c, 2, bodies);
  bw_rigid_state s = bw_rigid_state_of(r, 0);
  const double mass = 2.0 * PI / 6.0;
  bw_check_near(s.mass / mass, 1.0, 1e-3);
  for (int d = 0; d < 3; d++) {
    bw_check_near(s.inertia[d] / (0.1 * mass), 1.0, 2e-3);
    bw_check_near(s.position[d], 1.0 + d, 1e-4);
  }
  s = bw_rigid_state_of(r, 1);
  bw_check_near(s.mass, 3.0, 3e-3);
  double sum = 0.0, square = 0.0;
  for (int d = 0; d < 3; d++)
    sum += s.inertia[d], square += s.inertia[d] * s.inertia[d];
  /* moments m (b^2 + c^2)/12: 13, 10, 5 quarters */
  bw_check_near(sum, 28.0 / 4.0, 1e-2);
  bw_check_near(square, (169.0 + 100.0 + 25.0) / 16.0, 3e-2);
  bw_rigid_destroy(&r);

  const bw_shape ring[] = {{.kind = BW_SHAPE_CYLINDER, .radius = 1.0, .axis = 2},
                           {.kind = BW_SHAPE_CYLINDER, .radius = 0.5, .axis = 2, .remove = true}};
  bw_rigid_config planar = spaced(0.1);
  planar.planar = true, planar.depth = 0.1;
  r = make(&planar, 1, &(bw_rigid_body){.count = 2, .shape = ring, .density = 4.0});
  s = bw_rigid_state_of(r, 0);
  bw_check_near(s.mass, 4.0 * 0.1 * PI * 0.75, 1e-3);
  bw_check_near(s.inertia[2], 0.5 * s.mass * 1.25, 1e-3);
  bw_rigid_destroy(&r);
}
END_TEST

/* Largest error of the energy over the same time, with a step of dt. Angular momentum is exact. */
static double top_error(double dt, double seconds)
{
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {1, 2, 3}};
  const bw_rigid_body b = {.count = 1,
                           .shape = &box,
                           .mass = 1.0,
                           .inertia = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}},
                           .spin = {0.02, 1.0, 0.03}, /* about the middle axis: it tumbles */
                           .velocity = {1.0, -2.0, 0.5}};
  const bw_rigid_config c = spaced(0.25);
  bw_rigid *r = make(&c, 1, &b);
  const double before = bw_rigid_energy_of(r).kinetic;
  const double L[3] = {0.02, 2.0, 0.09};
  double error = 0.0, least = 1.0;
  for (int q = 0; q < (int)lround(seconds / dt); q++) {
    bw_check_ok(bw_rigid_step(r, dt));
    error = fmax(error, fabs(bw_rigid_energy_of(r).kinetic - before));
    const bw_rigid_state s = bw_rigid_state_of(r, 0);
    least = fmin(least, s.turn[1][1]);
    for (int d = 0; d < 3; d++) { /* Q I Q^T W */
      double now = 0.0;
      for (int a = 0; a < 3; a++)
        for (int e = 0; e < 3; e++)
          now += s.turn[d][a] * (1.0 + a) * s.turn[e][a] * s.spin[e];
      bw_check_near(now, L[d], 1e-11);
      bw_check_near(s.velocity[d], b.velocity[d], 0.0);
      bw_check_near(s.position[d], b.velocity[d] * bw_rigid_time(r), 1e-9);
    }
  }
  ck_assert_msg(least < -0.9, "the top did not tumble: %g", least);
  bw_rigid_destroy(&r);
  return error;
}

START_TEST(the_asymmetric_top_keeps_momentum_and_energy)
{
  const double coarse = top_error(0.1, 60.0), fine = top_error(0.05, 60.0);
  const double longer = top_error(0.1, 240.0);
  ck_assert_msg(coarse < 2e-3, "energy off by %g", coarse);
  const double order = log2(coarse / fine);
  ck_assert_msg(fabs(order - 2.0) < 0.1, "order %g", order);
  ck_assert_msg(longer < 1.1 * coarse, "energy drifts: %g after %g", longer, coarse);
}
END_TEST

/* The turn itself: a symmetric top precesses about L at |L|/I_1, to second order. */
START_TEST(the_symmetric_top_precesses)
{
  double error[2];
  for (int q = 0; q < 2; q++) {
    const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .radius = 1.0};
    const bw_rigid_body b = {.count = 1,
                             .shape = &ball,
                             .mass = 1.0,
                             .inertia = {{2, 0, 0}, {0, 2, 0}, {0, 0, 3}},
                             .spin = {0.4, 0.0, 1.0}};
    const bw_rigid_config c = spaced(0.25);
    const double L[3] = {0.8, 0.0, 3.0}, size = sqrt(0.64 + 9.0);
    const double period = 2.0 * PI * 2.0 / size;
    const int steps = q == 0 ? 40 : 80;
    bw_rigid *r = make(&c, 1, &b);
    for (int k = 0; k < steps; k++) {
      bw_check_ok(bw_rigid_step(r, period / steps));
      /* At first the axis moves as W x e_z has it. */
      if (k == 0) bw_check_near(bw_rigid_state_of(r, 0).turn[1][2], -0.4 * period / steps, 1e-2);
    }
    /* After one period of precession the axis is where it was. */
    const bw_rigid_state s = bw_rigid_state_of(r, 0);
    error[q] = hypot(s.turn[0][2], s.turn[1][2]);
    double along = 0.0;
    for (int d = 0; d < 3; d++)
      along += s.turn[d][2] * L[d] / size;
    bw_check_near(along, 3.0 / size, 1e-2);
    bw_rigid_destroy(&r);
  }
  ck_assert_msg(error[0] < 2e-2 && fabs(log2(error[0] / error[1]) - 2.0) < 0.2, "%g, %g", error[0],
                error[1]);
}
END_TEST

/* Springs swing with sqrt(k/m) and sqrt(kappa/I); the rest is held. */
START_TEST(springs_have_their_frequency)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {3, 0, 0}, .radius = 1.0};
  const bw_rigid_body b = {.count = 1,
                           .shape = &ball,
                           .mass = 2.0,
                           .centre = {3, 0, 0},
                           .inertia = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}},
                           .velocity = {1.0, 0.0, 0.25},
                           .spin = {0, 0, 0.3},
                           .held = {false, true, true, true, true, false},
                           .stiffness = {8.0, 0, 0, 0, 0, 8.0}};
  const bw_rigid_config c = spaced(0.25);
  bw_rigid *r = make(&c, 1, &b);
  const double period = 2.0 * PI / 2.0; /* of the centre; of the turn half of it */
  const int steps = 400;
  bw_rigid_state s;
  for (int q = 1; q <= steps / 4; q++)
    bw_check_ok(bw_rigid_step(r, period / steps));
  s = bw_rigid_state_of(r, 0);
  bw_check_near(s.position[0], 3.5, 1e-4); /* V/w after a quarter */
  bw_check_near(s.velocity[0], 0.0, 1e-3);
  bw_check_near(s.turn[1][0], 0.0, 1e-3); /* half a swing of the turn */
  bw_check_near(s.spin[2], -0.3, 1e-4);
  bw_check_near(s.position[2], 0.25 * period / 4.0, 1e-12); /* held: as it was told */
  bw_check_near(s.position[1], 0.0, 0.0);
  for (int q = 1; q <= 3 * steps / 4; q++)
    bw_check_ok(bw_rigid_step(r, period / steps));
  s = bw_rigid_state_of(r, 0);
  bw_check_near(s.position[0], 3.0, 1e-3);
  bw_check_near(s.velocity[0], 1.0, 1e-4);
  bw_check_status(bw_rigid_step(r, 1.01 * bw_rigid_dt_max(r)), BW_ECFL);
  bw_rigid_destroy(&r);
}
END_TEST

/* A free body on alike torsion springs, loaded: energy is kept to second order; saved and restored
 * it goes on to the last bit. */
START_TEST(restored_bodies_go_on)
{
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {1, 2, 3}};
  const bw_rigid_body b = {.count = 1,
                           .shape = &box,
                           .density = 0.2,
                           .spin = {0.2, 0.5, -0.3},
                           .stiffness = {1, 1, 1, 2, 2, 2}};
  bw_rigid_config c = spaced(0.25);
  c.gravity[1] = -0.3;
  const double dt = 0.02;
  double energy[2], row[BW_RIGID_ROW];
  bw_rigid *r = make(&c, 1, &b), *other = make(&c, 1, &b);
  for (int q = 0; q < 200; q++) {
    const bw_rigid_energy e = bw_rigid_energy_of(r);
    energy[q > 0] = e.kinetic + e.weight + e.spring;
    bw_check_near(energy[q > 0], energy[0], 2e-4);
    bw_check_ok(bw_rigid_step(r, dt));
  }
  bw_rigid_save(r, row);
  bw_rigid_restore(other, bw_rigid_time(r), row);
  for (int q = 0; q < 50; q++) {
    bw_check_ok(bw_rigid_step(r, dt));
    bw_check_ok(bw_rigid_step(other, dt));
  }
  const bw_rigid_state s = bw_rigid_state_of(r, 0), t = bw_rigid_state_of(other, 0);
  ck_assert_int_eq(memcmp(&s, &t, sizeof s), 0);
  bw_check_near(bw_rigid_time(other), 250 * dt, 1e-12);
  bw_rigid_destroy(&other);
  bw_rigid_destroy(&r);
}
END_TEST

/* Damping alone: V = V_0 exp(-c t/m), second order. */
START_TEST(damping_decays)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .radius = 1.0};
  const bw_rigid_body b = {.count = 1,
                           .shape = &ball,
                           .mass = 2.0,
                           .inertia = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           .velocity = {1, 0, 0},
                           .spin = {0, 0, 1},
                           .held = {false, true, true, true, true, false},
                           .damping = {1.0, 0, 0, 0, 0, 0.5}};
  const bw_rigid_config c = spaced(0.25);
  bw_rigid *r = make(&c, 1, &b);
  for (int q = 0; q < 100; q++)
    bw_check_ok(bw_rigid_step(r, 0.02));
  const bw_rigid_state s = bw_rigid_state_of(r, 0);
  bw_check_near(s.velocity[0], exp(-1.0), 1e-4);
  bw_check_near(s.spin[2], exp(-1.0), 1e-4);
  bw_rigid_destroy(&r);
}
END_TEST

/* What a body was made from is copied, and let go with it. */
START_TEST(nothing_is_left_behind)
{
  const bw_shape balls[] = {{.kind = BW_SHAPE_SPHERE, .radius = 1.0},
                            {.kind = BW_SHAPE_SPHERE, .centre = {0.5, 0, 0}, .radius = 1.0}};
  const bw_rigid_body b = {.count = 2, .shape = balls, .density = 2.0};
  const bw_rigid_config c = spaced(0.25);
  size_t before = 0;
  if (bw_comm_size(bw_check_world()) > 1) return; /* messages keep memory of their own */
  /* The first ones pay for what libraries set up and keep. */
  for (int q = 0; q < 8; q++) {
    bw_rigid *r = make(&c, 1, &b);
    bw_rigid_destroy(&r);
    ck_assert(q < 6 || bw_memory_in_use() == before);
    before = bw_memory_in_use();
  }
}
END_TEST

/* What an impulse would do is what a load does in a short step: to a leaning box that is free, to
 * one that turns about y alone and is held along x, to one that is told how to move. */
START_TEST(an_answer_is_that_of_a_step)
{
  const bw_shape_frame leaning = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}},
                                  {0.1, 0.2, 0.3}};
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {1, 2, 3}, .frame = &leaning};
  const bool held[3][6] = {
      {false}, {true, false, false, true, false, true}, {true, true, true, true, true, true}};
  const double load[6] = {1.0, -2.0, 3.0, 0.5, 1.5, -0.7}, dt = 1e-6;
  const bw_rigid_config c = spaced(0.3);
  for (int q = 0; q < 3; q++) {
    bw_rigid_body body = {.count = 1, .shape = &box, .density = 0.5};
    double impulse[6], change[6], moved = 0.0;
    memcpy(body.held, held[q], sizeof body.held);
    bw_rigid *r = make(&c, 1, &body);
    for (int e = 0; e < 6; e++)
      impulse[e] = dt * load[e];
    bw_rigid_answer(r, 0, impulse, change);
    bw_rigid_load(r, load, load + 3);
    bw_check_ok(bw_rigid_step(r, dt));
    const bw_rigid_state s = bw_rigid_state_of(r, 0);
    for (int e = 0; e < 6; e++) {
      bw_check_near(change[e], e < 3 ? s.velocity[e] : s.spin[e - 3], 1e-5 * dt);
      ck_assert(!held[q][e] || change[e] == 0.0);
      moved += fabs(change[e]);
    }
    ck_assert(q == 2 ? moved == 0.0 : moved > dt);
    bw_rigid_destroy(&r);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(an_answer_is_that_of_a_step),
                                      BW_TEST(mass_is_that_of_the_shapes),
                                      BW_TEST(the_asymmetric_top_keeps_momentum_and_energy),
                                      BW_TEST(the_symmetric_top_precesses),
                                      BW_TEST(springs_have_their_frequency),
                                      BW_TEST(restored_bodies_go_on),
                                      BW_TEST(damping_decays),
                                      BW_TEST(nothing_is_left_behind)};
BW_CHECK_MAIN("rigid.motion", tests)
