/* porous_case.h -- a porous medium that breaks in a channel flow: what its sources share. */
#pragma once
#include "bw_case.h"
#include "bw_coupler.h"
#include "bw_history.h"
#include "bw_shape.h"
#include "bw_solid_stress.h"

/* ---- what the YAML file says (tables in porous_config.c) ---- */
typedef struct {
  double length[3]; /* box: stream, wall-normal, span [m] */
  int cells[3];     /* cubes */
} porous_domain;
typedef struct {
  double density, viscosity; /* [kg/m3], kinematic [m2/s] */
  double bulk_velocity;      /* mean of the Poiseuille inflow [m/s] */
} porous_fluid;
typedef struct {
  double density, young_modulus;         /* [kg/m3], [Pa] */
  double fracture_energy, horizon_ratio; /* G0 [J/m2]; horizon over spacing [-], default 3 */
  double damping_pair;                   /* k_d of POROUS 3.41 [N s/m7]     default 0 */
  int surface_correction, integrator;    /* enums of the solid     default volume, verlet */
  bool contact;                          /* between fragments and with walls  default true */
} porous_solid;
/* Pores: balls at random places that overlap freely. */
typedef struct {
  double radius[2], porosity; /* smallest and largest [m]; to expect [-] */
  int seed;                   /*                                          default 1 */
} porous_random;
/* A medium from voxels. */
typedef struct {
  char file[1024];   /* NRRD, MetaImage, TIFF, npy; a folder or pattern of TIFF; raw with `size` */
  double solid[2];   /* smallest and largest value of a solid voxel */
  double voxel;      /* its edge [m]; NaN: not given */
  double spacing[3]; /* its three edges [m]; NaN: not given */
  int unit;          /* of the file's own spacings, a row of porous_units; INT_MIN: as it says */
  int size[3], type, byte_order, skip; /* of a raw file; size INT_MIN: it is none */
  int from[3], to[3]; /* voxels that count, first and behind the last; INT_MIN: all */
  bool flip[3];       /* the last voxel along x, y, z comes first */
  int coarsen[3];     /* voxels along x, y, z that make one                 default 1, 1, 1 */
} porous_image;
/* A medium from a closed surface. */
typedef struct {
  char file[1024]; /* STL */
  double scale;    /* a unit of length of the file [m]                     default 1 */
} porous_surface;
/* Walls that may hold the medium. */
enum { CLAMP_FLOOR = 1, CLAMP_CEILING = 2, CLAMP_BOTH = CLAMP_FLOOR | CLAMP_CEILING };
/* The medium: a box with pores on a lattice, or one of random, image and surface. */
typedef struct {
  int lattice;                             /* bw_shape_kind of the pores     default pores_sc */
  double front, length;                    /* inflow to front; along the stream [m] */
  double pitch, radius_over_pitch;         /* of the pores [m], [-]; NaN: not given */
  double offset[3];                        /* of the lattice, in pitches     default 0.5 */
  bool has_random, has_image, has_surface; /* which of the following is given */
  porous_random random;
  porous_image image;
  porous_surface surface;
  int clamped;        /* porous_clamp bits: which walls hold it           default floor */
  int clamped_layers; /* particles behind each of them that hold it       default 3 */
} porous_medium;
/* One of the three phases. */
typedef struct {
  double time_step;     /* of the fluid [s]; the solid sub-cycles */
  double settled;       /* ends when the drop changes by less per h/U_b [-]; 0: never */
  double settling_rate; /* absolute damping over the density [1/s]        default 0 */
  int steps;            /* at most */
} porous_phase;
/* Steps between rows and files; 0: at the ends of phases. */
typedef struct {
  int sample_every, picture_every, checkpoint_every; /* defaults 10, 0, 0 */
  int keep_every; /* between good states kept in memory               default 50 */
} porous_output;

