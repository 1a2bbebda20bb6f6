#include "bw_case.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_real.h"
#include "case_internal.h"

#include <math.h>
#include <stdio.h>

/* Given by the build to this file alone, so that a commit compiles one file anew. */
#ifndef BW_VERSION
#define BW_VERSION "unknown"
#endif
#ifndef BW_COMMIT
#define BW_COMMIT "unknown"
#endif

const char *bw_version(void)
{
  return BW_VERSION;
}

const char *bw_commit(void)
{
  return BW_COMMIT;
}

static void release(bw_case **run)
{
  if (*run == NULL) return;
  bw_core__case_leave(*run);
  if ((*run)->files != NULL) bw_release(&(*run)->files->list);
  bw_release(&(*run)->files);
  bw_release(&(*run)->overrides);
  bw_release(&(*run)->out);
  bw_release(&(*run)->parameters);
  bw_release(&(*run)->changed);
  bw_log_destroy(&(*run)->log);
  bw_release(run);
}

static bw_status load(bw_case *run, void *config)
{
  const bw_case_args *a = &run->args;
  BW_TRY(bw_config_load(a->comm, a->yaml, run->about->fields, a->n_overrides, a->overrides,
                        run->about->config_size, config));
  /* Before the folder is touched: a run with a slip in its command line leaves no trace. */
  BW_REQUIRE(a->restart == NULL || bw_path_exists(a->comm, a->restart), BW_EIO,
             "--restart %s: there is no such file", a->restart);
  return bw_core__case_identity(run, config);
}

/* The resolved configuration: printed with --check, recorded otherwise. */
static bw_status announce(bw_case *run, const void *config)
{
  const bw_case_args *a = &run->args;
  char *resolved = NULL;
  bw_status st = bw_comm_agree(a->comm, bw_config_dump(run->about->fields, config, &resolved));
  /* A check touches no folder. */
  if (!a->check) {
    BW_THEN(st, bw_core__case_folder(run));
    BW_THEN(st, bw_core__case_record(run, resolved));
  }
  if (st == BW_OK)
    bw_log_info(run->log, "%s: %s on %d rank%s, %s precision%s%s", run->about->name, a->yaml,
                bw_comm_size(a->comm), bw_comm_size(a->comm) == 1 ? "" : "s", BW_REAL_NAME,
                a->check ? "" : ", results in ", a->check ? ", checked only:" : a->out);
  if (st == BW_OK && a->check) bw_log_info(run->log, "%s", resolved);
  if (st == BW_OK) bw_core__case_tell_changes(run);
  bw_release(&resolved);
  return st;
}

static bw_status begin(bw_case *run, int argc, char **argv, void *config)
{
  const bool speaker = bw_comm_rank(run->args.comm) == 0;
  BW_TRY(bw_comm_agree(run->args.comm, bw_core__case_parse(run, argc, argv)));
  /* All ranks have read the same command line; only rank 0 answers. */
  if (run->version && speaker) bw_core__case_version();
  if (run->help && speaker) bw_core__case_help(run, config);
  bw_log_config settings = bw_log_config_default();
  settings.quiet = run->args.quiet;
  BW_TRY(bw_comm_agree(run->args.comm, bw_log_create(run->args.comm, &settings, &run->log)));
  /* Help or version was all that was asked: no case file is needed. */
  if (run->args.stop) return BW_OK;
  BW_TRY(load(run, config));
  return announce(run, config);
}

bw_status bw_case_begin(const bw_comm *comm, int argc, char **argv, const bw_case_about *about,
                        void *config, bw_case **out)
{
  bw_case *run = NULL;
  *out = NULL;
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&run, 1)));
  run->about = about;
  run->args.comm = comm;
  run->args.stop_after = HUGE_VAL;
  /* The clock starts before the case file is read: set-up counts. */
  run->wall_start = bw_wall_time();
  const bw_status st = begin(run, argc, argv, config);
  /* Nothing is recorded of a run that did not begin. */
  if (st != BW_OK) release(&run);
  *out = run;
  return st;
}

const bw_case_args *bw_case_args_of(const bw_case *run)
{
  return &run->args;
}

bw_log *bw_case_log(const bw_case *run)
{
  return run == NULL ? NULL : run->log;
}

bw_status bw_case_path(const bw_case *run, const char *name, char **path)
{
  bw_core__case_note(run, name);
  const bw_status st = bw_comm_agree(run->args.comm, bw_path_join(run->out, name, path));
  if (st != BW_OK) bw_release(path);
  return st;
}

bw_status bw_case_end(const bw_comm *comm, bw_case **run, bw_status mine)
{
  bw_status st = comm != NULL ? bw_comm_agree(comm, mine) : mine;
  if (*run == NULL) return st;
  /* The record says how the run ended, also when it failed. */
  const bw_status recorded = bw_comm_agree(comm, bw_core__case_record_end(*run, st));
  if (st == BW_OK) st = recorded;
  release(run);
  return st;
}

int bw_case_main(int argc, char **argv, const bw_case_about *about, void *config,
                 bw_status (*simulate)(const bw_comm *, void *, bw_case *))
{
  bw_comm *world = NULL;
  bw_case *run = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, bw_case_begin(world, argc, argv, about, config, &run));
  /* Whatever simulate returns, the record is finished and all ranks leave together. */
  if (st == BW_OK && !run->args.stop) st = simulate(world, config, run);
  st = bw_case_end(world, &run, st);
  return bw_finish(&world, st);
}
