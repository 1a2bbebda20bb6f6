/* coupler_internal.h -- shared by the sources of the coupler only. */
#pragma once
#include "bw_coupler.h"
#include "bw_exchange.h"
#include "rigid_touch.h"

/* Of the fluid on the solid since the start, this rank's share [M L^2/T^2]: given through the
 * markers; by the load; of that, what is held back; what the solid received. What films took. */
enum { BW_COUPLER__WORKS = 5 };
typedef struct {
  double given, late, loaded, received, film;
} bw_coupler__work;

/* What the book of the coupling sums over the steps of a window (book.c), of this rank. */
enum { BW_COUPLER__WINDOWS = 2, BW_COUPLER__BOOK_SUMS = 7 };
typedef struct {
  double sum[BW_COUPLER__BOOK_SUMS];
  double last[BW_COUPLER__BOOK_SUMS]; /* of the window before, of all ranks */
  int strikes[2];                     /* windows in a row that look wrong: the book, the swing */
} bw_coupler__window;
typedef struct {
  bw_coupler__window window[BW_COUPLER__WINDOWS];
  double *X;                     /* (n,3) positions at the beginning of the step [L] */
  double *V, *change;            /* (n,3) velocities after the last step, their last change [L/T] */
  double missed, received, load; /* of the step: book.c */
  int64_t steps;                 /* booked */
} bw_coupler__book;

enum { BW_COUPLER__CHOICE = 6 }; /* numbers of a choice (stability.c) */

/* A copy of everything a run needs to go on: fields with halos, particle rows. */
typedef struct {
  bool filled;
  double fluid_numbers[2]; /* time, gradient of the forcing */
  bw_real *field[4];       /* u, v, w, p; NULL where the fluid has none */
  double *rows;            /* (n, bw_solid_restart_row) of bw_solid_get_restart */
  double sums[BW_SOLID_RESTART_SUMS], work[BW_COUPLER__WORKS]; /* of all ranks */
  uint8_t *bits;                                               /* (n, bits_bytes) */
  double *V_before, *F, *M;                                    /* (n,3) */
  double *felt, *lag;                                          /* (n,3); NULL: no predictor */
  double *bodies;                                              /* joined.c; NULL: none */
  double *edge, *carried; /* (n) of films: pressure at edges, volume brought; NULL: no films */
  double choice[BW_COUPLER__CHOICE];
} bw_coupler__state;

/* Surface particles that share a marker. A block's members are sent to one rank, which hands the
 * marker over; that rank follows from the block alone, and members are summed in the order of their
 * ids, so that markers do not depend on the number of ranks. */
typedef struct {
  bw_exchange *plan;       /* members to the ranks of their markers */
  size_t n_members, n;     /* received members, markers */
  int32_t *order, *marker; /* (n_members) rising by block and id; which marker is whose */
  double *send, *receive;  /* (n_surface,12), (n_members,12) */
  double *X, *V, *M, *dV, *area, *force; /* (n,3), area and dV (n) */
  double *out, *N;   /* (n,3) normal of all members; of those whose marker knows it, or NaN */
  int *body;         /* (n) or -1 */
  size_t n_surface;  /* surface the plan is for */
  int64_t events;    /* broken bonds then, bw_solid_events */
  int32_t *particle; /* (particles) and its members */
  uint16_t *broken;  /* (particles) broken bonds of each */
  int8_t *face;      /* (particles) 2 axis + side of the reference normal, or -1 */
  int64_t *block;    /* (particles) reference site over k, packed */
} bw_coupler__blocks;

/* Iterated coupling (iterate.c): state at the beginning of the step, positions then (n,3);
 * velocity with which the solid answers (n,3), load of the try before (n,3), the fluid's velocity
 * inside at the beginning (n,3); guess of the markers' and its residual (n_surface,3); what earlier
 * tries of the step taught, (n_surface,3) a column. */
enum { BW_COUPLER__COLUMNS = 30 };
enum { BW_COUPLER__START = 100 }; /* steps in which every flow slips */
#define BW_COUPLER__THETA 0.8     /* of the displacement; ringing: -2/3 */
typedef struct {
  bw_coupler__state start;
  double *X, *answer, *load, *inside, *guess, *residual;
  int columns, room; /* used, and how many there may be */
  double *q[BW_COUPLER__COLUMNS], *d[BW_COUPLER__COLUMNS];
} bw_coupler__iteration;

/* What holds, and what was chosen by it (stability.c). */
typedef struct {
  bool open, made, told;  /* left to us; found; said */
  double dt, broken;      /* of then: step, broken ends of bonds */
  bw_coupler_limit limit; /* found */
} bw_coupler__choice;

