/* What a specimen writes: log, history.csv, pictures, the crack's particles. */
#include "specimen_output.h"
#include "bw_file.h"
#include "bw_memory.h"
#include "bw_vtk.h"
#include "specimen_failure.h"
#include <math.h>
#include <stdio.h>

bw_status specimen_describe(const specimen *p, bw_log *log)
{
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  bw_log_info(log, "built: %lld particles, %lld bonds, time step at most %.3g s",
              (long long)bw_solid_total(p->solid), (long long)e.bonds, bw_solid_dt_max(p->solid));
  return BW_OK;
}

enum { COLUMNS = 11 };
static const char *const columns[COLUMNS] = {
    "time[s]",    "tip_x[m]",   "tip_y[m]",    "reach[m]",    "speed[m/s]", "broken_bonds[-]",
    "kinetic[J]", "elastic[J]", "fracture[J]", "external[J]", "residual[J]"};

bw_status specimen_open_history(const bw_case *run, bw_history **out)
{
  return bw_case_history(run, COLUMNS, columns, NAN, -1, out);
}

bw_status specimen_sample(specimen *p, bw_history *history)
{
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  const specimen_crack *c = &p->crack;
  /* What is left of the work is the error of the integration in time. */
  const double spent = e.kinetic + e.elastic + e.fracture + e.damping;
  const double row[COLUMNS] = {p->time,    c->tip[0],        c->tip[1],         c->reach,
                               c->speed,   (double)e.broken, e.kinetic,         e.elastic,
                               e.fracture, e.external,       e.external - spent};
  bw_history_append(history, row);
  return BW_OK;
}

enum { ARRAYS = 2 + BW_SOLID_FAILURE_GAUGES };

/* Damage, displacement, and the gauges that are asked for, each in an array of its own. */
static int name_arrays(const specimen *p, const double U[], const double used[], double column[],
                       char name[][32], bw_vtk_array out[ARRAYS])
{
  int asked[BW_SOLID_FAILURE_GAUGES];
  const int n = used != NULL ? specimen_gauges(p, asked) : 0;
  out[0] = (bw_vtk_array){"damage", BW_VTK_FLOAT64, 1, p->damage};
  out[1] = (bw_vtk_array){"displacement", BW_VTK_FLOAT64, 3, U};
  for (int q = 0; q < n; q++) {
    double *mine = column + (size_t)q * p->n;
    for (size_t i = 0; i < p->n; i++)
      mine[i] = used[BW_SOLID_FAILURE_GAUGES * i + (size_t)asked[q]];
    snprintf(name[q], sizeof name[q], "used_%s", bw_solid_failure_name[asked[q]]);
    out[2 + q] = (bw_vtk_array){name[q], BW_VTK_FLOAT64, 1, mine};
  }
  return 2 + n;
}

/* used: gauges of failure, or NULL. */
static bw_status write_particles(specimen *p, const char *path, const double used[])
{
  double *X = NULL, *U = NULL, *column = NULL;
  char name[BW_SOLID_FAILURE_GAUGES][32];
  bw_vtk_array arrays[ARRAYS];
  bw_status st = BW_ALLOCATE(&X, 3 * p->n);
  BW_THEN(st, BW_ALLOCATE(&U, 3 * p->n));
  BW_THEN(st, BW_ALLOCATE(&column, BW_SOLID_FAILURE_GAUGES * p->n));
  st = bw_comm_agree(p->comm, st);
  /* Present places, with the displacement from the reference shape. */
  if (st == BW_OK) {
    bw_solid_get_position(p->solid, X);
    bw_solid_get_damage(p->solid, p->damage);
    for (size_t i = 0; i < 3 * p->n; i++)
      U[i] = X[i] - p->X0[i];
    const int n = name_arrays(p, U, used, column, name, arrays);
    st = bw_vtk_write_points(p->comm, path, p->time, p->n, X, n, arrays);
  }
  bw_release(&X);
  bw_release(&U);
  bw_release(&column);
  return st;
}

