/* What the porous medium writes: history.csv, VTK files, checkpoints, fragments.csv. */
#include "bw_memory.h"
#include "bw_number.h"
#include "bw_vtk.h"
#include "porous_case.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bw_status porous_open_history(porous_run *p)
{
  return bw_case_history(p->run, COL_COUNT, porous_columns, bw_ns_channel_time(p->fluid), p->rows,
                         &p->history);
}

bw_status porous_sample(porous_run *p)
{
  double row[COL_COUNT] = {0};
  BW_TRY(porous_measure(p, row));
  bw_history_append(p->history, row);
  p->broken = row[COL_BROKEN];
  return BW_OK;
}

static bw_status write_fluid(porous_run *p, const char *path)
{
  bw_real *const *u = bw_ns_channel_velocity(p->fluid), *solid = NULL;
  const size_t n = bw_solid_count(p->solid);
  double *X = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, bw_field_create(p->grid, &solid));
  st = bw_comm_agree(p->comm, st);
  /* 1 where a particle is: what moves inside the solid is no flow. */
  if (st == BW_OK) {
    bw_solid_get_position(p->solid, X);
    st = bw_grid_mark(p->grid, n, X, NULL, solid);
  }
  const bw_vtk_field fields[] = {
      {.name = "velocity", .data = {u[0], u[1], u[2]}, .staggered = true},
      {.name = "pressure",
       .data = {bw_ns_channel_pressure(p->fluid)},
       .scale = p->config->fluid.density},
      {.name = "solid", .data = {solid}},
  };
  BW_THEN(st, bw_vtk_write_grid(p->grid, path, bw_ns_channel_time(p->fluid), 3, fields));
  bw_release(&X);
  bw_release(&solid);
  return st;
}

static bw_status write_solid(porous_run *p, const char *path)
{
  const size_t n = bw_solid_count(p->solid);
  double *X = NULL, *V = NULL, *U = NULL, *damage = NULL;
  int64_t *piece = NULL;
  porous_tensors t = {0};
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&U, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&damage, n));
  BW_THEN(st, BW_ALLOCATE(&piece, n));
  /* What follows is collective. */
  st = bw_comm_agree(p->comm, st);
  BW_THEN(st, bw_pd_interface_fragments(bw_coupler_edit_interface(p->coupler), piece, NULL));
  BW_THEN(st, porous_tensors_make(p, &t));
  /* Present places; U holds the reference shape until it is taken off. */
  if (st == BW_OK) {
    bw_solid_get_position(p->solid, X);
    bw_solid_get_velocity(p->solid, V);
    bw_solid_get_reference(p->solid, U);
    bw_solid_get_damage(p->solid, damage);
    for (size_t i = 0; i < 3 * n; i++)
      U[i] = X[i] - U[i];
    const bw_vtk_array arrays[] = {{"damage", BW_VTK_FLOAT64, 1, damage},
                                   {"velocity", BW_VTK_FLOAT64, 3, V},
                                   {"displacement", BW_VTK_FLOAT64, 3, U},
                                   {"principal_stress", BW_VTK_FLOAT64, 3, t.stress},
                                   {"von_mises", BW_VTK_FLOAT64, 1, t.von_mises},
                                   {"principal_strain", BW_VTK_FLOAT64, 3, t.strain},
                                   {"fragment", BW_VTK_INT64, 1, piece},
                                   {"id", BW_VTK_INT64, 1, bw_solid_id(p->solid)}};
    st = bw_vtk_write_points(p->comm, path, bw_ns_channel_time(p->fluid), n, X,
                             sizeof arrays / sizeof *arrays, arrays);
  }
  bw_release(&X);
  bw_release(&V);
  bw_release(&U);
  bw_release(&damage);
  bw_release(&piece);
  porous_tensors_release(&t);
  return st;
}

/* One VTK file of a series `what` at the present time, e.g. fluid-00001200.vti in fluid.pvd. */
static bw_status add_to_series(porous_run *p, const char *what, const char *extension,
                               bw_status (*write)(porous_run *, const char *))
{
  char name[64], series[64], *path = NULL, *series_path = NULL;
  snprintf(name, sizeof name, "%s-%08lld.%s", what, (long long)p->total_step, extension);
  snprintf(series, sizeof series, "%s.pvd", what);
  bw_status st = bw_case_path(p->run, name, &path);
  BW_THEN(st, bw_case_path(p->run, series, &series_path));
  /* The series names the file only after it is there. */
  BW_THEN(st, write(p, path));
  BW_THEN(st, bw_vtk_series_add(p->comm, series_path, bw_ns_channel_time(p->fluid), name));
  bw_release(&path);
  bw_release(&series_path);
  return st;
}

bw_status porous_picture(porous_run *p)
{
  BW_TRY(add_to_series(p, "fluid", "vti", write_fluid));
  return add_to_series(p, "solid", "vtp", write_solid);
}

