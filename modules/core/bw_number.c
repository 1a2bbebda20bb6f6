#include "bw_number.h"

#include <limits.h>
#include <math.h>

bool bw_to_int(double x, int *n)
{
  const double whole = round(x);
  /* Written so that NaN fails. */
  if (!(whole >= (double)INT_MIN && whole <= (double)INT_MAX)) return false;
  *n = (int)whole;
  return true;
}

bool bw_to_int64(double x, int64_t *n)
{
  static const double exact = 9007199254740992.0; /* 2^53 */
  const double whole = round(x);
  if (!(whole >= -exact && whole <= exact)) return false;
  *n = (int64_t)whole;
  return true;
}

bool bw_divides(double whole, double part, int64_t *n)
{
  static const double tolerance = 1e-9; /* of the ratio; rounding of a ratio is 1e-16 of it */
  const double ratio = whole / part;
  int64_t times = 0;
  if (!bw_to_int64(ratio, &times) || times < 1 || times > BW_MOST_STEPS) return false;
  if (fabs(ratio - (double)times) > tolerance * ratio) return false;
  *n = times;
  return true;
}
