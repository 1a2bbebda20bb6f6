/* Sites of the bodies of one lattice: which they occupy, which are held, of which group. */
#include "scene_impl.h"

#include "bw_exchange.h"
#include "bw_memory.h"
#include <math.h>
#include <string.h>

void bw_scene__sites_release(bw_scene__sites *sites)
{
  bw_release(&sites->site);
  bw_release(&sites->kind);
  bw_release(&sites->group);
  sites->n = 0;
}

static void place_of(const bw_solid_config *c, const int32_t site[3], double x[3])
{
  const bool flat = c->geometry != BW_PD_3D;
  for (int k = 0; k < 3; k++) {
    x[k] = c->origin[k];
    for (int d = 0; d < (flat ? 2 : 3); d++)
      x[k] += (site[d] + 0.5) * c->ds * c->axes[d][k];
  }
}

/* Extent of the particles, their cells included, of all ranks. Collective. */
static void extent(const bw_comm *comm, const bw_solid_config *c, const bw_scene__sites *sites,
                   double lower[3], double upper[3])
{
  for (int d = 0; d < 3; d++)
    lower[d] = HUGE_VAL, upper[d] = -HUGE_VAL;
  for (int64_t i = 0; i < sites->n; i++) {
    double x[3];
    place_of(c, sites->site + 3 * i, x);
    for (int d = 0; d < 3; d++) {
      lower[d] = fmin(lower[d], x[d] - 0.5 * c->ds);
      upper[d] = fmax(upper[d], x[d] + 0.5 * c->ds);
    }
  }
  bw_comm_min(comm, 3, lower);
  bw_comm_max(comm, 3, upper);
}

bool bw_scene__in_where(const bw_scene_where *w, bool planar, double ds, const double lower[3],
                        const double upper[3], const double x[3])
{
  int d, end;
  if (w->has_box && !bw_scene__in_box(&w->box, planar, ds, x)) return false;
  if (w->side[0] == '\0') return true;
  /* In the outermost layers along that direction: the tie is far from any centre. */
  (void)bw_scene__side_named(w->side, &d, &end);
  const double depth = end == 0 ? x[d] - lower[d] : upper[d] - x[d];
  return depth < w->layers * ds;
}

static bool is_held(const bw_scene__solid *q, const bw_scene_config *c, const bw_scene_body *b,
                    double ds, const double lower[3], const double upper[3], const double x[3])
{
  (void)q;
  for (int k = 0; k < b->n_held; k++) {
    const bw_scene_held *h = &b->held[k];
    /* Held by a body: that body's own particles do it, which are on this lattice. */
    if (h->by[0] != '\0') continue;
    bw_scene_where w = {.layers = h->layers, .has_box = h->has_box, .box = h->box};
    memcpy(w.side, h->side, sizeof w.side);
    if (bw_scene__in_where(&w, bw_scene__planar(c), ds, lower, upper, x)) return true;
  }
  return false;
}

/* Bits of the particles of one body: held, moved by a load, unbreakable. Collective. */
static void set_kinds(bw_scene *s, int b, const bw_scene__solid *q, const bw_solid_config *config,
                      bw_scene__sites *sites)
{
  const bw_scene_config *c = &s->config;
  const bw_scene_body *body = &c->bodies[b];
  double lower[3], upper[3];
  extent(s->comm, config, sites, lower, upper);
  for (int64_t i = 0; i < sites->n; i++) {
    double x[3];
    place_of(config, sites->site + 3 * i, x);
    uint8_t kind = sites->kind[i];
    if (!bw_scene__deforms(body) || is_held(q, c, body, config->ds, lower, upper, x))
      kind |= BW_PD_PRESCRIBED;
    for (int k = 0; k < c->n_loads; k++) {
      const bw_scene_load *l = &c->loads[k];
      if (strcmp(l->on, body->name) != 0) continue;
      if (l->kind != BW_SCENE_VELOCITY && !l->unbreakable) continue;
      if (l->has_where && !bw_scene__in_where(&l->where, s->planar, config->ds, lower, upper, x))
        continue;
      if (l->kind == BW_SCENE_VELOCITY) kind |= BW_PD_PRESCRIBED;
      if (l->unbreakable) kind |= BW_PD_UNBREAKABLE;
    }
    sites->kind[i] = kind;
  }
}

