/* Friction of rigid bodies against mechanics on a slope: a block that slides to rest, one that
 * stays or slides by the angle, a disc that rolls, two that rub; the book, ranks, restart.
 * TEST ranks=1,2,3 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_rigid.h"

#include <string.h>

/* Planar, on a floor at y = 0, in a field of 1 that leans by the angle [rad] along x. */
static bw_rigid *on_slope(const bw_shape *shape, double angle, double mu, double speed)
{
  const bw_rigid_body body = {.count = 1, .shape = shape, .density = 2.0, .velocity = {speed}};
  bw_rigid_config c = bw_rigid_config_default();
  bw_rigid *r = NULL;
  c.planar = true, c.spacing = 0.02;
  c.stiffness = 1e6, c.friction = mu, c.safety = 0.1;
  c.gravity[0] = sin(angle), c.gravity[1] = -cos(angle);
  c.walled[1][0] = true, c.upper[1] = 1.0;
  bw_check_ok(bw_rigid_create(bw_check_world(), &c, 1, &body, &r));
  return r;
}

static void go(bw_rigid *r, double time)
{
  const double dt = time / ceil(time / bw_rigid_dt_max(r));
  for (double t = bw_rigid_time(r); t < time - 0.5 * dt; t = bw_rigid_time(r))
    bw_check_ok(bw_rigid_step(r, dt));
}

/* A flat block, which does not tip. Weight over stiffness is 4e-7, the time in which contact
 * turns it by a radian 3e-4: it creeps at some mu 1.3e-3, twice that at nine tenths of what
 * friction bears, and twice that again as it bounces on the floor that it was put on. */
static const bw_shape BLOCK = {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {0.8, 0.2, 0}};

/* It comes to rest after v/(mu g), v^2/(2 mu g) further. All its energy is in the book. */
START_TEST(a_block_slides_to_rest)
{
  bw_rigid *r = on_slope(&BLOCK, 0.0, 0.4, 1.0);
  const bw_rigid_energy start = bw_rigid_energy_of(r);
  const double x = bw_rigid_state_of(r, 0).position[0];
  go(r, 4.0);
  const bw_rigid_state b = bw_rigid_state_of(r, 0);
  const bw_rigid_energy end = bw_rigid_energy_of(r);
  bw_check_near(b.position[0] - x, 1.0 / (2 * 0.4), 0.01 / (2 * 0.4));
  bw_check_near(b.velocity[0], 0.0, 1e-3);
  bw_check_near(end.rubbed / start.kinetic, 1.0, 0.01);
  bw_check_near(end.kinetic + end.weight + end.contact + end.rubbed - start.kinetic - start.weight -
                    start.contact,
                0.0, 2e-3 * start.kinetic);
  bw_rigid_destroy(&r);
}
END_TEST

/* tan(angle) of 0.9 and 1.1 mu: it stays, or it slides with g (sin - mu cos). */
START_TEST(a_slope)
{
  const double mu = 0.4;
  for (int above = 0; above < 2; above++) {
    const double angle = atan((above ? 1.1 : 0.9) * mu), time = 2.0;
    bw_rigid *r = on_slope(&BLOCK, angle, mu, 0.0);
    const double x = bw_rigid_state_of(r, 0).position[0];
    go(r, time);
    const double way = bw_rigid_state_of(r, 0).position[0] - x;
    const double right = 0.5 * (sin(angle) - mu * cos(angle)) * time * time;
    if (above)
      bw_check_near(way, right, 0.1 * right);
    else
      bw_check_near(way, 0.0, 4.0 * mu * 1.3e-3 * time);
    bw_rigid_destroy(&r);
  }
}
END_TEST

/* A disc rolls with 2/3 g sin(angle), and turns as it rolls, where mu > tan(angle)/3; below it
 * slides, with g (sin - mu cos). On the one point of 0.02 that touches it sinks by 2.7e-5; with
 * T of 5.5e-4 it creeps by 5.2e-3 where friction bears a quarter of what it could. */
