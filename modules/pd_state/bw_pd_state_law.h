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
 * Between two groups each end has its own constants, and the smaller G0 or the joint's own counts.
 * A law given no options (NULL) takes the defaults. */
#pragma once
#include "bw_pd_body.h"

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

BW_END_DECLS
