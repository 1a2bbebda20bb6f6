/* cylinder_flow.h -- steady flow past a cylinder in the middle of a plane channel, and its drag
 * by three routes. Shared by the case and by the validation of ibm_mdf and probe.
 *
 * Units: diameter d, bulk velocity U_b and density are 1, so nu = 1/Re_d. Two-dimensional; the
 * cylinder is at (upstream, height/2), its surface carried by markers about one spacing apart on
 * a circle pulled in by `retraction` spacings (ERRATA 21). Cd = D/(0.5 rho U_b^2 d). */
#pragma once
#include "bw_ibm_mdf.h"
#include "bw_memory.h"
#include "bw_ns_channel.h"
#include "bw_probe.h"

#include <math.h>

typedef struct {
  double reynolds;             /* U_b d/nu                                 required */
  double blockage;             /* d over the channel's height              default 0.25 */
  double upstream, downstream; /* from the centre to inflow and outflow [d]  default 4, 4 */
  int cells_per_diameter;      /*                                          default 15 */
  double retraction;           /* of the markers, in spacings [-]          default 0.3 */
  int n_iter;                  /* forcing iterations                       default 2 */
  int kernel;                  /* of the markers, bw_kernel_delta_id       default roma3 */
  double probe_length;         /* in spacings [-]                          default 2 */
  double dt_fraction;          /* of the largest stable step [-]           default 0.5 */
} cylinder_config;

typedef struct {
  double reaction;       /* from the force of the markers (ERRATA 18) */
  double probe[2];       /* linear and quadratic profile (bw_probe_profile) */
  double control_volume; /* momentum balance of the box of 2 d around it */
  double slip;           /* rms velocity left at the markers after the last step [U_b] */
} cylinder_drag;

typedef struct {
  cylinder_config config;
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_ibm_mdf *body;
  bw_probe *probe[2];
  bw_real *pressure; /* of the last step, see cylinder_step */
  double dt, h;
  size_t n;                          /* surface points of this rank: all of them on rank 0 */
  double *point, *normal, *traction; /* (n,3) on the nominal surface */
  double area;                       /* of one point */
} cylinder_flow;

static inline cylinder_config cylinder_config_default(void)
{
  return (cylinder_config){.reynolds = NAN,
                           .blockage = 0.25,
                           .upstream = 4.0,
                           .downstream = 4.0,
                           .cells_per_diameter = 15,
                           .retraction = 0.3,
                           .n_iter = 2,
                           .kernel = BW_KERNEL_ROMA3,
                           .probe_length = 2.0,
                           .dt_fraction = 0.5};
}

static inline void cylinder_destroy(cylinder_flow *f)
{
  bw_release(&f->pressure);
  bw_release(&f->point);
  bw_release(&f->normal);
  bw_release(&f->traction);
  for (int p = 0; p < 2; p++)
    bw_probe_destroy(&f->probe[p]);
  bw_ibm_mdf_destroy(&f->body);
  bw_ns_channel_destroy(&f->fluid);
  bw_grid_destroy(&f->grid);
}

/* Poiseuille flow everywhere: what comes in. */
static inline void cylinder_poiseuille(const double x[3], double t, void *context, double u[3])
{
  const double y = x[1] / *(const double *)context;
  (void)t;
  u[0] = 6.0 * y * (1.0 - y);
  u[1] = u[2] = 0.0;
}

static inline bw_status cylinder_make_fluid(const bw_comm *comm, cylinder_flow *f)
{
  const cylinder_config *c = &f->config;
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  f->h = 1.0 / c->cells_per_diameter;
  double height = 1.0 / c->blockage;
  grid.n[0] = (int)lround((c->upstream + c->downstream) * c->cells_per_diameter);
  grid.n[1] = (int)lround(height * c->cells_per_diameter);
  grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = grid.n[d] * f->h;
  grid.periodic[2] = true;
  grid.halo = 2;
  height = grid.length[1];
  BW_TRY(bw_grid_create(comm, &grid, &f->grid));

  fluid.nu = 1.0 / c->reynolds;
  fluid.side[0][0].kind = BW_SIDE_INFLOW;
  fluid.side[0][0].profile = BW_PROFILE_POISEUILLE;
  fluid.side[0][0].bulk_velocity = 1.0;
  fluid.side[0][1].kind = BW_SIDE_OUTFLOW;
  fluid.side[1][0].kind = fluid.side[1][1].kind = BW_SIDE_WALL;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_ns_channel_create(f->grid, &fluid, &f->fluid));
  BW_TRY(bw_ns_channel_set_velocity(f->fluid, cylinder_poiseuille, &height, 0.0));
  f->dt = c->dt_fraction * bw_ns_channel_dt_max(f->fluid);

  const int size = c->cells_per_diameter;
  const int x = (int)lround(c->upstream * size), y = grid.n[1] / 2;
  return bw_ns_channel_watch_box(f->fluid, (int[3]){x - size, y - size, 0},
                                 (int[3]){x + size, y + size, 1});
}

/* `n` points on a circle of radius R about the cylinder's centre, and their normals. */
static inline void cylinder_circle(const cylinder_flow *f, double R, size_t n, double point[],
                                   double normal[])
{
  const double turn = 2.0 * acos(-1.0) / (double)n;
  for (size_t q = 0; q < n; q++) {
    const double c = cos(turn * ((double)q + 0.5)), s = sin(turn * ((double)q + 0.5));
    const double x[3] = {f->config.upstream + R * c, 0.5 * bw_grid_look(f->grid)->length[1] + R * s,
                         0.5 * f->h};
    const double m[3] = {c, s, 0.0};
    for (int d = 0; d < 3; d++) {
      point[3 * q + (size_t)d] = x[d];
      normal[3 * q + (size_t)d] = m[d];
    }
  }
}

