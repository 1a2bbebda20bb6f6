/* The keys of the fluid: its sides, start and forcing. */
#include "bw_ns_channel.h"
#include "bw_ns_words.h"
#include "scene_internal.h"

#define V BW_CONFIG_VALUE
static const bw_config_word model_words[] = {
    {"incompressible", BW_SCENE_INCOMPRESSIBLE, "a flow on a grid"},
    {"particles", BW_SCENE_PARTICLES, "particles with a free surface"},
    {"none", BW_SCENE_NO_FLUID, NULL},
    {NULL, 0, NULL}};
static const bw_config_word walls_words[] = {{"slip", BW_SCENE_SLIP, "the fluid slips along them"},
                                             {"stick", BW_SCENE_STICK, "it sticks to them"},
                                             {NULL, 0, NULL}};
static const bw_config_field side_fields[] = {
    BW_CONFIG_WORD(bw_scene_side, kind, BW_REQUIRED, bw_ns_side_words,
                   "what the side is to the fluid"),
    BW_CONFIG_WORD(bw_scene_side, profile, BW_OPTIONAL, bw_ns_profile_words,
                   "velocity profile of an inflow"),
    V(bw_scene_side, velocity, BW_OPTIONAL, BW_POINT, "L/T",
      "velocity of a wall in its plane, or of a uniform inflow"),
    V(bw_scene_side, mean, BW_OPTIONAL, BW_ANY, "L/T",
      "mean velocity of a poiseuille inflow along +x, +y or +z; negative through an upper side"),
    V(bw_scene_side, ramp, BW_OPTIONAL, BW_AT_LEAST(0), "T",
      "time over which an inflow or a moving wall comes to its velocity, as (1 - cos)/2"),
    BW_CONFIG_END};
static const bw_config_field pair_fields[] = {
    BW_CONFIG_MAP(bw_scene_pair, lower, side_fields, "the side at 0"),
    BW_CONFIG_MAP(bw_scene_pair, upper, side_fields, "the side at the length"), BW_CONFIG_END};
static const bw_config_field sides_fields[] = {
    BW_CONFIG_MAP(bw_scene_sides, x, pair_fields, "the sides normal to x"),
    BW_CONFIG_MAP(bw_scene_sides, y, pair_fields, "the sides normal to y"),
    BW_CONFIG_MAP_IF(bw_scene_sides, z, has_z, pair_fields,
                     "the sides normal to z; left out in two dimensions"),
    BW_CONFIG_END};
static const bw_config_field vortex_fields[] = {
    V(bw_scene_vortex, centre, BW_REQUIRED, BW_POINT, "L", "place of the axis, which is along z"),
    V(bw_scene_vortex, radius, BW_REQUIRED, BW_ABOVE(0), "L", "where the vortex is fastest"),
    V(bw_scene_vortex, swirl, BW_REQUIRED, BW_ANY, "L/T",
      "largest velocity of the vortex; > 0: counterclockwise"),
    BW_CONFIG_END};
static const bw_config_field start_fields[] = {
    V(bw_scene_start, velocity, BW_OPTIONAL, BW_POINT, "L/T", "uniform velocity at the start"),
    V(bw_scene_start, developed, BW_OPTIONAL, BW_ANY, "",
      "the profile of a poiseuille inflow at the lower x side, everywhere"),
    BW_CONFIG_LIST(bw_scene_start, vortices, n_vortices, BW_OPTIONAL, vortex_fields,
                   "vortices added to it"),
    BW_CONFIG_WORD(bw_scene_start, hydrostatic, BW_OPTIONAL, bw_scene__truth_words,
                   "of particles: under the pressure of rest below the top of each shape; left "
                   "out: true"),
    V(bw_scene_start, file, BW_OPTIONAL, BW_FILE, "",
      "checkpoint of a scene with the same cells, whose fluid is taken"),
    BW_CONFIG_END};
static const bw_config_field forcing_fields[] = {
    BW_CONFIG_WORD(bw_scene_forcing, kind, BW_REQUIRED, bw_ns_forcing_words,
                   "what is held constant along a periodic direction"),
    BW_CONFIG_WORD(bw_scene_forcing, axis, BW_OPTIONAL, bw_scene__axis_words,
                   "along which direction, which has to be periodic; left out: x"),
    V(bw_scene_forcing, value, BW_REQUIRED, BW_ANY, "L/T or L/T2",
      "the bulk velocity, or the gradient -dp/dx over the density, along the axis"),
    BW_CONFIG_END};
const bw_config_field bw_scene__fluid_fields[] = {
    BW_CONFIG_WORD(bw_scene_fluid, model, BW_OPTIONAL, model_words, "what the fluid is"),
    V(bw_scene_fluid, density, BW_REQUIRED, BW_ABOVE(0), "M/L3", "density of the fluid"),
    V(bw_scene_fluid, viscosity, BW_REQUIRED, BW_ABOVE(0), "L2/T",
      "kinematic viscosity of the fluid"),
    BW_CONFIG_MAP_IF(bw_scene_fluid, sides, has_sides, sides_fields,
                     "the sides of the box; a fluid of particles has walls there (domain.open)"),
    BW_CONFIG_MAP(bw_scene_fluid, start, start_fields, "the first velocity"),
    BW_CONFIG_MAP_IF(bw_scene_fluid, forcing, has_forcing, forcing_fields,
                     "what drives a flow that is periodic"),
    BW_CONFIG_LIST(bw_scene_fluid, shape, n_shape, BW_OPTIONAL, bw_scene__shape_fields,
                   "of particles: where it is at first; bodies are taken away from it"),
    V(bw_scene_fluid, speed, BW_OPTIONAL, BW_ABOVE(0), "L/T",
      "of particles: largest speed that is expected; left out: 2 sqrt(gravity depth)"),
    BW_CONFIG_WORD(bw_scene_fluid, walls, BW_OPTIONAL, walls_words,
                   "of particles: what walls and bodies are to it; left out: slip"),
    BW_CONFIG_WORD(bw_scene_fluid, eddy, BW_OPTIONAL, bw_ns_eddy_words,
                   "model of the eddies that no cell resolves, in space; left out: none"),
    V(bw_scene_fluid, film_roughness, BW_OPTIONAL, BW_ABOVE(0), "L",
      "films where bodies, faces of cracks and walls are too near for the grid: their least gap"),
    V(bw_scene_fluid, film_limit, BW_OPTIONAL, BW_ABOVE(0), "L",
      "gap from which the grid carries a film; left out: three cells, with probes four"),
    V(bw_scene_fluid, film_least, BW_OPTIONAL, BW_ANY, "M/(L T2)",
      "pressure, 0 or less, below which a film between bodies that deform cavitates; left out: it "
      "bears any"),
    BW_CONFIG_WORD(
        bw_scene_fluid, film_flux, BW_OPTIONAL, bw_scene__truth_words,
        "what flows in a film between bodies that deform leaves the grid and enters it "
        "at the film's edges, by the cubic law; for films that answer within some steps; "
        "left out: no"),
    BW_CONFIG_END};
#undef V