/* The material group of each part of a body; parts without a material have the body's. */
static int group_of(const bw_scene *s, bw_scene__solid *q, int b, const char *material)
{
  const int m = bw_scene__material_named(&s->config, material);
  for (int g = 0; g < q->n_groups; g++)
    if (q->body_of[g] == b && q->material_of[g] == m) return g;
  if (q->n_groups == BW_PD_GROUPS) return -1;
  q->body_of[q->n_groups] = b;
  q->material_of[q->n_groups] = m;
  return q->n_groups++;
}

static bw_status set_groups(bw_scene *s, bw_scene__solid *q, int b, bw_scene__shapes *shapes)
{
  const bw_scene_body *body = &s->config.bodies[b];
  for (int k = 0; k < shapes->n; k++) {
    const bw_scene_shape *part = &body->shape[shapes->part[k]];
    const int group =
        group_of(s, q, b, part->material[0] != '\0' ? part->material : body->material);
    BW_REQUIRE(group >= 0, BW_EINPUT,
               "bodies.%s: bodies that hold each other or share a flow have more than %d materials "
               "and bodies together, which this build cannot tell apart",
               body->name, BW_PD_GROUPS);
    shapes->shape[k].particle_group = (uint8_t)group;
    shapes->shape[k].particle_kind = part->held ? BW_PD_PRESCRIBED : BW_PD_FREE;
  }
  return BW_OK;
}

static bw_status make_room(size_t n, bw_scene__sites *sites)
{
  bw_status st = BW_ALLOCATE(&sites->site, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&sites->kind, n));
  BW_THEN(st, BW_ALLOCATE(&sites->group, n));
  sites->n = (int64_t)n;
  if (st != BW_OK) bw_scene__sites_release(sites);
  return st;
}

/* The sites of a body behind those that are there. */
static bw_status append(bw_scene__sites *all, const bw_scene__sites *one)
{
  bw_scene__sites sum = {0};
  const size_t n = (size_t)all->n, more = (size_t)one->n;
  bw_status st = make_room(n + more, &sum);
  if (st == BW_OK && n > 0) {
    memcpy(sum.site, all->site, 3 * n * sizeof *sum.site);
    memcpy(sum.kind, all->kind, n);
    memcpy(sum.group, all->group, n);
  }
  if (st == BW_OK) {
    memcpy(sum.site + 3 * n, one->site, 3 * more * sizeof *sum.site);
    memcpy(sum.kind + n, one->kind, more);
    memcpy(sum.group + n, one->group, more);
  }
  bw_scene__sites_release(all);
  *all = sum;
  return st;
}

/* A site on its way to the rank that gives it to the solid. */
typedef struct {
  int64_t number; /* in the order of all ranks */
  int32_t site[3];
  uint8_t kind, group;
} traveller;

/* Number of each own site, body after body, whatever the ranks: a particle's id is its place in the
 * list of all, and has to be the same in a restart on other ranks. share (n_bodies): how many of
 * each body are here. Returns how many there are. Collective. */
static int64_t number_sites(const bw_comm *comm, int n_bodies, const int64_t share[],
                            const bw_scene__sites *sites, traveller item[])
{
  int64_t before = 0, i = 0;
  for (int k = 0; k < n_bodies; k++) {
    int64_t all = share[k], at = before + bw_comm_prefix_sum(comm, share[k]);
    bw_comm_sum_int(comm, 1, &all);
    before += all;
    for (int64_t q = 0; q < share[k]; q++, i++) {
      item[i] = (traveller){.number = at + q, .kind = sites->kind[i], .group = sites->group[i]};
      memcpy(item[i].site, sites->site + 3 * i, sizeof item[i].site);
    }
  }
  return before;
}

