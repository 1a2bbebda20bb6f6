/* Rows along x become blocks along z and come back changed; tridiagonal systems over the ranks in
 * y or z.
 * TEST ranks=1,2,3,4 */
#include "bw_memory.h"
#include "bw_transpose.h"
#include "bw_tridiagonal.h"
#include "grid_cases.h"

/* All numbers of a transposed set, told by where they are (x-entry, y and z from 0). */
static double code(int c, int j, int k)
{
  return 1 + c + 300.0 * j + 9000.0 * k;
}

/* comm: NULL for the world. periodic: bits x, y, z. */
static bw_grid *make(const bw_comm *comm, const int n[3], int way, int periodic, bool *fits)
{
  grid_case c = {.n = {n[0], n[1], n[2]}, .periodic = periodic, .halo = 1, .comm = comm};
  *fits = grid_case_divide(&c, way, bw_comm_size(bw_check_world()));
  return *fits ? grid_case_create(&c) : NULL;
}

static void put_all(bw_transpose *t, const bw_grid_view *v, int columns)
{
  bw_real rows[3][300];
  for (int j = 0; j < v->m[1]; j++)
    for (int k = 0; k < v->m[2]; k += 3) {
      const int n = v->m[2] - k < 3 ? v->m[2] - k : 3;
      for (int r = 0; r < n; r++)
        for (int c = 0; c < columns; c++)
          rows[r][c] = (bw_real)code(c, v->lo[1] + j, v->lo[2] + k + r);
      bw_transpose_put(t, j, k, n, rows[0], 300);
    }
}

/* Every block holds all of z of its columns; each number is halved. Returns the numbers seen. */
static double halve_blocks(bw_transpose *t, const bw_grid_view *v)
{
  double seen = 0;
  for (int b = 0; b < bw_transpose_blocks(t); b++) {
    const bw_columns columns = bw_transpose_columns(t, b);
    bw_real *a = bw_transpose_open(t, b);
    ck_assert_int_le(columns.width, bw_transpose_columns(t, 0).width);
    for (int j = 0; j < v->m[1]; j++) {
      bw_transpose_fetch(t, j);
      for (int k = 0; k < v->n[2]; k++)
        for (int c = 0; c < columns.width; c++, seen++) {
          bw_real *x = &a[((ptrdiff_t)j * v->n[2] + k) * columns.width + c];
          ck_assert_double_eq((double)*x, code(columns.first + c, v->lo[1] + j, k));
          *x /= 2;
        }
      bw_transpose_store(t, j);
    }
  }
  return seen;
}

static void check_round_trip(const bw_comm *comm, const int n[3], int columns, int way)
{
  bool fits;
  bw_grid *grid = make(comm, n, way, 0, &fits);
  if (!fits) return;
  const bw_grid_view *v = bw_grid_look(grid);
  bw_transpose *t = NULL;
  bw_check_ok(bw_transpose_create(grid, columns, columns % 2 == 0 ? 2 : 1, &t));
  put_all(t, v, columns);
  bw_transpose_to_z(t);
  double seen = halve_blocks(t, v);
  bw_comm_sum(bw_check_world(), 1, &seen);
  ck_assert_double_eq(seen, (double)columns * v->n[1] * v->n[2]);
  bw_transpose_to_x(t);
  for (int j = 0; j < v->m[1]; j++)
    for (int k = 0; k < v->m[2]; k++) {
      bw_real row[300];
      bw_transpose_get(t, j, k, 1, row, 300);
      for (int c = 0; c < columns; c++)
        ck_assert_double_eq((double)row[c], code(c, v->lo[1] + j, v->lo[2] + k) / 2);
    }
  ck_assert_int_eq(bw_transpose_volume(t) == 0, v->ranks[2] == 1);
  bw_grid_sent halo, swap;
  bw_grid_traffic(grid, &halo, &swap);
  ck_assert_uint_eq(swap.bytes, bw_transpose_volume(t));
  if (comm != NULL) ck_assert_uint_le(swap.bytes, (size_t)swap.messages * GRID_SHORT_MESSAGE);
  bw_transpose_destroy(&t);
  bw_grid_destroy(&grid);
}

START_TEST(rows_become_columns_and_return)
{
  bw_comm *cut = grid_short_messages();
  for (int way = 0; way < GRID_WAYS; way++)
    for (int q = 0; q < 2; q++) {
      const bw_comm *comm = q == 0 ? NULL : cut;
      check_round_trip(comm, (const int[]){4, 9, 7}, 46, way);
      check_round_trip(comm, (const int[]){4, 5, 12}, 2, way); /* ranks without columns */
      check_round_trip(comm, (const int[]){4, 5, 7}, 1, way);  /* a single number a row */
      check_round_trip(comm, (const int[]){4, 4, 8}, 45, way); /* not in pairs */
      check_round_trip(comm, (const int[]){4, 8, 1}, 290, way);
      check_round_trip(comm, (const int[]){4, 8, 4}, 64, way);
    }
  bw_comm_destroy(&cut);
}
END_TEST

