/* bw_scene_config.h -- what a scene file says, as a plain struct (tables in scene_fields*.c).
 *
 * Any consistent set of units: [M], [L], [T]. Numbers that were not given are NaN (words INT_MIN,
 * texts ""); bw_scene_resolve fills what `accuracy` decides. Names join the parts: a body names its
 * material, a gauge its body. */
#pragma once
#include "bw_scene_parts.h"

BW_BEGIN_DECLS

/* How careful a run is with what the file leaves open. */
typedef enum {
  BW_SCENE_QUICK,    /* a first look */
  BW_SCENE_STANDARD, /* the default */
  BW_SCENE_CAREFUL   /* for numbers that are handed on */
} bw_scene_accuracy;

/* Which layer the solids of a scene in two dimensions are. */
typedef enum {
  BW_SCENE_SPACE,  /* three dimensions */
  BW_SCENE_STRESS, /* one layer, free to contract across */
  BW_SCENE_STRAIN  /* one layer, held across */
} bw_scene_plane;

/* How a body moves. */
typedef enum {
  BW_SCENE_FIXED,      /* not at all */
  BW_SCENE_PRESCRIBED, /* as its velocity, turn and swing say */
  BW_SCENE_RIGID,      /* as one piece, by its mass and what acts on it */
  BW_SCENE_ELASTIC,    /* it deforms and does not break */
  BW_SCENE_BREAKABLE   /* it deforms and breaks */
} bw_scene_motion;

/* A material. Keys of laws that this build does not have are read, and refused. */
typedef struct {
  char name[BW_SCENE_NAME];    /* how others call it */
  char law[BW_SCENE_NAME];     /* a row of bw_solid_laws */
  char elastic[BW_SCENE_NAME]; /* of a state-based law */
  char plastic[BW_SCENE_NAME]; /* of a state-based law */
  double density;              /* [M/L^3] */
  double young_modulus;        /* [M/(L T^2)] */
  double poisson_ratio;        /* [-]; NaN: the law's own */
  double fracture_energy;      /* [M/T^2]; NaN: it does not break */
  double cohesion, friction_angle, dilation_angle, yield_stress, hardening; /* of plastic laws */
  int influence;        /* bw_pd_state_influence, of law ordinary; INT_MIN: its default */
  int weight;           /* bw_pd_state_weight, of law correspondence, as all below */
  int breaks;           /* bw_pd_state_breaks: what breaks a bond */
  int cone;             /* bw_pd_material_cone; INT_MIN: by the plane and the dilation */
  double stabilisation; /* against modes without energy, over mu; NaN: its default */
  double limit;         /* what a pair bears, by `breaks` */
} bw_scene_material;

