/* bw_ulph.h -- a fluid of particles with a free surface (updated-Lagrangian hydrodynamics).
 *
 * Solves, for a weakly compressible Newtonian fluid in a frame at rest, in 2D or 3D,
 *   d(rho)/dt = -rho div v,   rho dv/dt = -grad p + mu laplace v + rho g,   p = c0^2 (rho - rho0),
 * with p = 0 outside of the fluid. Source: ULPH (docs/sources.md), equations 8-23, 27, 52; what was
 * wrong there stands in docs/errata.md under "ULPH".
 *
 * Operators, with x = x_J - x_I, weight w = (1 - q)^4 (1 + 4 q), q = r/R, R = 3 dx (Wendland 1995,
 * C2), volume V = m/rho, and M_I = sum_J w V_J x x^T:
 *   (grad f)_I = sum_J w V_J (f_J - f_I) M_I^-1 x,
 *   F_I        = -V_I sum_J w V_J (p_I M_I^-1 + p_J M_J^-1) x.
 * The gradient is exact for linear fields on any cloud of points. The force is its adjoint:
 * sum F.v = sum V p div v, so that momentum, angular momentum and energy are kept to round-off.
 * Where the least eigenvalue of M_I is below 0.35 of that of a full neighbourhood, M_I^-1 is the
 * unit matrix over the latter: the force is then central, and all three are still kept.
 * Density diffusion (Antuono et al. 2010, with these operators), antisymmetric, zero for linear rho
 * and between particles that are not of the surface:
 *   D_I = delta h c0 sum_J w V_J/m2 [2 (rho_J - rho_I) - (grad rho_I + grad rho_J).x],
 * with h = 1.2 dx and m2 = (tr M_I + tr M_J)/(2 d). Viscosity, central, antisymmetric:
 *   F_I = V_I sum_J w V_J 2 (d + 2) mu_t ((v_J - v_I).x) x/(r^2 m2),
 *   mu_t = mu + rho0 alpha h c0/(2 (d + 2)): the physical viscosity and the artificial one.
 * Tension: where p_I < 0 and no surface is within R, F_I = -V_I (grad p)_I; the momentum that this
 * takes is booked. Shifting: particles without a surface within R move by
 *   -C |grad v| h^2 dt (sum_J w V_J x)/m2, at most 0.05 dx, against clustering; rho and v follow
 * their gradients, and what that takes is booked.
 * A particle is of the surface where the least eigenvalue of M_I is below 3/4 of the full one.
 * Walls are particles too: 3 layers inside a solid shape, a mirror image of the fluid. Their
 * velocity is that of the fluid near them with its part normal to the wall turned round (relative
 * to the wall; with no slip the other part goes linearly through the wall's velocity on the
 * surface), their pressure that of the fluid with the weight between (equation 52 with
 * x_sf = x_f - x_s), at least 0, and their M that of a fluid particle in their place: then pairs
 * across a flat free-slip wall leave it no force along it. Where walls meet, the normal is the way
 * to the nearest place outside of all of them. A wall particle counts only as far as
 * there is fluid in front of it. Pairs of fluid and wall have the artificial viscosity alpha_wall:
 * the image is extrapolated, its operators are the adjoint of each other only where it is exact,
 * and thin sheets on walls would ring.
 * Step (kick, drift, kick, one evaluation): v += a dt/2; x += v dt; walls; M, grad v; rho by the
 * mean of the step's dilation; p; a; v += a dt/2; diffusion and shifting.
 *
 * Shapes    positions (n,3) [L]; in 2D z = 0. Numbers are double in either precision: the pressure
 *           is a small difference of densities.
 * Units     any consistent ones; in 2D masses are per depth [M/L].
 * Life      create -> start -> { dt_max, step, gauges, account }* -> destroy.
 * Limits    no inflow, outflow or periodic side; no surface tension; below 2^31 points per rank;
 *           one motion for all walls that move, a translation.
 * Ranks     sums are in an order that depends on positions and identities alone: the state is the
 *           same to the last bit on any number of ranks. */
#pragma once
#include "bw_comm.h"
#include "bw_shape.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_ulph bw_ulph;

/* Place x (3) [L] of the walls that move, relative to where they were built, with velocity v (3)
 * [L/T] and acceleration a (3) [L/T^2] at the time t [T]. */
typedef void bw_ulph_motion(double t, void *context, double x[3], double v[3], double a[3]);

/* The state of the fluid at the start: velocity v (3) [L/T] and pressure p at the place x (3). */
typedef void bw_ulph_start_fn(const double x[3], void *context, double v[3], double *p);

