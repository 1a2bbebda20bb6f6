/* flap_in_channel.h -- a flap behind a cylinder in a channel: set-up, step, history, state.
 *
 * Turek and Hron's benchmark: channel 2.5 x 0.41 m, cylinder of 0.1 m at (0.2, 0.2), flap of 0.35 x
 * 0.02 m behind it, parabolic inflow. Two-dimensional, plane strain, one cell deep; SI units. */
#pragma once
#include "bw_checkpoint.h"
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LENGTH = 2.5, HEIGHT = 0.41, CENTRE = 0.2, RADIUS = 0.05;
static const double THICK = 0.02, END = 0.6, RHO = 1000.0, NU = 1e-3;
static const double PI = 3.14159265358979323846;
enum { SAVE_EVERY = 250 };

typedef struct {
  const char *name;
  double mean, density, young; /* of the inflow; of the flap, the benchmark's */
  double dt, ramp, end, from;  /* with 82 cells; of the inflow; of the run; samples count from */
  int iterations;              /* of the coupling; 1: explicit */
  double tip, frequency;       /* goals of 164 cells */
  bw_coupler_load_kind load;
  bool predictor; /* explicit steps: does the fluid know the motion to come? */
} flap_case;

/* A row of the history. */
enum { T, UX, UY, DRAG, LIFT, DRAG_PROBES, LIFT_PROBES, TRIES, COLUMNS };

typedef struct {
  flap_case of;
  int cells;
  double h, ds, dt, depth;
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  size_t n; /* particles of this rank */
  double *X0, *X, *V;
  double inner[2]; /* momentum of the fluid inside the solid */
  double force[2]; /* of the last step along x: by the reaction, by the momentum of a box */
  double *row;     /* (rows, COLUMNS) */
  int rows, room;
  char path[1024];
} flap;

static inline void flap_destroy(flap *f)
{
  bw_coupler_destroy(&f->coupler);
  bw_solid_destroy(&f->solid);
  bw_ns_channel_destroy(&f->fluid);
  bw_grid_destroy(&f->grid);
  double **const arrays[] = {&f->X0, &f->X, &f->V, &f->row};
  for (size_t q = 0; q < sizeof arrays / sizeof *arrays; q++)
    bw_release(arrays[q]);
}

/* The parabola that comes in, at time t. */
static inline void flap_stream(const double x[3], double t, void *context, double u[3])
{
  const flap_case *c = context;
  const double y = x[1] / HEIGHT;
  const double up = t < c->ramp ? 0.5 * (1.0 - cos(PI * t / c->ramp)) : 1.0;
  u[0] = 6.0 * c->mean * y * (1.0 - y) * up;
  u[1] = u[2] = 0.0;
}

static inline bw_status flap_make_fluid(const bw_comm *comm, flap *f)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  f->h = HEIGHT / f->cells;
  f->depth = f->h;
  grid.n[0] = (int)round(LENGTH / f->h), grid.n[1] = f->cells, grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = grid.n[d] * f->h;
  grid.periodic[2] = true;
  grid.halo = 2;
  fluid.nu = NU;
  fluid.side[0][0] = (bw_ns_side){.kind = BW_SIDE_INFLOW,
                                  .profile = BW_PROFILE_CALLBACK,
                                  .function = flap_stream,
                                  .context = &f->of};
  fluid.side[0][1].kind = BW_SIDE_OUTFLOW;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_grid_create(comm, &grid, &f->grid));
  BW_TRY(bw_ns_channel_create(f->grid, &fluid, &f->fluid));
  /* A box around cylinder and flap, from wall to wall. */
  BW_TRY(bw_ns_channel_watch_box(f->fluid, (int[3]){(int)(0.1 / f->h), 0, 0},
                                 (int[3]){(int)(0.7 / f->h), grid.n[1], 1}));
  /* What does not come up in time is there from the start. */
  BW_TRY(bw_ns_channel_set_velocity(f->fluid, flap_stream, &f->of, 0.0));
  f->dt = fmin(f->of.dt * 82.0 / f->cells, 0.8 * bw_ns_channel_dt_max(f->fluid));
  return BW_OK;
}