/* To the ranks of the plan, each of which has a row of numbers from `first` on. Collective. */
static bw_status travel(const bw_comm *comm, size_t n, const int to[], const traveller item[],
                        int64_t first, bw_scene__sites *out)
{
  bw_exchange *plan = NULL;
  traveller *come = NULL;
  bw_status st = bw_exchange_create(comm, n, to, &plan);
  BW_TRY(st);
  const size_t all = bw_exchange_received(plan);
  st = BW_ALLOCATE(&come, all);
  BW_THEN(st, make_room(all, out));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) bw_exchange_forward(plan, sizeof *item, item, come);
  for (size_t i = 0; st == BW_OK && i < all; i++) {
    const size_t at = (size_t)(come[i].number - first);
    memcpy(out->site + 3 * at, come[i].site, sizeof come[i].site);
    out->kind[at] = come[i].kind, out->group[at] = come[i].group;
  }
  bw_exchange_destroy(&plan);
  bw_release(&come);
  return st;
}

/* The sites of several bodies, of which each rank has a share, in the order of the bodies over all
 * ranks. Collective. */
static bw_status put_in_order(const bw_comm *comm, int n_bodies, const int64_t share[],
                              bw_scene__sites *sites)
{
  const int64_t size = bw_comm_size(comm), rank = bw_comm_rank(comm);
  const size_t n = (size_t)sites->n;
  traveller *item = NULL;
  int *to = NULL;
  bw_scene__sites sorted = {0};
  if (n_bodies < 2 || size == 1) return BW_OK;
  bw_status st = BW_ALLOCATE(&item, n);
  BW_THEN(st, BW_ALLOCATE(&to, n));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    const int64_t all = number_sites(comm, n_bodies, share, sites, item);
    /* Rank r has the numbers from r all/size, rounded down, on. */
    for (size_t i = 0; i < n; i++)
      to[i] = (int)(((item[i].number + 1) * size - 1) / all);
    st = travel(comm, n, to, item, all * rank / size, &sorted);
  }
  bw_release(&item);
  bw_release(&to);
  if (st == BW_OK) {
    bw_scene__sites_release(sites);
    *sites = sorted;
  } else
    bw_scene__sites_release(&sorted);
  return st;
}

static bw_status fill_body(bw_scene *s, bw_scene__solid *q, int b, const bw_solid_config *config,
                           bw_scene__sites *one)
{
  bw_scene__shapes shapes;
  bw_shape_lattice lattice = {.ds = config->ds, .planar = s->planar};
  memcpy(lattice.origin, config->origin, sizeof lattice.origin);
  memcpy(lattice.axes, config->axes, sizeof lattice.axes);
  bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
  BW_THEN(st, set_groups(s, q, b, &shapes));
  st = bw_comm_agree(s->comm, st);
  BW_THEN(st, bw_shape_fill_shared(s->comm, shapes.n, shapes.shape, &lattice, &one->n, &one->site,
                                   &one->kind, &one->group));
  bw_scene__shapes_release(&shapes);
  return bw_scene__of_body(&s->config, b, st);
}

bw_status bw_scene__sites_groups(bw_scene *s, bw_scene__solid *q)
{
  for (int k = 0; k < q->n_bodies; k++) {
    bw_scene__shapes shapes;
    bw_status st = bw_scene__shapes_make(&s->config, q->body[k], &shapes);
    BW_THEN(st, set_groups(s, q, q->body[k], &shapes));
    bw_scene__shapes_release(&shapes);
    BW_TRY(st);
  }
  return BW_OK;
}

bw_status bw_scene__sites_make(bw_scene *s, bw_scene__solid *q, const bw_solid_config *config,
                               bw_scene__sites *out)
{
  bw_status st = BW_OK;
  int64_t share[BW_SCENE_BODIES];
  *out = (bw_scene__sites){0};
  for (int k = 0; k < q->n_bodies && st == BW_OK; k++) {
    bw_scene__sites one = {0};
    st = fill_body(s, q, q->body[k], config, &one);
    if (st == BW_OK) set_kinds(s, q->body[k], q, config, &one);
    share[k] = one.n;
    if (st == BW_OK) st = bw_comm_agree(s->comm, append(out, &one));
    bw_scene__sites_release(&one);
  }
  BW_THEN(st, put_in_order(s->comm, q->n_bodies, share, out));
  return st;
}
