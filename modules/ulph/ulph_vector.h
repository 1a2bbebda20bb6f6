/* ulph_vector.h -- BW_ULPH_LANES numbers at a time. */
#pragma once
#include <math.h>
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

/* The weight (1 - q)^4 (1 + 4 q) with q = r/R, 0 beyond R. */
BW_ULPH_PIECE vec vec_weight(vec r2, double inverse_R2)
{
  const vec q = vec_sqrt(r2 * inverse_R2);
  vec up = vec_above_0(1 - q);
  up *= up;
  return up * up * (1 + 4 * q);
}
