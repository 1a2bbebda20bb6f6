/* The command line, the rules of the output folder, run.yaml.
 * TEST ranks=1,2 */
#include "bw_case.h"
#include "bw_check.h"
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct {
  double nu;
  int steps;
} config;
static const bw_config_field fields[] = {
    BW_CONFIG_VALUE(config, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
    BW_CONFIG_VALUE(config, steps, BW_OPTIONAL, BW_AT_LEAST(0), "", "time steps"), BW_CONFIG_END};
static const bw_case_about about = {"tube", "flow in a tube", fields, sizeof(config)};
static const bw_case_about other_case = {"plate", "another", fields, sizeof(config)};

/* A folder that is new for every test program run, the same on all ranks. */
static char base[96];
static const char *in_base(const char *name, char path[200])
{
  if (base[0] == '\0') {
    int64_t number = bw_comm_rank(bw_check_world()) == 0 ? (int64_t)getpid() : 0;
    bw_comm_max_int(bw_check_world(), 1, &number);
    snprintf(base, sizeof base, "test_core_case/%lld", (long long)number);
    bw_check_ok(bw_folder_make(bw_check_world(), base));
  }
  snprintf(path, 200, "%s/%s", base, name);
  return path;
}

/* begin with the words given (the program's name comes first) */
static bw_status begin(const bw_case_about *of, const char *const words[], config *c, bw_case **run)
{
  char *argv[16] = {(char *)"program"};
  char copy[16][256];
  int argc = 1;
  for (; words[argc - 1] != NULL; argc++) {
    snprintf(copy[argc], sizeof copy[argc], "%s", words[argc - 1]);
    argv[argc] = copy[argc];
  }
  *c = (config){.nu = NAN, .steps = 7};
  return bw_case_begin(bw_check_world(), argc, argv, of, c, run);
}
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

static void expect_refusal(const bw_case_about *of, const char *const words[], bw_status code,
                           const char *piece)
{
  config c;
  bw_case *run = NULL;
  bw_check_status(begin(of, words, &c, &run), code);
  ck_assert_ptr_null(run);
  ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                bw_last_message());
}

static const char *case_file(char path[200])
{
  in_base("tube.yaml", path);
  bw_check_ok(bw_file_write_text(bw_check_world(), path, "nu: 0.5\n"));
  return path;
}

START_TEST(command_line_errors_have_hints)
{
  char yaml[200];
  case_file(yaml);
  expect_refusal(&about, WORDS("--quiet"), BW_EUSAGE, "no case file is given: tube CASE.yaml");
  expect_refusal(&about, WORDS("a.yaml", "b.yaml"), BW_EUSAGE, "two case files");
  expect_refusal(&about, WORDS(yaml, "--ouput", "x"), BW_EUSAGE,
                 "--ouput: unknown option; did you mean --out?");
  expect_refusal(&about, WORDS(yaml, "--zzzzzzzzzz"), BW_EUSAGE, "--help lists them");
  expect_refusal(&about, WORDS(yaml, "-q"), BW_EUSAGE, "-q: unknown option");
  expect_refusal(&about, WORDS(yaml, "--out"), BW_EUSAGE, "--out needs a value: --out DIR");
  expect_refusal(&about, WORDS(yaml, "--out", ""), BW_EUSAGE, "empty");
  expect_refusal(&about, WORDS(yaml, "--check=1"), BW_EUSAGE, "--check takes no value");
  expect_refusal(&about, WORDS("no_such.yaml"), BW_EIO, "no_such.yaml");
  expect_refusal(&about, WORDS(yaml, "--set", "nu=-1", "--check"), BW_EINPUT,
                 "nu = -1: must be > 0");
  expect_refusal(&about, WORDS(yaml, "--restart", "no.h5"), BW_EIO,
                 "--restart no.h5: there is no such file");
}
END_TEST

