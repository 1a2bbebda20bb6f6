/* particles_test.h -- numbers that depend on a key alone, and bodies of lattice sites. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_particles_map.h"

#include <string.h>

/* The last step of splitmix64 (Steele, Lea & Flood 2014): every bit of the key moves every bit. */
static inline uint64_t scramble(uint64_t key)
{
  uint64_t z = key * 0x9E3779B97F4A7C15u + 0x632BE59BD9B4E019u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/* In [0, 1). */
static inline double fraction_of(uint64_t key)
{
  return (double)(scramble(key) >> 11) / 9007199254740992.0;
}

/* A body: sites (n,3), the same on all ranks; owned by the test. */
typedef struct {
  size_t n;
  int32_t *site;
} body;

static inline body body_of(size_t most)
{
  body b = {0};
  bw_check_ok(BW_ALLOCATE(&b.site, 3 * most));
  return b;
}

static inline void body_add(body *b, int i, int j, int k)
{
  const int32_t site[3] = {i, j, k};
  memcpy(b->site + 3 * b->n++, site, sizeof site);
}

/* Every site of a box for which keep is true. */
static inline body body_box(const int lower[3], const int size[3], bool (*keep)(const int at[3]))
{
  body b = body_of((size_t)(size[0] * size[1] * size[2]));
  for (int k = 0; k < size[2]; k++)
    for (int j = 0; j < size[1]; j++)
      for (int i = 0; i < size[0]; i++) {
        const int at[3] = {lower[0] + i, lower[1] + j, lower[2] + k};
        if (keep(at)) body_add(&b, at[0], at[1], at[2]);
      }
  return b;
}

/* Solid around a lattice of round pores: porosity 0.56. */
static inline bool porous(const int at[3])
{
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    const double x = (at[k] % 12 + 12) % 12 - 5.5;
    r2 += x * x;
  }
  return r2 > 6.2 * 6.2;
}

static inline bool full(const int at[3])
{
  (void)at;
  return true;
}

/* n sites scattered over a box, every one once. */
static inline body body_scattered(size_t n, int reach)
{
  body b = body_of(n);
  const int32_t lower[3] = {-reach, -reach, -reach}, upper[3] = {reach, reach, reach};
  bw_particles_map map = {0};
  bw_check_ok(bw_particles_map_create(n, lower, upper, &map));
  for (uint64_t key = 0; b.n < n; key += 3) {
    int32_t s[3], found;
    for (size_t k = 0; k < 3; k++)
      s[k] = (int32_t)floor(fraction_of(key + k) * (2 * reach + 1)) - reach;
    bw_check_ok(bw_particles_map_put(&map, s, (int32_t)b.n, &found));
    if (found < 0) body_add(&b, s[0], s[1], s[2]);
  }
  bw_particles_map_destroy(&map);
  return b;
}
