/* The keys of dam_break.yaml, their defaults, and every contradiction between them. */
#include "dam_case.h"

#include "bw_number.h"
#include "bw_solid_words.h"
#include "bw_ulph.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#define V BW_CONFIG_VALUE
static const bw_config_field tank_fields[] = {
    V(dam_tank, size, BW_REQUIRED, BW_AT_LEAST(0), "L",
      "inside of the tank in x, y (up) and z; 0 in z: two dimensions"),
    V(dam_tank, no_slip, BW_OPTIONAL, BW_ANY, "", "water sticks to walls; false: it slips"),
    BW_CONFIG_END};
static const bw_config_field box_fields[] = {
    V(dam_box, lower, BW_REQUIRED, BW_ANY, "L", "lower corner"),
    V(dam_box, upper, BW_REQUIRED, BW_ANY, "L", "upper corner"), BW_CONFIG_END};
static const bw_config_field fluid_fields[] = {
    V(dam_fluid, spacing, BW_REQUIRED, BW_ABOVE(0), "L", "distance of the particles, dx"),
    V(dam_fluid, density, BW_REQUIRED, BW_ABOVE(0), "M/L3", "density without pressure"),
    V(dam_fluid, viscosity, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L T)", "dynamic viscosity"),
    V(dam_fluid, gravity, BW_REQUIRED, BW_AT_LEAST(0), "L/T2", "along -y"),
    V(dam_fluid, speed, BW_OPTIONAL, BW_ABOVE(0), "L/T",
      "largest speed that is expected; left out: 2 sqrt(gravity depth)"),
    V(dam_fluid, sound_speed, BW_OPTIONAL, BW_ABOVE(0), "L/T",
      "at least 10 times the larger of speed and sqrt(gravity depth), which it is when left out"),
    V(dam_fluid, alpha, BW_OPTIONAL, BW_FROM_TO(0, 1), "", "artificial viscosity"),
    V(dam_fluid, alpha_wall, BW_OPTIONAL, BW_FROM_TO(0, 1), "", "the same beside walls"),
    V(dam_fluid, delta, BW_OPTIONAL, BW_FROM_TO(0, 0.3), "", "density diffusion"),
    V(dam_fluid, shifting, BW_OPTIONAL, BW_FROM_TO(0, 10), "", "against clustering; 0: none"),
    BW_CONFIG_END};
static const bw_config_field motion_fields[] = {
    V(dam_motion, amplitude, BW_REQUIRED, BW_ANY, "L",
      "the tank is at amplitude (cos(2 pi t/period) - 1)"),
    V(dam_motion, period, BW_REQUIRED, BW_ABOVE(0), "T", "period of that motion"), BW_CONFIG_END};
static const bw_config_word gauge_words[] = {
    {"depth", DAM_DEPTH, "of the column at `at`, within `width` on either side"},
    {"pressure", DAM_PRESSURE, "on the wall between lower and upper, mean since the last row"},
    {"front", DAM_FRONT, "largest x of the water between lower and upper"},
    {"height", DAM_HEIGHT, "largest y of the water between lower and upper"},
    {"aside", DAM_ASIDE, "of the solid that was between lower and upper: mean move along x"},
    {"up", DAM_UP, "of the same: mean move along y"},
    {NULL, 0, NULL}};
static const bw_config_field gauge_fields[] = {
    V(dam_gauge, name, BW_REQUIRED, BW_ANY, "", "of the column in history.csv"),
    BW_CONFIG_WORD(dam_gauge, kind, BW_REQUIRED, gauge_words, "what is measured"),
    V(dam_gauge, at, BW_OPTIONAL, BW_ANY, "L", "place of a column, which goes with the tank"),
    V(dam_gauge, width, BW_OPTIONAL, BW_AT_LEAST(0), "L", "half-width of a column; 0: 2 spacings"),
    V(dam_gauge, lower, BW_OPTIONAL, BW_ANY, "L", "lower corner of where is looked"),
    V(dam_gauge, upper, BW_OPTIONAL, BW_ANY, "L", "upper corner of where is looked"),
    BW_CONFIG_END};
static const bw_config_field part_fields[] = {
    V(dam_part, lower, BW_REQUIRED, BW_ANY, "L", "lower corner"),
    V(dam_part, upper, BW_REQUIRED, BW_ANY, "L", "upper corner"),
    V(dam_part, held, BW_OPTIONAL, BW_ANY, "", "does not move"), BW_CONFIG_END};