START_TEST(bad_grain_is_refused)
{
  bool fits;
  bw_grid *grid = make(NULL, (const int[]){4, 8, 8}, 0, false, &fits);
  bw_transpose *t = NULL;
  bw_check_status(bw_transpose_create(grid, 7, 2, &t), BW_EINPUT);
  ck_assert_ptr_null(t);
  bw_grid_destroy(&grid);
}
END_TEST

/* x of line l in row j (1..n): smooth in neither. */
static double wanted(int j, size_t l)
{
  return sin(1.7 * j + 0.3 * (double)l) + 0.5 * cos(5.1 * j * (double)(l + 1));
}

static const double scale = 0.25;

/* f such that `wanted` solves  lower x_{j-1} + (diagonal + shift_l) x_j + upper x_{j+1} = scale f.
 */
static void fill(const bw_grid_view *v, int d, const double *lower, const double *diagonal,
                 const double *upper, size_t lines, const bw_real *shift, bw_real *f)
{
  const int n = v->n[d];
  for (int j = 1; j <= v->m[d]; j++)
    for (size_t l = 0; l < lines; l++) {
      const int g = v->lo[d] + j, before = g == 1 ? n : g - 1, after = g == n ? 1 : g + 1;
      f[(size_t)(j - 1) * lines + l] =
          (bw_real)((lower[g - 1] * wanted(before, l) + upper[g - 1] * wanted(after, l) +
                     (diagonal[g - 1] + (double)shift[l]) * wanted(g, l)) /
                    scale);
    }
}

static void solve(bw_tridiagonal *t, size_t lines, const bw_real *shift, bw_real *f)
{
  for (int pass = bw_tridiagonal_coupled(t) ? 0 : 1; pass < 2; pass++) {
    for (size_t l = 0; l < lines; l += BW_TRIDIAGONAL_LINES) {
      const bw_tridiagonal_batch b = {.first = l,
                                      .n = lines - l < BW_TRIDIAGONAL_LINES ? (int)(lines - l)
                                                                            : BW_TRIDIAGONAL_LINES,
                                      .pitch = (ptrdiff_t)lines,
                                      .shift = shift + l,
                                      .scale = (bw_real)scale};
      if (pass == 0)
        bw_tridiagonal_reduce(t, &b, f + l);
      else
        bw_tridiagonal_finish(t, &b, f + l);
    }
    if (pass == 0) bw_tridiagonal_join(t);
  }
}

static void check_lines(int d, int rows, size_t lines, bool cyclic, int way)
{
  bool fits;
  const int n[3] = {2, d == 1 ? rows : 4, d == 2 ? rows : 1};
  bw_grid *grid = make(NULL, n, way, cyclic ? 1 << d : 0, &fits);
  if (!fits) return;
  const bw_grid_view *v = bw_grid_look(grid);
  double lower[40], diagonal[40], upper[40];
  for (int j = 0; j < rows; j++) { /* dominant by 0.2 and more: amplification below 5 */
    lower[j] = 1 + 0.3 * sin(2.0 * j);
    upper[j] = 0.8 + 0.5 * cos(3.0 * j);
    diagonal[j] = -(lower[j] + upper[j]) - 0.2;
  }
  if (!cyclic) lower[0] = upper[rows - 1] = 0;
  bw_real *f = NULL, *shift = NULL;
  bw_tridiagonal *t = NULL;
  bw_check_ok(BW_ALLOCATE(&f, lines * (size_t)v->m[d]));
  bw_check_ok(BW_ALLOCATE(&shift, lines));
  for (size_t l = 0; l < lines; l++)
    shift[l] = (bw_real)(-0.01 * (double)l);
  bw_check_ok(bw_tridiagonal_create(grid, d, lines, &t));
  bw_tridiagonal_set(t, lower, diagonal, upper, cyclic);
  fill(v, d, lower, diagonal, upper, lines, shift, f);
  solve(t, lines, shift, f);
  for (int j = 1; j <= v->m[d]; j++)
    for (size_t l = 0; l < lines; l++) /* error: 5 x the round-off of f, about 10 epsilon |f| */
      bw_check_near(f[(size_t)(j - 1) * lines + l], wanted(v->lo[d] + j, l),
                    5 * 10 * 10 * BW_REAL_EPSILON);
  bw_tridiagonal_destroy(&t);
  bw_release(&f), bw_release(&shift);
  bw_grid_destroy(&grid);
}

static void check_direction(int d)
{
  static const size_t lines[] = {1, 3, 130, 300};
  for (int rows = 4; rows < 38; rows += 3) /* down to one row per rank */
    for (int l = 0; l < 4; l++)
      for (int way = 0; way < GRID_WAYS; way++) {
        check_lines(d, rows, lines[l], false, way);
        check_lines(d, rows, lines[l], true, way);
      }
}

START_TEST(lines_over_the_ranks_in_y)
{
  check_direction(1);
  if (bw_comm_size(bw_check_world()) <= 2) check_lines(1, 2, 5, true, 0);
}
END_TEST

START_TEST(lines_over_the_ranks_in_z)
{
  check_direction(2);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(rows_become_columns_and_return), BW_TEST(bad_grain_is_refused),
    BW_TEST(lines_over_the_ranks_in_y), BW_TEST(lines_over_the_ranks_in_z)};
BW_CHECK_MAIN("grid.transpose", tests)
