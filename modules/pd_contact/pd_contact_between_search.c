/* Pairs of particles of different bodies: who may be near another body, copies, cells.
 *
 * Each rank tells the box of its part of every body. A particle in no other body's box, with the
 * reach and the skin around it, has nothing to meet and is in no list: bodies that are apart cost
 * nothing beyond the boxes. */
#include "bw_memory.h"
#include "pd_contact_between.h"

#include <math.h>
#include <string.h>

enum { BOX = 6 };

void bw_pd_contact__between_release(bw_pd_contact_between *c)
{
  bw_release(&c->mine);
  bw_release(&c->sent);
  bw_exchange_destroy(&c->plan);
  bw_release(&c->send);
  bw_release(&c->y);
  bw_release(&c->kind);
  bw_release(&c->pair_start);
  bw_release(&c->pair);
  bw_release(&c->busy);
  c->n_mine = c->n_theirs = c->n_sent = c->n_busy = 0;
}

static bool acts(const bw_pd_body *pd, size_t i)
{
  return !(pd->points.kind[i] & BW_PD_RETIRED);
}

/* Boxes of all ranks' parts of all bodies, (ranks, n_body, BOX) lower and upper corners.
 * Collective. */
static bw_status boxes(const bw_pd_contact_between *c, double **box)
{
  double *mine = NULL, y[3];
  size_t bytes;
  void *all = NULL;
  const size_t n = (size_t)c->n_body;
  bw_status st = bw_comm_agree(c->body[0]->comm, BW_ALLOCATE(&mine, BOX * n));
  for (size_t b = 0; b < n && st == BW_OK; b++) {
    double *m = mine + BOX * b;
    for (int k = 0; k < 3; k++)
      m[k] = INFINITY, m[3 + k] = -INFINITY;
    for (size_t i = 0; i < c->body[b]->n; i++) {
      if (!acts(c->body[b], i)) continue;
      bw_pd_contact__place(c->body[b], i, y);
      for (int k = 0; k < 3; k++)
        m[k] = fmin(m[k], y[k]), m[3 + k] = fmax(m[3 + k], y[k]);
    }
  }
  BW_THEN(st, bw_comm_allgather(c->body[0]->comm, BOX * n * sizeof *mine, mine, &bytes, &all));
  *box = all;
  bw_release(&mine);
  return st;
}

/* Is y near the box? An empty box is near nothing; a period leaves its direction open. */
static bool in_box(const bw_pd_contact_between *c, const double y[3], const double box[BOX])
{
  const double margin = c->reach + c->skin;
  for (int k = 0; k < 3; k++) {
    if (!(box[k] <= box[3 + k])) return false;
    if (c->period[k] > 0) continue;
    if (!(y[k] >= box[k] - margin && y[k] <= box[3 + k] + margin)) return false;
  }
  return true;
}

/* Is y near what rank r has of the other bodies? */
static bool near_rank(const bw_pd_contact_between *c, int body, const double y[3],
                      const double *box, int r)
{
  for (int b = 0; b < c->n_body; b++)
    if (b != body && in_box(c, y, box + BOX * ((size_t)r * (size_t)c->n_body + (size_t)b)))
      return true;
  return false;
}

typedef struct {
  size_t mine, sent;
} choice;

/* One particle: counted, and with lists noted, where it has to be. */
static void choose(bw_pd_contact_between *c, bw_pd_between_row row, const double *box,
                   int *destination, choice *n)
{
  const bw_comm *comm = c->body[0]->comm;
  const int size = bw_comm_size(comm), me = bw_comm_rank(comm);
  double y[3];
  bool any = false;
  bw_pd_contact__place(c->body[row.body], (size_t)row.particle, y);
  for (int r = 0; r < size; r++) {
    if (!near_rank(c, row.body, y, box, r)) continue;
    any = true;
    if (r == me) continue;
    if (destination != NULL) destination[n->sent] = r, c->sent[n->sent] = row;
    n->sent++;
  }
  /* Near another body on any rank: that rank's particles come here, as the boxes are the same. */
  if (any && destination != NULL) c->mine[n->mine] = row;
  n->mine += any;
}

/* Own particles near other bodies, and where else they have to be. */
static bw_status candidates(bw_pd_contact_between *c, const double *box, int **destination)
{
  for (int pass = 0; pass < 2; pass++) {
    choice n = {0};
    for (int b = 0; b < c->n_body; b++)
      for (size_t i = 0; i < c->body[b]->n; i++)
        if (acts(c->body[b], i))
          choose(c, (bw_pd_between_row){b, (int32_t)i}, box, *destination, &n);
    c->n_mine = n.mine, c->n_sent = n.sent;
    if (pass == 1) break;
    BW_TRY(BW_ALLOCATE(destination, n.sent));
    BW_TRY(BW_ALLOCATE(&c->sent, n.sent));
    BW_TRY(BW_ALLOCATE(&c->mine, n.mine));
    BW_TRY(BW_ALLOCATE(&c->send, 3 * n.sent));
  }
  return BW_OK;
}

