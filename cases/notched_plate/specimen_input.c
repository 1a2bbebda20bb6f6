/* The case file. */
#include "bw_solid_words.h"
#include "specimen.h"
#include <limits.h>
#include <math.h>

#define V BW_CONFIG_VALUE
static const bw_config_field shape_fields[] = {
    V(specimen_shape, length, BW_REQUIRED, BW_ABOVE(0), "m", "length of the plate, in x"),
    V(specimen_shape, height, BW_REQUIRED, BW_ABOVE(0), "m", "height of the plate, in y"),
    V(specimen_shape, thickness, BW_OPTIONAL, BW_ABOVE(0), "m",
      "thickness of the plate, in z; in two dimensions that of the one layer"),
    V(specimen_shape, particles, BW_REQUIRED, BW_AT_LEAST(10), "",
      "particles along the length; they give the spacing"),
    V(specimen_shape, lattice_angle, BW_OPTIONAL, BW_FROM_TO(-180, 180), "deg",
      "angle by which the lattice is turned about the plate's middle"),
    BW_CONFIG_END};

static const bw_config_field notch_fields[] = {
    V(specimen_notch, from, BW_REQUIRED, BW_ANY, "m", "one end of the cut, [x, y]"),
    V(specimen_notch, to, BW_REQUIRED, BW_ANY, "m", "its other end, [x, y]"), BW_CONFIG_END};

static const bw_config_field hole_fields[] = {
    V(specimen_hole, centre, BW_REQUIRED, BW_ANY, "m", "middle of the hole, [x, y]"),
    V(specimen_hole, radius, BW_REQUIRED, BW_ABOVE(0), "m", "radius of the hole"), BW_CONFIG_END};

static const bw_config_word geometry_words[] = {
    {"plane_stress", BW_PD_PLANE_STRESS, "bonds have Poisson's ratio 1/3"},
    {"plane_strain", BW_PD_PLANE_STRAIN, "1/4"},
    {"solid", BW_PD_3D, "three dimensions, 1/4"},
    {NULL, 0, NULL}};
