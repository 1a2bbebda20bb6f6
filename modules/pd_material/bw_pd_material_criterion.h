/* bw_pd_material_criterion.h -- how much of what a point bears its stress uses.
 *
 * Each number is 1 where the criterion says that the point fails, and goes with the load: at half
 * of the stress it is a half.
 *   Rankine         sigma_1/limit, sigma_1 the largest principal stress
 *   energy          sqrt(2 E W)/limit, W = sigma:C^-1:sigma/2: in uniaxial tension sigma/limit
 *   von Mises       sqrt(3 J2)/limit
 *   Mohr-Coulomb    ((sigma_1 - sigma_3) + (sigma_1 + sigma_3) sin(phi))/(2 limit cos(phi))
 *   Drucker-Prager  (sqrt(J2) + alpha I1)/k, the cone that is Mohr-Coulomb's in plane strain
 *                   without dilation: alpha = sin(phi)/3, k = limit cos(phi)
 * limit is a strength in tension, a yield stress, or a cohesion [M/(L T^2)]. */
#pragma once
#include "bw_status.h"

BW_BEGIN_DECLS

/* What is compared with what. */
typedef enum {
  BW_PD_MATERIAL_RANKINE,
  BW_PD_MATERIAL_ENERGY,
  BW_PD_MATERIAL_MISES,
  BW_PD_MATERIAL_MOHR_COULOMB,
  BW_PD_MATERIAL_CONE, /* Drucker-Prager */
  BW_PD_MATERIAL_CRITERIA
} bw_pd_material_criterion_kind;

/* A criterion. */
typedef struct {
  bw_pd_material_criterion_kind kind; /* which of the five */
  double limit;                       /* [M/(L T^2)] */
  double friction;                    /* angle phi of the last two [rad] */
} bw_pd_material_criterion;

/* What a Cauchy stress (6: xx yy zz yz xz xy) [M/(L T^2)] uses of it; lam and mu [M/(L T^2)], of
 * space, are read by `energy` alone. Local. */
double bw_pd_material_used(const bw_pd_material_criterion *c, double lam, double mu,
                           const double sigma[6]);
/* Principal stresses, the largest first, and their directions (rows); either may be NULL. Local. */
void bw_pd_material_principal_stress(const double sigma[6], double value[3],
                                     double direction[3][3]);

BW_END_DECLS
