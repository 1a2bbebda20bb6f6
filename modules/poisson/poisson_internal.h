/* poisson_internal.h -- shared by the sources of poisson only. */
#pragma once
#include "bw_poisson.h"
#include <fftw3.h>

#ifdef BW_SINGLE
#define BW_FFTW(name) fftwf_##name
#else
#define BW_FFTW(name) fftw_##name
#endif

/* How the pair of conditions in x or z is diagonalised; a row of the table in
 * poisson_transform.c. */
typedef struct {
  bw_poisson_side side[2];
  bool periodic;
  BW_FFTW(r2r_kind) forward, backward; /* unused where complex transforms serve */
  int norm;                            /* backward(forward(f)) = norm n f */
  double turns; /* lambda_k = -(2 sin(theta_k/2) / spacing)^2, theta_k = turns pi (k + offset)/n */
  double offset;
} bw_poisson__kind;

/* NULL when the pair is not in the table. */
const bw_poisson__kind *bw_poisson__find(const bw_poisson_side side[2]);

/* Transforms of one direction; plans for in-place or out-of-place rows, see the makers. */
typedef struct {
  BW_FFTW(plan) forward, backward;
  bool complex_numbers; /* forward/backward are r2c/c2r (rows) or c2c (columns) */
} bw_poisson__transform;

/* Rows along x: n reals -> columns entries (2 (n/2+1), interleaved, when periodic; n else), out
 * of place between 64-byte aligned rows. Local. */
bw_status bw_poisson__rows(const bw_poisson__kind *kind, int n, bw_poisson__transform *out);
int bw_poisson__columns(const bw_poisson__kind *kind, int n);

/* Columns along z of an array [n][width], in place; `complex_numbers` when pairs of entries are
 * complex (x was periodic). Local. */
bw_status bw_poisson__columns_along_z(const bw_poisson__kind *kind, int n, int width,
                                      bool complex_numbers, bw_poisson__transform *out);

void bw_poisson__transform_destroy(bw_poisson__transform *t);
void bw_poisson__row_forward(const bw_poisson__transform *t, bw_real *in, bw_real *out);
void bw_poisson__row_backward(const bw_poisson__transform *t, bw_real *in, bw_real *out);
void bw_poisson__column_forward(const bw_poisson__transform *t, bw_real *a);
void bw_poisson__column_backward(const bw_poisson__transform *t, bw_real *a);

/* Eigenvalues [1/L^2] of the second difference, in the order of the transform's output:
 * columns entries along x, n along z (half-complex order for a real periodic z). Local. */
void bw_poisson__eigenvalues_x(const bw_poisson__kind *kind, int n, double spacing,
                               double lambda[]);
void bw_poisson__eigenvalues_z(const bw_poisson__kind *kind, int n, double spacing,
                               bool complex_numbers, double lambda[]);
