/* box_case.h -- flow in a box: what the sources of the case share.
 *
 * Any consistent units; p is over the density. Time advances in equal intervals (between samples);
 * the steps within one are chosen from field and time alone or fixed, so that what follows a
 * checkpoint (between two steps) does not depend on whether it was read. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "bw_ns_channel.h"

/* What the YAML file says (tables in box_config.c). */
typedef struct {
  int kind, profile;    /* bw_ns_side_kind, bw_ns_profile */
  double velocity[3];   /* of a wall or a uniform inflow [L/T]       default 0 */
  double bulk_velocity; /* of a Poiseuille inflow [L/T]; NaN: not given */
} box_side;
typedef struct {
  box_side lower, upper; /* at 0 and at the length */
} box_pair;
typedef struct {
  box_pair x, y, z;
  bool has_z; /* are there sides in z? Not in two dimensions */
} box_sides;
typedef struct {
  double length[3], stretch; /* [L]; of y by tanh [-], 0: uniform */
  int cells[3];              /* cells[2] = 1: two dimensions */
  char faces[1024];          /* path of a file with the faces in y; empty: none */
} box_domain;
typedef struct {
  double viscosity; /* kinematic [L^2/T] */
  int viscous;      /* bw_ns_viscous                               default explicit */
} box_fluid;
typedef struct {
  int kind;     /* bw_ns_forcing */
  double value; /* bulk velocity [L/T], or -dp/dx over the density [L/T^2] */
} box_forcing;
typedef struct {
  double centre[2], radius; /* in x and y; where it is fastest [L] */
  double swirl;             /* largest velocity [L/T]; > 0: counterclockwise */
} box_vortex;
enum { BOX_VORTICES = 8 };
typedef struct {
  double velocity[3]; /* everywhere [L/T]                              default 0 */
  int n_vortices;     /* added to it */
  box_vortex vortices[BOX_VORTICES];
} box_start;
typedef struct {
  double end, step;   /* of the run; fixed step, NaN: limit_share decides [T] */
  double limit_share; /* step over the largest stable one [-]          default 0.8 */
} box_time;
typedef struct {
  double sample_every;     /* rows of history.csv [T] */
  double picture_every;    /* VTK files [T]; 0: at the end             default 0 */
  double checkpoint_every; /* checkpoint.h5 [T]; 0: at the end         default 0 */
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

extern const bw_config_field box_fields[]; /* its keys */
box_config box_config_default(void);       /* required values NaN or INT_MIN */

/* The configurations of grid and solver, all contradictions found. Local. */
bw_status box_resolve(box_config *c, bw_grid_config *grid,
                      bw_ns_channel_config *fluid) BW_MUST_CHECK;

/* A run. */
typedef struct {
  const box_config *config; /* borrowed */
  bw_case *run;             /* borrowed */
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_history *history;
  int64_t intervals, steps; /* done */
  double dt;                /* the last step */
  int64_t rows;             /* of history.csv, when the checkpoint was written */
  bool stopped;             /* asked to end early */
} box_run;

/* box_run.c. All collective. */
/* The grid with its faces to be looked at, nothing on it; the caller's (bw_grid_destroy). */
bw_status box_plan(const box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                   bw_grid **plan) BW_MUST_CHECK;
bw_status box_create(box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                     const bw_ns_channel_config *fluid) BW_MUST_CHECK;
void box_destroy(box_run *b);                        /* half-built objects, too */
int64_t box_intervals(const box_config *c);          /* of the whole run */
bw_status box_start_field(box_run *b) BW_MUST_CHECK; /* what `start` describes */
/* One interval; less of it when the run is asked to stop. */
bw_status box_advance(box_run *b) BW_MUST_CHECK;
bw_status box_restart(box_run *b, const char *path) BW_MUST_CHECK; /* goes on from a file */
bw_status box_checkpoint(box_run *b) BW_MUST_CHECK;                /* checkpoint.h5 */

/* box_output.c. All collective. */
/* Sizes, sides, steps and memory to the log, from the grid as it would be built; a step that cannot
 * be stable is refused. Takes no memory for fields. */
bw_status box_describe(const box_run *b, const bw_grid *plan,
                       const bw_ns_channel_config *fluid) BW_MUST_CHECK;
/* Creates history.csv, or goes on with it from the checkpoint that was read. */
bw_status box_open_history(box_run *b) BW_MUST_CHECK;
void box_sample(box_run *b);                     /* a row of it */
bw_status box_picture(box_run *b) BW_MUST_CHECK; /* adds the present fields to fluid.pvd */
