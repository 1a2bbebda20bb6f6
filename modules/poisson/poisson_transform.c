/* Which transform diagonalises the second difference of cell-centred values under which pair of
 * conditions on the boundary faces.
 *
 * With ghosts phi_0 = +phi_1 (Neumann) or -phi_1 (Dirichlet) the eigenvectors are samples, at the
 * centres i - 1/2, of cos(theta (i-1/2)) or sin(theta (i-1/2)) whose continuation has the same
 * symmetry about the upper face n + 1/2, hence theta = pi (k + offset)/n with offset 0 (N-N:
 * cosine, DCT-II), 1 (D-D: sine, DST-II), 1/2 (N-D: cosine, DCT-IV; D-N: sine, DST-IV); periodic
 * ones are exp(i theta j), theta = 2 pi k/n. Always lambda = (2 cos theta - 2)/h^2. */
#include "bw_memory.h"
#include "poisson_internal.h"

#include <math.h>

#define PI 3.14159265358979323846
#define P  BW_POISSON_PERIODIC
#define N  BW_POISSON_NEUMANN
#define D  BW_POISSON_DIRICHLET

static const bw_poisson__kind kinds[] = {
    {{P, P}, true, FFTW_R2HC, FFTW_HC2R, 1, 2.0, 0.0},
    {{N, N}, false, FFTW_REDFT10, FFTW_REDFT01, 2, 1.0, 0.0},
    {{D, D}, false, FFTW_RODFT10, FFTW_RODFT01, 2, 1.0, 1.0},
    {{N, D}, false, FFTW_REDFT11, FFTW_REDFT11, 2, 1.0, 0.5},
    {{D, N}, false, FFTW_RODFT11, FFTW_RODFT11, 2, 1.0, 0.5},
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

int bw_poisson__columns(const bw_poisson__kind *kind, int n)
{
  return kind->periodic ? 2 * (n / 2 + 1) : n;
}

static bw_status made(const bw_poisson__transform *t, const char *axis, int n)
{
  BW_REQUIRE(t->forward != NULL && t->backward != NULL, BW_EMEM,
             "poisson: FFTW made no plan for %d cells in %s", n, axis);
  return BW_OK;
}

bw_status bw_poisson__rows(const bw_poisson__kind *kind, int n, bw_poisson__transform *out)
{
  bw_real *a = NULL, *b = NULL;
  bw_status st = BW_ALLOCATE(&a, (size_t)n);
  BW_THEN(st, BW_ALLOCATE(&b, (size_t)bw_poisson__columns(kind, n)));
  if (st == BW_OK) {
    BW_FFTW(complex) *spectrum = (BW_FFTW(complex) *)b;
    out->complex_numbers = kind->periodic;
    out->forward = kind->periodic ? BW_FFTW(plan_dft_r2c_1d)(n, a, spectrum, FFTW_MEASURE)
                                  : BW_FFTW(plan_r2r_1d)(n, a, b, kind->forward, FFTW_MEASURE);
    out->backward = kind->periodic ? BW_FFTW(plan_dft_c2r_1d)(n, spectrum, a, FFTW_MEASURE)
                                   : BW_FFTW(plan_r2r_1d)(n, b, a, kind->backward, FFTW_MEASURE);
    st = made(out, "x", n);
  }
  bw_release(&a);
  bw_release(&b);
  return st;
}

bw_status bw_poisson__columns_along_z(const bw_poisson__kind *kind, int n, int width,
                                      bool complex_numbers, bw_poisson__transform *out)
{
  bw_real *a = NULL;
  bw_status st = BW_ALLOCATE(&a, (size_t)n * (size_t)width);
  /* Rows of a narrow block start anywhere. */
  const unsigned flags =
      FFTW_MEASURE | ((size_t)width * sizeof *a % 64 == 0 ? 0u : (unsigned)FFTW_UNALIGNED);
  out->complex_numbers = complex_numbers && kind->periodic;
  if (st == BW_OK && out->complex_numbers) {
    BW_FFTW(complex) *z = (BW_FFTW(complex) *)a;
    const int pairs = width / 2;
    out->forward = BW_FFTW(plan_many_dft)(1, &n, pairs, z, NULL, pairs, 1, z, NULL, pairs, 1,
                                          FFTW_FORWARD, flags);
    out->backward = BW_FFTW(plan_many_dft)(1, &n, pairs, z, NULL, pairs, 1, z, NULL, pairs, 1,
                                           FFTW_BACKWARD, flags);
  } else if (st == BW_OK) {
    out->forward = BW_FFTW(plan_many_r2r)(1, &n, width, a, NULL, width, 1, a, NULL, width, 1,
                                          &kind->forward, flags);
    out->backward = BW_FFTW(plan_many_r2r)(1, &n, width, a, NULL, width, 1, a, NULL, width, 1,
                                           &kind->backward, flags);
  }
  BW_THEN(st, made(out, "z", n));
  bw_release(&a);
  return st;
}

void bw_poisson__transform_destroy(bw_poisson__transform *t)
{
  if (t->forward != NULL) BW_FFTW(destroy_plan)(t->forward);
  if (t->backward != NULL) BW_FFTW(destroy_plan)(t->backward);
  t->forward = t->backward = NULL;
}

void bw_poisson__row_forward(const bw_poisson__transform *t, bw_real *in, bw_real *out)
{
  if (t->complex_numbers)
    BW_FFTW(execute_dft_r2c)(t->forward, in, (BW_FFTW(complex) *)out);
  else
    BW_FFTW(execute_r2r)(t->forward, in, out);
}

void bw_poisson__row_backward(const bw_poisson__transform *t, bw_real *in, bw_real *out)
{
  if (t->complex_numbers)
    BW_FFTW(execute_dft_c2r)(t->backward, (BW_FFTW(complex) *)in, out);
  else
    BW_FFTW(execute_r2r)(t->backward, in, out);
}

static void column(const bw_poisson__transform *t, BW_FFTW(plan) plan, bw_real *a)
{
  if (t->complex_numbers)
    BW_FFTW(execute_dft)(plan, (BW_FFTW(complex) *)a, (BW_FFTW(complex) *)a);
  else
    BW_FFTW(execute_r2r)(plan, a, a);
}

void bw_poisson__column_forward(const bw_poisson__transform *t, bw_real *a)
{
  column(t, t->forward, a);
}

void bw_poisson__column_backward(const bw_poisson__transform *t, bw_real *a)
{
  column(t, t->backward, a);
}

static double eigenvalue(const bw_poisson__kind *kind, int n, double spacing, int k)
{
  const double s = 2.0 * sin(0.5 * kind->turns * PI * (k + kind->offset) / n) / spacing;
  return -s * s;
}

void bw_poisson__eigenvalues_x(const bw_poisson__kind *kind, int n, double spacing, double lambda[])
{
  const int columns = bw_poisson__columns(kind, n);
  for (int c = 0; c < columns; c++) /* periodic: real and imaginary part share one */
    lambda[c] = eigenvalue(kind, n, spacing, kind->periodic ? c / 2 : c);
}

void bw_poisson__eigenvalues_z(const bw_poisson__kind *kind, int n, double spacing,
                               bool complex_numbers, double lambda[])
{
  (void)complex_numbers; /* c2c order k = 0..n-1 and half-complex order r0 .. r_n/2 .. i1 both
                            have wavenumber k or n - k at entry k: the same sine squared */
  for (int k = 0; k < n; k++)
    lambda[k] = eigenvalue(kind, n, spacing, k);
}
