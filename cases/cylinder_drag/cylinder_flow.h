/* cylinder_flow.h -- steady flow past a cylinder in the middle of a plane channel, and its drag
 * by three routes. Shared by the case and by the validation of ibm_mdf and probe.
 *
 * Units: diameter d, bulk velocity U_b and density are 1, so nu = 1/Re_d. Two-dimensional; the
 * cylinder is at (upstream, height/2), its surface carried by markers about one spacing apart: on
 * the surface itself, or on a circle pulled in by `retraction` spacings (ERRATA 21).
 * Cd = D/(0.5 rho U_b^2 d). */
#pragma once
#include "body_flow.h"
#include "bw_probe.h"

/* The flow and its discretisation. */
typedef struct {
  double reynolds;             /* U_b d/nu                                 required */
  double blockage;             /* d over the channel's height              default 0.25 */
  double upstream, downstream; /* from the centre to inflow and outflow [d]  default 4, 4 */
  int cells_per_diameter;      /*                                          default 15 */
  double retraction;           /* of the markers, in spacings [-]; NaN: none, they stand on
                                  the true surface (without memory: the best one known for
                                  kernel and n_iter)                       default NaN */
  int n_iter;                  /* forcing iterations                       default 1 */
  double memory;               /* share of the last step in the markers'
                                  memory (bw_ibm_mdf.h), 0: none           default 0.2 */
  int kernel;                  /* of the markers, bw_kernel_delta_id       default roma3 */
  double probe_length;         /* in spacings [-]                          default 2 */
  double dt_fraction;          /* of the largest stable step of the flow
                                  as it is [-]                             default 0.5 */
} cylinder_config;

/* Drag coefficients by every route [-]. */
typedef struct {
  double reaction;       /* from the force of the markers (ERRATA 18) */
  double probe[2];       /* linear and quadratic profile (bw_probe_profile) */
  double control_volume; /* momentum balance of the box of 2 d around it, cut at the walls */
  double slip;           /* rms velocity left at the markers after the last step [U_b] */
} cylinder_drag;

/* The objects of a run. */
typedef struct {
  cylinder_config config;
  body_flow flow;
  bw_probe *probe[2]; /* linear and quadratic profile */
  double h;           /* spacing [d] */
  body_surface markers;
  body_surface wall; /* points on the nominal surface */
  double *traction;  /* (n,3) there */
  double area;       /* of one point */
} cylinder_flow;

static inline cylinder_config cylinder_config_default(void)
{
  return (cylinder_config){.reynolds = NAN,
                           .blockage = 0.25,
                           .upstream = 4.0,
                           .downstream = 4.0,
                           .cells_per_diameter = 15,
                           .retraction = NAN,
                           .n_iter = 1,
                           .memory = 0.2,
                           .kernel = BW_KERNEL_ROMA3,
                           .probe_length = 2.0,
                           .dt_fraction = 0.5};
}

static inline void cylinder_destroy(cylinder_flow *f)
{
  body_surface_free(&f->markers);
  body_surface_free(&f->wall);
  bw_release(&f->traction);
  for (int p = 0; p < 2; p++)
    bw_probe_destroy(&f->probe[p]);
  body_flow_destroy(&f->flow);
}

/* Poiseuille flow everywhere: what comes in. */
static inline void cylinder_poiseuille(const double x[3], double t, void *context, double u[3])
{
  const double y = x[1] / *(const double *)context;
  (void)t;
  u[0] = 6.0 * y * (1.0 - y);
  u[1] = u[2] = 0.0;
}

/* Lengths in diameters; the channel is rounded to whole cells. */
static inline bw_grid_config cylinder_grid(const cylinder_config *c)
{
  bw_grid_config grid = bw_grid_config_default();
  grid.n[0] = (int)lround((c->upstream + c->downstream) * c->cells_per_diameter);
  grid.n[1] = (int)lround(1.0 / c->blockage * c->cells_per_diameter);
  grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = grid.n[d] * (1.0 / c->cells_per_diameter);
  grid.periodic[2] = true;
  grid.halo = 2;
  return grid;
}

