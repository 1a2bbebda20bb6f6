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
} correct_scalars;

/* Corrects cell i. */
BW_NS_INLINE void correct_cell(int i, bool planar, const correct_scalars *c, bw_real *restrict u,
                               bw_real *restrict v, bw_real *restrict w, bw_real *restrict p,
                               const bw_real *restrict f, const bw_real *restrict fn,
                               const bw_real *restrict ft)
{
  const bw_real here = f[i];
  /* u <- u* - gamma_r dt grad p^ (POROUS 3.72), all three components from one read of p^. */
  u[i] += (here - f[i + 1]) * c->sx + c->shift;
  v[i] += (here - fn[i]) * c->sy;
  if (!planar) w[i] += (here - ft[i]) * c->sz;
  /* p <- p + p^ (POROUS 3.73). */
  p[i] += here;
}

BW_NS_INLINE void correct_cells(int n, bool planar, const correct_scalars *restrict c,
                                bw_real *restrict u, bw_real *restrict v, bw_real *restrict w,
                                bw_real *restrict p, const bw_real *restrict f,
                                const bw_real *restrict fn, const bw_real *restrict ft)
{
#pragma omp simd
  for (int i = 1; i <= n; i++)
    correct_cell(i, planar, c, u, v, w, p, f, fn, ft);
}

enum { LANES = 8 }; /* partial results side by side: compilers vectorise them without -ffast-math */

/* Per lane the largest rate and their sum: what is not finite survives a sum, but not a
 * comparison. */
typedef struct {
  bw_real most[LANES], total[LANES];
} courant_lanes;

typedef struct {
  bw_real x, y, z; /* 1/(2 dx) ... of the row's cells */
} courant_scalars;

/* Row sum of the convective operator of cell i: half of sum_d (|u_d below| + |u_d above|)/dx_d.
 * Both faces count, so that it is the same whichever way the stream goes. */
BW_NS_INLINE bw_real courant_rate(int i, bool planar, courant_scalars c, const bw_real *restrict u,
                                  const bw_real *restrict v, const bw_real *restrict vs,
                                  const bw_real *restrict w, const bw_real *restrict wb)
{
#define BW_ABS(x) ((x) < 0 ? -(x) : (x))
  const bw_real rate =
      (BW_ABS(u[i - 1]) + BW_ABS(u[i])) * c.x + (BW_ABS(vs[i]) + BW_ABS(v[i])) * c.y;
  return planar ? rate : rate + (BW_ABS(wb[i]) + BW_ABS(w[i])) * c.z;
#undef BW_ABS
}

BW_NS_INLINE void courant_cells(int n, bool planar, courant_scalars c, const bw_real *restrict u,
                                const bw_real *restrict v, const bw_real *restrict vs,
                                const bw_real *restrict w, const bw_real *restrict wb,
                                courant_lanes *restrict lanes)
{
  int i = 1;
  /* Whole groups of lanes, then the rest of the row one by one. */
  for (; i + LANES - 1 <= n; i += LANES)
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const bw_real rate = courant_rate(i + l, planar, c, u, v, vs, w, wb);
      lanes->most[l] = rate > lanes->most[l] ? rate : lanes->most[l];
      lanes->total[l] += rate;
    }
  for (; i <= n; i++) {
    const bw_real rate = courant_rate(i, planar, c, u, v, vs, w, wb);
    lanes->most[0] = rate > lanes->most[0] ? rate : lanes->most[0];
    lanes->total[0] += rate;
  }
}

/* Courant rates of row (j, k), whose lower faces are valid. */
BW_NS_INLINE void courant_row(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                              int j, int k, bool planar, courant_lanes *lanes)
{
  const bw_real half = (bw_real)0.5;
  const courant_scalars c = {half * m->rdx, half * m->rdyf[j], half * m->rdz};
  const ptrdiff_t at = bw_at(g, 0, j, k);
  const bw_real *v = u[1] + at, *w = planar ? NULL : u[2] + at;
  courant_cells(g->m[0], planar, c, u[0] + at, v, v - g->stride[1], w,
                planar ? NULL : w - g->stride[2], lanes);
}

/* Lanes are joined once per field, not per row. One value that is not finite makes the sum so:
 * nothing else has to look at the field. */
static double join_lanes(const courant_lanes *lanes)
{
  double largest = 0.0, sum = 0.0;
  for (int l = 0; l < LANES; l++) {
    largest = fmax(largest, (double)lanes->most[l]);
    sum += (double)lanes->total[l];
  }
  return isfinite(sum) ? largest : (double)NAN;
}

/* What the correction needs of a row; v has its gradient over the distance of centres, which
 * changes from row to row. */
static correct_scalars scalars_of(const bw_ns_metrics *m, int j, double scale, double shift)
{
  const bw_real s = (bw_real)scale;
  return (correct_scalars){
      .sx = s * m->rdx, .sy = s * m->rdyc[j], .sz = s * m->rdz, .shift = (bw_real)shift};
}

/* The faces below the first cells, which belong to another rank or to the periodic image, get the
 * value that their owner gives them: the Courant number reads them before the next halo. At a side
 * the difference of p^ is zero. */
static void correct_lower_faces(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                                const bw_real *phi, double scale, double shift)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  const correct_scalars c = scalars_of(m, 0, scale, shift);
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      u[0][at] += (phi[at] - phi[at + 1]) * c.sx + c.shift;
    }
  for (int k = 1; k <= g->m[2]; k++)
    for (int i = 1; i <= g->m[0]; i++) {
      const ptrdiff_t at = bw_at(g, i, 0, k);
      u[1][at] += (phi[at] - phi[at + row]) * c.sy;
    }
  for (int j = 1; j <= g->m[1] && u[2] != NULL; j++)
    for (int i = 1; i <= g->m[0]; i++) {
      const ptrdiff_t at = bw_at(g, i, j, 0);
      u[2][at] += (phi[at] - phi[at + plane]) * c.sz;
    }
}

BW_NS_INLINE double correct_all(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                                bw_real *p, const bw_real *phi, double scale, double shift,
                                bool planar, bool courant)
{
  const ptrdiff_t row = g->stride[1], plane = g->stride[2];
  courant_lanes lanes = {{0}, {0}};
  if (courant) correct_lower_faces(g, m, u, phi, scale, shift);
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      const correct_scalars c = scalars_of(m, j, scale, shift);
      correct_cells(g->m[0], planar, &c, u[0] + at, u[1] + at, planar ? NULL : u[2] + at, p + at,
                    phi + at, phi + at + row, phi + at + plane);
      /* The row is in the first-level cache: this saves a sweep before the next step. */
      if (courant) courant_row(g, m, u, j, k, planar, &lanes);
    }
  return join_lanes(&lanes);
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
  courant_lanes lanes = {{0}, {0}};
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      courant_row(g, m, u, j, k, u[2] == NULL, &lanes);
  return join_lanes(&lanes);
}
