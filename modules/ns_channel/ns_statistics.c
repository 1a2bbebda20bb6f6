/* ns_statistics.c -- samples, batches and their way to disk. */
#include "ns_statistics_internal.h"

#include "bw_memory.h"
#include "ns_channel_internal.h"
#include <string.h>

bw_status bw_ns_statistics_create(bw_ns_channel *ns, bw_ns_statistics **out)
{
  *out = NULL;
  const bw_grid_view *g = ns->g;
  for (int d = 0; d < 3; d += 2)
    BW_REQUIRE(g->periodic[d], BW_EINPUT,
               "ns_statistics: the mean is taken over x and z, but %c is not periodic", "xyz"[d]);
  bw_ns_statistics *s = NULL;
  bw_status st = bw_allocate(1, sizeof *s, &s);
  /* Every rank holds all rows: they are few, and all ranks give the same answers. */
  if (st == BW_OK) {
    s->ns = ns, s->g = g, s->nu = ns->config.nu;
    s->rows = g->n[1] + 1;
    s->size = (size_t)BW_NS_MOMENTS * (size_t)s->rows;
    s->per_batch = 1;
    st = BW_ALLOCATE(&s->now, s->size);
    BW_THEN(st, BW_ALLOCATE(&s->batch, BW_NS_BATCHES * s->size));
    BW_THEN(st, BW_ALLOCATE(&s->work, 2 * s->size));
    BW_THEN(st, BW_ALLOCATE(&s->value, (size_t)s->rows));
    if (ns->u[2] == NULL) BW_THEN(st, bw_field_create(ns->grid, &s->no_w));
  }
  /* An allocation may have failed on one rank alone. */
  st = bw_comm_agree(ns->comm, st);
  if (st != BW_OK) bw_ns_statistics_destroy(&s);
  *out = s;
  return st;
}

void bw_ns_statistics_destroy(bw_ns_statistics **s)
{
  if (*s == NULL) return;
  bw_release(&(*s)->now);
  bw_release(&(*s)->batch);
  bw_release(&(*s)->work);
  bw_release(&(*s)->value);
  bw_release(&(*s)->no_w);
  bw_release(s);
}

void bw_ns_statistics_reset(bw_ns_statistics *s)
{
  memset(s->batch, 0, BW_NS_BATCHES * s->size * sizeof *s->batch);
  s->per_batch = 1;
  s->full = 0;
  s->in_last = 0;
}

/* The mean over the box is taken off p: <p - m>, <(p - m)^2>, <(p - m) v> from the plain ones. */
static void centre_pressure(bw_ns_statistics *s)
{
  const bw_grid_view *g = s->g;
  double *p1 = s->now + (size_t)BW_NS_MOMENT_P * (size_t)s->rows;
  double *p2 = s->now + (size_t)BW_NS_MOMENT_PP * (size_t)s->rows, m = 0.0;
  /* Mean over the box at this instant: the level of p means nothing. */
  for (int j = 1; j < s->rows; j++)
    m += p1[j] * (g->y_face[j] - g->y_face[j - 1]) / g->length[1];
  const double *v = s->now + (size_t)BW_NS_MOMENT_V * (size_t)s->rows;
  double *pv = s->now + (size_t)BW_NS_MOMENT_PV * (size_t)s->rows;
  /* <(p - m) v> first: it needs the plain <v>, which stays. */
  for (int j = 0; j < s->rows; j++)
    pv[j] -= m * v[j];
  /* <(p - m)^2> = <p^2> + m (m - 2 <p>), with the plain <p>, which changes last. */
  for (int j = 1; j < s->rows; j++) {
    p2[j] += m * (m - 2.0 * p1[j]);
    p1[j] -= m;
  }
}

/* All batches are full: neighbours become one. */
static void join_batches(bw_ns_statistics *s)
{
  /* Batch b goes into b/2, which has been read already. */
  for (int b = 0; b < BW_NS_BATCHES; b++) {
    double *to = s->batch + (size_t)(b / 2) * s->size, *from = s->batch + (size_t)b * s->size;
    for (size_t q = 0; q < s->size && b > 0; q++) {
      to[q] = b % 2 == 0 ? from[q] : to[q] + from[q];
    }
  }
  /* Half as many batches, each twice as long: the upper half is free again. */
  s->full = BW_NS_BATCHES / 2;
  s->per_batch *= 2;
  memset(s->batch + (size_t)s->full * s->size, 0,
         (size_t)(BW_NS_BATCHES - s->full) * s->size * sizeof *s->batch);
}

void bw_ns_statistics_sample(bw_ns_statistics *s)
{
  bw_ns_channel *ns = s->ns;
  bw_real *const u[3] = {ns->u[0], ns->u[1], s->no_w != NULL ? s->no_w : ns->u[2]};
  memset(s->now, 0, s->size * sizeof *s->now);
  /* Sums over this rank's part of each plane ... */
  bw_ns__moments(s->g, u, ns->p, s->rows, s->now);
  bw_ns__eddy_stress(ns, s->now + (size_t)BW_NS_MOMENT_EDDY * (size_t)s->rows);
  /* ... and over all ranks, so that the state does not depend on their number. */
  bw_comm_sum(ns->comm, s->size, s->now);
  const double share = 1.0 / ((double)s->g->n[0] * s->g->n[2]);
  for (size_t q = 0; q < s->size; q++)
    s->now[q] *= share;
  centre_pressure(s);
  /* The sample joins the batch that is being filled. */
  double *to = s->batch + (size_t)s->full * s->size;
  for (size_t q = 0; q < s->size; q++)
    to[q] += s->now[q];
  if (++s->in_last < s->per_batch) return;
  s->in_last = 0;
  if (++s->full == BW_NS_BATCHES) join_batches(s);
}

long bw_ns_statistics_samples(const bw_ns_statistics *s)
{
  return s->full * s->per_batch + s->in_last;
}

int bw_ns_statistics_batches(const bw_ns_statistics *s)
{
  return s->full;
}

/* ---- state: rows, moments, per_batch, full, in_last, then the batches ---- */
enum { HEAD = 5 };

size_t bw_ns_statistics_state_size(const bw_ns_statistics *s)
{
  return HEAD + BW_NS_BATCHES * s->size;
}

void bw_ns_statistics_get_state(const bw_ns_statistics *s, double x[])
{
  const double head[HEAD] = {s->rows, BW_NS_MOMENTS, (double)s->per_batch, s->full,
                             (double)s->in_last};
  memcpy(x, head, sizeof head);
  memcpy(x + HEAD, s->batch, BW_NS_BATCHES * s->size * sizeof *x);
}

bw_status bw_ns_statistics_set_state(bw_ns_statistics *s, const double x[])
{
  BW_REQUIRE(x[0] == s->rows && x[1] == BW_NS_MOMENTS, BW_EINPUT,
             "ns_statistics: the state has %g rows of %g moments, this grid and version %d of %d; "
             "go on with the grid that wrote it",
             x[0], x[1], s->rows, BW_NS_MOMENTS);
  BW_REQUIRE(x[2] >= 1 && x[3] >= 0 && x[3] < BW_NS_BATCHES && x[4] >= 0 && x[4] < x[2], BW_EINPUT,
             "ns_statistics: the state has %g samples in batch %g of %d, full with %g", x[4], x[3],
             BW_NS_BATCHES, x[2]);
  /* The numbers are possible and belong to this grid. */
  s->per_batch = (long)x[2];
  s->full = (int)x[3];
  s->in_last = (long)x[4];
  memcpy(s->batch, x + HEAD, BW_NS_BATCHES * s->size * sizeof *x);
  return BW_OK;
}
