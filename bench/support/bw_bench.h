/* bw_bench.h -- a benchmark program: medians of repetitions, ratios to a rival and to a floor.
 *
 *   int main(int argc, char **argv) { return bw_bench_main(argc, argv, "fluid", run); }
 * Writes $BW_BUILD_DIR/bench/NAME.json, rows {case, quantity, value, unit, rival, rival_value,
 * rival_measured, floor_value, ratio_to_rival, ratio_to_floor}. A rival is what was timed in this
 * run, never elsewhere: only then is a ratio one. Nothing here fails on a clock. */
#pragma once
#include "bw_comm.h"

/* A program's ranks and its file. Opaque. */
typedef struct bw_bench bw_bench;

/* One number. */
typedef struct {
  const char *name;     /* the case */
  const char *quantity; /* what was measured, such as "core_ns_per_cell_substep" */
  const char *unit;     /* its unit; "" or "-": none */
  double value;         /* what was measured */
  const char *rival;    /* another code, or the same without what is priced; NULL: none */
  double rival_value;   /* the same of the rival, timed in this run; NaN: it was not */
  double floor_value;   /* what cannot be undercut on this machine; NaN: none */
} bw_bench_row;

enum { BW_BENCH_REPETITIONS = 7 }; /* of each measurement */

/* All ranks of the program, borrowed. Local. */
const bw_comm *bw_bench_comm(const bw_bench *b);
/* Writes a row to the file and the screen; rank 0 does, others return. Local. */
void bw_bench_put(bw_bench *b, const bw_bench_row *row);

/* Median over the repetitions of the largest time over ranks that `work(context)` takes [s]; one
 * more call before warms up. Collective. */
double bw_bench_median(const bw_comm *comm, void (*work)(void *context), void *context);

/* Median of x[n]; sorts x. Pure but for that. */
double bw_bench_middle(int n, double x[]);

/* Bytes per second and rank of a triad a = b + s c on arrays far larger than any cache, all ranks
 * of comm at once (write-allocate traffic not counted, as in STREAM). Collective. */
double bw_bench_triad(const bw_comm *comm);

/* The main of a benchmark: initialises, opens the file, runs, closes. Returns the exit code. */
int bw_bench_main(int argc, char **argv, const char *name, bw_status (*run)(bw_bench *b));
