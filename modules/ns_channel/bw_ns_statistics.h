/* bw_ns_statistics.h -- means over x, z and time of a flow between walls in y, while it runs.
 *
 * Sampled where the scheme has its numbers, nothing is interpolated that the scheme does not
 * interpolate itself: u, w, p at the heights y_centre[j], j = 1..n1 ("centres"); v at y_face[j],
 * j = 0..n1 ("faces"); products of two components and vorticities on the edge that both touch,
 * so that u v is the scheme's own momentum flux and
 *   nu dU/dy - <u'v'> = tau_w (1 - 2 y/H)
 * holds to round-off for a flow that is steady in the mean, whatever the grid, with the stress of
 * an eddy viscosity added where there is one (the budget of k knows none of it). p is taken
 * relative to its mean over the box at that instant (its constant means nothing).
 * Confidence: samples go to at most BW_NS_BATCHES batches in time; when all are full, neighbours
 * are joined. Batch means, 95 %: Student's t times their standard error; valid when a batch is
 * longer than the memory of the flow (some h/U_b in channel turbulence).
 * Rows are global: arrays of n1 + 1, row 0 of centres unused. All ranks hold the same sums.
 * Life: create -> { sample } -> profile -> destroy. Nothing is allocated in sample. */
#pragma once
#include "bw_ns_channel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sums over samples, in batches. Opaque. */
typedef struct bw_ns_statistics bw_ns_statistics;

/* Sizes. */
enum {
  BW_NS_BATCHES = 16 /* at most; 8 to 16 are full: few enough to be long, enough for Student's t */
};

/* Raw moments: plane and time means of products of the whole velocity u, v, w, the pressure p over
 * the density and the vorticity o = curl u. Up to GRADIENTS at centres, from V on at faces. */
typedef enum {
  BW_NS_MOMENT_U,              /* <u> [L/T] */
  BW_NS_MOMENT_UU,             /* <u^2> [L^2/T^2] */
  BW_NS_MOMENT_UUU,            /* <u^3> [L^3/T^3] */
  BW_NS_MOMENT_UUUU,           /* <u^4> [L^4/T^4] */
  BW_NS_MOMENT_W,              /* <w> */
  BW_NS_MOMENT_WW,             /* <w^2> */
  BW_NS_MOMENT_WWW,            /* <w^3> */
  BW_NS_MOMENT_WWWW,           /* <w^4> */
  BW_NS_MOMENT_P,              /* <p> [L^2/T^2], relative to the mean over the box */
  BW_NS_MOMENT_PP,             /* <p^2> */
  BW_NS_MOMENT_UW,             /* <u w>, on the edges that both touch */
  BW_NS_MOMENT_OY,             /* <o_y> [1/T] */
  BW_NS_MOMENT_OYOY,           /* <o_y^2> */
  BW_NS_MOMENT_GRADIENTS,      /* sum of the squares of u_x, v_y, w_z, u_z, w_x [1/T^2] */
  BW_NS_MOMENT_V,              /* <v>; the first at faces */
  BW_NS_MOMENT_VV,             /* <v^2> */
  BW_NS_MOMENT_VVV,            /* <v^3> */
  BW_NS_MOMENT_VVVV,           /* <v^4> */
  BW_NS_MOMENT_UV,             /* <u v>: the scheme's own flux */
  BW_NS_MOMENT_VW,             /* <v w>: the scheme's own flux */
  BW_NS_MOMENT_OX,             /* <o_x> */
  BW_NS_MOMENT_OXOX,           /* <o_x^2> */
  BW_NS_MOMENT_OZ,             /* <o_z> */
  BW_NS_MOMENT_OZOZ,           /* <o_z^2> */
  BW_NS_MOMENT_FACE_GRADIENTS, /* sum of the squares of u_y, v_x, v_z, w_y */
  BW_NS_MOMENT_VUU,            /* <v u u>, from the flux u v and the mean of u across it */
  BW_NS_MOMENT_VWW,            /* <v w w>, likewise */
  BW_NS_MOMENT_PV,             /* <p v> */
  BW_NS_MOMENT_EDDY,           /* <nu_t (u_y + v_x)>, stress of an eddy viscosity; 0 without one */
  BW_NS_MOMENTS                /* how many there are */
} bw_ns_moment;

/* What is made of them, capitals being means and primes fluctuations; stresses, p and nu dU/dy are
 * over the density. Up to VISCOUS_DIFFUSION at centres, from V on at faces. The budget is that of
 * k = <u_i'u_i'>/2; its terms add up to dk/dt. */
