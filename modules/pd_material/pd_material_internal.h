/* pd_material_internal.h -- tensors of nine, for one point and for lanes of points. */
#pragma once
#include "bw_pd_material.h"

#include <math.h>
#include <stddef.h>

typedef bw_pd_material_lanes lanes;

static inline lanes lanes_all(double x)
{
  return (lanes){x, x, x, x, x, x, x, x};
}

/* f of every lane. */
static inline lanes lanes_of(double (*f)(double), lanes x)
{
  for (int k = 0; k < BW_PD_MATERIAL_LANES; k++)
    x[k] = f(x[k]);
  return x;
}

/* Cofactors of A: J F^-T of a deformation gradient. TYPE: double or lanes. */
#define COFACTORS(A, C)                                                                            \
  do {                                                                                             \
    for (int i_ = 0; i_ < 3; i_++)                                                                 \
      for (int j_ = 0; j_ < 3; j_++) {                                                             \
        const int p_ = 3 * ((i_ + 1) % 3), q_ = 3 * ((i_ + 2) % 3);                                \
        const int r_ = (j_ + 1) % 3, s_ = (j_ + 2) % 3;                                            \
        (C)[3 * i_ + j_] = (A)[p_ + r_] * (A)[q_ + s_] - (A)[p_ + s_] * (A)[q_ + r_];              \
      }                                                                                            \
  } while (0)

/* Determinant by the first row and its cofactors. */
#define DETERMINANT(A, C) ((A)[0] * (C)[0] + (A)[1] * (C)[1] + (A)[2] * (C)[2])

/* C = A B, row-major. */
#define PRODUCT(A, B, C)                                                                           \
  do {                                                                                             \
    for (int i_ = 0; i_ < 3; i_++)                                                                 \
      for (int j_ = 0; j_ < 3; j_++)                                                               \
        (C)[3 * i_ + j_] =                                                                         \
            (A)[3 * i_] * (B)[j_] + (A)[3 * i_ + 1] * (B)[3 + j_] + (A)[3 * i_ + 2] * (B)[6 + j_]; \
  } while (0)

/* Stress is linear in a symmetric strain: 2 mu e + lam tr(e) 1. */
#define HOOKE(lam, mu, e, s)                                                                       \
  do {                                                                                             \
    for (int q_ = 0; q_ < 9; q_++)                                                                 \
      (s)[q_] = (e)[q_] * (2 * (mu));                                                              \
    for (int k_ = 0; k_ < 9; k_ += 4)                                                              \
      (s)[k_] += ((e)[0] + (e)[4] + (e)[8]) * (lam);                                               \
  } while (0)

/* Principal values (descending is not promised) and directions (columns of Q) of a symmetric
 * tensor, by Jacobi's rotations. */
void bw_pd_material__principal(const double A[9], double value[3], double Q[9]);
