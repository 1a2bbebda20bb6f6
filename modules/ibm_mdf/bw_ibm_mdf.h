/* bw_ibm_mdf.h -- immersed boundary by multi-direct forcing: no slip at Lagrangian markers.
 *
 * Per call, n_iter times (POROUS 3.79-3.82; ERRATA 17, 18):
 *   U = interpolate(u^);  Q += (V - U)/dt;  u^ = u* + dt spread(Q dV)
 * with the full dt of the step in every sub-step. Interpolation and spreading use the same
 * kernel and are adjoint: sum Q.U dV over markers = sum q.u h^3 over cells, to round-off.
 *
 * Memory. Each iteration takes a part of the slip, and projection brings slip back, so that any
 * number of iterations leaves some for ever, of the order of the step. With a memory M per marker,
 * the running mean of the force that it needed, the iterations of sub-step r begin from
 *   u* + dt gamma_r spread(M),  Q_r = gamma_r M/dV + what they add,  gamma = 8/15, 2/15, 1/3,
 * and the step ends with M <- (1 - beta) M + beta sum_r Q_r dV. Where the flow is steady M is the
 * whole force and no slip is left, after one iteration. For a mode with the eigenvalues a of A =
 * interpolate(spread(. dV)) and p a of the same with the projection in between, k = 1 - (1 - a)^
 * n_iter and y = (1 - beta) k (1 - p), a step multiplies what is not steady by the roots of
 *   mu^3 - (2 - k p (1 + beta) + y) mu^2 + (1 - k p + 2 y) mu - y = 0
 * (data/forcing_sheet/memory_roots.py). beta = 0 has the root 1, the slip that stays; it leaves 1
 * as 1 - beta a p. No root is above 1 while k <= 1; where A has an eigenvalue above 1 the
 * iterations take the part 1/a of what is missing only. beta = 0.05 to 0.3 behave alike.
 * Grid     must be uniform (checked, BW_EINPUT) with halo 2; kernels reach two cells.
 * Shapes   marker vectors are row-major (n,3); dV (n).
 * Owns     copies of the markers, sorted by cell, on the rank that owns the cell; their weights.
 * MPI      markers are handed over by whoever has them; the module sends them to their cells. Each
 *          other block whose cells or halo a marker's support reaches holds an image of it, gets
 *          its force and spreads it itself: one message per iteration, if there are images. */
#pragma once
#include "bw_grid.h"
#include "bw_kernel_delta.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A set of markers and what they do to the velocity of one grid. Opaque. */
typedef struct bw_ibm_mdf bw_ibm_mdf;

/* What a user chooses. */
typedef struct {
  bw_kernel_delta_id kernel; /*                     default BW_KERNEL_ROMA3 */
  int n_iter;                /* forcing iterations [-], >= 1       default 1 */
  double memory;             /* beta [-], 0 .. 0.5; 0: no memory   default 0.2 */
} bw_ibm_mdf_config;

/* Roma's kernel, one iteration, a memory of five steps. Without memory use two iterations or more.
 * Pure. */
bw_ibm_mdf_config bw_ibm_mdf_config_default(void);

/* How far inside the nominal surface the markers of a solid belong, in grid spacings (ERRATA 21).
 * A regularised sheet of force stops the fluid some way outside itself: over a flat sheet on the
 * grid by (1/2) sum_ij phi_i phi_j |i - j| spacings (0.25 to 0.28 for Roma's kernel, 0.375 to 0.39
 * for Peskin's, 0 to 0.25 for the hat), over a turned one by more, linearly in n_x^4 + n_y^4 +
 * n_z^4 of its normal. With memory no slip is left and the value is the mean over all places and
 * turns of the sheet (data/forcing_sheet/flat_sheet.py): it follows from the kernel alone. Without
 * memory slip adds to it, and the values are those at which the drag of a cylinder has no error
 * (validation/ibm_mdf/cylinder_drag). Pure. */
double bw_ibm_mdf_retraction(const bw_ibm_mdf_config *config);

/* No markers yet. `grid` is borrowed until destroy. BW_EINPUT for values out of range and a grid
 * that is stretched, has another halo than 2 or more than 2^31 - 1 cells on a rank; BW_EMEM.
 * Collective. */