START_TEST(check_help_and_version_touch_nothing)
{
  char yaml[200], folder[200];
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  in_base("untouched", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--check", "--out", folder, "--quiet"), &c, &run));
  ck_assert(bw_case_args_of(run)->check && bw_case_args_of(run)->quiet);
  ck_assert(!bw_case_args_of(run)->stop);
  ck_assert_double_eq(c.nu, 0.5);
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK));
  ck_assert(!bw_path_exists(bw_check_world(), folder));

  bw_check_ok(begin(&about, WORDS("--help"), &c, &run));
  ck_assert(bw_case_args_of(run)->stop);
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK));
  bw_check_ok(begin(&about, WORDS("--version", yaml), &c, &run));
  ck_assert(bw_case_args_of(run)->stop);
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK));
  ck_assert_ptr_null(run);
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK)); /* after a failed begin */
}
END_TEST

START_TEST(default_folders)
{
  char yaml[200], other[200];
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  bw_check_ok(begin(&about, WORDS(yaml, "--check", "--quiet"), &c, &run));
  ck_assert_str_eq(bw_case_args_of(run)->out, "out/tube");
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK));
  in_base("s1.yaml", other);
  bw_check_ok(bw_file_write_text(bw_check_world(), other, "nu: 1\n"));
  bw_check_ok(begin(&about, WORDS(other, "--check", "--quiet"), &c, &run));
  ck_assert_str_eq(bw_case_args_of(run)->out, "out/tube-s1");
  bw_check_ok(bw_case_end(bw_check_world(), &run, BW_OK));
}
END_TEST

/* run.yaml holds what was run, is a case file, and tells how it ended. */
START_TEST(the_record)
{
  char yaml[200], folder[200], *record = NULL, *text = NULL, *path = NULL;
  config c, again = {.nu = NAN, .steps = 1};
  bw_case *run = NULL;
  case_file(yaml);
  in_base("record", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--set=nu=0.1", "--quiet"), &c, &run));
  ck_assert_double_eq(c.nu, 0.1);
  bw_check_ok(bw_case_path(run, "run.yaml", &record));
  bw_check_ok(bw_config_load(bw_check_world(), record, fields, 0, NULL, sizeof again, &again));
  ck_assert_double_eq(again.nu, 0.1);
  ck_assert_int_eq(again.steps, 7);
  const bw_status failed = BW_FAIL(BW_EDIVERGED, "the flow \"blew up\"");
  bw_check_status(bw_case_end(bw_check_world(), &run, failed), BW_EDIVERGED);
  ck_assert_str_eq(bw_last_message(), "the flow \"blew up\"");
  bw_check_ok(bw_file_read_text(bw_check_world(), record, NULL, &text));
  char ranks[32];
  snprintf(ranks, sizeof ranks, "  ranks: %d\n", bw_comm_size(bw_check_world()));
  const char *const pieces[] = {"\nrun:\n  case: tube\n",
                                "  version: ",
                                "  commit: ",
                                ranks,
                                "  precision: ",
                                "  set: [\"nu=0.1\"]\n",
                                "  start: 2",
                                "  end: 2",
                                "  exit_code: 6\n",
                                "message: \"the flow \\\"blew up\\\"\""};
  for (size_t q = 0; q < sizeof pieces / sizeof *pieces; q++)
    ck_assert_msg(strstr(text, pieces[q]) != NULL, "'%s' not in:\n%s", pieces[q], text);
  again.nu = NAN; /* still a case file with its end in it */
  bw_check_ok(bw_config_load(bw_check_world(), record, fields, 0, NULL, sizeof again, &again));
  ck_assert_double_eq(again.nu, 0.1);
  bw_release(&record);
  bw_release(&text);
  bw_release(&path);
}
END_TEST

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
  bw_check_ok(bw_file_write_text(comm, checkpoint, "state"));
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
                 "holds results of another case than plate");
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
  expect_refusal(&about, WORDS(yaml, "--out", folder, "--restart", own), BW_EINPUT, "history.csv");
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

