/* Compact blocks of equal counts by recursive coordinate bisection; lattice order. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  uint64_t key;
  int32_t row;
} keyed;

static int compare(const void *a, const void *b)
{
  const uint64_t x = ((const keyed *)a)->key, y = ((const keyed *)b)->key;
  return (x > y) - (x < y);
}

/* Sort rows by site, axis[0] fastest. */
static void sort_along(const int axis[3], size_t n, const int32_t site[], const int32_t lower[3],
                       keyed item[])
{
  bool sorted = true;
  for (size_t q = 0; q < n; q++) {
    const int32_t *s = site + 3 * (size_t)item[q].row;
    item[q].key = 0;
    for (int k = 2; k >= 0; k--)
      item[q].key = item[q].key << 21 | (uint64_t)((int64_t)s[axis[k]] - lower[axis[k]]);
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
  /* The longest axis slowest: a cut through a plane of equal coordinates is clean in the next. */
  static const int cut_axes[3][3] = {{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};
  const int left = parts / 2;
  const size_t cut = n * (size_t)left / (size_t)parts;
  sort_along(cut_axes[longest_axis(n, site, item)], n, site, lower, item);
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

bw_status bw_pd_body_partition(int parts, size_t n, const int32_t site[], int32_t part[])
{
  keyed *item = NULL;
  int32_t lower[3];
  BW_TRY(items(n, &item));
  lower_corner(n, site, lower);
  bisect(0, parts, n, site, lower, item, part);
  bw_release(&item);
  return BW_OK;
}

/* What a sweep costs with this order of axes, up to a factor: blocks lie along axis[0], and are
 * partly empty at its end; planes of axis[0] and axis[1] within reach of a block are read from
 * the cache as long as they fit. */
static double cost_of_order(const int axis[3], const int64_t size[3], int reach)
{
  static const double CACHE = 786432, MISSED = 1.5; /* bytes: of a core's 1 MiB; measured factor */
  const double fast = (double)size[axis[0]], middle = (double)size[axis[1]];
  const double filled = fast / (ceil(fast / BW_PD_LANES) * BW_PD_LANES);
  const double planes = 4.0 * sizeof(bw_real) * fast * middle * (2 * reach + 1); /* u and w */
  return (planes > CACHE ? MISSED : 1.0) / filled;
}

void bw_pd_body_axes(const int64_t size[3], int reach, int axis[3])
{
  static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const int *best = orders[0];
  for (int q = 1; q < 6; q++)
    if (cost_of_order(orders[q], size, reach) < cost_of_order(best, size, reach)) best = orders[q];
  memcpy(axis, best, 3 * sizeof *axis);
}

/* order[n]: rows of site, axis[0] fastest. */
bw_status bw_pd_body_lattice_order(const int axis[3], size_t n, const int32_t site[],
                                   int32_t order[])
{
  keyed *item = NULL;
  int32_t lower[3];
  BW_TRY(items(n, &item));
  lower_corner(n, site, lower);
  sort_along(axis, n, site, lower, item);
  for (size_t q = 0; q < n; q++)
    order[q] = item[q].row;
  bw_release(&item);
  return BW_OK;
}
