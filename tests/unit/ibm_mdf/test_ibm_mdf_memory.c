/* Memory of the forcing: closed form of one marker, who keeps it, who has none, what reads ghosts.
 * TEST ranks=1,2,3,4 */
#include "ibm_fixture.h"

#include <string.h>

static const double DT = 0.02, BETA = 0.2;

static void stop_fluid(fixture *f)
{
  for (int c = 0; c < 3 && f->u[c] != NULL; c++)
    memset(f->u[c], 0, f->g->size * sizeof *f->u[c]);
}

/* Three sub-steps into fluid that rests at the beginning of each. */
static void step_in_resting_fluid(fixture *f)
{
  bw_ibm_mdf_begin_step(f->ib);
  for (int r = 0; r < 3; r++) {
    stop_fluid(f);
    bw_ibm_mdf_force(f->ib, f->u, DT);
  }
}

/* One marker in fluid that something stops before every sub-step. With d = dV/h^3, a = d prod C the
 * part of a velocity that forcing gives it, and m = M dt/h^3: sub-step r spreads gamma_r m and adds
 * d (V - gamma_r m prod C), in all q = (1 - a) m + 3 d V. So m -> (1 - beta a) m + 3 beta d V, from
 * nothing, m_n = (1 - (1 - beta a)^n) 3 V/prod C: in the end all that is needed. */
START_TEST(one_marker_has_a_closed_form)
{
  const fixture_case c = {{8, 8, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture f;
  fixture_make(&f, bw_check_world(), &c, 1, 0.0);
  fixture_remember(&f, &c, BETA);
  const double C = pow(bw_kernel_delta_get(c.kernel)->sum_of_squares, 3.0);
  double a = (f.n > 0 ? f.dV[0] : 0.0) / cell_volume(&f) * C;
  bw_comm_sum(bw_check_world(), 1, &a); /* whoever has it */
  double M[3] = {0.0}, *none = NULL;
  bw_check_ok(BW_ALLOCATE(&none, 1));
  for (int n = 1; n <= 40; n++) {
    const double before = 1.0 - pow(1.0 - BETA * a, n - 1);
    step_in_resting_fluid(&f);
    /* gamma of the third sub-step is 1/3: what the iteration found there is V less the whole. */
    const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
    double V2 = 0.0;
    for (int d = 0; d < 3 && f.n > 0; d++)
      V2 += f.V[d] * f.V[d];
    bw_comm_sum(bw_check_world(), 1, &V2);
    bw_check_near(r.slip_before, sqrt(V2) * (1.0 - before), 1e3 * BW_REAL_EPSILON);
    bw_ibm_mdf_memory(f.ib, f.n > 0 ? M : none);
    for (int d = 0; d < 3 && f.n > 0; d++)
      bw_check_near(M[d] * DT / cell_volume(&f), (1.0 - pow(1.0 - BETA * a, n)) * 3.0 * f.V[d] / C,
                    1e4 * BW_REAL_EPSILON);
  }
  bw_release(&none);
  fixture_free(&f);
}
END_TEST

/* The three sub-steps share the memory as 8/15, 2/15, 1/3: the first call finds that much less. */
START_TEST(sub_steps_share_the_memory)
{
  static const double gamma[3] = {8.0 / 15, 2.0 / 15, 1.0 / 3};
  const fixture_case c = {{8, 8, 8}, true, BW_KERNEL_ROMA3, 1};
  const double C = 0.125;
  fixture f;
  fixture_make(&f, bw_check_world(), &c, 1, 0.0);
  fixture_remember(&f, &c, BETA);
  const double M[3] = {cell_volume(&f), 0.0, 0.0}, rest[3] = {0.0};
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, rest, f.dV, M));
  for (int r = 0; r < 6; r++) {
    if (r == 3) bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, rest, f.dV, M));
    stop_fluid(&f);
    bw_ibm_mdf_force(f.ib, f.u, DT);
    bw_check_near(bw_ibm_mdf_measure(f.ib, f.u).slip_before, gamma[r % 3] * DT * C,
                  1e3 * BW_REAL_EPSILON);
  }
  fixture_free(&f);
}
END_TEST

