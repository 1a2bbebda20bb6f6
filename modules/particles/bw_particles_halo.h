/* bw_particles_halo.h -- which places around own particles are occupied by somebody else.
 *
 * On a lattice a particle interacts with those at its site plus a list of offsets. Places that no
 * own particle occupies are looked up with the rank that would own them, so that no rank needs a
 * list of all. Across a period the particle at a place may be an own one: its image counts too.
 * The list is what bw_particles_copies_create asks for: owner, and home as key.
 * Life     create -> reading -> destroy. */
#pragma once
#include "bw_particles_map.h"
#include "bw_particles_partition.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The lattice as all ranks see it; arrays are borrowed during the call. */
typedef struct {
  const bw_particles_partition *partition; /* tells who owns a site */
  int32_t lower[3];                        /* periodic: sites are lower .. lower + period - 1 */
  int32_t period[3];                       /* in steps; 0: not periodic */
  int n_offset;                            /* rows of offset; with offsets_of the most of any */
  const int32_t *offset; /* (n_offset,3) steps from a particle to those that it interacts with */
  /* NULL: these, of every particle. Else those of particle i are written to offset (n_offset,3)
   * by this; returns how many. */
  int (*offsets_of)(const void *context, size_t i, int32_t offset[]);
  const void *context; /* passed to it */
} bw_particles_lattice;

/* All bytes 0: none, may be destroyed. */
typedef struct {
  size_t n;       /* places */
  int32_t *place; /* (n,3) site, shifted by periods to where it is met */
  int32_t *home;  /* (n,3) the site where its owner has it */
  int *owner;     /* (n) rank, may be this one */
} bw_particles_halo;

/* Every place at an offset from a particle of site (n,3), in the order in which they are met, once
 * each, where there is a particle and not an own one. near: own sites -> 0 .. n-1, as
 * bw_particles_map_create_own makes it with a margin of the largest component of an offset; the
 * places found are added to it, numbered from n on in their order. *halo owns memory afterwards,
 * also after a failure: destroy it. BW_EMEM, and BW_EINPUT for more than 2^31 numbers; the same on
 * all ranks. Collective. */
bw_status bw_particles_halo_create(const bw_comm *comm, const bw_particles_lattice *lattice,
                                   size_t n, const int32_t site[], bw_particles_map *near,
                                   bw_particles_halo *halo) BW_MUST_CHECK;

void bw_particles_halo_destroy(bw_particles_halo *halo); /* Local. */

#ifdef __cplusplus
}
#endif
