/* The operators on clouds with a surface all round: the gradient of a linear field is exact, forces
 * keep momentum, angular momentum and energy whatever the pressures, and viscosity and diffusion
 * what they have to. With M_I^-1 of one end alone, as ULPH 26 is printed, they do not.
 * TEST ranks=1,2,3 */
#include "ulph_test.h"

/* Round-off of sums over 28 (122) neighbours, relative to the sum of absolutes. */
static const double ROUND = 1e-13;

static const double slope[3][3] = {{0.3, -0.2, 0.1}, {0.05, -0.4, 0.2}, {-0.1, 0.15, 0.25}};

static void linear(const double x[3], void *context, double v[3], double *p)
{
  const int d = *(const int *)context;
  *p = 0;
  for (int a = 0; a < 3; a++) {
    v[a] = 0;
    for (int b = 0; b < d; b++)
      v[a] += a < d ? 0.01 * slope[a][b] * x[b] : 0;
  }
}

static void random_state(const double x[3], void *context, double v[3], double *p)
{
  const int d = *(const int *)context;
  const uint64_t key = (uint64_t)(int64_t)rint(x[0] * 1e6 + x[1] * 1e9 + x[2] * 1e12);
  *p = 2 * noise(key);
  for (int k = 0; k < 3; k++)
    v[k] = k < d ? 0.3 * noise(key + 1 + (uint64_t)k) : 0;
}

static void gradient_of(int d, int n)
{
  bw_ulph_config c = ulph_still(d);
  bw_ulph *u = ulph_cloud(bw_check_world(), &c, n);
  int64_t whole = 0;
  bw_check_ok(bw_ulph_start(u, linear, &d));
  for (size_t i = 0; i < bw_ulph_count(u); i++) {
    if (u->own[i].lone) continue;
    whole++;
    for (int a = 0; a < d; a++)
      for (int b = 0; b < d; b++)
        bw_check_near(ULPH_BETWEEN(u, i, L[3 * a + b]), 0.01 * slope[a][b], 1e-14);
  }
  /* Corners alone have no gradient. */
  bw_comm_sum_int(bw_check_world(), 1, &whole);
  ck_assert_int_ge(whole, bw_ulph_total(u) * 8 / 10);
  bw_ulph_destroy(&u);
}

static void uniform_tension(const double x[3], void *context, double v[3], double *p)
{
  (void)x, (void)context;
  v[0] = v[1] = v[2] = 0;
  *p = -0.01;
}

/* Largest acceleration, in units of p/(rho dx), of particles that see none of the surface. */
static double pulled(bool cure)
{
  enum { ACROSS = 14 };
  bw_ulph_config c = ulph_still(2);
  c.tension_cure = cure;
  bw_ulph *u = ulph_cloud(bw_check_world(), &c, ACROSS);
  double largest = 0;
  bw_check_ok(bw_ulph_start(u, uniform_tension, NULL));
  for (size_t i = 0; i < bw_ulph_count(u); i++)
    for (int k = 0; k < 2; k++)
      if (fabs(u->own[i].x[0] - 6.5) < 1.5 && fabs(u->own[i].x[1] - 6.5) < 1.5)
        largest = fmax(largest, fabs(u->own[i].a[k]) * c.rho0 * c.dx / 0.01);
  bw_comm_max(bw_check_world(), 1, &largest);
  bw_ulph_destroy(&u);
  return largest;
}

/* A uniform tension has no gradient: its cure leaves disordered particles alone, which the pair
 * form, made for the sake of energy, pulls together. */
START_TEST(uniform_tension_moves_nothing)
{
  ck_assert_double_le(pulled(true), 1e-10); /* p is a difference of densities, 1e-5 of them */
  ck_assert_double_gt(pulled(false), 0.1);
}
END_TEST

START_TEST(gradient_of_a_linear_field_is_exact)
{
  gradient_of(2, 12);
  gradient_of(3, 7);
}
END_TEST

/* Sums of forces, torques, powers, and of their absolutes. */
typedef struct {
  double force[3], torque[3], power, stored, size[3];
} sums;

static sums sum_forces(const bw_ulph *u)
{
  sums s;
  memset(&s, 0, sizeof s);
  for (size_t i = 0; i < bw_ulph_count(u); i++) {
    const bw_ulph__particle *p = u->own + i;
    for (int k = 0; k < 3; k++) {
      const int a = (k + 1) % 3, c = (k + 2) % 3;
      const double F = p->m * p->a[k];
      const double torque = p->m * (p->x[a] * p->a[c] - p->x[c] * p->a[a]);
      s.force[k] += F, s.size[0] += fabs(F);
      s.torque[k] += torque, s.size[1] += fabs(torque);
      s.power += F * p->v[k], s.size[2] += fabs(F * p->v[k]);
      s.stored += ULPH_BETWEEN(u, i, V) * p->p * ULPH_BETWEEN(u, i, L[4 * k]);
    }
  }
  bw_comm_sum(bw_check_world(), sizeof s / sizeof(double), (double *)&s);
  return s;
}

static void conserve(int d, int n)
{
  bw_ulph_config c = ulph_still(d);
  c.speed = 30;
  bw_ulph *u = ulph_cloud(bw_check_world(), &c, n);
  bw_check_ok(bw_ulph_start(u, random_state, &d));
  const sums s = sum_forces(u);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_le(fabs(s.force[k]), ROUND * s.size[0]);
    ck_assert_double_le(fabs(s.torque[k]), ROUND * s.size[1]);
  }
  /* The power of the pair forces is that of the pressure on the dilation. */
  ck_assert_double_le(fabs(s.power - s.stored), ROUND * s.size[2]);
  ck_assert_double_gt(fabs(s.power), 1e-4 * s.size[2]);
  bw_ulph_destroy(&u);
}

