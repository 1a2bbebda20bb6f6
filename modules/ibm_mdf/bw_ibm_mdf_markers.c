/* The marker set: routed to the ranks of its cells, sorted there, with its weights. */
#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

/* Grow-only array of `count` items. */
#define RENEW(pointer, count)                                                                      \
  do {                                                                                             \
    bw_release(pointer);                                                                           \
    BW_TRY(BW_ALLOCATE(pointer, count));                                                           \
  } while (0)

bw_status bw_ibm_mdf__reserve(bw_ibm_mdf *ib, size_t n, size_t held)
{
  if (n > ib->room) {
    ib->room = 0; /* stays so if an allocation fails */
    RENEW(&ib->sent_from, n);
    RENEW(&ib->destination, n);
    RENEW(&ib->item, n);
    RENEW(&ib->answer, 3 * n);
    ib->room = n;
  }
  if (held > ib->held_room) {
    const size_t some = held + held / 8; /* markers come and go */
    ib->held_room = 0;
    RENEW(&ib->received, some);
    RENEW(&ib->order, some);
    RENEW(&ib->swap, some);
    RENEW(&ib->key, some);
    RENEW(&ib->key_swap, some);
    RENEW(&ib->stencil, some);
    RENEW(&ib->V, 3 * some);
    RENEW(&ib->dV, some);
    RENEW(&ib->QdV, 3 * some);
    RENEW(&ib->reply, 3 * some);
    RENEW(&ib->U, 3 * some);
    ib->held_room = some;
  }
  return BW_OK;
}

/* Into [0, length) of periodic directions; the middle of the one cell in 2D. */
static void wrap(const bw_grid_view *g, double x[3])
{
  for (int d = 0; d < 3; d++) {
    if (!g->periodic[d]) continue;
    x[d] -= g->length[d] * floor(x[d] / g->length[d]);
    if (x[d] >= g->length[d]) x[d] = 0.0; /* -1e-20 + length rounds to length */
  }
  if (g->n[2] == 1) x[2] = 0.5 * g->length[2];
}

static bw_status check(size_t n, const double X[], const double V[], const double dV[])
{
  for (size_t i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++)
      BW_REQUIRE(isfinite(X[3 * i + d]) && isfinite(V[3 * i + d]), BW_EINPUT,
                 "marker %zu: position and velocity must be finite, component %d is %g and %g", i,
                 d, X[3 * i + d], V[3 * i + d]);
    BW_REQUIRE(isfinite(dV[i]) && dV[i] >= 0.0, BW_EINPUT,
               "marker %zu: volume must be finite and >= 0, found %g", i, dV[i]);
  }
  return BW_OK;
}

/* Fill item, destination, sent_from with the markers in the box; true if the routes changed. */
static bool address(bw_ibm_mdf *ib, const double X[], const double V[], const double dV[])
{
  bool changed = ib->plan == NULL;
  const size_t before = ib->n_sent;
  size_t sent = 0;
  for (size_t i = 0; i < ib->n; i++) {
    bw_ibm_mdf__item *item = &ib->item[sent];
    memcpy(item->x, X + 3 * i, sizeof item->x);
    memcpy(item->v, V + 3 * i, sizeof item->v);
    item->volume = dV[i];
    wrap(ib->g, item->x);
    const int owner = bw_grid_owner(ib->grid, item->x);
    if (owner < 0) continue;
    changed |= sent >= before || ib->destination[sent] != owner;
    ib->destination[sent] = owner;
    ib->sent_from[sent] = i;
    sent++;
  }
  ib->n_sent = sent;
  return changed || sent != before;
}

bw_status bw_ibm_mdf_set_markers(bw_ibm_mdf *ib, size_t n, const double X[], const double V[],
                                 const double dV[])
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  bw_status st = check(n, X, V, dV);
  if (n > ib->room) ib->n_sent = 0; /* the old addresses go with the old arrays */
  BW_THEN(st, bw_ibm_mdf__reserve(ib, n, 0));
  BW_TRY(bw_comm_agree(comm, st));
  ib->n = n;
  const int64_t changed = address(ib, X, V, dV);
  int64_t count[3] = {changed, (int64_t)n, (int64_t)(n - ib->n_sent)};
  bw_comm_sum_int(comm, 3, count);
  ib->markers = count[1], ib->outside = count[2];
  if (count[0] > 0) {
    bw_exchange_destroy(&ib->plan);
    ib->held = 0;
    BW_TRY(bw_exchange_create(comm, ib->n_sent, ib->destination, &ib->plan));
    const size_t held = bw_exchange_received(ib->plan);
    BW_TRY(bw_comm_agree(comm, bw_ibm_mdf__reserve(ib, 0, held)));
    ib->held = held;
  }
  bw_exchange_forward(ib->plan, sizeof *ib->item, ib->item, ib->received);
  bw_ibm_mdf__place(ib);
  bw_ibm_mdf_begin_step(ib);
  return BW_OK;
}

