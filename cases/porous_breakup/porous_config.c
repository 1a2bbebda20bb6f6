/* The keys of porous_breakup.yaml and their defaults. */
#include "bw_coupler_fields.h"
#include "bw_solid_words.h"
#include "porous_body.h"

#include <limits.h>
#include <math.h>

#define V BW_CONFIG_VALUE
static const bw_config_field domain_fields[] = {
    V(porous_domain, length, BW_REQUIRED, BW_ABOVE(0), "m",
      "edges of the box: along the stream, from wall to wall, along the span"),
    V(porous_domain, cells, BW_REQUIRED, BW_AT_LEAST(4), "",
      "cells in x, y and z; cells are cubes"),
    BW_CONFIG_END};

static const bw_config_field fluid_fields[] = {
    V(porous_fluid, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density of the fluid"),
    V(porous_fluid, viscosity, BW_REQUIRED, BW_ABOVE(0), "m2/s",
      "kinematic viscosity of the fluid"),
    V(porous_fluid, bulk_velocity, BW_REQUIRED, BW_ABOVE(0), "m/s",
      "mean velocity of the Poiseuille inflow"),
    BW_CONFIG_END};

static const bw_config_field solid_fields[] = {
    V(porous_solid, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density of the solid"),
    V(porous_solid, young_modulus, BW_REQUIRED, BW_ABOVE(0), "Pa", "Young's modulus of the solid"),
    V(porous_solid, fracture_energy, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "J/m2",
      "fracture energy G0; another one may go on from where nothing has broken yet"),
    V(porous_solid, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "",
      "horizon over the spacing of the particles"),
    V(porous_solid, damping_pair, BW_OPTIONAL, BW_AT_LEAST(0), "N s/m7",
      "damping along bonds, k_d of POROUS 3.41"),
    BW_CONFIG_WORD(porous_solid, surface_correction, BW_OPTIONAL, bw_solid_correction_words,
                   "how bonds near surfaces are made as stiff as inside"),
    BW_CONFIG_WORD(porous_solid, integrator, BW_OPTIONAL, bw_solid_integrator_words,
                   "how the solid advances in time"),
    V(porous_solid, contact, BW_OPTIONAL, BW_ANY, "",
      "whether fragments repel each other and the channel's walls"),
    BW_CONFIG_END};

static const bw_config_word lattice_words[] = {
    {"pores_sc", BW_SHAPE_PORES_SC, "simple cubic"},
    {"pores_bcc", BW_SHAPE_PORES_BCC, "body-centred cubic"},
    {"pores_fcc", BW_SHAPE_PORES_FCC, "face-centred cubic"},
    {NULL, 0, NULL}};
static const bw_config_word clamp_words[] = {{"floor", CLAMP_FLOOR, "the lower wall"},
                                             {"ceiling", CLAMP_CEILING, "the upper wall"},
                                             {"both", CLAMP_BOTH, "both, as in POROUS 6.2"},
                                             {NULL, 0, NULL}};
static const bw_config_field random_fields[] = {
    V(porous_random, radius, BW_REQUIRED, BW_ABOVE(0), "m",
      "smallest and largest radius of the pores"),
    V(porous_random, porosity, BW_REQUIRED, BW_BETWEEN(0, 1), "",
      "porosity to be expected; pores overlap freely"),
    V(porous_random, seed, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "number of the medium; another one gives another medium"),
    BW_CONFIG_END};
static const bw_config_word unit_words[] = {{"m", 0, NULL},  {"cm", 1, NULL}, {"mm", 2, NULL},
                                            {"um", 3, NULL}, {"nm", 4, NULL}, {NULL, 0, NULL}};
const double porous_units[] = {1.0, 1e-2, 1e-3, 1e-6, 1e-9};
static const bw_config_word type_words[] = {{"uint8", BW_SHAPE_VOXEL_U8, NULL},
                                            {"int8", BW_SHAPE_VOXEL_I8, NULL},
                                            {"uint16", BW_SHAPE_VOXEL_U16, NULL},
                                            {"int16", BW_SHAPE_VOXEL_I16, NULL},
                                            {"uint32", BW_SHAPE_VOXEL_U32, NULL},
                                            {"int32", BW_SHAPE_VOXEL_I32, NULL},
                                            {"uint64", BW_SHAPE_VOXEL_U64, NULL},
                                            {"int64", BW_SHAPE_VOXEL_I64, NULL},
                                            {"float32", BW_SHAPE_VOXEL_F32, NULL},
                                            {"float64", BW_SHAPE_VOXEL_F64, NULL},
                                            {NULL, 0, NULL}};
static const bw_config_word order_words[] = {
    {"little", 0, "the least byte of a number comes first"},
    {"big", 1, "the largest comes first"},
    {NULL, 0, NULL}};
static const bw_config_field image_fields[] = {
    V(porous_image, file, BW_REQUIRED, BW_FILE, "",
      "path of an NRRD, MetaImage, TIFF or npy file, of a folder or pattern of TIFF files, or of a "
      "raw one"),
    V(porous_image, solid, BW_REQUIRED, BW_ANY, "", "smallest and largest value of a solid voxel"),
    V(porous_image, voxel, BW_OPTIONAL, BW_ABOVE(0), "m",
      "edge of a voxel that is a cube; left out: as the file says"),
    V(porous_image, spacing, BW_OPTIONAL, BW_ABOVE(0), "m",
      "edges of a voxel along x, y, z; left out: as the file says"),
    BW_CONFIG_WORD(porous_image, unit, BW_OPTIONAL, unit_words,
                   "unit of the spacings in the file; left out: as the file says, else m"),
    V(porous_image, size, BW_OPTIONAL, BW_AT_LEAST(1), "",
      "voxels along x, y, z of a raw file, x fastest"),
    BW_CONFIG_WORD(porous_image, type, BW_OPTIONAL, type_words, "numbers of a raw file"),
    BW_CONFIG_WORD(porous_image, byte_order, BW_OPTIONAL, order_words,
                   "order of bytes in a number of a raw file"),
    V(porous_image, skip, BW_OPTIONAL, BW_AT_LEAST(0), "bytes",
      "bytes of a raw file before its numbers"),
    V(porous_image, from, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "first voxel along x, y, z that counts, from 0"),
    V(porous_image, to, BW_OPTIONAL, BW_AT_LEAST(1), "",
      "voxel along x, y, z before which it ends; left out: all count"),
    V(porous_image, flip, BW_OPTIONAL, BW_ANY, "",
      "whether the voxels along x, y, z come in reverse"),
    V(porous_image, coarsen, BW_OPTIONAL, BW_FROM_TO(1, 1024), "",
      "voxels along x, y, z that make one, solid where half of them are"),
    BW_CONFIG_END};
static const bw_config_field surface_fields[] = {
    V(porous_surface, file, BW_REQUIRED, BW_FILE, "", "path of an STL file with a closed surface"),
    V(porous_surface, scale, BW_OPTIONAL, BW_ABOVE(0), "m", "length of one unit of the file"),
    BW_CONFIG_END};
static const bw_config_field medium_fields[] = {
    V(porous_medium, front, BW_REQUIRED, BW_ABOVE(0), "m",
      "distance of the medium's front from the inflow"),
    V(porous_medium, length, BW_REQUIRED, BW_ABOVE(0), "m",
      "length of the medium along the stream"),
    BW_CONFIG_WORD(porous_medium, lattice, BW_OPTIONAL, lattice_words,
                   "lattice on whose sites the pores are"),
    V(porous_medium, pitch, BW_OPTIONAL, BW_ABOVE(0), "m", "pitch of the pores' lattice"),
    V(porous_medium, radius_over_pitch, BW_OPTIONAL, BW_BETWEEN(0, 1), "",
      "radius of the pores over the pitch"),
    V(porous_medium, offset, BW_OPTIONAL, BW_FROM_TO(0, 1), "",
      "place of the first pore in the medium's box, in pitches"),
    BW_CONFIG_MAP_IF(porous_medium, random, has_random, random_fields,
                     "instead of a lattice: balls at random places are pores"),
    BW_CONFIG_MAP_IF(
        porous_medium, image, has_image, image_fields,
        "instead of a lattice: voxels, the first one's corner at front, floor and z = 0"),
    BW_CONFIG_MAP_IF(porous_medium, surface, has_surface, surface_fields,
                     "instead of a lattice: a body, its box's corner at front, floor and z = 0"),
    BW_CONFIG_WORD(porous_medium, clamped, BW_OPTIONAL, clamp_words,
                   "which of the channel's walls hold the medium"),
    V(porous_medium, clamped_layers, BW_OPTIONAL, BW_FROM_TO(0, 16), "",
      "layers of particles behind each of these walls that hold the medium"),
    BW_CONFIG_END};

static const bw_config_field phase_fields[] = {
    V(porous_phase, time_step, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "s",
      "time step of the fluid; the solid sub-cycles"),
    V(porous_phase, steps, BW_REQUIRED | BW_MAY_CHANGE, BW_AT_LEAST(0), "", "steps at most"),
    V(porous_phase, settled, BW_OPTIONAL | BW_MAY_CHANGE, BW_FROM_TO(0, 1), "",
      "relative change of the pressure drop per h/U_b below which the phase ends early; 0: never"),
    V(porous_phase, settling_rate, BW_OPTIONAL, BW_AT_LEAST(0), "1/s",
      "absolute damping of the solid over its density"),
    BW_CONFIG_END};

static const bw_config_field output_fields[] = {
    V(porous_output, sample_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(1), "steps",
      "steps between rows of history.csv"),
    V(porous_output, picture_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "steps",
      "steps between VTK files; 0: at the ends of phases only"),
    V(porous_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "steps",
      "steps between checkpoint-last.h5; 0: at the ends of phases only"),
    V(porous_output, keep_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(1), "steps",
      "steps between good states in memory, one of which is written if the run diverges"),
    BW_CONFIG_END};

const bw_config_field porous_fields[] = {
    BW_CONFIG_MAP(porous_config, domain, domain_fields, "the channel and its cells"),
    BW_CONFIG_MAP(porous_config, fluid, fluid_fields, "the fluid and its stream"),
    BW_CONFIG_MAP(porous_config, solid, solid_fields, "the material of the medium"),
    BW_CONFIG_MAP(porous_config, medium, medium_fields, "the porous body"),
    BW_CONFIG_MAP(porous_config, coupling, bw_coupler_fields, "how fluid and solid meet"),
    BW_CONFIG_MAP(porous_config, flow, phase_fields,
                  "phase 1: the medium is rigid, the flow settles"),
    BW_CONFIG_MAP(porous_config, deformation, phase_fields,
                  "phase 2: the medium is elastic, nothing breaks"),
    BW_CONFIG_MAP(porous_config, breakage, phase_fields, "phase 3: bonds may break"),
    BW_CONFIG_MAP(porous_config, output, output_fields, "when files are written"),
    BW_CONFIG_END};
#undef V

porous_config porous_config_default(void)
{
  const porous_phase phase = {.time_step = NAN, .steps = INT_MIN};
  const int unset = INT_MIN;
  return (porous_config){.domain = {.length = {NAN, NAN, NAN}, .cells = {unset, unset, unset}},
                         .fluid = {.density = NAN, .viscosity = NAN, .bulk_velocity = NAN},
                         .solid = {.density = NAN,
                                   .young_modulus = NAN,
                                   .fracture_energy = NAN,
                                   .horizon_ratio = 3.0,
                                   .surface_correction = BW_PD_SURFACE_VOLUME,
                                   .integrator = BW_SOLID_VERLET,
                                   .contact = true},
                         .medium = {.lattice = BW_SHAPE_PORES_SC,
                                    .front = NAN,
                                    .length = NAN,
                                    .pitch = NAN,
                                    .radius_over_pitch = NAN,
                                    .offset = {0.5, 0.5, 0.5},
                                    .random = {.radius = {NAN, NAN}, .porosity = NAN, .seed = 1},
                                    .image = {.solid = {NAN, NAN},
                                              .voxel = NAN,
                                              .spacing = {NAN, NAN, NAN},
                                              .unit = unset,
                                              .size = {unset, unset, unset},
                                              .type = unset,
                                              .coarsen = {1, 1, 1},
                                              .from = {unset, unset, unset},
                                              .to = {unset, unset, unset}},
                                    .surface = {.scale = 1.0},
                                    .clamped = CLAMP_FLOOR,
                                    .clamped_layers = 3},
                         .coupling = bw_coupler_config_default(),
                         .flow = phase,
                         .deformation = phase,
                         .breakage = phase,
                         .output = {.sample_every = 10, .keep_every = 50}};
}

const char *const porous_phase_name[PHASE_COUNT] = {"flow", "deformation", "breakage"};

const porous_phase *porous_phase_of(const porous_config *q, int phase)
{
  const porous_phase *const all[PHASE_COUNT] = {&q->flow, &q->deformation, &q->breakage};
  return all[phase];
}
