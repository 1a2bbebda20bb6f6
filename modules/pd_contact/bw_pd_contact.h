/* bw_pd_contact.h -- repulsion of particles that no intact bond joins, and of walls.
 *
 * On h, for r = |X_l - X_h| < r_c (POROUS 3.40 with ERRATA 3):
 *   C_h = - k_c (r_c/r - 1) e dV_l,  e from h to l,  k_c = 15 c0, r_c = ds,
 * with the law's micromodulus c0; between two materials, or two levels, the smaller r_c and the
 * harmonic mean of the two k_c. It derives from the energy k_c (r_c ln(r_c/r) - r_c + r) dV dV of a
 * pair. */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_pd_contact bw_pd_contact;

enum { BW_PD_WALLS = 6 }; /* walls of one solid, at most */

/* A plane that the particles do not cross: the domain lies where normal.X > offset. */
typedef struct {
  double normal[3]; /* unit, into the domain */
  double offset;    /* [L] */
} bw_pd_wall;

/* Contact of one body with itself, without walls; `pd` is borrowed until destroy. *out is the
 * caller's, NULL after a failure. BW_EMEM. Local. */
bw_status bw_pd_contact_create(bw_pd_body *pd, bw_pd_contact **out) BW_MUST_CHECK;

void bw_pd_contact_destroy(bw_pd_contact **contact); /* NULL is fine. Local. */

/* Pairs and positions for the present motion; a new search when something moved by half the skin.
 * BW_EDIVERGED when a particle was thrown through a wall. Collective. */
bw_status bw_pd_contact_update(bw_pd_contact *c) BW_MUST_CHECK;

/* Adds the accelerations by contact to load.extra of the body. After update. Local. */
void bw_pd_contact_force(bw_pd_contact *c);

/* Energy of this rank's halves [M L^2/T^2]. After update. Local. */
double bw_pd_contact_energy(bw_pd_contact *c);

/* The next update searches anew: something was set or retired. Local. */
void bw_pd_contact_forget(bw_pd_contact *c);

/* Bonds have changed: who is held across a wall is looked at again. Local. */
void bw_pd_contact_recheck(bw_pd_contact *c);

/* Step that resolves a collision of two particles [T]. Local. */
double bw_pd_contact_time(const bw_pd_contact *c);

/* k_c dV^2 of own particle i with its like [M L/T^2]. Local. */
double bw_pd_contact_force_of(const bw_pd_body *pd, size_t i);

/* Least distance of a pair so far over its r_c, of this rank; INFINITY: none. Local. */
double bw_pd_contact_closest(const bw_pd_contact *c);

/* Force on the walls at the last evaluation, of this rank (3) [M L/T^2]; borrowed, and writable for
 * a restart. Local. */
double *bw_pd_contact_wall_force(bw_pd_contact *c);

/* Replaces the walls (n = 0: none). BW_EINPUT for more than BW_PD_WALLS, a normal that is no unit
 * vector, a free particle beyond. Collective. */
bw_status bw_pd_contact_set_walls(bw_pd_contact *c, int n, const bw_pd_wall wall[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
