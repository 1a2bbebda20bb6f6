/* ns_eddy.c -- eddy viscosity of eddies that no cell resolves: WALE (Nicoud & Ducros 1999).
 *
 * With g_ij = du_i/dx_j at a centre, S its symmetric part, S^d the symmetric part of g g without
 * its trace, Delta^3 the volume of the cell:
 *   nu_t = (C Delta)^2 (S^d:S^d)^(3/2) / ((S:S)^(5/2) + (S^d:S^d)^(5/4)).
 * It vanishes in plain shear, where g g = 0, and as y^3 at walls. The force 2 div(nu_t S) is that
 * of fluxes on the faces of the momentum cells: nu_t at centres for normal stresses, its mean of
 * four centres on edges for shear stresses, so that it takes energy from every field. It is
 * explicit and enters the right-hand sides R of the scheme. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <math.h>

bw_status bw_ns__eddy_create(bw_ns_channel *ns)
{
  if (ns->config.eddy == BW_EDDY_NONE) return BW_OK;
  BW_TRY(bw_field_create(ns->grid, &ns->eddy.nu));
  for (int c = 0; c < 3; c++)
    BW_TRY(bw_field_create(ns->grid, &ns->eddy.force[c]));
  ns->cost.bytes += 4 * sizeof(bw_real) * ns->g->size;
  return BW_OK;
}

void bw_ns__eddy_destroy(bw_ns_channel *ns)
{
  bw_release(&ns->eddy.nu);
  for (int c = 0; c < 3; c++)
    bw_release(&ns->eddy.force[c]);
}

/* ---- nu_t ---- */

enum { LANES = 8 }; /* cells side by side: compilers vectorise the innermost loops */

/* Gradients du_c/dx_d of LANES cells, and what is made of them. */
typedef double gradients[3][3][LANES];

/* nu_t/(C Delta)^2 of LANES velocity gradients. */
BW_NS_INLINE void wale(gradients g, double nu[restrict LANES])
{
  gradients gg;
  double ss[LANES] = {0}, dd[LANES] = {0}, third[LANES];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
#pragma omp simd
      for (int l = 0; l < LANES; l++)
        gg[i][j][l] = g[i][0][l] * g[0][j][l] + g[i][1][l] * g[1][j][l] + g[i][2][l] * g[2][j][l];
#pragma omp simd
  for (int l = 0; l < LANES; l++)
    third[l] = (gg[0][0][l] + gg[1][1][l] + gg[2][2][l]) / 3.0;
  /* S:S and S^d:S^d. */
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
#pragma omp simd
      for (int l = 0; l < LANES; l++) {
        const double s = 0.5 * (g[i][j][l] + g[j][i][l]);
        const double d = 0.5 * (gg[i][j][l] + gg[j][i][l]) - (i == j ? third[l] : 0.0);
        ss[l] += s * s, dd[l] += d * d;
      }
      /* Powers of quarters by square roots: (dd)^(5/4), (ss)^(5/2). Nothing moves: 0/1. */
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double below = ss[l] * ss[l] * sqrt(ss[l]) + dd[l] * sqrt(sqrt(dd[l]));
    nu[l] = dd[l] * sqrt(dd[l]) / (below > 0.0 ? below : 1.0);
  }
}

/* A row of cells: velocities at its cell 0, reciprocals of extents and of distances of centres. */
typedef struct {
  const bw_real *u[3];
  ptrdiff_t stride[3];
  double own[3], up[3], down[3];
} row_of_cells;

static row_of_cells row_at(const bw_ns_channel *ns, int j, int k)
{
  const bw_ns_metrics *m = &ns->metrics;
  row_of_cells r = {.own = {(double)m->rdx, (double)m->rdyf[j], (double)m->rdz},
                    .up = {(double)m->rdx, (double)m->rdyc[j], (double)m->rdz},
                    .down = {(double)m->rdx, (double)m->rdyc[j - 1], (double)m->rdz}};
  for (int d = 0; d < 3; d++) {
    r.u[d] = ns->u[d] + bw_at(ns->g, 0, j, k);
    r.stride[d] = ns->g->stride[d];
  }
  return r;
}

