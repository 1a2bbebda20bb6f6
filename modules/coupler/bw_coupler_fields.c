/* The `coupling:` block of a case file, key by key. */
#include "bw_coupler_fields.h"
#include "bw_coupler.h"

const bw_config_word bw_coupler_kernel_words[] = {{"roma3", BW_KERNEL_ROMA3, NULL},
                                                  {"peskin4", BW_KERNEL_PESKIN4, NULL},
                                                  {"hat2", BW_KERNEL_HAT2, NULL},
                                                  {NULL, 0, NULL}};
const bw_config_word bw_coupler_profile_words[] = {
    {"linear", BW_PROBE_LINEAR, "gradient at the tip, as in POROUS"},
    {"quadratic", BW_PROBE_QUADRATIC, "gradient at the wall from a parabola"},
    {NULL, 0, NULL}};
static const bw_config_word load_words[] = {
    {"probes", BW_LOAD_PROBES, "stress seen by normal probes, as in POROUS"},
    {"reaction", BW_LOAD_REACTION, "reaction of the markers, as in FSI"},
    {NULL, 0, NULL}};

#define V    BW_CONFIG_VALUE
#define WORD BW_CONFIG_WORD
#define OURS bw_coupler_config
/* What a run that was stopped for its coupling is told to change may change with --restart. */
const bw_config_field bw_coupler_fields[] = {
    WORD(OURS, kernel, BW_OPTIONAL, bw_coupler_kernel_words, "delta kernel of the forcing"),
    V(OURS, iterations, BW_OPTIONAL, BW_FROM_TO(1, 50), "",
      "forcing iterations in each sub-step of the fluid"),
    V(OURS, memory, BW_OPTIONAL, BW_FROM_TO(0, 0.5), "",
      "share of the last step in the memory of the forcing; 0: none, then two iterations or more"),
    V(OURS, retraction, BW_OPTIONAL, BW_FROM_TO(-2, 2), "cells",
      "how far inside the nominal surface markers are; left out: the best for kernel and "
      "iterations"),
    V(OURS, marker_spacing, BW_OPTIONAL, BW_FROM_TO(0, 4), "cells",
      "largest distance of markers along the surface; 0: every surface particle is one"),
    V(OURS, probe_length, BW_OPTIONAL, BW_FROM_TO(1, 4), "cells", "length of the normal probes"),
    WORD(OURS, probe_profile, BW_OPTIONAL, bw_coupler_profile_words,
         "how the velocity is taken to vary along a probe"),
    WORD(OURS, load, BW_OPTIONAL, load_words, "what loads the solid"),
    V(OURS, load_relaxation, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE_TO(0, 1), "",
      "share of the new fluid load in each step; 1: plain explicit coupling; left out: half of "
      "what is measured to hold, 0.1 at most (0.3 with a predictor)"),
    V(OURS, predictor, BW_OPTIONAL | BW_MAY_CHANGE, BW_ANY, "",
      "tell the fluid how the solid would move in the step under its last load, by its sub-steps "
      "once more; then without a virtual mass"),
    V(OURS, virtual_mass, BW_OPTIONAL | BW_MAY_CHANGE, BW_FROM_TO(0, 100), "",
      "virtual mass of the surface, over load_relaxation x density x area x cell, which keeps "
      "motions faster than the step from being fed; 0: none"),
    V(OURS, coupling_iterations, BW_OPTIONAL | BW_MAY_CHANGE, BW_FROM_TO(1, 1000), "",
      "repetitions of a step at most; 1: explicit coupling"),
    V(OURS, coupling_residual, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE_TO(0, 1), "",
      "relative change of the surface's velocity that ends the repetitions"),
    V(OURS, solid_safety, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "solid sub-step over its stability limit"),
    V(OURS, gravity, BW_OPTIONAL, BW_ANY, "m/s2", "acceleration by gravity of solid and fluid"),
    BW_CONFIG_END};
#undef V
#undef WORD
#undef OURS
