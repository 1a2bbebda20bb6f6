/* Disordered clouds: forces, books and states at rest, by sums over pairs.
 * BUILD modules=solid_tools
 * TEST ranks=1,2,3,4 */
#include "bw_solid_static.h"
#include "bw_solid_stress.h"
#include "ledger.h"
#include "pd_cloud.h"

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

/* What the force of one particle is summed from. */
typedef struct {
  const bw_solid_config *c;
  double c0, dv, full; /* full: V_0 of the volume method */
  int64_t n;
  const double *X0, *X, *V;
  double *w; /* sums of Gamma dV, or energies of a dilation */
} pairs;

static double gamma_of(const pairs *p, double r0)
{
  return fmax(0, fmin(1, p->c->horizon_ratio + 0.5 - r0 / p->c->ds));
}

static void weigh(pairs *p)
{
  double d[3];
  for (int64_t a = 0; a < p->n; a++) {
    double volume = 0, moment = 0;
    for (int64_t b = 0; b < p->n; b++) {
      const double r0 = apart(p->c, p->X0 + 3 * a, p->X0 + 3 * b, d);
      if (a == b) continue;
      volume += gamma_of(p, r0) * p->dv, moment += gamma_of(p, r0) * p->dv * r0;
    }
    const double dilation = p->c->geometry == BW_PD_3D ? 3 : 1.5;
    p->w[a] = p->c->surface_correction == BW_PD_SURFACE_VOLUME
                  ? volume / p->full
                  : dilation * p->c->E / (0.25 * p->c0 * moment);
  }
}

static double alpha_of(const pairs *p, int64_t a, int64_t b)
{
  if (p->c->surface_correction == BW_PD_SURFACE_NONE) return 1;
  const double sum = p->w[a] + p->w[b];
  return p->c->surface_correction == BW_PD_SURFACE_VOLUME ? 2 / sum : sum / 2;
}

/* (L + D)/rho of particle a; returns twice its half of the bonds' energy. */
static double force_on(const pairs *p, int64_t a, double A[3])
{
  double energy = 0, xi[3], z[3];
  for (int k = 0; k < 3; k++)
    A[k] = 0;
  for (int64_t b = 0; b < p->n; b++) {
    const double r0 = apart(p->c, p->X0 + 3 * a, p->X0 + 3 * b, xi);
    const double r = apart(p->c, p->X + 3 * a, p->X + 3 * b, z), gamma = gamma_of(p, r0);
    if (a == b || gamma == 0) continue;
    const double s = r / r0 - 1, k = p->c0 * alpha_of(p, a, b) * gamma * p->dv;
    double along = 0;
    for (int d = 0; d < 3; d++)
      along += (p->V[3 * b + d] - p->V[3 * a + d]) * z[d] / r;
    for (int d = 0; d < 3; d++)
      A[d] += (k * s + p->c->damping.pair * gamma * p->dv * along) * z[d] / r / p->c->rho;
    energy += 0.5 * k * s * s * r0 * p->dv;
  }
  return energy;
}

static void check_force(bw_solid_config c, bool spread)
{
  const bool planar = c.geometry != BW_PD_3D;
  pd_body body = planar ? pd_box(13, 9, 1) : pd_box(9, 7, 6);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, wobble, swirl);
  if (spread) bw_solid_set_damping(pd, c.damping.pair, 1e-30, 0); /* another way through */
  const double elastic = ledger_of(pd).elastic, horizon = bw_solid_horizon(pd);
  double *X0 = rows_of(pd, bw_solid_get_reference), *X = rows_of(pd, bw_solid_get_position);
  double *A = rows_of(pd, bw_solid_get_acceleration), *V = rows_of(pd, bw_solid_get_velocity);
  pairs p = {&c, bw_solid_micromodulus(pd), bw_solid_volume(pd), 0, body.n, X0, X, V, NULL};
  p.full = acos(-1.0) * horizon * horizon * (planar ? 1 : 4.0 / 3 * horizon);
  bw_check_ok(BW_ALLOCATE(&p.w, (size_t)body.n));
  weigh(&p);
  double energy = 0, one[3], size = 0;
  for (int64_t a = 0; a < body.n; a++) {
    energy += 0.5 * force_on(&p, a, one);
    for (int k = 0; k < 3; k++)
      size = fmax(size, fabs(one[k]));
    for (int k = 0; k < (planar ? 2 : 3); k++)
      bw_check_near(A[3 * a + k], one[k], 1e3 * BW_REAL_EPSILON * size);
  }
  bw_check_near(elastic / energy, 1, 1e3 * BW_REAL_EPSILON);
  double *all[] = {X0, X, A, V, p.w};
  for (int q = 0; q < 5; q++)
    bw_release(&all[q]);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(forces_are_the_sum_over_pairs)
{
  for (int g = 0; g < 2; g++)
    for (int surface = 0; surface < 3; surface++)
      for (int damped = 0; damped < 3; damped++) {
        bw_solid_config c = cloudy((bw_pd_geometry)g);
        c.surface_correction = (bw_pd_surface_correction)surface;
        c.damping.pair = damped > 0 ? 0.2 : 0;
        check_force(c, damped == 2);
      }
}
END_TEST

