/* particles_key.h -- a lattice site as one number of 63 bits, and cuts found by counting such keys.
 *
 * Functions of numbers alone: what counts particles here never looks at one, so that it can be
 * tested with more of them than a machine holds. Shared by the sources of particles only. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Bits per direction, and the largest coordinate above the lower corner. */
enum { BW_PARTICLES_BITS = 21, BW_PARTICLES_MOST = (1 << BW_PARTICLES_BITS) - 1 };

/* Keys rise with axis[2] first, then axis[1], then axis[0]: axis[0] is fastest. above: site less
 * the lower corner, 0 .. BW_PARTICLES_MOST. */
static inline uint64_t bw_particles__key(const int axis[3], const int64_t above[3])
{
  uint64_t key = 0;
  for (int k = 2; k >= 0; k--)
    key = key << BW_PARTICLES_BITS | (uint64_t)above[axis[k]];
  return key;
}

static inline void bw_particles__unkey(const int axis[3], uint64_t key, int64_t above[3])
{
  for (int k = 0; k < 3; k++, key >>= BW_PARTICLES_BITS)
    above[axis[k]] = (int64_t)(key & BW_PARTICLES_MOST);
}

/* How many of n particles lie below the cut that leaves `left` of `parts` ranks there:
 * floor(n left/parts), without the product n left. */
int64_t bw_particles__cut_index(int64_t n, int left, int parts);

/* A search for the key that has `cut` others below it. Throughout, the numbers of keys below `low`
 * and below `high` are at most `cut` and more than `cut`. */
typedef struct {
  int64_t cut;
  uint64_t low, high;
  int64_t below; /* keys below `low` */
} bw_particles__selection;

/* All keys lie in least .. most, and there are more than `cut`. */
bw_particles__selection bw_particles__select(int64_t cut, uint64_t least, uint64_t most);
/* Is `low` the key that is looked for? */
bool bw_particles__selected(const bw_particles__selection *s);
/* The key below which the keys are to be counted next. */
uint64_t bw_particles__pivot(const bw_particles__selection *s);
/* Go on in the half that holds the key, as so many of all keys are below the pivot. Returns whether
 * it is the upper half. */
bool bw_particles__narrow(bw_particles__selection *s, int64_t below_pivot);
