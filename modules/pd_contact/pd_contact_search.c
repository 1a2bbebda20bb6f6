/* Pairs of particles outside each other's family: candidates and cells.
 *
 * Every particle is a candidate, buried ones too: a list of those at surfaces would switch pairs on
 * when the one becomes a surface with the other in it already, out of nothing. To be near each
 * other, two that began a family's reach apart must have moved apart by the rest, so that where
 * displacements are alike nobody is looked for. */
#include "bw_memory.h"
#include "bw_particles_cells.h"
#include "pd_contact.h"

#include <math.h>
#include <string.h>

void bw_pd_contact__release(bw_pd_contact *c)
{
  bw_release(&c->found.mine);
  bw_release(&c->found.sent);
  bw_exchange_destroy(&c->found.plan);
  bw_release(&c->found.send);
  bw_release(&c->found.y);
  bw_release(&c->found.site);
  bw_release(&c->found.kind);
  bw_release(&c->found.shift);
  bw_release(&c->found.pair_start);
  bw_release(&c->found.pair);
  bw_release(&c->found.busy);
  c->found.n_mine = c->found.n_theirs = c->found.n_sent = c->found.n_busy = 0;
}

/* Own particles that are not retired. */
static bw_status candidates(const bw_pd_body *pd, bw_pd_contact *c)
{
  /* Prescribed ones too: a grip pushes what meets it. */
  BW_TRY(BW_ALLOCATE(&c->found.mine, pd->n));
  for (size_t i = 0; i < pd->n; i++)
    if (!(pd->points.kind[i] & BW_PD_RETIRED)) c->found.mine[c->found.n_mine++] = (int32_t)i;
  return BW_OK;
}

/* Cells of all candidates, and how far those in a bucket are from their sites. */
typedef struct {
  bw_particles_cells in;
  double *moved; /* (buckets,2,3) least and largest displacement in a bucket [L] */
} cells;

/* From its site, but for what is the same for all. */
static void displacement(const bw_pd_body *pd, const bw_pd_contact *c, size_t q, double u[3])
{
  for (size_t k = 0; k < 3; k++) {
    u[k] = c->found.y[3 * q + k] - pd->level[0].stencil.unit * c->found.site[3 * q + k];
    if (c->found.shift != NULL) u[k] -= c->found.shift[3 * q + k];
  }
}

/* Each bucket keeps the range of its displacements, by which calm regions are known. */
static void widen(const double u[3], double range[6])
{
  for (int k = 0; k < 3; k++) {
    if (u[k] < range[k]) range[k] = u[k];
    if (u[k] > range[3 + k]) range[3 + k] = u[k];
  }
}

static bw_status make_cells(const bw_pd_body *pd, const bw_pd_contact *c, cells *g)
{
  const size_t n = c->found.n_mine + c->found.n_theirs;
  /* Edges of at least reach + skin: partners are in this cell or one next to it. */
  BW_TRY(bw_particles_cells_create(n, c->found.y, c->reach + c->skin, pd->config.period, &g->in));
  BW_TRY(BW_ALLOCATE(&g->moved, 6 * g->in.buckets));
  for (size_t b = 0; b < g->in.buckets; b++)
    for (size_t k = 0; k < 3; k++)
      g->moved[6 * b + k] = INFINITY, g->moved[6 * b + 3 + k] = -INFINITY;
  for (size_t q = 0; q < n; q++) {
    double u[3];
    displacement(pd, c, q, u);
    widen(u, g->moved + 6 * bw_particles_cells_bucket(&g->in, g->in.cell + 3 * q));
  }
  return BW_OK;
}

