/* bw_pd_interface.h -- which particles are surface, their normals and areas; fragments.
 *
 * POROUS 3.3.7: the sphere of radius horizon around a particle is divided into sectors (2D: 8 of
 * equal angle; 3D: solid angles, see README). A sector is empty when no intact bond points into
 * it and the mean distance 3.42 to the partners of its broken bonds exceeds the threshold (the
 * horizon by default). A particle is surface when `n_empty` neighbouring sectors are empty. Normals by
 * 3.45-3.46 (outward: into the fluid). Area per particle: A_h = sum over particles that were
 * surface at the start of their exact exposed area / their number; new crack faces get ds^2
 * (ERRATA 10; 2D: ds x thickness).
 * Sides of the domain against which the solid leans (a wall of the channel) are not surface: give
 * them as planes in the config.
 * MPI: results are of the rank's own particles. Updates cost nothing when no bond broke and no
 * gap opened. */
#pragma once
#include "bw_pd_bond.h"

typedef struct bw_pd_interface bw_pd_interface;

typedef struct {
  double threshold;     /* mean distance over horizon that opens a sector [-]   default 1 */
  int n_empty;          /* neighbouring empty sectors that make a surface       default 2 */
  bool walled[3][2];    /* lower/upper side of the box `lower..upper` is a wall the solid leans on */
  double lower[3], upper[3];
} bw_pd_interface_config;

bw_pd_interface_config bw_pd_interface_config_default(void);

/* `pd` is borrowed until destroy. Finds the first surface. Collective. */
bw_status bw_pd_interface_create(bw_pd_bond *pd, const bw_pd_interface_config *config,
                                 bw_pd_interface **out) BW_MUST_CHECK;
void bw_pd_interface_destroy(bw_pd_interface **pi); /* NULL is fine. Collective. */

/* Follow the solid: surface set where bonds broke, normals and positions everywhere. Collective. */
bw_status bw_pd_interface_update(bw_pd_interface *pi) BW_MUST_CHECK;

/* The surface of this rank, borrowed until the next update. Local. */
typedef struct {
  size_t n;
  const int32_t *particle; /* (n) index into pd's own particles */
  const double *X, *V, *N; /* (n,3) position [L], velocity [L/T], unit outward normal */
  const double *A;         /* (n) area [L^2] */
} bw_pd_surface;
bw_pd_surface bw_pd_interface_surface(const bw_pd_interface *pi);
const bool *bw_pd_interface_is_surface(const bw_pd_interface *pi); /* (count of pd) Local. */

typedef struct {
  int64_t label;       /* smallest global id in it */
  int64_t particles;
  double mass;         /* [M] */
  double centre[3], velocity[3], spin[3]; /* [L], [L/T], [1/T] */
} bw_pd_fragment;

/* Pieces connected by intact bonds, largest first. label (count of pd) of each own particle, may
 * be NULL. *fragment allocated on every rank (the same list), owned by the caller (bw_release).
 * Collective. */
bw_status bw_pd_interface_fragments(bw_pd_interface *pi, int64_t label[], size_t *n,
                                    bw_pd_fragment **fragment) BW_MUST_CHECK;
