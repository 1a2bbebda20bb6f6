/* rigid_impl.h -- rigid bodies in a fluid, as their sources hold them; inside `coupler` only. */
#pragma once
#include "rigid_films.h"
#include "rigid_joined.h"

struct bw_coupler_rigid {
  bw_coupler_rigid_config config;
  bw_ns_channel *fluid; /* borrowed */
  bw_rigid *rigid;      /* borrowed */
  bw_ibm_mdf *ibm;
  bw_coupler__films *films; /* NULL: none */
  size_t n;                 /* markers of this rank */
  bool placed, fresh;       /* fresh: by set_state, where the bodies are now */
  double *X, *V, *N, *dV;   /* (n,3), dV (n) */
  double *seen;    /* (n) of dV what the grid sees: films keep sides away from other faces */
  int *closed;     /* (n) surface that the marker closes: its body, or -1 */
  double *M, *Q;   /* (n,3) M memory, Q force of a step, then lack */
  double *inside;  /* (bodies,6) int (u - U) dV, its moment at the beginning */
  double *load;    /* (bodies,6) as the bodies have it: relaxed, with weight */
  double *hydro;   /* (bodies,6) of the fluid in the last step */
  double *scratch; /* (bodies,6) */
  double *acting;  /* (bodies,6) forces, then torques, of the step: with weight and films */
  double *marked;  /* (n,3) the surface when cells inside were marked */
  bool is_marked;
};

/* rigid_inside.c: int (u - U) dV and its moment, sum (bodies,6), over the bodies where they are, or
 * will be after dt [T]. Collective. */
void bw_coupler__rigid_inside(const bw_coupler_rigid *c, double dt, double sum[]);
