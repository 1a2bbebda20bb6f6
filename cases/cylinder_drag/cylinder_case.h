/* cylinder_case.h -- what cylinder_drag.yaml may say, and what the case writes. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "cylinder_flow.h"

/* When the run ends. */
typedef struct {
  double steady;   /* end when the drag changes by less than this part per d/U_b */
  double latest;   /* end at this time [d/U_b] at the latest */
  double interval; /* between samples [d/U_b] */
} cylinder_until;

/* What the YAML file says. */
typedef struct {
  cylinder_config cylinder;
  cylinder_until until;
} cylinder_case;

extern const bw_config_field cylinder_case_fields[]; /* its keys */
cylinder_case cylinder_case_default(void);           /* reynolds is NaN: required */

/* Before anything is built: what cannot run is refused, as the run would, also where nobody can
 * wait for the steps; sizes, groups, memory and an estimate of the time as lines of the log. From a
 * shorter and coarser channel: time and memory do not grow with that of the case. Collective. */
bw_status cylinder_plan(const bw_comm *comm, const cylinder_case *c, bw_log *log) BW_MUST_CHECK;

/* Creates history.csv. Collective. */
bw_status cylinder_open_history(const bw_case *run, bw_history **out) BW_MUST_CHECK;
/* A row of it: time [d/U_b] and what was measured. Local. */
void cylinder_sample(bw_history *history, double t, const cylinder_drag *d);

/* wall.csv (stress around the cylinder), fluid.vti and body.vtp. Collective. */
bw_status cylinder_write(cylinder_flow *f, const bw_case *run) BW_MUST_CHECK;
