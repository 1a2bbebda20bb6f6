/* The folder of the results: whose it is, what may be replaced, who holds it.
 * TEST ranks=1,2 */
#include "bw_memory.h"
#include "case_test.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

START_TEST(results_are_not_overwritten)
{
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], *checkpoint = NULL, *kept = NULL;
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  in_base("kept", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  /* a run without results may be repeated */
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  bw_check_ok(bw_case_path(run, "checkpoint-1.h5", &checkpoint));
  bw_check_ok(bw_case_path(run, "run-1.yaml", &kept));
  bw_check_ok(bw_file_write_text(comm, checkpoint, TUBE));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  ck_assert(bw_path_exists(comm, kept));

  expect_refusal(&about, WORDS(yaml, "--out", folder), BW_EINPUT, "give --out NEW, or --restart");
  expect_refusal(&other_case, WORDS(yaml, "--out", folder, "--overwrite"), BW_EINPUT,
                 "holds results of another case than plate");
  expect_refusal(&about, WORDS(yaml, "--out", folder, "--overwrite", "--restart", checkpoint),
                 BW_EUSAGE, "give one of them");
  static const char *const times[] = {"",     "soon", "-1", "inf", "1e3", "2x",
                                      "0x1h", "2h30", ".",  "h",   "nan", "1 h"};
  for (size_t q = 0; q < sizeof times / sizeof *times; q++)
    expect_refusal(&about, WORDS(yaml, "--stop-after", times[q]), BW_EUSAGE,
                   "write a time such as");
  expect_refusal(&other_case, WORDS(yaml, "--out", folder, "--restart", checkpoint), BW_EINPUT,
                 "written by tube, this is plate");
  bw_check_ok(
      begin(&about, WORDS(yaml, "--out", folder, "--restart", checkpoint, "--quiet"), &c, &run));
  ck_assert_str_eq(bw_case_args_of(run)->restart, checkpoint);
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  bw_release(&checkpoint);
  bw_release(&kept);

  char longest[300];
  memset(longest, 'a', sizeof longest);
  longest[187] = '\0';
  expect_refusal(&about, WORDS(yaml, "--out", longest), BW_EINPUT, "has 187 bytes, 186 at most");
  ck_assert(!bw_path_exists(comm, longest));

  in_base("in_the_way", folder);
  bw_check_ok(bw_file_write_text(comm, folder, "a file"));
  expect_refusal(&about, WORDS(yaml, "--out", folder), BW_EIO, "in the way");
}
END_TEST

/* --overwrite removes what the case has written and leaves what is the user's. */
START_TEST(overwriting_removes_own_files_alone)
{
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], own[220], *picture = NULL, *checkpoint = NULL;
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  in_base("replaced", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  bw_check_ok(bw_case_path(run, "a.vtp", &picture));
  bw_check_ok(bw_file_write_text(comm, picture, "points"));
  bw_check_ok(bw_case_path(run, "checkpoint.h5", &checkpoint)); /* noted, never written */
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  snprintf(own, sizeof own, "%s/notes.txt", folder);
  bw_check_ok(bw_file_write_text(comm, own, "mine"));
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--overwrite", "--quiet"), &c, &run));
  ck_assert(!bw_path_exists(comm, picture));
  ck_assert(bw_path_exists(comm, own));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  bw_release(&picture);
  bw_release(&checkpoint);

  /* Without a record nothing of the folder is a result of ours. */
  in_base("users", folder);
  bw_check_ok(bw_folder_make(comm, folder));
  snprintf(own, sizeof own, "%s/history.csv", folder);
  bw_check_ok(bw_file_write_text(comm, own, "my own table"));
  expect_refusal(&about, WORDS(yaml, "--out", folder), BW_EINPUT, "holds history.csv");
  expect_refusal(&about, WORDS(yaml, "--out", folder, "--overwrite"), BW_EINPUT, "no run.yaml");
  bw_check_ok(bw_file_write_text(comm, own, TUBE));
  expect_refusal(&about, WORDS(yaml, "--out", folder, "--restart", own), BW_EINPUT,
                 "holds history.csv");
}
END_TEST

/* A lock of the folder held by another process; ends with the process on `gate`. */
static pid_t hold_in_another_process(const char *path, int gate[2])
{
  int ready[2];
  char byte = 0;
  ck_assert(pipe(gate) == 0 && pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    struct flock want = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const int fd = open(path, O_RDWR | O_CREAT, 0666);
    const bool held = fcntl(fd, F_SETLK, &want) == 0 && write(fd, "process 7 on moon\n", 18) == 18;
    close(gate[1]);
    if (!held || write(ready[1], "x", 1) != 1) _exit(1);
    (void)!read(gate[0], &byte, 1); /* until the parent lets go */
    _exit(0);
  }
  ck_assert_int_gt(child, 0);
  ck_assert_int_eq(read(ready[0], &byte, 1), 1);
  close(ready[0]), close(ready[1]), close(gate[0]);
  return child;
}

/* Refused while another process holds the folder, whoever holds it is named; when it is dead, the
 * file it left does not stand in the way. */
START_TEST(one_run_at_a_time)
{
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], lock[220];
  const bool speaks = bw_comm_rank(comm) == 0;
  config c;
  bw_case *run = NULL;
  int gate[2] = {-1, -1};
  pid_t child = 0;
  case_file(yaml);
  in_base("locked", folder);
  snprintf(lock, sizeof lock, "%s/run.lock", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  ck_assert(bw_path_exists(comm, lock));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  ck_assert(!bw_path_exists(comm, lock));
  if (speaks) child = hold_in_another_process(lock, gate);
  bw_comm_barrier(comm);
  expect_refusal(&about, WORDS(yaml, "--out", folder), BW_EINPUT, "is in use: process 7 on moon");
  if (speaks) {
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    close(gate[1]);
  }
  bw_comm_barrier(comm);
  ck_assert(bw_path_exists(comm, lock));
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(results_are_not_overwritten),
                                      BW_TEST(overwriting_removes_own_files_alone),
                                      BW_TEST(one_run_at_a_time)};
BW_CHECK_MAIN("core.case_folder", tests)
