/* Pairs of particles outside each other's family: candidates and cells.
 *
 * Every particle is a candidate, buried ones too: a list of those at surfaces would switch pairs on
 * when the one becomes a surface with the other in it already, out of nothing. To be near each
 * other, two that began a family's reach apart must have moved apart by the rest, so that where
 * displacements are alike nobody is looked for. */
#include "bw_memory.h"
#include "pd_contact.h"

#include <math.h>
#include <string.h>

void bw_pd_contact__place(const bw_pd_body *pd, size_t i, double X[3])
{
  bw_pd_body_reference(pd, i, X);
  for (int k = 0; k < 3; k++)
    X[k] += (double)pd->u[k][pd->points.place[i]];
}

void bw_pd_contact__position(const bw_pd_body *pd, size_t i, double y[3])
{
  double X[3];
  bw_pd_contact__place(pd, i, X);
  for (int a = 0; a < 3; a++)
    y[a] =
        pd->config.axes[a][0] * X[0] + pd->config.axes[a][1] * X[1] + pd->config.axes[a][2] * X[2];
}

void bw_pd_contact__release(bw_pd_contact *c)
{
  bw_release(&c->mine);
  bw_release(&c->sent);
  bw_exchange_destroy(&c->plan);
  bw_release(&c->send);
  bw_release(&c->y);
  bw_release(&c->site);
  bw_release(&c->group);
  bw_release(&c->shift);
  bw_release(&c->pair_start);
  bw_release(&c->pair);
  bw_release(&c->busy);
  c->n_mine = c->n_theirs = c->n_sent = c->n_busy = 0;
}

/* Own particles that are not retired. */
static bw_status candidates(const bw_pd_body *pd, bw_pd_contact *c)
{
  /* Prescribed ones too: a grip pushes what meets it. */
  BW_TRY(BW_ALLOCATE(&c->mine, pd->n));
  for (size_t i = 0; i < pd->n; i++)
    if (!(pd->points.kind[i] & BW_PD_RETIRED)) c->mine[c->n_mine++] = (int32_t)i;
  return BW_OK;
}

/* Cells of edge at least reach + skin, hashed; whole numbers of them in periodic directions. */
typedef struct {
  double edge[3], lower[3];
  int32_t count[3]; /* cells in a periodic direction, 0: not periodic */
  size_t buckets;
  int32_t *head, *next, *cell; /* (buckets), (n), (n,3) */
  double *moved;               /* (buckets,2,3) least and largest displacement in a bucket [L] */
} cells;

static void cell_of(const cells *g, const double y[3], int32_t cell[3])
{
  for (int k = 0; k < 3; k++) {
    /* Particles that have flown far share the outermost cell: the number stays in range. */
    const double x = floor((y[k] - g->lower[k]) / g->edge[k]);
    cell[k] = (int32_t)fmax(-1e9, fmin(1e9, x));
    const int32_t n = g->count[k];
    if (n > 0) cell[k] = (cell[k] % n + n) % n;
  }
}

static size_t bucket_of(const cells *g, const int32_t cell[3])
{
  /* Odd factors spread neighbouring cells over the table; the lowest bits are dropped. */
  const uint64_t key = (uint64_t)(uint32_t)cell[0] * 0x9e3779b97f4a7c15u ^
                       (uint64_t)(uint32_t)cell[1] * 0xc2b2ae3d27d4eb4fu ^
                       (uint64_t)(uint32_t)cell[2] * 0x165667b19e3779f9u;
  return (size_t)(key >> 24) & (g->buckets - 1);
}

/* From its site, but for what is the same for all. */
static void displacement(const bw_pd_body *pd, const bw_pd_contact *c, size_t q, double u[3])
{
  for (size_t k = 0; k < 3; k++) {
    u[k] = c->y[3 * q + k] - pd->level->ds * c->site[3 * q + k];
    if (c->shift != NULL) u[k] -= c->shift[3 * q + k];
  }
}

/* Candidate q goes where it belongs. */
static void insert(const bw_pd_body *pd, const bw_pd_contact *c, cells *g, size_t q)
{
  double u[3];
  /* Each bucket keeps the range of its displacements, by which calm regions are known. */
  cell_of(g, c->y + 3 * q, g->cell + 3 * q);
  const size_t b = bucket_of(g, g->cell + 3 * q);
  double *least = g->moved + 6 * b, *most = least + 3;
  displacement(pd, c, q, u);
  const bool first = g->head[b] < 0;
  for (int k = 0; k < 3; k++) {
    if (first || u[k] < least[k]) least[k] = u[k];
    if (first || u[k] > most[k]) most[k] = u[k];
  }
  g->next[q] = g->head[b];
  g->head[b] = (int32_t)q;
}

