/* Lists of neighbours: cells, clusters of own particles, who is within reach of a cluster. */
#include "bw_memory.h"
#include "ulph_internal.h"

/* Cells are told apart this far either way of the origin. A key has 18 bits per direction, x the
 * lowest, and behind them 3 bits for the eighth of the cell. */
enum { FARTHEST = 1 << 17, BITS = 18 };

/* Halves of cells from the outermost one. */
static uint64_t half_cell(double x, double edge)
{
  return (uint64_t)fmax(0, fmin(4.0 * FARTHEST - 1, floor(2 * x / edge) + 2.0 * FARTHEST));
}

uint64_t bw_ulph__key(const bw_ulph *u, const double x[3])
{
  uint64_t key = 0, part = 0;
  for (int k = 2; k >= 0; k--) {
    const uint64_t half = half_cell(x[k], u->R + u->skin);
    key = key << BITS | half >> 1;
    part = part << 1 | (half & 1);
  }
  return key << 3 | part;
}

/* The first slot of a kind with a key of at least this one. */
static size_t first_with(const bw_ulph__kind *kind, uint64_t key)
{
  size_t below = 0, above = kind->n;
  while (below < above) {
    const size_t middle = below + (above - below) / 2;
    if (kind->key[middle] < key)
      below = middle + 1;
    else
      above = middle;
  }
  return below;
}

/* Where the lanes of a cluster are, and a box around all that they reach. */
typedef struct {
  vec x[3];
  double lower[3], upper[3], reach;
} ball;

static ball ball_of(const bw_ulph *u, const bw_ulph__kind *kind, size_t first, int lanes)
{
  ball b = {.reach = u->R + u->skin};
  for (int k = 0; k < 3; k++) {
    b.lower[k] = INFINITY, b.upper[k] = -INFINITY;
    for (int l = 0; l < BW_ULPH_LANES; l++) {
      /* Lanes that are not used repeat the last one. */
      const size_t own = first + (size_t)(l < lanes ? l : lanes - 1);
      const double x = u->near[kind->slot_own[own]].x[k];
      b.x[k][l] = x;
      const double around = k < u->config.dimensions ? b.reach : 0;
      b.lower[k] = fmin(b.lower[k], x - around);
      b.upper[k] = fmax(b.upper[k], x + around);
    }
  }
  return b;
}

static bw_status room_for(bw_ulph *u, size_t used, size_t more)
{
  if (used + more <= u->list_room) return BW_OK;
  const size_t room = 2 * (used + more) + 4096;
  int32_t *larger = NULL;
  BW_TRY(BW_ALLOCATE(&larger, room));
  if (used > 0) memcpy(larger, u->list, used * sizeof *larger);
  bw_release(&u->list);
  u->list = larger;
  u->list_room = room;
  return BW_OK;
}

/* Is a place within reach of any lane? */
static bool reached(const ball *b, const double x[3])
{
  const vec dx = b->x[0] - x[0], dy = b->x[1] - x[1], dz = b->x[2] - x[2];
  const vec_bits inside = dx * dx + dy * dy + dz * dz < b->reach * b->reach;
  int64_t any = 0;
  for (int l = 0; l < BW_ULPH_LANES; l++)
    any |= inside[l];
  return any != 0;
}

/* Slots of a kind that a cluster reaches are added to the list, in the order of slots. */
static bw_status collect(bw_ulph *u, const bw_ulph__kind *kind, const ball *b, size_t *used)
{
  const double edge = u->R + u->skin;
  uint64_t from[3], to[3];
  for (int k = 0; k < 3; k++) {
    from[k] = half_cell(b->lower[k], edge) >> 1;
    to[k] = half_cell(b->upper[k], edge) >> 1;
  }
  for (uint64_t z = from[2]; z <= to[2]; z++)
    for (uint64_t y = from[1]; y <= to[1]; y++) {
      /* Cells that follow each other in x have keys that do. */
      const uint64_t row = (z << BITS | y) << BITS;
      const size_t begin = first_with(kind, (row | from[0]) << 3);
      const size_t end = first_with(kind, ((row | to[0]) + 1) << 3);
      BW_TRY(room_for(u, *used, end - begin));
      for (size_t s = begin; s < end; s++)
        if (reached(b, u->near[kind->base + s].x)) u->list[(*used)++] = (int32_t)(kind->base + s);
    }
  return BW_OK;
}

