/* What a box flow writes: log, history.csv, VTK files. */
#include "box_case.h"
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "bw_number.h"
#include "bw_vtk.h"

#include <math.h>
#include <stdio.h>

static const char *const axis = "xyz";
static const char *const end_name[] = {"lower", "upper"};

/* ---- the set-up ---- */
static void describe_side(const box_run *b, int d, int s)
{
  static const char *const words[] = {"periodic", "wall", "free slip", "inflow", "outflow"};
  const box_pair *pair = d == 0   ? &b->config->sides.x
                         : d == 1 ? &b->config->sides.y
                                  : &b->config->sides.z;
  const box_side *side = s == 0 ? &pair->lower : &pair->upper;
  char more[96] = "";
  if (side->profile == BW_PROFILE_POISEUILLE)
    snprintf(more, sizeof more, ", laminar profile, bulk velocity %g", side->bulk_velocity);
  else if (side->kind == BW_SIDE_INFLOW || side->kind == BW_SIDE_WALL)
    snprintf(more, sizeof more, ", velocity [%g, %g, %g]", side->velocity[0], side->velocity[1],
             side->velocity[2]);
  bw_log_info(bw_case_log(b->run), "  %c %s: %s%s", axis[d], end_name[s], words[side->kind], more);
}

/* The step at the start: that of the fluid at rest, shortened by the speeds of `start`. */
static double first_step(const box_config *c, const bw_grid_view *g, double at_rest)
{
  static const double convective = 1.7320508; /* of bw_ns_channel_dt_max */
  double rate = 0.0;
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++)
    rate += fabs(c->start.velocity[d]) / g->spacing[d];
  for (int q = 0; q < c->start.n_vortices; q++)
    rate += fabs(c->start.vortices[q].swirl) / fmin(g->spacing[0], g->spacing[1]);
  return 1.0 / sqrt(1.0 / (at_rest * at_rest) + rate * rate / (convective * convective));
}

/* The fastest that sides and start name. */
static double fastest(const box_config *c)
{
  const box_pair *pair[3] = {&c->sides.x, &c->sides.y, &c->sides.z};
  double most = hypot(hypot(c->start.velocity[0], c->start.velocity[1]), c->start.velocity[2]);
  for (int d = 0; d < 6; d++) {
    const box_side *q = d % 2 == 0 ? &pair[d / 2]->lower : &pair[d / 2]->upper;
    most = fmax(most, hypot(hypot(q->velocity[0], q->velocity[1]), q->velocity[2]));
    most = fmax(most, isnan(q->bulk_velocity) ? 0.0 : fabs(q->bulk_velocity));
  }
  for (int q = 0; q < c->start.n_vortices; q++)
    most = fmax(most, fabs(c->start.vortices[q].swirl));
  return most;
}

/* Numbers that cannot be meant, by what they lead to. */
static bw_status check_sizes(const box_config *c, const bw_grid_view *g, double dt, double steps)
{
  static const double most = 1e12;
  BW_REQUIRE(steps <= (double)BW_MOST_STEPS, BW_EINPUT,
             "time.end = %g takes %.3g steps of %.3g, more than the %g that anybody can wait for: "
             "a speed of sides, forcing or start, or fluid.viscosity, is too large for the cells",
             c->time.end, steps, dt, (double)BW_MOST_STEPS);
  const double speed = fastest(c), cell = speed * g->spacing[1] / c->fluid.viscosity;
  BW_REQUIRE(
      cell <= most, BW_EINPUT,
      "fluid.viscosity = %g: with the speed %g that the file names, the cell Reynolds number "
      "is %.3g; at most %g, beyond which rounding hides the viscosity; check its unit",
      c->fluid.viscosity, speed, cell, most);
  return BW_OK;
}

bw_status box_describe(const box_run *b, const bw_grid *plan, const bw_ns_channel_config *fluid)
{
  bw_log *log = bw_case_log(b->run);
  const bw_grid_view *g = bw_grid_look(plan);
  const box_time *time = &b->config->time;
  bw_ns_plan known;
  BW_TRY(bw_ns_channel_plan(plan, fluid, &known));
  BW_REQUIRE(isnan(time->step) || time->step <= known.dt_max * (1.0 + 1e-12), BW_EINPUT,
             "time.step = %g is over the limit at rest, with the speed of walls and inflows, %.4g; "
             "take a shorter step, or leave it out",
             time->step, known.dt_max);
  /* Later steps follow the field. */
  const double limit = first_step(b->config, g, known.dt_max);
  const double longest = isnan(time->step) ? time->limit_share * limit : time->step;
  /* Each interval between rows takes whole steps. */
  const double every = b->config->output.sample_every;
  const double each = fmax(1.0, ceil(every / longest * (1.0 - 1e-12))), dt = every / each;
  const double steps = each * (double)box_intervals(b->config);
  BW_TRY(check_sizes(b->config, g, dt, steps));
  const double cells = (double)g->n[0] * g->n[1] * g->n[2];
  const int ranks = bw_comm_size(bw_grid_comm(plan));
  bw_log_info(log, "%d x %d x %d cells of %g x %g x %g, %s", g->n[0], g->n[1], g->n[2],
              g->spacing[0], g->spacing[1], g->spacing[2],
              g->n[2] == 1 ? "two-dimensional" : "three-dimensional");
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++)
    for (int s = 0; s < 2; s++)
      describe_side(b, d, s);
  /* velocity is prescribed or carried out at every side: the pressure enters by its gradient only
   */
  bw_log_info(log, "pressure: no side fixes its level; its mean over the box is kept at 0");
  /* 30 ns per cell and sub-step: one core of a server, in between 2D and 3D */
  bw_log_info(log,
              "largest stable step at the start, walls and inflows counted, %.3g, this run's %.3g: "
              "about %.0f steps, more where the flow gets faster, %.2g s on one core",
              limit, dt, steps, steps * cells * 3.0 * 30e-9);
  /* The fluid, and the larger of a checkpoint and a picture on their way. */
  const double writing =
      fmax(bw_checkpoint_file_bytes() + bw_checkpoint_field_bytes(plan), bw_vtk_grid_bytes(plan));
  bw_log_info(log, "memory: about %.3g MiB for each of %d ranks",
              (known.bytes + writing) / 1048576.0, ranks);
  return BW_OK;
}