/* Handed out and in again with the markers in another order, on another rank: the same as kept.
 * Rank r hands over the markers of rank r + q in step q; with one rank, in another order. */
START_TEST(memory_belongs_to_the_callers_markers)
{
  const bw_comm *comm = bw_check_world();
  static const fixture_case cases[] = {{{12, 10, 8}, true, BW_KERNEL_ROMA3, 1},
                                       {{12, 10, 1}, true, BW_KERNEL_PESKIN4, 2},
                                       {{12, 10, 8}, false, BW_KERNEL_ROMA3, 1}};
  for (int t = 0; t < 3; t++) {
    fixture kept, handed;
    fixture_make(&kept, comm, &cases[t], FIX_MARKERS, 0.0);
    fixture_make(&handed, comm, &cases[t], FIX_MARKERS, 0.0);
    fixture_remember(&kept, &cases[t], BETA);
    fixture_remember(&handed, &cases[t], BETA);
    fill_scattered(&kept, 1.0);
    fill_scattered(&handed, 1.0);
    double all[7 * FIX_MARKERS] = {0.0}, M[3 * FIX_MARKERS];
    const int size = bw_comm_size(comm), me = bw_comm_rank(comm);
    size_t mine = handed.n, number[FIX_MARKERS];
    for (size_t m = 0; m < mine; m++)
      number[m] = (size_t)me + m * (size_t)size;
    for (size_t m = 0; m < mine; m++) { /* what belongs to marker `number` does so for ever */
      memcpy(all + 7 * number[m], handed.X + 3 * m, 3 * sizeof *all);
      memcpy(all + 7 * number[m] + 3, handed.V + 3 * m, 3 * sizeof *all);
      all[7 * number[m] + 6] = handed.dV[m];
    }
    bw_comm_sum(comm, 7 * FIX_MARKERS, all);
    for (int q = 1; q <= 4; q++) {
      for (int r = 0; r < 3; r++) {
        bw_ibm_mdf_force(kept.ib, kept.u, DT);
        bw_ibm_mdf_force(handed.ib, handed.u, DT);
      }
      bw_ibm_mdf_begin_step(kept.ib);
      bw_ibm_mdf_memory(handed.ib, M);
      /* All memories on all ranks; then another share of the markers, last to first. */
      double memory[3 * FIX_MARKERS] = {0.0}, X[3 * FIX_MARKERS], V[3 * FIX_MARKERS];
      double dV[FIX_MARKERS];
      for (size_t m = 0; m < mine; m++)
        memcpy(memory + 3 * number[m], M + 3 * m, 3 * sizeof *M);
      bw_comm_sum(comm, 3 * FIX_MARKERS, memory);
      mine = 0;
      for (int k = FIX_MARKERS - 1; k >= 0; k--) {
        if ((k + q) % size != me) continue;
        number[mine] = (size_t)k;
        memcpy(X + 3 * mine, all + 7 * k, 3 * sizeof *X);
        memcpy(V + 3 * mine, all + 7 * k + 3, 3 * sizeof *V);
        memcpy(M + 3 * mine, memory + 3 * k, 3 * sizeof *M);
        dV[mine++] = all[7 * k + 6];
      }
      bw_check_ok(bw_ibm_mdf_set_markers(handed.ib, mine, X, V, dV, M));
    }
    for (int c = 0; c < 3 && kept.u[c] != NULL; c++)
      for (int k = 1; k <= kept.g->m[2]; k++)
        for (int j = 1; j <= kept.g->m[1]; j++)
          for (int i = 1; i <= kept.g->m[0]; i++)
            bw_check_near(kept.u[c][bw_at(kept.g, i, j, k)], handed.u[c][bw_at(kept.g, i, j, k)],
                          1e3 * BW_REAL_EPSILON);
    fixture_free(&kept);
    fixture_free(&handed);
  }
}
END_TEST

