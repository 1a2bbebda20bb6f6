/* pd_bond_internal.h -- shared by the sources of pd_bond only.
 *
 * Storage. Own particles and copies of others' (halo and periodic images) lie in one numbering,
 * the storage, in lattice order: the bounding box of their sites with holes where it is well
 * filled, without holes otherwise. Which axis is fastest, bw_pd_bond__axes says. Displacements are
 * stored there, so the neighbours of successive owners in one lattice direction are contiguous
 * nearly always.
 *
 * Bonds. A block is BW_PD_LANES successive storage places, some of them own particles. A slot is
 * one direction of a block: where the neighbours start and which of the bonds exist (family) and
 * hold (mask). Where neighbours of one direction are not contiguous, the block has several slots
 * of that direction with disjoint families. A block's slots are in stencil order, so the sum over
 * a family runs in the same order on any number of ranks. */
#pragma once
#include "bw_exchange.h"
#include "bw_pd_bond.h"

/* Owners per block: the width of the processor's vectors (at most 8: masks are bytes). */
#ifdef BW_SINGLE
#define BW_PD_WIDE   8
#define BW_PD_NARROW 4
#else
#define BW_PD_WIDE   4
#define BW_PD_NARROW 2
#endif
#if defined(__AVX512VL__)
#define BW_PD_LANES 8
#elif defined(__AVX__)
#define BW_PD_LANES BW_PD_WIDE
#else
#define BW_PD_LANES BW_PD_NARROW
#endif

/* Unit of the stored factors of bonds (surface correction `tensor`): 2^-14, 0 .. 4. */
#define BW_PD_ALPHA_UNIT (1.0 / 16384)

enum {
  BW_PD_PAD = 16, /* unused places before and after a storage array: loads may overrun */
  BW_PD_ROW = 8   /* constants of one direction in the kernels, see bw_pd_bond__constants */
};

/* Column of a kernel row. */
enum {
  BW_PD_XI = 0,        /* 0..2: xi */
  BW_PD_R0 = 3,        /* |xi| */
  BW_PD_STIFFNESS = 4, /* c0 Gamma dV / (rho |xi|), times 2 (volume), 1/2 (energy correction)
                          or BW_PD_ALPHA_UNIT (tensor) */
  BW_PD_LIMIT2 = 5,    /* (|xi| (1 + s0))^2 */
  BW_PD_WEIGHT = 6,    /* Gamma dV; in a cloud the last three are without Gamma and |xi| */
  BW_PD_MINUS_R0 = 7   /* -|xi| */
};

/* A bond before any load. */
typedef struct {
  double xi[3], r0, fraction; /* [L], |xi|, Gamma */
} bw_pd_rest;

/* In a cloud: the directions from site to site in which there can be a bond. */
typedef struct {
  int n;            /* directions */
  int reach;        /* largest component of an offset */
  int32_t *offset;  /* (n,3) lattice steps */
  double *xi;       /* (n,3) from site to site [L] */
  double *r0;       /* (n) |xi| [L] */
  double *fraction; /* (n) Gamma */
  bool *sure;       /* (n) */
  double *bulk;     /* (n) alpha of a full family: 1, unless the correction is by tensor */
  bw_real *row;     /* (n, BW_PD_ROW) */
  int16_t *number;  /* ((2 reach + 1)^3) direction of an offset, -1: none */
} bw_pd_stencil;

/* Lattice site -> number. Dense over a box, or a hash table when the box is too empty. */
typedef struct {
  bool dense;
  int64_t lower[3], size[3];
  int32_t *value; /* (cells) or (capacity); -1: none */
  uint64_t *key;  /* hash only */
  size_t capacity, used;
} bw_pd_map;

typedef struct {
  int32_t first; /* storage place of lane 0 */
  int32_t own;   /* own particle of the first lane set in mask; the others follow */
  uint32_t slot; /* first slot; the block's last one is before the next block's first */
  uint8_t mask;  /* lanes that are own particles */
  uint8_t gone;  /* lanes that are retired; all of mask: the block costs nothing */
  bool broken;   /* a bond of it broke */
} bw_pd_block;

