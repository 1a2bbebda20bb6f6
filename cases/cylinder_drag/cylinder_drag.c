/* Drag of a cylinder in a plane channel by three routes (FSI, table 1; ERRATA 21, 23, 24).
 *
 * Run:   build/bin/cylinder_drag cases/cylinder_drag/cylinder_drag.yaml --out out/cylinder
 * BUILD modules=ns_channel,ibm_mdf,probe,vtk */
#include "bw_stop.h"
#include "cylinder_case.h"

/* Steps until `end`; fewer when the run is asked to stop. */
static bw_status interval(cylinder_flow *f, const bw_case *run, double end, bool *stopped,
                          int64_t *steps)
{
  for (double left = 1.0; left > 0.0 && !*stopped;) {
    BW_TRY(cylinder_step(f, end, &left));
    ++*steps;
    *stopped = left > 0.0 && bw_case_stopping(run);
  }
  return BW_OK;
}

/* Until the drag is steady, the time is over or somebody asks to stop. */
static bw_status advance(cylinder_flow *f, const cylinder_case *c, const bw_case *run,
                         bw_history *history, bool *stopped)
{
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_end = c->until.latest, about.time_unit = "d/U_b";
  bw_status st = bw_comm_agree(bw_case_args_of(run)->comm,
                               bw_progress_create(bw_case_log(run), &about, &line));
  double t = 0.0, last = HUGE_VAL;
  int64_t steps = 0;
  for (bool steady = false; st == BW_OK && !steady && !*stopped && t < c->until.latest;) {
    /* A sample per interval, the last one shorter where it would go beyond the end; steady is when
     * two of them agree. */
    const double span = fmin(c->until.interval, c->until.latest - t);
    st = interval(f, run, t + span, stopped, &steps);
    if (st != BW_OK) break;
    const cylinder_drag d = cylinder_measure(f);
    t = bw_ns_channel_time(f->flow.fluid);
    cylinder_sample(history, t, &d);
    steady = fabs(d.reaction - last) < c->until.steady * span * fabs(d.reaction);
    last = d.reaction;
    bw_progress_update(line, steps, t, "Cd %.4f", d.reaction);
    if (t > c->until.latest - 0.5 * f->flow.dt) break; /* the end, to rounding */
    *stopped = *stopped || (!steady && bw_case_stopping(run));
  }
  bw_progress_finish(&line);
  return st;
}

static void report(cylinder_flow *f, bw_log *log)
{
  const cylinder_drag d = cylinder_measure(f);
  bw_log_info(log,
              "drag coefficient at t = %.2f d/U_b\n  force of the markers      %.4f\n"
              "  momentum of the box       %.4f\n  probes, linear profile    %.4f\n"
              "  probes, parabola to wall  %.4f\nslip at the markers %.1e U_b",
              bw_ns_channel_time(f->flow.fluid), d.reaction, d.control_volume, d.probe[0],
              d.probe[1], d.slip);
  if (d.slip > 0.02)
    bw_log_warn(log,
                "slip at the markers is %.1f %% of U_b: the drag comes out too low; take a memory "
                "(cylinder.memory: 0.2), more iterations, or smaller steps",
                100.0 * d.slip);
}

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  const cylinder_case *c = config;
  const bw_case_args *args = bw_case_args_of(run);
  bw_history *history = NULL;
  cylinder_flow f;
  bool stopped = false;
  BW_TRY(cylinder_plan(comm, c, bw_case_log(run)));
  /* --check ends here: nothing of the case was built. */
  if (args->check) return BW_OK;
  bw_status st = cylinder_create(comm, &c->cylinder, &f);
  if (st == BW_OK) {
    bw_log_info(bw_case_log(run), "markers %s %.2f h inside",
                f.flow.nu > 0.0 ? "on the true surface," : "pulled in,", f.config.retraction);
    bw_stop_install();
    st = cylinder_open_history(run, &history);
    BW_THEN(st, advance(&f, c, run, history, &stopped));
    BW_THEN(st, cylinder_write(&f, run));
    if (st == BW_OK) report(&f, bw_case_log(run));
    const bw_status closed = bw_history_close(comm, &history);
    BW_THEN(st, closed);
    if (st == BW_OK && stopped) st = bw_case_unfinished(run, NULL);
  }
  cylinder_destroy(&f);
  return st;
}

int main(int argc, char **argv)
{
  cylinder_case config = cylinder_case_default();
  const bw_case_about about = {"cylinder_drag", "the drag of a cylinder in a channel, three ways",
                               cylinder_case_fields, sizeof config, NULL};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
