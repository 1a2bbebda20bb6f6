/* The keys of cylinder_drag.yaml, and what the case writes. */
#include "cylinder_case.h"

#include "bw_number.h"
#include "bw_vtk.h"
#include <stdio.h>

#define V BW_CONFIG_VALUE
static const bw_config_word kernel_words[] = {{"roma3", BW_KERNEL_ROMA3, "three nodes"},
                                              {"peskin4", BW_KERNEL_PESKIN4, "four nodes"},
                                              {"hat2", BW_KERNEL_HAT2, "two nodes"},
                                              {NULL, 0, NULL}};
static const bw_config_field cylinder_fields[] = {
    V(cylinder_config, reynolds, BW_REQUIRED, BW_ABOVE_TO(0, 1e6), "-",
      "Reynolds number Re_d = U_b d/nu"),
    V(cylinder_config, blockage, BW_OPTIONAL, BW_FROM_TO(0.02, 0.8), "-",
      "diameter over the channel's height"),
    V(cylinder_config, upstream, BW_OPTIONAL, BW_FROM_TO(1.5, 1000), "d",
      "distance of the cylinder's centre from the inflow"),
    V(cylinder_config, downstream, BW_OPTIONAL, BW_FROM_TO(1.5, 1000), "d",
      "distance of the outflow from the cylinder's centre"),
    V(cylinder_config, cells_per_diameter, BW_OPTIONAL, BW_FROM_TO(8, 200), "",
      "cells per diameter"),
    V(cylinder_config, retraction, BW_OPTIONAL, BW_FROM_TO(0, 2), "h",
      "how far inside the surface markers are; left out: on the true surface (without memory: the "
      "best for kernel and n_iter)"),
    V(cylinder_config, n_iter, BW_OPTIONAL, BW_FROM_TO(1, 100), "",
      "forcing iterations in each sub-step"),
    V(cylinder_config, memory, BW_OPTIONAL, BW_FROM_TO(0, 0.5), "",
      "share of the last step's force in the markers' memory; 0: none, then two iterations or "
      "more"),
    BW_CONFIG_WORD(cylinder_config, kernel, BW_OPTIONAL, kernel_words,
                   "delta kernel of the markers"),
    V(cylinder_config, probe_length, BW_OPTIONAL, BW_FROM_TO(1, 4), "h",
      "length of the normal probes"),
    V(cylinder_config, dt_fraction, BW_OPTIONAL, BW_FROM_TO(0.01, 0.9), "",
      "time step over the largest stable one of the flow as it is"),
    BW_CONFIG_END};
static const bw_config_field until_fields[] = {
    V(cylinder_until, steady, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "1/(d/U_b)",
      "relative change of the drag per unit of time below which the run ends"),
    V(cylinder_until, latest, BW_OPTIONAL, BW_ABOVE(0), "d/U_b",
      "time at which the run ends at the latest"),
    V(cylinder_until, interval, BW_OPTIONAL, BW_ABOVE(0), "d/U_b", "time between samples"),
    BW_CONFIG_END};
const bw_config_field cylinder_case_fields[] = {
    BW_CONFIG_MAP(cylinder_case, cylinder, cylinder_fields, "the flow and its discretisation"),
    BW_CONFIG_MAP(cylinder_case, until, until_fields, "when the run ends"), BW_CONFIG_END};

cylinder_case cylinder_case_default(void)
{
  return (cylinder_case){cylinder_config_default(),
                         {.steady = 1.0e-5, .latest = 60.0, .interval = 0.5}};
}

/* The same cylinder in a channel as short, with cells as large, as can be. */
static cylinder_config small_of(const cylinder_config *c)
{
  static const double beside = 1.5; /* diameters: the least that a case may have */
  static const int coarse = 16;     /* cells per diameter */
  cylinder_config s = *c;
  s.upstream = s.downstream = beside;
  s.cells_per_diameter = c->cells_per_diameter < coarse ? c->cells_per_diameter : coarse;
  return s;
}

/* What the markers, probes and points on the surface hold, from the small channel: its memory
 * beside that of its fluid and the field of the pressure. It grows with the diameter in cells. */
static bw_status weigh_body(const bw_comm *self, const cylinder_config *c, double *bytes)
{
  const cylinder_config s = small_of(c);
  const bw_ns_channel_config fluid = cylinder_fluid(&s);
  cylinder_flow f;
  bw_ns_plan own = {.bytes = 0.0};
  const double before = (double)bw_memory_in_use();
  bw_status st = cylinder_create(self, &s, &f);
  const double held = (double)bw_memory_in_use() - before;
  BW_THEN(st, bw_ns_channel_plan(f.flow.grid, &fluid, &own));
  if (st == BW_OK) {
    const double field = (double)sizeof(bw_real) * (double)bw_grid_look(f.flow.grid)->size;
    const double finer = (double)c->cells_per_diameter / s.cells_per_diameter;
    *bytes = finer * fmax(0.0, held - own.bytes - field);
  }
  cylinder_destroy(&f);
  return st;
}

