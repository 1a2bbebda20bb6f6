/* A network of facing pairs: its points, and what its film does to them. */
#include "bw_film_net.h"
#include "bw_memory.h"
#include "film_net_internal.h"

#include <math.h>
#include <string.h>

bw_film_net_config bw_film_net_config_default(void)
{
  return (bw_film_net_config){.mu = (double)NAN,
                              .limit = (double)NAN,
                              .full = (double)NAN,
                              .roughness = (double)NAN,
                              .least = -INFINITY,
                              .spacing = (double)NAN,
                              .depth = 1.0};
}

static bw_status check(const bw_film_net_config *c)
{
  BW_REQUIRE(c->mu > 0.0, BW_EINPUT,
             "film: mu is %g; a film needs a viscosity above 0: without one leave films out",
             c->mu);
  BW_REQUIRE(c->limit > 0.0, BW_EINPUT, "film: limit is %g; give a gap above 0", c->limit);
  BW_REQUIRE(c->full > 0.0 && c->full < c->limit, BW_EINPUT,
             "film: full is %g; give a gap above 0 and below the limit %g", c->full, c->limit);
  BW_REQUIRE(c->roughness > 0.0 && c->roughness <= c->limit, BW_EINPUT,
             "film: roughness is %g; give one above 0 and at most the limit %g: rougher faces have "
             "no film that the grid does not see",
             c->roughness, c->limit);
  BW_REQUIRE(c->least <= 0.0, BW_EINPUT,
             "film: least is %g; a film bears the pressure 0: give 0 or a pressure below",
             c->least);
  BW_REQUIRE(c->spacing > 0.0, BW_EINPUT, "film: spacing is %g; give one above 0", c->spacing);
  return BW_OK;
}

/* All arrays with a row per point, by their width. */
#define VECTORS(w)                                                                                 \
  {                                                                                                \
    &(w)->X, &(w)->N, &(w)->shear, &(w)->force                                                     \
  }
#define SCALARS(w)                                                                                 \
  {                                                                                                \
    &(w)->H, &(w)->A, &(w)->mobility, &(w)->m, &(w)->p, &(w)->rhs, &(w)->r, &(w)->q, &(w)->d,      \
        &(w)->diagonal, &(w)->volume, &(w)->edge_p, &(w)->join                                     \
  }
#define LISTS(w)                                                                                   \
  {                                                                                                \
    &(w)->node_of, &(w)->near, &(w)->next, &(w)->edge, &(w)->used                                  \
  }

static void release_points(bw_film_net *w)
{
  double **const vector[] = VECTORS(w), **const scalar[] = SCALARS(w);
  int32_t **const list[] = LISTS(w);
  for (size_t a = 0; a < sizeof vector / sizeof *vector; a++)
    bw_release(vector[a]);
  for (size_t a = 0; a < sizeof scalar / sizeof *scalar; a++)
    bw_release(scalar[a]);
  for (size_t a = 0; a < sizeof list / sizeof *list; a++)
    bw_release(list[a]);
  bw_release(&w->node);
  bw_release(&w->foot_at);
  bw_release(&w->is_used);
  bw_release(&w->fixed);
  bw_release(&w->locked);
  w->room = 0;
}

static bw_status make_points(bw_film_net *w, size_t n)
{
  if (n <= w->room && w->node != NULL) return BW_OK;
  double **const vector[] = VECTORS(w), **const scalar[] = SCALARS(w);
  int32_t **const list[] = LISTS(w);
  const size_t room = n + n / 8; /* points come and go */
  bw_status st = BW_OK;
  release_points(w);
  for (size_t a = 0; a < sizeof vector / sizeof *vector; a++)
    BW_THEN(st, BW_ALLOCATE(vector[a], 3 * room));
  for (size_t a = 0; a < sizeof scalar / sizeof *scalar; a++)
    BW_THEN(st, BW_ALLOCATE(scalar[a], room));
  for (size_t a = 0; a < sizeof list / sizeof *list; a++)
    BW_THEN(st, BW_ALLOCATE(list[a], room));
  BW_THEN(st, BW_ALLOCATE(&w->node, room));
  BW_THEN(st, BW_ALLOCATE(&w->foot_at, room + 1));
  BW_THEN(st, BW_ALLOCATE(&w->is_used, room));
  BW_THEN(st, BW_ALLOCATE(&w->fixed, room));
  BW_THEN(st, BW_ALLOCATE(&w->locked, room));
  w->room = room;
  return st;
}

