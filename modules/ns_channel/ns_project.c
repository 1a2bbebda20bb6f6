/* ns_project.c -- the two sweeps of the projection: divergence, and correction of u and p. */
#include "ns_channel_internal.h"

#include <math.h>

#define BW_INLINE static inline __attribute__((always_inline))

BW_INLINE double divergence_row(int n, bool planar, bool sum, bw_real sx, bw_real sy, bw_real sz,
                                const bw_real *restrict u, const bw_real *restrict v,
                                const bw_real *restrict vs, const bw_real *restrict w,
                                const bw_real *restrict wb, bw_real *restrict f)
{
  double total = 0.0;
#pragma omp simd reduction(+ : total)
  for (int i = 1; i <= n; i++) {
    bw_real d = (u[i] - u[i - 1]) * sx + (v[i] - vs[i]) * sy;
    if (!planar) d += (w[i] - wb[i]) * sz;
    f[i] = d;
    if (sum) total += (double)u[i];
  }
  return total;
}

BW_INLINE double divergence_all(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                                double scale, bool planar, bool sum, bw_real *f)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  double total = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      const bw_real *w = planar ? NULL : u[2] + at, *wb = planar ? NULL : w - plane;
      const bw_real c = (bw_real)scale;
      total +=
          m->dyf[j] * divergence_row(g->m[0], planar, sum, c * m->rdx, c * m->rdyf[j], c * m->rdz,
                                     u[0] + at, u[1] + at, u[1] + at - row, w, wb, f + at);
    }
  return total;
}

double bw_ns__divergence(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                         double scale, bool sum, bw_real *f)
{
  const bool planar = g->n[2] == 1;
  if (planar && sum) return divergence_all(g, m, u, scale, true, true, f);
  if (planar) return divergence_all(g, m, u, scale, true, false, f);
  if (sum) return divergence_all(g, m, u, scale, false, true, f);
  return divergence_all(g, m, u, scale, false, false, f);
}

typedef struct {
  bw_real sx, sy, sz, shift; /* scale/dx ... */
  bw_real rdx, rdy, rdz;
} correct_scalars;

/* Returns the largest sum |u_i|/dx_i of the row, and adds it up in *sum: what is not finite
 * survives a sum, but not a comparison. */
BW_INLINE bw_real correct_row(int n, bool planar, bool courant, const correct_scalars *restrict c,
                              bw_real *restrict u, bw_real *restrict v, bw_real *restrict w,
                              bw_real *restrict p, const bw_real *restrict f,
                              const bw_real *restrict fn, const bw_real *restrict ft, bw_real *sum)
{
  const bw_real sx = c->sx, sy = c->sy, sz = c->sz, shift = c->shift;
  const bw_real rdx = c->rdx, rdy = c->rdy, rdz = c->rdz;
  bw_real largest = 0, total = 0;
#pragma omp simd reduction(max : largest) reduction(+ : total)
  for (int i = 1; i <= n; i++) {
    const bw_real here = f[i];
    const bw_real un = u[i] + ((here - f[i + 1]) * sx + shift), vn = v[i] + (here - fn[i]) * sy;
    u[i] = un;
    v[i] = vn;
    p[i] += here;
    bw_real rate = 0;
    if (courant) rate = (un < 0 ? -un : un) * rdx + (vn < 0 ? -vn : vn) * rdy;
    if (!planar) {
      const bw_real wn = w[i] + (here - ft[i]) * sz;
      w[i] = wn;
      if (courant) rate += (wn < 0 ? -wn : wn) * rdz;
    }
    if (courant) {
      largest = rate > largest ? rate : largest;
      total += rate;
    }
  }
  *sum += total;
  return largest;
}

BW_INLINE double correct_all(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                             bw_real *p, const bw_real *phi, double scale, double shift,
                             bool planar, bool courant)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  const bw_real s = (bw_real)scale;
  bw_real largest = 0, sum = 0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      const correct_scalars c = {.sx = s * m->rdx,
                                 .sy = s * m->rdyc[j],
                                 .sz = s * m->rdz,
                                 .shift = (bw_real)shift,
                                 .rdx = m->rdx,
                                 .rdy = m->rdyc[j],
                                 .rdz = m->rdz};
      const bw_real most =
          correct_row(g->m[0], planar, courant, &c, u[0] + at, u[1] + at, planar ? NULL : u[2] + at,
                      p + at, phi + at, phi + at + row, phi + at + plane, &sum);
      largest = most > largest ? most : largest;
    }
  return isfinite(sum) ? (double)largest : (double)NAN;
}

double bw_ns__correct(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                      bw_real *p, const bw_real *phi, double scale, double shift, bool courant)
{
  const bool planar = g->n[2] == 1;
  if (planar && courant) return correct_all(g, m, u, p, phi, scale, shift, true, true);
  if (planar) return correct_all(g, m, u, p, phi, scale, shift, true, false);
  if (courant) return correct_all(g, m, u, p, phi, scale, shift, false, true);
  return correct_all(g, m, u, p, phi, scale, shift, false, false);
}

double bw_ns__courant(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3])
{
  double largest = 0.0, sum = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k);
        double rate =
            fabs((double)u[0][at]) * (double)m->rdx + fabs((double)u[1][at]) * (double)m->rdyc[j];
        if (u[2] != NULL) rate += fabs((double)u[2][at]) * (double)m->rdz;
        largest = rate > largest ? rate : largest;
        sum += rate;
      }
  return isfinite(sum) ? largest : (double)NAN;
}
