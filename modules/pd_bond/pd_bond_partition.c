/* Compact blocks of equal counts by recursive coordinate bisection; lattice order. */
#include "bw_memory.h"
#include "pd_bond_internal.h"

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

/* Sort rows by site with `axis` most significant and the next two (cyclic) after it: a cut through
 * a plane of equal coordinates is then clean in the next direction. */
static void sort_along(int axis, size_t n, const int32_t site[], const int32_t lower[3],
                       keyed item[])
{
  const int second = axis == 2 ? 1 : 2, third = 3 - axis - second;
  bool sorted = true;
  for (size_t q = 0; q < n; q++) {
    const int32_t *s = site + 3 * (size_t)item[q].row;
    item[q].key = (uint64_t)((int64_t)s[axis] - lower[axis]) << 42 |
                  (uint64_t)((int64_t)s[second] - lower[second]) << 21 |
                  (uint64_t)((int64_t)s[third] - lower[third]);
    sorted = sorted && (q == 0 || item[q - 1].key <= item[q].key);
  }
  if (!sorted) qsort(item, n, sizeof *item, compare);
}

static int longest_axis(size_t n, const int32_t site[], const keyed item[])
{
  int axis = 0;
  int64_t longest = -1;
  for (int k = 0; k < 3; k++) {
    int32_t low = INT32_MAX, high = INT32_MIN;
    for (size_t q = 0; q < n; q++) {
      const int32_t x = site[3 * (size_t)item[q].row + (size_t)k];
      low = x < low ? x : low;
      high = x > high ? x : high;
    }
    if ((int64_t)high - low > longest) longest = (int64_t)high - low, axis = k;
  }
  return axis;
}

static void bisect(int first, int parts, size_t n, const int32_t site[], const int32_t lower[3],
                   keyed item[], int32_t part[])
{
  if (parts == 1 || n == 0) {
    for (size_t q = 0; q < n; q++)
      part[item[q].row] = first;
    return;
  }
  const int left = parts / 2;
  const size_t cut = n * (size_t)left / (size_t)parts;
  sort_along(longest_axis(n, site, item), n, site, lower, item);
  bisect(first, left, cut, site, lower, item, part);
  bisect(first + left, parts - left, n - cut, site, lower, item + cut, part);
}

static void lower_corner(size_t n, const int32_t site[], int32_t lower[3])
{
  for (int k = 0; k < 3; k++) {
    lower[k] = INT32_MAX;
    for (size_t q = 0; q < n; q++)
      if (site[3 * q + (size_t)k] < lower[k]) lower[k] = site[3 * q + (size_t)k];
  }
}

static bw_status items(size_t n, keyed **item)
{
  BW_TRY(BW_ALLOCATE(item, n));
  for (size_t q = 0; q < n; q++)
    (*item)[q].row = (int32_t)q;
  return BW_OK;
}

bw_status bw_pd_bond__partition(int parts, size_t n, const int32_t site[], int32_t part[])
{
  keyed *item = NULL;
  int32_t lower[3];
  BW_TRY(items(n, &item));
  lower_corner(n, site, lower);
  bisect(0, parts, n, site, lower, item, part);
  bw_release(&item);
  return BW_OK;
}

/* order[n]: rows of site, z slowest, x fastest. */
bw_status bw_pd_bond__lattice_order(size_t n, const int32_t site[], int32_t order[])
{
  keyed *item = NULL;
  int32_t lower[3];
  BW_TRY(items(n, &item));
  lower_corner(n, site, lower);
  sort_along(2, n, site, lower, item);
  for (size_t q = 0; q < n; q++)
    order[q] = item[q].row;
  bw_release(&item);
  return BW_OK;
}
