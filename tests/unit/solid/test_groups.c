/* Several materials in one body: blocks where they meet, books, loads, states at rest.
 * BUILD modules=solid_tools
 * TEST ranks=1,2,3 */
#include "bw_solid_load.h"
#include "bw_solid_static.h"
#include "groups.h"

#include <string.h>

static void shake(const double X0[3], double v[3])
{
  v[0] = 0.1 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.1 * cos(3 * X0[1]) + 0.05 * X0[0];
  v[2] = 0.1 * sin(X0[2] * X0[0]);
}

static void shake_plane(const double X0[3], double v[3])
{
  shake(X0, v);
  v[2] = 0;
}

/* Corrections, clouds, integrators, dampings, planes: what a mixed block has to do as the
 * others. */
enum { WAYS = 9 };
static bw_solid_config way(int q)
{
  static const bw_pd_geometry geometry[] = {BW_PD_3D, BW_PD_PLANE_STRESS, BW_PD_PLANE_STRAIN};
  bw_solid_config c = pd_soft(geometry[q % 3]);
  static const bw_pd_surface_correction surface[WAYS] = {
      BW_PD_SURFACE_NONE,   BW_PD_SURFACE_VOLUME, BW_PD_SURFACE_ENERGY,
      BW_PD_SURFACE_TENSOR, BW_PD_SURFACE_TENSOR, BW_PD_SURFACE_VOLUME,
      BW_PD_SURFACE_ENERGY, BW_PD_SURFACE_NONE,   BW_PD_SURFACE_VOLUME};
  c.surface_correction = surface[q];
  c.disorder = q >= 6 ? 0.3 : 0;
  c.integrator = q % 4 == 1 ? BW_SOLID_RK3 : BW_SOLID_VERLET;
  c.damping.pair = q % 2 == 0 ? 0.02 : 0;
  c.damping.mean = q == 4 || q == 7 ? 0.02 : 0;
  c.damping.absolute = q == 8 ? 0.02 : 0;
  c.contact = q == 0 || q == 5 || q == 6;
  c.calibration = q == 3 ? BW_PD_CALIBRATION_LATTICE : BW_PD_CALIBRATION_NONE;
  c.G0 = 1e-3;
  return c;
}

/* Same material twice: numbers are the same, the order of products is not; 13 digits over 60 steps
 * of a body that breaks (1e-13 is 500 roundings of numbers near 1). */
static void check_same(int q)
{
  const bw_solid_config one = way(q), two = with_second(one, one.rho, one.E, one.G0);
  const bool planar = one.geometry != BW_PD_3D;
  pd_body body = pd_box(10, 7, planar ? 1 : 5);
  bw_solid *a = pd_make(bw_check_world(), &one, &body);
  bw_solid *b = make(bw_check_world(), &two, &body, by_parity);
  bw_check_near(bw_solid_dt_max(a), bw_solid_dt_max(b), 1e-13);
  ck_assert_double_eq(bw_solid_dt_contact(a), bw_solid_dt_contact(b));
  const double dt = 0.3 * fmin(bw_solid_dt_max(a), bw_solid_dt_contact(a));
  bw_solid *both[] = {a, b};
  for (int s = 0; s < 2; s++) {
    pd_set(both[s], NULL, planar ? shake_plane : shake);
    pd_steps(both[s], 120, dt);
  }
  const bw_solid_ledger x = ledger_of(a), y = ledger_of(b);
  ck_assert_int_gt(x.broken, 0);
  ck_assert_int_eq(x.broken, y.broken);
  bw_check_near(y.kinetic, x.kinetic, 1e-13 + 100 * BW_REAL_EPSILON);
  bw_check_near(y.elastic, x.elastic, 1e-13 + 100 * BW_REAL_EPSILON);
  bw_check_near(y.contact, x.contact, 1e-13 + 100 * BW_REAL_EPSILON);
  bw_check_near(y.damping, x.damping, 1e-13 + 100 * BW_REAL_EPSILON);
  bw_check_near(y.fracture, x.fracture, 1e-13 + 100 * BW_REAL_EPSILON);
  pd_check_same(a, b, bw_solid_get_position,
                1e-13 + 1e3 * (BW_REAL_EPSILON > 1e-10) * BW_REAL_EPSILON);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&body);
}

