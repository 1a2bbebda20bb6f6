/* ns_channel_internal.h -- shared by the sources of ns_channel only. */
#pragma once
#include "bw_ns_channel.h"
#include "bw_poisson.h"

enum { BW_NS_STAGES = 3 };
enum { BW_NS_LANES = 16 }; /* lines along x that are solved side by side */

#define BW_NS_INLINE static inline __attribute__((always_inline))

/* Geometry as kernels want it: reciprocals, indexed by local j (valid 1-2 .. m1+2). */
typedef struct {
  bw_real rdx, rdz;
  bw_real *rdyf;          /* 1/height of cell j                                       [1/L] */
  bw_real *rdyc;          /* 1/(y_centre[j+1] - y_centre[j]), at face j               [1/L] */
  bw_real *below, *above; /* shares of cells j, j+1 in the v-cell at face j [-]: what carries
                             momentum through its x and z faces */
  double *dyf, *dyc;      /* the heights themselves [L] */
  double *heights;        /* what to release */
  bw_real *reals;
} bw_ns_metrics;

/* What the momentum kernels work on. Rows and planes of fluxes stay in cache. */
typedef struct {
  const bw_grid_view *g;
  const bw_ns_metrics *metrics;
  bw_real *const *u, *const *R;
  bw_real *const *change; /* implicit: takes the change of u, which stays; else u */
  const bw_real *p;
  bw_real *fx[4];        /* rows 0..n0: x fluxes of u, v, w; the new y flux of w */
  bw_real *fy[3];        /* [k][i]: y flux below the row that is next, per plane */
  bw_real *fz[3];        /* [j in tile][i]: z flux below the plane that is next */
  bw_real *dy[3];        /* implicit in y: like fy, the difference quotients */
  int tile;              /* rows in y per tile */
  bw_real nu;            /* 0 where all of the viscous term is implicit */
  bw_ns_viscous viscous; /* implicit in y: a part of that here with weight kappa */
  bw_real alpha_dt, beta_dt, gamma_dt, kappa; /* kappa = old dt nu */
  bw_real source[3];                          /* dt gamma g along x, y, z */
} bw_ns_sweep;

/* Boundary planes of one side: normal velocity on the face, Dirichlet values of the others.
 * [b][a] over the two tangential directions, halos included. */
typedef struct {
  bool here;             /* does this rank touch the side (and is there one)? */
  bw_real *value[3];     /* NULL: constant */
  int extent[2], low[2]; /* indices low .. low+extent-1 in the tangential directions */
} bw_ns_plane;

/* Visit a layer of a side: value[b][a] of the plane, field[base + a step0 + b step1]. */
typedef struct {
  const bw_ns_plane *p;
  ptrdiff_t base, step0, step1;
} bw_ns_walk;

typedef struct bw_ns_lines bw_ns_lines; /* ns_lines.c */

/* Momentum balance of a box, see bw_ns_channel_control_volume. */
typedef struct {
  bool on, known; /* known: `momentum` is that of the present field */
  int lo[3], hi[3];
  double momentum[3]; /* this rank's share, at the end of the last step */
  double flux[3];     /* N of the last sub-step, this rank's share */
  double impulse[3];  /* of all fluxes and forces over the step, this rank's share */
  double force[3];    /* of the last step, this rank's share */
} bw_ns_box;

/* Eddies that no cell resolves (ns_eddy.c); all NULL without a model. */
typedef struct {
  bw_real *nu, *force[3]; /* at centres; on faces, of the present sub-step */
  double rate;            /* this rank's largest 4 nu_t sum 1/dx_i^2 [1/T] */
} bw_ns_eddies;

/* Volume that enters in some cells of this rank, in any order (ns_source.c). */
typedef struct {
  size_t n, room;
  ptrdiff_t *cell; /* (room) */
  double *rate;    /* (room) [1/T] */
} bw_ns_sources;

