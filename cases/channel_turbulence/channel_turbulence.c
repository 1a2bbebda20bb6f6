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

static bw_status save(channel_flow *f, const bw_case *run)
{
  char *path = NULL;
  bw_status st = bw_case_path(run, "checkpoint.h5", &path);
  BW_THEN(st, channel_save(f, path));
  BW_THEN(st, save_statistics(f, run));
  bw_release(&path);
  return st;
}

static bw_status run_to_end(channel_flow *f, const channel_case *c, const bw_case *run,
                            bw_history *history)
{
  const bw_comm *comm = bw_grid_comm(f->grid);
  const double interval = c->time.interval;
  const int64_t end = llround((c->time.spin_up + c->time.statistics) / interval);
  const int64_t every = (int64_t)fmax(1.0, round(c->output.checkpoint_every / interval));
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_unit = "h/U_b", about.step_start = f->steps;
  about.time_start = (double)f->intervals * interval, about.time_end = (double)end * interval;
  bw_status st = bw_comm_agree(comm, bw_progress_create(bw_case_log(run), &about, &line));
  for (bool stop = false; st == BW_OK && !stop && f->intervals < end;) {
    /* One interval; everything else happens between two. */
    st = channel_advance(f);
    if (st != BW_OK) break;
    const double re_tau = channel_record(f, history);
    bw_progress_update(line, f->steps, bw_ns_channel_time(f->fluid), "Re_tau %.1f, %ld samples",
                       re_tau, bw_ns_statistics_samples(f->statistics));
    stop = bw_stop_requested(comm);
    /* Also when asked to stop: nothing of the run is lost. */
    if (stop || f->intervals % every == 0 || f->intervals == end) st = save(f, run);
    if (stop) bw_log_warn(bw_case_log(run), "asked to stop: continue with --restart checkpoint.h5");
  }
  bw_progress_finish(&line);
  return st;
}

static bw_status simulate(const bw_comm *comm, void *context, bw_case *run)
{
  const channel_case *c = context;
  const bw_case_args *args = bw_case_args_of(run);
  const channel_config config = channel_config_of(c);
  bw_history *history = NULL;
  channel_flow f;
  bw_status st = channel_create(comm, &config, &f);
  if (st == BW_OK) channel_describe(&f, c, bw_case_log(run));
  /* --check has built and described everything, and ends. */
  if (st == BW_OK && !args->check) {
    bw_stop_install();
    st = args->restart != NULL ? channel_load(&f, args->restart) : channel_start(&f);
    const double from = args->restart != NULL ? bw_ns_channel_time(f.fluid) : (double)NAN;
    BW_THEN(st, channel_open_history(comm, run, from, &history));
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
                               channel_fields, sizeof config};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
