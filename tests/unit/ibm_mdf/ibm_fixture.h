/* A grid, three velocity fields and scattered markers for the tests of ibm_mdf. */
#pragma once
#include "bw_check.h"
#include "bw_ibm_mdf.h"
#include "bw_memory.h"

enum { FIX_MARKERS = 97 }; /* over all ranks */

typedef struct {
  bw_grid *grid;
  const bw_grid_view *g;
  bw_ibm_mdf *ib;
  bw_real *u[3];
  size_t n; /* markers of this rank */
  double *X, *V, *dV, *F;
} fixture;

/* A number in [-1, 1] that depends on the key alone (splitmix64). */
static inline double scatter_number(uint64_t key)
{
  uint64_t z = key * 0x9E3779B97F4A7C15u + 0x632BE59BD9B4E019u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return 2.0 * (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0 - 1.0;
}

/* Where component c (3: scalar) of cell (i,j,k) sits. */
static inline void place_of(const bw_grid_view *g, int c, int i, int j, int k, double x[3])
{
  const int cell[3] = {i, j, k};
  for (int d = 0; d < 3; d++)
    x[d] = (cell[d] + g->lo[d] - (c == d ? 0.0 : 0.5)) * g->spacing[d];
}

typedef double (*field_fn)(int c, const double x[3], const fixture *f);

/* Every storage cell, ghosts included, as the function says (not wrapped: for closed boxes). */
static inline void fill_everywhere(fixture *f, field_fn function)
{
  const bw_grid_view *g = f->g;
  for (int c = 0; c < 3 && f->u[c] != NULL; c++)
    for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
      for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
        for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++) {
          double x[3];
          place_of(g, c, i, j, k, x);
          f->u[c][bw_at(g, i, j, k)] = (bw_real)function(c, x, f);
        }
}

/* Interior by global cell number: the same field on any number of ranks; halos updated. */
static inline void fill_scattered(fixture *f, double amplitude)
{
  const bw_grid_view *g = f->g;
  const int components = f->u[2] == NULL ? 2 : 3;
  for (int c = 0; c < components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int id = ((k + g->lo[2]) * g->n[1] + j + g->lo[1]) * g->n[0] + i;
          f->u[c][bw_at(g, i, j, k)] =
              (bw_real)(amplitude * scatter_number((uint64_t)(3 * id + c)));
        }
  bw_halo_update(f->grid, components, f->u);
}

/* Sum over this rank's cells of a . b (b NULL: of component c of a alone). */
static inline double sum_cells(const fixture *f, bw_real *const a[3], bw_real *const b[3], int c0)
{
  const bw_grid_view *g = f->g;
  double sum = 0.0;
  for (int c = 0; c < 3 && a[c] != NULL; c++)
    for (int k = 1; k <= g->m[2] && (b != NULL || c == c0); k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const ptrdiff_t q = bw_at(g, i, j, k);
          sum += (double)a[c][q] * (b != NULL ? (double)b[c][q] : 1.0);
        }
  return sum;
}

static inline double cell_volume(const fixture *f)
{
  return f->g->spacing[0] * f->g->spacing[1] * f->g->spacing[2];
}

/* Markers number q with q % ranks == rank; in the box, `margin` cells away from its sides. */
static inline void make_markers(fixture *f, const bw_comm *comm, int total, double margin)
{
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  f->n = (size_t)((total - me + size - 1) / size);
  bw_check_ok(BW_ALLOCATE(&f->X, 3 * f->n));
  bw_check_ok(BW_ALLOCATE(&f->V, 3 * f->n));
  bw_check_ok(BW_ALLOCATE(&f->F, 3 * f->n));
  bw_check_ok(BW_ALLOCATE(&f->dV, f->n));
  for (size_t m = 0; m < f->n; m++) {
    const uint64_t key = (uint64_t)(me + (int)m * size) * 16u;
    for (uint64_t d = 0; d < 3; d++) {
      const double half = 0.5 * f->g->length[d], h = f->g->spacing[d];
      f->X[3 * m + d] = half + (half - margin * h) * scatter_number(key + d);
      f->V[3 * m + d] = scatter_number(key + 3u + d);
      f->F[3 * m + d] = scatter_number(key + 6u + d);
    }
    f->dV[m] = cell_volume(f) * (1.0 + 0.5 * scatter_number(key + 9u));
  }
}

typedef struct {
  int n[3];
  bool periodic;
  bw_kernel_delta_id kernel;
  int n_iter;
} fixture_case;

/* Spacings differ per direction, so that a mix-up of directions shows. */
static inline void fixture_make(fixture *f, const bw_comm *comm, const fixture_case *c, int total,
                                double margin)
{
  static const double spacing[3] = {0.5, 0.4, 0.3};
  bw_grid_config grid = bw_grid_config_default();
  bw_ibm_mdf_config ib = bw_ibm_mdf_config_default();
  *f = (fixture){0};
  for (int d = 0; d < 3; d++) {
    grid.n[d] = c->n[d];
    grid.length[d] = c->n[d] * spacing[d];
    grid.periodic[d] = c->periodic;
  }
  grid.halo = 2;
  ib.kernel = c->kernel;
  ib.n_iter = c->n_iter;
  ib.memory = 0.0; /* fixture_remember */
  bw_check_ok(bw_grid_create(comm, &grid, &f->grid));
  f->g = bw_grid_look(f->grid);
  for (int d = 0; d < (c->n[2] == 1 ? 2 : 3); d++)
    bw_check_ok(bw_field_create(f->grid, &f->u[d]));
  bw_check_ok(bw_ibm_mdf_create(f->grid, &ib, &f->ib));
  make_markers(f, comm, total, margin);
  bw_check_ok(bw_ibm_mdf_set_markers(f->ib, f->n, f->X, f->V, f->dV, NULL));
}

/* The same with a memory. */
static inline void fixture_remember(fixture *f, const fixture_case *c, double memory)
{
  const bw_ibm_mdf_config ib = {.kernel = c->kernel, .n_iter = c->n_iter, .memory = memory};
  bw_ibm_mdf_destroy(&f->ib);
  bw_check_ok(bw_ibm_mdf_create(f->grid, &ib, &f->ib));
  bw_check_ok(bw_ibm_mdf_set_markers(f->ib, f->n, f->X, f->V, f->dV, NULL));
}

static inline void fixture_free(fixture *f)
{
  bw_ibm_mdf_destroy(&f->ib);
  for (int c = 0; c < 3; c++)
    bw_release(&f->u[c]);
  bw_release(&f->X);
  bw_release(&f->V);
  bw_release(&f->F);
  bw_release(&f->dV);
  bw_grid_destroy(&f->grid);
}
