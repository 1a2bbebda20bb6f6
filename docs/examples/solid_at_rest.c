/* A strip is held at one end and pulled at the other until it is at rest; its stress is the
 * traction.
 * BUILD modules=solid,solid_tools,shape
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid_load.h"
#include "bw_solid_static.h"
#include "bw_solid_stress.h"
#include <math.h>
#include <stdio.h>

static const double LENGTH = 0.060, HEIGHT = 0.020, PULL = 1e6; /* [m], [m], [Pa] */

static bw_status strip(const bw_comm *world, bw_solid **solid)
{
  bw_solid_config config = bw_solid_config_default();
  config.geometry = BW_PD_PLANE_STRESS;
  config.ds = 1e-3;
  config.rho = 1200;
  config.E = 3e9;
  config.surface_correction = BW_PD_SURFACE_TENSOR;
  config.calibration = BW_PD_CALIBRATION_LATTICE;
  const bw_shape shapes[] = {/* the last three layers on the left are held */
                             {.upper = {LENGTH, HEIGHT, 1}},
                             {.upper = {0.003, HEIGHT, 1}, .particle_kind = BW_PD_PRESCRIBED}};
  int64_t n;
  int32_t *site;
  uint8_t *kind;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(config.ds, config.origin, true);
  BW_TRY(bw_shape_fill_shared(world, 2, shapes, &lattice, &n, &site, &kind, NULL));
  const bw_pd_sites part = {.n = n, .site = site, .kind = kind};
  const bw_status st = bw_solid_create(world, &config, &part, solid);
  bw_release(&site), bw_release(&kind);
  return st;
}

/* Mean of sigma_xx over the middle third of the strip. */
static double stress_in_the_middle(const bw_solid *solid, const double X0[], const double stress[])
{
  double sum[2] = {0};
  for (size_t i = 0; i < bw_solid_count(solid); i++)
    if (fabs(X0[3 * i] - LENGTH / 2) < LENGTH / 6) {
      sum[0] += stress[6 * i];
      sum[1] += 1;
    }
  bw_comm_sum(bw_solid_comm(solid), 2, sum);
  return sum[0] / sum[1];
}

static bw_status run(const bw_comm *world)
{
  bw_solid *solid;
  double *F = NULL, *stress = NULL, *X0 = NULL;
  BW_TRY(strip(world, &solid));
  const size_t n = bw_solid_count(solid);
  BW_TRY(BW_ALLOCATE(&F, 3 * n)); /* zero */
  BW_TRY(BW_ALLOCATE(&X0, 3 * n));
  BW_TRY(BW_ALLOCATE(&stress, 6 * n));
  const double lower[3] = {LENGTH - 0.003}, upper[3] = {LENGTH, HEIGHT}, pull[3] = {PULL};
  bw_solid_static_config at_rest = bw_solid_static_config_default();
  bw_solid_static_report report;
  BW_TRY(bw_solid_load_traction(solid, lower, upper, HEIGHT, pull, F)); /* thickness 1 */
  bw_solid_set_force(solid, F);
  BW_TRY(bw_solid_static_relax(solid, &at_rest, &report));
  bw_solid_stress_compute(solid, NULL, stress);
  bw_solid_get_reference(solid, X0);
  const double ratio = stress_in_the_middle(solid, X0, stress) / PULL;
  if (bw_comm_rank(world) == 0)
    printf("at rest to %.1e after %lld evaluations; stress over traction %.5f\n", report.residual,
           (long long)report.iterations, ratio);
  bw_solid_destroy(&solid);
  bw_release(&F), bw_release(&X0), bw_release(&stress);
  return fabs(ratio - 1) < 1e-3 ? BW_OK
                                : BW_FAIL(BW_EDIVERGED, "stress is %g of the traction", ratio);
}

int main(int argc, char **argv)
{
  bw_comm *world;
  return bw_init(&argc, &argv, &world) == BW_OK ? bw_finish(&world, run(world)) : 1;
}