typedef enum {
  BW_NS_PROFILE_U,           /* U [L/T] */
  BW_NS_PROFILE_W,           /* W [L/T] */
  BW_NS_PROFILE_P,           /* P [L^2/T^2] */
  BW_NS_PROFILE_U_RMS,       /* root mean square of u' [L/T] */
  BW_NS_PROFILE_W_RMS,       /* of w' [L/T] */
  BW_NS_PROFILE_P_RMS,       /* of p' [L^2/T^2] */
  BW_NS_PROFILE_UW,          /* <u'w'> [L^2/T^2] */
  BW_NS_PROFILE_OY_RMS,      /* of o_y' [1/T] */
  BW_NS_PROFILE_U_SKEWNESS,  /* <u'^3>/<u'^2>^1.5 [-] */
  BW_NS_PROFILE_U_FLATNESS,  /* <u'^4>/<u'^2>^2 [-] */
  BW_NS_PROFILE_W_SKEWNESS,  /* of w' [-] */
  BW_NS_PROFILE_W_FLATNESS,  /* of w' [-] */
  BW_NS_PROFILE_K,           /* k [L^2/T^2] */
  BW_NS_PROFILE_PRODUCTION,  /* -<u'v'> dU/dy - <v'w'> dW/dy [L^2/T^3], as all of the budget */
  BW_NS_PROFILE_DISSIPATION, /* -nu <(du_i'/dx_j)^2>, negative */
  BW_NS_PROFILE_TURBULENT_TRANSPORT, /* -d<v' u_i'u_i'>/dy /2 */
  BW_NS_PROFILE_PRESSURE_TRANSPORT,  /* -d<p'v'>/dy */
  BW_NS_PROFILE_VISCOUS_DIFFUSION,   /* nu d2k/dy2 */
  BW_NS_PROFILE_V,                   /* V [L/T]; the first at faces */
  BW_NS_PROFILE_V_RMS,               /* of v' [L/T] */
  BW_NS_PROFILE_UV,                  /* <u'v'> [L^2/T^2] */
  BW_NS_PROFILE_VW,                  /* <v'w'> [L^2/T^2] */
  BW_NS_PROFILE_OX_RMS,              /* of o_x' [1/T] */
  BW_NS_PROFILE_OZ_RMS,              /* of o_z' [1/T] */
  BW_NS_PROFILE_V_SKEWNESS,          /* of v' [-] */
  BW_NS_PROFILE_V_FLATNESS,          /* of v' [-] */
  BW_NS_PROFILE_SHEAR,               /* nu dU/dy [L^2/T^2]; row 0: tau_w/rho of the lower wall */
  BW_NS_PROFILE_EDDY,                /* <nu_t (u_y + v_x)> [L^2/T^2] */
  BW_NS_PROFILE_TOTAL,               /* nu dU/dy - <u'v'> + <nu_t (u_y + v_x)> [L^2/T^2] */
  BW_NS_PROFILES                     /* how many there are */
} bw_ns_profile_kind;

/* A value and how sure it is. */
typedef struct {
  double mean;     /* from all samples; NaN for 0/0 (skewness at a wall) */
  double interval; /* 95 % half width; NaN with fewer than two full batches */
} bw_ns_estimate;

/* `ns` is borrowed until destroy. BW_EINPUT unless x and z are periodic; BW_EMEM. Collective. */
bw_status bw_ns_statistics_create(bw_ns_channel *ns, bw_ns_statistics **out) BW_MUST_CHECK;
/* Releases everything and sets *s to NULL; NULL is fine. Local. */
void bw_ns_statistics_destroy(bw_ns_statistics **s);

/* Add the present field, as one of samples of equal weight (equal intervals of time). Costs a
 * third of a sub-step. Collective. */
void bw_ns_statistics_sample(bw_ns_statistics *s);
/* Forget all samples. Local. */
void bw_ns_statistics_reset(bw_ns_statistics *s);

/* Samples taken so far. Local. */
long bw_ns_statistics_samples(const bw_ns_statistics *s);
/* Full batches so far, of which the intervals are made. Local. */
int bw_ns_statistics_batches(const bw_ns_statistics *s);

/* Mean raw moment of all samples in a row; 0 before the first sample. Local. */
double bw_ns_statistics_moment(const bw_ns_statistics *s, bw_ns_moment moment, int row);

/* Is the profile at faces (rows 0 .. n1) or at centres (rows 1 .. n1)? Pure. */
bool bw_ns_profile_on_faces(bw_ns_profile_kind kind);

/* out[n1 + 1]. `fold`: both halves of the channel are averaged (with the sign that the reflection
 * gives each moment), so that out[j] and its mirror image agree. Local. */
void bw_ns_statistics_profile(const bw_ns_statistics *s, bw_ns_profile_kind kind, bool fold,
                              bw_ns_estimate out[]);

/* How many numbers the sums are, for a checkpoint. Local. */
size_t bw_ns_statistics_state_size(const bw_ns_statistics *s);
/* The sums as numbers x[state_size], the same on all ranks and for any number of them. Local. */
void bw_ns_statistics_get_state(const bw_ns_statistics *s, double x[]);
/* Goes on from these numbers, to the last bit. BW_EINPUT when they do not fit this grid. Local. */
bw_status bw_ns_statistics_set_state(bw_ns_statistics *s, const double x[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
