/* bw_real.h -- the floating-point type of fields and particles.
 *
 * double by default; float with -DBW_PRECISION=single, which defines BW_SINGLE. Time, reductions,
 * statistics and geometry are double always. */
#pragma once
#include <float.h>

#ifdef BW_SINGLE
typedef float bw_real;                        /* of fields and particles */
#define BW_REAL_EPSILON ((double)FLT_EPSILON) /* distance from 1 to the next bw_real */
#define BW_REAL_NAME    "single"              /* the word for messages and records */
#else
typedef double bw_real; /* of fields and particles */
#define BW_REAL_EPSILON DBL_EPSILON /* distance from 1 to the next bw_real */
#define BW_REAL_NAME    "double"    /* the word for messages and records */
#endif