/* A solid at whose surface the fluid ends: a composition of shapes (bw_shape.h). */
typedef struct {
  int count;             /* of shapes */
  const bw_shape *shape; /* (count) borrowed during create */
  double axes[3][3];     /* rows: axes of its particles; all zero: x, y, z */
  double origin[3];      /* a corner of their lattice [L] */
  bool no_slip;          /* false: free slip */
  bool moves;            /* by the motion of the configuration */
} bw_ulph_wall;

/* What a fluid is. Values without a default are NaN or 0 and refused by name. */
typedef struct {
  int dimensions;    /* 2 or 3                                                      required */
  double dx;         /* spacing of the particles [L]                                required */
  double rho0;       /* density without pressure [M/L^3]                            required */
  double speed;      /* largest speed that is expected [L/T]                        required */
  double c0;         /* speed of sound [L/T]; NaN: 10 max(speed, sqrt(|g| height))  default NaN */
  double gravity[3]; /* [L/T^2]                                                     default 0 */
  double mu;         /* dynamic viscosity [M/(L T)]                                 default 0 */
  double alpha;      /* artificial viscosity [-]                                    default 0.02 */
  double alpha_wall; /* the same of the pairs of fluid and wall                     default 0.1 */
  double delta;      /* density diffusion [-]                                       default 0.1 */
  double shifting;   /* factor C of the shifting [-]; 0: none                       default 2 */
  bool tension_cure; /* difference form under tension                            default true */
  double step_share; /* acoustic step over dx/(c0 + U) [-]                          default 1 */
  bw_ulph_motion *motion; /* of the walls that move; NULL: none does */
  void *motion_context;   /* borrowed for life */
} bw_ulph_config;

/* The book. Energies [M L^2/T^2] (2D: per depth); lines are what a term has given to the fluid
 * since the start, negative where it takes. kinetic + potential + compression - first = sum of the
 * lines + gap; gap is the error of the time integration. */
typedef struct {
  double kinetic, potential, compression; /* energies now */
  double first;                           /* kinetic + potential + compression at the start */
  double walls;                           /* work of moving walls */
  double viscous;                         /* by mu */
  double artificial;                      /* by alpha and alpha_wall */
  double diffusion;                       /* by delta */
  double tension;                         /* by the difference form */
  double shifting;             /* by the shifts, with the changes of rho and v that go with them */
  double ghosts;               /* what extrapolated wall particles give beyond a mirror image */
  double bodies;               /* work of bodies (bw_ulph_body.h) */
  double gap;                  /* what no line explains */
  double mass;                 /* [M] */
  double momentum[3], spin[3]; /* now, and about the origin [M L/T], [M L^2/T] */
  double push[5][3]; /* momentum given by gravity, walls, difference form, shifting, bodies */
  double turn[5][3]; /* angular momentum given by the same */
} bw_ulph_ledger;

/* The defaults above. Local. */
bw_ulph_config bw_ulph_config_default(void);

/* Kinematic viscosity of the artificial term [L^2/T]: alpha h c0/(2 (d + 2)). Local. */
double bw_ulph_artificial_nu(const bw_ulph *u);

/* Sites of a lattice of spacing dx with a corner at origin (3) inside a composition of shapes:
 * *x (n,3) of this rank's part, owned by the caller (bw_release). Errors of bw_shape_fill_shared.
 * Collective. */
bw_status bw_ulph_fill(const bw_comm *comm, const bw_ulph_config *config, const double origin[3],
                       int count, const bw_shape shape[], size_t *n, double **x) BW_MUST_CHECK;

/* A fluid of particles at x (n,3) of this rank, at rest without pressure, each with the volume
 * dx^d, and its walls. `comm` and the motion are borrowed until destroy. BW_EINPUT: a value of the
 * configuration by its name; a c0 that is less than 10 times the expected speed or sqrt(|g| height)
 * (with the value that would do); walls thinner than 3 dx; particles nearer than dx/2 to each other
 * or inside a wall (with the place). BW_EMEM. The same on all ranks. Collective. */
bw_status bw_ulph_create(const bw_comm *comm, const bw_ulph_config *config, size_t n,
                         const double x[], int n_walls, const bw_ulph_wall wall[],
                         bw_ulph **out) BW_MUST_CHECK;

void bw_ulph_destroy(bw_ulph **u); /* NULL is fine. Local. */

/* Velocity and pressure of every particle, and time 0; the mass of a particle becomes rho dx^d.
 * NULL leaves rest. Evaluates the forces. BW_EINPUT where a value is not finite, or faster than
 * c0/10.
 * Collective. */
