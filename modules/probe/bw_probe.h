/* bw_probe.h -- the fluid's stress on a surface, from normal probes.
 *
 * From each surface point X with unit normal n into the fluid a probe of length dl = 2 h reaches
 * the tip e = X + dl n; pressure and velocity gradients at e come from central differences over a
 * 2x2x2 stencil of spacing h interpolated with the delta kernel (POROUS 3.83-3.96; ERRATA 10, 19):
 *   p_wall = p_e - dl/2 (dp/dn|wall + dp/dn|e),  dp/dn|wall = -rho DU/Dt.n,
 *   t = -p_wall n + mu (grad u + grad u^T).n        (traction of the fluid on the solid).
 * Where the velocity gradient of t is taken:
 *   BW_PROBE_LINEAR     at the tip, as the documents do: first order in dl;
 *   BW_PROBE_QUADRATIC  at the wall, from the parabola through the velocity V of the surface and
 *                       the velocity and its slope at the tip, du/dn = 2 (u_e - V)/dl - du/dn|e;
 *                       dp/dn|wall gains mu d2u_n/dn2; derivatives along the wall are those of the
 *                       surface, which turns with a given spin; values at the tip are those of
 *                       the parabola through the nearest nodes. Exact for parabolas, second
 *                       order in dl on curved walls too.
 * What is in the way is noticed between h and one h ahead of the tip, also a wall thinner than
 * the probe is long (bw_probe_set_obstacles), and flagged (bw_probe_flag): a probe is shortened
 * until h is free ahead of its tip. A tip whose stencil leaves the box through a side that is not
 * periodic is tried at dl = h. Never silently wrong: the README has the error in gaps.
 * h is the largest spacing. Grid: uniform, halo 2. Kernels whose differences reach beyond the
 * halo (more than three nodes) are refused.
 * Shapes: vectors (n,3) row-major. Points are sent to the ranks that own their tips' cells.
 * Life: create -> { set_obstacles, set_points, set_velocity, traction } -> destroy. */
#pragma once
#include "bw_grid.h"
#include "bw_kernel_delta.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The probes of one surface in one grid. Opaque. */
typedef struct bw_probe bw_probe;

/* How the velocity is taken to vary along a probe (above). */
typedef enum {
  BW_PROBE_LINEAR,    /* slope of the tip, as in POROUS 3.89-3.94 */
  BW_PROBE_QUADRATIC, /* parabola through the wall's velocity and the tip's velocity and slope */
  BW_PROBE_PROFILES   /* how many there are */
} bw_probe_profile;

/* What a user chooses. */
typedef struct {
  bw_kernel_delta_id kernel; /*                                   default BW_KERNEL_ROMA3 */
  double length;             /* dl in grid spacings [-], 1 .. 4   default 2 */
  bw_probe_profile profile;  /*                                   default BW_PROBE_LINEAR */
  double rho;                /* density of the fluid [M/L^3]      required */
  double nu;                 /* its kinematic viscosity [L^2/T]   required */
} bw_probe_config;

/* Roma's kernel, two spacings, the linear profile; rho and nu NaN. Pure. */
bw_probe_config bw_probe_config_default(void);

/* No points yet. BW_EINPUT names the value that is missing or out of range; BW_EMEM. `grid` is
 * borrowed until destroy. Collective. */
bw_status bw_probe_create(bw_grid *grid, const bw_probe_config *config,
                          bw_probe **out) BW_MUST_CHECK;
/* Releases everything and sets *probe to NULL; NULL is fine. Collective. */
void bw_probe_destroy(bw_probe **probe);

/* What became of a probe. */
typedef enum {
  BW_PROBE_FREE,      /* at full length */
  BW_PROBE_SHORTENED, /* h <= dl < full: something is within full + h of the surface */
  BW_PROBE_BLOCKED,   /* something is within h: no traction (zero) */
  BW_PROBE_CROWDED    /* dl = h and something is within 1.75 h: the traction may be too small */
} bw_probe_flag;

/* What bw_probe_set_points has to avoid from now on: a cell-centred field with valid halos, 1 in
 * cells of a solid and 0 in the fluid (above 1/2 counts); copied. Looked at from h off the surface
 * on. NULL: nothing is in the way. All ranks give a field or none does. BW_EMEM. Local. */
bw_status bw_probe_set_obstacles(bw_probe *probe, const bw_real *solid) BW_MUST_CHECK;

/* Replace this rank's n surface points: position X [L], unit normal N into the fluid (n,3); copied.
 * Decides which probes are shortened or blocked. BW_EINPUT for normals that are not of length 1
 * and for positions that are not finite, on all ranks; BW_EMEM. Collective. */
bw_status bw_probe_set_points(bw_probe *probe, size_t n, const double X[],
                              const double N[]) BW_MUST_CHECK;

/* Velocity V (n,3) [L/T] and rate of rotation spin (n,3) [1/T] of the surface at the points of the
 * last set_points, for BW_PROBE_QUADRATIC (the linear profile does not use them). Borrowed until
 * the next set_points, which forgets them; NULL: at rest, not turning. Local. */
void bw_probe_set_velocity(bw_probe *probe, const double V[], const double spin[]);

/* traction (n,3) [M/(L T^2)] at the points, from u[3] [L/T] and p/rho (valid halos) and the
 * acceleration A (n,3) [L/T^2] of the surface (NULL: zero), less the force per mass on the fluid
 * that its pressure does not hold (a gradient that drives it). flag (n) may be NULL. Collective. */
void bw_probe_traction(bw_probe *probe, bw_real *const u[3], const bw_real *p, const double A[],
                       double traction[], unsigned char flag[]);

#ifdef __cplusplus
}
#endif