/* U_b = d = 1. Laminar inflow, convective outflow, walls. */
static inline bw_ns_channel_config cylinder_fluid(const cylinder_config *c)
{
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  fluid.nu = 1.0 / c->reynolds;
  fluid.side[0][0].kind = BW_SIDE_INFLOW;
  fluid.side[0][0].profile = BW_PROFILE_POISEUILLE;
  fluid.side[0][0].bulk_velocity = 1.0;
  fluid.side[0][1].kind = BW_SIDE_OUTFLOW;
  fluid.side[1][0].kind = fluid.side[1][1].kind = BW_SIDE_WALL;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  return fluid;
}

static inline bw_status cylinder_make_fluid(const bw_comm *comm, cylinder_flow *f)
{
  const cylinder_config *c = &f->config;
  const bw_grid_config grid = cylinder_grid(c);
  const bw_ns_channel_config fluid = cylinder_fluid(c);
  double height = grid.length[1];
  f->h = 1.0 / c->cells_per_diameter;
  BW_TRY(bw_grid_create(comm, &grid, &f->flow.grid));
  BW_TRY(bw_ns_channel_create(f->flow.grid, &fluid, &f->flow.fluid));
  BW_TRY(bw_ns_channel_set_velocity(f->flow.fluid, cylinder_poiseuille, &height, 0.0));

  /* Momentum is balanced over a box of two diameters about the cylinder, which ends at the walls
   * where they are nearer: their friction is a flux through its faces. */
  const int size = c->cells_per_diameter;
  const int x = (int)lround(c->upstream * size), y = grid.n[1] / 2;
  const int low = y > size ? y - size : 0, high = y + size < grid.n[1] ? y + size : grid.n[1];
  return bw_ns_channel_watch_box(f->flow.fluid, (int[3]){x - size, low, 0},
                                 (int[3]){x + size, high, 1});
}

/* Points about one spacing apart on a circle of radius R about the cylinder's centre. */
static inline bw_status cylinder_surface(const bw_comm *comm, const cylinder_flow *f, double R,
                                         body_surface *s)
{
  const double centre[2] = {f->config.upstream, 0.5 * bw_grid_look(f->flow.grid)->length[1]};
  const size_t n = body_circle_size(R, f->h);
  BW_TRY(body_surface_alloc(comm, n, s));
  body_circle(s, 0, n, centre, R, f->h);
  return BW_OK;
}

static inline bw_status cylinder_make_body(const bw_comm *comm, cylinder_flow *f)
{
  bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  config.kernel = (bw_kernel_delta_id)f->config.kernel;
  config.n_iter = f->config.n_iter;
  config.memory = f->config.memory;
  BW_TRY(bw_ibm_mdf_create(f->flow.grid, &config, &f->flow.body));
  /* On the true surface, or inside it (ERRATA 21). */
  const bool retracted = !isnan(f->config.retraction) || config.memory == 0.0;
  f->flow.nu = retracted ? 0.0 : 1.0 / f->config.reynolds;
  if (isnan(f->config.retraction))
    f->config.retraction = retracted ? bw_ibm_mdf_retraction(&config) : 0.0;
  BW_TRY(cylinder_surface(comm, f, 0.5 - f->config.retraction * f->h, &f->markers));
  return body_set_markers(&f->flow, &f->markers);
}

