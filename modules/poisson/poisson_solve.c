/* A solve: rows transformed along x go into blocks of columns; each block, small enough for the
 * cache, is transformed along z, solved along y and transformed back in one visit (two visits,
 * with one message round between, when y is divided); rows return transformed back. The field
 * is read and written once, the blocks twice. */
#include "poisson_internal.h"

enum { ROWS = BW_POISSON__ROWS };

/* (shift + factor lap) is solved for. */
typedef struct {
  double shift, factor;
} operator_;

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
      /* A few rows at a time, so that they are still in the first-level cache when they are put
       * away. */
      for (int r = 0; r < rows; r++) {
        bw_real *row = p->rows + r * p->row_stride;
        bw_poisson__row_forward(&p->x, phi + bw_at(v, 1, j, k + r), row);
        /* Entry 0 of a transformed row is its mean mode: the sum of f over x, times the norm. */
        plane += (double)row[0];
      }
      bw_transpose_put(p->transpose, j - 1, k - 1, rows, p->rows, p->row_stride);
    }
    /* Cells of one j have one height, so that the volume enters once for the plane. */
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
      /* The columns are solved and transformed back in z; x is the last to return. */
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

static void transform_z(bw_poisson *p, const visit *b, bool forward)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  if (v->n[2] == 1) return; /* one rank in z: nothing to fetch */
  /* A plan fits one width of block; the last block may be narrower. */
  const bool wide = b->columns.width == bw_transpose_columns(p->transpose, 0).width;
  const bw_poisson__transform *z = &p->z[wide ? 0 : 1];
  /* Row by row: a row is gathered, transformed and scattered while it is in the cache. */
  for (int j = 0; j < v->m[1]; j++) {
    if (forward) {
      bw_transpose_fetch(p->transpose, j);
      bw_poisson__columns_forward(z, b->at + j * b->plane);
    } else {
      bw_poisson__columns_backward(z, b->at + j * b->plane);
      bw_transpose_store(p->transpose, j);
    }
  }
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
  /* What the second differences in x and z are for a mode joins the diagonal of its line. */
  for (int k = 0; k < planes; k++)
    for (int c = 0; c < width; c++)
      shift[k * width + c] =
          (bw_real)(op->factor * (p->lambda_z[k0 + k] + p->lambda_x[b->columns.first + c]));
  /* Only the line of the constant mode is singular, and only without a shift. */
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
  /* The line holds transforms without their norm: what is subtracted has it too. */
  const bw_real mean = (bw_real)(p->removed_mean * norm(p, 0) * norm(p, 2));
  for (int j = 0; j < m1; j++)
    line[j * plane] -= mean;
}

/* The mean mode without its mean, which is phi's. Collective over the line in y. */
static void remove_mean_phi(const bw_poisson *p, bw_real *line, ptrdiff_t plane)
{
  const bw_grid_view *v = bw_grid_look(p->grid);
  const double *face = v->y_face + v->lo[1];
  /* The mean is over volume: cells of a stretched grid weigh by their height. */
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
    /* A singular line has a solution only for a right-hand side without mean. */
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
    /* In two visits `reduce` has removed the mean already, and the block was stored without it. */
    if (lines.pinned > 0 && !p->coupled) remove_mean_f(p, at, b->plane);
    bw_tridiagonal_finish(p->tridiagonal, &lines, at);
    /* Pinned, the constant mode came out with 0 in its last cell; now its mean is 0. */
    if (lines.pinned > 0) remove_mean_phi(p, at, b->plane);
  }
}

static void fetch(bw_poisson *p)
{
  for (int j = 0; j < bw_grid_look(p->grid)->m[1]; j++)
    bw_transpose_fetch(p->transpose, j);
}

static void store(bw_poisson *p)
{
  for (int j = 0; j < bw_grid_look(p->grid)->m[1]; j++)
    bw_transpose_store(p->transpose, j);
}

typedef enum { ALL_AT_ONCE, DOWN, UP } visit_part;

static void visit_blocks(bw_poisson *p, const operator_ *op, visit_part part)
{
  size_t line = 0;
  for (int q = 0; q < bw_transpose_blocks(p->transpose); q++) {
    visit b = {.columns = bw_transpose_columns(p->transpose, q), .first_line = line};
    b.at = bw_transpose_open(p->transpose, q);
    b.plane = (ptrdiff_t)bw_grid_look(p->grid)->n[2] * b.columns.width;
    /* On the way up the block is what `store` left on the way down: transformed along z, not yet
     * solved. */
    if (part == UP)
      fetch(p);
    else
      transform_z(p, &b, true);
    /* The separators of the lines are told on the way down, the lines solved on the way up. */
    if (part == DOWN) {
      reduce(p, op, &b);
      store(p);
    } else {
      finish(p, op, &b);
      transform_z(p, &b, false);
    }
    line += (size_t)b.plane;
  }
}

static void set_operator(bw_poisson *p, const operator_ *op)
{
  const int n = bw_grid_look(p->grid)->n[1];
  /* The same rows for every mode; what the mode adds to the diagonal is the shift of its line. */
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
  /* f is read for the last time; until the rows return the field is free. */
  double sum = rows_in(p, phi);
  p->removed_mean = 0;
  /* Solvable only without a mean: it is removed in the mean mode, and reported. */
  if (p->singular && op->shift == 0) {
    bw_comm_sum(bw_grid_comm(p->grid), 1, &sum);
    p->removed_mean = sum / (norm(p, 0) * v->n[2] * v->length[1]);
  }
  /* Transformed in x, divided by columns from here on: each rank holds all of z of a few
   * x-entries. */
  bw_transpose_to_z(p->transpose);
  if (p->coupled) {
    /* y is divided (or cyclic): down to the separators, one round of messages, and up again. */
    visit_blocks(p, op, DOWN);
    bw_tridiagonal_join(p->tridiagonal);
    visit_blocks(p, op, UP);
  } else
    /* All of y is here: each block is transformed, solved and transformed back while it is in the
     * cache. */
    visit_blocks(p, op, ALL_AT_ONCE);
  /* Solved; only the transform along x is still to be undone. */
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
