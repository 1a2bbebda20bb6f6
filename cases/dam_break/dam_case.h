/* dam_case.h -- water in a tank, and a solid in it: what the sources of the case share.
 *
 * Any consistent units. The tank is 0 .. size with walls on all sides but the top; y is up. Time
 * advances in equal intervals (between samples); the steps within one follow from the state alone,
 * so that what follows a checkpoint does not depend on whether it was read. */
#pragma once
#include "bw_case.h"
#include "bw_coupler_particles.h"
#include "bw_history.h"
#include "bw_shape.h"
#include "bw_ulph.h"
#include "bw_vtk.h"

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

/* The fluid's configuration, all contradictions found. Local. */
bw_status dam_resolve(const dam_config *c, bw_ulph_config *fluid) BW_MUST_CHECK;

/* A run. */
typedef struct {
  const dam_config *config; /* borrowed */
  bw_case *run;             /* borrowed */
  const bw_comm *comm;      /* borrowed */
  bw_ulph *fluid;
  bw_solid *solid;            /* NULL: there is none */
  bw_coupler_particles *both; /* NULL: the same */
  bw_history *history;
  int64_t intervals, rows; /* done; of history.csv, when the checkpoint was written */
  double dt;               /* the last step */
  /* Integrals over time of the pressure gauges in this interval, and the time that they cover. */
  double pressure[DAM_GAUGES], covered;
  bool stopped; /* asked to end early */
} dam_run;

/* dam_run.c. All collective. */
bw_status dam_create(dam_run *d, const bw_ulph_config *fluid) BW_MUST_CHECK;
void dam_destroy(dam_run *d);                    /* half-built objects, too */
int64_t dam_intervals(const dam_config *c);      /* of the whole run */
bw_status dam_advance(dam_run *d) BW_MUST_CHECK; /* one interval, or less when stopped */
bw_status dam_restart(dam_run *d, const char *path) BW_MUST_CHECK;
bw_status dam_checkpoint(dam_run *d) BW_MUST_CHECK; /* checkpoint.h5 */
void dam_where(const dam_run *d, double x[3]);      /* place of the tank now */
double dam_dt_max(dam_run *d);                      /* the step that is recommended now */
void dam_box_shape(const double lower[3], const double upper[3], bw_shape *shape); /* Local. */

/* dam_solid.c: nothing but the first is called without a solid. All collective. */
enum { DAM_SOLID_COLUMNS = 6 };
extern const char *const dam_solid_columns[DAM_SOLID_COLUMNS];
bw_status dam_solid_create(dam_run *d, const bw_ulph_config *fluid, int n_walls,
                           const bw_ulph_wall wall[]) BW_MUST_CHECK;
bw_status dam_solid_row(dam_run *d, double unit, double row[DAM_SOLID_COLUMNS]) BW_MUST_CHECK;
bw_status dam_solid_picture(dam_run *d) BW_MUST_CHECK; /* solid.pvd */
double dam_moved(const dam_run *d, const dam_gauge *g, int axis);

/* dam_plan.c: before anything is built, what cannot run is refused, as the run would; sizes, step
 * and memory to the log. A small tank is built for that, the case's own where that is small: time
 * and memory do not grow with the particles. Collective. */
bw_status dam_plan(const dam_run *d, const bw_ulph_config *fluid) BW_MUST_CHECK;

/* dam_output.c. All collective. */
/* `sample`: a fluid of this spacing, sound and weight; bytes: of a rank. */
void dam_describe(const dam_run *d, const bw_ulph_config *fluid, bw_ulph *sample, double water,
                  double walls, double bytes);
bw_status dam_open_history(dam_run *d) BW_MUST_CHECK;
bw_status dam_sample(dam_run *d) BW_MUST_CHECK;  /* a row of it */
bw_status dam_picture(dam_run *d) BW_MUST_CHECK; /* water.pvd, walls.pvd, solid.pvd */
/* NAME-STEP.vtp of points with their data, joined to NAME.pvd. */
bw_status dam_write_points(dam_run *d, const char *name, size_t n, const double x[], int count,
                           const bw_vtk_array array[]) BW_MUST_CHECK;
