/* coupler_internal.h -- shared by the sources of the coupler only. */
#pragma once
#include "bw_coupler.h"

/* A copy of everything a run needs to go on: fields with halos, particle rows. */
typedef struct {
  bool filled;
  double fluid_numbers[2]; /* time, gradient of the forcing */
  bw_real *field[4];       /* u, v, w, p; NULL where the fluid has none */
  double *rows;            /* (n,BW_PD_RESTART_ROW) of bw_pd_bond_get_restart */
  double sums[4];
  uint8_t *bits;        /* (n, bits_bytes) */
  double *V_before, *F; /* (n,3) */
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
  double *accel, *traction, *force;        /* (n,3) each: of the surface points */
  unsigned char *flag;                     /* (n) bw_probe_flag */
  double force_probe[3];                   /* of this rank, last probes */
  bw_real *p_mean;      /* field: pressure that acted over the last step (ns_channel's p/rho) */
  bool p_mean_known;    /* false before the first step and after a load */
  bw_real *inside;      /* field: 1 in cells that hold a particle */
  double *X, *X_inside; /* (n,3) positions now, and when `inside` was computed */
  bool inside_known, markers_moved;
  double checked_dt; /* step for which the present flow was found stable */
  bw_timer *timer;
  double bonds; /* intact ends of this rank at the start: work of one force evaluation */
  bw_coupler__state kept;
};

/* Surface, markers, probe points to where the solid is now. Collective. */
bw_status bw_coupler__follow_surface(bw_coupler *c) BW_MUST_CHECK;
/* Hand the markers over if the surface has moved. At the beginning of a step, so that the forces
 * of the last one can be asked for until then. Collective. */
bw_status bw_coupler__place_markers(bw_coupler *c) BW_MUST_CHECK;
/* Force of the fluid on each surface particle, c->force (n_surface,3) [M L/T^2], by probes (dt:
 * the step whose velocities give the acceleration) or by the markers' reaction. Collective. */
bw_status bw_coupler__probe_force(bw_coupler *c, double dt) BW_MUST_CHECK;
void bw_coupler__reaction_force(bw_coupler *c);
/* c->force, relaxed, to the force density F of the particles. Local. */
void bw_coupler__relax_load(bw_coupler *c);
void bw_coupler__state_release(bw_coupler__state *s);
