/* The keys of phases, gauges and what is watched. */
#include "bw_solid_failure.h"
#include "scene_internal.h"

#define V BW_CONFIG_VALUE
static const bw_config_field until_fields[] = {
    V(bw_scene_until, time, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE(0), "T",
      "time of the run at which it ends"),
    V(bw_scene_until, steps, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(1), "", "steps of the phase"),
    V(bw_scene_until, settled, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE_TO(0, 1), "",
      "solids: kinetic over elastic energy; fluid: relative change of its kinetic energy per "
      "sample; fluid of particles: kinetic (the largest of late) over potential energy above the "
      "origin; ends below it"),
    BW_CONFIG_END};
#define OURS bw_scene_phase
const bw_config_field bw_scene__phase_fields[] = {
    V(OURS, name, BW_OPTIONAL, BW_ANY, "", "what it is called in the log"),
    BW_CONFIG_BRIEF(bw_scene_phase, until, has_until, until_fields,
                    "when it ends: the first of those given; one number: the time"),
    V(OURS, hold, BW_OPTIONAL, BW_TEXTS, "", "bodies that stand still in it"),
    V(OURS, damp, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L3 T)", "damping against rest, of all bodies"),
    V(OURS, step, BW_OPTIONAL, BW_ABOVE(0), "T",
      "fixed time step in this phase; left out: as numerics says"),
    BW_CONFIG_WORD(bw_scene_phase, breaking, BW_OPTIONAL, bw_scene__truth_words,
                   "may bonds break? Left out: those of breakable bodies"),
    BW_CONFIG_END};
#undef OURS

static const bw_config_field line_fields[] = {
    V(bw_scene_line, from, BW_REQUIRED, BW_POINT, "L", "one end"),
    V(bw_scene_line, to, BW_REQUIRED, BW_POINT, "L", "the other end"),
    V(bw_scene_line, points, BW_OPTIONAL, BW_FROM_TO(2, 100000), "", "points, both ends included"),
    BW_CONFIG_END};
static const bw_config_field slice_fields[] = {
    BW_CONFIG_WORD(bw_scene_slice, axis, BW_REQUIRED, bw_scene__axis_words, "normal of the slice"),
    V(bw_scene_slice, at, BW_REQUIRED, BW_ANY, "L", "where on that axis"), BW_CONFIG_END};
static const bw_config_word by_words[] = {
    {"rankine", BW_SOLID_FAILURE_RANKINE, "largest principal stress over tension"},
    {"energy", BW_SOLID_FAILURE_ENERGY, "strain energy over that of tension"},
    {"mises", BW_SOLID_FAILURE_MISES, "over yield"},
    {"mohr_coulomb", BW_SOLID_FAILURE_MOHR_COULOMB, "cohesion and friction_angle"},
    {"drucker_prager", BW_SOLID_FAILURE_CONE, "cohesion and friction_angle"},
    {"stretch", BW_SOLID_FAILURE_STRETCH, "of bonds over their critical stretch"},
    {"griffith", BW_SOLID_FAILURE_GRIFFITH, "of a crack of length flaw, at rest"},
    {NULL, 0, NULL}};
#define OURS bw_scene_strength
static const bw_config_field strength_fields[] = {
    BW_CONFIG_WORD(bw_scene_strength, by, BW_REQUIRED, by_words, "what decides"),
    V(OURS, tension, BW_OPTIONAL, BW_ABOVE(0), "M/(L T2)", "strength, of rankine and energy"),
    V(OURS, yield, BW_OPTIONAL, BW_ABOVE(0), "M/(L T2)", "of mises"),
    V(OURS, cohesion, BW_OPTIONAL, BW_ABOVE(0), "M/(L T2)", "of mohr_coulomb, drucker_prager"),
    V(OURS, friction_angle, BW_OPTIONAL, BW_FROM_TO(0, 89), "deg", "of the same"),
    V(OURS, flaw, BW_OPTIONAL, BW_ABOVE(0), "L", "of griffith: length of the crack"),
    BW_CONFIG_END};
#undef OURS
#define OURS bw_scene_gauge_config
const bw_config_field bw_scene__gauge_fields[] = {
    V(OURS, name, BW_REQUIRED, BW_ANY, "", "its columns are NAME or NAME.x ..."),
    V(OURS, of, BW_REQUIRED, BW_TEXTS, "",
      "quantities: displacement, position, velocity, force, force_on_support, crack_tip, damage, "
      "fragments, broken_bonds, energy, pressure, flow_rate, bulk_velocity, tortuosity, "
      "film_energy (taken so far), film_gap (the least), divergence; failure (by what the load has "
      "to grow until the first place fails), "
      "failure_place; of a fluid of particles: depth, front, height, wall_pressure, wall_force, "
      "fluid_energy, work, mass, outside"),
    V(OURS, body, BW_OPTIONAL, BW_TEXTS, "", "bodies"),
    V(OURS, nearest, BW_OPTIONAL, BW_POINT, "L",
      "the particles of the body nearest to this place at the start; left out: all, by their mean"),
    BW_CONFIG_MAP_IF(bw_scene_gauge_config, region, has_region, bw_scene__box_fields,
                     "the particles in this box at the start, by their mean; of front, height, "
                     "wall_pressure (of wall particles, the first half a spacing in): where is "
                     "looked, going with a tank that is shaken"),
    BW_CONFIG_MAP_IF(bw_scene_gauge_config, strength, has_strength, strength_fields,
                     "of failure: what the body bears; left out: its bonds' critical stretch"),
    V(OURS, point, BW_OPTIONAL, BW_POINT, "L",
      "a place in the fluid; of depth: in its column, which goes with a tank that is shaken"),
    V(OURS, width, BW_OPTIONAL, BW_ABOVE(0), "L",
      "of depth: half the width of the column; left out: two spacings"),
    V(OURS, minus, BW_OPTIONAL, BW_POINT, "L", "another place, whose value is taken away"),
    BW_CONFIG_MAP_IF(bw_scene_gauge_config, line, has_line, line_fields,
                     "points on a line: files NAME-*.csv"),
    BW_CONFIG_MAP_IF(bw_scene_gauge_config, slice, has_slice, slice_fields,
                     "cells of a slice: files NAME-*.csv"),
    V(OURS, origin, BW_OPTIONAL, BW_POINT, "L", "of crack_tip: where the crack begins"),
    V(OURS, every, BW_OPTIONAL, BW_ABOVE(0), "T", "time between files of lines and slices"),
    BW_CONFIG_END};
#undef OURS

static const bw_config_word mean_words[] = {{"none", 0, NULL},
                                            {"midrange", 1, "(largest + least)/2"},
                                            {"time", 2, "over time"},
                                            {NULL, 0, NULL}};
#define OURS bw_scene_watch
const bw_config_field bw_scene__watch_fields[] = {
    V(bw_scene_watch, name, BW_REQUIRED, BW_ANY, "", "GAUGE or GAUGE.COMPONENT"),
    BW_CONFIG_WORD(bw_scene_watch, mean, BW_OPTIONAL | BW_MAY_CHANGE, mean_words, "which mean"),
    V(OURS, amplitude, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "", "half of largest less least"),
    V(OURS, frequency, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "of crossings of the mean, upwards"),
    V(OURS, last_periods, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(1), "",
      "periods that go in; left out: all after `from`"),
    V(OURS, from, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T", "time from which is looked at"),
    V(OURS, above, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "the run stops when the gauge is above"),
    V(OURS, below, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "the run stops when the gauge is below"),
    BW_CONFIG_END};
#undef OURS
#undef V
