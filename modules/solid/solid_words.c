#include "bw_solid.h"
#include "bw_solid_words.h"

const bw_config_word bw_solid_correction_words[] = {
    {"none", BW_PD_SURFACE_NONE, NULL},
    {"volume", BW_PD_SURFACE_VOLUME, "POROUS 3.43, 3.44"},
    {"energy", BW_PD_SURFACE_ENERGY, "that of a dilation"},
    {"tensor", BW_PD_SURFACE_TENSOR, "every family has the elasticity asked for"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_fraction_words[] = {
    {"default", BW_PD_FRACTION_DEFAULT, "exact in 3D, linear in 2D"},
    {"linear", BW_PD_FRACTION_LINEAR, "POROUS 3.33"},
    {"exact", BW_PD_FRACTION_EXACT, "part of the cell within the horizon"},
    {"none", BW_PD_FRACTION_NONE, NULL},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_reach_words[] = {
    {"half_cell", BW_PD_REACH_HALF_CELL, "horizon + ds/2"},
    {"horizon", BW_PD_REACH_HORIZON, NULL},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_calibration_words[] = {
    {"none", BW_PD_CALIBRATION_NONE, "integrals over the horizon"},
    {"lattice", BW_PD_CALIBRATION_LATTICE, "sums over a lattice's family"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_integrator_words[] = {
    {"verlet", BW_SOLID_VERLET, NULL}, {"rk3", BW_SOLID_RK3, NULL}, {NULL, 0, NULL}};
const bw_config_word bw_solid_law_words[] = {
    {"bond", BW_SOLID_BOND, "springs along bonds; Poisson's ratio 1/4, in plane stress 1/3"},
    {"ordinary", BW_SOLID_ORDINARY, "linear peridynamic solid, any Poisson's ratio"},
    {"correspondence", BW_SOLID_CORRESPONDENCE, "a material of deformation gradients"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_influence_words[] = {
    {"constant", BW_PD_STATE_CONSTANT, "1"},
    {"inverse", BW_PD_STATE_INVERSE, "1 over the distance"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_weight_words[] = {
    {"cubic", BW_PD_STATE_CUBIC, "falls to 0 where the family ends"},
    {"uniform", BW_PD_STATE_UNIFORM, "1"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_elastic_words[] = {
    {"linear", BW_PD_MATERIAL_LINEAR, "small strains without turns"},
    {"saint_venant", BW_PD_MATERIAL_SAINT_VENANT, "St. Venant-Kirchhoff"},
    {"neo_hookean", BW_PD_MATERIAL_NEO_HOOKEAN, NULL},
    {"hencky", BW_PD_MATERIAL_HENCKY, "of logarithmic strain"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_breaks_words[] = {
    {"stretch", BW_PD_STATE_BREAKS_BY_STRETCH, "that of the fracture energy"},
    {"stress", BW_PD_STATE_BREAKS_BY_STRESS, "largest principal stress of its ends"},
    {"flow", BW_PD_STATE_BREAKS_BY_FLOW, "plastic flow of its ends"},
    {"energy", BW_PD_STATE_BREAKS_BY_ENERGY, "energy of their stress, as of uniaxial tension"},
    {"mises", BW_PD_STATE_BREAKS_BY_MISES, "von Mises stress of its ends"},
    {"mohr_coulomb", BW_PD_STATE_BREAKS_BY_MOHR_COULOMB, "their shear and pressure"},
    {"drucker_prager", BW_PD_STATE_BREAKS_BY_CONE, "their deviator and pressure"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_plastic_words[] = {
    {"none", BW_SOLID_ELASTIC, "it does not yield"},
    {"j2", BW_SOLID_J2, "by the size of the deviator"},
    {"drucker_prager", BW_SOLID_DRUCKER_PRAGER, "by deviator and pressure"},
    {NULL, 0, NULL}};
const bw_config_word bw_solid_cone_words[] = {
    {"compression", BW_PD_MATERIAL_COMPRESSION_CONE, "in triaxial compression"},
    {"extension", BW_PD_MATERIAL_EXTENSION_CONE, "in triaxial extension"},
    {"plane_associated", BW_PD_MATERIAL_PLANE_ASSOCIATED, "in plane strain, dilating fully"},
    {"plane_isochoric", BW_PD_MATERIAL_PLANE_ISOCHORIC, "in plane strain without dilation"},
    {NULL, 0, NULL}};
