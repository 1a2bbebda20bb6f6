/* A Taylor-Green vortex dies out in a periodic box: energy against its exact decay.
 *
 * u = U sin(k x) cos(k y), v = -U cos(k x) sin(k y), k = 2 pi/L, solves the Navier-Stokes equations
 * in the plane with the factor exp(-2 nu k^2 t) (Taylor and Green 1937), its energy with the
 * square.
 * Run:   mpirun -n 2 build/bin/taylor_green cases/taylor_green/taylor_green.yaml --out out/vortex
 * BUILD modules=ns_channel,vtk */
#include "bw_case.h"
#include "bw_history.h"
#include "bw_memory.h"
#include "bw_ns_channel.h"
#include "bw_stop.h"
#include "bw_vtk.h"

#include <limits.h>
#include <math.h>

static const double pi = 3.14159265358979323846;

/* ---- what the YAML file says ---- */
typedef struct {
  double length, velocity, viscosity; /* [L], [L/T], [L^2/T] */
  int cells;
} vortex_flow;
typedef struct {
  double end, sample_every; /* [T] */
} vortex_time;
typedef struct {
  vortex_flow flow;
  vortex_time time;
} vortex_config;

#define V BW_CONFIG_VALUE
static const bw_config_field flow_fields[] = {
    V(vortex_flow, length, BW_OPTIONAL, BW_ABOVE(0), "L", "edge of the box"),
    V(vortex_flow, velocity, BW_OPTIONAL, BW_ABOVE(0), "L/T", "largest velocity at the start"),
    V(vortex_flow, viscosity, BW_REQUIRED, BW_ABOVE(0), "L2/T", "kinematic"),
    V(vortex_flow, cells, BW_REQUIRED, BW_AT_LEAST(4), "", "along an edge"), BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(vortex_time, end, BW_REQUIRED, BW_ABOVE(0), "T", "of the run"),
    V(vortex_time, sample_every, BW_REQUIRED, BW_ABOVE(0), "T", "rows of history.csv"),
    BW_CONFIG_END};
static const bw_config_field vortex_fields[] = {
    BW_CONFIG_MAP(vortex_config, flow, flow_fields, "box and fluid"),
    BW_CONFIG_MAP(vortex_config, time, time_fields, "how long, how often"), BW_CONFIG_END};

/* Not set, and therefore asked for by name: NAN, INT_MIN. */
static vortex_config vortex_config_default(void)
{
  return (vortex_config){
      .flow = {.length = 1.0, .velocity = 1.0, .viscosity = NAN, .cells = INT_MIN},
      .time = {.end = NAN, .sample_every = NAN}};
}

/* What no range of a single key can say. */
static bw_status check(const vortex_config *c)
{
  const double samples = c->time.end / c->time.sample_every;
  BW_REQUIRE(fabs(samples - round(samples)) < 1e-9 * samples, BW_EINPUT,
             "time.end = %g is %g times time.sample_every = %g; it must be a whole number of times",
             c->time.end, samples, c->time.sample_every);
  return BW_OK;
}

/* ---- the run ---- */
typedef struct {
  const vortex_config *config;
  bw_case *run;
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_history *history;
} vortex;

static void start_velocity(const double x[3], double t, void *context, double u[3])
{
  const vortex_flow *f = context;
  const double k = 2.0 * pi / f->length;
  (void)t;
  u[0] = f->velocity * sin(k * x[0]) * cos(k * x[1]);
  u[1] = -f->velocity * cos(k * x[0]) * sin(k * x[1]);
  u[2] = 0.0;
}

static bw_status create(vortex *q, const bw_comm *comm)
{
  vortex_flow flow = q->config->flow;
  bw_grid_config box = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  fluid.nu = flow.viscosity;
  for (int d = 0; d < 3; d++) {
    box.n[d] = d < 2 ? flow.cells : 1; /* one cell in z: two dimensions */
    box.length[d] = d < 2 ? flow.length : flow.length / flow.cells;
    box.periodic[d] = true;
    fluid.side[d][0].kind = fluid.side[d][1].kind = BW_SIDE_PERIODIC;
  }
  BW_TRY(bw_grid_create(comm, &box, &q->grid));
  BW_TRY(bw_ns_channel_create(q->grid, &fluid, &q->fluid));
  return bw_ns_channel_set_velocity(q->fluid, start_velocity, &flow, 0.0);
}

