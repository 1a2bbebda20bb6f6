/* Forces and motion: two particles in closed form, momenta, orders, damping, prescribed motion.
 * TEST ranks=1,2,3,4 */
#include "pd_test.h"

static const double PI = 3.14159265358979323846;

/* Two particles one spacing apart along x; bonds of all kinds share the constants of pd_soft. */
static bw_solid *pair(bw_solid_config c)
{
  pd_body two = pd_box(2, 1, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &two);
  pd_body_release(&two);
  return pd;
}

static void stretched(const double X0[3], double u[3])
{
  u[0] = X0[0] > 0.5 ? 0.01 : 0; /* the second particle is at 0.75 */
}

/* c0 = 12 E/(pi delta^4), s = 0.02, Gamma = 1: pulls together with c0 s dV/rho. With the volume
 * method alpha = 2 V0/(V + V), V = dV; with the energy method the ratio of 3 E to c0 ds dV/4. */
START_TEST(two_particles_pull_in_closed_form)
{
  const double delta = 1.5, dv = 0.125, c0 = 12 * 3 / (PI * pow(delta, 4));
  const double v0 = 4.0 / 3 * PI * pow(delta, 3);
  const double alpha[] = {1, v0 / dv, 3 * 3 / (0.25 * c0 * dv * 0.5)};
  for (int surface = 0; surface < 3; surface++) {
    bw_solid_config c = pd_soft(BW_PD_3D);
    c.surface_correction = (bw_pd_surface_correction)surface;
    bw_solid *pd = pair(c);
    double A[6], expected = alpha[surface] * c0 * 0.02 * dv / 2;
    pd_set(pd, stretched, NULL);
    const bw_solid_ledger l = ledger_of(pd); /* evaluates the force */
    pd_gather(pd, bw_solid_get_acceleration, A);
    bw_check_near(A[0] / expected, 1, 200 * BW_REAL_EPSILON);
    bw_check_near(A[3] / expected, -1, 200 * BW_REAL_EPSILON);
    ck_assert_double_eq(A[1], 0);
    const double energy = 0.5 * alpha[surface] * c0 * 0.02 * 0.02 * 0.5 * dv * dv;
    bw_check_near(l.elastic / energy, 1, 400 * BW_REAL_EPSILON);
    bw_solid_destroy(&pd);
  }
}
END_TEST

/* dt_max: sum over the family c0 Gamma dV/r0 with one neighbour. The pair itself is a spring with
 * w^2 = 2 c0 dV/(rho r0), for which Verlet's bound 2/w is just dt_max: sharp. */
static double pair_frequency(const bw_solid *pd)
{
  return sqrt(2 * bw_solid_micromodulus(pd) * 0.125 / (2 * 0.5));
}

/* Motion along the bond is a harmonic oscillator. Displacement of particle 0 about its centre
 * after time t, started stretched and at rest: 0.005 (1 - cos w t). */
static double pair_error(bw_solid_integrator integrator, int steps, double time)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.integrator = integrator;
  bw_solid *pd = pair(c);
  double X[6];
  pd_set(pd, stretched, NULL);
  pd_steps(pd, steps, time / steps);
  pd_gather(pd, bw_solid_get_position, X);
  const double exact = 0.25 + 0.005 * (1 - cos(pair_frequency(pd) * time));
  bw_solid_destroy(&pd);
  return fabs(X[0] - exact);
}

START_TEST(integrators_have_their_order)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.surface_correction = BW_PD_SURFACE_NONE;
  bw_solid *pd = pair(c);
  const double w = pair_frequency(pd);
  bw_check_near(bw_solid_dt_max(pd) * w, 2, 1e-12);
  /* Damped along the bond, the difference of the velocities decays with g = 2 k dV/rho, here w:
   * Verlet with lagged damping ends at w^2 dt^2 + 2 g dt = 4. */
  bw_solid_set_damping(pd, 2 * w / (2 * 0.125), 0, 0);
  const double damped = bw_solid_dt_max(pd) * w;
  bw_check_near(damped * damped + 2 * damped, 4, 1e-6);
  bw_solid_destroy(&pd);
  if (BW_REAL_EPSILON > 1e-10) return; /* orders drown in single precision */
  const double time = 3 / w, order[] = {2, 3};
  for (int q = 0; q < 2; q++) {
    const double coarse = pair_error((bw_solid_integrator)q, 40, time);
    const double fine = pair_error((bw_solid_integrator)q, 80, time);
    ck_assert_double_gt(coarse, 1e-12);
    ck_assert_double_le(fabs(log2(coarse / fine) - order[q]), 0.15);
  }
}
END_TEST

static void wobble(const double X0[3], double u[3])
{
  u[0] = 0.02 * sin(3 * X0[1] + X0[0]);
  u[1] = 0.02 * cos(2 * X0[0] - X0[2]);
  u[2] = 0.02 * sin(X0[0] + X0[1] + X0[2]);
}

static void swirl(const double X0[3], double v[3])
{
  v[0] = 0.3 + 0.1 * sin(5 * X0[1]);
  v[1] = 0.1 * X0[0] - 0.2 * cos(4 * X0[0]);
  v[2] = 0.05 * sin(7 * X0[0] * X0[1]);
}

