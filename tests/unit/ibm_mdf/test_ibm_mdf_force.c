/* Multi-direct forcing: closed form of one marker, momentum, convergence, independence of ranks.
 * TEST ranks=1,2,3,4 */
#include "ibm_fixture.h"

#include <stdlib.h>
#include <string.h>

static const double DT = 0.02;

/* One marker, fluid at rest: U = V dV/h^3 prod_d sum phi^2 for any position; sum phi^2 = 1/2 for
 * Roma's kernel, 3/8 for Peskin's. Every further iteration removes that share of the slip again,
 * and Q dV is what was needed for it. */
START_TEST(one_marker_has_a_closed_form)
{
  static const fixture_case cases[] = {{{8, 8, 8}, true, BW_KERNEL_ROMA3, 1},
                                       {{8, 8, 1}, true, BW_KERNEL_ROMA3, 1},
                                       {{8, 8, 8}, true, BW_KERNEL_ROMA3, 3},
                                       {{8, 8, 8}, true, BW_KERNEL_PESKIN4, 2}};
  for (int t = 0; t < 4; t++) {
    const bool flat = cases[t].n[2] == 1;
    const double C = bw_kernel_delta_get(cases[t].kernel)->sum_of_squares;
    fixture f;
    double U[3], QdV[3];
    fixture_make(&f, bw_check_world(), &cases[t], 1, 0.0);
    bw_ibm_mdf_force(f.ib, f.u, DT);
    double *none = NULL;
    bw_check_ok(BW_ALLOCATE(&none, 1));
    bw_ibm_mdf_interpolate(f.ib, f.u, f.n > 0 ? U : none);
    bw_ibm_mdf_marker_force(f.ib, f.n > 0 ? QdV : none);
    const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
    for (int c = 0; c < (flat ? 2 : 3) && f.n > 0; c++) {
      const double share = f.dV[0] / cell_volume(&f) * pow(C, flat ? 2.0 : 3.0);
      const double left = pow(1.0 - share, cases[t].n_iter);
      bw_check_near(U[c], f.V[c] * (1.0 - left), 50.0 * BW_REAL_EPSILON);
      bw_check_near(QdV[c] * DT / cell_volume(&f), f.V[c] * (1.0 - left) / pow(C, flat ? 2.0 : 3.0),
                    200.0 * BW_REAL_EPSILON);
    }
    ck_assert_int_eq(r.markers, 1);
    ck_assert(r.slip_after < r.slip_before);
    bw_release(&none);
    fixture_free(&f);
  }
}
END_TEST

/* dt sum QdV over markers, iterations and calls = change of momentum of the fluid. */
START_TEST(momentum_given_is_momentum_received)
{
  const bw_comm *comm = bw_check_world();
  const fixture_case c = {{12, 10, 8}, true, BW_KERNEL_ROMA3, 3};
  fixture f;
  fixture_make(&f, comm, &c, FIX_MARKERS, 0.0);
  fill_scattered(&f, 1.0);
  double before[3], after[3], force[3] = {0.0, 0.0, 0.0}, *QdV = NULL;
  bw_check_ok(BW_ALLOCATE(&QdV, 3 * f.n));
  bw_ibm_mdf_force(f.ib, f.u, DT); /* forgotten by begin_step */
  bw_ibm_mdf_begin_step(f.ib);
  for (int d = 0; d < 3; d++)
    before[d] = sum_cells(&f, f.u, NULL, d) * cell_volume(&f);
  bw_ibm_mdf_force(f.ib, f.u, DT);
  bw_ibm_mdf_force(f.ib, f.u, DT);
  for (int d = 0; d < 3; d++)
    after[d] = sum_cells(&f, f.u, NULL, d) * cell_volume(&f);
  bw_ibm_mdf_marker_force(f.ib, QdV);
  for (size_t m = 0; m < f.n; m++)
    for (int d = 0; d < 3; d++)
      force[d] += QdV[3 * m + d];
  bw_comm_sum(comm, 3, before);
  bw_comm_sum(comm, 3, after);
  bw_comm_sum(comm, 3, force);
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
  for (int d = 0; d < 3; d++) {
    ck_assert(fabs(force[d]) > 1.0e-3);
    bw_check_near(DT * force[d], after[d] - before[d], 500.0 * BW_REAL_EPSILON);
    bw_check_near(r.total_force[d], force[d], 500.0 * BW_REAL_EPSILON);
  }
  bw_release(&QdV);
  fixture_free(&f);
}
END_TEST

