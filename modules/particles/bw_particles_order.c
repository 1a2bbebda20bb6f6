/* Rows of sites sorted by a key that has the fastest axis last. */
#include "bw_particles_order.h"
#include "bw_memory.h"
#include "particles_key.h"

#include <stdlib.h>

typedef struct {
  uint64_t key;
  int32_t row;
} keyed;

static int compare(const void *a, const void *b)
{
  const uint64_t x = ((const keyed *)a)->key, y = ((const keyed *)b)->key;
  return (x > y) - (x < y);
}

void bw_particles_extent(size_t n, const int32_t site[], int32_t lower[3], int32_t upper[3])
{
  for (size_t k = 0; k < 3; k++) {
    lower[k] = n > 0 ? INT32_MAX : 0;
    upper[k] = n > 0 ? INT32_MIN : 0;
    for (size_t q = 0; q < n; q++) {
      const int32_t x = site[3 * q + k];
      lower[k] = x < lower[k] ? x : lower[k];
      upper[k] = x > upper[k] ? x : upper[k];
    }
  }
}

static bw_status check(size_t n, const int32_t lower[3], const int32_t upper[3])
{
  BW_REQUIRE(n <= INT32_MAX, BW_EINPUT,
             "particles: one rank has %zu of them; below 2^31 can be numbered: take more ranks", n);
  for (int k = 0; k < 3; k++)
    BW_REQUIRE((int64_t)upper[k] - lower[k] <= BW_PARTICLES_MOST, BW_EINPUT,
               "particles: sites reach from %d to %d in direction %d; the limit is 2^21 steps",
               lower[k], upper[k], k);
  return BW_OK;
}

bw_status bw_particles_lattice_order(const int axis[3], size_t n, const int32_t site[],
                                     int32_t order[])
{
  keyed *item = NULL;
  int32_t lower[3], upper[3];
  bw_particles_extent(n, site, lower, upper);
  BW_TRY(check(n, lower, upper));
  BW_TRY(BW_ALLOCATE(&item, n));
  bool sorted = true;
  for (size_t q = 0; q < n; q++) {
    int64_t above[3];
    for (size_t k = 0; k < 3; k++)
      above[k] = (int64_t)site[3 * q + k] - lower[k];
    item[q] = (keyed){bw_particles__key(axis, above), (int32_t)q};
    sorted = sorted && (q == 0 || item[q - 1].key <= item[q].key);
  }
  /* Sites often come in order already: a look costs less than sorting what is sorted. */
  if (!sorted) qsort(item, n, sizeof *item, compare);
  for (size_t q = 0; q < n; q++)
    order[q] = item[q].row;
  bw_release(&item);
  return BW_OK;
}