START_TEST(a_disc_rolls)
{
  const bw_shape disc = {
      .kind = BW_SHAPE_CYLINDER, .centre = {0, 0.3, 0}, .radius = 0.3, .axis = 2};
  for (int rolls = 0; rolls < 2; rolls++) {
    const double angle = 0.3, mu = rolls ? 0.4 : 0.05, time = 1.0;
    bw_rigid *r = on_slope(&disc, angle, mu, 0.0);
    go(r, time);
    const bw_rigid_state b = bw_rigid_state_of(r, 0);
    const double right = (rolls ? 2.0 / 3.0 * sin(angle) : sin(angle) - mu * cos(angle)) * time;
    bw_check_near(b.velocity[0], right, 0.03 * right);
    if (rolls) bw_check_near(b.spin[2] * 0.3 + b.velocity[0], 0.0, 2.0 * 5.2e-3);
    bw_rigid_destroy(&r);
  }
}
END_TEST

/* Two blocks in space meet off their line and rub: momentum and angular momentum of both stay. */
START_TEST(momentum_stays)
{
  const bw_shape a = {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {0.4, 0.4, 0.4}};
  const bw_shape b = {.kind = BW_SHAPE_BOX, .lower = {0.45, 0.2, 0.1}, .upper = {0.85, 0.6, 0.5}};
  const bw_rigid_body body[2] = {
      {.count = 1, .shape = &a, .density = 1.0, .velocity = {1, 0.4, -0.2}},
      {.count = 1, .shape = &b, .density = 3.0}};
  bw_rigid_config c = bw_rigid_config_default();
  bw_rigid *r = NULL;
  double P[2][3] = {{0}}, L[2][3] = {{0}}, row[2 * BW_RIGID_ROW];
  c.spacing = 0.05, c.stiffness = 2e3, c.friction = 0.5;
  bw_check_ok(bw_rigid_create(bw_check_world(), &c, 2, body, &r));
  for (int end = 0; end < 2; end++) {
    if (end == 1) go(r, 0.3);
    bw_rigid_save(r, row); /* rows 15 .. 17: L of a body about its centre */
    for (int q = 0; q < 2; q++) {
      const bw_rigid_state s = bw_rigid_state_of(r, q);
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        P[end][d] += s.mass * s.velocity[d];
        L[end][d] += row[BW_RIGID_ROW * q + 15 + d] +
                     s.mass * (s.position[e] * s.velocity[f] - s.position[f] * s.velocity[e]);
      }
    }
  }
  ck_assert_double_gt(bw_rigid_energy_of(r).rubbed, 1e-4);
  for (int d = 0; d < 3; d++) {
    bw_check_near(P[1][d], P[0][d], 1e-13);
    bw_check_near(L[1][d], L[0][d], 1e-13);
  }
  bw_rigid_destroy(&r);
}
END_TEST

/* From what was saved the motion and the book go on to the last bit. */
START_TEST(restart)
{
  double row[BW_RIGID_ROW];
  bw_rigid *r = on_slope(&BLOCK, 0.2, 0.4, 1.0), *s = on_slope(&BLOCK, 0.2, 0.4, 1.0);
  const double dt = bw_rigid_dt_max(r);
  for (int q = 0; q < 200; q++) {
    if (q == 100) {
      bw_rigid_save(r, row);
      bw_rigid_restore(s, bw_rigid_time(r), row);
      bw_rigid_set_rubbed(s, bw_rigid_energy_of(r).rubbed);
    }
    bw_check_ok(bw_rigid_step(r, dt));
    if (q >= 100) bw_check_ok(bw_rigid_step(s, dt));
  }
  const bw_rigid_state a = bw_rigid_state_of(r, 0), b = bw_rigid_state_of(s, 0);
  for (int d = 0; d < 3; d++) {
    bw_check_near(b.position[d], a.position[d], 0.0);
    bw_check_near(b.velocity[d], a.velocity[d], 0.0);
    bw_check_near(b.spin[d], a.spin[d], 0.0);
  }
  bw_check_near(bw_rigid_energy_of(s).rubbed, bw_rigid_energy_of(r).rubbed, 0.0);
  bw_rigid_destroy(&r);
  bw_rigid_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_block_slides_to_rest), BW_TEST(a_slope),
                                      BW_TEST(a_disc_rolls), BW_TEST(momentum_stays),
                                      BW_TEST(restart)};
BW_CHECK_MAIN("rigid.friction", tests)