static const bw_config_field solid_fields[] = {
    BW_CONFIG_WORD(specimen_solid, geometry, BW_OPTIONAL, geometry_words,
                   "plane stress, plane strain or three dimensions"),
    V(specimen_solid, young_modulus, BW_REQUIRED, BW_ABOVE(0), "Pa", "Young's modulus"),
    V(specimen_solid, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density"),
    V(specimen_solid, fracture_energy, BW_REQUIRED, BW_ABOVE(0), "J/m2", "fracture energy G0"),
    V(specimen_solid, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "",
      "horizon over the spacing of the particles"),
    BW_SOLID_LAW_KEYS(specimen_solid),
    BW_CONFIG_WORD(specimen_solid, surface_correction, BW_OPTIONAL, bw_solid_correction_words,
                   "how bonds near edges are made as stiff as inside"),
    BW_CONFIG_WORD(specimen_solid, volume_fraction, BW_OPTIONAL, bw_solid_fraction_words,
                   "which part of a partner's cell counts as within the horizon"),
    BW_CONFIG_WORD(specimen_solid, family_reach, BW_OPTIONAL, bw_solid_reach_words,
                   "how far away a partner may be"),
    BW_CONFIG_WORD(specimen_solid, integrator, BW_OPTIONAL, bw_solid_integrator_words,
                   "how the motion advances in time"),
    V(specimen_solid, disorder, BW_OPTIONAL, BW_FROM_TO(0, 0.4), "spacings",
      "how far particles stand off their sites; 0: a lattice"),
    V(specimen_solid, disorder_seed, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "number of the disordered cloud; another one gives another cloud"),
    V(specimen_solid, contact, BW_OPTIONAL, BW_ANY, "", "repulsion where no bond is left"),
    BW_CONFIG_END};

static const bw_config_word edge_words[] = {{"left", SPECIMEN_LEFT, NULL},
                                            {"right", SPECIMEN_RIGHT, NULL},
                                            {"bottom", SPECIMEN_BOTTOM, NULL},
                                            {"top", SPECIMEN_TOP, NULL},
                                            {NULL, 0, NULL}};
static const bw_config_word kind_words[] = {{"traction", SPECIMEN_TRACTION, "Pa"},
                                            {"velocity", SPECIMEN_VELOCITY, "m/s, held; 0: clamp"},
                                            {"start", SPECIMEN_START, "m/s, at t = 0 only"},
                                            {NULL, 0, NULL}};
static const bw_config_field load_fields[] = {
    BW_CONFIG_WORD(specimen_load, edge, BW_REQUIRED, edge_words,
                   "edge of the plate that is loaded"),
    BW_CONFIG_WORD(specimen_load, kind, BW_REQUIRED, kind_words, "what is given there"),
    V(specimen_load, value, BW_REQUIRED, BW_ANY, "", "traction [Pa] or velocity [m/s], [x, y]"),
    V(specimen_load, rows, BW_OPTIONAL, BW_AT_LEAST(1), "", "rows of particles that take the load"),
    V(specimen_load, from, BW_OPTIONAL, BW_ANY, "m",
      "where along the edge the load begins; left out: at its end"),
    V(specimen_load, to, BW_OPTIONAL, BW_ANY, "m",
      "where along the edge the load ends; left out: at its end"),
    V(specimen_load, rise, BW_OPTIONAL, BW_AT_LEAST(0), "s",
      "time in which a traction grows to its value"),
    V(specimen_load, unbreakable, BW_OPTIONAL, BW_ANY, "",
      "whether the bonds of the loaded particles cannot break"),
    BW_CONFIG_END};

static const bw_config_field follow_fields[] = {
    V(specimen_follow, from, BW_REQUIRED, BW_ANY, "m",
      "tip of the notch where the crack begins, [x, y]"),
    V(specimen_follow, lower, BW_OPTIONAL, BW_ANY, "m",
      "lower left corner of the window in which the crack is looked for; left out: the plate's"),
    V(specimen_follow, upper, BW_OPTIONAL, BW_ANY, "m",
      "upper right corner of that window; left out: the plate's"),
    V(specimen_follow, fit_from, BW_OPTIONAL, BW_AT_LEAST(0), "m",
      "distance from the notch's tip from which the crack's angle is fitted"),
    V(specimen_follow, fit_to, BW_OPTIONAL, BW_ABOVE(0), "m",
      "distance up to which it is fitted; left out: all of the crack"),
    V(specimen_follow, speed_window, BW_OPTIONAL, BW_ABOVE(0), "s",
      "time over which the tip's speed is taken; left out: 2e-6 s for 0.1 m of plate"),
    V(specimen_follow, angle_over, BW_OPTIONAL, BW_ABOVE(0), "m",
      "length of a branch that its angle is taken over; left out: a twentieth of the plate's"),
    V(specimen_follow, every, BW_OPTIONAL, BW_AT_LEAST(1), "steps",
      "steps between looks at the crack"),
    BW_CONFIG_END};

static const bw_config_field time_fields[] = {
    V(specimen_time, step, BW_REQUIRED, BW_ABOVE(0), "s", "time step"),
    V(specimen_time, end, BW_REQUIRED, BW_ABOVE(0), "s", "end of the run"),
    V(specimen_time, after, BW_OPTIONAL, BW_AT_LEAST(0), "s",
      "how long the run goes on after the crack has reached an edge or a hole; left out: to the "
      "end"),
    BW_CONFIG_END};

static const bw_config_field output_fields[] = {
    V(specimen_files, sample_every, BW_OPTIONAL, BW_AT_LEAST(1), "steps",
      "steps between rows of history.csv"),
    V(specimen_files, picture_every, BW_OPTIONAL, BW_AT_LEAST(1), "steps",
      "steps between pictures damage-*.vtp"),
    BW_CONFIG_END};

static const bw_config_field strength_fields[] = {
    V(specimen_strength, tension, BW_OPTIONAL, BW_ABOVE(0), "Pa",
      "in tension: gauges rankine and energy"),
    V(specimen_strength, yield, BW_OPTIONAL, BW_ABOVE(0), "Pa", "gauge mises"),
    V(specimen_strength, cohesion, BW_OPTIONAL, BW_ABOVE(0), "Pa",
      "gauges mohr_coulomb and drucker_prager, with friction_angle"),
    V(specimen_strength, friction_angle, BW_OPTIONAL, BW_FROM_TO(0, 89), "deg", "with cohesion"),
    V(specimen_strength, flaw, BW_OPTIONAL, BW_ABOVE(0), "m",
      "gauge griffith: a crack of this length is tried wherever the largest principal stress is "
      "half of its largest value or more; with solid.fracture_energy"),
    BW_CONFIG_END};

const bw_config_field specimen_fields[] = {
    BW_CONFIG_MAP(specimen_config, shape, shape_fields, "the plate and its lattice"),
    BW_CONFIG_LIST(specimen_config, notches, n_notches, BW_OPTIONAL, notch_fields,
                   "straight cuts through the thickness"),
    BW_CONFIG_LIST(specimen_config, holes, n_holes, BW_OPTIONAL, hole_fields,
                   "round holes through the thickness"),
    BW_CONFIG_MAP(specimen_config, solid, solid_fields, "the material and its discretisation"),
    BW_CONFIG_LIST(specimen_config, loads, n_loads, BW_REQUIRED, load_fields,
                   "what acts on the edges"),
    BW_CONFIG_MAP(specimen_config, follow, follow_fields, "the crack that is measured"),
    BW_CONFIG_MAP(specimen_config, time, time_fields, "how long the run is"),
    BW_CONFIG_MAP(specimen_config, output, output_fields, "when files are written"),
    BW_CONFIG_MAP(specimen_config, strength, strength_fields,
                  "what the material bears: gauges of failure in the pictures, and weakest-*.csv"),
    BW_CONFIG_END};
#undef V

specimen_config specimen_default(void)
{
  specimen_config c = {
      .shape = {.length = NAN, .height = NAN, .thickness = 1.0, .particles = INT_MIN},
      .solid = {.geometry = BW_PD_PLANE_STRESS,
                .young_modulus = NAN,
                .density = NAN,
                .fracture_energy = NAN,
                .horizon_ratio = 3.0,
                .choice = bw_solid_law_choice_default(),
                .surface_correction = BW_PD_SURFACE_VOLUME,
                .volume_fraction = BW_PD_FRACTION_DEFAULT,
                .family_reach = BW_PD_REACH_HALF_CELL,
                .integrator = BW_SOLID_VERLET},
      .follow = {.from = {NAN, NAN},
                 .lower = {NAN, NAN},
                 .upper = {NAN, NAN},
                 .fit_from = 0.0,
                 .fit_to = NAN,
                 .speed_window = NAN,
                 .angle_over = NAN,
                 .every = 1},
      .time = {.step = NAN, .end = NAN, .after = NAN},
      .output = {.sample_every = 10, .picture_every = 200},
      .strength = {NAN, NAN, NAN, NAN, NAN}};
  c.notches[0] = (specimen_notch){{NAN, NAN}, {NAN, NAN}};
  c.holes[0] = (specimen_hole){{NAN, NAN}, NAN};
  c.loads[0] = (specimen_load){
      .edge = INT_MIN, .kind = INT_MIN, .rows = 1, .value = {NAN, NAN}, .from = NAN, .to = NAN};
  return c;
}
