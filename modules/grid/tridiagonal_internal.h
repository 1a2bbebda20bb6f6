/* tridiagonal_internal.h -- shared by the sources of bw_tridiagonal only; the algebra is in the
 * head of bw_tridiagonal.c. */
#pragma once
#include "bw_tridiagonal.h"
#include "grid_internal.h"

enum { SUB, DIAGONAL, RIGHT, NEXT_F, NEXT_L, NEXT_G, PLANES }; /* what a rank tells of a line */
enum { BEFORE, OWN, ANSWERS };                                 /* the separators it is told */
enum { N = BW_TRIDIAGONAL_LINES };

struct bw_tridiagonal {
  bw_grid *grid;
  int d; /* direction of the lines */
  size_t lines;
  int n, lo;           /* rows of all ranks, before this rank's */
  int ranks, me, rows; /* in direction d; rows of this rank */
  int inner;           /* rows between the separators: rows - 1, or rows */
  bool cyclic;
  bw_real *lower, *diagonal, *upper; /* (n) */
  bw_real *pivot;                    /* (rows, N) reciprocals */
  bw_real *zero;                     /* (N) zeros */
  /* The lines are dealt out in consecutive portions. A portion of c lines is [PLANES][c] on the
   * way to its solver and [ANSWERS][c] back. */
  size_t *portion;                     /* (ranks+1) first line of each rank's portion */
  size_t *tell_start, *tell_count;     /* (ranks) in `tell` */
  size_t *hear_start, *hear_count;     /* in `hear`: [ranks][PLANES][my portion] */
  size_t *reply_start, *reply_count;   /* in `reply`: [ranks][ANSWERS][my portion] */
  size_t *answer_start, *answer_count; /* in `answer` */
  bw_real *tell, *hear, *reply, *answer;
  bw_real *work; /* (ranks, 3, N) */
};
