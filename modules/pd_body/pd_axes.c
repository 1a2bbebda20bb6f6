/* Which axis of the lattice is numbered fastest. */
#include "pd_body.h"

#include <math.h>
#include <string.h>

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
