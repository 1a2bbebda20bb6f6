/* Set-up: what the conditions mean for transforms, eigenvalues and the rows of the systems in y. */
#include "bw_memory.h"
#include "poisson_internal.h"

#include <math.h>

enum { LINE = 64 / (int)sizeof(bw_real) };

static const char *const side_name[] = {"periodic", "Neumann", "Dirichlet"};
static const char axis[] = "xyz";

static bw_status check(const bw_grid_view *v, const bw_poisson_side side[3][2])
{
  for (int d = 0; d < 3; d++) {
    for (int e = 0; e < 2; e++)
      BW_REQUIRE(side[d][e] >= BW_POISSON_PERIODIC && side[d][e] <= BW_POISSON_DIRICHLET, BW_EINPUT,
                 "poisson: side[%d][%d] = %d is no condition", d, e, (int)side[d][e]);
    /* Periodic is a property of both sides of a direction, and of the grid. */
    const bool periodic = side[d][0] == BW_POISSON_PERIODIC;
    BW_REQUIRE(periodic == (side[d][1] == BW_POISSON_PERIODIC), BW_EINPUT,
               "poisson: %c is %s below and %s above; periodic comes in pairs", axis[d],
               side_name[side[d][0]], side_name[side[d][1]]);
    /* 2D: every difference in z is zero, which suits any side that does not fix the value. */
    if (d == 2 && v->n[2] == 1) {
      BW_REQUIRE(side[2][0] != BW_POISSON_DIRICHLET && side[2][1] != BW_POISSON_DIRICHLET,
                 BW_EINPUT,
                 "poisson: z has one cell and a Dirichlet side; use periodic or Neumann");
      continue;
    }
    BW_REQUIRE(periodic == v->periodic[d], BW_EINPUT,
               "poisson: %c is %s here, but %speriodic on the grid", axis[d], side_name[side[d][0]],
               v->periodic[d] ? "" : "not ");
  }
  return BW_OK;
}

/* (d2 phi/dy2)_j = ((phi_{j+1}-phi_j)/(yc_{j+1}-yc_j) - (phi_j-phi_{j-1})/(yc_j-yc_{j-1})) /
 * (yf_j - yf_{j-1}); the coefficient to a ghost folds into the diagonal: phi_0 = phi_1 (Neumann),
 * -phi_1 (Dirichlet). */
static void second_difference(const bw_grid_view *v, const bw_poisson_side side[2], double lower[],
                              double diagonal[], double upper[])
{
  const int n = v->n[1];
  /* Rows as they are inside the box; the mirrored centres of the ghosts give the distance across a
   * boundary face. */
  for (int j = 1; j <= n; j++) {
    const double height = v->y_face[j] - v->y_face[j - 1];
    lower[j - 1] = 1.0 / ((v->y_centre[j] - v->y_centre[j - 1]) * height);
    upper[j - 1] = 1.0 / ((v->y_centre[j + 1] - v->y_centre[j]) * height);
    diagonal[j - 1] = -(lower[j - 1] + upper[j - 1]);
  }
  if (side[0] == BW_POISSON_PERIODIC) return;
  /* The ghosts are gone from here on: phi_0 = phi_1 (Neumann) or -phi_1 (Dirichlet) joins the
   * diagonal. */
  diagonal[0] += (side[0] == BW_POISSON_NEUMANN ? 1 : -1) * lower[0];
  diagonal[n - 1] += (side[1] == BW_POISSON_NEUMANN ? 1 : -1) * upper[n - 1];
  lower[0] = upper[n - 1] = 0.0;
}

static bw_status allocate(bw_poisson *p, int columns)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  double **const y_arrays[] = {&p->lower,          &p->diagonal,          &p->upper,
                               &p->operator_lower, &p->operator_diagonal, &p->operator_upper};
  for (int q = 0; q < 6; q++)
    BW_TRY(BW_ALLOCATE(y_arrays[q], (size_t)v->n[1]));
  BW_TRY(BW_ALLOCATE(&p->lambda_x, (size_t)columns));
  BW_TRY(BW_ALLOCATE(&p->lambda_z, (size_t)v->n[2]));
  /* Rows on their way to the blocks each begin on a cache line. */
  p->row_stride = (columns + LINE - 1) / LINE * LINE;
  return BW_ALLOCATE(&p->rows, (size_t)p->row_stride * BW_POISSON__ROWS);
}

