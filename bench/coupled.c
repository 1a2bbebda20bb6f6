/* Cost of a coupled step by part: the porous medium of POROUS chapter 5 at 128 x 64 x 64, elastic.
 *
 * The scene of cases/porous_breakup/s1.yaml to s3.yaml, started from rest: cost does not depend on
 * how far the flow has settled; bonds hold a hundred times the energy of S1, as the jerk of the
 * start would break them. porous_full: load by probes; porous_full_reaction: by the markers'
 * reaction, as in those files. No rival ships this combination. Shares are of the wall time of a
 * step. Per marker and iteration [core-ns]: `kernels` is interpolation and spreading, `forcing`
 * also the forces for images on other blocks (what a halo exchange would be).
 * `interface_over_fluid` is forcing and probes over momentum and Poisson; goal 0.3.
 * BUILD modules=coupler,shape
 * TEST ranks=2 */
#include "bw_bench.h"
#include "bw_bench_porous.h"
#include "bw_coupler.h"

#include <math.h>

enum { REPETITIONS = 7, STEPS = 2, NX = 128, NY = BW_BENCH_CELLS, NZ = 64 };
static const double DT = 5.0e-5, WHOLE = 5.0; /* [s], fracture energy [J/m2] */

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
} scene;

static bw_status build_fluid(const bw_comm *comm, scene *s)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  grid.n[0] = NX, grid.n[1] = NY, grid.n[2] = NZ;
  grid.length[0] = 2.0 * bw_bench_height, grid.length[1] = grid.length[2] = bw_bench_height;
  grid.periodic[2] = true;
  grid.halo = 2;
  flow.nu = 1.0e-3;
  flow.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 0.1};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_grid_create(comm, &grid, &s->grid));
  return bw_ns_channel_create(s->grid, &flow, &s->fluid);
}

static bw_status build_coupler(scene *s, bw_coupler_load_kind load)
{
  bw_coupler_config c = bw_coupler_config_default();
  c.rho = 1000, c.nu = 1.0e-3, c.load = load;
  c.walled[1][0] = c.walled[1][1] = true;
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  /* The solid moves: its sub-steps are most of the cost. */
  bw_coupler_hold_solid(s->coupler, false);
  bw_coupler_watch(s->coupler, false); /* as in most steps of a run */
  return BW_OK;
}

enum {
  STEP,
  MOMENTUM,
  POISSON,
  IBM,
  PROBE,
  SOLID,
  SURFACE,
  KERNELS,
  FORCING,
  SET,
  OVER_FLUID,
  QUANTITIES
};
static const struct {
  const char *quantity, *unit;
} quantity[QUANTITIES] = {
    [STEP] = {"ms_per_step", "ms"},
    [MOMENTUM] = {"share_momentum", "-"},
    [POISSON] = {"share_poisson", "-"},
    [IBM] = {"share_ibm", "-"},
    [PROBE] = {"share_probe", "-"},
    [SOLID] = {"share_solid", "-"},
    [SURFACE] = {"share_surface", "-"},
    [KERNELS] = {"kernels_ns_per_marker_and_iteration", "core-ns"},
    [FORCING] = {"forcing_ns_per_marker_and_iteration", "core-ns"},
    [SET] = {"set_ns_per_marker", "core-ns"},
    [OVER_FLUID] = {"interface_over_fluid", "-"},
};

/* One repetition: a few steps, and what they cost by part. Collective. */
static bw_status repeat(const bw_comm *comm, scene *s, double value[QUANTITIES])
{
  static const bw_coupler_part part[] = {
      [MOMENTUM] = BW_PART_MOMENTUM, [POISSON] = BW_PART_POISSON, [IBM] = BW_PART_FORCING,
      [PROBE] = BW_PART_PROBES,      [SOLID] = BW_PART_SOLID,     [SURFACE] = BW_PART_SURFACE};
  bw_timer_row rows[BW_PART_COUNT + 1];
  double total = 0.0;
  /* All ranks begin together, with clocks at zero. */
  bw_comm_barrier(comm);
  bw_timer_reset(bw_coupler_timer(s->coupler));
  bw_ibm_mdf_cost_reset(bw_coupler_markers(s->coupler));
  for (int q = 0; q < STEPS; q++)
    BW_TRY(bw_coupler_step(s->coupler, DT));
  /* Parts by the coupler's own timer, markers by their module's. */
  bw_timer_summary(bw_coupler_timer(s->coupler), comm, rows, &total);
  const bw_ibm_mdf_cost cost = bw_ibm_mdf_cost_of(bw_coupler_markers(s->coupler));
  double sum[4] = {cost.kernels, cost.images, cost.set, (double)cost.forced};
  bw_comm_sum(comm, 4, sum);
  /* Per step, and per marker and iteration: three sub-steps of n_iter each. */
  value[STEP] = 1e3 * total / STEPS;
  for (int q = MOMENTUM; q <= SURFACE; q++)
    value[q] = rows[part[q]].share;
  value[KERNELS] = 1e9 * sum[0] / sum[3];
  value[FORCING] = 1e9 * (sum[0] + sum[1]) / sum[3];
  value[SET] = 1e9 * sum[2] * 3.0 * bw_ibm_mdf_config_default().n_iter / sum[3];
  value[OVER_FLUID] = (value[IBM] + value[PROBE]) / (value[MOMENTUM] + value[POISSON]);
  return BW_OK;
}

static bw_status report(bw_bench *b, scene *s, const char *name)
{
  double value[REPETITIONS][QUANTITIES], column[REPETITIONS];
  bw_coupler_report r;
  for (int q = 0; q < REPETITIONS; q++)
    BW_TRY(repeat(bw_bench_comm(b), s, value[q]));
  /* The median of each quantity by itself, over all repetitions. */
  for (int i = 0; i < QUANTITIES; i++) {
    for (int q = 0; q < REPETITIONS; q++)
      column[q] = value[q][i];
    bw_bench_put(b, &(bw_bench_row){name, quantity[i].quantity, quantity[i].unit,
                                    bw_bench_middle(REPETITIONS, column), NULL, NAN, NAN});
  }
  BW_TRY(bw_coupler_measure(s->coupler, &r));
  bw_bench_put(b, &(bw_bench_row){name, "markers", "-", (double)r.markers, NULL, NAN, NAN});
  bw_bench_put(b, &(bw_bench_row){name, "imbalance", "-", r.imbalance, NULL, NAN, NAN});
  return BW_OK;
}

static bw_status run_scene(bw_bench *b, const char *name, bw_coupler_load_kind load)
{
  const bw_comm *comm = bw_bench_comm(b);
  scene s = {.grid = NULL};
  bw_status st = build_fluid(comm, &s);
  BW_THEN(st, bw_bench_porous(comm, WHOLE, &s.solid));
  BW_THEN(st, build_coupler(&s, load));
  BW_THEN(st, bw_coupler_step(s.coupler, DT)); /* warms up */
  BW_THEN(st, report(b, &s, name));
  bw_coupler_destroy(&s.coupler);
  bw_solid_destroy(&s.solid);
  bw_ns_channel_destroy(&s.fluid);
  bw_grid_destroy(&s.grid);
  return st;
}

static bw_status run(bw_bench *b)
{
  BW_TRY(run_scene(b, "porous_full_np2", BW_LOAD_PROBES));
  return run_scene(b, "porous_full_reaction_np2", BW_LOAD_REACTION);
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "coupled", run);
}
