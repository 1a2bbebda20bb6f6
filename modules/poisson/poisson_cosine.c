/* The cosine transform X_k = 2 sum_i x_i cos(pi k (i + 1/2)/n) by a Fourier transform of length n
 * (Makhoul 1980, IEEE Trans. ASSP 28, 27-34): several times faster than FFTW's own, whose real
 * transforms do not use vector instructions.
 *   v = x_0 x_2 x_4 ... x_5 x_3 x_1,  V = Fourier(v),  w_k = exp(-i pi k/2n),
 *   P = w_k V_k, Q = conj(w_k) V_{n-k}:   X_k = P + Q,   X_{n-k} = i (P - Q)     (X_0 = 2 V_0)
 * and back, 2 V_k = conj(w_k) (X_k - i X_{n-k}), 2 V_{n-k} = w_k (X_k + i X_{n-k}), 2 V_0 = X_0.
 * For real x, Q = conj(P) and half of V is enough (rows along x). For complex x, real and
 * imaginary part are two real columns transformed at once (columns along z).
 * The sine transform 2 sum_i x_i sin(pi (k+1)(i + 1/2)/n) is entry n-1-k of the cosine transform of
 * (-1)^i x_i: the values x_1, x_3, ... carry the factor `odd`, the order is left reversed. */
#include "bw_memory.h"
#include "poisson_internal.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

bw_status bw_poisson__twiddle(int n, bw_real **out)
{
  bw_real *t = NULL;
  BW_TRY(BW_ALLOCATE(out, 2 * (size_t)(n / 2 + 1)));
  t = *out;
  for (int k = 0; k <= n / 2; k++) {
    t[2 * k] = (bw_real)cos(0.5 * PI * k / n);
    t[2 * k + 1] = (bw_real)sin(0.5 * PI * k / n);
  }
  return BW_OK;
}

void bw_poisson__cosine_row_in(int n, bw_real odd, const bw_real *restrict row, bw_real *restrict v)
{
  const int evens = (n + 1) / 2;
  /* v = x_0 x_2 x_4 ... */
  for (int i = 0; i < evens; i++)
    v[i] = row[2 * i];
  /* ... x_5 x_3 x_1 from the end; the odd ones change sign for a sine transform. */
  for (int i = 0; i < n / 2; i++)
    v[n - 1 - i] = odd * row[2 * i + 1];
}

void bw_poisson__cosine_row_out(int n, bw_real odd, const bw_real *restrict v,
                                bw_real *restrict row)
{
  const int evens = (n + 1) / 2;
  for (int i = 0; i < n / 2; i++) {
    row[2 * i] = v[i];
    row[2 * i + 1] = odd * v[n - 1 - i];
  }
  if (n % 2 == 1) row[n - 1] = v[evens - 1];
}

void bw_poisson__cosine_row_combine(int n, const bw_real *restrict twiddle,
                                    const bw_real *restrict spectrum, bw_real *restrict out)
{
  out[0] = 2 * spectrum[0];
  /* Real x: X_k = 2 Re(w_k V_k) and X_{n-k} = -2 Im(w_k V_k). */
  for (int k = 1; k < (n + 1) / 2; k++) {
    const bw_real c = 2 * twiddle[2 * k], s = 2 * twiddle[2 * k + 1];
    const bw_real re = spectrum[2 * k], im = spectrum[2 * k + 1];
    out[k] = c * re + s * im;
    out[n - k] = s * re - c * im;
  }
  /* k = n/2 is its own partner: V is real there and w = (1 - i)/sqrt(2). */
  if (n % 2 == 0) out[n / 2] = 2 * twiddle[n] * spectrum[n];
}

void bw_poisson__cosine_row_split(int n, const bw_real *restrict twiddle,
                                  const bw_real *restrict in, bw_real *restrict spectrum)
{
  spectrum[0] = in[0];
  spectrum[1] = 0;
  /* 2 V_k = conj(w_k) (X_k - i X_{n-k}); only half of V is wanted, the inverse knows that v is
   * real. */
  for (int k = 1; k < (n + 1) / 2; k++) {
    const bw_real c = twiddle[2 * k], s = twiddle[2 * k + 1];
    spectrum[2 * k] = c * in[k] + s * in[n - k];
    spectrum[2 * k + 1] = s * in[k] - c * in[n - k];
  }
  if (n % 2 == 0) {
    spectrum[n] = 2 * twiddle[n] * in[n / 2];
    spectrum[n + 1] = 0;
  }
}