START_TEST(two_groups_of_one_material_are_one)
{
  for (int q = 0; q < WAYS; q++)
    check_same(q);
}
END_TEST

static double energy_error(double factor, double momentum[3])
{
  const bw_solid_config c = two_halves(BW_PD_3D);
  pd_body body = bar(false);
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  pd_set(s, NULL, shake);
  const bw_solid_ledger start = ledger_of(s);
  const double dt = factor * bw_solid_dt_max(s), end = 40 * bw_solid_dt_max(s);
  double most = 0;
  for (int q = 0; q < (int)lround(end / dt); q++) {
    pd_steps(s, 1, dt);
    const bw_solid_ledger now = ledger_of(s);
    most = fmax(most, fabs(now.kinetic + now.elastic - start.kinetic) / start.kinetic);
    for (int k = 0; k < 3; k++) {
      bw_check_near(now.momentum[k], start.momentum[k], 1e4 * BW_REAL_EPSILON);
      bw_check_near(now.angular[k], start.angular[k], 1e5 * BW_REAL_EPSILON);
    }
  }
  /* Not what one density would give. */
  double mass = 0;
  for (size_t i = 0; i < bw_solid_count(s); i++)
    mass += bw_solid_density(s, i) * bw_solid_volume(s);
  bw_comm_sum(bw_check_world(), 1, &mass);
  bw_check_near(mass, (2 + 6) * 160 * 0.125, 1e-12);
  memcpy(momentum, start.momentum, 3 * sizeof *momentum);
  bw_solid_destroy(&s);
  pd_body_release(&body);
  return most;
}

/* Energy is kept to the order of Verlet: half the step, a quarter of the error (3.6 to 4.4: what
 * the next order adds at these steps). */
START_TEST(energy_and_momentum_are_kept_across_the_joint)
{
  double p[3];
  const double coarse = energy_error(0.25, p), fine = energy_error(0.125, p);
  if (BW_REAL_EPSILON > 1e-10) return; /* rounding hides the order */
  ck_assert_double_lt(coarse, 0.02);
  ck_assert_double_gt(coarse / fine, 3.6);
  ck_assert_double_lt(coarse / fine, 4.4);
}
END_TEST

