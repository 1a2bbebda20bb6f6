/* What is watched: mean, amplitude and frequency of gauges, from the rows of history.csv (which
 * holds those before a restart, too).
 *
 * Of the rows from time `from` on: with the mean m, upward crossings of m at t_0 .. t_n by linear
 * interpolation give n periods and the frequency n/(t_n - t_0); with last_periods k the window is
 * that of the last k periods (all there are, if fewer), and mean, largest and least are taken anew
 * in it. midrange: (largest + least)/2; time: trapezoidal mean; amplitude: (largest - least)/2. */
#include "scene_impl.h"

#include "bw_file.h"
#include "bw_memory.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Times and values of one column; rows without a number are left out. */
typedef struct {
  size_t n;
  double *t, *x;
} series;

static bw_status parse(const char *text, int column, double from, series *out)
{
  size_t rows = 0;
  for (const char *c = text; *c != '\0'; c++)
    rows += *c == '\n';
  BW_TRY(BW_ALLOCATE(&out->t, rows + 1));
  BW_TRY(BW_ALLOCATE(&out->x, rows + 1));
  /* The first line has the names. */
  for (const char *line = strchr(text, '\n'); line != NULL && line[1] != '\0';
       line = strchr(line + 1, '\n')) {
    const char *cell = line + 1;
    char *end = NULL;
    const double t = strtod(cell, &end);
    for (int k = 0; k < column && cell != NULL; k++) {
      cell = strpbrk(cell, ",\n");
      cell = cell != NULL && *cell == ',' ? cell + 1 : NULL;
    }
    if (cell == NULL) continue;
    const double x = strtod(cell, &end);
    if (end == cell || t < from) continue;
    out->t[out->n] = t;
    out->x[out->n++] = x;
  }
  return BW_OK;
}

static void span(const series *q, double from, double to, double *least, double *most, double *mean)
{
  double area = 0.0, length = 0.0;
  *least = HUGE_VAL, *most = -HUGE_VAL;
  for (size_t i = 0; i < q->n; i++) {
    if (q->t[i] < from || q->t[i] > to) continue;
    *least = fmin(*least, q->x[i]), *most = fmax(*most, q->x[i]);
    if (i == 0 || q->t[i - 1] < from) continue;
    area += 0.5 * (q->x[i] + q->x[i - 1]) * (q->t[i] - q->t[i - 1]);
    length += q->t[i] - q->t[i - 1];
  }
  *mean = length > 0.0 ? area / length : 0.5 * (*least + *most);
}

/* Upward crossings of `level`; t (q->n) <- their times. */
static int crossings(const series *q, double level, double t[])
{
  int n = 0;
  for (size_t i = 1; i < q->n; i++)
    if (q->x[i - 1] < level && q->x[i] >= level)
      t[n++] =
          q->t[i - 1] + (level - q->x[i - 1]) / (q->x[i] - q->x[i - 1]) * (q->t[i] - q->t[i - 1]);
  return n;
}

typedef struct {
  double mean, amplitude, frequency;
  int periods;
} found;

static bw_status look(const bw_scene_watch *w, const series *q, found *f)
{
  double least, most, mean, *t = NULL;
  *f = (found){NAN, NAN, NAN, 0};
  if (q->n == 0) return BW_OK;
  BW_TRY(BW_ALLOCATE(&t, q->n));
  span(q, -HUGE_VAL, HUGE_VAL, &least, &most, &mean);
  double level = w->mean == 2 ? mean : 0.5 * (least + most);
  int n = crossings(q, level, t);
  const int asked = w->last_periods;
  f->periods = n - 1 < 0 ? 0 : n - 1;
  if (asked != INT_MIN && f->periods > asked) f->periods = asked;
  if (f->periods > 0) {
    const double from = t[n - 1 - f->periods], to = t[n - 1];
    f->frequency = f->periods / (to - from);
    if (asked != INT_MIN) span(q, from, to, &least, &most, &mean);
  }
  f->mean = w->mean == 2 ? mean : 0.5 * (least + most);
  f->amplitude = 0.5 * (most - least);
  bw_release(&t);
  return BW_OK;
}

static void print(FILE *out, bw_log *log, const bw_scene_watch *w, const char *unit, const found *f)
{
  fprintf(out, "%s,%.9g,%.9g,%.9g,%d\n", w->name, f->mean, f->amplitude, f->frequency, f->periods);
  char text[256];
  size_t used = (size_t)snprintf(text, sizeof text, "%-20s", w->name);
  if (w->mean > 0)
    used += (size_t)snprintf(text + used, sizeof text - used, "  mean (%s) %.5g %s",
                             w->mean == 1 ? "midrange" : "time", f->mean, unit);
  if (w->amplitude)
    used += (size_t)snprintf(text + used, sizeof text - used, "  amplitude %.5g %s", f->amplitude,
                             unit);
  if (w->frequency)
    used += (size_t)snprintf(text + used, sizeof text - used, "  frequency %.5g 1/T", f->frequency);
  if (w->frequency || w->last_periods != INT_MIN)
    snprintf(text + used, sizeof text - used, "  (%d whole period%s)", f->periods,
             f->periods == 1 ? "" : "s");
  bw_log_info(log, "%s", text);
}

/* On rank 0: every line of watch, from the text of the history. */
static bw_status report(const bw_scene *s, const char *history, FILE *out, bw_log *log)
{
  fprintf(out, "gauge,mean,amplitude,frequency[1/T],periods\n");
  for (int k = 0; k < s->config.n_watch; k++) {
    const bw_scene_watch *w = &s->config.watch[k];
    const int column = bw_scene__column_named(s, w->name);
    series q = {0};
    found f = {NAN, NAN, NAN, 0};
    bw_status st = parse(history, column, w->from, &q);
    BW_THEN(st, look(w, &q, &f));
    bw_release(&q.t);
    bw_release(&q.x);
    BW_TRY(st);
    if (w->mean > 0 || w->amplitude || w->frequency)
      print(out, log, w, strchr(s->names[column], '['), &f);
  }
  return BW_OK;
}

bw_status bw_scene__watch_report(bw_scene *s, const bw_case *run, bw_log *log)
{
  char *path = NULL, *history = NULL, *text = NULL, *history_path = NULL;
  size_t bytes = 0, length = 0;
  bw_comm *self = NULL;
  if (s->config.n_watch == 0) return BW_OK;
  bw_status st = bw_case_path(run, "watch.csv", &path);
  BW_THEN(st, bw_case_path(run, "history.csv", &history_path));
  if (st == BW_OK && bw_comm_rank(s->comm) == 0) {
    /* A communicator of this rank alone: others do not read. */
    FILE *out = open_memstream(&text, &length);
    if (out == NULL) st = BW_FAIL(BW_EMEM, "no memory for watch.csv");
    BW_THEN(st, bw_comm_self(&self));
    BW_THEN(st, bw_file_read_text(self, history_path, &bytes, &history));
    BW_THEN(st, report(s, history, out, log));
    if (out != NULL) fclose(out);
    bw_comm_destroy(&self);
  }
  st = bw_comm_agree(s->comm, st);
  BW_THEN(st, bw_file_write_text(s->comm, path, text));
  bw_release(&path);
  bw_release(&history_path);
  bw_release(&history);
  bw_release(&text);
  return st;
}
