/* Who owns which particle, which copies a rank needs, and how they are kept current.
 *
 * No rank sees a list of all. Each passes the sites it happens to know, the division among ranks is
 * found by counting (bw_particles_partition), rows go to their owners, and the places around own
 * particles that others own are asked for. */
#include "bw_memory.h"
#include "bw_particles_halo.h"
#include "bw_particles_order.h"
#include "bw_particles_partition.h"
#include "pd_body.h"

#include <math.h>
#include <string.h>

/* One particle on its way to its owner. */
typedef struct {
  int64_t id;
  int32_t site[3];
  uint8_t kind, group, level;
} passenger;

/* What is known while the body is divided. */
typedef struct {
  bw_particles_partition *partition;
  int32_t lower[3], upper[3]; /* of all sites */
  int32_t period[3];          /* in steps, 0: not periodic */
  size_t n;
  passenger *own; /* (n) as they arrived */
} crowd;

static bw_status extent_of_all(const bw_pd_body *pd, size_t n, const int32_t site[], crowd *g)
{
  double most[6];
  bw_particles_extent(n, site, g->lower, g->upper);
  /* One maximum for both ends: that of the lower one is taken with its sign turned. */
  for (int k = 0; k < 3; k++) {
    most[k] = n > 0 ? -(double)g->lower[k] : -INFINITY;
    most[3 + k] = n > 0 ? (double)g->upper[k] : -INFINITY;
  }
  bw_comm_max(pd->comm, 6, most);
  for (int k = 0; k < 3; k++) {
    /* Sites are numbered in 32 bits with room for images around them. */
    const double size = most[3 + k] + most[k] + 1;
    const int32_t period = (int32_t)lround(pd->config.period[k] / pd->level->stencil.unit);
    BW_REQUIRE(size < 1 << 20, BW_EINPUT,
               "solid: sites reach over %.0f steps in direction %d; the limit is 2^20", size, k);
    BW_REQUIRE(period == 0 || size <= period, BW_EINPUT,
               "solid: sites reach over %.0f steps in direction %d, whose period has %d", size, k,
               period);
    g->lower[k] = (int32_t)-most[k], g->upper[k] = (int32_t)most[3 + k];
    g->period[k] = period;
  }
  BW_REQUIRE(pd->dimension == 3 || (g->lower[2] == 0 && g->upper[2] == 0), BW_EINPUT,
             "solid: in 2D every site[2] must be 0; they lie in %d .. %d", g->lower[2],
             g->upper[2]);
  return BW_OK;
}

/* The rows that this rank was given go to their owners. Collective. */
static bw_status send_home(const bw_pd_body *pd, const bw_pd_refined *refined, crowd *g)
{
  const bw_pd_sites *given = &refined->sites;
  const size_t n = (size_t)given->n;
  const int64_t first = bw_comm_prefix_sum(pd->comm, given->n);
  passenger *row = NULL;
  int *owner = NULL;
  bw_exchange *plan = NULL;
  bw_status st = BW_ALLOCATE(&row, n);
  BW_THEN(st, BW_ALLOCATE(&owner, n));
  for (size_t q = 0; q < n && st == BW_OK; q++) {
    /* A global id is the row in the joined lists of all ranks. */
    row[q].id = first + (int64_t)q;
    memcpy(row[q].site, given->site + 3 * q, sizeof row[q].site);
    row[q].kind = given->kind == NULL ? BW_PD_FREE : given->kind[q];
    row[q].group = given->group == NULL ? 0 : given->group[q];
    row[q].level = refined->level == NULL ? 0 : refined->level[q];
    owner[q] = bw_particles_partition_owner(g->partition, row[q].site);
  }
  /* The plan is collective: nobody makes it unless all can. */
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) st = bw_exchange_create(pd->comm, n, owner, &plan);
  if (st == BW_OK) {
    g->n = bw_exchange_received(plan);
    st = bw_comm_agree(pd->comm, BW_ALLOCATE(&g->own, g->n));
  }
  if (st == BW_OK) bw_exchange_forward(plan, sizeof *row, row, g->own);
  bw_exchange_destroy(&plan);
  bw_release(&row);
  bw_release(&owner);
  return st;
}

