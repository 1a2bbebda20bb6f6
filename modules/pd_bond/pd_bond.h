/* pd_bond.h -- state of the bond law, shared by its sources. */
#pragma once
#include "bw_pd_bond_law.h"
#include "pd_law.h"

#include <math.h>

/* How the sweep gets the factors of a block's bonds: by the surface correction, or those that the
 * bonds near a jump between levels have each. */
enum { BW_PD_BOND_EXACT = BW_PD_SURFACE_TENSOR + 1 };

/* Unit of the stored factors of bonds (surface correction `tensor`): 2^-14, 0 .. 4. */
#define BW_PD_ALPHA_UNIT (1.0 / 16384)

enum {
  BW_PD_BOND_CONDITIONS = 22, /* of the correction `tensor`; in the plane 7 */
  BW_PD_BOND_CUBICS = 10      /* monomials of degree 3 of a direction; in the plane 4 */
};

/* Sums over a full family. */
typedef struct {
  double volume;   /* of Gamma dV [L^3] */
  double moment;   /* of |xi| Gamma dV [L^4] */
  double crossing; /* of |xi| xi.n Gamma dV where xi.n > 0 [L^5] */
} bw_pd_bond_full;

typedef struct {
  bw_pd_bond_options options;
  double full_volume; /* V_0 of the volume method (POROUS 3.44) [L^3] */
  bw_pd_bond_full full;
  double c0[BW_PD_GROUPS]
           [BW_PD_GROUPS]; /* micromodulus of bonds between two groups, level 0 [M/(L^5 T^2)] */
  double s0[BW_PD_GROUPS][BW_PD_GROUPS]; /* their critical stretch, level 0 [-] */
  bool breakable;                        /* some s0 is finite */
  double *bulk;                          /* (directions) alpha of a full family: 1 but by tensor */
  bw_real *w;                            /* storage: surface factor of a particle */
  /* Where levels change, with the correction `tensor`: what its factors and those near jumps
   * follow from, fields of the body that go on with cells that keep their level. */
  int n_lambda, n_mu;
  bw_real *lambda[BW_PD_BOND_CONDITIONS], *mu[BW_PD_BOND_CUBICS];
} bw_pd_bond_state;

static inline const bw_pd_bond_state *bw_pd_bond__state(const bw_pd_body *pd)
{
  return (const bw_pd_bond_state *)pd->state;
}

static inline bw_pd_bond_state *bw_pd_bond__own(bw_pd_body *pd)
{
  return (bw_pd_bond_state *)pd->state;
}

/* Micromodulus of the bond of two storage places: between levels that of the coarser end. */
static inline double bw_pd_bond__micromodulus(const bw_pd_body *pd, int32_t h, int32_t l)
{
  const double c0 =
      bw_pd_bond__state(pd)->c0[bw_pd_body_group_at(pd, h)][bw_pd_body_group_at(pd, l)];
  return c0 * bw_pd_level_coarser(bw_pd_body_level_at(pd, h), bw_pd_body_level_at(pd, l))->stiff;
}

/* pd_bond_law.c: c0 and s0 of the integrals. Local. */
void bw_pd_bond__material(bw_pd_body *pd);

/* pd_bond_calibrate.c; E, the harmonic mean, and fracture energy of bonds between two groups */
double bw_pd_bond__joint_E(const bw_pd_body_config *config, int g, int h);
double bw_pd_bond__joint_G0(const bw_pd_body_config *config, int g, int h);
double bw_pd_bond__classical_dilation(const bw_pd_body_config *config, double E); /* energy/e^2 */
bw_status bw_pd_bond__full_family(bw_pd_body *pd) BW_MUST_CHECK;                  /* its sums */
void bw_pd_bond__calibrate(bw_pd_body *pd);

/* pd_bond_surface.c: state.w. Collective. */
bw_status bw_pd_bond__surface_factors(bw_pd_body *pd) BW_MUST_CHECK;
double bw_pd_bond__alpha(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                         int lane);

/* What has changed since a body whose multipliers this one has. */
typedef struct {
  const bool *fresh; /* (n) own particles of cells whose level changed: they have none */
  bw_real *near;     /* storage: > 0 of those and around them, where multipliers may change */
} bw_pd_bond_change;

/* pd_bond_tensor.c: bonds.factor, state.bulk; change NULL: from nothing. With levels that change it
 * needs room for the multipliers (once), and `adopt` makes the factors of those there are.
 * Collective. */
bw_status bw_pd_bond__tensor_room(bw_pd_body *pd) BW_MUST_CHECK;
bw_status bw_pd_bond__tensor(bw_pd_body *pd, const bw_pd_bond_change *change) BW_MUST_CHECK;
bw_status bw_pd_bond__tensor_adopt(bw_pd_body *pd) BW_MUST_CHECK;
/* near (storage) <- 1 of own particles with a neighbour that is > 0 in before. Local. */
void bw_pd_bond__mark_neighbours(const bw_pd_body *pd, const bw_real *before, bw_real *near);

/* pd_bond_levels.c: bonds.exact, blocks' exact; the same. Collective. */
bw_status bw_pd_bond__levels_room(bw_pd_body *pd) BW_MUST_CHECK;
bw_status bw_pd_bond__levels(bw_pd_body *pd, const bw_pd_bond_change *change) BW_MUST_CHECK;
bw_status bw_pd_bond__levels_adopt(bw_pd_body *pd) BW_MUST_CHECK;

/* Members of the law. */
void bw_pd_bond__force(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);
bool bw_pd_bond__breaks(bw_pd_body *pd, bw_pd_block *block);
double bw_pd_bond__bond_energy(const bw_pd_body *pd, const bw_pd_block *block,
                               const bw_pd_slot *slot, int lane);
double bw_pd_bond__energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t lanes_asked);
bw_status bw_pd_bond__bound(bw_pd_body *pd) BW_MUST_CHECK;
void bw_pd_bond__tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[]);
void bw_pd_bond__rows(const bw_pd_body *pd, double row[]);
void bw_pd_bond__virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3]);
