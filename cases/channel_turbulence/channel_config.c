#include "channel_case.h"

#include <string.h>

#define V BW_CONFIG_VALUE
static const bw_config_field domain_fields[] = {
    V(channel_domain, length, BW_REQUIRED, BW_ABOVE(0), "h", "box; the height, length[1], is 1"),
    V(channel_domain, cells, BW_REQUIRED, BW_AT_LEAST(8), "", "cells in x, y, z"), BW_CONFIG_END};
static const bw_config_field fluid_fields[] = {
    V(channel_fluid, reynolds, BW_REQUIRED, BW_ABOVE(0), "", "Re_b = U_b h/nu"),
    V(channel_fluid, perturbation, BW_OPTIONAL, BW_FROM_TO(0, 1), "U_b",
      "rolls, waves and noise on the laminar profile"),
    BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(channel_time, spin_up, BW_REQUIRED, BW_AT_LEAST(0), "h/U_b", "before the statistics"),
    V(channel_time, statistics, BW_REQUIRED, BW_AT_LEAST(0), "h/U_b", "length of the statistics"),
    V(channel_time, interval, BW_OPTIONAL, BW_ABOVE(0), "h/U_b", "between samples"),
    V(channel_time, courant_share, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "",
      "step over the largest stable one"),
    BW_CONFIG_END};
static const bw_config_field output_fields[] = {V(channel_output, checkpoint_every, BW_OPTIONAL,
                                                  BW_ABOVE(0), "h/U_b",
                                                  "checkpoint.h5 and the profiles so far"),
                                                BW_CONFIG_END};
const bw_config_field channel_fields[] = {
    BW_CONFIG_MAP(channel_case, domain, domain_fields, "the channel"),
    BW_CONFIG_MAP(channel_case, fluid, fluid_fields, "the fluid and how it starts"),
    BW_CONFIG_MAP(channel_case, time, time_fields, "the run"),
    BW_CONFIG_MAP(channel_case, output, output_fields, "files"), BW_CONFIG_END};
#undef V

channel_case channel_case_default(void)
{
  return (channel_case){
      .domain = {.length = {NAN, NAN, NAN}, .cells = {INT_MIN, INT_MIN, INT_MIN}},
      .fluid = {.reynolds = NAN, .perturbation = 0.2},
      .time = {.spin_up = NAN, .statistics = NAN, .interval = 0.2, .courant_share = 0.8},
      .output = {.checkpoint_every = 5.0}};
}

channel_config channel_config_of(const channel_case *c)
{
  channel_config q = {.reynolds = c->fluid.reynolds,
                      .perturbation = c->fluid.perturbation,
                      .interval = c->time.interval,
                      .courant_share = c->time.courant_share,
                      .spin_up = c->time.spin_up};
  memcpy(q.length, c->domain.length, sizeof q.length);
  memcpy(q.cells, c->domain.cells, sizeof q.cells);
  return q;
}
