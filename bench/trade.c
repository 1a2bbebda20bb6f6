/* What accuracy costs: error against a reference and the work it took, for the choices a user has.
 *
 * cylinder     drag at Re_d 25 against finite elements (data/confined_cylinder: 4.788), by grid,
 *              kernel, forcing iterations and retraction; core-seconds to the steady state
 * vortex       Taylor-Green carried along by a stream against its closed form, by grid, step and
 *              viscous term; core-seconds
 * wave         speed of a plane P wave 32 spacings long against the classical one (nu = 1/4:
 *              c^2 = 1.2 E/rho), by horizon and calibration; core-ns per particle while a wave
 *              crosses one spacing
 * oscillation  a standing wave 8 spacings long, three periods, against the same lattice's exact
 *              motion, by integrator and step over its limit; force evaluations per period
 * Core-seconds are processor time on one rank. Each case gives two rows, `error` and
 * `cost`; tools/plot_trade.py draws them.
 * BUILD modules=ns_channel,ibm_mdf,probe,solid,solid_tools
 * TEST ranks=1 */
#include "../cases/cylinder_drag/cylinder_flow.h"
#include "bw_bench.h"
#include "bw_solid.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double TURN = 6.283185307179586;

typedef struct {
  double error, cost;
} trade;

static double core_seconds(void)
{
  return (double)clock() / CLOCKS_PER_SEC;
}

static void put(bw_bench *b, const char *name, const char *unit, trade t)
{
  bw_bench_put(b, &(bw_bench_row){name, "error", "-", t.error, NULL, NAN, NAN});
  bw_bench_put(b, &(bw_bench_row){name, "cost", unit, t.cost, NULL, NAN, NAN});
}

/* ---- cylinder ---- */

typedef struct {
  const char *name; /* curve/point */
  int cells, kernel, n_iter;
  double retraction; /* in spacings; NAN: the best one of that kernel and N_s, at Re_d 20 */
} cylinder_choice;

static const cylinder_choice cylinders[] = {
    {"grid, retracted/8 cells", 8, BW_KERNEL_ROMA3, 2, NAN},
    {"grid, retracted/15 cells", 15, BW_KERNEL_ROMA3, 2, NAN},
    {"grid, retracted/30 cells", 30, BW_KERNEL_ROMA3, 2, NAN},
    {"grid, not retracted/8 cells", 8, BW_KERNEL_ROMA3, 2, 0.0},
    {"grid, not retracted/15 cells", 15, BW_KERNEL_ROMA3, 2, 0.0},
    {"grid, not retracted/30 cells", 30, BW_KERNEL_ROMA3, 2, 0.0},
    {"iterations, 15 cells/N_s 1", 15, BW_KERNEL_ROMA3, 1, NAN},
    {"iterations, 15 cells/N_s 4", 15, BW_KERNEL_ROMA3, 4, NAN},
    {"iterations, 15 cells/N_s 8", 15, BW_KERNEL_ROMA3, 8, NAN},
    {"kernel, 15 cells/peskin4", 15, BW_KERNEL_PESKIN4, 2, NAN},
    {"kernel, 15 cells/hat2", 15, BW_KERNEL_HAT2, 2, NAN}};

static bw_status cylinder(const bw_comm *comm, const cylinder_choice *q, trade *out)
{
  const double finite_elements = 4.788, settled = 30.0; /* d/U_b: steady to 1e-4 */
  cylinder_config c = cylinder_config_default();
  cylinder_flow f;
  c.reynolds = 25.0;
  c.cells_per_diameter = q->cells, c.kernel = q->kernel, c.n_iter = q->n_iter;
  c.retraction = q->retraction;
  /* From nothing to the steady state: all that a user waits for. */
  const double start = core_seconds();
  bw_status st = cylinder_create(comm, &c, &f);
  BW_THEN(st, cylinder_advance(&f, settled));
  if (st == BW_OK) {
    out->error = fabs(cylinder_measure(&f).reaction / finite_elements - 1.0);
    out->cost = core_seconds() - start;
  }
  cylinder_destroy(&f);
  return st;
}

static bw_status study_cylinder(bw_bench *b, const bw_comm *comm)
{
  for (size_t q = 0; q < sizeof cylinders / sizeof *cylinders; q++) {
    trade t = {NAN, NAN};
    char name[96];
    BW_TRY(cylinder(comm, &cylinders[q], &t));
    snprintf(name, sizeof name, "cylinder/%s", cylinders[q].name);
    put(b, name, "core-s", t);
  }
  return BW_OK;
}

