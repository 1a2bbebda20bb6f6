/* pd_bond_levels.h -- the factors of bonds near a jump between levels: what is solved for. */
#pragma once
#include "pd_bond.h"
#include "pd_jump.h"
#include "pd_sweep.h"

/* The particles near a jump and their conditions. A row is one of these particles of this rank. */
typedef struct {
  bw_pd_body *pd;
  int cubics;                       /* monomials of degree 3 */
  bw_real *cubic[BW_PD_FINEST + 1]; /* (directions, cubics) of every direction of a level */
  bw_real *pull[BW_PD_FINEST + 1];  /* (directions) c fraction dV_l over those of level 0 */
  size_t rows;                      /* particles */
  int64_t all;                      /* of all ranks */
  int32_t *particle;                /* (rows) own particles */
  int32_t *row;                     /* (n) of an own particle; -1: none */
  double *white;                    /* (rows, cubics, cubics) conditions made orthonormal */
  bw_real *near;                    /* storage: 1 near a jump */
  bw_real *cut;                     /* storage: 1 where cells of the family are missing */
  uint8_t *free;                    /* (n_exact) lanes of a slot whose factor may change */
  bw_real *mu[BW_PD_BOND_CUBICS];   /* storage: multipliers of the monomials */
} bw_pd_bond_zone;

/* pd_bond_zone.c: fills all of it but for white and mu's values, and blocks' exact, bonds.exact
 * with the factors that the surface gave. Rows are those near a change, where one is given (NULL:
 * all). Collective. */
bw_status bw_pd_bond__zone(bw_pd_body *pd, const bw_pd_bond_change *change,
                           bw_pd_bond_zone *z) BW_MUST_CHECK;
/* bonds.exact are the factors that the surface gave, again. Local. */
void bw_pd_bond__zone_begin(bw_pd_bond_zone *z);
int bw_pd_bond__cubics(int dimension); /* how many monomials */
/* white, for the bonds that are free now. BW_EMEM. Local. */
bw_status bw_pd_bond__conditions(bw_pd_bond_zone *z) BW_MUST_CHECK;
void bw_pd_bond__zone_release(bw_pd_bond_zone *z);