/* Gradients at the centres of `n` cells from i on: of the normal component between its two faces,
 * of the others between the means over their faces in the neighbouring cells. Lanes beyond n have
 * those of the last cell. */
BW_NS_INLINE void gradients_at(const row_of_cells *r, int i, int n, gradients g)
{
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) {
      const bw_real *u = r->u[c] + i;
      /* Along the component itself two faces are enough, and a halo of one cell has no third. */
      const ptrdiff_t own = r->stride[c], step = d == c ? 0 : r->stride[d];
      const double rd = r->own[d], up = 0.25 * r->up[d], down = 0.25 * r->down[d];
#pragma omp simd
      for (int l = 0; l < LANES; l++) {
        const bw_real *at = u + (l < n ? l : n - 1);
        const double here = (double)at[0] + (double)at[-own];
        const double above = (double)at[step] + (double)at[step - own];
        const double below = (double)at[-step] + (double)at[-step - own];
        g[c][d][l] = d == c ? ((double)at[0] - (double)at[-own]) * rd
                            : (above - here) * up + (here - below) * down;
      }
    }
}

/* nu_t of a row; returns the largest. */
static double viscosity_of_row(const row_of_cells *row, int cells, double scale,
                               bw_real *restrict nu)
{
  double most = 0.0;
  for (int i = 1; i <= cells; i += LANES) {
    const int n = cells + 1 - i < LANES ? cells + 1 - i : LANES;
    gradients g;
    double here[LANES];
    /* Full groups with a constant number of cells. */
    if (n == LANES)
      gradients_at(row, i, LANES, g);
    else
      gradients_at(row, i, n, g);
    wale(g, here);
    for (int l = 0; l < n; l++) {
      nu[i + l] = (bw_real)(scale * here[l]);
      most = fmax(most, scale * here[l]);
    }
  }
  return most;
}

void bw_ns__eddy_update(bw_ns_channel *ns)
{
  if (ns->config.eddy == BW_EDDY_NONE) return;
  const bw_grid_view *g = ns->g;
  const double dx = g->spacing[0], dz = g->spacing[2], C = ns->config.eddy_constant;
  ns->eddy.rate = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const double dy = ns->metrics.dyf[j], size = cbrt(dx * dy * dz), scale = C * C * size * size;
      const double rates = 4.0 * (1.0 / (dx * dx) + 1.0 / (dy * dy) + 1.0 / (dz * dz));
      const row_of_cells row = row_at(ns, j, k);
      /* What an explicit term of this viscosity allows. */
      ns->eddy.rate =
          fmax(ns->eddy.rate,
               rates * viscosity_of_row(&row, g->m[0], scale, ns->eddy.nu + bw_at(g, 0, j, k)));
    }
  bw_halo_update(ns->grid, 1, &ns->eddy.nu);
  bw_ns__ghosts_eddy(ns, ns->eddy.nu);
}

/* ---- its force ---- */

/* nu_t (du_c/dx_d + du_d/dx_c) on an edge, above a cell in directions c and d: values of that cell
 * and its neighbours along c (first stride) and d (second); rc, rd: 1 over distances of centres. */
BW_NS_INLINE double shear_stress(const bw_real *nu, const bw_real *uc, const bw_real *ud,
                                 ptrdiff_t along, ptrdiff_t across, double rc, double rd)
{
  const double mean =
      0.25 * ((double)nu[0] + (double)nu[along] + (double)nu[across] + (double)nu[along + across]);
  return mean *
         (((double)uc[across] - (double)uc[0]) * rd + ((double)ud[along] - (double)ud[0]) * rc);
}

