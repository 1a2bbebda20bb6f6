/* What goes from the particles of a cell to those of another level: identity, linear fields.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_pd_levels.h"

#include <stdlib.h>

static const double AXES[3][3] = {{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}};

static double any(void)
{
  return 2.0 * rand() / RAND_MAX - 1;
}

static bw_pd_levels_rider any_rider(void)
{
  bw_pd_levels_rider r = {.kind = BW_PD_UNBREAKABLE};
  for (int q = 0; q < 3 * BW_PD_LEVELS_VECTORS; q++)
    r.f[q / 3][q % 3] = any();
  for (int q = 0; q < 18; q++)
    r.G[q / 9][q % 9] = any();
  return r;
}

/* Finer and back gives what there was, whatever the gradients: so momentum stays, too. */
START_TEST(refine_and_coarsen_is_the_identity)
{
  bw_pd_levels_rider had[8], fine[512], back[8];
  for (int way = 0; way < 6; way++) {
    const int dimension = 2 + way % 2, from = way / 2 == 2, to = 1 + way / 2;
    const int n = 1 << (dimension * from);
    for (int q = 0; q < n; q++)
      had[q] = any_rider();
    bw_pd_levels_recast(dimension, 0.3, AXES, from, to, had, fine);
    bw_pd_levels_recast(dimension, 0.3, AXES, to, from, fine, back);
    for (int q = 0; q < n; q++) {
      for (int k = 0; k < 3 * BW_PD_LEVELS_VECTORS; k++)
        bw_check_near(back[q].f[k / 3][k % 3], had[q].f[k / 3][k % 3], 1e-14);
      ck_assert_int_eq(back[q].kind, BW_PD_UNBREAKABLE);
    }
  }
}
END_TEST

/* A linear field is met exactly: parts are where the lattice has them. */
START_TEST(linear_fields_are_kept)
{
  bw_pd_levels_rider one = any_rider(), part[64];
  bw_pd_levels_recast(3, 1, AXES, 0, 2, &one, part);
  for (int q = 0; q < 64; q++) {
    double x[3] = {0};
    for (int k = 0; k < 3; k++) {
      /* Along axis k: the first split by a quarter, the second by an eighth. */
      const double at = (q >> (3 + k) & 1 ? 0.25 : -0.25) + (q >> k & 1 ? 0.125 : -0.125);
      for (int d = 0; d < 3; d++)
        x[d] += at * AXES[k][d];
    }
    for (int v = 0; v < 2; v++)
      for (int k = 0; k < 3; k++)
        bw_check_near(part[q].f[v][k],
                      one.f[v][k] + one.G[v][3 * k] * x[0] + one.G[v][3 * k + 1] * x[1] +
                          one.G[v][3 * k + 2] * x[2],
                      1e-14);
  }
}
END_TEST

START_TEST(gradients_of_linear_fields_are_exact)
{
  double xi[60], df[60], weight[20], G[9], A[9];
  for (int dimension = 2; dimension <= 3; dimension++) {
    for (int q = 0; q < 9; q++)
      A[q] = q / 3 < dimension && q % 3 < dimension ? any() : 0;
    for (int q = 0; q < 20; q++) {
      weight[q] = 1 + 0.5 * any();
      for (int k = 0; k < 3; k++)
        xi[3 * q + k] = k < dimension ? any() : 0;
      for (int k = 0; k < 3; k++)
        df[3 * q + k] =
            A[3 * k] * xi[3 * q] + A[3 * k + 1] * xi[3 * q + 1] + A[3 * k + 2] * xi[3 * q + 2];
    }
    bw_pd_levels_gradient(dimension, 20, weight, xi, df, G);
    for (int q = 0; q < 9; q++)
      bw_check_near(G[q], A[q], 1e-12);
    /* Neighbours on a line do not tell it: none is assumed. */
    for (int q = 0; q < 60; q++)
      xi[q] = q % 3 < dimension ? q / 3 * 0.1 : 0;
    bw_pd_levels_gradient(dimension, 20, weight, xi, df, G);
    for (int q = 0; q < 9; q++)
      ck_assert_double_eq(G[q], 0);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(refine_and_coarsen_is_the_identity),
                                      BW_TEST(linear_fields_are_kept),
                                      BW_TEST(gradients_of_linear_fields_are_exact)};
BW_CHECK_MAIN("solid.transfer", tests)
