/* What the bending plate writes: log, history.csv, VTK files, checkpoints. */
#include "bending_case.h"
#include "bw_checkpoint.h"
#include "bw_number.h"
#include "bw_vtk.h"

#include <stdio.h>

/* Whole steps: times that are multiples of the step are met in spite of rounding. */
static bw_status steps_until(const char *key, double time, double step, int64_t *steps)
{
  const double count = ceil(time / step - 1e-9);
  BW_REQUIRE(bw_to_int64(count, steps) && *steps <= BW_MOST_STEPS, BW_EINPUT,
             "time.%s = %g takes %.3g steps of time.step = %g, more than the %g that anybody can "
             "wait for; take a larger step",
             key, time, count, step, (double)BW_MOST_STEPS);
  return BW_OK;
}

bw_status bending_count_steps(bending_run *p)
{
  const bending_time *time = &p->config->time;
  BW_TRY(steps_until("end", time->end, time->step, &p->end));
  return steps_until("release", time->release, time->step, &p->release);
}

static const char *const columns[] = {"time[s]",
                                      "tip_x_over_height[-]",
                                      "tip_y_over_height[-]",
                                      "force_reaction_x[N/m]",
                                      "force_reaction_y[N/m]",
                                      "force_probe_x[N/m]",
                                      "force_probe_y[N/m]",
                                      "force_control_volume_x[N/m]",
                                      "force_control_volume_y[N/m]",
                                      "energy_kinetic[J/m]",
                                      "energy_elastic[J/m]",
                                      "dissipated_by_damping[J/m]",
                                      "work_received_by_plate[J/m]",
                                      "work_given_by_fluid[J/m]",
                                      "slip_rms_over_U_b[-]",
                                      "probes_blocked[-]",
                                      "leak_over_flux_past[-]"};

bw_status bending_open_history(bending_run *p)
{
  return bw_case_history(p->run, sizeof columns / sizeof *columns, columns,
                         bw_ns_channel_time(p->flow.fluid), p->rows, &p->history);
}

bw_status bending_sample(bending_run *p, bending_measure *m)
{
  const double H = p->flow.config.plate.height, U = p->flow.config.fluid.bulk_velocity;
  BW_TRY(bending_look(&p->flow, m));
  const double row[sizeof columns / sizeof *columns] = {bw_ns_channel_time(p->flow.fluid),
                                                        m->tip[0] / H,
                                                        m->tip[1] / H,
                                                        m->reaction[0],
                                                        m->reaction[1],
                                                        m->probe[0],
                                                        m->probe[1],
                                                        m->box[0],
                                                        m->box[1],
                                                        m->kinetic,
                                                        m->elastic,
                                                        m->damping,
                                                        m->received,
                                                        m->given,
                                                        m->slip / U,
                                                        (double)m->blocked,
                                                        m->report.leak};
  bw_coupler_warn_slip(p->flow.coupler, &m->report, bw_case_log(p->run));
  bw_coupler_warn_load(p->flow.coupler, &m->report, bw_case_log(p->run));
  bw_history_append(p->history, row);
  return BW_OK;
}

static bw_status write_plate(bending_run *p, const char *path)
{
  const size_t n = p->flow.n;
  double *U = NULL, *V = NULL, *damage = NULL;
  bw_status st = BW_ALLOCATE(&U, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&damage, n));
  /* Writing is collective: nobody goes on alone. */
  st = bw_comm_agree(p->flow.comm, st);
  if (st == BW_OK) {
    bw_solid_get_position(p->flow.solid, p->flow.X);
    bw_solid_get_velocity(p->flow.solid, V);
    bw_solid_get_damage(p->flow.solid, damage);
    for (size_t i = 0; i < 3 * n; i++)
      U[i] = p->flow.X[i] - p->flow.X0[i];
    const bw_vtk_array arrays[] = {{"damage", BW_VTK_FLOAT64, 1, damage},
                                   {"velocity", BW_VTK_FLOAT64, 3, V},
                                   {"displacement", BW_VTK_FLOAT64, 3, U}};
    st = bw_vtk_write_points(p->flow.comm, path, bw_ns_channel_time(p->flow.fluid), n, p->flow.X, 3,
                             arrays);
  }
  bw_release(&U);
  bw_release(&V);
  bw_release(&damage);
  return st;
}

