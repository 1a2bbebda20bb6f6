/* bw_bench.h -- a benchmark program: medians of repetitions, ratios to a rival and to a floor.
 *
 *   int main(int argc, char **argv) { return bw_bench_main(argc, argv, "fluid", run); }
 * Writes $BW_BUILD_DIR/bench/NAME.json, rows {case, quantity, value, unit, rival, rival_value,
 * floor_value, ratio_to_rival, ratio_to_floor}. Nothing here fails on a clock. */
#pragma once
#include "bw_comm.h"

typedef struct bw_bench bw_bench;

typedef struct {
  const char *name, *quantity, *unit; /* the case; "core_ns_per_cell_substep" */
  double value;
  const char *rival;               /* who was measured, where and how; NULL: none */
  double rival_value, floor_value; /* NaN: none */
} bw_bench_row;

enum { BW_BENCH_REPETITIONS = 7 };

const bw_comm *bw_bench_comm(const bw_bench *b);
void bw_bench_put(bw_bench *b, const bw_bench_row *row);

/* Median over the repetitions of the largest time over ranks that `work(context)` takes [s]; one
 * more call before warms up. Collective. */
double bw_bench_median(const bw_comm *comm, void (*work)(void *context), void *context);

/* Median of x[n]; sorts x. */
double bw_bench_middle(int n, double x[]);

/* Bytes per second and rank of a triad a = b + s c on arrays far larger than any cache, all ranks
 * of comm at once (write-allocate traffic not counted, as in STREAM). Collective. */
double bw_bench_triad(const bw_comm *comm);

int bw_bench_main(int argc, char **argv, const char *name, bw_status (*run)(bw_bench *b));
