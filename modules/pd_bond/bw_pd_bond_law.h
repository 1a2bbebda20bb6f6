/* bw_pd_bond_law.h -- the bond law: prototype microelastic brittle bonds (PMB).
 *
 *   L_h = sum_l c0 alpha_hl lambda_hl s_hl e_hl Gamma_hl dV_l,   s = (|xi + eta| - |xi|)/|xi|
 * with e the present direction of the bond, lambda 1 while it holds (POROUS 3.29-3.39 with
 * ERRATA 1, 2, 11, 14). A bond with s > s0 breaks for good, in tension only. Poisson's ratio is 1/4
 * in 3D and plane strain, 1/3 in plane stress. Between two groups a bond has the harmonic mean of
 * their micromoduli and its own fracture energy (bw_pd_body_config.joint_G0). */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Factor alpha of bonds whose families a surface has cut. */
typedef enum {
  BW_PD_SURFACE_NONE,   /* 1 */
  BW_PD_SURFACE_VOLUME, /* by the family's volume (POROUS 3.43, 3.44, ERRATA 11) */
  BW_PD_SURFACE_ENERGY, /* by the energy of a dilation (Madenci & Oterkus 2014, 4.2) */
  BW_PD_SURFACE_TENSOR  /* by direction: every family has the tensor of elasticity
                          (pd_bond_tensor.c) */
} bw_pd_surface_correction;

/* Where c0 and s0 come from. With the lattice's sums the bulk modulus, the energy of a flat crack
 * along the lattice and V_0 of the volume method are exact at any horizon_ratio. */
typedef enum {
  BW_PD_CALIBRATION_NONE,   /* the integrals over the ball (POROUS 3.21, 3.27, ERRATA 1) */
  BW_PD_CALIBRATION_LATTICE /* the sums over the lattice's full family (pd_bond_calibrate.c) */
} bw_pd_calibration;

/* What the law is asked for: `options` of bw_pd_body_create. */
typedef struct {
  bw_pd_surface_correction surface_correction; /* tensor: on lattices only */
  bw_pd_calibration calibration;               /* of c0 and s0 */
} bw_pd_bond_options;

/* The law to hand to a body: its word in a case file is `bond`. */
extern const bw_pd_law bw_pd_bond_law;

/* Constants of a body with this law (no other) and one of its groups, 0 .. n_group - 1. Local. */
double bw_pd_bond_law_micromodulus(const bw_pd_body *pd, int group);     /* c0 [M/(L^5 T^2)] */
double bw_pd_bond_law_critical_stretch(const bw_pd_body *pd, int group); /* s0 [-] */

#ifdef __cplusplus
}
#endif
