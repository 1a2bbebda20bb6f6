/* Principal values of a symmetric tensor, and the stiffest wave of an elastic state. */
#include "pd_material_internal.h"

#include <string.h>

/* One of Jacobi's rotations: the entry (p, q) becomes 0. */
static void rotate(double A[9], double Q[9], int p, int q)
{
  const double off = A[3 * p + q];
  if (off == 0) return;
  /* The smaller of the two angles that do it. */
  const double theta = (A[4 * q] - A[4 * p]) / (2 * off);
  const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
  const double c = 1 / sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double rp = A[3 * r + p], rq = A[3 * r + q];
  A[4 * p] -= t * off;
  A[4 * q] += t * off;
  A[3 * p + q] = A[3 * q + p] = 0;
  A[3 * r + p] = A[3 * p + r] = c * rp - s * rq;
  A[3 * r + q] = A[3 * q + r] = s * rp + c * rq;
  for (int i = 0; i < 3; i++) {
    const double ip = Q[3 * i + p], iq = Q[3 * i + q];
    Q[3 * i + p] = c * ip - s * iq;
    Q[3 * i + q] = s * ip + c * iq;
  }
}

void bw_pd_material__principal(const double tensor[9], double value[3], double Q[9])
{
  double A[9];
  memcpy(A, tensor, sizeof A);
  for (int q = 0; q < 9; q++)
    Q[q] = q % 4 == 0;
  /* Convergence is quadratic: six rounds are more than doubles hold. */
  for (int round = 0; round < 6; round++) {
    rotate(A, Q, 0, 1);
    rotate(A, Q, 0, 2);
    rotate(A, Q, 1, 2);
  }
  for (int k = 0; k < 3; k++)
    value[k] = A[4 * k];
}

/* dP of the displacement gradients along a.n, by central differences: (a.n):dP/dF gives a matrix
 * for fixed n when a runs over the unit vectors, and one for fixed a. */
static void tangent(const bw_pd_material_point *m, const double H[9], double A[9][9])
{
  static const double STEP = 1e-5;
  for (int q = 0; q < 9; q++) {
    lanes G[9], P[9];
    for (int c = 0; c < 9; c++) {
      G[c] = lanes_all(H[c]);
      if (c == q) G[c][0] += STEP, G[c][1] -= STEP;
    }
    bw_pd_material_stress(m, G, P, NULL);
    for (int c = 0; c < 9; c++)
      A[c][q] = (P[c][0] - P[c][1]) / (2 * STEP);
  }
}

/* The largest value of a.n:A:a.n from a start n: in turn the best a for n and the best n for a. */
static double best(double A[9][9], const double start[3])
{
  double n[3] = {start[0], start[1], start[2]}, most = 0;
  for (int pass = 0; pass < 60; pass++) {
    double M[9] = {0}, value[3], Q[9];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
          for (int l = 0; l < 3; l++)
            M[3 * i + k] += pass % 2 == 0 ? A[3 * i + j][3 * k + l] * n[j] * n[l]
                                          : A[3 * j + i][3 * l + k] * n[j] * n[l];
    bw_pd_material__principal(M, value, Q);
    /* The best direction of this pass is what the next one keeps. */
    int top = 0;
    for (int k = 1; k < 3; k++)
      if (value[k] > value[top]) top = k;
    for (int k = 0; k < 3; k++)
      n[k] = Q[3 * k + top];
    most = value[top];
  }
  return most;
}

double bw_pd_material_largest_tangent(const bw_pd_material_point *m, const double H[9])
{
  static const double start[][3] = {{1, 0, 0},      {0, 1, 0},      {0, 0, 1},
                                    {0.6, 0.8, 0},  {0.6, -0.8, 0}, {0.6, 0, 0.8},
                                    {0.6, 0, -0.8}, {0, 0.6, 0.8},  {0, 0.6, -0.8}};
  /* The search climbs to the nearest top: it starts from several sides. */
  double A[9][9], most = 0;
  tangent(m, H, A);
  const int n = m->plane == BW_PD_MATERIAL_SPACE ? 9 : 5;
  for (int q = 0; q < n; q++)
    if (m->plane == BW_PD_MATERIAL_SPACE || start[q][2] == 0) most = fmax(most, best(A, start[q]));
  return most;
}
