/* pd_interface_internal.h -- shared by the sources of pd_interface only. */
#pragma once
#include "bw_pd_interface.h"

enum { BW_PD_INTERFACE__SECTORS = 24 }; /* 3D; 8 of them are used in 2D */

/* Directions of the stencil of a level and the sectors they belong to. `slot_at` maps an offset in
 * `unit` (each component -reach..reach) to its slot, -1: none. */
typedef struct {
  int dims, sectors, slots, reach;
  int level, finest;   /* of the owner; of the body's finest particles */
  double ds, family;   /* spacing; radius of the family [L] */
  double unit;         /* of an offset [L]: ds, with several levels half of the finest one */
  double axes[3][3];   /* lattice directions */
  double *xi;          /* (slots,3) [L] */
  double *fraction;    /* (slots) part of the partner's cell in the horizon, over the own volume */
  uint8_t *other;      /* (slots) level of the partner */
  uint8_t *faces;      /* (slots) bit 2 r + (upper side): touches the own cell's face there */
  uint32_t *sector_of; /* (slots) bit s: the direction lies in sector s */
  int16_t *slot_at;    /* ((2 reach + 1)^3) */
  uint32_t adjacent[BW_PD_INTERFACE__SECTORS];
  double direction[BW_PD_INTERFACE__SECTORS][3]; /* middle of the sector, unit */
} bw_pd_interface__stencil;

bw_status bw_pd_interface__stencil_create(const bw_solid *pd, int level,
                                          bw_pd_interface__stencil *s);
void bw_pd_interface__stencil_release(bw_pd_interface__stencil *s);

/* Slot of the direction xi [L] to a particle of a level; -1: none, -2: no such particle can be
 * there (within a quarter of a unit). Local. */
int bw_pd_interface__slot_of(const bw_pd_interface__stencil *s, const double xi[3], int other);

/* The sectors of `empty` that touch its lowest one, directly or through others of it. Local. */
uint32_t bw_pd_interface__group(const bw_pd_interface__stencil *s, uint32_t empty);

/* Is there a set of n_empty neighbouring sectors in the bits of `empty`? Local. */
bool bw_pd_interface__is_open(const bw_pd_interface__stencil *s, uint32_t empty, int n_empty);

/* A present partner: `partner` is its index in the extended arrays (-1: it stands at xi). `cross`
 * has two bits per direction: 1, 2 when it is its image in the lower, upper wall. */
typedef struct {
  int32_t partner;
  int16_t slot;
  uint8_t cross;
} bw_pd_interface__near;

/* The line elements that carry eight successive rows of the list (bw_pd_lines.c). */
enum { BW_PD_INTERFACE__ROWS = 8 };
typedef struct {
  int32_t end[3][2][BW_PD_INTERFACE__ROWS]; /* storage places: to, from */
  double hold[3][BW_PD_INTERFACE__ROWS];    /* n0.a0: what stays along each [L] */
  uint8_t steps[3][BW_PD_INTERFACE__ROWS];  /* lattice steps between the ends; 0: missing */
  double spacing[BW_PD_INTERFACE__ROWS];    /* of the row's particle [L] */
  bool whole;                               /* none is missing in any row */
} bw_pd_interface__lines;

enum { BW_PD_INTERFACE__PASSES = 4 };

/* Walls that the body leans on. */
typedef struct {
  bool *outside;    /* (n) beyond a wall: never surface */
  bool *leans;      /* (n) its family reaches beyond a wall */
  bool *off;        /* (n) it leans no more: has moved from the wall */
  int32_t *leaning; /* (n_leaning) those that lean */
  size_t n_leaning;
} bw_pd_interface__walls;

/* What may make or end a surface. */
typedef struct {
  int64_t events;   /* of pd when `broken` was read */
  uint16_t *broken; /* (n) broken bonds */
  uint16_t *fresh;  /* (n) scratch: the same now */
  bool *undecided;  /* (n) surface or not depends on gaps */
  int32_t *gap;     /* (n_gap) those that are */
  size_t n_gap;
} bw_pd_interface__watch;

/* Scratch, of the particle resolved last. */
typedef struct {
  bw_pd_link *link;            /* (slots) */
  uint8_t *state;              /* (slots) enum below */
  bw_pd_interface__near *near; /* (slots) who is there, where state is not ABSENT */
  double *place;               /* (slots,3) relative to the particle */
} bw_pd_interface__seen;