static bw_status make_cells(const bw_pd_body *pd, const bw_pd_contact *c, cells *g)
{
  const size_t n = c->n_mine + c->n_theirs;
  for (int k = 0; k < 3; k++) {
    /* Edges of at least reach + skin: partners are in this cell or one next to it. */
    const double p = pd->config.period[k], least = c->reach + c->skin;
    g->lower[k] = n > 0 ? c->y[k] : 0;
    g->count[k] = p > 0 ? (int32_t)fmax(1, floor(p / least)) : 0;
    g->edge[k] = p > 0 ? p / g->count[k] : least;
  }
  /* A power of two, with room for one candidate in each. */
  for (g->buckets = 64; g->buckets < n;)
    g->buckets *= 2;
  BW_TRY(BW_ALLOCATE(&g->head, g->buckets));
  BW_TRY(BW_ALLOCATE(&g->moved, 6 * g->buckets));
  BW_TRY(BW_ALLOCATE(&g->next, n));
  BW_TRY(BW_ALLOCATE(&g->cell, 3 * n));
  memset(g->head, 0xff, g->buckets * sizeof *g->head); /* all -1 */
  for (size_t q = 0; q < n; q++)
    insert(pd, c, g, q);
  return BW_OK;
}

/* The cells around one and itself, every one once. */
static int around(const cells *g, const int32_t cell[3], int32_t out[27][3])
{
  int first[3], last[3], step[3], n = 0;
  for (int k = 0; k < 3; k++) {
    /* With one or two cells in a period the neighbour on both sides is the same one. */
    first[k] = g->count[k] == 1 || g->count[k] == 2 ? 0 : -1;
    last[k] = g->count[k] == 1 ? 0 : 1;
  }
  for (step[2] = first[2]; step[2] <= last[2]; step[2]++)
    for (step[1] = first[1]; step[1] <= last[1]; step[1]++)
      for (step[0] = first[0]; step[0] <= last[0]; step[0]++, n++)
        for (int k = 0; k < 3; k++) {
          out[n][k] = cell[k] + step[k];
          if (g->count[k] > 0) out[n][k] = (out[n][k] + g->count[k]) % g->count[k];
        }
  return n;
}

/* Have all in these n cells moved so much alike that only a family can be near each other? */
static bool calm(const bw_pd_body *pd, const bw_pd_contact *c, const cells *g, int n,
                 int32_t cell[][3])
{
  /* Two that are not family began beyond its reach: to be listed they must come nearer by this. */
  const double limit = pd->level->reach - (c->reach + c->skin);
  double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
  /* Buckets may hold other cells too: their displacements can only make it less calm. */
  for (int q = 0; q < n; q++) {
    const size_t b = bucket_of(g, cell[q]);
    if (g->head[b] < 0) continue;
    const double *u = g->moved + 6 * b;
    for (int k = 0; k < 3; k++) {
      least[k] = u[k] < least[k] ? u[k] : least[k];
      most[k] = u[3 + k] > most[k] ? u[3 + k] : most[k];
    }
  }
  double range2 = 0;
  for (int k = 0; k < 3; k++)
    range2 += (most[k] - least[k]) * (most[k] - least[k]);
  /* The diagonal of the range bounds how much any two have moved apart. */
  return limit > 0 && range2 < limit * limit;
}

/* Whether y[a] and y[b] are in each other's family: those pairs need no search. */
static bool same_family(const bw_pd_body *pd, const bw_pd_contact *c, size_t a, size_t b)
{
  int32_t o[3];
  for (size_t k = 0; k < 3; k++) {
    /* The nearest image of the site, as families are built. */
    const int32_t p = (int32_t)lround(pd->config.period[k] / pd->level->ds);
    o[k] = c->site[3 * b + k] - c->site[3 * a + k];
    if (p > 0) o[k] = ((o[k] % p) + p + p / 2) % p - p / 2;
  }
  const int direction = bw_pd_body_direction(&pd->level->stencil, o);
  /* On a lattice a direction of the stencil is family; in a cloud the distance decides. */
  if (direction < 0 || pd->level->stencil.sure[direction]) return direction >= 0;
  return bw_pd_body_apart(pd, direction, c->shift + 3 * a, c->shift + 3 * b).r0 < pd->level->reach;
}

