/* The words of case files for what a fluid can be told. */
#include "bw_ns_words.h"

#include "bw_ns_channel.h"

#include <stddef.h>

const bw_config_word bw_ns_side_words[] = {
    {"periodic", BW_SIDE_PERIODIC, "both sides of a direction"},
    {"wall", BW_SIDE_WALL, "no slip; velocity: it moves in its plane"},
    {"free_slip", BW_SIDE_FREE_SLIP, "a plane of symmetry"},
    {"inflow", BW_SIDE_INFLOW, "velocity given by profile"},
    {"outflow", BW_SIDE_OUTFLOW, "convective"},
    {NULL, 0, NULL}};

const bw_config_word bw_ns_profile_words[] = {
    {"uniform", BW_PROFILE_UNIFORM, "velocity"},
    {"poiseuille", BW_PROFILE_POISEUILLE, "laminar profile between the walls, by its mean"},
    {NULL, 0, NULL}};

const bw_config_word bw_ns_forcing_words[] = {
    {"flow_rate", BW_FORCING_FLOW_RATE, "value: bulk velocity [L/T]"},
    {"gradient", BW_FORCING_GRADIENT, "value: -dp/dx over the density [L/T2]"},
    {NULL, 0, NULL}};

const bw_config_word bw_ns_viscous_words[] = {
    {"explicit", BW_VISCOUS_EXPLICIT, "cheapest; the step is limited by dx^2/nu"},
    {"implicit_y", BW_VISCOUS_IMPLICIT_Y, "for cells that are thin in y"},
    {"implicit", BW_VISCOUS_IMPLICIT, "no limit by the viscosity"},
    {NULL, 0, NULL}};

const bw_config_word bw_ns_eddy_words[] = {
    {"none", BW_EDDY_NONE, "direct numerical simulation"},
    {"wale", BW_EDDY_WALE, "WALE, C = 0.325, for cells too coarse for the eddies"},
    {NULL, 0, NULL}};
