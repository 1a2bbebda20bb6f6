/* States at rest: relaxation, conjugate gradients and a dense solve agree; loads add up.
 * BUILD modules=solid_tools libs=gsl
 * TEST  ranks=1,2,3 */
#include "bw_solid_load.h"
#include "bw_solid_static.h"
#include "pd_test.h"

#include <gsl/gsl_linalg.h>

enum { NX = 7, NY = 3, NZ = 3 };

/* A block held at x = 0 and pulled and sheared at its other end. */
static bw_solid *block(bw_pd_surface_correction surface, double strain, double F[])
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.surface_correction = surface;
  c.horizon_ratio = 2;
  pd_body box = pd_box(NX, NY, NZ);
  for (int64_t q = 0; q < box.n; q++)
    if (box.site[3 * q] == 0) box.kind[q] = BW_PD_PRESCRIBED;
  bw_solid *pd = pd_make(bw_check_world(), &c, &box);
  const double traction[3] = {c.E * strain, 0.2 * c.E * strain, 0};
  for (size_t q = 0; q < 3 * bw_solid_count(pd); q++)
    F[q] = 0;
  bw_check_ok(
      bw_solid_load_traction(pd, (double[3]){3, -9, -9}, (double[3]){9, 9, 9}, 2.25, traction, F));
  bw_solid_set_force(pd, F);
  pd_body_release(&box);
  return pd;
}

/* K assembled by global id from what everybody sees: the links. No correction.
 * Solved dense by GSL. One rank. */
static void dense(bw_solid *pd, const double F[], double U[])
{
  const size_t n = bw_solid_count(pd);
  const double c0 = bw_solid_micromodulus(pd), dv = bw_solid_volume(pd);
  gsl_matrix *K = gsl_matrix_calloc(3 * n, 3 * n);
  gsl_vector *b = gsl_vector_calloc(3 * n), *x = gsl_vector_calloc(3 * n);
  bw_pd_link link[400];
  for (size_t h = 0; h < n; h++) {
    const bool held = (bw_solid_kind(pd)[h] & BW_PD_PRESCRIBED) != 0;
    for (size_t k = 0; k < 3; k++) {
      gsl_vector_set(b, 3 * h + k, held ? 0 : F[3 * h + k]);
      if (held) gsl_matrix_set(K, 3 * h + k, 3 * h + k, 1);
    }
    const int bonds = held ? 0 : bw_solid_links(pd, h, link);
    for (int q = 0; q < bonds; q++) {
      const double *xi = bw_solid_stencil_offset(pd, link[q].slot);
      const double r = sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
      const double k = c0 * bw_solid_stencil_fraction(pd, link[q].slot) * dv / (r * r * r);
      for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++) {
          *gsl_matrix_ptr(K, 3 * h + i, 3 * h + j) += k * xi[i] * xi[j];
          *gsl_matrix_ptr(K, 3 * h + i, 3 * (size_t)link[q].neighbour + j) -= k * xi[i] * xi[j];
        }
    }
  }
  int sign;
  gsl_permutation *order = gsl_permutation_alloc(3 * n);
  gsl_linalg_LU_decomp(K, order, &sign);
  gsl_linalg_LU_solve(K, order, b, x);
  for (size_t q = 0; q < 3 * n; q++)
    U[q] = gsl_vector_get(x, q);
  gsl_permutation_free(order);
  gsl_matrix_free(K);
  gsl_vector_free(b);
  gsl_vector_free(x);
}

static double largest_difference(const double a[], const double b[], size_t n, double *largest)
{
  double d = 0;
  *largest = 0;
  for (size_t q = 0; q < n; q++) {
    d = fmax(d, fabs(a[q] - b[q]));
    *largest = fmax(*largest, fabs(b[q]));
  }
  return d;
}

/* No correction: dense needs no alpha. The condition number of this block is below 1e4, so a
 * residual of 1e-11 leaves an error below 1e-7. */
START_TEST(conjugate_gradients_agree_with_a_dense_solve)
{
  if (bw_comm_size(bw_check_world()) > 1 || BW_REAL_EPSILON > 1e-10) return; /* serial, double */
  enum { N = 3 * NX * NY * NZ };
  double F[N], U[N] = {0}, want[N], size;
  bw_solid *pd = block(BW_PD_SURFACE_NONE, 1e-3, F);
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = 1e-11;
  bw_check_ok(bw_solid_static_linear(pd, &config, U, &report));
  dense(pd, F, want);
  ck_assert_double_lt(largest_difference(U, want, N, &size), 1e-7 * size);
  ck_assert_double_gt(size, 1e-4);
  bw_solid_destroy(&pd);
}
END_TEST

/* The relaxed state is nonlinear: it leaves the linear one by a part of the order of the strain,
 * 1e-6 here with rotations some ten times as large. In every correction, on any number of ranks. */
