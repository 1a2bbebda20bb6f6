/* bw_particles_map.h -- lattice site -> number of the particle there.
 *
 * A table over the box of the sites where that wastes little, hashing with linear probing where the
 * box is mostly empty. Sites are lattice coordinates (i, j, k) in steps; numbers are >= 0.
 * Life     create (or create_own) -> { put, get, replace }* -> destroy. All functions are local.
 * Limits   a box of at most 2^21 sites in each direction; numbers below 2^31. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* To be read by nobody but the functions below; it is open so that it can lie inside another
 * struct. All bytes 0: an empty map that may be destroyed and nothing else. */
typedef struct {
  bool dense;       /* a table over the box, not hashed */
  int64_t lower[3]; /* lower corner of the box, in steps */
  int64_t size[3];  /* sites of the box in each direction */
  int32_t *value;   /* (capacity) number; -1: none */
  uint64_t *key;    /* (capacity) 21 bits per direction; NULL for a dense map */
  size_t capacity;  /* sites of the box, or places for hashing (a power of two) */
  size_t used;      /* sites that have a number */
} bw_particles_map;

/* Make *map an empty map for about `n` sites with lower[k] <= site[k] <= upper[k]. More than n may
 * be put. *map owns memory afterwards, also after a failure: destroy it. BW_EMEM. */
bw_status bw_particles_map_create(size_t n, const int32_t lower[3], const int32_t upper[3],
                                  bw_particles_map *map) BW_MUST_CHECK;

/* The map of n particles by their sites: that at site[3 q] gets the number q. The box of the map is
 * that of the sites and `margin` more steps on each side. BW_EINPUT when two are on one site (it
 * names the site and both numbers), when there are 2^31 or more, or when the box has more than 2^21
 * sites in a direction; BW_EMEM. *map is to be destroyed also after a failure. */
bw_status bw_particles_map_create_own(size_t n, const int32_t site[], int32_t margin,
                                      bw_particles_map *map) BW_MUST_CHECK;

/* Release the memory of *map and empty it. */
void bw_particles_map_destroy(bw_particles_map *map);

/* The number at a site; -1: none there, or outside the box. */
int32_t bw_particles_map_get(const bw_particles_map *map, const int32_t site[3]);

/* Give a site of the box the number `value` if it has none. *found: the number that was there (it
 * stays), or -1 (then value is stored). BW_EMEM when a hashed map cannot grow. */
bw_status bw_particles_map_put(bw_particles_map *map, const int32_t site[3], int32_t value,
                               int32_t *found) BW_MUST_CHECK;

/* Another number for a site that has one. */
void bw_particles_map_replace(bw_particles_map *map, const int32_t site[3], int32_t value);

#ifdef __cplusplus
}
#endif
