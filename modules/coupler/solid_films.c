/* Films between the faces of a solid of particles: who faces whom, what drives and what they do.
 *
 * Every rank has all surface points and solves the same network, in the order of their ids, so that
 * films do not depend on the number of ranks; each point's values are told by the rank that has it.
 * Faces are those of an interface of their own, which opens a sector as soon as no bond holds
 * there: a crack has a film from its first opening on, before it has markers. */
#include "solid_films.h"
#include "bw_kernel_delta.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "rigid_films.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bw_status bw_coupler__films_check(const bw_coupler_films *f, double cell)
{
  BW_REQUIRE(f->roughness > 0.0 && f->roughness <= cell, BW_EINPUT,
             "films.roughness = %g: must be above 0 and at most a cell, %g: rougher faces have no "
             "film that the grid does not see",
             f->roughness, cell);
  BW_REQUIRE(isnan(f->limit) || f->limit >= cell, BW_EINPUT,
             "films.limit = %g: must be a cell, %g, at least; leave it out for three", f->limit,
             cell);
  BW_REQUIRE(
      f->least <= 0.0, BW_EINPUT,
      "films.least = %g: a film bears the pressure 0; give 0 or a pressure below, or leave it "
      "out",
      f->least);
  return BW_OK;
}

/* Walls of the box, but for sides on which the solid leans. */
static void find_walls(const bw_coupler *c, bw_film_net_config *net)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_ns_channel_config *fluid = bw_ns_channel_settings(c->fluid);
  for (int d = 0; d < (net->planar ? 2 : 3); d++) {
    net->period[d] = g->periodic[d] ? g->length[d] : 0.0;
    for (int end = 0; end < 2; end++)
      if (fluid->side[d][end].kind == BW_SIDE_WALL && !c->config.walled[d][end])
        net->wall[net->n_walls++] =
            (bw_film_wall){.direction = d, .at = end == 0 ? 0.0 : g->length[d], .upper = end == 1};
  }
}

static bw_status make_interface(bw_coupler *c, bw_pd_interface **out)
{
  static const double AT_ONCE = 1e-6; /* of a horizon: any opening */
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_pd_interface_config surface = bw_pd_interface_config_default();
  surface.threshold = AT_ONCE;
  memcpy(surface.walled, c->config.walled, sizeof surface.walled);
  memcpy(surface.upper, g->length, sizeof surface.upper);
  memset(surface.lower, 0, sizeof surface.lower);
  return bw_pd_interface_create(c->solid, &surface, out);
}

/* Part of a marker's force that its kernel puts beyond each distance, by the trapezoidal rule. */
static void find_spread(const bw_coupler *c, double spread[])
{
  const bw_kernel_delta *kernel = bw_kernel_delta_get(c->config.kernel);
  const double step = kernel->radius / BW_COUPLER__SPREAD;
  spread[BW_COUPLER__SPREAD] = 0.0;
  for (int i = BW_COUPLER__SPREAD; i-- > 0;)
    spread[i] = spread[i + 1] + 0.5 * step * (kernel->phi(step * i) + kernel->phi(step * (i + 1)));
}

bw_status bw_coupler__solid_films_create(bw_coupler *c)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_coupler_films *config = &c->config.films;
  bw_film_net_config net = bw_film_net_config_default();
  const bw_solid_config *solid = bw_solid_settings(c->solid);
  BW_TRY(bw_coupler__films_check(config, c->h));
  BW_REQUIRE(solid->finer.n == 0 && solid->finer.refine.level == 0, BW_EINPUT,
             "films: a solid with levels has particles of several spacings; films are found for "
             "one: leave levels or films out");
  bw_status st = BW_ALLOCATE(&c->films, 1);
  if (st == BW_OK) {
    c->films->rank = bw_comm_rank(bw_solid_comm(c->solid));
    net.planar = g->n[2] == 1;
    net.depth = solid->thickness;
    net.mu = c->config.rho * c->config.nu;
    /* Probes are shortened below three cells and a part, at once. */
    const double cells = c->config.load == BW_LOAD_PROBES ? 4.0 : 3.0;
    net.limit = isnan(config->limit) ? cells * c->h : config->limit;
    net.full = 5.0 / 6.0 * net.limit;
    net.roughness = config->roughness, net.least = config->least;
    net.spacing = solid->ds;
    find_walls(c, &net);
    find_spread(c, c->films->spread);
    st = bw_film_net_create(&net, &c->films->net);
    BW_THEN(st, bw_coupler__solid_films_grid_create(c));
  }
  BW_TRY(bw_comm_agree(bw_solid_comm(c->solid), st));
  return make_interface(c, &c->films->interface);
}

