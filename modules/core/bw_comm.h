/* bw_comm.h -- the group of ranks that works on one problem, and what they say together.
 *
 * Wraps one MPI communicator, so that only core and grid call MPI. An MPI failure ends the run
 * (MPI's own handler); everything else that may fail returns a bw_status.
 * "Collective" means: every rank of the communicator calls it, in the same order. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

BW_BEGIN_DECLS

/* A group of ranks; its messages never meet those of another group. */
typedef struct bw_comm bw_comm;

/* Start MPI and make *world of all ranks; it is freed by bw_finish. BW_EMEM. Collective. */
bw_status bw_init(int *argc, char ***argv, bw_comm **world) BW_MUST_CHECK;

/* The end of main: ranks agree on the worst status, the failing rank of lowest number prints
 * its message on stderr, *world is freed, MPI ends. Returns the exit code. Collective. */
int bw_finish(bw_comm **world, bw_status mine);

/* End the run of all ranks now, with this exit code and without any clean-up. For programs that
 * test: a rank that found a fault cannot tell the others, which may be waiting for it in a
 * collective call. Everything else returns a status and lets ranks agree. Local; does not
 * return. */
void bw_comm_abort(const bw_comm *comm, int code) __attribute__((noreturn));

/* *out = a group of this rank alone (for serial programs and tests inside a parallel run),
 * destroyed by the caller. BW_EMEM. Local. */
bw_status bw_comm_self(bw_comm **out) BW_MUST_CHECK;

/* The same ranks as a group of its own, whose messages do not meet those of `comm`. What is longer
 * than `limit` bytes (1 .. INT_MAX; 0: as `comm`) travels in several MPI messages: a small limit
 * lets a test see that, the default of 1 GiB is below what an MPI count can say. Results do not
 * depend on it, but for the order in which sums add. Destroyed by the caller. On failure *out is
 * NULL. Collective. */
bw_status bw_comm_copy(const bw_comm *comm, size_t limit, bw_comm **out) BW_MUST_CHECK;

/* Free *comm and set it to NULL; NULL inside is fine. The world is freed by bw_finish.
 * Collective. */
void bw_comm_destroy(bw_comm **comm);

int bw_comm_rank(const bw_comm *comm);             /* 0 .. size-1. Local. */
int bw_comm_size(const bw_comm *comm);             /* Local. */
size_t bw_comm_message_limit(const bw_comm *comm); /* [bytes] of one MPI message. Local. */

/* All ranks return the largest of the codes given; the message of the lowest rank that failed
 * replaces the others'. Call before branching on a result that may differ. Collective. */
bw_status bw_comm_agree(const bw_comm *comm, bw_status mine) BW_MUST_CHECK;

/* Element-wise over ranks, in place, result on all ranks; any n, the same on all. Collective. */
void bw_comm_sum(const bw_comm *comm, size_t n, double x[]);
void bw_comm_max(const bw_comm *comm, size_t n, double x[]);
void bw_comm_min(const bw_comm *comm, size_t n, double x[]);
void bw_comm_sum_int(const bw_comm *comm, size_t n, int64_t x[]);
void bw_comm_max_int(const bw_comm *comm, size_t n, int64_t x[]);
void bw_comm_xor(const bw_comm *comm, size_t n, uint64_t x[]);
void bw_comm_or(const bw_comm *comm, size_t n, uint64_t x[]);

/* Sum of x over the ranks below this one (0 on rank 0). Collective. */
int64_t bw_comm_prefix_sum(const bw_comm *comm, int64_t x);

/* Rank 0's bytes on all ranks; any number, the same on all ranks. Collective. */
void bw_comm_broadcast(const bw_comm *comm, size_t bytes, void *data);

/* Bytes of every rank, in rank order, on rank 0 (gather) or on all (allgather). *out is allocated
 * and owned by the caller (bw_release); NULL on ranks that receive nothing. *total counts its
 * bytes; any number, each rank its own. BW_EMEM on all ranks where they do not fit into the memory
 * of one. Collective. */
bw_status bw_comm_gather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                         void **out) BW_MUST_CHECK;
bw_status bw_comm_allgather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                            void **out) BW_MUST_CHECK;

/* No rank goes on before all have come here. Collective. */
void bw_comm_barrier(const bw_comm *comm);

/* Wall time [s] from an arbitrary origin, this rank's own. Local. */
double bw_wall_time(void);

BW_END_DECLS
