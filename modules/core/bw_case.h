/* bw_case.h -- the command line, output folder and record (run.yaml) that every case shares.
 *
 *   static bw_status simulate(const bw_comm *comm, void *config, bw_case *run);
 *
 *   int main(int argc, char **argv)
 *   {
 *     my_case c = my_case_default();
 *     const bw_case_about about = {"porous_breakup", "what it computes", fields, sizeof c,
 *                                  bw_checkpoint_read_case};
 *     return bw_case_main(argc, argv, &about, &c, simulate);
 *   }
 *
 * Command line: CASE.yaml [--set key.path=value]... [--out DIR] [--restart FILE]
 * [--overwrite] [--stop-after TIME] [--check] [--quiet] [--help] [--version].
 *
 * The folder of the results belongs to one run. While it runs, it holds a lock of the system on
 * run.lock, which ends with the process and is not copied with the folder: a second run is refused
 * and told who holds it. Nothing is replaced without --restart, which goes on with a run of the
 * same case, or --overwrite, which removes what runs of the same case have written (run.files) and
 * begins anew. A folder with files of the user's and no run.yaml is never written into.
 *
 * A restart is the same run. A checkpoint holds the program's name and the whole resolved case
 * (bw_checkpoint_put_case), the files that it names by the checksum of their content. With
 * --restart every value that differs is refused with key, both values and the checkpoint, or, where
 * its row has BW_MAY_CHANGE, listed on the screen and in run.yaml. */
#pragma once
#include "bw_config.h"
#include "bw_history.h"
#include "bw_log.h"
#include <stdio.h>

BW_BEGIN_DECLS

/* Version of the sources this program was built from, "1.2.3"; static storage. Local. */
const char *bw_version(void);

/* Commit of those sources; "unknown" where the build could not tell; static storage. Local. */
const char *bw_commit(void);

/* Reads from a checkpoint whose it is: the program and its parameters (bw_case_program,
 * bw_case_parameters of the run that wrote it), allocated, the caller's (bw_release), NULL after a
 * failure. bw_checkpoint_read_case is one. Collective. */
typedef bw_status bw_case_reader(const bw_comm *comm, const char *path, char **program,
                                 char **parameters);

/* What a case is. Borrowed by bw_case_begin until bw_case_end. */
typedef struct {
  const char *name;    /* of the program; the default folder is out/NAME, see bw_case_args.out */
  const char *summary; /* one line for --help */
  const bw_config_field *fields;   /* table of the keys of its case file, see bw_config.h */
  size_t config_size;              /* bytes of the struct that the table fills */
  bw_case_reader *read_checkpoint; /* bw_checkpoint_read_case; NULL: the case writes no checkpoints,
                                      and --restart is refused */
} bw_case_about;

/* The command line as it was understood. Texts and arrays live until bw_case_end. */
typedef struct {
  const bw_comm *comm; /* all ranks of the program */
  const char *yaml;    /* path of the case file */
  const char *out;     /* folder of the results, --out or else out/NAME (out/NAME-STEM for a case
                          file STEM.yaml called otherwise); exists unless check or stop */
  const char *restart; /* checkpoint to go on from, or NULL */
  const char *const *overrides; /* (n_overrides) the texts behind --set, in their order */
  int n_overrides;              /* number of --set */
  bool overwrite;               /* --overwrite: results of the same case may be replaced */
  bool check;                   /* --check: print the sizes, run and write nothing */
  double stop_after; /* --stop-after: wall-clock seconds since the start; INFINITY: none */
  bool quiet;        /* --quiet: only warnings and errors */
  bool stop; /* --help or --version was answered: nothing to do (the configuration is not read) */
} bw_case_args;

/* A case that runs: its command line, folder, record and log. */
typedef struct bw_case bw_case;

/* Read the command line; load and check the configuration; hold a restart against its checkpoint;
 * make the folder; write run.yaml; print the heading. With --check: prints the resolved
 * configuration instead, touches no folder. BW_EUSAGE for a command line not understood (with a
 * hint), BW_EINPUT for the configuration and for a checkpoint of another program or case,
 * BW_EINPUT when another run writes into the folder or what it holds may not be replaced (the
 * remedy is named), BW_EIO when it cannot be written. `about` is borrowed until end; `config` is
 * not kept. Collective. */
