/* Elastic materials: stress and energy of a displacement gradient, eight points at a time. */
#include "pd_material_internal.h"

static const double LEAST_J = 0.1; /* below it the logarithm of J is continued by its parabola */

bw_pd_material_point bw_pd_material_elastic_point(bw_pd_material_plane plane,
                                                  bw_pd_material_elastic elastic, double E,
                                                  double nu)
{
  return (bw_pd_material_point){.plane = plane,
                                .elastic = elastic,
                                .lam = E * nu / ((1 + nu) * (1 - 2 * nu)),
                                .mu = E / (2 * (1 + nu)),
                                .yield = {.k = INFINITY}};
}

/* e:s/2 */
static lanes half_product(const lanes a[9], const lanes b[9])
{
  lanes sum = a[0] * b[0];
  for (int q = 1; q < 9; q++)
    sum += a[q] * b[q];
  return sum * 0.5;
}

/* sigma33 = 0 of a law that is linear in its strain. */
static lanes across(const bw_pd_material_point *m, lanes in_plane)
{
  return in_plane * (-m->lam / (m->lam + 2 * m->mu));
}

static void linear(const bw_pd_material_point *m, lanes H[9], lanes P[9], lanes *W)
{
  lanes e[9];
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) H[8] = across(m, H[0] + H[4]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      e[3 * i + j] = (H[3 * i + j] + H[3 * j + i]) * 0.5;
  HOOKE(m->lam, m->mu, e, P);
  if (W != NULL) *W = half_product(e, P);
}

/* Green's strain, without the difference of F^T F and 1. */
static void green(const lanes H[9], lanes E[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      E[3 * i + j] =
          (H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] + H[6 + i] * H[6 + j]) *
          0.5;
}

static double root_minus_1(double x) /* sqrt(1 + 2x) - 1; no stretch below a thousandth */
{
  return sqrt(fmax(1 + 2 * x, 1e-6)) - 1;
}

static void saint_venant(const bw_pd_material_point *m, lanes H[9], lanes P[9], lanes *W)
{
  lanes E[9], S[9], F[9];
  green(H, E);
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) {
    E[8] = across(m, E[0] + E[4]);
    H[8] = lanes_of(root_minus_1, E[8]);
  }
  HOOKE(m->lam, m->mu, E, S);
  if (W != NULL) *W = half_product(E, S);
  for (int q = 0; q < 9; q++)
    F[q] = q % 4 == 0 ? H[q] + 1 : H[q];
  PRODUCT(F, S, P);
}

/* ln J, its continuation, and its derivative by J. */
static double logarithm(double J, double *slope)
{
  if (J > LEAST_J) {
    *slope = 1 / J;
    return log(J);
  }
  const double x = (J - LEAST_J) / LEAST_J;
  *slope = (1 - x) / LEAST_J;
  return log(LEAST_J) + x - 0.5 * x * x;
}

/* F33 of plane stress: mu F33^2 + lam (ln J2 + ln F33) = mu, J2 the area's change. Newton in the
 * logarithm x of F33, of which the left side is convex and rises: it converges from anywhere. */
static double thickness(const bw_pd_material_point *m, double J2)
{
  double slope;
  const double area = logarithm(J2, &slope);
  double x = -m->lam * area / (m->lam + 2 * m->mu);
  for (int pass = 0; pass < 60; pass++) {
    const double e = m->mu * exp(2 * x), f = e + m->lam * (area + x) - m->mu;
    const double step = f / (2 * e + m->lam);
    x -= step;
    if (fabs(step) < 1e-15 * (1 + fabs(x))) break;
  }
  return exp(x);
}

static void neo_hookean(const bw_pd_material_point *m, lanes H[9], lanes P[9], lanes *W)
{
  lanes F[9], C[9], g, slope, I1 = lanes_all(0);
  for (int q = 0; q < 9; q++)
    F[q] = q % 4 == 0 ? H[q] + 1 : H[q];
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) {
    const lanes J2 = F[0] * F[4] - F[1] * F[3];
    for (int k = 0; k < BW_PD_MATERIAL_LANES; k++)
      F[8][k] = thickness(m, J2[k]);
    H[8] = F[8] - 1;
  }
  /* ln J lane by lane: the processor has no logarithm of a vector. */
  COFACTORS(F, C);
  const lanes J = DETERMINANT(F, C);
  for (int k = 0; k < BW_PD_MATERIAL_LANES; k++) {
    double one;
    g[k] = logarithm(J[k], &one);
    slope[k] = one;
  }
  /* dJ/dF = cof F. */
  const lanes pressure = (g * m->lam - m->mu) * slope;
  for (int q = 0; q < 9; q++) {
    P[q] = F[q] * m->mu + pressure * C[q];
    I1 += F[q] * F[q];
  }
  if (W != NULL) *W = (I1 - 3) * (0.5 * m->mu) - g * m->mu + g * g * (0.5 * m->lam);
}

