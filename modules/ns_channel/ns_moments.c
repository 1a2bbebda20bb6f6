/* ns_moments.c -- sums over the rows of one field, the kernels of the statistics. */
#include "ns_statistics_internal.h"

/* Rows of one j, k and their neighbours in y and z. */
typedef struct {
  const bw_real *u, *u_next, *u_above;
  const bw_real *v, *v_below, *v_next;
  const bw_real *w, *w_before, *w_above;
  const bw_real *p, *p_above;
} neighbours;

/* Sums of the centre moments. rdy: 1 over the height of the cell. */
static void centre_row(int n, double rdx, double rdy, double rdz, const neighbours *at,
                       double s[restrict])
{
  const bw_real *restrict u = at->u, *restrict u_next = at->u_next, *restrict w = at->w;
  const bw_real *restrict p = at->p, *restrict v = at->v, *restrict v_below = at->v_below;
  const bw_real *restrict w_before = at->w_before;
  double u1 = 0, u2 = 0, u3 = 0, u4 = 0, w1 = 0, w2 = 0, w3 = 0, w4 = 0, p1 = 0, p2 = 0, uw = 0;
  double o1 = 0, o2 = 0, gg = 0;
/* Sums stay in registers over the row; each moment has one of its own. */
#pragma omp simd reduction(+ : u1, u2, u3, u4, w1, w2, w3, w4, p1, p2, uw, o1, o2, gg)
  for (int i = 0; i < n; i++) {
    const double a = (double)u[i], c = (double)w[i], q = (double)p[i];
    const double a_next = (double)u_next[i], c_next = (double)w[i + 1];
    /* Vorticity about y on the edge that u and w share; gradients where the scheme has them. */
    const double uz = (a_next - a) * rdz, wx = (c_next - c) * rdx, o = uz - wx;
    const double ux = (a - (double)u[i - 1]) * rdx, wz = (c - (double)w_before[i]) * rdz;
    const double vy = ((double)v[i] - (double)v_below[i]) * rdy;
    u1 += a, u2 += a * a, u3 += a * a * a, u4 += (a * a) * (a * a);
    w1 += c, w2 += c * c, w3 += c * c * c, w4 += (c * c) * (c * c);
    p1 += q, p2 += q * q;
    /* The product on that edge too: means of two, the factor 1/4 follows below. */
    uw += (a + a_next) * (c + c_next);
    o1 += o, o2 += o * o;
    gg += ux * ux + vy * vy + wz * wz + uz * uz + wx * wx;
  }
  /* One row is added; the caller's s runs over all rows of this height. */
  s[BW_NS_MOMENT_U] += u1, s[BW_NS_MOMENT_UU] += u2;
  s[BW_NS_MOMENT_UUU] += u3, s[BW_NS_MOMENT_UUUU] += u4;
  s[BW_NS_MOMENT_W] += w1, s[BW_NS_MOMENT_WW] += w2;
  s[BW_NS_MOMENT_WWW] += w3, s[BW_NS_MOMENT_WWWW] += w4;
  s[BW_NS_MOMENT_P] += p1, s[BW_NS_MOMENT_PP] += p2;
  s[BW_NS_MOMENT_UW] += 0.25 * uw;
  s[BW_NS_MOMENT_OY] += o1, s[BW_NS_MOMENT_OYOY] += o2;
  s[BW_NS_MOMENT_GRADIENTS] += gg;
}

