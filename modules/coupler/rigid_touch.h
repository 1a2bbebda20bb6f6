/* rigid_touch.h -- contact of the particles of a solid with the true surfaces of rigid bodies;
 * inside `coupler` only.
 *
 * A particle whose centre is y away from the surface meets its own mirror image in it, as at a wall
 * (pd_contact_wall.c), so that it touches with its cube's face:
 *   F = k_c dV^2 (ds/(2 y) - 1) n   where y < ds/2,   n the surface's normal,
 * with the energy k_c dV^2/2 (ds ln(ds/(2 y)) - ds + 2 y). The body gets -F at the same place, so
 * that momentum and angular momentum stay to round-off. */
#pragma once
#include "bw_rigid.h"
#include "bw_solid_outside.h"

typedef struct bw_coupler__touch bw_coupler__touch;

/* Between `solid` and all bodies of `rigid`, both borrowed; period (3) [L] of the box, 0: none.
 * From now on the solid evaluates it. BW_EINPUT where the two pierce each other, BW_EMEM.
 * Collective. */
bw_status bw_coupler__touch_create(bw_solid *solid, bw_rigid *rigid, const double period[3],
                                   bw_coupler__touch **out) BW_MUST_CHECK;
/* Lets go of the solid, which has to be there still; NULL is fine. Local. */
void bw_coupler__touch_destroy(bw_coupler__touch **touch);
/* The load for the present places, without pushing the particles. BW_EDIVERGED when a particle is
 * inside a body. Collective. */
bw_status bw_coupler__touch_feel(bw_coupler__touch *touch) BW_MUST_CHECK;
/* Forces (bodies,3), then torques (bodies,3) about their centres, as of the last evaluation;
 * borrowed, the same on all ranks. Local. */
const double *bw_coupler__touch_load(const bw_coupler__touch *touch);
/* Step that resolves a contact of the stiffest pair there can be [T], 1/w. Local. */
double bw_coupler__touch_time(const bw_coupler__touch *touch);
