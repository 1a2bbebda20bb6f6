/* bw_ns_channel.h -- incompressible Navier-Stokes in a box: MAC grid, RK3, pressure correction.
 *
 *   du/dt + div(u u) = -grad p + nu lap u + g,   div u = 0,
 * p is the pressure over the density [L^2/T^2]. One step is three sub-steps r = 0, 1, 2
 * (POROUS 3.70-3.73; ERRATA 5, 15):
 *   predict  u* = u + dt (alpha_r R(u) + beta_r R_prev - gamma_r grad p) + dt gamma_r g
 *   (a body may now change u*)
 *   project  lap p^ = (div u*) / (gamma_r dt);  u = u* - gamma_r dt grad p^;  p += p^
 * with alpha = 8/15, 5/12, 3/4; beta = 0, -17/60, -5/12; gamma = alpha + beta. Second-order
 * central differences in the divergence form that keeps kinetic energy.
 * Boundaries, per side: periodic; wall (no-slip, moving tangentially; free-slip); inflow
 * (uniform, laminar profile, callback); outflow (convective du/dt + U_c du/dn = 0 with U_c the bulk
 * velocity, slowed where fluid comes back, then a uniform correction that balances mass globally).
 * Any side may be any of them; velocities count along +x, +y, +z whatever the side.
 * 2D: n[2] == 1 computes and stores nothing for w.
 * Halos: u, v, w, p valid (all layers) after create, set_velocity, step and project; after
 * predict too. Life: config_default -> create -> set_velocity -> { step } -> destroy. */
#pragma once
#include "bw_grid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The solver: fields, boundaries and time of one flow. Opaque. */
typedef struct bw_ns_channel bw_ns_channel;

/* What a side of the box does to the fluid. */
typedef enum {
  BW_SIDE_PERIODIC,  /* joined to the opposite side, which has to be periodic too */
  BW_SIDE_WALL,      /* no slip; may move in its own plane */
  BW_SIDE_FREE_SLIP, /* a plane of symmetry: nothing crosses it, no shear stress on it */
  BW_SIDE_INFLOW,    /* velocity given by a profile */
  BW_SIDE_OUTFLOW    /* convective; takes what the inflows bring */
} bw_ns_side_kind;

/* How the velocity of an inflow or of a wall is given. */
typedef enum {
  BW_PROFILE_UNIFORM,    /* the same everywhere: bw_ns_side.velocity */
  BW_PROFILE_POISEUILLE, /* steady laminar flow through the section: bw_ns_side.bulk_velocity */
  BW_PROFILE_CALLBACK    /* a function of place and time: bw_ns_side.function */
} bw_ns_profile;

/* u[3] [L/T] at the point x[3] [L] and time t [T]. Pure; called for any point, in any order. */
typedef void (*bw_ns_velocity_fn)(const double x[3], double t, void *context, double u[3]);

/* One side of the box. */
typedef struct {
  bw_ns_side_kind kind;       /*                                          default wall */
  double velocity[3];         /* of the wall; of a uniform inflow [L/T]   default 0 */
  bw_ns_profile profile;      /* of an inflow; wall: uniform or callback    default uniform */
  double bulk_velocity;       /* of a Poiseuille inflow: the laminar profile of its section, a plane
                                 channel, a duct, or half of one at a free-slip side [L/T] */
  bw_ns_velocity_fn function; /* of a callback inflow or wall (tangential part of u is used) */
  void *context;              /* borrowed for the life of the solver */
} bw_ns_side;

/* What drives a flow that is periodic in x. */
typedef enum {
  BW_FORCING_NONE,      /* nothing; sides may */
  BW_FORCING_FLOW_RATE, /* a uniform gradient that keeps the bulk velocity, to round-off */
  BW_FORCING_GRADIENT   /* a given uniform gradient */
} bw_ns_forcing;

/* How the viscous term advances in time. Implicit parts weigh the old velocity of a sub-step with
 * 17/60, 0, 1/6 of dt and the new one with 1/4, 2/15, 1/6: second order in time, and what is stiff
 * is gone within a step (ERRATA 38). */
