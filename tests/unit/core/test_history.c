/* history.csv: what is written, what a restart keeps, what is damaged.
 * TEST ranks=1,2,4 */
#include "bw_check.h"
#include "bw_file.h"
#include "bw_history.h"
#include "bw_memory.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static bool speaks(void)
{
  return bw_comm_rank(bw_check_world()) == 0;
}

static const char *const columns[] = {"time[s]", "pressure_drop_over_p0[-]"};
static char history_path[64];

static bw_history *open_history_of(double restart, int64_t restart_rows)
{
  bw_history *h = NULL;
  snprintf(history_path, sizeof history_path, "test_core_history_np%d.csv",
           bw_comm_size(bw_check_world()));
  bw_check_ok(
      bw_history_create(bw_check_world(), history_path, 2, columns, restart, restart_rows, &h));
  return h;
}

static bw_history *open_history(double restart)
{
  return open_history_of(restart, -1);
}

static void rows(bw_history *h, int first, int last, double scale)
{
  for (int q = first; q <= last; q++)
    bw_history_append(h, (const double[]){0.1 * q, scale * q});
}

static void expect_history(const char *expected)
{
  char *text = NULL;
  bw_check_ok(bw_file_read_text(bw_check_world(), history_path, NULL, &text));
  ck_assert_str_eq(text, expected);
  bw_release(&text);
}

/* Rows later than the restart go, the row at the restart stays once whoever writes it, an
 * incomplete row goes; all doubles read back. */
START_TEST(history_goes_on_without_duplicates)
{
  const bw_comm *comm = bw_check_world();
  bw_history *h = open_history(NAN);
  rows(h, 0, 4, 1.0 / 3.0);
  ck_assert_int_eq(bw_history_rows(h), speaks() ? 5 : 0);
  bw_check_ok(bw_history_close(comm, &h));
  ck_assert_ptr_null(h);
  expect_history("time[s],pressure_drop_over_p0[-]\n0,0\n0.1,0.3333333333333333\n"
                 "0.2,0.6666666666666666\n0.30000000000000004,1\n0.4,1.3333333333333333\n");

  h = open_history(0.2); /* sampled before the checkpoint: the next row is a new one */
  ck_assert_int_eq(bw_history_rows(h), speaks() ? 3 : 0);
  rows(h, 3, 3, 2.0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history("time[s],pressure_drop_over_p0[-]\n0,0\n0.1,0.3333333333333333\n"
                 "0.2,0.6666666666666666\n0.30000000000000004,6\n");

  h = open_history(0.1); /* sampled again at the start: it is there already */
  rows(h, 1, 2, 5.0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history("time[s],pressure_drop_over_p0[-]\n0,0\n0.1,0.3333333333333333\n0.2,10\n");

  bw_check_ok(bw_file_write_text(comm, history_path,
                                 "time[s],pressure_drop_over_p0[-]\n0,0\n0.1,0.3\n0.15,0."));
  h = open_history(1.0); /* killed while it wrote */
  rows(h, 2, 2, 5.0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history("time[s],pressure_drop_over_p0[-]\n0,0\n0.1,0.3\n0.2,10\n");

  h = open_history(-1.0); /* a restart before all rows */
  bw_check_ok(bw_history_close(comm, &h));
  expect_history("time[s],pressure_drop_over_p0[-]\n");

  bw_check_ok(bw_file_write_text(comm, history_path, "")); /* killed before the first line */
  h = open_history(1.0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history("time[s],pressure_drop_over_p0[-]\n");
  bw_check_ok(bw_history_close(comm, &h)); /* NULL is fine */
}
END_TEST

START_TEST(history_refusals)
{
  const bw_comm *comm = bw_check_world();
  static const char *const bare[] = {"time[s]", "drop"}, *const comma[] = {"time[s]", "a,b[-]"};
  bw_history *h = open_history(NAN);
  bw_check_ok(bw_history_close(comm, &h));
  bw_check_status(bw_history_create(comm, history_path, 1, columns, 0.0, -1, &h), BW_EINPUT);
  ck_assert_ptr_null(h);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "holds other columns"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "pressure_drop_over_p0[-]"));
  bw_check_status(bw_history_create(comm, history_path, 2, bare, NAN, -1, &h), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "'drop' has no unit"));
  bw_check_status(bw_history_create(comm, history_path, 2, comma, NAN, -1, &h), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "comma"));
  bw_check_status(bw_history_create(comm, "no_such_folder/h.csv", 2, columns, NAN, -1, &h), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no_such_folder/h.csv: No such file"));

  bw_check_ok(bw_history_create(comm, "/dev/full", 2, columns, NAN, -1, &h) == BW_EIO
                  ? BW_OK
                  : BW_EIO); /* the header cannot be written */
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "No space left"));
}
END_TEST

#define HEADER "time[s],pressure_drop_over_p0[-]\n"

/* `text` is refused as the history of a run that had written three rows until t = 0.2 (or -1: it is
 * not known how many), with the piece in the message; the file stays as it was. */
