/* A crack in a glass plate runs from its notch and branches (FSI section 3, figures 2 and 3).
 *
 * Run:   build/bin/crack_branching cases/crack_branching/crack_branching.yaml --out out/crack
 * BUILD modules=pd_bond,pd_interface,vtk */
#include "bw_stop.h"
#include "plate_output.h"
#include <math.h>

static bw_status advance(plate *p, const crack_case *config, const bw_case *run,
                         bw_history *history)
{
  const int64_t steps = (int64_t)ceil(p->config.time.end / p->config.time.step - 1e-9);
  bw_progress *line = NULL;
  bw_progress_config about = bw_progress_config_default();
  about.time_start = 0.0, about.time_end = p->config.time.end, about.step_end = steps;
  bw_status st = bw_progress_create(bw_case_log(run), &about, &line);
  plate_sample(p, history);
  while (st == BW_OK && p->steps < steps && !bw_stop_requested(p->comm)) {
    st = plate_step(p);
    if (st == BW_OK && p->steps % config->output.sample_every == 0) plate_sample(p, history);
    if (p->steps % config->output.picture_every == 0) BW_THEN(st, plate_picture(p, run));
    bw_progress_update(line, p->steps, p->time, "crack tip %.1f mm", 1e3 * p->crack.tip);
  }
  bw_progress_finish(&line);
  return st;
}

static bw_status simulate(const bw_comm *comm, const crack_case *config, const bw_case *run)
{
  const plate_config c = crack_case_plate(config);
  const bw_case_args *args = bw_case_args_of(run);
  bw_history *history = NULL;
  plate p;
  BW_REQUIRE(args->restart == NULL, BW_EUSAGE,
             "--restart: this case takes seconds and writes no checkpoints; run it from the start");
  bw_status st = plate_create(comm, &c, &p);
  if (st == BW_OK) plate_describe(&p, bw_case_log(run));
  if (st == BW_OK && !args->check) {
    bw_stop_install();
    st = plate_open_history(&p, run, &history);
    BW_THEN(st, advance(&p, config, run, history));
    BW_THEN(st, plate_summary(&p, bw_case_log(run)));
    BW_THEN(st, bw_history_close(comm, &history));
  }
  plate_destroy(&p);
  return st;
}

int main(int argc, char **argv)
{
  crack_case config = crack_case_default();
  const bw_case_about about = {"crack_branching", "a crack that branches in a notched glass plate",
                               crack_case_fields, sizeof config};
  bw_comm *world = NULL;
  bw_case *run = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, bw_case_begin(world, argc, argv, &about, &config, &run));
  if (st == BW_OK && !bw_case_args_of(run)->stop) st = simulate(world, &config, run);
  st = bw_case_end(world, &run, st);
  return bw_finish(&world, st);
}
