/* specimen_failure.h -- where and when would it break: gauges of failure of a specimen. */
#pragma once
#include "bw_case.h"
#include "bw_solid_failure.h"
#include "specimen.h"

/* Which gauges the case file asks for: their numbers to `asked`, how many are returned. Local. */
int specimen_gauges(const specimen *p, int asked[BW_SOLID_FAILURE_GAUGES]);
/* All of them, now: used (n, BW_SOLID_FAILURE_GAUGES) of bw_solid_failure.h. BW_EINPUT for
 * strengths that lack something. Collective. */
bw_status specimen_used(specimen *p, double used[]) BW_MUST_CHECK;
/* weakest-STEP.csv: the first twenty places to fail by each gauge. Collective. */
bw_status specimen_weakest(specimen *p, const bw_case *run, const double used[]) BW_MUST_CHECK;
