/* A point of rubber is sheared: what stress does it answer with?
 * BUILD modules=pd_material
 * TEST  ranks=1 */
#include "bw_comm.h"
#include "bw_pd_material.h"

#include <math.h>
#include <stdio.h>

int main(int argc, char **argv)
{
  bw_comm *world;
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;

  const bw_pd_material_point rubber =
      bw_pd_material_elastic_point(BW_PD_MATERIAL_SPACE, BW_PD_MATERIAL_NEO_HOOKEAN, 1.4e6, 0.4);
  bw_pd_material_lanes H[9] = {{0}}, P[9], W;
  H[1] += 0.1; /* F - 1: a simple shear of all eight points */
  bw_pd_material_stress(&rubber, H, P, &W);

  printf("shear stress %g Pa, energy %g J/m3\n", P[1][0], W[0]);
  const bool right = fabs(P[1][0] / (0.1 * rubber.mu) - 1) < 1e-12;
  return bw_finish(&world, right ? BW_OK : BW_FAIL(BW_EDIVERGED, "the stress is not mu times 0.1"));
}
