/* ns_project.c -- the two sweeps of the projection: divergence, and correction of u and p. */
#include "ns_channel_internal.h"

#include <math.h>

BW_NS_INLINE double divergence_row(int n, bool planar, bool sum, bw_real sx, bw_real sy, bw_real sz,
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
    /* The bulk velocity is summed on the way: u is in registers here. */
    if (sum) total += (double)u[i];
  }
  return total;
}

BW_NS_INLINE double divergence_all(const bw_grid_view *g, const bw_ns_metrics *m,
                                   bw_real *const u[3], double scale, bool planar, bool sum,
                                   bw_real *f)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  double total = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      const bw_real *w = planar ? NULL : u[2] + at, *wb = planar ? NULL : w - plane;
      const bw_real c = (bw_real)scale;
      /* Weighted with the height of the row, as cells may be stretched in y. */
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
  /* Constants at each call, so that every instance has an inner loop without branches. */
  if (planar && sum) return divergence_all(g, m, u, scale, true, true, f);
  if (planar) return divergence_all(g, m, u, scale, true, false, f);
  if (sum) return divergence_all(g, m, u, scale, false, true, f);
  return divergence_all(g, m, u, scale, false, false, f);
}

typedef struct {
  bw_real sx, sy, sz, shift; /* scale/dx ... */
  bw_real rdx, rdy, rdz;
} correct_scalars;

/* Corrects cell i; returns its sum |u_i|/dx_i when asked. */
BW_NS_INLINE bw_real correct_cell(int i, bool planar, bool courant, const correct_scalars *c,
                                  bw_real *restrict u, bw_real *restrict v, bw_real *restrict w,
                                  bw_real *restrict p, const bw_real *restrict f,
                                  const bw_real *restrict fn, const bw_real *restrict ft)
{
  const bw_real here = f[i];
  /* u <- u* - gamma_r dt grad p^ (POROUS 3.72), all three components from one read of p^. */
  const bw_real un = u[i] + ((here - f[i + 1]) * c->sx + c->shift);
  const bw_real vn = v[i] + (here - fn[i]) * c->sy;
  bw_real rate = 0;
  u[i] = un;
  v[i] = vn;
  /* p <- p + p^ (POROUS 3.73). */
  p[i] += here;
  /* The new |u_i|/dx_i costs nothing here and saves a sweep before the next step. */
  if (courant) rate = (un < 0 ? -un : un) * c->rdx + (vn < 0 ? -vn : vn) * c->rdy;
  if (planar) return rate;
  const bw_real wn = w[i] + (here - ft[i]) * c->sz;
  w[i] = wn;
  return courant ? rate + (wn < 0 ? -wn : wn) * c->rdz : rate;
}

enum { LANES = 8 }; /* partial results side by side: compilers vectorise them without -ffast-math */

/* Per lane the largest sum |u_i|/dx_i and their sum: what is not finite survives a sum, but not a
 * comparison. */
typedef struct {
  bw_real most[LANES], total[LANES];
} courant_lanes;

BW_NS_INLINE void correct_cells(int n, bool planar, bool courant, const correct_scalars *restrict c,
                                bw_real *restrict u, bw_real *restrict v, bw_real *restrict w,
                                bw_real *restrict p, const bw_real *restrict f,
                                const bw_real *restrict fn, const bw_real *restrict ft,
                                courant_lanes *restrict lanes)
{
  int i = 1;
  /* Whole groups of lanes, then the rest of the row one by one. */
  for (; courant && i + LANES - 1 <= n; i += LANES)
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const bw_real rate = correct_cell(i + l, planar, true, c, u, v, w, p, f, fn, ft);
      lanes->most[l] = rate > lanes->most[l] ? rate : lanes->most[l];
      lanes->total[l] += rate;
    }
  for (; courant && i <= n; i++) {
    const bw_real rate = correct_cell(i, planar, true, c, u, v, w, p, f, fn, ft);
    lanes->most[0] = rate > lanes->most[0] ? rate : lanes->most[0];
    lanes->total[0] += rate;
  }
  /* Without the Courant number nothing is reduced and all cells are handled here. */
#pragma omp simd
  for (int q = i; q <= n; q++)
    correct_cell(q, planar, false, c, u, v, w, p, f, fn, ft);
}

BW_NS_INLINE double correct_all(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                                bw_real *p, const bw_real *phi, double scale, double shift,
                                bool planar, bool courant)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  const bw_real s = (bw_real)scale;
  courant_lanes lanes = {{0}, {0}};
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      /* v has its gradient over the distance of centres, which changes from row to row. */
      const correct_scalars c = {.sx = s * m->rdx,
                                 .sy = s * m->rdyc[j],
                                 .sz = s * m->rdz,
                                 .shift = (bw_real)shift,
                                 .rdx = m->rdx,
                                 .rdy = m->rdyc[j],
                                 .rdz = m->rdz};
      correct_cells(g->m[0], planar, courant, &c, u[0] + at, u[1] + at, planar ? NULL : u[2] + at,
                    p + at, phi + at, phi + at + row, phi + at + plane, &lanes);
    }
  /* Lanes are joined once per field, not per row. */
  double largest = 0.0, sum = 0.0;
  for (int l = 0; l < LANES; l++) {
    largest = fmax(largest, (double)lanes.most[l]);
    sum += (double)lanes.total[l];
  }
  /* One value that is not finite makes the sum so: nothing else has to look at the field. */
  return isfinite(sum) ? largest : (double)NAN;
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

/* The same numbers as `correct` finds, to the last bit: a restart chooses the same step. */
double bw_ns__courant(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3])
{
  bw_real largest = 0;
  double sum = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k);
        const bw_real x = u[0][at], y = u[1][at], z = u[2] != NULL ? u[2][at] : 0;
        /* The same operations in the same order as in correct_cell. */
        bw_real rate = (x < 0 ? -x : x) * m->rdx + (y < 0 ? -y : y) * m->rdyc[j];
        if (u[2] != NULL) rate += (z < 0 ? -z : z) * m->rdz;
        largest = rate > largest ? rate : largest;
        sum += (double)rate;
      }
  return isfinite(sum) ? (double)largest : (double)NAN;
}
