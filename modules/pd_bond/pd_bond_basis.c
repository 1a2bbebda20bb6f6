/* The conditions of the correction `tensor` (pd_bond_tensor.c), orthonormal over a full family. */
#include "bw_memory.h"
#include "pd_bond_tensor.h"

#include <math.h>
#include <string.h>

enum { EVEN = 15, MOST = BW_PD_BOND_CONDITIONS };

/* Mean of x^a y^b z^c over the directions: (a-1)!! (b-1)!! (c-1)!!/(d (d + 2)), degree 4. */
static double isotropic(const int power[3], int dimension)
{
  static const double odd_factorial[] = {1, 0, 1, 0, 3};
  double mean = 1.0 / (dimension * (dimension + 2));
  for (int k = 0; k < 3; k++)
    mean *= odd_factorial[power[k]];
  return mean;
}

/* Exponents of the monomials of degree 4; returns how many. */
static int monomials(int dimension, int power[EVEN][3])
{
  int n = 0;
  for (int a = 0; a <= 4; a++)
    for (int b = 0; a + b <= 4; b++) {
      const int c = 4 - a - b;
      if (dimension == 2 && c > 0) continue;
      power[n][0] = a, power[n][1] = b, power[n][2] = c;
      n++;
    }
  return n;
}

/* Harmonics of degree 3 of the unit vector e; returns how many. */
static int harmonics(int dimension, const double e[3], double out[MOST - EVEN])
{
  const double x = e[0], y = e[1], z = e[2];
  /* Real and imaginary part of (x + iy)^3, up to sign. */
  if (dimension == 2) {
    out[0] = x * (x * x - 3 * y * y);
    out[1] = y * (y * y - 3 * x * x);
    return 2;
  }
  out[0] = x * y * z;
  for (int k = 0; k < 3; k++) {
    const double p = e[k], q = e[(k + 1) % 3], r = e[(k + 2) % 3];
    out[1 + k] = p * (q * q - r * r);
    out[4 + k] = p * (5 * p * p - 3);
  }
  return MOST - EVEN;
}

/* The conditions of direction q, not yet orthonormal; returns K. Distances in ds. */
static int conditions(const bw_pd_body *pd, int q, double f[MOST])
{
  const bw_pd_stencil *s = &pd->level[0].stencil;
  /* Lengths in ds: numbers of order 1, whatever the unit. */
  const double r = s->r0[q] / pd->level[0].ds;
  int power[EVEN][3];
  double e[3];
  for (int k = 0; k < 3; k++)
    e[k] = s->offset[3 * q + k] * (s->unit / pd->level[0].ds) / r;
  /* Even conditions carry the energy's |xi|; odd ones are of the direction alone. */
  const int n = monomials(pd->dimension, power);
  for (int k = 0; k < n; k++)
    f[k] = r * pow(e[0], power[k][0]) * pow(e[1], power[k][1]) * pow(e[2], power[k][2]);
  return n + harmonics(pd->dimension, e, f + n);
}

/* One vector of the basis: f (directions) and its target less their parts along the `n` ones
 * there are, normalised. False: nothing is left, the condition follows from the others. */
static bool orthonormal(const bw_pd_stencil *s, const double basis[], int n, const double target[],
                        double f[], double *t)
{
  /* Gram-Schmidt in the inner product that is weighted with Gamma. */
  double before = 0, norm = 0;
  for (int q = 0; q < s->same; q++)
    before += s->fraction[q] * f[q] * f[q];
  for (int k = 0; k < n; k++) {
    const double *b = basis + (size_t)k * (size_t)s->same;
    double along = 0;
    for (int q = 0; q < s->same; q++)
      along += s->fraction[q] * b[q] * f[q];
    for (int q = 0; q < s->same; q++)
      f[q] -= along * b[q];
    *t -= along * target[k];
  }
  for (int q = 0; q < s->same; q++)
    norm += s->fraction[q] * f[q] * f[q];
  /* In the plane or with few neighbours some conditions follow from others. */
  if (!(norm > 1e-9 * before)) return false;
  for (int q = 0; q < s->same; q++)
    f[q] /= sqrt(norm);
  *t /= sqrt(norm);
  return true;
}

/* phi, T and the multipliers of a full family, whose factors 1 + full.phi go to state.bulk. */
bw_status bw_pd_bond__basis(bw_pd_body *pd, bw_pd_bond_solver *v)
{
  const bw_pd_stencil *s = &pd->level[0].stencil;
  double *bulk = bw_pd_bond__own(pd)->bulk;
  const size_t n = (size_t)s->same;
  double *rows = NULL, total = 0;
  for (size_t q = 0; q < n; q++)
    bulk[q] = 1;
  int power[EVEN][3], all = MOST;
  const int even = monomials(pd->dimension, power);
  BW_TRY(BW_ALLOCATE(&rows, MOST * n));
  /* The conditions as functions of the direction, and the first moment that sets their scale. */
  for (int q = 0; q < s->same; q++) {
    double f[MOST];
    all = conditions(pd, q, f);
    for (int k = 0; k < all; k++)
      rows[(size_t)k * n + (size_t)q] = f[k];
    total += s->fraction[q] * s->r0[q] / pd->level[0].ds;
  }
  /* Targets: of degree 4 the isotropic mean, of degree 3 nothing. Orthonormal ones stay. */
  for (int k = 0; k < all; k++) {
    double *f = rows + (size_t)v->n * n,
           t = k < even ? total * isotropic(power[k], pd->dimension) : 0;
    memmove(f, rows + (size_t)k * n, n * sizeof *f);
    if (!orthonormal(s, rows, v->n, v->target, f, &t)) continue;
    /* What a full family lacks is its multiplier: with orthonormal phi one step solves it. */
    v->target[v->n] = v->full[v->n] = t;
    for (int q = 0; q < s->same; q++)
      v->full[v->n] -= s->fraction[q] * f[q];
    v->n++;
  }
  /* Sweeps read all conditions of a direction at once: transposed. */
  const bw_status st = BW_ALLOCATE(&v->phi, n * (size_t)v->n);
  for (int k = 0; k < v->n && st == BW_OK; k++)
    for (size_t q = 0; q < n; q++) {
      v->phi[q * (size_t)v->n + (size_t)k] = (bw_real)rows[(size_t)k * n + q];
      bulk[q] += v->full[k] * rows[(size_t)k * n + q];
    }
  bw_release(&rows);
  return st;
}
