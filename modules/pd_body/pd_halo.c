/* Who owns which particle, which copies a rank needs, and how they are kept current. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <string.h>

/* What all ranks know while the object is built. */
typedef struct {
  size_t n;
  const int32_t *site;
  int32_t *part; /* (n) owner */
  bw_pd_map row; /* site -> row of the list */
  int32_t lower[3], upper[3];
  int32_t period[3]; /* in steps, 0: not periodic */
} crowd;

static void extent(size_t n, const int32_t site[], int32_t lower[3], int32_t upper[3])
{
  for (int k = 0; k < 3; k++) {
    lower[k] = n > 0 ? INT32_MAX : 0;
    upper[k] = n > 0 ? INT32_MIN : 0;
    for (size_t q = 0; q < n; q++) {
      const int32_t x = site[3 * q + (size_t)k];
      lower[k] = x < lower[k] ? x : lower[k];
      upper[k] = x > upper[k] ? x : upper[k];
    }
  }
}

static bw_status check_extent(const bw_pd_body *pd, crowd *g)
{
  extent(g->n, g->site, g->lower, g->upper);
  for (int k = 0; k < 3; k++) {
    const int64_t size = (int64_t)g->upper[k] - g->lower[k] + 1;
    g->period[k] = (int32_t)lround(pd->config.period[k] / pd->level->ds);
    BW_REQUIRE(size < 1 << 20, BW_EINPUT,
               "pd_bond: sites reach over %lld steps in direction %d; the limit is 2^20",
               (long long)size, k);
    BW_REQUIRE(g->period[k] == 0 || size <= g->period[k], BW_EINPUT,
               "pd_bond: sites reach over %lld steps in direction %d, whose period has %d",
               (long long)size, k, g->period[k]);
  }
  BW_REQUIRE(pd->dimension == 3 || (g->lower[2] == 0 && g->upper[2] == 0), BW_EINPUT,
             "pd_bond: in 2D every site[2] must be 0; they lie in %d .. %d", g->lower[2],
             g->upper[2]);
  return BW_OK;
}

static bw_status list_rows(crowd *g)
{
  BW_TRY(bw_pd_map_create(g->n, g->lower, g->upper, &g->row));
  for (size_t q = 0; q < g->n; q++) {
    const int32_t *s = g->site + 3 * q;
    int32_t found;
    BW_TRY(bw_pd_map_put(&g->row, s, (int32_t)q, &found));
    BW_REQUIRE(found < 0, BW_EINPUT, "pd_bond: particles %d and %zu are both on site (%d,%d,%d)",
               found, q, s[0], s[1], s[2]);
  }
  return BW_OK;
}

/* Row of the particle whose image is at `site`; -1: none. */
static int32_t row_at(const crowd *g, const int32_t site[3])
{
  int32_t home[3];
  for (int k = 0; k < 3; k++) {
    const int32_t p = g->period[k];
    home[k] = p == 0 ? site[k] : g->lower[k] + ((site[k] - g->lower[k]) % p + p) % p;
  }
  return bw_pd_map_get(&g->row, home);
}

static void choose_axes(bw_pd_body *pd, size_t n, const int32_t site[])
{
  int32_t lower[3], upper[3];
  int64_t size[3];
  extent(n, site, lower, upper);
  for (int k = 0; k < 3; k++)
    size[k] = (int64_t)upper[k] - lower[k] + 1;
  bw_pd_body_axes(size, pd->level->stencil.reach, pd->points.axis);
}

/* Rows of this rank in lattice order. */
static bw_status own_rows(bw_pd_body *pd, const crowd *g, size_t *n, int32_t **row)
{
  const int me = bw_comm_rank(pd->comm);
  int32_t *mine = NULL, *site = NULL, *order = NULL;
  *n = 0;
  for (size_t q = 0; q < g->n; q++)
    *n += g->part[q] == me;
  bw_status st = BW_ALLOCATE(&mine, *n);
  BW_THEN(st, BW_ALLOCATE(&site, 3 * *n));
  BW_THEN(st, BW_ALLOCATE(&order, *n));
  BW_THEN(st, BW_ALLOCATE(row, *n));
  if (st == BW_OK) {
    size_t at = 0;
    for (size_t q = 0; q < g->n; q++)
      if (g->part[q] == me) {
        memcpy(site + 3 * at, g->site + 3 * q, 3 * sizeof *site);
        mine[at++] = (int32_t)q;
      }
    choose_axes(pd, *n, site);
    st = bw_pd_body_lattice_order(pd->points.axis, *n, site, order);
  }
  for (size_t q = 0; q < *n && st == BW_OK; q++)
    (*row)[q] = mine[order[q]];
  bw_release(&mine);
  bw_release(&site);
  bw_release(&order);
  return st;
}

