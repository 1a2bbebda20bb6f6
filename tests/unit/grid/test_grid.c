/* Grid: geometry, division into blocks, owners, refusals.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_file.h"
#include "bw_grid.h"
#include "bw_memory.h"
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static bw_grid_config box(int n0, int n1, int n2)
{
  bw_grid_config c = bw_grid_config_default();
  c.n[0] = n0, c.n[1] = n1, c.n[2] = n2;
  c.length[0] = 3, c.length[1] = 2, c.length[2] = 1.5;
  return c;
}

static bw_grid *make(const bw_grid_config *c)
{
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(bw_check_world(), c, &grid));
  return grid;
}

/* Blocks tile the box: every (j, k) belongs to one rank, which bw_grid_owner names. */
START_TEST(blocks_tile_the_box_and_owner_knows)
{
  for (int q = 0; q < 8; q++) {
    bw_grid_config c = box(4, 7 + q % 4, q % 2 ? 1 : 9 + q % 3);
    if (q % 3 == 0) c.y_stretch = BW_STRETCH_TANH;
    bw_grid *grid = make(&c);
    const bw_grid_view *v = bw_grid_look(grid);
    const int rank = bw_comm_rank(bw_check_world());
    double mine = v->m[1] * v->m[2];
    bw_comm_sum(bw_check_world(), 1, &mine);
    ck_assert_double_eq(mine, c.n[1] * c.n[2]);
    for (int j = 1; j <= c.n[1]; j++)
      for (int k = 1; k <= c.n[2]; k++) {
        const bool here =
            j > v->lo[1] && j <= v->lo[1] + v->m[1] && k > v->lo[2] && k <= v->lo[2] + v->m[2];
        const double x[3] = {1.0, v->y_centre[j], (k - 0.5) * v->spacing[2]};
        ck_assert_int_eq(bw_grid_owner(grid, x) == rank, here);
      }
    for (int d = 0; d < 3; d++) /* uneven by at most one */
      ck_assert_int_le(abs(v->m[d] * v->ranks[d] - v->n[d]), v->ranks[d]);
    bw_grid_destroy(&grid);
  }
}
END_TEST

START_TEST(owner_at_and_beyond_the_boundary)
{
  bw_grid_config c = box(4, 8, 8);
  c.periodic[2] = true;
  bw_grid *grid = make(&c);
  const int last = bw_comm_size(bw_check_world()) - 1;
  const double corner[3] = {3, 2, 1.49}, below[3] = {1, -1e-9, 1}, nan[3] = {1, NAN, 1};
  const double once_around[3] = {1, 1.99, 1.49 - 3 * 1.5}, origin[3] = {0, 0, 0};
  const double far_in_x[3] = {3.01, 1, 1};
  ck_assert_int_eq(bw_grid_owner(grid, corner), last);
  ck_assert_int_eq(bw_grid_owner(grid, once_around), last);
  ck_assert_int_eq(bw_grid_owner(grid, origin), 0);
  ck_assert_int_eq(bw_grid_owner(grid, below), -1);
  ck_assert_int_eq(bw_grid_owner(grid, nan), -1);
  ck_assert_int_eq(bw_grid_owner(grid, far_in_x), -1);
  bw_grid_destroy(&grid);
}
END_TEST

/* bw_at addresses distinct entries of the storage, i fastest, and i = 1 is aligned. */
/* Points of all ranks, far from where they are known: each colours its cell, wherever that is, once
 * around a periodic side, too; what is outside colours nothing. */
