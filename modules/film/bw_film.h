/* bw_film.h -- the fluid between two faces that are too near for the grid: Reynolds' equation.
 *
 * Faces a below and b above a plane with the normal n, heights z_a and z_b over it, h = z_b - z_a,
 * whose relative motion at a place is U = U_b - U_a (O. Reynolds, Phil. Trans. R. Soc. 177 (1886)
 * 157; the form is that of any frame):
 *   div(h^3/(12 mu) grad p) = U.g,   g = n - grad(z_a + z_b)/2,   p that of the fluid around at the
 *                                                                 edge
 * The force on b, opposite to that on a and in the same line, is p g - mu U_t/h per area, U_t along
 * the plane. What it takes is the film's dissipation, never negative. Above the gap `limit` the
 * grid carries the film; it feels the faces as if they were no nearer than that. So the answer is
 * the difference of two films, one with h, one with max(h, limit): the resistance D1 - D0 of what
 * the grid lacks. It is nothing at the limit, without a step there, and takes energy whatever the
 * gap, as the narrower film is the stiffer one. h is never below the roughness.
 *
 * One patch has the film of two faces, around the place where they are nearest, as far as they face
 * each other and are nearer than three limits (of faces that part), in `cells` cells each way, the
 * smaller the nearer to that place where the gap widens; a line in the plane. The faces are those
 * of bodies whose signed distance is known, of which one place is nearest: between bodies with
 * several the film is that of the place where it began.
 * Units    any consistent set: [M], [L], [T]. A twist is a velocity and a spin, a wrench a force
 *          and a moment, both about the patch's origin.
 * Life     config_default -> create -> { place -> resistance, pressure } -> destroy. All local: no
 *          function communicates, and every rank may have films of its own. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_film bw_film;

/* What a user chooses. */
typedef struct {
  double mu;        /* viscosity [M/(L T)]                                     required */
  double limit;     /* gap from which the grid carries the film [L]            required */
  double roughness; /* least gap [L], below the limit                          required */
  bool planar;      /* a line along which the faces lie, else a patch          default false */
  double depth;     /* of a planar film [L]                                    default 1 */
  int cells;        /* each way, 8 .. 512                                      default 32 */
} bw_film_config;

/* Required values NaN. Pure. */
bw_film_config bw_film_config_default(void);

/* BW_EINPUT names the value: a viscosity, limit, roughness or depth that is not positive, a
 * roughness above the limit, too few or too many cells; BW_EMEM. *out is the caller's. */
bw_status bw_film_create(const bw_film_config *config, bw_film **out) BW_MUST_CHECK;
/* Releases everything and sets *film to NULL; NULL is fine. */
void bw_film_destroy(bw_film **film);

/* A body by its signed distance. */
typedef struct {
  double (*distance)(const void *context,
                     const double x[3]); /* of x from the surface, negative inside [L] */
  const void *context;                   /* handed to it, the caller's */
} bw_film_face;

/* Puts the film between two faces, the nearest place sought from x (3), and tells whether there is
 * one: false where they are further apart than the limit. */
bool bw_film_place(bw_film *film, const bw_film_face *a, const bw_film_face *b, const double x[3]);

/* Of the film as placed. */
typedef struct {
  double origin[3]; /* middle of the gap where the faces are nearest [L] */
  double normal[3]; /* from a to b */
  double gap;       /* there, above the roughness or not [L] */
  double area;      /* that the patch covers [L^2] */
} bw_film_where;
bw_film_where bw_film_look(const bw_film *film);

/* D (6,6): the wrench on b is -D times the twist of b less that of a, that on a the opposite. It is
 * symmetric and positive to the tolerance of the solve, 1e-8. lacking: that which the grid lacks,
 * D1 - D0, else D1. BW_EDIVERGED where the solve does not converge. */
bw_status bw_film_resistance(bw_film *film, bool lacking, double D[6][6]) BW_MUST_CHECK;

/* The film that the pressure around it drives: pressure(context, x) at its edge [M/(L T^2)], faces
 * at rest. wrench (6) on b, that on a the opposite; flux (2) along the patch's two directions
 * through its middle [L^3/T], in the plane the first alone. lacking as above. BW_EDIVERGED. */
bw_status bw_film_pressure(bw_film *film, bool lacking,
                           double (*pressure)(const void *context, const double x[3]),
                           const void *context, double wrench[6], double flux[2]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
