/* Pressure and shear of the network for a step, implicit in the velocities at its end. */
#include "film_net_internal.h"

#include <math.h>
#include <string.h>

static const double TOLERANCE = 1e-9; /* of the residual, in the norm of the preconditioner */
enum { ROUNDS = 30 };                 /* of the set of nodes that cavitate */

/* out (nodes) = B V: what each node's part of the gap gains per time. */
static void rate(const bw_film_net *w, const double V[], double out[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    double sum = -film_net__dot(V + 3 * (size_t)node->point, node->normal);
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      sum += w->foot[q].weight * film_net__dot(V + 3 * (size_t)w->foot[q].point, node->normal);
    out[a] = node->area * sum;
  }
}

/* w->force = M^-1 B^T p: how the used points answer to the pressure. */
static void answer(const bw_film_net *w, const double p[])
{
  double *F = w->force;
  for (size_t u = 0; u < w->n_used; u++)
    memset(F + 3 * (size_t)w->used[u], 0, 3 * sizeof *F);
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    const double f = node->area * p[a];
    for (size_t d = 0; d < 3; d++)
      F[3 * (size_t)node->point + d] -= f * node->normal[d];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      for (size_t d = 0; d < 3; d++)
        F[3 * (size_t)w->foot[q].point + d] += w->foot[q].weight * f * node->normal[d];
  }
  for (size_t u = 0; u < w->n_used; u++)
    for (size_t d = 0; d < 3; d++)
      F[3 * (size_t)w->used[u] + d] *= w->mobility[w->used[u]];
}

double bw_film_net__jump(const bw_film_net *w, const double p[], size_t a)
{
  double sum = p[a];
  for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
    sum -= w->foot[q].weight * p[w->node_of[w->foot[q].point]];
  return sum;
}

/* out += what joins both faces: a linear pressure is the same on both. */
static void add_joins(const bw_film_net *w, const double p[], double out[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    if (!(w->join[a] > 0.0)) continue;
    const double k = w->join[a] * bw_film_net__jump(w, p, a);
    out[a] += k;
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      out[w->node_of[w->foot[q].point]] -= w->foot[q].weight * k;
  }
}

/* out = (K + dt B M^-1 B^T) p. */
static void product(const bw_film_net *w, double dt, const double p[], double out[])
{
  answer(w, p);
  rate(w, w->force, out);
  for (size_t a = 0; a < w->n_nodes; a++)
    out[a] *= dt;
  for (size_t l = 0; l < w->n_links; l++) {
    const film_net_link *link = w->link + l;
    if (link->to >= 0) {
      const double q = link->k * (p[link->from] - p[link->to]);
      out[link->from] += q;
      out[link->to] -= q;
    } else if (!isnan(w->edge_p[-1 - link->to]))
      out[link->from] += link->k * p[link->from];
  }
  add_joins(w, p, out);
}

/* Nodes that reach neither an edge nor a point that can move: no pressure is known there, and none
 * acts on anything that moves. Theirs stays what it is. */
static void lock(bw_film_net *w)
{
  bool spreads = true;
  for (size_t a = 0; a < w->n_nodes; a++) {
    double moves = w->mobility[w->node[a].point];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      moves += w->mobility[w->foot[q].point];
    w->locked[a] = moves == 0.0;
  }
  while (spreads) {
    spreads = false;
    for (size_t l = 0; l < w->n_links; l++) {
      const film_net_link *link = w->link + l;
      bool *from = w->locked + link->from;
      const bool edge = link->to < 0, open = edge && !isnan(w->edge_p[-1 - link->to]);
      const bool free = open || (!edge && !(*from && w->locked[link->to]));
      if (!free || (!*from && (edge || !w->locked[link->to]))) continue;
      *from = false, spreads = true;
      if (!edge) w->locked[link->to] = false;
    }
  }
  for (size_t a = 0; a < w->n_nodes; a++)
    w->fixed[a] = w->locked[a] || !(w->diagonal[a] > 0.0);
}

/* Diagonal of the same, and the right side. */
static void set_up(bw_film_net *w, double dt, const double V[])
{
  rate(w, V, w->volume);
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    double moves = w->mobility[node->point];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      moves += w->foot[q].weight * w->foot[q].weight * w->mobility[w->foot[q].point];
    w->diagonal[a] = dt * node->area * node->area * moves;
    w->rhs[a] = -w->volume[a];
  }
  for (size_t l = 0; l < w->n_links; l++) {
    const film_net_link *link = w->link + l;
    const double driven = link->k * film_net__dot(link->way, w->f);
    const double far = link->to < 0 ? w->edge_p[-1 - link->to] : 0.0;
    if (isnan(far)) continue;
    w->diagonal[link->from] += link->k;
    w->rhs[link->from] += link->k * far - driven;
    if (link->to < 0) continue;
    w->diagonal[link->to] += link->k;
    w->rhs[link->to] += driven;
  }
  for (size_t a = 0; a < w->n_nodes; a++) {
    if (!(w->join[a] > 0.0)) continue;
    w->diagonal[a] += w->join[a];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      w->diagonal[w->node_of[w->foot[q].point]] +=
          w->join[a] * w->foot[q].weight * w->foot[q].weight;
  }
  lock(w);
}