/* Bond and pair damping forces are equal and opposite along the bond: both momenta stay. */
static void check_momenta(bw_pd_geometry geometry, double damping_pair, bool rk3)
{
  bw_solid_config c = pd_soft(geometry);
  c.integrator = rk3 ? BW_SOLID_RK3 : BW_SOLID_VERLET;
  c.damping.pair = damping_pair;
  c.origin[0] = -3;
  pd_body body = pd_box(7, 6, geometry == BW_PD_3D ? 5 : 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, wobble, swirl);
  const bw_solid_ledger a = ledger_of(pd);
  pd_steps(pd, 60, (rk3 ? 0.1 : 0.5) * bw_solid_dt_max(pd));
  const bw_solid_ledger b = ledger_of(pd);
  const double size = fabs(a.momentum[0]) + fabs(a.momentum[1]);
  /* damping with the half-step velocity still is along the present bond; in RK3 angular
     momentum is a quadratic invariant, which that scheme keeps to its order only: 1.6e-4 of its
     size in 60 steps of half the limit, so 1.6e-4/5^4 with a tenth of it */
  for (int k = 0; k < 3; k++) {
    ck_assert_double_le(fabs(b.momentum[k] - a.momentum[k]), 1e3 * BW_REAL_EPSILON * size);
    ck_assert_double_le(fabs(b.angular[k] - a.angular[k]),
                        (rk3 ? 1e-6 : 1e4 * BW_REAL_EPSILON) * size);
  }
  if (geometry != BW_PD_3D) ck_assert_double_eq(b.momentum[2], 0);
  if (damping_pair > 0) ck_assert_double_lt(b.kinetic + b.elastic, a.kinetic + a.elastic);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(momenta_are_conserved)
{
  for (int g = 0; g < 3; g++)
    for (int rk3 = 0; rk3 < 2; rk3++) {
      check_momenta((bw_pd_geometry)g, 0, rk3);
      check_momenta((bw_pd_geometry)g, 0.05, rk3);
    }
}
END_TEST

/* The book closes: Verlet's energy error is bounded and falls with dt^2, RK3's falls with dt^3. */
static double energy_error(bw_solid_integrator integrator, double fraction_of_limit, double damping)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.integrator = integrator;
  c.damping.pair = damping;
  c.damping.mean = damping;
  c.damping.absolute = damping;
  pd_body body = pd_box(6, 5, 4);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, wobble, swirl);
  const double start = pd_energy(pd), dt = 0.5 * fraction_of_limit;
  pd_steps(pd, (int)lround(20 / dt), dt);
  const double error = fabs(pd_energy(pd) - start) / start;
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  return error;
}

START_TEST(energy_book_closes)
{
  if (BW_REAL_EPSILON > 1e-10) return; /* orders drown in single precision */
  const double order[] = {2, 3};
  for (int q = 0; q < 2; q++) {
    const double coarse = energy_error((bw_solid_integrator)q, 0.2, 0);
    const double fine = energy_error((bw_solid_integrator)q, 0.1, 0);
    ck_assert_double_le(coarse, 0.02);
    ck_assert_double_ge(log2(coarse / fine), order[q] - 0.4);
  }
  /* damping: its work is booked as it is done, so the book closes as before */
  for (int q = 0; q < 2; q++)
    ck_assert_double_le(energy_error((bw_solid_integrator)q, 0.1, 0.01), 0.004);
}
END_TEST

static void parting(const double X0[3], double v[3])
{
  v[0] = X0[0] > 0.5 ? 0.3 : -0.1;
  v[1] = X0[0] > 0.5 ? 0.2 : 0; /* across the bond: pair damping does not see it */
  v[2] = 0;
}

/* On particle 0 of an unstretched pair: pair k dV 0.4/rho along x; mean k (0.4, 0.2)/rho; absolute
 * -k (-0.1, 0)/rho. Alone and together, as they take different ways through the code. */
START_TEST(damping_in_closed_form)
{
  const double kinds[][3] = {{0.8, 0, 0}, {0, 0.02, 0}, {0, 0, 0.05}, {0.8, 0.02, 0.05}};
  for (int surface = 0; surface < 3; surface++)
    for (int q = 0; q < 4; q++) {
      bw_solid_config c = pd_soft(BW_PD_3D);
      c.surface_correction = (bw_pd_surface_correction)surface;
      bw_solid *pd = pair(c);
      double A[6];
      bw_solid_set_damping(pd, kinds[q][0], kinds[q][1], kinds[q][2]);
      pd_set(pd, NULL, parting);
      (void)ledger_of(pd); /* evaluates the force */
      pd_gather(pd, bw_solid_get_acceleration, A);
      const double k = kinds[q][0], m = kinds[q][1], a = kinds[q][2];
      bw_check_near(A[0], (k * 0.125 * 0.4 + m * 0.4 + a * 0.1) / 2, 100 * BW_REAL_EPSILON);
      bw_check_near(A[1], m * 0.2 / 2, 100 * BW_REAL_EPSILON);
      bw_check_near(A[3], (-k * 0.125 * 0.4 - m * 0.4 - a * 0.3) / 2, 100 * BW_REAL_EPSILON);
      bw_check_near(A[4], (-m * 0.2 - a * 0.2) / 2, 100 * BW_REAL_EPSILON);
      bw_solid_destroy(&pd);
    }
}
END_TEST

