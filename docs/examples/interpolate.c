/* Values of a field of one dimension between its nodes, by the weights of a regularised delta
 * function: a linear field comes back exactly.
 * BUILD modules=kernel_delta
 * TEST  ranks=1 */
#include "bw_comm.h"
#include "bw_kernel_delta.h"
#include <float.h>
#include <math.h>

enum { POINTS = 5, NODES = 10 };

/* value[i] of the field at s[i], in cells: node 0 lies at 0, node 1 at 1. */
static void interpolate(const double field[NODES], const double s[POINTS], double value[POINTS])
{
  const bw_kernel_delta *kernel = bw_kernel_delta_get(BW_KERNEL_ROMA3);
  int first[POINTS];
  double weight[BW_KERNEL_MAX_SUPPORT * POINTS];
  bw_kernel_delta_weights(kernel, POINTS, s, first, weight);
  for (int i = 0; i < POINTS; i++) {
    value[i] = 0.0;
    for (int q = 0; q < kernel->support; q++)
      value[i] += weight[q * POINTS + i] * field[first[i] + q];
  }
}

int main(int argc, char **argv)
{
  const double s[POINTS] = {2.0, 2.3, 3.5, 5.49, 6.999};
  double field[NODES], value[POINTS], worst = 0.0;
  bw_comm *world = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  for (int i = 0; i < NODES; i++)
    field[i] = 1.0 + 0.1 * i;
  interpolate(field, s, value);
  for (int i = 0; i < POINTS; i++)
    worst = fmax(worst, fabs(value[i] - (1.0 + 0.1 * s[i])));
  /* three products and sums of numbers below 2 */
  if (st == BW_OK && !(worst < 10 * DBL_EPSILON))
    st = BW_FAIL(BW_EDIVERGED, "a linear field is off by %g", worst);
  return bw_finish(&world, st);
}
