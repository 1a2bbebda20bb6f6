/* plate.h -- a notched plate torn open: set-up, step, and where its crack is.
 *
 * Plate 0 .. length, 0 .. height; notch along the middle from the left edge; from t = 0 on the
 * two long edges are pulled apart by the stress sigma, as a body force sigma/(rows ds) on their
 * outermost rows. Used by this case and by validation/pd_bond/crack_*.c. */
#pragma once
#include "bw_pd_bond.h"
#include "bw_pd_crack.h"

typedef struct {
  double length, height, notch; /* [m] */
  int particles;                /* along the length; spacing length/particles */
} plate_shape;
typedef struct {
  double young_modulus, density, fracture_energy, horizon_ratio;
  int surface_correction, volume_fraction, family_reach, integrator; /* enums of bw_pd_bond.h */
  double damping_pair;
} plate_solid;
typedef struct {
  double stress; /* [Pa] */
  int rows;
} plate_load;
typedef struct {
  double step, end; /* [s] */
} plate_time;

typedef struct {
  plate_shape shape;
  plate_solid solid;
  plate_load load;
  plate_time time;
} plate_config;

/* What is known of the crack so far; NAN: not yet. */
typedef struct {
  double tip;      /* farthest particle with damage > 0.35 [m] */
  double t_first;  /* first bond beyond the notch broke [s] */
  double t_start;  /* the tip left the notch's end [s] */
  double t_branch; /* it was first seen forked, looked for once per microsecond / 4 [s] */
  double t_edge;   /* the tip is within one spacing of the far edge [s] */
} plate_crack;

typedef struct {
  const bw_comm *comm;
  plate_config config;
  bw_pd_bond *solid;
  double ds, time;
  int64_t steps, events;
  size_t n;
  double *X0, *damage; /* (n,3), (n) */
  double notch_tip;    /* tip before the first step [m] */
  plate_crack crack;
  bw_pd_crack_track track; /* of the tip */
} plate;

/* `p` is filled; free it with plate_destroy, also after a failure. Collective. */
bw_status plate_create(const bw_comm *comm, const plate_config *config, plate *p) BW_MUST_CHECK;
bw_status plate_step(plate *p) BW_MUST_CHECK; /* Collective. */
void plate_destroy(plate *p);

/* Highest speed of the tip until it reaches the far edge, over times `window` [m/s]. Local. */
double plate_speed(const plate *p, double window);

/* Branches cut by the section at x, and where the crack forks [m] (NAN: nowhere). Collective. */
bw_status plate_branches(plate *p, double x, int *branches, double *fork) BW_MUST_CHECK;