/* Own particles in lattice order: the first n rows of points. `order` (n) is scratch. */
static bw_status settle(bw_pd_body *pd, const crowd *g, int32_t *site, uint8_t *level,
                        int32_t *order)
{
  int32_t lower[3], upper[3];
  int64_t size[3];
  for (size_t q = 0; q < g->n; q++) {
    memcpy(site + 3 * q, g->own[q].site, sizeof g->own[q].site);
    level[q] = g->own[q].level;
  }
  bw_particles_extent(g->n, site, lower, upper);
  for (int k = 0; k < 3; k++)
    size[k] = (int64_t)upper[k] - lower[k] + 1;
  /* Which axis is fastest follows from the shape of this rank's part. */
  bw_pd_body_axes(size, pd->level->stencil.reach, pd->points.axis);
  return bw_pd_body_order(pd, g->n, site, level, order);
}

static bw_status settle_own(bw_pd_body *pd, const crowd *g, passenger **sorted)
{
  int32_t *site = NULL, *order = NULL;
  uint8_t *level = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * g->n);
  BW_THEN(st, BW_ALLOCATE(&level, g->n));
  BW_THEN(st, BW_ALLOCATE(&order, g->n));
  BW_THEN(st, BW_ALLOCATE(sorted, g->n));
  BW_THEN(st, settle(pd, g, site, level, order));
  for (size_t i = 0; i < g->n && st == BW_OK; i++)
    (*sorted)[i] = g->own[order[i]];
  bw_release(&site);
  bw_release(&level);
  bw_release(&order);
  return st;
}

/* site -> own number, with room for what is in reach around. */
static bw_status near_own(const bw_pd_body *pd, size_t n, const passenger own[],
                          bw_particles_map *near)
{
  int32_t lower[3] = {0}, upper[3] = {0};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      const int32_t x = own[i].site[k];
      lower[k] = i == 0 || x < lower[k] ? x : lower[k];
      upper[k] = i == 0 || x > upper[k] ? x : upper[k];
    }
  int reach = 0;
  for (int l = 0; l <= pd->finest; l++)
    reach = pd->level[l].stencil.reach > reach ? pd->level[l].stencil.reach : reach;
  for (int k = 0; k < 3; k++) {
    lower[k] -= reach;
    upper[k] += reach;
  }
  BW_TRY(bw_particles_map_create(2 * n, lower, upper, near));
  for (size_t i = 0; i < n; i++) {
    int32_t found;
    BW_TRY(bw_particles_map_put(near, own[i].site, (int32_t)i, &found));
    BW_REQUIRE(found < 0, BW_EINPUT, "solid: particles %lld and %lld are both on site (%d,%d,%d)",
               (long long)own[found].id, (long long)own[i].id, own[i].site[0], own[i].site[1],
               own[i].site[2]);
  }
  return BW_OK;
}

static int32_t find_own(const void *near, const void *key)
{
  return bw_particles_map_get((const bw_particles_map *)near, (const int32_t *)key);
}

/* With several levels: where the bonds of an own particle lead. */
typedef struct {
  const bw_pd_body *pd;
  const passenger *own;
} asker;

static int offsets_of(const void *context, size_t i, int32_t offset[])
{
  const asker *q = (const asker *)context;
  const int l = q->own[i].level;
  const bw_pd_stencil *s = &q->pd->level[l].stencil;
  int n = 0;
  for (int d = 0; d < s->n; d++)
    if (bw_pd_body_leads(q->pd, l, d, q->own[i].site))
      memcpy(offset + 3 * n++, s->offset + 3 * d, 3 * sizeof *offset);
  return n;
}

/* The occupied places around own particles that others, or images, occupy. Collective. */
static bw_status find_copies(const bw_pd_body *pd, const crowd *g, const passenger own[],
                             const int32_t site[], bw_particles_map *near, bw_particles_halo *halo)
{
  const asker q = {.pd = pd, .own = own};
  bw_particles_lattice lattice = {.partition = g->partition,
                                  .n_offset = pd->directions,
                                  .offset = pd->level->stencil.offset,
                                  .offsets_of = pd->finest > 0 ? offsets_of : NULL,
                                  .context = &q};
  memcpy(lattice.lower, g->lower, sizeof lattice.lower);
  memcpy(lattice.period, g->period, sizeof lattice.period);
  return bw_particles_halo_create(pd->comm, &lattice, pd->n, site, near, halo);
}

