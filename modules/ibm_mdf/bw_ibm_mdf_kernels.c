/* Interpolation and spreading over arrays: one marker at a time, a row of x per vector. */
#include "ibm_mdf_internal.h"

#include <string.h>

/* A row of the stencil. Explicit, because compilers give up on rows of four in nested loops. */
typedef bw_real row __attribute__((vector_size(IBM_WIDTH * sizeof(bw_real))));

static inline row load(const bw_real *p)
{
  row r;
  memcpy(&r, p, sizeof r);
  return r;
}

/* sum_kj wy wz u(row) . wx over support nodes in y (and z). ny, nz are constants at each call. */
__attribute__((always_inline)) static inline bw_real gather(const bw_real *restrict u,
                                                            const ptrdiff_t stride[3], int ny,
                                                            int nz, const bw_real *wx,
                                                            const bw_real *wy, const bw_real *wz)
{
  row sum = {0};
  for (int k = 0; k < nz; k++)
    for (int j = 0; j < ny; j++)
      sum += (nz > 1 ? wy[j] * wz[k] : wy[j]) * load(u + k * stride[2] + j * stride[1]);
  sum *= load(wx);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

__attribute__((always_inline)) static inline void scatter(bw_real *restrict u,
                                                          const ptrdiff_t stride[3], int ny, int nz,
                                                          bw_real F, const bw_real *wx,
                                                          const bw_real *wy, const bw_real *wz)
{
  const row x = F * load(wx);
  for (int k = 0; k < nz; k++)
    for (int j = 0; j < ny; j++) {
      bw_real *p = u + k * stride[2] + j * stride[1];
      const row r = load(p) + (nz > 1 ? wy[j] * wz[k] : wy[j]) * x;
      memcpy(p, &r, sizeof r);
    }
}

__attribute__((always_inline)) static inline void
interpolate_all(int support, int nz, size_t n, const bw_ibm_mdf__stencil s[],
                const ptrdiff_t stride[3], bw_real *const u[3], bw_real *restrict U)
{
  for (size_t m = 0; m < n; m++) {
    const bw_real(*c)[IBM_WIDTH] = s[m].w[IBM_CENTRE], (*f)[IBM_WIDTH] = s[m].w[IBM_FACE];
    U[3 * m] = gather(u[0] + s[m].at[0], stride, support, nz, f[0], c[1], c[2]);
    U[3 * m + 1] = gather(u[1] + s[m].at[1], stride, support, nz, c[0], f[1], c[2]);
    U[3 * m + 2] =
        nz > 1 ? gather(u[2] + s[m].at[2], stride, support, nz, c[0], c[1], f[2]) : (bw_real)0;
  }
}

/* Weights of the nodes that are beyond a physical boundary set to zero. */
static void cut_weights(const bw_ibm_mdf__stencil *s, bw_real w[IBM_PLACES][3][IBM_WIDTH])
{
  for (int p = 0; p < IBM_PLACES; p++)
    for (int d = 0; d < 3; d++)
      for (int q = 0; q < IBM_WIDTH; q++)
        w[p][d][q] = (s->keep[p][d] >> q & 1) != 0 ? s->w[p][d][q] : (bw_real)0;
}

__attribute__((always_inline)) static inline void
spread_all(int support, int nz, size_t n, const bw_ibm_mdf__stencil s[], const ptrdiff_t stride[3],
           const bw_real *restrict F, bw_real *const u[3])
{
  bw_real reduced[IBM_PLACES][3][IBM_WIDTH];
  for (size_t m = 0; m < n; m++) {
    const bw_real(*w)[3][IBM_WIDTH] = s[m].w;
    if (s[m].cut) {
      cut_weights(&s[m], reduced);
      w = (const bw_real(*)[3][IBM_WIDTH])reduced;
    }
    const bw_real(*c)[IBM_WIDTH] = w[IBM_CENTRE], (*f)[IBM_WIDTH] = w[IBM_FACE];
    scatter(u[0] + s[m].at[0], stride, support, nz, F[3 * m], f[0], c[1], c[2]);
    scatter(u[1] + s[m].at[1], stride, support, nz, F[3 * m + 1], c[0], f[1], c[2]);
    if (nz > 1) scatter(u[2] + s[m].at[2], stride, support, nz, F[3 * m + 2], c[0], c[1], f[2]);
  }
}

/* One instance per support, flat (one cell in z: no weight there) and in space. */
#define INSTANCE(name, support, nz)                                                                \
  static void interpolate_##name(size_t n, const bw_ibm_mdf__stencil s[],                          \
                                 const ptrdiff_t stride[3], bw_real *const u[3],                   \
                                 bw_real *restrict U)                                              \
  {                                                                                                \
    interpolate_all(support, nz, n, s, stride, u, U);                                              \
  }                                                                                                \
  static void spread_##name(size_t n, const bw_ibm_mdf__stencil s[], const ptrdiff_t stride[3],    \
                            const bw_real *restrict F, bw_real *const u[3])                        \
  {                                                                                                \
    spread_all(support, nz, n, s, stride, F, u);                                                   \
  }
INSTANCE(flat2, 2, 1)
INSTANCE(flat3, 3, 1)
INSTANCE(flat4, 4, 1)
INSTANCE(space2, 2, 2)
INSTANCE(space3, 3, 3)
INSTANCE(space4, 4, 4)

bw_ibm_mdf__interpolate_fn bw_ibm_mdf__interpolator(int support, bool flat)
{
  static const bw_ibm_mdf__interpolate_fn table[2][IBM_WIDTH + 1] = {
      {[2] = interpolate_space2, [3] = interpolate_space3, [4] = interpolate_space4},
      {[2] = interpolate_flat2, [3] = interpolate_flat3, [4] = interpolate_flat4}};
  return table[flat][support];
}

bw_ibm_mdf__spread_fn bw_ibm_mdf__spreader(int support, bool flat)
{
  static const bw_ibm_mdf__spread_fn table[2][IBM_WIDTH + 1] = {
      {[2] = spread_space2, [3] = spread_space3, [4] = spread_space4},
      {[2] = spread_flat2, [3] = spread_flat3, [4] = spread_flat4}};
  return table[flat][support];
}

/* Is index i of direction d in a layer that comes from an exchange? */
static bool exchanged(const bw_grid_view *g, int d, int i)
{
  return (i < 1 && (g->periodic[d] || !g->first[d])) ||
         (i > g->m[d] && (g->periodic[d] || !g->last[d]));
}

/* One row: all of it, or (its y and z being inside) the ends in periodic x. */
static void clear_row(const bw_grid_view *g, bool all, bw_real *restrict r)
{
  const int low = 1 - g->halo[0], high = g->m[0] + g->halo[0];
  if (!all && !g->periodic[0]) return;
  for (int i = low; i <= (all ? high : 0); i++)
    r[i] = 0;
  for (int i = g->m[0] + 1; !all && i <= high; i++)
    r[i] = 0;
}

void bw_ibm_mdf__clear_halos(const bw_grid_view *g, bw_real *const u[3])
{
  for (int c = 0; c < 3 && u[c] != NULL; c++)
    for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
      for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
        clear_row(g, exchanged(g, 1, j) || exchanged(g, 2, k), u[c] + bw_at(g, 0, j, k));
}
