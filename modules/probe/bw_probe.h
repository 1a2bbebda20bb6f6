/* bw_probe.h -- the fluid's stress on a surface, from normal probes.
 *
 * From each surface point X with unit normal n into the fluid a probe of length dl = 2 h reaches
 * the tip e = X + dl n; pressure and velocity gradients at e come from central differences over a
 * 2x2x2 stencil of spacing h interpolated with the delta kernel (POROUS 3.83-3.96; ERRATA 10, 19):
 *   p_wall = p_e - dl/2 (dp/dn|wall + dp/dn|e),  dp/dn|wall = -rho DU/Dt.n,
 *   t = -p_wall n + mu (grad u + grad u^T).n        (traction of the fluid on the solid).
 * A probe whose stencil leaves the box through a side that is not periodic, or that meets
 * `solid` cells given by the caller, is shortened once to dl = h and flagged; when that does not
 * help either its traction is zero and it is flagged blocked. Never silently wrong.
 * Shapes: vectors (n,3) row-major. Points are sent to the ranks that own their tips' cells. */
#pragma once
#include "bw_grid.h"
#include "bw_kernel_delta.h"

typedef struct bw_probe bw_probe;

typedef struct {
  bw_kernel_delta_id kernel; /*                                   default BW_KERNEL_ROMA3 */
  double length;             /* dl in grid spacings [-], 1 .. 4   default 2 */
  double rho, nu;            /* of the fluid [M/L^3], [L^2/T]     required */
} bw_probe_config;

bw_probe_config bw_probe_config_default(void);
bw_status bw_probe_create(bw_grid *grid, const bw_probe_config *config,
                          bw_probe **out) BW_MUST_CHECK; /* grid borrowed. Collective. */
void bw_probe_destroy(bw_probe **probe);                 /* Collective. */

typedef enum { BW_PROBE_FREE, BW_PROBE_SHORTENED, BW_PROBE_BLOCKED } bw_probe_flag;

/* Replace the surface points: position X, unit normal N into the fluid (n,3); copied.
 * Collective. */
bw_status bw_probe_set_points(bw_probe *probe, size_t n, const double X[], const double N[])
    BW_MUST_CHECK;

/* traction (n,3) [M/(L T^2)] at the points, from u[3] [L/T] and p/rho (valid halos) and the
 * acceleration A (n,3) [L/T^2] of the surface (NULL: zero). flag (n) may be NULL. Collective. */
void bw_probe_traction(bw_probe *probe, bw_real *const u[3], const bw_real *p, const double A[],
                       double traction[], unsigned char flag[]);
