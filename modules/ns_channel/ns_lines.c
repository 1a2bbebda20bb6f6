/* ns_lines.c -- (1 - kappa D_dd) x = f along every line of a direction: what an implicit viscous
 * term solves. A component has the same coefficients on all its lines: they are eliminated once,
 * then the rows across the lines are, one after the other, vectorised over the lines.
 * A cyclic system is symmetric (its spacing is uniform): the last unknown is f times the last row
 * of the inverse, the others follow by Thomas' algorithm. Where the direction is divided over
 * ranks, bw_tridiagonal.h couples them. */
#include "bw_memory.h"
#include "bw_tridiagonal.h"
#include "ns_channel_internal.h"

struct bw_ns_lines {
  int d, n;                         /* direction, rows of all ranks */
  bool cyclic;                      /* periodic direction */
  bw_tridiagonal *divided;          /* NULL: all rows are here */
  double *lower, *diagonal, *upper; /* rows j = 1 .. n at [j-1] */
  double edge[2];                   /* what couples rows 1 and n to the ghosts or faces */
  bw_real *below, *inverse, *above; /* eliminated: a_j/pivot, 1/pivot, c_j/pivot */
  bw_real *last;                    /* cyclic: last row of the inverse */
  bw_real no_shift[BW_TRIDIAGONAL_LINES];
};

static bw_status allocate(int n, bw_ns_lines *q)
{
  const size_t rows = (size_t)n;
  BW_TRY(BW_ALLOCATE(&q->lower, 3 * rows));
  q->diagonal = q->lower + n, q->upper = q->diagonal + n;
  BW_TRY(BW_ALLOCATE(&q->below, 4 * rows));
  q->inverse = q->below + n, q->above = q->inverse + n, q->last = q->above + n;
  return BW_OK;
}

bw_status bw_ns__lines_create(const bw_ns_channel *ns, int d, bw_ns_lines **out)
{
  const bw_grid_view *g = ns->g;
  bw_ns_lines *q = NULL;
  bw_status st = BW_ALLOCATE(out, 1);
  if (st == BW_OK) {
    q = *out;
    q->d = d, q->n = g->n[d], q->cyclic = g->periodic[d];
    st = allocate(q->n, q);
  }
  BW_TRY(bw_comm_agree(ns->comm, st));
  /* The whole line is on this rank, Thomas' algorithm solves it without a message. */
  if (g->ranks[d] == 1) return BW_OK;
  return bw_tridiagonal_create(ns->grid, d, (size_t)g->m[0] * (size_t)g->m[3 - d], &q->divided);
}

void bw_ns__lines_destroy(bw_ns_lines **lines)
{
  bw_ns_lines *q = *lines;
  if (q == NULL) return;
  bw_tridiagonal_destroy(&q->divided);
  bw_release(&q->lower);
  bw_release(&q->below);
  bw_release(lines);
}

bool bw_ns__lines_are_divided(const bw_ns_lines *q)
{
  return q->divided != NULL;
}

double bw_ns__lines_edge(const bw_ns_lines *q, int s)
{
  return q->edge[s];
}

double bw_ns__ghost_sign(const bw_ns_channel *ns, int d, int s)
{
  const bw_ns_side_kind kind = ns->config.side[d][s].kind;
  return kind == BW_SIDE_WALL || kind == BW_SIDE_INFLOW ? -1.0 : 1.0;
}

/* Extent of the global cell j; ghosts mirror (which is the periodic image, too). */
static double extent(const bw_grid_view *g, int d, int j)
{
  const int n = g->n[d], cell = j < 1 ? 1 - j : j > n ? 2 * n + 1 - j : j;
  return d == 1 ? g->y_face[cell] - g->y_face[cell - 1] : g->spacing[d];
}

/* Rows of 1 - kappa D_dd: the component along d sits on faces (row n is the side's face where
 * there is a side), the others in cells. */
static void coefficients(const bw_ns_channel *ns, int c, double kappa, bw_ns_lines *q)
{
  const bw_grid_view *g = ns->g;
  const int n = q->n, d = q->d;
  /* Second differences: of the component along d between faces, of the others between centres. */
  for (int j = 1; j <= n; j++) {
    const double h = extent(g, d, j), next = extent(g, d, j + 1), previous = extent(g, d, j - 1);
    const double mid = 0.5 * (h + next), mid_below = 0.5 * (previous + h);
    q->lower[j - 1] = -kappa / (c == d ? mid * h : h * mid_below);
    q->upper[j - 1] = -kappa / (c == d ? mid * next : h * mid);
    q->diagonal[j - 1] = 1.0 - q->lower[j - 1] - q->upper[j - 1];
  }
  /* What couples the ends to their neighbours beyond: kept, as the right side may need it. */
  q->edge[0] = q->lower[0], q->edge[1] = q->upper[n - 1];
  if (q->cyclic) return;
  /* The last row of the normal component is the side's own face: its value is given. */
  if (c == d) {
    q->lower[n - 1] = 0.0, q->diagonal[n - 1] = 1.0;
  } else {
    /* A ghost is sign times the cell beside it: that part belongs to the matrix. */
    q->diagonal[0] += q->edge[0] * bw_ns__ghost_sign(ns, d, 0);
    q->diagonal[n - 1] += q->edge[1] * bw_ns__ghost_sign(ns, d, 1);
  }
  q->lower[0] = q->upper[n - 1] = 0.0;
}

