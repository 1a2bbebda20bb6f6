/* Poisson: the residual of the discrete operator at round-off for every pair of conditions in every
 * direction, on every division of the ranks; means; independence of the ranks; Helmholtz.
 * TEST ranks=1,2,3,4 timeout=3600 */
#include "../../../validation/poisson/laplacian.h"
#include "bw_check.h"
#include <string.h>

/* Division `way` of the ranks (every pair of factors that fits); false when there is none. */
static bool divide(poisson_case *c, int way)
{
  const int size = bw_comm_size(bw_check_world());
  int found = 0;
  for (int r = 1; r <= size; r++)
    if (size % r == 0 && (c->n[2] > 1 || r == size) && found++ == way) {
      c->ranks[0] = r;
      c->ranks[1] = size / r;
      return true;
    }
  return false;
}

static bw_grid *make_grid(const poisson_case *c)
{
  bw_grid *grid = NULL;
  bw_check_ok(poisson_case_grid(bw_check_world(), c, &grid));
  return grid;
}

static bw_real *noise(bw_grid *grid)
{
  bw_real *f = NULL;
  bw_check_ok(bw_field_create(grid, &f));
  poisson_fill_noise(grid, f);
  return f;
}

/* Units of epsilon |A| max|phi|: one residual sums seven rounded products (the error of phi itself
 * enters through A again, a few more by the additions of four transforms). Measured: 1.2. */
static const double limit = 6;

static void check(const poisson_case *c)
{
  bw_grid *grid = make_grid(c);
  bw_real *f = noise(grid), *phi = noise(grid);
  bw_poisson *p = NULL;
  bw_check_ok(bw_poisson_create(grid, SIDES(c), &p));
  const double mean = bw_poisson_singular(p) ? poisson_mean(grid, f) : 0;
  bw_poisson_solve(p, phi);
  const double r = poisson_residual(grid, c, 0, -1, mean, phi, f);
  ck_assert_msg(r <= limit, "residual %g of round-off: n %d %d %d, x %d%d y %d%d z %d%d, %s, %dx%d",
                r, c->n[0], c->n[1], c->n[2], c->side[0][0], c->side[0][1], c->side[1][0],
                c->side[1][1], c->side[2][0], c->side[2][1], c->stretched ? "tanh" : "uniform",
                c->ranks[0], c->ranks[1]);
  bw_check_near(bw_poisson_removed_mean(p), mean, 10 * BW_REAL_EPSILON);
  if (bw_poisson_singular(p)) bw_check_near(poisson_mean(grid, phi), 0, 20 * BW_REAL_EPSILON);
  bw_poisson_destroy(&p);
  bw_release(&f), bw_release(&phi);
  bw_grid_destroy(&grid);
}

static void check_all_pairs(const int odd[3], const int even[3], bool stretched)
{
  for (int q = 0; q < POISSON_PAIRS * POISSON_PAIRS * POISSON_PAIRS; q++) {
    const int x = q % POISSON_PAIRS, y = q / POISSON_PAIRS % POISSON_PAIRS,
              z = q / POISSON_PAIRS / POISSON_PAIRS;
    poisson_case c = {.stretched = stretched, .halo = 1};
    poisson_case_sides(&c, x, y, z);
    if (stretched && c.side[1][0] == BW_POISSON_PERIODIC) continue;
    for (int parity = 0; parity < 2; parity++)
      for (int way = 0; way < 3; way++) {
        memcpy(c.n, parity == 0 ? odd : even, sizeof c.n);
        if (c.n[2] == 1 && z > 1) continue;
        if (divide(&c, way)) check(&c);
      }
  }
}

START_TEST(residual_in_3d_uniform)
{
  check_all_pairs((const int[]){7, 9, 5}, (const int[]){10, 4, 6}, false);
}
END_TEST

START_TEST(residual_in_3d_stretched)
{
  check_all_pairs((const int[]){5, 7, 9}, (const int[]){4, 8, 10}, true);
}
END_TEST

START_TEST(residual_in_2d)
{
  check_all_pairs((const int[]){9, 7, 1}, (const int[]){12, 10, 1}, false);
  check_all_pairs((const int[]){11, 9, 1}, (const int[]){6, 12, 1}, true);
}
END_TEST

/* Blocks of full width, several batches of lines, rows beyond one bundle, two halo layers. */
START_TEST(residual_on_larger_grids)
{
  static const int sizes[][3] = {{46, 12, 40}, {33, 21, 18}, {150, 14, 1}, {2, 6, 150}};
  for (int s = 0; s < 4; s++)
    for (int way = 0; way < 3; way++)
      for (int x = 0; x < 2; x++) {
        poisson_case c = {.halo = 2, .stretched = x == 1};
        memcpy(c.n, sizes[s], sizeof c.n);
        poisson_case_sides(&c, x, x, 1 - x);
        if (divide(&c, way) && c.n[1] / c.ranks[0] >= 2) check(&c);
      }
}
END_TEST