START_TEST(points_mark_their_cells)
{
  for (int flat = 0; flat < 2; flat++) {
    bw_grid_config c = box(4, 8, flat ? 1 : 8);
    c.periodic[2] = true;
    if (!flat) c.y_stretch = BW_STRETCH_TANH;
    bw_grid *grid = make(&c);
    const bw_grid_view *v = bw_grid_look(grid);
    const int rank = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
    bw_real *field = NULL;
    bw_check_ok(bw_field_create(grid, &field));
    /* Rank r colours every cell whose row is r modulo the ranks, from an image above or below. */
    double *x = NULL, *value = NULL;
    const size_t cells = (size_t)(c.n[0] * c.n[1] * c.n[2]);
    size_t n = 0;
    bw_check_ok(BW_ALLOCATE(&x, 3 * (cells + 1)));
    bw_check_ok(BW_ALLOCATE(&value, cells + 1));
    for (int k = 1; k <= c.n[2]; k++)
      for (int j = 1 + rank; j <= c.n[1]; j += size)
        for (int i = 1; i <= c.n[0]; i++, n++) {
          x[3 * n] = (i - 0.5) * v->spacing[0], x[3 * n + 1] = v->y_centre[j];
          x[3 * n + 2] = (k - 0.5) * v->spacing[2] + (i % 3 - 1) * v->length[2];
          value[n] = i + 10 * j + 100 * k;
        }
    x[3 * n] = 1.0, x[3 * n + 1] = -0.1, x[3 * n + 2] = 0.1, value[n++] = 7.0;
    bw_check_ok(bw_grid_mark(grid, n, x, value, field));
    for (int k = 1; k <= v->m[2]; k++)
      for (int j = 1; j <= v->m[1]; j++)
        for (int i = 1; i <= v->m[0]; i++)
          ck_assert_double_eq((double)field[bw_at(v, i, j, k)],
                              i + 10 * (j + v->lo[1]) + 100 * (k + v->lo[2]));
    /* Without values: 1, and cells without a point keep theirs. */
    bw_check_ok(bw_grid_mark(grid, rank == 0 ? 1 : 0, x, NULL, field));
    const bool mine = v->lo[1] == 0 && v->lo[2] == 0;
    if (mine) ck_assert_double_eq((double)field[bw_at(v, 1, 1, 1)], 1.0);
    if (mine) ck_assert_double_eq((double)field[bw_at(v, 2, 1, 1)], 112.0);
    bw_release(&x);
    bw_release(&value);
    bw_release(&field);
    bw_grid_destroy(&grid);
  }
}
END_TEST

START_TEST(storage_holds_every_cell_once)
{
  for (int q = 0; q < 6; q++) {
    /* The last two: with their halos, rows of a page of memory. */
    const int page = (int)(4096 / sizeof(bw_real));
    bw_grid_config c = box(q < 4 ? 5 + q : page - 2 * (q - 3), 9, q % 2 ? 1 : 8);
    c.halo = q < 4 ? 1 + q / 2 : q - 3;
    bw_grid *grid = make(&c);
    const bw_grid_view *v = bw_grid_look(grid);
    unsigned char *seen = NULL;
    bw_real *f = NULL;
    bw_check_ok(bw_field_create(grid, &f));
    bw_check_ok(BW_ALLOCATE(&seen, v->size));
    for (int k = 1 - v->halo[2]; k <= v->m[2] + v->halo[2]; k++)
      for (int j = 1 - v->halo[1]; j <= v->m[1] + v->halo[1]; j++) {
        ck_assert_uint_eq((uintptr_t)(f + bw_at(v, 1, j, k)) % 16, 0);
        for (int i = 1 - v->halo[0]; i <= v->m[0] + v->halo[0]; i++) {
          const ptrdiff_t at = bw_at(v, i, j, k);
          ck_assert_int_ge(at, 0);
          ck_assert_uint_lt((size_t)at, v->size);
          ck_assert_int_eq(seen[at]++, 0);
        }
      }
    ck_assert_int_eq(v->halo[2], c.n[2] == 1 ? 0 : c.halo);
    if (c.n[2] == 1) ck_assert_int_eq(bw_at(v, 2, 3, 0), bw_at(v, 2, 3, 1));
    bw_release(&f), bw_release(&seen);
    bw_grid_destroy(&grid);
  }
}
END_TEST

/* tanh: the formula at a quarter, exact ends, symmetric, monotone, ghosts mirrored. */
START_TEST(stretched_faces)
{
  bw_grid_config c = box(4, 12, 8);
  c.y_stretch = BW_STRETCH_TANH;
  c.y_stretch_strength = 2;
  bw_grid *grid = make(&c);
  const bw_grid_view *v = bw_grid_look(grid);
  ck_assert(!v->uniform_y);
  ck_assert_double_eq(v->y_face[0], 0);
  ck_assert_double_eq(v->y_face[12], 2);
  /* j = 3: 1 + tanh(-1)/tanh(2) = 1 - 0.7615941559557649/0.9640275800758169 */
  bw_check_near(v->y_face[3], 0.2099871708070, 1e-12);
  for (int j = 0; j <= 12; j++)
    bw_check_near(v->y_face[j] + v->y_face[12 - j], 2, 1e-15);
  ck_assert_double_lt(v->y_face[1], 2.0 / 12); /* finest at the wall */
  for (int q = 0; q < 2; q++) {
    ck_assert_double_eq(v->y_centre[-q], -v->y_centre[1 + q]);
    bw_check_near(v->y_centre[13 + q] + v->y_centre[12 - q], 4, 1e-15);
  }
  bw_grid_destroy(&grid);
}
END_TEST