/* More iterations leave less slip on a sheet of markers one spacing apart. */
START_TEST(slip_falls_with_iterations)
{
  double last = HUGE_VAL;
  for (int n_iter = 1; n_iter <= 8; n_iter *= 2) {
    const fixture_case c = {{10, 12, 10}, true, BW_KERNEL_ROMA3, n_iter};
    fixture f;
    fixture_make(&f, bw_check_world(), &c, 100, 0.0);
    const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
    for (size_t m = 0; m < f.n; m++) { /* the plane y = 5.3 h */
      const int q = me + (int)m * size;
      f.X[3 * m] = (q % 10 + 0.3) * f.g->spacing[0];
      f.X[3 * m + 1] = 5.3 * f.g->spacing[1];
      f.X[3 * m + 2] = (q / 10 + 0.1) * f.g->spacing[2];
      f.dV[m] = cell_volume(&f);
      f.V[3 * m] = 1.0, f.V[3 * m + 1] = 0.5, f.V[3 * m + 2] = -0.25;
    }
    bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
    bw_ibm_mdf_force(f.ib, f.u, DT);
    const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
    /* a uniform sheet: kernels overlap to 1 in the plane, 1/2 remains across it, exactly */
    bw_check_near(r.slip_after / r.slip_before, pow(0.5, n_iter), 100.0 * BW_REAL_EPSILON);
    bw_check_near(r.spacing_min, 1.0, 1e-12);
    bw_check_near(r.spacing_max, 1.0, 1e-12);
    ck_assert(r.slip_after < last);
    last = r.slip_after;
    fixture_free(&f);
  }
}
END_TEST

/* All ranks together against this rank alone with every marker. */
START_TEST(the_answer_does_not_depend_on_ranks)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  static const fixture_case cases[] = {{{12, 10, 8}, true, BW_KERNEL_ROMA3, 3},
                                       {{12, 10, 1}, true, BW_KERNEL_PESKIN4, 3},
                                       {{12, 10, 8}, false, BW_KERNEL_ROMA3, 2}};
  for (int t = 0; t < 3; t++) {
    bw_comm *self = NULL;
    fixture all, one;
    double *QdV = NULL, *alone = NULL;
    bw_check_ok(bw_comm_self(&self));
    fixture_make(&all, comm, &cases[t], FIX_MARKERS, 0.0);
    fixture_make(&one, self, &cases[t], FIX_MARKERS, 0.0);
    bw_check_ok(BW_ALLOCATE(&QdV, 3 * all.n));
    bw_check_ok(BW_ALLOCATE(&alone, 3 * one.n));
    fill_scattered(&all, 1.0);
    fill_scattered(&one, 1.0);
    bw_ibm_mdf_force(all.ib, all.u, DT);
    bw_ibm_mdf_force(one.ib, one.u, DT);
    bw_ibm_mdf_marker_force(all.ib, QdV);
    bw_ibm_mdf_marker_force(one.ib, alone);
    for (size_t m = 0; m < all.n; m++)
      for (int c = 0; c < 3; c++) /* forces reach 1/dt */
        bw_check_near(QdV[3 * m + c] * DT, alone[3 * ((size_t)me + m * (size_t)size) + c] * DT,
                      100.0 * BW_REAL_EPSILON);
    for (int c = 0; c < 3 && all.u[c] != NULL; c++)
      for (int k = 1; k <= all.g->m[2]; k++)
        for (int j = 1; j <= all.g->m[1]; j++)
          for (int i = 1; i <= all.g->m[0]; i++)
            bw_check_near(all.u[c][bw_at(all.g, i, j, k)],
                          one.u[c][bw_at(one.g, i, j + all.g->lo[1], k + all.g->lo[2])],
                          100.0 * BW_REAL_EPSILON);
    bw_release(&QdV);
    bw_release(&alone);
    fixture_free(&all);
    fixture_free(&one);
    bw_comm_destroy(&self);
  }
}
END_TEST

static void compare_with_update(fixture *f)
{
  for (int c = 0; c < 3 && f->u[c] != NULL; c++) {
    bw_real *fresh = NULL;
    bw_check_ok(bw_field_create(f->grid, &fresh));
    memcpy(fresh, f->u[c], f->g->size * sizeof *fresh);
    bw_halo_update(f->grid, 1, &fresh);
    for (size_t q = 0; q < f->g->size; q++)
      bw_check_near(f->u[c][q], fresh[q], 20.0 * BW_REAL_EPSILON);
    bw_release(&fresh);
  }
}

