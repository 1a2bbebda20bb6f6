/* pd_body.h -- the inside of a body: for its own sources, the laws, contact, levels and tools.
 *
 * Storage. Own particles and copies of others' (halo and periodic images) lie in one numbering,
 * the storage, in lattice order: the bounding box of their sites with holes where it is well
 * filled, without holes otherwise. Which axis is fastest, bw_pd_body_axes says. Displacements are
 * stored there, so the neighbours of successive owners in one lattice direction are contiguous
 * nearly always.
 *
 * Bonds. A block is BW_PD_LANES successive storage places, some of them own particles. A slot is
 * one direction of a block: where the neighbours start and which of the bonds exist (family) and
 * hold (mask). Where neighbours of one direction are not contiguous, the block has several slots
 * of that direction with disjoint families. A block's slots are in stencil order, so the sum over
 * a family runs in the same order on any number of ranks.
 *
 * Levels. The levels of a body lie one after the other in the storage, each in lattice order, but
 * that of a row of a finer level the particles with even sites come first, then those with odd
 * ones. Neighbours of successive owners are then contiguous across levels, too: a bond between
 * levels is a slot like another one, with directions of its own (pd_level.h). */
#pragma once
#include "bw_exchange.h"
#include "bw_particles_copies.h"
#include "bw_particles_map.h"
#include "bw_pd_body.h"
#include "pd_level.h"
#include "pd_refine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Owners per block: the width of the processor's vectors (at most 8: masks are bytes). What is
 * built on an installed library gets the number of that library (cmake/install.cmake). */
#ifdef BW_SINGLE
#define BW_PD_WIDE   8
#define BW_PD_NARROW 4
#else
#define BW_PD_WIDE   4
#define BW_PD_NARROW 2
#endif
#ifndef BW_PD_LANES
#if defined(__AVX512VL__)
#define BW_PD_LANES 8
#elif defined(__AVX__)
#define BW_PD_LANES BW_PD_WIDE
#else
#define BW_PD_LANES BW_PD_NARROW
#endif
#endif

/* A name with this number in it, defined by the library: see pd_law.h. */
#define BW_PD_LANES_NAME_OF(lanes) bw_pd_body_of_##lanes##_lanes
#define BW_PD_LANES_NAME(lanes)    BW_PD_LANES_NAME_OF(lanes)
extern const char BW_PD_LANES_NAME(BW_PD_LANES);

enum { BW_PD_PAD = 16 }; /* unused places before and after a storage array: loads may overrun */

/* A bond before any load. */
typedef struct {
  double xi[3];    /* from owner to partner [L] */
  double r0;       /* |xi| [L] */
  double fraction; /* Gamma: the part of the partner's cell that counts [-] */
} bw_pd_rest;

enum { BW_PD_MIXED = 255 }; /* group of a block where groups meet */
/* BW_PD_LANES successive storage places, some of them own particles. */
typedef struct {
  int32_t first; /* place of lane 0 */
  int32_t own;   /* own particle of the first lane set in mask; the others follow */
  uint32_t slot; /* first slot; the block's last one is before the next block's first */
  uint8_t mask;  /* lanes that are own particles */
  uint8_t gone;  /* lanes that are retired; all of mask: the block costs nothing */
  bool broken;   /* a bond of it broke */
  uint8_t group; /* of all its particles and their neighbours; BW_PD_MIXED: they differ */
  uint8_t level; /* of all its particles */
  int32_t exact; /* first slot's row of bonds.exact; -1: its bonds have none */
} bw_pd_block;

/* One direction of a block. */
typedef struct {
  int32_t base;       /* storage place of lane 0's neighbour; lane k's is base + k */
  uint16_t direction; /* row of the stencil */
  uint8_t mask;       /* lanes whose bond holds */
  uint8_t family;     /* lanes whose bond existed at the start */
} bw_pd_slot;

/* Own particles own .. own + n - 1 lie at the storage places place .. place + n - 1. */
typedef struct {
  int32_t place, own, n; /* first place, first particle, how many */
} bw_pd_run;

