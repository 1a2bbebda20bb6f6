/* bw_real.h -- the floating-point type of fields and particles.
 *
 * double by default; float with -DBW_PRECISION=single. Time, reductions, statistics and
 * geometry are double always. */
#pragma once
#include <float.h>

#ifdef BW_SINGLE
typedef float bw_real;
#define BW_REAL_EPSILON ((double)FLT_EPSILON)
#define BW_REAL_NAME    "single"
#else
typedef double bw_real;
#define BW_REAL_EPSILON DBL_EPSILON
#define BW_REAL_NAME    "double"
#endif