/* Absolute damping of a body that moves as a whole: V' = - k V/rho; Verlet takes the lagged
 * velocity, an error of first order in k dt/rho = 0.001. Mean damping leaves that motion alone. */
static void drift(const double X0[3], double v[3])
{
  v[0] = 0.25 + 0 * X0[0];
}

START_TEST(damping_of_rigid_motion)
{
  for (int q = 0; q < 2; q++) {
    bw_solid_config c = pd_soft(BW_PD_PLANE_STRAIN);
    c.damping.absolute = q == 0 ? 0.02 : 0;
    c.damping.mean = q == 1 ? 0.02 : 0;
    pd_body body = pd_box(5, 5, 1);
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    pd_set(pd, NULL, drift);
    pd_steps(pd, 200, 0.1);
    const double expected = q == 0 ? exp(-0.02 * 20 / 2) : 1;
    const double mass = 2 * 25 * 0.25;
    bw_check_near(ledger_of(pd).momentum[0] / (0.25 * mass), expected, 1e-3);
    bw_solid_destroy(&pd);
    pd_body_release(&body);
  }
}
END_TEST

/* A constant force on a free body: momentum grows by F V t, its work is the kinetic energy. */
START_TEST(external_force_does_its_work)
{
  for (int q = 0; q < 2; q++) {
    bw_solid_config c = pd_soft(BW_PD_3D);
    c.integrator = (bw_solid_integrator)q;
    pd_body body = pd_box(4, 4, 4);
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    double F[3 * 64];
    for (size_t i = 0; i < 64; i++)
      F[3 * i] = 0, F[3 * i + 1] = 0.04, F[3 * i + 2] = 0;
    bw_solid_set_force(pd, F);
    pd_steps(pd, 50, 0.1);
    const bw_solid_ledger l = ledger_of(pd);
    const double volume = 64 * 0.125, p = 0.04 * volume * 5;
    bw_check_near(l.momentum[1], p, 1e3 * BW_REAL_EPSILON);
    bw_check_near(l.kinetic, p * p / (2 * 2 * volume), 1e3 * BW_REAL_EPSILON);
    bw_check_near(l.external, l.kinetic, 1e3 * BW_REAL_EPSILON);
    bw_solid_destroy(&pd);
    pd_body_release(&body);
  }
}
END_TEST

/* Grips pull the ends of a bar apart: they move as told and their work is in the book. */
START_TEST(prescribed_ends_move_as_told)
{
  for (int q = 0; q < 2; q++) {
    bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS);
    c.integrator = (bw_solid_integrator)q;
    pd_body body = pd_box(16, 4, 1);
    for (int64_t i = 0; i < body.n; i++)
      if (body.site[3 * i] < 3 || body.site[3 * i] > 12) body.kind[i] = BW_PD_PRESCRIBED;
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    const size_t n = bw_solid_count(pd);
    double X[3 * 64], V[3 * 64], A[3 * 64];
    bw_solid_get_reference(pd, X);
    for (size_t i = 0; i < n; i++)
      V[3 * i] = X[3 * i] < 4 ? -0.01 : 0.01, V[3 * i + 1] = 0.005, V[3 * i + 2] = 0;
    bw_solid_set_prescribed(pd, V);
    pd_steps(pd, 100, 0.1);
    pd_gather(pd, bw_solid_get_position, X);
    pd_gather(pd, bw_solid_get_acceleration, A);
    for (size_t i = 0; i < 64; i++) {
      if (body.kind[i] == BW_PD_FREE) continue;
      const double side = body.site[3 * i] < 3 ? -1 : 1;
      bw_check_near(X[3 * i], (body.site[3 * i] + 0.5) * 0.5 + side * 0.1, 1e3 * BW_REAL_EPSILON);
      bw_check_near(X[3 * i + 1], (body.site[3 * i + 1] + 0.5) * 0.5 + 0.05, 1e3 * BW_REAL_EPSILON);
      ck_assert_double_eq(A[3 * i], 0);
    }
    const bw_solid_ledger l = ledger_of(pd);
    ck_assert_double_gt(l.elastic, 0);
    bw_check_near((l.kinetic + l.elastic) / l.external, 1, 0.01); /* dt is a tenth of the limit */
    bw_solid_destroy(&pd);
    pd_body_release(&body);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(two_particles_pull_in_closed_form),
                                      BW_TEST(integrators_have_their_order),
                                      BW_TEST(momenta_are_conserved),
                                      BW_TEST(energy_book_closes),
                                      BW_TEST(damping_in_closed_form),
                                      BW_TEST(damping_of_rigid_motion),
                                      BW_TEST(external_force_does_its_work),
                                      BW_TEST(prescribed_ends_move_as_told)};
BW_CHECK_MAIN("pd_bond.force", tests)
