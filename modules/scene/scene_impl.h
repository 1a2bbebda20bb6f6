/* scene_impl.h -- the objects of a scene; shared inside `scene` only. */
#pragma once
#include "bw_coupler.h"
#include "bw_coupler_particles.h"
#include "bw_coupler_rigid.h"
#include "bw_pd_state_law.h"
#include "bw_rigid.h"
#include "bw_scene.h"
#include "bw_solid_assembly.h"
#include "bw_solid_crack.h"
#include "bw_solid_load.h"
#include "bw_ulph.h"
#include "scene_check.h"
#include "scene_quantity.h"

/* Bodies on one lattice: a solid. */
typedef struct {
  bw_solid *solid;                     /* NULL where it is only planned */
  bw_solid_sample sample;              /* of a planned scene: what its material is like, */
  double sites;                        /* and about how many particles it has */
  bool contact;                        /* do its pieces meet each other? */
  int n_bodies, body[BW_SCENE_BODIES]; /* numbers in the file */
  int n_groups;
  int body_of[BW_PD_GROUPS];     /* of a material group */
  int material_of[BW_PD_GROUPS]; /* of a material group; -1: that of who it holds */
  size_t n;                      /* particles of this rank */
  double *X0;                    /* (n,3) */
  double *F, *V;                 /* (n,3) external force density, velocity of prescribed ones */
  bool *cut;                     /* (n) cracked at the start; NULL: no crack is followed */
  bool pushed, moved;            /* something acts; something is moved */
  bool steady;                   /* F is what it will be */
} bw_scene__solid;

/* What one load does to the particles of this rank. */
typedef struct {
  int load, solid;
  size_t n;
  int32_t *particle;     /* (n) */
  double push[3];        /* force density of all of it [M/(L^2 T^2)] */
  bw_solid_crack *crack; /* what it fills instead; NULL: it acts on particles */
} bw_scene__acting;

/* Points on the surfaces of bodies that do not deform, in a fluid alone: all on rank 0. */
typedef struct {
  size_t n;
  int *body;             /* (n) number in the file */
  double *X0, *N0;       /* (n,3) place and normal at t = 0 */
  double *area;          /* (n) [L^2] */
  double *X, *N, *V, *M; /* (n,3) place, normal, velocity; memory of markers, traction on walls */
} bw_scene__points;

/* A fluid of particles. */
typedef struct {
  bw_ulph_config config;
  bw_ulph *fluid;             /* of a plan too large to be made: a sample of it */
  bw_coupler_particles *both; /* with the solid; NULL: none, or planned */
  bool sampled;
  double sites, walls; /* particles of it, of its walls */
  double bytes;        /* of a rank, where planned */
  /* Wall pressures of gauges, integrated since the last row, and the time that they cover. */
  double patch[BW_SCENE_GAUGES], covered;
} bw_scene__water;

/* A column of the history. */
typedef struct {
  int gauge;                      /* number in the file */
  const bw_scene__quantity *what; /* NULL: time */
  int component;                  /* of the quantity, as in three dimensions */
} bw_scene__column;

/* Where a gauge looks, on this rank. */
typedef struct {
  int n[BW_SCENE_BODIES]; /* particles in each solid */
  int32_t *particle[BW_SCENE_BODIES];
  double count; /* of all ranks */
} bw_scene__aim;

/* What the energies of the solids came to at the first look, and the largest that they were. */
typedef struct {
  bool known, told;
  double start, most; /* [M L^2/T^2] */
} bw_scene__energies;

/* Updates of a run so far, or of a step, of all ranks (scene_updates.c). */
typedef struct {
  double cells, markers, particles;
} bw_scene__cost;

struct bw_scene {
  bw_scene_config config;
  const bw_comm *comm; /* borrowed */
  bw_log *log;         /* borrowed, may be NULL */
  bool planar;
  bool
      planned; /* it is only looked at: nothing of the fluid is made, solids where they are small */
  bool sketched; /* planned, and its solids are too large to be made */
  bool alive;    /* some body deforms, is prescribed, or is rigid and has particles */

  /* solids */
  int n_solids;
  bw_scene__solid solid[BW_SCENE_BODIES];
  int solid_of[BW_SCENE_BODIES]; /* of each body; -1: it is none */
  bw_solid_assembly *assembly;   /* several solids without fluid; NULL: none */
  int n_acting;
  bw_scene__acting acting[BW_SCENE_LOADS];

