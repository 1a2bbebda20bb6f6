/* Reynolds' equation on the patch: finite volumes, conjugate gradients.
 *
 * -div(h^3/(12 mu) grad p) over a cell is the sum over its edges of conductance times difference;
 * beside what is no film the pressure is that of the edge, half a cell away. */
#include "film_internal.h"

#include <math.h>
#include <string.h>

static const double TOLERANCE = 1e-9; /* of the residual, in the norm of the preconditioner */

void bw_film__conduct(bw_film *f, const double h[])
{
  const double per_mu = 1.0 / (12.0 * f->config.mu);
  memset(f->diagonal, 0, film_cells(f) * sizeof *f->diagonal);
  for (int d = 0; d < (f->config.planar ? 1 : 2); d++)
    for (int j = 0; j < f->n[1]; j++)
      for (int i = 0; i < f->n[0]; i++) {
        const ptrdiff_t at = i + (ptrdiff_t)f->n[0] * j, stride = d == 0 ? 1 : f->n[0];
        const int place = d == 0 ? i : j;
        const double across = film_area(f, i, j) / f->width[d][place] * per_mu;
        const bool up = place + 1 < f->n[d] && f->film[at + stride];
        const bool down = place > 0 && f->film[at - stride];
        f->k[d][at] = f->edge[d][0][at] = f->edge[d][1][at] = 0.0;
        if (!f->film[at]) continue;
        /* The gap on the edge is the mean of both sides. */
        const double edge = 2.0 * across * pow(h[at], 3) / f->width[d][place];
        if (up)
          f->k[d][at] = across * pow(0.5 * (h[at] + h[at + stride]), 3) /
                        (f->at[d][place + 1] - f->at[d][place]);
        else
          f->edge[d][1][at] = edge;
        if (!down) f->edge[d][0][at] = edge;
        f->diagonal[at] += f->k[d][at] + f->edge[d][0][at] + f->edge[d][1][at];
        if (up) f->diagonal[at + stride] += f->k[d][at];
      }
}

/* out = A x. */
static void product(const bw_film *f, const double *restrict x, double *restrict out)
{
  for (size_t at = 0; at < film_cells(f); at++)
    out[at] = f->diagonal[at] * x[at];
  for (int d = 0; d < (f->config.planar ? 1 : 2); d++) {
    const ptrdiff_t stride = d == 0 ? 1 : f->n[0];
    for (ptrdiff_t at = 0; at + stride < (ptrdiff_t)film_cells(f); at++) {
      out[at] -= f->k[d][at] * x[at + stride];
      out[at + stride] -= f->k[d][at] * x[at];
    }
  }
}

static double dot(const bw_film *f, const double a[], const double b[])
{
  double sum = 0.0;
  for (size_t at = 0; at < film_cells(f); at++)
    sum += a[at] * b[at];
  return sum;
}

/* q = r/diagonal, and r.q. */
static double precondition(bw_film *f)
{
  for (size_t at = 0; at < film_cells(f); at++)
    f->q[at] = f->film[at] ? f->r[at] / f->diagonal[at] : 0.0;
  return dot(f, f->r, f->q);
}

bw_status bw_film__solve(bw_film *f)
{
  const size_t n = film_cells(f);
  product(f, f->p, f->r);
  for (size_t at = 0; at < n; at++)
    f->r[at] = f->film[at] ? f->rhs[at] - f->r[at] : 0.0;
  double now = precondition(f), first = 0.0;
  for (size_t at = 0; at < n; at++)
    first += f->film[at] ? f->rhs[at] * f->rhs[at] / f->diagonal[at] : 0.0;
  memcpy(f->d, f->q, n * sizeof *f->d);
  /* As many iterations as unknowns would do in exact arithmetic. */
  for (size_t it = 0; it < 4 * n && now > TOLERANCE * TOLERANCE * first; it++) {
    product(f, f->d, f->q);
    const double step = now / dot(f, f->d, f->q), before = now;
    for (size_t at = 0; at < n; at++) {
      f->p[at] += step * f->d[at];
      f->r[at] -= step * f->q[at];
    }
    now = precondition(f);
    for (size_t at = 0; at < n; at++)
      f->d[at] = f->q[at] + now / before * f->d[at];
  }
  BW_REQUIRE(now <= TOLERANCE * TOLERANCE * first, BW_EDIVERGED,
             "film: Reynolds' equation did not converge (residual %g): gaps differ too much",
             sqrt(now / first));
  return BW_OK;
}