/* A list of sites with rows that grows. */
typedef struct {
  size_t n, capacity;
  int32_t *site, *row;
} site_list;

static bw_status append(site_list *list, const int32_t site[3], int32_t row)
{
  if (list->n == list->capacity) {
    const size_t capacity = 2 * list->capacity + 1024;
    int32_t *s = NULL, *r = NULL;
    BW_TRY(BW_ALLOCATE(&s, 3 * capacity));
    BW_TRY(BW_ALLOCATE(&r, capacity));
    if (list->n > 0) memcpy(s, list->site, 3 * list->n * sizeof *s);
    if (list->n > 0) memcpy(r, list->row, list->n * sizeof *r);
    bw_release(&list->site);
    bw_release(&list->row);
    list->site = s, list->row = r, list->capacity = capacity;
  }
  memcpy(list->site + 3 * list->n, site, 3 * sizeof *site);
  list->row[list->n++] = row;
  return BW_OK;
}

/* Every place in reach of an own particle that somebody else, or an image, occupies. */
static bw_status find_copies(const bw_pd_body *pd, const crowd *g, size_t n, const int32_t row[],
                             bw_pd_map *near, site_list *copies)
{
  const bw_pd_stencil *stencil = &pd->level->stencil;
  for (size_t i = 0; i < n; i++)
    for (int q = 0; q < stencil->n; q++) {
      const int32_t *s = g->site + 3 * (size_t)row[i], *o = stencil->offset + 3 * q;
      const int32_t there[3] = {s[0] + o[0], s[1] + o[1], s[2] + o[2]};
      if (bw_pd_map_get(near, there) >= 0) continue;
      const int32_t other = row_at(g, there);
      if (other < 0) continue;
      int32_t found;
      BW_TRY(bw_pd_map_put(near, there, (int32_t)(n + copies->n), &found));
      BW_TRY(append(copies, there, other));
    }
  return BW_OK;
}

static bw_status near_own(const bw_pd_body *pd, const crowd *g, size_t n, const int32_t row[],
                          bw_pd_map *near)
{
  int32_t *site = NULL, lower[3], upper[3], found;
  BW_TRY(BW_ALLOCATE(&site, 3 * n));
  for (size_t i = 0; i < n; i++)
    memcpy(site + 3 * i, g->site + 3 * (size_t)row[i], 3 * sizeof *site);
  extent(n, site, lower, upper);
  for (int k = 0; k < 3; k++) {
    lower[k] -= pd->level->stencil.reach;
    upper[k] += pd->level->stencil.reach;
  }
  bw_status st = bw_pd_map_create(2 * n, lower, upper, near);
  for (size_t i = 0; i < n && st == BW_OK; i++)
    st = bw_pd_map_put(near, site + 3 * i, (int32_t)i, &found);
  bw_release(&site);
  return st;
}

static bw_status extended_arrays(bw_pd_body *pd, const crowd *g, const uint8_t kind[],
                                 const int32_t own[], const site_list *copies, bw_pd_map *near)
{
  const size_t n = pd->n, all = n + copies->n;
  int32_t *order = NULL;
  pd->n_extended = all;
  bw_status st = BW_ALLOCATE(&pd->points.site, 3 * all);
  BW_THEN(st, BW_ALLOCATE(&pd->points.id, all));
  BW_THEN(st, BW_ALLOCATE(&pd->points.kind, all));
  BW_THEN(st, BW_ALLOCATE(&pd->points.group, all));
  BW_THEN(st, BW_ALLOCATE(&pd->points.place, all));
  BW_THEN(st, BW_ALLOCATE(&order, copies->n));
  BW_THEN(st, bw_pd_body_lattice_order(pd->points.axis, copies->n, copies->site, order));
  for (size_t e = 0; e < all && st == BW_OK; e++) {
    const size_t c = e < n ? 0 : (size_t)order[e - n];
    const int32_t row = e < n ? own[e] : copies->row[c];
    memcpy(pd->points.site + 3 * e, e < n ? g->site + 3 * (size_t)row : copies->site + 3 * c,
           3 * sizeof *pd->points.site);
    pd->points.id[e] = row;
    pd->points.kind[e] = kind == NULL ? BW_PD_FREE : kind[row];
    if (e >= n) bw_pd_map_replace(near, pd->points.site + 3 * e, (int32_t)e);
  }
  bw_release(&order);
  return st;
}

