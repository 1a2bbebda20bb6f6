/* case_internal.h -- shared by the sources of bw_case only. */
#pragma once
#include "bw_case.h"

struct bw_case {
  const bw_case_about *about;
  bw_case_args args;
  const char **overrides; /* args.overrides; the texts are argv's */
  char *out;              /* args.out */
  bw_log *log;
  bool help, version, recorded; /* recorded: run.yaml was written */
  double wall_start;            /* [s] */
};

/* Fill run->args from the command line; BW_EUSAGE with a hint. Local. */
bw_status bw_core__case_parse(bw_case *run, int argc, char **argv) BW_MUST_CHECK;
/* Rank 0: what --help and --version say. */
void bw_core__case_help(const bw_case *run, const void *config);
void bw_core__case_version(void);

/* The output folder: refused when it holds another run; made. Collective. */
bw_status bw_core__case_folder(bw_case *run) BW_MUST_CHECK;
/* run.yaml: `resolved` is the configuration as YAML. Collective. */
bw_status bw_core__case_record(bw_case *run, const char *resolved) BW_MUST_CHECK;
/* End time and status added to it. Collective. */
bw_status bw_core__case_record_end(const bw_case *run, bw_status status) BW_MUST_CHECK;