/* Have all in these n cells moved so much alike that only a family can be near each other? */
static bool calm(const bw_pd_body *pd, const bw_pd_contact *c, const cells *g, int n,
                 int32_t cell[][3])
{
  /* Two that are not family began beyond its reach: to be listed they must come nearer by this,
   * which is least for the finest. */
  const bw_pd_level *finest = &pd->level[pd->finest];
  const double limit = finest->reach - (finest->ds + c->skin);
  double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
  /* Buckets may hold other cells too: their displacements can only make it less calm. */
  for (int q = 0; q < n; q++) {
    const size_t b = bw_particles_cells_bucket(&g->in, cell[q]);
    const double *u = g->moved + 6 * b; /* of an empty bucket: nothing widens */
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
  const bw_pd_level *own = bw_pd_contact__level(pd, c->found.kind[a]);
  const bw_pd_stencil *s = &own->stencil;
  for (size_t k = 0; k < 3; k++) {
    /* The nearest image of the site, as families are built. */
    const int32_t p = (int32_t)lround(pd->config.period[k] / s->unit);
    o[k] = c->found.site[3 * b + k] - c->found.site[3 * a + k];
    if (p > 0) o[k] = ((o[k] % p) + p + p / 2) % p - p / 2;
  }
  const int direction = bw_pd_body_direction(s, o);
  /* On a lattice a direction of the stencil is family; in a cloud the distance decides. */
  if (direction < 0 || s->sure[direction]) return direction >= 0;
  return bw_pd_body_apart(pd, direction, c->found.shift + 3 * a, c->found.shift + 3 * b).r0 <
         own->reach;
}

/* Partners of candidate q in one cell are appended to the pairs. */
static bw_status pairs_in_cell(const bw_pd_body *pd, const bw_pd_contact *c, const cells *g,
                               size_t q, const int32_t cell[3], bw_pd_partners *found)
{
  for (int32_t p = g->in.head[bw_particles_cells_bucket(&g->in, cell)]; p >= 0; p = g->in.next[p]) {
    double d[3];
    /* Other cells of the same bucket are told by their numbers. */
    if ((size_t)p == q || !bw_particles_cells_holds(&g->in, cell, p)) continue;
    bw_pd_contact__difference(pd, c->found.y + 3 * q, c->found.y + 3 * p, d);
    const double far = c->law[c->found.kind[q] * c->kinds + c->found.kind[p]].reach + c->skin;
    if (!(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < far * far)) continue;
    /* Those are watched where their slots are, without a search. */
    if (same_family(pd, c, q, (size_t)p)) continue;
    BW_TRY(bw_pd_contact__append(found, p));
  }
  return BW_OK;
}

/* Partners of candidate q in the cells around it; quiet: the last cell found calm. */
static bw_status pairs_of(const bw_pd_body *pd, const bw_pd_contact *c, const cells *g, size_t q,
                          const int32_t **quiet, bw_pd_partners *found)
{
  const int32_t *own = g->in.cell + 3 * q;
  int32_t cell[27][3];
  /* Successive candidates stand in the same cell mostly: its calm is not looked at again. */
  if (*quiet != NULL && memcmp(*quiet, own, sizeof *cell) == 0) return BW_OK;
  const int count = bw_particles_cells_around(&g->in, own, cell);
  if (calm(pd, c, g, count, cell)) {
    *quiet = own;
    return BW_OK;
  }
  for (int k = 0; k < count; k++)
    BW_TRY(pairs_in_cell(pd, c, g, q, cell[k], found));
  return BW_OK;
}

static bw_status list_pairs(const bw_pd_body *pd, bw_pd_contact *c)
{
  cells g = {.moved = NULL};
  bw_pd_partners found = {0};
  /* Own candidates and those that others sent; pairs are listed for the own ones. */
  bw_status st = make_cells(pd, c, &g);
  BW_THEN(st, BW_ALLOCATE(&c->found.pair_start, c->found.n_mine + 1));
  const int32_t *quiet = NULL;
  for (size_t q = 0; q < c->found.n_mine && st == BW_OK; q++) {
    c->found.pair_start[q] = found.n;
    st = pairs_of(pd, c, &g, q, &quiet, &found);
  }
  if (st == BW_OK) c->found.pair_start[c->found.n_mine] = found.n;
  c->found.pair = found.partner;
  /* Steps go through the busy ones alone: most particles never meet anybody. */
  BW_THEN(st, bw_pd_contact__busy(c->found.n_mine, c->found.pair_start, &c->found.n_busy,
                                  &c->found.busy));
  bw_particles_cells_destroy(&g.in);
  bw_release(&g.moved);
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
