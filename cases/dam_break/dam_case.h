/* dam_case.h -- water in a tank, and a solid in it: what the sources of the case share.
 *
 * Any consistent units. The tank is 0 .. size with walls on all sides but the top; y is up. The
 * case is a scene (bw_scene.h) with keys of its own. */
#pragma once
#include "bw_scene.h"
#include "bw_solid.h"

enum { DAM_BOXES = 16, DAM_GAUGES = 16, DAM_NAME = 32 };

/* What the YAML file says (tables in dam_config.c). */
typedef struct {
  double size[3]; /* inside [L]; size[2] = 0: two dimensions */
  bool no_slip;   /* default false */
} dam_tank;
typedef struct {
  double lower[3], upper[3]; /* corners [L] */
} dam_box;
typedef struct {
  double spacing, density, viscosity; /* [L], [M/L3], dynamic [M/(L T)]     viscosity default 0 */
  double gravity;                     /* along -y [L/T2] */
  double speed;                       /* the largest expected [L/T]; NaN: 2 sqrt(gravity depth) */
  double sound_speed; /* [L/T]; NaN: 10 times the larger of speed and sqrt(gravity depth) */
  double alpha, alpha_wall, delta, shifting; /* as in bw_ulph_config */
} dam_fluid;
typedef struct {
  double amplitude[3], period; /* x = amplitude (cos(2 pi t/period) - 1) [L], [T] */
} dam_motion;
typedef enum {
  DAM_DEPTH,
  DAM_PRESSURE,
  DAM_FRONT,
  DAM_HEIGHT,
  DAM_ASIDE, /* of the solid, along x */
  DAM_UP     /* along y */
} dam_gauge_kind;
typedef struct {
  char name[DAM_NAME];
  int kind;
  double at[3], width;       /* depth: of the column; it goes with the tank [L] */
  double lower[3], upper[3]; /* pressure, front, height: looked at in this box; aside, up: where the
                                particles were at the start [L] */
} dam_gauge;
typedef struct {
  double lower[3], upper[3]; /* corners [L] */
  bool held; /* does not move                                            default false */
} dam_part;
typedef struct {
  double spacing, density, young; /* [L], [M/L3], [M/(L T2)] */
  double fracture_energy;         /* [M/T2]                                default INFINITY */
  double horizon_ratio;           /* NaN: 1.5 for correspondence that does not break, else 2 */
  double damping_pair;            /* [M/(L6 T)]                                  default 0 */
  bool contact;                   /* pieces push each other and the tank         default false */
  bw_solid_law_choice choice;
  int n_parts;
  dam_part parts[DAM_BOXES];
} dam_solid;
typedef struct {
  double end;        /* of the run [T] */
  double step_share; /* acoustic step over dx/(c0 + U) [-]                     default 1 */
} dam_time;
typedef struct {
  double sample_every, picture_every, checkpoint_every; /* [T]; 0: at the end */
} dam_output;
typedef struct {
  dam_tank tank;
  dam_fluid fluid;
  int n_water, n_obstacles, n_gauges;
  dam_box water[DAM_BOXES], obstacles[DAM_BOXES];
  dam_gauge gauges[DAM_GAUGES];
  bool hydrostatic; /* start with the pressure of water at rest            default true */
  bool has_motion;
  dam_motion motion;
  bool has_solid;
  dam_solid solid;
  dam_time time;
  dam_output output;
} dam_config;

extern const bw_config_field dam_fields[]; /* its keys */
dam_config dam_config_default(void);       /* required values NaN */

/* Refuses every contradiction, in the words of the case's keys. Local. */
bw_status dam_check(const dam_config *c) BW_MUST_CHECK;

/* *scene (bw_scene_config_default) <- the tank as a scene: its box, the water, obstacles as one
 * fixed body, the solid as another, gauges, when files are written. After dam_check. Local. */
void dam_to_scene(const dam_config *c, bw_scene_config *scene);