static void release_points(bw_coupler__solid_films *f)
{
  double **const all[] = {&f->X,    &f->N,       &f->H,       &f->A,          &f->mobility,
                          &f->V,    &f->L,       &f->F,       &f->T,          &f->p_mid,
                          &f->edge, &f->probe_X, &f->probe_N, &f->probe_A,    &f->traction,
                          &f->told, &f->brake,   &f->moved,   &f->source_rate};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_release(&f->probe_of);
  bw_release(&f->point_node);
  bw_release(&f->source_cell);
  bw_release(&f->flag);
  f->room = 0;
}

static bw_status make_points(bw_coupler__solid_films *f, size_t n)
{
  if (n <= f->room) return BW_OK;
  const size_t room = n + n / 8;
  double **const all[] = {&f->X,       &f->N,       &f->V,       &f->L,        &f->F,    &f->T,
                          &f->probe_X, &f->probe_N, &f->probe_A, &f->traction, &f->told, &f->brake};
  double **const scalar[] = {&f->H, &f->A, &f->mobility, &f->edge, &f->p_mid, &f->moved};
  release_points(f);
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    BW_TRY(BW_ALLOCATE(all[q], 3 * room));
  for (size_t q = 0; q < sizeof scalar / sizeof *scalar; q++)
    BW_TRY(BW_ALLOCATE(scalar[q], room));
  BW_TRY(BW_ALLOCATE(&f->probe_of, room));
  BW_TRY(BW_ALLOCATE(&f->point_node, room));
  BW_TRY(BW_ALLOCATE(&f->source_cell, 8 * room));
  BW_TRY(BW_ALLOCATE(&f->source_rate, 8 * room));
  BW_TRY(BW_ALLOCATE(&f->flag, room));
  f->room = room;
  return BW_OK;
}

static void release_rows(bw_coupler__solid_films *f)
{
  double **const all[] = {&f->base, &f->density, &f->before, &f->v, &f->a, &f->edge_p, &f->carried};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_release(&f->row);
  bw_release(&f->node_of);
}

void bw_coupler__solid_films_destroy(bw_coupler__solid_films **films)
{
  bw_coupler__solid_films *f = *films;
  if (f == NULL) return;
  release_points(f);
  release_rows(f);
  bw_coupler__solid_films_grid_release(f);
  bw_release(&f->list);
  bw_film_net_destroy(&f->net);
  bw_pd_interface_destroy(&f->interface);
  bw_release(films);
}

bw_status bw_coupler__solid_films_rows(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  release_rows(f);
  BW_TRY(BW_ALLOCATE(&f->base, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&f->density, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&f->before, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&f->v, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&f->a, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&f->edge_p, c->n));
  BW_TRY(BW_ALLOCATE(&f->carried, c->n));
  BW_TRY(BW_ALLOCATE(&f->row, c->n));
  BW_TRY(BW_ALLOCATE(&f->node_of, c->n));
  for (size_t i = 0; i < c->n; i++)
    f->edge_p[i] = NAN, f->node_of[i] = -1;
  return BW_OK;
}

bool bw_coupler__solid_films_any(const bw_coupler *c)
{
  return c->films != NULL && c->films->n_nodes > 0;
}

bool bw_coupler__solid_films_flow(const bw_coupler *c)
{
  return c->config.films.flux && bw_coupler__solid_films_any(c);
}

/* From none where a gap is a cell, on to all where it is two. */
static double apart(const bw_coupler *c, size_t p)
{
  const int32_t a = c->films->node_of[p];
  return a < 0 ? 1.0 : fmin(1.0, fmax(0.0, c->films->node[a].gap / c->h - 1.0));
}

double bw_coupler__solid_films_keep(const bw_coupler *c, size_t p)
{
  const bool tight = c->films != NULL && c->config.films.flux;
  if (c->broken[p] > 0 && !tight) return NAN;
  return c->films == NULL || tight ? 1.0 : apart(c, p);
}

bw_status bw_coupler__solid_films_aim(bw_coupler *c)
{
  const bw_coupler__solid_films *f = c->films;
  double *V = c->marker_V;
  if (!bw_coupler__solid_films_flow(c)) return BW_OK;
  for (size_t q = 0; q < c->n_surface; q++) {
    const int32_t a = f->node_of[c->particle[q]];
    const double own = apart(c, (size_t)c->particle[q]);
    if (a < 0) continue;
    for (size_t d = 0; d < 3; d++)
      V[3 * q + d] += (1.0 - own) * (f->told[3 * (size_t)a + d] - V[3 * q + d]);
  }
  /* Blocks know the mean of their members. */
  return c->block > 1 ? bw_coupler__blocks_follow(c) : BW_OK;
}

