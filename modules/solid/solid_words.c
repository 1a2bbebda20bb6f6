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
const bw_config_word bw_solid_integrator_words[] = {
    {"verlet", BW_SOLID_VERLET, NULL}, {"rk3", BW_SOLID_RK3, NULL}, {NULL, 0, NULL}};