void bw_poisson__cosine_columns_in(int n, int width, bw_real odd, const bw_real *restrict a,
                                   bw_real *restrict v)
{
  for (int i = 0; i < n; i++) {
    const bw_real *from = a + (ptrdiff_t)i * width;
    bw_real *to = v + (ptrdiff_t)(i % 2 == 0 ? i / 2 : n - 1 - i / 2) * width;
    const bw_real factor = i % 2 == 0 ? 1 : odd;
#pragma omp simd
    for (int c = 0; c < width; c++)
      to[c] = factor * from[c];
  }
}

void bw_poisson__cosine_columns_out(int n, int width, bw_real odd, const bw_real *restrict v,
                                    bw_real *restrict a)
{
  for (int i = 0; i < n; i++) {
    const bw_real *from = v + (ptrdiff_t)(i % 2 == 0 ? i / 2 : n - 1 - i / 2) * width;
    bw_real *to = a + (ptrdiff_t)i * width;
    const bw_real factor = i % 2 == 0 ? 1 : odd;
#pragma omp simd
    for (int c = 0; c < width; c++)
      to[c] = factor * from[c];
  }
}

static void scale_row(int width, bw_real factor, const bw_real *restrict from, bw_real *restrict to)
{
  for (int c = 0; c < width; c++)
    to[c] = factor * from[c];
}

void bw_poisson__cosine_columns_combine(int n, int width, const bw_real *restrict twiddle,
                                        const bw_real *restrict v, bw_real *restrict a)
{
  scale_row(width, 2, v, a);
  /* P = w_k V_k and Q = conj(w_k) V_{n-k}; two neighbouring entries are one complex number. */
  for (int k = 1; k < (n + 1) / 2; k++) {
    const bw_real c = twiddle[2 * k], s = twiddle[2 * k + 1];
    const bw_real *f = v + (ptrdiff_t)k * width, *g = v + (ptrdiff_t)(n - k) * width;
    bw_real *x = a + (ptrdiff_t)k * width, *y = a + (ptrdiff_t)(n - k) * width;
#pragma omp simd
    for (int q = 0; q < width; q += 2) {
      /* Real and imaginary part of x are two columns of their own: X = P + Q holds for both at
       * once. */
      const bw_real p_re = c * f[q] + s * f[q + 1], p_im = c * f[q + 1] - s * f[q];
      const bw_real q_re = c * g[q] - s * g[q + 1], q_im = c * g[q + 1] + s * g[q];
      x[q] = p_re + q_re;
      x[q + 1] = p_im + q_im;
      /* X_{n-k} = i (P - Q). */
      y[q] = q_im - p_im;
      y[q + 1] = p_re - q_re;
    }
  }
  if (n % 2 == 0)
    scale_row(width, 2 * twiddle[n], v + (ptrdiff_t)(n / 2) * width,
              a + (ptrdiff_t)(n / 2) * width);
}

void bw_poisson__cosine_columns_split(int n, int width, const bw_real *restrict twiddle,
                                      const bw_real *restrict a, bw_real *restrict v)
{
  memcpy(v, a, (size_t)width * sizeof *v);
  /* 2 V_k = conj(w_k) (X_k - i X_{n-k}) and 2 V_{n-k} = w_k (X_k + i X_{n-k}), for both columns at
   * once. */
  for (int k = 1; k < (n + 1) / 2; k++) {
    const bw_real c = twiddle[2 * k], s = twiddle[2 * k + 1];
    const bw_real *x = a + (ptrdiff_t)k * width, *y = a + (ptrdiff_t)(n - k) * width;
    bw_real *f = v + (ptrdiff_t)k * width, *g = v + (ptrdiff_t)(n - k) * width;
#pragma omp simd
    for (int q = 0; q < width; q += 2) {
      const bw_real p_re = x[q] + y[q + 1], p_im = x[q + 1] - y[q];
      const bw_real q_re = x[q] - y[q + 1], q_im = x[q + 1] + y[q];
      f[q] = c * p_re - s * p_im;
      f[q + 1] = c * p_im + s * p_re;
      g[q] = c * q_re + s * q_im;
      g[q + 1] = c * q_im - s * q_re;
    }
  }
  if (n % 2 == 0)
    scale_row(width, 2 * twiddle[n], a + (ptrdiff_t)(n / 2) * width,
              v + (ptrdiff_t)(n / 2) * width);
}
