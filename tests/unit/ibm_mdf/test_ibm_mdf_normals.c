/* Markers that know their side: the law of a flat sheet in closed form, what is refused.
 * TEST ranks=1,2,3,4 */
#include "ibm_fixture.h"

#include <string.h>

static const double DT = 0.02, NU = 0.7;
static const double WANTED[3] = {1.0, 0.5, -0.25}, REMEMBERED[3] = {0.3, -0.2, 0.1};

/* The plane y = 5.3 h, one marker for each cell of it, with memory REMEMBERED dV. */
static void make_sheet(fixture *f, double **N, double **M)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  const bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  fixture_make(f, comm, &(fixture_case){{10, 12, 10}, true, config.kernel, 1}, 100, 0.0);
  bw_ibm_mdf_destroy(&f->ib);
  bw_check_ok(bw_ibm_mdf_create(f->grid, &config, &f->ib));
  bw_check_ok(BW_ALLOCATE(N, 3 * f->n));
  bw_check_ok(BW_ALLOCATE(M, 3 * f->n));
  for (size_t m = 0; m < f->n; m++) {
    const int q = me + (int)m * size;
    f->X[3 * m] = (q % 10 + 0.3) * f->g->spacing[0];
    f->X[3 * m + 1] = 5.3 * f->g->spacing[1];
    f->X[3 * m + 2] = (q / 10 + 0.1) * f->g->spacing[2];
    f->dV[m] = cell_volume(f);
    (*N)[3 * m + 1] = 1.0;
    for (size_t c = 0; c < 3; c++) {
      f->V[3 * m + c] = WANTED[c];
      (*M)[3 * m + c] = REMEMBERED[c] * f->dV[m];
    }
  }
  bw_check_ok(bw_ibm_mdf_set_markers(f->ib, f->n, f->X, f->V, f->dV, *M));
}

/* One call. What memory brings, gamma_0 M, moves a uniform sheet by 1/2 dt gamma_0 M. The force of
 * the step then is M if all goes on like that; what is missing along the sheet is V - U - c h^2/nu
 * M, of which dQ dt is 1/(1 + c h^2/(nu dt)); across it V - U, all of it. c = 0.266 for a sheet
 * along the grid. */
START_TEST(a_flat_sheet_has_a_closed_form)
{
  for (int known = 0; known < 2; known++) {
    fixture f;
    double *N = NULL, *M = NULL, *Q = NULL;
    make_sheet(&f, &N, &M);
    bw_check_ok(BW_ALLOCATE(&Q, 3 * f.n));
    const double along = 0.266 * pow(cell_volume(&f), 2.0 / 3.0) / NU, gamma = 8.0 / 15.0;
    for (size_t m = 0; m < f.n && !known; m++)
      N[3 * m] = NAN; /* no normal: forced as ever */
    bw_check_ok(bw_ibm_mdf_set_normals(f.ib, N, NU));
    bw_ibm_mdf_force(f.ib, f.u, DT);
    bw_ibm_mdf_marker_force(f.ib, Q);
    for (size_t i = 0; i < 3 * f.n; i++) {
      const size_t c = i % 3;
      const double slip = known && c != 1 ? along : 0.0;
      const double lack = WANTED[c] - (0.5 * DT * gamma + slip) * REMEMBERED[c];
      const double want = gamma * REMEMBERED[c] + lack / (DT + slip);
      bw_check_near(Q[i] / cell_volume(&f), want, 1e5 * BW_REAL_EPSILON);
    }
    bw_release(&N);
    bw_release(&M);
    bw_release(&Q);
    fixture_free(&f);
  }
}
END_TEST

/* In a steady state memory is the force, and the law holds for the whole of it: no lack is left
 * when V = U + c h^2/nu M. */
START_TEST(the_report_measures_the_law)
{
  fixture f;
  double *N = NULL, *M = NULL;
  make_sheet(&f, &N, &M);
  bw_check_ok(bw_ibm_mdf_set_normals(f.ib, N, NU));
  const bw_ibm_mdf_report bare = bw_ibm_mdf_measure(f.ib, f.u);
  const double along = 0.266 * pow(cell_volume(&f), 2.0 / 3.0) / NU, rest = 7.0 / 15.0;
  double slip = 0.0;
  for (size_t c = 0; c < 3; c++)
    slip += pow(WANTED[c] - (c == 1 ? 0.0 : rest * along * REMEMBERED[c]), 2);
  bw_check_near(bare.slip_after, sqrt(slip), 100.0 * BW_REAL_EPSILON);
  bw_release(&N);
  bw_release(&M);
  fixture_free(&f);
}
END_TEST

START_TEST(bad_normals_are_refused)
{
  fixture f;
  double *N = NULL, *M = NULL;
  make_sheet(&f, &N, &M);
  bw_check_status(bw_ibm_mdf_set_normals(f.ib, N, 0.0), BW_EINPUT);
  bw_check_status(bw_ibm_mdf_set_normals(f.ib, N, NAN), BW_EINPUT);
  if (bw_comm_rank(bw_check_world()) == 0) N[1] = 0.9; /* one bad value on one rank, all refuse */
  bw_check_status(bw_ibm_mdf_set_normals(f.ib, N, NU), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "normal"));
  if (bw_comm_rank(bw_check_world()) == 0) N[1] = 1.0;
  bw_ibm_mdf_destroy(&f.ib);
  const bw_ibm_mdf_config plain = {.kernel = BW_KERNEL_ROMA3, .n_iter = 2};
  bw_check_ok(bw_ibm_mdf_create(f.grid, &plain, &f.ib));
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
  bw_check_status(bw_ibm_mdf_set_normals(f.ib, N, NU), BW_EINPUT);
  bw_release(&N);
  bw_release(&M);
  fixture_free(&f);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_flat_sheet_has_a_closed_form),
                                      BW_TEST(the_report_measures_the_law),
                                      BW_TEST(bad_normals_are_refused)};
BW_CHECK_MAIN("ibm_mdf.normals", tests)
