/* Which transform diagonalises the second difference of cell-centred values under which pair of
 * conditions on the boundary faces.
 *
 * With ghosts phi_0 = +phi_1 (Neumann) or -phi_1 (Dirichlet) the eigenvectors are samples, at the
 * centres i - 1/2, of cos(theta (i-1/2)) or sin(theta (i-1/2)) whose continuation has the same
 * symmetry about the upper face n + 1/2, hence theta = pi (q + offset)/n with offset 0 (N-N:
 * cosine, DCT-II), 1 (D-D: sine, DST-II), 1/2 (N-D: cosine, DCT-IV; D-N: sine, DST-IV); periodic
 * ones are exp(i theta j), theta = 2 pi q/n. Always lambda = (2 cos theta - 2)/h^2. */
#include "bw_memory.h"
#include "poisson_internal.h"

#include <math.h>

#define PI 3.14159265358979323846
#define P  BW_POISSON_PERIODIC
#define N  BW_POISSON_NEUMANN
#define D  BW_POISSON_DIRICHLET

static const bw_poisson__kind kinds[] = {
    {{P, P}, BW_POISSON__FOURIER, FFTW_R2HC, 1, 1, 2.0, 0.0, false},
    {{N, N}, BW_POISSON__COSINE, FFTW_REDFT10, 1, 2, 1.0, 0.0, false},
    {{D, D}, BW_POISSON__COSINE, FFTW_RODFT10, -1, 2, 1.0, 1.0, true},
    {{N, D}, BW_POISSON__OTHER, FFTW_REDFT11, 1, 2, 1.0, 0.5, false},
    {{D, N}, BW_POISSON__OTHER, FFTW_RODFT11, 1, 2, 1.0, 0.5, false},
};
#undef P
#undef N
#undef D

const bw_poisson__kind *bw_poisson__find(const bw_poisson_side side[2])
{
  for (size_t q = 0; q < sizeof kinds / sizeof *kinds; q++)
    if (kinds[q].side[0] == side[0] && kinds[q].side[1] == side[1]) return &kinds[q];
  return NULL;
}

double bw_poisson__eigenvalue(const bw_poisson__kind *kind, int n, double spacing, int k)
{
  const int q = kind->reversed ? n - 1 - k : k;
  const double s = 2.0 * sin(0.5 * kind->turns * PI * (q + kind->offset) / n) / spacing;
  return -s * s;
}

void bw_poisson__transform_destroy(bw_poisson__transform *t)
{
  if (t->forward != NULL) BW_FFTW(destroy_plan)(t->forward);
  if (t->backward != NULL) BW_FFTW(destroy_plan)(t->backward);
  t->forward = t->backward = NULL;
  bw_release(&t->twiddle);
  bw_release(&t->work);
  bw_release(&t->spectrum);
}

static bw_status made(const bw_poisson__transform *t, const char *axis)
{
  BW_REQUIRE(t->forward != NULL && t->backward != NULL, BW_EMEM,
             "poisson: FFTW made no plan for %d cells in %s", t->n, axis);
  return BW_OK;
}

/* ---- rows along x ---- */

int bw_poisson__columns(const bw_poisson__kind *kind, int n)
{
  /* Even in any case: along z a Fourier transform takes two neighbouring entries as one complex
   * number. */
  return kind->family == BW_POISSON__FOURIER ? 2 * (n / 2 + 1) : (n + 1) / 2 * 2;
}

bw_status bw_poisson__rows_create(const bw_poisson__kind *kind, int n, bw_poisson__transform *t)
{
  t->kind = kind;
  t->n = n;
  t->width = 1;
  BW_TRY(BW_ALLOCATE(&t->work, (size_t)n));
  BW_TRY(BW_ALLOCATE(&t->spectrum, (size_t)n + 2));
  BW_TRY(bw_poisson__twiddle(n, &t->twiddle));
  BW_FFTW(complex) *spectrum = (BW_FFTW(complex) *)t->spectrum;
  /* A cosine transform runs on the plan of a Fourier transform of the same length. */
  if (kind->family == BW_POISSON__OTHER) {
    t->forward = BW_FFTW(plan_r2r_1d)(n, t->work, t->spectrum, kind->real, BW_POISSON__EFFORT);
    t->backward = BW_FFTW(plan_r2r_1d)(n, t->spectrum, t->work, kind->real, BW_POISSON__EFFORT);
  } else {
    t->forward = BW_FFTW(plan_dft_r2c_1d)(n, t->work, spectrum, BW_POISSON__EFFORT);
    t->backward = BW_FFTW(plan_dft_c2r_1d)(n, spectrum, t->work, BW_POISSON__EFFORT);
  }
  return made(t, "x");
}

void bw_poisson__row_forward(const bw_poisson__transform *t, bw_real *in, bw_real *out)
{
  switch (t->kind->family) {
  case BW_POISSON__FOURIER:
    BW_FFTW(execute_dft_r2c)(t->forward, in, (BW_FFTW(complex) *)out);
    return;
  case BW_POISSON__COSINE:
    bw_poisson__cosine_row_in(t->n, t->kind->odd, in, t->work);
    BW_FFTW(execute)(t->forward);
    bw_poisson__cosine_row_combine(t->n, t->twiddle, t->spectrum, out);
    break;
  case BW_POISSON__OTHER:
    BW_FFTW(execute_r2r)(t->forward, in, out);
    break;
  }
  /* The entry that makes the number of columns even. The way back does not read it, so that any
   * number would do; zero keeps the solve along z of this column from running off to NaN. */
  if (t->n % 2 == 1) out[t->n] = 0;
}

