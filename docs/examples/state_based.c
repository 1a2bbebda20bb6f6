/* A rubber block is pulled: its sides draw in as Poisson's ratio says.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1,2 */
#include "bw_solid.h"
#include "bw_solid_static.h"
#include <math.h>
#include <stdio.h>

enum { NX = 12, NY = 6, NZ = 6, N = NX * NY * NZ };

/* Largest extent of the free part along y. */
static double width(const bw_comm *world, const bw_solid *block, double X[][3])
{
  double most = 0;
  bw_solid_get_position(block, X[0]);
  for (size_t i = 0; i < bw_solid_count(block); i++)
    if (fabs(X[i][0] - 0.6) < 0.1) most = fmax(most, fabs(X[i][1] - 0.3));
  bw_comm_max(world, 1, &most);
  return 2 * most;
}

static bw_status run(const bw_comm *world)
{
  bw_solid_config config = bw_solid_config_default(); /* any consistent units */
  config.ds = 0.1, config.rho = 1, config.E = 1;
  config.horizon_ratio = 1.5;                  /* eighteen neighbours ... */
  config.family_reach = BW_PD_REACH_HORIZON;   /* ... are the best where nothing breaks */
  config.choice.law = BW_SOLID_CORRESPONDENCE; /* a material of deformation gradients */
  config.choice.elastic = BW_PD_MATERIAL_NEO_HOOKEAN;
  config.choice.poisson_ratio = 0.45;

  int32_t site[N][3];
  uint8_t kind[N];
  for (int q = 0; q < N; q++) {
    site[q][0] = q % NX, site[q][1] = q / NX % NY, site[q][2] = q / NX / NY;
    kind[q] = site[q][0] < 2 || site[q][0] >= NX - 2 ? BW_PD_PRESCRIBED : BW_PD_FREE;
  }
  bw_solid *block = NULL;
  static double X[N][3], V[N][3];
  BW_TRY(bw_solid_create_same(world, &config, N, site[0], kind, &block));
  const double before = width(world, block, X);

  bw_solid_get_reference(block, X[0]);
  for (size_t i = 0; i < bw_solid_count(block); i++)
    X[i][0] *= 1.2; /* grips too */
  bw_solid_set_state(block, X[0], V[0]);
  const bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  BW_TRY(bw_solid_static_relax(block, &how, &report));
  const double after = width(world, block, X);
  bw_solid_destroy(&block);
  if (bw_comm_rank(world) == 0) printf("width %.4f before, %.4f after\n", before, after);
  return after < before ? BW_OK : BW_FAIL(BW_EDIVERGED, "its sides did not draw in");
}

int main(int argc, char **argv)
{
  bw_comm *world;
  return bw_init(&argc, &argv, &world) == BW_OK ? bw_finish(&world, run(world)) : 1;
}
