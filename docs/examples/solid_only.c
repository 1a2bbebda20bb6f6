/* A notched bar is pulled apart: one end held, the other drawn away, until it snaps.
 * BUILD modules=solid,solid_tools,shape
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid.h"
#include "bw_solid_load.h"
#include <stdio.h>

static bw_status pull(const bw_comm *world)
{
  bw_solid_config config = bw_solid_config_default(); /* SI units */
  config.geometry = BW_PD_PLANE_STRESS;
  config.ds = 1e-3;
  config.rho = 1200;
  config.E = 3e9;
  config.G0 = 300;
  config.damping.pair = 1e14;

  const uint8_t grip = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE;
  const bw_shape shapes[] = {/* 60 x 15 mm with 4 mm of grip at either end and a notch */
                             {.upper = {0.060, 0.015, 1}},
                             {.upper = {0.004, 0.015, 1}, .particle_kind = grip},
                             {.lower = {0.056}, .upper = {0.060, 0.015, 1}, .particle_kind = grip},
                             {.lower = {0.029}, .upper = {0.031, 0.004, 1}, .remove = true}};
  int64_t n;
  int32_t *site;
  uint8_t *kind;
  double *V = NULL;
  bw_solid *bar;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(config.ds, config.origin, true);
  /* What one rank alone may miss, as memory, ranks agree on before they go on together. */
  BW_TRY(bw_comm_agree(world, bw_shape_fill(4, shapes, &lattice, 0, 1, &n, &site, &kind, NULL)));
  BW_TRY(bw_solid_create_same(world, &config, n, site, kind, &bar));
  BW_TRY(bw_comm_agree(world, BW_ALLOCATE(&V, 3 * bw_solid_count(bar))));
  bw_solid_get_reference(bar, V);
  for (size_t i = 0; i < bw_solid_count(bar); i++) {
    V[3 * i] = V[3 * i] > 0.030 ? 1.0 : 0.0; /* only grips listen */
    V[3 * i + 1] = 0;
  }

  const double dt = 0.5 * bw_solid_dt_max(bar);
  const bw_solid_ramp ramp = {BW_SOLID_RAMP_SMOOTH, 0, 100 * dt};
  bw_solid_ledger e = {0};
  for (int step = 1; step <= 1200; step++) {
    bw_solid_load_move(bar, &ramp, (step - 1) * dt, dt, V);
    BW_TRY(bw_solid_step(bar, dt));
    if (step % 100 != 0) continue;
    BW_TRY(bw_solid_account(bar, &e));
    if (bw_comm_rank(world) == 0)
      printf("t = %5.1f us  elastic %7.4f J  kinetic %7.4f J  fracture %7.4f J  broken %lld\n",
             1e6 * step * dt, e.elastic, e.kinetic, e.fracture, (long long)e.broken);
  }
  bw_solid_destroy(&bar);
  bw_release(&site), bw_release(&kind), bw_release(&V);
  return e.broken > 80 ? BW_OK : BW_FAIL(BW_EDIVERGED, "the bar did not snap");
}

int main(int argc, char **argv)
{
  bw_comm *world;
  return bw_init(&argc, &argv, &world) == BW_OK ? bw_finish(&world, pull(world)) : 1;
}
