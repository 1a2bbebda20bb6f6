/* run.yaml: the case as it was run, and how it ended. */
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_real.h"
#include "case_internal.h"
#include "core_internal.h"

#include <errno.h>
#include <string.h>
#include <time.h>

/* UTC, ISO 8601 */
void bw_core__case_now(char text[BW_CORE__TIME])
{
  const time_t seconds = time(NULL);
  struct tm parts;
  gmtime_r(&seconds, &parts);
  strftime(text, BW_CORE__TIME, "%Y-%m-%dT%H:%M:%SZ", &parts);
}

static void put_record(FILE *out, const bw_case *run, const char *resolved)
{
  char start[BW_CORE__TIME];
  bw_core__case_now(start);
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
    bw_core__case_record_changes(out, run);
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
  char end[BW_CORE__TIME];
  FILE *out = fopen(path, "a");
  BW_REQUIRE(out != NULL, BW_EIO, "cannot write %s: %s", path, strerror(errno));
  bw_core__case_now(end);
  /* The record ends in the block `run`, which put_record has left open. */
  fprintf(out, "  end: %s\n  seconds: %.3f\n  exit_code: %d\n  status: ", end,
          bw_wall_time() - run->wall_start, (int)status);
  bw_core__put_quoted(out, bw_status_text(status));
  if (status != BW_OK) {
    fputs("\n  message: ", out);
    bw_core__put_quoted(out, bw_last_message());
  }
  fputc('\n', out);
  /* What the run has warned of, too. */
  if (bw_log_warning(run->log, 0) != NULL) fputs("  warnings:\n", out);
  for (int q = 0; bw_log_warning(run->log, q) != NULL; q++) {
    fputs("    - ", out);
    bw_core__put_quoted(out, bw_log_warning(run->log, q));
    fputc('\n', out);
  }
  errno = 0;
  const bool ok = fflush(out) == 0 && !ferror(out);
  const int reason = errno;
  BW_REQUIRE(fclose(out) == 0 && ok, BW_EIO, "cannot write %s: %s", path,
             strerror(reason != 0 ? reason : errno));
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