/* ---- vortex ---- */

typedef struct {
  const char *name; /* curve/point */
  int n;
  double nu, share; /* of the largest stable step */
  bw_ns_viscous viscous;
} vortex_choice;

static const vortex_choice vortices[] = {
    {"grid, 0.9 of the limit/16 cells", 16, 0.05, 0.9, BW_VISCOUS_EXPLICIT},
    {"grid, 0.9 of the limit/32 cells", 32, 0.05, 0.9, BW_VISCOUS_EXPLICIT},
    {"grid, 0.9 of the limit/64 cells", 64, 0.05, 0.9, BW_VISCOUS_EXPLICIT},
    {"grid, 0.9 of the limit/128 cells", 128, 0.05, 0.9, BW_VISCOUS_EXPLICIT},
    {"step, 64 cells/0.45", 64, 0.05, 0.45, BW_VISCOUS_EXPLICIT},
    {"step, 64 cells/0.22", 64, 0.05, 0.225, BW_VISCOUS_EXPLICIT},
    {"20 times as viscous, 64 cells/explicit", 64, 1.0, 0.9, BW_VISCOUS_EXPLICIT},
    {"20 times as viscous, 64 cells/implicit_y", 64, 1.0, 0.9, BW_VISCOUS_IMPLICIT_Y},
    {"20 times as viscous, 64 cells/implicit 0.9", 64, 1.0, 0.9, BW_VISCOUS_IMPLICIT},
    {"20 times as viscous, 64 cells/implicit 0.3", 64, 1.0, 0.3, BW_VISCOUS_IMPLICIT}};

static void vortex_velocity(const double x[3], double t, void *context, double u[3])
{
  const double f = exp(-2.0 * *(const double *)context * t), a = x[0] - t, b = x[1] - 0.5 * t;
  u[0] = 1.0 + sin(a) * cos(b) * f;
  u[1] = 0.5 - cos(a) * sin(b) * f;
  u[2] = 0.0;
}

/* Largest error of u over its points. */
static double vortex_error(bw_ns_channel *ns, double nu)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  double most = 0.0, exact[3];
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++) {
      const double x[3] = {i * g->spacing[0], (j - 0.5) * g->spacing[1], 0.0};
      vortex_velocity(x, bw_ns_channel_time(ns), &nu, exact);
      most = fmax(most, fabs((double)bw_ns_channel_velocity(ns)[0][bw_at(g, i, j, 1)] - exact[0]));
    }
  return most;
}

static bw_status vortex(const bw_comm *comm, const vortex_choice *q, trade *out)
{
  const double end = 0.5;
  double nu = q->nu;
  bw_grid_config g = bw_grid_config_default();
  bw_ns_channel_config c = bw_ns_channel_config_default();
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  g.n[0] = g.n[1] = q->n, g.n[2] = 1;
  g.length[0] = g.length[1] = TURN, g.length[2] = 1.0;
  for (int d = 0; d < 3; d++) {
    g.periodic[d] = true;
    c.side[d][0].kind = c.side[d][1].kind = BW_SIDE_PERIODIC;
  }
  c.nu = nu, c.viscous = q->viscous;
  bw_status st = bw_grid_create(comm, &g, &grid);
  BW_THEN(st, bw_ns_channel_create(grid, &c, &ns));
  /* The same flow three times; the shortest time counts, the error is the same. */
  for (int repetition = 0; st == BW_OK && repetition < 3; repetition++) { /* the first warms up */
    st = bw_ns_channel_set_velocity(ns, vortex_velocity, &nu, 0.0);
    const int steps = (int)ceil(end / (q->share * bw_ns_channel_dt_max(ns)));
    const double start = core_seconds();
    for (int step = 0; st == BW_OK && step < steps; step++)
      st = bw_ns_channel_step(ns, end / steps);
    *out = (trade){vortex_error(ns, nu), fmin(out->cost, core_seconds() - start)};
  }
  bw_ns_channel_destroy(&ns);
  bw_grid_destroy(&grid);
  return st;
}

