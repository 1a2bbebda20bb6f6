/* pd_jump.h -- particles near a jump between levels, for laws that have factors there. */
#pragma once
#include "pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* near (storage, 0 at first) of the own particles with a bond across a jump; or, before given, to
 * one that is marked in it: 1. Local. */
void bw_pd_body_mark_near(const bw_pd_body *pd, const bw_real before[], bw_real near[]);
/* near of all places with a bond across a jump, also of copies. Collective. */
void bw_pd_body_near_jumps(const bw_pd_body *pd, bw_real near[]);
/* A row of factors (block.exact, bonds.n_exact) for the slots of every block that has a particle
 * near a jump. BW_EINPUT: too many. Local. */
bw_status bw_pd_body_jump_room(bw_pd_body *pd, const bw_real near[]) BW_MUST_CHECK;
/* cut (storage): 1 where cells of the own lattice's family are missing; or, of one near a jump with
 * bonds to coarser particles, where half of these by weight miss some, as it is as near to a face
 * as they. BW_EMEM. Collective. */
bw_status bw_pd_body_cut_families(const bw_pd_body *pd, bw_real cut[]) BW_MUST_CHECK;

/* Cracks live on the finest level alone: then no broken bond ever lies between levels, where what a
 * crack costs depends on how it runs. Whether a bond is none of these; those that are beyond their
 * limit, lanes `over`, end the run. Local. */
bool bw_pd_body_above_finest(const bw_pd_body *pd, const bw_pd_block *block,
                             const bw_pd_slot *slot);
void bw_pd_body_note_astray(bw_pd_body *pd, const bw_pd_block *block, uint8_t over);

/* Vectors of (rows, columns), divided over ranks. */
typedef struct {
  const bw_comm *comm;
  size_t rows; /* of this rank */
  int columns;
  int64_t all; /* rows of all ranks */
} bw_pd_body_rows_of;

/* Sum of x.y over all rows of all ranks, to the same bits however they are divided: terms as whole
 * numbers of 2^-k of the largest one, and what that leaves once more. Collective. */
double bw_pd_body_dot(const bw_pd_body_rows_of *z, const double x[], const double y[]);

#ifdef __cplusplus
}
#endif
