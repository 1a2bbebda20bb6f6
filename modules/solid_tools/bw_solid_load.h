/* bw_solid_load.h -- what a solid is loaded with: ramps, prescribed motion, tractions, gravity,
 * starts.
 *
 * Forces are added to an array F (n,3) [M/(L^2 T^2)] of the own particles, which the caller clears
 * and hands to bw_solid_set_force. Places are reference positions; boxes are half-open
 * (lower <= X0 < upper); in 2D their z is ignored. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How a ramp goes from 0 to 1. */
typedef enum {
  BW_SOLID_RAMP_LINEAR, /* x */
  BW_SOLID_RAMP_SMOOTH  /* 3 x^2 - 2 x^3: no jump of velocity at its ends */
} bw_solid_ramp_kind;

/* 0 until `start`, 1 from start + duration on; x is the part of the duration that has gone by. */
typedef struct {
  bw_solid_ramp_kind kind; /* shape between the two */
  double start;            /* [T] */
  double duration;         /* [T]; 0: a step */
} bw_solid_ramp;

/* The ramp at a time [T]: 0 .. 1. Local. */
double bw_solid_ramp_value(const bw_solid_ramp *ramp, double time);

/* For the step from `time` to time + dt [T]: prescribed particles get the velocity that puts them
 * at X0 + value(time + dt) U, U (n,3) [L], when they stood at value(time) U before. Local. */
void bw_solid_load_displace(bw_solid *solid, const bw_solid_ramp *ramp, double time, double dt,
                            const double U[]);

/* The same with a velocity V (n,3) [L/T] that is ramped: value(time + dt/2) V. Local. */
void bw_solid_load_move(bw_solid *solid, const bw_solid_ramp *ramp, double time, double dt,
                        const double V[]);

/* traction (3) [M/(L T^2)] on the face `area` [L^2] of a body, spread evenly over the free
 * particles in the box (a layer of one horizon or less below the face): their sum is traction times
 * area, as F is a force per volume. BW_EINPUT when the box holds none or area is not positive.
 * Collective. */
bw_status bw_solid_load_traction(const bw_solid *solid, const double lower[3],
                                 const double upper[3], double area, const double traction[3],
                                 double F[]) BW_MUST_CHECK;

/* F += rho g, g (3) [L/T^2]. Local. */
void bw_solid_load_gravity(const bw_solid *solid, const double g[3], double F[]);

/* Velocities velocity (3) [L/T] + spin (3) [1/T] x (X - centre) for all particles, centre (3) [L];
 * positions stay. BW_EMEM. Collective. */
bw_status bw_solid_load_launch(bw_solid *solid, const double velocity[3], const double spin[3],
                               const double centre[3]) BW_MUST_CHECK;

/* A velocity of any form: writes V (3) [L/T] of the place X0 (3) [L]; data is the caller's. */
typedef void (*bw_solid_load_field)(const double X0[3], double V[3], const void *data);

/* Velocities of all particles from a field; positions stay. BW_EMEM. Collective. */
bw_status bw_solid_load_velocity(bw_solid *solid, bw_solid_load_field field,
                                 const void *data) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
