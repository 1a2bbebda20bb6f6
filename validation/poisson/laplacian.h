/* laplacian.h -- the discrete operator written out from its definition, apart from the solver:
 * ghost cells by the conditions, then plain differences. For residuals of what the solver returns.
 */
#pragma once
#include "bw_memory.h"
#include "bw_poisson.h"
#include <math.h>
#include <stdint.h>

typedef struct {
  int n[3];
  bw_poisson_side side[3][2];
  bool stretched;
  int halo;
  int ranks[2];
} poisson_case;

/* ISO C before C23 adds no const to arrays of arrays. */
#define SIDES(c) ((const bw_poisson_side(*)[2])(c)->side)

static const bw_poisson_side poisson_pairs[5][2] = {{BW_POISSON_PERIODIC, BW_POISSON_PERIODIC},
                                                    {BW_POISSON_NEUMANN, BW_POISSON_NEUMANN},
                                                    {BW_POISSON_DIRICHLET, BW_POISSON_DIRICHLET},
                                                    {BW_POISSON_NEUMANN, BW_POISSON_DIRICHLET},
                                                    {BW_POISSON_DIRICHLET, BW_POISSON_NEUMANN}};
enum { POISSON_PAIRS = 5 };

static inline void poisson_case_sides(poisson_case *c, int x, int y, int z)
{
  const int pair[3] = {x, y, z};
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 2; e++)
      c->side[d][e] = poisson_pairs[pair[d]][e];
}

/* Lengths that make the three spacings differ. */
static inline bw_status poisson_case_grid(const bw_comm *comm, const poisson_case *c,
                                          bw_grid **grid)
{
  bw_grid_config g = bw_grid_config_default();
  for (int d = 0; d < 3; d++) {
    g.n[d] = c->n[d];
    g.length[d] = 1.0 + 0.7 * d;
    g.periodic[d] = c->side[d][0] == BW_POISSON_PERIODIC;
  }
  g.halo = c->halo;
  g.ranks[0] = c->ranks[0];
  g.ranks[1] = c->ranks[1];
  if (c->stretched) g.y_stretch = BW_STRETCH_TANH;
  return bw_grid_create(comm, &g, grid);
}

/* A number in -1/2 .. 1/2 that depends on the global cell only. */
static inline double poisson_noise(int i, int j, int k)
{
  uint64_t s = (uint64_t)i * 73856093u ^ (uint64_t)j * 19349663u ^ (uint64_t)k * 83492791u;
  for (int q = 0; q < 3; q++)
    s = s * 6364136223846793005u + 1442695040888963407u, s ^= s >> 29;
  return (double)(s >> 11) / 9007199254740992.0 - 0.5;
}

#define FOR_CELLS(v, i, j, k)                                                                      \
  for (int k = 1; k <= (v)->m[2]; k++)                                                             \
    for (int j = 1; j <= (v)->m[1]; j++)                                                           \
      for (int i = 1; i <= (v)->m[0]; i++)

static inline void poisson_fill_noise(const bw_grid *grid, bw_real *f)
{
  const bw_grid_view *v = bw_grid_look(grid);
  FOR_CELLS(v, i, j, k)
  f[bw_at(v, i, j, k)] = (bw_real)poisson_noise(i, v->lo[1] + j, v->lo[2] + k);
}

/* phi's halos: neighbours', periodic images, +-1 times the cell at a boundary face. */
static inline void poisson_ghosts(bw_grid *grid, const poisson_case *c, bw_real *phi)
{
  const bw_grid_view *v = bw_grid_look(grid);
  bw_halo_update(grid, 1, &phi);
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 2; e++) {
      if (c->side[d][e] == BW_POISSON_PERIODIC || v->halo[d] == 0) continue;
      if (!(e == 0 ? v->first[d] : v->last[d])) continue;
      const bw_real sign = c->side[d][e] == BW_POISSON_NEUMANN ? 1 : -1;
      const ptrdiff_t out = e == 0 ? -v->stride[d] : v->stride[d];
      FOR_CELLS(v, i, j, k)
      {
        const int at[3] = {i, j, k};
        if (at[d] != (e == 0 ? 1 : v->m[d])) continue;
        phi[bw_at(v, i, j, k) + out] = sign * phi[bw_at(v, i, j, k)];
      }
    }
}

/* div grad phi at a cell, ghosts valid. */
static inline double poisson_laplacian(const bw_grid_view *v, const bw_real *phi, int i, int j,
                                       int k)
{
  const ptrdiff_t at = bw_at(v, i, j, k), row = v->stride[1], plane = v->stride[2];
  const int g = v->lo[1] + j;
  const double c = (double)phi[at];
  const double north = ((double)phi[at + row] - c) / (v->y_centre[g + 1] - v->y_centre[g]);
  const double south = (c - (double)phi[at - row]) / (v->y_centre[g] - v->y_centre[g - 1]);
  return ((double)phi[at + 1] - 2 * c + (double)phi[at - 1]) / pow(v->spacing[0], 2) +
         (north - south) / (v->y_face[g] - v->y_face[g - 1]) +
         ((double)phi[at + plane] - 2 * c + (double)phi[at - plane]) / pow(v->spacing[2], 2);
}

/* Row sum of |operator|: the round-off of one residual is a few epsilon times this times phi. */
static inline double poisson_operator_norm(const bw_grid_view *v)
{
  double thinnest = v->spacing[1];
  for (int j = 1; j <= v->n[1]; j++)
    thinnest = fmin(thinnest, v->y_face[j] - v->y_face[j - 1]);
  return 4 / pow(v->spacing[0], 2) + 4 / pow(thinnest, 2) + 4 / pow(v->spacing[2], 2);
}

/* Volume mean of a field over all ranks. */
static inline double poisson_mean(const bw_grid *grid, const bw_real *f)
{
  const bw_grid_view *v = bw_grid_look(grid);
  double sum = 0;
  FOR_CELLS(v, i, j, k)
  sum += (double)f[bw_at(v, i, j, k)] * (v->y_face[v->lo[1] + j] - v->y_face[v->lo[1] + j - 1]);
  bw_comm_sum(bw_grid_comm(grid), 1, &sum);
  return sum / (v->n[0] * v->n[2] * v->length[1]);
}

/* max |s phi - t lap phi - (f - mean)| in units of the round-off of evaluating it,
 * epsilon (max|f| + (s + |t| |lap|) max|phi|). NaN counts as worst. */
static inline double poisson_residual(bw_grid *grid, const poisson_case *c, double s, double t,
                                      double mean, bw_real *phi, const bw_real *f)
{
  const bw_grid_view *v = bw_grid_look(grid);
  double worst[3] = {0, 0, 0};
  poisson_ghosts(grid, c, phi);
  FOR_CELLS(v, i, j, k)
  {
    const ptrdiff_t at = bw_at(v, i, j, k);
    const double r = s * (double)phi[at] - t * poisson_laplacian(v, phi, i, j, k);
    const double e = fabs(r - ((double)f[at] - mean));
    if (!(e <= worst[0])) worst[0] = isfinite(e) ? e : 1e300;
    worst[1] = fmax(worst[1], fabs((double)phi[at]));
    worst[2] = fmax(worst[2], fabs((double)f[at]));
  }
  bw_comm_max(bw_grid_comm(grid), 3, worst);
  return worst[0] /
         (BW_REAL_EPSILON * (worst[2] + worst[1] * (s + fabs(t) * poisson_operator_norm(v))));
}
