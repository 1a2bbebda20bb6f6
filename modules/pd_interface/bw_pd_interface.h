/* bw_pd_interface.h -- which particles are surface, their normals and areas; fragments.
 *
 * POROUS 3.3.7: the sphere of radius horizon around a particle is divided into sectors: 2D, 8 of
 * equal angle centred on the lattice's sides and diagonals; 3D, 24 of equal solid angle, the
 * octants cut in three by the largest component (docs/verification/pd_interface says why). A bond
 * belongs to the sectors of its reference direction, so that turning as a rigid body changes
 * nothing. A sector is empty
 * when no intact bond points into it and the mean distance 3.42 to the partners of its broken
 * bonds, if it has any, exceeds the threshold (the horizon by default). A particle is surface
 * when `n_empty` neighbouring sectors are empty; in a body that never broke these are the
 * particles with an open side on the lattice.
 * Normals (outward: into the fluid): 3.45-3.46 in the reference shape over the partners that still
 * hold, where the surface is smooth their fit along it, turned with the body as a material surface
 * is. Where the neighbours balance (thin sheets, single particles) 3.45 is that of the body before
 * anything broke, or the direction of the empty sectors.
 * Areas of particles that were surface in the reference shape, one of
 *   open sides (default): ds^2 sum over the open lattice faces f of e_f.n_h, at least ds^2/4, so
 *     that sum A n is nothing, as on a closed surface (a uniform pressure gives no net force), and
 *     sum A n_d x_d the volume, for each direction d (figures in docs/verification/pd_interface);
 *   equal: as with POROUS 3.96, the body's area over their number.
 * Heights: a particle is a cube of edge ds, so on a side of the lattice the surface is ds/2 above
 * the centre; on a smooth slanted one, whose sides are steps, their mean is ds/(2 sum_d |n_d|), n_d
 * along the lattice's directions (ERRATA 33): the planes that cut off the particles' own volume;
 * and, as particles of one terrace are at different depths, the mean of what the particles of its
 * family on that surface say, weighted by A (1 - (xi/horizon)^2). On ridges and edges ds/2.
 * New crack faces get ds^2 (ERRATA 10; 2D: ds x thickness in all).
 * Several levels: all of this by each particle's own spacing and horizon. Partners that its own
 * horizon does not reach tell nothing, cells of another size weigh as their volume (3.45), and what
 * has an open side is surface whatever the sectors say.
 * Sides of the domain against which the solid leans (a wall of the channel) are not surface: give
 * them as planes in the config (refused for a disordered cloud, which no plane mirrors). There
 * partners are taken as mirrored in the plane, until the particle has moved from the wall by more
 * than the threshold or its bonds across it broke. Particles beyond such a plane (ghost layers) are
 * never surface. A disordered cloud has the sectors, weights, first surface, areas and first
 * normals of its sites. MPI: results are of the rank's own particles. Updates cost only positions
 * and the turning of normals when no bond broke. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The surface of one solid. Opaque. */
typedef struct bw_pd_interface bw_pd_interface;

/* Area of a surface particle (above). */
typedef enum {
  BW_PD_AREA_OPEN_SIDES, /* its open lattice faces, projected on its normal */
  BW_PD_AREA_EQUAL       /* the body's area over the number of surface particles */
} bw_pd_area;

/* What a user chooses. */
typedef struct {
  double threshold;  /* mean distance over horizon that opens a sector [-]   default 1 */
  int n_empty;       /* neighbouring empty sectors that make a surface; 0: 2 in 2D (as in
                        POROUS), 1 in 3D                                     default 0 */
  bw_pd_area area;   /* of surface particles, above                  default open sides */
  bool walled[3][2]; /* [direction][lower, upper]: this side of the box from lower
                        to upper is a wall the solid leans on                default false */
  double lower[3];   /* places of the lower walls [L]           required where walled */
  double upper[3];   /* places of the upper walls [L]           required where walled */
} bw_pd_interface_config;

/* Defaults as above, no walls. Pure. */
bw_pd_interface_config bw_pd_interface_config_default(void);

/* `pd` is borrowed until destroy. Finds the surface of the reference shape and that of now.
 * BW_EINPUT names the value; BW_EMEM. Collective. */
bw_status bw_pd_interface_create(bw_solid *pd, const bw_pd_interface_config *config,
                                 bw_pd_interface **out) BW_MUST_CHECK;
/* Releases everything and sets *pi to NULL; NULL is fine. Collective. */
void bw_pd_interface_destroy(bw_pd_interface **pi);

/* Follow the solid: surface set where bonds broke, normals and positions everywhere. Collective. */
bw_status bw_pd_interface_update(bw_pd_interface *pi) BW_MUST_CHECK;

