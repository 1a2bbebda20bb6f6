/* bw_number.h -- whole numbers from floating ones, by no conversion that can overflow.
 *
 * C leaves undefined what (int)1e30 or llround(NaN) is. Numbers that a user or a flow decides about
 * become counts through these functions alone. */
#pragma once
#include "bw_decls.h"
#include <stdbool.h>
#include <stdint.h>

BW_BEGIN_DECLS

/* Steps that a run or an interval may take. A trillion steps of a millisecond last thirty years:
 * whoever asks for more has mistaken a unit. */
#define BW_MOST_STEPS INT64_C(1000000000000)

/* *n = x rounded to the nearest whole number. False, and *n as it was, when x is not finite or
 * outside what an int holds. Local. */
bool bw_to_int(double x, int *n);

/* The same for 64 bits; |x| is at most 2^53, up to where a double holds every whole number. Local.
 */
bool bw_to_int64(double x, int64_t *n);

/* *n = whole/part where that is a whole number from 1 to BW_MOST_STEPS, to 1e-9 of it (decimal
 * fractions are not exact in binary). False, and *n as it was, otherwise. Local. */
bool bw_divides(double whole, double part, int64_t *n);

BW_END_DECLS
