/* A law that is no part of Breakwater runs through step, ledger, breaking, restart, ranks, statics,
 * stress and contact: the socket of laws (pd_law.h) is one. docs/add-a-law.md explains the law.
 * BUILD modules=solid_tools
 * TEST  ranks=1,2,3 */
#include "bw_solid_load.h"
#include "bw_solid_stress.h"
#include "cubic_law.h"
#include "law_test.h"

static const cubic_state STIFFENING = {.beta = 30, .s0 = 0.2}, LINEAR = {.beta = 0, .s0 = 0.2};

static bw_solid_config with(const cubic_state *options)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.law = &cubic_law;
  c.law_options = options;
  return c;
}

static void shake(const double X0[3], double v[3])
{
  v[0] = 0.3 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.2 * cos(3 * X0[1]) + 0.1 * X0[0];
  v[2] = 0.2 * sin(X0[2] * X0[0]);
}

static void tremble(const double X0[3], double v[3])
{
  shake(X0, v);
  for (int k = 0; k < 3; k++)
    v[k] *= 0.2;
}

/* Two particles, and how far they are stretched, on all ranks. */
static bw_solid *pair(const bw_solid_config *c, const uint8_t kind[2])
{
  pd_body two = pd_box(2, 1, 1);
  for (int q = 0; kind != NULL && q < 2; q++)
    two.kind[q] = kind[q];
  bw_solid *pd = pd_make(bw_check_world(), c, &two);
  pd_body_release(&two);
  return pd;
}

static double stretch(const bw_solid *pd, const bw_solid_config *c)
{
  double X[6];
  pd_gather(pd, bw_solid_get_position, X);
  return (X[3] - X[0]) / c->ds - 1;
}

static const double A = 0.15; /* stretch at the start */
static void apart(const double X0[3], double u[3])
{
  u[0] = X0[0] > 0.5 ? A * 0.5 : 0;
}

/* r0 s'' = -2 c Gamma dV/rho (s + beta s^3), Gamma = 1: with s = A sin(phi) the quarter of a period
 * is the integral of 1/(w sqrt(1 + beta A^2 (1 + sin^2 phi)/2)), w the frequency of small
 * oscillations. */
START_TEST(two_particles_swing_as_long_as_the_integral_says)
{
  enum { N = 2000, POINTS = 64 };
  const bw_solid_config c = with(&STIFFENING);
  bw_solid *pd = pair(&c, NULL);
  const double w = sqrt(2 * bw_solid_micromodulus(pd) * bw_solid_volume(pd) / (c.rho * c.ds));
  const double b = STIFFENING.beta, s0 = STIFFENING.s0;
  double quarter = 0;
  for (int q = 0; q < POINTS; q++) { /* the midpoint rule converges exponentially */
    const double sine = sin((q + 0.5) / POINTS * 1.57079632679489661923);
    quarter += 1.57079632679489661923 / POINTS / sqrt(1 + b * A * A * (1 + sine * sine) / 2) / w;
  }
  /* The bound is that of the steepest bond, and of a pair it is the frequency itself. */
  bw_check_near(bw_solid_dt_max(pd) * w * sqrt(1 + 3 * b * s0 * s0), 2, ROUND_OFF);
  pd_set(pd, apart, NULL);
  const double start = pd_energy(pd), dt = quarter / N;
  pd_steps(pd, N - 1, dt);
  const double before = stretch(pd, &c);
  pd_steps(pd, 1, dt);
  const double after = stretch(pd, &c);
  ck_assert_double_gt(before, 0);
  /* The straight line through both says when it passed 0; Verlet swings (w dt)^2/24 too fast. */
  const double missed = after / (after - before) / N;
  ck_assert_double_lt(fabs(missed), pow(2 * w * dt, 2));
  bw_check_near(pd_energy(pd) / start, 1, fmax(pow(2 * w * dt, 2), ROUND_OFF));
  bw_solid_destroy(&pd);
}
END_TEST