bw_status bw_ibm_mdf_create(bw_grid *grid, const bw_ibm_mdf_config *config,
                            bw_ibm_mdf **out) BW_MUST_CHECK;
/* Releases everything and sets *ib to NULL; NULL is fine. Collective. */
void bw_ibm_mdf_destroy(bw_ibm_mdf **ib);

/* Replace the marker set: position X [L], velocity V of the boundary [L/T], volume dV [L^3]
 * (surface area per marker times the grid spacing). Copied. Markers outside the box in a
 * direction that is not periodic are left out and counted; what a marker near such a side would
 * spread beyond it is lost. Computes all weights; the force of the step is zero again.
 * How close: any number of markers may share a surface as long as their volumes add up to area
 * times h; more than some 1.5 h (roma3), 2 h (peskin4) or 1 h (hat2) apart the fluid leaks between
 * them (table in docs/verification/ibm_mdf). The slip goes through I - A per iteration, with
 * A = interpolate(spread(. dV)); when the largest eigenvalue of A is above 2 the iteration grows.
 * That of the first set that has markers is measured (the cost of 8 iterations), later sets are
 * taken to be as dense.
 * M (n,3) [L^4/T^2]: what bw_ibm_mdf_memory gave of these markers, whatever their order and ranks
 * were then; NULL where they are new. The first component NaN: the marker neither has nor gathers a
 * memory (where two surfaces ask for different velocities in the same cells, as the faces of a
 * crack do, a memory would grow for ever). Not used without memory.
 * BW_EINPUT for values that are not finite, negative volumes and iterations that grow, on all
 * ranks; BW_EMEM. Collective. */
bw_status bw_ibm_mdf_set_markers(bw_ibm_mdf *ib, size_t n, const double X[], const double V[],
                                 const double dV[], const double M[]) BW_MUST_CHECK;

/* Markers on the true surface. N (n,3) outward unit normals of the markers just set, in their order
 * (NaN: this one has none and is forced as ever), nu [L^2/T] viscosity of the fluid.
 * A sheet of forces bends the velocity: smoothed by the kernel twice, the kink of its tangential
 * part reads c h [du_t/dn] below the velocity of the surface, c = (1/2) sum phi_i phi_j |i - j|,
 * that of a flat sheet with this normal (data/forcing_sheet), and the kink is the tangential force,
 * [du_t/dn] = F_t/(mu A). So the markers want
 *   U = V - c h^2/nu (Q - (Q.N) N)
 * and the fluid has V on the surface itself: no retraction, no shear inside the body, and an error
 * of second order (h/R)^2 on curved surfaces, where retracted markers leave 6 c^2 h^2/a of a
 * sphere's radius and 4.5 c^2 h^2/a of a cylinder's in Stokes flow. The normal part has no kink.
 * Valid until the next set_markers. BW_EINPUT without memory, for nu that is not positive and for
 * normals that are not of length 1, on all ranks. Collective. */
bw_status bw_ibm_mdf_set_normals(bw_ibm_mdf *ib, const double N[], double nu) BW_MUST_CHECK;

/* Markers of closed surfaces. surface (n): which of `surfaces` >= 0 each of the markers just set
 * lies on, or -1; N (n,3) its normal, of length 1, out of the body.
 * A force along the normals that is the same per area everywhere on a closed surface changes the
 * pressure inside and moves nothing. But what markers read has a net flow through the surface:
 * kernels average a velocity that bends around it. Memory would answer with such a force and, as it
 * does not help, with ever more of it; the jump of the pressure across the sheet, smeared by the
 * kernel, then reaches whoever reads the pressure beside the surface. So it is taken out of the
 * memory of each surface in every step: M <- M - N dV sum M.N/sum dV, over markers with a memory.
 * A body that ends in walls is closed by them; one of which some markers are left out is open (-1).
 * Valid until the next set_markers; without memory nothing is done. BW_EINPUT for surfaces that are
 * not there and normals that are not of length 1, on all ranks; BW_EMEM. Collective. */
bw_status bw_ibm_mdf_close(bw_ibm_mdf *ib, int surfaces, const int surface[],
                           const double N[]) BW_MUST_CHECK;