typedef enum {
  BW_VISCOUS_EXPLICIT,   /* all by RK3: third order, the step limited by dx^2/nu */
  BW_VISCOUS_IMPLICIT_Y, /* implicit in y: thin cells at walls do not limit the step */
  BW_VISCOUS_IMPLICIT    /* implicit in all directions: convection limits the step, and where the
                            Reynolds number of the box is of order 1 that short waves decay */
} bw_ns_viscous;

/* A model of eddies that no cell resolves. */
typedef enum {
  BW_EDDY_NONE, /* every eddy is resolved: direct numerical simulation */
  BW_EDDY_WALE  /* eddy viscosity of the squared velocity gradient (Nicoud & Ducros 1999): zero at
                   walls, as y^3, and in plain shear. Explicit, whatever `viscous` is. 3D only */
} bw_ns_eddy;

/* Everything that a flow is. */
typedef struct {
  bw_ns_side side[3][2]; /* [direction][lower, upper] */
  double nu;             /* kinematic viscosity [L^2/T]             required */
  bw_ns_forcing forcing; /* along a periodic direction              default none */
  int forcing_axis;      /* that direction: 0, 1, 2                 default 0: x */
  double forcing_value;  /* bulk velocity [L/T], or -dp/dx / rho [L/T^2], along it */
  bw_ns_viscous viscous; /*                                         default explicit */
  bw_ns_eddy eddy;       /*                                         default none */
  double eddy_constant;  /* C of WALE, nu_t = (C Delta)^2 ... [-]   default 0.325 */
} bw_ns_channel_config;

/* Walls at rest on all sides, no forcing, nu NaN. Pure. */
bw_ns_channel_config bw_ns_channel_config_default(void);

/* Is it possible on this grid? The check that create makes, before anything exists. Local. */
bw_status bw_ns_channel_config_check(const bw_grid_config *grid,
                                     const bw_ns_channel_config *config) BW_MUST_CHECK;

/* What a fluid costs and which step it bears, before it is built. */
typedef struct {
  double bytes;  /* of memory on the rank that needs most, solver and all */
  double dt_max; /* longest stable step of the fluid at rest: viscosity, and what is known of walls,
                    inflows and forcing then [T]; a laminar inflow counts with its mean */
} bw_ns_plan;

/* The same for the grid of a bw_grid_plan, from two small fluids with cells of the same size and
 * the same sides: time and memory do not grow with the grid. Errors of bw_ns_channel_create for the
 * settings. Collective. */
bw_status bw_ns_channel_plan(const bw_grid *grid, const bw_ns_channel_config *config,
                             bw_ns_plan *plan) BW_MUST_CHECK;

/* `grid` is borrowed until destroy. BW_EINPUT for impossible or contradictory boundaries (named),
 * nu <= 0 or NaN, forcing along what is not periodic; BW_EMEM. Fluid at rest. Collective. */
bw_status bw_ns_channel_create(bw_grid *grid, const bw_ns_channel_config *config,
                               bw_ns_channel **out) BW_MUST_CHECK;
/* Releases everything and sets *ns to NULL; NULL is fine. Collective. */
void bw_ns_channel_destroy(bw_ns_channel **ns);

/* Set u at each component's own points, project it divergence-free, zero the pressure, set the
 * time to t [T]. `function` NULL: rest. BW_EDIVERGED when a value is not finite. Collective. */
bw_status bw_ns_channel_set_velocity(bw_ns_channel *ns, bw_ns_velocity_fn function, void *context,
                                     double t) BW_MUST_CHECK;

/* Largest dt that the present field allows [T]:
 *   dt = 1 / sqrt((c/sqrt(3))^2 + g/(sqrt(3) dx) + (a/2.5127)^2),
 * an ellipse inside the stability region of this RK3, without z in 2D.
 * c: the largest rate of convection, of all cells half of sum_i (|u_i below| + |u_i above|)/dx_i,
 *    the same whichever way the stream goes; of all walls and inflows sum_i |u_i|/dx_i, and of a
 *    given flow rate U/dx, as the fluid may be at rest yet.
 * g: the given gradient, which may add g dt to the velocity.
 * a: 4 nu sum_i 1/dx_i^2 over the directions with an explicit viscous term, and over all of them
 *    with an eddy viscosity; with something implicit 2.47 in place of 2.5127 (ERRATA 37; ERRATA 22
 *    has the viscous part with 1.65).
 * With all of the viscous term implicit a = 0, and dt ends where the waves that are short in two or
 * three directions would no longer decay as fast as the one that fills the box (some L dx/nu).
 * Collective. */
