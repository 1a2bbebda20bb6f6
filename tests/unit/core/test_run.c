/* What a run tells and keeps: log, progress, timer, history.
 * TEST ranks=1,2,4 */
#include "bw_check.h"
#include "bw_file.h"
#include "bw_history.h"
#include "bw_log.h"
#include "bw_memory.h"
#include "bw_timer.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* A log into memory. */
typedef struct {
  char *out, *err;
  size_t out_length, err_length;
  bw_log_config config;
  bw_log *log;
} memory_log;

static void open_log(memory_log *m, bool quiet, int terminal, double seconds)
{
  *m = (memory_log){.config = bw_log_config_default()};
  m->config.out = open_memstream(&m->out, &m->out_length);
  m->config.err = open_memstream(&m->err, &m->err_length);
  m->config.quiet = quiet;
  m->config.terminal = terminal;
  m->config.plain_seconds = m->config.redraw_seconds = seconds;
  bw_check_ok(bw_log_create(bw_check_world(), &m->config, &m->log));
}

static void close_log(memory_log *m)
{
  bw_log_destroy(&m->log);
  fclose(m->config.out);
  fclose(m->config.err);
}

static void free_log(memory_log *m)
{
  free(m->out);
  free(m->err);
}

static bool speaks(void)
{
  return bw_comm_rank(bw_check_world()) == 0;
}

START_TEST(rank_zero_speaks)
{
  for (int quiet = 0; quiet < 2; quiet++) {
    memory_log m;
    open_log(&m, quiet != 0, 0, 0.0);
    bw_log_info(m.log, "%d cells", 7);
    bw_log_warn(m.log, "dt %g is large", 0.5);
    close_log(&m);
    ck_assert_str_eq(m.out, speaks() && !quiet ? "7 cells\n" : "");
    ck_assert_str_eq(m.err, speaks() ? "breakwater: warning: dt 0.5 is large\n" : "");
    free_log(&m);
  }
  bw_log_info(NULL, "nobody hears %s", "this");
  bw_log_warn(NULL, "nor this");
}
END_TEST

static void steps(memory_log *m, int n)
{
  bw_progress *p = NULL;
  bw_progress_config c = bw_progress_config_default();
  c.time_end = 2.0;
  c.step_end = 100;
  bw_check_ok(bw_progress_create(m->log, &c, &p));
  for (int q = 1; q <= n; q++) {
    const double t0 = bw_wall_time();
    while (bw_wall_time() - t0 < 1e-3)
      ;
    bw_progress_update(p, q, 0.02 * q, "drop %.2f", 0.5 * q);
    if (q == 2) bw_log_info(m->log, "between");
  }
  bw_progress_finish(&p);
  ck_assert_ptr_null(p);
}

/* A plain line per step (the interval is 0 here), none of the terminal's control codes. */
START_TEST(plain_progress)
{
  memory_log m;
  open_log(&m, false, 0, 0.0);
  steps(&m, 3);
  close_log(&m);
  if (speaks()) {
    ck_assert_ptr_nonnull(strstr(m.out, "step 1/100  t 0.02/2 s  "));
    ck_assert_ptr_nonnull(strstr(m.out, "drop 1.50\n"));
    ck_assert_ptr_nonnull(strstr(m.out, "\nbetween\n"));
    ck_assert_ptr_nonnull(strstr(m.out, "ETA 0:0"));
    ck_assert_ptr_nonnull(strstr(m.out, "took 0:00"));
    ck_assert_ptr_null(strchr(m.out, '\r'));
    int lines = 0;
    for (const char *c = m.out; *c != '\0'; c++)
      lines += *c == '\n';
    ck_assert_int_eq(lines, 5); /* 3 steps, "between", the end */
  } else {
    ck_assert_str_eq(m.out, "");
  }
  free_log(&m);

  open_log(&m, false, 0, 1000.0); /* not due: the last line only */
  steps(&m, 3);
  close_log(&m);
  if (speaks()) ck_assert_int_eq(strncmp(m.out, "between\nstep 3/100  t 0.06/2 s  mean ", 37), 0);
  free_log(&m);

  open_log(&m, true, 0, 0.0);
  steps(&m, 3);
  close_log(&m);
  ck_assert_str_eq(m.out, "");
  free_log(&m);
  bw_progress_update(NULL, 1, 1.0, "x");
}
END_TEST