START_TEST(motion_does_not_depend_on_ranks)
{
  bw_solid_config c = two_halves(BW_PD_3D);
  c.G0 = c.more.material[0].G0 = 0.004;
  c.more.joint_G0[0][1] = c.more.joint_G0[1][0] = 0.001;
  c.damping.pair = 0.02;
  c.contact = true;
  bw_comm *self = pd_alone();
  pd_body body = bar(false);
  bw_solid *many = make(bw_check_world(), &c, &body, by_half),
           *one = make(self, &c, &body, by_half);
  ck_assert_double_eq(bw_solid_dt_max(many), bw_solid_dt_max(one));
  const double dt = 0.3 * bw_solid_dt_max(one);
  pd_set(many, NULL, shake);
  pd_set(one, NULL, shake);
  pd_steps(many, 50, dt);
  pd_steps(one, 50, dt);
  pd_check_same(many, one, bw_solid_get_position, 1e-12 + 400 * BW_REAL_EPSILON);
  const bw_solid_ledger a = ledger_of(many), b = ledger_of(one);
  ck_assert_int_gt(a.broken, 10);
  ck_assert_int_eq(a.broken, b.broken);
  bw_check_near(a.fracture, b.fracture, 1e-12 + 1e3 * BW_REAL_EPSILON);
  bw_check_near(a.damping, b.damping, 1e-12 + 1e3 * BW_REAL_EPSILON);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

START_TEST(a_restart_goes_on_to_the_same_bits)
{
  bw_solid_config c = two_halves(BW_PD_PLANE_STRAIN);
  c.G0 = c.more.material[0].G0 = 0.004;
  pd_body body = bar(true);
  bw_solid *first = make(bw_check_world(), &c, &body, by_half);
  bw_solid *second = make(bw_check_world(), &c, &body, by_half);
  const double dt = 0.3 * bw_solid_dt_max(first);
  pd_set(first, NULL, shake_plane);
  pd_steps(first, 60, dt);
  pd_restart_from(first, second);
  pd_steps(first, 60, dt);
  pd_steps(second, 60, dt);
  ck_assert_int_gt(ledger_of(first).broken, 0);
  pd_check_same(first, second, bw_solid_get_position, 0);
  pd_check_same(first, second, bw_solid_get_velocity, 0);
  bw_check_near(pd_energy(first), pd_energy(second), 1e3 * BW_REAL_EPSILON); /* sums of ranks */
  bw_solid_destroy(&first);
  bw_solid_destroy(&second);
  pd_body_release(&body);
}
END_TEST

/* Everything falls alike. */
START_TEST(weight_goes_with_density)
{
  const bw_solid_config c = two_halves(BW_PD_3D);
  pd_body body = bar(false);
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  double *F = NULL, *A = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * bw_solid_count(s)));
  bw_check_ok(BW_ALLOCATE(&A, 3 * bw_solid_count(s)));
  bw_solid_load_gravity(s, (double[]){0, 0, -2}, F);
  bw_solid_set_force(s, F);
  pd_steps(s, 10, 0.3 * bw_solid_dt_max(s));
  bw_solid_get_acceleration(s, A);
  for (size_t i = 0; i < bw_solid_count(s); i++)
    bw_check_near(A[3 * i + 2], -2, 1e3 * BW_REAL_EPSILON);
  bw_check_near(pd_energy(s), 0, 1e4 * BW_REAL_EPSILON);
  bw_release(&F);
  bw_release(&A);
  bw_solid_destroy(&s);
  pd_body_release(&body);
}
END_TEST

/* Both solvers, the same strains: small against 1, so that the bar is linear to 1e-5. */
START_TEST(relaxation_and_linear_solve_agree_across_the_joint)
{
  if (BW_REAL_EPSILON > 1e-10) return; /* residuals below rounding */
  bw_solid_config c = two_halves(BW_PD_PLANE_STRESS);
  pd_body body = bar(true);
  for (int64_t q = 0; q < body.n; q++)
    body.kind[q] = body.site[3 * q] < 2 ? BW_PD_PRESCRIBED : BW_PD_FREE;
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  const size_t n = bw_solid_count(s);
  double *F = NULL, *U = NULL, *X = NULL, *X0 = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * n));
  bw_check_ok(BW_ALLOCATE(&U, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_check_ok(bw_solid_load_traction(s, (double[]){7, -9, -9}, (double[]){9, 9, 9}, 2.5,
                                     (double[]){1e-5, 0, 0}, F));
  bw_solid_set_force(s, F);
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = 1e-8;
  bw_check_ok(bw_solid_static_linear(s, &config, U, &report));
  bw_check_ok(bw_solid_static_relax(s, &config, &report));
  bw_solid_get_position(s, X);
  bw_solid_get_reference(s, X0);
  double most = 0, apart = 0;
  for (size_t q = 0; q < 3 * n; q++) {
    most = fmax(most, fabs(U[q]));
    apart = fmax(apart, fabs(X[q] - X0[q] - U[q]));
  }
  bw_comm_max(bw_check_world(), 1, &most);
  bw_comm_max(bw_check_world(), 1, &apart);
  ck_assert_double_gt(most, 1e-6);
  ck_assert_double_lt(apart, 1e-4 * most);
  bw_release(&F);
  bw_release(&U);
  bw_release(&X);
  bw_release(&X0);
  bw_solid_destroy(&s);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(two_groups_of_one_material_are_one),
                                      BW_TEST(energy_and_momentum_are_kept_across_the_joint),
                                      BW_TEST(motion_does_not_depend_on_ranks),
                                      BW_TEST(a_restart_goes_on_to_the_same_bits),
                                      BW_TEST(weight_goes_with_density),
                                      BW_TEST(relaxation_and_linear_solve_agree_across_the_joint)};
BW_CHECK_MAIN("solid_groups", tests)
