/* Water in a tank, of particles: dam breaks, sloshing, water at rest, with blocks, gauges, and a
 * solid that bends, breaks or floats.
 *
 * Goes on after an interruption with --restart OUT/checkpoint.h5, to the last bit, on any number of
 * ranks.
 * Run:   mpirun -n 2 build/bin/dam_break cases/dam_break/dam_break.yaml --out out/dam_break
 * BUILD modules=coupler_particles,solid,ulph,vtk,checkpoint,shape */
#include "bw_checkpoint.h"
#include "bw_number.h"
#include "bw_stop.h"
#include "dam_case.h"

/* Is it time for what happens `every` so often (0: at the end only)? */
static bool due(const dam_run *d, double every, bool last)
{
  int64_t times = 0;
  /* Checked with the other times: it divides. */
  if (every == 0.0 || !bw_divides(every, d->config->output.sample_every, &times)) return last;
  return last || d->intervals % times == 0;
}

/* Not stopped on the way through one? */
static bool between_intervals(const dam_run *d)
{
  return bw_ulph_time(d->fluid) == (double)d->intervals * d->config->output.sample_every;
}

static bw_status after_interval(dam_run *d, bool last)
{
  BW_TRY(dam_sample(d));
  /* The checkpoint first: what was paid for is on disk before a picture may fail. */
  if (due(d, d->config->output.checkpoint_every, last)) BW_TRY(dam_checkpoint(d));
  if (due(d, d->config->output.picture_every, last)) BW_TRY(dam_picture(d));
  return BW_OK;
}

static bw_status run_to_end(dam_run *d)
{
  const int64_t end = dam_intervals(d->config);
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_unit = "T", about.step_start = bw_ulph_steps(d->fluid);
  about.time_start = bw_ulph_time(d->fluid), about.time_end = d->config->time.end;
  bw_status st = bw_comm_agree(d->comm, bw_progress_create(bw_case_log(d->run), &about, &line));
  while (st == BW_OK && !d->stopped && d->intervals < end) {
    st = dam_advance(d);
    if (st == BW_OK && !d->stopped) {
      st = after_interval(d, d->intervals == end);
      d->stopped = d->intervals < end && bw_case_stopping(d->run);
    }
    bw_progress_update(line, bw_ulph_steps(d->fluid), bw_ulph_time(d->fluid), "dt %.3g", d->dt);
  }
  bw_progress_finish(&line);
  if (st != BW_OK || !d->stopped) return st;
  /* No row: the history of a run that was stopped is that of one that was not. */
  BW_TRY(dam_checkpoint(d));
  return bw_case_unfinished(d->run, "checkpoint.h5");
}

static bw_status run_case(dam_run *d)
{
  const bw_case_args *args = bw_case_args_of(d->run);
  bw_ulph_config fluid;
  BW_TRY(dam_resolve(d->config, &fluid));
  BW_TRY(dam_plan(d, &fluid));
  /* --check ends here: nothing of the case is kept. */
  if (args->check) return BW_OK;
  BW_TRY(dam_create(d, &fluid));
  if (args->restart != NULL) {
    BW_TRY(dam_restart(d, args->restart));
    BW_TRY(bw_case_check_end(d->run, "time.end", d->config->time.end, bw_ulph_time(d->fluid)));
  }
  BW_TRY(dam_open_history(d));
  /* The first row is the start itself; a restart has it already. */
  if (args->restart == NULL) {
    BW_TRY(dam_sample(d));
    BW_TRY(dam_picture(d));
  } else if (between_intervals(d) && due(d, d->config->output.picture_every, false)) {
    /* Again: a run that was killed after the checkpoint may not have drawn it. */
    BW_TRY(dam_picture(d));
  }
  bw_stop_install();
  return run_to_end(d);
}

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  dam_run d = {.config = config, .run = run, .comm = comm};
  bw_status st = run_case(&d);
  const bw_status closed = bw_history_close(comm, &d.history);
  BW_THEN(st, closed);
  dam_destroy(&d);
  return st;
}

int main(int argc, char **argv)
{
  dam_config config = dam_config_default();
  const bw_case_about about = {"dam_break", "water of particles in a tank, and a solid in it",
                               dam_fields, sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