/* On a terminal each line erases the one before, other lines stand alone, the width is kept. */
START_TEST(terminal_progress)
{
  memory_log m;
  open_log(&m, false, 40, 0.0);
  steps(&m, 3);
  close_log(&m);
  if (speaks()) {
    const char *second = strstr(m.out, "\r\033[Kstep 2/100");
    ck_assert_ptr_nonnull(second);
    const char *between = strstr(m.out, "\r\033[Kbetween\n");
    ck_assert_ptr_nonnull(between);
    ck_assert_int_le((int)(between - second), 4 + 39);
    ck_assert_ptr_nonnull(strstr(m.out, "between\nstep 3/100")); /* nothing to erase there */
    ck_assert_int_eq(m.out[m.out_length - 1], '\n');
  }
  free_log(&m);
}
END_TEST

static void burn(double seconds)
{
  const double t0 = bw_wall_time();
  while (bw_wall_time() - t0 < seconds)
    ;
}

/* Steps of at least 10 ms, at most `longest`: the speed shown lies between (1 % for the clock
 * readings in between; half, as a delay while printing counts in two intervals), and the time left
 * follows from it (rounded to 1 s; up to 20 steps old). */
START_TEST(speed_and_time_left)
{
  memory_log m;
  bw_progress *p = NULL;
  bw_progress_config c = bw_progress_config_default();
  c.step_end = 1000;
  open_log(&m, false, 0, 0.1);
  const double before = bw_wall_time();
  double longest = 0.0, last = before;
  bw_check_ok(bw_progress_create(m.log, &c, &p));
  for (int q = 1; q <= 20; q++) {
    burn(0.01);
    bw_progress_update(p, q, 0.0, "%s", "");
    longest = fmax(longest, bw_wall_time() - last);
    last = bw_wall_time();
  }
  bw_progress_finish(&p);
  close_log(&m);
  if (speaks()) {
    double speed = 0.0;
    int minutes = -1, seconds = -1;
    const char *line = strstr(m.out, "  t ");
    ck_assert_ptr_nonnull(line);
    ck_assert_int_eq(sscanf(line, "  t 0 s  %lf steps/s  ETA %d:%d", &speed, &minutes, &seconds),
                     3);
    ck_assert_double_le(speed, 1.01 / 0.01);
    ck_assert_double_ge(speed, 0.5 / longest);
    const double left = 60.0 * minutes + seconds;
    ck_assert_double_le(left, 1000.0 / speed + 1.0);
    ck_assert_double_ge(left, 980.0 / speed - 1.0);
  }
  free_log(&m);
}
END_TEST

/* What a callee measured of itself moves between parts; the sum of the parts stays. */
START_TEST(timer_moves_seconds)
{
  static const bw_timer_part parts[] = {{"whole", NULL}, {"part of it", NULL}};
  bw_timer *t = NULL;
  bw_check_ok(bw_timer_create(2, parts, &t));
  bw_timer_start(t, 0);
  burn(0.01);
  bw_timer_stop(t, 0);
  const double before = bw_timer_seconds(t, 0);
  bw_timer_move(t, 0, 1, 0.004);
  bw_check_near(bw_timer_seconds(t, 0), before - 0.004, 1e-15);
  bw_check_near(bw_timer_seconds(t, 1), 0.004, 1e-15);
  bw_timer_move(NULL, 0, 1, 1.0);
  bw_timer_destroy(&t);
}
END_TEST

