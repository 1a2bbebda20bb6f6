/* ns_implicit.c -- y diffusion by Crank-Nicolson in each sub-step: with kappa = gamma dt nu/2,
 *   (1 - kappa D_yy) u* = rhs,   rhs: the sweep's result, + kappa D_yy u included there.
 * One tridiagonal system per column, the same coefficients for all. Where all of y is on the rank
 * (and not periodic), rows are eliminated one after the other, vectorised along x; else
 * bw_tridiagonal.h couples the ranks. */
#include "bw_memory.h"
#include "bw_tridiagonal.h"
#include "ns_channel_internal.h"

struct bw_ns_implicit {
  bw_tridiagonal *lines;            /* NULL: all of y is here */
  double *lower, *diagonal, *upper; /* rows j = 1 .. n1 at [j-1] */
  double edge[2];                   /* what couples rows 1 and n1 to the ghosts or faces */
  bw_real *below, *inverse, *above; /* eliminated: a_j, 1/pivot, c_j/pivot */
  bw_real no_shift[BW_TRIDIAGONAL_LINES];
};

static bw_status allocate(bw_ns_channel *ns)
{
  const size_t n = (size_t)ns->g->n[1];
  BW_TRY(BW_ALLOCATE(&ns->implicit, 1));
  bw_ns_implicit *q = ns->implicit;
  BW_TRY(BW_ALLOCATE(&q->lower, 3 * n));
  q->diagonal = q->lower + n, q->upper = q->diagonal + n;
  BW_TRY(BW_ALLOCATE(&q->below, 3 * n));
  q->inverse = q->below + n, q->above = q->inverse + n;
  return BW_OK;
}

bw_status bw_ns__implicit_create(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  if (!ns->sweep.split_y) return BW_OK;
  BW_TRY(bw_comm_agree(ns->comm, allocate(ns)));
  if (g->ranks[1] == 1 && !g->periodic[1]) return BW_OK;
  return bw_tridiagonal_create(ns->grid, (size_t)g->m[0] * (size_t)g->m[2], &ns->implicit->lines);
}

void bw_ns__implicit_destroy(bw_ns_channel *ns)
{
  if (ns->implicit == NULL) return;
  bw_tridiagonal_destroy(&ns->implicit->lines);
  bw_release(&ns->implicit->lower);
  bw_release(&ns->implicit->below);
  bw_release(&ns->implicit);
}

/* Ghost of a centred component beyond y side s: sign u + G (ns_boundary.c). */
static double ghost_sign(const bw_ns_channel *ns, int s)
{
  const bw_ns_side_kind kind = ns->config.side[1][s].kind;
  return kind == BW_SIDE_WALL || kind == BW_SIDE_INFLOW ? -1.0 : 1.0;
}

/* Height of the global cell j; ghosts mirror (which is the periodic image, too). */
static double height(const bw_grid_view *g, int j)
{
  const int n = g->n[1], cell = j < 1 ? 1 - j : j > n ? 2 * n + 1 - j : j;
  return g->y_face[cell] - g->y_face[cell - 1];
}

/* Rows of 1 - kappa D_yy: component v sits on faces (row n1 is the side's face where there is a
 * side), the others in cells. */
static void coefficients(const bw_ns_channel *ns, int c, double kappa, bw_ns_implicit *q)
{
  const bw_grid_view *g = ns->g;
  const int n = g->n[1];
  for (int j = 1; j <= n; j++) {
    const double h = height(g, j), next = height(g, j + 1), previous = height(g, j - 1);
    const double mid = 0.5 * (h + next), mid_below = 0.5 * (previous + h);
    q->lower[j - 1] = -kappa / (c == 1 ? mid * h : h * mid_below);
    q->upper[j - 1] = -kappa / (c == 1 ? mid * next : h * mid);
    q->diagonal[j - 1] = 1.0 - q->lower[j - 1] - q->upper[j - 1];
  }
  q->edge[0] = q->lower[0], q->edge[1] = q->upper[n - 1];
  if (g->periodic[1]) return;
  if (c == 1) {
    q->lower[n - 1] = 0.0, q->diagonal[n - 1] = 1.0;
  } else {
    q->diagonal[0] += q->edge[0] * ghost_sign(ns, 0);
    q->diagonal[n - 1] += q->edge[1] * ghost_sign(ns, 1);
  }
  q->lower[0] = q->upper[n - 1] = 0.0;
}

