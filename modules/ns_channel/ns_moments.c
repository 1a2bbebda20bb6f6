/* ns_moments.c -- sums over the rows of one field, the kernels of the statistics. */
#include "ns_statistics_internal.h"

/* u, w at k and k+1, p: sums of the centre moments into s[BW_NS_MOMENT_U ..]. */
static void centre_row(int n, double rdx, double rdz, const bw_real *restrict u,
                       const bw_real *restrict u_next, const bw_real *restrict w,
                       const bw_real *restrict p, double s[restrict])
{
  double u1 = 0, u2 = 0, u3 = 0, u4 = 0, w1 = 0, w2 = 0, w3 = 0, w4 = 0, p1 = 0, p2 = 0, uw = 0;
  double o1 = 0, o2 = 0;
#pragma omp simd reduction(+ : u1, u2, u3, u4, w1, w2, w3, w4, p1, p2, uw, o1, o2)
  for (int i = 0; i < n; i++) {
    const double a = (double)u[i], c = (double)w[i], q = (double)p[i];
    const double a_next = (double)u_next[i], c_next = (double)w[i + 1];
    const double o = (a_next - a) * rdz - (c_next - c) * rdx;
    u1 += a, u2 += a * a, u3 += a * a * a, u4 += (a * a) * (a * a);
    w1 += c, w2 += c * c, w3 += c * c * c, w4 += (c * c) * (c * c);
    p1 += q, p2 += q * q;
    uw += (a + a_next) * (c + c_next);
    o1 += o, o2 += o * o;
  }
  s[BW_NS_MOMENT_U] += u1, s[BW_NS_MOMENT_UU] += u2;
  s[BW_NS_MOMENT_UUU] += u3, s[BW_NS_MOMENT_UUUU] += u4;
  s[BW_NS_MOMENT_W] += w1, s[BW_NS_MOMENT_WW] += w2;
  s[BW_NS_MOMENT_WWW] += w3, s[BW_NS_MOMENT_WWWW] += w4;
  s[BW_NS_MOMENT_P] += p1, s[BW_NS_MOMENT_PP] += p2;
  s[BW_NS_MOMENT_UW] += 0.25 * uw;
  s[BW_NS_MOMENT_OY] += o1, s[BW_NS_MOMENT_OYOY] += o2;
}

/* v at k and k+1; u and w below and above the face. */
static void face_row(int n, double rdx, double rdy, double rdz, const bw_real *restrict v,
                     const bw_real *restrict v_next, const bw_real *restrict u,
                     const bw_real *restrict u_above, const bw_real *restrict w,
                     const bw_real *restrict w_above, double s[restrict])
{
  double v1 = 0, v2 = 0, v3 = 0, v4 = 0, uv = 0, vw = 0, x1 = 0, x2 = 0, z1 = 0, z2 = 0;
#pragma omp simd reduction(+ : v1, v2, v3, v4, uv, vw, x1, x2, z1, z2)
  for (int i = 0; i < n; i++) {
    const double b = (double)v[i], b_right = (double)v[i + 1], b_next = (double)v_next[i];
    const double a = (double)u[i], a_above = (double)u_above[i];
    const double c = (double)w[i], c_above = (double)w_above[i];
    const double ox = (c_above - c) * rdy - (b_next - b) * rdz;
    const double oz = (b_right - b) * rdx - (a_above - a) * rdy;
    v1 += b, v2 += b * b, v3 += b * b * b, v4 += (b * b) * (b * b);
    uv += (a + a_above) * (b + b_right);
    vw += (b + b_next) * (c + c_above);
    x1 += ox, x2 += ox * ox, z1 += oz, z2 += oz * oz;
  }
  s[BW_NS_MOMENT_V] += v1, s[BW_NS_MOMENT_VV] += v2;
  s[BW_NS_MOMENT_VVV] += v3, s[BW_NS_MOMENT_VVVV] += v4;
  s[BW_NS_MOMENT_UV] += 0.25 * uv, s[BW_NS_MOMENT_VW] += 0.25 * vw;
  s[BW_NS_MOMENT_OX] += x1, s[BW_NS_MOMENT_OXOX] += x2;
  s[BW_NS_MOMENT_OZ] += z1, s[BW_NS_MOMENT_OZOZ] += z2;
}

void bw_ns__moments(const bw_grid_view *g, bw_real *const u[3], const bw_real *p, int rows,
                    double sum[])
{
  const double rdx = 1.0 / g->spacing[0], rdz = 1.0 / g->spacing[2];
  const ptrdiff_t up = g->stride[1], back = g->stride[2];
  for (int j = g->first[1] ? 0 : 1; j <= g->m[1]; j++) {
    const int y = j + g->lo[1];
    const double rdy = 1.0 / (g->y_centre[y + 1] - g->y_centre[y]);
    double s[BW_NS_MOMENTS] = {0.0};
    for (int k = 1; k <= g->m[2]; k++) {
      const ptrdiff_t q = bw_at(g, 1, j, k);
      face_row(g->m[0], rdx, rdy, rdz, u[1] + q, u[1] + q + back, u[0] + q, u[0] + q + up, u[2] + q,
               u[2] + q + up, s);
      if (j > 0) centre_row(g->m[0], rdx, rdz, u[0] + q, u[0] + q + back, u[2] + q, p + q, s);
    }
    for (int m = 0; m < BW_NS_MOMENTS; m++)
      sum[(size_t)m * (size_t)rows + (size_t)y] = s[m];
  }
}