/* Rank r spends 20 (r+1) ms in part 0: the largest, the mean, the cost per unit of work. */
START_TEST(timer_sums)
{
  static const bw_timer_part parts[] = {{"momentum", "cell sub-step"}, {"solid", NULL}};
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  bw_timer *t = NULL;
  bw_timer_row rows[3];
  double total = 0.0, mine[2], highest, mean;
  bw_check_ok(bw_timer_create(2, parts, &t));
  ck_assert_int_eq(bw_timer_parts(t), 2);
  for (int q = 0; q < 2; q++) {
    bw_timer_start(t, 0);
    burn(0.01 * (me + 1));
    bw_timer_stop(t, 0);
    bw_timer_work(t, 0, 500.0);
  }
  bw_timer_start(t, 1);
  burn(0.005);
  bw_timer_stop(t, 1);
  burn(0.01);
  bw_timer_summary(t, comm, rows, &total);

  mine[0] = bw_timer_seconds(t, 0);
  ck_assert_double_ge(mine[0], 0.02 * (me + 1));
  highest = mine[0];
  mean = mine[0];
  bw_comm_max(comm, 1, &highest);
  bw_comm_sum(comm, 1, &mean);
  mean /= size;
  ck_assert_double_eq(rows[0].seconds, highest);
  bw_check_near(rows[0].seconds_mean, mean, 1e-15); /* the same sum, another order */
  ck_assert_double_eq(rows[0].work, 1000.0 * size);
  bw_check_near(rows[0].ns_per_unit, 1e9 * highest / 1000.0, 1e-12);
  ck_assert_int_eq(rows[0].calls, 2);
  ck_assert_int_eq(rows[1].calls, 1);
  ck_assert(isnan(rows[1].ns_per_unit));
  ck_assert_str_eq(rows[2].name, "other");
  ck_assert_double_ge(rows[2].seconds, 0.01);
  bw_check_near(rows[0].share + rows[1].share + rows[2].share, 1.0, 1e-12);
  ck_assert_double_ge(total, 0.02 * size + 0.015);

  memory_log m;
  open_log(&m, false, 0, 0.0);
  bw_check_ok(bw_timer_report(t, comm, m.log));
  close_log(&m);
  if (speaks()) {
    ck_assert_ptr_nonnull(strstr(m.out, "momentum"));
    ck_assert_ptr_nonnull(strstr(m.out, "core-ns per cell sub-step"));
    ck_assert_ptr_nonnull(strstr(m.out, "other"));
  }
  free_log(&m);
  bw_timer_reset(t);
  ck_assert_double_eq(bw_timer_seconds(t, 0), 0.0);
  bw_timer_destroy(&t);
  bw_timer_destroy(&t); /* NULL is fine, and everywhere else */
  bw_timer_start(t, 0);
  bw_timer_stop(t, 0);
  bw_timer_work(t, 0, 1.0);
  bw_check_ok(bw_timer_report(t, comm, NULL));
}
END_TEST

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

/* A disk that is full: no row is counted that is not there, no checkpoint may be written that counts
 * one, and nothing is written behind the row that was cut. */
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
  bw_check_status(bw_history_close(comm, &h), BW_EIO);
  h = open_history_of(0.1, 2);
  bw_check_ok(bw_history_close(comm, &h));
  expect_history(HEADER "0,0\n0.1,1\n");
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(rank_zero_speaks),
                                      BW_TEST(plain_progress),
                                      BW_TEST(terminal_progress),
                                      BW_TEST(speed_and_time_left),
                                      BW_TEST(timer_moves_seconds),
                                      BW_TEST(timer_sums),
                                      BW_TEST(history_goes_on_without_duplicates),
                                      BW_TEST(damaged_histories_are_refused),
                                      BW_TEST(rows_that_cannot_be),
                                      BW_TEST(a_full_disk),
                                      BW_TEST(history_refusals)};
BW_CHECK_MAIN("core.run", tests)
