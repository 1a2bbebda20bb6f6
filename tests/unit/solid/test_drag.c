/* A drag towards given velocities: single particles without bonds decay as they should.
 * BUILD modules=solid
 * TEST ranks=1,2,3 */
#include "pd_test.h"

#include <math.h>
#include <string.h>

enum { MANY = 6, AWAY = 20, STEPS = 7 };
static const double DT = 0.01, K = 30.0, FORCE = 0.4;

/* Particles too far apart to be bonded; the last is held. */
static bw_solid *scattered(bw_solid_integrator integrator)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.integrator = integrator;
  pd_body body = pd_box(MANY, 1, 1);
  for (int q = 0; q < MANY; q++)
    body.site[3 * q] *= AWAY;
  body.kind[MANY - 1] = BW_PD_PRESCRIBED;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_body_release(&body);
  return pd;
}

/* Whatever is dragged goes from v to V by exp(-k dt/rho) a step, or, where a force acts beside it,
 * by that and F dt/rho; what the drag gave and did is what the motion shows. */
static void decay(bw_solid_integrator integrator, double k_scale)
{
  bw_solid *pd = scattered(integrator);
  const size_t n = bw_solid_count(pd);
  const double rho = bw_solid_settings(pd)->rho, left = exp(-k_scale * K * DT / rho);
  double X[3 * MANY], V[3 * MANY] = {0}, F[3 * MANY] = {0}, impulse[3 * MANY];
  double k[MANY], towards[3 * MANY] = {0}, expected[3 * MANY];
  int32_t particle[MANY];
  bw_solid_ledger start, end;
  bw_solid_get_position(pd, X);
  for (size_t i = 0; i < n; i++) {
    particle[i] = (int32_t)i;
    k[i] = k_scale * K;
    towards[3 * i] = 0.3, V[3 * i] = 1.0, V[3 * i + 1] = -0.5, F[3 * i + 2] = FORCE;
    if (bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED) memset(V + 3 * i, 0, 3 * sizeof *V);
  }
  bw_solid_set_state(pd, X, V);
  bw_solid_set_force(pd, F);
  bw_check_ok(bw_solid_set_drag(pd, n, particle, k, towards));
  bw_check_ok(bw_solid_account(pd, &start));
  memcpy(expected, V, sizeof V);
  for (int q = 0; q < STEPS; q++) {
    bw_check_ok(bw_solid_step(pd, DT));
    for (size_t i = 0; i < 3 * n; i++)
      expected[i] = towards[i] + left * (expected[i] - towards[i]) + DT * F[i] / rho;
  }
  bw_solid_get_velocity(pd, V);
  double work = bw_solid_get_drag(pd, impulse), by_force = 0.0;
  const double near = 100.0 * BW_REAL_EPSILON;
  for (size_t i = 0; i < n; i++) {
    const bool held = bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED;
    for (size_t c = 3 * i; c < 3 * i + 3; c++) {
      const double first = c % 3 == 0 ? 1.0 : c % 3 == 1 ? -0.5 : 0.0;
      bw_check_near(V[c], held ? 0.0 : expected[c], near);
      const double change = rho * (expected[c] - first) - STEPS * DT * F[c];
      bw_check_near(impulse[c], held ? 0.0 : change, near * rho);
    }
  }
  /* The book: external holds what force and drag did, which is all of the kinetic energy. */
  bw_check_ok(bw_solid_account(pd, &end));
  bw_comm_sum(bw_check_world(), 1, &work);
  by_force = end.external - start.external - work;
  bw_check_near(end.external - start.external, end.kinetic - start.kinetic, near);
  ck_assert_double_lt(work, 0.0);
  ck_assert_double_gt(by_force, 0.0);
  /* Without it the particles go on as they would. */
  bw_check_ok(bw_solid_set_drag(pd, 0, NULL, NULL, NULL));
  bw_check_ok(bw_solid_step(pd, DT));
  bw_solid_get_velocity(pd, F);
  for (size_t i = 0; i < n; i++)
    bw_check_near(F[3 * i], V[3 * i], near);
  bw_solid_destroy(&pd);
}

START_TEST(a_drag_takes_what_it_says)
{
  decay(BW_SOLID_VERLET, 1.0);
  decay(BW_SOLID_RK3, 1.0);
}
END_TEST

/* However strong: no more than the difference. */
START_TEST(a_strong_drag_does_not_overshoot)
{
  decay(BW_SOLID_VERLET, 1e4);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_drag_takes_what_it_says),
                                      BW_TEST(a_strong_drag_does_not_overshoot)};
BW_CHECK_MAIN("solid.drag", tests)
