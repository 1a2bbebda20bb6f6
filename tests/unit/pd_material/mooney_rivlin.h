/* mooney_rivlin.h -- rubber with a second invariant: an energy that is no part of Breakwater.
 *
 *   W = c1 (I1 - 3) + c2 (I2 - 3) - (2 c1 + 4 c2) g + (lam - 4 c2)/2 g^2,   g = ln J
 * with C = F^T F, I1 = tr C, I2 = (I1^2 - tr C^2)/2. parameter[0] is the part c2/(c1 + c2). */
#pragma once
#include "pd_material_internal.h"

typedef struct {
  double c1, c2;   /* [M/(L T^2)] */
  double rest;     /* 2 c1 + 4 c2: nothing pulls at F = 1 */
  double dilation; /* lam - 4 c2, so that small strains have lam */
} mooney_rivlin_constants;

static mooney_rivlin_constants mooney_rivlin_of(const bw_pd_material_point *m)
{
  const double c2 = 0.5 * m->mu * m->parameter[0], c1 = 0.5 * m->mu - c2;
  return (mooney_rivlin_constants){c1, c2, 2 * c1 + 4 * c2, m->lam - 4 * c2};
}

static void mooney_rivlin_stress(const bw_pd_material_point *m, const lanes H[9], lanes P[9],
                                 lanes *W)
{
  const mooney_rivlin_constants k = mooney_rivlin_of(m);
  lanes F[9], T[9], B[9], BF[9], cof[9], g, I1 = lanes_all(0), I2 = lanes_all(0);
  for (int q = 0; q < 9; q++) {
    F[q] = q % 4 == 0 ? H[q] + 1 : H[q];
    I1 += F[q] * F[q];
  }
  for (int q = 0; q < 9; q++)
    T[q] = F[3 * (q % 3) + q / 3];
  /* F C = B F with B = F F^T; tr C^2 = B:B. */
  PRODUCT(F, T, B);
  PRODUCT(B, F, BF);
  for (int q = 0; q < 9; q++)
    I2 -= 0.5 * B[q] * B[q];
  I2 += 0.5 * I1 * I1;
  /* F^-T = cof F/J. */
  COFACTORS(F, cof);
  const lanes J = DETERMINANT(F, cof);
  g = lanes_of(log, J);
  for (int q = 0; q < 9; q++)
    P[q] =
        2 * k.c1 * F[q] + 2 * k.c2 * (I1 * F[q] - BF[q]) + (k.dilation * g - k.rest) * cof[q] / J;
  if (W != NULL) *W = k.c1 * (I1 - 3) + k.c2 * (I2 - 3) - k.rest * g + 0.5 * k.dilation * g * g;
}

static const bw_pd_material_energy mooney_rivlin = {"mooney_rivlin", mooney_rivlin_stress};
