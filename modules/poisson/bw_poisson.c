/* A solve: rows transformed along x go into blocks of columns; each block, small enough for the
 * cache, is transformed along z, solved along y and transformed back in one visit (two visits,
 * with one message round between, when y is divided); rows return transformed back. The field
 * is read and written once, the blocks twice. */
#include "bw_memory.h"
#include "bw_transpose.h"
#include "bw_tridiagonal.h"
#include "poisson_internal.h"

#include <math.h>

enum { ROWS = 8 }; /* x-rows on their way to the blocks together: they fit the first-level cache */
enum { LINE = 64 / (int)sizeof(bw_real) };

struct bw_poisson {
  bw_grid *grid;
  const bw_poisson__kind *kind[3];
  bool singular, real_x; /* real_x: x-entries are no complex numbers */
  bool coupled;          /* coupled: the lines in y need all ranks in y, or are cyclic */
  double removed_mean;
  bw_poisson__transform x, z[2]; /* z: of blocks of full width, of the last one */
  bw_transpose *transpose;
  bw_tridiagonal *tridiagonal;
  double *lambda_x, *lambda_z;      /* (columns), (n2) */
  double *lower, *diagonal, *upper; /* (n1) of d2/dy2, then of the operator being solved */
  double *operator_lower, *operator_diagonal, *operator_upper;
  bw_real *rows; /* (ROWS, row_stride) */
  ptrdiff_t row_stride;
};

/* (shift + factor lap) is solved for. */
typedef struct {
  double shift, factor;
} operator_;

static const char *const side_name[] = {"periodic", "Neumann", "Dirichlet"};
static const char axis[] = "xyz";

static bw_status check(const bw_grid_view *v, const bw_poisson_side side[3][2])
{
  for (int d = 0; d < 3; d++) {
    for (int e = 0; e < 2; e++)
      BW_REQUIRE(side[d][e] >= BW_POISSON_PERIODIC && side[d][e] <= BW_POISSON_DIRICHLET, BW_EINPUT,
                 "poisson: side[%d][%d] = %d is no condition", d, e, (int)side[d][e]);
    const bool periodic = side[d][0] == BW_POISSON_PERIODIC;
    BW_REQUIRE(periodic == (side[d][1] == BW_POISSON_PERIODIC), BW_EINPUT,
               "poisson: %c is %s below and %s above; periodic comes in pairs", axis[d],
               side_name[side[d][0]], side_name[side[d][1]]);
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
  for (int j = 1; j <= n; j++) {
    const double height = v->y_face[j] - v->y_face[j - 1];
    lower[j - 1] = 1.0 / ((v->y_centre[j] - v->y_centre[j - 1]) * height);
    upper[j - 1] = 1.0 / ((v->y_centre[j + 1] - v->y_centre[j]) * height);
    diagonal[j - 1] = -(lower[j - 1] + upper[j - 1]);
  }
  if (side[0] == BW_POISSON_PERIODIC) return;
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
  p->row_stride = (columns + LINE - 1) / LINE * LINE;
  return BW_ALLOCATE(&p->rows, (size_t)p->row_stride * ROWS);
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
  p->singular = true;
  for (int d = 0; d < 3; d++) {
    p->kind[d] = bw_poisson__find(side[d]);
    for (int e = 0; e < 2; e++)
      p->singular = p->singular && side[d][e] != BW_POISSON_DIRICHLET;
  }
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
  st = bw_comm_agree(comm, st);
  if (st == BW_OK)
    st = bw_transpose_create(grid, bw_poisson__columns(p->kind[0], bw_grid_look(grid)->n[0]), 2,
                             &p->transpose);
  BW_THEN(st, bw_tridiagonal_create(grid, count_lines(p), &p->tridiagonal));
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

/* Field -> X side. Returns the volume integral of f over this rank's rows, times the norm of x
 * over (dx dz n0): entry 0 of a row is its sum times that norm. */
static double rows_in(bw_poisson *p, bw_real *phi)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  double sum = 0;
  for (int j = 1; j <= v->m[1]; j++) {
    double plane = 0;
    for (int k = 1; k <= v->m[2]; k += ROWS) {
      const int rows = v->m[2] - k + 1 < ROWS ? v->m[2] - k + 1 : ROWS;
      for (int r = 0; r < rows; r++) {
        bw_real *row = p->rows + r * p->row_stride;
        bw_poisson__row_forward(&p->x, phi + bw_at(v, 1, j, k + r), row);
        plane += (double)row[0];
      }
      bw_transpose_put(p->transpose, j - 1, k - 1, rows, p->rows, p->row_stride);
    }
    sum += plane * (v->y_face[v->lo[1] + j] - v->y_face[v->lo[1] + j - 1]);
  }
  return sum;
}

static void rows_out(bw_poisson *p, bw_real *phi)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  for (int j = 1; j <= v->m[1]; j++)
    for (int k = 1; k <= v->m[2]; k += ROWS) {
      const int rows = v->m[2] - k + 1 < ROWS ? v->m[2] - k + 1 : ROWS;
      bw_transpose_get(p->transpose, j - 1, k - 1, rows, p->rows, p->row_stride);
      for (int r = 0; r < rows; r++)
        bw_poisson__row_backward(&p->x, p->rows + r * p->row_stride, phi + bw_at(v, 1, j, k + r));
    }
}

