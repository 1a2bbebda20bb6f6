/* pd_level.h -- what all particles of one spacing share: a row of the table of levels.
 *
 * Row l has the spacing ds/2^l. Whatever reads a spacing, a volume, a horizon or a stencil takes it
 * from the row of its particle (or block). In a body of several levels places are counted in half
 * spacings of the finest one, in which every cell has its centre at whole numbers: those of a
 * particle of level l are odd multiples of 2^(finest - l). */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { BW_PD_ROW = 8 }; /* constants of one direction in the kernels */

/* Column of a kernel row. The body fills geometry, the law its stiffness and limit. In a cloud,
 * where |xi| and Gamma follow from the places of both ends, the columns hold 1 for them. */
enum {
  BW_PD_XI = 0,        /* 0..2: xi [L] */
  BW_PD_R0 = 3,        /* |xi| [L] */
  BW_PD_STIFFNESS = 4, /* of the law: acceleration of the owner per change of length [1/T^2]; in a
                          cloud per stretch [L/T^2], still to be taken times Gamma */
  BW_PD_LIMIT2 = 5,    /* of the law: the squared length beyond which a bond breaks [L^2], or
                          another limit of its own */
  BW_PD_WEIGHT = 6,    /* Gamma dV [L^3] */
  BW_PD_MINUS_R0 = 7   /* -|xi| [L] */
};

/* The directions in which there can be a bond, x fastest: first to particles of the own level, then
 * to those of the next coarser level, then of the next finer one. */
typedef struct {
  int n;            /* directions */
  int same;         /* of them to particles of the own level */
  int reach;        /* largest component of an offset */
  double unit;      /* of an offset [L]: ds, with several levels half of the finest ds */
  int32_t *offset;  /* (n,3) steps of that unit */
  double *xi;       /* (n,3) from site to site [L] */
  double *r0;       /* (n) |xi| [L] */
  double *fraction; /* (n) Gamma [-]; between levels what takes its place beside the micromodulus of
                       the coarser end (pd_stencil_levels.c) */
  double *volume;   /* (n) part of the partner's cell in the owner's horizon, over dv of the owner
                       [-]: fraction, but between levels */
  double *tough;    /* (n) square of the critical stretch over that of the coarser end [-] */
  uint8_t *other;   /* (n) level at the other end */
  bool *sure;       /* (n) in a cloud: a bond wherever both sites are occupied */
  int16_t *number;  /* ((2 reach + 1)^3) direction of an offset, -1: none; NULL: several levels */
} bw_pd_stencil;

/* A row of the table of levels. */
typedef struct {
  double ds;             /* spacing [L] */
  double stiff;          /* micromodulus over that of level 0 [-]: (horizon_0/horizon)^(D+1), or of
                            families of one horizon what gives them the same modulus */
  double stretch;        /* critical stretch over that of level 0: (horizon_0/horizon)^1/2 [-] */
  double horizon;        /* m ds [L] */
  double reach;          /* of the family [L]: |xi| < reach */
  double dv;             /* volume of one particle [L^3] */
  double area;           /* of the face of a particle's cell [L^2] */
  bw_pd_stencil stencil; /* directions of a family */
  bw_real *row; /* (n_group, n_group, stencil.n, BW_PD_ROW) kernel rows: owner's group, other's */
} bw_pd_level;

/* The coarser of two rows of one table: constants of bonds between levels are told by it. */
static inline const bw_pd_level *bw_pd_level_coarser(const bw_pd_level *a, const bw_pd_level *b)
{
  return a < b ? a : b;
}

/* Whether the owner of a bond in a direction of its level's stencil is the end that is first in
 * lattice order: the last axis in which the two differ tells. */
static inline bool bw_pd_body_is_first(const bw_pd_stencil *stencil, int direction)
{
  const int32_t *o = stencil->offset + 3 * direction;
  return o[2] != 0 ? o[2] > 0 : o[1] != 0 ? o[1] > 0 : o[0] > 0;
}

#ifdef __cplusplus
}
#endif
