/* A flood over slabs of cells, one slab a rank. */
#include "bw_exchange.h"
#include "bw_memory.h"
#include "bw_shape_way.h"

#include <string.h>

enum { OPEN, SOLID, REACHED };

/* Cells of the slab whose neighbours are to be looked at. */
typedef struct {
  size_t n, room;
  int64_t *cell;
} front;

typedef struct {
  const bw_comm *comm;
  const bw_shape_way_box *box;
  int across;            /* the axis that is cut */
  int64_t first, layers; /* of this rank, along it */
  int64_t stride[3];     /* of a cell's number in the slab; stride[across] is a layer */
  uint8_t *state;        /* (layers, stride[across]) */
  front now, next;
  bw_status st; /* of the front's growth, kept until the ranks agree */
  bw_exchange *borders;
  int64_t border[2];     /* own layers that are sent, counted from the first */
  int64_t target[2];     /* the layers of the box that the borders received are next to */
  uint8_t *sent, *given; /* (2, stride[across]), at most two of each */
} slab;

static int64_t first_layer(const slab *s, int64_t rank)
{
  return s->box->cells[s->across] * rank / bw_comm_size(s->comm);
}

static int owner(const slab *s, int64_t layer)
{
  return (int)(((layer + 1) * bw_comm_size(s->comm) - 1) / s->box->cells[s->across]);
}

static int64_t cells_of(const slab *s)
{
  return s->layers * s->stride[s->across];
}

static bw_status check_box(const bw_shape_way_box *b)
{
  double all = 1.0;
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(b->cells[d] > 0 && b->cells[d] <= INT32_MAX, BW_EINPUT,
               "way: cells[%d] = %lld has to be 1 .. 2^31 - 1", d, (long long)b->cells[d]);
    all *= (double)b->cells[d];
  }
  BW_REQUIRE(all < 4e18, BW_EINPUT, "way: %g cells are more than can be numbered", all);
  BW_REQUIRE(b->axis >= 0 && b->axis <= 2, BW_EINPUT, "way: axis = %d has to be 0, 1 or 2",
             b->axis);
  BW_REQUIRE(!b->periodic[b->axis], BW_EINPUT,
             "way: the box is periodic along axis %d, so that it has no sides there", b->axis);
  return BW_OK;
}

/* Cut across the longest axis, so that borders are smallest and slabs most even. */
static bw_status make_slab(const bw_comm *comm, const bw_shape_way_box *box, slab *s)
{
  *s = (slab){.comm = comm, .box = box};
  BW_TRY(check_box(box));
  for (int d = 1; d < 3; d++)
    if (box->cells[d] >= box->cells[s->across]) s->across = d;
  int64_t stride = 1;
  for (int d = 0; d < 3; d++) {
    if (d == s->across) continue;
    s->stride[d] = stride;
    stride *= box->cells[d];
  }
  s->stride[s->across] = stride;
  s->first = first_layer(s, bw_comm_rank(comm));
  s->layers = first_layer(s, bw_comm_rank(comm) + 1) - s->first;
  BW_TRY(BW_ALLOCATE(&s->state, (size_t)cells_of(s)));
  BW_TRY(BW_ALLOCATE(&s->sent, 2 * (size_t)stride));
  return BW_ALLOCATE(&s->given, 2 * (size_t)stride);
}

static void release_slab(slab *s)
{
  bw_exchange_destroy(&s->borders);
  bw_release(&s->state);
  bw_release(&s->sent);
  bw_release(&s->given);
  bw_release(&s->now.cell);
  bw_release(&s->next.cell);
}

/* ---- solid cells to the ranks that hold them ---- */

static bool within(const bw_shape_way_box *b, const int32_t at[3])
{
  bool in = true;
  for (int d = 0; d < 3; d++)
    in = in && at[d] >= 0 && at[d] < b->cells[d];
  return in;
}

