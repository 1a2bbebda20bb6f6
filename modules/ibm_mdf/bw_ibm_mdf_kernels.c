/* Interpolation and spreading over arrays: one marker at a time, a row of x per vector. Markers are
 * sorted by cell, so that of a later one only the uppermost rows may be new to the cache. */
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

__attribute__((always_inline)) static inline void
fetch_top(const bw_real *u, const bw_ibm_mdf__stencils *s, int ny, int nz)
{
  for (int j = nz > 1 ? 0 : ny - 1; j < ny; j++)
    __builtin_prefetch(u + (nz - 1) * s->plane + j * s->row);
}

/* sum_kj wz wy u(row) . wx over support nodes in y (and z). ny, nz are constants at each call. */
__attribute__((always_inline)) static inline bw_real gather(const bw_real *restrict u,
                                                            const bw_ibm_mdf__stencils *s, int ny,
                                                            int nz, const bw_real *wx,
                                                            const bw_real *wy, const bw_real *wz)
{
  row sum = {0};
  /* Rows along x are summed as vectors; the weights along x are multiplied in once, at the end. */
  for (int k = 0; k < nz; k++) {
    row plane = {0};
    for (int j = 0; j < ny; j++)
      plane += wy[j] * load(u + k * s->plane + j * s->row);
    sum += nz > 1 ? wz[k] * plane : plane;
  }
  sum *= load(wx);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

__attribute__((always_inline)) static inline void scatter(bw_real *restrict u,
                                                          const bw_ibm_mdf__stencils *s, int ny,
                                                          int nz, bw_real F, const bw_real *wx,
                                                          const bw_real *wy, const bw_real *wz)
{
  const row x = F * load(wx);
  /* The adjoint of gather: the same weights, written instead of read. */
  for (int k = 0; k < nz; k++) {
    const row plane = nz > 1 ? wz[k] * x : x;
    for (int j = 0; j < ny; j++) {
      bw_real *p = u + k * s->plane + j * s->row;
      const row r = load(p) + wy[j] * plane;
      memcpy(p, &r, sizeof r);
    }
  }
}

__attribute__((always_inline)) static inline void interpolate_all(int support, int nz,
                                                                  const bw_ibm_mdf__stencils *s,
                                                                  bw_real *const u[3],
                                                                  bw_real *restrict U)
{
  for (size_t m = s->begin; m < s->end; m++) {
    /* A marker further on is asked for early, as its rows may not be in the cache. */
    for (int d = 0; d < (nz > 1 ? 3 : 2); d++)
      fetch_top(u[d] + s->nodes[m + IBM_AHEAD].at[d], s, support, nz);
    const bw_real(*c)[IBM_WIDTH] = s->weights[m].w[IBM_CENTRE];
    const bw_real(*f)[IBM_WIDTH] = s->weights[m].w[IBM_FACE];
    const int32_t *at = s->nodes[m].at;
    /* Component c has face weights along c and centre weights across (staggered grid). */
    U[3 * m] = gather(u[0] + at[0], s, support, nz, f[0], c[1], c[2]);
    U[3 * m + 1] = gather(u[1] + at[1], s, support, nz, c[0], f[1], c[2]);
    U[3 * m + 2] = nz > 1 ? gather(u[2] + at[2], s, support, nz, c[0], c[1], f[2]) : (bw_real)0;
  }
}

/* Weights without those of the nodes that are beyond a physical boundary. */
static bw_ibm_mdf__weights cut(const bw_ibm_mdf__weights *whole, uint32_t keep)
{
  bw_ibm_mdf__weights rest;
  for (int p = 0; p < IBM_PLACES; p++)
    for (int d = 0; d < 3; d++)
      for (int q = 0; q < IBM_WIDTH; q++, keep >>= 1)
        rest.w[p][d][q] = (keep & 1u) != 0 ? whole->w[p][d][q] : (bw_real)0;
  return rest;
}

__attribute__((always_inline)) static inline void spread_all(int support, int nz,
                                                             const bw_ibm_mdf__stencils *s,
                                                             const bw_real *restrict F,
                                                             bw_real *const u[3])
{
  for (size_t m = s->begin; m < s->end; m++) {
    bw_ibm_mdf__weights rest;
    const bw_ibm_mdf__weights *w = &s->weights[m];
    /* Near a wall: what would fall beyond it is lost. */
    if (s->nodes[m].keep != IBM_KEEP_ALL) {
      rest = cut(w, s->nodes[m].keep);
      w = &rest;
    }
    const bw_real(*c)[IBM_WIDTH] = w->w[IBM_CENTRE], (*f)[IBM_WIDTH] = w->w[IBM_FACE];
    const int32_t *at = s->nodes[m].at;
    /* Markers one after the other, so that those that share nodes add up in a fixed order. */
    scatter(u[0] + at[0], s, support, nz, F[3 * m], f[0], c[1], c[2]);
    scatter(u[1] + at[1], s, support, nz, F[3 * m + 1], c[0], f[1], c[2]);
    if (nz > 1) scatter(u[2] + at[2], s, support, nz, F[3 * m + 2], c[0], c[1], f[2]);
  }
}

/* One instance per support, flat (one cell in z: no weight there) and in space. */
#define INSTANCE(name, support, nz)                                                                \
  static void interpolate_##name(const bw_ibm_mdf__stencils *s, bw_real *const u[3],               \
                                 bw_real *restrict U)                                              \
  {                                                                                                \
    interpolate_all(support, nz, s, u, U);                                                         \
  }                                                                                                \
  static void spread_##name(const bw_ibm_mdf__stencils *s, const bw_real *restrict F,              \
                            bw_real *const u[3])                                                   \
  {                                                                                                \
    spread_all(support, nz, s, F, u);                                                              \
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