double *bw_coupler__solid_films_edge(const bw_coupler *c)
{
  return c->films == NULL ? NULL : c->films->edge_p;
}

/* ---- who faces whom ---- */

static int by_id(const void *a, const void *b)
{
  const bw_coupler__film_point *p = a, *q = b;
  return (p->id > q->id) - (p->id < q->id);
}

/* The surface points of this rank that the fluid meets. */
static bw_status own_points(bw_coupler *c, size_t *n, bw_coupler__film_point **out)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_pd_surface s = bw_pd_interface_surface(c->films->interface);
  const uint8_t *kind = bw_solid_kind(c->solid);
  BW_TRY(BW_ALLOCATE(out, s.n));
  *n = 0;
  for (size_t q = 0; q < s.n; q++) {
    const size_t p = (size_t)s.particle[q];
    if (kind[p] & BW_PD_RETIRED || !bw_coupler__within_box(g, s.X + 3 * q)) continue;
    const double mass = bw_solid_density(c->solid, p) * bw_solid_volume_of(c->solid, p);
    bw_coupler__film_point *o = *out + (*n)++;
    *o = (bw_coupler__film_point){.id = bw_solid_id(c->solid)[p],
                                  .rank = (int32_t)c->films->rank,
                                  .particle = (int32_t)p,
                                  .H = s.H[q],
                                  .A = s.A[q],
                                  .mobility = kind[p] & BW_PD_PRESCRIBED ? 0.0 : 1.0 / mass};
    memcpy(o->X, s.X + 3 * q, sizeof o->X);
    memcpy(o->N, s.N + 3 * q, sizeof o->N);
  }
  return BW_OK;
}

/* The points of all ranks, in the order of their ids. Collective. */
static bw_status gather_points(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  const bw_comm *comm = bw_solid_comm(c->solid);
  bw_coupler__film_point *own = NULL;
  size_t n = 0, bytes = 0;
  void *all = NULL;
  bw_release(&f->list);
  bw_status st = bw_comm_agree(comm, own_points(c, &n, &own));
  BW_THEN(st, bw_comm_allgather(comm, n * sizeof *own, own, &bytes, &all));
  bw_release(&own);
  if (st != BW_OK) return st;
  f->list = all;
  f->n = bytes / sizeof *f->list;
  if (f->n > 0) qsort(f->list, f->n, sizeof *f->list, by_id);
  BW_TRY(bw_comm_agree(comm, make_points(f, f->n)));
  for (size_t s = 0; s < f->n; s++) {
    memcpy(f->X + 3 * s, f->list[s].X, sizeof f->list[s].X);
    memcpy(f->N + 3 * s, f->list[s].N, sizeof f->list[s].N);
    f->H[s] = f->list[s].H, f->A[s] = f->list[s].A, f->mobility[s] = f->list[s].mobility;
  }
  return BW_OK;
}

bw_status bw_coupler__solid_films_follow(bw_coupler *c)
{
  c->films->stale = true;
  return bw_pd_interface_update(c->films->interface);
}

bw_status bw_coupler__solid_films_find(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  if (!f->stale) return BW_OK;
  f->stale = false;
  BW_TRY(gather_points(c));
  const bw_film_points points = {f->n, f->X, f->N, f->H, f->A, f->mobility};
  BW_TRY(bw_comm_agree(bw_solid_comm(c->solid), bw_film_net_find(f->net, &points)));
  f->n_nodes = bw_film_net_nodes(f->net, &f->node);
  f->n_used = bw_film_net_used(f->net, &f->used);
  f->n_edges = bw_film_net_edges(f->net, &f->edge_point);
  for (size_t i = 0; i < c->n; i++)
    f->node_of[i] = -1;
  for (size_t a = 0; a < f->n_nodes; a++)
    if (bw_coupler__film_own(f, f->node[a].point))
      f->node_of[f->list[f->node[a].point].particle] = (int32_t)a;
  for (size_t i = 0; i < c->n; i++)
    f->row[i] = -1;
  for (size_t q = 0; q < c->n_surface; q++)
    f->row[c->particle[q]] = (int32_t)q;
  return BW_OK;
}
