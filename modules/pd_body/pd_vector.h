/* pd_vector.h -- BW_PD_LANES numbers at a time, for the bond sweeps.
 *
 * A vector is a gcc/clang vector type of the processor's width. With AVX-512 the operations the
 * language cannot express (fused multiply-add, reciprocal root, lane masks) use its instructions;
 * elsewhere they are plain vector arithmetic. Both ways a bond seen from its two ends gives
 * exactly opposite results: every operation is exact under a change of sign. */
#pragma once
#include "pd_body.h"
#include <math.h>
#include <string.h>
#ifdef __AVX512VL__
#include <immintrin.h>
#endif

typedef bw_real vec __attribute__((vector_size(BW_PD_LANES * sizeof(bw_real))));

static inline vec vec_load(const bw_real *from)
{
  vec x;
  memcpy(&x, from, sizeof x);
  return x;
}

static inline void vec_store(bw_real *to, vec x)
{
  memcpy(to, &x, sizeof x);
}

static inline vec vec_all(bw_real x)
{
#if BW_PD_LANES == 8
  return (vec){x, x, x, x, x, x, x, x};
#elif BW_PD_LANES == 4
  return (vec){x, x, x, x};
#else
  return (vec){x, x};
#endif
}

/* Whole numbers. */
static inline vec vec_whole(const uint16_t *from)
{
#if defined(__AVX512VL__) && defined(BW_SINGLE)
  return (vec)_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)from)));
#elif defined(__AVX512VL__)
  return (vec)_mm512_cvtepi32_pd(_mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)from)));
#else
  vec x;
  for (int k = 0; k < BW_PD_LANES; k++)
    x[k] = from[k];
  return x;
#endif
}

static inline double vec_sum(vec x)
{
  double sum = 0;
  for (int k = 0; k < BW_PD_LANES; k++)
    sum += (double)x[k];
  return sum;
}

/* lanes: a choice of lanes. lanes_of and lanes_bits turn a mask (bit k: lane k) into one and back;
 * choices are joined and met with | and &. */
#ifdef __AVX512VL__

typedef uint8_t lanes;

static inline lanes lanes_of(uint8_t bits)
{
  return bits;
}

static inline uint8_t lanes_bits(lanes m)
{
  return m;
}

#ifndef BW_SINGLE

static inline vec vec_fma(vec a, vec b, vec c)
{
  return (vec)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
}

/* c - a b */
static inline vec vec_fnma(vec a, vec b, vec c)
{
  return (vec)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
}

/* 1/sqrt(x): the 14-bit estimate y and one step of fourth order, y (1 + e/2 + 3e^2/8 + 5e^3/16)
 * with e = 1 - x y^2, |e| < 2^-13: the next term is below 2^-53. */
static inline vec vec_rsqrt(vec x)
{
  const vec y = (vec)_mm512_rsqrt14_pd((__m512d)x);
  const vec e = vec_fnma(x * y, y, vec_all(1.0));
  const vec p = vec_fma(vec_fma(vec_all(0.3125), e, vec_all(0.375)), e, vec_all(0.5));
  return vec_fma(y * e, p, y);
}

/* x in the lanes of mask, 0 in the others. */
static inline vec vec_keep(lanes mask, vec x)
{
  return (vec)_mm512_maskz_mov_pd(mask, (__m512d)x);
}

static inline lanes vec_above(vec a, vec b)
{
  return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_GT_OQ);
}

#else

static inline vec vec_fma(vec a, vec b, vec c)
{
  return (vec)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
}

static inline vec vec_fnma(vec a, vec b, vec c)
{
  return (vec)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c);
}

/* One step of second order doubles the 14 bits of the estimate. */
static inline vec vec_rsqrt(vec x)
{
  const vec y = (vec)_mm256_rsqrt14_ps((__m256)x);
  const vec e = vec_fnma(x * y, y, vec_all(1.0f));
  return vec_fma(y * e, vec_fma(vec_all(0.375f), e, vec_all(0.5f)), y);
}

