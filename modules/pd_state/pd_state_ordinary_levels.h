/* pd_state_ordinary_levels.h -- weights of an ordinary law near jumps between levels: what is
 * solved for. */
#pragma once
#include "pd_jump.h"
#include "pd_state_ordinary.h"

enum {
  BW_PD_SQUARES = 6, /* monomials of degree 2 of a direction, at most */
  BW_PD_CUBES = 10,  /* of degree 3 */
  BW_PD_WANTS = BW_PD_SQUARES + BW_PD_CUBES
};

/* w Gamma dV of the bonds of a direction: in the owner's family, and that of its partner's family
 * for the partner's volume [as w L^3]. */
typedef struct {
  double own, reverse;
} bw_pd_ordinary_pair;

/* Plain weights of all directions of all levels, (finest + 1) arrays of (directions). */
typedef struct {
  bw_pd_ordinary_pair *of[BW_PD_FINEST + 1];
} bw_pd_ordinary_plain;

/* BW_EMEM; the second releases it. Local. */
bw_status bw_pd_state__plain(const bw_pd_body *pd, bw_pd_ordinary_plain *out) BW_MUST_CHECK;
void bw_pd_state__plain_release(bw_pd_ordinary_plain *plain);