/* Clusters of own particles of a kind, with fluid, walls and faces around them. */
static bw_status clusters(bw_ulph *u, const bw_ulph__kind *kind, bw_ulph__clusters *to,
                          size_t *used)
{
  to->n = (kind->own + BW_ULPH_LANES - 1) / BW_ULPH_LANES;
  bw_release(&to->of);
  BW_TRY(BW_ALLOCATE(&to->of, to->n));
  for (size_t c = 0; c < to->n; c++) {
    bw_ulph__cluster *q = to->of + c;
    q->first = c * BW_ULPH_LANES;
    q->lanes = kind->own - q->first < BW_ULPH_LANES ? (int)(kind->own - q->first) : BW_ULPH_LANES;
    const ball b = ball_of(u, kind, q->first, q->lanes);
    q->begin = *used;
    BW_TRY(collect(u, &u->fluid, &b, used));
    q->walls = *used;
    /* A wall without fluid in reach shows nothing. */
    const bool shows = kind == &u->fluid || q->walls > q->begin;
    if (shows) BW_TRY(collect(u, &u->wall, &b, used));
    q->faces = *used;
    if (shows) BW_TRY(collect(u, &u->face, &b, used));
    q->end = *used;
  }
  return BW_OK;
}

bw_status bw_ulph__lists(bw_ulph *u)
{
  size_t used = 0;
  BW_TRY(clusters(u, &u->fluid, &u->clusters, &used));
  BW_TRY(clusters(u, &u->wall, &u->shading, &used));
  return clusters(u, &u->face, &u->facing, &used);
}

static void place_slots(bw_ulph *u, bw_ulph__kind *kind)
{
  for (size_t i = 0; i < kind->own; i++) {
    const bw_ulph__particle *p = u->own + kind->first + i;
    bw_ulph__near *n = u->near + kind->slot_own[i];
    bw_ulph__where(u, p, n->x);
    /* The whole volume, for those who ask where a body ends; of a face half a particle. */
    n->V = (p->wall == u->n_walls ? 0.5 : 1) * p->m / u->config.rho0;
  }
  bw_ulph__send(kind, sizeof *u->near, u->near);
}

/* From the places `at`, and the walls at the time time_built, alone. */
bw_status bw_ulph__rebuild(bw_ulph *u)
{
  BW_TRY(bw_ulph__migrate(u));
  BW_TRY(bw_ulph__slots(u));
  place_slots(u, &u->fluid);
  place_slots(u, &u->wall);
  place_slots(u, &u->face);
  BW_TRY(bw_comm_agree(u->comm, bw_ulph__lists(u)));
  bw_ulph__turn_faces(u);
  u->listed = true;
  u->rebuilds++;
  return BW_OK;
}

void bw_ulph__release_lists(bw_ulph *u)
{
  bw_ulph__kind *kinds[] = {&u->fluid, &u->wall, &u->face};
  for (int k = 0; k < 3; k++) {
    bw_particles_copies_destroy(&kinds[k]->copies);
    bw_release(&kinds[k]->slot_own);
    bw_release(&kinds[k]->slot_copy);
    bw_release(&kinds[k]->key);
  }
  bw_release(&u->near);
  bw_release(&u->far);
  bw_release(&u->between);
  bw_release(&u->shade);
  bw_release(&u->front);
  bw_release(&u->clusters.of);
  bw_release(&u->shading.of);
  bw_release(&u->facing.of);
  bw_release(&u->list);
  u->list_room = 0;
}