  /* rigid bodies, and what does not deform beside them */
  bw_rigid *rigid;                /* NULL: none */
  bw_coupler_rigid *floats;       /* they are in a flow; NULL: they are not */
  int rigid_of[BW_SCENE_BODIES];  /* number in `rigid` of each body; -1: it is none */
  bw_rigid_state *rigid_start;    /* (count) */
  bw_rigid_state *rigid_before;   /* (count) at the beginning of the step */
  double *rigid_load;             /* (6 count) of contact with solids: forces, then torques */
  double rigid_weight;            /* energy of the weights at the start */
  bw_scene__shapes *rigid_shapes; /* (count) theirs, whose masks are borrowed */
  bool too_fast;                  /* has been said */

  /* fluid */
  bw_grid *grid;             /* where planned, one that is only looked at */
  bw_ns_channel_config flow; /* settings of the fluid */
  bw_ns_plan flow_plan;      /* where planned */
  bw_ns_channel *fluid;      /* NULL: none, or planned */
  bw_coupler *coupler;       /* with what deforms; NULL: none */
  bw_ibm_mdf *markers;       /* with what does not, alone; NULL: none */
  bw_scene__points inner;    /* its markers */
  bw_scene__points wall;     /* its probe points; none where nobody asks for forces */
  bool moving;               /* some of them are prescribed */
  bw_probe *probe;
  bw_real *pressure;  /* that acted over the last step */
  double speed;       /* the fastest that the file names [L/T] */
  void *ramped[3][2]; /* of sides whose velocity rises, owned */

  bw_scene__water *water; /* a fluid of particles; NULL: none */

  /* interfaces of solids, for fragments; made when asked for */
  bw_pd_interface *interface[BW_SCENE_BODIES];

  /* time */
  double time, dt, phase_start;
  int64_t steps, phase_steps;
  int phase;
  double settled_energy; /* of the fluid at the last look; NaN: none */
  bool watched;
  bw_scene__cost cost; /* of this run so far */
  int64_t n_markers;   /* on what does not deform, of all ranks; known when it is described */

  /* scene_sound.c: is it still physics? */
  struct {
    double
        ripple; /* energy in the wave of two cells at the last look [L^2/T^2, a sum over cells] */
    bw_scene__energies energies;
    bool close; /* particles in contact came too near, and it was said */
    int doubts; /* warnings so far */
  } sound;

  /* gauges */
  int n_columns;
  bw_scene__column *column;
  const char **names; /* (n_columns) */
  double *row;        /* the last measure */
  bw_scene__aim aim[BW_SCENE_GAUGES];
  int64_t pictures; /* so far */
};

/* scene_create.c: bw_scene_create; `planned`: what --check looks at, in time and memory that do not
 * grow with the cells of the fluid nor, beyond BW_SCENE__MADE, with the particles. */
enum { BW_SCENE__MADE = 200000 };
bw_status bw_scene__create(const bw_comm *comm, const bw_scene_config *config, bw_log *log,
                           bool planned, bw_scene **out) BW_MUST_CHECK;

/* scene_plan.c: sites of one body or of the fluid (BW_SCENE__FLUID) on a lattice; of one too large
 * to be walked through, those of some of its rows. Local. */
bw_status bw_scene__count_body(bw_scene *s, int b, const bw_shape_lattice *lattice,
                               double *n) BW_MUST_CHECK;
/* The sites of a solid, counted or, beyond some ten millions, by a sample. */
bw_status bw_scene__count_sites(bw_scene *s, const bw_scene__solid *q,
                                const bw_solid_config *config, double *n) BW_MUST_CHECK;
/* Lines of memory and pores; refuses steps beyond a limit. Collective. */
bw_status bw_scene__plan_describe(bw_scene *s, bw_log *log) BW_MUST_CHECK;

/* scene_updates.c: what a step of dt [T] costs; of iterated steps one try. Local. */
bw_scene__cost bw_scene__cost_of_step(const bw_scene *s, double dt);
void bw_scene__cost_add(bw_scene *s, double dt);
/* One line of the log. */
void bw_scene__cost_tell(const bw_scene *s, const bw_scene__cost *c, const char *how, bw_log *log);
/* scene_sound.c: after a step; BW_EDIVERGED where it is no physics any more. Collective. */
bw_status bw_scene__look(bw_scene *s) BW_MUST_CHECK;