static inline vec vec_keep(lanes mask, vec x)
{
  return (vec)_mm256_maskz_mov_ps(mask, (__m256)x);
}

static inline lanes vec_above(vec a, vec b)
{
  return _mm256_cmp_ps_mask((__m256)a, (__m256)b, _CMP_GT_OQ);
}

#endif

#else

#ifdef BW_SINGLE
typedef int32_t lane_bits;
#else
typedef int64_t lane_bits;
#endif
typedef lane_bits lanes __attribute__((vector_size(BW_PD_LANES * sizeof(bw_real))));

static inline lanes lanes_of(uint8_t bits)
{
#if BW_PD_LANES == 8
  const lanes bit = {1, 2, 4, 8, 16, 32, 64, 128};
#elif BW_PD_LANES == 4
  const lanes bit = {1, 2, 4, 8};
#else
  const lanes bit = {1, 2};
#endif
  return (bit & (lane_bits)bits) != 0;
}

static inline uint8_t lanes_bits(lanes m)
{
  unsigned bits = 0;
  for (int k = 0; k < BW_PD_LANES; k++)
    bits |= (unsigned)(m[k] & 1) << k;
  return (uint8_t)bits;
}

static inline vec vec_fma(vec a, vec b, vec c)
{
  return a * b + c;
}

static inline vec vec_fnma(vec a, vec b, vec c)
{
  return c - a * b;
}

#ifdef BW_SINGLE
#define SQRT sqrtf
#else
#define SQRT sqrt
#endif
static inline vec vec_rsqrt(vec x)
{
  bw_real y[BW_PD_LANES];
  memcpy(y, &x, sizeof y);
#pragma omp simd
  for (int k = 0; k < BW_PD_LANES; k++)
    y[k] = SQRT(y[k]);
  memcpy(&x, y, sizeof y);
  return 1 / x;
}
#undef SQRT

static inline vec vec_keep(lanes mask, vec x)
{
  return (vec)((lanes)x & mask);
}

static inline lanes vec_above(vec a, vec b)
{
  return (lanes)(a > b);
}

#endif

/* The smaller of a and b; x moved into 0 .. 1. */
#if defined(__AVX512VL__) && !defined(BW_SINGLE)
static inline vec vec_least(vec a, vec b)
{
  return (vec)_mm512_min_pd((__m512d)a, (__m512d)b);
}

static inline vec vec_clamp(vec x)
{
  return (vec)_mm512_min_pd(_mm512_max_pd((__m512d)x, _mm512_setzero_pd()), _mm512_set1_pd(1));
}
#elif defined(__AVX512VL__)
static inline vec vec_least(vec a, vec b)
{
  return (vec)_mm256_min_ps((__m256)a, (__m256)b);
}

static inline vec vec_clamp(vec x)
{
  return (vec)_mm256_min_ps(_mm256_max_ps((__m256)x, _mm256_setzero_ps()), _mm256_set1_ps(1));
}
#else
static inline vec vec_least(vec a, vec b)
{
  for (int k = 0; k < BW_PD_LANES; k++)
    a[k] = a[k] < b[k] ? a[k] : b[k];
  return a;
}

static inline vec vec_clamp(vec x)
{
  for (int k = 0; k < BW_PD_LANES; k++)
    x[k] = x[k] < 0 ? 0 : x[k] < 1 ? x[k] : 1;
  return x;
}
#endif

/* The lanes of a block's owners to successive own places: all at once when the block is full. */
static inline void vec_put_owners(const bw_pd_block *block, vec x, bw_real *own)
{
  if (block->mask == (1u << BW_PD_LANES) - 1) {
    vec_store(own + block->own, x);
    return;
  }
  int32_t at = block->own;
  for (int k = 0; k < BW_PD_LANES; k++)
    if (block->mask >> k & 1) own[at++] = x[k];
}