/* The medium is held; it is elastic; bonds break. */
enum { PHASE_FLOW, PHASE_SOLID, PHASE_BREAKAGE, PHASE_COUNT };
typedef struct {
  porous_domain domain;
  porous_fluid fluid;
  porous_solid solid;
  porous_medium medium;
  bw_coupler_config coupling;
  porous_phase flow, deformation, breakage;
  porous_output output;
} porous_config;

extern const bw_config_field porous_fields[]; /* its keys */
porous_config porous_config_default(void);    /* required values NaN or INT_MIN */
/* The phase by its number, borrowed. */
const porous_phase *porous_phase_of(const porous_config *q, int phase);
extern const char *const porous_phase_name[PHASE_COUNT];

/* ---- the medium (porous_medium.c) ---- */
/* This rank's part of its particles on sites of the grid's cells, with the slab that holds it:
 * site (n,3), kind (n), the caller's (bw_release). Refused when nothing is left of it or nothing
 * flows through. With --check the log of `run` gets what it is
 * like; NULL: of no case. Collective. */
bw_status porous_medium_sites(const bw_comm *comm, const porous_config *q, bw_case *run, int64_t *n,
                              int32_t **site, uint8_t **kind) BW_MUST_CHECK;

/* Which walls hold the medium, as bits; 0: none. Local. */
int porous_clamps(const porous_medium *m);
/* How many particles of it are in the channel: counted up to some million cells, else told from
 * some of its rows. The same refusals, but that nothing flows through is only seen where they are
 * counted. Nothing is kept. Collective. */
bw_status porous_medium_try(const bw_comm *comm, const porous_config *q, bw_case *run,
                            double *particles, bool *exact) BW_MUST_CHECK;

/* ---- the objects of a run (porous_build.c) ---- */
enum { N_PROGRESS = 6 }; /* numbers of a checkpoint: phase, steps, settling check, rows */
typedef struct {
  const porous_config *config;
  bw_case *run;
  const bw_comm *comm;
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  bw_history *history;
  int phase;                        /* PHASE_... */
  int64_t step;                     /* steps done in this phase */
  int64_t total_step;               /* since the start of the flow */
  double last_drop, last_drop_time; /* pressure drop at the previous settling check */
  double kept_progress[N_PROGRESS]; /* what a checkpoint says of the run, of the last good state */
  double broken, imbalance;         /* bonds; markers, most on a rank over the mean; last sample */
  bool warned;                      /* that pieces hit each other too hard */
  bool stopped;                     /* asked for an end in good order ... */
  bool phase_done;                  /* ... when the phase was over, or on the way */
  double length;                    /* of the medium as built [m] */
  int64_t rows;                     /* of history.csv, when the checkpoint was written */
} porous_run;

/* Fluid, solid and coupler from p->config, the stream uniform. Destroy also after a failure.
 * Collective. */
bw_status porous_build(porous_run *p) BW_MUST_CHECK;
/* What p->phase allows the solid to do; the same again changes nothing. Local. */
void porous_enter_phase(porous_run *p);
void porous_destroy(porous_run *p);
bw_grid_config porous_grid(const porous_config *q);           /* that of the fluid. Local. */
bw_ns_channel_config porous_fluid_of(const porous_config *q); /* its settings. Local. */

/* ---- before anything is built (porous_plan.c) ---- */
/* Values that contradict each other are refused. Local. */
bw_status porous_check(const porous_config *q) BW_MUST_CHECK;
/* What cannot run is refused, as the run would; sizes, dimensionless groups, steps against their
 * limits, memory and time to the log. From a small run of the same kind: time and memory do not
 * grow with the channel. Collective. */
bw_status porous_plan(porous_run *p) BW_MUST_CHECK;
/* What was built, to the log. Collective. */
bw_status porous_describe(porous_run *p) BW_MUST_CHECK;

