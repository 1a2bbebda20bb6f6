/* Loads: ramps, prescribed motion along them, sums of forces, starts.
 * BUILD modules=solid_tools
 * TEST ranks=1,2,3 */
#include "bw_solid_load.h"
#include "pd_test.h"

#include <string.h>

START_TEST(ramps_start_and_end)
{
  const bw_solid_ramp linear = {BW_SOLID_RAMP_LINEAR, 2, 4}, smooth = {BW_SOLID_RAMP_SMOOTH, 2, 4};
  const bw_solid_ramp step = {BW_SOLID_RAMP_LINEAR, 2, 0};
  ck_assert_double_eq(bw_solid_ramp_value(&linear, 1.9), 0);
  ck_assert_double_eq(bw_solid_ramp_value(&linear, 3), 0.25);
  ck_assert_double_eq(bw_solid_ramp_value(&linear, 6), 1);
  ck_assert_double_eq(bw_solid_ramp_value(&smooth, 3), 0.0625 * 2.5);
  ck_assert_double_eq(bw_solid_ramp_value(&smooth, 4), 0.5);
  ck_assert_double_eq(bw_solid_ramp_value(&smooth, 7), 1);
  ck_assert_double_eq(bw_solid_ramp_value(&step, 1.999), 0);
  ck_assert_double_eq(bw_solid_ramp_value(&step, 2), 1);
}
END_TEST

static bw_solid *bar(bw_solid_integrator integrator)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS);
  c.integrator = integrator;
  pd_body box = pd_box(12, 4, 1);
  for (int64_t q = 0; q < box.n; q++)
    if (box.site[3 * q] >= 9) box.kind[q] = BW_PD_PRESCRIBED;
  bw_solid *pd = pd_make(bw_check_world(), &c, &box);
  pd_body_release(&box);
  return pd;
}

/* Steps of uneven length: the displacement is the ramp's, its speed the product's. */
static void follow(bw_solid_integrator integrator)
{
  bw_solid *pd = bar(integrator);
  const size_t n = bw_solid_count(pd);
  const double dt = 0.4 * bw_solid_dt_max(pd);
  const bw_solid_ramp ramp = {BW_SOLID_RAMP_SMOOTH, 2.3 * dt, 10 * dt};
  double U[3 * 48] = {0}, X[3 * 48], X0[3 * 48], V[3 * 48], time = 0;
  for (size_t i = 0; i < n; i++)
    U[3 * i] = 0.01, U[3 * i + 1] = -0.02;
  bw_solid_get_reference(pd, X0);
  for (int q = 0; q < 20; q++) {
    const double h = q % 2 ? dt : 0.7 * dt;
    bw_solid_load_displace(pd, &ramp, time, h, U);
    bw_check_ok(bw_solid_step(pd, h));
    time += h;
    bw_solid_get_position(pd, X);
    for (size_t i = 0; i < n; i++) {
      if (!(bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED)) continue;
      const double value = bw_solid_ramp_value(&ramp, time);
      bw_check_near(X[3 * i] - X0[3 * i], 0.01 * value, 20 * BW_REAL_EPSILON);
      bw_check_near(X[3 * i + 1] - X0[3 * i + 1], -0.02 * value, 20 * BW_REAL_EPSILON);
    }
  }
  bw_solid_load_move(pd, &ramp, 7.3 * dt - 0.5 * dt, dt, U); /* its middle: value 1/2 */
  bw_check_ok(bw_solid_step(pd, dt));
  bw_solid_get_velocity(pd, V);
  for (size_t i = 0; i < n; i++)
    if (bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED)
      bw_check_near(V[3 * i], 0.005, 20 * BW_REAL_EPSILON);
  bw_solid_destroy(&pd);
}

START_TEST(prescribed_particles_follow_the_ramp)
{
  follow(BW_SOLID_VERLET);
  follow(BW_SOLID_RK3);
}
END_TEST

/* Traction times area, and weight: F summed over volumes. Prescribed particles take none. */
START_TEST(forces_add_up)
{
  bw_solid *pd = bar(BW_SOLID_VERLET);
  double F[3 * 48] = {0}, total[3] = {0};
  const double dv = bw_solid_volume(pd), traction[3] = {3, -4, 0}, g[3] = {0, -10, 0};
  bw_check_ok(bw_solid_load_traction(pd, (double[3]){0, 0, 5}, (double[3]){1.2, 9, 6}, 2, traction,
                                     F)); /* z of the box ignored; two columns of four */
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    for (size_t k = 0; k < 3; k++)
      total[k] += F[3 * i + k] * dv;
  bw_comm_sum(bw_check_world(), 3, total);
  bw_check_near(total[0], 6, 1e-12);
  bw_check_near(total[1], -8, 1e-12);
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    const bool loaded = bw_solid_id(pd)[i] % 12 < 2;
    ck_assert(loaded == (F[3 * i] != 0));
  }
  memset(F, 0, sizeof F);
  bw_solid_load_gravity(pd, g, F);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    bw_check_near(F[3 * i + 1], -20, 1e-12); /* rho = 2 */
  bw_check_ok(
      bw_solid_load_traction(pd, (double[3]){0, 0, 0}, (double[3]){9, 9, 0}, 2, traction, F));
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    if (bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED) ck_assert_double_eq(F[3 * i], 0);
  bw_solid_destroy(&pd);
}
END_TEST

static void swirl(const double X0[3], double V[3], const void *data)
{
  const double *factor = data;
  V[0] = *factor * X0[1], V[1] = -X0[0], V[2] = 0;
}

/* A box of 12 x 4 cells, mass m, sides a and b: momentum m v, angular momentum about its centre
 * m (a^2 + b^2)/12 w less the cells' own (they are points) m ds^2/6 w. */
START_TEST(launches)
{
  bw_solid *pd = bar(BW_SOLID_VERLET);
  const double m = 48 * 2 * bw_solid_volume(pd), centre[3] = {3, 1, 0};
  bw_check_ok(bw_solid_load_launch(pd, (double[3]){0, 0, 0}, (double[3]){0, 0, 1.5}, centre));
  bw_solid_ledger l = ledger_of(pd);
  bw_check_near(l.angular[2], 1.5 * m * ((36 + 4) / 12.0 - 0.25 / 6), 50 * BW_REAL_EPSILON);
  bw_check_near(l.momentum[0], 0, 50 * BW_REAL_EPSILON);
  bw_check_ok(bw_solid_load_launch(pd, (double[3]){2, -1, 0}, (double[3]){0, 0, 0}, centre));
  l = ledger_of(pd);
  bw_check_near(l.momentum[0], 2 * m, 50 * BW_REAL_EPSILON);
  bw_check_near(l.momentum[1], -m, 50 * BW_REAL_EPSILON);
  const double factor = 4;
  bw_check_ok(bw_solid_load_velocity(pd, swirl, &factor));
  l = ledger_of(pd);
  bw_check_near(l.momentum[0], 4 * m * 1, 50 * BW_REAL_EPSILON); /* mean of y is 1, of x 3 */
  bw_check_near(l.momentum[1], -3 * m, 50 * BW_REAL_EPSILON);
  bw_solid_destroy(&pd);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(ramps_start_and_end),
                                      BW_TEST(prescribed_particles_follow_the_ramp),
                                      BW_TEST(forces_add_up), BW_TEST(launches)};
BW_CHECK_MAIN("pd_bond.load", tests)
