/* A porous medium that breaks in a channel flow (POROUS chapters 5 and 6).
 *
 * Three phases in one run, each ending in a checkpoint: the medium is held until the flow has
 * settled; it deforms, with breakage off and settling damping; breakage on.
 * Run:   mpirun -n 2 build/bin/porous_breakup cases/porous_breakup/porous_breakup.yaml
 * BUILD modules=coupler,shape,solid_tools */
#include "bw_checkpoint.h"
#include "bw_stop.h"
#include "porous_case.h"

#include <stdio.h>

static bw_status run_phase(porous_run *p)
{
  const porous_phase *f = porous_phase_of(p->config, p->phase);
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.step_start = p->step, about.step_end = f->steps;
  about.time_start = bw_ns_channel_time(p->fluid);
  about.time_end = about.time_start + (double)(f->steps - p->step) * f->time_step;
  /* What the solid may do in this phase. */
  porous_enter_phase(p);
  bw_status st = bw_comm_agree(p->comm, bw_progress_create(bw_case_log(p->run), &about, &line));
  p->phase_done = p->step >= f->steps;
  for (bool done = p->phase_done; st == BW_OK && !done && !p->stopped;) {
    /* Probes are read only in steps that are measured. */
    bw_coupler_watch(p->coupler, porous_sample_due(p));
    BW_THEN(st, bw_coupler_step(p->coupler, f->time_step));
    if (st != BW_OK) break;
    bw_coupler_tell_limit(p->coupler, bw_case_log(p->run));
    p->step++, p->total_step++;
    st = porous_after_step(p);
    const double drop = porous_pressure_drop(p);
    bw_progress_update(line, p->step, bw_ns_channel_time(p->fluid),
                       "%s, pressure drop %.2f p0, %.0f broken bonds", porous_phase_name[p->phase],
                       drop, p->broken);
    /* A phase ends by its steps, or when the pressure drop rests. */
    done = p->step >= f->steps || porous_settled(p, drop);
    p->phase_done = done;
    /* The end of the run is no stop. */
    p->stopped = !(done && p->phase == PHASE_BREAKAGE) && bw_case_stopping(p->run);
  }
  bw_progress_finish(&line);
  return st;
}

/* The steady flow, and whether the solid can bear it. */
static void tell_drop(porous_run *p)
{
  static const double large = 0.1; /* strain beyond which bonds along straight lines are no model */
  const porous_config *q = p->config;
  const double drop = porous_pressure_drop(p), U = q->fluid.bulk_velocity;
  const double strain = drop * q->fluid.density * U * U / q->solid.young_modulus;
  bw_log_info(bw_case_log(p->run),
              "steady flow: pressure drop %.1f p0 (POROUS, with pores it does not print: 190)",
              drop);
  if (strain > large)
    bw_log_warn(bw_case_log(p->run),
                "the pressure drop is %.3g times Young's modulus: strains of that size are beyond "
                "the model; the solid is too soft for this stream",
                strain);
}

/* The checkpoint that the end of a phase writes. */
static void phase_checkpoint(int phase, char name[64])
{
  snprintf(name, 64, "checkpoint-%s.h5", porous_phase_name[phase]);
}

static bw_status end_phase(porous_run *p)
{
  const int phase = p->phase;
  const int64_t step = p->step;
  char name[64];
  if (p->stopped && !p->phase_done) return porous_checkpoint(p, "checkpoint-last.h5", false);
  if (phase == PHASE_FLOW) tell_drop(p);
  /* The state at the end, whatever the interval is; a row that is there is not repeated. */
  BW_TRY(porous_sample(p));
  bw_coupler_warn_end(p->coupler, bw_case_log(p->run));
  /* The checkpoint before pictures and tables, which may fail: the phase is paid for. It belongs to
   * the beginning of the next phase; the last one to its own end, from which a longer run goes
   * on. */
  phase_checkpoint(phase, name);
  if (phase != PHASE_BREAKAGE) p->phase++, p->step = 0;
  BW_TRY(porous_checkpoint(p, name, false));
  p->phase = phase, p->step = step;
  BW_TRY(porous_picture(p));
  if (phase != PHASE_FLOW) BW_TRY(porous_stress_csv(p));
  p->phase++;
  p->step = 0;
  return BW_OK;
}

/* A run that was stopped goes on from where it was: on the way through a phase, or at its end. */
static bw_status unfinished(const porous_run *p)
{
  char name[64] = "checkpoint-last.h5";
  if (p->phase_done) phase_checkpoint(p->phase - 1, name);
  return bw_case_unfinished(p->run, name);
}

/* The picture and the table that were due when the checkpoint was written, once more: a run that
 * was killed behind the checkpoint does not have them. */
static bw_status draw_again(porous_run *p)
{
  const int every = p->config->output.picture_every;
  const bool at_end = p->step == 0 && p->phase > PHASE_FLOW; /* of the phase before */
  if (!at_end && (every == 0 || p->step == 0 || p->step % every != 0)) return BW_OK;
  BW_TRY(porous_picture(p));
  if (!at_end || p->phase - 1 == PHASE_FLOW) return BW_OK;
  p->phase--;
  const bw_status st = porous_stress_csv(p);
  p->phase++;
  return st;
}

/* A checkpoint behind the end that is asked for is refused. */
static bw_status check_end(const porous_run *p)
{
  const int64_t steps = porous_phase_of(p->config, p->phase)->steps;
  char key[64];
  snprintf(key, sizeof key, "%s.steps", porous_phase_name[p->phase]);
  /* At its end a phase goes over into the next one; only the last one ends the run. */
  if (p->phase != PHASE_BREAKAGE && p->step <= steps) return BW_OK;
  return bw_case_check_end(p->run, key, (double)steps, (double)p->step);
}

static bw_status run_case(porous_run *p)
{
  const bw_case_args *args = bw_case_args_of(p->run);
  BW_TRY(porous_plan(p));
  /* --check ends before anything is built. */
  if (args->check) return BW_OK;
  BW_TRY(porous_build(p));
  BW_TRY(porous_describe(p));
  if (args->restart != NULL) {
    BW_TRY(porous_restart(p, args->restart));
    BW_TRY(check_end(p));
  }
  BW_TRY(porous_open_history(p));
  if (args->restart != NULL) BW_TRY(draw_again(p));
  /* The first good state, for a divergence in the first steps. */
  bw_status st = porous_keep(p);
  bw_stop_install();
  while (st == BW_OK && p->phase < PHASE_COUNT && !p->stopped) {
    st = run_phase(p);
    BW_THEN(st, end_phase(p));
  }
  /* Diverged: the last good state goes to disk, and the message says where. */
  if (st == BW_EDIVERGED || st == BW_ECFL) st = porous_save_last_good(p, st);
  BW_THEN(st, porous_fragments_csv(p));
  BW_THEN(st, porous_cost(p));
  if (st == BW_OK && p->stopped) st = unfinished(p);
  return st;
}

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  porous_run p = {.config = config, .run = run, .comm = comm};
  bw_status st = run_case(&p);
  const bw_status closed = bw_history_close(comm, &p.history);
  BW_THEN(st, closed);
  porous_destroy(&p);
  return st;
}

int main(int argc, char **argv)
{
  porous_config config = porous_config_default();
  const bw_case_about about = {"porous_breakup", "a porous medium that breaks in a channel flow",
                               porous_fields, sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
