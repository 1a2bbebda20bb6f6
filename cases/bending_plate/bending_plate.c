/* An elastic plate on the wall of a channel, bent by the stream (FSI section 3, last test).
 *
 * Run:   build/bin/bending_plate cases/bending_plate/bending_plate.yaml --out out/bending
 * BUILD modules=coupler,vtk,shape */
#include "bending_case.h"
#include "bw_checkpoint.h"
#include "bw_stop.h"

/* What is due after a step: samples, pictures, checkpoints. */
static bw_status after_step(bending_run *p, bending_measure *m)
{
  enum { KEEP_EVERY = 50 }; /* a window of the book of the coupling */
  const bending_output *out = &p->config->output;
  /* Good states first; one in which the book looks wrong is none. */
  if (p->step % KEEP_EVERY == 0 && bw_coupler_sound(p->flow.coupler)) BW_TRY(bending_keep(p));
  if (p->step % out->sample_every == 0) BW_TRY(bending_sample(p, m));
  /* 0 leaves checkpoints and pictures to the end of the run. The checkpoint first: what was paid
   * for is on disk before a picture may fail. */
  if (out->checkpoint_every > 0 && p->step % out->checkpoint_every == 0)
    BW_TRY(bending_checkpoint(p));
  if (out->picture_every > 0 && p->step % out->picture_every == 0) BW_TRY(bending_picture(p));
  return BW_OK;
}

/* *stopped: the run was asked to end early. */
static bw_status advance(bending_run *p, bool *stopped)
{
  const bending_time *time = &p->config->time;
  bending_measure m = {.slip = NAN};
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.step_start = p->step, about.step_end = p->end;
  about.time_start = (double)p->step * time->step, about.time_end = time->end;
  bw_status st =
      bw_comm_agree(p->flow.comm, bw_progress_create(bw_case_log(p->run), &about, &line));
  while (st == BW_OK && p->step < p->end && !*stopped) {
    const int64_t next = p->step + 1;
    /* The plate is held while the flow starts, then let go. */
    bw_coupler_hold_solid(p->flow.coupler, p->step < p->release);
    /* Probes are read only in steps that are measured. */
    bw_coupler_watch(p->flow.coupler, next % p->config->output.sample_every == 0 || next == p->end);
    st = bw_coupler_step(p->flow.coupler, time->step);
    p->step += st == BW_OK;
    bw_coupler_tell_limit(p->flow.coupler, bw_case_log(p->run));
    BW_THEN(st, after_step(p, &m));
    bw_progress_update(line, p->step, bw_ns_channel_time(p->flow.fluid),
                       "tip %.4f heights, force %.4g N/m", m.tip[0] / p->flow.config.plate.height,
                       m.box[0]);
    *stopped = p->step < p->end && bw_case_stopping(p->run);
  }
  bw_progress_finish(&line);
  /* The last state is always a row, whatever the interval is; one that is there is not repeated. */
  if (!*stopped) BW_THEN(st, bending_sample(p, &m));
  return st;
}

static bw_status run_case(bending_run *p, const bw_comm *comm)
{
  const bw_case_args *args = bw_case_args_of(p->run);
  bool stopped = false;
  BW_TRY(bending_plan(p));
  /* --check ends here: nothing was built. */
  if (args->check) return BW_OK;
  BW_TRY(bending_create(comm, &p->config->physics, &p->flow));
  if (args->restart != NULL) {
    BW_TRY(bending_restart(p, args->restart));
    const double step = p->config->time.step; /* the checkpoint's, too: it may not change */
    BW_TRY(bw_case_check_end(p->run, "time.end", (double)p->end * step, (double)p->step * step));
  }
  /* A history that goes on is cut at the time of the checkpoint. */
  BW_TRY(bending_open_history(p));
  /* A run that was killed behind its checkpoint has not drawn the picture that was due. */
  const int every = p->config->output.picture_every;
  if (args->restart != NULL && every > 0 && p->step % every == 0) BW_TRY(bending_picture(p));
  bw_stop_install();
  /* The first good state, for a divergence in the first steps. */
  bw_status st = bending_keep(p);
  BW_THEN(st, advance(p, &stopped));
  if (st == BW_EDIVERGED || st == BW_ECFL) st = bending_save_last_good(p, st);
  BW_TRY(st);
  /* The last state, whatever the intervals were. */
  BW_TRY(bending_checkpoint(p));
  if (stopped) return bw_case_unfinished(p->run, "checkpoint-last.h5");
  BW_TRY(bending_picture(p));
  bw_coupler_warn_end(p->flow.coupler, bw_case_log(p->run));
  return bw_timer_report(bw_coupler_timer(p->flow.coupler), comm, bw_case_log(p->run));
}

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  bending_run p = {.config = config, .comm = comm, .run = run};
  bw_status st = run_case(&p, comm);
  /* Closed also after a failure, so that the rows until then are on disk. */
  const bw_status closed = bw_history_close(comm, &p.history);
  BW_THEN(st, closed);
  bending_destroy(&p.flow);
  return st;
}

int main(int argc, char **argv)
{
  bending_case config = bending_case_default();
  const bw_case_about about = {"bending_plate", "an elastic plate bent by a channel flow",
                               bending_case_fields, sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
