/* Where the tips go: full length, shortened or none; and on which rank they are read. */
#include "bw_memory.h"
#include "probe_internal.h"

#include <math.h>
#include <string.h>

static bw_status reserve_points(bw_probe *b, size_t n)
{
  if (n <= b->room) return BW_OK;
  b->room = 0; /* stays so if an allocation fails */
  bw_release(&b->normal);
  bw_release(&b->length);
  bw_release(&b->flag);
  BW_TRY(BW_ALLOCATE(&b->normal, 3 * n));
  BW_TRY(BW_ALLOCATE(&b->length, n));
  BW_TRY(BW_ALLOCATE(&b->flag, n));
  b->room = n;
  return BW_OK;
}

/* Room for n tips of this rank's points. */
static bw_status reserve_sent(bw_probe__tips *t, size_t n)
{
  if (n <= t->room) return BW_OK;
  t->n = t->room = 0;
  bw_release(&t->from);
  bw_release(&t->to);
  bw_release(&t->item);
  bw_release(&t->answer);
  bw_release(&t->seen);
  bw_release(&t->read);
  BW_TRY(BW_ALLOCATE(&t->from, n));
  BW_TRY(BW_ALLOCATE(&t->to, n));
  BW_TRY(BW_ALLOCATE(&t->item, n));
  BW_TRY(BW_ALLOCATE(&t->answer, n));
  BW_TRY(BW_ALLOCATE(&t->seen, n));
  BW_TRY(BW_ALLOCATE(&t->read, n));
  t->room = n;
  return BW_OK;
}

/* Room for n tips in this rank's cells. */
static bw_status reserve_held(bw_probe__tips *t, size_t n)
{
  if (n <= t->held_room) return BW_OK;
  const size_t some = n + n / 8; /* points come and go */
  t->held_room = 0;
  bw_release(&t->received);
  bw_release(&t->reply);
  bw_release(&t->seen_here);
  BW_TRY(BW_ALLOCATE(&t->received, some));
  BW_TRY(BW_ALLOCATE(&t->reply, some));
  BW_TRY(BW_ALLOCATE(&t->seen_here, some));
  t->held_room = some;
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
    /* Two dimensions: the middle of the one cell. */
    if (d == 2 && g->n[2] == 1) {
      tip[d] = 0.5 * g->length[d];
    } else if (g->periodic[d]) {
      /* A tip beyond a periodic side is read on the other end. */
      if (tip[d] >= 0.0 && tip[d] < g->length[d]) continue;
      tip[d] -= g->length[d] * floor(tip[d] / g->length[d]);
      if (tip[d] >= g->length[d]) tip[d] = 0.0; /* -1e-20 + length rounds to length */
    } else if (tip[d] - half < 0.0 || tip[d] + half > g->length[d]) {
      return false;
    }
  }
  return true;
}

static void start_list(bw_probe__tips *t)
{
  t->before = t->n;
  t->changed = t->plan == NULL;
  t->n = 0;
}

/* An empty set without a plan. */
static void forget(bw_probe__tips *t)
{
  bw_exchange_destroy(&t->plan);
  t->n = t->held = 0;
}

/* Add the tip of point i at distance dl; false when it leaves the box. */
static bool add_tip(bw_probe *b, bw_probe__tips *t, size_t i, const double x[3], double dl)
{
  bw_probe__item *item = &t->item[t->n];
  memcpy(item->normal, b->normal + 3 * i, sizeof item->normal);
  if (!place_tip(b->g, x, item->normal, dl, item->tip)) return false;
  const int rank = bw_grid_owner(b->grid, item->tip);
  /* The plan holds as long as each tip goes to the rank that its predecessor went to. */
  t->changed |= t->n >= t->before || t->to[t->n] != rank;
  t->to[t->n] = rank;
  t->read[t->n] = 1;
  t->from[t->n++] = i;
  return true;
}