/* Where probes begin, one or several for a surface point (probes.c). */
typedef struct {
  size_t n, room;
  int32_t *point;           /* (n) which surface point */
  double *X, *N, *A;        /* (n,3), (n,3), (n) */
  double *H;                /* (n) from the particle's centre to X along N [L] */
  double *V, *spin, *accel; /* (n,3) each */
  double *traction;         /* (n,3) */
  unsigned char *flag;      /* (n) bw_probe_flag */
  unsigned char *part;      /* (n) which part of the traction bears: bw_coupler__part */
  double *moment;           /* (n_surface,3) of their forces about the particles [M L^2/T^2] */
} bw_coupler__probes;

struct bw_coupler {
  bw_coupler_config config;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_pd_interface *interface;
  bw_ibm_mdf *ibm;
  bw_ibm_mdf *inside_fluid; /* reads the fluid where the particles are; NULL: nobody does */
  bw_probe *probe;
  struct bw_coupler__solid_films *films; /* NULL: none */
  bool held;
  size_t n;         /* particles of this rank */
  int64_t *id;      /* (n) theirs */
  int64_t revision; /* of the solid that the arrays below are for */
  double h;         /* grid spacing [L] */
  double *F; /* (n,3) load on particles during a step, else what it takes over [M/(L^2 T^2)] */
  /* (n,3) load of the last step [M/(L^2 T^2)]; by how much the particles are ahead of what the
   * fluid was told [L]; NULL: no predictor */
  double *felt, *lag;
  double *M;               /* (n,3) memory of the particles' markers [L^4/T^2] */
  uint16_t *broken;        /* (n) broken bonds of each particle ... */
  int64_t events;          /* ... when the solid had counted so many */
  double *V, *V_before;    /* (n,3) velocity now, or what the markers are told; the step before */
  int *body, n_bodies;     /* (n) which body each particle belongs to */
  size_t n_surface;        /* surface particles inside the box: rows used of the arrays below */
  int32_t *particle, *row; /* which particle each is; which row of the interface's surface */
  double *marker_X, *marker_V, *marker_dV; /* (n,3), (n,3), (n) */
  double *marker_M; /* (n,3) memory of the surface points [L^4/T^2]; NaN: they have none */
  double *root, *normal, *area; /* nominal surface (n,3), normals (n,3), areas (n) */
  double *height;               /* (n) of the surface above its particles' centres [L] */
  double *side;                 /* (n,3) normals that markers know; NaN: they are retracted */
  int *closed;                  /* (n) body of the surface points */
  bool on_surface;              /* markers know their normals and stand on the surface */
  double *force;                /* (n,3) of the surface points */
  double *load;                 /* (n,3) of c->force, on the particles [M L/T^2] */
  double *flow;                 /* (n,3) the same without the couples of their moments */
  double *moment;               /* (n,3) of the interface's rows [M L^2/T^2] */
  double *turn;                 /* (n,3) spin of the interface's rows */
  double *scratch[3];           /* (n,3) each, free between calls */
  bw_coupler__probes probes;
  double force_probe[3]; /* of this rank, last probes */
  bw_real *p_mean;       /* field: pressure that acted over the last step (ns_channel's p/rho) */
  bool p_mean_known;     /* false before the first step, after a load, after an unwatched step */
  bool watched, stepped; /* bw_coupler_watch; has there been a step since create or load */
  int reach[3][2];       /* local cells that probes can read, where p_mean is kept */
  bw_real *inside;       /* field: 1 in cells that hold a particle */
  double *X;             /* (n,3) positions, scratch */
  /* `inside` was computed for these n_inside surface particles and roots (n,3) */
  int32_t *particle_inside;
  double *root_inside;
  size_t n_inside;
  bool inside_known, markers_moved;
  bool motion_known; /* turn and V are those of the solid's present velocities */
  double checked_dt; /* step for which the present flow was found stable */
  bw_timer *timer;
  double bonds; /* intact ends of this rank at the start: work of one force evaluation */
  int block;    /* particles of a face along each side that share a marker; 1: no blocks */
  bw_coupler__blocks blocks;
  bool open[3][2], has_outflow; /* outflow sides */
  bool *gone;                   /* (n) scratch: particles beyond an outflow */
  uint8_t *stays;               /* (particles and copies) scratch: not gone */
  bw_pd_link *link;             /* (family) scratch */
  bw_coupler__work work;
  bw_coupler__book book;
  bw_coupler_rigid *floats; /* rigid bodies in the same flow, borrowed; NULL: none */
  bw_coupler__touch *touch; /* contact with them; NULL: none */
  bw_coupler__state kept;
  bw_coupler__state predicted; /* the solid at the beginning of the step (predictor.c) */
  bw_coupler__iteration iteration;
  int iterations;
  double residual;
  int64_t unconverged;
  int64_t steps;       /* since create; a restart begins behind the start */
  size_t handed;       /* markers that this rank has handed over */
  int slip_above;      /* reports in a row with much slip; -1: it was said */
  double slip_last[2]; /* slip and leak of the last of them, over the largest speed so far */
  double speed;        /* by which the last measurement divides [L/T] */
  double speed_most;   /* the largest of those since create */
  bool load_told;      /* bw_coupler_warn_load has looked */
  bw_coupler__choice choice;
};