/* ---- what is measured (porous_measure.c) ---- */
enum {
  COL_TIME,
  COL_PHASE,
  COL_DROP,
  COL_POROSITY,
  COL_PERMEABILITY,
  COL_BROKEN,
  COL_BROKEN_FRACTION,
  COL_DAMAGE_MEAN,
  COL_DAMAGE_MAX,
  COL_FRAGMENTS,
  COL_DETACHED,
  COL_LARGEST,
  COL_FRAGMENT_SPEED,
  COL_KINETIC,
  COL_ELASTIC,
  COL_DAMPING,
  COL_FRACTURE,
  COL_EXTERNAL,
  COL_REACTION,
  COL_PROBE = COL_REACTION + 3,
  COL_BOX = COL_PROBE + 3,
  COL_SLIP = COL_BOX + 3,
  COL_BLOCKED,
  COL_DISPLACEMENT,
  COL_GIVEN,
  COL_LATE,
  COL_INSIDE,
  COL_OUT,
  COL_LEFT,
  COL_WALLS,
  COL_LEAK = COL_WALLS + 3,
  COL_TORTUOSITY,
  COL_COUNT
};
extern const char *const porous_columns[COL_COUNT]; /* names with units */
/* A row of history.csv of the last step. Collective. */
bw_status porous_measure(porous_run *p, double row[COL_COUNT]) BW_MUST_CHECK;
double porous_pressure_drop(porous_run *p); /* over rho U_b^2 [-]. Collective. */

/* Has the pressure drop stopped changing? Asked every step, looks every tenth of h/U_b. Local. */
bool porous_settled(porous_run *p, double drop);
/* Will there be a sample after the step to come? Local. */
bool porous_sample_due(const porous_run *p);

/* ---- stress and strain of the medium (porous_stress.c) ---- */
typedef struct {
  double *stress, *strain; /* (n,3) principal values, largest first; Cauchy [Pa], Green [-] */
  double *von_mises;       /* (n) [Pa] */
} porous_tensors;
bw_status porous_tensors_make(porous_run *p, porous_tensors *t) BW_MUST_CHECK; /* Collective. */
void porous_tensors_release(porous_tensors *t);
/* stress-PHASE.csv: probability densities over the particles that are not clamped, of the largest
 * principal stress and von Mises' over E s0, and the largest principal strain over s0. Collective.
 */
bw_status porous_stress_csv(porous_run *p) BW_MUST_CHECK;

/* ---- files (porous_output.c) ---- */
/* Creates history.csv, or goes on with it from the checkpoint that was read. All collective. */
bw_status porous_open_history(porous_run *p) BW_MUST_CHECK;
bw_status porous_sample(porous_run *p) BW_MUST_CHECK;  /* measures, and writes a row */
bw_status porous_picture(porous_run *p) BW_MUST_CHECK; /* adds to fluid.pvd and solid.pvd */
/* Writes `name` in the folder of the run; `kept`: the last good state, not the present one. */
bw_status porous_checkpoint(porous_run *p, const char *name, bool kept) BW_MUST_CHECK;
/* Remember the present state as good. */
bw_status porous_keep(porous_run *p) BW_MUST_CHECK;
/* After a divergence: checkpoint-good.h5, and the cause again with its remedy. Returns `cause`. */
bw_status porous_save_last_good(porous_run *p, bw_status cause) BW_MUST_CHECK;
/* Goes on from a checkpoint, written by any number of ranks. */
bw_status porous_restart(porous_run *p, const char *path) BW_MUST_CHECK;
/* What is due after a step: the last good state, samples, pictures, checkpoints. */
bw_status porous_after_step(porous_run *p) BW_MUST_CHECK;
/* fragments.csv: the pieces now, largest first. */
bw_status porous_fragments_csv(porous_run *p) BW_MUST_CHECK;
/* Where the time went, and how evenly the markers lay on the ranks. Collective. */
bw_status porous_cost(porous_run *p) BW_MUST_CHECK;
