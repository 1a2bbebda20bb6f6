/* grid_cases.h -- the grids that every test of the halo runs over. */
#pragma once
#include "bw_check.h"
#include "bw_grid.h"
#include "bw_memory.h"

typedef struct {
  int n[3];
  int periodic; /* bits: x, y, z */
  int halo;
  int ranks[2];
  const bw_comm *comm; /* NULL: the world */
} grid_case;

/* The ranks of the world, with messages of at most so many bytes: not a whole number of bw_reals.
 */
enum { GRID_SHORT_MESSAGE = 101 };
static inline bw_comm *grid_short_messages(void)
{
  bw_comm *comm = NULL;
  bw_check_ok(bw_comm_copy(bw_check_world(), GRID_SHORT_MESSAGE, &comm));
  return comm;
}

/* Non-cubic, odd, 2D; every combination of periodic directions; both halo widths. */
static inline grid_case grid_case_number(int q)
{
  static const int sizes[3][3] = {{5, 9, 8}, {2, 11, 13}, {7, 10, 1}};
  grid_case c = {.periodic = q % 8, .halo = 1 + q / 8 % 2};
  for (int d = 0; d < 3; d++)
    c.n[d] = sizes[q / 16 % 3][d];
  return c;
}
enum { GRID_CASES = 48 };

/* Division `way` of the ranks: chosen by the grid, then every pair of factors. False: none such,
 * or it does not fit. */
static inline bool grid_case_divide(grid_case *c, int way, int size)
{
  c->ranks[0] = c->ranks[1] = 0;
  if (way == 0) return true;
  int found = 0;
  for (int r = 1; r <= size; r++)
    if (size % r == 0 && ++found == way) {
      c->ranks[0] = r;
      c->ranks[1] = size / r;
      return c->n[2] > 1 || c->ranks[1] == 1;
    }
  return false;
}
enum { GRID_WAYS = 4 }; /* up to three pairs of factors of 1..4 */

static inline bw_grid *grid_case_create(const grid_case *c)
{
  bw_grid_config g = bw_grid_config_default();
  for (int d = 0; d < 3; d++) {
    g.n[d] = c->n[d];
    g.length[d] = 1.0 + 0.5 * d;
    g.periodic[d] = (c->periodic >> d & 1) != 0;
  }
  g.halo = c->halo;
  g.ranks[0] = c->ranks[0];
  g.ranks[1] = c->ranks[1];
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(c->comm != NULL ? c->comm : bw_check_world(), &g, &grid));
  return grid;
}
