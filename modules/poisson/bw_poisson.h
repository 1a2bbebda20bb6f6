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

/* The solver for one grid and one set of conditions. */
typedef struct bw_poisson bw_poisson;

/* The condition on one side of the box. */
typedef enum {
  BW_POISSON_PERIODIC, /* the other side goes on here; both sides of a direction */
  BW_POISSON_NEUMANN,  /* d phi/dn = 0 on the boundary face */
  BW_POISSON_DIRICHLET /* phi = 0 on the boundary face */
} bw_poisson_side;

/* *out = a solver; side[d][0], side[d][1]: lower and upper condition in direction d; periodic ones
 * in pairs and only where the grid is periodic (BW_EINPUT otherwise; one cell in z takes either of
 * periodic and Neumann). `grid` is borrowed until destroy. BW_EMEM. Collective. */
bw_status bw_poisson_create(bw_grid *grid, const bw_poisson_side side[3][2],
                            bw_poisson **out) BW_MUST_CHECK;

/* Free *p and set it to NULL; NULL inside is fine. Local. */
void bw_poisson_destroy(bw_poisson **p);

/* In place: `phi` (a field, interior read as f [X/L^2], halos ignored) becomes the solution [X];
 * its halos are not updated. Collective. */
void bw_poisson_solve(bw_poisson *p, bw_real *phi);

/* Solve (1 - alpha div grad) phi = f the same way; alpha [L^2] > 0 (implicit diffusion of a
 * cell-centred field). Collective. */
void bw_poisson_solve_helmholtz(bw_poisson *p, double alpha, bw_real *phi);

/* Has no side a Dirichlet condition, so that phi is known up to a constant? Local. */
bool bw_poisson_singular(const bw_poisson *p);

/* Mean of f over the box that the last solve removed [X/L^2]; 0 where the operator is not singular.
 * Local. */
double bw_poisson_removed_mean(const bw_poisson *p);

BW_END_DECLS
