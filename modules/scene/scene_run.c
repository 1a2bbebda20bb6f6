/* The run of a scene as a case: history, pictures, profiles, checkpoints, what is watched. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_number.h"
#include "bw_stop.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a run holds besides its scene. */
typedef struct {
  bw_scene *scene;
  bw_case *run; /* borrowed */
  bw_history *history;
  double sample, picture, checkpoint; /* intervals [T]; 0: at the end only */
  double checkpoint_wall;             /* [s] */
  double written;                     /* wall clock of the last checkpoint [s] */
  double *row;
  int64_t rows; /* when the checkpoint was written */
  bool stopped; /* asked to end early */
  bool limited; /* a limit of `watch` ended it */
} driver;

/* The next multiple of an interval after now; INFINITY: there is none. */
static double next_of(double every, double now)
{
  return every > 0.0 ? (floor(now / every + 1e-9) + 1.0) * every : INFINITY;
}

/* Is now a multiple of it? */
static bool due(double every, double now)
{
  return every > 0.0 && fabs(now / every - round(now / every)) < 1e-9 && now > 0.0;
}

/* Steps end where something is written: an interval far below the step that the scene bears would
 * never come to an end. 0 and NaN: never, or chosen. */
static bw_status check_interval(const driver *r, const char *key, double every, double most)
{
  static const double least = 1e-6; /* of the longest stable step */
  const double end = bw_scene__end(r->scene), limit = bw_scene__limit(r->scene);
  BW_REQUIRE(!(every > 0.0) || isnan(end) || end / every < most, BW_EINPUT,
             "%s = %g: %.3g times to the end at %g; take a longer one", key, every, end / every,
             end);
  BW_REQUIRE(!(every > 0.0) || every > least * limit, BW_EINPUT,
             "%s = %g is %.3g of the longest stable step, %g; take a longer one", key, every,
             every / limit, limit);
  return BW_OK;
}

static bw_status check_intervals(const driver *r)
{
  /* Rows that a table still holds; files that a folder does. */
  static const double rows = 1e9, files = 1e6;
  const bw_scene_config *c = &r->scene->config;
  BW_TRY(check_interval(r, "output.sample_every", c->output.sample_every, rows));
  BW_TRY(check_interval(r, "output.picture_every", c->output.picture_every, files));
  BW_TRY(check_interval(r, "output.checkpoint_every", r->checkpoint, files));
  for (int g = 0; g < c->n_gauges; g++) {
    char key[128];
    snprintf(key, sizeof key, "gauges.%s.every", c->gauges[g].name);
    BW_TRY(check_interval(r, key, c->gauges[g].every, files));
  }
  return BW_OK;
}

static bw_status set_intervals(driver *r)
{
  const bw_scene_output *o = &r->scene->config.output;
  char *unit = NULL;
  const double every = strtod(o->checkpoint_every, &unit), end = bw_scene__end(r->scene);
  r->picture = o->picture_every;
  r->sample = o->sample_every;
  /* Two hundred rows, or one every fifty steps where the end is not known. */
  if (isnan(r->sample)) r->sample = isnan(end) ? 50.0 * bw_scene__limit(r->scene) : end / 200.0;
  const bool number = unit != o->checkpoint_every && isfinite(every);
  unit += strspn(unit, " ");
  BW_REQUIRE(
      number && every >= 0.0 && (*unit == '\0' || strcmp(unit, "s") == 0), BW_EINPUT,
      "output.checkpoint_every = %s: must be a time of the wall clock, as 600 s, or a number "
      "in units of the scene's time",
      o->checkpoint_every);
  if (*unit == 's')
    r->checkpoint_wall = every;
  else
    r->checkpoint = every;
  return check_intervals(r);
}

