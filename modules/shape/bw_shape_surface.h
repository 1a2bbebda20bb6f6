/* bw_shape_surface.h -- the true surface of a body: distance, normal, points with their areas.
 *
 * Here a body is what its shapes say, not the staircase of lattice sites; its surface is where the
 * markers and probes of a rigid body belong. Shapes are composed in order: with d < 0 inside,
 *   added    d = min(d, d_s)        removed  d = max(d, -d_s)        outside  d_s = -d_s.
 * Distance  of a single box, sphere or endless cylinder: exact. Of any composition: its sign is
 *           that of the body, its zero the surface, its magnitude a lower bound of the distance
 *           (exact where the nearest point of the surface is that of the shape that decides). It
 *           is zero too on a face within the body at which two added shapes touch.
 * Planar    z is ignored; areas are lengths, per unit of depth.
 * Images    have such a surface once bw_shape_mask_find_surface has found it; before, masks give
 *           NaN, and are refused where there is a status. */
#pragma once
#include "bw_shape.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Signed distance of x (3) [L] from the surface, negative inside. The shapes are not checked; NaN
 * for masks, +INFINITY where nothing is added. Local. */
double bw_shape_distance(int count, const bw_shape shape[], bool planar, const double x[3]);

/* The unit vector `normal` (3) along which the distance grows fastest at x (3); on the surface it
 * is the outward normal. Where two faces meet it is that of one of them, at the centre of a ball
 * any. NaN for masks. Local. */
void bw_shape_normal(int count, const bw_shape shape[], bool planar, const double x[3],
                     double normal[3]);

/* Points on the surface of the body: point (n,3) [L], outward unit normal (n,3), area (n) [L^2]
 * (planar: [L]), owned by the caller (bw_release). Each stands for a patch of about `spacing` [L]
 * in both directions; patches that an edge between two shapes cuts are smaller, and their points
 * are near the middle of what is left. Areas of whole patches are exact, so that a sphere, a box
 * or the side of a cylinder has its area to round-off; those of cut patches have an error of
 * second order in `spacing`.
 * BW_EINPUT for what bw_shape_range refuses, for a spacing that is not positive, for masks, for
 * planar cylinders that are not along z, and for a body without any surface; BW_EMEM. Local: a
 * body of N points costs N wherever it is called. */
bw_status bw_shape_points(int count, const bw_shape shape[], bool planar, double spacing,
                          int64_t *n, double **point, double **normal, double **area) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
