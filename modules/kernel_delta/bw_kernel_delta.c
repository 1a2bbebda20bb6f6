#include "bw_kernel_delta.h"

#include <math.h>

/* The functions choose values, not paths, so that loops over them become vector code. */
static inline double positive(double x)
{
  return x > 0.0 ? x : 0.0;
}

/* Roma, Peskin & Berger, J. Comput. Phys. 153 (1999) 509, eq. 22; POROUS 3.78. */
static inline double roma3(double r)
{
  const double a = fabs(r), b = a <= 0.5 ? a : 1.0 - a;
  const double root = sqrt(positive(1.0 - 3.0 * b * b)); /* negative beyond the radius only */
  const double value = a <= 0.5 ? (1.0 + root) / 3.0 : (5.0 - 3.0 * a - root) / 6.0;
  return a >= 1.5 ? 0.0 : value;
}

/* Peskin, Acta Numerica 11 (2002) 479, eq. 6.27. The radicand of the outer branch is >= 0 on
 * [1,2] but for rounding next to 2. */
static inline double peskin4(double r)
{
  const double a = fabs(r);
  const double inner = 1.0 + 4.0 * a - 4.0 * a * a, outer = -7.0 + 12.0 * a - 4.0 * a * a;
  const double root = sqrt(positive(a <= 1.0 ? inner : outer));
  const double value = a <= 1.0 ? (3.0 - 2.0 * a + root) / 8.0 : (5.0 - 2.0 * a - root) / 8.0;
  return a >= 2.0 ? 0.0 : value;
}

static inline double hat2(double r)
{
  return positive(1.0 - fabs(r));
}

/* Nodes in (s - radius, s + radius]: of a tie between the two ends, where phi vanishes on both, the
 * upper one is kept, so that a marker on a block's lower edge stays in its halo. */
#define WEIGH(phi, support, radius)                                                                \
  static void weigh_##phi(size_t n, const double *restrict s, int *restrict first,                 \
                          double *restrict weight)                                                 \
  {                                                                                                \
    for (size_t i = 0; i < n; i++)                                                                 \
      first[i] = (int)floor(s[i] - (radius)) + 1;                                                  \
    for (int q = 0; q < (support); q++, weight += n)                                               \
      for (size_t i = 0; i < n; i++)                                                               \
        weight[i] = phi(s[i] - (double)(first[i] + q));                                            \
  }
WEIGH(roma3, 3, 1.5)
WEIGH(peskin4, 4, 2.0)
WEIGH(hat2, 2, 1.0)

static const bw_kernel_delta table[BW_KERNEL_COUNT] = {
    [BW_KERNEL_ROMA3] = {"roma3", 3, 1.5, 0.5, roma3, weigh_roma3},
    [BW_KERNEL_PESKIN4] = {"peskin4", 4, 2.0, 0.375, peskin4, weigh_peskin4},
    [BW_KERNEL_HAT2] = {"hat2", 2, 1.0, 0.0, hat2, weigh_hat2},
};

const bw_kernel_delta *bw_kernel_delta_get(bw_kernel_delta_id id)
{
  return &table[id];
}

void bw_kernel_delta_weights(const bw_kernel_delta *kernel, size_t n, const double s[], int first[],
                             double weight[])
{
  kernel->weigh(n, s, first, weight);
}