static inline bw_solid_config flap_material(const flap *f)
{
  const flap_case *c = &f->of;
  bw_solid_config s = bw_solid_config_default();
  s.geometry = BW_PD_PLANE_STRAIN;
  s.ds = f->ds;
  s.thickness = f->depth;
  s.horizon_ratio = 3.0;
  s.rho = c->density;
  s.E = c->young * (1.0 - 0.25 * 0.25) / (1.0 - 0.4 * 0.4);
  s.surface_correction = BW_PD_SURFACE_TENSOR;
  s.damping.mean = c->density * sqrt(s.E / c->density) / (30.0 * f->ds);
  /* What rests may be damped: about critical for the first mode, 1.08 Hz at the fluid's density. */
  if (c->ramp == 0.0) s.damping.absolute = 2.0 * 2.0 * PI * 1.08 * sqrt(RHO * c->density);
  s.origin[0] = END;
  s.origin[1] = CENTRE - 0.5 * THICK;
  s.origin[2] = 0.5 * f->depth;
  return s;
}

static inline bw_status flap_make_solid(const bw_comm *comm, flap *f)
{
  /* Twelve particles across, and two a cell at least: markers of single particles, about as far
   * apart as cells, would leave the cylinder its steps. */
  f->ds = THICK / fmax(12.0, ceil(2.0 * THICK / f->h - 1e-9));
  const bw_solid_config s = flap_material(f);
  /* The cylinder is held, and with it the root of the flap. */
  const bw_shape body[2] = {{.kind = BW_SHAPE_BOX,
                             .lower = {CENTRE, CENTRE - 0.5 * THICK},
                             .upper = {END, CENTRE + 0.5 * THICK, f->depth}},
                            {.kind = BW_SHAPE_CYLINDER,
                             .centre = {CENTRE, CENTRE},
                             .radius = RADIUS,
                             .axis = 2,
                             .particle_kind = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE}};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(f->ds, s.origin, true);
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = bw_shape_fill_shared(comm, 2, body, &lattice, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create(comm, &s, &(bw_pd_sites){n, site, kind, NULL}, &f->solid));
  bw_release(&site);
  bw_release(&kind);
  if (st != BW_OK) return st;
  f->n = bw_solid_count(f->solid);
  st = BW_ALLOCATE(&f->X0, 3 * f->n);
  BW_THEN(st, BW_ALLOCATE(&f->X, 3 * f->n));
  BW_THEN(st, BW_ALLOCATE(&f->V, 3 * f->n));
  if (st == BW_OK) bw_solid_get_reference(f->solid, f->X0);
  return bw_comm_agree(comm, st);
}

static inline bw_status flap_make(const bw_comm *comm, flap *f)
{
  bw_coupler_config c = bw_coupler_config_default();
  BW_TRY(flap_make_fluid(comm, f));
  BW_TRY(flap_make_solid(comm, f));
  f->room = (int)ceil(f->of.end / f->dt) + 1;
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&f->row, (size_t)f->room * COLUMNS)));
  c.rho = RHO, c.nu = NU;
  c.marker_spacing = 1.0;
  c.coupling_residual = 1e-3;
  c.coupling_iterations = f->of.iterations;
  c.load = f->of.load;
  c.predictor = f->of.predictor;
  BW_TRY(bw_coupler_create(&c, f->fluid, f->solid, &f->coupler));
  bw_coupler_hold_solid(f->coupler, false);
  return BW_OK;
}

/* Displacement of the middle of the free end: of the last column, carried on along the slope over
 * three columns. Momentum of the fluid in place of the solid. Collective. */
static inline void flap_look_at_solid(const bw_comm *comm, flap *f, double tip[2], double inner[2])
{
  double sum[8] = {0.0};
  bw_solid_get_position(f->solid, f->X);
  bw_solid_get_velocity(f->solid, f->V);
  for (size_t i = 0; i < f->n; i++) {
    const double *x = f->X + 3 * i, *x0 = f->X0 + 3 * i;
    for (int d = 0; d < 2; d++)
      sum[6 + d] += RHO * bw_solid_volume(f->solid) * f->V[3 * i + (size_t)d];
    if (fabs(x0[1] - CENTRE) > 0.6 * f->ds) continue;
    const double before = (END - x0[0]) / f->ds - 0.5;
    const int column = before < 0.5 ? 0 : fabs(before - 3.0) < 0.5 ? 3 : -1;
    if (column < 0) continue;
    for (int d = 0; d < 2; d++)
      sum[column + d] += x[d] - x0[d];
    sum[column + 2] += 1.0;
  }
  bw_comm_sum(comm, 8, sum);
  for (int d = 0; d < 2; d++) {
    const double last = sum[d] / sum[2], third = sum[3 + d] / sum[5];
    tip[d] = last + (last - third) / 6.0;
    inner[d] = sum[6 + d];
  }
}

