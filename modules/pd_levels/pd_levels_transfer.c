/* What goes from the particles of a cell to those that take their place. */
#include "bw_pd_levels.h"

#include <math.h>
#include <string.h>

/* Inverse of the symmetric M (3,3), of which the leading `dimension` count; false where it is
 * singular to rounding of the places of neighbours. */
static bool invert(int dimension, double M[3][3], double out[3][3])
{
  static const double FLAT = 1e-6; /* least over mean extent of a family, squared */
  if (dimension == 2) M[2][2] = 0.5 * (M[0][0] + M[1][1]);
  double det = 0;
  for (int k = 0; k < 3; k++)
    for (int q = 0; q < 3; q++) {
      const int a = (q + 1) % 3, b = (q + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      out[k][q] = M[a][c] * M[b][d] - M[a][d] * M[b][c];
    }
  for (int q = 0; q < 3; q++)
    det += M[0][q] * out[q][0];
  const double mean = (M[0][0] + M[1][1] + M[2][2]) / 3;
  if (!(det > FLAT * mean * mean * mean)) return false;
  for (int k = 0; k < 9; k++)
    out[k / 3][k % 3] /= det;
  return true;
}

void bw_pd_levels_gradient(int dimension, size_t n, const double weight[], const double xi[],
                           const double df[], double G[9])
{
  double M[3][3] = {{0}}, N[3][3] = {{0}}, inverse[3][3];
  /* Normal equations G M = N. */
  for (size_t q = 0; q < n; q++)
    for (int k = 0; k < dimension; k++)
      for (int d = 0; d < dimension; d++) {
        M[k][d] += weight[q] * xi[3 * q + (size_t)k] * xi[3 * q + (size_t)d];
        N[k][d] += weight[q] * df[3 * q + (size_t)k] * xi[3 * q + (size_t)d];
      }
  memset(G, 0, 9 * sizeof *G);
  if (!invert(dimension, M, inverse)) return;
  for (int k = 0; k < dimension; k++)
    for (int d = 0; d < dimension; d++)
      for (int q = 0; q < dimension; q++)
        G[3 * k + d] += N[k][q] * inverse[q][d];
}

/* From the centre of a cell of spacing ds to that of its part after `splits` splits. */
static void away_of(int dimension, double ds, const double axes[3][3], int splits, size_t part,
                    double away[3])
{
  memset(away, 0, 3 * sizeof *away);
  for (int s = 0; s < splits; s++) {
    /* The first split's part is in the highest bits. */
    const size_t bits = part >> (dimension * (splits - 1 - s));
    for (int k = 0; k < dimension; k++)
      for (int d = 0; d < 3; d++)
        away[d] += (bits >> k & 1 ? 1 : -1) * ldexp(ds, -s - 2) * axes[k][d];
  }
}

static void refine(int dimension, double ds, const double axes[3][3], int splits, size_t part,
                   const bw_pd_levels_rider *parent, bw_pd_levels_rider *child)
{
  double away[3];
  away_of(dimension, ds, axes, splits, part, away);
  *child = *parent;
  for (int v = 0; v < 2; v++)
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 3; d++)
        child->f[v][k] += parent->G[v][3 * k + d] * away[d];
}

/* All have one mass. What is retired as a whole stays so. */
static void coarsen(size_t n, const bw_pd_levels_rider part[], bw_pd_levels_rider *all)
{
  *all = (bw_pd_levels_rider){.kind = part[0].kind};
  for (size_t q = 0; q < n; q++) {
    all->kind = (uint8_t)(all->kind & part[q].kind);
    for (int v = 0; v < BW_PD_LEVELS_VECTORS; v++)
      for (int k = 0; k < 3; k++)
        all->f[v][k] += part[q].f[v][k] / (double)n;
  }
}

void bw_pd_levels_recast(int dimension, double ds, const double axes[3][3], int from, int to,
                         const bw_pd_levels_rider before[], bw_pd_levels_rider after[])
{
  const size_t n = (size_t)1 << (dimension * to);
  const int splits = to - from;
  for (size_t q = 0; q < n; q++)
    if (splits >= 0)
      refine(dimension, ldexp(ds, -from), axes, splits,
             q & (((size_t)1 << (dimension * splits)) - 1), &before[q >> (dimension * splits)],
             &after[q]);
    else
      coarsen((size_t)1 << (dimension * -splits), before + (q << (dimension * -splits)), &after[q]);
}
