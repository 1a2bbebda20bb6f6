/* Flow in a box: six sides by name, explicit or implicit viscosity, forcing, vortices to start
 * from.
 *
 * Goes on after an interruption with --restart OUT/checkpoint.h5, to the last bit.
 * Run:   mpirun -n 2 build/bin/box_flow cases/box_flow/box_flow.yaml --out out/cavity
 * BUILD modules=ns_channel,vtk,checkpoint */
#include "box_case.h"
#include "bw_checkpoint.h"
#include "bw_number.h"
#include "bw_stop.h"

/* Is it time for what happens `every` so often (0: at the end only)? */
static bool due(const box_run *b, double every, bool last)
{
  int64_t times = 0;
  /* Checked with the other times: it divides. */
  if (every == 0.0 || !bw_divides(every, b->config->output.sample_every, &times)) return last;
  return last || b->intervals % times == 0;
}

/* Not stopped on the way through one? */
static bool between_intervals(const box_run *b)
{
  return bw_ns_channel_time(b->fluid) == (double)b->intervals * b->config->output.sample_every;
}

static bw_status after_interval(box_run *b, bool last)
{
  box_sample(b);
  /* The checkpoint first: what was paid for is on disk before a picture may fail. */
  if (due(b, b->config->output.checkpoint_every, last)) BW_TRY(box_checkpoint(b));
  if (due(b, b->config->output.picture_every, last)) BW_TRY(box_picture(b));
  return BW_OK;
}

static bw_status run_to_end(box_run *b)
{
  const int64_t end = box_intervals(b->config);
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_unit = "T", about.step_start = b->steps;
  about.time_start = bw_ns_channel_time(b->fluid), about.time_end = b->config->time.end;
  bw_status st = bw_comm_agree(bw_case_args_of(b->run)->comm,
                               bw_progress_create(bw_case_log(b->run), &about, &line));
  while (st == BW_OK && !b->stopped && b->intervals < end) {
    st = box_advance(b);
    if (st == BW_OK && !b->stopped) {
      st = after_interval(b, b->intervals == end);
      b->stopped = b->intervals < end && bw_case_stopping(b->run);
    }
    bw_progress_update(line, b->steps, bw_ns_channel_time(b->fluid), "dt %.3g", b->dt);
  }
  bw_progress_finish(&line);
  if (st != BW_OK || !b->stopped) return st;
  /* No row: the history of a run that was stopped is that of one that was not. */
  BW_TRY(box_checkpoint(b));
  return bw_case_unfinished(b->run, "checkpoint.h5");
}

/* What will run, and whether it can. */
static bw_status describe(const box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                          const bw_ns_channel_config *fluid)
{
  bw_grid *plan = NULL;
  bw_status st = box_plan(b, comm, grid, &plan);
  BW_THEN(st, box_describe(b, plan, fluid));
  bw_grid_destroy(&plan);
  return st;
}

static bw_status run_case(box_run *b, const bw_comm *comm, box_config *config)
{
  const bw_case_args *args = bw_case_args_of(b->run);
  bw_grid_config grid;
  bw_ns_channel_config fluid;
  /* All contradictions are found before anything exists. */
  BW_TRY(box_resolve(config, &grid, &fluid));
  BW_TRY(describe(b, comm, &grid, &fluid));
  /* --check ends here: nothing was built. */
  if (args->check) return BW_OK;
  BW_TRY(box_create(b, comm, &grid, &fluid));
  BW_TRY(box_start_field(b));
  if (args->restart != NULL) {
    BW_TRY(box_restart(b, args->restart));
    BW_TRY(bw_case_check_end(b->run, "time.end", config->time.end, bw_ns_channel_time(b->fluid)));
  }
  BW_TRY(box_open_history(b));
  /* The first row is the start itself; a restart has it already. */
  if (args->restart == NULL) {
    box_sample(b);
    BW_TRY(box_picture(b));
  } else if (between_intervals(b) && due(b, config->output.picture_every, false)) {
    /* Again: a run that was killed after the checkpoint may not have drawn it. */
    BW_TRY(box_picture(b));
  }
  bw_stop_install();
  return run_to_end(b);
}

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  box_run b = {.config = config, .run = run};
  bw_status st = run_case(&b, comm, config);
  const bw_status closed = bw_history_close(comm, &b.history);
  BW_THEN(st, closed);
  box_destroy(&b);
  return st;
}

int main(int argc, char **argv)
{
  box_config config = box_config_default();
  const bw_case_about about = {"box_flow", "incompressible flow in a box", box_fields,
                               sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