/* Sets the ghosts of the velocity beyond the physical sides of the box from what is inside. */
typedef void (*bw_ibm_mdf_ghosts_fn)(void *context);
/* Who forces walled boxes gives the function that does so for his fluid (bw_ns_channel_ghosts):
 * spreading changes cells at a side and not the ghosts beyond, which the next iteration reads. The
 * context is borrowed for the life of the markers; NULL: nobody does. Local, on all ranks. */
void bw_ibm_mdf_set_ghosts(bw_ibm_mdf *ib, bw_ibm_mdf_ghosts_fn function, void *context);

/* Make the velocity u[3] [L/T] (fields with valid halos; u[2] may be NULL in 2D) meet V at the
 * markers, in place; halos of u stay valid (their owners' values to round-off), except beyond
 * physical boundaries. dt [T] is that of the whole step (ERRATA 18). Adds to the force of the step.
 * Once per sub-step: memory enters the first, second and third call since begin_step with gamma_0,
 * gamma_1 and gamma_2. Collective. */
void bw_ibm_mdf_force(bw_ibm_mdf *ib, bw_real *const u[3], double dt);

/* Start a new step: the memory takes up the force of the last one, which is zero from now on.
 * After set_markers, whose M has it already, the memory stays as it is. Collective. */
void bw_ibm_mdf_begin_step(bw_ibm_mdf *ib);

/* M (n,3) [L^4/T^2], in the order of set_markers: the memory with which the next step begins (the
 * force of the last one is in it). Markers without memory and outside the box have zeros.
 * Collective. */
void bw_ibm_mdf_memory(bw_ibm_mdf *ib, double M[]);

/* Sum over the sub-steps since begin_step of Q dV, per marker in the order of set_markers
 * (n,3) [L^4/T^2]: the mean force of the boundary on the fluid over the step, per density
 * (ERRATA 18). Collective. */
void bw_ibm_mdf_marker_force(bw_ibm_mdf *ib, double QdV[]);

/* U (n,3) [L/T] = u at the markers, in the order of set_markers; zero where one is outside the box.
 * u's halos must be valid. Collective. */
void bw_ibm_mdf_interpolate(bw_ibm_mdf *ib, bw_real *const u[3], double U[]);
/* u += spread(F dV) for F (n,3), a velocity per marker [L/T]; the adjoint of interpolate. u's halos
 * stay valid. Collective. */
void bw_ibm_mdf_spread(bw_ibm_mdf *ib, const double F[], bw_real *const u[3]);

/* lack (n,3) [L/T], in the order of set_markers: what u at the markers lacks of what they want;
 * zero where one is outside the box. u's halos must be valid. Collective. */
void bw_ibm_mdf_lack_of(bw_ibm_mdf *ib, bw_real *const u[3], double lack[]);

/* What the last step did. */
typedef struct {
  double slip_before;    /* rms |V - U| over markers (with normals: of what they want), before the
                            iterations of the last force call, with what memory had spread [L/T] */
  double slip_after;     /* the same after it [L/T]; costs one interpolation */
  double total_force[3]; /* sum of QdV over all markers since begin_step [L^4/T^2] */
  int64_t markers;       /* handed over by all ranks */
  int64_t outside;       /* of them, those outside the box, which force nothing */
  double imbalance;      /* most markers on a rank over the mean */
  double spacing_min;    /* smallest dV/h^3: volume of a marker over that of a cell [-] */
  double spacing_max;    /* largest dV/h^3 [-] */
} bw_ibm_mdf_report;
/* Measures the last step; u as in force, for slip_after. Collective. */
bw_ibm_mdf_report bw_ibm_mdf_measure(bw_ibm_mdf *ib, bw_real *const u[3]);

/* Where this rank's time went since create or the last reset. */
typedef struct {
  double set;     /* set_markers: routes, order, weights [s] */
  double kernels; /* interpolation and spreading, those of images included [s] */
  double images;  /* forces to images on other blocks, waiting included [s] */
  int64_t forced; /* markers held, times iterations */
} bw_ibm_mdf_cost;
/* Reads the clocks. Local. */
bw_ibm_mdf_cost bw_ibm_mdf_cost_of(const bw_ibm_mdf *ib);
/* Sets clocks and counts to zero. Local. */
void bw_ibm_mdf_cost_reset(bw_ibm_mdf *ib);

#ifdef __cplusplus
}
#endif