bw_status bw_case_begin(const bw_comm *comm, int argc, char **argv, const bw_case_about *about,
                        void *config, bw_case **out) BW_MUST_CHECK;

/* The command line; borrowed, valid until bw_case_end. Local. */
const bw_case_args *bw_case_args_of(const bw_case *run);

/* The log of the case; borrowed, valid until bw_case_end. `run` NULL, of a program that builds a
 * case's set-up without being one: NULL, which every log function takes and says nothing. Local. */
bw_log *bw_case_log(const bw_case *run);

/* *path = a file that the run writes into its folder, allocated, owned by the caller (bw_release).
 * The name is noted: --overwrite of a later run may remove the file. Collective. */
bw_status bw_case_path(const bw_case *run, const char *name, char **path) BW_MUST_CHECK;

/* A table or another text that the run writes into its folder: made in memory, then on the disk as
 * a whole or not at all. */
typedef struct {
  FILE *out;     /* where rank 0 writes to; NULL on the others */
  char *text;    /* what was written so far, on rank 0 */
  size_t length; /* of it [bytes] */
} bw_case_text;

/* Begin one: t->out. BW_EMEM; end it also then. Collective. */
bw_status bw_case_text_begin(const bw_case *run, bw_case_text *t) BW_MUST_CHECK;

/* Where `st` is fine on all ranks it becomes the file `name`, as by bw_case_path; `t` is released.
 * Returns what went wrong first: `st`, BW_EMEM, BW_EIO. Collective. */
bw_status bw_case_text_end(const bw_case *run, bw_case_text *t, const char *name,
                           bw_status st) BW_MUST_CHECK;

/* history.csv in the folder of the run (bw_history.h). After --restart, restart_time and
 * restart_rows are the time of the checkpoint and the rows that had been written until then; rows
 * are held against the file where the checkpoint lies in the folder of the results, for elsewhere
 * the file is another one. Without --restart both are not looked at. Collective. */
bw_status bw_case_history(const bw_case *run, int n, const char *const names[], double restart_time,
                          int64_t restart_rows, bw_history **out) BW_MUST_CHECK;

/* The program's name, and the resolved case as a checkpoint keeps it: a line of text for each
 * value. Borrowed, valid until bw_case_end; the second is rank 0's alone, "" elsewhere. Local. */
const char *bw_case_program(const bw_case *run);
const char *bw_case_parameters(const bw_case *run);

/* After a checkpoint was read that is at `done`, in the unit of `end`, the value of `key`:
 * BW_EINPUT where it lies beyond the end that is asked for; at the end it is said that the run is
 * complete. Without --restart nothing. All ranks know the same. Local. */
bw_status bw_case_check_end(const bw_case *run, const char *key, double end,
                            double done) BW_MUST_CHECK;

/* Is the run to end early, in good order: by a signal (bw_stop.h) or because the time of
 * --stop-after is over? The same answer on all ranks. Once per step is cheap. Collective. */
bool bw_case_stopping(const bw_case *run);

/* What a run that ends early returns: BW_EUNFINISHED, with why it ended and how it goes on.
 * `checkpoint`: name in the folder; NULL: the case writes none. Collective. */
bw_status bw_case_unfinished(const bw_case *run, const char *checkpoint) BW_MUST_CHECK;

/* Ranks agree on `mine`; end time and status are added to run.yaml; *run is freed (NULL inside is
 * fine). Returns the agreed status; bw_finish prints its message. Collective. */
bw_status bw_case_end(const bw_comm *comm, bw_case **run, bw_status mine) BW_MUST_CHECK;

/* main of a case: start MPI, begin, simulate unless --help or --version were all that was asked,
 * end. `simulate` gets the configuration read; it releases what it made whatever comes. Returns the
 * exit code. Collective. */
int bw_case_main(int argc, char **argv, const bw_case_about *about, void *config,
                 bw_status (*simulate)(const bw_comm *comm, void *config, bw_case *run));

BW_END_DECLS
