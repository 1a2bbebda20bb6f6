/* Whether a relaxed load holds, from the fluid's answer lambda (stability.c, which says what it is
 * and derives the recurrence). */
#include "coupler_internal.h"

#include <math.h>

/* Growth a step that a memory of forty steps does not tell from 1. */
static const double SLOW = 1.02;

/* What goes on behind a memory: nothing, or a drag, which lasts as long as a motion does. */
static double drag_of(int n, const double lambda[])
{
  enum { LAST = 8 };
  double mean = 0.0;
  for (int q = n - LAST; q < n && n >= LAST; q++)
    mean += lambda[q] / LAST;
  return fmax(0.0, mean);
}

/* What the fluid is told beyond y with a predictor (predictor.c), change: of y since the last step.
 */
static double ahead(double change, double *lag)
{
  const double more = 0.5 * change - BW_COUPLER__CATCH_UP * *lag;
  *lag += more;
  return 0.5 * change + BW_COUPLER__CATCH_UP * more;
}

bool bw_coupler__relaxation_holds(int n, const double lambda[], double w, bool predictor)
{
  enum { LONG = 1200 };
  const double drag = drag_of(n, lambda);
  double b[LONG] = {1.0}, y = 0.0, lag = 0.0, early = 0.0, late = 0.0, before = 0.0;
  for (int k = 0; k + 1 < LONG; k++) {
    /* The velocity of n steps ago is the sum of all its changes until then. */
    before += k >= n ? b[k - n] : 0.0;
    double sum = drag * before;
    for (int q = 0; q < n && q <= k; q++)
      sum += lambda[q] * b[k - q];
    const double last = y;
    y = (1.0 - w) * y - w * sum;
    b[k + 1] = y + (predictor ? ahead(y - last, &lag) : 0.0);
    if (!(fabs(y) < 1e100)) return false;
    if (k >= LONG / 2)
      late = fmax(late, fabs(y));
    else if (k >= n)
      early = fmax(early, fabs(y));
  }
  return late <= early * pow(SLOW, LONG / 2);
}

/* The largest W up to which all hold; the set need not be whole: where an answer comes late, more
 * of a load at once may hold again, but not on purpose. */
static double all_below(int n, const double lambda[], bool predictor)
{
  static const double least = 1e-4, up = 1.3, fine = 1.01;
  double low = 0.0, high = least;
  while (high < 1.0 && bw_coupler__relaxation_holds(n, lambda, high, predictor))
    low = high, high = fmin(1.0, high * up);
  if (bw_coupler__relaxation_holds(n, lambda, high, predictor)) return high;
  while (low > 0.0 && high > fine * low) {
    const double middle = sqrt(low * high);
    *(bw_coupler__relaxation_holds(n, lambda, middle, predictor) ? &low : &high) = middle;
  }
  return low;
}

double bw_coupler__relaxation_limit(int n, const double lambda[], double mu, bool predictor)
{
  const double W = all_below(n, lambda, predictor);
  /* What the virtual mass makes of w: W is no more than 1/mu whatever w is. */
  if (mu * W >= 1.0) return 1.0;
  return mu > 0.0 ? fmin(1.0, -log1p(-mu * W) / mu) : W;
}