/* Partners of surface particles, in rows. */
typedef struct {
  bw_pd_interface__near *pool; /* (pool_n of pool_room) */
  size_t pool_n, pool_room;
  size_t *row;                /* (n) where the row begins */
  uint16_t *row_n, *row_room; /* (n) its length and how long it may get; room 0: no row */
  bool *stale;                /* (n) the row has to be made anew */
} bw_pd_interface__rows;

/* The surface as it is now: a row per particle of the list. */
typedef struct {
  int32_t *list; /* (n_list) which particle */
  size_t n_list;
  double *position, *list_normal; /* (n_list,3) */
  double *area, *height;          /* (n_list) */
  double *bend;                   /* (n_list) */
  bool *smooth;                   /* (n_list) */
  bw_pd_interface__lines *lines;  /* (n_list / 8, rounded up) */
  double *off_lattice; /* (the same,3,3,8) of a cloud: its line elements less the lattice's
                          [L]; NULL: a lattice */
} bw_pd_interface__shown;

/* Points of the surface that may look several ways. */
typedef struct {
  uint8_t *open;     /* (n) bit 2 r + (upper side): open in the reference shape; 0: one point */
  size_t n, room;    /* points now, and how many there can be */
  int32_t *row;      /* (room) */
  double *N, *A, *H; /* (room,3) (room) (room) */
  bool *step;        /* (room) a side of a step */
} bw_pd_interface__sides;

/* Normals of the reference shape as they are fitted. */
typedef struct {
  double *own_normal;                        /* (n,3) of the surface, 0 elsewhere */
  double *told[BW_PD_INTERFACE__PASSES + 1]; /* (n_extended,3) the same by 3.45 and after each pass
                                                of fits over it */
  bool *changed;                             /* (n_extended) since they were settled last */
  double *bend;                              /* (n) slope of the last fit [1/L]; 0: none */
  double (*side)[2];      /* (n_extended) height of the surface by each particle alone [L], area */
  double *lift;           /* (n) how far above that the mean of those about it is [L] */
  bool *touched, *border; /* (n) a partner changed; it has copies or images as partners */
  double *borne;          /* (n_extended,3) scratch: forces that bear moments */
} bw_pd_interface__fit;

struct bw_pd_interface {
  bw_solid *pd; /* borrowed */
  bw_pd_interface_config config;
  int n_stencil;
  bw_pd_interface__stencil *stencil; /* (n_stencil) a row per level */
  int64_t revision;                  /* of the solid that all this is for */
  size_t n, n_extended;              /* own particles; own and copies */
  double area_total;                 /* of the reference shape [L^2] */
  double *area_first;   /* (n) of those that are surface in the reference shape [L^2] */
  bool *surface;        /* (n) now */
  bool *first;          /* (n) in the reference shape */
  double *X0;           /* (n,3) */
  double *normal;       /* (n,3) unit normal 3.45 in the reference shape, of those that are or
                           were surface; else 0 */
  double *first_normal; /* (n,3) the same before anything broke */
  int32_t *anchor;      /* (n,6) ends of three line elements: extended particles, or h twice */
  uint8_t *steps;       /* (n,3) lattice steps between them */
  bool fresh_start;     /* nothing is known of the present shape yet */
  bw_pd_interface__walls wall;
  bw_pd_interface__watch watch;
  bw_pd_interface__seen seen;
  bw_pd_interface__rows rows;
  bw_pd_interface__shown now;
  bw_pd_interface__sides sides;
  bw_pd_interface__fit fit;
};

static inline double bw_pd_interface__dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Directions of an own particle. */
static inline const bw_pd_interface__stencil *bw_pd_interface__stencil_of(const bw_pd_interface *pi,
                                                                          size_t h)
{
  return pi->stencil + (pi->n_stencil > 1 ? bw_solid_level(pi->pd, h) : 0);
}

/* Mean distance that opens a sector of an own particle; area of one side of it, as of a crack face.
 * Local. */
static inline double bw_pd_interface__opening(const bw_pd_interface *pi, size_t h)
{
  return pi->config.threshold * bw_solid_horizon_of(pi->pd, h);
}

static inline double bw_pd_interface__side_area(const bw_pd_interface *pi, size_t h)
{
  const double ds = bw_solid_spacing(pi->pd, h);
  return ds * (pi->stencil->dims == 2 ? bw_solid_settings(pi->pd)->thickness : ds);
}

enum { BW_PD_INTERFACE__ABSENT, BW_PD_INTERFACE__INTACT, BW_PD_INTERFACE__BROKEN };

