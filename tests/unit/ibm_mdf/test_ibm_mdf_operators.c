/* Interpolation and spreading: exact on constants and linear fields, adjoint, conservative.
 * TEST ranks=1,2,3,4 */
#include "ibm_fixture.h"

static const fixture_case cases[] = {
    {{12, 16, 10}, true, BW_KERNEL_ROMA3, 1},   {{12, 16, 1}, true, BW_KERNEL_ROMA3, 1},
    {{12, 16, 10}, true, BW_KERNEL_PESKIN4, 1}, {{12, 16, 1}, true, BW_KERNEL_PESKIN4, 1},
    {{12, 16, 10}, true, BW_KERNEL_HAT2, 1},    {{12, 16, 1}, true, BW_KERNEL_HAT2, 1}};
enum { CASES = sizeof cases / sizeof *cases };

/* Sums of 97 x 64 terms of order one; a hundred units of round-off is generous, a missing or
 * doubled node is larger by twelve orders. */
static const double ROUND_OFF = 500.0 * BW_REAL_EPSILON;

static void zero(const fixture *f, bw_real *u[3])
{
  for (int c = 0; c < 3 && u[c] != NULL; c++)
    for (size_t q = 0; q < f->g->size; q++)
      u[c][q] = 0;
}

/* sum F.U(u) dV over markers = sum u.q h^3 over cells, q = spread F (ends of the box included:
 * markers are scattered over all of it, and two sit on the seam itself). */
START_TEST(interpolation_and_spreading_are_adjoint)
{
  const bw_comm *comm = bw_check_world();
  for (int t = 0; t < CASES; t++) {
    fixture f;
    bw_real *q[3] = {NULL, NULL, NULL};
    double *U = NULL, sum[3] = {0.0, 0.0, 0.0};
    fixture_make(&f, comm, &cases[t], FIX_MARKERS, 0.0);
    for (int d = 0; d < 3 && f.n > 1; d++) {
      f.X[d] = 0.0;
      f.X[3 + d] = f.g->length[d];
    }
    bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
    for (int c = 0; c < 3 && f.u[c] != NULL; c++)
      bw_check_ok(bw_field_create(f.grid, &q[c]));
    bw_check_ok(BW_ALLOCATE(&U, 3 * f.n));
    fill_scattered(&f, 1.0);
    zero(&f, q);
    bw_ibm_mdf_interpolate(f.ib, f.u, U);
    bw_ibm_mdf_spread(f.ib, f.F, q);
    for (size_t m = 0; m < f.n; m++)
      for (int c = 0; c < 3; c++) {
        sum[0] += f.F[3 * m + c] * U[3 * m + c] * f.dV[m];
        sum[2] += fabs(f.F[3 * m + c] * U[3 * m + c]) * f.dV[m];
      }
    sum[1] = sum_cells(&f, f.u, q, 0) * cell_volume(&f);
    bw_comm_sum(comm, 3, sum);
    ck_assert(sum[2] > 0.1);
    bw_check_near(sum[0] / sum[2], sum[1] / sum[2],
                  1.0e-13 + 10.0 * ROUND_OFF * (sizeof(bw_real) == 4));
    for (int c = 0; c < 3; c++)
      bw_release(&q[c]);
    bw_release(&U);
    fixture_free(&f);
  }
}
END_TEST

/* The force that arrives on the grid is the force that was spread, per component. */
START_TEST(spreading_keeps_the_total_force)
{
  const bw_comm *comm = bw_check_world();
  for (int t = 0; t < CASES; t++) {
    fixture f;
    fixture_make(&f, comm, &cases[t], FIX_MARKERS, 0.0);
    bw_ibm_mdf_spread(f.ib, f.F, f.u);
    for (int c = 0; c < 3 && f.u[c] != NULL; c++) {
      double sum[2] = {0.0, sum_cells(&f, f.u, NULL, c) * cell_volume(&f)};
      for (size_t m = 0; m < f.n; m++)
        sum[0] += f.F[3 * m + c] * f.dV[m];
      bw_comm_sum(comm, 2, sum);
      bw_check_near(sum[1], sum[0], ROUND_OFF);
    }
    fixture_free(&f);
  }
}
END_TEST

static double linear(int c, const double x[3], const fixture *f)
{
  static const double a[3][4] = {
      {0.3, 0.7, -0.2, 0.4}, {-0.5, 0.1, 0.9, -0.6}, {0.2, -0.8, 0.3, 0.5}};
  const double z = f->u[2] == NULL ? 0.0 : x[2];
  return a[c][0] + a[c][1] * x[0] + a[c][2] * x[1] + a[c][3] * z;
}

/* Zeroth and first moment, and that each marker gets its own answer: every value differs. */
START_TEST(linear_fields_are_exact_and_answers_find_their_markers)
{
  const bw_comm *comm = bw_check_world();
  for (int t = 0; t < CASES; t++) {
    fixture_case closed = cases[t];
    closed.periodic = false;
    fixture f;
    double *U = NULL;
    fixture_make(&f, comm, &closed, FIX_MARKERS, 0.0);
    bw_check_ok(BW_ALLOCATE(&U, 3 * f.n));
    fill_everywhere(&f, linear);
    bw_ibm_mdf_interpolate(f.ib, f.u, U);
    for (size_t m = 0; m < f.n; m++) {
      for (int c = 0; c < 3 && f.u[c] != NULL; c++)
        bw_check_near(U[3 * m + c], linear(c, f.X + 3 * m, &f), ROUND_OFF);
      if (f.u[2] == NULL) ck_assert_double_eq(U[3 * m + 2], 0.0);
    }
    bw_release(&U);
    fixture_free(&f);
  }
}
END_TEST

static double unit(int c, const double x[3], const fixture *f)
{
  (void)x, (void)f;
  return 1.0 + c;
}

/* A marker on a wall: the part beyond it is lost, ghosts and wall faces stay as they are. */
START_TEST(nothing_is_written_beyond_walls)
{
  const bw_comm *comm = bw_check_world();
  for (int t = 0; t < CASES; t++) {
    fixture_case closed = cases[t];
    closed.periodic = false;
    fixture f;
    fixture_make(&f, comm, &closed, FIX_MARKERS, 0.0);
    for (size_t m = 0; m < f.n; m++) /* onto the six sides in turn */
      f.X[3 * m + m % 3] = m % 2 == 0 ? 0.0 : f.g->length[m % 3];
    bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
    fill_everywhere(&f, unit);
    bw_ibm_mdf_spread(f.ib, f.F, f.u);
    const bw_grid_view *g = f.g;
    double changed = 0.0;
    for (int c = 0; c < 3 && f.u[c] != NULL; c++)
      for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
        for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
          for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++) {
            const int at[3] = {i + g->lo[0], j + g->lo[1], k + g->lo[2]};
            bool boundary = false;
            for (int d = 0; d < (f.u[2] == NULL ? 2 : 3); d++)
              boundary |= at[d] < 1 || at[d] > g->n[d] - (c == d);
            const double difference = fabs((double)f.u[c][bw_at(g, i, j, k)] - (1.0 + c));
            if (boundary)
              ck_assert_double_eq(difference, 0.0);
            else
              changed = fmax(changed, difference);
          }
    bw_comm_max(comm, 1, &changed);
    ck_assert(changed > 0.05);
    fixture_free(&f);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(interpolation_and_spreading_are_adjoint), BW_TEST(spreading_keeps_the_total_force),
    BW_TEST(linear_fields_are_exact_and_answers_find_their_markers),
    BW_TEST(nothing_is_written_beyond_walls)};
BW_CHECK_MAIN("ibm_mdf.operators", tests)