static bw_status write_fluid(bending_run *p, const char *path)
{
  bw_real *const *u = bw_ns_channel_velocity(p->flow.fluid), *solid = NULL;
  bw_status st = bw_comm_agree(p->flow.comm, bw_field_create(p->flow.grid, &solid));
  /* 1 where a particle is: what moves inside the plate is no flow. */
  if (st == BW_OK) {
    bw_solid_get_position(p->flow.solid, p->flow.X);
    st = bw_grid_mark(p->flow.grid, p->flow.n, p->flow.X, NULL, solid);
  }
  const bw_vtk_field fields[] = {
      {.name = "velocity", .data = {u[0], u[1], u[2]}, .staggered = true},
      {.name = "pressure",
       .data = {bw_ns_channel_pressure(p->flow.fluid)},
       .scale = p->flow.config.fluid.density},
      {.name = "solid", .data = {solid}}};
  BW_THEN(st, bw_vtk_write_grid(p->flow.grid, path, bw_ns_channel_time(p->flow.fluid), 3, fields));
  bw_release(&solid);
  return st;
}

/* One file of the series `what` at the present time. */
static bw_status add_to_series(bending_run *p, const char *what, const char *extension,
                               bw_status (*write)(bending_run *, const char *))
{
  char name[64], series[64], *path = NULL, *series_path = NULL;
  snprintf(name, sizeof name, "%s-%08lld.%s", what, (long long)p->step, extension);
  snprintf(series, sizeof series, "%s.pvd", what);
  bw_status st = bw_case_path(p->run, name, &path);
  BW_THEN(st, bw_case_path(p->run, series, &series_path));
  /* The series names the file only after it is there. */
  BW_THEN(st, write(p, path));
  const double time = bw_ns_channel_time(p->flow.fluid);
  BW_THEN(st, bw_vtk_series_add(p->flow.comm, series_path, time, name));
  bw_release(&path);
  bw_release(&series_path);
  return st;
}

bw_status bending_picture(bending_run *p)
{
  BW_TRY(add_to_series(p, "fluid", "vti", write_fluid));
  return add_to_series(p, "plate", "vtp", write_plate);
}

static void progress_of(const bending_run *p, double progress[2])
{
  progress[0] = (double)p->step;
  progress[1] = (double)bw_history_rows(p->history);
}

/* `kept`: the last good state, else the present one. */
static bw_status write_checkpoint(bending_run *p, const char *name, bool kept)
{
  double progress[2];
  progress_of(p, progress);
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  bw_status st = bw_history_sync(p->flow.comm, p->history);
  BW_THEN(st, bw_case_path(p->run, name, &path));
  BW_THEN(st, bw_checkpoint_create(p->flow.comm, path, &ck));
  BW_THEN(st, bw_checkpoint_put_case(ck, p->run));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "case/progress", 2, kept ? p->kept : progress));
  BW_THEN(st,
          kept ? bw_coupler_save_kept(p->flow.coupler, ck) : bw_coupler_save(p->flow.coupler, ck));
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  return st;
}

bw_status bending_checkpoint(bending_run *p)
{
  return write_checkpoint(p, "checkpoint-last.h5", false);
}

bw_status bending_keep(bending_run *p)
{
  progress_of(p, p->kept);
  return bw_coupler_keep(p->flow.coupler);
}

bw_status bending_save_last_good(bending_run *p, bw_status cause)
{
  char what[1024];
  /* The message of the failure, before saving replaces it. */
  snprintf(what, sizeof what, "%s", bw_last_message());
  BW_TRY(write_checkpoint(p, "checkpoint-good.h5", true));
  return BW_FAIL(cause, "step %lld: %s; the last good state, step %.0f, is in checkpoint-good.h5",
                 (long long)p->step + 1, what, p->kept[0]);
}

bw_status bending_restart(bending_run *p, const char *path)
{
  double progress[2] = {0.0, 0.0};
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_open(p->flow.comm, path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "case/progress", 2, progress);
  /* Fluid, solid and load as they were saved. */
  BW_THEN(st, bw_coupler_load(p->flow.coupler, ck));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  if (st != BW_OK) return st;
  BW_REQUIRE(bw_to_int64(progress[0], &p->step) && bw_to_int64(progress[1], &p->rows), BW_EINPUT,
             "%s: 'case/progress' holds numbers that no run has", path);
  return BW_OK;
}
