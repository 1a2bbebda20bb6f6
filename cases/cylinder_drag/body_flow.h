/* body_flow.h -- a box of fluid with surfaces of markers in it: the step, the pressure that acted,
 * markers on circles and spheres. Shared by cylinder_flow.h and the validations of ibm_mdf and
 * probe.
 *
 * body_flow_box makes a box of cubic cells that is periodic or walled; who needs another one makes
 * grid, fluid and body and calls body_flow_ready. */
#pragma once
#include "bw_ibm_mdf.h"
#include "bw_memory.h"
#include "bw_ns_channel.h"

#include <math.h>

/* The objects of a flow with bodies. */
typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_ibm_mdf *body;
  bw_real *pressure; /* that acted over the last step, see body_flow_step */
  bw_real *drive[3]; /* acceleration of the fluid at the points of u [L/T^2]; NULL: none */
  double dt;         /* step [T] */
  double nu;         /* viscosity of markers on the true surface (bw_ibm_mdf_set_normals); 0: they
                        are retracted */
} body_flow;

static inline void body_flow_destroy(body_flow *f)
{
  bw_release(&f->pressure);
  for (int d = 0; d < 3; d++)
    bw_release(&f->drive[d]);
  bw_ibm_mdf_destroy(&f->body);
  bw_ns_channel_destroy(&f->fluid);
  bw_grid_destroy(&f->grid);
}

/* For bw_ibm_mdf_set_ghosts. */
static inline void body_ghosts(void *fluid)
{
  bw_ns_channel_ghosts(fluid);
}

/* The last of the making: ghosts, the step, the field of the pressure that acts. Collective. */
static inline bw_status body_flow_ready(body_flow *f, double dt)
{
  f->dt = dt;
  bw_ibm_mdf_set_ghosts(f->body, body_ghosts, f->fluid);
  return bw_comm_agree(bw_grid_comm(f->grid), bw_field_create(f->grid, &f->pressure));
}

/* A box of cubic cells. */
typedef struct {
  int n[3];         /* cells; n[2] = 1: flat */
  double h, nu;     /* edge of a cell [L], viscosity [L^2/T] */
  bool periodic[3]; /* else walls at rest; z of a flat box is periodic */
  bw_ns_forcing forcing;
  double forcing_value;
  bw_ibm_mdf_config body; /* forcing at the markers */
} body_box;

/* Fluid at rest, no markers yet; f->dt is the caller's to choose. Destroy also after a failure. */
static inline bw_status body_flow_box(const bw_comm *comm, const body_box *b, body_flow *f)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  *f = (body_flow){0};
  grid.halo = 2;
  /* A flat box is one periodic cell deep. */
  for (int d = 0; d < 3; d++) {
    grid.n[d] = b->n[d];
    grid.length[d] = b->n[d] * b->h;
    grid.periodic[d] = b->periodic[d] || b->n[d] == 1;
    fluid.side[d][0].kind = fluid.side[d][1].kind =
        grid.periodic[d] ? BW_SIDE_PERIODIC : BW_SIDE_WALL;
  }
  fluid.nu = b->nu;
  fluid.forcing = b->forcing;
  fluid.forcing_value = b->forcing_value;
  BW_TRY(bw_grid_create(comm, &grid, &f->grid));
  BW_TRY(bw_ns_channel_create(f->grid, &fluid, &f->fluid));
  BW_TRY(bw_ibm_mdf_create(f->grid, &b->body, &f->body));
  f->nu = b->body.memory > 0.0 ? b->nu : 0.0;
  return body_flow_ready(f, NAN);
}

/* One step of f->dt with the markers where they are. Collective.
 * The body takes its momentum with the full dt in every sub-step while pressure acts for gamma_r
 * dt only, so as long as slip remains p swings from sub-step to sub-step (by 20 % of a cylinder's
 * drag with two iterations). What acted over the step is the mean sum gamma_r p_r: kept for
 * probes. */
static inline bw_status body_flow_step(body_flow *f)
{
  static const double gamma[3] = {8.0 / 15.0, 2.0 / 15.0, 1.0 / 3.0}; /* bw_ns_channel.h */
  const bw_real *p = bw_ns_channel_pressure(f->fluid);
  bw_real *const *u = bw_ns_channel_velocity(f->fluid);
  const size_t size = bw_grid_look(f->grid)->size;
  BW_TRY(bw_ns_channel_check(f->fluid, f->dt));
  /* The markers' force is summed over the three sub-steps. */
  bw_ibm_mdf_begin_step(f->body);
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(f->fluid, r, f->dt);
    /* A body force acts as the pressure gradient does, with gamma_r dt. */
    for (int d = 0; d < 3; d++) /* halos too: predict leaves them valid */
      for (size_t q = 0; f->drive[d] != NULL && q < size; q++)
        u[d][q] += (bw_real)(gamma[r] * f->dt) * f->drive[d][q];
    /* No slip, with the full dt (ERRATA 18). */
    bw_ibm_mdf_force(f->body, u, f->dt);
    bw_ns_channel_project(f->fluid, r, f->dt);
    for (size_t q = 0; q < size; q++)
      f->pressure[q] = (r == 0 ? 0 : f->pressure[q]) + (bw_real)gamma[r] * p[q];
  }
  return BW_OK;
}

