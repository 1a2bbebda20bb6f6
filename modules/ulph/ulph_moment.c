/* Moment matrices: definiteness, inverse, and the moment of a lattice. */
#include "ulph_internal.h"

vec_bits bw_ulph__above(int d, const vec A[6], double shift)
{
  /* By the leading minors; what is not a number is not definite. */
  const vec a = A[0] - shift, b = A[3] - shift, ab = a * b - A[1] * A[1];
  const vec_bits plane = (a > 0) & (ab > 0);
  if (d == 2) return plane;
  const vec c = A[5] - shift;
  const vec det = ab * c - a * A[4] * A[4] - b * A[2] * A[2] + 2 * A[1] * A[2] * A[4];
  return plane & (det > 0);
}

/* Its inverse. */
static void invert(int d, const vec A[6], vec out[6])
{
  memset(out, 0, 6 * sizeof *out);
  if (d == 2) {
    const vec over = 1 / (A[0] * A[3] - A[1] * A[1]);
    out[0] = A[3] * over, out[1] = -A[1] * over, out[3] = A[0] * over;
    return;
  }
  /* Cofactors of a symmetric matrix. */
  out[0] = A[3] * A[5] - A[4] * A[4];
  out[1] = A[2] * A[4] - A[1] * A[5];
  out[2] = A[1] * A[4] - A[2] * A[3];
  out[3] = A[0] * A[5] - A[2] * A[2];
  out[4] = A[1] * A[2] - A[0] * A[4];
  out[5] = A[0] * A[3] - A[1] * A[1];
  const vec over = 1 / (A[0] * out[0] + A[1] * out[1] + A[2] * out[2]);
  for (int k = 0; k < 6; k++)
    out[k] *= over;
}

/* M^-1 is replaced where the least eigenvalue is below this part of the full one. A particle of a
 * flat surface has half of it. With less, M^-1 makes sound so fast that steps of dx/c0 are not
 * stable: a rotating square patch blew up at 0.2. */
static const double SINGULAR = 0.35;

vec_bits bw_ulph__moment(const bw_ulph *u, const vec M[6], vec Minv[6])
{
  const int d = u->config.dimensions;
  const vec_bits singular = ~bw_ulph__above(d, M, SINGULAR * u->m2);
  const vec unit = (vec){0} + 1 / u->m2;
  invert(d, M, Minv);
  for (int k = 0; k < 6; k++)
    Minv[k] = vec_choose(singular, k == 0 || k == 3 || k == 5 ? unit : (vec){0}, Minv[k]);
  return singular;
}

/* sum w x^power dx^d over the sites with x >= least dx. */
static double lattice_sum(int d, double dx, double R, int least, int power)
{
  const int n = (int)ceil(R / dx);
  double sum = 0;
  for (int k = d == 3 ? -n : 0; k <= (d == 3 ? n : 0); k++)
    for (int j = -n; j <= n; j++)
      for (int i = least; i <= n; i++) {
        const double q = sqrt(i * i + j * j + k * k) * dx / R;
        if (q < 1) sum += pow(1 - q, 4) * (1 + 4 * q) * pow(i * dx, power);
      }
  return sum * pow(dx, d);
}

double bw_ulph__lattice_moment(int d, double dx, double R)
{
  return lattice_sum(d, dx, R, -(int)ceil(R / dx), 2);
}

double bw_ulph__half_space(int d, double dx, double R, int k)
{
  return lattice_sum(d, dx, R, k + 1, 1);
}
