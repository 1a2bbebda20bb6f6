/* ns_implicit.c -- y diffusion, implicit in each sub-step (ERRATA 38): with kappa = new_r dt nu,
 *   (1 - kappa D_yy) u* = rhs,   rhs: the sweep's result, + old_r dt nu D_yy u included there.
 * In place: one direction needs no increment (ns_factored.c does). */
#include "ns_channel_internal.h"

static void row_minus(int n, bw_real factor, const bw_real *restrict other, bw_real *restrict row)
{
  for (int i = 1; i <= n; i++)
    row[i] -= factor * other[i];
}

/* row -= factor G: what the ghost beyond side s of a centred component adds to the right. */
static void row_boundary(const bw_ns_channel *ns, int c, int s, int k, bw_real factor,
                         bw_real *restrict row)
{
  const bw_ns_plane *p = &ns->plane[1][s];
  /* Free slip and outflow: the ghost is the cell itself, which the matrix holds already. */
  if (bw_ns__ghost_sign(ns, 1, s) > 0) return;
  const bw_real *value = p->value[c];
  if (value != NULL) value += (k - p->low[1]) * p->extent[0] - p->low[0];
  const bw_real constant = (bw_real)ns->config.side[1][s].velocity[c];
  /* A ghost is 2 U - u: the matrix has the -u, the right side gets the 2 U. */
  for (int i = 1; i <= ns->g->m[0]; i++)
    row[i] -= factor * 2 * (value != NULL ? value[i] : constant);
}

/* Known values beyond rows 1 and n1 go to the right-hand side. */
static void boundaries(const bw_ns_channel *ns, const bw_ns_lines *lines, int c, int k)
{
  const bw_grid_view *g = ns->g;
  const bw_real below = (bw_real)bw_ns__lines_edge(lines, 0);
  const bw_real above = (bw_real)bw_ns__lines_edge(lines, 1);
  bw_real *first = ns->u[c] + bw_at(g, 0, 1, k), *last = ns->u[c] + bw_at(g, 0, g->m[1], k);
  /* v has its boundary value on the face below the first row; u and w have a ghost. */
  if (ns->plane[1][0].here) {
    if (c == 1)
      row_minus(g->m[0], below, first - g->stride[1], first);
    else
      row_boundary(ns, c, 0, k, below, first);
  }
  /* At the upper side v's own last row is the face: it is an identity in the matrix. */
  if (ns->plane[1][1].here && c != 1) row_boundary(ns, c, 1, k, above, last);
}

void bw_ns__implicit_solve(bw_ns_channel *ns, double kappa)
{
  const bw_grid_view *g = ns->g;
  bw_ns_lines *lines = ns->lines[1];
  for (int c = 0; c < ns->components; c++) {
    /* The part of the diffusion with the old velocity was added explicitly in the sweep. */
    bw_ns__lines_set(ns, c, kappa, lines);
    for (int k = 1; k <= g->m[2]; k++) {
      /* Boundary values go to the right side before the lines are eliminated. */
      boundaries(ns, lines, c, k);
      if (!bw_ns__lines_are_divided(lines))
        bw_ns__lines_solve(lines, g->m[0], g->stride[1], ns->u[c] + bw_at(g, 1, 1, k));
    }
    /* Lines that cross ranks need all planes at once, as their separators travel together. */
    if (bw_ns__lines_are_divided(lines)) bw_ns__lines_solve_divided(ns, lines, ns->u[c]);
  }
}