typedef struct {
  int32_t base; /* storage place of lane 0's neighbour */
  uint16_t direction;
  uint8_t mask;   /* bonds that hold */
  uint8_t family; /* bonds that existed at the start */
} bw_pd_slot;

typedef struct {
  int32_t place, own, n; /* own particles own.. own+n-1 lie at storage place.. place+n-1 */
} bw_pd_run;

typedef struct bw_pd_contact bw_pd_contact;

struct bw_pd_bond {
  const bw_comm *comm;
  bw_pd_bond_config config;
  int dimension;              /* 2 or 3 */
  double horizon, c0, s0, dv; /* dv: volume of one particle */
  double full_volume;         /* V_0 of the volume method (3.44) */
  struct {
    double volume, moment, crossing; /* sums over a full family of Gamma dV times 1, |xi| and, for
                                        xi.n > 0, |xi| xi.n */
  } full;
  /* Largest eigenvalue over particles of sum_l e e times c0 alpha Gamma dV/|xi|, Gamma dV. */
  double most_stiffness, most_weight;
  double damping_pair, damping_mean, damping_absolute;
  bool breakage;
  bw_pd_stencil stencil;

  int axis[3];          /* of the lattice order, fastest first */
  size_t n, n_extended; /* own; own and copies */
  int64_t total;
  int32_t *site;  /* (n_extended,3), images shifted */
  int64_t *id;    /* (n_extended) */
  uint8_t *kind;  /* (n_extended) */
  int32_t *place; /* (n_extended) storage place */
  size_t n_storage;
  int32_t *occupant; /* (n_storage) extended index, -1: hole */

  bw_exchange *halo; /* copies ask, owners answer: used backward */
  size_t n_asked;
  int32_t *asked;          /* (n_asked) own particle of each answer */
  bw_real *reply, *answer; /* (n_asked,6), (copies,6) */
  bw_real *extended_X;     /* (n_extended,3), made on demand */

  size_t n_block, n_slot, n_run;
  bw_pd_block *block; /* (n_block + 1) */
  bw_pd_slot *slot;   /* (n_slot) */
  uint16_t *alpha;    /* (n_slot, BW_PD_LANES) factors of bonds, correction by tensor only */
  bw_pd_run *run;     /* (n_run) */
  uint32_t *hit;      /* (n_block) blocks where a bond is beyond s0 */
  size_t n_hit;

  bw_real *u[3], *vs[3], *w;          /* storage: displacement, velocity, surface factor */
  bw_real *shift[3];                  /* storage: reference place from its site; NULL: a lattice */
  bw_real *v[3], *a[3];               /* own: velocity, bond force / rho */
  bw_real *extra[3], *damp[3];        /* own: (contact + damping)/rho, damping/rho */
  bw_real *f[3];                      /* own: external force / rho */
  bw_real *v_before[3], *a_before[3]; /* own: RK3's previous stage */
  bw_real *mobile;                    /* own: 1, or 0 when prescribed */
  size_t n_prescribed;
  int32_t *prescribed;  /* (n_prescribed) own particles */
  double *prescribed_v; /* (n_prescribed,3) */
  bool current;         /* copies and a are those of u, v */
  bool loaded;          /* extra may differ from zero */
  bool restored;        /* a was given by set_restart */
  bw_pd_contact *contact;
  int n_wall;
  bw_pd_wall wall[BW_PD_WALLS];
  size_t n_retired;
  int32_t *retired; /* (n_retired of n) own particles */

  double done_damping, done_fracture, done_external; /* of this rank */
  double done_retired, done_wall[3];                 /* of this rank */
  double wall_force[3]; /* on the walls, of this rank, at the last evaluation [M L/T^2] */
  int64_t events, bonds_directed, precracked; /* precracked: directed, of this rank */
};