/* All ranks together against this rank alone with every marker, over steps with memory. */
START_TEST(the_answer_does_not_depend_on_ranks)
{
  const fixture_case c = {{12, 10, 8}, false, BW_KERNEL_ROMA3, 1};
  bw_comm *self = NULL;
  fixture all, one;
  bw_check_ok(bw_comm_self(&self));
  fixture_make(&all, bw_check_world(), &c, FIX_MARKERS, 0.0);
  fixture_make(&one, self, &c, FIX_MARKERS, 0.0);
  fixture_remember(&all, &c, BETA);
  fixture_remember(&one, &c, BETA);
  fill_scattered(&all, 1.0);
  fill_scattered(&one, 1.0);
  for (int q = 0; q < 9; q++) {
    if (q % 3 == 0) bw_ibm_mdf_begin_step(all.ib), bw_ibm_mdf_begin_step(one.ib);
    bw_ibm_mdf_force(all.ib, all.u, DT);
    bw_ibm_mdf_force(one.ib, one.u, DT);
  }
  for (int d = 0; d < 3; d++)
    for (int k = 1; k <= all.g->m[2]; k++)
      for (int j = 1; j <= all.g->m[1]; j++)
        for (int i = 1; i <= all.g->m[0]; i++)
          bw_check_near(all.u[d][bw_at(all.g, i, j, k)],
                        one.u[d][bw_at(one.g, i, j + all.g->lo[1], k + all.g->lo[2])],
                        1e3 * BW_REAL_EPSILON);
  fixture_free(&all);
  fixture_free(&one);
  bw_comm_destroy(&self);
}
END_TEST

/* Markers that were told to have no memory do what markers without memory do, to the last bit, and
 * tell zeros. */
START_TEST(a_marker_may_have_none)
{
  const fixture_case c = {{12, 10, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture with, without;
  double M[3 * FIX_MARKERS];
  fixture_make(&with, bw_check_world(), &c, FIX_MARKERS, 0.0);
  fixture_make(&without, bw_check_world(), &c, FIX_MARKERS, 0.0);
  fixture_remember(&with, &c, BETA);
  for (size_t i = 0; i < 3 * with.n; i++)
    M[i] = NAN;
  bw_check_ok(bw_ibm_mdf_set_markers(with.ib, with.n, with.X, with.V, with.dV, M));
  fill_scattered(&with, 1.0);
  fill_scattered(&without, 1.0);
  for (int q = 0; q < 7; q++) {
    if (q % 3 == 0) bw_ibm_mdf_begin_step(with.ib), bw_ibm_mdf_begin_step(without.ib);
    bw_ibm_mdf_force(with.ib, with.u, DT);
    bw_ibm_mdf_force(without.ib, without.u, DT);
  }
  for (int d = 0; d < 3; d++)
    ck_assert_int_eq(memcmp(with.u[d], without.u[d], with.g->size * sizeof *with.u[d]), 0);
  bw_ibm_mdf_memory(with.ib, M);
  for (size_t i = 0; i < 3 * with.n; i++)
    ck_assert_double_eq(M[i], 0.0);
  fixture_free(&with);
  fixture_free(&without);
}
END_TEST

/* Twelve markers in one place: A has the eigenvalue 12/8. An iteration takes all of their slip, not
 * one and a half times as much. */
START_TEST(crowded_markers_take_no_more_than_their_slip)
{
  const fixture_case c = {{8, 8, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture f;
  double X[3 * 12], V[3 * 12], dV[12];
  fixture_make(&f, bw_check_world(), &c, 0, 0.0);
  fixture_remember(&f, &c, BETA);
  for (int m = 0; m < 12; m++) {
    X[3 * m] = X[3 * m + 1] = X[3 * m + 2] = 1.33;
    V[3 * m] = 1.0, V[3 * m + 1] = V[3 * m + 2] = 0.5;
    dV[m] = cell_volume(&f);
  }
  const size_t n = bw_comm_rank(bw_check_world()) == 0 ? 12 : 0;
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, n, X, V, dV, NULL));
  bw_ibm_mdf_force(f.ib, f.u, DT);
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f.ib, f.u);
  bw_check_near(r.slip_before, sqrt(1.5), 1e3 * BW_REAL_EPSILON);
  bw_check_near(r.slip_after, 0.0, 1e3 * BW_REAL_EPSILON);
  fixture_free(&f);
}
END_TEST

typedef struct {
  int calls;
  const fixture *f;
} mirror_context;

/* A wall at rest on the lower side of y: u is odd about it. */
static void mirror(void *context)
{
  mirror_context *k = context;
  const bw_grid_view *g = k->f->g;
  k->calls++;
  if (!g->first[1]) return;
  for (int q = 1 - g->halo[2]; q <= g->m[2] + g->halo[2]; q++)
    for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++)
      for (int j = 1; j <= 2; j++)
        k->f->u[0][bw_at(g, i, 1 - j, q)] = -k->f->u[0][bw_at(g, i, j, q)];
}

