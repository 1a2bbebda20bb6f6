/* specimen.h -- a notched plate under load: set-up, step, and where its crack is.
 *
 * Plate 0 .. length, 0 .. height (3D: 0 .. thickness), with notches and round holes through the
 * thickness, on a lattice that may be turned about its middle. Loads act on the outermost rows of
 * an edge. One crack is followed: the cracked particles (bw_pd_crack.h) inside a window that
 * were not so from the start and are joined to the tip of the notch. Used by this case and by
 * validation/pd_bond. */
#pragma once
#include "bw_config.h"
#include "bw_log.h"
#include "bw_pd_crack.h"
#include "bw_solid.h"

enum { SPECIMEN_NOTCHES = 4, SPECIMEN_HOLES = 4, SPECIMEN_LOADS = 4 }; /* at most, in a file */

/* The plate and its lattice. */
typedef struct {
  double length, height, thickness; /* [m]; thickness in 2D: of the one layer */
  int particles;                    /* along the length; spacing length/particles */
  double lattice_angle;             /* [deg] the lattice is turned by, about the plate's middle */
} specimen_shape;
/* A straight cut through the thickness. */
typedef struct {
  double from[2], to[2]; /* its ends in x and y [m] */
} specimen_notch;
/* A round hole through the thickness. */
typedef struct {
  double centre[2], radius; /* [m] */
} specimen_hole;
/* The material and how it is discretised. */
typedef struct {
  int geometry;                          /* bw_pd_geometry       default plane stress */
  double young_modulus, density;         /* [Pa], [kg/m3] */
  double fracture_energy, horizon_ratio; /* G0 [J/m2]; horizon over spacing [-], default 3 */
  bw_solid_law_choice choice;            /* law and its options  default bonds */
  int surface_correction, volume_fraction, family_reach, integrator; /* enums of bw_solid.h */
  double disorder;   /* of the particles off their sites, in spacings   default 0: a lattice */
  int disorder_seed; /* another one gives another cloud                 default 0 */
  bool contact;      /* repulsion between particles that no bond joins        default false */
} specimen_solid;

typedef enum { SPECIMEN_LEFT, SPECIMEN_RIGHT, SPECIMEN_BOTTOM, SPECIMEN_TOP } specimen_edge;
typedef enum {
  SPECIMEN_TRACTION, /* value [Pa], as a body force on the particles of the rows, equal for each */
  SPECIMEN_VELOCITY, /* value [m/s], held (0: clamped) */
  SPECIMEN_START     /* value [m/s], at t = 0 only */
} specimen_kind;
/* What acts on an edge. */
typedef struct {
  int edge, kind, rows; /* specimen_edge, specimen_kind; rows of particles that take it */
  double value[2];      /* in x and y; its unit by kind */
  double from, to;      /* part of the edge [m]                     default all of it */
  double rise;          /* time in which a traction rises to value [s]      default 0 */
  bool unbreakable;     /*                                                 default false */
} specimen_load;

/* The crack that is followed. */
typedef struct {
  double from[2];  /* the notch's tip [m] */
  double lower[2]; /* window the crack is looked for in [m]    default the plate */
  double upper[2];
  double fit_from, fit_to; /* distances from the notch's tip that the angle is fitted to [m] */
  double
      speed_window; /* [s]           default 2e-6 (ADAPT 6.1) for 0.1 m of plate, in proportion */
  double
      angle_over; /* of a crack that its angle at a fork is taken over [m]    default length/20 */
  int every;      /* steps between looks                      default 1 */
} specimen_follow;
/* How long. */
typedef struct {
  double step, end; /* time step; end of the run [s] */
  double after;     /* stop this long after the crack reached an end [s]    default: never */
} specimen_time;
/* What the material bears, for gauges of failure: NaN: that one is not asked for. */
typedef struct {
  double tension, yield, cohesion; /* strengths [Pa] */
  double friction_angle;           /* with cohesion [degrees] */
  double flaw;                     /* crack whose release is found, with the fracture energy [m] */
} specimen_strength;
/* Files. */
typedef struct {
  int sample_every, picture_every; /* steps between rows, between pictures   default 10, 200 */
} specimen_files;

/* What the YAML file says. */
typedef struct {
  specimen_shape shape;
  int n_notches, n_holes, n_loads;
  specimen_notch notches[SPECIMEN_NOTCHES];
  specimen_hole holes[SPECIMEN_HOLES];
  specimen_solid solid;
  specimen_load loads[SPECIMEN_LOADS];
  specimen_follow follow;
  specimen_time time;
  specimen_files output;
  specimen_strength strength;
} specimen_config;