/* pd_bond_create.c: zeros, with BW_PD_PAD more before and after */
bw_status bw_pd_bond__storage_array(size_t n, bw_real **out);
void bw_pd_bond__release_storage_array(bw_real **array);

/* pd_bond_config.c */
bw_status bw_pd_bond__check_config(const bw_pd_bond_config *config);
void bw_pd_bond__material(bw_pd_bond *pd);
void bw_pd_bond__constants(bw_pd_bond *pd);

/* pd_bond_calibrate.c */
double bw_pd_bond__classical_dilation(const bw_pd_bond_config *config); /* energy density/e^2 */
bw_status bw_pd_bond__full_family(bw_pd_bond *pd); /* its sums, once the stencil is there */
void bw_pd_bond__calibrate(bw_pd_bond *pd);

/* pd_bond_fraction.c: part of the cell at `offset` (in ds) within the distance m of the origin */
double bw_pd_bond__fraction_area(double m, const int32_t offset[3]);
bw_status bw_pd_bond__fraction_volume(double m, const int32_t offset[3], double *fraction);

/* pd_bond_cloud.c: reference places off their sites */
bw_status bw_pd_bond__scatter(bw_pd_bond *pd); /* shift of all places, once they are numbered */
/* The bond in a direction of the stencil whose ends are off their sites by h and l [L]. */
bw_pd_rest bw_pd_bond__apart(const bw_pd_bond *pd, int direction, const double h[3],
                             const double l[3]);
bw_pd_rest bw_pd_bond__rest_of_cloud(const bw_pd_bond *pd, int direction, int32_t h, int32_t l);
/* Means over the full families of a sample of sites: of the sums of Gamma, Gamma |xi| and
 * Gamma |xi|^2, lengths in ds. */
bw_status bw_pd_bond__cloud_means(const bw_pd_bond *pd, double mean[3]);

/* pd_bond_stencil.c */
double bw_pd_bond__family_reach(const bw_pd_bond_config *config); /* in ds */
bw_status bw_pd_bond__stencil(bw_pd_bond *pd);
int bw_pd_bond__direction(const bw_pd_stencil *stencil, const int32_t offset[3]);

/* pd_bond_map.c */
bw_status bw_pd_map_create(size_t n, const int32_t lower[3], const int32_t upper[3],
                           bw_pd_map *map);
void bw_pd_map_destroy(bw_pd_map *map);
int32_t bw_pd_map_get(const bw_pd_map *map, const int32_t site[3]);
/* Returns in *found what was there (then nothing changes) or -1 (then value is stored). */
bw_status bw_pd_map_put(bw_pd_map *map, const int32_t site[3], int32_t value, int32_t *found);
void bw_pd_map_replace(bw_pd_map *map, const int32_t site[3], int32_t value);

/* pd_bond_partition.c: part[n] of `parts` compact blocks of equal counts; the axes of the lattice
 * order of a body of so many sites each way, fastest first */
bw_status bw_pd_bond__partition(int parts, size_t n, const int32_t site[], int32_t part[]);
void bw_pd_bond__axes(const int64_t size[3], int reach, int axis[3]);
bw_status bw_pd_bond__lattice_order(const int axis[3], size_t n, const int32_t site[],
                                    int32_t order[]);

/* pd_bond_halo.c */
bw_status bw_pd_bond__distribute(bw_pd_bond *pd, size_t n, const int32_t site[],
                                 const uint8_t kind[], bw_pd_map *near);
void bw_pd_bond__refresh(bw_pd_bond *pd, bool velocity);
void bw_pd_bond__fill_places(bw_pd_bond *pd, bw_real *places);

/* pd_bond_slots.c */
bw_status bw_pd_bond__slots(bw_pd_bond *pd, const bw_pd_map *near);
bw_status bw_pd_bond__surface_factors(bw_pd_bond *pd);
double bw_pd_bond__alpha(const bw_pd_bond *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                         int lane);

/* pd_bond_bounds.c: most_stiffness, most_weight. Collective. */
bw_status bw_pd_bond__bounds(bw_pd_bond *pd);