/* One point: h = ln(C)/2 in principal directions N of C, P = F N s N^T with s = (lam tr h + 2 mu
 * h)/stretch^2; no stretch is below a thousandth. Returns W. */
static double hencky_one(const bw_pd_material_point *m, double H[9], double P[9])
{
  double C[9], c[3], N[9], h[3], S[9] = {0}, F[9];
  const int last = m->plane == BW_PD_MATERIAL_SPACE ? 3 : 2;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = (i == 2 || j == 2) && last == 2
                         ? 0 /* the third direction is a principal one: below */
                         : H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] +
                               (last == 3 ? H[6 + i] * H[6 + j] : 0);
  /* C less 1 has the principal directions of C, and its values keep their digits. */
  bw_pd_material__principal(C, c, N);
  for (int a = 0; a < 3; a++)
    h[a] = 0.5 * log1p(fmax(c[a], -1 + 1e-6));
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) {
    /* The row of zeros belongs to the direction that is z. */
    for (int a = 0; a < 3; a++)
      if (fabs(N[6 + a]) > 0.5) {
        h[a] = 0;
        h[a] = -m->lam / (m->lam + 2 * m->mu) * (h[0] + h[1] + h[2]);
        c[a] = expm1(2 * h[a]);
        H[8] = expm1(h[a]);
      }
  }
  /* Second Piola-Kirchhoff stress from the principal stresses of Kirchhoff. */
  const double trace = h[0] + h[1] + h[2];
  for (int a = 0; a < 3; a++) {
    const double s = (m->lam * trace + 2 * m->mu * h[a]) / (1 + fmax(c[a], -1 + 1e-6));
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        S[3 * i + j] += s * N[3 * i + a] * N[3 * j + a];
  }
  for (int q = 0; q < 9; q++)
    F[q] = q % 4 == 0 ? H[q] + 1 : H[q];
  PRODUCT(F, S, P);
  return 0.5 * m->lam * trace * trace + m->mu * (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}

static void hencky(const bw_pd_material_point *m, lanes H[9], lanes P[9], lanes *W)
{
  for (int k = 0; k < BW_PD_MATERIAL_LANES; k++) {
    double one[9], p[9];
    for (int q = 0; q < 9; q++)
      one[q] = H[q][k];
    const double w = hencky_one(m, one, p);
    for (int q = 0; q < 9; q++)
      P[q][k] = p[q];
    H[8][k] = one[8];
    if (W != NULL) (*W)[k] = w;
  }
}

/* An energy of one's own in plane stress: P33 = 0 in every lane, by the secant's steps from the
 * slope of Hooke's law; no thickness below a hundredth. */
static void own_thickness(const bw_pd_material_point *m, lanes H[9])
{
  lanes P[9], before = lanes_all(0), last = lanes_all(0);
  H[8] = across(m, H[0] + H[4]);
  for (int pass = 0; pass < 50; pass++) {
    double most = 0;
    m->own->stress(m, H, P, NULL);
    for (int k = 0; k < BW_PD_MATERIAL_LANES; k++) {
      const bool known = pass > 0 && P[8][k] != last[k];
      const double slope = known ? (P[8][k] - last[k]) / (H[8][k] - before[k]) : m->lam + 2 * m->mu;
      before[k] = H[8][k], last[k] = P[8][k];
      /* What is as small as rounding is left, or the secant would divide by it. */
      if (fabs(P[8][k]) < 1e-15 * m->mu || !(slope > 0)) continue;
      H[8][k] = fmax(H[8][k] - P[8][k] / slope, -0.99);
      most = fmax(most, fabs(H[8][k] - before[k]) / (1 + fabs(H[8][k])));
    }
    if (!(most > 1e-15)) break;
  }
}

/* P and W of an energy of one's own, in the plane too. */
static void own_stress(const bw_pd_material_point *m, lanes H[9], lanes P[9], lanes *W)
{
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) own_thickness(m, H);
  m->own->stress(m, H, P, W);
}

void bw_pd_material_stress(const bw_pd_material_point *m, bw_pd_material_lanes H[9],
                           bw_pd_material_lanes P[9], bw_pd_material_lanes *W)
{
  static void (*const stress[])(const bw_pd_material_point *, lanes *, lanes *,
                                lanes *) = {linear, saint_venant, neo_hookean, hencky};
  /* In the plane nothing leaves it: what the caller has out of it is replaced. */
  if (m->plane != BW_PD_MATERIAL_SPACE) H[2] = H[5] = H[6] = H[7] = H[8] = lanes_all(0);
  (m->own != NULL ? own_stress : stress[m->elastic])(m, H, P, W);
}