/* Copies ask their owners by id; the owners remember in which order they are asked. */
static bw_status plan_halo(bw_pd_body *pd, const crowd *g, const bw_pd_map *near)
{
  const size_t copies = pd->n_extended - pd->n;
  int *owner = NULL;
  int64_t *asked = NULL;
  bw_status st = BW_ALLOCATE(&owner, copies);
  for (size_t c = 0; c < copies && st == BW_OK; c++)
    owner[c] = g->part[pd->points.id[pd->n + c]];
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) st = bw_exchange_create(pd->comm, copies, owner, &pd->halo.plan);
  if (st == BW_OK) {
    pd->halo.n_asked = bw_exchange_received(pd->halo.plan);
    st = BW_ALLOCATE(&asked, pd->halo.n_asked);
    BW_THEN(st, BW_ALLOCATE(&pd->halo.asked, pd->halo.n_asked));
    BW_THEN(st, BW_ALLOCATE(&pd->halo.reply, 6 * pd->halo.n_asked));
    BW_THEN(st, BW_ALLOCATE(&pd->halo.answer, 6 * copies));
    st = bw_comm_agree(pd->comm, st);
  }
  if (st == BW_OK) {
    bw_exchange_forward(pd->halo.plan, sizeof *asked, pd->points.id + pd->n, asked);
    for (size_t q = 0; q < pd->halo.n_asked; q++)
      pd->halo.asked[q] = bw_pd_map_get(near, g->site + 3 * (size_t)asked[q]);
  }
  bw_release(&owner);
  bw_release(&asked);
  return st;
}

static bw_status local_part(bw_pd_body *pd, crowd *g, const uint8_t kind[], bw_pd_map *near)
{
  int32_t *own = NULL;
  site_list copies = {0};
  bw_status st = check_extent(pd, g);
  BW_THEN(st, BW_ALLOCATE(&g->part, g->n));
  BW_THEN(st, list_rows(g));
  BW_THEN(st, bw_pd_body_partition(bw_comm_size(pd->comm), g->n, g->site, g->part));
  BW_THEN(st, own_rows(pd, g, &pd->n, &own));
  BW_THEN(st, near_own(pd, g, pd->n, own, near));
  BW_THEN(st, find_copies(pd, g, pd->n, own, near, &copies));
  BW_THEN(st, extended_arrays(pd, g, kind, own, &copies, near));
  bw_release(&own);
  bw_release(&copies.site);
  bw_release(&copies.row);
  return st;
}

/* near: site (shifted for images) -> extended index, to be destroyed by the caller. */
bw_status bw_pd_body_distribute(bw_pd_body *pd, size_t n, const int32_t site[],
                                const uint8_t kind[], bw_pd_map *near)
{
  crowd g = {.n = n, .site = site};
  bw_status st = bw_comm_agree(pd->comm, local_part(pd, &g, kind, near));
  if (st == BW_OK) st = plan_halo(pd, &g, near);
  bw_release(&g.part);
  bw_pd_map_destroy(&g.row);
  return st;
}

/* Copies' displacement (and velocity) from their owners. Collective. */
void bw_pd_body_refresh(bw_pd_body *pd, bool velocity)
{
  const size_t width = velocity ? 6 : 3, copies = pd->n_extended - pd->n;
  if (velocity)
    for (size_t r = 0; r < pd->bonds.n_run; r++)
      for (int k = 0; k < 3; k++)
        memcpy(pd->vs[k] + pd->bonds.run[r].place, pd->v[k] + pd->bonds.run[r].own,
               (size_t)pd->bonds.run[r].n * sizeof(bw_real));
  for (size_t q = 0; q < pd->halo.n_asked; q++) {
    const int32_t own = pd->halo.asked[q], place = pd->points.place[own];
    for (size_t k = 0; k < 3; k++)
      pd->halo.reply[width * q + k] = pd->u[k][place];
    for (size_t k = 3; k < width; k++)
      pd->halo.reply[width * q + k] = pd->v[k - 3][own];
  }
  bw_exchange_backward(pd->halo.plan, width * sizeof(bw_real), pd->halo.reply, pd->halo.answer);
  for (size_t c = 0; c < copies; c++) {
    const int32_t place = pd->points.place[pd->n + c];
    for (size_t k = 0; k < 3; k++)
      pd->u[k][place] = pd->halo.answer[width * c + k];
    for (size_t k = 3; k < width; k++)
      pd->vs[k - 3][place] = pd->halo.answer[width * c + k];
  }
}

/* Copies' values of a storage array from their owners. Collective. */
void bw_pd_body_fill_places(bw_pd_body *pd, bw_real *places)
{
  const size_t copies = pd->n_extended - pd->n;
  for (size_t q = 0; q < pd->halo.n_asked; q++)
    pd->halo.reply[q] = places[pd->points.place[pd->halo.asked[q]]];
  bw_exchange_backward(pd->halo.plan, sizeof(bw_real), pd->halo.reply, pd->halo.answer);
  for (size_t c = 0; c < copies; c++)
    places[pd->points.place[pd->n + c]] = pd->halo.answer[c];
}