/* Plans for z: the blocks of this rank have one or two widths. */
static bw_status plan_z(bw_poisson *p)
{
  const int n = bw_grid_look(p->grid)->n[2], blocks = bw_transpose_blocks(p->transpose);
  if (n == 1 || blocks == 0) return BW_OK;
  const int wide = bw_transpose_columns(p->transpose, 0).width;
  const int narrow = bw_transpose_columns(p->transpose, blocks - 1).width;
  BW_TRY(bw_poisson__columns_create(p->kind[2], n, wide, p->real_x, &p->z[0]));
  if (narrow == wide) return BW_OK;
  return bw_poisson__columns_create(p->kind[2], n, narrow, p->real_x, &p->z[1]);
}

static size_t count_lines(const bw_poisson *p)
{
  size_t n = 0;
  for (int b = 0; b < bw_transpose_blocks(p->transpose); b++)
    n += (size_t)bw_transpose_columns(p->transpose, b).width;
  return n * (size_t)bw_grid_look(p->grid)->n[2];
}

static void fill_eigenvalues(bw_poisson *p, int columns)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  /* A complex number of a Fourier row has one eigenvalue for its two entries. */
  for (int c = 0; c < columns; c++) {
    const int entry = c < v->n[0] ? c : v->n[0] - 1; /* a zero behind the reals: any will do */
    p->lambda_x[c] =
        bw_poisson__eigenvalue(p->kind[0], v->n[0], v->spacing[0], p->real_x ? entry : c / 2);
  }
  for (int k = 0; v->n[2] > 1 && k < v->n[2]; k++)
    p->lambda_z[k] = bw_poisson__eigenvalue(p->kind[2], v->n[2], v->spacing[2], k);
}

static bw_status build(bw_poisson *p, const bw_poisson_side side[3][2])
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  /* Without a Dirichlet side anywhere the constants are in the null space of the operator. */
  p->singular = true;
  for (int d = 0; d < 3; d++) {
    p->kind[d] = bw_poisson__find(side[d]);
    for (int e = 0; e < 2; e++)
      p->singular = p->singular && side[d][e] != BW_POISSON_DIRICHLET;
  }
  /* What a transform of x yields decides how z reads a block: complex numbers, or real columns side
   * by side. */
  p->real_x = p->kind[0]->family != BW_POISSON__FOURIER;
  p->coupled = v->ranks[1] > 1 || v->periodic[1];
  const int columns = bw_poisson__columns(p->kind[0], v->n[0]);
  BW_TRY(allocate(p, columns));
  fill_eigenvalues(p, columns);
  second_difference(v, side[1], p->lower, p->diagonal, p->upper);
  return bw_poisson__rows_create(p->kind[0], v->n[0], &p->x);
}

bw_status bw_poisson_create(bw_grid *grid, const bw_poisson_side side[3][2], bw_poisson **out)
{
  const bw_comm *comm = bw_grid_comm(grid);
  bw_poisson *p = NULL;
  bw_status st = BW_ALLOCATE(&p, 1);
  BW_THEN(st, check(bw_grid_look(grid), side));
  if (st == BW_OK) {
    p->grid = grid;
    st = build(p, side);
  }
  /* Local work is done. What follows is collective, and needs to know the number of columns. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK)
    st = bw_transpose_create(grid, bw_poisson__columns(p->kind[0], bw_grid_look(grid)->n[0]), 2,
                             &p->transpose);
  /* One line in y for every x-entry and every k of this rank's columns. */
  BW_THEN(st, bw_tridiagonal_create(grid, 1, count_lines(p), &p->tridiagonal));
  if (st == BW_OK) st = bw_comm_agree(comm, plan_z(p));
  if (st != BW_OK) bw_poisson_destroy(&p);
  *out = p;
  return st;
}

void bw_poisson_destroy(bw_poisson **poisson)
{
  bw_poisson *p = *poisson;
  if (p == NULL) return;
  bw_poisson__transform_destroy(&p->x);
  bw_poisson__transform_destroy(&p->z[0]);
  bw_poisson__transform_destroy(&p->z[1]);
  bw_transpose_destroy(&p->transpose);
  bw_tridiagonal_destroy(&p->tridiagonal);
  bw_release(&p->lambda_x);
  bw_release(&p->lambda_z);
  bw_release(&p->lower);
  bw_release(&p->diagonal);
  bw_release(&p->upper);
  bw_release(&p->operator_lower);
  bw_release(&p->operator_diagonal);
  bw_release(&p->operator_upper);
  bw_release(&p->rows);
  bw_release(poisson);
}

bool bw_poisson_singular(const bw_poisson *p)
{
  return p->singular;
}

double bw_poisson_removed_mean(const bw_poisson *p)
{
  return p->removed_mean;
}