START_TEST(forces_keep_momentum_spin_and_energy)
{
  conserve(2, 12);
  conserve(3, 7);
}
END_TEST

START_TEST(viscosity_keeps_momentum_and_spin_and_takes_energy)
{
  for (int d = 2; d <= 3; d++) {
    bw_ulph_config c = ulph_still(d);
    /* No pressure: what acts is viscous. */
    c.speed = 30, c.mu = 0.1;
    bw_ulph *u = ulph_cloud(bw_check_world(), &c, d == 2 ? 12 : 7);
    bw_check_ok(bw_ulph_start(u, linear, &d));
    const sums s = sum_forces(u);
    for (int k = 0; k < 3; k++) {
      ck_assert_double_le(fabs(s.force[k]), ROUND * s.size[0]);
      ck_assert_double_le(fabs(s.torque[k]), ROUND * s.size[1]);
    }
    ck_assert_double_lt(s.power, 0);
    bw_ulph_destroy(&u);
  }
}
END_TEST

static void weigh(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = v[1] = v[2] = 0;
  *p = 3 - 0.4 * x[0] + 0.7 * x[1] + 0.2 * x[2];
}

/* Zero for a linear density, with a sum of zero for any. */
START_TEST(diffusion_leaves_linear_density_and_mass)
{
  for (int d = 2; d <= 3; d++) {
    bw_ulph_config c = ulph_still(d);
    c.speed = 30, c.delta = 0.1;
    bw_ulph *u = ulph_cloud(bw_check_world(), &c, d == 2 ? 12 : 7);
    double sum[2] = {0, 0}, linear_most = 0;
    bw_check_ok(bw_ulph_start(u, weigh, NULL));
    /* Particles whose neighbours all have a gradient see a linear density. */
    for (size_t i = 0; i < bw_ulph_count(u); i++) {
      bool inside = true;
      for (int k = 0; k < d; k++)
        inside = inside && u->own[i].x[k] > 3.5 &&
                 u->own[i].x[k] < (d == 2 ? 7.5 : 2.5) + (d == 2 ? 0 : 0);
      if (inside) linear_most = fmax(linear_most, fabs(ULPH_BETWEEN(u, i, D)));
    }
    bw_check_ok(bw_ulph_start(u, random_state, &d));
    for (size_t i = 0; i < bw_ulph_count(u); i++) {
      const double D = ULPH_BETWEEN(u, i, V) * ULPH_BETWEEN(u, i, D);
      sum[0] += D;
      sum[1] += fabs(D);
    }
    bw_comm_sum(bw_check_world(), 2, sum);
    bw_comm_max(bw_check_world(), 1, &linear_most);
    ck_assert_double_le(fabs(sum[0]), ROUND * sum[1]);
    ck_assert_double_gt(sum[1], 1e-6);
    /* delta h c0 rho/dx^2 is 70 times a density; 2e-16 of 2 is its round-off. */
    ck_assert_double_le(linear_most, 1e-12);
    bw_ulph_destroy(&u);
  }
}
END_TEST

/* ULPH 26 as printed: the central force of a pair over M_I^-1 of one end. */
START_TEST(one_ended_viscosity_loses_momentum)
{
  int d = 2;
  const bw_ulph_config c = ulph_still(d);
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  bw_ulph *u = ulph_cloud(self, &c, 12);
  bw_check_ok(bw_ulph_start(u, random_state, &d));
  double force[3] = {0}, size = 0;
  for (size_t i = 0; i < bw_ulph_count(u); i++)
    for (size_t j = 0; j < bw_ulph_count(u); j++) {
      double x[3], F[3], vx = 0, r2 = 0;
      for (int k = 0; k < 3; k++) {
        x[k] = u->own[j].x[k] - u->own[i].x[k];
        vx += x[k] * (u->own[j].v[k] - u->own[i].v[k]);
        r2 += x[k] * x[k];
      }
      if (i == j || r2 >= 9 || vx >= 0) continue;
      double Minv[6];
      for (int k = 0; k < 6; k++)
        Minv[k] = ULPH_BETWEEN(u, i, Minv[k]);
      bw_ulph__times(Minv, x, F);
      for (int k = 0; k < 3; k++) {
        force[k] += F[k] * vx / (r2 + 0.01) * pow(1 - sqrt(r2) / 3, 4);
        size += fabs(F[k] * vx / (r2 + 0.01) * pow(1 - sqrt(r2) / 3, 4));
      }
    }
  ck_assert_double_gt(fabs(force[0]) + fabs(force[1]), 1e-3 * size);
  bw_ulph_destroy(&u);
  bw_comm_destroy(&self);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(uniform_tension_moves_nothing),
    BW_TEST(gradient_of_a_linear_field_is_exact),
    BW_TEST(forces_keep_momentum_spin_and_energy),
    BW_TEST(viscosity_keeps_momentum_and_spin_and_takes_energy),
    BW_TEST(diffusion_leaves_linear_density_and_mass),
    BW_TEST(one_ended_viscosity_loses_momentum),
};
BW_CHECK_MAIN("ulph operators", tests)
