/* bw_coupler_films.h -- what a user chooses of films that no cell resolves (bw_film.h,
 * bw_film_net.h).
 *
 * Between rigid bodies, and between these and walls (bw_coupler_rigid.h): where two faces are
 * nearer than `limit`, the markers of a body keep away from the other face by that much (half of
 * what is missing, where both are bodies), so that the grid carries a film of that gap, which it
 * resolves; what it lacks, D1 - D0, brakes the bodies,
 *   (M + dt D) v_{n+1} = M v*,   v* by all other forces,
 * film after film: opposite impulses in one line, which take energy whatever the step.
 *
 * Between faces of solids of particles, and between these and walls (bw_coupler.h): crack faces,
 * fragments, bodies. Markers stay, so that no face leaks that was tight. A network of facing
 * particles has the film (bw_film_net.h), with the pressure that probes read at its edges. Below
 * five sixths of the limit its forces stand in the place of the grid's, from there to the limit
 * more and more of the grid's: of the load of two faces the half of the difference, so that
 * momentum stays. It is implicit in each sub-step of the solid.
 *
 * flux: what flows in these leaves the grid and enters it at the edges, by the cubic law: along a
 * film the grid's velocity is braked, the film's volume is taken out and put in, and markers keep
 * their memory where bonds have broken, so that faces are tight (solid_films_grid.c). Without it
 * the grid lets through a slit what its markers do. The film answers the pressure at once, which a
 * fluid does within h^2/(12 nu): it has to be some steps at most, or the pressure that the flow
 * makes and the flow that the pressure makes feed each other. So a step dt is refused where
 * h^3/(12 nu dt) is above 25 cells. */
#pragma once
#include <stdbool.h>

/* What a user chooses. */
typedef struct {
  bool on;          /*                                                   default false */
  double limit;     /* gap from which the grid carries the film [L]      default three cells, four
                       where probes load a solid of particles: they shorten below that */
  double roughness; /* least gap of a film [L]            required where on, at most a cell */
  double least;     /* pressure below which a film between particles cavitates, at most 0
                       [M/(L T^2)]                            default -INFINITY: it bears any */
  bool flux;        /* what flows in a film between particles is the grid's   default false */
} bw_coupler_films;
