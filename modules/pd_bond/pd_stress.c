/* Deformation gradient and stress from the families. */
#include "bw_pd_stress.h"
#include "pd_bond_internal.h"

#include <math.h>
#include <string.h>

/* Below this part of the cube of its mean eigenvalue the determinant of the shape tensor is that
 * of bonds in one plane (or line); a half family has 0.1 and more. */
static const double FLAT = 1e-6;

typedef struct {
  double y_xi[3][3], xi_xi[3][3], virial[3][3];
} family_sums;

/* Adds one bond: w = Gamma dV, k = c0 alpha. */
static void add_bond(family_sums *sum, const bw_pd_rest *rest, const double y[3], double w,
                     double k)
{
  const double *xi = rest->xi, r0 = rest->r0;
  const double r = sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
  const double f = r > 0 ? 0.5 * k * w * (r - r0) / (r0 * r) : 0; /* 1/2 c0 alpha s w/|y| */
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      sum->y_xi[a][b] += w * y[a] * xi[b];
      sum->xi_xi[a][b] += w * xi[a] * xi[b];
      sum->virial[a][b] += f * y[a] * y[b];
    }
}

static void block_sums(const bw_pd_bond *pd, const bw_pd_block *block, int lane, family_sums *sum)
{
  memset(sum, 0, sizeof *sum);
  const int32_t h = block->first + lane;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->slot[q];
    if (!(slot->mask >> lane & 1)) continue;
    const int32_t l = slot->base + lane;
    const bw_pd_rest rest = bw_pd_bond__rest(pd, slot->direction, h, l);
    double y[3];
    for (int k = 0; k < 3; k++)
      y[k] = rest.xi[k] + ((double)pd->u[k][l] - (double)pd->u[k][h]);
    add_bond(sum, &rest, y, rest.fraction * pd->dv,
             pd->c0 * bw_pd_bond__alpha(pd, block, slot, lane));
  }
}

static double cofactor(double m[3][3], int i, int j)
{
  const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
  return m[a][c] * m[b][d] - m[a][d] * m[b][c];
}

static double determinant(double m[3][3])
{
  return m[0][0] * cofactor(m, 0, 0) + m[0][1] * cofactor(m, 0, 1) + m[0][2] * cofactor(m, 0, 2);
}

/* Returns J. */
static double gradient(family_sums *sum, int dimension, double F[3][3])
{
  double trace = 0;
  for (int k = 0; k < dimension; k++)
    trace += sum->xi_xi[k][k] / dimension;
  if (dimension == 2) sum->xi_xi[2][2] = sum->y_xi[2][2] = trace;
  const double det = determinant(sum->xi_xi);
  const bool flat = !(det > FLAT * trace * trace * trace);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      F[a][b] = a == b;
      if (flat) continue;
      F[a][b] = 0;
      for (int k = 0; k < 3; k++) /* the shape tensor and so its inverse are symmetric */
        F[a][b] += sum->y_xi[a][k] * cofactor(sum->xi_xi, k, b) / det;
    }
  const double J = determinant(F);
  return J > 0 ? J : 1; /* turned inside out: no volume to divide by */
}

static void stress_row(const bw_pd_bond *pd, const family_sums *sum, double J, double s[6])
{
  for (int k = 0; k < 3; k++) {
    s[k] = sum->virial[k][k] / J;
    s[3 + k] = sum->virial[(k + 1) % 3][(k + 2) % 3] / J;
  }
  if (pd->config.geometry == BW_PD_PLANE_STRAIN) s[2] = pd->config.nu * (s[0] + s[1]);
}

void bw_pd_stress_compute(bw_pd_bond *pd, double F[], double stress[])
{
  family_sums sum;
  double one[3][3];
  if (!pd->current) bw_pd_bond__refresh(pd, false);
  for (size_t b = 0; b < pd->n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(pd->block[b].mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_bond__owner(&pd->block[b], lane);
      block_sums(pd, &pd->block[b], lane, &sum);
      const double J = gradient(&sum, pd->dimension, one);
      if (F != NULL) memcpy(F + 9 * i, one, sizeof one);
      if (stress != NULL) stress_row(pd, &sum, J, stress + 6 * i);
    }
}