/* Destinations (m) of the sites within the box, and their numbers in the slab there. */
static size_t address(const slab *s, int64_t n, const int32_t site[], int to[], int64_t cell[])
{
  size_t m = 0;
  for (int64_t q = 0; q < n; q++) {
    const int32_t *at = site + 3 * q;
    if (!within(s->box, at)) continue;
    to[m] = owner(s, at[s->across]);
    cell[m] = -first_layer(s, to[m]) * s->stride[s->across];
    for (int d = 0; d < 3; d++)
      cell[m] += at[d] * s->stride[d];
    m++;
  }
  return m;
}

static bw_status mark_solid(slab *s, int64_t n, const int32_t site[])
{
  int *to = NULL;
  int64_t *cell = NULL, *mine = NULL;
  bw_exchange *plan = NULL;
  bw_status st = BW_ALLOCATE(&to, (size_t)n);
  BW_THEN(st, BW_ALLOCATE(&cell, (size_t)n));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK)
    st = bw_comm_agree(s->comm,
                       bw_exchange_create(s->comm, address(s, n, site, to, cell), to, &plan));
  bw_release(&to);
  if (st == BW_OK) st = bw_comm_agree(s->comm, BW_ALLOCATE(&mine, bw_exchange_received(plan)));
  if (st == BW_OK) {
    bw_exchange_forward(plan, sizeof *cell, cell, mine);
    for (size_t q = 0; q < bw_exchange_received(plan); q++)
      s->state[mine[q]] = SOLID;
  }
  bw_exchange_destroy(&plan);
  bw_release(&cell);
  bw_release(&mine);
  return st;
}

/* ---- borders ---- */

/* The plan of a round: the lowest and the highest layer of every slab go to the ranks that hold
 * what lies beyond them. A rank may get both from one neighbour, or from itself, so that each
 * border says next to which layer it belongs. Collective. */
static bw_status plan_borders(slab *s)
{
  const int64_t all = s->box->cells[s->across];
  const int64_t beyond[2] = {s->first - 1, s->first + s->layers};
  int64_t next_to[2];
  int to[2];
  size_t n = 0;
  for (int side = 0; side < 2 && s->layers > 0; side++) {
    if (!s->box->periodic[s->across] && (beyond[side] < 0 || beyond[side] == all)) continue;
    next_to[n] = (beyond[side] + all) % all;
    to[n] = owner(s, next_to[n]);
    s->border[n] = side == 0 ? 0 : s->layers - 1;
    n++;
  }
  BW_TRY(bw_comm_agree(s->comm, bw_exchange_create(s->comm, n, to, &s->borders)));
  bw_exchange_forward(s->borders, sizeof next_to[0], next_to, s->target);
  return BW_OK;
}

static bw_status grow(front *f)
{
  BW_TRY(BW_ENLARGE(&f->cell, f->n, 2 * f->room + 1024));
  f->room = 2 * f->room + 1024;
  return BW_OK;
}

static bool enter(slab *s, int64_t cell, front *f)
{
  if (s->state[cell] != OPEN || s->st != BW_OK) return false;
  if (f->n == f->room) s->st = grow(f);
  if (s->st != BW_OK) return false;
  s->state[cell] = REACHED;
  f->cell[f->n++] = cell;
  return true;
}

/* What the neighbours have reached in the layers next to this slab is reached here as well. Returns
 * how many cells are new. Collective. */
static int64_t exchange_borders(slab *s)
{
  const int64_t layer = s->stride[s->across];
  for (size_t q = 0; q < bw_exchange_sent(s->borders); q++)
    memcpy(s->sent + (int64_t)q * layer, s->state + s->border[q] * layer, (size_t)layer);
  bw_exchange_forward(s->borders, (size_t)layer, s->sent, s->given);
  int64_t entered = 0;
  for (size_t q = 0; q < bw_exchange_received(s->borders); q++)
    for (int64_t cell = 0; cell < layer; cell++)
      if (s->given[(int64_t)q * layer + cell] == REACHED)
        entered += enter(s, (s->target[q] - s->first) * layer + cell, &s->now);
  return entered;
}