/* A marker 0.3 h above a wall, fluid at rest: spreading into the first two rows leaves the ghosts
 * of the wall behind, so every interpolation that follows a spreading asks for fresh ones; the
 * velocity that an iteration meets is then less by what the ghosts mirror. */
START_TEST(ghosts_are_fresh_after_spreading)
{
  double slip[2];
  for (int fresh = 0; fresh <= 1; fresh++) {
    const fixture_case c = {{8, 10, 8}, false, BW_KERNEL_ROMA3, 1};
    fixture f;
    double X[3], V[3] = {1.0, 0.0, 0.0}, dV, M[3];
    fixture_make(&f, bw_check_world(), &c, 0, 0.0);
    for (int d = 0; d < 3; d++)
      X[d] = (d == 1 ? 0.3 : 3.2) * f.g->spacing[d], M[d] = 0.0;
    dV = cell_volume(&f), M[0] = dV / DT;
    fixture_remember(&f, &c, BETA);
    mirror_context k = {0, &f};
    if (fresh) bw_ibm_mdf_set_ghosts(f.ib, mirror, &k);
    const size_t n = bw_comm_rank(bw_check_world()) == 0 ? 1 : 0;
    bw_check_ok(bw_ibm_mdf_set_markers(f.ib, n, X, V, &dV, M));
    bw_ibm_mdf_force(f.ib, f.u, DT);
    slip[fresh] = bw_ibm_mdf_measure(f.ib, f.u).slip_before;
    ck_assert_int_eq(k.calls, fresh);
    bw_ibm_mdf_set_ghosts(f.ib, NULL, NULL);
    fixture_free(&f);
  }
  /* s = 0.3: rows at 0.5, 1.5 have w_1, w_2, ghosts at -0.5, -1.5 have w_0, 0. In x and z sum phi^2
   * is 1/2: U = gamma_0 (w_1^2 + w_2^2)/4, less gamma_0 w_0 w_1/4 by the mirrored row. */
  const bw_kernel_delta *kernel = bw_kernel_delta_get(BW_KERNEL_ROMA3);
  const double w0 = kernel->phi(0.8), w1 = kernel->phi(0.2), w2 = kernel->phi(1.2);
  const double kept = 8.0 / 15 * (w1 * w1 + w2 * w2) / 4.0, mirrored = 8.0 / 15 * w0 * w1 / 4.0;
  bw_check_near(slip[0], 1.0 - kept, 1e3 * BW_REAL_EPSILON);
  bw_check_near(slip[1], 1.0 - kept + mirrored, 1e3 * BW_REAL_EPSILON);
}
END_TEST

/* N.M and dV of the markers of each of two surfaces, over all ranks; those of none are row 2. */
static void press(const fixture *f, const int surface[], const double N[], const double M[],
                  double sum[6])
{
  memset(sum, 0, 6 * sizeof *sum);
  for (size_t m = 0; m < f->n; m++) {
    double *s = sum + (surface[m] < 0 ? 4 : 2 * surface[m]);
    for (size_t d = 0; d < 3; d++)
      s[0] += M[3 * m + d] * N[3 * m + d];
    s[1] += f->dV[m];
  }
  bw_comm_sum(bw_check_world(), 6, sum);
}

/* Two surfaces and markers of none: each surface loses its own mean along the normals and nothing
 * else, when it is told and in every step; -1 and markers without memory lose nothing. */
