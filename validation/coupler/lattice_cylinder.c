/* Claim: a cylinder made of particles, whatever their number to a cell, has the drag of a cylinder.
 *
 * Held in the middle of a channel four diameters high, 8 d long, Re_d = 20.
 * Reference  an independent finite-element solution, data/confined_cylinder, for the diameter of
 *            the disc that has the particles' area: the drag goes with its 1.5th power or so (a
 *            cylinder that fills a quarter of the channel). Momentum of a box: the reaction.
 * Measured   with all that the coupler does by default, markers shared by particles closer than a
 *            cell: force of the markers; of the probes. Steady: the drag changes by less than 1e-4
 *            per d/U_b. Spacings of 1 to 0.2 cells, 15 and 30 cells across; not --full: three of
 *            the fourteen.
 * Tolerance  reaction: the surface is known to 0.1 h (Breugem 2012), and a disc of particles is
 *            round to 0.11 of their spacing, rms (tests/unit/pd_interface/test_height): twice the
 *            sum of the diameter, 3 to 6 % of the drag with 15 cells, half of it with 30.
 *            Probes: what they may miss on a true cylinder (validation/ibm_mdf/cylinder_drag: the
 *            friction's share, 35 %, of (dl/delta)^2/2 + 5 %), and the same of the diameter.
 *            Box and reaction are one to round-off of the accumulated fluxes.
 * BUILD modules=coupler,shape
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/cylinder_flow.h"
#include "bw_coupler.h"
#include "bw_validation.h"
#include "cylinder_of_particles.h"

#include <stdio.h>

static const double RE = 20.0, STEADY = 1e-4, LATEST = 40.0, FRICTION_SHARE = 0.35;

typedef struct {
  double h, wide; /* cell, diameter of the disc of the particles' area [d] */
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
} scene;

