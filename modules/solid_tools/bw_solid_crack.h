/* bw_solid_crack.h -- a pressure in the cracks of a solid that are joined to a source.
 *
 * A fluid of one pressure p fills the cracks that a source feeds and follows their tips at once: no
 * time to flow, no lag behind the tip. It pushes the two faces apart. On a lattice of particles a
 * face is what broken bonds cross: per area of a plane cut of normal n there are |xi.n|/V of
 * direction xi, V the volume of a particle, so that the area vectors
 *   a = C Gamma xi/|xi|,  C = 2 d V/(sum over a full family of Gamma |xi|),  d the dimension,
 * add up to n per area for a cut of any direction: the sum over a family of Gamma xi (x) xi/|xi| is
 * isotropic on a cubic lattice. Gamma is the bond's volume fraction, and a has the weights of a
 * bond's force in a uniform expansion; so a pressure in a crack moves a body as tension p at its
 * edges does, but for that uniform state, as in linear fracture mechanics.
 * The pair (i, j) of a broken bond, apart by y now, gets -p |a| q y/|y| and the opposite:
 *   q = min(1, (xi.N0/|xi|)/(y.N/|y|)),  N0, N the crack's normal before and now,
 * from the sums of Gamma xi and of Gamma y over the broken bonds of both ends. Without q, which is
 * 1 while a crack opens by much less than a spacing, the bonds of a wide crack would all stand on
 * its faces and push too much. Forces are opposite and central: momentum and angular momentum are
 * those of before. The work is that of bw_solid_set_force and in the ledger as external.
 *
 * Joined: a particle is wet when one of its broken bonds leads to a wet one, or when it is of the
 * source and has a broken bond. All broken bonds of wet particles are pushed apart. So two cracks
 * within one horizon on either side of a particle count as one. Wet particles stay wet. A crack
 * that closes keeps its pressure. A body with levels or disorder is refused.
 * Units as in bw_solid.h. The same bits on any number of ranks, and after a restart: what is wet
 * follows from the source and the bonds that hold. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_solid_crack bw_solid_crack;

/* source (count): own particles that the source touches, copied; such as those with a broken bond
 * when the pre-cracks have been cut. `solid` is borrowed until destroy. BW_EINPUT for a body with
 * levels or disorder, or when the source is empty on all ranks; BW_EMEM. *out is the caller's, NULL
 * after a failure. Collective. */
bw_status bw_solid_crack_create(bw_solid *solid, const bool source[],
                                bw_solid_crack **out) BW_MUST_CHECK;
/* Frees it and sets the pointer to NULL; NULL is fine. Local. */
void bw_solid_crack_destroy(bw_solid_crack **crack);

/* F (n,3) += the force density of the pressure [M/(L^2 T^2)] at the present places; the crack is
 * followed to where it is now. BW_EMEM. Collective. */
bw_status bw_solid_crack_push(bw_solid_crack *crack, double pressure, double F[]) BW_MUST_CHECK;

/* What the fluid fills. */
typedef struct {
  int64_t bonds; /* broken bonds that it pushes apart */
  double area;   /* of one face [L^2]; in the plane length times thickness */
  double volume; /* opened since the reference shape [L^3] */
} bw_solid_crack_size;

/* Of the crack as it is now, of all ranks. BW_EMEM. Collective. */
bw_status bw_solid_crack_measure(bw_solid_crack *crack, bw_solid_crack_size *out) BW_MUST_CHECK;

/* Whether each own particle is wet (count), as of the last push or measure; borrowed until the
 * next. Local. */
const bool *bw_solid_crack_wet(const bw_solid_crack *crack);

#ifdef __cplusplus
}
#endif
