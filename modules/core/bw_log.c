#include "bw_log.h"
#include "bw_memory.h"
#include "core_internal.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

enum { LINE = 512, KEPT = 20 };

struct bw_log {
  bw_log_config config;
  bool speaks;    /* rank 0 */
  bool line_open; /* a progress line without its newline is on the terminal */
  int n_kept;
  char *kept[KEPT]; /* warnings */
};

struct bw_progress {
  bw_log *log;
  bw_progress_config config;
  double wall_start;                        /* [s] */
  double wall_shown, time_shown;            /* at the last line */
  double steps_per_second, time_per_second; /* smoothed; 0 before the first line */
  int64_t step_shown, step;
  double time;
  char watched[LINE / 2];
};

bw_log_config bw_log_config_default(void)
{
  return (bw_log_config){.quiet = false,
                         .out = stdout,
                         .err = stderr,
                         .terminal = -1,
                         .plain_seconds = 10.0,
                         .redraw_seconds = 0.2,
                         .clock = bw_wall_time};
}

bw_status bw_log_create(const bw_comm *comm, const bw_log_config *config, bw_log **out)
{
  bw_log *log = NULL;
  BW_TRY(BW_ALLOCATE(&log, 1));
  log->config = config != NULL ? *config : bw_log_config_default();
  log->speaks = bw_comm_rank(comm) == 0;
  if (log->config.terminal < 0) log->config.terminal = bw_core__terminal_width(log->config.out);
  *out = log;
  return BW_OK;
}

/* The progress line goes away so that another line can take its place. */
static void clear_line(bw_log *log)
{
  if (log->line_open) fputs("\r\033[K", log->config.out);
  log->line_open = false;
}

void bw_log_destroy(bw_log **log)
{
  if (*log == NULL) return;
  clear_line(*log);
  fflush((*log)->config.out);
  for (int q = 0; q < (*log)->n_kept; q++)
    bw_release(&(*log)->kept[q]);
  bw_release(log);
}

void bw_log_info(bw_log *log, const char *fmt, ...)
{
  if (log == NULL || !log->speaks || log->config.quiet) return;
  va_list args;
  /* The progress line makes room and is drawn anew by the next update. */
  clear_line(log);
  va_start(args, fmt);
  vfprintf(log->config.out, fmt, args);
  va_end(args);
  fputc('\n', log->config.out);
  fflush(log->config.out);
}

/* The text of a warning; NULL without memory, which it is not worth to end a run for. */
static char *warning_text(const char *fmt, va_list args)
{
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) return NULL;
  vfprintf(out, fmt, args);
  if (fclose(out) == 0) return text;
  bw_release(&text);
  return NULL;
}

void bw_log_warn(bw_log *log, const char *fmt, ...)
{
  if (log == NULL || !log->speaks) return;
  va_list args;
  clear_line(log);
  /* The two streams may end on one terminal: in order of time. */
  fflush(log->config.out);
  va_start(args, fmt);
  char *text = warning_text(fmt, args);
  va_end(args);
  fprintf(log->config.err, "breakwater: warning: %s\n", text != NULL ? text : fmt);
  fflush(log->config.err);
  /* What a user may have missed on the screen stands in run.yaml. */
  if (text != NULL && log->n_kept < KEPT)
    log->kept[log->n_kept++] = text;
  else
    bw_release(&text);
}

const char *bw_log_warning(const bw_log *log, int q)
{
  return log != NULL && 0 <= q && q < log->n_kept ? log->kept[q] : NULL;
}

static double now_of(const bw_log *log)
{
  return log != NULL ? log->config.clock() : bw_wall_time();
}

bw_progress_config bw_progress_config_default(void)
{
  return (bw_progress_config){
      .time_start = 0.0, .time_end = NAN, .step_start = 0, .step_end = 0, .time_unit = "s"};
}

bw_status bw_progress_create(bw_log *log, const bw_progress_config *config, bw_progress **out)
{
  bw_progress *p = NULL;
  BW_TRY(BW_ALLOCATE(&p, 1));
  p->log = log;
  p->config = config != NULL ? *config : bw_progress_config_default();
  /* The first interval begins now, so that set-up before it does not count as slow steps. */
  p->wall_start = p->wall_shown = now_of(log);
  p->time = p->time_shown = p->config.time_start;
  p->step = p->step_shown = p->config.step_start;
  *out = p;
  return BW_OK;
}

/* Half of the new speed, half of the old: steady to read, soon right after a change. */
static void measure_speed(bw_progress *p, double now)
{
  const double seconds = now - p->wall_shown;
  if (seconds <= 0.0) return;
  const double steps = (double)(p->step - p->step_shown) / seconds;
  const double time = (p->time - p->time_shown) / seconds;
  /* The first interval has no older one to be averaged with. */
  const bool first = p->steps_per_second == 0.0;
  p->steps_per_second = first ? steps : 0.5 * (p->steps_per_second + steps);
  p->time_per_second = first ? time : 0.5 * (p->time_per_second + time);
  p->wall_shown = now;
  p->step_shown = p->step;
  p->time_shown = p->time;
}

