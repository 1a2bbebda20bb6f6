/* What ranks tell each other for a search: candidates go to every rank near whose own they are. */
#include "bw_memory.h"
#include "pd_contact.h"

#include <math.h>
#include <string.h>

/* Boxes of all ranks' candidates, (size,6) lower and upper corners. */
static bw_status boxes(const bw_pd_body *pd, const bw_pd_contact *c, double **box)
{
  double mine[6] = {INFINITY, INFINITY, INFINITY, -INFINITY, -INFINITY, -INFINITY}, y[3];
  size_t bytes;
  void *all = NULL;
  /* A rank without candidates has an empty box, which nobody is in. */
  for (size_t q = 0; q < c->found.n_mine; q++) {
    bw_pd_contact__position(pd, (size_t)c->found.mine[q], y);
    for (int k = 0; k < 3; k++) {
      mine[k] = fmin(mine[k], y[k]);
      mine[3 + k] = fmax(mine[3 + k], y[k]);
    }
  }
  BW_TRY(bw_comm_allgather(pd->comm, sizeof mine, mine, &bytes, &all));
  *box = all;
  return BW_OK;
}

static bool in_box(const bw_pd_body *pd, const double y[3], const double box[6], double margin)
{
  for (int k = 0; k < 3; k++) {
    /* Along a period a box says nothing: an image may be in it. */
    if (pd->config.period[k] > 0 && box[k] <= box[3 + k]) continue;
    if (!(y[k] >= box[k] - margin && y[k] <= box[3 + k] + margin)) return false;
  }
  return true;
}

/* Candidates near another rank's go there. */
static bw_status choose_sent(const bw_pd_body *pd, bw_pd_contact *c, const double *box,
                             int **destination)
{
  const int size = bw_comm_size(pd->comm), me = bw_comm_rank(pd->comm);
  /* Counted, then written. A particle may go to several ranks. */
  for (int pass = 0; pass < 2; pass++) {
    size_t n = 0;
    for (size_t q = 0; q < c->found.n_mine && size > 1; q++) {
      double y[3];
      bw_pd_contact__position(pd, (size_t)c->found.mine[q], y);
      for (int r = 0; r < size; r++) {
        if (r == me || !in_box(pd, y, box + 6 * r, c->reach + c->skin)) continue;
        if (pass == 1) (*destination)[n] = r;
        if (pass == 1) c->found.sent[n] = c->found.mine[q];
        n++;
      }
    }
    c->found.n_sent = n;
    if (pass == 1) break;
    BW_TRY(BW_ALLOCATE(destination, n));
    BW_TRY(BW_ALLOCATE(&c->found.sent, n));
  }
  return BW_ALLOCATE(&c->found.send, 3 * c->found.n_sent);
}

/* What others sent goes behind the own rows of `all`. */
static void share_rows(const bw_pd_contact *c, size_t bytes, const void *sent, void *all)
{
  bw_exchange_forward(c->found.plan, bytes, sent, (unsigned char *)all + c->found.n_mine * bytes);
}

/* From the sites, in a cloud. */
static bw_status share_shifts(const bw_pd_body *pd, bw_pd_contact *c)
{
  double *sent = NULL;
  /* What makes a family in a cloud: how far each is off its site. */
  bw_status st = BW_ALLOCATE(&c->found.shift, 3 * (c->found.n_mine + c->found.n_theirs));
  BW_THEN(st, BW_ALLOCATE(&sent, 3 * c->found.n_sent));
  st = bw_comm_agree(pd->comm, st);
  for (size_t k = 0; k < 3 && st == BW_OK; k++) {
    for (size_t q = 0; q < c->found.n_mine; q++)
      c->found.shift[3 * q + k] = (double)pd->points.shift[k][pd->points.place[c->found.mine[q]]];
    for (size_t q = 0; q < c->found.n_sent; q++)
      sent[3 * q + k] = (double)pd->points.shift[k][pd->points.place[c->found.sent[q]]];
  }
  if (st == BW_OK) share_rows(c, 3 * sizeof *sent, sent, c->found.shift);
  bw_release(&sent);
  return st;
}

static bw_status share(const bw_pd_body *pd, bw_pd_contact *c)
{
  int32_t *send = NULL;
  uint8_t *kind = NULL;
  const size_t n = c->found.n_mine;
  /* Rows of the own candidates, then of those that came. */
  c->found.n_theirs = bw_exchange_received(c->found.plan);
  bw_status st = BW_ALLOCATE(&c->found.y, 3 * (n + c->found.n_theirs));
  BW_THEN(st, BW_ALLOCATE(&c->found.site, 3 * (n + c->found.n_theirs)));
  BW_THEN(st, BW_ALLOCATE(&c->found.kind, n + c->found.n_theirs));
  BW_THEN(st, BW_ALLOCATE(&send, 3 * c->found.n_sent));
  BW_THEN(st, BW_ALLOCATE(&kind, c->found.n_sent));
  /* All arrays stand on all ranks: the exchanges below can be made. */
  st = bw_comm_agree(pd->comm, st);
  for (size_t q = 0; q < n && st == BW_OK; q++) {
    c->found.kind[q] = bw_pd_contact__kind(pd, (size_t)c->found.mine[q]);
    bw_pd_contact__position(pd, (size_t)c->found.mine[q], c->found.y + 3 * q);
    memcpy(c->found.site + 3 * q, pd->points.site + 3 * (size_t)c->found.mine[q], 3 * sizeof *send);
  }
  for (size_t q = 0; q < c->found.n_sent && st == BW_OK; q++) {
    kind[q] = bw_pd_contact__kind(pd, (size_t)c->found.sent[q]);
    bw_pd_contact__position(pd, (size_t)c->found.sent[q], c->found.send + 3 * q);
    memcpy(send + 3 * q, pd->points.site + 3 * (size_t)c->found.sent[q], 3 * sizeof *send);
  }
  /* Sites tell who is family, kinds which pair law acts. */
  if (st == BW_OK) {
    share_rows(c, 3 * sizeof(double), c->found.send, c->found.y);
    share_rows(c, 3 * sizeof *send, send, c->found.site);
    share_rows(c, sizeof *kind, kind, c->found.kind);
  }
  bw_release(&send);
  bw_release(&kind);
  BW_TRY(st);
  return pd->config.disorder > 0 ? share_shifts(pd, c) : BW_OK;
}

bw_status bw_pd_contact__share(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  double *box = NULL;
  int *destination = NULL;
  bw_status st = boxes(pd, c, &box);
  if (st == BW_OK) st = bw_comm_agree(pd->comm, choose_sent(pd, c, box, &destination));
  /* From here on who is sent where is settled until the next search. */
  BW_THEN(st, bw_exchange_create(pd->comm, c->found.n_sent, destination, &c->found.plan));
  BW_THEN(st, share(pd, c));
  bw_release(&box);
  bw_release(&destination);
  return st;
}
