/* Links along the faces, out at their edges, and between both faces of a gap. */
#include "bw_memory.h"
#include "film_net_internal.h"

#include <math.h>
#include <string.h>

/* Points along one face look about the same way, to 60 degrees: from a face to its edge, from there
 * around it, but not around it at once. */
static const double ALONG = 0.5;
/* A point that is nearer to both of two others by this parts them. */
static const double BETWEEN = 1.2;

/* Squared distance of two points. */
static double distance2(const bw_film_net *w, size_t s, size_t q)
{
  double d[3];
  film_net__between(w, w->X + 3 * s, w->X + 3 * q, d);
  return film_net__dot(d, d);
}

/* Is another of the n points in the list between s and q: a good deal nearer to both? */
static bool is_parted(const bw_film_net *w, size_t s, size_t q, size_t n)
{
  const double far2 = distance2(w, s, q) / (BETWEEN * BETWEEN);
  for (size_t a = 0; a < n; a++) {
    const size_t t = (size_t)w->near[a];
    if (t != q && distance2(w, s, t) < far2 && distance2(w, q, t) < far2) return true;
  }
  return false;
}

size_t bw_film_net__neighbours(bw_film_net *w, size_t s)
{
  const double range = FILM_NET_REACH * w->config.spacing;
  const size_t n = bw_film_net__around(w, w->X + 3 * s, range);
  size_t face = 0, kept = 0;
  int32_t next[FILM_NET_FACE];
  for (size_t a = 0; a < n && face < FILM_NET_FACE; a++) {
    const size_t q = (size_t)w->near[a];
    if (q == s || film_net__dot(w->N + 3 * s, w->N + 3 * q) < ALONG) continue;
    if (distance2(w, s, q) < range * range) w->near[face++] = w->near[a];
  }
  for (size_t a = 0; a < face; a++)
    if (!is_parted(w, s, (size_t)w->near[a], face)) next[kept++] = w->near[a];
  memcpy(w->near, next, kept * sizeof *next);
  return kept;
}

static bw_status make_link(bw_film_net *w, const film_net_link *link)
{
  if (w->n_links == w->room_links) {
    const size_t room = 2 * w->room_links + 1024;
    BW_TRY(BW_ENLARGE(&w->link, w->n_links, room));
    w->room_links = room;
  }
  w->link[w->n_links++] = *link;
  return BW_OK;
}

/* Area of a point along its face: of a node that which faces the other one. */
static double tile_of(const bw_film_net *w, size_t s)
{
  const int32_t a = w->node_of[s];
  return a < 0 ? w->A[s] : (w->node[a].wall ? 1.0 : 2.0) * w->node[a].area;
}

/* Number of the edge at point q. */
static int32_t edge_of(bw_film_net *w, size_t q)
{
  if (w->node_of[q] == -1) {
    w->edge[w->n_edges] = (int32_t)q;
    w->node_of[q] = -2 - (int32_t)w->n_edges++;
  }
  return -2 - w->node_of[q];
}

/* h^3/(12 mu) of the part of the gap that a node's face carries. */
static double mobility_of(const bw_film_net *w, double gap, bool wall)
{
  return (wall ? 1.0 : 0.5) * gap * gap * gap / (12.0 * w->config.mu);
}

/* From node a along its face: to nodes of larger number, each pair once, and to edges. */
static bw_status link_along(bw_film_net *w, size_t a)
{
  const bw_film_node *node = w->node + a;
  const size_t s = (size_t)node->point, n = bw_film_net__neighbours(w, s);
  const double dimension = w->config.planar ? 1.0 : 2.0;
  for (size_t b = 0; b < n; b++) {
    const size_t q = (size_t)w->near[b];
    const int32_t other = w->node_of[q];
    if (other >= 0 && (size_t)other < a) continue;
    double way[3];
    film_net__between(w, w->X + 3 * s, w->X + 3 * q, way);
    const bw_film_node *there = other >= 0 ? w->node + other : node;
    const double c = dimension * tile_of(w, s) * tile_of(w, q) * (1.0 / w->m[s] + 1.0 / w->m[q]);
    film_net_link link = {
        .from = (int32_t)a,
        .k = c * mobility_of(w, 0.5 * (node->gap + there->gap), node->wall && there->wall)};
    memcpy(link.way, way, sizeof way);
    if (other >= 0)
      link.to = other;
    else {
      /* The edge of the face is half a spacing away. */
      link.to = -1 - edge_of(w, q);
      link.k *= 2.0;
      for (int d = 0; d < 3; d++)
        link.way[d] *= 0.5;
    }
    BW_TRY(make_link(w, &link));
  }
  return BW_OK;
}

/* Of each node: what holds its pressure to that under its foot. Only where all of the foot stands
 * on nodes. */
static void join_faces(bw_film_net *w)
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    const double wide = w->config.planar ? w->A[node->point] / w->config.spacing : 1.0;
    bool all = !node->wall;
    for (size_t f = w->foot_at[a]; f < w->foot_at[a + 1]; f++)
      all = all && w->node_of[w->foot[f].point] >= 0;
    w->join[a] =
        all ? wide / (w->config.planar ? w->config.spacing : 1.0) * mobility_of(w, node->gap, false)
            : 0.0;
  }
}

/* sum r^2 A over the neighbours of a point, once. */
static void find_moment(bw_film_net *w, size_t s)
{
  if (w->m[s] > 0.0) return;
  const size_t n = bw_film_net__neighbours(w, s);
  double d[3];
  for (size_t b = 0; b < n; b++) {
    const size_t q = (size_t)w->near[b];
    film_net__between(w, w->X + 3 * s, w->X + 3 * q, d);
    w->m[s] += film_net__dot(d, d) * tile_of(w, q);
  }
}

bw_status bw_film_net__link(bw_film_net *w)
{
  memset(w->m, 0, w->n * sizeof *w->m);
  for (size_t a = 0; a < w->n_nodes; a++) {
    const size_t s = (size_t)w->node[a].point, n = bw_film_net__neighbours(w, s);
    int32_t beside[FILM_NET_FACE];
    const size_t most = n < FILM_NET_FACE ? n : FILM_NET_FACE;
    memcpy(beside, w->near, most * sizeof *beside);
    find_moment(w, s);
    for (size_t b = 0; b < most; b++)
      find_moment(w, (size_t)beside[b]);
  }
  for (size_t a = 0; a < w->n_nodes; a++)
    BW_TRY(link_along(w, a));
  join_faces(w);
  return BW_OK;
}
