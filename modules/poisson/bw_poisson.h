/* bw_poisson.h -- direct solution of  div grad phi = f  on the staggered grid.
 *
 * Second-order differences, diagonalised by fast transforms in x and z and solved by a
 * tridiagonal system in y (which may be stretched):  per mode (kx, kz)
 *   (phi_{j+1}-phi_j)/(dyc_j dyf_j) - (phi_j-phi_{j-1})/(dyc_{j-1} dyf_j)
 *      + (lambda_x + lambda_z) phi_j = f_j.
 * Conditions are imposed on the face at the boundary: Neumann (zero normal derivative) or
 * Dirichlet (zero value). Exact to round-off: the residual of the discrete operator is the
 * claim. Transforms: real FFT where periodic; DCT-II (N-N), DST-II (D-D), DCT-IV (N-D),
 * DST-IV (D-N) elsewhere. When no direction has a Dirichlet side the operator is singular:
 * the mean of f must vanish (the solver removes it and reports it) and phi has mean zero.
 * Nothing is allocated in a solve. */
#pragma once
#include "bw_grid.h"

BW_BEGIN_DECLS

typedef struct bw_poisson bw_poisson;

typedef enum { BW_POISSON_PERIODIC, BW_POISSON_NEUMANN, BW_POISSON_DIRICHLET } bw_poisson_side;

/* side[d][0], side[d][1]: lower and upper condition in direction d; periodic ones in pairs and
 * only where the grid is periodic (BW_EINPUT otherwise). `grid` is borrowed. Collective. */
bw_status bw_poisson_create(bw_grid *grid, const bw_poisson_side side[3][2],
                            bw_poisson **out) BW_MUST_CHECK;
void bw_poisson_destroy(bw_poisson **p); /* Collective. */

/* In place: `phi` (a field, interior read as f [X/L^2], halos ignored) becomes the solution [X];
 * its halos are not updated. Collective. */
void bw_poisson_solve(bw_poisson *p, bw_real *phi);

/* Solve (1 - alpha div grad) phi = f the same way; alpha [L^2] > 0 (implicit diffusion of a
 * cell-centred field). Collective. */
void bw_poisson_solve_helmholtz(bw_poisson *p, double alpha, bw_real *phi);

bool bw_poisson_singular(const bw_poisson *p);       /* Local. */
double bw_poisson_removed_mean(const bw_poisson *p); /* of f, at the last solve. Local. */

BW_END_DECLS
