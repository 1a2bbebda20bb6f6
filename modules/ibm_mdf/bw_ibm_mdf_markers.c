/* The marker set: routed to the ranks of its cells, sorted there. */
#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

/* Room for n markers handed over. */
static bw_status reserve_sent(bw_ibm_mdf *ib, size_t n)
{
  if (n <= ib->room) return BW_OK;
  ib->n_sent = ib->room = 0; /* stays so if an allocation fails */
  IBM_RENEW(&ib->sent_from, n);
  IBM_RENEW(&ib->destination, n);
  IBM_RENEW(&ib->item, n);
  IBM_RENEW(&ib->answer, 3 * n);
  IBM_RENEW(&ib->wet_sent, n);
  ib->room = n;
  return BW_OK;
}

static bw_status reserve_held(bw_ibm_mdf *ib, size_t held)
{
  if (held <= ib->held_room) return BW_OK;
  const size_t some = held + held / 8; /* markers come and go */
  ib->held_room = 0;
  IBM_RENEW(&ib->received, some);
  IBM_RENEW(&ib->order, some);
  IBM_RENEW(&ib->swap, some);
  IBM_RENEW(&ib->key, some);
  IBM_RENEW(&ib->key_swap, some);
  IBM_RENEW(&ib->place, some);
  IBM_RENEW(&ib->V, 3 * some);
  IBM_RENEW(&ib->dV, some);
  IBM_RENEW(&ib->QdV, 3 * some);
  IBM_RENEW(&ib->M, 3 * some);
  IBM_RENEW(&ib->N, 3 * some);
  IBM_RENEW(&ib->along, some);
  IBM_RENEW(&ib->wet, some);
  IBM_RENEW(&ib->reply, 3 * some);
  ib->held_room = some;
  return BW_OK;
}

/* Into [0, length) of periodic directions; the middle of the one cell in 2D. */
static void wrap(const bw_grid_view *g, double x[3])
{
  for (int d = 0; d < 3; d++) {
    if (!g->periodic[d] || (x[d] >= 0.0 && x[d] < g->length[d])) continue;
    x[d] -= g->length[d] * floor(x[d] / g->length[d]);
    if (x[d] >= g->length[d]) x[d] = 0.0; /* -1e-20 + length rounds to length */
  }
  if (g->n[2] == 1) x[2] = 0.5 * g->length[2];
}

static bw_status check(size_t n, const double X[], const double V[], const double dV[],
                       const double M[])
{
  for (size_t i = 0; i < n; i++) {
    /* A marker without a place has no owner, and NaN would spread through the whole fluid. */
    for (int d = 0; d < 3; d++)
      BW_REQUIRE(isfinite(X[3 * i + d]) && isfinite(V[3 * i + d]), BW_EINPUT,
                 "marker %zu: position and velocity must be finite, component %d is %g and %g", i,
                 d, X[3 * i + d], V[3 * i + d]);
    BW_REQUIRE(isfinite(dV[i]) && dV[i] >= 0.0, BW_EINPUT,
               "marker %zu: volume must be finite and >= 0, found %g", i, dV[i]);
    BW_REQUIRE(M == NULL || isnan(M[3 * i]) ||
                   (isfinite(M[3 * i]) && isfinite(M[3 * i + 1]) && isfinite(M[3 * i + 2])),
               BW_EINPUT, "marker %zu: memory must be finite, or NaN for none", i);
  }
  return BW_OK;
}

/* Fill item, destination, sent_from with the markers in the box; true if the routes changed. */
static bool address(bw_ibm_mdf *ib, const double X[], const double V[], const double dV[],
                    const double M[])
{
  bool changed = ib->plan == NULL;
  const size_t before = ib->n_sent;
  size_t sent = 0;
  for (size_t i = 0; i < ib->n; i++) {
    bw_ibm_mdf__item *item = &ib->item[sent];
    double x[3] = {X[3 * i], X[3 * i + 1], X[3 * i + 2]};
    /* Periodic images of a marker are the marker; what is outside otherwise has no owner. */
    wrap(ib->g, x);
    const int owner = bw_grid_owner(ib->grid, x);
    if (owner < 0) continue;
    for (int d = 0; d < 3; d++)
      item->s[d] = x[d] / ib->g->spacing[d];
    memcpy(item->v, V + 3 * i, sizeof item->v);
    if (ib->g->n[2] == 1) item->v[2] = 0.0; /* as is what is interpolated there */
    for (int d = 0; d < 3; d++)
      item->m[d] = M == NULL ? 0.0 : M[3 * i + (size_t)d];
    item->volume = dV[i];
    /* The plan only knows how many go where: it holds while each goes to the rank it went to. */
    changed |= sent >= before || ib->destination[sent] != owner;
    ib->destination[sent] = owner;
    ib->sent_from[sent] = i;
    sent++;
  }
  ib->n_sent = sent;
  return changed || sent != before;
}

static unsigned cell_of(const bw_grid_view *g, const double s[3])
{
  unsigned c[3];
  for (int d = 0; d < 3; d++) {
    const int i = (int)bw_ibm_mdf__local(g, s, d);
    c[d] = (unsigned)(i < g->m[d] ? i : g->m[d] - 1);
  }
  return (c[2] * (unsigned)g->m[1] + c[1]) * (unsigned)g->m[0] + c[0];
}

