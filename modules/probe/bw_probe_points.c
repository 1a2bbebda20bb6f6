/* Where the tips go: full length, shortened or none; and on which rank they are read. */
#include "bw_memory.h"
#include "probe_internal.h"

#include <math.h>
#include <string.h>

static bw_status reserve(bw_probe *b, size_t n, size_t held)
{
  if (n > b->room) {
    b->room = 0; /* stays so if an allocation fails */
    bw_release(&b->point);
    bw_release(&b->length);
    bw_release(&b->flag);
    bw_release(&b->sent_from);
    bw_release(&b->destination);
    bw_release(&b->item);
    bw_release(&b->answer);
    BW_TRY(BW_ALLOCATE(&b->point, n));
    BW_TRY(BW_ALLOCATE(&b->length, n));
    BW_TRY(BW_ALLOCATE(&b->flag, n));
    BW_TRY(BW_ALLOCATE(&b->sent_from, 2 * n));
    BW_TRY(BW_ALLOCATE(&b->destination, 2 * n));
    BW_TRY(BW_ALLOCATE(&b->item, 2 * n));
    BW_TRY(BW_ALLOCATE(&b->answer, 2 * n));
    b->room = n;
  }
  if (held > b->held_room) {
    const size_t some = held + held / 8; /* points come and go */
    b->held_room = 0;
    bw_release(&b->received);
    bw_release(&b->reply);
    BW_TRY(BW_ALLOCATE(&b->received, some));
    BW_TRY(BW_ALLOCATE(&b->reply, some));
    b->held_room = some;
  }
  return BW_OK;
}

static bw_status check(size_t n, const double X[], const double N[])
{
  for (size_t i = 0; i < n; i++) {
    const double *x = X + 3 * i, *m = N + 3 * i;
    BW_REQUIRE(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]), BW_EINPUT,
               "surface point %zu: position (%g, %g, %g) must be finite", i, x[0], x[1], x[2]);
    const double square = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    BW_REQUIRE(fabs(square - 1.0) < 1.0e-6, BW_EINPUT,
               "surface point %zu: normal (%g, %g, %g) must have length 1", i, m[0], m[1], m[2]);
  }
  return BW_OK;
}

/* The tip at distance dl, wrapped into the box; false when its stencil (or the point's) leaves it
 * through a side that is not periodic. */
static bool place_tip(const bw_grid_view *g, const double x[3], const double n[3], double dl,
                      double tip[3])
{
  for (int d = 0; d < 3; d++) {
    const double half = 0.5 * g->spacing[d];
    tip[d] = x[d] + dl * n[d];
    if (d == 2 && g->n[2] == 1) {
      tip[d] = 0.5 * g->length[d];
    } else if (g->periodic[d]) {
      tip[d] -= g->length[d] * floor(tip[d] / g->length[d]);
      if (tip[d] >= g->length[d]) tip[d] = 0.0; /* -1e-20 + length rounds to length */
    } else if (tip[d] - half < 0.0 || tip[d] + half > g->length[d]) {
      return false;
    }
  }
  return true;
}

/* Add the tip of point i at distance dl to those to be sent; false when it leaves the box. */
static bool send_tip(bw_probe *b, size_t i, const double x[3], double dl)
{
  bw_probe__item *item = &b->item[b->n_sent];
  memcpy(item->normal, b->point[i].normal, sizeof item->normal);
  if (!place_tip(b->g, x, item->normal, dl, item->tip)) return false;
  b->destination[b->n_sent] = bw_grid_owner(b->grid, item->tip);
  b->sent_from[b->n_sent++] = i;
  return true;
}

/* Send the listed tips to their ranks. */
static bw_status route(bw_probe *b)
{
  const bw_comm *comm = bw_grid_comm(b->grid);
  b->held = 0;
  bw_exchange_destroy(&b->plan);
  BW_TRY(bw_exchange_create(comm, b->n_sent, b->destination, &b->plan));
  const size_t held = bw_exchange_received(b->plan);
  BW_TRY(bw_comm_agree(comm, reserve(b, 0, held)));
  b->held = held;
  bw_exchange_forward(b->plan, sizeof *b->item, b->item, b->received);
  return BW_OK;
}

/* Length of every probe when nothing but the box is in the way. */
static void fit_into_box(bw_probe *b, const double X[])
{
  for (size_t i = 0; i < b->n; i++) {
    double tip[3];
    const double *x = X + 3 * i, *n = b->point[i].normal;
    const bool full = place_tip(b->g, x, n, b->full, tip);
    const bool some = full || place_tip(b->g, x, n, b->h, tip);
    b->length[i] = full ? b->full : some ? b->h : 0.0;
  }
}

/* Try both lengths of every probe against the obstacles. */
static bw_status avoid_obstacles(bw_probe *b, const double X[])
{
  b->n_sent = 0;
  for (size_t i = 0; i < b->n; i++) {
    if (b->length[i] > b->h) send_tip(b, i, X + 3 * i, b->length[i]);
    if (b->length[i] > 0.0) send_tip(b, i, X + 3 * i, b->h);
  }
  BW_TRY(route(b));
  for (size_t q = 0; q < b->held; q++) {
    bw_probe__tip tip;
    bw_probe__weigh(b, b->received[q].tip, &tip);
    b->reply[q].p.value = bw_probe__evaluate(b, b->obstacles, 3, &tip).value;
  }
  bw_exchange_backward(b->plan, sizeof *b->reply, b->reply, b->answer);
  /* the first free tip of a point, the long one coming first */
  for (size_t i = 0, s = 0; i < b->n; i++) {
    const double longest = b->length[i];
    bool free = false;
    for (double dl = longest; s < b->n_sent && b->sent_from[s] == i; s++, dl = b->h)
      if (!free && b->answer[s].p.value <= 0.5) {
        free = true;
        b->length[i] = dl;
      }
    if (!free) b->length[i] = 0.0;
  }
  return BW_OK;
}

bw_status bw_probe_set_points(bw_probe *b, size_t n, const double X[], const double N[])
{
  const bw_comm *comm = bw_grid_comm(b->grid);
  bw_status st = check(n, X, N);
  BW_THEN(st, reserve(b, n, 0));
  BW_TRY(bw_comm_agree(comm, st));
  b->n = n;
  b->V = b->spin = NULL;
  for (size_t i = 0; i < n; i++)
    memcpy(b->point[i].normal, N + 3 * i, sizeof b->point[i].normal);
  fit_into_box(b, X);
  if (b->obstacles != NULL) BW_TRY(avoid_obstacles(b, X));
  b->n_sent = 0;
  for (size_t i = 0; i < n; i++) {
    const double dl = b->length[i];
    b->flag[i] = dl >= b->full ? BW_PROBE_FREE : dl > 0.0 ? BW_PROBE_SHORTENED : BW_PROBE_BLOCKED;
    if (dl > 0.0) send_tip(b, i, X + 3 * i, dl);
  }
  return route(b);
}