struct bw_ns_channel {
  bw_grid *grid; /* borrowed */
  const bw_grid_view *g;
  const bw_comm *comm;
  bw_poisson *poisson;
  bw_ns_channel_config config;
  bw_ns_metrics metrics;
  int components; /* 2 or 3 */
  bw_real *u[3], *p, *phi, *R[3], *scratch;
  size_t scratch_size;
  bw_ns_sweep sweep;
  bw_ns_plane plane[3][2];
  double outflow_area;   /* of all outflow sides; 0: there is none */
  bw_ns_lines *lines[3]; /* of the directions with an implicit viscous term */
  bw_real *increment[3]; /* implicit: u* - u; the first is phi, free until the projection */
  bw_real *lanes;        /* (n0, BW_NS_LANES) */
  double time;
  double gradient; /* flow rate: gradient the next predict starts from [L/T^2] */
  double applied;  /* mean gradient of the last finished step */
  double applying; /* the same of the step in progress */
  bool impulsive;  /* velocity was just set: its bulk need not be the wanted one */
  bw_ns_eddies eddy;
  bw_ns_sources sources;
  double courant;     /* this rank's largest rate of convection [1/T]; NaN when not finite */
  bool courant_known; /* courant_all is that of the present field */
  double courant_all, eddy_all; /* of all ranks */
  double viscous_rate;          /* largest eigenvalue of the explicit viscous operator [1/T] */
  double damping_step; /* all implicit: longest step that damps short waves [T], else INFINITY */
  bw_ns_box box;
  bw_ns_cost cost;
};

extern const double bw_ns__alpha[BW_NS_STAGES], bw_ns__beta[BW_NS_STAGES],
    bw_ns__gamma[BW_NS_STAGES], bw_ns__end[BW_NS_STAGES]; /* end: time after the sub-step / dt */
/* Implicit terms: weights of the old and the new velocity in a sub-step; their sum is gamma. */
extern const double bw_ns__old[BW_NS_STAGES], bw_ns__new[BW_NS_STAGES];

/* ns_config.c */
bw_status bw_ns__config_check(const bw_grid_view *g, const bw_ns_channel_config *c);

/* ns_momentum.c: u (or the change) <- u + alpha_dt R(u) + beta_dt R_prev - gamma_dt grad p +
 * source, R_prev <- R, in all cells of the rank; boundary-normal faces get values that the caller
 * replaces. Local. */
void bw_ns__momentum_sweep(const bw_ns_sweep *s, int stage);
int bw_ns__momentum_tile(const bw_grid_view *g);
size_t bw_ns__momentum_scratch(const bw_ns_sweep *s); /* reals */
void bw_ns__momentum_place(bw_ns_sweep *s, bw_real *scratch);

/* ns_project.c. Local. */
/* f <- scale div u; returns this rank's sum u dy (per cell of dx = dz = 1) when asked. */
double bw_ns__divergence(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                         double scale, bool sum, bw_real *f);
/* u <- u - scale grad phi (+ shift in x), p <- p + phi; with `courant` (and the faces below the
 * first cells) the largest half of sum (|u_i below| + |u_i above|)/dx_i, NaN when something is not
 * finite (else 0). */
double bw_ns__correct(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3],
                      bw_real *p, const bw_real *phi, double scale, double shift, bool courant);
double bw_ns__courant(const bw_grid_view *g, const bw_ns_metrics *m, bw_real *const u[3]);

/* ns_source.c. f -= scale times the rate of the sources. Local. */
void bw_ns__sources_take(const bw_ns_channel *ns, double scale, bw_real *f);
void bw_ns__sources_destroy(bw_ns_channel *ns);

/* ns_limit.c: what is known of the step before there is a field. Collective. */
void bw_ns__limits_create(bw_ns_channel *ns);

/* ns_boundary.c */
bw_status bw_ns__planes_create(bw_ns_channel *ns);
void bw_ns__planes_destroy(bw_ns_channel *ns);
void bw_ns__faces(bw_ns_channel *ns);           /* planes -> normal velocity on the faces. Local. */
void bw_ns__ghosts_velocity(bw_ns_channel *ns); /* beyond physical boundaries. Local. */
void bw_ns__ghosts_scalar(bw_ns_channel *ns, bw_real *p);
void bw_ns__ghosts_eddy(bw_ns_channel *ns, bw_real *nu); /* odd at walls: zero there */
bw_ns_walk bw_ns__walk(const bw_ns_channel *ns, int d, int s, int index); /* layer `index` of d */
int bw_ns__face_index(const bw_ns_channel *ns, int d, int s); /* of the side's own face */