/* The surface of this rank. */
typedef struct {
  size_t n;                /* surface particles of this rank */
  const int32_t *particle; /* (n) index into pd's own particles, rising */
  const double *X;         /* (n,3) position [L] */
  const double *N;         /* (n,3) unit outward normal, into the fluid */
  const double *A;         /* (n) area [L^2] */
  const double *H;         /* (n) how far above the centre, along N, the surface is [L] */
  const double *bend;      /* (n) change of N along the surface, sqrt(1/R_1^2 + 1/R_2^2), in the
                              reference shape [1/L]; 0 where it is not smooth */
  const bool *smooth;      /* (n) it is smooth there: N is one to a few degrees, not a ridge's or
                              an edge's, whose sides look elsewhere */
} bw_pd_surface;
/* The surface as of the last update; arrays are borrowed until the next. Local. */
bw_pd_surface bw_pd_interface_surface(const bw_pd_interface *pi);
/* Where that surface meets the fluid: one point for each of its rows where it is smooth and on new
 * crack faces, elsewhere one for each side of the lattice that was open in the reference shape, on
 * that side and turned with the body: a ridge, an edge, a sheet has sides towards different
 * pressures. A side has ds^2; sum A N over a body of such sides is nothing. With equal areas one
 * point for each row. */
typedef struct {
  size_t n;           /* points of this rank */
  const int32_t *row; /* (n) the row of bw_pd_surface it belongs to, rising */
  const double *N;    /* (n,3) unit outward normal */
  const double *A;    /* (n) area [L^2] */
  const double *H;    /* (n) how far from the particle's centre, along N, the surface is [L] */
  const bool *step;   /* (n) a side of a step: the surface there looks as N of its row does; false:
                         N is the surface's own, or a sheet's, whose sides are opposite */
} bw_pd_sides;
/* Those of the last update; arrays are borrowed until the next. Collective. */
bw_pd_sides bw_pd_interface_sides(bw_pd_interface *pi);
/* How many they can become while the set of particles stays. Local. */
size_t bw_pd_interface_most_sides(const bw_pd_interface *pi);
/* spin (n,3) of that surface [1/T]: half the curl of the present velocities around each particle,
 * from the line elements that carry its normal; exact for rigid motion, 0 where none can be told. A
 * point at X + a N moves with V + a spin x N. After an update. Collective. */
void bw_pd_interface_turn(bw_pd_interface *pi, double spin[]);
/* Moments (n,3) [M L^2/T^2] on that surface, as couples of forces on the ends of the same line
 * elements, added to force (count of pd, 3): without a resultant, with exactly their sum as moment,
 * and their power is that of the spin, sum moment.spin = sum force.V (the adjoint of turn). A force
 * F at X + a N is F on the particle and the moment a N x F. After an update. Collective. */
void bw_pd_interface_twist(bw_pd_interface *pi, const double moment[], double force[]);
/* Whether each own particle is surface, (count of pd); borrowed until the next update. Local. */
const bool *bw_pd_interface_is_surface(const bw_pd_interface *pi);

/* Area of the reference shape [L^2], all ranks: ds^2 sum over its open lattice faces f of
 * |n_f.e_f|, n_f the normal at the face's own middle. Local. */
double bw_pd_interface_reference_area(const bw_pd_interface *pi);

/* A piece whose particles are joined by intact bonds. */
typedef struct {
  int64_t label;      /* smallest global id in it */
  int64_t particles;  /* how many, on all ranks */
  double mass;        /* [M] */
  double centre[3];   /* [L]; of the image its particle `label` is in (periodic directions) */
  double velocity[3]; /* of the centre [L/T] */
  double spin[3];     /* I^-1 L [1/T]; 0 about axes without inertia (single particles, rods) */
} bw_pd_fragment;

/* The pieces that a body is in. No rank holds the list of all: each piece belongs to the rank of
 * the particle whose id is its label, so that a rank has no more pieces than particles. */
enum { BW_PD_FRAGMENT_LARGEST = 16 };
typedef struct {
  int64_t total;    /* pieces on all ranks */
  size_t n_largest; /* entries of `largest`: the lesser of total and BW_PD_FRAGMENT_LARGEST */
  bw_pd_fragment largest[BW_PD_FRAGMENT_LARGEST]; /* on all ranks the same: most particles first, of
                                                     equal ones the smaller label */
  size_t n;                                       /* pieces that belong to this rank */
  bw_pd_fragment *own; /* (n) in the same order; see bw_pd_fragment_release */
} bw_pd_fragments;

/* Pieces connected by intact bonds, as they are now. label (count of pd): the piece of each own
 * particle; may be NULL. *out is filled, owned by the caller (bw_pd_fragment_release, also after a
 * failure); NULL where only labels are wanted. The centre of a piece that meets itself through a
 * periodic direction depends on where it is cut there. Sums over particles are in order of ranks.
 * BW_EMEM on all ranks. Collective. */
bw_status bw_pd_interface_fragments(bw_pd_interface *pi, int64_t label[],
                                    bw_pd_fragments *out) BW_MUST_CHECK;

/* Bodies: particles connected by bonds, whether or not these hold. label (count of pd): the
 * smallest id in the body of each own particle. BW_EMEM on all ranks. Collective. */
bw_status bw_pd_interface_bodies(bw_pd_interface *pi, int64_t label[]) BW_MUST_CHECK;

/* Free what *f owns and clear it; a cleared one is fine. Local. */
void bw_pd_fragment_release(bw_pd_fragments *f);

/* Hand all pieces of all ranks, in the order of `largest`, to visit(context, n, piece) on rank 0,
 * some at a time: it never holds more than a thousand of each rank. `visit` is not called on the
 * other ranks. BW_EMEM on all ranks. Collective. */
bw_status bw_pd_fragment_visit(const bw_comm *comm, const bw_pd_fragments *f,
                               void (*visit)(void *context, size_t n, const bw_pd_fragment piece[]),
                               void *context) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
