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
    b->flag[i] = full ? BW_PROBE_FREE : some ? BW_PROBE_SHORTENED : BW_PROBE_BLOCKED;
  }
}

/* Is there an obstacle `along` the normal from a tip of this rank, at most 1.5 h away? */
static bool obstructed(const bw_probe *b, const bw_probe__item *item, double along)
{
  const bw_grid_view *g = b->g;
  int cell[3] = {1, 1, 1};
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++) {
    const double x = item->tip[d] + along * item->normal[d];
    const int i = (int)floor(x / g->spacing[d]) + 1 - g->lo[d], most = g->m[d] + g->halo[d];
    if (!g->periodic[d] && (x < 0.0 || x > g->length[d])) return false;
    cell[d] = i < 1 - g->halo[d] ? 1 - g->halo[d] : i > most ? most : i;
  }
  return (double)b->obstacles[bw_at(g, cell[0], cell[1], cell[2])] > 0.5;
}

/* From a tip, the nearest obstacle ahead (at most 1.5 h) and behind, in steps of h/4 [L]. */
static void look_around(const bw_probe *b, const bw_probe__item *item, double *ahead,
                        double *behind)
{
  enum { LOOKS = 6 };
  *ahead = *behind = HUGE_VAL;
  for (int q = LOOKS; q >= 0; q--) {
    const double s = 0.25 * q * b->h;
    if (obstructed(b, item, s)) *ahead = s;
    if (obstructed(b, item, -s)) *behind = s;
  }
}

/* A probe reads what is up to 1.5 h around its tip, most of it within h: its length is such that
 * nothing is within h ahead of the tip. `wall`: where the first obstacle was seen, from the root;
 * known to h/4, and cells tell where a solid is to half of them. */
static void shorten(bw_probe *b, size_t i, double wall)
{
  if (wall >= b->length[i] + b->h) return;
  b->length[i] = wall > b->h ? fmax(b->h, wall - 1.25 * b->h) : 0.0;
  b->flag[i] = wall > 1.75 * b->h ? BW_PROBE_SHORTENED
               : wall > b->h      ? BW_PROBE_CROWDED
                                  : BW_PROBE_BLOCKED;
}

/* Look for obstacles between h and one h ahead of every tip, from the tip and from a distance h. */
static bw_status avoid_obstacles(bw_probe *b, const double X[])
{
  b->n_sent = 0;
  for (size_t i = 0; i < b->n; i++) {
    if (b->length[i] > b->h) send_tip(b, i, X + 3 * i, b->length[i]);
    if (b->length[i] > 0.0) send_tip(b, i, X + 3 * i, b->h);
  }
  BW_TRY(route(b));
  for (size_t q = 0; q < b->held; q++)
    look_around(b, &b->received[q], &b->reply[q].p.value, &b->reply[q].p.slope);
  bw_exchange_backward(b->plan, sizeof *b->reply, b->reply, b->answer);
  for (size_t s = 0; s < b->n_sent;) {
    const size_t i = b->sent_from[s];
    const double dl = b->length[i], seen = 2.5 * b->h;
    double wall = HUGE_VAL;
    if (dl > b->h) { /* the long one first; what it sees behind it, if the short one does not */
      const bw_probe__along *far = &b->answer[s++].p;
      wall = dl - far->slope > seen ? seen : dl + far->value;
    }
    shorten(b, i, fmin(wall, b->h + b->answer[s++].p.value));
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
    if (b->length[i] > 0.0) send_tip(b, i, X + 3 * i, b->length[i]);
  }
  return route(b);
}