/* scene_solids.c */
bw_status bw_scene__solids_create(bw_scene *s) BW_MUST_CHECK;
void bw_scene__solids_destroy(bw_scene *s);
/* scene_levels.c: boxes and refine of the bodies of a solid, to its settings. BW_EINPUT. Local. */
bw_status bw_scene__levels_of(const bw_scene *s, const bw_scene__solid *q,
                              bw_solid_config *c) BW_MUST_CHECK;
/* What is kept per particle of a solid, of those that there are now. Collective. */
bw_status bw_scene__solid_arrays(bw_scene *s, bw_scene__solid *q) BW_MUST_CHECK;
/* A solid has other particles now: what is kept of them is made anew, loads and gauges too. */
bw_status bw_scene__solid_renew(bw_scene *s, int solid) BW_MUST_CHECK;
/* Before a step: levels follow what happens. */
bw_status bw_scene__solids_adapt(bw_scene *s) BW_MUST_CHECK;
/* Body of an own particle. */
int bw_scene__body_of(const bw_scene__solid *q, size_t i);
/* Volume of its particle i over that of the coarsest [-]. Local. */
double bw_scene__share(const bw_scene__solid *q, size_t i);
/* scene_law.c: what the law of a solid is asked for; NULL: nothing. BW_EINPUT where its materials
 * ask for what one solid cannot have. Local. */
bw_status bw_scene__law_options(const bw_scene *s, const bw_scene__solid *q,
                                bw_pd_state_mixed_options *room,
                                const void **options) BW_MUST_CHECK;
/* scene_sites.c: the sites of all bodies of a solid. */
typedef struct {
  int64_t n;
  int32_t *site;
  uint8_t *kind, *group;
} bw_scene__sites;
bw_status bw_scene__sites_make(bw_scene *s, bw_scene__solid *q, const bw_solid_config *config,
                               bw_scene__sites *out) BW_MUST_CHECK;
void bw_scene__sites_release(bw_scene__sites *sites);
/* Numbers the material groups as sites_make does, without sites. */
bw_status bw_scene__sites_groups(bw_scene *s, bw_scene__solid *q) BW_MUST_CHECK;
/* Is x (3) in the place, given the extent of the body's particles? */
bool bw_scene__in_where(const bw_scene_where *w, bool planar, double ds, const double lower[3],
                        const double upper[3], const double x[3]);

/* scene_loads.c */
bw_status bw_scene__loads_create(bw_scene *s) BW_MUST_CHECK;
void bw_scene__loads_destroy(bw_scene *s);
bw_status bw_scene__loads_apply(bw_scene *s,
                                double dt) BW_MUST_CHECK; /* for the step from s->time */
/* scene_loads_crack.c: does it act in cracks? Local. */
bool bw_scene__in_cracks(const bw_scene_load *l);
/* a->crack from the cracks that a body has at the start. Collective. */
bw_status bw_scene__fill_cracks(bw_scene *s, bw_scene__acting *a) BW_MUST_CHECK;
/* What loads fill in the bodies of a list of names. Collective. */
bw_status bw_scene__measure_cracks(bw_scene *s, const char *names,
                                   bw_solid_crack_size *out) BW_MUST_CHECK;
bw_status bw_scene__loads_aim(bw_scene *s) BW_MUST_CHECK; /* which particles each acts on, anew */
/* Share of a load at a time [T]. */
double bw_scene__load_share(const bw_scene_load *l, double time);
/* Where a point of a prescribed body is at a time. */
void bw_scene__motion(const bw_scene_body *b, const double X0[3], double time, double X[3]);

/* Velocity V (3) of a point of it that is at X (3) then. */
void bw_scene__velocity(const bw_scene_body *b, const double X[3], double time, double V[3]);

/* scene_rigid.c: bodies of six numbers. */
bw_status bw_scene__rigid_create(bw_scene *s) BW_MUST_CHECK;
void bw_scene__rigid_destroy(bw_scene *s);
/* The status of what refuses "rigid body NUMBER", with the name that the file has. Local. */
bw_status bw_scene__rigid_named(const bw_scene *s, bw_status st) BW_MUST_CHECK;
/* Prescribed ones among them are told how to move in the step from s->time. Local. */
void bw_scene__rigid_tell(bw_scene *s, double dt);
/* A step of solids and rigid bodies without fluid: contact of the solids' particles loads the rigid
 * ones, whose own particles move with them. */
