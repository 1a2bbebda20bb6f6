/* bw_pd_body.h -- a peridynamic body: lattice, families, bonds that hold, motion.
 *
 * What every law of the solid stands on, and what the front (bw_solid.h) shows of it. Particles sit
 * on a uniform lattice, X0 = origin + axes.(site + 1/2) ds, site[3] integers, or, with `disorder`,
 * in a cloud around it (pd_cloud.c). The family of h holds the l with |xi| < horizon + ds/2 (POROUS
 * 3.32, ERRATA 2); every bond is kept from both ends, in blocks of the processor's vectors.
 * Shapes   vectors row-major (n,3); own particles are 0 .. n-1 in lattice order, then copies of
 *          what other ranks own and periodic images up to n_extended.
 * Units    any consistent set: [M], [L], [T]. */
#pragma once
#include "bw_comm.h"
#include "bw_real.h"
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_pd_body bw_pd_body; /* opaque; its sources and the laws see pd_body.h */
typedef struct bw_pd_law bw_pd_law;   /* pd_law.h: how a body answers to its deformation */

/* Dimension and out-of-plane condition. */
typedef enum {
  BW_PD_3D,           /* three dimensions */
  BW_PD_PLANE_STRESS, /* one layer, free to contract across */
  BW_PD_PLANE_STRAIN  /* one layer, held across */
} bw_pd_geometry;

/* How much of a neighbour's cell counts as within the horizon. */
typedef enum {
  BW_PD_FRACTION_LINEAR, /* POROUS 3.33 with ERRATA 2; refused in 3D */
  BW_PD_FRACTION_EXACT,  /* the part of the cube (square) inside the ball (disc) */
  BW_PD_FRACTION_NONE,   /* all of it */
  BW_PD_FRACTION_DEFAULT /* exact in 3D, linear in 2D */
} bw_pd_volume_fraction;

/* Which neighbours are family. */
typedef enum {
  BW_PD_REACH_HALF_CELL, /* |xi| < horizon + ds/2 */
  BW_PD_REACH_HORIZON    /* |xi| < horizon */
} bw_pd_family_reach;

/* What a particle is, bits that may be joined by | but for retired, which is not for create. */
enum {
  BW_PD_FREE = 0,        /* moves by the forces on it */
  BW_PD_PRESCRIBED = 1,  /* moves with a given velocity: the ghost layers of POROUS 3.3.11 */
  BW_PD_UNBREAKABLE = 2, /* keeps its bonds, whatever their stretch */
  BW_PD_RETIRED = 4      /* has left the mechanics and flies on */
};

enum { BW_PD_GROUPS = 16 }; /* groups of particles in one body, at most */
enum { BW_PD_BOXES = 16 };  /* boxes of finer particles, at most */
enum { BW_PD_FINEST = 6 };  /* level of the finest particles, at most */

/* How two particles of different spacing pull at each other, with c, Gamma of either's own horizon
 * and of the other's cell. */
typedef enum {
  BW_PD_JUMP_BALANCED,  /* as dual, times a factor per bond: no force under a uniform strain */
  BW_PD_JUMP_DUAL,      /* (c_h Gamma_hl + c_l Gamma_lh)/2: momentum is kept, ghost forces stay */
  BW_PD_JUMP_ONE_SIDED, /* each end c_h Gamma_hl of its own: momentum is not kept */
} bw_pd_jump;

/* Where a body is finer. Cells of the level before that the box meets are split in two each way;
 * around it lie belts of the levels between, each a horizon of the next coarser one wide. */
typedef struct {
  int level;                 /* 1: half the spacing, 2: a quarter, ... */
  double lower[3], upper[3]; /* along the axes of the lattice: lower < axes.X < upper [L]; in 2D
                                the third is not read */
} bw_pd_box;

/* The level of every cell of the coarsest lattice: all that is in a cell is of its level. Levels of
 * cells within a horizon of each other, of the coarser one's level, differ by one at most
 * (bw_pd_levels_balance sees to that). */