double bw_ns_channel_dt_max(bw_ns_channel *ns);

/* One step of dt: three times predict and project. BW_ECFL when dt is over the limit,
 * BW_EDIVERGED when the field is not finite (message says where). Collective. */
bw_status bw_ns_channel_step(bw_ns_channel *ns, double dt) BW_MUST_CHECK;

/* The first half of sub-step r = 0, 1, 2 (in order, with the same dt): the velocity of
 * bw_ns_channel_velocity holds u* afterwards, whose interior a body may change. Part of step, for
 * who puts something in between. Collective. */
void bw_ns_channel_predict(bw_ns_channel *ns, int r, double dt);
/* Ghosts beyond the sides from the velocity inside and in the halos, which are valid: for who has
 * changed u* next to a side and reads beyond it before project. Local. */
void bw_ns_channel_ghosts(bw_ns_channel *ns);
/* Volume that enters in n cells (bw_at, of this rank; one may come more than once): rate (n) per
 * volume and time [1/T], below 0 where it leaves. Copied; div u is that from the next projection
 * on, until other sources are given, 0 in all other cells. Over all cells and ranks it has to add
 * up to nothing, rate times volume, as nothing else lets it out. BW_EMEM. Local. */
bw_status bw_ns_channel_set_sources(bw_ns_channel *ns, size_t n, const ptrdiff_t cell[],
                                    const double rate[]) BW_MUST_CHECK;
/* The second half: updates halos itself, makes u free of divergence; r = 2 advances the time. A
 * constant flow rate is met exactly after every project, whatever the body took: predict applies
 * the gradient of the sub-step before, project the rest. Collective. */
void bw_ns_channel_project(bw_ns_channel *ns, int r, double dt);

/* Is the field finite and the step within its limit? The check that step makes: BW_EDIVERGED,
 * BW_ECFL, BW_EINPUT for a dt that is negative or not finite. Collective. */
bw_status bw_ns_channel_check(bw_ns_channel *ns, double dt) BW_MUST_CHECK;

/* The velocity u[3] [L/T], each component on its own faces, with halos (layout of bw_grid.h);
 * borrowed; u[2] is NULL in 2D. Local. */
bw_real *const *bw_ns_channel_velocity(bw_ns_channel *ns);
/* p/rho [L^2/T^2] at the centres, with halos; borrowed. Local. */
bw_real *bw_ns_channel_pressure(bw_ns_channel *ns);
/* The grid that create was given, borrowed. Local. */
bw_grid *bw_ns_channel_grid(bw_ns_channel *ns);
/* The configuration in force, borrowed until destroy. Local. */
const bw_ns_channel_config *bw_ns_channel_settings(const bw_ns_channel *ns);
/* Time of the present field [T]. Local. */
double bw_ns_channel_time(const bw_ns_channel *ns);
/* The present field is that of time t [T] from now on; nothing else changes. Local, the same on all
 * ranks. */
void bw_ns_channel_set_time(bw_ns_channel *ns, double t);

/* After fields were overwritten through the views (restart): boundaries, halos. Collective. */
void bw_ns_channel_refresh(bw_ns_channel *ns);

/* Largest |div u| over the cells, less the sources, times dx over the largest |u| [-]; 0 at rest.
 * Collective. */
double bw_ns_channel_divergence(bw_ns_channel *ns);

/* What a line of a history wants to know of the present field. */
typedef struct {
  double bulk_velocity;     /* mean over the box, along forcing_axis [L/T] */
  double kinetic_energy;    /* integral u.u/2 [L^5/T^2] */
  double pressure_gradient; /* mean forcing -dp/dx/rho applied in the last step [L/T^2] */
  double inflow;            /* volume flux along +x through the lower x side [L^3/T] */
  double outflow;           /* the same through the upper x side [L^3/T] */
} bw_ns_summary;
/* Integrals of the present field, the same on all ranks. Collective. */
bw_ns_summary bw_ns_channel_summary(bw_ns_channel *ns);

