/* ulph_vector.h -- BW_ULPH_LANES numbers at a time. */
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __AVX__
#include <immintrin.h>
#endif

#ifdef __AVX512F__
enum { BW_ULPH_LANES = 8 };
#else
enum { BW_ULPH_LANES = 4 };
#endif

typedef double vec __attribute__((vector_size(8 * BW_ULPH_LANES)));
typedef int64_t vec_bits __attribute__((vector_size(8 * BW_ULPH_LANES)));

/* A function that is a piece of a loop: its number of dimensions is a constant there. */
#define BW_ULPH_PIECE static inline __attribute__((always_inline))

/* x where the comparison says so, else 0. */
BW_ULPH_PIECE vec vec_where(vec_bits so, vec x)
{
  return (vec)((vec_bits)x & so);
}

/* x where the comparison says so, else y. */
BW_ULPH_PIECE vec vec_choose(vec_bits so, vec x, vec y)
{
  return (vec)(((vec_bits)x & so) | ((vec_bits)y & ~so));
}

/* Does a comparison hold in any lane? */
BW_ULPH_PIECE bool vec_any(vec_bits so)
{
#ifdef __AVX512F__
  return _mm512_test_epi64_mask((__m512i)so, (__m512i)so) != 0;
#else
  int64_t any = 0;
  for (int l = 0; l < BW_ULPH_LANES; l++)
    any |= so[l];
  return any != 0;
#endif
}

BW_ULPH_PIECE double vec_sum(vec x)
{
  double sum = 0;
  for (int l = 0; l < BW_ULPH_LANES; l++)
    sum += x[l];
  return sum;
}

BW_ULPH_PIECE vec vec_dot(const vec a[3], const vec b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* x where it is above 0, else 0. */
BW_ULPH_PIECE vec vec_above_0(vec x)
{
  return (vec)((vec_bits)x & (vec_bits)(x > 0));
}

BW_ULPH_PIECE vec vec_sqrt(vec x)
{
#ifdef __AVX512F__
  return (vec)_mm512_sqrt_pd((__m512d)x);
#elif defined(__AVX__)
  return (vec)_mm256_sqrt_pd((__m256d)x);
#else
  for (int l = 0; l < BW_ULPH_LANES; l++)
    x[l] = sqrt(x[l]);
  return x;
#endif
}

/* Square root of numbers above 0 to an ulp: two steps of Newton's method on an estimate of 14 bits,
 * as the root that is rounded rightly holds up everything else. */
BW_ULPH_PIECE vec vec_root(vec x)
{
#ifdef __AVX512F__
  const vec y = (vec)_mm512_rsqrt14_pd((__m512d)x);
  vec root = x * y, half = 0.5 * y;
  for (int q = 0; q < 2; q++) {
    const vec rest = 0.5 - root * half;
    root += root * rest;
    half += half * rest;
  }
  return root;
#else
  return vec_sqrt(x);
#endif
}

/* 1/x to an ulp or two, in the same way. */
BW_ULPH_PIECE vec vec_inverse(vec x)
{
#ifdef __AVX512F__
  vec y = (vec)_mm512_rcp14_pd((__m512d)x);
  for (int q = 0; q < 2; q++)
    y += y * (1 - x * y);
  return y;
#else
  return 1 / x;
#endif
}

/* out = A x, of a symmetric A: xx xy xz yy yz zz. */
BW_ULPH_PIECE void vec_times(const vec A[6], const vec x[3], vec out[3])
{
  out[0] = A[0] * x[0] + A[1] * x[1] + A[2] * x[2];
  out[1] = A[1] * x[0] + A[3] * x[1] + A[4] * x[2];
  out[2] = A[2] * x[0] + A[4] * x[1] + A[5] * x[2];
}

/* The weight (1 - q)^4 (1 + 4 q) with q = r/R, 0 beyond R. */
BW_ULPH_PIECE vec vec_weight(vec r2, double inverse_R2)
{
  const vec q = vec_root(r2 * inverse_R2 + 1e-40);
  vec up = vec_above_0(1 - q);
  up *= up;
  return up * up * (1 + 4 * q);
}