/* A block and what a visit needs to know of it. */
typedef struct {
  bw_real *at; /* [m1][n2][width] */
  bw_columns columns;
  size_t first_line;
  ptrdiff_t plane; /* n2 width */
} visit;

static void transform_z(const bw_poisson *p, const visit *b, bool forward)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  if (v->n[2] == 1) return;
  const bool wide = b->columns.width == bw_transpose_columns(p->transpose, 0).width;
  const bw_poisson__transform *z = &p->z[wide ? 0 : 1];
  for (int j = 0; j < v->m[1]; j++)
    if (forward)
      bw_poisson__columns_forward(z, b->at + j * b->plane);
    else
      bw_poisson__columns_backward(z, b->at + j * b->plane);
}

static double norm(const bw_poisson *p, int d)
{
  const int n = bw_grid_look(p->grid)->n[d];
  return d == 2 && n == 1 ? 1.0 : (double)p->kind[d]->norm * n;
}

/* Planes k0.. of a block as one batch of lines; shift is filled. The mean mode (x-entry 0, k = 0)
 * of a singular operator is pinned, and with it the imaginary part of a complex one. */
static bw_tridiagonal_batch batch(const bw_poisson *p, const operator_ *op, const visit *b, int k0,
                                  int planes, bw_real shift[])
{
  const int width = b->columns.width;
  for (int k = 0; k < planes; k++)
    for (int c = 0; c < width; c++)
      shift[k * width + c] =
          (bw_real)(op->factor * (p->lambda_z[k0 + k] + p->lambda_x[b->columns.first + c]));
  const bool mean_mode = p->singular && op->shift == 0 && k0 == 0 && b->columns.first == 0;
  return (bw_tridiagonal_batch){.first = b->first_line + (size_t)k0 * (size_t)width,
                                .n = planes * width,
                                .pitch = b->plane,
                                .shift = shift,
                                .scale = (bw_real)(1.0 / (norm(p, 0) * norm(p, 2))),
                                .pinned = !mean_mode  ? 0
                                          : p->real_x ? 1
                                                      : 2};
}

/* The mean mode without the mean of f. */
static void remove_mean_f(const bw_poisson *p, bw_real *line, ptrdiff_t plane)
{
  const int m1 = bw_grid_look(p->grid)->m[1];
  const bw_real mean = (bw_real)(p->removed_mean * norm(p, 0) * norm(p, 2));
  for (int j = 0; j < m1; j++)
    line[j * plane] -= mean;
}

/* The mean mode without its mean, which is phi's. Collective over the line in y. */
static void remove_mean_phi(const bw_poisson *p, bw_real *line, ptrdiff_t plane)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  const double *face = v->y_face + v->lo[1];
  double sum = 0;
  for (int j = 0; j < v->m[1]; j++)
    sum += (double)line[j * plane] * (face[j + 1] - face[j]);
  bw_grid_line_sum(p->grid, 1, 1, &sum);
  for (int j = 0; j < v->m[1]; j++)
    line[j * plane] -= (bw_real)(sum / v->length[1]);
}

