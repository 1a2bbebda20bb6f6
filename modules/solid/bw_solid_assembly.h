/* bw_solid_assembly.h -- several solids in one space, stepped together, with contact between them.
 *
 * Each solid keeps its own lattice, turn, spacing, materials, dampings and, where it was asked for,
 * its contact with itself. The set adds the contact between the particles of different solids
 * (bw_pd_contact_between.h). A step is that of velocity Verlet of all:
 *   v += dt/2 A, u += dt v of every solid; forces of all, contact between them; v += dt/2 A.
 * Energy is kept to the order of the integrator, momentum and angular momentum of free solids to
 * round-off, on any number of ranks.
 * Units    any consistent set: [M], [L], [T].
 * Life     solids created -> create -> { set state, forces, step, account }* -> destroy -> solids
 *          destroyed. Between create and destroy the solids are stepped by the set alone;
 *          everything else may be done with each as ever: views, states, forces, retiring,
 *          checkpoints. A restart is one of each solid, set before the next step: the rows hold the
 *          set's contact.
 * Limits   one communicator, dimension and period; velocity Verlet. Solids that touch at create
 *          push from the start, and the account holds that energy; those that pierce each other are
 *          refused. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_solid_assembly bw_solid_assembly;

/* A set of n >= 1 solids, which are borrowed until destroy; the list is copied. BW_EINPUT names the
 * solid and the key: one listed twice, integrator = rk3, another communicator, dimension, thickness
 * or period than the first's, a particle nearer to another solid's than BW_SOLID_TOO_CLOSE times
 * the smaller spacing. BW_EMEM. *out is the caller's, NULL after a failure. Collective. */
bw_status bw_solid_assembly_create(int n, bw_solid *const solid[],
                                   bw_solid_assembly **out) BW_MUST_CHECK;
void bw_solid_assembly_destroy(bw_solid_assembly **set); /* NULL is fine; the solids stay. Local. */

/* One step of dt [T] of all solids. BW_ECFL when dt is above the bw_solid_dt_max of one of them;
 * BW_EDIVERGED as of bw_solid_step; BW_EMEM. Collective. */
bw_status bw_solid_assembly_step(bw_solid_assembly *set, double dt) BW_MUST_CHECK;

/* Step [T] that is stable with the bonds and the contacts of all together: the rates 1/dt^2 of
 * bonds, contact within and contact between add (bw_solid_dt_contact). Small against it, energy is
 * kept to (dt w)^2/8. INFINITY where nothing acts. The same on all ranks. Local. */
double bw_solid_assembly_dt(const bw_solid_assembly *set);

/* The book of all solids: sums of their ledgers, with the energy between them in `contact`;
 * `closest` is the least of all pairs, over their reach. Energy between two solids goes with the
 * present motion: kinetic + elastic + contact + retired + damping + fracture + plastic - external
 * is constant to the order of the step. Evaluates the forces first where a state was changed.
 * BW_EDIVERGED, BW_EMEM; *out is then left as it was. Collective. */
bw_status bw_solid_assembly_account(bw_solid_assembly *set, bw_solid_ledger *out) BW_MUST_CHECK;

/* Pairs of different solids that each evaluation looks at, of all ranks; each counts from both
 * ends. Collective. */
int64_t bw_solid_assembly_pairs(const bw_solid_assembly *set);

#ifdef __cplusplus
}
#endif
