/* pd_state_correspondence.h -- state of the correspondence law. */
#pragma once
#include "bw_pd_material.h"
#include "pd_state.h"

enum { BW_PD_REMEMBERED = 17 }; /* H 9, sigma 6, flow, dissipated */

typedef struct {
  bw_pd_state_correspondence_options options;
  bw_pd_material_point material[BW_PD_GROUPS], small[BW_PD_GROUPS]; /* the other: of small strain */
  double kappa[BW_PD_FINEST + 1]; /* of each level: tr K/d of a full family [L^5] */
  /* c of the central springs of each level, w c s per volume [M/(L^4 T^2)] */
  double spring[BW_PD_FINEST + 1][BW_PD_GROUPS];
  double s0[BW_PD_GROUPS][BW_PD_GROUPS]; /* of a bond as long as the horizon, on level 0 [-] */
  bool breakable, remembers;
  bw_real *inverse[6]; /* storage: K^-1, xx yy zz yz xz xy */
  bw_real *beta;       /* storage: beta; of a particle on springs minus their c */
  bw_real *whole;      /* storage: beta before anything flowed; NULL where nothing yields */
  bw_real *lately;     /* storage: what z held, over beta, when it last flowed; saved */
  bw_real *B[9];       /* storage: P K^-1 - beta H; copies after the first pass */
  bw_real *measure;    /* storage: part of the limit of stress or flow; copies too; or NULL */
  bool *cut;           /* (n_block) K is not that of all bonds of the start */
  int64_t seen;        /* bonds.events when K was made */
  bw_real *accepted[BW_PD_REMEMBERED]; /* storage: at the last step's end; saved; or NULL */
  bw_real *trial[BW_PD_REMEMBERED];    /* storage: at the last evaluation */
} bw_pd_correspondence;

static inline bw_pd_correspondence *bw_pd_correspondence_of(const bw_pd_body *pd)
{
  return (bw_pd_correspondence *)pd->state;
}

/* w of a bond of a particle of a level, q = |xi|/reach. */
static inline double bw_pd_correspondence_weight(const bw_pd_body *pd, const bw_pd_level *level,
                                                 double r0)
{
  const double q = r0 / level->reach;
  return bw_pd_correspondence_of(pd)->options.weight == BW_PD_STATE_UNIFORM
             ? 1
             : (1 - q) * (1 - q) * (1 + 2 * q);
}

/* What is left of mu as the secant of shear stress over shear strain, once a factor p of flow has
 * come to it: beta goes with it, or what keeps modes without energy away would hold the narrow
 * bands in which a material yields. */
static inline double bw_pd_correspondence_secant(const bw_pd_body *pd, int32_t h, double flow)
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_material_point *m = &o->material[bw_pd_body_group_at(pd, h)];
  return isfinite(m->yield.k) ? 1 / (1 + m->mu * flow / m->yield.k) : 1;
}

/* beta of a particle with this family. */
static inline double bw_pd_correspondence_beta(const bw_pd_body *pd, int32_t h, double kappa)
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const double beta = o->options.stabilisation * o->small[bw_pd_body_group_at(pd, h)].mu / kappa;
  return o->remembers ? beta * bw_pd_correspondence_secant(pd, h, (double)o->accepted[15][h])
                      : beta;
}

/* pd_state_correspondence.c: whether a bond is beyond its limit; what lanes that lost bonds
 * remember of H becomes that of the bonds that hold. Local. */
bool bw_pd_state__correspondence_beyond(const bw_pd_body *pd, const bw_pd_level *level,
                                        const bw_pd_walk *b);
void bw_pd_state__forget(bw_pd_body *pd, const bw_pd_block *block, uint8_t changed);

/* pd_state_shape.c */

/* The least eigenvalue of a symmetric tensor of `dimension`. */
double bw_pd_state__least(const double K[6], int dimension);

/* A particle's family: K, its inverse, tr K/d; whether it spans the space. */
typedef struct {
  double K[6], inverse[6], kappa;
  bool spans;
} bw_pd_state_family;

/* With the bonds of a lane that hold but for that of `without` (NULL: all of them). */
bw_pd_state_family bw_pd_state__family(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                                       const bw_pd_slot *without);
/* inverse and beta of all blocks whose bonds have changed since. Local. */
void bw_pd_state__shapes(const bw_pd_body *pd);

/* pd_state_correspondence_sweep.c */
void bw_pd_state__deform(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);
void bw_pd_state__force(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);
void bw_pd_state__tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[]);

/* pd_state_memory.c */

/* P of a block's displacement gradients, small: by materials of small strain; of materials that
 * remember the trial state, too. */
void bw_pd_state__stress(const bw_pd_body *pd, const bw_pd_block *block, bool small,
                         bw_pd_material_lanes H[9], bw_pd_material_lanes P[9]);
/* What a place remembers, in all lanes: accepted. */
bw_pd_material_state bw_pd_state__remembered(const bw_pd_body *pd, int32_t place);
/* How much of the limit of stress or flow the owners have used, to `measure`. */
void bw_pd_state__measure(const bw_pd_body *pd, const bw_pd_block *block,
                          const bw_pd_material_lanes H[9], const bw_pd_material_lanes P[9]);
/* beta of a block's owners, with what has flowed at the last evaluation. */
void bw_pd_state__soften(const bw_pd_body *pd, const bw_pd_block *block);
double bw_pd_state__dissipated(const bw_pd_body *pd);

/* pd_state_accept.c */
void bw_pd_state__accept(bw_pd_body *pd);

/* pd_state_energy.c: members of the law, and displacement gradient of a lane by its family. */
void bw_pd_state__gradient(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                           const bw_pd_state_family *f, const bw_pd_slot *without, double H[9]);
double bw_pd_state__bond_energy(const bw_pd_body *pd, const bw_pd_block *block,
                                const bw_pd_slot *slot, int lane);
double bw_pd_state__energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked);
void bw_pd_state__virial(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                         double sum[3][3]);
