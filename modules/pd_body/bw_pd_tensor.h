/* bw_pd_tensor.h -- symmetric tensors at particles: strain, principal values, von Mises.
 *
 * Symmetric tensors are rows of six: xx, yy, zz, yz, xz, xy. */
#pragma once
#include "bw_status.h"
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BW_PD_SYMMETRIC = 6 }; /* numbers in a row */

/* Green-Lagrange strain 1/2 (F^T F - 1), (n,6) [-], of n deformation gradients (n,9), row-major.
 * Local. */
void bw_pd_tensor_strain(size_t n, const double F[], double strain[]);

/* Principal values (n,3), largest first, and their unit directions in rows (n,9), or NULL, of n
 * symmetric tensors (n,6). BW_EMEM. Local. */
bw_status bw_pd_tensor_principal(size_t n, const double tensor[], double value[],
                                 double direction[]) BW_MUST_CHECK;

/* Von Mises' equivalent stress sqrt(3/2 s:s), s the deviator, (n) in the unit of stress (n,6).
 * Local. */
void bw_pd_tensor_von_mises(size_t n, const double stress[], double von_mises[]);

/* t += factor e (x) e with e = xi/r0, r0 not 0. Local. */
void bw_pd_tensor_add_dyad(double factor, const double xi[3], double r0, double t[BW_PD_SYMMETRIC]);

#ifdef __cplusplus
}
#endif