/* Who is where. Arrays have n_extended rows, own particles first, but for occupant. */
typedef struct {
  int64_t total;     /* particles of all ranks */
  int axis[3];       /* of the lattice order, fastest first */
  int32_t *site;     /* (.,3), images shifted; with several levels places as pd_level.h says */
  uint8_t *level;    /* row of the table of levels; NULL: all of them 0 */
  int64_t *id;       /* global ids */
  uint8_t *kind;     /* bits: BW_PD_PRESCRIBED, ... */
  uint8_t *group;    /* row of config.material */
  int32_t *place;    /* storage place */
  size_t n_storage;  /* places */
  int32_t *occupant; /* (n_storage) extended index, -1: hole */
  bw_real *shift[3]; /* storage: reference place from its site [L]; NULL: a lattice */
  bw_real *weight;   /* (n) mass over that of the first group's on level 0 [-]; NULL: all 1 */
} bw_pd_points;

/* Copies of what others own, and images. */
typedef struct {
  bw_particles_copies *copies; /* the plan by which copies get values and give sums back */
  bw_real *extended_X;         /* (n_extended,3), made on demand */
} bw_pd_halo;

/* Who is bonded to whom. */
typedef struct {
  size_t n_block, n_slot, n_run;
  bw_pd_block *block; /* (n_block + 1), in the order of own particles; of the last one slot only */
  bw_pd_slot *slot;   /* (n_slot) */
  bw_pd_run *run;     /* (n_run) */
  uint32_t *hit;      /* (n_block) blocks where a bond is beyond its limit */
  size_t n_hit;       /* how many hit holds */
  uint16_t *factor;   /* (n_slot, BW_PD_LANES) of a law that keeps a factor per bond; NULL: none */
  bw_real *exact;     /* (n_exact, BW_PD_LANES) factors of bonds near jumps between levels, slots of
                         the blocks that have some, one block after the other; NULL: none */
  size_t n_exact;     /* rows of it */
  int64_t astray;     /* bonds beyond their limit above the finest level, which none may be */
  int64_t astray_id;  /* the particle at one end of the last one */
  int64_t directed;   /* bonds at the start, from both ends, of this rank */
  int64_t events;     /* bonds broken (or mended by a restart) so far */
  double released;    /* energy that bonds held when they broke, of this rank [M L^2/T^2] */
} bw_pd_bonds;

/* Who moves as told. */
typedef struct {
  bw_real *mobile;   /* (n) 1, or 0 when prescribed or retired */
  size_t n;          /* prescribed particles */
  int32_t *particle; /* (n) own particles */
  double *velocity;  /* (n,3) [L/T] */
} bw_pd_held;

/* What acts besides the bonds, accelerations of the own particles [L/T^2]. */
typedef struct {
  bw_real *f[3];     /* external force / rho */
  bw_real *extra[3]; /* (contact + damping)/rho */
  bw_real *damp[3];  /* damping/rho */
} bw_pd_forces;

/* Coefficients of damping (ERRATA 4). */
typedef struct {
  double pair;           /* [M/(L^6 T)] */
  double mean, absolute; /* to the mean of the family, absolute [M/(L^3 T)] */
  double most_weight;    /* largest eigenvalue of sum_l e e Gamma dV over particles [L^3] */
} bw_pd_dampings;

enum { BW_PD_FIELDS = 32 };             /* fields of a law, at most */
typedef struct bw_pd_field bw_pd_field; /* pd_law.h */
typedef struct {
  int n;            /* at most BW_PD_FIELDS */
  bw_pd_field *row; /* (n) */
} bw_pd_fields;

struct bw_pd_body {
  const bw_comm *comm;      /* borrowed */
  bw_pd_body_config config; /* as asked for, defaults and Poisson's ratio resolved */
  int dimension;            /* 2 or 3 */
  int finest;               /* level of the finest particles; 0: one level */
  bool mapped;              /* levels are by a map */
  bw_pd_level *level;       /* (finest + 1) */
  int directions;           /* largest number of directions of a level */
  size_t n, n_extended;     /* own particles; own and copies */
  bw_pd_points points;      /* who is where */
  bw_pd_halo halo;          /* what others own */
  bw_pd_bonds bonds;        /* who is bonded to whom */
  bw_real *u[3],
      *vs[3];           /* storage: displacement [L]; velocity of own and copies, on demand [L/T] */
  bw_real *v[3], *a[3]; /* own: velocity [L/T], internal force / rho [L/T^2] */
  bw_pd_forces load;    /* what acts besides the bonds */
  bw_pd_held held;      /* who moves as told */
  bw_pd_dampings damping;
  bool current;         /* copies and a are those of u, v */
  bool breakage;        /* bonds may break */
  int64_t revision;     /* see bw_pd_body_touch */
  const bw_pd_law *law; /* borrowed */
  void *state;          /* of the law */
  double frequency2;    /* bound of the squared largest frequency without damping [1/T^2] */
  bw_pd_fields fields;  /* of the law */
};