static void eliminate(int n, bw_ns_implicit *q)
{
  double previous = 0.0;
  for (int j = 0; j < n; j++) {
    const double pivot = q->diagonal[j] - q->lower[j] * previous;
    previous = q->upper[j] / pivot;
    q->below[j] = (bw_real)q->lower[j];
    q->inverse[j] = (bw_real)(1.0 / pivot);
    q->above[j] = (bw_real)previous;
  }
}

static void row_minus(int n, bw_real factor, bw_real scale, bw_real *restrict row,
                      const bw_real *restrict other)
{
  for (int i = 1; i <= n; i++)
    row[i] = (row[i] - factor * other[i]) * scale;
}

/* row -= factor G: what the ghost beyond side s of a centred component adds to the right. */
static void row_boundary(const bw_ns_channel *ns, int c, int s, int k, bw_real factor,
                         bw_real *restrict row)
{
  const bw_ns_plane *p = &ns->plane[1][s];
  if (ghost_sign(ns, s) > 0) return;
  const bw_real *value = p->value[c];
  if (value != NULL) value += (k - p->low[1]) * p->extent[0] - p->low[0];
  const bw_real constant = (bw_real)ns->config.side[1][s].velocity[c];
  for (int i = 1; i <= ns->g->m[0]; i++)
    row[i] -= factor * 2 * (value != NULL ? value[i] : constant);
}

/* Known values beyond rows 1 and n1 go to the right-hand side. */
static void boundaries(const bw_ns_channel *ns, int c, int k)
{
  const bw_grid_view *g = ns->g;
  const double *edge = ns->implicit->edge;
  bw_real *first = ns->u[c] + bw_at(g, 0, 1, k), *last = ns->u[c] + bw_at(g, 0, g->m[1], k);
  if (ns->plane[1][0].here) {
    if (c == 1)
      row_minus(g->m[0], (bw_real)edge[0], 1, first, first - g->stride[1]);
    else
      row_boundary(ns, c, 0, k, (bw_real)edge[0], first);
  }
  if (ns->plane[1][1].here && c != 1) row_boundary(ns, c, 1, k, (bw_real)edge[1], last);
}

static void solve_plane(const bw_grid_view *g, int k, const bw_ns_implicit *q, bw_real *u)
{
  const int n = g->m[0], rows = g->m[1];
  const ptrdiff_t step = g->stride[1];
  bw_real *row = u + bw_at(g, 0, 1, k);
  for (int i = 1; i <= n; i++)
    row[i] *= q->inverse[0];
  for (int j = 1; j < rows; j++) {
    row += step;
    row_minus(n, q->below[j], q->inverse[j], row, row - step);
  }
  for (int j = rows - 2; j >= 0; j--) {
    row -= step;
    row_minus(n, q->above[j], 1, row, row + step);
  }
}

/* All lines of a component in batches; what: reduce (false) or finish (true). */
static void each_batch(const bw_grid_view *g, const bw_ns_implicit *q, bool finish, bw_real *u)
{
  for (int k = 1; k <= g->m[2]; k++)
    for (int i = 1; i <= g->m[0]; i += BW_TRIDIAGONAL_LINES) {
      const int left = g->m[0] + 1 - i;
      const bw_tridiagonal_batch batch = {
          .first = (size_t)(k - 1) * (size_t)g->m[0] + (size_t)(i - 1),
          .n = left < BW_TRIDIAGONAL_LINES ? left : BW_TRIDIAGONAL_LINES,
          .pitch = g->stride[1],
          .shift = q->no_shift,
          .scale = 1};
      if (finish)
        bw_tridiagonal_finish(q->lines, &batch, u + bw_at(g, i, 1, k));
      else
        bw_tridiagonal_reduce(q->lines, &batch, u + bw_at(g, i, 1, k));
    }
}

void bw_ns__implicit_solve(bw_ns_channel *ns, double gamma_dt)
{
  const bw_grid_view *g = ns->g;
  bw_ns_implicit *q = ns->implicit;
  for (int c = 0; c < ns->components; c++) {
    coefficients(ns, c, 0.5 * gamma_dt * ns->config.nu, q);
    if (q->lines == NULL) eliminate(g->n[1], q);
    for (int k = 1; k <= g->m[2]; k++) {
      boundaries(ns, c, k);
      if (q->lines == NULL) solve_plane(g, k, q, ns->u[c]);
    }
    if (q->lines == NULL) continue;
    bw_tridiagonal_set(q->lines, q->lower, q->diagonal, q->upper, g->periodic[1]);
    each_batch(g, q, false, ns->u[c]);
    bw_tridiagonal_join(q->lines);
    each_batch(g, q, true, ns->u[c]);
  }
}
