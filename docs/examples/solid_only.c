/* A notched bar is pulled apart: one end held, the other drawn away, until it snaps.
 * BUILD modules=pd_bond
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_pd_bond.h"
#include "bw_pd_load.h"
#include "bw_pd_shape.h"
#include <stdio.h>

static bw_status pull(const bw_comm *world)
{
  bw_pd_bond_config config = bw_pd_bond_config_default(); /* SI units */
  config.geometry = BW_PD_PLANE_STRESS;
  config.ds = 1e-3;
  config.rho = 1200;
  config.E = 3e9;
  config.G0 = 300;
  config.damping_pair = 1e14;

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
  bw_pd_bond *bar;
  /* what one rank alone may miss, as memory, ranks agree on before they go on together */
  BW_TRY(bw_comm_agree(
      world, bw_pd_shape_fill(4, shapes, config.ds, config.origin, true, &n, &site, &kind)));
  BW_TRY(bw_pd_bond_create(world, &config, n, site, kind, &bar));
  BW_TRY(bw_comm_agree(world, BW_ALLOCATE(&V, 3 * bw_pd_bond_count(bar))));
  bw_pd_bond_get_reference(bar, V);
  for (size_t i = 0; i < bw_pd_bond_count(bar); i++) {
    V[3 * i] = V[3 * i] > 0.030 ? 1.0 : 0.0; /* only grips listen */
    V[3 * i + 1] = 0;
  }

  const double dt = 0.5 * bw_pd_bond_dt_max(bar);
  const bw_pd_ramp ramp = {BW_PD_RAMP_SMOOTH, 0, 100 * dt};
  bw_pd_bond_ledger e = {0};
  for (int step = 1; step <= 1200; step++) {
    bw_pd_load_move(bar, &ramp, (step - 1) * dt, dt, V);
    BW_TRY(bw_pd_bond_step(bar, dt));
    if (step % 100 != 0) continue;
    BW_TRY(bw_pd_bond_account(bar, &e));
    if (bw_comm_rank(world) == 0)
      printf("t = %5.1f us  elastic %7.4f J  kinetic %7.4f J  fracture %7.4f J  broken %lld\n",
             1e6 * step * dt, e.elastic, e.kinetic, e.fracture, (long long)e.broken);
  }
  bw_pd_bond_destroy(&bar);
  bw_release(&site), bw_release(&kind), bw_release(&V);
  return e.broken > 80 ? BW_OK : BW_FAIL(BW_EDIVERGED, "the bar did not snap");
}

int main(int argc, char **argv)
{
  bw_comm *world;
  return bw_init(&argc, &argv, &world) == BW_OK ? bw_finish(&world, pull(world)) : 1;
}