static const bw_config_field solid_fields[] = {
    V(dam_solid, spacing, BW_REQUIRED, BW_ABOVE(0), "L",
      "of its particles: that of the fluid, or a whole number of times less"),
    V(dam_solid, density, BW_REQUIRED, BW_ABOVE(0), "M/L3", "density"),
    V(dam_solid, young, BW_REQUIRED, BW_ABOVE(0), "M/(L T2)", "Young's modulus"),
    V(dam_solid, fracture_energy, BW_OPTIONAL, BW_ABOVE(0), "M/T2", "left out: it does not break"),
    V(dam_solid, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "",
      "horizon over spacing; left out: 1.5 for correspondence that does not break, else 2"),
    BW_SOLID_LAW_KEYS(dam_solid),
    V(dam_solid, damping_pair, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L6 T)",
      "between particles that bonds join"),
    V(dam_solid, contact, BW_OPTIONAL, BW_ANY, "", "pieces push each other and the tank's walls"),
    BW_CONFIG_LIST(dam_solid, parts, n_parts, BW_REQUIRED, part_fields,
                   "boxes; the last one that holds a place says whether it is held there"),
    BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(dam_time, end, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "T", "end of the run"),
    V(dam_time, step_share, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "step over the one that is recommended, at most spacing/(sound speed + speed)"),
    BW_CONFIG_END};
static const bw_config_field output_fields[] = {
    V(dam_output, sample_every, BW_REQUIRED, BW_ABOVE(0), "T", "time between rows of history.csv"),
    V(dam_output, picture_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T",
      "time between VTK files of water.pvd and walls.pvd; 0: at the end only"),
    V(dam_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T",
      "time between checkpoint.h5; 0: at the end only"),
    BW_CONFIG_END};
const bw_config_field dam_fields[] = {
    BW_CONFIG_MAP(dam_config, tank, tank_fields, "the tank, open at the top"),
    BW_CONFIG_MAP(dam_config, fluid, fluid_fields, "the water"),
    BW_CONFIG_LIST(dam_config, water, n_water, BW_REQUIRED, box_fields, "where water is at first"),
    BW_CONFIG_LIST(dam_config, obstacles, n_obstacles, BW_OPTIONAL, box_fields,
                   "blocks in the tank; let them go 4 spacings into the walls that they stand on"),
    V(dam_config, hydrostatic, BW_OPTIONAL, BW_ANY, "",
      "start with the pressure below the top of each box of water; false: without pressure"),
    BW_CONFIG_MAP_IF(dam_config, motion, has_motion, motion_fields, "of the tank"),
    BW_CONFIG_MAP_IF(dam_config, solid, has_solid, solid_fields, "in the water or beside it"),
    BW_CONFIG_LIST(dam_config, gauges, n_gauges, BW_OPTIONAL, gauge_fields,
                   "more columns of history.csv"),
    BW_CONFIG_MAP(dam_config, time, time_fields, "how long the run is, in which steps"),
    BW_CONFIG_MAP(dam_config, output, output_fields, "when files are written"),
    BW_CONFIG_END};
#undef V

dam_config dam_config_default(void)
{
  const bw_ulph_config u = bw_ulph_config_default();
  const dam_box box = {{NAN, NAN, NAN}, {NAN, NAN, NAN}};
  return (dam_config){.tank = {.size = {NAN, NAN, NAN}},
                      .fluid = {.spacing = NAN,
                                .density = NAN,
                                .gravity = NAN,
                                .speed = NAN,
                                .sound_speed = NAN,
                                .alpha = u.alpha,
                                .alpha_wall = u.alpha_wall,
                                .delta = u.delta,
                                .shifting = u.shifting},
                      .water = {box},
                      .obstacles = {box},
                      .hydrostatic = true,
                      .motion = {.amplitude = {NAN, NAN, NAN}, .period = NAN},
                      .solid = {.spacing = NAN,
                                .density = NAN,
                                .young = NAN,
                                .fracture_energy = INFINITY,
                                .horizon_ratio = NAN,
                                .choice = bw_solid_law_choice_default(),
                                .parts = {{{NAN, NAN, NAN}, {NAN, NAN, NAN}, false}}},
                      .gauges = {{.kind = INT_MIN}},
                      .time = {.end = NAN, .step_share = u.step_share},
                      .output = {.sample_every = NAN}};
}

static bw_status box_check(const dam_config *c, const char *list, int number, const dam_box *b,
                           double margin)
{
  const int dimensions = c->tank.size[2] > 0 ? 3 : 2;
  for (int k = 0; k < dimensions; k++) {
    BW_REQUIRE(b->lower[k] < b->upper[k], BW_EINPUT,
               "%s.%d: lower[%d] is %g and upper[%d] is %g; upper must be larger", list, number, k,
               b->lower[k], k, b->upper[k]);
    BW_REQUIRE(
        b->lower[k] >= -margin && b->upper[k] <= c->tank.size[k] + margin, BW_EINPUT,
        "%s.%d: from %g to %g in direction %d, but the tank is from 0 to %g: what is outside "
        "of it cannot be; move it, or enlarge tank.size[%d]",
        list, number, b->lower[k], b->upper[k], k, c->tank.size[k], k);
  }
  return BW_OK;
}

