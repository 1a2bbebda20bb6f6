/* rigid_films.h -- films between the rigid bodies of a flow; inside `coupler` only. */
#pragma once
#include "bw_coupler_rigid.h"
#include "bw_film.h"

typedef struct bw_coupler__films bw_coupler__films;

/* mu: viscosity. BW_EINPUT names the value; BW_EMEM. Fluid and bodies are borrowed. Collective. */
bw_status bw_coupler__films_create(const bw_coupler_films *config, double mu, bw_ns_channel *fluid,
                                   bw_rigid *rigid, bw_coupler__films **out) BW_MUST_CHECK;
void bw_coupler__films_destroy(bw_coupler__films **films);
/* X (n,3) of the surface points of this rank with the normals N (n,3): those nearer than the limit
 * to another body or a wall are moved away from it; share (n): the part of its area that each then
 * stands for. Local. */
void bw_coupler__films_retract(const bw_coupler__films *films, size_t n, const double N[],
                               double X[], double share[]);
/* F, T (bodies,3) += what the films add over a step of dt in which the bodies are loaded with F and
 * T. BW_EDIVERGED. The same on all ranks. Local. */
bw_status bw_coupler__films_brake(bw_coupler__films *films, double dt, double F[],
                                  double T[]) BW_MUST_CHECK;
/* Of the last step: wrench (6) on a body; returns the power taken. Local. */
double bw_coupler__films_of(const bw_coupler__films *films, int body, double wrench[6]);
/* What all have taken since the start [M L^2/T^2], from where the count goes on; least gap of the
 * last step [L]. Local. */
double bw_coupler__films_taken(const bw_coupler__films *f);
void bw_coupler__films_count(bw_coupler__films *f, double taken);
double bw_coupler__films_gap(const bw_coupler__films *f);
/* BW_EINPUT names a roughness, limit or least pressure of films, of bodies of any kind, that
 * cannot be with cells of edge `cell`. Local. */
bw_status bw_coupler__films_check(const bw_coupler_films *config, double cell) BW_MUST_CHECK;
