/* bw_film_net.h -- films between faces that are made of particles: a network of facing pairs.
 *
 * A point s of a surface (normal N) that has other points of a surface in front of it, which look
 * back, is a node of the film: the foot of its normal on the other face is the mean of the points
 * q there with weights w_q, sum w_q = 1, chosen so that the foot lies on the line of the normal n,
 *   n = N_s - sum w_q N_q, of length 1,  h = n.(sum w_q x_q - x_s),  h' = n.(sum w_q V_q - V_s).
 * Each face carries half of the film, with nodes of the area a = A N.n/2; in front of a wall, which
 * has no points, there is one face, a = A N.n. Reynolds' equation (bw_film.h) over a node:
 *   sum_j k_sj (p_s - p_j + (x_j - x_s).f) = -a h',   k_sj = h^3/(12 mu) c_sj
 * with the neighbours j on the same face, p_j given where j has no film (an edge of it), and f what
 * drives the fluid per volume. c is that of diffusion among points, d A_s A_j (1/m_s + 1/m_j)
 * with m = sum_j r^2 A_j over all neighbours in 1.6 spacings and d the dimension of the face: exact
 * on a line and on a square lattice; an edge is half a spacing away. Both faces of a gap are
 * joined, as p does not change across. Between faces that slide the shear is mu U_t/h.
 *
 * Opposite forces along n with the foot on that line: momentum to round-off, and of the pressure
 * the angular momentum as well; shear has the moment h times itself. What the film takes is
 * sum k (p_s - p_j)^2 + mu a U_t^2/h.
 *
 * Step. A film is stiffer than any step of the solid: p belongs to the velocities at its end,
 * V = V* + dt/m F, V* by all other forces:
 *   (K + dt B M^-1 B^T) p = -B V*,   (B V)_s = a h',
 * symmetric and positive, conjugate gradients. No film pulls by more than -`least`: nodes that
 * would have cavitated have p = least (an active set).
 *
 * Shared with the grid. From a gap `limit` on the grid carries the film, below `full` the network
 * does, in between both: forces are those of the network times b, b = 1 below `full`, 0 from
 * `limit` on, 3 t^2 - 2 t^3 of what lies between. h is never below the roughness.
 *
 * Units    any consistent set: [M], [L], [T].
 * Life     config_default -> create -> { find -> { press -> forces } } -> destroy. All local: no
 *          function communicates. The answer depends on the order of the points by rounding
 *          alone. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_film_net bw_film_net;

/* A plane that the fluid does not cross, at rest. */
typedef struct {
  int direction; /* 0 .. 2: across it */
  double at;     /* its place [L] */
  bool upper;    /* the fluid is below */
} bw_film_wall;

enum { BW_FILM_WALLS = 6 /* at most */ };

/* What a user chooses. */
typedef struct {
  double mu;        /* viscosity [M/(L T)]                                       required */
  double limit;     /* gap from which the grid carries the film [L]              required */
  double full;      /* gap below which the network does [L]                      required */
  double roughness; /* least gap [L], below the limit                            required */
  double least;     /* least pressure of a film [M/(L T^2)]              default -INFINITY */
  double spacing;   /* of the points [L]                                         required */
  bool planar;      /* points of a plane                                      default false */
  double depth;     /* of the plane [L]                                       default 1 */
  double period[3]; /* of periodic directions [L]; 0: not periodic                default 0 */
  int n_walls;      /* how many of them                                        default 0 */
  bw_film_wall wall[BW_FILM_WALLS]; /* (n_walls) */
} bw_film_net_config;

/* Required values NaN. Pure. */
bw_film_net_config bw_film_net_config_default(void);

/* BW_EINPUT names the value: mu, limit, full, roughness or spacing that is not positive, a
 * roughness above the limit, a `full` above the limit, a least pressure above 0; BW_EMEM. *out is
 * the caller's. */
bw_status bw_film_net_create(const bw_film_net_config *config, bw_film_net **out) BW_MUST_CHECK;
/* Releases everything and sets *net to NULL; NULL is fine. */
void bw_film_net_destroy(bw_film_net **net);

/* Points of surfaces. */
typedef struct {
  size_t n;               /* how many */
  const double *X;        /* (n,3) centres of the particles [L] */
  const double *N;        /* (n,3) unit normals, into the fluid */
  const double *H;        /* (n) height of the surface above the centre [L] */
  const double *A;        /* (n) area [L^2] */
  const double *mobility; /* (n) 1/mass, 0: held [1/M] */
} bw_film_points;

/* Finds nodes, feet, links and edges; the points are copied. BW_EMEM. */
bw_status bw_film_net_find(bw_film_net *net, const bw_film_points *points) BW_MUST_CHECK;

/* A node of the film. */
typedef struct {
  int32_t point;    /* its surface point */
  bool wall;        /* the other face is a wall */
  double normal[3]; /* from it to the other face */
  double gap;       /* not below the roughness [L] */
  double area;      /* a above [L^2] */
  double share;     /* b above */
  double pressure;  /* of the last press [M/(L T^2)] */
} bw_film_node;
/* Borrowed until the next find. */
size_t bw_film_net_nodes(const bw_film_net *net, const bw_film_node **node);
/* Points at the edges, whose pressure has to be given. Borrowed until the next find. */
size_t bw_film_net_edges(const bw_film_net *net, const int32_t **point);
/* Points on which a film may act: nodes, and those that they stand on. Borrowed. */
size_t bw_film_net_used(const bw_film_net *net, const int32_t **point);

/* Pressure of the nodes and shear, for a step of dt [T] at whose end the points would have the
 * velocities V (n,3) without films; edge (edges): pressure there, NaN: closed. f (3): force per
 * volume that drives the fluid beside its pressure. BW_EDIVERGED where the solve does not
 * converge. */
bw_status bw_film_net_press(bw_film_net *net, double dt, const double V[], const double edge[],
                            const double f[3]) BW_MUST_CHECK;
/* F (n,3) += what the films of the last press do to the points [M L/T^2]. */
void bw_film_net_force(const bw_film_net *net, double F[]);
/* T (nodes,3): what L (n,3), another load on the points [M L/T^2], does between the faces: half of
 * the difference of both faces' loads per area, as it acts on the other one [M/(L T^2)]. */
void bw_film_net_between(const bw_film_net *net, const double L[], double T[]);
/* F (n,3) -= the forces of T (nodes,3) between the faces in the share of the film, which stands for
 * them. */
void bw_film_net_replace(const bw_film_net *net, const double T[], double F[]);
/* moved (n) += dt times the volume per time that the film of the last press brings to each point:
 * to nodes what their gap gains, to edges what comes out there; of each way its share. All of it
 * adds up to nothing. */
void bw_film_net_bring(const bw_film_net *net, double dt, double moved[]);
/* F (n,3) += f (nodes,3), half on the node's point, half under its foot; in front of a wall the
 * wall bears the other half. */
void bw_film_net_give(const bw_film_net *net, const double f[], double F[]);
/* mean (nodes,3): of V (n,3) at both faces, 0 at a wall. */
void bw_film_net_mean(const bw_film_net *net, const double V[], double mean[]);
/* What flows in the film of the last press through the plane through x with the normal n
 * [L^3/T]. */
double bw_film_net_flux(const bw_film_net *net, const double x[3], const double n[3]);
/* What the films of the last press dissipate [M L^2/T^3], all of them, whatever their share. */
double bw_film_net_dissipation(const bw_film_net *net);

#ifdef __cplusplus
}
#endif
