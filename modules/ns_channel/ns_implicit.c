/* ns_implicit.c -- y diffusion by Crank-Nicolson in each sub-step: with kappa = gamma dt nu/2,
 *   (1 - kappa D_yy) u* = rhs,   rhs: the sweep's result, + kappa D_yy u included there.
 * One tridiagonal system per column, the same coefficients for all: rows in y are eliminated one
 * after the other, vectorised along x. All of y is on the rank. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

typedef struct { /* one system: rows first..last */
  int first, last;
  bw_real *below, *inverse, *above; /* a_j; 1/pivot; c_j/pivot */
} tridiagonal;

bw_status bw_ns__implicit_create(bw_ns_channel *ns)
{
  if (!ns->sweep.split_y) return BW_OK;
  return BW_ALLOCATE(&ns->implicit, 3 * ((size_t)ns->g->m[1] + 2));
}

/* Ghost of a centred component beyond y side s: sign u + G (ns_boundary.c). */
static bw_real ghost_sign(const bw_ns_channel *ns, int s)
{
  const bw_ns_side_kind kind = ns->config.side[1][s].kind;
  return kind == BW_SIDE_WALL || kind == BW_SIDE_INFLOW ? -1 : 1;
}

static tridiagonal eliminate(bw_ns_channel *ns, int c, bw_real kappa)
{
  const bw_ns_metrics *m = &ns->metrics;
  const int n = ns->g->m[1];
  tridiagonal t = {.first = 1, .last = c == 1 ? n - 1 : n, .below = ns->implicit};
  t.inverse = t.below + n + 2, t.above = t.inverse + n + 2;
  bw_real previous = 0;
  for (int j = t.first; j <= t.last; j++) {
    const bw_real a =
        c == 1 ? -kappa * m->rdyc[j] * m->rdyf[j] : -kappa * m->rdyf[j] * m->rdyc[j - 1];
    const bw_real above =
        c == 1 ? -kappa * m->rdyc[j] * m->rdyf[j + 1] : -kappa * m->rdyf[j] * m->rdyc[j];
    bw_real pivot = 1 - a - above;
    if (c != 1 && j == 1) pivot += a * ghost_sign(ns, 0);
    if (c != 1 && j == n) pivot += above * ghost_sign(ns, 1);
    if (j > t.first) pivot -= a * previous;
    t.below[j] = a;
    t.inverse[j] = 1 / pivot;
    t.above[j] = previous = above / pivot;
  }
  return t;
}

static void row_minus(int n, bw_real factor, bw_real scale, bw_real *restrict row,
                      const bw_real *restrict other)
{
  for (int i = 1; i <= n; i++)
    row[i] = (row[i] - factor * other[i]) * scale;
}

/* row -= factor G: what the ghost beyond side s of a centred component adds to the right. */
static void row_boundary(const bw_ns_channel *ns, int c, int s, int k, bw_real factor, bw_real *row)
{
  const bw_ns_plane *p = &ns->plane[1][s];
  const bw_ns_side *side = &ns->config.side[1][s];
  if (ghost_sign(ns, s) > 0) return;
  const bw_real *value = p->value[c];
  if (value != NULL) value += (k - p->low[1]) * p->extent[0] - p->low[0];
  const bw_real constant = (bw_real)side->velocity[c];
  for (int i = 1; i <= ns->g->m[0]; i++)
    row[i] -= factor * 2 * (value != NULL ? value[i] : constant);
}

static void solve_plane(const bw_ns_channel *ns, int c, int k, const tridiagonal *t, bw_real kappa)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_metrics *m = &ns->metrics;
  const int n = g->m[0];
  const ptrdiff_t row = g->stride[1];
  bw_real *first = ns->u[c] + bw_at(g, 0, 1, k);
  if (c != 1) {
    row_boundary(ns, c, 0, k, -kappa * m->rdyf[1] * m->rdyc[0], first);
    row_boundary(ns, c, 1, k, -kappa * m->rdyf[g->m[1]] * m->rdyc[g->m[1]],
                 first + row * (g->m[1] - 1));
  } else { /* the faces on both sides are known */
    row_minus(n, t->below[1], 1, first, first - row);
    row_minus(n, -kappa * m->rdyc[t->last] * m->rdyf[t->last + 1], 1, first + row * (t->last - 1),
              first + row * t->last);
  }
  row_minus(n, 0, t->inverse[1], first, first - row);
  bw_real *q = first + row;
  for (int j = 2; j <= t->last; j++, q += row)
    row_minus(n, t->below[j], t->inverse[j], q, q - row);
  q = first + row * (t->last - 2);
  for (int j = t->last - 1; j >= 1; j--, q -= row)
    row_minus(n, t->above[j], 1, q, q + row);
}

void bw_ns__implicit_solve(bw_ns_channel *ns, double gamma_dt)
{
  const bw_real kappa = (bw_real)(0.5 * gamma_dt * ns->config.nu);
  for (int c = 0; c < ns->components; c++) {
    const tridiagonal t = eliminate(ns, c, kappa);
    for (int k = 1; k <= ns->g->m[2]; k++)
      solve_plane(ns, c, k, &t, kappa);
  }
}
