/* bw_solid_failure.h -- where and when would it break: gauges of failure, before anything does.
 *
 * Each gauge says at every particle how much of what the material bears the present state uses:
 * 1 is failure, and at small strain the number goes with the load, so that 1/number is the factor
 * by which the load has to grow until this place fails.
 *   stretch          largest stretch of a particle's bonds over the one that breaks them
 *   the stress's     Rankine, energy, von Mises, Mohr-Coulomb, Drucker-Prager of the Cauchy stress
 *                    (bw_solid_stress.h), as bw_pd_material_criterion.h has them
 *   Griffith         sqrt(G/G0), G the energy per area that a crack would release which is not
 *                    there: the bonds that cross it are taken away, the body comes to rest anew
 * Source: Griffith, Phil. Trans. R. Soc. A 221 (1921) 163. Which gauge tells where a porous medium
 * breaks is POROUS's open question. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Columns of a row of gauges. */
typedef enum {
  BW_SOLID_FAILURE_RANKINE, /* the stress's in the order of bw_pd_material_criterion_kind */
  BW_SOLID_FAILURE_ENERGY,
  BW_SOLID_FAILURE_MISES,
  BW_SOLID_FAILURE_MOHR_COULOMB,
  BW_SOLID_FAILURE_CONE, /* Drucker-Prager */
  BW_SOLID_FAILURE_STRETCH,
  BW_SOLID_FAILURE_GRIFFITH,
  BW_SOLID_FAILURE_GAUGES
} bw_solid_failure_gauge;

/* Their words, in that order: rankine, energy, ... */
extern const char *const bw_solid_failure_name[BW_SOLID_FAILURE_GAUGES];

/* What a material bears. A gauge whose number is NaN is not asked for, and NaN. */
typedef struct {
  double tension;  /* of rankine and energy: strength in tension [M/(L T^2)] */
  double yield;    /* of mises [M/(L T^2)] */
  double cohesion; /* of Mohr-Coulomb and Drucker-Prager [M/(L T^2)] */
  double friction; /* of the same: angle [rad] */
  double stretch;  /* of a bond [-] */
  double G0;       /* of griffith [M/T^2] */
  double flaw;     /* length of its crack [L] */
} bw_solid_strength;

/* All NaN; stretch and G0 as the body has them. Local. */
bw_solid_strength bw_solid_strength_of(const bw_solid *solid);

/* used (n, BW_SOLID_FAILURE_GAUGES) of the present state; the column of griffith stays as it is.
 * BW_EINPUT for a number that is not positive. Collective. */
bw_status bw_solid_failure_compute(bw_solid *solid, const bw_solid_strength *strength,
                                   double used[]) BW_MUST_CHECK;

/* The column of griffith of that array, for a state at rest at small strain. A crack of the length
 * `flaw` (in space a square) is put at a particle, across its largest principal stress when that
 * pulls; at all particles where that stress is `part` of the largest one or more, 0 elsewhere. Many
 * are tried at once, so far apart that they do not feel each other. The body is as before when it
 * returns. BW_EINPUT for G0, flaw or part; BW_EMEM. Collective. */
bw_status bw_solid_failure_griffith(bw_solid *solid, const bw_solid_strength *strength, double part,
                                    double used[]) BW_MUST_CHECK;

/* A place of the list. */
typedef struct {
  int64_t id;   /* global id of the particle */
  double X0[3]; /* where it is in the reference shape [L] */
  double used;  /* the gauge */
  double load;  /* 1/used: at this times the present load it fails there */
} bw_solid_failure_place;

/* The first places to fail by a gauge: up to `most` rows of list, of all ranks and on all of them,
 * the first one first; *n: how many. BW_EMEM. Collective. */
bw_status bw_solid_failure_list(const bw_solid *solid, const double used[],
                                bw_solid_failure_gauge gauge, int most,
                                bw_solid_failure_place list[], int *n) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