/* Seconds still to go; NaN when nothing says so. */
static double remaining(const bw_progress *p)
{
  /* A goal in time is better than one in steps: steps may change their length. */
  if (isfinite(p->config.time_end))
    return p->time_per_second > 0.0 ? fmax(0.0, (p->config.time_end - p->time) / p->time_per_second)
                                    : NAN;
  if (p->config.step_end > 0 && p->steps_per_second > 0.0)
    return fmax(0.0, (double)(p->config.step_end - p->step) / p->steps_per_second);
  return NAN;
}

/* "1 d 02:03:04", "2:03:04" or "3:04"; "?" for NaN. */
static void format_duration(char *text, size_t size, double seconds)
{
  /* NaN, or more than three hundred years: nothing to tell. */
  if (!(seconds < 1e10)) {
    snprintf(text, size, "?");
    return;
  }
  const long long s = (long long)(seconds + 0.5);
  const int day = (int)(s / 86400), h = (int)(s / 3600 % 24), m = (int)(s / 60 % 60);
  if (day > 0)
    snprintf(text, size, "%d d %02d:%02d:%02d", day, h, m, (int)(s % 60));
  else if (h > 0)
    snprintf(text, size, "%d:%02d:%02d", h, m, (int)(s % 60));
  else
    snprintf(text, size, "%d:%02d", m, (int)(s % 60));
}

/* Cut to the terminal's width: a line that wraps could not be redrawn in place. */
static void show(bw_progress *p, const char *speed_word, double steps_per_second, const char *tail)
{
  const bw_progress_config *c = &p->config;
  const int columns = p->log->config.terminal;
  char line[LINE];
  char goal[64] = "", step_goal[32] = "";
  /* What is not known is left out rather than shown as a question. */
  if (isfinite(c->time_end)) snprintf(goal, sizeof goal, "/%.4g", c->time_end);
  if (c->step_end > 0) snprintf(step_goal, sizeof step_goal, "/%lld", (long long)c->step_end);
  snprintf(line, sizeof line, "step %lld%s  t %.5g%s %s  %s%.4g steps/s  %s%s%s",
           (long long)p->step, step_goal, p->time, goal, c->time_unit, speed_word, steps_per_second,
           tail, p->watched[0] != '\0' ? "  " : "", p->watched);
  if (columns > 1 && strlen(line) >= (size_t)columns) line[columns - 1] = '\0';
  fputs(line, p->log->config.out);
}

void bw_progress_update(bw_progress *p, int64_t step, double time, const char *fmt, ...)
{
  if (p == NULL || p->log == NULL || !p->log->speaks || p->log->config.quiet) return;
  const bw_log_config *c = &p->log->config;
  const double now = now_of(p->log);
  /* The last state is kept even when no line is due: finish shows it. */
  p->step = step;
  p->time = time;
  /* Nothing below this line is done more often than a reader can follow. */
  if (now - p->wall_shown < (c->terminal ? c->redraw_seconds : c->plain_seconds)) return;
  char left[32], tail[48];
  va_list args;
  measure_speed(p, now);
  format_duration(left, sizeof left, remaining(p));
  snprintf(tail, sizeof tail, "ETA %s", left);
  va_start(args, fmt);
  vsnprintf(p->watched, sizeof p->watched, fmt, args);
  va_end(args);
  clear_line(p->log);
  show(p, "", p->steps_per_second, tail);
  /* On a terminal the line stays open, to be redrawn; elsewhere each is a line of its own. */
  if (!c->terminal) fputc('\n', c->out);
  p->log->line_open = c->terminal != 0;
  fflush(c->out);
}

void bw_progress_finish(bw_progress **progress)
{
  bw_progress *p = *progress;
  if (p == NULL) return;
  /* The last line is plain on a terminal too, and stays. */
  if (p->log != NULL && p->log->speaks && !p->log->config.quiet) {
    char spent[32], tail[48];
    const double seconds = now_of(p->log) - p->wall_start;
    format_duration(spent, sizeof spent, seconds);
    snprintf(tail, sizeof tail, "took %s", spent);
    p->watched[0] = '\0'; /* may be older than the last step */
    clear_line(p->log);
    show(p, "mean ", seconds > 0.0 ? (double)(p->step - p->config.step_start) / seconds : 0.0,
         tail);
    fputc('\n', p->log->config.out);
    fflush(p->log->config.out);
  }
  bw_release(progress);
}
