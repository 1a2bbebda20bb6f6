/* Claim: the weights of every regularised delta have the moments that force, torque and the rate
 * of multi-direct forcing rest on, and interpolate smooth fields to second order.
 *
 * Measured   through bw_kernel_delta_weights, as interpolation and spreading use it, for shifts all
 *            over a cell: sum (force), first moment (torque), sum of squares (1 - C is what one
 *            iteration leaves of the slip of a flat sheet).
 * Reference  POROUS 3.5.1 with ERRATA 16: 1, 0 and Roma's 1/2; Peskin 2002 eq. 6.13: 3/8; the hat:
 *            t^2 + (1-t)^2. Roma's second moment and sum over even nodes: data/kernel_delta.
 *            Interpolated cosine: the cosine itself; what is left falls with h^2 (half the second
 *            moment times the curvature).
 * Tolerance  round-off of four weights, each with a root: 8 epsilon, times 2 for the arm of the
 * first moment. The table is printed to nine digits. Order: 0.05, the next term is (k h)^2 smaller,
 * 6e-3 on the coarser grid.
 * BUILD modules=kernel_delta
 * TEST  ranks=1 */
#include "bw_kernel_delta.h"
#include "bw_validation.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

enum { SHIFTS = 997, TABLE = 16, COLUMNS = 6 };
static const double ROUND_OFF = 8.0 * DBL_EPSILON;

typedef struct {
  double sum, first, squares, second, even;
} moments;

/* Of the weights at a point t cells above a node of even number. */
static moments moments_at(const bw_kernel_delta *k, double t)
{
  const double s = 2.0 + t;
  double w[BW_KERNEL_MAX_SUPPORT];
  int first;
  bw_kernel_delta_weights(k, 1, &s, &first, w);
  moments m = {0};
  for (int q = 0; q < k->support; q++) {
    const double arm = s - (first + q);
    m.sum += w[q];
    m.first += arm * w[q];
    m.second += arm * arm * w[q];
    m.squares += w[q] * w[q];
    if ((first + q) % 2 == 0) m.even += w[q];
  }
  return m;
}

static double squares_of(const bw_kernel_delta *k, double t)
{
  return k->sum_of_squares > 0.0 ? k->sum_of_squares : t * t + (1.0 - t) * (1.0 - t);
}

/* Largest departures over all shifts. */
static void defining_moments(bw_validation *v, const bw_kernel_delta *k)
{
  moments worst = {0};
  char claim[96];
  for (int q = 0; q < SHIFTS; q++) {
    const double t = (double)q / SHIFTS;
    const moments m = moments_at(k, t);
    worst.sum = fmax(worst.sum, fabs(m.sum - 1.0));
    worst.first = fmax(worst.first, fabs(m.first));
    worst.squares = fmax(worst.squares, fabs(m.squares - squares_of(k, t)));
  }
  const struct {
    const char *what, *quantity;
    double value, tolerance;
  } row[] = {{"sum of the weights less 1", "sum", worst.sum, ROUND_OFF},
             {"first moment", "first_moment", worst.first, 2.0 * ROUND_OFF},
             {"sum of squares less its value", "sum_of_squares", worst.squares, ROUND_OFF}};
  for (int q = 0; q < 3; q++) {
    snprintf(claim, sizeof claim, "%s: %s, any shift", k->name, row[q].what);
    bw_validation_row(v, &(bw_claim){.claim = claim,
                                     .quantity = row[q].quantity,
                                     .measured = row[q].value,
                                     .tolerance = row[q].tolerance,
                                     .kind = BW_ANALYTIC,
                                     .source = "POROUS 3.5.1 with ERRATA 16; Peskin 2002"});
  }
}

static bw_status published_moments(bw_validation *v)
{
  double table[TABLE][COLUMNS];
  int rows = 0;
  BW_TRY(bw_validation_table("kernel_delta/roma1999.csv", COLUMNS, TABLE, &table[0][0], &rows));
  for (int q = 0; q < rows; q++) {
    char claim[96];
    const moments m = moments_at(bw_kernel_delta_get(BW_KERNEL_ROMA3), table[q][0]);
    const double found[2] = {m.second, m.even};
    static const char *const name[2] = {"second moment", "sum over even nodes"};
    for (int c = 0; c < 2; c++) {
      snprintf(claim, sizeof claim, "roma3: %s at %.2f", name[c], table[q][0]);
      bw_validation_row(v, &(bw_claim){.claim = claim,
                                       .quantity = c == 0 ? "second_moment" : "even_sum",
                                       .measured = found[c],
                                       .reference = table[q][4 + c],
                                       .tolerance = 2.5e-9,
                                       .kind = BW_PUBLISHED,
                                       .source = "Roma, Peskin & Berger 1999; data/kernel_delta"});
    }
  }
  return BW_OK;
}

/* Largest error of cos(2 pi x) interpolated from n nodes on a unit period. */
static double interpolation_error(const bw_kernel_delta *k, int n)
{
  const double turn = 2.0 * acos(-1.0);
  double worst = 0.0;
  for (int q = 0; q < SHIFTS; q++) {
    double w[BW_KERNEL_MAX_SUPPORT], u = 0.0;
    const double s = 10.0 + (double)n * q / SHIFTS;
    int first;
    bw_kernel_delta_weights(k, 1, &s, &first, w);
    for (int i = 0; i < k->support; i++)
      u += w[i] * cos(turn * (first + i) / n);
    worst = fmax(worst, fabs(u - cos(turn * s / n)));
  }
  return worst;
}

static void interpolation_order(bw_validation *v, const bw_kernel_delta *k)
{
  char claim[96];
  snprintf(claim, sizeof claim, "%s: order of interpolation", k->name);
  bw_validation_row(
      v, &(bw_claim){.claim = claim,
                     .quantity = "order",
                     .measured = bw_validation_order(1.0 / 80, interpolation_error(k, 80),
                                                     1.0 / 160, interpolation_error(k, 160)),
                     .reference = 2.0,
                     .tolerance = 0.025,
                     .kind = BW_ORDER,
                     .source = "two moments exact: error (h^2/2) u'' sum (x/h)^2 phi"});
}

static bw_status run(bw_validation *v)
{
  for (int id = 0; id < BW_KERNEL_COUNT; id++) {
    const bw_kernel_delta *k = bw_kernel_delta_get((bw_kernel_delta_id)id);
    defining_moments(v, k);
    interpolation_order(v, k);
  }
  return published_moments(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "kernel_delta.moments", run);
}
