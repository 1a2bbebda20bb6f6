/* Factors of bonds that go on when levels change.
 * TEST ranks=1,3 */
#include "bw_solid_levels.h"
#include "levels_test.h"

/* Forces of three uniform strains, row after row; the plate's number of particles. */
static size_t strained(bw_solid *pd, double **A)
{
  const size_t n = bw_solid_count(pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(A, 9 * n));
  for (size_t e = 0; e < 3; e++) {
    bw_solid_get_reference(pd, X);
    for (size_t i = 0; i < n; i++) {
      const double x = X[3 * i], y = X[3 * i + 1];
      X[3 * i] += 1e-4 * (e == 0 ? x : e == 2 ? y : 0);
      X[3 * i + 1] += 1e-4 * (e == 1 ? y : e == 2 ? x : 0);
    }
    bw_solid_set_state(pd, X, V);
    bw_check_ok(bw_solid_evaluate(pd));
    bw_solid_get_acceleration(pd, *A + 3 * n * e);
  }
  bw_release(&X);
  bw_release(&V);
  return n;
}

/* What factors that went on over a change leave of a uniform strain is what a body made for those
 * levels leaves, inside, where faces are not felt: to a thousandth of E strain over the horizon. */
START_TEST(factors_go_on)
{
  enum { SIDE = 48 };
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS);
  c.finer.refine.level = 1;
  c.ds = 1, c.E = 1, c.rho = 1, c.horizon_ratio = 3;
  c.surface_correction = BW_PD_SURFACE_TENSOR;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  pd_body body = pd_box(SIDE, SIDE, 1);
  bw_solid *walked = pd_make(bw_check_world(), &c, &body);
  bw_solid *made = pd_make(bw_check_world(), &c, &body);
  const bw_pd_box here = {1, {12, 12, 0}, {26, 30, 1}}, there = {1, {20, -1, 0}, {33, 30, 1}};
  bw_check_ok(bw_solid_regrid(walked, 1, &here));
  bw_check_ok(bw_solid_regrid(walked, 1, &there));
  bw_check_ok(bw_solid_regrid(made, 1, &there));
  double *A = NULL, *B = NULL, *X0 = NULL, worst = 0, most = 0;
  const size_t n = strained(walked, &A);
  ck_assert_int_eq((int64_t)strained(made, &B), (int64_t)n);
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_solid_get_reference(walked, X0);
  for (size_t i = 0; i < n; i++) {
    const double *x = X0 + 3 * i;
    const double edge = fmin(fmin(x[0], SIDE - x[0]), fmin(x[1], SIDE - x[1]));
    for (size_t q = 0; q < 9; q++) {
      const size_t at = 3 * n * (q / 3) + 3 * i + q % 3;
      most = fmax(most, fabs(A[at]));
      if (edge > 16) worst = fmax(worst, fabs(A[at] - B[at]));
    }
  }
  bw_comm_max(bw_check_world(), 1, &worst);
  bw_comm_max(bw_check_world(), 1, &most);
  ck_assert_double_gt(most, 1e-4 / 3); /* of faces, which nothing pulls */
  ck_assert_msg(worst < 1e-3 * 1e-4 / 3, "%g of E strain/horizon", worst / (1e-4 / 3));
  double *all[] = {A, B, X0};
  for (size_t q = 0; q < 3; q++)
    bw_release(&all[q]);
  bw_solid_destroy(&walked);
  bw_solid_destroy(&made);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(factors_go_on)};
BW_CHECK_MAIN("solid.levels_factors", tests)
