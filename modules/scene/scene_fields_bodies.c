/* The keys of materials, bodies and loads. */
#include "bw_shape.h"
#include "bw_solid.h"
#include "bw_solid_words.h"
#include "scene_internal.h"

#define V    BW_CONFIG_VALUE
#define OURS bw_scene_material
const bw_config_field bw_scene__material_fields[] = {
    V(OURS, name, BW_REQUIRED, BW_ANY, "", "by which bodies call it"),
    V(OURS, law, BW_OPTIONAL, BW_ANY, "",
      "how it answers to deformation: bond, or another row of --laws"),
    V(OURS, elastic, BW_OPTIONAL, BW_ANY, "", "elastic law of a state-based material"),
    V(OURS, plastic, BW_OPTIONAL, BW_ANY, "", "plastic law of a state-based material"),
    V(OURS, density, BW_REQUIRED, BW_ABOVE(0), "M/L3", "density"),
    V(OURS, young_modulus, BW_REQUIRED, BW_ABOVE(0), "M/(L T2)", "Young's modulus"),
    V(OURS, poisson_ratio, BW_OPTIONAL, BW_BETWEEN(-1, 0.5), "",
      "Poisson's ratio; left out: the law's own (bonds: 1/4, in plane stress 1/3)"),
    V(OURS, fracture_energy, BW_OPTIONAL, BW_ABOVE(0), "M/T2",
      "fracture energy of breakable bodies"),
    V(OURS, cohesion, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L T2)", "of drucker_prager"),
    V(OURS, friction_angle, BW_OPTIONAL, BW_FROM_TO(0, 89), "deg", "of drucker_prager"),
    V(OURS, dilation_angle, BW_OPTIONAL, BW_FROM_TO(0, 89), "deg", "of drucker_prager"),
    V(OURS, yield_stress, BW_OPTIONAL, BW_ABOVE(0), "M/(L T2)", "of j2"),
    V(OURS, hardening, BW_OPTIONAL, BW_AT_LEAST(0), "M/(L T2)", "of j2"),
    BW_CONFIG_WORD(bw_scene_material, influence, BW_OPTIONAL, bw_solid_influence_words,
                   "law ordinary: how much a neighbour at a distance counts"),
    BW_CONFIG_WORD(bw_scene_material, weight, BW_OPTIONAL, bw_solid_weight_words,
                   "law correspondence: how much a neighbour at a distance counts"),
    BW_CONFIG_WORD(bw_scene_material, breaks, BW_OPTIONAL, bw_solid_breaks_words,
                   "law correspondence: what breaks a bond of a breakable body"),
    V(OURS, limit, BW_OPTIONAL, BW_ABOVE(0), "M/(L T2) or 1",
      "stress, cohesion or factor of flow that a pair bears, by breaks"),
    BW_CONFIG_WORD(bw_scene_material, cone, BW_OPTIONAL, bw_solid_cone_words,
                   "of drucker_prager: where the cone meets Mohr-Coulomb's pyramid"),
    V(OURS, stabilisation, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "law correspondence: stiffness against modes without energy, over mu"),
    BW_CONFIG_END};
#undef OURS

const bw_config_field bw_scene__box_fields[] = {
    V(bw_scene_box, from, BW_REQUIRED, BW_POINT, "L", "lower corner"),
    V(bw_scene_box, to, BW_REQUIRED, BW_POINT, "L", "upper corner"), BW_CONFIG_END};
static const bw_config_field cylinder_fields[] = {
    BW_CONFIG_WORD(bw_scene_cylinder, axis, BW_OPTIONAL, bw_scene__axis_words, "its direction"),
    V(bw_scene_cylinder, centre, BW_REQUIRED, BW_ANY, "L",
      "of its axis, two numbers across it in the order x, y, z"),
    V(bw_scene_cylinder, radius, BW_REQUIRED, BW_ABOVE(0), "L", "radius"),
    V(bw_scene_cylinder, from, BW_OPTIONAL, BW_ANY, "L", "lower end; left out: none"),
    V(bw_scene_cylinder, to, BW_OPTIONAL, BW_ANY, "L", "upper end; left out: none"),
    BW_CONFIG_END};
static const bw_config_field sphere_fields[] = {
    V(bw_scene_sphere, centre, BW_REQUIRED, BW_POINT, "L", "centre"),
    V(bw_scene_sphere, radius, BW_REQUIRED, BW_ABOVE(0), "L", "radius"), BW_CONFIG_END};
static const bw_config_word pores_words[] = {{"simple", BW_SHAPE_PORES_SC, "simple cubic"},
                                             {"body_centred", BW_SHAPE_PORES_BCC, NULL},
                                             {"face_centred", BW_SHAPE_PORES_FCC, NULL},
                                             {NULL, 0, NULL}};