void bw_poisson__row_backward(const bw_poisson__transform *t, bw_real *in, bw_real *out)
{
  switch (t->kind->family) {
  case BW_POISSON__FOURIER:
    BW_FFTW(execute_dft_c2r)(t->backward, (BW_FFTW(complex) *)in, out);
    break;
  case BW_POISSON__COSINE:
    bw_poisson__cosine_row_split(t->n, t->twiddle, in, t->spectrum);
    BW_FFTW(execute)(t->backward);
    bw_poisson__cosine_row_out(t->n, t->kind->odd, t->work, out);
    break;
  case BW_POISSON__OTHER:
    BW_FFTW(execute_r2r)(t->backward, in, out);
    break;
  }
}

/* ---- columns along z ---- */

bw_status bw_poisson__columns_create(const bw_poisson__kind *kind, int n, int width, bool separate,
                                     bw_poisson__transform *t)
{
  const int pairs = width / 2;
  t->kind = kind;
  t->n = n;
  t->width = width;
  t->separate = separate && kind->family == BW_POISSON__FOURIER;
  BW_TRY(BW_ALLOCATE(&t->work, (size_t)n * (size_t)width));
  BW_TRY(bw_poisson__twiddle(n, &t->twiddle));
  /* Rows of a narrow block start anywhere; those of `work` and of full blocks do not. */
  const bool aligned =
      (size_t)width * sizeof(bw_real) % 64 == 0 || kind->family == BW_POISSON__COSINE;
  const unsigned flags = BW_POISSON__EFFORT | (aligned ? 0u : (unsigned)FFTW_UNALIGNED);
  BW_FFTW(complex) *z = (BW_FFTW(complex) *)t->work;
  /* All columns of a block in one plan, side by side in memory, in place. */
  if (kind->family == BW_POISSON__OTHER) {
    t->forward = BW_FFTW(plan_many_r2r)(1, &n, width, t->work, NULL, width, 1, t->work, NULL, width,
                                        1, &kind->real, flags);
    t->backward = BW_FFTW(plan_many_r2r)(1, &n, width, t->work, NULL, width, 1, t->work, NULL,
                                         width, 1, &kind->real, flags);
  } else {
    t->forward = BW_FFTW(plan_many_dft)(1, &n, pairs, z, NULL, pairs, 1, z, NULL, pairs, 1,
                                        FFTW_FORWARD, flags);
    t->backward = BW_FFTW(plan_many_dft)(1, &n, pairs, z, NULL, pairs, 1, z, NULL, pairs, 1,
                                         FFTW_BACKWARD, flags);
  }
  return made(t, "z");
}

/* Two real columns went through as one complex number: Z = A + i B. Rows k and n-k become real
 * and imaginary parts of A_k and of B_k, each in its own column. */
static void take_apart(int n, int width, bw_real *restrict a)
{
  for (int k = 1; k < (n + 1) / 2; k++) {
    bw_real *x = a + (ptrdiff_t)k * width, *y = a + (ptrdiff_t)(n - k) * width;
#pragma omp simd
    for (int q = 0; q < width; q += 2) {
      const bw_real x_re = x[q], x_im = x[q + 1], y_re = y[q], y_im = y[q + 1];
      /* A_k = (Z_k + conj Z_{n-k})/2 and B_k = (Z_k - conj Z_{n-k})/2i. */
      x[q] = (bw_real)0.5 * (x_re + y_re);
      x[q + 1] = (bw_real)0.5 * (x_im + y_im);
      y[q] = (bw_real)0.5 * (x_im - y_im);
      y[q + 1] = (bw_real)0.5 * (y_re - x_re);
    }
  }
}

static void put_together(int n, int width, bw_real *restrict a)
{
  for (int k = 1; k < (n + 1) / 2; k++) {
    bw_real *x = a + (ptrdiff_t)k * width, *y = a + (ptrdiff_t)(n - k) * width;
#pragma omp simd
    for (int q = 0; q < width; q += 2) {
      const bw_real a_re = x[q], b_re = x[q + 1], a_im = y[q], b_im = y[q + 1];
      x[q] = a_re - b_im;
      x[q + 1] = a_im + b_re;
      y[q] = a_re + b_im;
      y[q + 1] = b_re - a_im;
    }
  }
}

static void run(const bw_poisson__transform *t, BW_FFTW(plan) plan, bw_real *a)
{
  if (t->kind->family == BW_POISSON__OTHER)
    BW_FFTW(execute_r2r)(plan, a, a);
  else
    BW_FFTW(execute_dft)(plan, (BW_FFTW(complex) *)a, (BW_FFTW(complex) *)a);
}

void bw_poisson__columns_forward(const bw_poisson__transform *t, bw_real *a)
{
  if (t->kind->family == BW_POISSON__COSINE) {
    bw_poisson__cosine_columns_in(t->n, t->width, t->kind->odd, a, t->work);
    run(t, t->forward, t->work);
    bw_poisson__cosine_columns_combine(t->n, t->width, t->twiddle, t->work, a);
  } else
    run(t, t->forward, a);
  /* Two real columns went through as one complex one: eigenvalues belong to each by itself. */
  if (t->separate) take_apart(t->n, t->width, a);
}

void bw_poisson__columns_backward(const bw_poisson__transform *t, bw_real *a)
{
  if (t->separate) put_together(t->n, t->width, a);
  if (t->kind->family == BW_POISSON__COSINE) {
    bw_poisson__cosine_columns_split(t->n, t->width, t->twiddle, a, t->work);
    run(t, t->backward, t->work);
    bw_poisson__cosine_columns_out(t->n, t->width, t->kind->odd, t->work, a);
  } else
    run(t, t->backward, a);
}
