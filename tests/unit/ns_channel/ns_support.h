/* ns_support.h -- grids, solvers and fields that the tests of ns_channel share. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <string.h>

/* Round-off of bw_real against the double tolerance a test is written in. */
#define NS_TOLERANCE(x) ((x)*BW_REAL_EPSILON / DBL_EPSILON)

static inline bw_grid *ns_grid(const bw_comm *comm, const int n[3], const double length[3],
                               const bool periodic[3], double stretch, int halo)
{
  bw_grid_config c = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    c.n[d] = n[d], c.length[d] = length[d], c.periodic[d] = periodic[d];
  c.halo = halo;
  if (stretch > 0) c.y_stretch = BW_STRETCH_TANH, c.y_stretch_strength = stretch;
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(comm, &c, &grid));
  return grid;
}

/* Walls at rest where the grid is not periodic. */
static inline bw_ns_channel_config ns_config(const bool periodic[3], double nu)
{
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu;
  for (int d = 0; d < 3; d++)
    for (int s = 0; s < 2; s++)
      if (periodic[d]) c.side[d][s].kind = BW_SIDE_PERIODIC;
  return c;
}

static inline bw_ns_channel *ns_solver(bw_grid *grid, const bw_ns_channel_config *c)
{
  bw_ns_channel *ns = NULL;
  bw_check_ok(bw_ns_channel_create(grid, c, &ns));
  return ns;
}

static inline void ns_free(bw_ns_channel **ns)
{
  bw_grid *grid = bw_ns_channel_grid(*ns);
  bw_ns_channel_destroy(ns);
  bw_grid_destroy(&grid);
}

/* The same pseudo-random velocity for a point, whatever rank asks: -1 .. 1 per component. */
static inline void ns_noise(const double x[3], double t, void *context, double u[3])
{
  const double seed = context != NULL ? *(const double *)context : 1.0;
  for (int c = 0; c < 3; c++) {
    const double a = sin(seed + t + 12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + 4.1 * c);
    const double b = a * 437.5453;
    u[c] = 2.0 * (b - floor(b)) - 1.0;
  }
}

/* Smooth, all components, no symmetry. */
static inline void ns_smooth(const double x[3], double t, void *context, double u[3])
{
  (void)context, (void)t;
  u[0] = 0.3 + sin(2.1 * x[0] + 0.3) * cos(1.7 * x[1]) + 0.2 * sin(3.0 * x[2] + x[1]);
  u[1] = 0.1 + cos(1.3 * x[0] + x[2]) * sin(2.3 * x[1] + 0.5);
  u[2] = -0.2 + sin(1.1 * x[0] - 0.4 * x[1]) * cos(1.9 * x[2]);
}