bw_status bw_scene__rigid_step(bw_scene *s, double dt,
                               bw_status (*solids)(bw_scene *s, double dt)) BW_MUST_CHECK;
/* Where the material point of body q, at X0 at the start, is in a state of it. Local. */
void bw_scene__rigid_place(const bw_scene *s, int q, const bw_rigid_state *now, const double X0[3],
                           double X[3]);
double bw_scene__rigid_speed(const bw_scene *s); /* the fastest point now [L/T]. Local. */
bw_status bw_scene__rigid_save(bw_scene *s, bw_checkpoint *ck) BW_MUST_CHECK;
bw_status bw_scene__rigid_restore(bw_scene *s, bw_checkpoint *ck) BW_MUST_CHECK;
/* scene_gauges_rigid.c: a quantity for which bw_scene__of_rigid holds. */
bw_status bw_scene__measure_rigid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS]) BW_MUST_CHECK;

/* scene_create.c: does some gauge ask for this quantity? */
bool bw_scene__asked(const bw_scene *s, const char *quantity);
/* Is the momentum of a box around the bodies balanced? */
bool bw_scene__balances(const bw_scene *s);

/* scene_fluid.c */
bw_status bw_scene__fluid_create(bw_scene *s) BW_MUST_CHECK;
void bw_scene__fluid_destroy(bw_scene *s);

/* scene_surface.c: bodies that do not deform, in a fluid alone */
bw_status bw_scene__surfaces_create(bw_scene *s) BW_MUST_CHECK; /* planned: their points alone */
void bw_scene__surfaces_destroy(bw_scene *s);
bw_status bw_scene__surfaces_step(bw_scene *s, double dt) BW_MUST_CHECK;
bw_status bw_scene__surfaces_restore(bw_scene *s) BW_MUST_CHECK;
/* Force on the bodies of these names: by markers, probes, box. Collective. */
bw_status bw_scene__surface_force(bw_scene *s, const char *names,
                                  double value[BW_SCENE__COMPONENTS]) BW_MUST_CHECK;

/* scene_water.c: a fluid of particles, with the solid of the scene where it has one */
bw_status bw_scene__water_create(bw_scene *s) BW_MUST_CHECK;
void bw_scene__water_destroy(bw_scene *s);
double bw_scene__water_limit(bw_scene *s); /* longest step now [T]. Collective. */
bw_status bw_scene__water_step(bw_scene *s, double dt) BW_MUST_CHECK;
bw_status bw_scene__water_save(bw_scene *s, bw_checkpoint *ck) BW_MUST_CHECK;
bw_status bw_scene__water_restore(bw_scene *s, bw_checkpoint *ck) BW_MUST_CHECK;
/* scene_water_make.c: its walls and particles. A planned one that is large becomes a sample. */
bw_status bw_scene__water_make(bw_scene *s) BW_MUST_CHECK;
/* scene_water_gauges.c: what gauges see of it, forces on the solid among them. Collective. */
bw_status bw_scene__measure_water(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS]) BW_MUST_CHECK;
void bw_scene__water_where(const bw_scene *s, double x[3]); /* place of its walls now. Local. */
void bw_scene__water_gather(bw_scene *s, double dt);        /* wall pressures over a step of dt */
/* scene_water_picture.c: fluid.pvd, walls.pvd. */
bw_status bw_scene__water_picture(bw_scene *s, int solid, const char *path) BW_MUST_CHECK;
bw_status bw_scene__walls_picture(bw_scene *s, int solid, const char *path) BW_MUST_CHECK;

/* scene_coupled.c */
bw_status bw_scene__coupled_create(bw_scene *s) BW_MUST_CHECK;

/* scene_step.c */
bw_status bw_scene__phase_begin(bw_scene *s) BW_MUST_CHECK;
double bw_scene__limit(bw_scene *s); /* longest step now, with its share [T] */
/* Warns where the state at the end slips or leaks, gauge or not. Collective. */
bw_status bw_scene__warn_leak(bw_scene *s) BW_MUST_CHECK;
/* Refuses what no key can tell by itself: steps without end, loads, speeds, damping and viscosity
 * that are out of all proportion. Called when all is made, or planned. Collective. */