static bw_status study_vortex(bw_bench *b, const bw_comm *comm)
{
  for (size_t q = 0; q < sizeof vortices / sizeof *vortices; q++) {
    trade t = {NAN, INFINITY};
    char name[96];
    BW_TRY(vortex(comm, &vortices[q], &t));
    snprintf(name, sizeof name, "vortex/%s", vortices[q].name);
    put(b, name, "core-s", t);
  }
  return BW_OK;
}

/* ---- waves in the solid: a periodic block, moved along x by A sin(k x); k A = 1e-4 is a strain
 * at which brittle solids break, and what single precision has to resolve ---- */

static const double YOUNG = 1.0, DENSITY = 1.0, STRAIN = 1e-4;

typedef struct {
  bw_solid *pd;
  size_t n;
  double k, amplitude;
  double *X, *V, *A, *shape; /* (n,3), (n,3), (n,3), (n): sin(k x) */
} wave_body;

static void wave_destroy(wave_body *w)
{
  bw_solid_destroy(&w->pd);
  bw_release(&w->X);
  bw_release(&w->V);
  bw_release(&w->A);
  bw_release(&w->shape);
}

/* size: particles per direction; one wave over size[0]. Destroy also after a failure. */
static bw_status wave_create(const bw_comm *comm, bw_solid_config c, const int size[3],
                             wave_body *w)
{
  const int64_t rank = bw_comm_rank(comm), ranks = bw_comm_size(comm);
  const int64_t all = (int64_t)size[0] * size[1] * size[2];
  const int64_t first = all * rank / ranks, n = all * (rank + 1) / ranks - first;
  int32_t *site = NULL;
  *w = (wave_body){0};
  c.ds = 1.0, c.rho = DENSITY, c.E = YOUNG;
  for (int d = 0; d < 3; d++)
    c.period[d] = size[d];
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&site, 3 * (size_t)n));
  /* A block that is periodic in all directions has no surface. Each rank gives its part of it. */
  for (int64_t q = 0; st == BW_OK && q < n; q++) {
    const int64_t id = first + q;
    site[3 * q] = (int32_t)(id % size[0]);
    site[3 * q + 1] = (int32_t)(id / size[0] % size[1]);
    site[3 * q + 2] = (int32_t)(id / size[0] / size[1]);
  }
  BW_THEN(st, bw_solid_create(comm, &c, &(bw_pd_sites){n, site, NULL, NULL}, &w->pd));
  bw_release(&site);
  BW_TRY(st);
  w->n = bw_solid_count(w->pd);
  w->k = TURN / size[0], w->amplitude = STRAIN / w->k;
  BW_TRY(BW_ALLOCATE(&w->X, 3 * w->n));
  BW_TRY(BW_ALLOCATE(&w->V, 3 * w->n));
  BW_TRY(BW_ALLOCATE(&w->A, 3 * w->n));
  BW_TRY(BW_ALLOCATE(&w->shape, w->n));
  bw_solid_get_reference(w->pd, w->X);
  /* Displaced by one wave along x, at rest. */
  for (size_t i = 0; i < w->n; i++) {
    w->shape[i] = sin(w->k * w->X[3 * i]);
    w->X[3 * i] += w->amplitude * w->shape[i];
  }
  bw_solid_set_state(w->pd, w->X, w->V);
  return BW_OK;
}

/* Of a field along x: its part along the wave. */
static double wave_part(const wave_body *w, const double field[])
{
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < w->n; i++) {
    sum += field[3 * i] * w->shape[i];
    squares += w->shape[i] * w->shape[i];
  }
  return sum / squares;
}

/* The wave is a mode of the lattice: its frequency from the acceleration. */
static bw_status wave_frequency(wave_body *w, double *omega)
{
  bw_solid_ledger e; /* not wanted: making it evaluates the force */
  BW_TRY(bw_solid_account(w->pd, &e));
  bw_solid_get_acceleration(w->pd, w->A);
  *omega = sqrt(-wave_part(w, w->A) / w->amplitude);
  return BW_OK;
}

/* Core-seconds in which a wave of unit speed crosses a unit length; the first steps warm up. */
static bw_status wave_cost(bw_solid *pd, double *seconds)
{
  enum { WARM = 2, STEPS = 20 };
  const double dt = 0.9 * bw_solid_dt_max(pd);
  double start = 0.0;
  /* Time per unit of simulated time, at 0.9 of the limit. */
  for (int q = 0; q < WARM + STEPS; q++) {
    if (q == WARM) start = core_seconds();
    BW_TRY(bw_solid_step(pd, dt));
  }
  *seconds = (core_seconds() - start) / (STEPS * dt);
  return BW_OK;
}