/* Everything with a row per particle anew, after the set of particles changed. Collective. */
bw_status bw_coupler__renew(bw_coupler *c) BW_MUST_CHECK;
/* Surface, markers, probe points to where the solid is now. Collective. */
bw_status bw_coupler__follow_surface(bw_coupler *c) BW_MUST_CHECK;
/* The memory of the markers to the particles, at the end of a step. Collective. */
void bw_coupler__remember(bw_coupler *c);
/* Velocities c->V and spins c->turn of the solid as it moves now; computed once for each motion.
 * Collective. */
void bw_coupler__know_motion(bw_coupler *c);
/* Velocity (n_surface,3) of the surface's markers then. Collective. */
void bw_coupler__marker_velocity(bw_coupler *c, double V[]);
/* Sets c->V of the surface particles to what makes the markers move at V (n_surface,3). Collective.
 */
void bw_coupler__tell_surface(bw_coupler *c, const double V[]);
/* Hand the markers over if the surface has moved. At the beginning of a step, so that the forces
 * of the last one can be asked for until then. Collective. */
bw_status bw_coupler__place_markers(bw_coupler *c) BW_MUST_CHECK;
/* moment = out N x force. Pure. */
void bw_coupler__moment(double out, const double N[3], const double force[3], double moment[3]);
/* Room for the probes of the present set of particles. Local. */
bw_status bw_coupler__probes_create(bw_coupler *c);
void bw_coupler__probes_release(bw_coupler *c);
/* Force of the fluid on each surface particle, c->force (n_surface,3) [M L/T^2], by probes (dt:
 * the step whose velocities give the acceleration) or by the markers' reaction. Collective. */
bw_status bw_coupler__probe_force(bw_coupler *c, double dt) BW_MUST_CHECK;
/* Does a point meet the fluid: is it inside all sides that are not periodic? */
bool bw_coupler__within_box(const bw_grid_view *g, const double x[3]);
/* What probes must not end in, if that has changed. Collective. */
bw_status bw_coupler__find_obstacles(bw_coupler *c) BW_MUST_CHECK;
/* The pressure that probes read: over rho, with valid halos. */
const bw_real *bw_coupler__read_pressure(const bw_coupler *c);
/* Will probes read the pressure of this step? */
bool bw_coupler__probes_look(const bw_coupler *c);
void bw_coupler__find_reach(bw_coupler *c); /* Collective */
void bw_coupler__reaction_force(bw_coupler *c);
/* The largest speed that drives the fluid (measure.c). Collective. */
double bw_coupler__reference_speed(bw_coupler *c);
/* Work of the fluid through the markers over a step of dt; c->force holds the reaction. Local. */
void bw_coupler__count_work(bw_coupler *c, double dt);

/* Free bodies (bodies.c): walls and arrays; the solid's force from c->F and gravity (local); retire
 * what left; mass inside, out, left. */
bw_status bw_coupler__bodies_create(bw_coupler *c) BW_MUST_CHECK;
/* Numbers the bodies: c->body. Collective. */
bw_status bw_coupler__bodies_number(bw_coupler *c) BW_MUST_CHECK;
void bw_coupler__bodies_release(bw_coupler *c);
void bw_coupler__push_solid(bw_coupler *c);
double bw_coupler__wetted(bw_coupler *c); /* volume of this rank's particles in the box [L^3] */
bw_status bw_coupler__let_go(bw_coupler *c) BW_MUST_CHECK;
void bw_coupler__count_mass(bw_coupler *c, double mass[3]);

/* Blocks: tables of the reference shape (after the first surface is known); markers of the present
 * surface; the reaction of the markers, minus rho Q dV, to c->force in shares of area. */
bw_status bw_coupler__blocks_create(bw_coupler *c) BW_MUST_CHECK;
bw_status bw_coupler__blocks_follow(bw_coupler *c) BW_MUST_CHECK;
void bw_coupler__blocks_reaction(bw_coupler *c);
/* Memory of the blocks, from c->marker_M of their members and back to it, in shares of area.
 * Collective. */
void bw_coupler__blocks_gather_memory(bw_coupler *c);
/* Velocity of the fluid at each member's marker, out (n_surface,3). Collective. */
void bw_coupler__blocks_velocity(bw_coupler *c, double out[]);
void bw_coupler__blocks_memory(bw_coupler *c);
void bw_coupler__blocks_release(bw_coupler__blocks *b);

