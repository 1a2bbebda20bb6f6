/* Normal probes: what is in the way shortens and blocks them; bad input.
 * TEST ranks=1,2,3,4 */
#include "probe_test.h"

/* Looking at a wall of the box from d cells: the stencil ends half a cell beyond the tip, so
 * dl = 2 h needs 2.5 cells and dl = h needs 1.5. */
START_TEST(box_sides_shorten_and_block)
{
  static const int n[3] = {10, 12, 8};
  static const struct {
    double distance;
    unsigned char flag;
  } row[] = {{2.6, BW_PROBE_FREE},
             {2.4, BW_PROBE_SHORTENED},
             {1.6, BW_PROBE_SHORTENED},
             {1.4, BW_PROBE_BLOCKED},
             {0.5, BW_PROBE_BLOCKED}};
  fixture f;
  make(&f, bw_check_world(), n, 0.3, false, BW_PROBE_LINEAR);
  fill(&f, linear);
  for (int d = 0; d < 3; d++)
    for (int q = 0; q < 5; q++) {
      double X[3] = {1.5, 1.7, 1.2}, N[3] = {0.0, 0.0, 0.0}, A[3], t[3], want[3];
      unsigned char flag = 99;
      N[d] = 1.0;
      X[d] = f.g->length[d] - row[q].distance * 0.3;
      for (int c = 0; c < 3; c++)
        A[c] = -GRAD_P[c];
      bw_check_ok(bw_probe_set_points(f.probe, 1, X, N));
      bw_probe_traction(f.probe, f.u, f.p, A, t, &flag);
      ck_assert_int_eq(flag, row[q].flag);
      expected(false, X, N, A, 0.6, want);
      for (int c = 0; c < 3; c++)
        bw_check_near(t[c], flag == BW_PROBE_BLOCKED ? 0.0 : want[c], ROUND_OFF);
    }
  drop(&f);
}
END_TEST

/* Cells of 0.2 x 0.3 x 0.1: probes are 2 x 0.3 long whichever way they look, so that a side 0.5
 * away is too near for all of them, and one 0.9 away for none. */
START_TEST(the_longest_cell_is_the_measure)
{
  static const double spacing[3] = {0.2, 0.3, 0.1};
  bw_grid_config g = bw_grid_config_default();
  bw_probe_config c = bw_probe_config_default();
  bw_grid *grid = NULL;
  bw_probe *probe = NULL;
  bw_real *u[3] = {NULL}, *p = NULL;
  for (int d = 0; d < 3; d++)
    g.n[d] = 16, g.length[d] = 16 * spacing[d];
  g.halo = 2;
  c.rho = RHO, c.nu = NU;
  bw_check_ok(bw_grid_create(bw_check_world(), &g, &grid));
  bw_check_ok(bw_probe_create(grid, &c, &probe));
  for (int d = 0; d < 3; d++)
    bw_check_ok(bw_field_create(grid, &u[d]));
  bw_check_ok(bw_field_create(grid, &p));
  for (int d = 0; d < 3; d++)
    for (int near = 0; near < 2; near++) {
      double X[3], N[3] = {0.0, 0.0, 0.0}, t[3];
      unsigned char flag = 99;
      for (int e = 0; e < 3; e++)
        X[e] = 0.5 * g.length[e];
      X[d] = g.length[d] - (near == 1 ? 0.5 : 0.9);
      N[d] = 1.0;
      bw_check_ok(bw_probe_set_points(probe, 1, X, N));
      bw_probe_traction(probe, u, p, NULL, t, &flag);
      ck_assert((flag == BW_PROBE_FREE) == (near == 0));
    }
  for (int d = 0; d < 3; d++)
    bw_release(&u[d]);
  bw_release(&p);
  bw_probe_destroy(&probe);
  bw_grid_destroy(&grid);
}
END_TEST

typedef struct {
  double gap; /* in cells */
  unsigned char flag;
} look;

/* Flags of five points that look along +x at x = 1.8 (cell 7) from afar, and what they read: linear
 * fields exactly, at whatever length. */
static void expect_flags(const fixture *f, bw_probe *probe, const look row[5])
{
  double X[5][3], N[5][3], A[5][3], t[5][3], want[3];
  unsigned char flag[5];
  for (int q = 0; q < 5; q++) {
    memcpy(X[q], (double[3]){1.8 - 0.3 * row[q].gap, 1.0 + 0.3 * q, 0.8 + 0.2 * q}, sizeof X[q]);
    memcpy(N[q], (double[3]){1.0, 0.0, 0.0}, sizeof N[q]);
    for (int c = 0; c < 3; c++)
      A[q][c] = -GRAD_P[c];
  }
  bw_check_ok(bw_probe_set_points(probe, 5, X[0], N[0]));
  bw_probe_traction(probe, f->u, f->p, A[0], t[0], flag);
  for (int q = 0; q < 5; q++) {
    ck_assert_int_eq(flag[q], row[q].flag);
    expected(false, X[q], N[q], A[q], 0.6, want);
    for (int c = 0; c < 3; c++)
      bw_check_near(t[q][c], flag[q] == BW_PROBE_BLOCKED ? 0.0 : want[c], ROUND_OFF);
  }
}