static bw_status study_wave(bw_bench *b, const bw_comm *comm)
{
  static const char *const calibration[] = {"integrals", "lattice"};
  const int length = 32;
  const double speed = sqrt(1.2 * YOUNG / DENSITY);
  for (int q = 0; q < 10; q++) {
    bw_solid_config c = bw_solid_config_default();
    wave_body w;
    char name[96];
    c.horizon_ratio = 2 + q % 5;
    c.calibration = q < 5 ? BW_PD_CALIBRATION_NONE : BW_PD_CALIBRATION_LATTICE;
    bw_status st = wave_create(comm, c, (int[3]){length, length, length}, &w);
    /* Speed omega/k against the classical one; the wave is 32 spacings long. */
    double seconds = NAN, omega = NAN;
    BW_THEN(st, wave_frequency(&w, &omega));
    const double error = fabs(omega / w.k / speed - 1.0);
    BW_THEN(st, wave_cost(w.pd, &seconds));
    snprintf(name, sizeof name, "wave/constants from %s/m %g", calibration[q / 5], c.horizon_ratio);
    if (st == BW_OK) put(b, name, "core-ns", (trade){error, 1e9 * seconds / speed / (double)w.n});
    wave_destroy(&w);
    BW_TRY(st);
  }
  return BW_OK;
}

/* Error of the standing wave after three periods, over its amplitude. */
static bw_status oscillation(const bw_comm *comm, bw_solid_integrator integrator, double share,
                             trade *out)
{
  enum { PERIODS = 3 };
  bw_solid_config c = bw_solid_config_default();
  wave_body w;
  c.integrator = integrator;
  double omega = NAN;
  bw_status st = wave_create(comm, c, (int[3]){8, 1, 1}, &w);
  BW_THEN(st, wave_frequency(&w, &omega));
  if (st == BW_OK) {
    /* Against the lattice's own frequency: what is left is the integrator's error. */
    const double end = PERIODS * TURN / omega;
    const int steps = (int)ceil(end / (share * bw_solid_dt_max(w.pd)));
    for (int q = 0; st == BW_OK && q < steps; q++)
      st = bw_solid_step(w.pd, end / steps);
    bw_solid_get_position(w.pd, w.X);
    bw_solid_get_velocity(w.pd, w.V);
    bw_solid_get_reference(w.pd, w.A);
    /* Displacements. */
    for (size_t i = 0; i < 3 * w.n; i++)
      w.X[i] -= w.A[i];
    /* Distance in the plane of displacement and velocity, over the amplitude. */
    out->error =
        hypot(wave_part(&w, w.X) / w.amplitude - 1.0, wave_part(&w, w.V) / (omega * w.amplitude));
    out->cost = (double)steps * (integrator == BW_SOLID_RK3 ? 3 : 1) / PERIODS;
  }
  wave_destroy(&w);
  return st;
}

static bw_status study_oscillation(bw_bench *b, const bw_comm *comm)
{
  static const char *const integrator[] = {
      [BW_SOLID_VERLET] = "velocity Verlet", [BW_SOLID_RK3] = "RK3"};
  for (int q = 0; q < 2; q++)
    for (double share = 0.95; share > 0.1; share /= 2.0) {
      trade t = {NAN, NAN};
      char name[96];
      BW_TRY(oscillation(comm, (bw_solid_integrator)q, share, &t));
      snprintf(name, sizeof name, "oscillation/%s/%.2g", integrator[q], share);
      put(b, name, "evaluations", t);
    }
  return BW_OK;
}

static bw_status studies(bw_bench *b, const bw_comm *self)
{
  BW_TRY(study_oscillation(b, self));
  BW_TRY(study_wave(b, self));
  BW_TRY(study_vortex(b, self));
  return study_cylinder(b, self);
}

/* All on rank 0: others wait. */
static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  bw_comm *self = NULL;
  bw_status st = bw_comm_self(&self);
  if (bw_comm_rank(comm) == 0) BW_THEN(st, studies(b, self));
  st = bw_comm_agree(comm, st);
  bw_comm_destroy(&self);
  return st;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "trade", run);
}
