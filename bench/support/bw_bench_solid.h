/* bw_bench_solid.h -- the time of a peridynamic step, for the benchmarks of solids. */
#pragma once
#include "bw_bench.h"
#include "bw_solid.h"

/* Some steps of a solid, as work to be timed. */
typedef struct {
  bw_solid *pd; /* borrowed */
  int steps;    /* per call */
  double dt;    /* [T] */
  bw_status st; /* of all calls so far */
} bw_bench_solid;

/* Takes the steps; context: a bw_bench_solid. Collective. */
static inline void bw_bench_solid_advance(void *context)
{
  bw_bench_solid *w = context;
  for (int q = 0; q < w->steps; q++)
    BW_THEN(w->st, bw_solid_step(w->pd, w->dt));
}

/* Seconds per step, the median of repetitions of `steps` at half the limit. Collective. */
static inline double bw_bench_solid_seconds(const bw_comm *comm, bw_solid *pd, int steps,
                                            bw_status *st)
{
  bw_bench_solid w = {pd, steps, 0.5 * bw_solid_dt_max(pd), BW_OK};
  const double seconds = bw_bench_median(comm, bw_bench_solid_advance, &w) / steps;
  *st = w.st;
  return seconds;
}