static const bw_config_field pores_fields[] = {
    BW_CONFIG_WORD(bw_scene_pores, kind, BW_REQUIRED, pores_words, "lattice of the pores"),
    V(bw_scene_pores, centre, BW_REQUIRED, BW_POINT, "L", "centre of one pore"),
    V(bw_scene_pores, radius, BW_REQUIRED, BW_ABOVE(0), "L", "radius of a pore"),
    V(bw_scene_pores, pitch, BW_REQUIRED, BW_ABOVE(0), "L", "edge of the lattice's cube"),
    BW_CONFIG_END};
static const bw_config_field image_fields[] = {
    V(bw_scene_image, file, BW_REQUIRED, BW_FILE, "",
      "voxel image: NRRD, MetaImage, TIFF, npy; a folder or pattern of TIFF"),
    V(bw_scene_image, low, BW_OPTIONAL, BW_ANY, "", "least value of a voxel that is solid"),
    V(bw_scene_image, high, BW_OPTIONAL, BW_ANY, "", "largest value of a voxel that is solid"),
    V(bw_scene_image, at, BW_OPTIONAL, BW_POINT, "L", "lower corner; left out: the file's"),
    V(bw_scene_image, voxel, BW_OPTIONAL, BW_ABOVE(0), "L",
      "edge of a voxel; left out: the file's"),
    V(bw_scene_image, from, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "first voxel along x, y, z that counts, from 0"),
    V(bw_scene_image, to, BW_OPTIONAL, BW_AT_LEAST(1), "",
      "voxel along x, y, z before which it ends; left out: all count"),
    V(bw_scene_image, flip, BW_OPTIONAL, BW_ANY, "",
      "whether the voxels along x, y, z come in reverse"),
    V(bw_scene_image, coarsen, BW_OPTIONAL, BW_FROM_TO(1, 1024), "",
      "voxels along x, y, z that make one, solid where half of them are"),
    BW_CONFIG_END};
static const bw_config_field stl_fields[] = {
    V(bw_scene_stl, file, BW_REQUIRED, BW_FILE, "", "closed surface of triangles"),
    V(bw_scene_stl, unit, BW_OPTIONAL, BW_ABOVE(0), "L", "length of the file's unit"),
    V(bw_scene_stl, cell, BW_OPTIONAL, BW_ABOVE(0), "L",
      "cells it is filled with; left out: half the spacing"),
    BW_CONFIG_END};
#define S(m, flag, fields, help) BW_CONFIG_MAP_IF(bw_scene_shape, m, flag, fields, help)
const bw_config_field bw_scene__shape_fields[] = {
    S(box, has_box, bw_scene__box_fields, "a box along x, y, z"),
    S(cylinder, has_cylinder, cylinder_fields, "a cylinder along an axis"),
    S(sphere, has_sphere, sphere_fields, "a ball; in two dimensions a disc"),
    S(pores, has_pores, pores_fields, "overlapping spherical pores; with remove: true"),
    S(image, has_image, image_fields, "voxels of an image"),
    S(stl, has_stl, stl_fields, "what a surface encloses"),
    V(bw_scene_shape, minus, BW_OPTIONAL, BW_ANY, "", "take away the shapes of this body"),
    V(bw_scene_shape, remove, BW_OPTIONAL, BW_ANY, "", "take this shape away"),
    V(bw_scene_shape, held, BW_OPTIONAL, BW_ANY, "",
      "of a body that deforms: the particles of this shape are held"),
    V(bw_scene_shape, material, BW_OPTIONAL, BW_ANY, "", "of this shape; left out: the body's"),
    BW_CONFIG_END};
#undef S

static const bw_config_field held_fields[] = {
    V(bw_scene_held, by, BW_OPTIONAL, BW_ANY, "",
      "a body that holds this one: particles of this one that stand in it are held"),
    V(bw_scene_held, side, BW_OPTIONAL, BW_ANY, "",
      "x_lower, x_upper, y_lower ... of the body's own extent"),
    V(bw_scene_held, layers, BW_OPTIONAL, BW_FROM_TO(1, 1000), "",
      "layers of particles under that side"),
    BW_CONFIG_MAP_IF(bw_scene_held, box, has_box, bw_scene__box_fields, "what is in a box"),
    BW_CONFIG_END};
static const bw_config_field crack_fields[] = {
    V(bw_scene_crack, from, BW_REQUIRED, BW_POINT, "L", "one end"),
    V(bw_scene_crack, to, BW_REQUIRED, BW_POINT, "L", "the other end"),
    V(bw_scene_crack, along, BW_OPTIONAL, BW_POINT, "L",
      "in three dimensions: the cut is the parallelogram of to - from and this edge"),
    BW_CONFIG_END};
