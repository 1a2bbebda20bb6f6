/* cube_scene.h -- a cube of 8 particles a side in a channel flow, for the tests of the coupler. */
#pragma once
#include "bw_check.h"
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "coupler_internal.h"

#include <math.h>
#include <stdio.h>

/* Positions and forces pass through bw_real. */
static const double ROUND_OFF = 1.0e3 * BW_REAL_EPSILON;
enum { N = 24, BLOCK = 8, FIRST = 8 };
static const double H = 1.0 / N, RHO = 10.0;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
} scene;

static inline void stream(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = 6.0 * x[1] * (1.0 - x[1]);
  u[1] = u[2] = 0.0;
}

/* A cube of 8 particles a side in the middle of a box of 24 cells a side, in a channel flow. */
static inline scene build_blocks(double retraction, double relaxation, double spacing)
{
  scene s = {0};
  const bw_comm *comm = bw_check_world();
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  bw_solid_config solid = bw_solid_config_default();
  bw_coupler_config config = bw_coupler_config_default();
  for (int d = 0; d < 3; d++)
    grid.n[d] = N, grid.length[d] = 1.0;
  grid.periodic[2] = true;
  grid.halo = 2;
  flow.nu = 0.05;
  flow.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 1.0};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
  solid.ds = H;
  solid.rho = 50.0;
  solid.E = 1.0e4;
  config.rho = RHO;
  config.nu = flow.nu;
  config.retraction = retraction;
  config.load_relaxation = relaxation;
  config.marker_spacing = spacing;

  const double lower = FIRST * H, upper = (FIRST + BLOCK) * H;
  const bw_shape cube = {
      .kind = BW_SHAPE_BOX, .lower = {lower, lower, lower}, .upper = {upper, upper, upper}};
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_check_ok(bw_grid_create(comm, &grid, &s.grid));
  bw_check_ok(bw_ns_channel_create(s.grid, &flow, &s.fluid));
  const bw_shape_lattice lattice = bw_shape_lattice_straight(H, solid.origin, false);
  bw_check_ok(bw_shape_fill(1, &cube, &lattice, 0, 1, &n, &site, &kind, NULL));
  ck_assert_int_eq(n, BLOCK * BLOCK * BLOCK);
  bw_check_ok(bw_solid_create_same(comm, &solid, n, site, kind, &s.solid));
  bw_check_ok(bw_coupler_create(&config, s.fluid, s.solid, &s.coupler));
  bw_check_ok(bw_ns_channel_set_velocity(s.fluid, stream, NULL, 0.0));
  bw_release(&site);
  bw_release(&kind);
  return s;
}

static inline scene build(double retraction, double relaxation)
{
  return build_blocks(retraction, relaxation, 0.0);
}

static inline void destroy(scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

/* Saved, n steps gone on, loaded, gone on again: the same velocities, to round-off. */
static inline void check_restart(scene *s, const char *name, double step, int n)
{
  const size_t size = 3 * bw_solid_count(s->solid);
  char path[64]; /* of this number of ranks: tests run side by side */
  snprintf(path, sizeof path, "%s_np%d.h5", name, bw_comm_size(bw_check_world()));
  double *V[2] = {NULL, NULL}, most[2] = {0.0, 0.0};
  bw_checkpoint *ck = NULL;
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_save(s->coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  for (int round = 0; round < 2; round++) {
    for (int q = 0; q < n; q++)
      bw_check_ok(bw_coupler_step(s->coupler, step));
    bw_check_ok(BW_ALLOCATE(&V[round], size));
    bw_solid_get_velocity(s->solid, V[round]);
    if (round > 0) break;
    bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
    bw_check_ok(bw_coupler_load(s->coupler, ck));
    bw_check_ok(bw_checkpoint_close(&ck));
  }
  for (size_t i = 0; i < size; i++) {
    most[0] = fmax(most[0], fabs(V[0][i]));
    most[1] = fmax(most[1], fabs(V[1][i] - V[0][i]));
  }
  bw_comm_max(bw_check_world(), 2, most);
  ck_assert_double_gt(most[0], 0.0);
  ck_assert_double_lt(most[1], ROUND_OFF * most[0]);
  bw_release(&V[0]);
  bw_release(&V[1]);
  if (bw_comm_rank(bw_check_world()) == 0) remove(path);
}
