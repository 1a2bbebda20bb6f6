/* box_case.h -- flow in a box: what the sources of the case share.
 *
 * Any consistent units; p is over the density. Time advances in equal intervals (between samples);
 * the steps within one are chosen from the field alone or fixed, so that what follows a checkpoint
 * (between intervals) does not depend on whether it was read. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "bw_ns_channel.h"

/* What the YAML file says (tables in box_config.c). */
typedef struct {
  int kind, profile;
  double velocity[3], bulk_velocity;
} box_side;
typedef struct {
  box_side lower, upper;
} box_pair;
typedef struct {
  box_pair x, y, z;
  bool has_z;
} box_sides;
typedef struct {
  double length[3], stretch;
  int cells[3];
  char faces[256];
} box_domain;
typedef struct {
  double viscosity;
  int viscous;
} box_fluid;
typedef struct {
  int kind;
  double value;
} box_forcing;
typedef struct {
  double centre[2], radius, swirl;
} box_vortex;
enum { BOX_VORTICES = 8 };
typedef struct {
  double velocity[3];
  int n_vortices;
  box_vortex vortices[BOX_VORTICES];
} box_start;
typedef struct {
  double end, step, limit_share;
} box_time;
typedef struct {
  double sample_every, picture_every, checkpoint_every;
} box_output;
typedef struct {
  box_domain domain;
  box_fluid fluid;
  box_sides sides;
  bool has_forcing;
  box_forcing forcing;
  box_start start;
  box_time time;
  box_output output;
} box_config;

extern const bw_config_field box_fields[];
box_config box_config_default(void);

/* The configurations of grid and solver, all contradictions found. Local. */
bw_status box_resolve(box_config *c, bw_grid_config *grid,
                      bw_ns_channel_config *fluid) BW_MUST_CHECK;

typedef struct {
  const box_config *config;
  bw_case *run;
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_history *history;
  int64_t intervals, steps; /* done */
  double dt;                /* the last step */
} box_run;

/* box_run.c. All collective. */
bw_status box_create(box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                     const bw_ns_channel_config *fluid) BW_MUST_CHECK;
void box_destroy(box_run *b);
int64_t box_intervals(const box_config *c);          /* of the whole run */
bw_status box_start_field(box_run *b) BW_MUST_CHECK; /* what `start` describes */
bw_status box_advance(box_run *b) BW_MUST_CHECK;     /* one interval */
bw_status box_restart(box_run *b, const char *path) BW_MUST_CHECK;
bw_status box_checkpoint(box_run *b) BW_MUST_CHECK;

/* box_output.c. All collective. */
void box_describe(box_run *b);
bw_status box_open_history(box_run *b, double restart_time) BW_MUST_CHECK;
void box_sample(box_run *b);
bw_status box_picture(box_run *b) BW_MUST_CHECK;