/* Own particles, then copies in lattice order; what copies are comes with the first exchange. */
static bw_status extended_arrays(bw_pd_body *pd, const passenger own[],
                                 const bw_particles_halo *halo, const int32_t order[],
                                 bw_particles_map *near)
{
  bw_pd_points *p = &pd->points;
  const size_t n = pd->n, all = pd->n_extended = n + halo->n;
  BW_TRY(BW_ALLOCATE(&p->site, 3 * all));
  BW_TRY(BW_ALLOCATE(&p->id, all));
  BW_TRY(BW_ALLOCATE(&p->kind, all));
  BW_TRY(BW_ALLOCATE(&p->group, all));
  if (pd->finest > 0) BW_TRY(BW_ALLOCATE(&p->level, all));
  BW_TRY(BW_ALLOCATE(&p->place, all));
  BW_TRY(BW_ALLOCATE(&pd->halo.extended_X, 3 * all));
  for (size_t i = 0; i < n; i++) {
    memcpy(p->site + 3 * i, own[i].site, sizeof own[i].site);
    p->id[i] = own[i].id;
    p->kind[i] = own[i].kind;
    p->group[i] = own[i].group;
    if (p->level != NULL) p->level[i] = own[i].level;
  }
  for (size_t c = 0; c < halo->n; c++) {
    int32_t *site = p->site + 3 * (n + c);
    memcpy(site, halo->place + 3 * (size_t)order[c], 3 * sizeof *site);
    bw_particles_map_replace(near, site, (int32_t)(n + c));
    if (p->level != NULL) p->level[n + c] = bw_pd_body_level_of_place(pd, site);
  }
  return BW_OK;
}

/* Copies ask their owners by the site where these have them. Collective. */
static bw_status plan_halo(bw_pd_body *pd, const bw_particles_halo *halo, const int32_t order[],
                           const bw_particles_map *near)
{
  bw_pd_points *p = &pd->points;
  int32_t *home = NULL;
  int *owner = NULL;
  /* The halo lists places in the order of the search, copies are numbered as they are stored. */
  bw_status st = BW_ALLOCATE(&home, 3 * halo->n);
  BW_THEN(st, BW_ALLOCATE(&owner, halo->n));
  for (size_t c = 0; c < halo->n && st == BW_OK; c++) {
    memcpy(home + 3 * c, halo->home + 3 * (size_t)order[c], 3 * sizeof *home);
    owner[c] = halo->owner[order[c]];
  }
  /* Asking is collective: no rank may begin without the others. */
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) {
    const bw_particles_question ask = {.n = halo->n,
                                       .owner = owner,
                                       .key_bytes = 3 * sizeof *home,
                                       .key = home,
                                       .find = find_own,
                                       .context = near};
    st = bw_particles_copies_create(pd->comm, pd->n, &ask, 6 * sizeof(bw_real), &pd->halo.copies);
  }
  /* What never changes is sent once; motion comes with every refresh. */
  if (st == BW_OK) {
    bw_particles_copies_values(pd->halo.copies, sizeof *p->id, p->id, p->id);
    bw_particles_copies_values(pd->halo.copies, sizeof *p->kind, p->kind, p->kind);
    bw_particles_copies_values(pd->halo.copies, sizeof *p->group, p->group, p->group);
  }
  bw_release(&home);
  bw_release(&owner);
  return st;
}

/* As bw_pd_body_order, of places that tell their level. */
static bw_status order_places(const bw_pd_body *pd, size_t n, const int32_t place[],
                              int32_t order[])
{
  uint8_t *level = NULL;
  bw_status st = BW_ALLOCATE(&level, n);
  for (size_t q = 0; q < n && st == BW_OK && pd->finest > 0; q++)
    level[q] = bw_pd_body_level_of_place(pd, place + 3 * q);
  BW_THEN(st, bw_pd_body_order(pd, n, place, level, order));
  bw_release(&level);
  return st;
}

/* Copies of what is near, once every particle is with its owner. Collective. */
static bw_status make_copies(bw_pd_body *pd, const crowd *g, const passenger own[],
                             bw_particles_map *near)
{
  bw_particles_halo halo = {0};
  int32_t *site = NULL, *order = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * pd->n);
  for (size_t i = 0; i < pd->n && st == BW_OK; i++)
    memcpy(site + 3 * i, own[i].site, sizeof own[i].site);
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) st = find_copies(pd, g, own, site, near, &halo);
  if (st == BW_OK) {
    st = BW_ALLOCATE(&order, halo.n);
    BW_THEN(st, order_places(pd, halo.n, halo.place, order));
    BW_THEN(st, extended_arrays(pd, own, &halo, order, near));
    st = bw_comm_agree(pd->comm, st);
  }
  if (st == BW_OK) st = plan_halo(pd, &halo, order, near);
  bw_release(&site);
  bw_release(&order);
  bw_particles_halo_destroy(&halo);
  return st;
}