/* pd_storage.c */

/* A storage array of n places, with BW_PD_PAD more before and after, zero everywhere. The caller
 * owns it, and releases it by the second (which sets it to NULL; NULL is fine). BW_EMEM. Local. */
bw_status bw_pd_body_storage_array(size_t n, bw_real **out) BW_MUST_CHECK;
void bw_pd_body_release_storage_array(bw_real **array);

/* pd_create.c */

/* Particles, families and bonds of the sites that the ranks give, with the constants of the law.
 * `comm` and `law` are borrowed until destroy, `options` (the law's) and `given` during the call.
 * *out is the caller's, NULL after a failure. BW_EINPUT names the value; BW_EMEM. Collective. */
bw_status bw_pd_body_create(const bw_comm *comm, const bw_pd_body_config *config,
                            const bw_pd_law *law, const void *options, const bw_pd_sites *given,
                            bw_pd_body **out) BW_MUST_CHECK;
void bw_pd_body_destroy(bw_pd_body **pd); /* NULL is fine. Collective. */

/* pd_config.c */

/* Refuses what no law could be asked for (BW_EINPUT). Local. */
bw_status bw_pd_body_check(const bw_pd_body_config *config) BW_MUST_CHECK;
/* The table of levels, without stencils. BW_EMEM. Local. */
bw_status bw_pd_body_levels(bw_pd_body *pd) BW_MUST_CHECK;
/* Poisson's ratio of a network of bonds: 1/3 in plane stress, else 1/4 (ERRATA 14). Local. */
double bw_pd_body_natural_poisson(bw_pd_geometry geometry);

/* pd_fraction.c: the part of the square or cube at `offset` (3, in ds) within the distance m (in
 * ds) of the origin, 0 .. 1. BW_EMEM, BW_EDIVERGED of the quadrature. Local. */
double bw_pd_body_fraction_area(double m, const double offset[3]);
bw_status bw_pd_body_fraction_volume(double m, const double offset[3],
                                     double *fraction) BW_MUST_CHECK;

/* pd_cloud.c: reference places off their sites */

/* pd->points.shift of all places, once they are numbered. BW_EMEM. Local. */
bw_status bw_pd_body_scatter(bw_pd_body *pd) BW_MUST_CHECK;
/* The bond in a direction of the stencil whose ends are off their sites by h and l [L]; or whose
 * ends are at the storage places h and l. Local. */
bw_pd_rest bw_pd_body_apart(const bw_pd_body *pd, int direction, const double h[3],
                            const double l[3]);
bw_pd_rest bw_pd_body_rest_of_cloud(const bw_pd_body *pd, int direction, int32_t h, int32_t l);
/* Means over the full families of a sample of sites: of the sums of Gamma, Gamma |xi| and
 * Gamma |xi|^2, lengths in ds. BW_EMEM. Local. */
bw_status bw_pd_body_cloud_means(const bw_pd_body *pd, double mean[3]) BW_MUST_CHECK;

/* pd_stencil.c */

/* How far a family reaches, in ds: m + 1/2 or m. Local. */
double bw_pd_body_family_reach(const bw_pd_body_config *config);
/* Fills the stencil of one level, with room for kernel rows. BW_EMEM, BW_EDIVERGED. Local. */
bw_status bw_pd_body_stencil(bw_pd_body *pd) BW_MUST_CHECK;
/* Room for n directions of level l. BW_EMEM. Local. */
bw_status bw_pd_body_stencil_room(bw_pd_body *pd, int l, int n) BW_MUST_CHECK;
void bw_pd_body_stencil_lengths(const bw_pd_body *pd, bw_pd_stencil *s); /* xi, r0 by offset */
/* Gamma of a cell at an offset in its own spacings, of m of them. BW_EMEM, BW_EDIVERGED. Local. */
bw_status bw_pd_body_fraction(const bw_pd_body *pd, double m, const double offset[3],
                              double *gamma) BW_MUST_CHECK;
