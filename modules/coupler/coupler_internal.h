/* coupler_internal.h -- shared by the sources of the coupler only. */
#pragma once
#include "bw_coupler.h"

/* A copy of everything a run needs to go on: fields with halos, particle rows. */
typedef struct {
  bool filled;
  double fluid_numbers[2]; /* time, gradient of the forcing */
  bw_real *field[4];       /* u, v, w, p; NULL where the fluid has none */
  double *rows;            /* (n,9) of bw_pd_bond_get_restart */
  double sums[4];
  uint8_t *bits;    /* (n, bits_bytes) */
  double *V_before, *F;  /* (n,3) */
} bw_coupler__state;

struct bw_coupler {
  bw_coupler_config config;
  bw_ns_channel *fluid;
  bw_pd_bond *solid;
  bw_pd_interface *interface;
  bw_ibm_mdf *ibm;
  bw_probe *probe;
  bool held;
  size_t n;             /* particles of this rank */
  double h;             /* grid spacing [L] */
  double *F;            /* (n,3) fluid load on particles [M/(L^2 T^2)] */
  double *V, *V_before; /* (n,3) velocity now and at the end of the step before */
  size_t n_surface;     /* surface particles inside the box: rows used of the arrays below */
  int32_t *particle;    /* which particle each is */
  double *marker_X, *marker_V, *marker_dV; /* (n,3), (n,3), (n) */
  double *root, *normal, *area;            /* probe points (n,3), normals (n,3), areas (n) */
  double *accel, *traction;                /* (n,3) each: of the surface points */
  unsigned char *flag;                     /* (n) bw_probe_flag */
  double force_probe[3];                   /* of this rank, last load */
  bw_real *inside;                         /* field: 1 in cells that hold a particle */
  double *X, *X_inside;                    /* (n,3) positions now, and when `inside` was computed */
  bool inside_known, markers_moved;
  bw_timer *timer;
  double bonds; /* intact ends of this rank at the start: work of one force evaluation */
  bw_coupler__state kept;
};

/* Surface, markers, probe points to where the solid is now. Collective. */
bw_status bw_coupler__follow_surface(bw_coupler *c) BW_MUST_CHECK;
/* Hand the markers over if the surface has moved. At the beginning of a step, so that the forces
 * of the last one can be asked for until then. Collective. */
bw_status bw_coupler__place_markers(bw_coupler *c) BW_MUST_CHECK;
/* Fluid stress on the surface particles -> external force density of the solid. Collective. */
bw_status bw_coupler__load(bw_coupler *c, double dt) BW_MUST_CHECK;
void bw_coupler__state_release(bw_coupler__state *s);
