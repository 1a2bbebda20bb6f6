#include "bw_timer.h"
#include "bw_memory.h"

#include <math.h>

typedef struct {
  double seconds, since, work; /* `since`: wall time of start; 0 when not running */
  double calls;
} part_sums;

struct bw_timer {
  int n;
  const bw_timer_part *parts; /* (n) */
  part_sums *sums;            /* (n) */
  double begin;               /* wall time of create or reset */
};

bw_status bw_timer_create(int n, const bw_timer_part parts[], bw_timer **out)
{
  bw_timer *t = NULL;
  *out = NULL;
  BW_TRY(BW_ALLOCATE(&t, 1));
  const bw_status st = BW_ALLOCATE(&t->sums, (size_t)n);
  if (st != BW_OK) {
    bw_release(&t);
    return st;
  }
  /* All sums are zero; the total starts with the reset. */
  t->n = n;
  t->parts = parts;
  bw_timer_reset(t);
  *out = t;
  return BW_OK;
}

void bw_timer_destroy(bw_timer **timer)
{
  if (*timer == NULL) return;
  bw_release(&(*timer)->sums);
  bw_release(timer);
}

void bw_timer_reset(bw_timer *t)
{
  if (t == NULL) return;
  for (int q = 0; q < t->n; q++)
    t->sums[q] = (part_sums){0};
  t->begin = bw_wall_time();
}

void bw_timer_start(bw_timer *t, int part)
{
  if (t == NULL) return;
  BW_ASSERT(part >= 0 && part < t->n && t->sums[part].since == 0.0);
  t->sums[part].since = bw_wall_time();
}

void bw_timer_stop(bw_timer *t, int part)
{
  if (t == NULL) return;
  BW_ASSERT(part >= 0 && part < t->n && t->sums[part].since != 0.0);
  t->sums[part].seconds += bw_wall_time() - t->sums[part].since;
  t->sums[part].since = 0.0;
  t->sums[part].calls += 1.0;
}

void bw_timer_move(bw_timer *t, int from, int to, double seconds)
{
  if (t == NULL) return;
  t->sums[from].seconds -= seconds;
  t->sums[to].seconds += seconds;
}

void bw_timer_work(bw_timer *t, int part, double units)
{
  if (t != NULL) t->sums[part].work += units;
}

double bw_timer_seconds(const bw_timer *t, int part)
{
  return t == NULL ? 0.0 : t->sums[part].seconds;
}

int bw_timer_parts(const bw_timer *t)
{
  return t == NULL ? 0 : t->n;
}

/* One row from this rank's sums; `total` is the wall time of the mean rank. */
static void fill_row(const bw_comm *comm, const char *name, const char *unit, const part_sums *mine,
                     double total, bw_timer_row *row)
{
  const int size = bw_comm_size(comm);
  double highest[2] = {mine->seconds, mine->calls}, sum[2] = {mine->seconds, mine->work};
  /* The slowest rank says how long a part takes; work is what all have done together. */
  bw_comm_max(comm, 2, highest);
  bw_comm_sum(comm, 2, sum);
  *row = (bw_timer_row){.name = name,
                        .work_unit = unit,
                        .seconds = highest[0],
                        .seconds_mean = sum[0] / size,
                        .share = total > 0.0 ? sum[0] / size / total : 0.0,
                        .work = sum[1],
                        .ns_per_unit = sum[1] > 0.0 ? 1e9 * highest[0] * size / sum[1] : NAN,
                        .calls = (int64_t)highest[1]};
}

void bw_timer_summary(const bw_timer *t, const bw_comm *comm, bw_timer_row rows[], double *total)
{
  if (t == NULL) {
    *total = 0.0;
    rows[0] = (bw_timer_row){.name = "other", .ns_per_unit = NAN};
    return;
  }
  const double wall = bw_wall_time() - t->begin;
  part_sums other = {.seconds = wall};
  double mean = wall;
  *total = wall;
  /* Shares are of the mean rank: they add up to 1 also where ranks take turns in waiting. */
  bw_comm_max(comm, 1, total);
  bw_comm_sum(comm, 1, &mean);
  mean /= bw_comm_size(comm);
  for (int q = 0; q < t->n; q++) {
    fill_row(comm, t->parts[q].name, t->parts[q].work_unit, &t->sums[q], mean, &rows[q]);
    /* What no part claims is "other". */
    other.seconds -= t->sums[q].seconds;
  }
  fill_row(comm, "other", NULL, &other, mean, &rows[t->n]);
}

static void report_row(const bw_timer_row *row, bw_log *log)
{
  char cost[80] = "";
  if (row->work > 0.0 && row->work_unit != NULL)
    snprintf(cost, sizeof cost, "  %10.4g core-ns per %s", row->ns_per_unit, row->work_unit);
  bw_log_info(log, "  %-16s %10.3f s %6.1f %%%s", row->name, row->seconds, 100.0 * row->share,
              cost);
}

bw_status bw_timer_report(const bw_timer *t, const bw_comm *comm, bw_log *log)
{
  bw_timer_row *rows = NULL;
  double total = 0.0;
  if (t == NULL) return BW_OK;
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&rows, (size_t)t->n + 1)));
  /* Every rank takes part in the sums; the log then speaks on rank 0 alone. */
  bw_timer_summary(t, comm, rows, &total);
  bw_log_info(log, "where the time went (largest over %d ranks; total %.3f s):", bw_comm_size(comm),
              total);
  for (int q = 0; q <= t->n; q++)
    report_row(&rows[q], log);
  bw_release(&rows);
  return BW_OK;
}