/* Bonds that break: momenta stay, the book closes, as on a lattice (test_bond_break.c). */
static void burst(const double X0[3], double v[3])
{
  v[0] = 0.4 * (X0[0] - 1.5) + 0.02 * sin(9 * X0[1]);
  v[1] = 0.3 * (X0[1] - 1.25);
  v[2] = 0;
}

static void check_book(bool contact, double step, double tolerance)
{
  bw_solid_config c = cloudy(BW_PD_3D);
  c.G0 = 0.005;
  c.contact = contact;
  pd_body body = pd_box(6, 5, 4);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, burst);
  const double start = pd_energy(pd), dt = step * bw_solid_dt_max(pd);
  const bw_solid_ledger first = ledger_of(pd);
  pd_steps(pd, (int)(8 / step), dt);
  const bw_solid_ledger l = ledger_of(pd);
  ck_assert_int_gt(l.broken, 100);
  bw_check_near(pd_energy(pd) / start, 1, tolerance);
  for (int k = 0; k < 3; k++) {
    bw_check_near(l.momentum[k], first.momentum[k], 1e4 * BW_REAL_EPSILON);
    bw_check_near(l.angular[k], first.angular[k], 1e5 * BW_REAL_EPSILON);
  }
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

/* With contact too: neighbours that start nearer than ds must not gain its energy when they part,
 * which is 15 times that of a bond and would be above the kinetic energy here. */
START_TEST(books_close_when_it_bursts)
{
  check_book(false, 0.02, 1e-3);
  check_book(true, 0.02, 1e-3);
}
END_TEST

/* A linear deformation is its own gradient in any family, and the mean stress of many particles
 * that of the family sum: here of the ensemble, within its scatter. */
static void shear(const double X0[3], double u[3])
{
  u[0] = 1e-3 * X0[0] + 2e-3 * X0[1];
  u[1] = -5e-4 * X0[0];
  u[2] = 7e-4 * X0[2];
}

START_TEST(linear_deformations_are_exact)
{
  bw_solid_config c = cloudy(BW_PD_3D);
  pd_body body = pd_box(8, 7, 6);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const size_t n = bw_solid_count(pd);
  const double G[9] = {1 + 1e-3, 2e-3, 0, -5e-4, 1, 0, 0, 0, 1 + 7e-4};
  double *F = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 9 * n));
  pd_set(pd, shear, NULL);
  bw_solid_stress_compute(pd, F, NULL);
  for (size_t q = 0; q < 9 * n; q++)
    bw_check_near(F[q], G[q % 9], 200 * BW_REAL_EPSILON);
  bw_release(&F);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* A held bar under a small end load: relaxation and linear solve agree to the strain. */
START_TEST(both_static_solvers_agree)
{
  if (BW_REAL_EPSILON > 1e-10) return; /* the tolerance drowns in single precision */
  bw_solid_config c = cloudy(BW_PD_PLANE_STRESS);
  pd_body body = pd_box(16, 6, 1);
  for (int64_t q = 0; q < body.n; q++)
    if (body.site[3 * q] < 3) body.kind[q] = BW_PD_PRESCRIBED;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const size_t n = bw_solid_count(pd);
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  double *F = NULL, *U = NULL, *X = NULL, *X0 = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * n));
  bw_check_ok(BW_ALLOCATE(&U, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  for (size_t i = 0; i < n; i++)
    F[3 * i] = bw_solid_id(pd)[i] % 16 > 12 ? 1e-6 : 0;
  bw_solid_set_force(pd, F);
  how.tolerance = 1e-9;
  bw_check_ok(bw_solid_static_linear(pd, &how, U, &report));
  bw_check_ok(bw_solid_static_relax(pd, &how, &report));
  bw_solid_get_position(pd, X);
  bw_solid_get_reference(pd, X0);
  double most[2] = {0};
  for (size_t q = 0; q < 3 * n; q++) {
    most[0] = fmax(most[0], fabs(U[q]));
    most[1] = fmax(most[1], fabs(X[q] - X0[q] - U[q]));
  }
  bw_comm_max(bw_check_world(), 2, most);
  ck_assert_double_gt(most[0], 1e-7);
  ck_assert_double_le(most[1], 1e-5 * most[0]); /* strains are below 1e-5 */
  bw_release(&F);
  bw_release(&U);
  bw_release(&X);
  bw_release(&X0);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(forces_are_the_sum_over_pairs), BW_TEST(books_close_when_it_bursts),
    BW_TEST(linear_deformations_are_exact), BW_TEST(both_static_solvers_agree)};
BW_CHECK_MAIN("pd_bond.cloud_force", tests)