bw_status bw_ulph_start(bw_ulph *u, bw_ulph_start_fn *start, void *context) BW_MUST_CHECK;

/* The step that is recommended now [T]: the least of step_share dx/(c0 + U), dx the largest speed
 * U; 0.25 sqrt(dx/|a|); dx^2/8 over the whole kinematic viscosity. Collective. */
double bw_ulph_dt_max(bw_ulph *u);

/* Advance by dt [T]. BW_ECFL beyond 2.4 dx/c0, the acoustic limit; BW_EDIVERGED when a value is not
 * finite or faster than c0. Memory grows where particles gather or change rank. Collective. */
bw_status bw_ulph_step(bw_ulph *u, double dt) BW_MUST_CHECK;

double bw_ulph_time(const bw_ulph *u);      /* [T]. Local. */
int64_t bw_ulph_steps(const bw_ulph *u);    /* done since start. Local. */
int64_t bw_ulph_rebuilds(const bw_ulph *u); /* of the lists of neighbours. Local. */
double bw_ulph_c0(const bw_ulph *u);        /* [L/T]. Local. */

/* The time t [T] that steps have led to but for rounding, to the last bit. Local. */
void bw_ulph_set_time(bw_ulph *u, double t);

/* Fluid particles of this rank; of all ranks; wall particles of this rank. Local. */
size_t bw_ulph_count(const bw_ulph *u);
int64_t bw_ulph_total(const bw_ulph *u);
size_t bw_ulph_wall_count(const bw_ulph *u);

/* What can be read of each particle. */
typedef enum {
  BW_ULPH_POSITION, /* 3 [L] */
  BW_ULPH_VELOCITY, /* 3 [L/T] */
  BW_ULPH_FORCE,    /* 3, mass times acceleration without gravity [M L/T^2] */
  BW_ULPH_DENSITY,  /* 1 [M/L^3] */
  BW_ULPH_PRESSURE, /* 1 */
  BW_ULPH_SURFACE,  /* 1: 1 at the surface, else 0 */
  BW_ULPH_MASS      /* 1 [M] */
} bw_ulph_field;

/* out (count,1 or 3) of the fluid particles of this rank; of its wall particles (position, velocity
 * of the wall, pressure; others are 0). Local. */
void bw_ulph_read(const bw_ulph *u, bw_ulph_field field, double out[]);
void bw_ulph_read_wall(const bw_ulph *u, bw_ulph_field field, double out[]);

/* id (count): the fluid particle's number in the joined list of create. Local. */
void bw_ulph_ids(const bw_ulph *u, int64_t id[]);

/* The book as it stands. Collective. */
bw_ulph_ledger bw_ulph_account(const bw_ulph *u);

/* Height of the fluid in the column at x (and z in 3D) [L], counted along y: its volume weighted
 * with a hat of half-width `width` [L], rounded up to a multiple of dx, over the hat. Spray counts
 * with what it holds. Keep a column that width away from walls. Collective. */
double bw_ulph_depth(const bw_ulph *u, const double x[3], double width);

/* Largest place along `axis` (0, 1, 2) of the fluid within lower <= x < upper, a surface dx/2
 * outside of the outermost particle that has neighbours on all sides or at its back; -INFINITY
 * where there is none. Collective. */
double bw_ulph_reach(const bw_ulph *u, int axis, const double lower[3], const double upper[3]);

/* Mean pressure on the wall particles of the first layer within lower <= x < upper, dry ones
 * counted as 0. NaN where there are none. Collective. */
double bw_ulph_wall_pressure(const bw_ulph *u, const double lower[3], const double upper[3]);

/* Force of the fluid on all walls [M L/T^2] at the last evaluation. Collective. */
void bw_ulph_wall_force(const bw_ulph *u, double force[3]);

/* Fluid particles outside of lower <= x < upper. Collective. */
int64_t bw_ulph_outside(const bw_ulph *u, const double lower[3], const double upper[3]);

/* Numbers of a particle, and of the whole, that go into a checkpoint. */
enum { BW_ULPH_ROW = 17, BW_ULPH_NUMBERS = 81 };

/* rows (count, BW_ULPH_ROW) in the order of bw_ulph_ids, numbers (BW_ULPH_NUMBERS); what state_set
 * needs to go on to the last bit. Collective. */
void bw_ulph_state_get(const bw_ulph *u, double rows[], double numbers[]);

/* The state of a fluid that was created alike: n rows of this rank, any division, each id once.
 * BW_EINPUT when ids are missing; BW_EMEM. Collective. */
bw_status bw_ulph_state_set(bw_ulph *u, size_t n, const int64_t id[], const double rows[],
                            const double numbers[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