static bw_status part_check(const dam_config *c, int number)
{
  const dam_part *p = &c->solid.parts[number];
  const dam_box box = {{p->lower[0], p->lower[1], p->lower[2]},
                       {p->upper[0], p->upper[1], p->upper[2]}};
  /* What holds it may go into the walls. */
  return box_check(c, "solid.parts", number, &box, 100 * c->fluid.spacing);
}

static bw_status gauge_check(const dam_config *c, int number)
{
  const dam_gauge *g = &c->gauges[number];
  const dam_box box = {{g->lower[0], g->lower[1], g->lower[2]},
                       {g->upper[0], g->upper[1], g->upper[2]}};
  BW_REQUIRE(g->name[strcspn(g->name, ",[]\"")] == 0, BW_EINPUT,
             "gauges.%d.name: '%s' has a comma, a quote or a bracket; leave it out", number,
             g->name);
  BW_REQUIRE((g->kind != DAM_ASIDE && g->kind != DAM_UP) || c->has_solid, BW_EINPUT,
             "gauges.%d.kind: it tells how the solid moves, but there is none: give `solid`",
             number);
  if (g->kind != DAM_DEPTH) return box_check(c, "gauges", number, &box, 4 * c->fluid.spacing);
  for (int k = 0; k < 3; k += 2)
    BW_REQUIRE(g->at[k] >= 0 && g->at[k] <= c->tank.size[k], BW_EINPUT,
               "gauges.%d.at: %g in direction %d is not in the tank, 0 to %g", number, g->at[k], k,
               c->tank.size[k]);
  return BW_OK;
}

static bw_status times_divide(const char *whole_key, double whole, const char *part_key,
                              double part)
{
  int64_t times = 0;
  if (whole == 0) return BW_OK;
  BW_REQUIRE(bw_divides(whole, part, &times), BW_EINPUT, "%s is %g, no whole number of %s, %g",
             whole_key, whole, part_key, part);
  return BW_OK;
}

/* Lengths are whole numbers of spacings, so that walls stand between particles, and no more than
 * sites have numbers (bw_shape.h). */
static bw_status spacing_check(const dam_config *c)
{
  static const double most = 2147483000.0;
  int64_t times;
  for (int k = 0; k < 3; k++)
    BW_REQUIRE(c->tank.size[k] / c->fluid.spacing <= most, BW_EINPUT,
               "tank.size[%d] = %g is %.3g spacings of %g, more than 2^31: take a larger spacing",
               k, c->tank.size[k], c->tank.size[k] / c->fluid.spacing, c->fluid.spacing);
  for (int k = 0; k < 3; k++)
    BW_REQUIRE(
        (k == 2 && c->tank.size[k] == 0) || bw_divides(c->tank.size[k], c->fluid.spacing, &times),
        BW_EINPUT,
        "tank.size[%d] is %g, no whole number of fluid.spacing, %g: take %g, or a spacing of "
        "%g",
        k, c->tank.size[k], c->fluid.spacing,
        c->fluid.spacing * rint(c->tank.size[k] / c->fluid.spacing),
        c->tank.size[k] / rint(c->tank.size[k] / c->fluid.spacing));
  return BW_OK;
}

/* A block is seen three spacings deep. */
static bw_status obstacle_check(const dam_config *c, int number)
{
  const dam_box *o = &c->obstacles[number];
  BW_TRY(box_check(c, "obstacles", number, o, 100 * c->fluid.spacing));
  for (int k = 0; k < (c->tank.size[2] > 0 ? 3 : 2); k++)
    BW_REQUIRE(o->upper[k] - o->lower[k] >= 3 * c->fluid.spacing * (1 - 1e-9), BW_EINPUT,
               "obstacles.%d is %g thick in direction %d, thinner than 3 spacings of %g", number,
               o->upper[k] - o->lower[k], k, c->fluid.spacing);
  return BW_OK;
}

bw_status dam_check(const dam_config *c)
{
  const dam_output *o = &c->output;
  BW_TRY(spacing_check(c));
  for (int q = 0; q < c->n_water; q++)
    BW_TRY(box_check(c, "water", q, &c->water[q], 1e-9 * c->fluid.spacing));
  for (int q = 0; q < c->n_obstacles; q++)
    BW_TRY(obstacle_check(c, q));
  for (int q = 0; q < c->n_gauges; q++)
    BW_TRY(gauge_check(c, q));
  for (int q = 0; q < (c->has_solid ? c->solid.n_parts : 0); q++)
    BW_TRY(part_check(c, q));
  BW_REQUIRE(!c->has_solid || !c->has_motion, BW_EINPUT,
             "motion: a tank that moves does not move the solid with it; leave one of the two out");
  BW_TRY(times_divide("time.end", c->time.end, "output.sample_every", o->sample_every));
  BW_TRY(times_divide("output.picture_every", o->picture_every, "output.sample_every",
                      o->sample_every));
  return times_divide("output.checkpoint_every", o->checkpoint_every, "output.sample_every",
                      o->sample_every);
}
