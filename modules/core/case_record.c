/* The output folder and run.yaml. */
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_real.h"
#include "case_internal.h"
#include "core_internal.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <time.h>

enum { TIME = 32 };

/* UTC, ISO 8601 */
static void now(char text[TIME])
{
  const time_t seconds = time(NULL);
  struct tm parts;
  gmtime_r(&seconds, &parts);
  strftime(text, TIME, "%Y-%m-%dT%H:%M:%SZ", &parts);
}

/* Something in the folder besides run.yaml and its older siblings. Rank 0. */
static bool holds_results(const char *folder)
{
  DIR *d = opendir(folder);
  bool found = false;
  if (d == NULL) return false;
  /* Records alone are no results: a run that stopped before its first output may begin again. */
  for (const struct dirent *e = readdir(d); e != NULL && !found; e = readdir(d))
    found = e->d_name[0] != '.' && strcmp(e->d_name, "run.yaml") != 0 &&
            strncmp(e->d_name, "run-", 4) != 0;
  closedir(d);
  return found;
}

/* A restart goes on in a folder of the same case only. */
static bw_status check_same_case(const bw_case *run, const char *path)
{
  char *text = NULL, line[128];
  BW_TRY(bw_file_read_text(run->args.comm, path, NULL, &text));
  snprintf(line, sizeof line, "\nrun:\n  case: %s\n", run->about->name);
  /* The key is looked for as put_record writes it, on lines of its own. */
  const bool same = strstr(text, line) != NULL;
  bw_release(&text);
  BW_REQUIRE(same, BW_EINPUT, "the folder %s holds results of another case than %s: give --out NEW",
             run->out, run->about->name);
  return BW_OK;
}

/* run.yaml becomes run-N.yaml, the first N that is free. Rank 0. */
static bw_status keep_old_record(const bw_case *run, const char *path)
{
  for (int n = 1; n < 10000; n++) {
    char name[32], *kept = NULL;
    snprintf(name, sizeof name, "run-%d.yaml", n);
    BW_TRY(bw_path_join(run->out, name, &kept));
    /* A name that is taken is never overwritten: every start of the run stays on record. */
    FILE *taken = fopen(kept, "r");
    const bool renamed = taken == NULL && rename(path, kept) == 0;
    const int reason = errno;
    if (taken != NULL) fclose(taken);
    bw_release(&kept);
    if (renamed) return BW_OK;
    BW_REQUIRE(taken != NULL, BW_EIO, "cannot rename %s: %s", path, strerror(reason));
  }
  return BW_FAIL(BW_EIO, "%s: too many records of restarts", run->out);
}

bw_status bw_core__case_folder(bw_case *run)
{
  const bw_comm *comm = run->args.comm;
  char *path = NULL;
  bw_status st = bw_comm_agree(comm, bw_path_join(run->out, "run.yaml", &path));
  /* A run.yaml says that a run has been here. */
  if (st == BW_OK && bw_path_exists(comm, path)) {
    int64_t results = bw_comm_rank(comm) == 0 && holds_results(run->out);
    bw_comm_max_int(comm, 1, &results);
    /* Results of another run are never mixed with new ones. */
    if (results && run->args.restart == NULL)
      st = BW_FAIL(BW_EINPUT,
                   "the folder %s holds results of another run: give --out NEW, or --restart FILE "
                   "to go on with that one",
                   run->out);
    else if (results)
      st = check_same_case(run, path);
    /* What is left is a restart, or a folder in which nothing was written. */
    if (st == BW_OK && bw_comm_rank(comm) == 0) st = keep_old_record(run, path);
    st = bw_comm_agree(comm, st);
  }
  BW_THEN(st, bw_folder_make(comm, run->out));
  bw_release(&path);
  return st;
}

static void put_record(FILE *out, const bw_case *run, const char *resolved)
{
  char start[TIME];
  now(start);
  /* The resolved values, then how they came about, under a key that a case file ignores. */
  fprintf(out, "# The case as it was run; this file is a case file itself.\n%s", resolved);
  fprintf(out, "run:\n  case: %s\n  version: \"%s\"\n  commit: \"%s\"\n", run->about->name,
          bw_version(), bw_commit());
  fprintf(out, "  precision: %s\n  ranks: %d\n  file: ", BW_REAL_NAME,
          bw_comm_size(run->args.comm));
  bw_core__put_quoted(out, run->args.yaml);
  fputs("\n  set: [", out);
  for (int q = 0; q < run->args.n_overrides; q++) {
    fputs(q > 0 ? ", " : "", out);
    bw_core__put_quoted(out, run->args.overrides[q]);
  }
  fputs("]\n", out);
  if (run->args.restart != NULL) {
    fputs("  restart: ", out);
    bw_core__put_quoted(out, run->args.restart);
    fputc('\n', out);
  }
  fprintf(out, "  start: %s\n", start);
}

bw_status bw_core__case_record(bw_case *run, const char *resolved)
{
  char *path = NULL, *text = NULL;
  size_t length = 0;
  bw_status st = bw_path_join(run->out, "run.yaml", &path);
  FILE *out = st == BW_OK ? open_memstream(&text, &length) : NULL;
  if (out != NULL) put_record(out, run, resolved);
  if (st == BW_OK && (out == NULL || fclose(out) != 0))
    st = BW_FAIL(BW_EMEM, "no memory to write %s", path);
  /* The text is complete in memory before the disk is touched. */
  st = bw_comm_agree(run->args.comm, st);
  BW_THEN(st, bw_file_write_text(run->args.comm, path, text));
  run->recorded = st == BW_OK;
  bw_release(&text);
  bw_release(&path);
  return st;
}

static bw_status append_end(const bw_case *run, const char *path, bw_status status)
{
  char end[TIME];
  FILE *out = fopen(path, "a");
  BW_REQUIRE(out != NULL, BW_EIO, "cannot write %s: %s", path, strerror(errno));
  now(end);
  /* The record ends in the block `run`, which put_record has left open. */
  fprintf(out, "  end: %s\n  seconds: %.3f\n  exit_code: %d\n  status: ", end,
          bw_wall_time() - run->wall_start, (int)status);
  bw_core__put_quoted(out, bw_status_text(status));
  if (status != BW_OK) {
    fputs("\n  message: ", out);
    bw_core__put_quoted(out, bw_last_message());
  }
  fputc('\n', out);
  const bool ok = !ferror(out);
  BW_REQUIRE(fclose(out) == 0 && ok, BW_EIO, "cannot write %s: %s", path, strerror(errno));
  return BW_OK;
}

bw_status bw_core__case_record_end(const bw_case *run, bw_status status)
{
  bw_status st = BW_OK;
  /* Only where a record was begun; the end of a run that never began has no place. */
  if (run->recorded && bw_comm_rank(run->args.comm) == 0) {
    char *path = NULL;
    st = bw_path_join(run->out, "run.yaml", &path);
    BW_THEN(st, append_end(run, path, status));
    bw_release(&path);
  }
  return st;
}
