/* The command line, run.yaml, the end of a run before its time.
 * TEST ranks=1,2 */
#include "bw_memory.h"
#include "case_test.h"

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
  bw_check_ok(bw_file_write_text(comm, checkpoint, TUBE));
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
                                      BW_TEST(stopping_before_the_end),
                                      BW_TEST(histories_go_on_in_their_folder)};
BW_CHECK_MAIN("core.case", tests)