static void scene_destroy(scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

static bw_status make_fluid(const bw_comm *comm, const cylinder_config *c, scene *s)
{
  const bw_grid_config grid = cylinder_grid(c);
  const bw_ns_channel_config fluid = cylinder_fluid(c);
  const int d = c->cells_per_diameter, x = (int)(c->upstream * d), y = grid.n[1] / 2;
  double height = grid.length[1];
  s->h = 1.0 / d;
  BW_TRY(bw_grid_create(comm, &grid, &s->grid));
  BW_TRY(bw_ns_channel_create(s->grid, &fluid, &s->fluid));
  BW_TRY(bw_ns_channel_set_velocity(s->fluid, cylinder_poiseuille, &height, 0.0));
  return bw_ns_channel_watch_box(s->fluid, (int[3]){x - d, y - d, 0}, (int[3]){x + d, y + d, 1});
}

static bw_status make_solid(const bw_comm *comm, const cylinder_config *c, double ds, scene *s)
{
  const double height = bw_grid_look(s->grid)->length[1];
  bw_solid_config solid = bw_solid_config_default();
  solid.geometry = BW_PD_PLANE_STRAIN;
  solid.ds = ds, solid.thickness = s->h;
  solid.rho = solid.E = 1.0;
  solid.origin[2] = 0.5 * s->h;
  BW_TRY(cylinder_of_particles(comm, c->upstream, 0.5 * height, &solid, &s->solid));
  s->wide = 2.0 * ds * sqrt((double)bw_solid_total(s->solid) / acos(-1.0));
  return BW_OK;
}

static bw_status make_scene(const bw_comm *comm, const cylinder_config *c, double ds, scene *s)
{
  bw_coupler_config coupler = bw_coupler_config_default();
  BW_TRY(make_fluid(comm, c, s));
  BW_TRY(make_solid(comm, c, ds * s->h, s));
  coupler.rho = 1.0, coupler.nu = 1.0 / c->reynolds;
  coupler.marker_spacing = 1.0;
  return bw_coupler_create(&coupler, s->fluid, s->solid, &s->coupler); /* the solid is held */
}

/* Cd by reaction, probes and box when it is steady; the diameter. */
static bw_status measure(const bw_comm *comm, const cylinder_config *c, double ds, double Cd[3],
                         double *wide)
{
  scene s = {0};
  bw_coupler_report r;
  bw_status st = make_scene(comm, c, ds, &s);
  double last = HUGE_VAL, change = HUGE_VAL;
  for (double until = 1.0; st == BW_OK && change > STEADY && until < LATEST; until += 1.0) {
    while (st == BW_OK && bw_ns_channel_time(s.fluid) < until)
      st = bw_coupler_step(s.coupler, 0.5 * bw_ns_channel_dt_max(s.fluid));
    BW_THEN(st, bw_coupler_measure(s.coupler, &r));
    if (st == BW_OK) change = fabs(r.force_reaction[0] / last - 1.0), last = r.force_reaction[0];
  }
  if (st == BW_OK && change > STEADY)
    st = BW_FAIL(BW_EDIVERGED, "the drag is not steady after %g d/U_b", LATEST);
  if (st == BW_OK) {
    const double scale = 2.0 / s.h;
    Cd[0] = scale * r.force_reaction[0], Cd[1] = scale * r.force_probe[0];
    Cd[2] = scale * r.force_control_volume[0];
    *wide = s.wide;
  }
  scene_destroy(&s);
  return st;
}

static bw_status one_spacing(bw_validation *v, const cylinder_config *c, double ds, double Cd_round)
{
  const double h = 1.0 / c->cells_per_diameter, place = 1.5 * 2.0 * (0.1 + 0.11 * ds) * h;
  const double over = c->probe_length * h * sqrt(c->reynolds);
  const double probes = FRICTION_SHARE * (0.5 * over * over + 0.05) + place;
  double Cd[3], wide = NAN;
  char extra[96], claim[3][96];
  static const char *const route[] = {"reaction", "probes", "box"};
  BW_TRY(measure(bw_validation_comm(v), c, ds, Cd, &wide));
  snprintf(extra, sizeof extra, "\"spacing_over_cell\": %g, \"cells_per_diameter\": %d", ds,
           c->cells_per_diameter);
  for (int q = 0; q < 3; q++)
    snprintf(claim[q], sizeof claim[q], "drag by %s, particles of %g cells, %d cells across",
             route[q], ds, c->cells_per_diameter);
  static const char fem[] = "independent finite elements, data/confined_cylinder";
  const double round = Cd_round * pow(wide, 1.5);
  bw_validation_row(v, &(bw_claim){claim[0], "Cd_reaction", Cd[0], round, place,
                                   BW_INDEPENDENT_CODE, fem, extra});
  bw_validation_row(
      v, &(bw_claim){claim[1], "Cd_probes", Cd[1], round, probes, BW_INDEPENDENT_CODE, fem, extra});
  bw_validation_row(v, &(bw_claim){claim[2], "Cd_box", Cd[2], Cd[0], 1.0e4 * BW_REAL_EPSILON,
                                   BW_CONSERVATION, "momentum balance of a box", extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  enum { SPACINGS = 7 };
  static const double spacing[SPACINGS] = {1.0, 0.8, 0.67, 0.5, 0.34, 0.25, 0.2};
  static const bool quick[2][SPACINGS] = {{[0] = true, [3] = true}, {[5] = true}};
  cylinder_config c = cylinder_config_default();
  double table[16][5], round = NAN; /* blockage, Re_d, d before, d behind, Cd */
  int rows = 0;
  c.reynolds = RE;
  BW_TRY(bw_validation_table("confined_cylinder/confined_cylinder.csv", 5, 16, table[0], &rows));
  for (int q = 0; q < rows; q++)
    if (table[q][1] == RE && table[q][2] == c.upstream) round = table[q][4];
  for (int grid = 0; grid < 2; grid++)
    for (int q = 0; q < SPACINGS; q++) {
      c.cells_per_diameter = 15 << grid;
      if (bw_validation_full(v) || quick[grid][q]) BW_TRY(one_spacing(v, &c, spacing[q], round));
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.lattice_cylinder", run);
}
