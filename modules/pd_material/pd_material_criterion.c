/* Criteria of failure at a point. */
#include "bw_pd_material_criterion.h"
#include "pd_material_internal.h"

void bw_pd_material_principal_stress(const double s[6], double value[3], double direction[3][3])
{
  const double S[9] = {s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2]};
  double v[3], Q[9];
  int order[3] = {0, 1, 2};
  bw_pd_material__principal(S, v, Q);
  /* Three are sorted by hand; the directions are columns of Q. */
  for (int a = 0; a < 2; a++)
    for (int b = a + 1; b < 3; b++)
      if (v[order[b]] > v[order[a]]) {
        const int c = order[a];
        order[a] = order[b], order[b] = c;
      }
  for (int a = 0; a < 3; a++) {
    if (value != NULL) value[a] = v[order[a]];
    for (int k = 0; k < 3 && direction != NULL; k++)
      direction[a][k] = Q[3 * k + order[a]];
  }
}

/* J2. */
static double deviator(const double s[6])
{
  const double mean = (s[0] + s[1] + s[2]) / 3;
  double sum = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  for (int k = 0; k < 3; k++)
    sum += 0.5 * (s[k] - mean) * (s[k] - mean);
  return sum;
}

double bw_pd_material_used(const bw_pd_material_criterion *c, double lam, double mu,
                           const double s[6])
{
  const double I1 = s[0] + s[1] + s[2], J2 = deviator(s);
  const double sine = sin(c->friction), cosine = cos(c->friction);
  double p[3];
  switch (c->kind) {
  case BW_PD_MATERIAL_ENERGY: {
    /* 2 W = J2/mu + I1^2/(9 K). */
    const double K = lam + 2 * mu / 3, E = 9 * K * mu / (3 * K + mu);
    return sqrt(E * (J2 / mu + I1 * I1 / (9 * K))) / c->limit;
  }
  case BW_PD_MATERIAL_MISES:
    return sqrt(3 * J2) / c->limit;
  case BW_PD_MATERIAL_CONE:
    return (sqrt(J2) + sine / 3 * I1) / (c->limit * cosine);
  case BW_PD_MATERIAL_MOHR_COULOMB:
    bw_pd_material_principal_stress(s, p, NULL);
    return ((p[0] - p[2]) + (p[0] + p[2]) * sine) / (2 * c->limit * cosine);
  default:
    bw_pd_material_principal_stress(s, p, NULL);
    return p[0] / c->limit;
  }
}
