/* cylinder_in_channel.h -- the channel in which a free cylinder falls, spins or is carried. */
#pragma once
#include "bw_ns_channel.h"

typedef enum { FALL, COUETTE, POISEUILLE, MOTIONS } motion;
enum { HEIGHTS = 4 }; /* of the channel, in diameters; diameter, viscosity, fluid's density are 1 */
static const double RE = 0.1;
static const char *const name[MOTIONS] = {"fall", "couette", "poiseuille"};

static inline void cylinder_couette(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = RE * (x[1] - 0.5 * HEIGHTS);
  u[1] = u[2] = 0.0;
}

static inline void cylinder_poiseuille(const double x[3], double t, void *context, double u[3])
{
  const double y = x[1] / HEIGHTS;
  (void)t, (void)context;
  u[0] = 6.0 * RE * y * (1.0 - y);
  u[1] = u[2] = 0.0;
}

/* *grid and *fluid: the channel with 1/h = cells, at its start. Collective. */
static inline bw_status cylinder_fluid(const bw_comm *comm, motion m, int cells, bw_grid **g,
                                       bw_ns_channel **fluid)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  grid.n[0] = (m == FALL ? 3 : 2) * HEIGHTS * cells; /* disturbances: exp(-4.2 x/H) */
  grid.n[1] = HEIGHTS * cells, grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = (double)grid.n[d] / cells;
  grid.periodic[0] = m != FALL;
  grid.periodic[2] = true;
  grid.halo = 2;
  flow.nu = 1.0;
  for (int q = 0; q < 2; q++) {
    if (m != FALL) flow.side[0][q].kind = BW_SIDE_PERIODIC;
    if (m == COUETTE) flow.side[1][q].velocity[0] = (q - 0.5) * RE * HEIGHTS;
    flow.side[2][q].kind = BW_SIDE_PERIODIC;
  }
  if (m == POISEUILLE) flow.forcing = BW_FORCING_FLOW_RATE, flow.forcing_value = RE;
  BW_TRY(bw_grid_create(comm, &grid, g));
  BW_TRY(bw_ns_channel_create(*g, &flow, fluid));
  if (m == FALL) return BW_OK;
  return bw_ns_channel_set_velocity(*fluid, m == COUETTE ? cylinder_couette : cylinder_poiseuille,
                                    NULL, 0.0);
}
