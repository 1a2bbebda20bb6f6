/* pd_bond_tensor.h -- the correction `tensor`: its conditions, and what is solved for. */
#pragma once
#include "pd_bond.h"

typedef struct {
  int n;                                /* conditions K */
  bw_real *phi;                         /* (directions, K) */
  double target[BW_PD_BOND_CONDITIONS]; /* T */
  double full[BW_PD_BOND_CONDITIONS];   /* lambda of a full family */
  bool *held;                           /* (n) particles that keep those */
  bw_real *at[BW_PD_BOND_CONDITIONS];   /* storage: lambda with momentum */
  bw_real *last[BW_PD_BOND_CONDITIONS]; /* own: lambda of the sweep before */
  bw_real *next[BW_PD_BOND_CONDITIONS]; /* own: of this one */
} bw_pd_bond_solver;

/* pd_bond_basis.c: n, phi, target and full of the level's own directions, which have factors 1 +
 * full.phi in a full family: state.bulk. BW_EMEM. Local. */
bw_status bw_pd_bond__basis(bw_pd_body *pd, bw_pd_bond_solver *v) BW_MUST_CHECK;
