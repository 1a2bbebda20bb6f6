/* ulph_internal.h -- what the sources of ulph share.
 *
 * Own particles are rows of one array: fluid, walls, faces of bodies (bw_ulph_body.h), each part in
 * the order of (cell, part of the cell, identity). Slots are own particles and copies of others'
 * together, in the same order: lists name slots, so that sums do not depend on who owns what. */
#pragma once
#include "bw_particles_copies.h"
#include "bw_particles_migrate.h"
#include "bw_ulph.h"
#include "bw_ulph_body.h"
#include "ulph_vector.h"
#include <math.h>
#include <string.h>

/* A particle, as it lies in memory and travels between ranks. */
typedef struct {
  int64_t id;       /* fluid and walls are numbered apart */
  int32_t wall;     /* -1: fluid; n_walls: a face of a body */
  int32_t lone;     /* fluid: M was singular in the last evaluation */
  double m;         /* mass */
  double x[3];      /* place */
  double v[3];      /* velocity; of walls: extrapolated */
  double a[3];      /* acceleration without gravity; of faces: force by the pressure */
  double rho, p;    /* density and pressure */
  double at[3];     /* fluid: where it was when lists were made; walls: where it was built */
  double normal[3]; /* walls, faces: out of the wall */
  double depth;     /* walls: below the surface */
  double surface;   /* fluid: 1 at the surface, else 0 */
  double shift[3];  /* fluid: by which it was shifted since the last evaluation; of faces: drag */
} bw_ulph__particle;

/* Of a slot, for the first sweep. */
typedef struct {
  double x[3], V, v[3], rho;
} bw_ulph__near;

/* Of a slot, for the second sweep. */
typedef struct {
  double P[6]; /* p M^-1: xx xy xz yy yz zz */
  double p;
  double m2;      /* tr M/d */
  double g[3];    /* gradient of the density. Walls: 1 where it moves */
  double surface; /* 1 at the surface, else 0 */
} bw_ulph__far;

enum { BW_ULPH__LINES = 8, BW_ULPH__PUSHES = 5 };
/* Lines of the book. */
enum {
  LINE_WALLS,
  LINE_VISCOUS,
  LINE_ARTIFICIAL,
  LINE_DIFFUSION,
  LINE_TENSION,
  LINE_SHIFTING,
  LINE_GHOSTS,
  LINE_BODIES
};
/* Who pushes. */
enum { PUSH_GRAVITY, PUSH_WALLS, PUSH_TENSION, PUSH_SHIFTING, PUSH_BODIES };

/* Of the lanes of a cluster of fluid, from the first sweep to the second. */
typedef struct {
  vec Minv[6], s[3]; /* M^-1; sum w V x */
  vec L[9], g[3];    /* L[3 a + b] = d v_a/d x_b; gradient of the density */
  vec div_wall;      /* part of tr L that is due to walls */
  vec couple[3];     /* torque that their pairs with fluid leave, as those with walls complete M */
  vec V, p;
  vec p_mean;        /* pressure in the middle of the step, to which tr L belongs */
  vec lone, surface; /* 1 or 0: M is singular; of the surface */
  vec D;             /* density diffusion */
} bw_ulph__between;

/* What stands in the fluid: all walls, those of them that move, bodies. */
enum { BW_ULPH__WALLS, BW_ULPH__MOVING, BW_ULPH__BODIES, BW_ULPH__STANDING };

/* Sums of the second sweep, of the lanes of a cluster: over fluid, and over what stands in it. */
typedef struct {
  vec A[3], B[3], F[3], D, surface; /* w V P x; w V p x; viscous; diffusion; any surface */
  struct {
    vec s[3], A[3], B[3], F[3]; /* w V x; w V P x; w V p x; viscous */
  } by[BW_ULPH__STANDING];
} bw_ulph__pairs;

/* The book of the lanes of clusters, in the order of bw_ulph__book. */
typedef struct {
  vec line[BW_ULPH__LINES], push[BW_ULPH__PUSHES][3], turn[BW_ULPH__PUSHES][3];
} bw_ulph__page;

/* Of an own wall particle: sums over the fluid near it. */
typedef struct {
  double weight, hydrostatic; /* sum w; (g - a).sum rho x w */
  double flat;                /* of faces: 1 on a flat surface, 0 on an edge */
} bw_ulph__shade;

