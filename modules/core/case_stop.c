/* The end of a run before its time, and the history that goes on after it. */
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_stop.h"
#include "case_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Why to stop, the same on all ranks: a signal's number; LATE; 0: go on. */
enum { LATE = 1 << 20 };
static int64_t reason_to_stop(const bw_case *run)
{
  /* The clock of rank 0 counts: others differ. */
  const bool late =
      bw_comm_rank(run->args.comm) == 0 && bw_wall_time() - run->wall_start >= run->args.stop_after;
  int64_t reason = late ? LATE : bw_stop_signal();
  bw_comm_max_int(run->args.comm, 1, &reason);
  return reason;
}

bool bw_case_stopping(const bw_case *run)
{
  return reason_to_stop(run) != 0;
}

bw_status bw_case_unfinished(const bw_case *run, const char *checkpoint)
{
  const int64_t reason = reason_to_stop(run);
  char why[96], *path = NULL;
  if (reason == LATE)
    snprintf(why, sizeof why, "the time of --stop-after is over");
  else
    snprintf(why, sizeof why, "asked to stop by signal %d (%s)", (int)reason,
             strsignal((int)reason));
  if (checkpoint == NULL)
    return BW_FAIL(BW_EUNFINISHED, "%s; this case writes no checkpoints, run it again", why);
  BW_TRY(bw_comm_agree(run->args.comm, bw_path_join(run->out, checkpoint, &path)));
  const bw_status st = BW_FAIL(BW_EUNFINISHED, "%s: go on with --restart %s", why, path);
  bw_release(&path);
  return st;
}

/* Does the checkpoint lie in the folder of the results? */
static bool goes_on_here(const bw_case *run)
{
  const char *slash = strrchr(run->args.restart, '/');
  struct stat from, to;
  char *folder = NULL;
  bool same = false;
  /* "a/b.h5" lies in a, "b.h5" in the present folder. */
  if (bw_path_join("", slash != NULL ? run->args.restart : ".", &folder) == BW_OK) {
    if (slash != NULL) folder[slash > run->args.restart ? slash - run->args.restart : 1] = '\0';
    same = stat(folder, &from) == 0 && stat(run->out, &to) == 0 && from.st_ino == to.st_ino &&
           from.st_dev == to.st_dev;
  }
  bw_release(&folder);
  return same;
}

bw_status bw_case_history(const bw_case *run, int n, const char *const names[], double restart_time,
                          int64_t restart_rows, bw_history **out)
{
  const bw_comm *comm = run->args.comm;
  const bool restart = run->args.restart != NULL;
  char *path = NULL;
  *out = NULL;
  /* Rank 0 looks at the disk, for all. */
  int64_t here = restart && bw_comm_rank(comm) == 0 && goes_on_here(run);
  bw_comm_max_int(comm, 1, &here);
  BW_TRY(bw_comm_agree(comm, bw_case_path(run, "history.csv", &path)));
  const bw_status st = bw_history_create(comm, path, n, names, restart ? restart_time : (double)NAN,
                                         here ? restart_rows : -1, out);
  bw_release(&path);
  return st;
}