bw_status specimen_picture(specimen *p, const bw_case *run)
{
  int asked[BW_SOLID_FAILURE_GAUGES];
  char name[64], *path = NULL, *series = NULL;
  double *used = NULL;
  snprintf(name, sizeof name, "damage-%06lld.vtp", (long long)p->steps);
  bw_status st = bw_case_path(run, name, &path);
  BW_THEN(st, bw_case_path(run, "damage.pvd", &series));
  if (specimen_gauges(p, asked) > 0) {
    BW_THEN(st, bw_comm_agree(p->comm, BW_ALLOCATE(&used, BW_SOLID_FAILURE_GAUGES * p->n)));
    BW_THEN(st, specimen_used(p, used));
    BW_THEN(st, specimen_weakest(p, run, used));
  }
  BW_THEN(st, write_particles(p, path, used));
  /* The series names the file only after it is there. */
  BW_THEN(st, bw_vtk_series_add(p->comm, series, p->time, name));
  bw_release(&path);
  bw_release(&series);
  bw_release(&used);
  return st;
}

static bw_status write_crack(specimen *p, const bw_pd_crack *crack, const char *path)
{
  enum { ROW = 40 }; /* characters of a line at most */
  char *text = NULL;
  bw_status st = bw_comm_agree(p->comm, BW_ALLOCATE(&text, ROW * (crack->n + 1)));
  if (st != BW_OK) return st;
  /* One text, written by rank 0. */
  size_t used = (size_t)snprintf(text, ROW, "x[m],y[m]\n");
  for (size_t q = 0; q < crack->n; q++)
    used += (size_t)snprintf(text + used, ROW, "%.9g,%.9g\n", crack->s[q], crack->t[q]);
  st = bw_file_write_text(p->comm, path, text);
  bw_release(&text);
  return st;
}

bw_status specimen_crack_file(specimen *p, const bw_case *run)
{
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  bw_pd_crack crack;
  char *path = NULL;
  bw_solid_get_damage(p->solid, p->damage);
  BW_TRY(bw_pd_crack_collect(p->comm, &look, p->n, p->X0, p->damage, &crack));
  bw_status st = bw_case_path(run, "crack.csv", &path);
  BW_THEN(st, write_crack(p, &crack, path));
  bw_release(&path);
  bw_pd_crack_release(&crack);
  return st;
}

static const char *or_never(double x, char text[16])
{
  if (isnan(x))
    snprintf(text, 16, "(never)");
  else
    snprintf(text, 16, "%.4g", x);
  return text;
}

bw_status specimen_summary(specimen *p, bw_log *log)
{
  const specimen_crack *c = &p->crack;
  char text[3][16];
  bw_pd_crack_line line;
  specimen_fork fork;
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  /* Collective measures first, then the log of rank 0. */
  BW_TRY(specimen_fit(p, &line));
  BW_TRY(specimen_branches(p, &fork));
  bw_log_info(log, "first bond broken %s us, crack leaves the notch %s us, reaches an end %s us",
              or_never(1e6 * c->t_first, text[0]), or_never(1e6 * c->t_start, text[1]),
              or_never(1e6 * c->t_end, text[2]));
  bw_log_info(log, "tip at (%.4g, %.4g) mm, %.4g mm from the notch; at most %.4g m/s",
              1e3 * c->tip[0], 1e3 * c->tip[1], 1e3 * c->reach,
              specimen_speed(p, p->config.follow.speed_window));
  bw_log_info(log, "path at %s deg to x, %s mm wide (rms), %zu particles",
              or_never(line.angle * 180.0 / acos(-1.0), text[0]),
              or_never(1e3 * line.width, text[1]), line.n);
  bw_log_info(log, "branches %d, forks %s mm past the notch, first seen %s us", fork.branches,
              or_never(1e3 * (fork.x - p->config.follow.from[0]), text[0]),
              or_never(1e6 * c->t_branch, text[1]));
  const double spent = e.kinetic + e.elastic + e.fracture + e.damping;
  bw_log_info(log, "work %.4g J, fracture %.4g J, not accounted for %.2g %% of the work",
              e.external, e.fracture, 100.0 * (e.external - spent) / e.external);
  return BW_OK;
}