START_TEST(a_bond_breaks_beyond_s0_and_its_energy_is_booked)
{
  const bw_solid_config c = with(&STIFFENING);
  bw_solid *pd = pair(&c, NULL);
  double V[6] = {0}, X[6], s = 0;
  pd_gather(pd, bw_solid_get_position, X);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    V[3 * i] = bw_solid_id(pd)[i] == 0 ? -1 : 1;
  bw_solid_get_position(pd, X);
  bw_solid_set_state(pd, X, V);
  const double start = pd_energy(pd), dt = 0.02 * bw_solid_dt_max(pd);
  for (int q = 0; ledger_of(pd).broken == 0 && q < 10000; q++) {
    ck_assert_double_le(s, STIFFENING.s0); /* while it holds */
    pd_steps(pd, 1, dt);
    s = stretch(pd, &c);
  }
  ck_assert_double_gt(s, STIFFENING.s0);
  const double dv = bw_solid_volume(pd), s2 = s * s;
  const double held = bw_solid_micromodulus(pd) * c.ds * s2 * (0.5 + STIFFENING.beta * s2 / 4);
  bw_check_near(ledger_of(pd).fracture / (held * dv * dv), 1, ROUND_OFF);
  ck_assert_double_eq(ledger_of(pd).elastic, 0);
  bw_check_near(pd_energy(pd) / start, 1, pow(2 * 0.02, 2)); /* Verlet's (w dt)^2 */
  bw_solid_destroy(&pd);
}
END_TEST

START_TEST(force_is_the_derivative_of_energy)
{
  const bw_solid_config c = with(&STIFFENING);
  check_force(&c);
}
END_TEST

START_TEST(rest_by_relaxation_and_by_the_linear_solve)
{
  const bw_solid_config c = with(&STIFFENING);
  check_rest(&c);
}
END_TEST

/* Largest departure of the energy over a time, in parts of it. */
static double departure(double fraction, const cubic_state *law, bw_solid_ledger *end)
{
  bw_solid_config c = with(law);
  pd_body body = pd_box(9, 6, 5);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, tremble);
  const double dt = fraction * bw_solid_dt_max(pd), start = pd_energy(pd);
  double worst = 0;
  for (int q = 0; q < (int)(5 / dt); q++) {
    pd_steps(pd, 1, dt);
    worst = fmax(worst, fabs(pd_energy(pd) / start - 1));
  }
  *end = ledger_of(pd);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  return worst;
}

START_TEST(the_book_closes_to_the_order_of_the_integrator)
{
  const cubic_state brittle = {.beta = 30, .s0 = 0.02};
  bw_solid_ledger first, end;
  const double coarse = departure(0.4, &STIFFENING, &first),
               fine = departure(0.2, &STIFFENING, &end);
  ck_assert_int_eq(end.broken, 0);
  ck_assert_double_gt(coarse / fine, 3.5); /* second order: 4 */
  ck_assert_double_lt(coarse, 0.01);
  for (int k = 0; k < 3; k++) {
    bw_check_near(first.momentum[k], end.momentum[k], ROUND_OFF);
    bw_check_near(first.angular[k], end.angular[k], ROUND_OFF);
  }
  /* With breaking: what broken bonds held is fracture. */
  const double broken = departure(0.2, &brittle, &end);
  ck_assert_int_gt(end.broken, 10);
  ck_assert_double_gt(end.fracture, 0);
  ck_assert_double_lt(broken, 0.01);
}
END_TEST

START_TEST(without_the_cubic_term_it_is_the_bond_law)
{
  bw_solid_config bonds = pd_soft(BW_PD_3D);
  bonds.surface_correction = BW_PD_SURFACE_NONE;
  bonds.G0 = 0.02;
  pd_body body = pd_box(9, 6, 5);
  bw_solid *b = pd_make(bw_check_world(), &bonds, &body);
  const cubic_state same = {.beta = 0, .s0 = bw_solid_critical_stretch(b)};
  const bw_solid_config c = with(&same);
  bw_solid *a = pd_make(bw_check_world(), &c, &body);
  bw_check_near(bw_solid_micromodulus(a) / bw_solid_micromodulus(b), 1, ROUND_OFF);
  bw_check_near(bw_solid_dt_max(a) / bw_solid_dt_max(b), 1, ROUND_OFF);
  pd_set(a, NULL, shake);
  pd_set(b, NULL, shake);
  pd_steps(a, 60, 0.5 * bw_solid_dt_max(b));
  pd_steps(b, 60, 0.5 * bw_solid_dt_max(b));
  pd_check_same(a, b, bw_solid_get_position, ROUND_OFF);
  pd_check_same(a, b, bw_solid_get_velocity, ROUND_OFF);
  pd_check_same(a, b, bw_solid_get_acceleration, 10 * ROUND_OFF);
  const bw_solid_ledger x = ledger_of(a), y = ledger_of(b);
  ck_assert_int_gt(x.broken, 0);
  ck_assert_int_eq(x.broken, y.broken);
  bw_check_near(x.elastic, y.elastic, ROUND_OFF);
  bw_check_near(x.fracture, y.fracture, ROUND_OFF);
  bw_solid_destroy(&a);
  bw_solid_destroy(&b);
  pd_body_release(&body);
}
END_TEST

