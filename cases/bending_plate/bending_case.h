/* bending_case.h -- the bending plate as a case: what its YAML says, its files. */
#pragma once
#include "bending_flow.h"
#include "bw_case.h"
#include "bw_history.h"

typedef struct {
  double step, release, end; /* [s] */
} bending_time;
typedef struct {
  int sample_every, picture_every, checkpoint_every;
} bending_output;
typedef struct {
  bending_config physics;
  bending_time time;
  bending_output output;
} bending_case;

extern const bw_config_field bending_case_fields[];
bending_case bending_case_default(void);

typedef struct {
  const bending_case *config;
  bw_case *run;
  bending_flow flow;
  bw_history *history;
  int64_t step;
} bending_run;

/* Sizes, dimensionless groups, the step against its limits. Collective. */
void bending_describe(bending_run *p);
bw_status bending_open_history(bending_run *p, double restart_time) BW_MUST_CHECK;
bw_status bending_sample(bending_run *p, bending_measure *m) BW_MUST_CHECK;
bw_status bending_picture(bending_run *p) BW_MUST_CHECK;
bw_status bending_checkpoint(bending_run *p) BW_MUST_CHECK;
bw_status bending_restart(bending_run *p, const char *path) BW_MUST_CHECK;
