/* bw_particles_partition.h -- compact parts of equal counts by recursive coordinate bisection.
 *
 * The particles of `parts` ranks are divided by a cut across the longest axis of the box of their
 * sites, n floor(parts/2)/parts of them below it, and each side is divided likewise (Berger &
 * Bokhari, IEEE Trans. Computers C-36 (1987) 570). Sites are ordered by the longest axis first, so
 * that a cut through a plane of equal coordinates is a clean cut along the next axis; at most one
 * line of a plane is broken.
 *
 * No rank holds a list of all sites. Each passes those that it happens to know; a cut is found by
 * bisection of the 63-bit key of a site with counts that are summed over the ranks, for all groups
 * of one depth of the tree at once: at most 63 sums of 64-bit integers per depth, log2(ranks)
 * depths. What remains on every rank is the tree of at most size - 1 cuts, which tells the owner of
 * any site, occupied or not. It depends on the set of sites alone, not on who passed which.
 *
 * Life     create -> { owner, count, total }* -> destroy.
 * Limits   sites within 2^21 steps of each other in every direction; counts to 2^62. */
#pragma once
#include "bw_comm.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_particles_partition bw_particles_partition;

/* Divide the sites of all ranks among the ranks of `comm`. site (n,3), lattice coordinates in
 * steps; every rank passes some, none is fine, each particle is passed by one rank. Several
 * particles on one site stay together (counts are then equal but for what that needs); whether it
 * is allowed, bw_particles_map_create_own tells once every rank has its own. The arrays are read
 * during the call only; takes 8 n bytes while it runs. *out is owned by the caller, NULL after a
 * failure. BW_EINPUT beyond the limit of 2^21 steps, BW_EMEM; the same on all ranks. Collective. */
bw_status bw_particles_partition_create(const bw_comm *comm, size_t n, const int32_t site[],
                                        bw_particles_partition **out) BW_MUST_CHECK;

void bw_particles_partition_destroy(bw_particles_partition **partition); /* NULL is fine. Local. */

/* The rank, 0 .. size-1, that owns a site. A site where no particle was belongs to whoever would
 * own a particle there; beyond the box of the sites, to the owner of that side. Local. */
int bw_particles_partition_owner(const bw_particles_partition *partition, const int32_t site[3]);

/* Particles that `rank` owns of those that create was given on all ranks. Local. */
int64_t bw_particles_partition_count(const bw_particles_partition *partition, int rank);

/* Particles that create was given on all ranks. Local. */
int64_t bw_particles_partition_total(const bw_particles_partition *partition);

#ifdef __cplusplus
}
#endif