/* Position in cells from the block's lower edge, kept inside the block against rounding. */
static double local_position(const bw_grid_view *g, const double x[3], int d)
{
  return fmin(fmax(x[d] / g->spacing[d] - g->lo[d], 0.0), (double)g->m[d]);
}

static unsigned cell_of(const bw_grid_view *g, const double x[3])
{
  int c[3];
  for (int d = 0; d < 3; d++) {
    const int i = (int)local_position(g, x, d);
    c[d] = i < g->m[d] ? i : g->m[d] - 1;
  }
  return ((unsigned)c[2] * (unsigned)g->m[1] + (unsigned)c[1]) * (unsigned)g->m[0] + (unsigned)c[0];
}

/* Stable sort of order[] by key[], 8 bits at a time: the same result on every run. */
static void sort_by_key(bw_ibm_mdf *ib)
{
  unsigned *from = ib->order, *to = ib->swap, *key = ib->key, *key_to = ib->key_swap;
  for (int shift = 0; shift < 32; shift += 8) {
    size_t start[257] = {0};
    for (size_t m = 0; m < ib->held; m++)
      start[1 + (key[m] >> shift & 255u)]++;
    for (int b = 0; b < 256; b++)
      start[b + 1] += start[b];
    for (size_t m = 0; m < ib->held; m++) {
      const size_t place = start[key[m] >> shift & 255u]++;
      to[place] = from[m];
      key_to[place] = key[m];
    }
    unsigned *t = from;
    from = to, to = t;
    t = key, key = key_to, key_to = t;
  }
}

/* Weights of one direction at one place; returns the lowest local node. In x the window of four
 * is moved down where it would leave the halo (kernels of less than four nodes). */
static int direction(const bw_ibm_mdf *ib, const double x[3], int place, int d,
                     bw_ibm_mdf__stencil *s)
{
  const bw_grid_view *g = ib->g;
  const int support = ib->kernel->support;
  double w[BW_KERNEL_MAX_SUPPORT];
  const double local = local_position(g, x, d) + (place == IBM_CENTRE ? 0.5 : 0.0);
  const int first = bw_kernel_delta_weights(ib->kernel, local, w);
  const int highest = g->m[d] + g->halo[d] - IBM_WIDTH + 1;
  const int start = d == 0 && first > highest ? highest : first;
  const int n_inside = place == IBM_FACE ? g->n[d] - 1 : g->n[d];
  memset(s->w[place][d], 0, sizeof s->w[place][d]);
  s->keep[place][d] = 0;
  for (int q = 0; q < support; q++) {
    const int node = first + q, p = node - start;
    const bool ghost = !g->periodic[d] && (node + g->lo[d] < 1 || node + g->lo[d] > n_inside);
    s->w[place][d][p] = (bw_real)w[q];
    s->keep[place][d] |= (unsigned char)(!ghost << p);
    s->cut |= (unsigned char)(ghost && w[q] > 0.0);
  }
  return start;
}

static void make_stencil(const bw_ibm_mdf *ib, const double x[3], bw_ibm_mdf__stencil *s)
{
  const bw_grid_view *g = ib->g;
  int first[IBM_PLACES][3] = {{1, 1, 1}, {1, 1, 1}};
  s->cut = 0;
  for (int p = 0; p < IBM_PLACES; p++)
    for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++)
      first[p][d] = direction(ib, x, p, d, s);
  for (int c = 0; c < 3; c++)
    s->at[c] = bw_at(g, first[c == 0][0], first[c == 1][1], first[c == 2][2]);
}

void bw_ibm_mdf__place(bw_ibm_mdf *ib)
{
  for (size_t m = 0; m < ib->held; m++) {
    ib->order[m] = (unsigned)m;
    ib->key[m] = cell_of(ib->g, ib->received[m].x);
  }
  sort_by_key(ib);
  for (size_t m = 0; m < ib->held; m++) {
    const bw_ibm_mdf__item *item = &ib->received[ib->order[m]];
    make_stencil(ib, item->x, &ib->stencil[m]);
    memcpy(ib->V + 3 * m, item->v, sizeof item->v);
    ib->dV[m] = item->volume;
  }
}