START_TEST(relaxation_agrees_with_conjugate_gradients)
{
  enum { N = 3 * NX * NY * NZ };
  const double strain = BW_REAL_EPSILON > 1e-10 ? 1e-2 : 1e-6;
  for (int surface = 0; surface < 3; surface++) {
    double F[N], U[N] = {0}, X[N], X0[N], size[2] = {0};
    bw_solid *pd = block((bw_pd_surface_correction)surface, strain, F);
    bw_solid_static_config config = bw_solid_static_config_default();
    bw_solid_static_report report;
    config.tolerance = BW_REAL_EPSILON > 1e-10 ? 1e-3 : 1e-8;
    bw_check_ok(bw_solid_static_linear(pd, &config, U, &report));
    ck_assert_double_le(report.residual, config.tolerance);
    bw_check_ok(bw_solid_static_relax(pd, &config, &report));
    ck_assert_double_le(report.residual, config.tolerance);
    ck_assert_int_gt(report.iterations, 10);
    bw_solid_get_position(pd, X);
    bw_solid_get_reference(pd, X0);
    for (size_t q = 0; q < 3 * bw_solid_count(pd); q++) {
      size[0] = fmax(size[0], fabs(X[q] - X0[q] - U[q]));
      size[1] = fmax(size[1], fabs(U[q]));
    }
    bw_comm_max(bw_check_world(), 2, size);
    ck_assert_double_lt(size[0], 100 * strain * size[1]);
    bw_solid_destroy(&pd);
  }
}
END_TEST

/* Stretched and let go, with nothing that loads or holds it: the stretch goes, whatever the units
 * of its stiffness. What is left of the force is measured by where it began. */
START_TEST(a_free_body_loses_its_stretch)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.horizon_ratio = 2;
  c.E *= 1e-12;
  pd_body box = pd_box(NX, NY, NZ);
  bw_solid *pd = pd_make(bw_check_world(), &c, &box);
  double U[3 * NX * NY * NZ] = {0}, X[3 * NX * NY * NZ], last[2] = {-1, -1};
  bw_solid_get_reference(pd, X);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    U[3 * i] = 1e-2 * X[3 * i];
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = BW_REAL_EPSILON > 1e-10 ? 1e-3 : 1e-8;
  bw_check_ok(bw_solid_static_linear(pd, &config, U, &report));
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    last[0] = fmax(last[0], U[3 * i]), last[1] = fmax(last[1], -U[3 * i]);
  bw_comm_max(bw_check_world(), 2, last);
  /* It was 1e-2 of the length; the smallest eigenvalue is a few hundredths of the largest. */
  ck_assert_double_lt(last[0] + last[1], 1e2 * config.tolerance * 1e-2 * NX * c.ds);
  bw_solid_destroy(&pd);
  pd_body_release(&box);
}
END_TEST

/* Stretched by its ends beyond s0 the block breaks in two and ends without stress. */
START_TEST(relaxation_breaks_what_is_beyond)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.horizon_ratio = 2;
  pd_body box = pd_box(12, 3, 3);
  for (int64_t q = 0; q < box.n; q++)
    if (box.site[3 * q] < 2 || box.site[3 * q] > 9)
      box.kind[q] = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE;
  bw_solid *pd = pd_make(bw_check_world(), &c, &box);
  double X[3 * 108], V[3 * 108] = {0};
  bw_solid_get_reference(pd, X);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    X[3 * i] += X[3 * i] > 3 ? 0.05 : 0;
  bw_solid_set_state(pd, X, V);
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = BW_REAL_EPSILON > 1e-10 ? 1e-3 : 1e-6;
  config.breaks = true;
  bw_check_ok(bw_solid_static_relax(pd, &config, &report));
  ck_assert_int_eq(report.broken, 0);
  const double elastic = ledger_of(pd).elastic;
  bw_check_ok(
      bw_solid_set_G0(pd, 1e-6)); /* s0 = sqrt(5 G0/(6 E delta)) = 5e-4; the strain is near 1e-2 */
  const bw_status st = bw_solid_static_relax(pd, &config, &report);
  ck_assert_msg(st == BW_OK, "%s", bw_last_message());
  ck_assert_int_gt(report.broken, 20);
  ck_assert_double_lt(ledger_of(pd).elastic, 1e-3 * elastic);
  ck_assert_double_gt(ledger_of(pd).fracture, 0);
  bw_solid_destroy(&pd);
  pd_body_release(&box);
}
END_TEST

START_TEST(impossible_requests_are_refused)
{
  enum { N = 3 * NX * NY * NZ };
  double F[N], U[N] = {0};
  bw_solid_static_report report;
  bw_solid *pd = block(BW_PD_SURFACE_VOLUME, 1e-3, F);
  bw_solid_static_config config = bw_solid_static_config_default();
  config.max_iterations = 3;
  bw_check_status(bw_solid_static_relax(pd, &config, &report), BW_EDIVERGED);
  bw_check_status(bw_solid_static_linear(pd, &config, U, &report), BW_EDIVERGED);
  config.tolerance = 0;
  bw_check_status(bw_solid_static_relax(pd, &config, &report), BW_EINPUT);
  const double box[2][3] = {{90, 90, 90}, {99, 99, 99}}, pull[3] = {1, 0, 0};
  bw_check_status(bw_solid_load_traction(pd, box[0], box[1], 1, pull, F), BW_EINPUT);
  bw_check_status(bw_solid_load_traction(pd, (double[3]){-9, -9, -9}, box[1], 0, pull, F),
                  BW_EINPUT);
  bw_solid_destroy(&pd);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(conjugate_gradients_agree_with_a_dense_solve),
    BW_TEST(relaxation_agrees_with_conjugate_gradients), BW_TEST(a_free_body_loses_its_stretch),
    BW_TEST(relaxation_breaks_what_is_beyond), BW_TEST(impossible_requests_are_refused)};
BW_CHECK_MAIN("pd_bond.static", tests)
