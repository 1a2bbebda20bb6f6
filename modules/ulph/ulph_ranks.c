/* Who owns which particle, copies of what others own, and the order of the slots. */
#include "bw_memory.h"
#include "ulph_internal.h"

#include <stdlib.h>

/* A new division of space is made when a rank has so many times its share, or so many times what
 * the last division left. */
static const double UNEQUAL = 1.1, WORSE = 1.05;

/* What slots are sorted by. */
typedef struct {
  uint64_t key;
  int64_t id;
  int32_t from;
} ordered;

static int compare(const void *a, const void *b)
{
  const ordered *p = a, *q = b;
  if (p->key != q->key) return p->key < q->key ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

void bw_ulph__where(const bw_ulph *u, const bw_ulph__particle *p, double x[3])
{
  const bool moved = p->wall >= 0 && u->moves[p->wall];
  for (int k = 0; k < 3; k++)
    x[k] = p->at[k] + (moved ? u->wall_x[k] : 0);
}

/* ---- owners ---- */
static bw_status places(const bw_ulph *u, size_t first, size_t n, double **x)
{
  BW_TRY(BW_ALLOCATE(x, 3 * n));
  for (size_t i = 0; i < n; i++)
    bw_ulph__where(u, u->own + first + i, *x + 3 * i);
  return BW_OK;
}

/* Equal numbers of fluid particles; walls go with the places. */
static bw_status divide(bw_ulph *u)
{
  bw_particles_space_config c = bw_particles_space_config_default();
  double *x = NULL;
  c.edge = u->R + u->skin;
  bw_particles_space_destroy(&u->space);
  bw_status st = bw_comm_agree(u->comm, places(u, 0, u->fluid.own, &x));
  BW_THEN(st, bw_particles_space_create(u->comm, &c, u->fluid.own, x, &u->space));
  bw_release(&x);
  return st;
}

/* Rows in the order of their keys; order[i].from is the row that comes to i. */
static void permute(bw_ulph__particle row[], ordered order[], size_t n)
{
  for (size_t i = 0; i < n; i++) {
    /* Round a cycle. */
    const bw_ulph__particle first = row[i];
    size_t to = i;
    while ((size_t)order[to].from != i) {
      const size_t from = (size_t)order[to].from;
      row[to] = row[from];
      order[to].from = (int32_t)to;
      to = from;
    }
    row[to] = first;
    order[to].from = (int32_t)to;
  }
}

/* Own particles sorted: fluid, walls, faces, by cell, part of the cell and identity. */
static bw_status sort_own(bw_ulph *u)
{
  /* Keys have 59 bits. */
  const uint64_t behind = UINT64_C(1) << 60;
  ordered *order = NULL;
  BW_TRY(BW_ALLOCATE(&order, u->n));
  u->fluid.own = u->wall.own = 0;
  for (size_t i = 0; i < u->n; i++) {
    const bool fluid = u->own[i].wall < 0, face = u->own[i].wall == u->n_walls;
    u->fluid.own += fluid;
    u->wall.own += !fluid && !face;
    const uint64_t part = fluid ? 0 : face ? 2 * behind : behind;
    order[i] = (ordered){bw_ulph__key(u, u->own + i) + part, u->own[i].id, (int32_t)i};
  }
  qsort(order, u->n, sizeof *order, compare);
  permute(u->own, order, u->n);
  u->wall.first = u->fluid.own;
  u->face.first = u->wall.first + u->wall.own;
  u->face.own = u->n - u->face.first;
  bw_release(&order);
  return BW_OK;
}

static bw_status send_home(bw_ulph *u)
{
  double *x = NULL, *there = NULL;
  void *rows = NULL;
  size_t n = 0;
  bw_status st = bw_comm_agree(u->comm, places(u, 0, u->n, &x));
  BW_THEN(st, bw_particles_migrate(u->space, u->n, x, sizeof *u->own, u->own, &n, &there, &rows));
  if (st == BW_OK) {
    bw_release(&u->own);
    u->own = rows;
    u->n = n;
  }
  bw_release(&x);
  bw_release(&there);
  BW_TRY(st);
  return bw_comm_agree(u->comm, sort_own(u));
}

/* The largest number of fluid particles of a rank over the mean. */
static double inequality(const bw_ulph *u)
{
  double most = (double)u->fluid.own;
  bw_comm_max(u->comm, 1, &most);
  return most * bw_comm_size(u->comm) / fmax(1, (double)u->total);
}

bw_status bw_ulph__migrate(bw_ulph *u)
{
  if (bw_comm_size(u->comm) == 1) return sort_own(u);
  if (u->space == NULL) {
    /* Fluid comes first, in whatever order, so that it can be counted. */
    BW_TRY(bw_comm_agree(u->comm, sort_own(u)));
    BW_TRY(divide(u));
    BW_TRY(send_home(u));
    u->balance = inequality(u);
    return BW_OK;
  }
  BW_TRY(send_home(u));
  const double now = inequality(u);
  if (now < UNEQUAL || now < WORSE * u->balance) return BW_OK;
  BW_TRY(divide(u));
  BW_TRY(send_home(u));
  u->balance = inequality(u);
  return BW_OK;
}

/* ---- slots ---- */
/* What a copy is sorted by. */
typedef struct {
  uint64_t key;
  int64_t id;
} name;

static name name_of(const bw_ulph *u, const bw_ulph__kind *kind, size_t own)
{
  const bw_ulph__particle *p = u->own + kind->first + own;
  return (name){bw_ulph__key(u, p), p->id};
}

/* Own particles and copies get their slots. */
static bw_status number_slots(bw_ulph *u, bw_ulph__kind *kind)
{
  const size_t copies = kind->copies == NULL ? 0 : bw_particles_copies_count(kind->copies);
  ordered *order = NULL;
  kind->n = kind->own + copies;
  BW_REQUIRE(kind->n < INT32_MAX / 2, BW_EINPUT,
             "ulph: %zu particles and copies on one rank: take more ranks", kind->n);
  bw_release(&kind->slot_own);
  bw_release(&kind->slot_copy);
  bw_release(&kind->key);
  BW_TRY(BW_ALLOCATE(&kind->slot_own, kind->own));
  BW_TRY(BW_ALLOCATE(&kind->slot_copy, copies));
  BW_TRY(BW_ALLOCATE(&kind->key, kind->n));
  BW_TRY(BW_ALLOCATE(&order, kind->n));
  for (size_t i = 0; i < kind->n; i++) {
    name q = {0};
    if (i < kind->own)
      q = name_of(u, kind, i);
    else
      memcpy(&q,
             (const char *)bw_particles_copies_answer(kind->copies) + (i - kind->own) * sizeof q,
             sizeof q);
    order[i] = (ordered){q.key, q.id, (int32_t)i};
  }
  /* Own particles are in order already. */
  if (copies > 0) qsort(order, kind->n, sizeof *order, compare);
  for (size_t s = 0; s < kind->n; s++) {
    const size_t from = (size_t)order[s].from;
    kind->key[s] = order[s].key;
    if (from < kind->own)
      kind->slot_own[from] = (int32_t)(kind->base + s);
    else
      kind->slot_copy[from - kind->own] = (int32_t)(kind->base + s);
  }
  bw_release(&order);
  return BW_OK;
}

/* Particles near another rank's places are offered to it, with their names. */
static bw_status offer(bw_ulph *u, bw_ulph__kind *kind)
{
  double *x = NULL;
  int32_t *own = NULL;
  int *destination = NULL;
  size_t rows = 0;
  bw_particles_copies_destroy(&kind->copies);
  if (bw_comm_size(u->comm) == 1) return BW_OK;
  bw_status st = places(u, kind->first, kind->own, &x);
  BW_THEN(st, bw_particles_space_near(u->space, kind->own, x, u->R + u->skin, &rows, &own,
                                      &destination));
  st = bw_comm_agree(u->comm, st);
  BW_THEN(st, bw_particles_copies_offer(u->comm, kind->own, rows, own, destination,
                                        sizeof(bw_ulph__far), &kind->copies));
  if (st == BW_OK) {
    name *reply = bw_particles_copies_reply(kind->copies);
    for (size_t q = 0; q < rows; q++)
      reply[q] = name_of(u, kind, (size_t)own[q]);
    bw_particles_copies_out(kind->copies, sizeof *reply, reply,
                            bw_particles_copies_answer(kind->copies));
  }
  bw_release(&x);
  bw_release(&own);
  bw_release(&destination);
  return st;
}

/* Arrays are made anew when they are too small, with some room. */
static bw_status make_room(bw_ulph *u)
{
  const size_t clusters = (u->fluid.own + BW_ULPH_LANES - 1) / BW_ULPH_LANES;
  const size_t shades = u->wall.own + u->face.own;
  if (u->slots > u->slot_room) {
    u->slot_room = u->slots + u->slots / 8;
    bw_release(&u->near);
    bw_release(&u->far);
    bw_release(&u->front);
    BW_TRY(BW_ALLOCATE(&u->near, u->slot_room));
    BW_TRY(BW_ALLOCATE(&u->far, u->slot_room));
    BW_TRY(BW_ALLOCATE(&u->front, u->slot_room));
  }
  if (clusters > u->between_room) {
    u->between_room = clusters + clusters / 8;
    bw_release(&u->between);
    BW_TRY(BW_ALLOCATE(&u->between, u->between_room));
  }
  if (shades <= u->shade_room) return BW_OK;
  u->shade_room = shades + shades / 8;
  bw_release(&u->shade);
  return BW_ALLOCATE(&u->shade, u->shade_room);
}

static bw_status number_all(bw_ulph *u)
{
  u->fluid.base = 0;
  BW_TRY(number_slots(u, &u->fluid));
  u->wall.base = u->fluid.n;
  BW_TRY(number_slots(u, &u->wall));
  u->face.base = u->wall.base + u->wall.n;
  BW_TRY(number_slots(u, &u->face));
  u->slots = u->fluid.n + u->wall.n + u->face.n;
  return make_room(u);
}

bw_status bw_ulph__slots(bw_ulph *u)
{
  BW_TRY(offer(u, &u->fluid));
  BW_TRY(offer(u, &u->wall));
  BW_TRY(offer(u, &u->face));
  return bw_comm_agree(u->comm, number_all(u));
}

void bw_ulph__send(bw_ulph__kind *kind, size_t bytes, void *slots)
{
  bw_particles_copies *c = kind->copies;
  if (c == NULL) return;
  const size_t rows = bw_particles_copies_rows(c), copies = bw_particles_copies_count(c);
  const int32_t *asked = bw_particles_copies_asked(c);
  char *reply = bw_particles_copies_reply(c), *answer = bw_particles_copies_answer(c), *s = slots;
  for (size_t q = 0; q < rows; q++)
    memcpy(reply + q * bytes, s + (size_t)kind->slot_own[asked[q]] * bytes, bytes);
  bw_particles_copies_out(c, bytes, reply, answer);
  for (size_t k = 0; k < copies; k++)
    memcpy(s + (size_t)kind->slot_copy[k] * bytes, answer + k * bytes, bytes);
}