typedef struct {
  int finest;       /* level of the finest particles there may be, 1 .. BW_PD_FINEST */
  int32_t lower[3]; /* lattice site of the first cell */
  int32_t size[3];  /* cells each way */
  uint8_t *level;   /* (size[2], size[1], size[0]) 0 .. finest */
} bw_pd_map;

/* The boxes of a body, and how bonds between two spacings are. */
typedef struct {
  int n;                      /* boxes; 0: one level                          default 0 */
  bw_pd_box box[BW_PD_BOXES]; /* where they are, several may meet */
  const bw_pd_map *map;       /* in place of boxes, borrowed by create        default NULL */
  bw_pd_jump jump;            /* bonds between levels                  default balanced */
  bool same_horizon;          /* finer particles keep the horizon of level 0: they have more
                                 neighbours (m-refinement; else delta-refinement, in which horizon
                                 and spacing shrink together). For comparison: costs 2^dimension
                                 more per level                        default false */
  bool later;                 /* another body's motion goes to this one: the law prepares nothing
                                 that its settle makes                       default false */
} bw_pd_finer;

/* What the particles of one group are made of. */
typedef struct {
  double rho; /* density [M/L^3] */
  double E;   /* Young's modulus [M/(L T^2)] */
  double nu;  /* Poisson's ratio [-]; NaN: the law's own, where it has one */
  double G0;  /* fracture energy [M/T^2]; INFINITY: it does not break */
} bw_pd_material;

/* What a body is, whatever its law. */
typedef struct {
  bw_pd_geometry geometry;               /* dimension and plane condition */
  double ds;                             /* lattice spacing [L] */
  double thickness;                      /* of the layer in 2D [L] */
  double horizon_ratio;                  /* m = horizon/ds [-], 1 .. 12 */
  bw_pd_volume_fraction volume_fraction; /* of cells that the horizon cuts */
  bw_pd_family_reach family_reach;       /* who is family */
  double disorder;       /* particles start up to this many ds off their sites, 0.4 at most */
  int32_t disorder_seed; /* another number, another cloud */
  double origin[3];      /* of the lattice [L] */
  double axes[3][3];     /* rows: lattice directions, unit vectors at right angles */
  double period[3];      /* per lattice direction [L], whole numbers of ds; 0: not periodic */
  int n_group;           /* groups, 1 .. BW_PD_GROUPS */
  bw_pd_material material[BW_PD_GROUPS];       /* of each group */
  double joint_G0[BW_PD_GROUPS][BW_PD_GROUPS]; /* of bonds between two groups, symmetric [M/T^2];
                                                   NaN: the smaller of the two */
  bw_pd_finer finer;                           /* levels of finer particles */
} bw_pd_body_config;

/* What one rank gives to a body that is made: its part of the sites, any division will do. The
 * global id of a particle is its row in the lists of all ranks joined in rank order, after cells
 * that lie in a box have been split (bw_pd_body_config.finer). */
typedef struct {
  int64_t n;            /* sites that this rank gives; 0 is fine */
  const int32_t *site;  /* (n,3) */
  const uint8_t *kind;  /* (n) bits as above; NULL: free */
  const uint8_t *group; /* (n) rows of material; NULL: 0 */
} bw_pd_sites;

/* A bond of a particle as seen from it, its owner. */
typedef struct {
  int32_t neighbour; /* index into own particles and copies */
  int16_t slot;      /* number of the bond's direction in the stencil */
  bool intact;       /* it still holds */
} bw_pd_link;

/* Own particles, then copies of what other ranks own and periodic images. */
typedef struct {
  size_t n;          /* own and copies */
  const int64_t *id; /* (n) global ids */
  const bw_real *X;  /* (n,3) present positions, copies shifted to where they act [L] */
} bw_pd_extended;

/* The motion of own particles and copies, where the body keeps it: of the extended particle e it is
 * in u[k][place[e]] and v[k][place[e]], k = 0 .. 2. Borrowed. */
typedef struct {
  const int32_t *place; /* (n_extended) storage places */
  const bw_real *u[3];  /* displacement [L] */
  const bw_real *v[3];  /* velocity [L/T], NULL unless asked for */
} bw_pd_motion;

#ifdef __cplusplus
}
#endif