/* pd_stencil_levels.c: the same of a body of several levels. BW_EMEM, BW_EDIVERGED. Local. */
bw_status bw_pd_body_stencil_levels(bw_pd_body *pd) BW_MUST_CHECK;

/* pd_order.c: rows of places in the order of the storage. BW_EMEM, BW_EINPUT: too wide. Local. */
bw_status bw_pd_body_order(const bw_pd_body *pd, size_t n, const int32_t site[],
                           const uint8_t level[], int32_t order[]) BW_MUST_CHECK;
/* Level of the particle at a place of a body of several levels. Local. */
uint8_t bw_pd_body_level_of_place(const bw_pd_body *pd, const int32_t site[3]);
/* Whether a direction of the stencil of level l leads from a place to a cell of its other level.
 * Local. */
bool bw_pd_body_leads(const bw_pd_body *pd, int l, int direction, const int32_t site[3]);
/* Row of the stencil of an offset in lattice steps; -1: none. Local. */
int bw_pd_body_direction(const bw_pd_stencil *stencil, const int32_t offset[3]);
/* The columns of the kernel rows that are geometry. Local. */
void bw_pd_body_rows(bw_pd_body *pd);

/* pd_axes.c: the axes of the lattice order of a body of so many sites each way, fastest first;
 * reach in steps. Local. */
void bw_pd_body_axes(const int64_t size[3], int reach, int axis[3]);

/* pd_halo.c */

/* Fills points and halo. near: site (shifted for images) -> extended index, to be destroyed by the
 * caller. BW_EINPUT for two on one site and for extents; BW_EMEM. Collective. */
bw_status bw_pd_body_distribute(bw_pd_body *pd, const bw_pd_refined *given,
                                bw_particles_map *near) BW_MUST_CHECK;
void bw_pd_body_refresh(bw_pd_body *pd, bool velocity); /* copies' u (and v). Collective. */
void bw_pd_body_fill_places(const bw_pd_body *pd,
                            bw_real *places); /* copies' values. Collective. */

/* pd_slots.c: storage places, runs, blocks and slots; near as above. BW_EINPUT for too many bonds
 * on one rank; BW_EMEM. Local. */
bw_status bw_pd_body_slots(bw_pd_body *pd, const bw_particles_map *near) BW_MUST_CHECK;

/* pd_damping.c */

bool bw_pd_body_damped(const bw_pd_body *pd); /* some coefficient is not zero. Local. */
/* load.damp of n blocks, list (n) of their numbers (NULL: of all), by all kinds of damping; u and v
 * of copies are current. Local. */
void bw_pd_body_damp(bw_pd_body *pd, size_t n, const uint32_t list[]);
/* Adds absolute damping alone to load.damp, after a sweep that did the pairs. Local. */
void bw_pd_body_damp_absolute(bw_pd_body *pd);
/* damping.most_weight. BW_EMEM. Collective. */
bw_status bw_pd_body_damping_bound(bw_pd_body *pd) BW_MUST_CHECK;

/* pd_links.c */

/* The bond of a lane of a slot is gone, seen from its owner; the half of its energy goes to
 * bonds.released. The other end cuts its own. Local. */
void bw_pd_body_cut(bw_pd_body *pd, bw_pd_block *block, bw_pd_slot *slot, int lane);
/* Present length of the bond of a lane of a slot [L]; h: its owner's storage place. Local. */
double bw_pd_body_length(const bw_pd_body *pd, int32_t h, const bw_pd_slot *slot, int lane,
                         const double xi[3]);
/* What bw_solid.h says of its functions of these names. */
void bw_pd_body_get_damage(const bw_pd_body *pd, double damage[]);
void bw_pd_body_get_broken(const bw_pd_body *pd, uint16_t broken[]);
int bw_pd_body_links(const bw_pd_body *pd, size_t h, bw_pd_link link[]);
bw_pd_extended bw_pd_body_get_extended(bw_pd_body *pd);
bw_pd_motion bw_pd_body_get_motion(bw_pd_body *pd, bool velocity);
void bw_pd_body_fill_extended(bw_pd_body *pd, size_t bytes, const void *own, void *all);
void bw_pd_body_sum_extended(bw_pd_body *pd, double *all);

