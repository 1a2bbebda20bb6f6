/* What a run tells and keeps: log, progress, timer.
 * TEST ranks=1,2,4 */
#include "bw_check.h"
#include "bw_log.h"
#include "bw_timer.h"

#include <stdio.h>
#include <string.h>

/* The log's clock [s]: it goes when the test says so, not when the machine has time. */
static double told;
static double tell_time(void)
{
  return told;
}

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
  m->config.clock = tell_time;
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
    /* Kept for the record, on the rank that writes it. */
    if (speaks())
      ck_assert_str_eq(bw_log_warning(m.log, 0), "dt 0.5 is large");
    else
      ck_assert_ptr_null(bw_log_warning(m.log, 0));
    ck_assert_ptr_null(bw_log_warning(m.log, 1));
    close_log(&m);
    ck_assert_str_eq(m.out, speaks() && !quiet ? "7 cells\n" : "");
    ck_assert_str_eq(m.err, speaks() ? "breakwater: warning: dt 0.5 is large\n" : "");
    free_log(&m);
  }
  bw_log_info(NULL, "nobody hears %s", "this");
  bw_log_warn(NULL, "nor this");
}
END_TEST

/* A step takes a quarter of a second and gets 0.02 of 2 s further. */
static void steps(memory_log *m, int n)
{
  bw_progress *p = NULL;
  bw_progress_config c = bw_progress_config_default();
  c.time_end = 2.0;
  c.step_end = 100;
  bw_check_ok(bw_progress_create(m->log, &c, &p));
  for (int q = 1; q <= n; q++) {
    told += 0.25;
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
    ck_assert_ptr_nonnull(strstr(m.out, "4 steps/s  ETA 0:25  drop 0.50\n")); /* 99 of 4 a second */
    ck_assert_ptr_nonnull(strstr(m.out, "took 0:01"));
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

/* Half of the speed shown is that since the last line, half what was shown before; the time left
 * follows from it. */
START_TEST(speed_and_time_left)
{
  memory_log m;
  bw_progress *p = NULL;
  bw_progress_config c = bw_progress_config_default();
  c.step_end = 968;
  open_log(&m, false, 0, 0.125);
  bw_check_ok(bw_progress_create(m.log, &c, &p));
  for (int q = 1; q <= 12; q++) {
    told += q <= 8 ? 1.0 / 64.0 : 1.0 / 32.0;
    bw_progress_update(p, q, 0.0, "%s", "");
  }
  bw_progress_finish(&p);
  close_log(&m);
  if (speaks()) /* due after 8 steps of 1/64 s and 4 more of 1/32 s: 960/64 s left, 956/48 s */
    ck_assert_str_eq(m.out, "step 8/968  t 0 s  64 steps/s  ETA 0:15\n"
                            "step 12/968  t 0 s  48 steps/s  ETA 0:20\n"
                            "step 12/968  t 0 s  mean 48 steps/s  took 0:00\n");
  free_log(&m);
}
END_TEST

/* What follows has the machine's clock in it: only that at least as much time has passed as was
 * burnt is claimed, which a busy machine cannot break, and sums of what was measured. */
static void burn(double seconds)
{
  const double t0 = bw_wall_time();
  while (bw_wall_time() - t0 < seconds)
    ;
}

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
  double nothing = -1.0;
  bw_timer_summary(NULL, comm, rows + 2, &nothing);
  ck_assert_double_eq(nothing, 0.0);
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

static const bw_check_test tests[] = {BW_TEST(rank_zero_speaks),    BW_TEST(plain_progress),
                                      BW_TEST(terminal_progress),   BW_TEST(speed_and_time_left),
                                      BW_TEST(timer_moves_seconds), BW_TEST(timer_sums)};
BW_CHECK_MAIN("core.run", tests)
