/* bw_timer.h -- where the wall time of a run goes, by part, and what one unit of work costs.
 *
 *   static const bw_timer_part parts[] = {{"momentum", "cell sub-step"}, {"solid", "bond"}};
 *   bw_timer_start(t, MOMENTUM); ...; bw_timer_stop(t, MOMENTUM); bw_timer_work(t, MOMENTUM, n);
 * Parts do not overlap or nest. A NULL timer is fine everywhere: nothing is measured. */
#pragma once
#include "bw_log.h"

BW_BEGIN_DECLS

/* Wall time and work of this rank, by part. */
typedef struct bw_timer bw_timer;

/* A part of a run, as the caller names it. */
typedef struct {
  const char *name;      /* "momentum" */
  const char *work_unit; /* what bw_timer_work counts; NULL when nothing is counted */
} bw_timer_part;

/* What bw_timer_summary says of a part. */
typedef struct {
  const char *name, *work_unit; /* of the part; borrowed as in create */
  double seconds;               /* wall time in this part: the largest over ranks [s] */
  double seconds_mean;          /* mean over ranks [s]; below `seconds` where ranks wait or idle */
  double share;                 /* seconds_mean over the mean wall time since create or reset */
  double work;                  /* units, summed over ranks */
  double ns_per_unit;           /* core-ns per unit: 1e9 seconds ranks / work; NaN without work */
  int64_t calls;                /* starts, largest over ranks */
} bw_timer_row;

/* *out = a timer of n parts, all sums zero, whose total starts now. `parts` and its texts are
 * borrowed until destroy. BW_EMEM; *out is NULL then. Local. */
bw_status bw_timer_create(int n, const bw_timer_part parts[], bw_timer **out) BW_MUST_CHECK;
/* Free *timer and set it to NULL; NULL inside is fine. Local. */
void bw_timer_destroy(bw_timer **timer);

/* All sums to zero; the total starts now. Local. */
void bw_timer_reset(bw_timer *timer);

/* Part `part` (0 .. n-1) begins; no other is running. Local. */
void bw_timer_start(bw_timer *timer, int part);

/* Part `part` ends; counted as one call. Local. */
void bw_timer_stop(bw_timer *timer, int part);

/* Charge `seconds` of part `from` to `to`: what a callee measured of itself. Local. */
void bw_timer_move(bw_timer *timer, int from, int to, double seconds);

/* Count `units` of work of this rank in `part`. Local. */
void bw_timer_work(bw_timer *timer, int part, double units);

/* Wall time of this rank in `part` so far [s], a running interval excluded; 0 for NULL. Local. */
double bw_timer_seconds(const bw_timer *timer, int part);

/* n of create; 0 for NULL. Local. */
int bw_timer_parts(const bw_timer *timer);

/* rows[n+1]: the parts, then "other" (the wall time in no part); shares sum to 1. *total [s] is
 * the largest wall time over ranks. The same on all ranks. A NULL timer (on all ranks) fills
 * rows[0] alone. Collective. */
void bw_timer_summary(const bw_timer *timer, const bw_comm *comm, bw_timer_row rows[],
                      double *total);

/* The summary as a table through `log` (may be NULL). BW_EMEM, agreed by all ranks. Collective. */
bw_status bw_timer_report(const bw_timer *timer, const bw_comm *comm, bw_log *log) BW_MUST_CHECK;

BW_END_DECLS