/* One kind of slots: fluid, or walls. */
typedef struct {
  size_t own, first, n;        /* own particles: first .. first + own - 1; slots in all */
  size_t base;                 /* number of the first slot */
  bw_particles_copies *copies; /* of and for others */
  int32_t *slot_own;           /* (own) slot of an own particle */
  int32_t *slot_copy;          /* (copies) slot of a copy */
  uint64_t *key;               /* (n) cell of a slot, increasing */
} bw_ulph__kind;

/* Neighbours of BW_ULPH_LANES own particles that are near each other. */
typedef struct {
  size_t first;                    /* own particle of lane 0, of its kind */
  int lanes;                       /* that are used */
  size_t begin, walls, faces, end; /* list: fluid from begin to walls, walls from there to faces */
  size_t wide[4];                  /* the same four of the wide list */
} bw_ulph__cluster;

/* Clusters of one kind. */
typedef struct {
  size_t n;
  bw_ulph__cluster *of; /* (n) */
} bw_ulph__clusters;

/* Which fluid the face of a body sees: normal.x > least, x from the face to the fluid. The two
 * faces of a particle share all of it; of a thick body the first sees all. */
typedef struct {
  double normal[3], least;
} bw_ulph__front;

/* The particles of the solids in the fluid, all of them on every rank. */
typedef struct {
  int64_t n;
  double *volume; /* (n) 0: not seen */
  double *x, *v;  /* (n,3) places now, and mean velocities of the step that leads there */
  bool no_slip;
} bw_ulph__body;

/* What terms have given to the fluid, or give per time. */
typedef struct {
  double line[BW_ULPH__LINES];
  double push[BW_ULPH__PUSHES][3], turn[BW_ULPH__PUSHES][3];
} bw_ulph__book;

struct bw_ulph {
  const bw_comm *comm;
  bw_ulph_config config;
  int n_walls;
  bool *no_slip, *moves; /* (n_walls + 1), the last of bodies */
  bw_ulph__body body;
  double half_space[4];   /* |sum w V x| half a layer below a flat surface, and 1, 2, 3 deeper */
  double R, h, m2;        /* reach, length of the viscosity; m2 of a lattice */
  double skin, near_skin; /* beyond R: of the wide lists, of those of them that are near */
  double strayed;         /* no particle has gone farther since the near ones were found */
  double mu_t, mu_wall;   /* physical and artificial viscosity; artificial one of walls */
  double time, time_built;
  int64_t steps, rebuilds, total;
  bool listed;                            /* lists are there */
  bool started;                           /* accelerations belong to the state */
  double wall_x[3], wall_v[3], wall_a[3]; /* of the walls that move, now */
  double wall_force[3];                   /* of this rank's fluid on walls */
  bw_particles_space *space;
  double balance; /* inequality that the last division left */
  size_t n;       /* own: fluid, walls, faces */
  bw_ulph__particle *own;
  bw_ulph__kind fluid, wall, face;
  size_t slots, slot_room, between_room, shade_room; /* used, and allocated of what follows */
  bw_ulph__near *near;                               /* (slots) */
  bw_ulph__far *far;                                 /* (slots) */
  bw_ulph__between *between;                         /* (clusters.n) */
  bw_ulph__shade *shade;                             /* (wall.own + face.own) */
  bw_ulph__front *front;                             /* (slots) of faces */
  bw_ulph__clusters clusters, shading, facing;       /* of fluid, walls, faces */
  size_t list_room, near_room;
  int32_t *wide, *list; /* slots: who may come near until lists are made anew; who is near */
  double first_energy;  /* of all ranks, at the start */
  bw_ulph__book book;   /* since the start, of all ranks */
  /* By the forces of the last evaluation per time; by what moves without a force in this step. Of
   * this rank until the end of the step, when all are summed. */
  bw_ulph__book rate, jump;
};

/* Place of xx, xy, xz, yy, yz, zz in six numbers; a <= b. */
static inline int bw_ulph__sym(int a, int b)
{
  return a + b + (a > 0);
}

/* out = A x, of a symmetric A in six numbers. */
static inline void bw_ulph__times(const double A[6], const double x[3], double out[3])
{
  out[0] = A[0] * x[0] + A[1] * x[1] + A[2] * x[2];
  out[1] = A[1] * x[0] + A[3] * x[1] + A[4] * x[2];
  out[2] = A[2] * x[0] + A[4] * x[1] + A[5] * x[2];
}