extern const bw_config_field specimen_fields[]; /* its keys (specimen_input.c) */
specimen_config specimen_default(void);         /* limits not given: NaN, meaning none */

/* What is known of the crack so far; NAN: not yet. */
typedef struct {
  double tip[2];   /* its particle farthest from the notch's tip [m] */
  double reach;    /* that distance [m] */
  double t_first;  /* first bond broke, anywhere [s] */
  double t_start;  /* the crack has left the notch by more than ds [s] */
  double t_branch; /* it was first seen forked [s] */
  double t_end;    /* its tip came within 1.5 ds of an edge or hole [s] */
  double speed;    /* of reach over the last speed_window, ADAPT 6.1 [m/s] */
} specimen_crack;

/* A plate under load. */
typedef struct {
  const bw_comm *comm; /* borrowed */
  specimen_config config;
  bw_solid *solid;
  double ds, time;              /* spacing [m]; time [s] */
  int64_t steps, events;        /* steps done; broken bonds of this rank at the last look */
  size_t n;                     /* particles of this rank */
  double *X0, *damage, *F;      /* (n,3), (n), (n,3) of the tractions */
  uint8_t *loads;               /* (n) bit q: its site is in the rows of load q */
  bool *notched;                /* (n) cracked by the notches: no part of the crack */
  double share[SPECIMEN_LOADS]; /* body force per stress of each load [1/m] */
  bool rising;                  /* some traction still rises */
  specimen_crack crack;
  bw_pd_crack_track track; /* of reach, at the looks */
} specimen;

/* ---- before anything is built (specimen_plan.c) ---- */
/* What cannot run is refused: values that contradict each other, notches, holes and loads that
 * touch nothing. `p` gets the configuration alone. Local; no memory. */
bw_status specimen_begin(const bw_comm *comm, const specimen_config *config,
                         specimen *p) BW_MUST_CHECK;
/* The same, with sizes, limits and the memory of a rank to the log; a step that the material does
 * not bear is refused. Time and memory do not grow with the plate. Collective. */
bw_status specimen_plan(const bw_comm *comm, const specimen_config *config,
                        bw_log *log) BW_MUST_CHECK;
/* The lattice's material; where site i, j lies in the plane; is a place in the plate, but for the
 * first n_holes holes; does a load act on a site there? Local. */
bw_solid_config specimen_material(const specimen *p);
void specimen_place(const bw_solid_config *c, int i, int j, double x[2]);
bool specimen_inside(const specimen *p, int n_holes, const double x[3]);
bool specimen_loaded(const specimen *p, const specimen_load *load, const double x[3]);

/* `p` is filled; free it with specimen_destroy, also after a failure. Collective. */
bw_status specimen_create(const bw_comm *comm, const specimen_config *config,
                          specimen *p) BW_MUST_CHECK;
/* One step, with loads that rise and a look at the crack where one is due. Collective. */
bw_status specimen_step(specimen *p) BW_MUST_CHECK;
bool specimen_done(const specimen *p); /* time.end, or time.after. Local. */
void specimen_destroy(specimen *p);    /* half-built ones, too. Collective. */

/* The followed crack as it is now (bw_pd_crack_release). Collective. */
bw_status specimen_find(specimen *p, bw_pd_crack *crack) BW_MUST_CHECK;

/* Follow the crack; specimen_step does, every follow.every steps. Collective. */
bw_status specimen_look(specimen *p) BW_MUST_CHECK;

/* Of a crack along x that forks. */
typedef struct {
  double x;                       /* where it forks [m]; NAN: nowhere */
  int branches;                   /* half way between there (or the notch) and the tip */
  double middle[2];               /* y of the two lowest there [m] */
  double angle_first, angle_last; /* between the outermost branches, over 5 mm behind the fork and
                                     before the tip [rad] */
} specimen_fork;
bw_status specimen_branches(specimen *p, specimen_fork *out) BW_MUST_CHECK; /* Collective. */

/* Highest speed at which reach grows until t_end, over times `window` [m/s]. (Of reach, not of the
 * tip: with two branches the farthest particle is now on one, now on the other.) Local. */
double specimen_speed(const specimen *p, double window);

/* Its line over fit_from .. fit_to, angle to x [rad]. Collective. */
bw_status specimen_fit(specimen *p, bw_pd_crack_line *line) BW_MUST_CHECK;