static double next_event(const driver *r)
{
  const double now = r->scene->time;
  double next = fmin(next_of(r->sample, now), next_of(r->picture, now));
  for (int g = 0; g < r->scene->config.n_gauges; g++)
    if (r->scene->config.gauges[g].has_line || r->scene->config.gauges[g].has_slice)
      next = fmin(next, next_of(r->scene->config.gauges[g].every, now));
  return fmin(next, next_of(r->checkpoint, now));
}

static bw_status checkpoint(driver *r)
{
  const double rows = (double)bw_history_rows(r->history);
  const bw_comm *comm = r->scene->comm;
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  bw_status st = bw_history_sync(comm, r->history);
  BW_THEN(st, bw_case_path(r->run, "checkpoint-last.h5", &path));
  BW_THEN(st, bw_checkpoint_create(comm, path, &ck));
  BW_THEN(st, bw_checkpoint_put_case(ck, r->run));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "case/rows", 1, &rows));
  BW_THEN(st, bw_scene_save(r->scene, ck));
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  r->written = bw_wall_time();
  return st;
}

static bw_status restart(driver *r, const char *path)
{
  double rows = 0.0;
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_open(r->scene->comm, path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "case/rows", 1, &rows);
  BW_THEN(st, bw_scene_restore(r->scene, ck));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  BW_TRY(st);
  BW_REQUIRE(bw_to_int64(rows, &r->rows), BW_EINPUT, "%s: 'case/rows' is no number of rows", path);
  return BW_OK;
}

/* A row of the history, and the limits of what is watched. */
static bw_status sample(driver *r)
{
  bw_scene *s = r->scene;
  bw_scene__warn_speed(s);
  BW_TRY(bw_scene_measure(s, r->row));
  bw_history_append(r->history, r->row);
  for (int k = 0; k < s->config.n_watch && !r->limited; k++) {
    const bw_scene_watch *w = &s->config.watch[k];
    const double x = r->row[bw_scene__column_named(s, w->name)];
    if (!(x > w->above || x < w->below)) continue;
    r->limited = true;
    bw_log_info(s->log, "watch.%s: %g is %s %g at t = %g: the run ends here", w->name, x,
                x > w->above ? "above" : "below", x > w->above ? w->above : w->below, s->time);
  }
  return BW_OK;
}

/* Has the wall clock of rank 0 come to the next checkpoint? Asked of all in every 16th step. */
static bool wall_due(const driver *r)
{
  if (r->checkpoint_wall <= 0.0 || r->scene->steps % 16 != 0) return false;
  int64_t over = bw_wall_time() - r->written > r->checkpoint_wall;
  bw_comm_broadcast(r->scene->comm, sizeof over, &over);
  return over != 0;
}

static bw_status after_step(driver *r)
{
  bw_scene *s = r->scene;
  const bool over = bw_scene_done(s);
  if (due(r->sample, s->time) || over) BW_TRY(sample(r));
  for (int g = 0; g < s->config.n_gauges; g++)
    if ((s->config.gauges[g].has_line || s->config.gauges[g].has_slice) &&
        due(s->config.gauges[g].every, s->time))
      BW_TRY(bw_scene__profiles(s, r->run, g));
  /* The checkpoint first: what was paid for is on disk before a picture may fail. */
  if (due(r->checkpoint, s->time) || wall_due(r)) BW_TRY(checkpoint(r));
  if (due(r->picture, s->time) && !over) BW_TRY(bw_scene_picture(s, r->run));
  return BW_OK;
}

/* The picture that was due when the checkpoint was written, once more: a run that was killed behind
 * the checkpoint does not have it. The last one of a run follows anyway. */
static bw_status draw_again(driver *r)
{
  const bw_scene *s = r->scene;
  if (!due(r->picture, s->time) || bw_scene_done(s)) return BW_OK;
  return bw_scene_picture(r->scene, r->run);
}