START_TEST(closed_surfaces_lose_their_pressure)
{
  const fixture_case c = {{12, 10, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture f;
  double M[3 * FIX_MARKERS], N[3 * FIX_MARKERS], before[6], after[6];
  int surface[FIX_MARKERS];
  fixture_make(&f, bw_check_world(), &c, FIX_MARKERS, 0.0);
  fixture_remember(&f, &c, BETA);
  for (size_t m = 0; m < f.n; m++) {
    const double *F = f.F + 3 * m, length = sqrt(F[0] * F[0] + F[1] * F[1] + F[2] * F[2]);
    surface[m] = (int)(m % 3) - 1;
    for (size_t d = 0; d < 3; d++)
      N[3 * m + d] = F[d] / length, M[3 * m + d] = (double)(d + 1) * F[d];
  }
  double given[3 * FIX_MARKERS];
  memcpy(given, M, sizeof given);
  press(&f, surface, N, given, before);
  bw_check_ok(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, given));
  bw_check_ok(bw_ibm_mdf_close(f.ib, 2, surface, N));
  bw_ibm_mdf_memory(f.ib, M);
  for (size_t m = 0; m < f.n; m++)
    for (size_t d = 0; d < 3; d++) {
      const double *s = before + 2 * (surface[m] < 0 ? 0 : surface[m]);
      const double lost = surface[m] < 0 ? 0.0 : N[3 * m + d] * f.dV[m] * s[0] / s[1];
      bw_check_near(M[3 * m + d], given[3 * m + d] - lost, 1e3 * BW_REAL_EPSILON);
    }
  fill_scattered(&f, 1.0);
  for (int r = 0; r < 3; r++)
    bw_ibm_mdf_force(f.ib, f.u, DT);
  bw_ibm_mdf_memory(f.ib, M); /* with the force of this step */
  press(&f, surface, N, M, before);
  bw_ibm_mdf_begin_step(f.ib);
  bw_ibm_mdf_memory(f.ib, M);
  press(&f, surface, N, M, after);
  for (int s = 0; s < 2; s++) {
    ck_assert_double_gt(fabs(before[2 * s]), 1e-3);
    bw_check_near(after[2 * s], 0.0, 1e4 * BW_REAL_EPSILON);
  }
  bw_check_near(after[4], before[4], 1e4 * BW_REAL_EPSILON);
  /* A surface that is not there, on one rank. */
  surface[0] = bw_comm_rank(bw_check_world()) == 0 ? 2 : 0;
  bw_check_status(bw_ibm_mdf_close(f.ib, 2, surface, N), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "surface"));
  fixture_free(&f);
}
END_TEST

START_TEST(bad_input_is_refused_on_all_ranks)
{
  const bw_comm *comm = bw_check_world();
  const fixture_case c = {{8, 10, 8}, true, BW_KERNEL_ROMA3, 1};
  fixture f;
  bw_ibm_mdf *ib = NULL;
  bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  fixture_make(&f, comm, &c, 4 * bw_comm_size(comm), 0.0);
  fixture_remember(&f, &c, BETA);
  static const double wrong[] = {-0.1, 0.6, NAN};
  for (int q = 0; q < 3; q++) {
    config.memory = wrong[q];
    bw_check_status(bw_ibm_mdf_create(f.grid, &config, &ib), BW_EINPUT);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), "memory"));
  }
  double M[3 * 4] = {0.0};
  if (bw_comm_rank(comm) == bw_comm_size(comm) - 1) M[4] = INFINITY;
  bw_check_status(bw_ibm_mdf_set_markers(f.ib, f.n, f.X, f.V, f.dV, M), BW_EINPUT);
  fixture_free(&f);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(one_marker_has_a_closed_form),
                                      BW_TEST(sub_steps_share_the_memory),
                                      BW_TEST(memory_belongs_to_the_callers_markers),
                                      BW_TEST(the_answer_does_not_depend_on_ranks),
                                      BW_TEST(a_marker_may_have_none),
                                      BW_TEST(crowded_markers_take_no_more_than_their_slip),
                                      BW_TEST(ghosts_are_fresh_after_spreading),
                                      BW_TEST(closed_surfaces_lose_their_pressure),
                                      BW_TEST(bad_input_is_refused_on_all_ranks)};
BW_CHECK_MAIN("ibm_mdf.memory", tests)
