/* The driver of the cases that break a specimen. */
#include "specimen_main.h"
#include "bw_number.h"
#include "bw_stop.h"
#include "specimen_output.h"
#include <math.h>

/* *stopped: asked to end early. */
static bw_status advance(specimen *p, const bw_case *run, bw_history *history, bool *stopped)
{
  const specimen_files *files = &p->config.output;
  int64_t steps = 0, drawn = -1;
  (void)bw_to_int64(ceil(p->config.time.end / p->config.time.step - 1e-9), &steps); /* checked */
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_start = 0.0, about.time_end = p->config.time.end, about.step_end = steps;
  bw_status st = bw_comm_agree(p->comm, bw_progress_create(bw_case_log(run), &about, &line));
  /* The state at t = 0. */
  BW_THEN(st, specimen_sample(p, history));
  while (st == BW_OK && !specimen_done(p) && !*stopped) {
    st = specimen_step(p);
    if (p->steps % files->sample_every == 0) BW_THEN(st, specimen_sample(p, history));
    if (p->steps % files->picture_every == 0) {
      BW_THEN(st, specimen_picture(p, run));
      drawn = p->steps;
    }
    bw_progress_update(line, p->steps, p->time, "crack %.1f mm", 1e3 * p->crack.reach);
    *stopped = st == BW_OK && !specimen_done(p) && bw_case_stopping(run);
  }
  bw_progress_finish(&line);
  /* The last state is always a row and a picture; a row that is there is not repeated. */
  BW_THEN(st, specimen_sample(p, history));
  if (drawn != p->steps) BW_THEN(st, specimen_picture(p, run));
  return st;
}

static bw_status simulate(const bw_comm *comm, void *context, bw_case *run)
{
  const specimen_config *config = context;
  const bw_case_args *args = bw_case_args_of(run);
  bw_history *history = NULL;
  specimen p;
  bool stopped = false;
  bw_stop_install();
  BW_TRY(specimen_plan(comm, config, bw_case_log(run)));
  /* --check ends before anything is built. */
  if (args->check) return BW_OK;
  bw_status st = specimen_create(comm, config, &p);
  if (st == BW_OK) {
    st = specimen_describe(&p, bw_case_log(run));
    BW_THEN(st, specimen_open_history(run, &history));
    BW_THEN(st, advance(&p, run, history, &stopped));
    /* The crack as it is at the end, and what was found of it. */
    BW_THEN(st, specimen_crack_file(&p, run));
    BW_THEN(st, specimen_summary(&p, bw_case_log(run)));
    const bw_status closed = bw_history_close(comm, &history);
    BW_THEN(st, closed);
    if (st == BW_OK && stopped) st = bw_case_unfinished(run, NULL);
  }
  specimen_destroy(&p);
  return st;
}

int specimen_main(int argc, char **argv, const char *name, const char *title)
{
  specimen_config config = specimen_default();
  const bw_case_about about = {name, title, specimen_fields, sizeof config, NULL};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