/* No halo travels while forcing, yet all hold what their owners hold: also where a support meets a
 * block twice over a periodic side, and three blocks on (two cells thick on four ranks). */
START_TEST(halos_stay_valid)
{
  static const fixture_case cases[] = {
      {{12, 10, 8}, true, BW_KERNEL_ROMA3, 2}, {{6, 8, 2}, true, BW_KERNEL_ROMA3, 2},
      {{6, 8, 2}, true, BW_KERNEL_PESKIN4, 2}, {{4, 8, 1}, true, BW_KERNEL_PESKIN4, 2},
      {{12, 10, 8}, false, BW_KERNEL_HAT2, 2}, {{6, 8, 2}, false, BW_KERNEL_PESKIN4, 1}};
  for (int t = 0; t < 6; t++) {
    fixture f;
    fixture_make(&f, bw_check_world(), &cases[t], 24, 0.0); /* more would grow in a small box */
    fill_scattered(&f, 1.0);
    bw_ibm_mdf_force(f.ib, f.u, DT);
    compare_with_update(&f);
    bw_ibm_mdf_spread(f.ib, f.F, f.u);
    compare_with_update(&f);
    fixture_free(&f);
  }
}
END_TEST

/* Outside a closed box: left out, counted, force zero; outside a periodic one: wrapped. */
START_TEST(markers_outside_are_counted)
{
  const bw_comm *comm = bw_check_world();
  const int size = bw_comm_size(comm);
  for (int periodic = 0; periodic <= 1; periodic++) {
    const fixture_case c = {{8, 10, 8}, periodic != 0, BW_KERNEL_ROMA3, 1};
    fixture f;
    fixture_make(&f, comm, &c, 5 * size, 2.0);
    double *QdV = NULL;
    bw_check_ok(BW_ALLOCATE(&QdV, 3 * f.n));
    f.X[3 * 2 + 1] += 3.0 * f.g->length[1];
    bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
    bw_ibm_mdf_force(f.ib, f.u, DT);
    bw_ibm_mdf_marker_force(f.ib, QdV);
    const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
    ck_assert_int_eq(r.markers, 5 * size);
    ck_assert_int_eq(r.outside, periodic ? 0 : size);
    for (size_t m = 0; m < f.n; m++)
      ck_assert((fabs(QdV[3 * m]) > 0.0) == (periodic || m != 2));
    bw_release(&QdV);
    fixture_free(&f);
  }
}
END_TEST

/* A new set replaces the old one whatever their sizes; the same set again gives the same bits. */
START_TEST(sets_can_be_replaced)
{
  const bw_comm *comm = bw_check_world();
  const fixture_case c = {{8, 10, 8}, true, BW_KERNEL_ROMA3, 2};
  fixture f;
  fixture_make(&f, comm, &c, FIX_MARKERS, 0.0);
  double *first = NULL, *again = NULL;
  bw_check_ok(BW_ALLOCATE(&first, 3 * f.n));
  bw_check_ok(BW_ALLOCATE(&again, 3 * f.n));
  fill_scattered(&f, 1.0);
  bw_ibm_mdf_force(f.ib, f.u, DT);
  bw_ibm_mdf_marker_force(f.ib, first);
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, 0, NULL, NULL, NULL, NULL));
  bw_ibm_mdf_force(f.ib, f.u, DT);
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n / 2, f.X, f.V, f.dV, NULL));
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));
  fill_scattered(&f, 1.0);
  bw_ibm_mdf_force(f.ib, f.u, DT);
  bw_ibm_mdf_marker_force(f.ib, again);
  ck_assert_int_eq(memcmp(first, again, 3 * f.n * sizeof *first), 0);
  bw_release(&first);
  bw_release(&again);
  fixture_free(&f);
}
END_TEST

/* q markers in one place, dV = h^3 each: A has the eigenvalue q (sum phi^2)^3 = q/8; beside them
 * one alone that is fine. */
START_TEST(iterations_that_grow_are_refused)
{
  const bool first = bw_comm_rank(bw_check_world()) == 0;
  for (int q = 15; q <= 17; q += 2) {
    const fixture_case c = {{8, 8, 8}, true, BW_KERNEL_ROMA3, 1};
    fixture f;
    double X[3 * 18], V[3 * 18] = {0.0}, dV[18];
    fixture_make(&f, bw_check_world(), &c, 0, 0.0);
    for (int m = 0; m <= q; m++) {
      X[3 * m] = X[3 * m + 1] = X[3 * m + 2] = m == q ? 0.1 : 1.33;
      dV[m] = cell_volume(&f);
    }
    const size_t n = first ? (size_t)q + 1 : 0;
    if (q < 16)
      bw_check_ok(bw_ibm_mdf_set_markers(f.ib, n, X, V, dV, NULL));
    else
      bw_check_status(bw_ibm_mdf_set_markers(f.ib, n, X, V, dV, NULL), BW_EINPUT);
    fixture_free(&f);
  }
}
END_TEST

