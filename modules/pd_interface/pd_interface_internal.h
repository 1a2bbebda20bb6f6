/* pd_interface_internal.h -- shared by the sources of pd_interface only. */
#pragma once
#include "bw_pd_interface.h"

enum { BW_PD_INTERFACE__SECTORS = 24 }; /* 3D; 8 of them are used in 2D */

/* Directions of the stencil and the sectors they belong to. `slot_at` maps a lattice offset
 * (each component -reach..reach) to its slot, -1: none. */
typedef struct {
  int dims, sectors, slots, reach;
  double ds, family;   /* spacing; radius of the family [L] */
  double axes[3][3];   /* lattice directions */
  double *xi;          /* (slots,3) [L] */
  double *fraction;    /* (slots) Gamma */
  uint32_t *sector_of; /* (slots) bit s: the direction lies in sector s */
  int16_t *slot_at;    /* ((2 reach + 1)^3) */
  uint32_t adjacent[BW_PD_INTERFACE__SECTORS];
  double direction[BW_PD_INTERFACE__SECTORS][3]; /* middle of the sector, unit */
} bw_pd_interface__stencil;

bw_status bw_pd_interface__stencil_create(const bw_pd_bond *pd, bw_pd_interface__stencil *s);
void bw_pd_interface__stencil_release(bw_pd_interface__stencil *s);

/* Slot of the direction xi [L]; -1: none, -2: xi is no lattice offset (within ds/4). Local. */
int bw_pd_interface__slot_of(const bw_pd_interface__stencil *s, const double xi[3]);

/* The sectors of `empty` that touch its lowest one, directly or through others of it. Local. */
uint32_t bw_pd_interface__group(const bw_pd_interface__stencil *s, uint32_t empty);

/* Is there a set of n_empty neighbouring sectors in the bits of `empty`? Local. */
bool bw_pd_interface__is_open(const bw_pd_interface__stencil *s, uint32_t empty, int n_empty);

struct bw_pd_interface {
  bw_pd_bond *pd; /* borrowed */
  bw_pd_interface_config config;
  bw_pd_interface__stencil stencil;
  size_t n;           /* own particles */
  double opening;     /* mean distance that opens a sector [L] */
  double area_total;  /* of the reference shape [L^2] */
  double area_new;    /* of a crack face, one side of a particle [L^2] */
  double *area_first; /* (n) of those that are surface in the reference shape [L^2] */
  int64_t events;     /* of pd when `damaged` was made */
  bool *surface;      /* (n) now */
  bool *first;        /* (n) in the reference shape */
  bool *outside;      /* (n) beyond a wall: never surface */
  int32_t *damaged;   /* (n_damaged) own particles with broken bonds */
  int32_t *leaning;   /* (n_leaning) own particles whose family reaches beyond a wall */
  size_t n_damaged, n_leaning;
  bool *leans;           /* (n) is it in `leaning`? */
  bool *off;             /* (n) it leans no more: has moved from the wall */
  double *X0;            /* (n,3) */
  double *normal;        /* (n,3) last unit normal of those that are or were surface; else 0 */
  bw_pd_bond_link *link; /* (slots) scratch */
  uint8_t *state;        /* (slots) scratch, enum below */
  double *place;         /* (slots,3) scratch: partner's position relative to the particle */
  int32_t *list;         /* (n_list) the surface, and its rows: (.,3) but area */
  size_t n_list;
  double *position, *velocity, *list_normal, *area;
  double *all_velocity; /* (n,3) */
  double *own_normal;   /* (n,3) of the surface, 0 elsewhere; for smoothing */
  double *all_normal;   /* (n_extended,3) */
  size_t n_extended;
};

enum { BW_PD_INTERFACE__ABSENT, BW_PD_INTERFACE__INTACT, BW_PD_INTERFACE__BROKEN };

/* Fill state and place of particle h: present ones from X (extended array), or, with X NULL, of
 * the reference shape (all bonds intact). Directions across a wall are filled with images. */
void bw_pd_interface__resolve(bw_pd_interface *pi, size_t h, const bw_real *X);

/* Of the particle resolved last: bits of its empty sectors; its unit normal (false and unchanged
 * when the neighbours balance); area [L^2] of its open lattice faces, each projected on the
 * normal there (reference shape). Local. */
uint32_t bw_pd_interface__empty_sectors(const bw_pd_interface *pi);
bool bw_pd_interface__normal(const bw_pd_interface *pi, double n[3]);
double bw_pd_interface__open_area(const bw_pd_interface *pi);

/* ds^2 sum over the open sides f of the particle resolved last of e_f.n [L^2]. Local. */
double bw_pd_interface__facing_area(const bw_pd_interface *pi, const double n[3]);

/* Has h moved from a wall it leans on by more than opens a sector? Local. */
bool bw_pd_interface__moved_off(const bw_pd_interface *pi, size_t h, const bw_real *X);
