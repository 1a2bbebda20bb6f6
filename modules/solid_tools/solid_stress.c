/* Deformation gradient and stress from the families. */
#include "bw_solid_stress.h"
#include "pd_law.h"

#include <math.h>
#include <string.h>

/* Below this part of the cube of its mean eigenvalue the determinant of the shape tensor is that
 * of bonds in one plane (or line); a half family has 0.1 and more. */
static const double FLAT = 1e-6;

typedef struct {
  double y_xi[3][3], xi_xi[3][3], virial[3][3];
} family_sums;

static void block_sums(const bw_pd_body *pd, const bw_pd_block *block, int lane, family_sums *sum)
{
  /* Sums over bonds that hold: what broke carries nothing and tells nothing of F. */
  memset(sum, 0, sizeof *sum);
  const int32_t h = block->first + lane;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    if (!(slot->mask >> lane & 1)) continue;
    const int32_t l = slot->base + lane;
    const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
    const double w = rest.fraction * pd->level->dv;
    double y[3];
    for (int k = 0; k < 3; k++)
      y[k] = rest.xi[k] + ((double)pd->u[k][l] - (double)pd->u[k][h]);
    /* Present bond by reference bond, and reference by reference: the shape tensor. */
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        sum->y_xi[a][b] += w * y[a] * rest.xi[b];
        sum->xi_xi[a][b] += w * rest.xi[a] * rest.xi[b];
      }
  }
  /* The law knows its forces. */
  pd->law->virial(pd, block, lane, sum->virial);
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
  /* In the plane nothing spans the third direction: F_zz = 1. */
  double trace = 0;
  for (int k = 0; k < dimension; k++)
    trace += sum->xi_xi[k][k] / dimension;
  if (dimension == 2) sum->xi_xi[2][2] = sum->y_xi[2][2] = trace;
  const double det = determinant(sum->xi_xi);
  /* Bonds in one plane or line do not tell F: it is left at 1. */
  const bool flat = !(det > FLAT * trace * trace * trace);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      F[a][b] = a == b;
      if (flat) continue;
      F[a][b] = 0;
      for (int k = 0; k < 3; k++) /* the shape tensor and so its inverse are symmetric */
        F[a][b] += sum->y_xi[a][k] * cofactor(sum->xi_xi, k, b) / det;
    }
  /* J as the virial has to be divided by it. */
  const double J = determinant(F);
  return J > 0 ? J : 1; /* turned inside out: no volume to divide by */
}

static void stress_row(const bw_pd_body *pd, size_t i, const family_sums *sum, double J,
                       double s[6])
{
  const double nu = bw_pd_body_material(pd, i)->nu;
  /* The law's sum is J sigma: order xx yy zz, then yz xz xy. */
  for (int k = 0; k < 3; k++) {
    s[k] = sum->virial[k][k] / J;
    s[3 + k] = sum->virial[(k + 1) % 3][(k + 2) % 3] / J;
  }
  /* Held across: the plane's two stresses make the third, where the law does not know better. */
  if (pd->config.geometry == BW_PD_PLANE_STRAIN && s[2] == 0) s[2] = nu * (s[0] + s[1]);
}

void bw_solid_stress_compute(bw_solid *s, double F[], double stress[])
{
  bw_pd_body *pd = bw_solid_body(s);
  family_sums sum;
  double one[3][3];
  /* Families end in copies: they have to stand where they are now. */
  if (!pd->current) bw_pd_body_refresh(pd, false);
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(pd->bonds.block[b].mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(&pd->bonds.block[b], lane);
      block_sums(pd, &pd->bonds.block[b], lane, &sum);
      const double J = gradient(&sum, pd->dimension, one);
      if (F != NULL) memcpy(F + 9 * i, one, sizeof one);
      if (stress != NULL) stress_row(pd, i, &sum, J, stress + 6 * i);
    }
}
