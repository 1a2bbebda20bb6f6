/* ns_factored.c -- diffusion, implicit in all directions in each sub-step, factored into lines.
 * With the weights old_r + new_r = gamma_r of ERRATA 38, kappa = new_r dt nu,
 * L = D_xx + D_yy + D_zz and w the sweep's change of u (no viscous term in it), the increment
 * d = u* - u of
 *   u* - u = w + dt nu L (old_r u + new_r u*)
 * is found from
 *   (1 - kappa D_yy) (1 - kappa D_xx) (1 - kappa D_zz) d = w + gamma_r dt nu L u,
 * which differs by kappa^2 (D_xx D_yy + ..) d = O(dt^3): second order in time. Where u is steady
 * d = 0: the steady states are those of the explicit scheme.
 * Stability: with a, b, c = kappa |eigenvalue| of the three, diffusion alone multiplies a mode by
 *   1 - gamma_r/new_r (a + b + c)/((1 + a) (1 + b) (1 + c)),
 * above -17/15 in the first sub-step and above -1 in the others. What is stiff in one direction is
 * gone after a step; of what is stiff in several, more stays the longer the step: ns_limit.c.
 *
 * Why not a Helmholtz solve by transforms: three more Poisson solves per sub-step, transforms for
 * values on faces beside those of the pressure, and three more transposes between ranks; the lines
 * take any pair of sides as they are, and only their separators travel.
 *
 * Boundary values that change in time: d is counted from the old field with the new values at its
 * sides, so that it obeys the homogeneous conditions, and so does what is between two of the
 * factors. u on the right then has, at sides, the mean of old and new values by their weights. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <string.h>

/* Visit what the second differences of component c see of side (d, s): its face, or the ghosts
 * beyond it. */
typedef void (*point_fn)(bw_real *u, bw_real *d, bw_real share);

static void each_point(bw_ns_channel *ns, int c, int d, int s, point_fn f, bw_real share)
{
  const bw_grid_view *g = ns->g;
  /* Along d one layer: the face for the normal component, the ghost cells beyond it for the
   * others. */
  int from[3] = {1, 1, 1}, to[3] = {g->m[0], g->m[1], g->m[2]};
  from[d] = to[d] = s == 0 ? 0 : c == d ? g->m[d] : g->m[d] + 1;
  for (int k = from[2]; k <= to[2]; k++)
    for (int j = from[1]; j <= to[1]; j++)
      for (int i = from[0]; i <= to[0]; i++)
        f(ns->u[c] + bw_at(g, i, j, k), ns->increment[c] + bw_at(g, i, j, k), share);
}

static void each_side(bw_ns_channel *ns, point_fn f, bw_real share)
{
  for (int c = 0; c < ns->components; c++)
    for (int d = 0; d < ns->components; d++)
      for (int s = 0; s < 2; s++)
        if (ns->plane[d][s].here) each_point(ns, c, d, s, f, share);
}

static void keep(bw_real *u, bw_real *d, bw_real share)
{
  (void)share;
  *d = *u;
}

/* `share`: of the new value. */
static void average(bw_real *u, bw_real *d, bw_real share)
{
  *u = share * *u + (1 - share) * *d;
  *d = 0;
}

/* d += w L u in a row, w = gamma_r dt nu; f: w/(heights) of the six neighbours (x: both the same).
 */
typedef struct {
  bw_real x, north, south, z;
} factors;

static void add_laplacian(int n, factors f, const bw_real *restrict u, const bw_real *restrict un,
                          const bw_real *restrict us, const bw_real *restrict ut,
                          const bw_real *restrict ub, bw_real *restrict d)
{
#pragma omp simd
  for (int i = 1; i <= n; i++)
    d[i] += f.x * ((u[i + 1] - u[i]) - (u[i] - u[i - 1])) +
            (f.north * (un[i] - u[i]) - f.south * (u[i] - us[i])) +
            f.z * ((ut[i] - u[i]) - (u[i] - ub[i]));
}

static factors factors_of_row(const bw_ns_channel *ns, int c, int j, double weight)
{
  const bw_ns_metrics *m = &ns->metrics;
  const bw_real w = (bw_real)weight;
  return (factors){.x = w * m->rdx * m->rdx,
                   .north = w * (c == 1 ? m->rdyf[j + 1] * m->rdyc[j] : m->rdyc[j] * m->rdyf[j]),
                   .south = w * (c == 1 ? m->rdyf[j] * m->rdyc[j] : m->rdyc[j - 1] * m->rdyf[j]),
                   .z = w * m->rdz * m->rdz};
}

/* Is local row `at` of direction d the face of an upper side, where the velocity is given? */
static bool on_side(const bw_ns_channel *ns, int c, int d, int at)
{
  return c == d && at == ns->g->m[d] && ns->plane[d][1].here;
}

static void right_side(const bw_ns_channel *ns, int c, int j, int k, double weight)
{
  const bw_grid_view *g = ns->g;
  const ptrdiff_t at = bw_at(g, 0, j, k), row = g->stride[1], plane = g->stride[2];
  bw_real *u = ns->u[c] + at, *d = ns->increment[c] + at;
  /* A row on an upper face is prescribed, so its increment is nothing. */
  if (on_side(ns, c, 1, j) || on_side(ns, c, 2, k)) {
    memset(d + 1, 0, (size_t)g->m[0] * sizeof *d);
    return;
  }
  /* d holds the sweep's change; with gamma_r dt nu L u it is the right side of the factored
   * equation. */
  add_laplacian(g->m[0], factors_of_row(ns, c, j, weight), u, u + row, u - row, u + plane,
                u - plane, d);
  /* Along x only the last point of the row can be a prescribed face. */
  if (on_side(ns, c, 0, g->m[0])) d[g->m[0]] = 0;
}