static inline bw_status flap_sample(const bw_comm *comm, flap *f)
{
  bw_coupler_report r;
  double tip[2], inner[2], *row = f->row + (size_t)f->rows * COLUMNS;
  BW_TRY(bw_coupler_measure(f->coupler, &r));
  flap_look_at_solid(comm, f, tip, inner);
  row[T] = bw_ns_channel_time(f->fluid);
  row[TRIES] = r.iterations;
  f->force[0] = r.force_reaction[0];
  f->force[1] = r.force_control_volume[0];
  for (int d = 0; d < 2; d++) {
    /* The reaction moves the fluid inside, too. */
    const double moved = (inner[d] - f->inner[d]) / f->dt;
    row[UX + d] = tip[d];
    row[DRAG + d] = (r.force_reaction[d] + moved) / f->depth;
    row[DRAG_PROBES + d] = r.force_probe[d] / f->depth;
    f->inner[d] = inner[d];
  }
  f->rows++;
  return BW_OK;
}

/* What has to be the same for a run to go on. */
enum { SETTINGS = 6 };
static inline void flap_settings(const flap *f, double x[SETTINGS])
{
  const double now[SETTINGS] = {f->dt, f->of.end, f->of.iterations, f->of.load, f->ds, COLUMNS};
  memcpy(x, now, sizeof now);
}

static inline bw_status flap_save(const bw_comm *comm, flap *f)
{
  bw_checkpoint *ck = NULL;
  double set[SETTINGS], numbers[3] = {f->rows, f->inner[0], f->inner[1]};
  flap_settings(f, set);
  BW_TRY(bw_checkpoint_create(comm, f->path, &ck));
  bw_status st = bw_coupler_save(f->coupler, ck);
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "settings", SETTINGS, set));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "numbers", 3, numbers));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "history", f->rows * COLUMNS, f->row));
  if (st != BW_OK) {
    bw_checkpoint_abandon(&ck);
    return st;
  }
  return bw_checkpoint_close(&ck);
}

/* Goes on from what an earlier call has left, if it has. */
static inline bw_status flap_resume(const bw_comm *comm, flap *f)
{
  FILE *file = fopen(f->path, "rb");
  double there[SETTINGS], here[SETTINGS], numbers[3];
  bw_checkpoint *ck = NULL;
  if (file == NULL) return BW_OK;
  fclose(file);
  flap_settings(f, here);
  BW_TRY(bw_checkpoint_open(comm, f->path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "settings", SETTINGS, there);
  if (st == BW_OK && memcmp(here, there, sizeof here) != 0)
    st = BW_FAIL(BW_EINPUT, "%s is of a run with other settings: remove it", f->path);
  BW_THEN(st, bw_checkpoint_get_numbers(ck, "numbers", 3, numbers));
  if (st == BW_OK) {
    f->rows = (int)numbers[0];
    f->inner[0] = numbers[1], f->inner[1] = numbers[2];
    st = bw_checkpoint_get_numbers(ck, "history", f->rows * COLUMNS, f->row);
  }
  BW_THEN(st, bw_coupler_load(f->coupler, ck));
  bw_checkpoint_abandon(&ck);
  return st;
}

static inline bw_status flap_march(const bw_comm *comm, flap *f, bool kept)
{
  const double slack = 0.5 * f->dt;
  if (kept) BW_TRY(flap_resume(comm, f));
  while (bw_ns_channel_time(f->fluid) < f->of.end - slack && f->rows < f->room) {
    BW_TRY(bw_coupler_step(f->coupler, f->dt));
    BW_TRY(flap_sample(comm, f));
    if (kept && f->rows % SAVE_EVERY == 0) BW_TRY(flap_save(comm, f));
  }
  return kept ? flap_save(comm, f) : BW_OK;
}