static void eliminate(int rows, bw_ns_lines *q)
{
  double previous = 0.0;
  for (int j = 0; j < rows; j++) {
    const double pivot = q->diagonal[j] - q->lower[j] * previous;
    previous = q->upper[j] / pivot;
    q->below[j] = (bw_real)(q->lower[j] / pivot);
    q->inverse[j] = (bw_real)(1.0 / pivot);
    q->above[j] = (bw_real)previous;
  }
}

/* With z = T^-1 (a, 0, .., 0, a), T the matrix without its last row and column, a what couples
 * neighbours: the last row of the inverse is (-z, 1)/(diagonal - a (z_1 + z_{n-1})). */
static void border(bw_ns_lines *q)
{
  const int rows = q->n - 1;
  const double a = q->edge[0];
  double *z = q->lower; /* not needed any more */
  /* Right side (a, 0, .., 0, a): the last unknown couples to the first and the last row. */
  for (int j = 0; j < rows; j++)
    z[j] = (j == 0 ? a : 0.0) + (j == rows - 1 ? a : 0.0);
  /* Forward and backward sweep of Thomas' algorithm. */
  z[0] *= (double)q->inverse[0];
  for (int j = 1; j < rows; j++)
    z[j] = z[j] * (double)q->inverse[j] - (double)q->below[j] * z[j - 1];
  for (int j = rows - 2; j >= 0; j--)
    z[j] -= (double)q->above[j] * z[j + 1];
  /* Schur complement of the last unknown; the matrix is symmetric, so a row is a column. */
  const double scale = 1.0 / (q->diagonal[rows] - a * (z[0] + z[rows - 1]));
  for (int j = 0; j < rows; j++)
    q->last[j] = (bw_real)(-z[j] * scale);
  q->last[rows] = (bw_real)scale;
}

void bw_ns__lines_set(const bw_ns_channel *ns, int c, double kappa, bw_ns_lines *q)
{
  coefficients(ns, c, kappa, q);
  /* A cyclic line is eliminated without its last unknown, which border() finds apart. */
  if (q->divided != NULL)
    bw_tridiagonal_set(q->divided, q->lower, q->diagonal, q->upper, q->cyclic);
  else
    eliminate(q->cyclic ? q->n - 1 : q->n, q);
  if (q->divided == NULL && q->cyclic) border(q);
}

/* row <- scale row - factor other. */
BW_NS_INLINE void combine(int width, bw_real scale, bw_real factor, const bw_real *restrict other,
                          bw_real *restrict row)
{
#pragma omp simd
  for (int i = 0; i < width; i++)
    row[i] = scale * row[i] - factor * other[i];
}

BW_NS_INLINE void solve_rows(const bw_ns_lines *q, int width, ptrdiff_t pitch, bw_real *f)
{
  const int rows = q->cyclic ? q->n - 1 : q->n;
  bw_real *last = f + (q->n - 1) * pitch;
  /* The last unknown first: the scalar product of the inverse's last row with the right side. */
  if (q->cyclic) {
    combine(width, q->last[rows], -q->last[0], f, last);
    for (int j = 1; j < rows; j++)
      combine(width, 1, -q->last[j], f + j * pitch, last);
  }
  /* It is known now and goes to the right side of the first row. */
  combine(width, q->inverse[0], q->cyclic ? (bw_real)q->edge[0] * q->inverse[0] : 0, last, f);
  /* Forward elimination. */
  for (int j = 1; j < rows; j++)
    combine(width, q->inverse[j], q->below[j], f + (j - 1) * pitch, f + j * pitch);
  /* Back substitution, from the last row (or the last unknown of the cycle) down. */
  for (int j = q->n - 2; j >= 0; j--)
    combine(width, 1, q->above[j], f + (j + 1) * pitch, f + j * pitch);
}

void bw_ns__lines_solve(const bw_ns_lines *q, int width, ptrdiff_t pitch, bw_real *f)
{
  /* A width known at compile time lets the compiler unroll the lanes. */
  if (width == BW_NS_LANES)
    solve_rows(q, BW_NS_LANES, pitch, f);
  else
    solve_rows(q, width, pitch, f);
}

/* All lines of a field in batches: reduced, or finished. */
static void each_batch(const bw_grid_view *g, const bw_ns_lines *q, bool finish, bw_real *u)
{
  const int across = 3 - q->d;
  for (int k = 1; k <= g->m[across]; k++)
    for (int i = 1; i <= g->m[0]; i += BW_TRIDIAGONAL_LINES) {
      const int left = g->m[0] + 1 - i;
      /* Batches are numbered by their first line, so that the separators of all lines find their
       * place. */
      const bw_tridiagonal_batch batch = {
          .first = (size_t)(k - 1) * (size_t)g->m[0] + (size_t)(i - 1),
          .n = left < BW_TRIDIAGONAL_LINES ? left : BW_TRIDIAGONAL_LINES,
          .pitch = g->stride[q->d],
          .shift = q->no_shift,
          .scale = 1};
      bw_real *f = u + bw_at(g, i, 1, 1) + (k - 1) * g->stride[across];
      if (finish)
        bw_tridiagonal_finish(q->divided, &batch, f);
      else
        bw_tridiagonal_reduce(q->divided, &batch, f);
    }
}

void bw_ns__lines_solve_divided(const bw_ns_channel *ns, const bw_ns_lines *q, bw_real *u)
{
  /* Each rank reduces its part to the rows at its ends ... */
  each_batch(ns->g, q, false, u);
  /* ... which are solved for all ranks together ... */
  bw_tridiagonal_join(q->divided);
  /* ... and substituted into the rows between them. */
  each_batch(ns->g, q, true, u);
}