bw_status bw_film_net_create(const bw_film_net_config *config, bw_film_net **out)
{
  bw_film_net *w = NULL;
  *out = NULL;
  BW_TRY(check(config));
  BW_TRY(BW_ALLOCATE(&w, 1));
  w->config = *config;
  *out = w;
  return BW_OK;
}

void bw_film_net_destroy(bw_film_net **net)
{
  bw_film_net *w = *net;
  if (w == NULL) return;
  release_points(w);
  bw_release(&w->head);
  bw_release(&w->foot);
  bw_release(&w->link);
  bw_release(net);
}

/* Places, each in its period. */
static void copy_inside(bw_film_net *w, const double X[])
{
  for (size_t i = 0; i < 3 * w->n; i++) {
    const double period = w->config.period[i % 3];
    w->X[i] = period > 0.0 ? X[i] - period * floor(X[i] / period) : X[i];
  }
}

bw_status bw_film_net_find(bw_film_net *w, const bw_film_points *points)
{
  BW_TRY(make_points(w, points->n));
  w->n = points->n;
  if (w->n > 0) {
    copy_inside(w, points->X);
    memcpy(w->N, points->N, 3 * w->n * sizeof *w->N);
    memcpy(w->H, points->H, w->n * sizeof *w->H);
    memcpy(w->A, points->A, w->n * sizeof *w->A);
    memcpy(w->mobility, points->mobility, w->n * sizeof *w->mobility);
  }
  BW_TRY(bw_film_net__find(w));
  /* A new film is solved from nothing, so that it does not depend on how it came about. */
  memset(w->p, 0, w->n_nodes * sizeof *w->p);
  memset(w->shear, 0, 3 * w->n_nodes * sizeof *w->shear);
  return BW_OK;
}

size_t bw_film_net_nodes(const bw_film_net *w, const bw_film_node **node)
{
  *node = w->node;
  return w->n_nodes;
}

size_t bw_film_net_edges(const bw_film_net *w, const int32_t **point)
{
  *point = w->edge;
  return w->n_edges;
}

size_t bw_film_net_used(const bw_film_net *w, const int32_t **point)
{
  *point = w->used;
  return w->n_used;
}

/* F += the force f on the other face of node a, and its opposite on it. */
static void add_pair(const bw_film_net *w, size_t a, const double f[3], double F[])
{
  const size_t s = (size_t)w->node[a].point;
  for (size_t d = 0; d < 3; d++)
    F[3 * s + d] -= f[d];
  for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
    for (size_t d = 0; d < 3; d++)
      F[3 * (size_t)w->foot[q].point + d] += w->foot[q].weight * f[d];
}

void bw_film_net_force(const bw_film_net *w, double F[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    double f[3];
    for (size_t d = 0; d < 3; d++)
      f[d] = node->share * node->area * (node->pressure * node->normal[d] + w->shear[3 * a + d]);
    add_pair(w, a, f, F);
  }
}

void bw_film_net_between(const bw_film_net *w, const double L[], double T[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    const bw_film_node *node = w->node + a;
    const size_t s = (size_t)node->point;
    double *f = T + 3 * a;
    /* A wall has no load that is known. */
    for (size_t d = 0; d < 3; d++)
      f[d] = -(node->wall ? 1.0 : 0.5) * L[3 * s + d] / w->A[s];
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++) {
      const size_t t = (size_t)w->foot[q].point;
      for (size_t d = 0; d < 3; d++)
        f[d] += 0.5 * w->foot[q].weight * L[3 * t + d] / w->A[t];
    }
  }
}