static int planes_per_batch(int width)
{
  return width < BW_TRIDIAGONAL_LINES ? BW_TRIDIAGONAL_LINES / width : 1;
}

static void reduce(bw_poisson *p, const operator_ *op, const visit *b)
{
  const int n = bw_grid_look(p->grid)->n[2], step = planes_per_batch(b->columns.width);
  bw_real shift[BW_TRIDIAGONAL_LINES];
  for (int k = 0; k < n; k += step) {
    const bw_tridiagonal_batch lines = batch(p, op, b, k, n - k < step ? n - k : step, shift);
    bw_real *at = b->at + k * b->columns.width;
    if (lines.pinned > 0) remove_mean_f(p, at, b->plane);
    bw_tridiagonal_reduce(p->tridiagonal, &lines, at);
  }
}

static void finish(bw_poisson *p, const operator_ *op, const visit *b)
{
  const int n = bw_grid_look(p->grid)->n[2], step = planes_per_batch(b->columns.width);
  bw_real shift[BW_TRIDIAGONAL_LINES];
  for (int k = 0; k < n; k += step) {
    const bw_tridiagonal_batch lines = batch(p, op, b, k, n - k < step ? n - k : step, shift);
    bw_real *at = b->at + k * b->columns.width;
    if (lines.pinned > 0 && !p->coupled) remove_mean_f(p, at, b->plane);
    bw_tridiagonal_finish(p->tridiagonal, &lines, at);
    if (lines.pinned > 0) remove_mean_phi(p, at, b->plane);
  }
}

typedef enum { ALL_AT_ONCE, DOWN, UP } visit_part;

static void visit_blocks(bw_poisson *p, const operator_ *op, visit_part part)
{
  size_t line = 0;
  for (int q = 0; q < bw_transpose_blocks(p->transpose); q++) {
    visit b = {.columns = bw_transpose_columns(p->transpose, q), .first_line = line};
    b.at = bw_transpose_open(p->transpose, q);
    b.plane = (ptrdiff_t)bw_grid_look(p->grid)->n[2] * b.columns.width;
    if (part != UP) transform_z(p, &b, true);
    if (part == DOWN)
      reduce(p, op, &b);
    else {
      finish(p, op, &b);
      transform_z(p, &b, false);
    }
    bw_transpose_close(p->transpose, q);
    line += (size_t)b.plane;
  }
}

static void set_operator(bw_poisson *p, const operator_ *op)
{
  const int n = bw_grid_look(p->grid)->n[1];
  for (int j = 0; j < n; j++) {
    p->operator_lower[j] = op->factor * p->lower[j];
    p->operator_diagonal[j] = op->shift + op->factor * p->diagonal[j];
    p->operator_upper[j] = op->factor * p->upper[j];
  }
  bw_tridiagonal_set(p->tridiagonal, p->operator_lower, p->operator_diagonal, p->operator_upper,
                     bw_grid_look(p->grid)->periodic[1]);
}

static void solve(bw_poisson *p, const operator_ *op, bw_real *phi)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  set_operator(p, op);
  double sum = rows_in(p, phi);
  p->removed_mean = 0;
  if (p->singular && op->shift == 0) {
    bw_comm_sum(bw_grid_comm(p->grid), 1, &sum);
    p->removed_mean = sum / (norm(p, 0) * v->n[2] * v->length[1]);
  }
  bw_transpose_to_z(p->transpose);
  if (p->coupled) {
    visit_blocks(p, op, DOWN);
    bw_tridiagonal_join(p->tridiagonal);
    visit_blocks(p, op, UP);
  } else
    visit_blocks(p, op, ALL_AT_ONCE);
  bw_transpose_to_x(p->transpose);
  rows_out(p, phi);
}

void bw_poisson_solve(bw_poisson *p, bw_real *phi)
{
  solve(p, &(operator_){0.0, 1.0}, phi);
}

void bw_poisson_solve_helmholtz(bw_poisson *p, double alpha, bw_real *phi)
{
  solve(p, &(operator_){1.0, -alpha}, phi);
}
