/* bw_ns_correlations.h -- two-point correlations and spectra along x and z at chosen heights.
 *
 *   R_aa(r) = <a(x) a(x + r)> - <a>^2,   a = u, v, w at their own points,
 * averaged over the plane and time; r = 0 .. n/2 cells (period n). The spectrum is its cosine
 * transform, exactly the energy of the discrete Fourier modes:
 *   E_m, m = 0 .. n/2, wave number 2 pi m/L, with sum_m E_m = R(0), the variance.
 * A plane is u and w at y_centre[row] and v at y_face[row], row = 1 .. n1.
 * Cost of a sample: direct sums, 3 (n0 + n2)/2 products per point of a plane, planes dealt out over
 * the ranks; all ranks hold the same sums. Life: create -> { sample } -> get -> destroy. */
#pragma once
#include "bw_ns_channel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sums over samples at a number of heights. Opaque. */
typedef struct bw_ns_correlations bw_ns_correlations;

/* `planes` heights at the global rows rows[planes], which are copied. `ns` is borrowed until
 * destroy. BW_EINPUT unless x and z are periodic, the box has three dimensions and rows are
 * 1 .. n1; BW_EMEM. Collective. */
bw_status bw_ns_correlations_create(bw_ns_channel *ns, int planes, const int rows[],
                                    bw_ns_correlations **out) BW_MUST_CHECK;
/* Releases everything and sets *c to NULL; NULL is fine. Local. */
void bw_ns_correlations_destroy(bw_ns_correlations **c);

/* Add the present field with the weight of one sample. Allocates nothing. Collective. */
void bw_ns_correlations_sample(bw_ns_correlations *c);
/* Samples taken so far. Local. */
long bw_ns_correlations_samples(const bw_ns_correlations *c);

/* R of a component (0, 1, 2) along direction 0 or 2 on a plane (index into rows):
 * out[n/2 + 1] [L^2/T^2]; zeros before the first sample. Local. */
void bw_ns_correlations_get(const bw_ns_correlations *c, int plane, int component, int direction,
                            double out[]);
/* E of the same: out[n/2 + 1] [L^2/T^2]; zeros before the first sample. Local. */
void bw_ns_correlations_spectrum(const bw_ns_correlations *c, int plane, int component,
                                 int direction, double out[]);

/* How many numbers the sums are, for a checkpoint. Local. */
size_t bw_ns_correlations_state_size(const bw_ns_correlations *c);
/* The sums as numbers x[state_size], the same on all ranks and for any number of them. Local. */
void bw_ns_correlations_get_state(const bw_ns_correlations *c, double x[]);
/* Goes on from these numbers, to the last bit. BW_EINPUT when planes, rows or cells are others.
 * Local. */
bw_status bw_ns_correlations_set_state(bw_ns_correlations *c, const double x[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
