/* Probability densities of values at particles. */
#include "bw_solid_stress.h"

#include <gsl/gsl_histogram.h>
#include <math.h>

bw_status bw_solid_stress_pdf(const bw_comm *comm, size_t n, const double value[],
                              const double weight[], double lower, double upper, int bins,
                              double density[], double *outside)
{
  BW_REQUIRE(isfinite(lower) && isfinite(upper) && upper > lower, BW_EINPUT,
             "solid_stress_pdf: the range %g .. %g has to be finite and not empty", lower, upper);
  BW_REQUIRE(bins > 0, BW_EINPUT, "solid_stress_pdf: bins = %d has to be positive", bins);
  /* What is out of range or no number is in the total weight, and in no bin. */
  double total[2] = {0}; /* all weight; weight inside */
  gsl_histogram *h = gsl_histogram_alloc((size_t)bins);
  const bw_status st = bw_comm_agree(
      comm, h != NULL ? BW_OK : BW_FAIL(BW_EMEM, "solid_stress_pdf: no memory for %d bins", bins));
  if (st != BW_OK) {
    if (h != NULL) gsl_histogram_free(h);
    return st;
  }
  /* Each rank counts its own, then bins are added up. */
  gsl_histogram_set_ranges_uniform(h, lower, upper);
  for (size_t i = 0; i < n; i++) {
    const double w = weight != NULL ? weight[i] : 1;
    total[0] += w;
    if (isfinite(value[i])) gsl_histogram_accumulate(h, value[i], w);
  }
  for (int q = 0; q < bins; q++)
    density[q] = gsl_histogram_get(h, (size_t)q);
  gsl_histogram_free(h);
  bw_comm_sum(comm, bins, density);
  bw_comm_sum(comm, 2, total);
  BW_REQUIRE(total[0] > 0, BW_EINPUT, "solid_stress_pdf: there is nothing to count");
  /* From weights to a density: over all weight and the width of a bin. */
  for (int q = 0; q < bins; q++) {
    total[1] += density[q];
    density[q] *= bins / ((upper - lower) * total[0]);
  }
  *outside = 1 - total[1] / total[0];
  return BW_OK;
}
