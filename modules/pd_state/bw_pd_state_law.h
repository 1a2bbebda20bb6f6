/* bw_pd_state_law.h -- state-based laws: any Poisson's ratio, large strains, plasticity.
 *
 * Ordinary (linear peridynamic solid), its word in a case file is `ordinary`: a bond pulls along
 * itself, by its own change of length e and by the dilatation theta of both ends' families.
 *   theta_h = (d/q_h) sum_l w |xi| e Gamma dV,   q_h = sum_l w |xi|^2 Gamma dV over the family
 *   t_h = w [(d (lam* - mu)/q_h) theta_h |xi| + (d (d + 2) mu/q_h) e]
 *   L_h = sum_l (t_h + t_l) y/|y| Gamma dV
 * with d = 2 or 3, lam* = lam in space and plane strain, E nu/(1 - nu^2) in plane stress
 * (ERRATA-ADAPT 2). Energy density (lam* - mu) theta^2/2 + (d (d + 2) mu/2 q) sum w e^2 Gamma dV.
 * lam* = mu is the bond law. A bond breaks for good when it is stretched and its energy (t_h + t_l)
 * e/2 is beyond that of a flat cut, G0/sum_{xi.n > 0} xi.n Gamma dV (ERRATA-ADAPT 24); its part in
 * theta goes with it, q stays.
 *
 * Correspondence (non-ordinary), its word is `correspondence`: the deformation gradient of a
 * particle, by its family, is what a material (bw_pd_material.h) answers to.
 *   K = sum w xi xi Gamma dV,  F_h = (sum w y xi Gamma dV) K^-1,  z = y - F_h xi
 *   T_h = w (P(F_h) K^-1 xi + beta z),  beta = gamma mu/kappa,  kappa = tr K/d
 *   L_h = sum (T_h<xi> - T_l<-xi>) Gamma dV
 * Energy density W(F) + beta/2 sum w z^2 Gamma dV. gamma = 4/3 cancels the error of shear waves to
 * the fourth order for every weight, horizon and dimension (ERRATA-ULPH, "what the solid must use
 * instead"). The default weight is (1 - q)^2 (1 + 2 q) with q = |xi| over the family's reach; eight
 * neighbours (18 in space: horizon_ratio 1.5, family_reach horizon) are the most accurate where
 * nothing breaks. A particle whose bonds no longer span the space is on central springs.
 * A bond breaks when its stretch is beyond s0 sqrt(horizon/|xi|), s0 of its G0: at the energy that
 * a spring in its place would hold, the same for all. With one stretch for all bonds those nearly
 * along a crack hold on longest, and what the crack costs depends on the stress along it. Or when
 * it is stretched and the mean of what its ends have used of a criterion's limit
 * (bw_pd_material_criterion.h), or of the flow's factor, is above 1.
 *
 * Between two groups each end has its own constants, and the smaller G0 or the joint's own counts.
 * A law given no options (NULL) takes the defaults. */
#pragma once
#include "bw_pd_body.h"
#include "bw_pd_material.h"

BW_BEGIN_DECLS

/* How much a neighbour at a distance counts in an ordinary law. */
typedef enum {
  BW_PD_STATE_CONSTANT, /* w = 1 */
  BW_PD_STATE_INVERSE   /* w = 1/|xi| */
} bw_pd_state_influence;

/* What the ordinary law is asked for: `options` of bw_pd_body_create. */
typedef struct {
  bw_pd_state_influence influence; /* default constant */
} bw_pd_state_ordinary_options;

/* The defaults. Local. */
bw_pd_state_ordinary_options bw_pd_state_ordinary_options_default(void);

/* The ordinary law. */
extern const bw_pd_law bw_pd_state_ordinary_law;

/* How much a neighbour at a distance counts in a correspondence law. */
typedef enum {
  BW_PD_STATE_CUBIC,  /* (1 - q)^2 (1 + 2 q), q = |xi|/reach */
  BW_PD_STATE_UNIFORM /* 1 */
} bw_pd_state_weight;

/* What breaks a bond of a correspondence law. */
typedef enum {
  BW_PD_STATE_BREAKS_BY_STRETCH, /* its stretch times sqrt(|xi|/horizon), of G0 */
  BW_PD_STATE_BREAKS_BY_STRESS,  /* the largest principal Cauchy stress of its ends */
  BW_PD_STATE_BREAKS_BY_FLOW,    /* the factor of the plastic flow of its ends */
  /* What their stress uses of a criterion (bw_pd_material_criterion.h). */
  BW_PD_STATE_BREAKS_BY_ENERGY,
  BW_PD_STATE_BREAKS_BY_MISES,
  BW_PD_STATE_BREAKS_BY_MOHR_COULOMB,
  BW_PD_STATE_BREAKS_BY_CONE /* Drucker-Prager */
} bw_pd_state_breaks;

/* What the correspondence law is asked for: `options` of bw_pd_body_create. */
typedef struct {
  bw_pd_state_weight weight;        /* default cubic */
  bw_pd_material_elastic elastic;   /* default neo-Hookean */
  const bw_pd_material_energy *own; /* borrowed: an energy in place of it; default NULL: none */
  double parameter[BW_PD_MATERIAL_PARAMETERS]; /* of `own`                           default 0 */
  bw_pd_material_yield yield[BW_PD_GROUPS];    /* of each group; default: it does not yield */
  double stabilisation;                        /* gamma [-]; default 4/3 */
  bw_pd_state_breaks breaks;                   /* default by stretch */
  double limit;                                /* of stress [M/(L T^2)] or flow [-] */
  double friction; /* angle of Mohr-Coulomb and Drucker-Prager [rad]; default 0 */
} bw_pd_state_correspondence_options;

/* The defaults. Local. */
bw_pd_state_correspondence_options bw_pd_state_correspondence_options_default(void);

/* The correspondence law. */
extern const bw_pd_law bw_pd_state_correspondence_law;

/* What a body of both laws is asked for: `options` of bw_pd_body_create, which must be given. */
typedef struct {
  bool correspondence_group[BW_PD_GROUPS];           /* of each group; default false: ordinary */
  bw_pd_state_ordinary_options ordinary;             /* default that law's own */
  bw_pd_state_correspondence_options correspondence; /* default that law's own */
} bw_pd_state_mixed_options;

/* The defaults: ordinary everywhere. Local. */
bw_pd_state_mixed_options bw_pd_state_mixed_options_default(void);

/* Some groups ordinary, the others correspondence; bonds are the ordinary law with their own
 * Poisson's ratio. It is no row of the table: bw_solid_config.law takes it, and scenes whose parts
 * have materials of both laws. */
extern const bw_pd_law bw_pd_state_mixed_law;

BW_END_DECLS
