/* Surface correction `tensor`: bounds on any shape, opposite forces, the same on any ranks, an
 * energy, factors of the reference.
 * TEST ranks=1,2,3 */
#include "pd_bond.h"
#include "pd_test.h"

static bw_solid_config tensor(bw_pd_geometry geometry)
{
  bw_solid_config c = pd_soft(geometry);
  c.surface_correction = BW_PD_SURFACE_TENSOR;
  return c;
}

/* Least and largest factor of the bonds of all ranks; false where there is none. */
static bool span(const bw_solid *pd, double *least, double *most)
{
  const bw_pd_body *body = bw_solid_body(pd);
  const bw_pd_block *block = body->bonds.block;
  const bw_pd_slot *slot = body->bonds.slot;
  double found[2] = {-INFINITY, -INFINITY};
  for (size_t b = 0; b < body->bonds.n_block; b++)
    for (uint32_t q = block[b].slot; q < block[b + 1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        if (!(slot[q].family >> lane & 1)) continue;
        const double alpha = bw_pd_bond__alpha(body, &block[b], &slot[q], lane);
        found[0] = fmax(found[0], -alpha), found[1] = fmax(found[1], alpha);
      }
  bw_comm_max(bw_check_world(), 2, found);
  *least = -found[0], *most = found[1];
  return found[1] > 0;
}

/* A particle, a pair, a chain, a rod, sheets of one and two layers, a cube: all between 1/4 and 4.
 */
START_TEST(factors_are_bounded)
{
  static const int size[][3] = {{1, 1, 1}, {2, 1, 1}, {9, 1, 1}, {12, 2, 2},
                                {9, 9, 1}, {9, 9, 2}, {9, 9, 9}};
  for (int g = 0; g < 2; g++)
    for (size_t q = 0; q < sizeof size / sizeof *size; q++) {
      if (g == 1 && size[q][2] > 1) continue;
      const bw_solid_config c = tensor(g == 0 ? BW_PD_3D : BW_PD_PLANE_STRESS);
      pd_body body = pd_box(size[q][0], size[q][1], size[q][2]);
      bw_solid *pd = pd_make(bw_check_world(), &c, &body);
      double least, most;
      const bool any = span(pd, &least, &most);
      ck_assert_int_eq(any, size[q][0] > 1);
      if (any) ck_assert(least > 0.2499 && most < 4);
      ck_assert(bw_solid_dt_max(pd) > 0);
      bw_solid_destroy(&pd);
      pd_body_release(&body);
    }
}
END_TEST

static void pulled(const double X0[3], double u[3])
{
  u[0] = 1e-6 * X0[0], u[1] = -1e-6 / 3 * X0[1];
}

/* Largest acceleration of the middle of a strip in uniaxial stress along it. */
static double unrest(bw_pd_surface_correction surface)
{
  bw_solid_config c = tensor(BW_PD_PLANE_STRESS);
  c.surface_correction = surface;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  pd_body body = pd_box(40, 10, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const size_t n = bw_solid_count(pd);
  double *X = NULL, *A = NULL, worst = 0;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&A, 3 * n));
  pd_set(pd, pulled, NULL);
  bw_check_ok(bw_solid_step(pd, 1e-6 * bw_solid_dt_max(pd)));
  bw_solid_get_reference(pd, X);
  bw_solid_get_acceleration(pd, A);
  for (size_t i = 0; i < n; i++)
    if (fabs(X[3 * i] / c.ds - 20) < 4) worst = fmax(worst, hypot(A[3 * i], A[3 * i + 1]));
  bw_comm_max(bw_check_world(), 1, &worst);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  bw_release(&X);
  bw_release(&A);
  return worst;
}

/* The strain that elasticity gives a free strip is one of rest, up to what 60 sweeps leave (1 to
 * 2 % of a family's moments, where half a family lacks 10 to 20 %). */
START_TEST(uniform_stress_is_at_rest)
{
  if (BW_REAL_EPSILON > 1e-10) return; /* a strain of 1e-6 */
  ck_assert_double_lt(unrest(BW_PD_SURFACE_TENSOR), 0.2 * unrest(BW_PD_SURFACE_NONE));
}
END_TEST

static void skew(const double X0[3], double u[3])
{
  u[0] = 1e-3 * X0[1] * X0[1] + 2e-3 * X0[2], u[1] = -1e-3 * X0[0] * X0[2], u[2] = 1e-3 * X0[1];
}

/* Forces are opposite and central: momentum stays, and the energy book closes. */
START_TEST(momentum_stays)
{
  const bw_solid_config c = tensor(BW_PD_3D);
  pd_body body = pd_box(7, 6, 5);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, skew, NULL);
  const bw_solid_ledger before = ledger_of(pd);
  for (int q = 0; q < 50; q++)
    bw_check_ok(bw_solid_step(pd, 0.5 * bw_solid_dt_max(pd)));
  const bw_solid_ledger after = ledger_of(pd);
  const double size = sqrt(2 * before.elastic * c.rho * 0.125 * (double)body.n);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_lt(fabs(after.momentum[k]), 1e3 * BW_REAL_EPSILON * size);
    ck_assert_double_lt(fabs(after.angular[k]), 1e3 * BW_REAL_EPSILON * size * 3);
  }
  bw_check_near((after.kinetic + after.elastic) / before.elastic, 1, 0.02);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Factors are those of the reference: a precrack does not change the ones that remain. */
START_TEST(broken_bonds_change_no_factor)
{
  const bw_solid_config c = tensor(BW_PD_PLANE_STRAIN);
  pd_body body = pd_box(12, 10, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  double before[2], after[2];
  ck_assert(span(pd, &before[0], &before[1]));
  bw_check_ok(bw_solid_precrack(pd, (double[3]){3, 0, 0}, (double[3]){3, 5, 0}, NULL));
  ck_assert(span(pd, &after[0], &after[1]));
  ck_assert(before[0] == after[0] && before[1] == after[1]);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

START_TEST(a_cloud_is_refused)
{
  bw_solid_config c = tensor(BW_PD_3D);
  c.disorder = 0.2;
  pd_body body = pd_box(2, 2, 2);
  bw_solid *pd = NULL;
  ck_assert_int_eq(bw_solid_create_same(bw_check_world(), &c, body.n, body.site, body.kind, &pd),
                   BW_EINPUT);
  ck_assert_ptr_null(pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(factors_are_bounded), BW_TEST(uniform_stress_is_at_rest), BW_TEST(momentum_stays),
    BW_TEST(broken_bonds_change_no_factor), BW_TEST(a_cloud_is_refused)};
BW_CHECK_MAIN("pd_bond.tensor", tests)