/* Sums of the face moments. rdy: 1 over the distance of the centres. */
static void face_row(int n, double rdx, double rdy, double rdz, const neighbours *at,
                     double s[restrict])
{
  const bw_real *restrict v = at->v, *restrict v_next = at->v_next;
  const bw_real *restrict u = at->u, *restrict u_above = at->u_above;
  const bw_real *restrict w = at->w, *restrict w_above = at->w_above;
  const bw_real *restrict p = at->p, *restrict p_above = at->p_above;
  double v1 = 0, v2 = 0, v3 = 0, v4 = 0, uv = 0, vw = 0, x1 = 0, x2 = 0, z1 = 0, z2 = 0;
  double gg = 0, vuu = 0, vww = 0, pv = 0;
/* v sits here; u and w are met half way between this height and the one above. */
#pragma omp simd reduction(+ : v1, v2, v3, v4, uv, vw, x1, x2, z1, z2, gg, vuu, vww, pv)
  for (int i = 0; i < n; i++) {
    const double b = (double)v[i], b_right = (double)v[i + 1], b_next = (double)v_next[i];
    const double a = (double)u[i], a_above = (double)u_above[i];
    const double c = (double)w[i], c_above = (double)w_above[i];
    const double vx = (b_right - b) * rdx, vz = (b_next - b) * rdz;
    const double uy = (a_above - a) * rdy, wy = (c_above - c) * rdy;
    const double ox = wy - vz, oz = vx - uy;
    /* Four times u v and v w as the momentum sweep has them: its own fluxes (ns_momentum.c). */
    const double flux_u = (a + a_above) * (b + b_right), flux_w = (b + b_next) * (c + c_above);
    v1 += b, v2 += b * b, v3 += b * b * b, v4 += (b * b) * (b * b);
    uv += flux_u, vw += flux_w;
    x1 += ox, x2 += ox * ox, z1 += oz, z2 += oz * oz;
    gg += uy * uy + vx * vx + vz * vz + wy * wy;
    /* Triple products for the turbulent transport, from the same fluxes. */
    vuu += flux_u * (a + a_above), vww += flux_w * (c + c_above);
    pv += b * ((double)p[i] + (double)p_above[i]);
  }
  /* The factors of the means are taken in once per row. */
  s[BW_NS_MOMENT_V] += v1, s[BW_NS_MOMENT_VV] += v2;
  s[BW_NS_MOMENT_VVV] += v3, s[BW_NS_MOMENT_VVVV] += v4;
  s[BW_NS_MOMENT_UV] += 0.25 * uv, s[BW_NS_MOMENT_VW] += 0.25 * vw;
  s[BW_NS_MOMENT_OX] += x1, s[BW_NS_MOMENT_OXOX] += x2;
  s[BW_NS_MOMENT_OZ] += z1, s[BW_NS_MOMENT_OZOZ] += z2;
  s[BW_NS_MOMENT_FACE_GRADIENTS] += gg;
  s[BW_NS_MOMENT_VUU] += 0.125 * vuu, s[BW_NS_MOMENT_VWW] += 0.125 * vww;
  s[BW_NS_MOMENT_PV] += 0.5 * pv;
}

void bw_ns__moments(const bw_grid_view *g, bw_real *const u[3], const bw_real *p, int rows,
                    double sum[])
{
  const double rdx = 1.0 / g->spacing[0], rdz = 1.0 / g->spacing[2];
  const ptrdiff_t up = g->stride[1], back = g->stride[2];
  /* Row 0 is the lower wall: it has faces but no centres. */
  for (int j = g->first[1] ? 0 : 1; j <= g->m[1]; j++) {
    const int y = j + g->lo[1];
    const double rdyc = 1.0 / (g->y_centre[y + 1] - g->y_centre[y]);
    double s[BW_NS_MOMENTS] = {0.0};
    for (int k = 1; k <= g->m[2]; k++) {
      const ptrdiff_t q = bw_at(g, 1, j, k);
      /* The rows that this height touches: the next in z, the one above, those before. */
      const neighbours at = {.u = u[0] + q,
                             .u_next = u[0] + q + back,
                             .u_above = u[0] + q + up,
                             .v = u[1] + q,
                             .v_below = u[1] + q - up,
                             .v_next = u[1] + q + back,
                             .w = u[2] + q,
                             .w_before = u[2] + q - back,
                             .w_above = u[2] + q + up,
                             .p = p + q,
                             .p_above = p + q + up};
      face_row(g->m[0], rdx, rdyc, rdz, &at, s);
      if (j > 0) centre_row(g->m[0], rdx, 1.0 / (g->y_face[y] - g->y_face[y - 1]), rdz, &at, s);
    }
    /* Rows are global, and every height of this block is on this rank for a part of z. */
    for (int m = 0; m < BW_NS_MOMENTS; m++)
      sum[(size_t)m * (size_t)rows + (size_t)y] = s[m];
  }
}
