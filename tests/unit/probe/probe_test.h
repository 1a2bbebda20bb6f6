/* probe_test.h -- fields, probes, surface points and known tractions that the tests share. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_probe.h"

#include <string.h>

enum { POINTS = 60 };
static const double RHO = 2.5, NU = 0.3;
static const double ROUND_OFF = 1000.0 * BW_REAL_EPSILON; /* gradients divide by h ~ 0.3 */

typedef struct {
  bw_grid *grid;
  const bw_grid_view *g;
  bw_real *u[3], *p;
  bw_probe *probe;
} fixture;

typedef double (*field_fn)(int c, const double x[3]); /* c = 0..2 velocity, 3 pressure/density */

static inline void make(fixture *f, const bw_comm *comm, const int n[3], double h, bool periodic,
                        bw_probe_profile profile)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_probe_config probe = bw_probe_config_default();
  *f = (fixture){.grid = NULL};
  for (int d = 0; d < 3; d++) {
    grid.n[d] = n[d];
    grid.length[d] = n[d] * h;
    grid.periodic[d] = periodic;
  }
  grid.halo = 2;
  probe.rho = RHO, probe.nu = NU, probe.profile = profile;
  bw_check_ok(bw_grid_create(comm, &grid, &f->grid));
  f->g = bw_grid_look(f->grid);
  for (int d = 0; d < (n[2] == 1 ? 2 : 3); d++)
    bw_check_ok(bw_field_create(f->grid, &f->u[d]));
  bw_check_ok(bw_field_create(f->grid, &f->p));
  bw_check_ok(bw_probe_create(f->grid, &probe, &f->probe));
}

static inline void drop(fixture *f)
{
  bw_probe_destroy(&f->probe);
  for (int d = 0; d < 3; d++)
    bw_release(&f->u[d]);
  bw_release(&f->p);
  bw_grid_destroy(&f->grid);
}

/* Ghosts included. */
static inline void fill(const fixture *f, field_fn function)
{
  const bw_grid_view *g = f->g;
  for (int c = 0; c < 4; c++) {
    bw_real *a = c == 3 ? f->p : f->u[c];
    for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2] && a != NULL; k++)
      for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
        for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++) {
          const int cell[3] = {i, j, k};
          double x[3];
          for (int d = 0; d < 3; d++)
            x[d] = (cell[d] + g->lo[d] - (c == d ? 0.0 : 0.5)) * g->spacing[d];
          a[bw_at(g, i, j, k)] = (bw_real)function(c, x);
        }
  }
}

/* In [0, 1), from the key alone. */
static inline double number(unsigned key)
{
  unsigned z = key * 2654435761u + 12345u;
  z = (z ^ (z >> 15)) * 2246822519u;
  z = (z ^ (z >> 13)) * 3266489917u;
  return (double)((z ^ (z >> 16)) & 0xFFFFFFu) / 16777216.0;
}

/* Point q with its normal, `margin` cells inside the box; z normal zero in 2D. */
static inline void scatter(const fixture *f, unsigned q, double margin, double x[3], double n[3])
{
  const double polar = f->u[2] == NULL ? 0.0 : 2.0 * number(8 * q) - 1.0;
  const double angle = 6.283185307179586 * number(8 * q + 1);
  n[0] = sqrt(1.0 - polar * polar) * cos(angle);
  n[1] = sqrt(1.0 - polar * polar) * sin(angle);
  n[2] = polar;
  for (unsigned d = 0; d < 3; d++) {
    const double edge = margin * f->g->spacing[d];
    x[d] = edge + (f->g->length[d] - 2.0 * edge) * number(8 * q + 2 + d);
  }
}

static const double G[3][3] = {{0.7, -0.2, 0.4}, {0.1, -0.9, -0.6}, {-0.8, 0.3, 0.2}};
static const double GRAD_P[3] = {0.6, -1.1, 0.9};

static inline double linear(int c, const double x[3])
{
  const double *a = c == 3 ? GRAD_P : G[c];
  return 0.4 * (c - 1) + a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
}

/* In 2D nothing depends on z. */
static inline double linear_flat(int c, const double x[3])
{
  const double y[3] = {x[0], x[1], 0.0};
  return linear(c, y);
}

/* t = -p n + mu (G + G^T) n with p the wall's, when DU/Dt = -grad p/rho; else p is off by
 * dl/2 times the difference of the two slopes. */
static inline void expected(bool flat, const double X[3], const double n[3], const double A[3],
                            double dl, double t[3])
{
  const int dims = flat ? 2 : 3;
  double p = (flat ? linear_flat : linear)(3, X), error = 0.0;
  for (int d = 0; d < dims; d++)
    error += (GRAD_P[d] + A[d]) * n[d];
  p += 0.5 * dl * error;
  for (int c = 0; c < 3; c++) {
    t[c] = -RHO * p * n[c];
    for (int d = 0; d < dims && c < dims; d++)
      t[c] += RHO * NU * (G[c][d] + G[d][c]) * n[d];
  }
}
