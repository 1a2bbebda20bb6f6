/* The keys of a scene file: the top level, the domain, output and numerics. */
#include "bw_coupler.h"
#include "bw_coupler_fields.h"
#include "bw_ns_words.h"
#include "bw_solid.h"
#include "bw_solid_words.h"
#include "scene_internal.h"

#include <string.h>

#define V BW_CONFIG_VALUE
const bw_config_word bw_scene__truth_words[] = {
    {"false", 0, NULL}, {"true", 1, NULL}, {NULL, 0, NULL}};
const bw_config_word bw_scene__axis_words[] = {
    {"x", 0, NULL}, {"y", 1, NULL}, {"z", 2, NULL}, {NULL, 0, NULL}};
static const bw_config_word accuracy_words[] = {
    {"quick", BW_SCENE_QUICK, "a first look"},
    {"standard", BW_SCENE_STANDARD, NULL},
    {"careful", BW_SCENE_CAREFUL, "for numbers that are handed on"},
    {NULL, 0, NULL}};
static const bw_config_word plane_words[] = {
    {"none", BW_SCENE_SPACE, "three dimensions"},
    {"stress", BW_SCENE_STRESS, "a thin plate, free to contract across"},
    {"strain", BW_SCENE_STRAIN, "a slice of something long, held across"},
    {NULL, 0, NULL}};

static const bw_config_field shake_fields[] = {
    V(bw_scene_shake, amplitude, BW_REQUIRED, BW_POINT, "L",
      "the walls are at amplitude (cos(2 pi f t) - 1): they begin at rest"),
    V(bw_scene_shake, frequency, BW_REQUIRED, BW_ABOVE(0), "1/T", "f"), BW_CONFIG_END};
static const bw_config_field domain_fields[] = {
    V(bw_scene_domain, length, BW_REQUIRED, BW_ABOVE(0), "L",
      "edges of the box in x, y and z; its lower corner is the origin"),
    V(bw_scene_domain, cells, BW_REQUIRED, BW_AT_LEAST(1), "",
      "cells in x, y and z; one cell in z: two dimensions"),
    V(bw_scene_domain, stretch, BW_OPTIONAL, BW_FROM_TO(0, 10), "",
      "strength of the stretching in y by tanh, thin cells at both sides; 0: uniform"),
    V(bw_scene_domain, open, BW_OPTIONAL, BW_TEXTS, "",
      "around a fluid of particles: sides without a wall, x_lower ... z_upper, or none; left out: "
      "the one against gravity"),
    BW_CONFIG_MAP_IF(bw_scene_domain, shake, has_shake, shake_fields,
                     "motion of the walls around a fluid of particles"),
    BW_CONFIG_END};

static const bw_config_field contact_fields[] = {
    V(bw_scene_contact, between, BW_OPTIONAL, BW_TEXTS, "",
      "all: any two bodies that move; none: they pass through each other"),
    V(bw_scene_contact, friction, BW_OPTIONAL, BW_FROM_TO(0, 10), "",
      "coefficient of friction of rigid bodies, where none deforms"),
    BW_CONFIG_END};

const bw_config_field bw_scene__output_fields[] = {
    V(bw_scene_output, sample_every, BW_OPTIONAL, BW_ABOVE(0), "T",
      "time between rows of history.csv; left out: a 200th of the run"),
    V(bw_scene_output, picture_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T",
      "time between VTK files; 0: at the end only"),
    V(bw_scene_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "600 s: wall-clock time between checkpoint-last.h5; 0: at the end only"),
    V(bw_scene_output, figures, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "draw history.csv at the end (./run)"),
    BW_CONFIG_END};

static const bw_config_word load_words[] = {
    {"probes", BW_LOAD_PROBES, "stress seen by normal probes"},
    {"reaction", BW_LOAD_REACTION, "reaction of the markers"},
    {NULL, 0, NULL}};