/* Rows at home, who is near, which copies. Collective. */
static bw_status divide(bw_pd_body *pd, const bw_pd_refined *given, crowd *g,
                        bw_particles_map *near)
{
  passenger *own = NULL;
  bw_status st = bw_particles_partition_create(pd->comm, (size_t)given->sites.n, given->sites.site,
                                               &g->partition);
  if (st == BW_OK) st = send_home(pd, given, g);
  if (st == BW_OK) {
    pd->n = g->n;
    pd->points.total = bw_particles_partition_total(g->partition);
    st = settle_own(pd, g, &own);
    BW_THEN(st, near_own(pd, g->n, own, near));
    st = bw_comm_agree(pd->comm, st);
  }
  bw_release(&g->own);
  if (st == BW_OK) st = make_copies(pd, g, own, near);
  bw_release(&own);
  return st;
}

bw_status bw_pd_body_distribute(bw_pd_body *pd, const bw_pd_refined *given, bw_particles_map *near)
{
  crowd g = {0};
  bw_status st = extent_of_all(pd, (size_t)given->sites.n, given->sites.site, &g);
  if (st == BW_OK) st = divide(pd, given, &g, near);
  bw_particles_partition_destroy(&g.partition);
  bw_release(&g.own);
  return st;
}

/* Copies' displacement (and velocity) from their owners. Collective. */
void bw_pd_body_refresh(bw_pd_body *pd, bool velocity)
{
  bw_particles_copies *c = pd->halo.copies;
  const size_t width = velocity ? 6 : 3, copies = pd->n_extended - pd->n;
  const size_t rows = bw_particles_copies_rows(c);
  const int32_t *asked = bw_particles_copies_asked(c);
  bw_real *reply = (bw_real *)bw_particles_copies_reply(c);
  bw_real *answer = (bw_real *)bw_particles_copies_answer(c);
  /* Own velocities lie beside each other; neighbours read them at their places. */
  if (velocity)
    for (size_t r = 0; r < pd->bonds.n_run; r++)
      for (int k = 0; k < 3; k++)
        memcpy(pd->vs[k] + pd->bonds.run[r].place, pd->v[k] + pd->bonds.run[r].own,
               (size_t)pd->bonds.run[r].n * sizeof(bw_real));
  /* One message for both: displacement, then velocity, a row per copy that others hold. */
  for (size_t q = 0; q < rows; q++) {
    const int32_t own = asked[q], place = pd->points.place[own];
    for (size_t k = 0; k < 3; k++)
      reply[width * q + k] = pd->u[k][place];
    for (size_t k = 3; k < width; k++)
      reply[width * q + k] = pd->v[k - 3][own];
  }
  bw_particles_copies_out(c, width * sizeof(bw_real), reply, answer);
  /* Copies have no row of their own in v: a sweep finds them at their places. */
  for (size_t q = 0; q < copies; q++) {
    const int32_t place = pd->points.place[pd->n + q];
    for (size_t k = 0; k < 3; k++)
      pd->u[k][place] = answer[width * q + k];
    for (size_t k = 3; k < width; k++)
      pd->vs[k - 3][place] = answer[width * q + k];
  }
}

/* Copies' values of a storage array from their owners. Collective. */
void bw_pd_body_fill_places(const bw_pd_body *pd, bw_real *places)
{
  bw_particles_copies *c = pd->halo.copies;
  const size_t copies = pd->n_extended - pd->n, rows = bw_particles_copies_rows(c);
  const int32_t *asked = bw_particles_copies_asked(c);
  bw_real *reply = (bw_real *)bw_particles_copies_reply(c);
  bw_real *answer = (bw_real *)bw_particles_copies_answer(c);
  for (size_t q = 0; q < rows; q++)
    reply[q] = places[pd->points.place[asked[q]]];
  bw_particles_copies_out(c, sizeof(bw_real), reply, answer);
  for (size_t q = 0; q < copies; q++)
    places[pd->points.place[pd->n + q]] = answer[q];
}