bw_status bw_scene__check_sizes(bw_scene *s) BW_MUST_CHECK;
/* Of the fluid at the start, whole [T]; where it is only planned, from what the file says. */
double bw_scene__fluid_limit(bw_scene *s);
/* Largest sum of |u_d|/dx_d of the velocity at the start, as far as a few places know [1/T]. */
double bw_scene__start_rate(bw_scene *s);
double bw_scene__solid_limit(const bw_scene *s); /* of solids and rigid bodies, whole [T] */
double bw_scene__end(const bw_scene *s);         /* of the scene [T]; NaN: not known */

/* scene_gauges.c, scene_gauges_solid.c, scene_gauges_fluid.c */
/* Number of the column of a name of history.csv without its unit; -1: none. */
int bw_scene__column_named(const bw_scene *s, const char *name);
/* list (size) <- the names of the columns of the gauge that NAME or NAME.COMPONENT begins with,
 * with commas; of all gauges where there is no such gauge. Local. */
void bw_scene__column_names(const bw_scene *s, const char *name, size_t size, char list[]);
bw_status bw_scene__gauges_create(bw_scene *s) BW_MUST_CHECK;
bw_status bw_scene__gauges_aim(bw_scene *s) BW_MUST_CHECK; /* which particles each looks at, anew */
void bw_scene__gauges_destroy(bw_scene *s);
bw_status bw_scene__note_cuts(bw_scene *s) BW_MUST_CHECK;
bw_status bw_scene__note_cut(bw_scene *s, int solid) BW_MUST_CHECK; /* of one, anew */
bw_status bw_scene__measure_solid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS]) BW_MUST_CHECK;
bw_status bw_scene__measure_fluid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS]) BW_MUST_CHECK;
/* scene_failure.c: by what the load has to grow until the first particle of a gauge fails, and
 * where that was at the start (3); NULL: not wanted; unchanged where nothing is loaded.
 * Collective. */
bw_status bw_scene__failure(bw_scene *s, const bw_scene_gauge_config *g, const bw_scene__aim *aim,
                            double *load, double place[3]) BW_MUST_CHECK;
/* value (3 or 1) <- velocity or pressure at x (3), all ranks. */
void bw_scene__sample(bw_scene *s, bool pressure, size_t n, const double x[], double value[]);

/* scene_describe.c: warnings of what will be poor. */
void bw_scene__warn(bw_scene *s, bw_log *log);
/* scene_warn_solids.c: of a body that is `layers` particles thick; of what its cracks cost beyond
 * what was measured, and of gauges in which two supports cancel. Local. */
void bw_scene__warn_layers(const bw_scene *s, int b, double layers, bw_log *log);
void bw_scene__warn_solids(const bw_scene *s, bw_log *log);
/* scene_promise.c: the error that this accuracy was measured to have on scenes of this kind.
 * Local. */
void bw_scene__promise(const bw_scene *s, FILE *out);
/* scene_gaps.c: refuses bodies that block the stream, warns of gaps that cells do not see.
 * Collective. */
bw_status bw_scene__look_at_gaps(bw_scene *s, bw_log *log) BW_MUST_CHECK;
/* Once, when a rigid body is too fast for the grid. Local. */
void bw_scene__warn_speed(bw_scene *s);
/* scene_picture.c: the name of the series of a solid; -1: of the surfaces of rigid bodies. */
void bw_scene__series_name(const bw_scene *s, int solid, char name[2 * BW_SCENE_NAME]);
/* scene_paraview.c: open.pvsm, which shows all series. Collective. */
bw_status bw_scene__paraview(bw_scene *s, const bw_case *run) BW_MUST_CHECK;
/* scene_profiles.c: the files of the lines and slices that are due. */
bw_status bw_scene__profiles(bw_scene *s, const bw_case *run, int gauge) BW_MUST_CHECK;
/* scene_watch.c: what the rows of history.csv say of the gauges that are watched, to the log and
 * watch.csv. */
bw_status bw_scene__watch_report(bw_scene *s, const bw_case *run, bw_log *log) BW_MUST_CHECK;
