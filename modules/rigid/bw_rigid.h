/* bw_rigid.h -- rigid bodies: six numbers each, on springs, between walls, in contact.
 *
 *   m V' = F + f,   L' = T + t,   L = Q I Q^T W,   X' = V,   Q' = W x Q
 * F, T: what the caller loads; f, t: weight, springs, walls, contact. X is the centre of mass, Q
 * the turn since the start, I the inertia at the start, W the spin, L the angular momentum about X.
 * Step     kick, drift, kick. The drift turns the body by a splitting of its kinetic energy: about
 *          its principal axes by L_1/I_1 dt/2, L_2/I_2 dt/2, L_3/I_3 dt, L_2/I_2 dt/2, L_1/I_1
 *          dt/2 (A. Dullweber, B. Leimkuhler and R. McLachlan, J. Chem. Phys. 107 (1997) 5840).
 *          Momentum and angular momentum of what is free are exact to round-off, energy to dt^2
 *          without drift.
 * Held     per direction of space, three for the centre and three for the turn: there the velocity
 *          is what the caller sets, whatever the forces. A body that may turn about one axis alone
 *          turns by the inertia about it; two free turns are refused.
 * Springs  -k (X - X_0) on the centre, -kappa times the turn's vector (angle times axis) about it,
 *          -c V and -c W as damping; per direction of space.
 * Contact  an elastic foundation: each surface point of one body that is deeper than 0 inside
 *          another one, d < 0 being its distance, is pushed out along the normal there with the
 *          pressure -k d/2 on its area, the other body is pushed back at the same point, and the
 *          same holds with the two exchanged. Walls: -k d. So momentum and angular momentum are
 *          kept, and the force has the energy k d^2/4 per area. d counts from `gap` away.
 * Friction Coulomb's: where the pressure p acts on faces that slide past each other at u, it is
 *          -mu p u/sqrt(u^2 + e^2) on both sides of the same point. e = mu |d|/T, T the time in
 *          which contact lets a body swing by a radian at most, is what a body at rest creeps by:
 *          friction is a damper of k T per area there, which no step that contact allows overdoes.
 *          With it goes a damper along the normal, of 2 % of the critical damping, as sliding
 *          would feed the bouncing of what loses nothing. What both take is booked.
 * Planar   shapes are sections, masses are those of the depth, only x, y and the turn about z live.
 * MPI      every rank holds all bodies and computes the same motion; only surface points, and the
 *          search for contact, are divided. Functions are collective unless they say local.
 * Units    any consistent set: [M], [L], [T]. Vectors are rows of three.
 * Life     config_default -> create -> { load, step } -> destroy. */
#pragma once
#include "bw_comm.h"
#include "bw_shape_surface.h"

BW_BEGIN_DECLS

/* A set of rigid bodies. Opaque. */
typedef struct bw_rigid bw_rigid;

/* One body as it starts. Zero is the default of all that is not required. */
typedef struct {
  int count;             /* of shapes                                     required */
  const bw_shape *shape; /* (count) where it is at the start; copied, but frames and masks stay
                            borrowed                                      required */
  double density;        /* mass and inertia are those of the shapes filled with it [M/L^3]; 0: they
                            are given below */
  double mass;           /* [M] */
  double centre[3];      /* of mass [L] */
  double inertia[3][3];  /* about the centre, along x, y, z [M L^2] */
  double velocity[3];    /* [L/T] */
  double spin[3];        /* [1/T] */
  bool held[6];          /* x, y, z of the centre, turn about x, y, z */
  double stiffness[6];   /* of springs: [M/T^2], then [M L^2/T^2] */
  double damping[6];     /* [M/T], then [M L^2/T] */
} bw_rigid_body;

/* What all share. */
typedef struct {
  bool planar;       /*                                          default false */
  double depth;      /* of planar bodies [L]                     default 1 */
  double gravity[3]; /* [L/T^2]                                  default 0 */
  double stiffness;  /* k of contact [M/(L^2 T^2)]; 0: none      default 0 */
  double friction;   /* mu of contact [-]                        default 0 */
  double gap;        /* distance at which contact begins [L]     default 0 */
  bool walled[3][2]; /* which planes of the box below are walls  default none */
  double lower[3];   /* [L] */
  double upper[3];   /* [L] */
  double spacing;    /* of the surface points [L]                required */
  double safety;     /* of the stable step [-]                   default 0.2 */
} bw_rigid_config;

/* Three dimensions, no weight, no walls, no contact; spacing NaN. Local. */
bw_rigid_config bw_rigid_config_default(void);

/* n bodies. Mass, centre and inertia of shapes come from their surface, by Gauss, to second order
 * in a hundredth of their size. BW_EINPUT names the body and the value: an empty list, no volume,
 * mass or inertia that is not positive, two free turns, a spacing that is not positive, more than a
 * third of a body's size or asked of a mask, what bw_shape_points refuses; BW_EMEM. *out is the
 * caller's, NULL after a failure. Collective. */
bw_status bw_rigid_create(const bw_comm *comm, const bw_rigid_config *config, int n,
                          const bw_rigid_body body[], bw_rigid **out) BW_MUST_CHECK;
/* Releases everything and sets *rigid to NULL; NULL is fine. Local. */
void bw_rigid_destroy(bw_rigid **rigid);

