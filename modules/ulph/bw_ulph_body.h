/* bw_ulph_body.h -- solids that move in a fluid of particles, and what the fluid does to them.
 *
 * A solid is given by its own particles: places, volumes, and the velocity with which each has gone
 * through a step. The fluid meets them as it meets walls (bw_ulph.h): each shows the image of the
 * fluid in front of it, so that
 *   F_IA = -V_I w V_A (p_I M_I^-1 + p_A M_A^-1) x,   x = x_A - x_I,
 * and the viscosity of pairs with walls act between fluid particle I and solid particle A. The
 * force on A is -sum_I F_IA of these very pairs: momentum is kept to round-off, whatever the shape.
 * Where the solid ends follows from its particles, anew with the lists of neighbours: the normal at
 * A is that of -sum_B w V_B x over solids and walls, or, in the middle of something thin, the axis
 * in which sum_B w V_B x x^T is least. Each particle of something thin has two faces, one for the
 * fluid in front of that plane and one for what is behind: a plate of any thickness keeps its two
 * sides apart, cracks let fluid in when they are wide enough for it, and fragments are met from all
 * sides.
 *
 * Work: half a step gives -dt/2 sum F_A.v_A to the fluid with the force at that end of the step and
 * the velocity of the step, v = (x_new - x_old)/dt; it is the line `bodies` of the book.
 *
 * Shapes   (n,3) of all particles of all solids, the same on every rank. In 2D volumes are areas.
 * Life     bw_ulph_create -> add_body -> start -> { move_body, step, body_force }*.
 * Limits   memory and messages of every rank grow with all particles of the solids; an angular
 *          momentum that pairs take with them stands with that of the walls. */
#pragma once
#include "bw_ulph.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Solid particles with volumes V (n) [L^d] (0: never seen by the fluid) at x (n,3) [L], `spacing`
 * apart; all are copied. Those inside a wall of create are not seen. Once, before start. BW_EINPUT:
 * a spacing that is not dx or dx over a whole number; fluid that is nearer to one than a quarter of
 * dx + spacing (with the place); a second call. BW_EMEM. The same on all ranks. Collective. */
bw_status bw_ulph_add_body(bw_ulph *u, int64_t n, const double V[], const double x[],
                           double spacing, bool no_slip, int n_walls,
                           const bw_ulph_wall wall[]) BW_MUST_CHECK;

/* Where they are at the end of the next step, x (n,3) [L], and with which mean velocities they get
 * there, v (n,3) [L/T]; copied. Local, the same on all ranks. */
void bw_ulph_move_body(bw_ulph *u, const double x[], const double v[]);

/* Force of the fluid on each, F (n,3) [M L/T^2], and its share of the wetted area (n)
 * [L^(d-1)], at the last evaluation. Collective. */
void bw_ulph_body_force(const bw_ulph *u, double F[], double area[]);

/* Pressure that each shows, the mean of its faces (n); dry ones 0. Collective. */
void bw_ulph_body_pressure(const bw_ulph *u, double p[]);

/* Numbers of a particle of a body in a checkpoint. */
enum { BW_ULPH_BODY_ROW = 23 };

/* rows (n, BW_ULPH_BODY_ROW) of all particles, the same on every rank; set before
 * bw_ulph_state_set. Collective; Local. */
void bw_ulph_body_get(const bw_ulph *u, double rows[]);
void bw_ulph_body_set(bw_ulph *u, const double rows[]);

#ifdef __cplusplus
}
#endif
