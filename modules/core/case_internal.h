/* case_internal.h -- shared by the sources of bw_case only. */
#pragma once
#include "bw_case.h"

enum { BW_CORE__TIME = 32 };

/* What runs have written into the folder: a line per name. Rank 0. */
typedef struct {
  char *list;
  size_t length;
} bw_core__case_files;

struct bw_case {
  const bw_case_about *about;
  bw_case_args args;
  const char **overrides; /* args.overrides; the texts are argv's */
  char *out;              /* args.out */
  char *parameters;       /* rank 0: the resolved case as lines (bw_core__config_lines) */
  char *changed;          /* rank 0: a line for each value that a restart has changed, or NULL */
  bw_log *log;
  bool help, version, recorded; /* recorded: run.yaml was written */
  bool locked;                  /* rank 0: run.lock is held ... */
  int lock;                     /* ... through this file */
  bw_core__case_files *files;   /* rank 0, of a folder that was taken */
  double wall_start;            /* [s] */
};

/* Fill run->args from the command line; BW_EUSAGE with a hint. Local. */
bw_status bw_core__case_parse(bw_case *run, int argc, char **argv) BW_MUST_CHECK;
/* Rank 0: what --help and --version say. */
void bw_core__case_help(const bw_case *run, const void *config);
void bw_core__case_version(void);

/* run->parameters; with --restart refused where the checkpoint is another program's or another
 * case's, else run->changed. Collective. */
bw_status bw_core__case_identity(bw_case *run, const void *config) BW_MUST_CHECK;
/* What a restart has changed: to the log, into run.yaml's block `run`. Local. */
void bw_core__case_tell_changes(const bw_case *run);
void bw_core__case_record_changes(FILE *out, const bw_case *run);

/* The output folder: refused when another run writes into it, or when it holds what may not be
 * replaced; made, locked. Collective. */
bw_status bw_core__case_folder(bw_case *run) BW_MUST_CHECK;
/* The lock is given up. Local. */
void bw_core__case_leave(bw_case *run);
/* `name` is a file of the run from now on: --overwrite may remove it. Local, of rank 0. */
void bw_core__case_note(const bw_case *run, const char *name);
/* The time of day, UTC, ISO 8601. Local. */
void bw_core__case_now(char text[BW_CORE__TIME]);
/* run.yaml: `resolved` is the configuration as YAML. Collective. */
bw_status bw_core__case_record(bw_case *run, const char *resolved) BW_MUST_CHECK;
/* End time and status added to it. Collective. */
bw_status bw_core__case_record_end(const bw_case *run, bw_status status) BW_MUST_CHECK;