static bw_status describe(const bw_grid *plan, const bw_ns_plan *known, double body,
                          const cylinder_case *c, bw_log *log)
{
  const bw_grid_view *g = bw_grid_look(plan);
  const double dt = cylinder_first_step(&c->cylinder, known->dt_max), steps = c->until.latest / dt;
  const int ranks = bw_comm_size(bw_grid_comm(plan));
  BW_REQUIRE(
      steps <= (double)BW_MOST_STEPS, BW_EINPUT,
      "until.latest = %g takes %.3g steps of %.3g (cylinder.reynolds = %g), more than the %g "
      "that anybody can wait for",
      c->until.latest, steps, dt, c->cylinder.reynolds, (double)BW_MOST_STEPS);
  const double cells = (double)g->n[0] * g->n[1];
  const double field = (double)sizeof(bw_real) * (double)g->size;
  /* 20 ns per cell and sub-step: measured, one core, this case */
  bw_log_info(
      log,
      "Re_d = %g, blockage %g, %d x %d cells, first dt about %.3g d/U_b\n"
      "memory about %.3g MiB for each of %d ranks; about %.0f steps to the latest end, %.0f s",
      c->cylinder.reynolds, 1.0 / g->length[1], g->n[0], g->n[1], dt,
      (known->bytes + field + body + bw_vtk_grid_bytes(plan)) / 1048576.0, ranks, steps,
      steps * cells * 3.0 * 20.0e-9);
  /* Measured at blockage 0.8, against 60 cells per diameter. */
  const double gap = 0.5 * ((double)g->n[1] - c->cylinder.cells_per_diameter);
  if (gap < 4.0)
    bw_log_warn(log,
                "the gaps between cylinder and walls are %.3g cells wide: the drag comes out some "
                "4 %% too low at 4 cells, 16 %% at 2, 40 %% at 1; take more "
                "cylinder.cells_per_diameter",
                gap);
  return BW_OK;
}

bw_status cylinder_plan(const bw_comm *comm, const cylinder_case *c, bw_log *log)
{
  const bw_grid_config sizes = cylinder_grid(&c->cylinder);
  const bw_ns_channel_config fluid = cylinder_fluid(&c->cylinder);
  bw_grid *plan = NULL;
  bw_comm *self = NULL;
  bw_ns_plan known;
  double body = 0.0;
  bw_status st = bw_grid_plan(comm, &sizes, &plan);
  BW_THEN(st, bw_ns_channel_plan(plan, &fluid, &known));
  BW_THEN(st, bw_comm_agree(comm, bw_comm_self(&self)));
  BW_THEN(st, bw_comm_agree(comm, weigh_body(self, &c->cylinder, &body)));
  BW_THEN(st, describe(plan, &known, body, c, log));
  bw_comm_destroy(&self);
  bw_grid_destroy(&plan);
  return st;
}

bw_status cylinder_open_history(const bw_case *run, bw_history **out)
{
  static const char *const names[] = {"time[d/U_b]",           "Cd_reaction[-]",
                                      "Cd_control_volume[-]",  "Cd_probe_linear[-]",
                                      "Cd_probe_quadratic[-]", "slip[U_b]"};
  return bw_case_history(run, sizeof names / sizeof *names, names, NAN, -1, out);
}

void cylinder_sample(bw_history *history, double t, const cylinder_drag *d)
{
  const double row[] = {t, d->reaction, d->control_volume, d->probe[0], d->probe[1], d->slip};
  bw_history_append(history, row);
}

/* Angle from the front stagnation point, pressure and shear, as in the reference's table. */
static bw_status write_wall(cylinder_flow *f, const bw_case *run)
{
  bw_case_text t;
  const bw_status st = bw_case_text_begin(run, &t);
  if (t.out != NULL) fprintf(t.out, "theta[deg],p[rho U_b^2],tau[rho U_b^2]\n");
  for (size_t q = 0; t.out != NULL && q < f->wall.n; q++) {
    /* p = -t.n, and the part of t along the wall, clockwise from the front. */
    const double *n = f->wall.N + 3 * q, *T = f->traction + 3 * q;
    fprintf(t.out, "%.4f,%.8g,%.8g\n", atan2(n[1], -n[0]) * 180.0 / acos(-1.0),
            -(T[0] * n[0] + T[1] * n[1]), T[0] * n[1] - T[1] * n[0]);
  }
  return bw_case_text_end(run, &t, "wall.csv", st);
}

bw_status cylinder_write(cylinder_flow *f, const bw_case *run)
{
  const bw_comm *comm = bw_grid_comm(f->flow.grid);
  bw_real *const *u = bw_ns_channel_velocity(f->flow.fluid), *p = f->flow.pressure;
  const bw_vtk_field fields[] = {{.name = "velocity", .data = {u[0], u[1]}, .staggered = true},
                                 {.name = "pressure", .data = {p}}};
  char *fluid = NULL, *body = NULL;
  bw_status st = bw_case_path(run, "fluid.vti", &fluid);
  BW_THEN(st, bw_case_path(run, "body.vtp", &body));
  /* Traction by the parabola, from the pressure that acted; rank 0 has all points. */
  bw_probe_traction(f->probe[BW_PROBE_QUADRATIC], u, p, NULL, f->traction, NULL);
  BW_THEN(st, write_wall(f, run));
  const bw_vtk_array traction = {"traction", BW_VTK_FLOAT64, 3, f->traction};
  BW_THEN(st, bw_vtk_write_grid(f->flow.grid, fluid, bw_ns_channel_time(f->flow.fluid), 2, fields));
  BW_THEN(st, bw_vtk_write_points(comm, body, bw_ns_channel_time(f->flow.fluid), f->wall.n,
                                  f->wall.X, 1, &traction));
  bw_release(&fluid);
  bw_release(&body);
  return st;
}
