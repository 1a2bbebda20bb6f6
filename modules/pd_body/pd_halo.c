/* Who owns which particle, which copies a rank needs, and how they are kept current.
 *
 * No rank sees a list of all. Each passes the sites it happens to know, the division among ranks is
 * found by counting (bw_particles_partition), rows go to their owners, and the places around own
 * particles that others own are asked for. */
#include "bw_memory.h"
#include "bw_particles_order.h"
#include "bw_particles_partition.h"
#include "pd_body.h"

#include <math.h>
#include <string.h>

/* One particle on its way to its owner. */
typedef struct {
  int64_t id;
  int32_t site[3];
  uint8_t kind, group;
} passenger;

/* What is known while the body is divided. */
typedef struct {
  bw_particles_partition *partition;
  int32_t lower[3], upper[3]; /* of all sites */
  int32_t period[3];          /* in steps, 0: not periodic */
  size_t n;
  passenger *own; /* (n) as they arrived */
} crowd;

/* Sites that may be occupied by somebody else's particle, or by an image. */
typedef struct {
  size_t n, capacity;
  int32_t *there, *home; /* (n,3) where it would act; where its owner has it */
  int *owner;            /* (n) */
} site_list;

static bw_status extent_of_all(const bw_pd_body *pd, size_t n, const int32_t site[], crowd *g)
{
  double most[6];
  bw_particles_extent(n, site, g->lower, g->upper);
  for (int k = 0; k < 3; k++) {
    most[k] = n > 0 ? -(double)g->lower[k] : -INFINITY;
    most[3 + k] = n > 0 ? (double)g->upper[k] : -INFINITY;
  }
  bw_comm_max(pd->comm, 6, most);
  for (int k = 0; k < 3; k++) {
    const double size = most[3 + k] + most[k] + 1;
    const int32_t period = (int32_t)lround(pd->config.period[k] / pd->level->ds);
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
static bw_status send_home(const bw_pd_body *pd, const bw_pd_sites *given, crowd *g)
{
  const size_t n = (size_t)given->n;
  const int64_t first = bw_comm_prefix_sum(pd->comm, given->n);
  passenger *row = NULL;
  int *owner = NULL;
  bw_exchange *plan = NULL;
  bw_status st = BW_ALLOCATE(&row, n);
  BW_THEN(st, BW_ALLOCATE(&owner, n));
  for (size_t q = 0; q < n && st == BW_OK; q++) {
    row[q].id = first + (int64_t)q;
    memcpy(row[q].site, given->site + 3 * q, sizeof row[q].site);
    row[q].kind = given->kind == NULL ? BW_PD_FREE : given->kind[q];
    row[q].group = given->group == NULL ? 0 : given->group[q];
    owner[q] = bw_particles_partition_owner(g->partition, row[q].site);
  }
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
static bw_status settle(bw_pd_body *pd, const crowd *g, int32_t *site, int32_t *order)
{
  int32_t lower[3], upper[3];
  int64_t size[3];
  for (size_t q = 0; q < g->n; q++)
    memcpy(site + 3 * q, g->own[q].site, sizeof g->own[q].site);
  bw_particles_extent(g->n, site, lower, upper);
  for (int k = 0; k < 3; k++)
    size[k] = (int64_t)upper[k] - lower[k] + 1;
  /* Which axis is fastest follows from the shape of this rank's part. */
  bw_pd_body_axes(size, pd->level->stencil.reach, pd->points.axis);
  return bw_particles_lattice_order(pd->points.axis, g->n, site, order);
}

static bw_status settle_own(bw_pd_body *pd, const crowd *g, passenger **sorted)
{
  int32_t *site = NULL, *order = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * g->n);
  BW_THEN(st, BW_ALLOCATE(&order, g->n));
  BW_THEN(st, BW_ALLOCATE(sorted, g->n));
  BW_THEN(st, settle(pd, g, site, order));
  for (size_t i = 0; i < g->n && st == BW_OK; i++)
    (*sorted)[i] = g->own[order[i]];
  bw_release(&site);
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
  for (int k = 0; k < 3; k++) {
    lower[k] -= pd->level->stencil.reach;
    upper[k] += pd->level->stencil.reach;
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

/* Where the particle whose image is at `site` is at home. */
static void home_of(const crowd *g, const int32_t site[3], int32_t home[3])
{
  for (int k = 0; k < 3; k++) {
    const int32_t p = g->period[k];
    home[k] = p == 0 ? site[k] : g->lower[k] + ((site[k] - g->lower[k]) % p + p) % p;
  }
}

static bw_status append(site_list *list, const int32_t there[3], const int32_t home[3], int owner)
{
  if (list->n == list->capacity) {
    site_list more = {.n = list->n, .capacity = 2 * list->capacity + 1024};
    BW_TRY(BW_ALLOCATE(&more.there, 3 * more.capacity));
    BW_TRY(BW_ALLOCATE(&more.home, 3 * more.capacity));
    BW_TRY(BW_ALLOCATE(&more.owner, more.capacity));
    if (list->n > 0) {
      memcpy(more.there, list->there, 3 * list->n * sizeof *more.there);
      memcpy(more.home, list->home, 3 * list->n * sizeof *more.home);
      memcpy(more.owner, list->owner, list->n * sizeof *more.owner);
    }
    bw_release(&list->there);
    bw_release(&list->home);
    bw_release(&list->owner);
    *list = more;
  }
  memcpy(list->there + 3 * list->n, there, 3 * sizeof *there);
  memcpy(list->home + 3 * list->n, home, 3 * sizeof *home);
  list->owner[list->n++] = owner;
  return BW_OK;
}

static void release_list(site_list *list)
{
  bw_release(&list->there);
  bw_release(&list->home);
  bw_release(&list->owner);
}

/* Is the place one that this rank cannot answer for? Then it has to ask its owner. */
static bool foreign(const bw_pd_body *pd, const crowd *g, const bw_particles_map *near,
                    const int32_t there[3], int32_t home[3], int *owner)
{
  bool outside = false;
  home_of(g, there, home);
  for (int k = 0; k < 3; k++)
    outside = outside || home[k] < g->lower[k] || home[k] > g->upper[k];
  if (outside) return false;
  *owner = bw_particles_partition_owner(g->partition, home);
  if (*owner != bw_comm_rank(pd->comm)) return true;
  const bool image = memcmp(there, home, 3 * sizeof *home) != 0;
  return image && bw_particles_map_get(near, home) >= 0;
}

/* Places in reach of own particles that may hold a copy, each once. */
static bw_status list_places(const bw_pd_body *pd, const crowd *g, const passenger own[],
                             const bw_particles_map *near, site_list *places)
{
  const bw_pd_stencil *stencil = &pd->level->stencil;
  bw_particles_map seen = {0};
  if (g->n == 0) return BW_OK;
  int32_t lower[3], upper[3];
  for (int k = 0; k < 3; k++) {
    lower[k] = g->lower[k] - stencil->reach;
    upper[k] = g->upper[k] + stencil->reach;
  }
  bw_status st = bw_particles_map_create(1024, lower, upper, &seen);
  for (size_t i = 0; i < g->n && st == BW_OK; i++)
    for (int q = 0; q < stencil->n && st == BW_OK; q++) {
      const int32_t *s = own[i].site, *o = stencil->offset + 3 * q;
      const int32_t there[3] = {s[0] + o[0], s[1] + o[1], s[2] + o[2]};
      int32_t home[3], found;
      int owner;
      if (bw_particles_map_get(near, there) >= 0) continue;
      if (!foreign(pd, g, near, there, home, &owner)) continue;
      st = bw_particles_map_put(&seen, there, (int32_t)places->n, &found);
      if (st == BW_OK && found < 0) st = append(places, there, home, owner);
    }
  bw_particles_map_destroy(&seen);
  return st;
}

static int32_t find_own(const void *near, const void *key)
{
  return bw_particles_map_get((const bw_particles_map *)near, (const int32_t *)key);
}

static bw_particles_question question_of(const site_list *list, const bw_particles_map *near)
{
  return (bw_particles_question){.n = list->n,
                                 .owner = list->owner,
                                 .key_bytes = 3 * sizeof(int32_t),
                                 .key = list->home,
                                 .find = find_own,
                                 .context = near};
}

/* The places that turn out to be occupied, in lattice order. Collective. */
static bw_status occupied(const bw_pd_body *pd, const site_list *places,
                          const bw_particles_map *near, site_list *copies)
{
  int32_t *index = NULL, *order = NULL;
  site_list found = {0};
  bw_status st = bw_comm_agree(pd->comm, BW_ALLOCATE(&index, places->n));
  if (st == BW_OK) {
    const bw_particles_question question = question_of(places, near);
    st = bw_particles_ask(pd->comm, &question, index);
  }
  for (size_t q = 0; q < places->n && st == BW_OK; q++)
    if (index[q] >= 0)
      st = append(&found, places->there + 3 * q, places->home + 3 * q, places->owner[q]);
  BW_THEN(st, BW_ALLOCATE(&order, found.n));
  BW_THEN(st, bw_particles_lattice_order(pd->points.axis, found.n, found.there, order));
  for (size_t q = 0; q < found.n && st == BW_OK; q++) {
    const size_t c = (size_t)order[q];
    st = append(copies, found.there + 3 * c, found.home + 3 * c, found.owner[c]);
  }
  bw_release(&index);
  bw_release(&order);
  release_list(&found);
  return bw_comm_agree(pd->comm, st);
}

/* Own particles, then copies; what copies are comes with the first exchange. */
static bw_status extended_arrays(bw_pd_body *pd, const passenger own[], const site_list *copies)
{
  bw_pd_points *p = &pd->points;
  const size_t n = pd->n, all = pd->n_extended = n + copies->n;
  BW_REQUIRE(all < INT32_MAX, BW_EINPUT,
             "solid: %zu particles and copies on one rank; the limit is 2^31, use more ranks", all);
  BW_TRY(BW_ALLOCATE(&p->site, 3 * all));
  BW_TRY(BW_ALLOCATE(&p->id, all));
  BW_TRY(BW_ALLOCATE(&p->kind, all));
  BW_TRY(BW_ALLOCATE(&p->group, all));
  BW_TRY(BW_ALLOCATE(&p->place, all));
  BW_TRY(BW_ALLOCATE(&pd->halo.extended_X, 3 * all));
  for (size_t i = 0; i < n; i++) {
    memcpy(p->site + 3 * i, own[i].site, sizeof own[i].site);
    p->id[i] = own[i].id;
    p->kind[i] = own[i].kind;
    p->group[i] = own[i].group;
  }
  if (copies->n > 0) memcpy(p->site + 3 * n, copies->there, 3 * copies->n * sizeof *p->site);
  return BW_OK;
}

static bw_status plan_halo(bw_pd_body *pd, const site_list *copies, bw_particles_map *near)
{
  bw_pd_points *p = &pd->points;
  const bw_particles_question question = question_of(copies, near);
  BW_TRY(bw_particles_copies_create(pd->comm, pd->n, &question, 6 * sizeof(bw_real),
                                    &pd->halo.copies));
  bw_particles_copies_values(pd->halo.copies, sizeof *p->id, p->id, p->id);
  bw_particles_copies_values(pd->halo.copies, sizeof *p->kind, p->kind, p->kind);
  bw_particles_copies_values(pd->halo.copies, sizeof *p->group, p->group, p->group);
  bw_status st = BW_OK;
  for (size_t c = 0; c < copies->n && st == BW_OK; c++) {
    int32_t found;
    st = bw_particles_map_put(near, copies->there + 3 * c, (int32_t)(pd->n + c), &found);
  }
  return bw_comm_agree(pd->comm, st);
}

/* Rows at home, who is near, which copies. Collective. */
static bw_status divide(bw_pd_body *pd, const bw_pd_sites *given, crowd *g, bw_particles_map *near)
{
  passenger *own = NULL;
  site_list places = {0}, copies = {0};
  bw_status st =
      bw_particles_partition_create(pd->comm, (size_t)given->n, given->site, &g->partition);
  if (st == BW_OK) st = send_home(pd, given, g);
  if (st == BW_OK) {
    st = settle_own(pd, g, &own);
    pd->n = g->n;
    pd->points.total = bw_particles_partition_total(g->partition);
    BW_THEN(st, near_own(pd, g->n, own, near));
    BW_THEN(st, list_places(pd, g, own, near, &places));
    st = bw_comm_agree(pd->comm, st);
  }
  if (st == BW_OK) st = occupied(pd, &places, near, &copies);
  if (st == BW_OK) st = bw_comm_agree(pd->comm, extended_arrays(pd, own, &copies));
  if (st == BW_OK) st = plan_halo(pd, &copies, near);
  bw_release(&own);
  release_list(&places);
  release_list(&copies);
  return st;
}

bw_status bw_pd_body_distribute(bw_pd_body *pd, const bw_pd_sites *given, bw_particles_map *near)
{
  crowd g = {0};
  bw_status st = extent_of_all(pd, (size_t)given->n, given->site, &g);
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
  for (size_t q = 0; q < rows; q++) {
    const int32_t own = asked[q], place = pd->points.place[own];
    for (size_t k = 0; k < 3; k++)
      reply[width * q + k] = pd->u[k][place];
    for (size_t k = 3; k < width; k++)
      reply[width * q + k] = pd->v[k - 3][own];
  }
  bw_particles_copies_out(c, width * sizeof(bw_real), reply, answer);
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