static int32_t kind_of(const bw_pd_contact_between *c, bw_pd_between_row row)
{
  return c->kinds.first[row.body] + bw_pd_contact__kind(c->body[row.body], (size_t)row.particle);
}

/* Rows of all candidates that this rank sees. Collective. */
static bw_status share(bw_pd_contact_between *c)
{
  int32_t *kind = NULL;
  c->n_theirs = bw_exchange_received(c->plan);
  bw_status st = BW_ALLOCATE(&c->y, 3 * (c->n_mine + c->n_theirs));
  BW_THEN(st, BW_ALLOCATE(&c->kind, c->n_mine + c->n_theirs));
  BW_THEN(st, BW_ALLOCATE(&kind, c->n_sent));
  st = bw_comm_agree(c->body[0]->comm, st);
  if (st == BW_OK) {
    for (size_t q = 0; q < c->n_mine; q++) {
      c->kind[q] = kind_of(c, c->mine[q]);
      bw_pd_contact__place(c->body[c->mine[q].body], (size_t)c->mine[q].particle, c->y + 3 * q);
    }
    for (size_t q = 0; q < c->n_sent; q++) {
      kind[q] = kind_of(c, c->sent[q]);
      bw_pd_contact__place(c->body[c->sent[q].body], (size_t)c->sent[q].particle, c->send + 3 * q);
    }
    bw_exchange_forward(c->plan, 3 * sizeof(double), c->send, c->y + 3 * c->n_mine);
    bw_exchange_forward(c->plan, sizeof *kind, kind, c->kind + c->n_mine);
  }
  bw_release(&kind);
  return st;
}

/* Partners of row q in one cell. */
static bw_status pairs_in_cell(const bw_pd_contact_between *c, const bw_particles_cells *g,
                               size_t q, const int32_t cell[3], bw_pd_partners *found)
{
  for (int32_t p = g->head[bw_particles_cells_bucket(g, cell)]; p >= 0; p = g->next[p]) {
    const double reach = c->kinds.law[c->kind[q] * c->kinds.n + c->kind[p]].reach,
                 far = reach + c->skin;
    double d[3];
    if (reach == 0 || !bw_particles_cells_holds(g, cell, p)) continue; /* of the same body */
    bw_particles_difference(c->period, c->y + 3 * q, c->y + 3 * (size_t)p, d);
    if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < far * far)
      BW_TRY(bw_pd_contact__append(found, p));
  }
  return BW_OK;
}

static bw_status list_pairs(bw_pd_contact_between *c)
{
  bw_particles_cells g = {0};
  int32_t cell[27][3];
  bw_pd_partners found = {0};
  bw_status st = BW_ALLOCATE(&c->pair_start, c->n_mine + 1);
  if (c->reach > 0)
    BW_THEN(st, bw_particles_cells_create(c->n_mine + c->n_theirs, c->y, c->reach + c->skin,
                                          c->period, &g));
  for (size_t q = 0; q < c->n_mine && st == BW_OK; q++) {
    const int count = bw_particles_cells_around(&g, g.cell + 3 * q, cell);
    c->pair_start[q] = found.n;
    for (int k = 0; k < count; k++)
      BW_THEN(st, pairs_in_cell(c, &g, q, cell[k], &found));
  }
  if (st == BW_OK) c->pair_start[c->n_mine] = found.n;
  c->pair = found.partner;
  BW_THEN(st, bw_pd_contact__busy(c->n_mine, c->pair_start, &c->n_busy, &c->busy));
  bw_particles_cells_destroy(&g);
  return st;
}

bw_status bw_pd_contact__between_search(bw_pd_contact_between *c)
{
  const bw_comm *comm = c->body[0]->comm;
  double *box = NULL;
  int *destination = NULL;
  bw_pd_contact__between_release(c);
  bw_status st = boxes(c, &box);
  if (st == BW_OK) st = bw_comm_agree(comm, candidates(c, box, &destination));
  BW_THEN(st, bw_exchange_create(comm, c->n_sent, destination, &c->plan));
  BW_THEN(st, share(c));
  if (st == BW_OK) st = bw_comm_agree(comm, list_pairs(c));
  bw_release(&box);
  bw_release(&destination);
  return st;
}