static inline bw_status cylinder_make_probes(const bw_comm *comm, cylinder_flow *f)
{
  BW_TRY(cylinder_surface(comm, f, 0.5, &f->wall)); /* nominal surface, d = 1 */
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&f->traction, 3 * f->wall.n)));
  f->area = acos(-1.0) / (double)body_circle_size(0.5, f->h) * f->h;
  /* Both profiles read the same flow. */
  for (int p = 0; p < 2; p++) {
    bw_probe_config config = bw_probe_config_default();
    config.rho = 1.0;
    config.nu = 1.0 / f->config.reynolds;
    config.length = f->config.probe_length;
    config.profile = p == 0 ? BW_PROBE_LINEAR : BW_PROBE_QUADRATIC;
    BW_TRY(bw_probe_create(f->flow.grid, &config, &f->probe[p]));
    BW_TRY(bw_probe_set_points(f->probe[p], f->wall.n, f->wall.X, f->wall.N));
  }
  return BW_OK;
}

/* The first step [d/U_b] where the fluid alone bears `limit`: the flow does not feel the cylinder
 * yet, past which it will be twice as fast as in the middle of the channel (potential flow, 3 U_b),
 * or as fast as the gaps at the walls make it (plane flow in them, 1.5 U_b/(1 - blockage)). */
static inline double cylinder_first_step(const cylinder_config *c, double limit)
{
  const double past = fmax(3.0, 1.5 / (1.0 - c->blockage)) * c->cells_per_diameter;
  return c->dt_fraction * fmin(limit, sqrt(3.0) / past);
}

/* The longest step of the flow as it is [d/U_b]. Collective. */
static inline double cylinder_longest_step(cylinder_flow *f)
{
  const double limit = bw_ns_channel_dt_max(f->flow.fluid);
  const bool start = bw_ns_channel_time(f->flow.fluid) == 0.0;
  return start ? cylinder_first_step(&f->config, limit) : f->config.dt_fraction * limit;
}

/* Everything, at t = 0 with Poiseuille flow. Destroy also after a failure. Collective. */
static inline bw_status cylinder_create(const bw_comm *comm, const cylinder_config *config,
                                        cylinder_flow *f)
{
  *f = (cylinder_flow){.config = *config};
  BW_TRY(cylinder_make_fluid(comm, f));
  BW_TRY(cylinder_make_body(comm, f));
  BW_TRY(body_flow_ready(&f->flow, cylinder_longest_step(f)));
  return cylinder_make_probes(comm, f);
}

/* Drag coefficients of the last step. Collective. */
static inline cylinder_drag cylinder_measure(cylinder_flow *f)
{
  const double scale = 2.0 / f->h; /* 1/(0.5 rho U_b^2 d depth) */
  bw_real *const *u = bw_ns_channel_velocity(f->flow.fluid);
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(f->flow.body, u);
  /* Force of the markers on the fluid, reversed (ERRATA 18). */
  cylinder_drag drag = {.reaction = -scale * r.total_force[0], .slip = r.slip_after};
  double box[3];
  bw_ns_channel_control_volume(f->flow.fluid, box);
  drag.control_volume = -scale * box[0];
  /* Traction times area, from the pressure that acted over the step. */
  for (int p = 0; p < 2; p++) {
    bw_probe_traction(f->probe[p], u, f->flow.pressure, NULL, f->traction, NULL);
    for (size_t q = 0; q < f->wall.n; q++)
      drag.probe[p] += scale * f->area * f->traction[3 * q];
  }
  bw_comm_sum(bw_grid_comm(f->flow.grid), 2, drag.probe);
  return drag;
}

/* The next of as few equal steps as lead to `end`; `left`: how many are to follow. Collective. */
static inline bw_status cylinder_step(cylinder_flow *f, double end, double *left)
{
  const double span = end - bw_ns_channel_time(f->flow.fluid);
  const double steps = fmax(1.0, ceil(span / cylinder_longest_step(f) - 1e-9));
  f->flow.dt = span / steps;
  *left = steps - 1.0;
  return body_flow_step(&f->flow);
}

/* Steps until `interval` later. Collective. */
static inline bw_status cylinder_advance(cylinder_flow *f, double interval)
{
  const double end = bw_ns_channel_time(f->flow.fluid) + interval;
  for (double left = 1.0; left > 0.0;)
    BW_TRY(cylinder_step(f, end, &left));
  return BW_OK;
}