/* Points, normals and volumes of surfaces: n on rank 0, none on the others. */
typedef struct {
  size_t n;
  double *X, *N, *V, *dV; /* (n,3) (n,3) (n,3) (n) */
  double *M;              /* (n,3) memory of the markers */
  int *closed;            /* (n) which of n_closed surfaces, each around a body, the point is on */
  int n_closed;           /* on all ranks; 1: all points are on one; 0: sheets without an inside */
} body_surface;

static inline void body_surface_free(body_surface *s)
{
  bw_release(&s->X);
  bw_release(&s->N);
  bw_release(&s->V);
  bw_release(&s->dV);
  bw_release(&s->M);
  bw_release(&s->closed);
}

/* Room for n points of one closed surface on rank 0, zeros. Collective. */
static inline bw_status body_surface_alloc(const bw_comm *comm, size_t n, body_surface *s)
{
  *s = (body_surface){.n = bw_comm_rank(comm) == 0 ? n : 0, .n_closed = 1};
  bw_status st = BW_ALLOCATE(&s->X, 3 * s->n);
  BW_THEN(st, BW_ALLOCATE(&s->N, 3 * s->n));
  BW_THEN(st, BW_ALLOCATE(&s->V, 3 * s->n));
  BW_THEN(st, BW_ALLOCATE(&s->dV, s->n));
  BW_THEN(st, BW_ALLOCATE(&s->M, 3 * s->n));
  BW_THEN(st, BW_ALLOCATE(&s->closed, s->n));
  return bw_comm_agree(comm, st);
}

/* What stands on the true surface knows its side; the memory of what encloses a body holds no
 * pressure inside. Collective. */
static inline bw_status body_set_sides(body_flow *f, const body_surface *s)
{
  if (f->nu > 0.0) BW_TRY(bw_ibm_mdf_set_normals(f->body, s->N, f->nu));
  return s->n_closed > 0 ? bw_ibm_mdf_close(f->body, s->n_closed, s->closed, s->N) : BW_OK;
}

/* Makes the surface the markers of the flow: new ones, without a memory. Collective. */
static inline bw_status body_set_markers(body_flow *f, const body_surface *s)
{
  BW_TRY(bw_ibm_mdf_set_markers(f->body, s->n, s->X, s->V, s->dV, NULL));
  return body_set_sides(f, s);
}

/* The markers of the flow have moved; what they remember moves with them. Collective. */
static inline bw_status body_move_markers(body_flow *f, const body_surface *s)
{
  bw_ibm_mdf_memory(f->body, s->M);
  BW_TRY(bw_ibm_mdf_set_markers(f->body, s->n, s->X, s->V, s->dV, s->M));
  return body_set_sides(f, s);
}

/* The pressure inside that the memory of the markers holds: their mean force along the normals over
 * that in any direction [-]; 0 without memory. Begins the next step. Collective. */
static inline double body_pressure_inside(body_flow *f, body_surface *s)
{
  double sum[2] = {0.0, 0.0};
  bw_ibm_mdf_begin_step(f->body);
  bw_ibm_mdf_memory(f->body, s->M);
  for (size_t q = 0; q < 3 * s->n; q++)
    sum[0] += s->M[q] * s->N[q], sum[1] += fabs(s->M[q]);
  bw_comm_sum(bw_grid_comm(f->grid), 2, sum);
  return sum[1] > 0.0 ? sum[0] / sum[1] : 0.0;
}

/* Points about h apart around a circle of radius R. */
static inline size_t body_circle_size(double R, double h)
{
  return (size_t)lround(2.0 * acos(-1.0) * R / h);
}

/* Points from..from+n-1 (those that this rank has): a circle of radius R about (x, y) in the cell
 * of depth h in z, normals outward; dV = arc times h, times the depth. At rest. */
static inline void body_circle(body_surface *s, size_t from, size_t n, const double centre[2],
                               double R, double h)
{
  const double turn = 2.0 * acos(-1.0) / (double)n;
  for (size_t q = 0; q < n && from + q < s->n; q++) {
    /* Half a spacing off the axes, so that no point lies on the line of symmetry. */
    const double c = cos(turn * ((double)q + 0.5)), d = sin(turn * ((double)q + 0.5));
    double *X = s->X + 3 * (from + q), *N = s->N + 3 * (from + q);
    X[0] = centre[0] + R * c, X[1] = centre[1] + R * d, X[2] = 0.5 * h;
    N[0] = c, N[1] = d, N[2] = 0.0;
    s->dV[from + q] = turn * R * h * h;
  }
}

/* Points about h apart on a sphere of radius R. */
static inline size_t body_sphere_size(double R, double h)
{
  return (size_t)lround(4.0 * acos(-1.0) * R * R / (h * h));
}

/* All points (those that this rank has): a sphere of radius R about `centre`, evenly on a spiral,
 * normals outward; dV = area per point times h. At rest. */
static inline void body_sphere(body_surface *s, const double centre[3], double R, double h)
{
  const double pi = acos(-1.0), golden = pi * (3.0 - sqrt(5.0));
  for (size_t q = 0; q < s->n; q++) {
    /* Equal steps in height are equal areas; turned by the golden angle the points are even. */
    const double z = 1.0 - (2.0 * (double)q + 1.0) / (double)s->n, r = sqrt(1.0 - z * z);
    const double N[3] = {r * cos(golden * (double)q), r * sin(golden * (double)q), z};
    for (int d = 0; d < 3; d++) {
      s->N[3 * q + d] = N[d];
      s->X[3 * q + d] = centre[d] + R * N[d];
    }
    s->dV[q] = 4.0 * pi * R * R / (double)s->n * h;
  }
}