/* The two directions along a side normal to d, in order. */
static inline int bw_ns__tangent(int d, int which)
{
  return which == 0 ? (d == 0 ? 1 : 0) : (d == 2 ? 1 : 2);
}

static inline size_t bw_ns__plane_size(const bw_ns_plane *p)
{
  return (size_t)p->extent[0] * (size_t)p->extent[1];
}

/* ns_inflow.c */
bw_status bw_ns__inflow_create(bw_ns_channel *ns); /* steady profiles, areas. Collective. */
double bw_ns__inflow(bw_ns_channel *ns, double t); /* callbacks; net influx. Collective. */
double bw_ns__side_area(const bw_ns_channel *ns, int d, int a,
                        int b);                                 /* of cell (a, b) of a side */
double bw_ns__side_flux(const bw_ns_channel *ns, int d, int s); /* out of the box, local share */

/* ns_outflow.c */
void bw_ns__outflow_capture(bw_ns_channel *ns); /* planes <- field. Local. */
void bw_ns__outflow_advance(bw_ns_channel *ns, double dt, double influx); /* Collective. */
void bw_ns__outflow_balance(bw_ns_channel *ns, double influx);            /* Collective. */

/* ns_box.c. All local; nothing where no box is watched. */
void bw_ns__box_fluxes(bw_ns_channel *ns, int r, double dt, double gradient); /* before the sweep */
void bw_ns__box_diffusion(bw_ns_channel *ns, double weight); /* in y, where it is split */
void bw_ns__box_projection(bw_ns_channel *ns, double gamma_dt, double shift);
void bw_ns__box_finish(bw_ns_channel *ns, double dt);

/* ns_lines.c */
bw_status bw_ns__lines_create(const bw_ns_channel *ns, int d, bw_ns_lines **out); /* Collective. */
void bw_ns__lines_destroy(bw_ns_lines **lines);
/* The operator 1 - kappa D_dd of component c; homogeneous at the sides. Local. */
void bw_ns__lines_set(const bw_ns_channel *ns, int c, double kappa, bw_ns_lines *q);
bool bw_ns__lines_are_divided(const bw_ns_lines *q);   /* over ranks */
double bw_ns__lines_edge(const bw_ns_lines *q, int s); /* what couples the row at side s to it */
/* Not divided: `width` lines side by side, rows `pitch` apart from f on. Local. */
void bw_ns__lines_solve(const bw_ns_lines *q, int width, ptrdiff_t pitch, bw_real *f);
/* Divided: all lines of a field. Collective. */
void bw_ns__lines_solve_divided(const bw_ns_channel *ns, const bw_ns_lines *q, bw_real *u);
/* Ghost of a component along side (d, s) = sign u + G (ns_boundary.c). */
double bw_ns__ghost_sign(const bw_ns_channel *ns, int d, int s);

/* ns_eddy.c. All do nothing without a model; collective: update. */
bw_status bw_ns__eddy_create(bw_ns_channel *ns);
void bw_ns__eddy_destroy(bw_ns_channel *ns);
void bw_ns__eddy_update(bw_ns_channel *ns);                     /* nu_t of the present velocity */
void bw_ns__eddy_force(bw_ns_channel *ns);                      /* before the sweep changes u */
void bw_ns__eddy_add(bw_ns_channel *ns, int r, double dt);      /* ... and after it */
void bw_ns__eddy_stress(const bw_ns_channel *ns, double sum[]); /* over x, z: [0..n1], at faces */

/* ns_implicit.c: u <- (1 - kappa D_yy)^-1 u. Collective. */
void bw_ns__implicit_solve(bw_ns_channel *ns, double kappa);

/* ns_factored.c: u <- u* of sub-step r, from the sweep's change in `increment`; sides have mean
 * values until the faces are set. Collective. */
void bw_ns__factored_solve(bw_ns_channel *ns, int r, double dt);