/* Send the listed tips to their ranks; where those are the same as last time, by the same plan. */
static bw_status route(bw_probe *b, bw_probe__tips *t)
{
  const bw_comm *comm = bw_grid_comm(b->grid);
  int64_t news = t->changed || t->n != t->before;
  /* A new plan is made by all ranks or by none. */
  bw_comm_sum_int(comm, 1, &news);
  if (news > 0) {
    t->held = 0;
    bw_exchange_destroy(&t->plan);
    BW_TRY(bw_exchange_create(comm, t->n, t->to, &t->plan));
    const size_t held = bw_exchange_received(t->plan);
    BW_TRY(bw_comm_agree(comm, reserve_held(t, held)));
    t->held = held;
  }
  /* Each tip is now with the rank that owns its cell. */
  bw_exchange_forward(t->plan, sizeof *t->item, t->item, t->received);
  return BW_OK;
}

/* Places along the normal at -LOOKS..LOOKS quarters of h from a tip of this rank; further than 1.5
 * h another rank would have to be asked. LANES: of which 2 LOOKS + 1 count, a whole vector. */
enum { LOOKS = 6, LANES = 16 };

typedef struct {
  ptrdiff_t cell[LANES]; /* offset in a field, direction by direction */
  int inside[LANES];     /* the box */
} places;

static void add_direction(const bw_probe *b, const bw_probe__item *item, int d, places *at)
{
  const bw_grid_view *g = b->g;
  const double centre = item->tip[d] / g->spacing[d];
  /* A quarter of h along the normal, in cells of this direction. */
  const double step = 0.25 * b->h * item->normal[d] / g->spacing[d];
  const double low = g->periodic[d] ? -HUGE_VAL : 0.0, high = g->periodic[d] ? HUGE_VAL : g->n[d];
  const int least = 1 - g->halo[d], most = g->m[d] + g->halo[d], lo = g->lo[d];
  const int stride = (int)g->stride[d];
  for (int q = 0; q < LANES; q++) {
    const double s = centre + (q - LOOKS) * step;
    /* Beyond the halo the nearest layer stands in: LOOKS is such that nothing further is asked. */
    const int i = (int)floor(s) + 1 - lo, c = i < least ? least : i > most ? most : i;
    at->cell[q] += (ptrdiff_t)stride * c;
    at->inside[q] &= (s >= low) & (s <= high);
  }
}

/* Whether there is an obstacle at each place: bits 0..2 LOOKS. */
static unsigned look_along(const bw_probe *b, const bw_probe__item *item)
{
  const int dims = b->g->n[2] == 1 ? 2 : 3;
  unsigned seen = 0;
  places at;
  /* Offsets add up direction by direction; all places of a probe in one vector. */
  for (int q = 0; q < LANES; q++)
    at.cell[q] = bw_at(b->g, 0, 0, dims == 2), at.inside[q] = 1;
  for (int d = 0; d < dims; d++)
    add_direction(b, item, d, &at);
  /* One bit per place, so that the whole view travels as a number. */
  for (int q = 0; q <= 2 * LOOKS; q++)
    seen |= (unsigned)(at.inside[q] & b->obstacles[at.cell[q]]) << q;
  return seen;
}

/* What is to be seen from each tip. Collective. */
static void look(bw_probe *b, bw_probe__tips *t)
{
  for (size_t q = 0; q < t->held; q++)
    t->seen_here[q] = (uint16_t)look_along(b, &t->received[q]);
  bw_exchange_backward(t->plan, sizeof *t->seen, t->seen_here, t->seen);
}

/* Distance from the root of the first obstacle that a tip at dl has seen from h on. */
static double first_seen(const bw_probe *b, unsigned seen, double dl)
{
  if (seen == 0) return HUGE_VAL;
  /* From the root outwards; nearer than h the surface itself would be seen. */
  for (int q = -LOOKS; q <= LOOKS; q++) {
    const double at = dl + 0.25 * q * b->h;
    if ((seen >> (q + LOOKS) & 1u) != 0 && at > b->h * (1.0 - 1.0e-9)) return at;
  }
  return HUGE_VAL;
}

