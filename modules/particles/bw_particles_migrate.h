/* bw_particles_migrate.h -- moving points belong to the rank that owns the place where they are.
 *
 * Space is divided into cells of a given edge, and the cells are divided among the ranks by
 * recursive bisection with equal numbers of points (bw_particles_partition.h). Every place has an
 * owner, also where no point was. Points keep moving while the division stands; when the numbers
 * per rank have become too unequal, a new division is made and the points migrate once more.
 * Positions are (n,3) [L], of any value; what is not a number goes to the outermost cell.
 * Life     create -> { owner, near, migrate }* -> destroy.
 * Limits   cells are told apart up to 2^20 from `lower` in each direction; beyond that, the
 *          outermost one goes on for ever. */
#pragma once
#include "bw_comm.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_particles_space bw_particles_space;

/* How space is cut into cells. */
typedef struct {
  double lower[3];  /* a corner of a cell, somewhere among the points [L]      default 0 */
  double edge;      /* least edge of a cell [L], above 0                       required */
  double period[3]; /* positions that differ by it are the same place [L]      default 0: none */
} bw_particles_space_config;

/* The defaults; edge is still to be set. Local. */
bw_particles_space_config bw_particles_space_config_default(void);

/* Divide space by the points x (n,3) that the ranks have at present, in any division; the
 * configuration is the same on all ranks. A rank's part is whole cells, so that counts are equal
 * but for the points of a few cells. `comm` is borrowed until destroy; x is read during the call
 * only. *out is owned by the caller, NULL after a failure. BW_EINPUT for an edge or a period that
 * is not finite or has the wrong sign, BW_EMEM; the same on all ranks. Collective. */
bw_status bw_particles_space_create(const bw_comm *comm, const bw_particles_space_config *config,
                                    size_t n, const double x[],
                                    bw_particles_space **out) BW_MUST_CHECK;

void bw_particles_space_destroy(bw_particles_space **space); /* NULL is fine. Local. */

/* The rank, 0 .. size-1, that owns the position x. Local. */
int bw_particles_space_owner(const bw_particles_space *space, const double x[3]);

/* Own points that other ranks may need: whatever is within `reach` [L] of a place that another rank
 * owns, so that every rank gets all points within reach of its own. own[rows], destination[rows]:
 * point and rank, a point as often as there are ranks that it is near; allocated, owned by the
 * caller (bw_release), as bw_particles_copies_offer takes them. Points of x (n,3) are those of this
 * rank, migrated. BW_EINPUT unless 0 < reach <= 4 edges and n < 2^31, BW_EMEM. Local. */
bw_status bw_particles_space_near(const bw_particles_space *space, size_t n, const double x[],
                                  double reach, size_t *rows, int32_t **own,
                                  int **destination) BW_MUST_CHECK;

/* Each point goes to the owner of its position, with its row of `bytes` bytes (0: no rows, which
 * may then be NULL). *x_out (n_out,3) and *rows_out (n_out) are allocated and owned by the caller
 * (bw_release), ordered by the rank that points come from and within it as before: order them by an
 * identity where that matters. Positions are not changed, nor wrapped into a period. BW_EMEM, the
 * same on all ranks. Collective. */
bw_status bw_particles_migrate(const bw_particles_space *space, size_t n, const double x[],
                               size_t bytes, const void *rows, size_t *n_out, double **x_out,
                               void **rows_out) BW_MUST_CHECK;

/* A number that depends on all ranks' rows of `bytes` bytes, each as often as it is there, but not
 * on their order nor on who has which: the same before and after a migration. Collective. */
uint64_t bw_particles_checksum(const bw_comm *comm, size_t n, size_t bytes, const void *rows);

#ifdef __cplusplus
}
#endif