/* What does not change, and what moves; the same on all ranks. */
typedef struct {
  double mass;        /* [M] */
  double volume;      /* of the shapes, times the depth [L^3] */
  double inertia[3];  /* principal [M L^2] */
  double position[3]; /* of the centre of mass [L] */
  double turn[3][3];  /* Q: rows are x, y, z of space, columns those of the body */
  double velocity[3]; /* [L/T] */
  double spin[3];     /* [1/T] */
  double force[3];    /* f of the last evaluation: weight, springs, walls, contact [M L/T^2] */
  double torque[3];   /* t, about the centre [M L^2/T^2] */
} bw_rigid_state;

int bw_rigid_count(const bw_rigid *rigid);                         /* bodies. Local. */
double bw_rigid_time(const bw_rigid *rigid);                       /* [T]. Local. */
const bw_comm *bw_rigid_comm(const bw_rigid *rigid);               /* Local. */
bw_rigid_state bw_rigid_state_of(const bw_rigid *rigid, int body); /* Local. */

/* Set velocity [L/T] and spin [1/T] of a body, held directions included: this is how prescribed
 * bodies are moved. The same on all ranks. Local. */
void bw_rigid_set_motion(bw_rigid *rigid, int body, const double velocity[3], const double spin[3]);

/* Load F (n,3) and torque T (n,3) about the centres for the steps to come, all bodies, the same on
 * all ranks; without it what was loaded last. Local. */
void bw_rigid_load(bw_rigid *rigid, const double F[], const double T[]);

/* The largest step [T] that springs and contact allow, times `safety`: of springs that of velocity
 * Verlet, 2 sqrt(m/k); of contact the same with k times half of the body's surface. INFINITY where
 * there is neither. Local. */
double bw_rigid_dt_max(const bw_rigid *rigid);

/* One step of dt [T]. BW_ECFL above bw_rigid_dt_max, BW_EDIVERGED when something is not finite.
 * Collective. */
bw_status bw_rigid_step(bw_rigid *rigid, double dt) BW_MUST_CHECK;
/* The same in two halves: kick and drift; new forces and kick. Between them a caller whose load
 * depends on where the bodies are finds them there, and loads it for the second kick. Errors as of
 * bw_rigid_step. Collective. */
bw_status bw_rigid_begin(bw_rigid *rigid, double dt) BW_MUST_CHECK;
bw_status bw_rigid_end(bw_rigid *rigid, double dt) BW_MUST_CHECK;

/* Energies now [M L^2/T^2]; their sum is constant without load, damping and work of what is
 * held. */
typedef struct {
  double kinetic; /* of the centres and the turns */
  double weight;  /* -m g.X */
  double spring;  /* of both kinds */
  double contact; /* between bodies and with walls */
  double rubbed;  /* taken by friction so far */
} bw_rigid_energy;
bw_rigid_energy bw_rigid_energy_of(const bw_rigid *rigid); /* Collective. */

/* Points on the surfaces, with equal shares of all bodies on every rank: how many on this one. */
size_t bw_rigid_points(const bw_rigid *rigid); /* Local. */
/* Number of each of them (n), from 0 over all bodies, whatever the ranks are; body (n); area [L^2]
 * (planar: times the depth) (n). Borrowed. Local. */
const int64_t *bw_rigid_point_id(const bw_rigid *rigid);
const int *bw_rigid_point_body(const bw_rigid *rigid);
const double *bw_rigid_point_area(const bw_rigid *rigid);
/* Where they are now, how they move and look: X, V, N (n,3); any may be NULL. Local. */
void bw_rigid_surface(const bw_rigid *rigid, double X[], double V[], double N[]);
/* Sum of forces f (n,3) at this rank's points, over all ranks: F, T (bodies,3), T about the
 * centres. Collective. */
void bw_rigid_sum(const bw_rigid *rigid, const double f[], double F[], double T[]);

/* Signed distance of x (3) from a body where it is now, negative inside (bw_shape_distance).
 * Local. */
double bw_rigid_distance(const bw_rigid *rigid, int body, const double x[3]);
/* The unit vector (3) along which that distance grows fastest at x (3) (bw_shape_normal). Local. */
void bw_rigid_normal(const bw_rigid *rigid, int body, const double x[3], double normal[3]);
/* Area of a body's surface [L^2] (planar: its sides, without the two ends). Local. */
double bw_rigid_area(const bw_rigid *rigid, int body);
/* What an impulse and its moment about the centre, impulse (6) [M L/T], [M L^2/T], change of a
 * body's velocity and spin, change (6) [L/T], [1/T]: nothing in held directions. Local. */
void bw_rigid_answer(const bw_rigid *rigid, int body, const double impulse[6], double change[6]);
/* Radius of the ball about the centre of mass that holds the body. Local. */
double bw_rigid_radius(const bw_rigid *rigid, int body);

/* State for a restart: BW_RIGID_ROW numbers per body, the same on all ranks. Restored into bodies
 * that were created alike, the motion goes on to the last bit. save is local, restore
 * collective. */
enum { BW_RIGID_ROW = 24 /* numbers per body */ };
void bw_rigid_save(const bw_rigid *rigid, double row[]);
void bw_rigid_restore(bw_rigid *rigid, double time, const double row[]);
/* What friction has taken so far [M L^2/T^2], for a restart, too. Local. */
void bw_rigid_set_rubbed(bw_rigid *rigid, double rubbed);

BW_END_DECLS