/* The wall-clock time of --stop-after, without waiting for it; and what a run returns then. */
START_TEST(stopping_before_the_end)
{
  static const struct {
    const char *text;
    double seconds;
  } times[] = {{"0", 0.0}, {"90", 90.0}, {"1.5m", 90.0}, {"2h30m", 9000.0}, {"1d1s", 86401.0}};
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], *text = NULL, *record = NULL;
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  in_base("stopped", folder);
  for (size_t q = 0; q < sizeof times / sizeof *times; q++) {
    bw_check_ok(
        begin(&about, WORDS(yaml, "--check", "--quiet", "--stop-after", times[q].text), &c, &run));
    ck_assert_double_eq(bw_case_args_of(run)->stop_after, times[q].seconds);
    bw_check_ok(bw_case_end(comm, &run, BW_OK));
  }
  bw_check_ok(begin(&about, WORDS(yaml, "--check", "--quiet"), &c, &run));
  ck_assert(!bw_case_stopping(run));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet", "--stop-after=0"), &c, &run));
  ck_assert(bw_case_stopping(run));
  bw_check_ok(bw_case_path(run, "run.yaml", &record));
  const bw_status st = bw_case_unfinished(run, "checkpoint.h5");
  ck_assert_int_eq(st, BW_EUNFINISHED);
  ck_assert_int_eq(st, 75);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "stopped/checkpoint.h5"));
  bw_check_status(bw_case_end(comm, &run, st), BW_EUNFINISHED);
  bw_check_ok(bw_file_read_text(comm, record, NULL, &text));
  ck_assert_ptr_nonnull(strstr(text, "  exit_code: 75\n  status: \"unfinished\"\n"));
  bw_release(&text);
  bw_release(&record);
}
END_TEST

static void close_rows(bw_history **h, int64_t expected)
{
  if (bw_comm_rank(bw_check_world()) == 0) ck_assert_int_eq(bw_history_rows(*h), expected);
  bw_check_ok(bw_history_close(bw_check_world(), h));
}

/* Rows are counted where the checkpoint lies in the folder of the results, and not elsewhere. */
START_TEST(histories_go_on_in_their_folder)
{
  static const char *const columns[] = {"time[s]", "x[-]"};
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], other[200], checkpoint[220];
  config c;
  bw_case *run = NULL;
  bw_history *h = NULL;
  case_file(yaml);
  in_base("history", folder);
  in_base("history-2", other);
  snprintf(checkpoint, sizeof checkpoint, "%s/checkpoint.h5", folder);
  bw_check_ok(begin(&about, WORDS(yaml, "--out", folder, "--quiet"), &c, &run));
  bw_check_ok(bw_case_history(run, 2, columns, 5.0, 5, &h)); /* new: 5.0 and 5 are not looked at */
  for (int q = 0; q < 3; q++)
    bw_history_append(h, (const double[]){q, 0.0});
  close_rows(&h, 3);
  bw_check_ok(bw_file_write_text(comm, checkpoint, "state"));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  const char *const here[] = {yaml, "--out", folder, "--quiet", "--restart", checkpoint, NULL};
  bw_check_ok(begin(&about, here, &c, &run));
  bw_check_status(bw_case_history(run, 2, columns, 2.0, 4, &h), BW_EINPUT);
  bw_check_ok(bw_case_history(run, 2, columns, 1.0, 2, &h));
  close_rows(&h, 2);
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  const char *const there[] = {yaml, "--out", other, "--quiet", "--restart", checkpoint, NULL};
  bw_check_ok(begin(&about, there, &c, &run));
  bw_check_ok(bw_case_history(run, 2, columns, 1.0, 2, &h));
  close_rows(&h, 0);
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(command_line_errors_have_hints),
                                      BW_TEST(check_help_and_version_touch_nothing),
                                      BW_TEST(default_folders),
                                      BW_TEST(the_record),
                                      BW_TEST(results_are_not_overwritten),
                                      BW_TEST(overwriting_removes_own_files_alone),
                                      BW_TEST(one_run_at_a_time),
                                      BW_TEST(stopping_before_the_end),
                                      BW_TEST(histories_go_on_in_their_folder)};
BW_CHECK_MAIN("core.case", tests)