static void progress_of(const porous_run *p, double progress[N_PROGRESS])
{
  const double now[N_PROGRESS] = {
      p->phase,     (double)p->step,   (double)p->total_step,
      p->last_drop, p->last_drop_time, (double)bw_history_rows(p->history)};
  memcpy(progress, now, sizeof now);
}

bw_status porous_keep(porous_run *p)
{
  progress_of(p, p->kept_progress);
  return bw_coupler_keep(p->coupler);
}

bw_status porous_save_last_good(porous_run *p, bw_status cause)
{
  char what[1024];
  /* The message of the failure, before saving replaces it. */
  snprintf(what, sizeof what, "%s", bw_last_message());
  BW_TRY(porous_checkpoint(p, "checkpoint-good.h5", true));
  return BW_FAIL(cause,
                 "step %lld (%s): %s; the last good state, step %lld of that phase, is in "
                 "checkpoint-good.h5",
                 (long long)p->step + 1, porous_phase_name[p->phase], what,
                 (long long)p->kept_progress[1]);
}

bw_status porous_checkpoint(porous_run *p, const char *name, bool kept)
{
  double progress[N_PROGRESS];
  progress_of(p, progress);
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  bw_status st = bw_history_sync(p->comm, p->history);
  BW_THEN(st, bw_case_path(p->run, name, &path));
  BW_THEN(st, bw_checkpoint_create(p->comm, path, &ck));
  BW_THEN(st, bw_checkpoint_put_case(ck, p->run));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "case/progress", N_PROGRESS,
                                        kept ? p->kept_progress : progress));
  /* State and progress belong together: both of now, or both of the last good state. */
  BW_THEN(st, kept ? bw_coupler_save_kept(p->coupler, ck) : bw_coupler_save(p->coupler, ck));
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  return st;
}

bw_status porous_restart(porous_run *p, const char *path)
{
  double progress[N_PROGRESS];
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_open(p->comm, path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "case/progress", N_PROGRESS, progress);
  if (st == BW_OK) {
    if (!bw_to_int(progress[0], &p->phase) || p->phase < 0 || p->phase >= PHASE_COUNT ||
        !bw_to_int64(progress[1], &p->step) || !bw_to_int64(progress[2], &p->total_step) ||
        !bw_to_int64(progress[5], &p->rows))
      st = BW_FAIL(BW_EINPUT, "%s: 'case/progress' holds numbers that no run has", path);
  }
  if (st == BW_OK) {
    p->last_drop = progress[3];
    p->last_drop_time = progress[4];
    porous_enter_phase(p); /* before loading: new damping would ask for new forces */
    st = bw_coupler_load(p->coupler, ck);
  }
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  return st;
}

/* What is due after a step: the last good state, samples, checkpoints, pictures. */
bw_status porous_after_step(porous_run *p)
{
  const porous_output *out = &p->config->output;
  /* Good states first, so that a failure while writing leaves one. */
  /* One in which the book of the coupling looks wrong is none. */
  if (p->step % out->keep_every == 0 && bw_coupler_sound(p->coupler)) BW_TRY(porous_keep(p));
  if (p->step % out->sample_every == 0) BW_TRY(porous_sample(p));
  /* The checkpoint first: what was paid for is on disk before a picture may fail. */
  if (out->checkpoint_every > 0 && p->step % out->checkpoint_every == 0)
    BW_TRY(porous_checkpoint(p, "checkpoint-last.h5", false));
  if (out->picture_every > 0 && p->step % out->picture_every == 0) BW_TRY(porous_picture(p));
  return BW_OK;
}

static void write_pieces(void *context, size_t n, const bw_pd_fragment piece[])
{
  FILE *f = context;
  for (size_t q = 0; f != NULL && q < n; q++) {
    const double *c = piece[q].centre, *v = piece[q].velocity;
    fprintf(f, "%lld,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", (long long)piece[q].particles,
            piece[q].mass, c[0], c[1], c[2], v[0], v[1], v[2]);
  }
}

/* fragments.csv: the pieces at the end, largest first. */
bw_status porous_fragments_csv(porous_run *p)
{
  bw_pd_fragments pieces;
  bw_case_text t;
  bw_status st = bw_pd_interface_fragments(bw_coupler_edit_interface(p->coupler), NULL, &pieces);
  if (st == BW_OK) {
    st = bw_case_text_begin(p->run, &t);
    if (t.out != NULL) fputs("particles[-],mass[kg],x[m],y[m],z[m],u[m/s],v[m/s],w[m/s]\n", t.out);
    /* No rank holds all pieces: rank 0 is handed some at a time and writes them. */
    BW_THEN(st, bw_pd_fragment_visit(p->comm, &pieces, write_pieces, t.out));
    st = bw_case_text_end(p->run, &t, "fragments.csv", st);
  }
  bw_pd_fragment_release(&pieces);
  return st;
}

bw_status porous_cost(porous_run *p)
{
  bw_log_info(bw_case_log(p->run), "markers    most on a rank over the mean: %.2f", p->imbalance);
  return bw_timer_report(bw_coupler_timer(p->coupler), p->comm, bw_case_log(p->run));
}