/* Deeper for wider kernels, and for fewer iterations, which leave more slip; never less than a flat
 * sheet along the grid has on average without slip, (1/2) sum phi_i phi_j |i - j|. */
START_TEST(retraction_follows_kernel_and_iterations)
{
  static const bw_kernel_delta_id rising[] = {BW_KERNEL_HAT2, BW_KERNEL_ROMA3, BW_KERNEL_PESKIN4};
  for (int k = 0; k < 3; k++) {
    double least = 0.0;
    for (int shift = 0; shift < 10; shift++) {
      const bw_kernel_delta *kernel = bw_kernel_delta_get(rising[k]);
      for (int i = -2; i <= 3; i++)
        for (int j = -2; j <= 3; j++)
          least += 0.05 * kernel->phi(0.1 * shift - i) * kernel->phi(0.1 * shift - j) * abs(i - j);
    }
    const double no_slip = bw_ibm_mdf_retraction(
        &(bw_ibm_mdf_config){.kernel = rising[k], .n_iter = 1, .memory = 0.2});
    /* Sheets turned against the grid stand off more, by less than a tenth of a spacing. */
    ck_assert(no_slip >= least && no_slip < least + 0.1);
    double last = 1.0;
    for (int n = 1; n <= 64; n++) {
      const double r =
          bw_ibm_mdf_retraction(&(bw_ibm_mdf_config){.kernel = rising[k], .n_iter = n});
      ck_assert(r <= last && r >= least);
      if (k > 0)
        ck_assert(
            r > bw_ibm_mdf_retraction(&(bw_ibm_mdf_config){.kernel = rising[k - 1], .n_iter = n}));
      last = r;
    }
  }
}
END_TEST

START_TEST(bad_input_is_refused_on_all_ranks)
{
  const bw_comm *comm = bw_check_world();
  const fixture_case c = {{8, 10, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture f;
  fixture_make(&f, comm, &c, 4 * bw_comm_size(comm), 0.0);
  const bool last = bw_comm_rank(comm) == bw_comm_size(comm) - 1;
  const double x = f.X[4], dV = f.dV[1];
  if (last) f.X[4] = NAN;
  bw_check_status(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL), BW_EINPUT);
  f.X[4] = x;
  if (last) f.dV[1] = -1.0;
  bw_check_status(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL), BW_EINPUT);
  f.dV[1] = dV;
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, NULL));

  bw_ibm_mdf *ib = NULL;
  bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  config.n_iter = 0;
  bw_check_status(bw_ibm_mdf_create(f.grid, &config, &ib), BW_EINPUT);
  config.n_iter = 1;
  bw_grid_config g = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    g.n[d] = 8, g.length[d] = 1.0;
  bw_grid *thin = NULL;
  bw_check_ok(bw_grid_create(comm, &g, &thin)); /* halo 1 */
  bw_check_status(bw_ibm_mdf_create(thin, &config, &ib), BW_EINPUT);
  ck_assert_ptr_null(ib);
  bw_grid_destroy(&thin);
  g.halo = 2, g.y_stretch = BW_STRETCH_TABLE; /* even a table of equal heights */
  g.y_table = (const double[]){0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1};
  bw_check_ok(bw_grid_create(comm, &g, &thin));
  bw_check_status(bw_ibm_mdf_create(thin, &config, &ib), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "y"));
  bw_grid_destroy(&thin);
  fixture_free(&f);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(one_marker_has_a_closed_form),
                                      BW_TEST(momentum_given_is_momentum_received),
                                      BW_TEST(slip_falls_with_iterations),
                                      BW_TEST(the_answer_does_not_depend_on_ranks),
                                      BW_TEST(halos_stay_valid),
                                      BW_TEST(markers_outside_are_counted),
                                      BW_TEST(sets_can_be_replaced),
                                      BW_TEST(iterations_that_grow_are_refused),
                                      BW_TEST(retraction_follows_kernel_and_iterations),
                                      BW_TEST(bad_input_is_refused_on_all_ranks)};
BW_CHECK_MAIN("ibm_mdf.force", tests)
