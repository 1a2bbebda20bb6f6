/* pd_tensor_bound.h -- a bound of the largest frequency of a network of springs.
 *
 * The network of springs k along e has u.Ku = 1/2 sum_hl k (e.(u_l - u_h))^2, and (a - b)^2 is at
 * most 2 a^2 + 2 b^2, so that u.Ku <= sum_h u_h.(2 T_h) u_h with T_h = sum_l k e e: no eigenvalue
 * of K is above twice the largest one of all T_h. (ERRATA 6 has T's trace there, three times as
 * much in the bulk.) What is left: the sharpest wave of the lattice allows a step 1.17 times as
 * long in 3D and 1.19 times in the plane with m = 3, 1.10 and 1.12 times with m = 2, and just this
 * one with m = 1. The same holds for the pair damping, with Gamma dV for k. Turned bodies have the
 * same bound; a strain s changes T by some 3 s of itself. With masses the eigenvalues of a
 * particle's tensor count over its own density. */
#pragma once
#include "bw_pd_tensor.h"
#include "pd_body.h"

/* T of a block's lanes, symmetric rows of six [M/(L^3 T^2)]. */
typedef double bw_pd_tensors[BW_PD_LANES][BW_PD_SYMMETRIC];

/* Raises *most to twice the largest eigenvalue of a block's T over density [1/T^2]. BW_EMEM.
 * Local. */
bw_status bw_pd_body_bound_block(const bw_pd_body *pd, const bw_pd_block *block, bw_pd_tensors T,
                                 double *most) BW_MUST_CHECK;
/* pd->frequency2 from what each rank found, and how it fared. Collective. */
bw_status bw_pd_body_bound_all(bw_pd_body *pd, bw_status st, double most) BW_MUST_CHECK;
