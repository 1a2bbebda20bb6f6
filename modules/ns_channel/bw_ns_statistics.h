/* bw_ns_statistics.h -- means over x, z and time of a flow between walls in y, while it runs.
 *
 * Sampled where the scheme has its numbers, nothing is interpolated that the scheme does not
 * interpolate itself: u, w, p at the heights y_centre[j], j = 1..n1 ("centres"); v at y_face[j],
 * j = 0..n1 ("faces"); products of two components and vorticities on the edge that both touch,
 * so that u v is the scheme's own momentum flux and
 *   nu dU/dy - <u'v'> = tau_w (1 - 2 y/H)
 * holds to round-off for a flow that is steady in the mean, whatever the grid. p is taken
 * relative to its mean over the box at that instant (its constant means nothing).
 * Confidence: samples go to at most BW_NS_BATCHES batches in time; when all are full, neighbours
 * are joined. Batch means, 95 %: Student's t times their standard error; valid when a batch is
 * longer than the memory of the flow (some h/U_b in channel turbulence).
 * Rows are global: arrays of n1 + 1, row 0 of centres unused. All ranks hold the same sums.
 * Life: create -> { sample } -> profile -> destroy. Nothing is allocated in sample. */
#pragma once
#include "bw_ns_channel.h"

typedef struct bw_ns_statistics bw_ns_statistics;

enum { BW_NS_BATCHES = 16 }; /* 8 to 16 of them full: few enough to be long, enough for t */

/* Raw moments: plane and time means. Vorticity o = curl u. */
typedef enum {
  BW_NS_MOMENT_U, /* centres */
  BW_NS_MOMENT_UU,
  BW_NS_MOMENT_UUU,
  BW_NS_MOMENT_UUUU,
  BW_NS_MOMENT_W,
  BW_NS_MOMENT_WW,
  BW_NS_MOMENT_WWW,
  BW_NS_MOMENT_WWWW,
  BW_NS_MOMENT_P,
  BW_NS_MOMENT_PP,
  BW_NS_MOMENT_UW,
  BW_NS_MOMENT_OY,
  BW_NS_MOMENT_OYOY,
  BW_NS_MOMENT_GRADIENTS, /* sum of the squares of u_x, v_y, w_z, u_z, w_x */
  BW_NS_MOMENT_V,         /* faces */
  BW_NS_MOMENT_VV,
  BW_NS_MOMENT_VVV,
  BW_NS_MOMENT_VVVV,
  BW_NS_MOMENT_UV,
  BW_NS_MOMENT_VW,
  BW_NS_MOMENT_OX,
  BW_NS_MOMENT_OXOX,
  BW_NS_MOMENT_OZ,
  BW_NS_MOMENT_OZOZ,
  BW_NS_MOMENT_FACE_GRADIENTS, /* of u_y, v_x, v_z, w_y */
  BW_NS_MOMENT_VUU,
  BW_NS_MOMENT_VWW,
  BW_NS_MOMENT_PV,
  BW_NS_MOMENTS
} bw_ns_moment;

/* What is made of them; p, nu dU/dy and stresses over the density. */
typedef enum {
  BW_NS_PROFILE_U, /* centres: means, rms of fluctuations, <u'w'>, skewness, flatness */
  BW_NS_PROFILE_W,
  BW_NS_PROFILE_P,
  BW_NS_PROFILE_U_RMS,
  BW_NS_PROFILE_W_RMS,
  BW_NS_PROFILE_P_RMS,
  BW_NS_PROFILE_UW,
  BW_NS_PROFILE_OY_RMS,
  BW_NS_PROFILE_U_SKEWNESS,
  BW_NS_PROFILE_U_FLATNESS,
  BW_NS_PROFILE_W_SKEWNESS,
  BW_NS_PROFILE_W_FLATNESS,
  BW_NS_PROFILE_K, /* centres: k = <u_i'u_i'>/2 and its budget, whose terms add up to dk/dt */
  BW_NS_PROFILE_PRODUCTION,          /* -<u'v'> dU/dy - <v'w'> dW/dy */
  BW_NS_PROFILE_DISSIPATION,         /* -nu <(du_i'/dx_j)^2>, negative */
  BW_NS_PROFILE_TURBULENT_TRANSPORT, /* -d<v' u_i'u_i'>/dy /2 */
  BW_NS_PROFILE_PRESSURE_TRANSPORT,  /* -d<p'v'>/dy */
  BW_NS_PROFILE_VISCOUS_DIFFUSION,   /* nu d2k/dy2 */
  BW_NS_PROFILE_V,                   /* faces */
  BW_NS_PROFILE_V_RMS,
  BW_NS_PROFILE_UV,
  BW_NS_PROFILE_VW,
  BW_NS_PROFILE_OX_RMS,
  BW_NS_PROFILE_OZ_RMS,
  BW_NS_PROFILE_V_SKEWNESS,
  BW_NS_PROFILE_V_FLATNESS,
  BW_NS_PROFILE_SHEAR, /* nu dU/dy; row 0: tau_w/rho of the lower wall */
  BW_NS_PROFILE_TOTAL, /* nu dU/dy - <u'v'> */
  BW_NS_PROFILES
} bw_ns_profile_kind;

typedef struct {
  double mean;     /* from all samples; NaN for 0/0 (skewness at a wall) */
  double interval; /* 95 % half width; NaN with fewer than two full batches */
} bw_ns_estimate;

/* `ns` is borrowed until destroy. BW_EINPUT unless x and z are periodic. Collective. */
bw_status bw_ns_statistics_create(bw_ns_channel *ns, bw_ns_statistics **out) BW_MUST_CHECK;
void bw_ns_statistics_destroy(bw_ns_statistics **s); /* NULL is fine. Local. */

/* Add the present field, as one of samples of equal weight (equal intervals of time). Costs a
 * third of a sub-step. Collective. */
void bw_ns_statistics_sample(bw_ns_statistics *s);
void bw_ns_statistics_reset(bw_ns_statistics *s); /* Forget all samples. Local. */

long bw_ns_statistics_samples(const bw_ns_statistics *s); /* Local. */
int bw_ns_statistics_batches(const bw_ns_statistics *s);  /* full ones. Local. */

/* Mean raw moment of all samples in a row; 0 before the first sample. Local. */
double bw_ns_statistics_moment(const bw_ns_statistics *s, bw_ns_moment moment, int row);

bool bw_ns_profile_on_faces(bw_ns_profile_kind kind); /* Local. */

/* out[n1 + 1]. `fold`: both halves of the channel are averaged (with the sign that the reflection
 * gives each moment), so that out[j] and its mirror image agree. Local. */
void bw_ns_statistics_profile(const bw_ns_statistics *s, bw_ns_profile_kind kind, bool fold,
                              bw_ns_estimate out[]);

/* The sums as numbers, the same on all ranks and independent of how many these are, for a
 * checkpoint; a restart goes on to the last bit. x[state_size]. BW_EINPUT when x does not fit this
 * grid. Local. */
size_t bw_ns_statistics_state_size(const bw_ns_statistics *s);
void bw_ns_statistics_get_state(const bw_ns_statistics *s, double x[]);
bw_status bw_ns_statistics_set_state(bw_ns_statistics *s, const double x[]) BW_MUST_CHECK;
