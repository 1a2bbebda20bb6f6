/* The keys of bending_plate.yaml and their defaults. */
#include "bending_case.h"
#include "bw_coupler_fields.h"
#include "bw_solid_words.h"

#define V BW_CONFIG_VALUE
static const bw_config_field channel_fields[] = {
    V(bending_channel, length, BW_REQUIRED, BW_ABOVE(0), "m",
      "length of the channel, along the stream"),
    V(bending_channel, height, BW_REQUIRED, BW_ABOVE(0), "m",
      "height of the channel, from wall to wall"),
    V(bending_channel, cells, BW_REQUIRED, BW_AT_LEAST(4), "",
      "cells in x and y; cells are squares"),
    BW_CONFIG_END};
static const bw_config_field fluid_fields[] = {
    V(bending_fluid, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density of the fluid"),
    V(bending_fluid, viscosity, BW_REQUIRED, BW_ABOVE(0), "m2/s",
      "kinematic viscosity of the fluid"),
    V(bending_fluid, bulk_velocity, BW_REQUIRED, BW_ABOVE(0), "m/s",
      "mean velocity of the Poiseuille inflow"),
    BW_CONFIG_END};
static const bw_config_field plate_fields[] = {
    V(bending_plate, front, BW_REQUIRED, BW_ABOVE(0), "m",
      "distance of the plate's upstream face from the inflow"),
    V(bending_plate, thickness, BW_REQUIRED, BW_ABOVE(0), "m",
      "thickness of the plate, along the stream"),
    V(bending_plate, height, BW_REQUIRED, BW_ABOVE(0), "m", "height of the plate over the wall"),
    V(bending_plate, particles_across, BW_REQUIRED, BW_FROM_TO(2, 1000), "",
      "particles across the plate's thickness"),
    V(bending_plate, clamped_layers, BW_OPTIONAL, BW_FROM_TO(1, 16), "",
      "rows of held particles under the wall"),
    V(bending_plate, young_modulus, BW_REQUIRED, BW_ABOVE(0), "Pa", "Young's modulus of the plate"),
    V(bending_plate, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density of the plate"),
    V(bending_plate, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "",
      "horizon over the spacing of the particles"),
    V(bending_plate, damping_mean, BW_OPTIONAL, BW_AT_LEAST(0), "kg/(m3 s)",
      "damping against the mean of the neighbours, k_d of FSI 9"),
    V(bending_plate, damping_pair, BW_OPTIONAL, BW_AT_LEAST(0), "N s/m7",
      "damping along bonds, k_d of POROUS 3.41"),
    V(bending_plate, damping_absolute, BW_OPTIONAL, BW_AT_LEAST(0), "kg/(m3 s)",
      "damping against rest, to bring the plate to rest"),
    BW_CONFIG_WORD(bending_plate, surface_correction, BW_OPTIONAL, bw_solid_correction_words,
                   "how bonds near surfaces are made as stiff as inside"),
    BW_CONFIG_END};

static const bw_config_field physics_fields[] = {
    BW_CONFIG_MAP(bending_config, channel, channel_fields, "the channel and its cells"),
    BW_CONFIG_MAP(bending_config, fluid, fluid_fields, "the fluid and its stream"),
    BW_CONFIG_MAP(bending_config, plate, plate_fields, "the plate and its particles"),
    BW_CONFIG_MAP(bending_config, coupling, bw_coupler_fields, "how fluid and solid meet"),
    BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(bending_time, step, BW_REQUIRED, BW_ABOVE(0), "s",
      "time step of the fluid; the solid sub-cycles"),
    V(bending_time, release, BW_OPTIONAL, BW_AT_LEAST(0), "s",
      "time until which the plate is held"),
    V(bending_time, end, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "s", "end of the run"),
    BW_CONFIG_END};
static const bw_config_field output_fields[] = {
    V(bending_output, sample_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(1), "steps",
      "steps between rows of history.csv"),
    V(bending_output, picture_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "steps",
      "steps between VTK files; 0: at the end only"),
    V(bending_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "steps",
      "steps between checkpoint-last.h5; 0: at the end only"),
    BW_CONFIG_END};
const bw_config_field bending_case_fields[] = {
    BW_CONFIG_MAP(bending_case, physics, physics_fields, "the set-up"),
    BW_CONFIG_MAP(bending_case, time, time_fields, "how long the run is"),
    BW_CONFIG_MAP(bending_case, output, output_fields, "when files are written"), BW_CONFIG_END};
#undef V

bending_case bending_case_default(void)
{
  return (bending_case){.physics = bending_config_default(),
                        .time = {.step = NAN, .end = NAN},
                        .output = {.sample_every = 10}};
}
