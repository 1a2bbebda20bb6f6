/* plate_output.h -- the case file and the files of results. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "plate.h"

typedef struct {
  int sample_every, picture_every; /* steps */
} plate_files;

typedef struct {
  plate_shape shape;
  plate_solid solid;
  plate_load load;
  plate_time time;
  plate_files output;
} crack_case;

plate_config crack_case_plate(const crack_case *c);

extern const bw_config_field crack_case_fields[];
crack_case crack_case_default(void);

/* Print what the numbers mean: sizes, speeds, dt against its limit. Collective. */
void plate_describe(const plate *p, bw_log *log);

bw_status plate_open_history(const plate *p, const bw_case *run, bw_history **out) BW_MUST_CHECK;
void plate_sample(plate *p, bw_history *history);                    /* one row. Collective. */
bw_status plate_picture(plate *p, const bw_case *run) BW_MUST_CHECK; /* damage.pvd. Collective. */
bw_status plate_summary(plate *p, bw_log *log) BW_MUST_CHECK;        /* Collective. */