/* c->force, of the surface points or of their markers, to the particles, c->load (Collective);
 * that, relaxed, to their force density F (Local). */
void bw_coupler__carry_force(bw_coupler *c, bool marker);
void bw_coupler__relax_load(bw_coupler *c, double dt, double relaxation);
void bw_coupler__state_release(bw_coupler__state *s);
bw_status bw_coupler__state_create(const bw_coupler *c,
                                   bw_coupler__state *s) BW_MUST_CHECK; /* Local */
void bw_coupler__state_capture(const bw_coupler *c, bw_coupler__state *s);
/* The same of the solid, what is joined to it, and its load alone. Local; Collective. */
bw_status bw_coupler__state_create_solid(const bw_coupler *c, bw_coupler__state *s) BW_MUST_CHECK;
void bw_coupler__state_capture_solid(const bw_coupler *c, bw_coupler__state *s);
bw_status bw_coupler__state_restore_solid(bw_coupler *c, const bw_coupler__state *s) BW_MUST_CHECK;
/* Fluid and solid as they were; surface and markers stay. Collective. */
bw_status bw_coupler__state_restore(bw_coupler *c, const bw_coupler__state *s) BW_MUST_CHECK;

/* Phases of a step, and the step that repeats them (step.c, iterate.c). Collective. */
bw_status bw_coupler__advance_fluid(bw_coupler *c, double dt) BW_MUST_CHECK;
bw_status bw_coupler__load_solid(bw_coupler *c, double dt, double relaxation) BW_MUST_CHECK;
bw_status bw_coupler__advance_solid(bw_coupler *c, double dt, double relaxation) BW_MUST_CHECK;
#define BW_COUPLER__CATCH_UP 0.2 /* of the lag, in a step */
/* predictor.c: room for it (Local); with one, the markers of the step to come move as the solid
 * would under the load that it felt last (Collective). */
bw_status bw_coupler__predictor_create(bw_coupler *c) BW_MUST_CHECK;
bw_status bw_coupler__predict(bw_coupler *c, double dt) BW_MUST_CHECK;
/* virtual_mass.c: the drag of the step to come, after V_before is known; what is carried over to
 * the next load after it. Local. */
bw_status bw_coupler__resist(bw_coupler *c, double dt, double relaxation) BW_MUST_CHECK;
void bw_coupler__carry_over(bw_coupler *c, double dt, double relaxation);

/* The book (book.c): at the beginning of a step; after the solid has moved under c->F, before what
 * is carried over replaces it (both local); at the end of the step, BW_EDIVERGED when it is no
 * physics any more (Collective). */
void bw_coupler__book_open(bw_coupler *c);
void bw_coupler__book_motion(bw_coupler *c, double dt);
bw_status bw_coupler__book_close(bw_coupler *c) BW_MUST_CHECK;
/* The status of a step that failed, `cause`; its message names the coupling where the book says so.
 * Collective. */
bw_status bw_coupler__book_explain(bw_coupler *c, bw_status cause) BW_MUST_CHECK;
/* Of an iterated step loaded by the reaction: takes the inertia of the fluid inside out of c->load.
 * Collective. */
void bw_coupler__free_inside(bw_coupler *c, double dt);
bw_status bw_coupler__iterate(bw_coupler *c, double dt) BW_MUST_CHECK;
bw_status bw_coupler__iteration_create(bw_coupler *c) BW_MUST_CHECK; /* Local */
void bw_coupler__iteration_release(bw_coupler *c);

/* Stability (stability.c, relaxation.c). Does the recurrence of b_{k+1} = y_k, or with a predictor
 * what that makes of it, and y_k = (1 - w) y_{k-1} - w sum_q lambda_q b_{k-q} decay? The largest
 * relaxation below which it does, with a virtual mass of w mu times what resists. Pure. */
#define BW_COUPLER__MARGIN 0.5                /* of the limit, which is taken ... */
double bw_coupler__most(const bw_coupler *c); /* ... up to this */
bool bw_coupler__relaxation_holds(int n, const double lambda[], double w, bool predictor);
double bw_coupler__relaxation_limit(int n, const double lambda[], double mu, bool predictor);
/* Before an explicit step of dt: finds what holds where that is asked for and not known, and sets
 * what was left open. Collective. */
bw_status bw_coupler__choose(bw_coupler *c, double dt) BW_MUST_CHECK;
/* The choice as numbers; the way back, of a checkpoint. Local. */
void bw_coupler__get_choice(const bw_coupler *c, double choice[BW_COUPLER__CHOICE]);
void bw_coupler__adopt_choice(bw_coupler *c, const double choice[BW_COUPLER__CHOICE]);