START_TEST(same_on_any_number_of_ranks_and_after_a_restart)
{
  const cubic_state brittle = {.beta = 30, .s0 = 0.1};
  const bw_solid_config c = with(&brittle);
  bw_comm *self = pd_alone();
  pd_body body = pd_box(9, 6, 5);
  bw_solid *all = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  bw_solid *next = pd_make(bw_check_world(), &c, &body);
  const double dt = 0.4 * bw_solid_dt_max(all);
  pd_set(all, NULL, shake);
  pd_set(one, NULL, shake);
  pd_steps(all, 60, dt);
  pd_steps(one, 60, dt);
  pd_restart_from(all, next);
  ck_assert_int_gt(ledger_of(all).broken, 10);
  pd_steps(all, 40, dt);
  pd_steps(one, 40, dt);
  pd_steps(next, 40, dt);
  pd_check_same(all, one, bw_solid_get_position, ROUND_OFF);
  ck_assert_int_eq(ledger_of(all).broken, ledger_of(one).broken);
  bw_check_near(ledger_of(all).fracture, ledger_of(one).fracture, ROUND_OFF);
  pd_check_same(all, next, bw_solid_get_position, 0);
  pd_check_same(all, next, bw_solid_get_velocity, 0);
  ck_assert_int_eq(ledger_of(all).broken, ledger_of(next).broken);
  bw_solid_destroy(&all);
  bw_solid_destroy(&one);
  bw_solid_destroy(&next);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* c (s + beta s^3) Gamma dV = F. */
START_TEST(a_pulled_pair_comes_to_rest_where_the_cubic_says)
{
  const uint8_t kind[2] = {BW_PD_PRESCRIBED, BW_PD_FREE};
  const bw_solid_config c = with(&STIFFENING);
  bw_solid *pd = pair(&c, kind);
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  how.tolerance = fmax(1e-9, 10 * BW_REAL_EPSILON);
  const double s = 0.12, b = STIFFENING.beta;
  const double pull = bw_solid_micromodulus(pd) * bw_solid_volume(pd);
  double F[6] = {0};
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    F[3 * i] = bw_solid_id(pd)[i] == 1 ? pull * (s + b * s * s * s) : 0;
  bw_solid_set_force(pd, F);
  bw_check_ok(bw_solid_static_relax(pd, &how, &report));
  bw_check_near(stretch(pd, &c), s, how.tolerance); /* dF/ds >= pull >= F */
  bw_solid_destroy(&pd);
}
END_TEST

static void swell(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = 0.1 * X0[k];
}

/* Where all bonds have the stretch e, stress is 1 + beta e^2 times that of linear springs. */
START_TEST(stress_of_a_dilation)
{
  const cubic_state *law[] = {&LINEAR, &STIFFENING};
  double sum[2][3] = {{0}};
  pd_body body = pd_box(7, 7, 7);
  for (int q = 0; q < 2; q++) {
    const bw_solid_config c = with(law[q]);
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    double *stress = NULL;
    bw_check_ok(BW_ALLOCATE(&stress, 6 * bw_solid_count(pd)));
    pd_set(pd, swell, NULL);
    bw_solid_stress_compute(pd, NULL, stress);
    for (size_t i = 0; i < bw_solid_count(pd); i++)
      for (size_t k = 0; k < 3; k++)
        sum[q][k] += stress[6 * i + k];
    bw_comm_sum(bw_check_world(), 3, sum[q]);
    bw_release(&stress);
    bw_solid_destroy(&pd);
  }
  for (int k = 0; k < 3; k++) {
    ck_assert_double_gt(sum[0][k], 0);
    bw_check_near(sum[1][k] / sum[0][k], 1 + STIFFENING.beta * 0.1 * 0.1, ROUND_OFF);
  }
  pd_body_release(&body);
}
END_TEST

/* A block falls on a floor and comes back; contact is as stiff as the law's micromodulus says. */
START_TEST(a_block_falls_on_a_wall)
{
  const bw_pd_wall floor_at_0 = {.normal = {0, 1, 0}, .offset = 0};
  bw_solid_config c = with(&STIFFENING), bonds = pd_soft(BW_PD_3D);
  c.contact = bonds.contact = true;
  pd_body body = pd_box(4, 3, 3);
  for (int64_t q = 0; q < body.n; q++)
    body.site[3 * q + 1] += 1;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_solid *other = pd_make(bw_check_world(), &bonds, &body);
  bw_check_near(bw_solid_dt_contact(pd) / bw_solid_dt_contact(other), 1, ROUND_OFF);
  bw_check_ok(bw_solid_set_walls(pd, 1, &floor_at_0));
  const double velocity[3] = {0, -0.1, 0}, none[3] = {0};
  bw_check_ok(bw_solid_load_launch(pd, velocity, none, none));
  const double dt = 0.2 * bw_solid_dt_max(pd), start = pd_energy(pd);
  const bw_solid_ledger first = ledger_of(pd);
  double worst = 0, pressed = 0;
  for (int q = 0; q < (int)(20 / dt); q++) {
    pd_steps(pd, 1, dt);
    worst = fmax(worst, fabs(pd_energy(pd) / start - 1));
    pressed = fmax(pressed, ledger_of(pd).contact);
  }
  const bw_solid_ledger end = ledger_of(pd);
  ck_assert_double_gt(pressed, 0.01 * start);
  ck_assert_double_gt(end.momentum[1], -0.5 * first.momentum[1]); /* it is on its way up */
  bw_check_near(end.momentum[1] + end.wall[1], first.momentum[1], ROUND_OFF);
  ck_assert_double_lt(worst, 0.01);
  bw_solid_destroy(&pd);
  bw_solid_destroy(&other);
  pd_body_release(&body);
}
END_TEST

START_TEST(what_a_law_refuses_and_the_table_of_laws)
{
  const cubic_state wrong = {.beta = -1, .s0 = 0.1};
  bw_solid_config c = with(&wrong);
  pd_body two = pd_box(2, 1, 1);
  bw_solid *pd = NULL;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, two.n, two.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "beta = -1"));
  c = with(&LINEAR);
  c.geometry = BW_PD_PLANE_STRESS;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, two.n, two.site, NULL, &pd),
                  BW_EINPUT);
  ck_assert_ptr_eq(bw_solid_law_by_name("bond"), bw_solid_laws[0]);
  ck_assert_ptr_null(bw_solid_law_by_name("cubic")); /* it is only of this test */
  FILE *file = tmpfile();
  char text[400] = "";
  bw_solid_laws_describe(file);
  rewind(file);
  ck_assert_uint_gt(fread(text, 1, sizeof text - 1, file), 0);
  fclose(file);
  for (const bw_pd_law_key *key = bw_solid_laws[0]->keys; key->name != NULL; key++)
    ck_assert_ptr_nonnull(strstr(text, key->name));
  pd_body_release(&two);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(two_particles_swing_as_long_as_the_integral_says),
                                      BW_TEST(a_bond_breaks_beyond_s0_and_its_energy_is_booked),
                                      BW_TEST(force_is_the_derivative_of_energy),
                                      BW_TEST(the_book_closes_to_the_order_of_the_integrator),
                                      BW_TEST(without_the_cubic_term_it_is_the_bond_law),
                                      BW_TEST(same_on_any_number_of_ranks_and_after_a_restart),
                                      BW_TEST(a_pulled_pair_comes_to_rest_where_the_cubic_says),
                                      BW_TEST(rest_by_relaxation_and_by_the_linear_solve),
                                      BW_TEST(stress_of_a_dilation),
                                      BW_TEST(a_block_falls_on_a_wall),
                                      BW_TEST(what_a_law_refuses_and_the_table_of_laws)};
BW_CHECK_MAIN("law", tests)
