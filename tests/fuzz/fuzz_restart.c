/* Fuzzer of the folder that a run goes on in: case file, record, list of files, history and
 * checkpoint of a good run, of which the first byte chooses one and the others change it
 * (fuzz_patched).
 * BUILD modules=checkpoint,shape */
#include "bw_case.h"
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "fuzz.h"
#include "fuzz_case.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const bw_case_about about = {"fuzz", "a case", fuzz_fields, sizeof(fuzz_case),
                                    bw_checkpoint_read_case};
static const char *const names[] = {"time[s]", "drag[N]"};

/* The files of a run. */
enum { FILES = 5 };
static const char *const files[FILES] = {"case.yaml", "run/run.yaml", "run/run.files",
                                         "run/history.csv", "run/checkpoint.h5"};

static bw_status begin(bool restart, bw_case **run)
{
  fuzz_case c = fuzz_case_default();
  /* The case keeps its arguments until it ends. */
  static char yaml[300], out[300], checkpoint[320];
  static char program[] = "fuzz", to[] = "--out", quiet[] = "--quiet", from[] = "--restart";
  static char *argv[] = {program, yaml, to, out, quiet, from, checkpoint, NULL};
  snprintf(yaml, sizeof yaml, "%s/case.yaml", fuzz_folder());
  snprintf(out, sizeof out, "%s/run", fuzz_folder());
  snprintf(checkpoint, sizeof checkpoint, "%s/checkpoint.h5", out);
  return bw_case_begin(fuzz_comm(), restart ? 7 : 5, argv, &about, &c, run);
}

static bw_status write_checkpoint(const bw_case *run)
{
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  const double x = 1.0;
  bw_status st = bw_case_path(run, "checkpoint.h5", &path);
  BW_THEN(st, bw_checkpoint_create(fuzz_comm(), path, &ck));
  BW_THEN(st, bw_checkpoint_put_case(ck, run));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "time", 1, &x));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_release(&path);
  return st;
}

/* A run of three rows, the checkpoint behind the second. */
static bw_status good_run(void)
{
  static const char yaml[] = "nu: 0.01\nn: [4, 4, 4]\nbodies: [{radius: 2}, {radius: 3}]\n";
  bw_case *run = NULL;
  bw_history *h = NULL;
  fuzz_file("case.yaml", (const uint8_t *)yaml, sizeof yaml - 1);
  BW_TRY(begin(false, &run));
  bw_status st = bw_case_history(run, 2, names, NAN, -1, &h);
  for (int q = 0; q < 3 && st == BW_OK; q++)
    bw_history_append(h, (const double[2]){0.5 * q, 1.0 + q});
  const bw_status closed = bw_history_close(fuzz_comm(), &h);
  BW_THEN(st, closed);
  BW_THEN(st, write_checkpoint(run));
  return bw_case_end(fuzz_comm(), &run, st);
}

/* Whatever the run before has left. */
static void empty(const char *name)
{
  char path[600];
  snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
  DIR *folder = opendir(path);
  for (const struct dirent *e; folder != NULL && (e = readdir(folder)) != NULL;) {
    snprintf(path, sizeof path, "%s/%s/%s", fuzz_folder(), name, e->d_name);
    if (e->d_name[0] != '.') unlink(path);
  }
  if (folder != NULL) closedir(folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static fuzz_base good[FILES];
  bw_case *run = NULL;
  bw_history *h = NULL;
  if (good[0].byte == NULL) {
    if (good_run() != BW_OK) abort();
    for (int q = 0; q < FILES; q++)
      fuzz_read(files[q], &good[q]);
  }
  empty("run");
  for (int q = 0; q < FILES; q++) {
    const bool this = size > 0 && data[0] % FILES == q;
    fuzz_patched(files[q], &good[q], this ? data + 1 : NULL, this ? size - 1 : 0);
  }
  bw_status st = begin(true, &run);
  if ((st == BW_OK) != (run != NULL) || (st != BW_OK && bw_last_message()[0] == 0)) abort();
  if (st == BW_OK) {
    st = bw_case_history(run, 2, names, 0.5, 2, &h);
    const bw_status closed = bw_history_close(fuzz_comm(), &h);
    BW_THEN(st, closed);
    if (bw_case_end(fuzz_comm(), &run, st) == BW_OK && st != BW_OK) abort();
  }
  return 0;
}