static bw_status advance(driver *r)
{
  bw_scene *s = r->scene;
  const double end = bw_scene__end(s);
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_start = s->time, about.time_end = end, about.step_start = s->steps;
  about.time_unit = "T";
  bw_status st = bw_comm_agree(s->comm, bw_progress_create(s->log, &about, &line));
  if (s->steps == 0) BW_THEN(st, sample(r));
  while (st == BW_OK && !bw_scene_done(s) && !r->stopped && !r->limited) {
    const double event = next_event(r);
    const int phase = s->phase;
    /* Probes are read only in steps that are measured: the last one before a row, or any that may
     * end a phase. */
    const double next = s->time + 1.0001 * bw_scene__limit(s);
    bw_scene_expect(s, next >= event || isnan(end) || next >= end);
    st = bw_scene_step(s, event);
    BW_THEN(st, after_step(r));
    if (st == BW_OK && s->phase != phase && !bw_scene_done(s))
      bw_log_info(s->log, "phase %d%s%s begins at t = %g", s->phase,
                  s->config.phases[s->phase].name[0] != '\0' ? ", " : "",
                  s->config.phases[s->phase].name, s->time);
    bw_progress_update(line, s->steps, s->time, "step %.3g", s->dt);
    r->stopped = st == BW_OK && !bw_scene_done(s) && bw_case_stopping(r->run);
  }
  bw_progress_finish(&line);
  return st;
}

static bw_status check_watch(const bw_scene *s)
{
  char known[512];
  for (int k = 0; k < s->config.n_watch; k++) {
    const char *name = s->config.watch[k].name;
    bw_scene__column_names(s, name, sizeof known, known);
    BW_REQUIRE(bw_scene__column_named(s, name) > 0, BW_EINPUT,
               "watch.%s: there is no such component; %s%s", name,
               known[0] != '\0' ? "there are: " : "a line or a slice has files of its own", known);
  }
  return BW_OK;
}

static bw_status run_scene(driver *r, const bw_scene_config *config)
{
  const bw_case_args *args = bw_case_args_of(r->run);
  bw_log *log = bw_case_log(r->run);
  BW_TRY(bw_scene__create(args->comm, config, log, args->check, &r->scene));
  bw_scene *s = r->scene;
  BW_TRY(check_watch(s));
  BW_TRY(bw_scene__check_sizes(s));
  BW_TRY(set_intervals(r));
  BW_TRY(bw_scene_describe(s, log));
  /* --check ends here: all was looked at, nothing large was made. */
  if (args->check) return BW_OK;
  if (args->restart != NULL) BW_TRY(restart(r, args->restart));
  /* Where the end is a time, the checkpoint may lie behind it. */
  if (!isnan(bw_scene__end(s)))
    BW_TRY(bw_case_check_end(r->run, "phases.until.time", bw_scene__end(s), s->time));
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&r->row, (size_t)s->n_columns)));
  BW_TRY(bw_case_history(r->run, s->n_columns, s->names, s->time, r->rows, &r->history));
  if (args->restart != NULL) BW_TRY(draw_again(r));
  bw_stop_install();
  r->written = bw_wall_time();
  BW_TRY(advance(r));
  /* The last state, whatever the intervals were. */
  BW_TRY(checkpoint(r));
  if (r->stopped) return bw_case_unfinished(r->run, "checkpoint-last.h5");
  BW_TRY(bw_scene_picture(s, r->run));
  BW_TRY(bw_scene__warn_leak(s));
  bw_scene__cost_tell(s, &s->cost, "", log);
  return bw_scene__watch_report(s, r->run, log);
}

bw_status bw_scene_run(const bw_comm *comm, void *config, bw_case *run)
{
  driver r = {.run = run};
  bw_status st = run_scene(&r, config);
  /* Closed also after a failure, so that the rows until then are on disk. */
  const bw_status closed = bw_history_close(comm, &r.history);
  BW_THEN(st, closed);
  bw_release(&r.row);
  bw_scene_destroy(&r.scene);
  return st;
}
