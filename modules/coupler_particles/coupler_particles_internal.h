/* coupler_particles_internal.h -- what the sources of coupler_particles share. */
#pragma once
#include "bw_coupler_particles.h"
#include "bw_ulph_body.h"

struct bw_coupler_particles {
  bw_coupler_particles_config config;
  bw_ulph *fluid;   /* borrowed */
  bw_solid *solid;  /* borrowed */
  double rho0;      /* of the fluid */
  double thickness; /* of a solid in two dimensions, else 1 */
  bool held, known; /* the solid stays; F is that of the last evaluation */
  size_t n, total;  /* particles of this rank, of all */
  /* Of all particles, on every rank: force, wetted area, places, velocities. */
  double *F, *area, *x, *v; /* (total,3), (total), (total,3), (total,3) */
  double *next;             /* (total,3) scratch */
  /* Of this rank's, in the order of the solid. */
  double *X, *density, *load; /* (n,3) places, force densities, loads */
  double *owed, *kept;        /* (n,3) impulses still to be received; of the virtual mass */
  double *k;                  /* (n) drag */
  int32_t *wet;               /* (n) who feels it */
  /* Sums of this rank since the start. */
  double impulse[3], late, received;
};

/* Arrays of what all ranks have, from each rank's rows. Collective. */
void bw_coupler_particles__join(const bw_coupler_particles *c, const double own[], double all[]);
