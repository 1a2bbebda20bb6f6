/* bw_pd_contact_between.h -- repulsion between the particles of different bodies.
 *
 * Bodies are lattices of their own, with their own spacing, turn and materials. A particle a of one
 * body and b of another that are nearer than r_c, r = |X_b - X_a| < r_c, push each other apart with
 * the force (POROUS 3.40 with ERRATA 3)
 *   F_a = - k_c (r_c/r - 1) e dV_a dV_b,   e from a to b,   F_b = - F_a,
 * which derives from the energy k_c (r_c ln(r_c/r) - r_c + r) dV_a dV_b of the pair. r_c is the
 * smaller of the two spacings. k_c = 15 c with the micromodulus c of the law; of two that differ it
 * is the harmonic mean. Retired particles are left out; prescribed ones push and are pushed.
 * What overlaps from the start pushes from the start, with the energy that says. Bodies that pierce
 * each other should be refused by whoever puts them together: bw_pd_contact_between_closest tells.
 * Shapes   positions in space, not in lattice axes.
 * Units    any consistent set: [M], [L], [T].
 * Life     create -> { update -> { force, energy }* }* -> destroy.
 * Limits   bodies of one dimension and, in 2D, one thickness. Periods are those of space: bodies
 *          with periods stand along the axes and all have the same. */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_pd_contact_between bw_pd_contact_between;

/* Contact between each two of n >= 1 bodies of one communicator. The bodies are borrowed until
 * destroy, the list is copied. BW_EINPUT names what does not go together: a body listed twice,
 * another communicator, dimension, thickness or period; BW_EMEM. *out is the caller's, NULL after a
 * failure. Collective. */
bw_status bw_pd_contact_between_create(int n, bw_pd_body *const body[],
                                       bw_pd_contact_between **out) BW_MUST_CHECK;
void bw_pd_contact_between_destroy(bw_pd_contact_between **between); /* NULL is fine. Local. */

/* Pairs and positions for the present motion of the bodies; a new search when a particle has moved
 * by half the skin since the last one. BW_EMEM. Collective. */
bw_status bw_pd_contact_between_update(bw_pd_contact_between *between) BW_MUST_CHECK;

/* Adds the accelerations to load.extra of the bodies [L/T^2]. After update. Local. */
void bw_pd_contact_between_force(bw_pd_contact_between *between);

/* Energy of the pairs, this rank's halves: summed over ranks every pair counts once [M L^2/T^2].
 * After update. Local. */
double bw_pd_contact_between_energy(bw_pd_contact_between *between);

/* The next update searches anew: particles were retired. Local. */
void bw_pd_contact_between_forget(bw_pd_contact_between *between);

/* Step that resolves a collision of two particles [T], 1/w of their oscillation; of the stiffest
 * pair there can be. INFINITY with one body. The same on all ranks. Local. */
double bw_pd_contact_between_time(const bw_pd_contact_between *between);

/* Least distance of a pair over its r_c, of this rank, in the forces and energies so far; INFINITY:
 * none touched. Local. */
double bw_pd_contact_between_closest(const bw_pd_contact_between *between);

/* Pairs that are looked at in each evaluation, of this rank's particles with others: those nearer
 * than r_c and the skin at the last search. A pair of two own particles counts twice. Local. */
size_t bw_pd_contact_between_pairs(const bw_pd_contact_between *between);

#ifdef __cplusplus
}
#endif