/* Markers about one spacing apart; dV = arc times h, times the depth h of the cell in z. */
static inline bw_status cylinder_make_body(const bw_comm *comm, cylinder_flow *f)
{
  bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  config.kernel = (bw_kernel_delta_id)f->config.kernel;
  config.n_iter = f->config.n_iter;
  BW_TRY(bw_ibm_mdf_create(f->grid, &config, &f->body));
  const double R = 0.5 - f->config.retraction * f->h, around = 2.0 * acos(-1.0) * R;
  const size_t all = (size_t)lround(around / f->h), n = bw_comm_rank(comm) == 0 ? all : 0;
  double *X = NULL, *V = NULL, *dV = NULL, *normal = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&dV, n));
  BW_THEN(st, BW_ALLOCATE(&normal, 3 * n));
  if (st == BW_OK) {
    cylinder_circle(f, R, n, X, normal);
    for (size_t q = 0; q < n; q++)
      dV[q] = around / (double)all * f->h * f->h;
    st = bw_ibm_mdf_set_markers(f->body, n, X, V, dV);
  }
  bw_release(&X);
  bw_release(&V);
  bw_release(&dV);
  bw_release(&normal);
  return st;
}

static inline bw_status cylinder_make_probes(const bw_comm *comm, cylinder_flow *f)
{
  const double around = acos(-1.0); /* nominal surface, d = 1 */
  const size_t all = (size_t)lround(around / f->h);
  f->n = bw_comm_rank(comm) == 0 ? all : 0;
  f->area = around / (double)all * f->h;
  BW_TRY(BW_ALLOCATE(&f->point, 3 * f->n));
  BW_TRY(BW_ALLOCATE(&f->normal, 3 * f->n));
  BW_TRY(BW_ALLOCATE(&f->traction, 3 * f->n));
  cylinder_circle(f, 0.5, f->n, f->point, f->normal);
  for (int p = 0; p < 2; p++) {
    bw_probe_config config = bw_probe_config_default();
    config.rho = 1.0;
    config.nu = 1.0 / f->config.reynolds;
    config.length = f->config.probe_length;
    config.profile = p == 0 ? BW_PROBE_LINEAR : BW_PROBE_QUADRATIC;
    BW_TRY(bw_probe_create(f->grid, &config, &f->probe[p]));
    BW_TRY(bw_probe_set_points(f->probe[p], f->n, f->point, f->normal));
  }
  return BW_OK;
}

/* Everything, at t = 0 with Poiseuille flow. Destroy also after a failure. Collective. */
static inline bw_status cylinder_create(const bw_comm *comm, const cylinder_config *config,
                                        cylinder_flow *f)
{
  *f = (cylinder_flow){.config = *config};
  BW_TRY(cylinder_make_fluid(comm, f));
  BW_TRY(cylinder_make_body(comm, f));
  BW_TRY(bw_field_create(f->grid, &f->pressure));
  return cylinder_make_probes(comm, f);
}

/* One step of f->dt. Collective.
 * The body takes its momentum with the full dt in every sub-step while pressure acts for gamma_r
 * dt only, so as long as slip remains p swings from sub-step to sub-step (by 20 % of the drag
 * with two iterations). What acted over the step is the mean sum gamma_r p_r: kept for the
 * probes. */
static inline bw_status cylinder_step(cylinder_flow *f)
{
  static const double gamma[3] = {8.0 / 15.0, 2.0 / 15.0, 1.0 / 3.0}; /* bw_ns_channel.h */
  const bw_real *p = bw_ns_channel_pressure(f->fluid);
  const size_t size = bw_grid_look(f->grid)->size;
  BW_TRY(bw_ns_channel_check(f->fluid, f->dt));
  bw_ibm_mdf_begin_step(f->body);
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(f->fluid, r, f->dt);
    bw_ibm_mdf_force(f->body, bw_ns_channel_velocity(f->fluid), f->dt);
    bw_ns_channel_project(f->fluid, r, f->dt);
    for (size_t q = 0; q < size; q++)
      f->pressure[q] = (r == 0 ? 0 : f->pressure[q]) + (bw_real)gamma[r] * p[q];
  }
  return BW_OK;
}

/* Drag coefficients of the last step. Collective. */
static inline cylinder_drag cylinder_measure(cylinder_flow *f)
{
  const double scale = 2.0 / f->h; /* 1/(0.5 rho U_b^2 d depth) */
  bw_real *const *u = bw_ns_channel_velocity(f->fluid);
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f->body, u);
  cylinder_drag drag = {.reaction = -scale * r.total_force[0], .slip = r.slip_after};
  double box[3];
  bw_ns_channel_control_volume(f->fluid, box);
  drag.control_volume = -scale * box[0];
  for (int p = 0; p < 2; p++) {
    bw_probe_traction(f->probe[p], u, f->pressure, NULL, f->traction, NULL);
    for (size_t q = 0; q < f->n; q++)
      drag.probe[p] += scale * f->area * f->traction[3 * q];
  }
  bw_comm_sum(bw_grid_comm(f->grid), 2, drag.probe);
  return drag;
}

/* Steps until `interval` later, at least one. Collective. */
static inline bw_status cylinder_advance(cylinder_flow *f, double interval)
{
  const double end = bw_ns_channel_time(f->fluid) + interval - 0.5 * f->dt;
  do {
    BW_TRY(cylinder_step(f));
  } while (bw_ns_channel_time(f->fluid) < end);
  return BW_OK;
}