/* pd_bond_tensor.c: pd->alpha, stencil.bulk. Collective. */
bw_status bw_pd_bond__tensor(bw_pd_bond *pd);

/* pd_bond_force.c: a = L/rho; with check notes the blocks with a bond beyond s0; with damping fills
 * damp with the pair damping */
void bw_pd_bond__force(bw_pd_bond *pd, bool check, bool damping);
bool bw_pd_bond__break_hits(bw_pd_bond *pd);
double bw_pd_bond__elastic(const bw_pd_bond *pd); /* of this rank's halves [M L^2/T^2] */

/* pd_bond_damping.c: damp of `n` blocks (list NULL: all); absolute: adds that kind alone */
bool bw_pd_bond__damped(const bw_pd_bond *pd);
void bw_pd_bond__damping(bw_pd_bond *pd, size_t n, const uint32_t list[]);
void bw_pd_bond__damping_absolute(bw_pd_bond *pd);

/* pd_bond_break.c */
void bw_pd_bond__break(bw_pd_bond *pd, bw_pd_block *block, bw_pd_slot *slot, int lane);

/* pd_bond_contact.c, pd_bond_search.c */
bw_status bw_pd_bond__contact_create(bw_pd_bond *pd);
void bw_pd_bond__contact_destroy(bw_pd_bond *pd);
bw_status bw_pd_bond__contact_update(bw_pd_bond *pd); /* Collective. */
void bw_pd_bond__contact_force(bw_pd_bond *pd);       /* adds to extra; Collective */
double bw_pd_bond__contact_energy(bw_pd_bond *pd);    /* of this rank's halves; Collective */

/* pd_bond_retire.c */
void bw_pd_bond__retire_rows(bw_pd_bond *pd, const double rows[]); /* of a restart; Collective */
void bw_pd_bond__still_retired(bw_pd_bond *pd);                    /* no force on them */
double bw_pd_bond__elastic_of(const bw_pd_bond *pd, const bw_pd_block *block, uint8_t lanes_asked);

/* pd_bond_views.c */
void bw_pd_bond__adopt_prescribed(bw_pd_bond *pd);

/* pd_bond_step.c */
bw_status bw_pd_bond__evaluate(bw_pd_bond *pd, bool check);
void bw_pd_bond__impose(bw_pd_bond *pd);

/* First slot after a block's; a block whose particles are all retired has none. */
static inline uint32_t bw_pd_bond__slot_end(const bw_pd_block *block)
{
  return block->gone == block->mask ? block->slot : block[1].slot;
}

/* Own particle of lane `lane` of a block. */
static inline int32_t bw_pd_bond__owner(const bw_pd_block *block, int lane)
{
  return block->own + __builtin_popcount(block->mask & ((1u << lane) - 1u));
}

/* Reference place of an own particle or a copy. */
static inline void bw_pd_bond__reference(const bw_pd_bond *pd, size_t e, double X0[3])
{
  const bw_pd_bond_config *c = &pd->config;
  const int32_t *site = pd->site + 3 * e;
  for (int k = 0; k < 3; k++) {
    X0[k] = c->origin[k];
    for (int d = 0; d < pd->dimension; d++)
      X0[k] += c->axes[d][k] * (site[d] + 0.5) * c->ds;
    if (pd->shift[k] != NULL) X0[k] += (double)pd->shift[k][pd->place[e]];
  }
}

/* The bond of the storage places h and l, l in a direction of the stencil from h. */
static inline bw_pd_rest bw_pd_bond__rest(const bw_pd_bond *pd, int direction, int32_t h, int32_t l)
{
  if (pd->config.disorder > 0) return bw_pd_bond__rest_of_cloud(pd, direction, h, l);
  const double *xi = pd->stencil.xi + 3 * direction;
  return (bw_pd_rest){
      {xi[0], xi[1], xi[2]}, pd->stencil.r0[direction], pd->stencil.fraction[direction]};
}