/* force_c of a row += (stress_cd above - below)/extent of the momentum cell along d. */
static void add_shear(const bw_ns_channel *ns, int c, int d, int j, ptrdiff_t at)
{
  const bw_ns_metrics *m = &ns->metrics;
  const bw_real *restrict nu = ns->eddy.nu + at, *restrict uc = ns->u[c] + at;
  const bw_real *restrict ud = ns->u[d] + at;
  const ptrdiff_t along = ns->g->stride[c], across = ns->g->stride[d];
  const double r[3] = {(double)m->rdx, (double)m->rdyc[j], (double)m->rdz};
  const double below = d == 1 ? (double)m->rdyc[j - 1] : r[d];
  /* Of v's cells the extent in y is a distance of centres; no other component is divided by it. */
  const double extent = d == 1 ? (double)m->rdyf[j] : r[d], rc = r[c], rd = r[d];
  bw_real *restrict force = ns->eddy.force[c] + at;
#pragma omp simd
  for (int i = 1; i <= ns->g->m[0]; i++) {
    const double up = shear_stress(nu + i, uc + i, ud + i, along, across, rc, rd);
    const double down =
        shear_stress(nu + i - across, uc + i - across, ud + i - across, along, across, rc, below);
    force[i] += (bw_real)((up - down) * extent);
  }
}

/* force_c of a row <- 2 (nu_t du_c/dx_c above - below)/extent. */
static void set_normal(const bw_ns_channel *ns, int c, int j, ptrdiff_t at)
{
  const bw_ns_metrics *m = &ns->metrics;
  const bw_real *restrict nu = ns->eddy.nu + at, *restrict u = ns->u[c] + at;
  const ptrdiff_t own = ns->g->stride[c];
  const double r[3] = {(double)m->rdx, (double)m->rdyc[j], (double)m->rdz};
  /* The cells below and above the face of c. */
  const double here = c == 1 ? (double)m->rdyf[j] : r[c];
  const double above = c == 1 ? (double)m->rdyf[j + 1] : r[c], twice = 2.0 * r[c];
  bw_real *restrict force = ns->eddy.force[c] + at;
#pragma omp simd
  for (int i = 1; i <= ns->g->m[0]; i++)
    force[i] =
        (bw_real)(twice * ((double)nu[i + own] * ((double)u[i + own] - (double)u[i]) * above -
                           (double)nu[i] * ((double)u[i] - (double)u[i - own]) * here));
}

void bw_ns__eddy_force(bw_ns_channel *ns)
{
  if (ns->config.eddy == BW_EDDY_NONE) return;
  const bw_grid_view *g = ns->g;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int c = 0; c < 3; c++) {
        const ptrdiff_t at = bw_at(g, 0, j, k);
        set_normal(ns, c, j, at);
        for (int d = 0; d < 3; d++)
          if (d != c) add_shear(ns, c, d, j, at);
      }
}

void bw_ns__eddy_add(bw_ns_channel *ns, int r, double dt)
{
  if (ns->config.eddy == BW_EDDY_NONE) return;
  const bw_grid_view *g = ns->g;
  const bw_real alpha = (bw_real)(bw_ns__alpha[r] * dt);
  /* R keeps it for the next sub-step, whose beta R_prev it is a part of. */
  const bw_real keep = r < BW_NS_STAGES - 1 ? 1 : 0;
  for (int c = 0; c < 3; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++) {
        const ptrdiff_t at = bw_at(g, 0, j, k);
        const bw_real *restrict force = ns->eddy.force[c] + at;
        bw_real *restrict change = ns->sweep.change[c] + at, *restrict R = ns->R[c] + at;
        for (int i = 1; i <= g->m[0]; i++) {
          change[i] += alpha * force[i];
          R[i] += keep * force[i];
        }
      }
}

void bw_ns__eddy_stress(const bw_ns_channel *ns, double sum[])
{
  const bw_grid_view *g = ns->g;
  if (ns->config.eddy == BW_EDDY_NONE) return;
  /* Faces j = 1 .. n1 - 1; at the walls nu_t is zero. */
  const ptrdiff_t x = g->stride[0], y = g->stride[1];
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k);
        sum[j + g->lo[1]] += shear_stress(ns->eddy.nu + at, ns->u[0] + at, ns->u[1] + at, x, y,
                                          (double)ns->metrics.rdx, (double)ns->metrics.rdyc[j]);
      }
}
