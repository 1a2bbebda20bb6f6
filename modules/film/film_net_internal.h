/* film_net_internal.h -- shared by the sources of the network only. */
#pragma once
#include "bw_film_net.h"

#define FILM_NET_REACH  1.6 /* neighbours along a face, in spacings: next ones and diagonals */
#define FILM_NET_BEYOND 0.5 /* how far beyond the limit points of a foot may be, in spacings */

enum { FILM_NET_FACE = 64 }; /* points within reach of one, on one face */

/* A point that a node stands on, with its weight in the foot. */
typedef struct {
  int32_t point;
  double weight;
} film_net_foot;

/* Between nodes; to: a node, or -1 - edge. drop: (x_to - x_from), whose product with f drives. */
typedef struct {
  int32_t from, to;
  double k, way[3];
} film_net_link;

struct bw_film_net {
  bw_film_net_config config;
  /* points, copied */
  size_t n, room;
  double *X, *N, *H, *A, *mobility;
  double *m;        /* (n) sum r^2 A of its neighbours; 0: not known */
  int32_t *node_of; /* (n) node of a point; -1: none, -2 - edge: an edge */
  int32_t *near;    /* (n) scratch: points around one */
  /* bins: points by cells of edge `wide` or a little more */
  int bins[3];
  double low[3], wide[3];
  int32_t *head, *next; /* (bins), (n): lists; -1 ends */
  size_t room_head;
  /* film */
  size_t n_nodes, n_feet, n_links, n_edges, n_used;
  size_t room_feet, room_links;
  bw_film_node *node; /* (n) */
  size_t *foot_at;    /* (n + 1) where the feet of a node begin */
  film_net_foot *foot;
  film_net_link *link;
  int32_t *edge, *used; /* (n) */
  bool *is_used;        /* (n) */
  /* solve, (n) each */
  double *p, *rhs, *r, *q, *d, *diagonal, *volume;
  double *join;   /* (n) between a node and its foot; 0: none */
  double *shear;  /* (n,3) on the other face of a node, per area */
  double *force;  /* (n,3) scratch, of points */
  double *edge_p; /* (n) of the last press */
  double f[3];
  bool *fixed, *locked; /* (n) at the least pressure; closed between held points */
};

/* How far apart two points may be that know each other. */
double bw_film_net__reach(const bw_film_net *w);
/* w->near: the points within `radius` of x, at most that of the bins; how many. */
size_t bw_film_net__around(const bw_film_net *w, const double x[3], double radius);
/* Sorts the points into bins. */
bw_status bw_film_net__sort(bw_film_net *w) BW_MUST_CHECK;
/* Nodes, feet, links, edges of the points. */
bw_status bw_film_net__find(bw_film_net *w) BW_MUST_CHECK;

/* w->near cut down to the neighbours of s along its face, none with another one between (a relative
 * neighbourhood: on a square lattice the next four, on a line two, also around its corners); how
 * many. */
size_t bw_film_net__neighbours(bw_film_net *w, size_t s);
/* Links and edges of the nodes. */
bw_status bw_film_net__link(bw_film_net *w) BW_MUST_CHECK;
/* p of node a less that at its foot; where it is joined. */
double bw_film_net__jump(const bw_film_net *w, const double p[], size_t a);

/* to - from, by the nearest image: points are inside their period. */
static inline void film_net__between(const bw_film_net *w, const double from[3], const double to[3],
                                     double d[3])
{
  for (int k = 0; k < 3; k++) {
    const double period = w->config.period[k];
    d[k] = to[k] - from[k];
    if (2.0 * d[k] > period && period > 0.0)
      d[k] -= period;
    else if (2.0 * d[k] < -period && period > 0.0)
      d[k] += period;
  }
}

static inline double film_net__dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
