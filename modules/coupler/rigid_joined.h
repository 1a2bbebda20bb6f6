/* rigid_joined.h -- rigid bodies beside a solid of particles; inside `coupler` only. */
#pragma once
#include "bw_coupler_rigid.h"
#include "coupler_internal.h"
#include "rigid_touch.h"

/* bw_coupler_rigid.c: the halves of its step, and what it holds. */
bw_rigid *bw_coupler__rigid_set(const bw_coupler_rigid *coupler); /* borrowed. Local. */
/* The load of the fluid in the step that has just been: kept as what acts. Collective. */
bw_status bw_coupler__rigid_find_load(bw_coupler_rigid *coupler, double dt) BW_MUST_CHECK;
/* That: forces (bodies,3), then torques; borrowed, the same on all ranks. Local. */
const double *bw_coupler__rigid_acting(const bw_coupler_rigid *coupler);
double *bw_coupler__rigid_scratch(bw_coupler_rigid *coupler); /* (bodies,6). Local. */
/* inside <- 1 in the cells of this rank whose centre is in a body. Local. */
void bw_coupler__rigid_mark(bw_coupler_rigid *coupler, bw_real *inside);
/* How far a surface point of this rank has moved since that [L]; INFINITY: it was not called. */
double bw_coupler__rigid_moved(const bw_coupler_rigid *coupler);

/* joined.c: room for the state of the bodies, *bodies; it, and the way back. Nothing without them.
 * room is local, the others are collective. */
bw_status bw_coupler__joined_room(const bw_coupler *c, double **bodies) BW_MUST_CHECK;
void bw_coupler__joined_capture(const bw_coupler *c, double bodies[]);
bw_status bw_coupler__joined_restore(const bw_coupler *c, double time,
                                     double bodies[]) BW_MUST_CHECK;
/* How many parts of a step of dt bodies and their contact need, at least. Local. */
double bw_coupler__joined_parts(const bw_coupler *c, double dt);
/* A sub-step of dt of the solid, with its films. Collective. */
bw_status bw_coupler__step_solid(bw_coupler *c, double dt) BW_MUST_CHECK;
/* A step of dt of the bodies in n parts, with or without one of the solid. Collective. */
bw_status bw_coupler__step_joined(bw_coupler *c, double dt, int n, bool solid) BW_MUST_CHECK;
/* A step of the bodies beside a solid that is held: their load, and their motion. Collective. */
bw_status bw_coupler__step_floats(bw_coupler *c, double dt) BW_MUST_CHECK;