static void destroy(vortex *q)
{
  bw_ns_channel_destroy(&q->fluid);
  bw_grid_destroy(&q->grid);
}

/* A row of history.csv: a unit in every name. */
static bw_status open_history(vortex *q)
{
  static const char *const names[] = {"time[T]", "energy_over_start[-]", "exact[-]"};
  return bw_case_history(q->run, 3, names, (double)NAN, -1, &q->history);
}

static void sample(vortex *q, double first)
{
  const vortex_flow *f = &q->config->flow;
  const double k = 2.0 * pi / f->length, t = bw_ns_channel_time(q->fluid);
  const double now = bw_ns_channel_summary(q->fluid).kinetic_energy / first;
  const double row[] = {t, now, exp(-4.0 * f->viscosity * k * k * t)};
  bw_history_append(q->history, row);
}

/* A picture that ParaView opens: fluid.pvd lists it. */
static bw_status picture(vortex *q, const char *name)
{
  bw_real *const *u = bw_ns_channel_velocity(q->fluid);
  const bw_vtk_field field = {.name = "velocity", .data = {u[0], u[1], u[2]}, .staggered = true};
  char *path = NULL, *series = NULL;
  bw_status st = bw_case_path(q->run, name, &path);
  BW_THEN(st, bw_case_path(q->run, "fluid.pvd", &series));
  BW_THEN(st, bw_vtk_write_grid(q->grid, path, bw_ns_channel_time(q->fluid), 1, &field));
  BW_THEN(st, bw_vtk_series_add(bw_grid_comm(q->grid), series, bw_ns_channel_time(q->fluid), name));
  bw_release(&path);
  bw_release(&series);
  return st;
}

/* Steps of equal length, none beyond what is stable, that end on the next sample. */
static bw_status advance(vortex *q, double until)
{
  for (int left = 1; left > 0; left--) {
    const double span = until - bw_ns_channel_time(q->fluid);
    left = (int)ceil(span / (0.8 * bw_ns_channel_dt_max(q->fluid)) * (1.0 - 1e-12));
    BW_TRY(bw_ns_channel_step(q->fluid, span / left));
  }
  return BW_OK;
}

static bw_status run_to_end(vortex *q)
{
  const vortex_time *time = &q->config->time;
  const double first = bw_ns_channel_summary(q->fluid).kinetic_energy;
  const int samples = (int)lround(time->end / time->sample_every);
  sample(q, first);
  for (int i = 1; i <= samples; i++) {
    /* All ranks hear of a signal at the same step. */
    if (bw_case_stopping(q->run)) return bw_case_unfinished(q->run, NULL);
    BW_TRY(advance(q, i * time->sample_every));
    sample(q, first);
  }
  return picture(q, "fluid-end.vti");
}

static bw_status run_case(vortex *q, const bw_comm *comm)
{
  const bw_case_args *args = bw_case_args_of(q->run);
  BW_TRY(check(q->config));
  BW_TRY(create(q, comm));
  bw_log_info(bw_case_log(q->run), "%d x %d cells, Re = U L/nu = %g, largest stable step %.3g",
              q->config->flow.cells, q->config->flow.cells,
              q->config->flow.velocity * q->config->flow.length / q->config->flow.viscosity,
              bw_ns_channel_dt_max(q->fluid));
  if (args->check) return BW_OK;
  BW_TRY(open_history(q));
  bw_stop_install();
  return run_to_end(q);
}

/* Whatever happened, what was made is released. */
static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  vortex q = {.config = config, .run = run};
  bw_status st = run_case(&q, comm);
  const bw_status closed = bw_history_close(comm, &q.history);
  BW_THEN(st, closed);
  destroy(&q);
  return st;
}

int main(int argc, char **argv)
{
  vortex_config config = vortex_config_default();
  const bw_case_about about = {"taylor_green", "a vortex that dies out", vortex_fields,
                               sizeof config, NULL}; /* no checkpoints */
  return bw_case_main(argc, argv, &about, &config, simulate);
}