static inline double bw_ulph__dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The particle of a body that a face belongs to: two faces each, numbered one after the other. */
static inline size_t bw_ulph__body_particle(const bw_ulph__particle *face)
{
  return (size_t)(face->id & ((INT64_C(1) << 40) - 1)) / 2;
}

/* ulph_moment.c: M^-1, or where M is singular (of which it tells) that of the central form. */
vec_bits bw_ulph__moment(const bw_ulph *u, const vec M[6], vec Minv[6]);
/* Is A - shift the unit matrix positive definite, in d dimensions? */
vec_bits bw_ulph__above(int d, const vec A[6], double shift);
/* The same of a half-space, sum w x dx^d, k + 1/2 layers below its surface. */
double bw_ulph__half_space(int d, double dx, double R, int k);
/* sum w x^2 dx^d of a whole neighbourhood on a lattice, per direction. */
double bw_ulph__lattice_moment(int d, double dx, double R);

/* ulph_config.c */
bw_status bw_ulph__check(const bw_ulph_config *c) BW_MUST_CHECK;
bw_status bw_ulph__check_sound(const bw_comm *comm, bw_ulph_config *c, size_t n,
                               const double x[]) BW_MUST_CHECK;

/* ulph_wall.c: particles of all walls are added to own; faces go with their body. Collective. */
bw_status bw_ulph__build_walls(bw_ulph *u, int n_walls, const bw_ulph_wall wall[]) BW_MUST_CHECK;
void bw_ulph__move_walls(bw_ulph *u, double t);

/* ulph_shade.c: velocity and density of walls and faces from the fluid in `near`; their pressure
 * from that in `far`. Both end with the exchange. Collective. */
void bw_ulph__shade_velocity(bw_ulph *u);
void bw_ulph__shade_pressure(bw_ulph *u);

/* Before that, with new lists: walls and faces are dry until fluid has been seen. Local. */
void bw_ulph__dry(bw_ulph *u);

/* ulph_ranks.c. Collective. */
bw_status bw_ulph__migrate(bw_ulph *u) BW_MUST_CHECK; /* own to the owners of `at` */
bw_status bw_ulph__slots(bw_ulph *u) BW_MUST_CHECK;   /* copies, slots */
void bw_ulph__send(bw_ulph__kind *kind, size_t bytes, void *slots);
void bw_ulph__where(const bw_ulph *u, const bw_ulph__particle *p, double x[3]); /* for lists */

/* ulph_face.c: which way faces look, from the lists; forces on them. */
void bw_ulph__turn_faces(bw_ulph *u);
void bw_ulph__load_faces(bw_ulph *u);
/* Work on bodies in half a step, at the velocities of that step, joins the jumps of the book. */
void bw_ulph__book_bodies(bw_ulph *u, double half);

/* ulph_lists.c */
uint64_t bw_ulph__key(const bw_ulph *u, const bw_ulph__particle *p); /* cell and part of it */
bw_status bw_ulph__lists(bw_ulph *u) BW_MUST_CHECK;                  /* wide ones. Local. */
void bw_ulph__keep_near(bw_ulph *u);                  /* lists of who is near by `near`. Local. */
bw_status bw_ulph__rebuild(bw_ulph *u) BW_MUST_CHECK; /* all of it. Collective. */
void bw_ulph__release_lists(bw_ulph *u);

/* ulph_first.c, ulph_second.c: the sweeps over pairs. */
void bw_ulph__first(bw_ulph *u, double dt);
void bw_ulph__second(bw_ulph *u, double dt);

/* ulph_forces.c: forces of the pairs of a cluster; what they do to its particles, and the book of
 * it, per time (rate) and of the step (jump). */
void bw_ulph__forces(bw_ulph *u, size_t cluster, const bw_ulph__pairs *pairs, double dt,
                     bw_ulph__page *rate, bw_ulph__page *jump);

/* ulph_step.c: all sweeps with the present places; forces of the end of a step dt. Collective. */
void bw_ulph__evaluate(bw_ulph *u, double dt);
void bw_ulph__mark_places(bw_ulph *u); /* lists will be made from here. Local. */
void bw_ulph__join_books(bw_ulph *u);  /* rate and jump of all ranks. Collective. */

/* ulph_account.c */
double bw_ulph__energy(const bw_ulph *u); /* of all ranks. Collective. */