/* ---- the flood ---- */

/* Where the neighbour of `at` is; false where there is none in this slab. */
static bool step(const slab *s, int64_t cell, int64_t at, int d, int to, int64_t *neighbour)
{
  const bool cut = d == s->across;
  const int64_t size = cut ? s->layers : s->box->cells[d];
  int64_t next = at + to;
  if (next < 0 || next >= size) {
    if (cut || !s->box->periodic[d]) return false;
    next = (next + size) % size;
  }
  *neighbour = cell + (next - at) * s->stride[d];
  return true;
}

/* From the front to all that is connected to it in this slab. Local. */
static void flood(slab *s)
{
  while (s->now.n > 0 && s->st == BW_OK) {
    s->next.n = 0;
    for (size_t q = 0; q < s->now.n; q++)
      for (int d = 0; d < 3; d++) {
        const int64_t cell = s->now.cell[q], row = cell / s->stride[d];
        const int64_t at = d == s->across ? row : row % s->box->cells[d];
        int64_t to;
        for (int side = -1; side <= 1; side += 2)
          if (step(s, cell, at, d, side, &to)) enter(s, to, &s->next);
      }
    const front done = s->now;
    s->now = s->next;
    s->next = done;
  }
  s->now.n = 0;
}

/* Each cell of the slab whose place along the box's axis is `at`, to `what`, with `sum`. */
typedef void (*visitor)(slab *s, int64_t cell, int64_t *sum);

static int64_t visit_side(slab *s, int64_t at, visitor what)
{
  const int d = s->box->axis;
  int64_t sum = 0;
  for (int64_t cell = 0; cell < cells_of(s); cell++) {
    const int64_t row = cell / s->stride[d];
    const int64_t here = d == s->across ? row + s->first : row % s->box->cells[d];
    if (here == at) what(s, cell, &sum);
  }
  return sum;
}

static void start_here(slab *s, int64_t cell, int64_t *sum)
{
  *sum += enter(s, cell, &s->now);
}

static void count_reached(slab *s, int64_t cell, int64_t *sum)
{
  *sum += s->state[cell] == REACHED;
}

/* Rounds of floods and exchanges, until nothing is new anywhere. Collective. */
static bw_status flood_all(slab *s)
{
  visit_side(s, 0, start_here);
  int64_t entered = 1;
  while (entered > 0) {
    flood(s);
    BW_TRY(bw_comm_agree(s->comm, s->st));
    /* Every slab is flooded as far as it goes by itself; only borders can bring more. */
    entered = exchange_borders(s);
    /* A front that could not grow has entered less than it should: another round says so. */
    if (s->st != BW_OK) entered = 1;
    bw_comm_max_int(s->comm, 1, &entered);
  }
  return BW_OK;
}

static void conclude(slab *s, bw_shape_way *way)
{
  int64_t sum[3] = {visit_side(s, s->box->cells[s->box->axis] - 1, count_reached), 0, 0};
  for (int64_t cell = 0; cell < cells_of(s); cell++) {
    sum[1] += s->state[cell] != SOLID;
    sum[2] += s->state[cell] == REACHED;
  }
  bw_comm_sum_int(s->comm, 3, sum);
  *way = (bw_shape_way){.through = sum[0] > 0, .open = sum[1], .reached = sum[2]};
}

bw_status bw_shape_find_way(const bw_comm *comm, const bw_shape_way_box *box, int64_t n,
                            const int32_t site[], bw_shape_way *way)
{
  slab s;
  *way = (bw_shape_way){0};
  bw_status st = bw_comm_agree(comm, make_slab(comm, box, &s));
  BW_THEN(st, mark_solid(&s, n, site));
  BW_THEN(st, plan_borders(&s));
  BW_THEN(st, flood_all(&s));
  if (st == BW_OK) conclude(&s, way);
  release_slab(&s);
  return st;
}
