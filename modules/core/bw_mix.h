/* bw_mix.h -- the step of every checksum here: 64 bits to 64 bits, one to one. */
#pragma once
#include "bw_decls.h"

#include <stdint.h>

BW_BEGIN_DECLS

/* The finaliser of splitmix64 (Steele, Lea, Flood 2014): every bit in moves every bit out.
 * Local. */
static inline uint64_t bw_mix(uint64_t x)
{
  x ^= x >> 30;
  x *= UINT64_C(0xbf58476d1ce4e5b9);
  x ^= x >> 27;
  x *= UINT64_C(0x94d049bb133111eb);
  return x ^ (x >> 31);
}

BW_END_DECLS