static void expect_damage(const char *text, int64_t written, const char *piece)
{
  const bw_comm *comm = bw_check_world();
  bw_history *h = NULL;
  bw_check_ok(bw_file_write_text(comm, history_path, text));
  const bw_status st = bw_history_create(comm, history_path, 2, columns, 0.2, written, &h);
  ck_assert_msg(st == BW_EINPUT && h == NULL, "accepted: %s", text);
  ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                bw_last_message());
  expect_history(text);
}

START_TEST(damaged_histories_are_refused)
{
  const bw_comm *comm = bw_check_world();
  bw_history *h = open_history(NAN);
  bw_check_ok(bw_history_close(comm, &h));
  expect_damage(HEADER "0,0\nhello,world\n0.2,2\n", -1, ".csv:3: no row of 2 numbers");
  expect_damage(HEADER "0,0\n,\n0.2,2\n", -1, ".csv:3: no row"); /* a row has a time */
  expect_damage(HEADER "0,0\n0.1\n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n0.1,1,1\n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n0.1,1 \n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n0.1,0x1\n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n0.1,inf\n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n\n0.2,2\n", -1, ".csv:3: no row");
  expect_damage(HEADER "0,0\n0.1,1\n0.1,1\n0.2,2\n", -1, ".csv:4: the time 0.1 does not follow");
  expect_damage(HEADER "0,0\n0.2,2\n0.1,1\n", -1, ".csv:4: the time 0.1 does not follow");
  expect_damage(HEADER "0,0\n0.2,2\n", 3, "holds 2 rows");
  expect_damage(HEADER "0,0\n0.1,1\n0.2,", 3, "holds 2 rows");
  expect_damage(HEADER "0,0\n0.05,1\n0.1,1\n0.2,2\n", 3, "holds 4 rows");
  expect_damage(HEADER, 3, "holds 0 rows");
  expect_damage("", 3, "holds other columns");

  /* Not damaged: a number that was not measured; whatever follows the rows of the checkpoint. */
  bw_check_ok(bw_file_write_text(comm, history_path,
                                 HEADER "0,\n0.1,1e-3\n0.2,2\n0.3,3\n\x01\x02,\n0.4,4\n"));
  h = open_history_of(0.2, 3);
  ck_assert_int_eq(bw_history_rows(h), speaks() ? 3 : 0);
  rows(h, 3, 3, 1.0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history(HEADER "0,\n0.1,1e-3\n0.2,2\n0.30000000000000004,3\n");
  bw_check_ok(bw_file_write_text(comm, history_path, HEADER "0,0\n0.1,1\n0.2,2\n0.\n"));
  h = open_history_of(0.2, 3);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history(HEADER "0,0\n0.1,1\n0.2,2\n");
}
END_TEST

/* A time stands once; what was not measured is empty; an infinite number is no result. */
START_TEST(rows_that_cannot_be)
{
  const bw_comm *comm = bw_check_world();
  bw_history *h = open_history(NAN);
  bw_history_append(h, (const double[]){0.0, NAN});
  bw_history_append(h, (const double[]){0.1, 1.0});
  bw_history_append(h, (const double[]){0.1, 1.0});
  ck_assert_int_eq(bw_history_rows(h), speaks() ? 2 : 0);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history(HEADER "0,\n0.1,1\n");
  h = open_history(NAN);
  bw_history_append(h, (const double[]){0.0, 1.0});
  bw_history_append(h, (const double[]){0.1, -INFINITY});
  bw_check_status(bw_history_close(comm, &h), BW_EDIVERGED);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "column 2 is infinite at 0.1"));
}
END_TEST

/* A disk that is full: no row is counted that is not there, no checkpoint may be written that
 * counts one, and nothing is written behind the row that was cut. */
START_TEST(a_full_disk)
{
  const bw_comm *comm = bw_check_world();
  bw_history *h = open_history(NAN);
  rows(h, 0, 1, 1.0);
  bw_check_ok(bw_history_sync(comm, h));
  struct rlimit before, low;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &before);
  low = before;
  low.rlim_cur = sizeof HEADER + 10; /* into the third row */
  setrlimit(RLIMIT_FSIZE, &low);
  rows(h, 2, 2, 1.0 / 3.0);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  rows(h, 3, 3, 1.0); /* there is room again */
  ck_assert_int_eq(bw_history_rows(h), speaks() ? 2 : 0);
  bw_check_status(bw_history_sync(comm, h), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), history_path));
  /* The system's own reason. */
  ck_assert_ptr_nonnull(strstr(bw_last_message(), strerror(EFBIG)));
  bw_check_status(bw_history_close(comm, &h), BW_EIO);
  h = open_history_of(0.1, 2);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history(HEADER "0,0\n0.1,1\n");
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(history_goes_on_without_duplicates), BW_TEST(damaged_histories_are_refused),
    BW_TEST(rows_that_cannot_be), BW_TEST(a_full_disk), BW_TEST(history_refusals)};
BW_CHECK_MAIN("core.history", tests)