/* Where a body is held: particles in a box, those that stand in another body, or a side. */
typedef struct {
  char by[BW_SCENE_NAME];   /* a body; its sites become held particles of this one */
  char side[BW_SCENE_NAME]; /* x_lower ... z_upper of the body's own extent */
  int layers;               /* of that side */
  bool has_box;             /* is it given? */
  bw_scene_box box;         /* particles in it */
} bw_scene_held;
typedef struct {
  double from[3], to[3]; /* the segment, in 3D two corners of the cut [L] */
  double along[3];       /* 3D: the other edge of the parallelogram, from `from` [L] */
} bw_scene_crack;
/* Where a body's particles are finer (bw_pd_body.h); belts of the levels between are added. */
typedef struct {
  int level;      /* 1: half the spacing, 2: a quarter, ... */
  double from[3]; /* lower corner of a box along x, y, z [L] */
  double to[3];   /* upper corner [L] */
} bw_scene_level;
/* Where levels follow what happens (bw_solid.h). */
typedef struct {
  int level;             /* of the finest particles */
  int trigger;           /* bw_pd_levels_trigger */
  double at, coarsen_at; /* shares of what breaks [-] */
  double buffer, ahead;  /* of fine cells, in horizons of the coarsest [-] */
} bw_scene_refine;
/* A body that turns. */
typedef struct {
  double rate;      /* [1/T], right-handed about the axis */
  double axis[3];   /* [-] */
  double centre[3]; /* a point of it [L] */
} bw_scene_rotation;
/* A body that swings to and fro. */
typedef struct {
  double amplitude[3]; /* X = X0 + amplitude sin(2 pi frequency t) [L] */
  double frequency;    /* [1/T] */
} bw_scene_swing;
/* A rigid body: what its shapes and its material leave open. */
typedef struct {
  double mass;               /* [M]; NaN: of its shapes, filled with its material */
  double centre[3];          /* of mass [L]; NaN: of its shapes, filled evenly */
  double inertia[3];         /* about it, along x, y, z [M L^2]; NaN: of its shapes */
  double stiffness[3];       /* of springs to where it starts [M/T^2] */
  double damping[3];         /* beside them [M/T] */
  double turn_stiffness;     /* of a spring against its turn [M L^2/T^2] */
  double turn_damping;       /* beside it [M L^2/T] */
  char held[BW_SCENE_NAMES]; /* directions it cannot move or turn in: x, y, z, turn_x, ... turn */
} bw_scene_rigid;
typedef struct {
  char name[BW_SCENE_NAME];             /* how others call it */
  int n_shape;                          /* how many of shape */
  bw_scene_shape shape[BW_SCENE_PARTS]; /* in order: added, or taken away */
  char material[BW_SCENE_NAME];         /* name of a material */
  int motion;                           /* bw_scene_motion */
  double spacing;                       /* [L]; NaN: the fluid's */
  double turn;                          /* of the lattice about z [deg] */
  double velocity[3];                /* of a prescribed body always, of others at the start [L/T] */
  bool has_rotation;                 /* is it given? */
  bw_scene_rotation rotation;        /* of a prescribed body */
  bool has_swing;                    /* is it given? */
  bw_scene_swing swing;              /* of a prescribed body */
  bool has_rigid;                    /* is it given? */
  bw_scene_rigid rigid;              /* of a rigid body */
  int n_held;                        /* how many of held */
  bw_scene_held held[BW_SCENE_HELD]; /* where it is held */
  int n_cracks;                      /* how many of cracks */
  bw_scene_crack cracks[BW_SCENE_CRACKS]; /* there from the start */
  int n_levels;                           /* how many of levels */
  bw_scene_level levels[BW_SCENE_LEVELS]; /* where it is finer */
  bool has_refine;                        /* is it given? */
  bw_scene_refine refine;                 /* and where it becomes so */
  int self_contact; /* does what breaks off collide with the rest? INT_MIN: if it breaks */
} bw_scene_body;

/* Loads. */
typedef enum {
  BW_SCENE_TRACTION, /* value: force per area of the side [M/(L T^2)] */
  BW_SCENE_PRESSURE, /* value[0]: against the side [M/(L T^2)] */
  BW_SCENE_FORCE,    /* value: the sum over the place [M L/T^2] */
  BW_SCENE_GRAVITY,  /* value: acceleration [L/T^2] */
  BW_SCENE_VELOCITY  /* value: of particles that are held to it [L/T] */
} bw_scene_load_kind;
typedef struct {
  char side[BW_SCENE_NAME]; /* x_lower ... z_upper of the body's extent, or `crack` */
  int layers;               /* of that side */
  bool has_box;             /* is it given? */
  bw_scene_box box;         /* particles in it */
} bw_scene_where;
typedef struct {
  char on[BW_SCENE_NAME]; /* a body */
  int kind;               /* bw_scene_load_kind */
  bool has_where;         /* is it given? */
  bw_scene_where where;   /* left out: all of the body */
  double value[3];        /* by kind, see above */
  double ramp;            /* until all of it acts [T] */
  double start;           /* when it begins [T] */
  bool smooth;            /* the ramp has no corners */
  bool unbreakable;       /* bonds of the particles it acts on do not break */
} bw_scene_load;

/* Who may touch whom. */
typedef struct {
  char between[BW_SCENE_NAMES]; /* all, none */
  double friction;              /* [-] */
} bw_scene_contact;