/* ---- history.csv: fixed columns, then those of the sides that have something to say ---- */
enum { FIXED = 6, COLUMNS = FIXED + 18, NAME = 40 };

/* Flux through inflow and outflow, stress of the tangential components on walls. */
static bool has_flux(bw_ns_side_kind kind)
{
  return kind == BW_SIDE_INFLOW || kind == BW_SIDE_OUTFLOW;
}

typedef struct {
  int d, s, component; /* component < 0: the flux */
} side_column;

static int side_columns(const box_run *b, side_column column[COLUMNS - FIXED])
{
  const box_sides *sides = &b->config->sides;
  const box_pair *pair[3] = {&sides->x, &sides->y, &sides->z};
  const int dimensions = b->config->domain.cells[2] == 1 ? 2 : 3;
  int n = 0;
  for (int d = 0; d < dimensions; d++)
    for (int s = 0; s < 2; s++) {
      const int kind = s == 0 ? pair[d]->lower.kind : pair[d]->upper.kind;
      /* Through in- and outflow a flux, on walls a stress per tangential direction. */
      if (has_flux((bw_ns_side_kind)kind)) column[n++] = (side_column){d, s, -1};
      for (int c = 0; c < dimensions && kind == BW_SIDE_WALL; c++)
        if (c != d) column[n++] = (side_column){d, s, c};
    }
  return n;
}

bw_status box_open_history(box_run *b)
{
  static const char *const fixed[FIXED] = {
      "time[T]",       "bulk_velocity[L/T]", "kinetic_energy[L5/T2]",
      "divergence[-]", "forcing[L/T2]",      "dt[T]"};
  const char *names[COLUMNS];
  char text[COLUMNS][NAME];
  side_column column[COLUMNS - FIXED];
  const int n = side_columns(b, column);
  for (int q = 0; q < FIXED; q++)
    names[q] = fixed[q];
  /* Columns of the sides carry their names, e.g. flux_x_lower. */
  for (int q = 0; q < n; q++) {
    const side_column *c = &column[q];
    if (c->component < 0)
      snprintf(text[q], NAME, "flux_%c_%s[L3/T]", axis[c->d], end_name[c->s]);
    else
      snprintf(text[q], NAME, "stress_%c_%s_%c[L2/T2]", axis[c->d], end_name[c->s],
               axis[c->component]);
    names[FIXED + q] = text[q];
  }
  return bw_case_history(b->run, FIXED + n, names, bw_ns_channel_time(b->fluid), b->rows,
                         &b->history);
}

void box_sample(box_run *b)
{
  const bw_ns_summary now = bw_ns_channel_summary(b->fluid);
  side_column column[COLUMNS - FIXED];
  const int n = side_columns(b, column);
  double row[COLUMNS] = {bw_ns_channel_time(b->fluid), now.bulk_velocity,
                         now.kinetic_energy,           bw_ns_channel_divergence(b->fluid),
                         now.pressure_gradient,        b->dt};
  /* Each side is integrated anew; they are few. */
  for (int q = 0; q < n; q++) {
    const bw_ns_side_report side = bw_ns_channel_side(b->fluid, column[q].d, column[q].s);
    row[FIXED + q] = column[q].component < 0 ? side.flux : side.stress[column[q].component];
  }
  bw_history_append(b->history, row);
}

/* ---- pictures ---- */
bw_status box_picture(box_run *b)
{
  bw_real *const *u = bw_ns_channel_velocity(b->fluid);
  const bw_vtk_field fields[] = {
      {.name = "velocity", .data = {u[0], u[1], u[2]}, .staggered = true},
      {.name = "pressure", .data = {bw_ns_channel_pressure(b->fluid)}}};
  char name[64], *path = NULL, *series = NULL;
  snprintf(name, sizeof name, "fluid-%08lld%s", (long long)b->steps,
           bw_vtk_grid_extension(b->grid));
  bw_status st = bw_case_path(b->run, name, &path);
  BW_THEN(st, bw_case_path(b->run, "fluid.pvd", &series));
  BW_THEN(st, bw_vtk_write_grid(b->grid, path, bw_ns_channel_time(b->fluid), 2, fields));
  BW_THEN(st, bw_vtk_series_add(bw_grid_comm(b->grid), series, bw_ns_channel_time(b->fluid), name));
  bw_release(&path);
  bw_release(&series);
  return st;
}