START_TEST(helmholtz)
{
  for (int q = 0; q < 27; q++)
    for (int way = 0; way < 3; way++) {
      poisson_case c = {.n = {8, 9, 7}, .halo = 1, .stretched = q / 3 % 3 != 0};
      poisson_case_sides(&c, q % 3, q / 3 % 3, q / 9);
      if (!divide(&c, way)) continue;
      bw_grid *grid = make_grid(&c);
      bw_real *f = noise(grid), *phi = noise(grid);
      bw_poisson *p = NULL;
      bw_check_ok(bw_poisson_create(grid, SIDES(&c), &p));
      const double alpha = 0.01 * (1 + q);
      bw_poisson_solve_helmholtz(p, alpha, phi);
      ck_assert_double_le(poisson_residual(grid, &c, 1, alpha, 0, phi, f), limit);
      memcpy(phi, f, bw_grid_look(grid)->size * sizeof *phi);
      bw_poisson_solve(p, phi); /* the operator is set anew each time */
      const double mean = bw_poisson_singular(p) ? poisson_mean(grid, f) : 0;
      ck_assert_double_le(poisson_residual(grid, &c, 0, -1, mean, phi, f), limit);
      bw_poisson_destroy(&p);
      bw_release(&f), bw_release(&phi);
      bw_grid_destroy(&grid);
    }
}
END_TEST

/* The same cells on this rank alone and on all ranks. Both are within round-off of the exact
 * solution: the difference is bounded by the condition number of the operator times epsilon. */
START_TEST(solution_is_independent_of_the_ranks)
{
  bw_comm *alone = NULL;
  bw_check_ok(bw_comm_self(&alone));
  for (int way = 0; way < 3; way++)
    for (int pair = 0; pair < POISSON_PAIRS; pair++) {
      poisson_case c = {.n = {12, 10, 9}, .halo = 1};
      poisson_case_sides(&c, pair, (pair + 1) % 5, (pair + 3) % 5);
      if (!divide(&c, way)) continue;
      bw_grid *all = make_grid(&c), *one = NULL;
      bw_grid_config g = bw_grid_config_default();
      for (int d = 0; d < 3; d++) {
        g.n[d] = c.n[d];
        g.length[d] = bw_grid_look(all)->length[d];
        g.periodic[d] = bw_grid_look(all)->periodic[d];
      }
      bw_check_ok(bw_grid_create(alone, &g, &one));
      bw_poisson *p = NULL, *q = NULL;
      bw_check_ok(bw_poisson_create(all, SIDES(&c), &p));
      bw_check_ok(bw_poisson_create(one, SIDES(&c), &q));
      bw_real *a = noise(all), *b = noise(one);
      bw_poisson_solve(p, a);
      bw_poisson_solve(q, b);
      const bw_grid_view *v = bw_grid_look(all), *w = bw_grid_look(one);
      double worst = 0;
      FOR_CELLS(v, i, j, k)
      worst = fmax(
          worst, fabs((double)(a[bw_at(v, i, j, k)] - b[bw_at(w, i, v->lo[1] + j, v->lo[2] + k)])));
      ck_assert_double_le(worst, BW_REAL_EPSILON * poisson_operator_norm(v));
      bw_poisson_destroy(&p), bw_poisson_destroy(&q);
      bw_release(&a), bw_release(&b);
      bw_grid_destroy(&all), bw_grid_destroy(&one);
    }
  bw_comm_destroy(&alone);
}
END_TEST

static void refused(poisson_case c, bool periodic_grid, const char *word)
{
  poisson_case g = c;
  poisson_case_sides(&g, periodic_grid ? 0 : 1, periodic_grid ? 0 : 1, periodic_grid ? 0 : 1);
  bw_grid *grid = make_grid(&g);
  bw_poisson *p = NULL;
  bw_check_status(bw_poisson_create(grid, SIDES(&c), &p), BW_EINPUT);
  ck_assert_ptr_null(p);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "\"%s\" does not say \"%s\"",
                bw_last_message(), word);
  bw_poisson_destroy(&p);
  bw_grid_destroy(&grid);
}

START_TEST(contradictions_are_refused)
{
  poisson_case c = {.n = {6, 6, 6}, .halo = 1};
  poisson_case_sides(&c, 0, 1, 1), refused(c, false, "x is periodic");
  poisson_case_sides(&c, 0, 0, 1), refused(c, true, "z is Neumann");
  poisson_case_sides(&c, 1, 1, 1), c.side[1][0] = BW_POISSON_PERIODIC, refused(c, false, "pairs");
  c.n[2] = 1;
  poisson_case_sides(&c, 1, 1, 2), refused(c, false, "one cell");
  /* One such side is enough. */
  for (int s = 0; s < 2; s++) {
    poisson_case_sides(&c, 1, 1, 1);
    c.side[2][s] = BW_POISSON_DIRICHLET, c.side[2][1 - s] = BW_POISSON_NEUMANN;
    refused(c, false, "one cell");
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(residual_in_3d_uniform),
                                      BW_TEST(residual_in_3d_stretched),
                                      BW_TEST(residual_in_2d),
                                      BW_TEST(residual_on_larger_grids),
                                      BW_TEST(helmholtz),
                                      BW_TEST(solution_is_independent_of_the_ranks),
                                      BW_TEST(contradictions_are_refused)};
BW_CHECK_MAIN("poisson.poisson", tests)
