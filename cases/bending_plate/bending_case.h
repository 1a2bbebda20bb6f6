/* bending_case.h -- the bending plate as a case: what its YAML says, its files. */
#pragma once
#include "bending_flow.h"
#include "bw_case.h"
#include "bw_history.h"

/* How long. */
typedef struct {
  double step;    /* of the fluid [s]; the solid sub-cycles */
  double release; /* the plate is held until then [s]        default 0 */
  double end;     /* of the run [s] */
} bending_time;
/* Steps between rows and files; 0: at the end only. */
typedef struct {
  int sample_every;     /* rows of history.csv                default 10 */
  int picture_every;    /* VTK files                          default 0 */
  int checkpoint_every; /* checkpoint-last.h5                 default 0 */
} bending_output;
/* What the YAML file says. */
typedef struct {
  bending_config physics; /* the set-up, shared with the validation of the coupler */
  bending_time time;
  bending_output output;
} bending_case;

extern const bw_config_field bending_case_fields[]; /* its keys (bending_config.c) */
bending_case bending_case_default(void);            /* required values NaN or INT_MIN */

/* A run. */
typedef struct {
  const bending_case *config; /* borrowed */
  const bw_comm *comm;        /* borrowed */
  bw_case *run;               /* borrowed */
  bending_flow flow;
  bw_history *history;
  int64_t step;         /* steps done */
  int64_t end, release; /* of the whole run; until the plate is let go */
  int64_t rows;         /* of history.csv, when the checkpoint was written */
} bending_run;

/* Before anything is built: counts the steps; what cannot run is refused, as the run would; sizes,
 * dimensionless groups, the step against its limits and memory to the log. From a small set-up of
 * the same kind: time and memory do not grow with the channel (bending_plan.c). Collective. */
bw_status bending_plan(bending_run *p) BW_MUST_CHECK;
/* The steps of the run from its times; refused where nobody can wait for them. Local. */
bw_status bending_count_steps(bending_run *p) BW_MUST_CHECK;
/* Creates history.csv, or goes on with it from the checkpoint that was read. Collective. */
bw_status bending_open_history(bending_run *p) BW_MUST_CHECK;
/* Measures the last step, to m, and writes a row of history.csv. Collective. */
bw_status bending_sample(bending_run *p, bending_measure *m) BW_MUST_CHECK;
/* Adds the present state to fluid.pvd and plate.pvd. Collective. */
bw_status bending_picture(bending_run *p) BW_MUST_CHECK;
/* checkpoint-last.h5 of the present state. Collective. */
bw_status bending_checkpoint(bending_run *p) BW_MUST_CHECK;
/* Goes on from a checkpoint, written by any number of ranks. Collective. */
bw_status bending_restart(bending_run *p, const char *path) BW_MUST_CHECK;
