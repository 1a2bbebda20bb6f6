/* Turbulent channel flow at Re_b = 5600 (FSI section 3, second test; figures 4a, 4b).
 *
 * From a perturbed parabola through transition; then statistics, in batches. Goes on after an
 * interruption with --restart OUT/checkpoint.h5, to the last bit.
 * Run:   mpirun -n 2 build/bin/channel_turbulence cases/channel_turbulence/channel_turbulence.yaml
 * BUILD modules=ns_channel,checkpoint */
#include "bw_stop.h"
#include "channel_case.h"

static bw_status save_statistics(channel_flow *f, const bw_case *run)
{
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  BW_TRY(channel_profiles(f, run));
  BW_TRY(channel_spectra(f, run));
  BW_TRY(bw_case_path(run, "statistics.h5", &path));
  bw_status st = bw_checkpoint_create(bw_grid_comm(f->grid), path, &ck);
  BW_THEN(st, channel_profiles_hdf5(f, ck));
  BW_THEN(st, channel_spectra_hdf5(f, ck));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  return st;
}

static bw_status save(channel_flow *f, const bw_case *run, bw_history *history)
{
  char *path = NULL;
  bw_status st = bw_history_sync(bw_grid_comm(f->grid), history);
  BW_THEN(st, bw_case_path(run, "checkpoint.h5", &path));
  f->rows = bw_history_rows(history);
  /* The checkpoint first: what was paid for is on disk before a table may fail. */
  BW_THEN(st, channel_save(f, path));
  BW_THEN(st, save_statistics(f, run));
  bw_release(&path);
  return st;
}

static bw_status run_to_end(channel_flow *f, const channel_case *c, const bw_case *run,
                            bw_history *history)
{
  const double interval = c->time.interval;
  int64_t end = 0, every = 0;
  (void)bw_divides(c->time.spin_up + c->time.statistics, interval, &end); /* checked before */
  /* So rare that it is never due: at the end. */
  if (!bw_to_int64(fmax(1.0, c->output.checkpoint_every / interval), &every)) every = end;
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_unit = "h/U_b", about.step_start = f->steps;
  about.time_start = (double)f->intervals * interval, about.time_end = (double)end * interval;
  bw_status st = bw_comm_agree(bw_case_args_of(run)->comm,
                               bw_progress_create(bw_case_log(run), &about, &line));
  while (st == BW_OK && !f->stopped && f->intervals < end) {
    /* One interval; everything but a stop happens between two. */
    st = channel_advance(f);
    if (st != BW_OK || f->stopped) break;
    const double re_tau = channel_record(f, history);
    bw_progress_update(line, f->steps, bw_ns_channel_time(f->fluid), "Re_tau %.1f, %ld samples",
                       re_tau, bw_ns_statistics_samples(f->statistics));
    if (f->intervals % every == 0 || f->intervals == end) st = save(f, run, history);
    f->stopped = f->intervals < end && bw_case_stopping(run);
  }
  bw_progress_finish(&line);
  if (st != BW_OK || !f->stopped) return st;
  /* Nothing of the run is lost. */
  BW_TRY(save(f, run, history));
  return bw_case_unfinished(run, "checkpoint.h5");
}

/* Whole intervals, as many as anybody can wait for. */
static bw_status check_times(const channel_case *c)
{
  const double total = c->time.spin_up + c->time.statistics;
  int64_t n = 0;
  BW_REQUIRE(bw_divides(total, c->time.interval, &n), BW_EINPUT,
             "time.spin_up + time.statistics is %g, %.6g times time.interval, %g; make it a whole "
             "number of intervals, from 1 to %g",
             total, total / c->time.interval, c->time.interval, (double)BW_MOST_STEPS);
  return BW_OK;
}

/* Of the bulk flow: turbulence takes more. */
static bw_status check_steps(const channel_case *c, double dt)
{
  const double total = c->time.spin_up + c->time.statistics;
  BW_REQUIRE(total / dt <= (double)BW_MOST_STEPS, BW_EINPUT,
             "time.spin_up + time.statistics = %g takes %.3g steps of %.3g, more than the %g that "
             "anybody can wait for: fluid.reynolds = %g is too small for an explicit viscous term, "
             "or the cells are too many",
             total, total / dt, dt, (double)BW_MOST_STEPS, c->fluid.reynolds);
  return BW_OK;
}

/* What will run, and whether it can; no memory for fields. */
static bw_status describe(const bw_comm *comm, const channel_config *config, const channel_case *c,
                          const bw_case *run)
{
  const bw_ns_channel_config fluid = channel_fluid_of(config);
  bw_grid *plan = NULL;
  bw_ns_plan known;
  bw_status st = channel_grid(comm, config, bw_grid_plan, &plan);
  BW_THEN(st, bw_ns_channel_plan(plan, &fluid, &known));
  BW_THEN(st, check_steps(c, known.dt_max));
  if (st == BW_OK) channel_describe(plan, &known, c, bw_case_log(run));
  bw_grid_destroy(&plan);
  return st;
}

static bw_status simulate(const bw_comm *comm, void *context, bw_case *run)
{
  const channel_case *c = context;
  const bw_case_args *args = bw_case_args_of(run);
  const channel_config config = channel_config_of(c);
  bw_history *history = NULL;
  channel_flow f = {0};
  BW_TRY(check_times(c));
  BW_TRY(describe(comm, &config, c, run));
  /* --check ends here: nothing was built. */
  if (args->check) return BW_OK;
  bw_status st = channel_create(comm, &config, &f);
  if (st == BW_OK) {
    bw_stop_install();
    st = args->restart != NULL ? channel_load(&f, args->restart) : channel_start(&f);
    f.run = run;
    if (args->restart != NULL)
      BW_THEN(st,
              bw_case_check_end(run, "time.spin_up + time.statistics",
                                c->time.spin_up + c->time.statistics, bw_ns_channel_time(f.fluid)));
    BW_THEN(st, channel_open_history(&f, run, &history));
    /* Again: a run that was killed after the checkpoint may not have written them. */
    if (args->restart != NULL) BW_THEN(st, save_statistics(&f, run));
    BW_THEN(st, run_to_end(&f, c, run, history));
    const bw_status closed = bw_history_close(comm, &history);
    BW_THEN(st, closed);
  }
  channel_destroy(&f);
  return st;
}

int main(int argc, char **argv)
{
  channel_case config = channel_case_default();
  const bw_case_about about = {"channel_turbulence", "turbulent flow between two walls",
                               channel_fields, sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