static const bw_config_field level_fields[] = {
    V(bw_scene_level, level, BW_REQUIRED, BW_FROM_TO(1, BW_PD_FINEST), "",
      "1: half the spacing, 2: a quarter, and so on"),
    V(bw_scene_level, from, BW_REQUIRED, BW_POINT, "L", "lower corner of a box along x, y, z"),
    V(bw_scene_level, to, BW_REQUIRED, BW_POINT, "L", "upper corner"), BW_CONFIG_END};
static const bw_config_word trigger_words[] = {
    {"stretch", BW_PD_LEVELS_STRETCH, "of bonds over what breaks the finest ones"},
    {"energy", BW_PD_LEVELS_ENERGY, "over the largest of all particles; for comparison"},
    {"damage", BW_PD_LEVELS_DAMAGE, "of particles; for comparison, it comes late"},
    {NULL, 0, NULL}};
static const bw_config_field refine_fields[] = {
    V(bw_scene_refine, level, BW_REQUIRED, BW_FROM_TO(1, BW_PD_FINEST), "",
      "of the finest particles; 1: half the spacing, 2: a quarter, and so on"),
    BW_CONFIG_WORD(bw_scene_refine, trigger, BW_OPTIONAL, trigger_words, "what is looked at"),
    V(bw_scene_refine, at, BW_OPTIONAL, BW_BETWEEN(0, 1), "", "cells beyond it have to be fine"),
    V(bw_scene_refine, coarsen_at, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "fine cells below it may be coarse again"),
    V(bw_scene_refine, buffer, BW_OPTIONAL, BW_ABOVE(1), "",
      "horizons of fine cells around those, at least"),
    V(bw_scene_refine, ahead, BW_OPTIONAL, BW_AT_LEAST(0), "",
      "horizons more that are made fine at once"),
    BW_CONFIG_END};
const bw_config_word bw_scene__motion_words[] = {
    {"fixed", BW_SCENE_FIXED, "it does not move"},
    {"prescribed", BW_SCENE_PRESCRIBED, "it moves as velocity, rotation and swing say"},
    {"rigid", BW_SCENE_RIGID, "it moves as one piece, by its mass and what acts on it"},
    {"elastic", BW_SCENE_ELASTIC, "it deforms"},
    {"breakable", BW_SCENE_BREAKABLE, "it deforms and breaks"},
    {NULL, 0, NULL}};
static const bw_config_field rotation_fields[] = {
    V(bw_scene_rotation, rate, BW_REQUIRED, BW_ANY, "1/T", "angular velocity [rad/T]"),
    V(bw_scene_rotation, axis, BW_OPTIONAL, BW_POINT, "", "direction; left out: z"),
    V(bw_scene_rotation, centre, BW_REQUIRED, BW_POINT, "L", "a point of the axis"), BW_CONFIG_END};
static const bw_config_field swing_fields[] = {
    V(bw_scene_swing, amplitude, BW_REQUIRED, BW_POINT, "L", "X = X0 + amplitude sin(2 pi f t)"),
    V(bw_scene_swing, frequency, BW_REQUIRED, BW_ABOVE(0), "1/T", "f"), BW_CONFIG_END};
static const bw_config_field rigid_fields[] = {
    V(bw_scene_rigid, mass, BW_OPTIONAL, BW_ABOVE(0), "M",
      "left out: its shapes filled with its material"),
    V(bw_scene_rigid, centre, BW_OPTIONAL, BW_POINT, "L",
      "of mass; left out: of its shapes, filled evenly"),
    V(bw_scene_rigid, inertia, BW_OPTIONAL, BW_POINT, "M L2",
      "moments about the centre of mass along x, y, z; in two dimensions the last one counts; left "
      "out: of its shapes"),
    V(bw_scene_rigid, stiffness, BW_OPTIONAL, BW_POINT, "M/T2",
      "of springs along x, y, z between its centre and where that starts"),
    V(bw_scene_rigid, damping, BW_OPTIONAL, BW_POINT, "M/T", "of dampers beside these springs"),
    V(bw_scene_rigid, turn_stiffness, BW_OPTIONAL, BW_AT_LEAST(0), "M L2/T2",
      "of a spring against its turn"),
    V(bw_scene_rigid, turn_damping, BW_OPTIONAL, BW_AT_LEAST(0), "M L2/T", "of a damper beside it"),
    V(bw_scene_rigid, held, BW_OPTIONAL, BW_TEXTS, "",
      "in which it keeps its velocity at the start, mostly none: x, y, z, turn_x, turn_y, turn_z, "
      "turn (all three)"),
    BW_CONFIG_END};
