/* bw_particles_order.h -- the order of a lattice, one axis fastest, and boxes of sites.
 *
 * Sites are lattice coordinates (i, j, k) in steps, arrays of them (n,3). All functions are local
 * and pure. */
#pragma once
#include "bw_status.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* order[n] <- rows of site[] such that axis[0] varies fastest, then axis[1], then axis[2] (axis: a
 * permutation of 0, 1, 2). Rows of one site may come in either order. BW_EINPUT for 2^31 rows or
 * more, and when the sites reach over more than 2^21 steps in a direction; BW_EMEM. */
bw_status bw_particles_lattice_order(const int axis[3], size_t n, const int32_t site[],
                                     int32_t order[]) BW_MUST_CHECK;

/* The least and the largest coordinate in each direction; 0 and 0 when n is 0. */
void bw_particles_extent(size_t n, const int32_t site[], int32_t lower[3], int32_t upper[3]);

#ifdef __cplusplus
}
#endif