/* Another solid, thick or one cell thin, begins at x = 1.8; probes of 2 and of 4 h look at it. */
START_TEST(obstacles_shorten_and_block)
{
  static const int n[3] = {12, 12, 8};
  static const look two[5] = {{3.1, BW_PROBE_FREE},
                              {2.6, BW_PROBE_SHORTENED},
                              {1.8, BW_PROBE_SHORTENED},
                              {1.2, BW_PROBE_CROWDED},
                              {0.8, BW_PROBE_BLOCKED}};
  static const look four[5] = {{5.1, BW_PROBE_FREE},
                               {4.4, BW_PROBE_SHORTENED},
                               {2.7, BW_PROBE_SHORTENED}, /* seen behind the tip when thin */
                               {1.2, BW_PROBE_CROWDED},
                               {0.8, BW_PROBE_BLOCKED}};
  static const look none[5] = {{3.1, BW_PROBE_FREE},
                               {2.6, BW_PROBE_FREE},
                               {1.8, BW_PROBE_FREE},
                               {1.2, BW_PROBE_FREE},
                               {0.8, BW_PROBE_FREE}};
  for (int last = 7; last <= 10; last += 3) {
    fixture f;
    bw_real *solid = NULL;
    bw_probe *longer = NULL;
    bw_probe_config c = bw_probe_config_default();
    c.rho = RHO, c.nu = NU, c.length = 4.0;
    make(&f, bw_check_world(), n, 0.3, true, BW_PROBE_LINEAR);
    fill(&f, linear);
    bw_check_ok(bw_probe_create(f.grid, &c, &longer));
    bw_check_ok(bw_field_create(f.grid, &solid));
    for (int k = 1; k <= f.g->m[2]; k++)
      for (int j = 1; j <= f.g->m[1]; j++)
        for (int i = 7; i <= last; i++)
          solid[bw_at(f.g, i, j, k)] = 1;
    bw_halo_update(f.grid, 1, &solid);
    bw_check_ok(bw_probe_set_obstacles(f.probe, solid));
    bw_check_ok(bw_probe_set_obstacles(longer, solid));
    expect_flags(&f, f.probe, two);
    expect_flags(&f, longer, four);
    bw_check_ok(bw_probe_set_obstacles(f.probe, NULL));
    expect_flags(&f, f.probe, none);
    bw_probe_destroy(&longer);
    bw_release(&solid);
    drop(&f);
  }
}
END_TEST

START_TEST(bad_input_is_refused_on_all_ranks)
{
  static const int n[3] = {8, 8, 8};
  const bw_comm *comm = bw_check_world();
  const bool last = bw_comm_rank(comm) == bw_comm_size(comm) - 1;
  fixture f;
  make(&f, comm, n, 0.3, true, BW_PROBE_LINEAR);
  double X[3] = {1.0, 1.0, 1.0}, N[3] = {0.0, last ? 1.1 : 1.0, 0.0};
  bw_check_status(bw_probe_set_points(f.probe, 1, X, N), BW_EINPUT);
  N[1] = 1.0;
  X[0] = last ? NAN : 1.0;
  bw_check_status(bw_probe_set_points(f.probe, 1, X, N), BW_EINPUT);
  X[0] = 1.0;
  bw_check_ok(bw_probe_set_points(f.probe, last ? 1 : 0, X, N));

  bw_probe *probe = NULL;
  bw_probe_config c = bw_probe_config_default();
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT); /* rho is required */
  c.rho = 1.0;
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT); /* nu is required */
  c.nu = 1.0;
  c.kernel = BW_KERNEL_PESKIN4; /* reaches beyond the halo */
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT);
  c.kernel = BW_KERNEL_HAT2;
  c.length = 0.5;
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT);
  c.length = 1.5;
  bw_check_ok(bw_probe_create(f.grid, &c, &probe));
  bw_probe_destroy(&probe);
  drop(&f);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(box_sides_shorten_and_block), BW_TEST(the_longest_cell_is_the_measure),
    BW_TEST(obstacles_shorten_and_block), BW_TEST(bad_input_is_refused_on_all_ranks)};
BW_CHECK_MAIN("probe.flags", tests)