#define OURS              bw_scene_numerics
#define W(m, words, help) BW_CONFIG_WORD(bw_scene_numerics, m, BW_OPTIONAL, words, help)
const bw_config_field bw_scene__numerics_fields[] = {
    V(OURS, step, BW_OPTIONAL, BW_ABOVE(0), "T",
      "fixed time step; left out: step_share of the largest stable one"),
    V(OURS, step_share, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "time step over the largest stable one"),
    V(OURS, solid_share, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "in a flow: sub-step of the solids over their limit"),
    W(integrator, bw_solid_integrator_words, "of the solids"),
    V(OURS, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "",
      "horizon over the spacing of the particles"),
    W(surface_correction, bw_solid_correction_words,
      "how bonds near surfaces are made as stiff as inside"),
    W(volume_fraction, bw_solid_fraction_words, "how much of a neighbour's cell counts"),
    W(family_reach, bw_solid_reach_words, "who is within the horizon"),
    W(calibration, bw_solid_calibration_words,
      "of bonds: where their stiffness and limit come from"),
    V(OURS, damping_mean, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L3 T)",
      "damping against the mean of the neighbours"),
    V(OURS, damping_pair, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L6 T)", "damping along bonds"),
    V(OURS, damping_absolute, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L3 T)", "damping against rest"),
    V(OURS, disorder, BW_OPTIONAL, BW_FROM_TO(0, 0.4), "ds",
      "how far particles start off their sites, at most"),
    V(OURS, disorder_seed, BW_OPTIONAL, BW_ANY, "", "another number, another disorder"),
    W(viscous, bw_ns_viscous_words, "how the viscous term of the fluid advances in time"),
    W(load, load_words, "what of the fluid loads the solids"),
    W(kernel, bw_coupler_kernel_words, "of the markers' forcing"),
    W(probe_profile, bw_coupler_profile_words, "how the velocity is taken to vary along a probe"),
    V(OURS, forcing_iterations, BW_OPTIONAL, BW_FROM_TO(1, 50), "",
      "forcing iterations in each sub-step"),
    V(OURS, memory, BW_OPTIONAL, BW_FROM_TO(0, 0.5), "",
      "share of the last step in the memory of the markers"),
    V(OURS, retraction, BW_OPTIONAL, BW_FROM_TO(-2, 2), "cells",
      "how far inside the surface markers are; left out: the best for kernel and iterations"),
    V(OURS, marker_spacing, BW_OPTIONAL, BW_FROM_TO(0, 4), "cells",
      "largest distance of markers on the surface"),
    V(OURS, probe_length, BW_OPTIONAL, BW_FROM_TO(1, 4), "cells", "length of the normal probes"),
    V(OURS, load_relaxation, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "share of the new load of the fluid in each step; left out: chosen by what is measured"),
    V(OURS, predictor, BW_OPTIONAL, BW_ANY, "",
      "tell the fluid how the solids would move in the step under their last load, by their "
      "sub-steps once more"),
    V(OURS, virtual_mass, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "of bodies in a flow, over that of the fluid they carry along"),
    V(OURS, contact_stiffness, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L2 T2)",
      "pressure per depth between rigid bodies and at walls; left out: so that weight and "
      "velocities "
      "press them half a spacing in"),
    V(OURS, sound_speed, BW_OPTIONAL, BW_ABOVE(0), "L/T",
      "of a fluid of particles, at least 10 times its largest speed, which it is when left out"),
    V(OURS, artificial_viscosity, BW_OPTIONAL, BW_FROM_TO(0, 1), "", "of a fluid of particles"),
    V(OURS, wall_viscosity, BW_OPTIONAL, BW_FROM_TO(0, 1), "", "the same beside walls"),
    V(OURS, density_diffusion, BW_OPTIONAL, BW_FROM_TO(0, 0.3), "", "of a fluid of particles"),
    V(OURS, shifting, BW_OPTIONAL, BW_FROM_TO(0, 10), "",
      "of particles of a fluid against clustering; 0: none"),
    V(OURS, coupling_residual, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "change of the surface's velocity that ends iterations"),
    V(OURS, coupling_iterations, BW_OPTIONAL, BW_FROM_TO(1, 1000), "",
      "repetitions of a step at most; 1: explicit"),
    BW_CONFIG_END};
#undef OURS
#undef W

const bw_config_field bw_scene_fields[] = {
    V(bw_scene_config, name, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "", "what the scene is called"),
    BW_CONFIG_WORD(bw_scene_config, accuracy, BW_OPTIONAL, accuracy_words,
                   "sets every knob that the file leaves open"),
    BW_CONFIG_WORD(bw_scene_config, plane, BW_OPTIONAL, plane_words,
                   "two dimensions: which layer the solids are"),
    V(bw_scene_config, thickness, BW_OPTIONAL, BW_ABOVE(0), "L",
      "of that layer; left out: the domain's length in z, or 1"),
    BW_CONFIG_MAP_IF(bw_scene_config, domain, has_domain, domain_fields,
                     "the box of the fluid; left out: solids alone"),
    BW_CONFIG_MAP_IF(bw_scene_config, fluid, has_fluid, bw_scene__fluid_fields, "the fluid"),
    BW_CONFIG_NAMED(bw_scene_config, materials, n_materials, BW_OPTIONAL, bw_scene__material_fields,
                    "what bodies are made of, by name"),
    BW_CONFIG_NAMED(bw_scene_config, bodies, n_bodies, BW_OPTIONAL, bw_scene__body_fields,
                    "the bodies, by name"),
    BW_CONFIG_LIST(bw_scene_config, loads, n_loads, BW_OPTIONAL, bw_scene__load_fields,
                   "what acts on the bodies"),
    V(bw_scene_config, gravity, BW_OPTIONAL, BW_POINT, "L/T2", "acceleration of all bodies"),
    BW_CONFIG_MAP_IF(bw_scene_config, contact, has_contact, contact_fields,
                     "how bodies meet; left out: all do, where they can"),
    BW_CONFIG_LIST(bw_scene_config, phases, n_phases, BW_REQUIRED, bw_scene__phase_fields,
                   "what happens, in order"),
    BW_CONFIG_NAMED(bw_scene_config, gauges, n_gauges, BW_OPTIONAL, bw_scene__gauge_fields,
                    "what is measured, by name: columns of history.csv"),
    BW_CONFIG_NAMED(bw_scene_config, watch, n_watch, BW_OPTIONAL, bw_scene__watch_fields,
                    "what is printed of gauges at the end, by GAUGE or GAUGE.COMPONENT"),
    BW_CONFIG_MAP(bw_scene_config, output, bw_scene__output_fields, "when files are written"),
    BW_CONFIG_MAP(bw_scene_config, numerics, bw_scene__numerics_fields,
                  "knobs by name, each in place of what accuracy sets"),
    BW_CONFIG_END};
#undef V

const char *bw_scene__word(const bw_config_word words[], int value)
{
  for (const bw_config_word *w = words; w->word != NULL; w++)
    if (w->value == value) return w->word;
  return "?";
}