static double dot(const bw_film_net *w, const double a[], const double b[])
{
  double sum = 0.0;
  for (size_t i = 0; i < w->n_nodes; i++)
    sum += a[i] * b[i];
  return sum;
}

/* q = r/diagonal of the nodes that are not fixed, and r.q. */
static double precondition(bw_film_net *w)
{
  for (size_t a = 0; a < w->n_nodes; a++)
    w->q[a] = w->fixed[a] ? 0.0 : w->r[a] / w->diagonal[a];
  return dot(w, w->r, w->q);
}

/* p of the nodes that are not fixed. */
static bw_status conjugate_gradients(bw_film_net *w, double dt)
{
  const size_t n = w->n_nodes;
  double first = 0.0;
  product(w, dt, w->p, w->r);
  for (size_t a = 0; a < n; a++) {
    w->r[a] = w->fixed[a] ? 0.0 : w->rhs[a] - w->r[a];
    first += w->fixed[a] ? 0.0 : w->rhs[a] * w->rhs[a] / w->diagonal[a];
  }
  double now = precondition(w);
  memcpy(w->d, w->q, n * sizeof *w->d);
  for (size_t it = 0; it < 10 * n + 100 && now > TOLERANCE * TOLERANCE * first; it++) {
    product(w, dt, w->d, w->q);
    for (size_t a = 0; a < n; a++)
      w->q[a] = w->fixed[a] ? 0.0 : w->q[a];
    const double step = now / dot(w, w->d, w->q), before = now;
    for (size_t a = 0; a < n; a++) {
      w->p[a] += step * w->d[a];
      w->r[a] -= step * w->q[a];
    }
    now = precondition(w);
    for (size_t a = 0; a < n; a++)
      w->d[a] = w->q[a] + now / before * w->d[a];
  }
  BW_REQUIRE(now <= TOLERANCE * TOLERANCE * first, BW_EDIVERGED,
             "film: Reynolds' equation did not converge (residual %g): gaps differ too much",
             sqrt(now / first));
  return BW_OK;
}

/* Nodes below the least pressure are held at it, those that it would fill are let go; tells whether
 * the set has changed. */
static bool cavitate(bw_film_net *w, double dt)
{
  const double least = w->config.least;
  bool changed = false;
  product(w, dt, w->p, w->r);
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bool was = w->fixed[a];
    if (w->locked[a] || !(w->diagonal[a] > 0.0)) continue;
    w->fixed[a] = was ? w->r[a] >= w->rhs[a] : w->p[a] < least;
    if (w->fixed[a]) w->p[a] = least;
    changed = changed || was != w->fixed[a];
  }
  return changed;
}

/* mu U_t/h between the faces, at the velocities of the end, node by node. */
static void find_shear(bw_film_net *w, double dt, const double V[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    const size_t s = (size_t)node->point;
    double U[3] = {-V[3 * s], -V[3 * s + 1], -V[3 * s + 2]}, moves = w->mobility[s];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++) {
      const size_t t = (size_t)w->foot[q].point;
      for (size_t d = 0; d < 3; d++)
        U[d] += w->foot[q].weight * V[3 * t + d];
      moves += w->foot[q].weight * w->foot[q].weight * w->mobility[t];
    }
    const double along = film_net__dot(U, node->normal), c = w->config.mu / node->gap;
    for (size_t d = 0; d < 3; d++)
      w->shear[3 * a + d] =
          -c / (1.0 + dt * c * node->area * moves) * (U[d] - along * node->normal[d]);
  }
}

bw_status bw_film_net_press(bw_film_net *w, double dt, const double V[], const double edge[],
                            const double f[3])
{
  memset(w->fixed, 0, w->n_nodes * sizeof *w->fixed);
  memcpy(w->f, f, sizeof w->f);
  if (w->n_edges > 0) memcpy(w->edge_p, edge, w->n_edges * sizeof *edge);
  set_up(w, dt, V);
  BW_TRY(conjugate_gradients(w, dt));
  for (int round = 0; w->config.least > -INFINITY && round < ROUNDS && cavitate(w, dt); round++)
    BW_TRY(conjugate_gradients(w, dt));
  find_shear(w, dt, V);
  for (size_t a = 0; a < w->n_nodes; a++)
    w->node[a].pressure = w->p[a];
  return BW_OK;
}
