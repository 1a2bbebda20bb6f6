/* The keys of channel_turbulence.yaml and their defaults. */
#include "bw_ns_words.h"
#include "channel_case.h"

#include <string.h>

#define V BW_CONFIG_VALUE
static const bw_config_field domain_fields[] = {
    V(channel_domain, length, BW_REQUIRED, BW_ABOVE(0), "h",
      "edges of the box; the height, length[1], has to be 1"),
    V(channel_domain, cells, BW_REQUIRED, BW_AT_LEAST(8), "", "cells in x, y and z"),
    V(channel_domain, stretch, BW_OPTIONAL, BW_FROM_TO(0, 10), "",
      "strength s of y_j = (1 + tanh(s (2j/n - 1))/tanh s)/2; 0: uniform"),
    V(channel_domain, faces, BW_OPTIONAL, BW_FILE, "",
      "path of a text file with the faces in y, from 0 to 1"),
    BW_CONFIG_END};
static const bw_config_word viscous_words[] = {
    {"explicit", BW_VISCOUS_EXPLICIT, "third order in time"},
    {"implicit_y", BW_VISCOUS_IMPLICIT_Y, "implicit in y: thin cells at the walls cost no steps"},
    {"implicit", BW_VISCOUS_IMPLICIT, "implicit in all directions"},
    {0}};
static const bw_config_field fluid_fields[] = {
    V(channel_fluid, reynolds, BW_REQUIRED, BW_ABOVE_TO(0, 1e9), "",
      "Reynolds number Re_b = U_b h/nu on the full height"),
    V(channel_fluid, perturbation, BW_OPTIONAL, BW_FROM_TO(0, 1), "U_b",
      "size of the rolls, waves and noise on the laminar profile at the start"),
    BW_CONFIG_WORD(channel_fluid, viscous, BW_OPTIONAL, viscous_words,
                   "how the viscous term advances in time"),
    BW_CONFIG_WORD(channel_fluid, eddy, BW_OPTIONAL, bw_ns_eddy_words,
                   "model of the eddies that no cell resolves"),
    BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(channel_time, spin_up, BW_REQUIRED, BW_AT_LEAST(0), "h/U_b",
      "time before the statistics begin"),
    V(channel_time, statistics, BW_REQUIRED | BW_MAY_CHANGE, BW_AT_LEAST(0), "h/U_b",
      "length of the statistics"),
    V(channel_time, interval, BW_OPTIONAL, BW_ABOVE(0), "h/U_b", "time between samples"),
    V(channel_time, courant_share, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "time step over the largest stable one"),
    BW_CONFIG_END};
static const bw_config_field output_fields[] = {
    V(channel_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE(0), "h/U_b",
      "time between checkpoint.h5 and the profiles so far"),
    BW_CONFIG_END};
const bw_config_field channel_fields[] = {
    BW_CONFIG_MAP(channel_case, domain, domain_fields, "the channel and its cells"),
    BW_CONFIG_MAP(channel_case, fluid, fluid_fields, "the fluid and how it starts"),
    BW_CONFIG_MAP(channel_case, time, time_fields, "how long the run is"),
    BW_CONFIG_MAP(channel_case, output, output_fields, "when files are written"), BW_CONFIG_END};
#undef V

channel_case channel_case_default(void)
{
  return (channel_case){
      .domain = {.length = {NAN, NAN, NAN}, .cells = {INT_MIN, INT_MIN, INT_MIN}, .stretch = 0.0},
      .fluid = {.reynolds = NAN, .perturbation = 0.2, .viscous = BW_VISCOUS_EXPLICIT},
      .time = {.spin_up = NAN, .statistics = NAN, .interval = 0.2, .courant_share = 0.8},
      .output = {.checkpoint_every = 5.0}};
}

channel_config channel_config_of(const channel_case *c)
{
  channel_config q = {.stretch = c->domain.stretch,
                      .faces = c->domain.faces[0] != 0 ? c->domain.faces : NULL,
                      .viscous = c->fluid.viscous,
                      .eddy = c->fluid.eddy,
                      .reynolds = c->fluid.reynolds,
                      .perturbation = c->fluid.perturbation,
                      .interval = c->time.interval,
                      .courant_share = c->time.courant_share,
                      .spin_up = c->time.spin_up};
  memcpy(q.length, c->domain.length, sizeof q.length);
  memcpy(q.cells, c->domain.cells, sizeof q.cells);
  return q;
}