/* pd_views.c: what bw_solid.h says of its functions of these names */
void bw_pd_body_get_reference(const bw_pd_body *pd, double X0[]);
void bw_pd_body_get_position(const bw_pd_body *pd, double X[]);
void bw_pd_body_get_velocity(const bw_pd_body *pd, double V[]);
void bw_pd_body_get_acceleration(const bw_pd_body *pd, double A[]);
void bw_pd_body_set_state(bw_pd_body *pd, const double X[], const double V[]);
void bw_pd_body_set_force(bw_pd_body *pd, const double F[]);
void bw_pd_body_set_prescribed(bw_pd_body *pd, const double V[]);
void bw_pd_body_set_damping(bw_pd_body *pd, double pair, double mean, double absolute);
/* The set of particles or their surface has changed: whoever keeps lists of particles (contact,
 * interface, coupler) makes them anew at its next update. On all ranks alike. Local. */
void bw_pd_body_touch(bw_pd_body *pd);
void bw_pd_body_adopt_prescribed(bw_pd_body *pd);   /* held.velocity from v */
size_t bw_pd_body_list_bytes(const bw_pd_body *pd); /* of slots and blocks */

/* First slot after a block's; a block whose particles are all retired has none. */
static inline uint32_t bw_pd_body_slot_end(const bw_pd_block *block)
{
  return block->gone == block->mask ? block->slot : block[1].slot;
}

/* Own particle of lane `lane` of a block. */
static inline int32_t bw_pd_body_owner(const bw_pd_block *block, int lane)
{
  return block->own + __builtin_popcount(block->mask & ((1u << lane) - 1u));
}

/* Group of who stands at a storage place; holes are of the first one. */
static inline int bw_pd_body_group_at(const bw_pd_body *pd, int32_t place)
{
  const int32_t e = pd->points.occupant[place];
  return e < 0 ? 0 : pd->points.group[e];
}

/* Material of an own particle or a copy. */
static inline const bw_pd_material *bw_pd_body_material(const bw_pd_body *pd, size_t e)
{
  return &pd->config.material[pd->points.group[e]];
}

/* The row of the table of levels of an own particle or a copy. */
static inline const bw_pd_level *bw_pd_body_level(const bw_pd_body *pd, size_t e)
{
  return pd->points.level == NULL ? pd->level : pd->level + pd->points.level[e];
}

/* The same of who is at a storage place. */
static inline const bw_pd_level *bw_pd_body_level_at(const bw_pd_body *pd, int32_t place)
{
  if (pd->points.level == NULL) return pd->level;
  const int32_t e = pd->points.occupant[place];
  return bw_pd_body_level(pd, e < 0 ? 0 : (size_t)e);
}

/* Mass of a particle of the first group on the first level [M]: that of another one is this times
 * its weight (bw_pd_body.weight). */
static inline double bw_pd_body_unit_mass(const bw_pd_body *pd)
{
  return pd->config.material[0].rho * pd->level[0].dv;
}

/* The row that all particles of a block share. */
static inline const bw_pd_level *bw_pd_body_level_of(const bw_pd_body *pd, const bw_pd_block *block)
{
  return pd->level + block->level;
}

/* Reference place of an own particle or a copy. */
static inline void bw_pd_body_reference(const bw_pd_body *pd, size_t e, double X0[3])
{
  const bw_pd_body_config *c = &pd->config;
  const int32_t *site = pd->points.site + 3 * e;
  for (int k = 0; k < 3; k++) {
    X0[k] = c->origin[k];
    for (int d = 0; d < pd->dimension; d++)
      X0[k] += pd->finest > 0 ? c->axes[d][k] * site[d] * pd->level->stencil.unit
                              : c->axes[d][k] * (site[d] + 0.5) * c->ds;
    if (pd->points.shift[k] != NULL) X0[k] += (double)pd->points.shift[k][pd->points.place[e]];
  }
}

/* The bond of the storage places h and l, l in a direction of the stencil from h. */
static inline bw_pd_rest bw_pd_body_rest(const bw_pd_body *pd, int direction, int32_t h, int32_t l)
{
  if (pd->config.disorder > 0) return bw_pd_body_rest_of_cloud(pd, direction, h, l);
  const bw_pd_stencil *s = &bw_pd_body_level_at(pd, h)->stencil;
  const double *xi = s->xi + 3 * direction;
  const bw_pd_rest rest = {{xi[0], xi[1], xi[2]}, s->r0[direction], s->fraction[direction]};
  return rest;
}

#ifdef __cplusplus
}
#endif