/* One pass of a stable sort by the 11 bits of key from `shift` up. */
static void sort_pass(size_t n, int shift, const unsigned *restrict from,
                      const unsigned *restrict key, unsigned *restrict to,
                      unsigned *restrict key_to)
{
  enum { BITS = 11, MASK = (1 << BITS) - 1 };
  size_t start[(1 << BITS) + 1] = {0};
  /* Count, ... */
  for (size_t m = 0; m < n; m++)
    start[1 + (key[m] >> shift & MASK)]++;
  /* ... add up, ... */
  for (int b = 0; b <= MASK; b++)
    start[b + 1] += start[b];
  /* ... and place, in the order they came: the sort is stable. */
  for (size_t m = 0; m < n; m++) {
    const size_t place = start[key[m] >> shift & MASK]++;
    to[place] = from[m];
    key_to[place] = key[m];
  }
}

/* order[]: the markers received, by cell; markers of a cell as they came: the same on every run. */
static void sort_by_cell(bw_ibm_mdf *ib)
{
  const int *cells = ib->g->m;
  for (size_t m = 0; m < ib->held; m++) {
    ib->order[m] = (unsigned)m;
    ib->key[m] = cell_of(ib->g, ib->received[m].s);
  }
  /* Radix sort: two passes do for 4 million cells a rank, a third for the rest. */
  sort_pass(ib->held, 0, ib->order, ib->key, ib->swap, ib->key_swap);
  sort_pass(ib->held, 11, ib->swap, ib->key_swap, ib->order, ib->key);
  if ((size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2] > (size_t)1 << 22) {
    sort_pass(ib->held, 22, ib->order, ib->key, ib->swap, ib->key_swap);
    memcpy(ib->order, ib->swap, ib->held * sizeof *ib->order);
    memcpy(ib->key, ib->key_swap, ib->held * sizeof *ib->key);
  }
  /* Where each layer of cells in z begins, for force_held. */
  const unsigned per_layer = (unsigned)cells[0] * (unsigned)cells[1];
  size_t m = 0;
  for (int k = 0; k <= cells[2]; k++) {
    while (m < ib->held && ib->key[m] < per_layer * (unsigned)k)
      m++;
    ib->layer[k] = m;
  }
}

/* The received markers in their order, their images, and the weights of all. Collective. */
static bw_status settle(bw_ibm_mdf *ib)
{
  /* Neighbours in space become neighbours in memory. */
  sort_by_cell(ib);
  for (size_t m = 0; m < ib->held; m++) {
    const bw_ibm_mdf__item *item = &ib->received[ib->order[m]];
    for (int d = 0; d < 3; d++)
      ib->place[m].s[d] = bw_ibm_mdf__local(ib->g, item->s, d);
    memcpy(ib->V + 3 * m, item->v, sizeof item->v);
    memcpy(ib->M + 3 * m, item->m, sizeof item->m);
    ib->dV[m] = item->volume;
  }
  /* Places are known: images follow, then the weights of both. */
  BW_TRY(bw_ibm_mdf__cast_images(ib));
  bw_ibm_mdf__weigh(ib);
  /* The force of the last step belongs to other markers: M has it, if anybody has. */
  ib->call = 0;
  ib->sided = false;
  ib->surfaces = 0;
  bw_ibm_mdf_begin_step(ib);
  return BW_OK;
}

/* A new plan for the addressed markers. Collective. */
static bw_status plan_markers(bw_ibm_mdf *ib)
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  /* Stays so if anything fails: no kernel runs over arrays that are too short. */
  ib->held = 0;
  bw_exchange_destroy(&ib->plan);
  BW_TRY(bw_exchange_create(comm, ib->n_sent, ib->destination, &ib->plan));
  const size_t held = bw_exchange_received(ib->plan);
  BW_TRY(bw_comm_agree(comm, reserve_held(ib, held)));
  ib->held = held;
  return BW_OK;
}

bw_status bw_ibm_mdf_set_markers(bw_ibm_mdf *ib, size_t n, const double X[], const double V[],
                                 const double dV[], const double M[])
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  const double start = bw_wall_time();
  bw_status st = check(n, X, V, dV, M);
  BW_THEN(st, reserve_sent(ib, n));
  /* Bad values on one rank end the call on all. */
  BW_TRY(bw_comm_agree(comm, st));
  ib->n = n;
  /* Routes first: only when some marker changes its rank is a new plan made. */
  const int64_t changed = address(ib, X, V, dV, M);
  int64_t count[3] = {changed, (int64_t)n, (int64_t)(n - ib->n_sent)};
  bw_comm_sum_int(comm, 3, count);
  ib->markers = count[1], ib->outside = count[2];
  if (count[0] > 0) BW_TRY(plan_markers(ib));
  /* Each marker is now with the rank that owns its cell. */
  bw_exchange_forward(ib->plan, sizeof *ib->item, ib->item, ib->received);
  st = settle(ib);
  ib->cost.set += bw_wall_time() - start;
  /* Does the iteration of these markers converge? Asked once, of the first set that has any. */
  if (st != BW_OK || ib->measured || ib->markers == ib->outside) return st;
  st = bw_ibm_mdf__check_growth(ib);
  ib->measured = st == BW_OK;
  return st;
}