/* A table is taken as it is, the last face to the last bit of the box. */
START_TEST(faces_of_a_table)
{
  static const double y[7] = {0, 0.25, 0.6, 1.0, 1.4, 1.8, 2.0 + 1e-15};
  bw_grid_config c = box(4, 6, 8);
  c.y_stretch = BW_STRETCH_TABLE, c.y_table = y;
  bw_grid *grid = make(&c);
  const bw_grid_view *v = bw_grid_look(grid);
  ck_assert(!v->uniform_y);
  for (int j = 0; j < 6; j++)
    ck_assert_double_eq(v->y_face[j], y[j]);
  ck_assert_double_eq(v->y_face[6], 2.0);
  bw_check_near(v->y_centre[2], 0.425, 1e-15);
  ck_assert_int_eq(bw_grid_owner(grid, (double[3]){0.1, 0.59, 0.1}),
                   bw_grid_owner(grid, (double[3]){0.1, 0.26, 0.1}));
  bw_grid_destroy(&grid);
}
END_TEST

static void table_refused(const char *text, const char *word)
{
  const bw_comm *comm = bw_check_world();
  double *y = NULL;
  bw_check_ok(bw_file_write_text(comm, "test_grid_table.txt", text));
  bw_check_status(bw_grid_read_table(comm, "test_grid_table.txt", 4, 2.0, &y), BW_EINPUT);
  ck_assert_ptr_null(y);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "\"%s\" does not say \"%s\"",
                bw_last_message(), word);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "test_grid_table.txt"));
}

START_TEST(tables_of_files)
{
  const bw_comm *comm = bw_check_world();
  double *y = NULL;
  bw_check_ok(bw_file_write_text(comm, "test_grid_table.txt", "# faces\n0 0.4\n1.0# mid\n1.6 2\n"));
  bw_check_ok(bw_grid_read_table(comm, "test_grid_table.txt", 4, 2.0, &y));
  ck_assert_double_eq(y[1], 0.4);
  ck_assert_double_eq(y[4], 2.0);
  bw_release(&y);
  table_refused("0 0.5 1 2", "4 faces, but 4 cells in y have 5");
  table_refused("0 0.5 1 1.5 1.8 2", "6 faces");
  table_refused("0 0.5\n1 x.5 2", "line 2: \"x.5\" is no number");
  table_refused("0 0.5 1 1.5e 2", "\"1.5e\"");
  table_refused("0 0.5 1 nan 2", "face 3 is nan");
  table_refused("0.1 0.5 1 1.5 2", "first face");
  table_refused("0 0.5 1 1.5 2.1", "last face is at 2.1");
  table_refused("0 0.5 0.5 1.5 2", "face 2 at 0.5 is not above face 1");
  table_refused("0 0.5 0.4 1.5 2", "is not above");
  table_refused("0 0.1 0.55 1.3 2", "cells 1 and 2 differ by the factor 4.5");
  bw_check_status(bw_grid_read_table(comm, "no_such_table.txt", 4, 2.0, &y), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no_such_table.txt"));
  bw_comm_barrier(comm);
  if (bw_comm_rank(comm) == 0) remove("test_grid_table.txt");
}
END_TEST

START_TEST(uniform_faces_are_exact)
{
  bw_grid_config c = box(4, 8, 8);
  bw_grid *grid = make(&c);
  const bw_grid_view *v = bw_grid_look(grid);
  for (int j = 0; j <= 8; j++)
    ck_assert_double_eq(v->y_face[j], 0.25 * j);
  for (int j = -1; j <= 10; j++)
    ck_assert_double_eq(v->y_centre[j], 0.25 * (j - 0.5));
  ck_assert_double_eq(v->spacing[0], 0.75);
  bw_grid_destroy(&grid);
}
END_TEST

START_TEST(least_halo_is_chosen)
{
  const int size = bw_comm_size(bw_check_world());
  const struct {
    int n[3], ranks[2][2]; /* expected for 2 and for 4 ranks */
  } want[] = {{{192, 128, 160}, {{1, 2}, {1, 4}}},
              {{128, 64, 64}, {{1, 2}, {1, 4}}},
              {{8, 64, 1}, {{2, 1}, {4, 1}}},
              {{8, 200, 16}, {{2, 1}, {4, 1}}}};
  for (int q = 0; q < 4; q++) {
    const bw_grid_config c = box(want[q].n[0], want[q].n[1], want[q].n[2]);
    bw_grid *grid = make(&c);
    const bw_grid_view *v = bw_grid_look(grid);
    ck_assert_int_eq(v->ranks[1] * v->ranks[2], size);
    if (size == 2 || size == 4)
      for (int d = 0; d < 2; d++)
        ck_assert_int_eq(v->ranks[1 + d], want[q].ranks[size / 4][d]);
    bw_grid_destroy(&grid);
  }
}
END_TEST

static void refused(bw_grid_config c, const char *word)
{
  bw_grid *grid = NULL;
  bw_check_status(bw_grid_create(bw_check_world(), &c, &grid), BW_EINPUT);
  ck_assert_ptr_null(grid);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "\"%s\" does not say \"%s\"",
                bw_last_message(), word);
}