/* Phases. */
typedef struct {
  double time;    /* of the run [T]; NaN: not given */
  int steps;      /* of the phase; INT_MIN: not given */
  double settled; /* kinetic over elastic energy, or change of the flow; NaN: not given */
} bw_scene_until;
typedef struct {
  char name[BW_SCENE_NAME];  /* how others call it */
  bool has_until;            /* is it given? */
  bw_scene_until until;      /* when it ends */
  char hold[BW_SCENE_NAMES]; /* bodies that stand still */
  double damp;               /* against rest [M/(L^3 T)] */
  double step;               /* fixed time step in it [T]; NaN: that of numerics */
  int breaking;              /* may bonds break? 0, 1; INT_MIN: as the bodies say */
} bw_scene_phase;

/* Gauges. */
typedef struct {
  double from[3], to[3]; /* [L] */
  int points;            /* places, ends included */
} bw_scene_line;
typedef struct {
  int axis;  /* 0, 1, 2 */
  double at; /* [L] */
} bw_scene_slice;
/* What a body bears before it fails (bw_solid_failure.h); NaN: not given. */
typedef struct {
  int by;                /* bw_solid_failure_gauge */
  double tension, yield; /* [M/(L T^2)] */
  double cohesion;       /* [M/(L T^2)] */
  double friction_angle; /* [deg] */
  double flaw;           /* [L] */
} bw_scene_strength;
typedef struct {
  char name[BW_SCENE_NAME];   /* how others call it */
  char of[BW_SCENE_NAMES];    /* quantities: see bw_scene_quantity */
  char body[BW_SCENE_NAMES];  /* bodies */
  double nearest[3];          /* the particle of the body that is nearest to this place [L] */
  bool has_region;            /* is it given? */
  bw_scene_box region;        /* mean over the particles in it */
  bool has_strength;          /* is it given? */
  bw_scene_strength strength; /* what the body bears, of failure */
  double point[3];            /* a place in the fluid [L] */
  double minus[3];            /* another one, whose value is taken away [L] */
  bool has_line;              /* is it given? */
  bw_scene_line line;         /* places in a row */
  bool has_slice;             /* is it given? */
  bw_scene_slice slice;       /* a plane */
  double width;               /* half of that of a column of depth [L]; NaN: two spacings */
  double origin[3];           /* where a crack begins [L] */
  double every;               /* time between files of lines and slices [T] */
} bw_scene_gauge_config;

/* What is printed of a gauge at the end, and limits that stop a run. */
typedef struct {
  char name[BW_SCENE_NAME];  /* GAUGE or GAUGE.COMPONENT */
  int mean;                  /* 0: none, 1: midrange, 2: time */
  bool amplitude, frequency; /* are they asked for? */
  int last_periods;          /* that go in */
  double from;               /* time from which is looked at [T] */
  double above, below;       /* the run stops beyond; NaN: no limit */
} bw_scene_watch;

/* What a run leaves. */
typedef struct {
  double sample_every;                  /* [T] */
  double picture_every;                 /* [T]; 0: at the end only */
  char checkpoint_every[BW_SCENE_NAME]; /* "600 s" of wall clock, or a time of the run */
  bool figures;                         /* draw history.csv at the end? */
} bw_scene_output;