static bw_status append_pair(bw_pd_contact *c, size_t *n, size_t *capacity, int32_t partner)
{
  /* Grows twofold; this happens in searches, not in the steps between them. */
  if (*n == *capacity) {
    int32_t *larger = NULL;
    *capacity = 2 * *capacity + 1024;
    BW_TRY(BW_ALLOCATE(&larger, *capacity));
    if (*n > 0) memcpy(larger, c->pair, *n * sizeof *larger);
    bw_release(&c->pair);
    c->pair = larger;
  }
  c->pair[(*n)++] = partner;
  return BW_OK;
}

/* Partners of candidate q in one cell are appended to the pairs. */
static bw_status pairs_in_cell(const bw_pd_body *pd, bw_pd_contact *c, const cells *g, size_t q,
                               const int32_t cell[3], size_t *n, size_t *capacity)
{
  const double far = c->reach + c->skin;
  for (int32_t p = g->head[bucket_of(g, cell)]; p >= 0; p = g->next[p]) {
    double d[3];
    /* Other cells of the same bucket are told by their numbers. */
    if ((size_t)p == q || memcmp(g->cell + 3 * p, cell, 3 * sizeof *cell) != 0) continue;
    bw_pd_contact__difference(pd, c->y + 3 * q, c->y + 3 * p, d);
    if (!(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < far * far)) continue;
    /* Those are watched where their slots are, without a search. */
    if (same_family(pd, c, q, (size_t)p)) continue;
    BW_TRY(append_pair(c, n, capacity, p));
  }
  return BW_OK;
}

/* Partners of candidate q in the cells around it; quiet: the last cell found calm. */
static bw_status pairs_of(const bw_pd_body *pd, bw_pd_contact *c, const cells *g, size_t q,
                          const int32_t **quiet, size_t *n, size_t *capacity)
{
  const int32_t *own = g->cell + 3 * q;
  int32_t cell[27][3];
  /* Successive candidates stand in the same cell mostly: its calm is not looked at again. */
  if (*quiet != NULL && memcmp(*quiet, own, sizeof *cell) == 0) return BW_OK;
  const int count = around(g, own, cell);
  if (calm(pd, c, g, count, cell)) {
    *quiet = own;
    return BW_OK;
  }
  for (int k = 0; k < count; k++)
    BW_TRY(pairs_in_cell(pd, c, g, q, cell[k], n, capacity));
  return BW_OK;
}

/* Candidates that have a pair. */
static bw_status list_busy(bw_pd_contact *c)
{
  /* Steps go through these alone: most particles never meet anybody. */
  for (int pass = 0; pass < 2; pass++) {
    size_t n = 0;
    for (size_t q = 0; q < c->n_mine; q++) {
      if (c->pair_start[q] == c->pair_start[q + 1]) continue;
      if (pass == 1) c->busy[n] = (int32_t)q;
      n++;
    }
    if (pass == 0) BW_TRY(BW_ALLOCATE(&c->busy, n));
    c->n_busy = n;
  }
  return BW_OK;
}

static bw_status list_pairs(const bw_pd_body *pd, bw_pd_contact *c)
{
  cells g = {0};
  /* Own candidates and those that others sent; pairs are listed for the own ones. */
  bw_status st = make_cells(pd, c, &g);
  BW_THEN(st, BW_ALLOCATE(&c->pair_start, c->n_mine + 1));
  size_t n = 0, capacity = 0;
  const int32_t *quiet = NULL;
  for (size_t q = 0; q < c->n_mine && st == BW_OK; q++) {
    c->pair_start[q] = n;
    st = pairs_of(pd, c, &g, q, &quiet, &n, &capacity);
  }
  if (st == BW_OK) c->pair_start[c->n_mine] = n;
  BW_THEN(st, list_busy(c));
  bw_release(&g.head);
  bw_release(&g.moved);
  bw_release(&g.next);
  bw_release(&g.cell);
  return st;
}

bw_status bw_pd_contact__search(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  /* Nothing of the last search is kept. */
  bw_pd_contact__release(c);
  bw_status st = bw_comm_agree(pd->comm, candidates(pd, c));
  BW_THEN(st, bw_pd_contact__share(c));
  /* Own candidates and those that others sent are in one list of places. */
  BW_THEN(st, list_pairs(pd, c));
  BW_THEN(st, bw_pd_contact__wall_search(c));
  return bw_comm_agree(pd->comm, st);
}
