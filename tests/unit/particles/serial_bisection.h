/* serial_bisection.h -- recursive coordinate bisection as it is done with a list of all sites: sort
 * along the longest axis, cut by rows, recurse. The oracle for the division without such a list. */
#pragma once
#include "bw_check.h"

typedef struct {
  uint64_t key;
  int32_t row;
} serial_item;

static inline int serial_compare(const void *a, const void *b)
{
  const uint64_t x = ((const serial_item *)a)->key, y = ((const serial_item *)b)->key;
  return (x > y) - (x < y);
}

static inline void serial_sort(const int axis[3], size_t n, const int32_t site[],
                               const int32_t lower[3], serial_item item[])
{
  for (size_t q = 0; q < n; q++) {
    const int32_t *s = site + 3 * (size_t)item[q].row;
    item[q].key = 0;
    for (int k = 2; k >= 0; k--)
      item[q].key = item[q].key << 21 | (uint64_t)((int64_t)s[axis[k]] - lower[axis[k]]);
  }
  qsort(item, n, sizeof *item, serial_compare);
}

static inline int serial_longest(size_t n, const int32_t site[], const serial_item item[])
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

/* part[row] of the rows of item[n]: one of first .. first + parts - 1. */
static inline void serial_bisect(int first, int parts, size_t n, const int32_t site[],
                                 const int32_t lower[3], serial_item item[], int32_t part[])
{
  static const int cut_axes[3][3] = {{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};
  if (parts == 1 || n == 0) {
    for (size_t q = 0; q < n; q++)
      part[item[q].row] = first;
    return;
  }
  const int left = parts / 2;
  const size_t cut = n * (size_t)left / (size_t)parts;
  serial_sort(cut_axes[serial_longest(n, site, item)], n, site, lower, item);
  serial_bisect(first, left, cut, site, lower, item, part);
  serial_bisect(first + left, parts - left, n - cut, site, lower, item + cut, part);
}