/* Every knob by name; NaN or INT_MIN: `accuracy` decides. */
typedef struct {
  double step;          /* of the run, fixed [T]; NaN: step_share of the limit */
  double step_share;    /* of the largest stable step of the fluid or, alone, of the solids */
  double solid_share;   /* solid sub-step over its limit, in a flow */
  int integrator;       /* bw_solid_integrator */
  double horizon_ratio; /* m */
  int surface_correction, volume_fraction, family_reach; /* of bw_solid.h */
  int calibration;                                       /* of the bond law, bw_pd_calibration */
  double damping_mean;      /* against the mean motion of a family [M/(L^3 T)] */
  double damping_pair;      /* between the ends of bonds [M/(L^6 T)] */
  double damping_absolute;  /* against rest [M/(L^3 T)] */
  double disorder;          /* of a cloud of particles, share of the spacing [-]; 0: a lattice */
  int disorder_seed;        /* of the random numbers for it */
  int viscous;              /* bw_ns_viscous */
  int load;                 /* bw_coupler_load_kind */
  int kernel;               /* of the forcing, bw_kernel_delta_id */
  int probe_profile;        /* bw_probe_profile */
  int forcing_iterations;   /* of the immersed boundary */
  double memory;            /* of the forcing, beta [-] */
  double retraction;        /* of markers, over the grid spacing [-] */
  double marker_spacing;    /* over the grid spacing [-] */
  double probe_length;      /* over the grid spacing [-] */
  double load_relaxation;   /* of the load, w [-]; NaN: chosen (bw_coupler.h) */
  bool predictor;           /* does the fluid know how the solids would move, bw_coupler.h? */
  double virtual_mass;      /* of bodies in a flow, see bw_coupler.h and bw_coupler_rigid.h [-] */
  double contact_stiffness; /* of rigid bodies, see bw_rigid.h [M/(L^2 T^2)]; NaN: by the energy
                               that gravity and velocities bring */
  double sound_speed;       /* of a fluid of particles [L/T]; NaN: 10 times the fastest */
  double artificial_viscosity; /* of it, alpha [-] */
  double wall_viscosity;       /* the same beside walls [-] */
  double density_diffusion;    /* of it, delta [-] */
  double shifting;             /* of it, against clustering [-] */
  double coupling_residual;    /* at which the iterations of a step end [-] */
  int coupling_iterations;     /* of a step, at most; 0: none */
  unsigned set; /* bits of the knobs that `accuracy` has set, by rows of its table; no key */
} bw_scene_numerics;

/* A scene. */
typedef struct {
  char name[BW_SCENE_NAMES]; /* how others call it */
  int accuracy;              /* bw_scene_accuracy */
  int plane;                 /* bw_scene_plane; INT_MIN: strain with one cell in z, else space */
  double thickness;          /* of the layer in two dimensions [L]; NaN: of the domain, else 1 */
  bool has_domain;           /* is there a box of the fluid? */
  bw_scene_domain domain;    /* that box */
  bool has_fluid;            /* is there a fluid? */
  bw_scene_fluid fluid;      /* it */
  int n_materials;           /* how many of materials */
  bw_scene_material materials[BW_SCENE_MATERIALS]; /* of the bodies */
  int n_bodies;                                    /* how many of bodies */
  bw_scene_body bodies[BW_SCENE_BODIES];           /* solids */
  int n_loads;                                     /* how many of loads */
  bw_scene_load loads[BW_SCENE_LOADS];             /* on bodies */
  double gravity[3];                               /* [L/T^2] */
  bool has_contact;                                /* is it given? */
  bw_scene_contact contact;                        /* between bodies */
  int n_phases;                                    /* how many of phases */
  bw_scene_phase phases[BW_SCENE_PHASES];          /* in order */
  int n_gauges;                                    /* how many of gauges */
  bw_scene_gauge_config gauges[BW_SCENE_GAUGES];   /* what is measured */
  int n_watch;                                     /* how many of watch */
  bw_scene_watch watch[BW_SCENE_WATCHED];          /* what is said of gauges at the end */
  bw_scene_output output;                          /* what is written */
  bw_scene_numerics numerics;                      /* knobs */
} bw_scene_config;

/* The keys of a scene file, for bw_config_load and bw_case_main. */
extern const bw_config_field bw_scene_fields[];

/* *c <- what a scene is before its file is read. Local. */
void bw_scene_config_default(bw_scene_config *c);

/* Fills what `accuracy` decides and resolves what follows from the rest. Twice is once. Local. */
void bw_scene_resolve(bw_scene_config *c);

/* The knobs that `accuracy` has set, one a line: "  numerics.KEY = VALUE". After resolve. Local. */
void bw_scene_knobs(const bw_scene_config *c, FILE *out);

/* Refuses what a run would refuse at its start, without a field or a particle: names that lead
 * nowhere, what this build does not have, overlapping bodies, loads that hit nothing, cracks
 * outside. BW_EINPUT names key, value and remedy. Local. */
bw_status bw_scene_check(const bw_scene_config *c) BW_MUST_CHECK;

/* The keys as a JSON schema (draft 2020-12). Local. */
void bw_scene_schema(FILE *out);

BW_END_DECLS