#define OURS bw_scene_body
const bw_config_field bw_scene__body_fields[] = {
    V(OURS, name, BW_REQUIRED, BW_ANY, "", "by which the rest of the scene calls it"),
    BW_CONFIG_LIST(bw_scene_body, shape, n_shape, BW_REQUIRED, bw_scene__shape_fields,
                   "shapes in order: added, or taken away"),
    V(OURS, material, BW_OPTIONAL, BW_ANY, "",
      "what it is made of; not needed: fixed, prescribed, rigid with a mass"),
    BW_CONFIG_WORD(bw_scene_body, motion, BW_REQUIRED, bw_scene__motion_words, "how it moves"),
    V(OURS, spacing, BW_OPTIONAL, BW_ABOVE(0), "L", "of its particles; left out: the fluid's"),
    V(OURS, turn, BW_OPTIONAL, BW_ANY, "deg", "of its lattice about z"),
    V(OURS, velocity, BW_OPTIONAL, BW_POINT, "L/T",
      "of a prescribed body; of others that move, at the start"),
    BW_CONFIG_MAP_IF(bw_scene_body, rotation, has_rotation, rotation_fields,
                     "of a prescribed body; of others that move, at the start"),
    BW_CONFIG_MAP_IF(bw_scene_body, swing, has_swing, swing_fields, "of a prescribed body"),
    BW_CONFIG_MAP_IF(bw_scene_body, rigid, has_rigid, rigid_fields,
                     "of a rigid body: mass, springs, directions that are held; left out: free"),
    BW_CONFIG_LIST(bw_scene_body, held, n_held, BW_OPTIONAL, held_fields, "where it is held"),
    BW_CONFIG_LIST(bw_scene_body, cracks, n_cracks, BW_OPTIONAL, crack_fields,
                   "cuts that are there from the start"),
    BW_CONFIG_LIST(
        bw_scene_body, levels, n_levels, BW_OPTIONAL, level_fields,
        "boxes in which its particles are finer; cracks have to stay in the finest ones"),
    BW_CONFIG_MAP_IF(bw_scene_body, refine, has_refine, refine_fields,
                     "its particles become finer where it is about to crack, and coarser again"),
    BW_CONFIG_WORD(bw_scene_body, self_contact, BW_OPTIONAL, bw_scene__truth_words,
                   "does what breaks off collide with the rest? Left out: if the body breaks"),
    BW_CONFIG_END};
#undef OURS

static const bw_config_word load_words[] = {
    {"traction", BW_SCENE_TRACTION, "force per area of a side"},
    {"pressure", BW_SCENE_PRESSURE, "against a side"},
    {"force", BW_SCENE_FORCE, "sum over the place"},
    {"gravity", BW_SCENE_GRAVITY, "acceleration"},
    {"velocity", BW_SCENE_VELOCITY, "of particles that are held to it"},
    {NULL, 0, NULL}};
static const bw_config_field where_fields[] = {
    V(bw_scene_where, side, BW_OPTIONAL, BW_ANY, "",
      "x_lower, x_upper, y_lower ... of the body's own extent; crack: its cracks"),
    V(bw_scene_where, layers, BW_OPTIONAL, BW_FROM_TO(1, 1000), "",
      "layers of particles under that side that take the load"),
    BW_CONFIG_MAP_IF(bw_scene_where, box, has_box, bw_scene__box_fields,
                     "what of it is in a box, by the places at the start"),
    BW_CONFIG_END};
#define OURS bw_scene_load
const bw_config_field bw_scene__load_fields[] = {
    V(OURS, on, BW_REQUIRED, BW_ANY, "", "a body"),
    BW_CONFIG_WORD(bw_scene_load, kind, BW_REQUIRED, load_words, "what acts"),
    BW_CONFIG_BRIEF(bw_scene_load, where, has_where, where_fields,
                    "a side, a box, or both; left out: all of the body"),
    V(OURS, value, BW_REQUIRED, BW_POINT, "by kind",
      "traction, force, acceleration, velocity; one "
      "number: pressure"),
    V(OURS, ramp, BW_OPTIONAL, BW_AT_LEAST(0), "T", "time until all of it acts"),
    V(OURS, start, BW_OPTIONAL, BW_AT_LEAST(0), "T", "time at which it begins"),
    V(OURS, smooth, BW_OPTIONAL, BW_ANY, "", "the ramp is 3 x^2 - 2 x^3"),
    V(OURS, unbreakable, BW_OPTIONAL, BW_ANY, "", "bonds of the particles it acts on do not break"),
    BW_CONFIG_END};
#undef OURS
#undef V
