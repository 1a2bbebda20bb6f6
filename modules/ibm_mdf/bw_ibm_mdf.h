/* bw_ibm_mdf.h -- immersed boundary by multi-direct forcing: no slip at Lagrangian markers.
 *
 * Per call, n_iter times (POROUS 3.79-3.82; ERRATA 17, 18):
 *   U = interpolate(u^);  Q += (V - U)/dt;  u^ = u* + dt spread(Q dV)
 * with the full dt of the step in every sub-step. Interpolation and spreading use the same
 * kernel and are adjoint: sum Q.U dV over markers = sum q.u h^3 over cells, to round-off.
 * Grid     must be uniform (checked, BW_EINPUT) with halo 2; kernels reach two cells.
 * Shapes   marker vectors are row-major (n,3); dV (n).
 * Owns     copies of the markers, sorted by cell, on the rank that owns the cell; their weights.
 * MPI      markers are handed over by whoever has them; the module sends them to their cells. Each
 *          other block whose cells or halo a marker's support reaches holds an image of it, gets
 * its force and spreads it itself: one message per iteration, as long as there are images. */
#pragma once
#include "bw_grid.h"
#include "bw_kernel_delta.h"

typedef struct bw_ibm_mdf bw_ibm_mdf;

typedef struct {
  bw_kernel_delta_id kernel; /*                     default BW_KERNEL_ROMA3 */
  int n_iter;                /* forcing iterations [-], >= 1       default 2 */
} bw_ibm_mdf_config;

bw_ibm_mdf_config bw_ibm_mdf_config_default(void);

/* How far inside the nominal surface the markers of a solid belong, in grid spacings (ERRATA 21).
 * A regularised sheet of force stops the fluid some way outside itself: over a flat sheet on the
 * grid by (1/2) sum_ij phi_i phi_j |i - j| spacings (0.25 to 0.28 for Roma's kernel, 0.375 to 0.39
 * for Peskin's, 0 to 0.25 for the hat), more where slip is left. The values are those at which the
 * drag of a cylinder has no error (validation/ibm_mdf/cylinder_drag). Pure. */
double bw_ibm_mdf_retraction(const bw_ibm_mdf_config *config);

/* `grid` is borrowed. Collective. */
bw_status bw_ibm_mdf_create(bw_grid *grid, const bw_ibm_mdf_config *config,
                            bw_ibm_mdf **out) BW_MUST_CHECK;
void bw_ibm_mdf_destroy(bw_ibm_mdf **ib); /* NULL is fine. Collective. */

/* Replace the marker set: position X [L], velocity V of the boundary [L/T], volume dV [L^3]
 * (surface area per marker times the grid spacing). Copied. Markers outside the box in a
 * direction that is not periodic are left out and counted; what a marker near such a side would
 * spread beyond it is lost. Computes all weights; the force of the step is zero again.
 * How close: any number of markers may share a surface as long as their volumes add up to area
 * times h; more than some 1.5 h (roma3), 2 h (peskin4) or 1 h (hat2) apart the fluid leaks between
 * them (README). The slip goes through I - A per iteration, A = interpolate(spread(. dV)); when the
 * largest eigenvalue of A is above 2 the iteration grows: of the first set that has markers it is
 * measured (8 iterations' cost), those of later sets are taken to be as dense.
 * BW_EINPUT for values that are not finite, negative volumes and iterations that grow, on all
 * ranks. Collective. */
bw_status bw_ibm_mdf_set_markers(bw_ibm_mdf *ib, size_t n, const double X[], const double V[],
                                 const double dV[]) BW_MUST_CHECK;

/* Make the velocity u[3] (fields with valid halos; u[2] may be NULL in 2D) meet V at the markers,
 * in place; halos of u stay valid (their owners' values to round-off), except beyond physical
 * boundaries.
 * Adds to the force of the step. Collective. */
void bw_ibm_mdf_force(bw_ibm_mdf *ib, bw_real *const u[3], double dt);

/* Start a new step: the accumulated force is zero. Local. */
void bw_ibm_mdf_begin_step(bw_ibm_mdf *ib);

/* Sum over the sub-steps since begin_step of Q dV, per marker in the order of set_markers
 * (n,3) [L^4/T^2]: the mean force of the boundary on the fluid over the step, per density
 * (ERRATA 18). Collective. */
void bw_ibm_mdf_marker_force(bw_ibm_mdf *ib, double QdV[]);

/* The two operations by themselves: U (n,3) = interpolated u; u += spread(F dV) for F (n,3).
 * u's halos must be valid; after spreading they are updated. Collective. */
void bw_ibm_mdf_interpolate(bw_ibm_mdf *ib, bw_real *const u[3], double U[]);
void bw_ibm_mdf_spread(bw_ibm_mdf *ib, const double F[], bw_real *const u[3]);

typedef struct {
  double slip_before, slip_after;  /* rms |V - U| over markers before and after the last force
                                      call [L/T]; slip_after costs one interpolation */
  double total_force[3];           /* sum of QdV over all markers since begin_step [L^4/T^2] */
  int64_t markers, outside;        /* over all ranks */
  double imbalance;                /* most markers on a rank over the mean */
  double spacing_min, spacing_max; /* nothing to do with the grid: dV/h^3 range [-] */
} bw_ibm_mdf_report;
/* u as in force: used to measure slip_after. Collective. */
bw_ibm_mdf_report bw_ibm_mdf_measure(bw_ibm_mdf *ib, bw_real *const u[3]);

/* Where this rank's time went since create or the last reset [s]. Local. */
typedef struct {
  double set;     /* set_markers: routes, order, weights */
  double kernels; /* interpolation and spreading, those of images included */
  double images;  /* forces to images on other blocks, waiting included */
  int64_t forced; /* markers held, times iterations */
} bw_ibm_mdf_cost;
bw_ibm_mdf_cost bw_ibm_mdf_cost_of(const bw_ibm_mdf *ib);
void bw_ibm_mdf_cost_reset(bw_ibm_mdf *ib);
