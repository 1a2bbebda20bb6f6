/* bw_log.h -- what a run tells its user: lines from rank 0, and one progress line.
 *
 * On a terminal the progress line is redrawn in place; elsewhere a plain line is printed now and
 * then. Log lines never mix with it. A NULL log or progress is silent, so that modules and tests
 * may do without. Calls are local: ranks other than 0 return at once. */
#pragma once
#include "bw_comm.h"
#include <stdio.h>

BW_BEGIN_DECLS

/* Where the lines of a run go. */
typedef struct bw_log bw_log;

/* How a log speaks; start from bw_log_config_default. */
typedef struct {
  bool quiet;            /* no info lines and no progress; warnings stay. Default false. */
  FILE *out, *err;       /* default stdout, stderr; borrowed until destroy */
  int terminal;          /* columns of the terminal that `out` is (1: unknown); 0 not a terminal;
                            -1 ask the system (default) */
  double plain_seconds;  /* between plain progress lines [s]; default 10 */
  double redraw_seconds; /* between redraws on a terminal [s]; default 0.2 */
  double (*clock)(void); /* [s] from an arbitrary origin; default bw_wall_time. A test has its own,
                            so that it does not depend on how busy the machine is. */
} bw_log_config;

/* The defaults named above. Local. */
bw_log_config bw_log_config_default(void);

/* *out = a log of this rank, which speaks on rank 0 of `comm` only. NULL config: the defaults; it
 * is copied. BW_EMEM. Local. */
bw_status bw_log_create(const bw_comm *comm, const bw_log_config *config,
                        bw_log **out) BW_MUST_CHECK;

/* Close a progress line that is open, free *log and set it to NULL; NULL inside is fine. Local. */
void bw_log_destroy(bw_log **log);

/* One or more lines on rank 0, in printf's format; a newline is added at the end. Local. */
void bw_log_info(bw_log *log, const char *fmt, ...) BW_PRINTF(2, 3);

/* The same on stderr with "warning: " in front, also when quiet; kept for run.yaml. Local. */
void bw_log_warn(bw_log *log, const char *fmt, ...) BW_PRINTF(2, 3);

/* The text of warning q = 0, 1, .. of the log; NULL beyond the last one that was kept (the first
 * 20), on other ranks than 0, and where log is NULL. Borrowed until destroy. Local. */
const char *bw_log_warning(const bw_log *log, int q);

/* The one line that says how far a run is. */
typedef struct bw_progress bw_progress;

/* What a run has before it; start from bw_progress_config_default. */
typedef struct {
  double time_start, time_end;  /* simulated time [s] of this run (after a restart: from there);
                                   NaN end: the ETA follows the steps */
  int64_t step_start, step_end; /* numbers of the first and last step; step_end 0: not known */
  const char *time_unit;        /* default "s"; borrowed until finish */
} bw_progress_config;

/* From time 0 and step 0 to an end that is not known. Local. */
bw_progress_config bw_progress_config_default(void);

/* *out = a progress line on `log` (borrowed until finish; NULL: silent). NULL config: the defaults;
 * it is copied. The speed is measured from here on. BW_EMEM. Local. */
bw_status bw_progress_create(bw_log *log, const bw_progress_config *config,
                             bw_progress **out) BW_MUST_CHECK;

/* After step number `step`, at the simulated `time`: `fmt` adds the watched quantities, e.g. "dp/p0
 * %.4f". The text is formed only when a line is due, so call it in every step with values this rank
 * has already. Local. */
void bw_progress_update(bw_progress *progress, int64_t step, double time, const char *fmt, ...)
    BW_PRINTF(4, 5);

/* The last state as a plain line with the mean speed, then *progress is freed and set to NULL. NULL
 * inside is fine. Local. */
void bw_progress_finish(bw_progress **progress);

BW_END_DECLS