/* Lines along x of a plane, several side by side to be vectorised. */
static void solve_x(bw_ns_channel *ns, int c, int k)
{
  const bw_grid_view *g = ns->g;
  const int n = g->m[0];
  for (int j = 1; j <= g->m[1]; j += BW_NS_LANES) {
    const int rows = g->m[1] + 1 - j < BW_NS_LANES ? g->m[1] + 1 - j : BW_NS_LANES;
    bw_real *d = ns->increment[c] + bw_at(g, 1, j, k);
    /* Transposed into lanes: the recursion runs along x, the vector across rows. */
    for (int q = 0; q < rows; q++)
      for (int i = 0; i < n; i++)
        ns->lanes[i * BW_NS_LANES + q] = d[q * g->stride[1] + i];
    /* Lanes beyond `rows` hold what they did before; nobody reads their result. */
    bw_ns__lines_solve(ns->lines[0], BW_NS_LANES, BW_NS_LANES, ns->lanes);
    for (int q = 0; q < rows; q++)
      for (int i = 0; i < n; i++)
        d[q * g->stride[1] + i] = ns->lanes[i * BW_NS_LANES + q];
  }
}

/* Right-hand side, y and x in one visit of each plane, which stays in the second-level cache. */
static void solve_planes(bw_ns_channel *ns, int c, double weight, double kappa)
{
  const bw_grid_view *g = ns->g;
  const bool divided = bw_ns__lines_are_divided(ns->lines[1]);
  bw_real *d = ns->increment[c];
  /* Coefficients depend on the component, as faces and centres are spaced differently in y. */
  bw_ns__lines_set(ns, c, kappa, ns->lines[1]);
  bw_ns__lines_set(ns, c, kappa, ns->lines[0]);
  for (int k = 1; k <= g->m[2]; k++) {
    for (int j = 1; j <= g->m[1]; j++)
      right_side(ns, c, j, k, weight);
    /* Lines in y that cross ranks wait until all planes have their right side. */
    if (divided) continue;
    bw_ns__lines_solve(ns->lines[1], g->m[0], g->stride[1], d + bw_at(g, 1, 1, k));
    solve_x(ns, c, k);
  }
  if (!divided) return;
  /* Here y travels between ranks; x is whole on every rank and follows. */
  bw_ns__lines_solve_divided(ns, ns->lines[1], d);
  for (int k = 1; k <= g->m[2]; k++)
    solve_x(ns, c, k);
}

static void add(bw_ns_channel *ns, int c, int j, int rows)
{
  const bw_grid_view *g = ns->g;
  for (int k = 1; k <= g->m[2]; k++)
    for (int q = j; q < j + rows; q++) {
      bw_real *restrict u = ns->u[c] + bw_at(g, 0, q, k);
      const bw_real *restrict d = ns->increment[c] + bw_at(g, 0, q, k);
      for (int i = 1; i <= g->m[0]; i++)
        u[i] += d[i];
    }
}

/* Rows of an x-z slab (all z) that fits the second-level cache. */
static int slab(const bw_grid_view *g)
{
  enum { BUDGET = 512 * 1024 };
  const int rows = (int)(BUDGET / (sizeof(bw_real) * (size_t)g->stride[1] * (size_t)g->m[2]));
  return rows < 1 ? 1 : rows;
}

/* z, where there is one, and u += d. The lines through the halos between rows solve for nothing. */
static void solve_z(bw_ns_channel *ns, int c, double kappa)
{
  const bw_grid_view *g = ns->g;
  bw_ns_lines *z = ns->lines[2];
  const bool divided = z != NULL && bw_ns__lines_are_divided(z);
  const int most = slab(g);
  /* The factors of y and x are done; z is the last, so d is u* - u afterwards. */
  if (z != NULL) bw_ns__lines_set(ns, c, kappa, z);
  if (divided) bw_ns__lines_solve_divided(ns, z, ns->increment[c]);
  /* In slabs, so that d is still in the cache when u takes it. */
  for (int j = 1; j <= g->m[1]; j += most) {
    const int rows = g->m[1] + 1 - j < most ? g->m[1] + 1 - j : most;
    if (z != NULL && !divided)
      bw_ns__lines_solve(z, (int)((rows - 1) * g->stride[1] + g->m[0]), g->stride[2],
                         ns->increment[c] + bw_at(g, 1, j, 1));
    add(ns, c, j, rows);
  }
}

void bw_ns__factored_solve(bw_ns_channel *ns, int r, double dt)
{
  const double weight = bw_ns__gamma[r] * dt * ns->config.nu;
  const double kappa = bw_ns__new[r] * dt * ns->config.nu;
  const bw_real share = (bw_real)(bw_ns__new[r] / bw_ns__gamma[r]);
  /* The old boundary values are put away in the increment's places at the sides. */
  each_side(ns, keep, share);
  /* Now the sides of u have the values of the end of the sub-step ... */
  bw_ns__faces(ns);
  bw_ns__ghosts_velocity(ns);
  /* ... and here their mean with the old ones, so that d obeys homogeneous conditions. */
  each_side(ns, average, share);
  for (int c = 0; c < ns->components; c++) {
    solve_planes(ns, c, weight, kappa);
    solve_z(ns, c, kappa);
  }
}