START_TEST(impossible_grids_are_refused_by_name)
{
  const bw_grid_config good = box(8, 8, 8);
  bw_grid_config c = good;
  c.n[1] = 1, refused(c, "n[1] = 1");
  c = good, c.n[2] = 0, refused(c, "n[2] = 0");
  c = good, c.n[0] = -4, refused(c, "n[0] = -4");
  /* Counts that would not hold them: refused before anything is counted. */
  c = good, c.n[1] = INT_MAX, refused(c, "at most 16777216 in a direction");
  c = good, c.n[0] = c.n[1] = c.n[2] = 1000000, refused(c, "cells are 1e+18");
  c = good, c.length[0] = NAN, refused(c, "length[0]");
  c = good, c.length[2] = 0, refused(c, "length[2]");
  c = good, c.length[1] = INFINITY, refused(c, "length[1]");
  c = good, c.length[0] = 1e9, refused(c, "times as long in x as in y");
  c = good, c.length[2] = 1e-9, refused(c, "times as long in x as in z");
  c = good, c.n[2] = 1, c.length[2] = 1e9; /* one layer: a thickness */
  bw_grid *flat = NULL;
  bw_check_ok(bw_grid_plan(bw_check_world(), &c, &flat));
  bw_grid_destroy(&flat);
  c = good, c.halo = 3, refused(c, "halo = 3");
  c = good, c.halo = 0, refused(c, "halo = 0");
  c = good, c.y_stretch = BW_STRETCH_TANH, c.periodic[1] = true, refused(c, "periodic");
  c = good, c.y_stretch = BW_STRETCH_TANH, c.y_stretch_strength = -1, refused(c, "strength");
  c = good, c.y_stretch = BW_STRETCH_TANH, c.y_stretch_strength = NAN, refused(c, "strength");
  c = good, c.y_stretch = BW_STRETCH_TABLE, refused(c, "y_table is NULL");
  c.y_table = (const double[]){0, 1, 2, 3, 4, 5, 6, 7, 1.5}, refused(c, "y_table: the last face");
  c.periodic[1] = true, refused(c, "periodic");
  c = good, c.ranks[0] = 3, c.ranks[1] = 5, refused(c, "3 x 5");
  c = good, c.ranks[0] = 2, refused(c, "2 x 0");
  bw_grid *none = NULL;
  bw_grid_destroy(&none); /* nothing to do */
}
END_TEST

START_TEST(too_many_ranks_are_told_how_many_fit)
{
  const int size = bw_comm_size(bw_check_world());
  if (size < 3) return; /* 2 x 1 blocks fit */
  bw_grid_config c = box(8, 5, 1);
  c.halo = 2;
  refused(c, "2 ranks would");
  c = box(8, 5, 3);
  c.halo = 2;
  c.ranks[0] = 1, c.ranks[1] = size, refused(c, "at most 2 x 1");
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(blocks_tile_the_box_and_owner_knows),
                                      BW_TEST(owner_at_and_beyond_the_boundary),
                                      BW_TEST(points_mark_their_cells),
                                      BW_TEST(storage_holds_every_cell_once),
                                      BW_TEST(stretched_faces),
                                      BW_TEST(faces_of_a_table),
                                      BW_TEST(tables_of_files),
                                      BW_TEST(uniform_faces_are_exact),
                                      BW_TEST(least_halo_is_chosen),
                                      BW_TEST(impossible_grids_are_refused_by_name),
                                      BW_TEST(too_many_ranks_are_told_how_many_fit)};
BW_CHECK_MAIN("grid.grid", tests)