/* Everything anew, after the set of particles changed. Collective. */
bw_status bw_pd_interface__rebuild(bw_pd_interface *pi) BW_MUST_CHECK;

/* Who is around particle h: fills state and near; `reference`: all bonds intact. Directions across
 * a wall it leans on are filled with images. */
void bw_pd_interface__resolve(bw_pd_interface *pi, size_t h, bool reference);

/* Fills place of the particle resolved last, h; now NULL: in the reference shape. */
void bw_pd_interface__locate(bw_pd_interface *pi, size_t h, const bw_pd_motion *now);

/* Of h, resolved last: bits of the sectors where nothing intact is, and of those where nothing ever
 * was; located too: bits of its empty sectors (3.42). Local. */
void bw_pd_interface__bare_sectors(const bw_pd_interface *pi, size_t h, uint32_t *not_held,
                                   uint32_t *never);
uint32_t bw_pd_interface__empty_sectors(const bw_pd_interface *pi, size_t h);

/* Unit normal 3.45 of h, resolved last, in the reference shape; false, and n unchanged,
 * when its present partners balance. Local. */
bool bw_pd_interface__normal_of(const bw_pd_interface *pi, size_t h, double n[3]);

/* Has h, resolved last, a side that nobody ever touched? Local. */
bool bw_pd_interface__has_open_side(const bw_pd_interface *pi, size_t h);

/* Bits 2 r + (upper side) of the sides of h, resolved last, that nobody ever touched. Local. */
unsigned bw_pd_interface__open_sides(const bw_pd_interface *pi, size_t h);

/* Area [L^2] of the open lattice faces of the particle resolved last, each projected on the
 * normal there (reference shape). Local. */
double bw_pd_interface__open_area(const bw_pd_interface *pi, size_t h);

/* ds^2 sum over the open sides f of the particle resolved last of e_f.n [L^2]. Local. */
double bw_pd_interface__facing_area(const bw_pd_interface *pi, size_t h, const double n[3]);

/* Has h moved from a wall it leans on by more than opens a sector? Local. */
bool bw_pd_interface__moved_off(const bw_pd_interface *pi, size_t h, const bw_pd_motion *now);

/* bw_pd_normal.c. Of h, resolved last: its normal 3.45 (where partners balance that of the
 * reference shape, if there is none that of its empty sectors). */
void bw_pd_interface__tell_normal(bw_pd_interface *pi, size_t h, uint32_t empty);
/* own_normal of the surface: 3.45, or its fit where that is smooth. Collective. */
void bw_pd_interface__settle_normals(bw_pd_interface *pi);
/* Normal of a partner in rows (n_extended,3) of normals, an image's mirrored. Local. */
void bw_pd_interface__partner_normal(const bw_pd_interface__near *near, const double all[],
                                     double n[3]);
/* fit.touched: own particles that changed, or have a partner that did. Collective. */
void bw_pd_interface__spread_change(bw_pd_interface *pi);
/* Did the fits find the surface smooth at h? After settle_normals. Local. */
bool bw_pd_interface__is_smooth(const bw_pd_interface *pi, size_t h);

/* bw_pd_height.c. Heights of the listed surface, and where it is smooth. After settle_normals.
 * Collective. */
void bw_pd_interface__settle_heights(bw_pd_interface *pi);

/* bw_pd_lines.c. Of h, resolved last: where its line elements end. */
void bw_pd_interface__anchor(bw_pd_interface *pi, size_t h);
/* The lines of the listed surface and what they hold of own_normal. */
void bw_pd_interface__lay_lines(bw_pd_interface *pi, const bw_pd_motion *now);
/* list_normal: own_normal turned with the body. */
void bw_pd_interface__carry_normals(bw_pd_interface *pi, const bw_pd_motion *now);

/* N (8,3,6): sides of the block's rows as they look now, side 2 r + (upper) of the lattice. */
void bw_pd_interface__carry_sides(const bw_pd_interface *pi, size_t block, const bw_pd_motion *now,
                                  double N[BW_PD_INTERFACE__ROWS][6][3]);

/* bw_pd_sides.c: room for all that can be open. Local. */
bw_status bw_pd_interface__sides_create(bw_pd_interface *pi);

/* bw_pd_follow.c: is h, resolved last, surface? now NULL: in the reference shape. */
bool bw_pd_interface__judge(bw_pd_interface *pi, size_t h, const bw_pd_motion *now);
/* The list of surface particles, its areas, and rows, normals 3.45, anchors of the stale ones. */
void bw_pd_interface__renew(bw_pd_interface *pi, bool reference);
