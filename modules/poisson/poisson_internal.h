/* poisson_internal.h -- shared by the sources of poisson only. */
#pragma once
#include "bw_poisson.h"
#include "bw_transpose.h"
#include "bw_tridiagonal.h"
#include <fftw3.h>

#ifdef BW_SINGLE
#define BW_FFTW(name) fftwf_##name
#else
#define BW_FFTW(name) fftw_##name
#endif

/* Plans are those FFTW chooses without measuring: the same bits in every run, which a measured
 * choice is not, for 0 to 10 % of the time of a solve. */
#define BW_POISSON__EFFORT ((unsigned)FFTW_ESTIMATE)

typedef enum {
  BW_POISSON__FOURIER,
  BW_POISSON__COSINE, /* by a Fourier transform of the same length, poisson_cosine.c */
  BW_POISSON__OTHER   /* by FFTW's own real transform */
} bw_poisson__family;

/* How the pair of conditions in x or z is diagonalised; a row of the table in
 * poisson_transform.c. */
typedef struct {
  bw_poisson_side side[2];
  bw_poisson__family family;
  BW_FFTW(r2r_kind) real; /* OTHER: its own inverse */
  bw_real odd;            /* COSINE: factor of every second value (-1 makes it a sine) */
  int norm;               /* backward(forward(f)) = norm n f */
  double turns, offset;   /* lambda_k = -(2 sin(theta_k/2) / spacing)^2 */
  bool reversed;          /* theta_k = turns pi (q + offset)/n, q = k or n-1-k */
} bw_poisson__kind;

/* NULL when the pair is not in the table. */
const bw_poisson__kind *bw_poisson__find(const bw_poisson_side side[2]);

/* One direction, for arrays of one shape. */
typedef struct {
  const bw_poisson__kind *kind;
  int n, width;  /* length; reals side by side (1 along x) */
  bool separate; /* z, FOURIER: the pairs of reals are two columns, not a complex number */
  BW_FFTW(plan) forward, backward;
  bw_real *twiddle; /* COSINE: cos, sin of pi k / 2n, k = 0..n/2 */
  bw_real *work;    /* COSINE: one array of the shape, and a spectrum */
  bw_real *spectrum;
} bw_poisson__transform;

/* Rows along x: n reals to columns entries, out of place, 16-byte aligned rows. The columns are
 * an even number: complex numbers, or reals with a zero behind them. Local. */
int bw_poisson__columns(const bw_poisson__kind *kind, int n);
bw_status bw_poisson__rows_create(const bw_poisson__kind *kind, int n, bw_poisson__transform *t);
void bw_poisson__row_forward(const bw_poisson__transform *t, bw_real *in, bw_real *out);
void bw_poisson__row_backward(const bw_poisson__transform *t, bw_real *in, bw_real *out);

/* Columns along z of an array [n][width], in place, width even; `separate` when x gave real
 * entries. Local. */
bw_status bw_poisson__columns_create(const bw_poisson__kind *kind, int n, int width, bool separate,
                                     bw_poisson__transform *t);
void bw_poisson__columns_forward(const bw_poisson__transform *t, bw_real *a);
void bw_poisson__columns_backward(const bw_poisson__transform *t, bw_real *a);

void bw_poisson__transform_destroy(bw_poisson__transform *t);

/* Eigenvalue [1/L^2] of the second difference for entry k of a transform's output: q-th complex
 * number (either part) or k-th real. Along z two separate columns hold, at rows k and n-k, real
 * and imaginary parts: their eigenvalues are equal, so k is right for all. */
double bw_poisson__eigenvalue(const bw_poisson__kind *kind, int n, double spacing, int k);

/* The cosine transforms around a Fourier transform, see poisson_cosine.c. */
bw_status bw_poisson__twiddle(int n, bw_real **out);
void bw_poisson__cosine_row_in(int n, bw_real odd, const bw_real *restrict row,
                               bw_real *restrict v);
void bw_poisson__cosine_row_combine(int n, const bw_real *restrict twiddle,
                                    const bw_real *restrict spectrum, bw_real *restrict out);
void bw_poisson__cosine_row_split(int n, const bw_real *restrict twiddle,
                                  const bw_real *restrict in, bw_real *restrict spectrum);
void bw_poisson__cosine_row_out(int n, bw_real odd, const bw_real *restrict v,
                                bw_real *restrict row);
void bw_poisson__cosine_columns_in(int n, int width, bw_real odd, const bw_real *restrict a,
                                   bw_real *restrict v);
void bw_poisson__cosine_columns_combine(int n, int width, const bw_real *restrict twiddle,
                                        const bw_real *restrict v, bw_real *restrict a);
void bw_poisson__cosine_columns_split(int n, int width, const bw_real *restrict twiddle,
                                      const bw_real *restrict a, bw_real *restrict v);
void bw_poisson__cosine_columns_out(int n, int width, bw_real odd, const bw_real *restrict v,
                                    bw_real *restrict a);

enum {
  BW_POISSON__ROWS = 8
}; /* x-rows on their way to the blocks together: they fit the first-level cache */
struct bw_poisson {
  bw_grid *grid;
  const bw_poisson__kind *kind[3];
  bool singular, real_x; /* real_x: x-entries are no complex numbers */
  bool coupled;          /* coupled: the lines in y need all ranks in y, or are cyclic */
  double removed_mean;
  bw_poisson__transform x, z[2]; /* z: of blocks of full width, of the last one */
  bw_transpose *transpose;
  bw_tridiagonal *tridiagonal;
  double *lambda_x, *lambda_z;      /* (columns), (n2) */
  double *lower, *diagonal, *upper; /* (n1) of d2/dy2, then of the operator being solved */
  double *operator_lower, *operator_diagonal, *operator_upper;
  bw_real *rows; /* (BW_POISSON__ROWS, row_stride) */
  ptrdiff_t row_stride;
};
