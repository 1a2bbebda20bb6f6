/* bw_solid_stress.h -- stress and strain at the particles of a solid, and their statistics.
 *
 *   P_h     = 1/2 sum_l f_hl (x) xi dV_l,   f_hl = c0 alpha s e Gamma      (first Piola-Kirchhoff)
 *   sigma_h = P F^T/J = 1/(2J) sum_l c0 alpha s |xi + eta| e (x) e Gamma dV_l          (Cauchy)
 *   F_h     = (sum_l (xi + eta) (x) xi Gamma dV_l) . (sum_l xi (x) xi Gamma dV_l)^-1
 * over the bonds that hold. P is the derivative by F of the energy density 1/4 sum c0 alpha s^2
 * |xi| Gamma dV of a uniformly deformed family (ds/dF = e (x) xi/|xi|): that gives the factor 1/2.
 * It is the peridynamic stress of Lehoucq & Silling (J. Mech. Phys. Solids 56, 2008) with their
 * integral along the bond replaced by its value where the deformation is uniform; on a lattice it
 * is then exactly the force through a plane between two layers, per area. Within two horizons of a
 * surface or of a steep gradient it is an average.
 * Where the bonds left do not span the space F cannot be found: there F = 1 and J = 1.
 * 2D: sigma_zz = 0 in plane stress, (sigma_xx + sigma_yy)/4 in plane strain; F_zz = 1 in both.
 * Symmetric tensors are rows of six: xx, yy, zz, yz, xz, xy. */
#pragma once
#include "bw_pd_tensor.h"
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* F (n,9) row-major [-] and Cauchy stress (n,6) [M/(L T^2)] of the own particles at the present
 * positions; either may be NULL. Collective (updates the copies). */
void bw_solid_stress_compute(bw_solid *solid, double F[], double stress[]);

/* Probability density of `value` (n) over all ranks in `bins` equal bins of lower .. upper:
 * density[bins] [1/unit of value], with sum density width = 1 - *outside, the share that is out of
 * range or not finite. weight (n): NULL for equal weights. BW_EINPUT for an empty range, no bins or
 * no weight at all; BW_EMEM. Collective. */
bw_status bw_solid_stress_pdf(const bw_comm *comm, size_t n, const double value[],
                              const double weight[], double lower, double upper, int bins,
                              double density[], double *outside) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
