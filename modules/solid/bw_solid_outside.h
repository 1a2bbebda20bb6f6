/* bw_solid_outside.h -- who else pushes the particles of a solid, by where they are.
 *
 * Contact with what is no solid of particles, a rigid surface that moves for example: the force is
 * one of the present places, evaluated with those of bonds and contact, and so at both ends of a
 * Verlet step. Its energy counts as `contact` in the ledger, which closes with the energy of who
 * pushes. The caller moves what pushes:
 *   kick and drift it; bw_solid_step; kick it with the force found there (coupler/joined.c).
 * Life     solid created -> set_outside -> { step } -> forget_outside or destroy of the solid. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What pushes. */
typedef struct {
  void *who; /* for the functions below */
  /* The own particles are at X (n,3) [L]: calls bw_solid_push for those that it touches. An error
   * of one rank is agreed on later. Collective. */
  bw_status (*push)(void *who, bw_solid *solid, const double X[]);
  /* Of the last push, this rank's share [M L^2/T^2]. Local. */
  double (*energy)(const void *who);
  /* Least distance over its reach so far, of this rank. Local. */
  double (*closest)(const void *who);
} bw_solid_outside;

/* Takes over what `outside` holds; its `who` is borrowed. Forces are evaluated anew before the next
 * step. BW_EINPUT for integrator = rk3, whose stages nobody follows, and where levels change;
 * BW_EMEM. Collective. */
bw_status bw_solid_set_outside(bw_solid *solid, const bw_solid_outside *outside) BW_MUST_CHECK;
void bw_solid_forget_outside(bw_solid *solid); /* nobody pushes any more. Local. */

/* Within `push` alone: the force F (3) [M L/T^2] on own particle i. Local. */
void bw_solid_push(bw_solid *solid, size_t i, const double F[3]);

/* Forces of the present motion, where they are not known: before the first of the steps that go
 * with what pushes. Errors of bw_solid_evaluate. Collective. */
bw_status bw_solid_make_ready(bw_solid *solid) BW_MUST_CHECK;

/* k_c dV^2 of own particle i with its like, the force of a pair at half its reach, which is the
 * spacing [M L/T^2] (bw_pd_contact.h). Local. */
double bw_solid_contact_force(const bw_solid *solid, size_t i);

#ifdef __cplusplus
}
#endif
