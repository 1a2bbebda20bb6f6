#include "bw_kernel_delta.h"

#include <math.h>

/* Roma, Peskin & Berger, J. Comput. Phys. 153 (1999) 509, eq. 22; POROUS 3.78. */
static double roma3(double r)
{
  const double a = fabs(r);
  if (a >= 1.5) return 0.0;
  if (a <= 0.5) return (1.0 + sqrt(1.0 - 3.0 * a * a)) / 3.0;
  const double b = 1.0 - a;
  return (5.0 - 3.0 * a - sqrt(1.0 - 3.0 * b * b)) / 6.0;
}

/* Peskin, Acta Numerica 11 (2002) 479, eq. 6.27. The radicand of the outer branch is >= 0 on
 * [1,2] but for rounding next to 2. */
static double peskin4(double r)
{
  const double a = fabs(r);
  if (a >= 2.0) return 0.0;
  if (a <= 1.0) return (3.0 - 2.0 * a + sqrt(1.0 + 4.0 * a - 4.0 * a * a)) / 8.0;
  return (5.0 - 2.0 * a - sqrt(fmax(0.0, -7.0 + 12.0 * a - 4.0 * a * a))) / 8.0;
}

static double hat2(double r)
{
  return fmax(0.0, 1.0 - fabs(r));
}

static const bw_kernel_delta table[BW_KERNEL_COUNT] = {
    [BW_KERNEL_ROMA3] = {"roma3", 3, 1.5, 0.5, roma3},
    [BW_KERNEL_PESKIN4] = {"peskin4", 4, 2.0, 0.375, peskin4},
    [BW_KERNEL_HAT2] = {"hat2", 2, 1.0, 0.0, hat2},
};

const bw_kernel_delta *bw_kernel_delta_get(bw_kernel_delta_id id)
{
  return &table[id];
}

int bw_kernel_delta_weights(const bw_kernel_delta *kernel, double s,
                            double weight[BW_KERNEL_MAX_SUPPORT])
{
  /* nodes in (s - radius, s + radius]: of a tie between the two ends, where phi vanishes on
   * both, the upper one is kept, so that a marker on a block's lower edge stays in its halo */
  const int first = (int)floor(s - kernel->radius) + 1;
  for (int q = 0; q < kernel->support; q++)
    weight[q] = kernel->phi(s - (double)(first + q));
  return first;
}
