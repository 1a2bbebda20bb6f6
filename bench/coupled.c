/* Cost of a coupled step by part: the porous medium of POROUS chapter 5 at 128 x 64 x 64, elastic.
 *
 * The same scene as cases/porous_breakup/s1.yaml, started from rest: cost does not depend on how
 * far the flow has settled. No rival ships this combination. Shares are of the wall time of a step.
 * BUILD modules=coupler
 * TEST ranks=2 */
#include "bw_bench.h"
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_pd_shape.h"

#include <math.h>

enum { STEPS = 2, NX = 128, NY = 64, NZ = 64 };
static const double HEIGHT = 0.1, DT = 5.0e-5;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_pd_bond *solid;
  bw_coupler *coupler;
  bw_status st;
} scene;

static bw_status build_fluid(const bw_comm *comm, scene *s)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  grid.n[0] = NX, grid.n[1] = NY, grid.n[2] = NZ;
  grid.length[0] = 2.0 * HEIGHT, grid.length[1] = grid.length[2] = HEIGHT;
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

static bw_status build_solid(const bw_comm *comm, scene *s)
{
  const double h = HEIGHT, ds = h / NY, pitch = h / 4;
  const bw_shape body[] = {
      {.kind = BW_SHAPE_BOX, .lower = {0.25 * h, 0, 0}, .upper = {h, h, h}},
      {.kind = BW_SHAPE_PORES_SC,
       .remove = true,
       .radius = 0.5825 * pitch,
       .pitch = pitch,
       .centre = {0.25 * h + 0.5 * pitch, 0.5 * pitch, 0.5 * pitch}},
      {.kind = BW_SHAPE_BOX,
       .lower = {0.25 * h, -3 * ds, 0},
       .upper = {h, 0, h},
       .particle_kind = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE},
  };
  bw_pd_bond_config c = bw_pd_bond_config_default();
  c.ds = ds, c.rho = 3000, c.E = 1.0e8, c.G0 = 0.05, c.contact = true, c.period[2] = h;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = bw_pd_shape_fill(3, body, ds, c.origin, false, &n, &site, &kind);
  BW_THEN(st, bw_pd_bond_create(comm, &c, n, site, kind, &s->solid));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static bw_status build_coupler(scene *s)
{
  bw_coupler_config c = bw_coupler_config_default();
  c.rho = 1000, c.nu = 1.0e-3;
  c.walled[1][0] = c.walled[1][1] = true;
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
  return BW_OK;
}

static void advance(void *context)
{
  scene *s = context;
  for (int q = 0; q < STEPS; q++)
    BW_THEN(s->st, bw_coupler_step(s->coupler, DT));
}

static void report(bw_bench *b, const scene *s, double seconds)
{
  static const struct {
    const char *quantity;
    bw_coupler_part part;
  } shares[] = {{"share_momentum", BW_PART_MOMENTUM}, {"share_poisson", BW_PART_POISSON},
                {"share_ibm", BW_PART_FORCING},       {"share_probe", BW_PART_PROBES},
                {"share_solid", BW_PART_SOLID},       {"share_surface", BW_PART_SURFACE}};
  bw_timer_row rows[BW_PART_COUNT + 1];
  double total = 0.0;
  bw_timer_summary(bw_coupler_timer(s->coupler), bw_bench_comm(b), rows, &total);
  bw_bench_put(b, &(bw_bench_row){"porous_full_np2", "ms_per_step", "ms", 1e3 * seconds / STEPS,
                                  NULL, NAN, NAN});
  for (size_t q = 0; q < sizeof shares / sizeof *shares; q++)
    bw_bench_put(b, &(bw_bench_row){"porous_full_np2", shares[q].quantity, "-",
                                    rows[shares[q].part].share, NULL, NAN, NAN});
  bw_bench_put(b, &(bw_bench_row){"porous_full_np2", "forcing_ns_per_marker_and_iteration", "ns",
                                  rows[BW_PART_FORCING].ns_per_unit, NULL, NAN, NAN});
}

static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  scene s = {.st = BW_OK};
  bw_status st = build_fluid(comm, &s);
  BW_THEN(st, build_solid(comm, &s));
  BW_THEN(st, build_coupler(&s));
  if (st == BW_OK) {
    advance(&s);
    bw_timer_reset(bw_coupler_timer(s.coupler));
    const double seconds = bw_bench_median(comm, advance, &s);
    st = s.st;
    if (st == BW_OK) report(b, &s, seconds);
  }
  bw_coupler_destroy(&s.coupler);
  bw_pd_bond_destroy(&s.solid);
  bw_ns_channel_destroy(&s.fluid);
  bw_grid_destroy(&s.grid);
  return st;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "coupled", run);
}