/* The longest probe of every point when nothing but the box is in the way. */
static void fit_into_box(bw_probe *b, const double X[])
{
  bw_probe__tips *t = &b->tips[PROBE_LONGEST];
  start_list(t);
  for (size_t i = 0; i < b->n; i++) {
    const double *x = X + 3 * i;
    /* At full length if the box allows, else at one spacing, else not at all. */
    const bool full = add_tip(b, t, i, x, b->full), some = full || add_tip(b, t, i, x, b->h);
    b->length[i] = full ? b->full : some ? b->h : 0.0;
    b->flag[i] = full ? BW_PROBE_FREE : some ? BW_PROBE_SHORTENED : BW_PROBE_BLOCKED;
  }
}

/* A probe reads what is up to 1.5 h around its tip, most of it within h: its length is such that
 * nothing is within h ahead of the tip. `wall`: where the first obstacle was seen, from the root;
 * known to h/4, and cells tell where a solid is to half of them. */
static void shorten(bw_probe *b, size_t i, double wall)
{
  /* A spacing is free ahead of the tip: nothing to shorten. */
  if (wall >= b->length[i] + b->h) return;
  /* Short of the obstacle by a spacing and the quarter that its place is uncertain by. */
  b->length[i] = wall > b->h ? fmax(b->h, wall - 1.25 * b->h) : 0.0;
  b->flag[i] = wall > 1.75 * b->h ? BW_PROBE_SHORTENED
               : wall > b->h      ? BW_PROBE_CROWDED
                                  : BW_PROBE_BLOCKED;
}

/* A tip farther out than this does not see back to h. */
static double nearsighted(const bw_probe *b)
{
  return b->h * (1.0 + 0.25 * LOOKS);
}

/* Look for obstacles between h and one h ahead of every tip, from the longest tip and where that
 * is too far out also from h; then give new tips to the probes that became shorter. */
static bw_status avoid_obstacles(bw_probe *b, const double X[])
{
  bw_probe__tips *longest = &b->tips[PROBE_LONGEST], *near = &b->tips[PROBE_NEAR];
  bw_probe__tips *shorter = &b->tips[PROBE_SHORTER];
  start_list(near);
  /* From a long probe's tip the first part of the way is out of sight: a second look, from h. */
  for (size_t s = 0; s < longest->n && b->full > nearsighted(b); s++) {
    const size_t i = longest->from[s];
    if (b->length[i] > b->h) add_tip(b, near, i, X + 3 * i, b->h);
  }
  BW_TRY(route(b, near));
  /* Both views come back to the ranks of the points. */
  look(b, longest);
  look(b, near);
  start_list(shorter);
  /* `near` lists the same points in the same order, with gaps. */
  for (size_t s = 0, q = 0; s < longest->n; s++) {
    const size_t i = longest->from[s];
    const double dl = b->length[i];
    double wall = first_seen(b, longest->seen[s], dl);
    if (q < near->n && near->from[q] == i) wall = fmin(wall, first_seen(b, near->seen[q++], b->h));
    shorten(b, i, wall);
    /* Its reading counts only if it kept its length; else a new tip is sent. */
    longest->read[s] = b->length[i] == dl;
    if (!longest->read[s] && b->length[i] > 0.0) add_tip(b, shorter, i, X + 3 * i, b->length[i]);
  }
  return route(b, shorter);
}

bw_status bw_probe_set_points(bw_probe *b, size_t n, const double X[], const double N[])
{
  bw_status st = check(n, X, N);
  BW_THEN(st, reserve_points(b, n));
  for (int t = 0; t < PROBE_SETS; t++)
    BW_THEN(st, reserve_sent(&b->tips[t], n));
  /* A bad normal on one rank ends the call on all. */
  BW_TRY(bw_comm_agree(bw_grid_comm(b->grid), st));
  b->n = n;
  b->V = b->spin = NULL;
  if (n > 0) memcpy(b->normal, N, 3 * n * sizeof *N);
  /* First as if nothing but the box were in the way ... */
  fit_into_box(b, X);
  BW_TRY(route(b, &b->tips[PROBE_LONGEST]));
  /* ... then with what stands there. */
  if (b->in_the_way) return avoid_obstacles(b, X);
  forget(&b->tips[PROBE_NEAR]);
  forget(&b->tips[PROBE_SHORTER]);
  return BW_OK;
}