/* Hydraulic tortuosity of the flow along an axis [-]: integral of |u| over that of u_axis (POROUS
 * 2.7), over the cells whose centres are between two corners [L]; 1 of straight flow. Cells of a
 * body at rest in it add nothing. NaN where nothing flows along the axis. Collective. */
double bw_ns_channel_tortuosity(bw_ns_channel *ns, int axis, const double lower[3],
                                const double upper[3]);

/* One side of the present field. */
typedef struct {
  double flux;      /* out of the box [L^3/T] */
  double stress[3]; /* mean of nu du_c/dn of the tangential components, n into the fluid [L^2/T^2]:
                       force of the fluid on a wall per area and density; [d] is 0 */
} bw_ns_side_report;
/* The eddy viscosity of the present field at the centres, with halos (layout of bw_grid.h)
 * [L^2/T]; borrowed; NULL without a model. Local. */
const bw_real *bw_ns_channel_eddy_viscosity(const bw_ns_channel *ns);

/* Flux and stress of side s (0 lower, 1 upper) of direction d. Collective. */
bw_ns_side_report bw_ns_channel_side(bw_ns_channel *ns, int d, int s);

/* Watch the momentum of the cells lo[d] < i <= hi[d] (global; per velocity component those of
 * its points with these indices). Before a step; replaces an earlier box; costs the faces of the
 * box per sub-step and its volume per step. BW_EINPUT when the box is empty or leaves the grid, the
 * viscous term is implicit in all directions, or there is an eddy viscosity. Collective. */
bw_status bw_ns_channel_watch_box(bw_ns_channel *ns, const int lo[3],
                                  const int hi[3]) BW_MUST_CHECK;

/* Force per density of everything inside the watched box on the fluid, mean over the last step
 * [L^4/T^2], from the momentum balance of the box:
 *   F = d/dt int u dV + oint (u u.n + p n - nu grad u.n) dS - int g dV
 * with the scheme's own fluxes weighted as RK3 weights them, so that F is the mean body force of
 * the step to round-off (oint grad u^T.n dS vanishes where div u = 0). Zero before the first
 * step. What a fixed body feels is -rho F. Collective. */
void bw_ns_channel_control_volume(bw_ns_channel *ns, double force[3]);

/* Change the bulk velocity or the gradient that config.forcing_value gave (ramps, oscillating
 * flow); from the next predict on. No effect without forcing. Local, the same on all ranks. */
void bw_ns_channel_set_forcing(bw_ns_channel *ns, double value);

/* The mean gradient -dp/dx/rho along forcing_axis that drove the last step [L/T^2], 0 without
 * forcing. The pressure
 * field is without it: the whole one falls by so much more per length. Local. */
double bw_ns_channel_driving(const bw_ns_channel *ns);

/* The gradient that the constant flow rate starts the next step from [L/T^2]: with u, v, w, p and
 * the time the whole state of the solver (a checkpoint saves it). Local. */
double bw_ns_channel_gradient(const bw_ns_channel *ns);
/* Puts that gradient [L/T^2] back after a restart. Local, the same on all ranks. */
void bw_ns_channel_set_gradient(bw_ns_channel *ns, double gradient);

/* Where this rank's time went since create or the last reset, and the memory of its own fields
 * (without poisson's). */
typedef struct {
  double momentum; /* the sweep of predict, and the implicit solves [s] */
  double poisson;  /* pressure solves [s] */
  double correct;  /* divergence and correction [s] */
  double halo;     /* messages between ranks and ghosts at sides [s] */
  double boundary; /* values of inflow and outflow, the watched box [s] */
  long substeps;   /* sub-steps done */
  size_t bytes;    /* memory of fields and buffers on this rank [B] */
} bw_ns_cost;
/* Reads the clocks. Local. */
bw_ns_cost bw_ns_channel_cost(const bw_ns_channel *ns);
/* Sets the clocks and the count of sub-steps to zero. Local. */
void bw_ns_channel_cost_reset(bw_ns_channel *ns);

#ifdef __cplusplus
}
#endif