void bw_film_net_replace(const bw_film_net *w, const double T[], double F[])
{
  for (size_t a = 0; a < w->n_nodes; a++) {
    double f[3];
    for (size_t d = 0; d < 3; d++)
      f[d] = -w->node[a].share * w->node[a].area * T[3 * a + d];
    add_pair(w, a, f, F);
  }
}

/* Pressure at the far end of a link. */
static double far_pressure(const bw_film_net *w, const film_net_link *link)
{
  return link->to >= 0 ? w->p[link->to] : w->edge_p[-1 - link->to];
}

/* What flows along a link, from its beginning. */
static double flow(const bw_film_net *w, const film_net_link *link)
{
  const double far = far_pressure(w, link);
  if (isnan(far)) return 0.0;
  return link->k * (w->p[link->from] - far + film_net__dot(link->way, w->f));
}

void bw_film_net_bring(const bw_film_net *w, double dt, double moved[])
{
  for (size_t l = 0; l < w->n_links; l++) {
    const film_net_link *link = w->link + l;
    const bw_film_node *from = w->node + link->from, *to = link->to < 0 ? from : w->node + link->to;
    const double volume = 0.5 * (from->share + to->share) * dt * flow(w, link);
    moved[from->point] -= volume;
    moved[link->to < 0 ? w->edge[-1 - link->to] : to->point] += volume;
  }
  for (size_t a = 0; a < w->n_nodes; a++) {
    if (!(w->join[a] > 0.0)) continue;
    const double volume = w->node[a].share * dt * w->join[a] * bw_film_net__jump(w, w->p, a);
    moved[w->node[a].point] -= volume;
    for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
      moved[w->foot[q].point] += w->foot[q].weight * volume;
  }
}

void bw_film_net_give(const bw_film_net *w, const double f[], double F[])
{
  for (size_t a = 0; a < w->n_nodes; a++)
    for (size_t d = 0; d < 3; d++) {
      F[3 * (size_t)w->node[a].point + d] += 0.5 * f[3 * a + d];
      for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
        F[3 * (size_t)w->foot[q].point + d] += 0.5 * w->foot[q].weight * f[3 * a + d];
    }
}

void bw_film_net_mean(const bw_film_net *w, const double V[], double mean[])
{
  for (size_t a = 0; a < w->n_nodes; a++)
    for (size_t d = 0; d < 3; d++) {
      mean[3 * a + d] = 0.5 * V[3 * (size_t)w->node[a].point + d];
      for (size_t q = w->foot_at[a]; q < w->foot_at[a + 1]; q++)
        mean[3 * a + d] += 0.5 * w->foot[q].weight * V[3 * (size_t)w->foot[q].point + d];
    }
}

double bw_film_net_flux(const bw_film_net *w, const double x[3], const double n[3])
{
  double sum = 0.0, from[3], inside[3];
  for (int d = 0; d < 3; d++) {
    const double period = w->config.period[d];
    inside[d] = period > 0.0 ? x[d] - period * floor(x[d] / period) : x[d];
  }
  for (size_t l = 0; l < w->n_links; l++) {
    const film_net_link *link = w->link + l;
    film_net__between(w, inside, w->X + 3 * (size_t)w->node[link->from].point, from);
    const double before = film_net__dot(from, n), after = before + film_net__dot(link->way, n);
    if (before <= 0.0 && after > 0.0) sum += flow(w, link);
    if (before > 0.0 && after <= 0.0) sum -= flow(w, link);
  }
  return sum;
}

double bw_film_net_dissipation(const bw_film_net *w)
{
  double sum = 0.0;
  for (size_t l = 0; l < w->n_links; l++) {
    const double q = flow(w, w->link + l);
    sum += q * q / w->link[l].k;
  }
  for (size_t a = 0; a < w->n_nodes; a++)
    if (w->join[a] > 0.0) sum += w->join[a] * pow(bw_film_net__jump(w, w->p, a), 2);
  for (size_t a = 0; a < w->n_nodes; a++)
    sum += w->node[a].area * w->node[a].gap / w->config.mu *
           film_net__dot(w->shear + 3 * a, w->shear + 3 * a);
  return sum;
}
