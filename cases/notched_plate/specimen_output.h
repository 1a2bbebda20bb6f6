/* specimen_output.h -- the files of results. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "specimen.h"

/* Print what the numbers mean: sizes, speeds, dt against its limit. Collective. */
bw_status specimen_describe(const specimen *p, bw_log *log) BW_MUST_CHECK;

/* Creates history.csv. Collective. */
bw_status specimen_open_history(const bw_case *run, bw_history **out) BW_MUST_CHECK;
/* A row of it. Collective. */
bw_status specimen_sample(specimen *p, bw_history *history) BW_MUST_CHECK;
/* Adds the present particles to damage.pvd. Collective. */
bw_status specimen_picture(specimen *p, const bw_case *run) BW_MUST_CHECK;
/* crack.csv: the places of all cracked particles, now, notches included. Collective. */
bw_status specimen_crack_file(specimen *p, const bw_case *run) BW_MUST_CHECK;
/* What was found of the crack, to the log. Collective. */
bw_status specimen_summary(specimen *p, bw_log *log) BW_MUST_CHECK;
