/* Lists of neighbours: cells, clusters of own particles, who is within reach of a cluster. */
#include "bw_memory.h"
#include "ulph_internal.h"

/* Cells are told apart this far either way of the origin. A key has 16 bits per direction, x the
 * lowest, and behind them the layer of walls and the place within the cell, on a curve of Hilbert
 * through its 8^d parts that begins where the last cell of the row ended: particles that follow
 * each other are near each other. */
enum { FARTHEST = 1 << 15, BITS = 16, LEVELS = 3, CURVE = 3 * LEVELS, WITHIN = CURVE + 2 };

/* Parts of cells from the outermost one. */
static uint32_t part_of_cell(double x, double edge)
{
  const double parts = 1 << LEVELS;
  return (uint32_t)fmax(0, fmin(2 * parts * FARTHEST - 1, floor(parts * (x / edge + FARTHEST))));
}

static uint64_t cell_of(double x, double edge)
{
  return part_of_cell(x, edge) >> LEVELS;
}

/* Place of a part on the curve, from (0, 0, 0) to the last in x (Skilling, AIP Conf. Proc. 707
 * (2004) 381: bits of the directions exchanged and turned, level by level, then Gray's code). */
static uint64_t along_curve(int d, const uint32_t part[3])
{
  uint32_t X[3] = {part[0], part[1], part[2]}, t = 0;
  uint64_t place = 0;
  for (uint32_t q = 1 << (LEVELS - 1); q > 1; q >>= 1)
    for (int i = 0; i < d; i++)
      if ((X[i] & q) != 0) {
        X[0] ^= q - 1;
      } else {
        t = (X[0] ^ X[i]) & (q - 1);
        X[0] ^= t, X[i] ^= t;
      }
  for (int i = 1; i < d; i++)
    X[i] ^= X[i - 1];
  t = 0;
  for (uint32_t q = 1 << (LEVELS - 1); q > 1; q >>= 1)
    if ((X[d - 1] & q) != 0) t ^= q - 1;
  for (int level = LEVELS - 1; level >= 0; level--)
    for (int i = 0; i < d; i++)
      place = place << 1 | ((X[i] ^ t) >> level & 1);
  return place;
}

uint64_t bw_ulph__key(const bw_ulph *u, const bw_ulph__particle *p)
{
  uint64_t key = 0;
  uint32_t part[3] = {0};
  double x[3];
  bw_ulph__where(u, p, x);
  for (int k = 2; k >= 0; k--) {
    const uint32_t all = part_of_cell(x[k], u->R + u->skin);
    key = key << BITS | all >> LEVELS;
    part[k] = all & ((1 << LEVELS) - 1);
  }
  const bool layered = p->wall >= 0 && p->wall < u->n_walls;
  const uint64_t layer = layered ? (uint64_t)fmin(3, floor(p->depth / u->config.dx)) : 0;
  return key << WITHIN | layer << CURVE | along_curve(u->config.dimensions, part);
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
  if (used > 0) memcpy(larger, u->wide, used * sizeof *larger);
  bw_release(&u->wide);
  u->wide = larger;
  u->list_room = room;
  return BW_OK;
}

/* Is a place within reach of any lane? */
static bool reached(const ball *b, const double x[3])
{
  const vec dx = x[0] - b->x[0], dy = x[1] - b->x[1], dz = x[2] - b->x[2];
  return vec_any(dx * dx + dy * dy + dz * dz < b->reach * b->reach);
}

/* Slots of a kind that a cluster reaches are added to the wide list, in the order of slots. */
static bw_status collect(bw_ulph *u, const bw_ulph__kind *kind, const ball *b, size_t *used)
{
  const double edge = u->R + u->skin;
  uint64_t from[3], to[3];
  for (int k = 0; k < 3; k++) {
    from[k] = cell_of(b->lower[k], edge);
    to[k] = cell_of(b->upper[k], edge);
  }
  for (uint64_t z = from[2]; z <= to[2]; z++)
    for (uint64_t y = from[1]; y <= to[1]; y++) {
      /* Cells that follow each other in x have keys that do. */
      const uint64_t row = (z << BITS | y) << BITS;
      const size_t begin = first_with(kind, (row | from[0]) << WITHIN);
      const size_t end = first_with(kind, ((row | to[0]) + 1) << WITHIN);
      BW_TRY(room_for(u, *used, end - begin));
      for (size_t s = begin; s < end; s++)
        if (reached(b, u->near[kind->base + s].x)) u->wide[(*used)++] = (int32_t)(kind->base + s);
    }
  return BW_OK;
}

/* A box around the fluid, copies as well. */
typedef struct {
  double lower[3], upper[3];
} box;

static box fluid_box(const bw_ulph *u)
{
  box b;
  for (int k = 0; k < 3; k++)
    b.lower[k] = INFINITY, b.upper[k] = -INFINITY;
  for (size_t s = u->fluid.base; s < u->fluid.base + u->fluid.n; s++)
    for (int k = 0; k < 3; k++) {
      b.lower[k] = fmin(b.lower[k], u->near[s].x[k]);
      b.upper[k] = fmax(b.upper[k], u->near[s].x[k]);
    }
  return b;
}

static bool meets(const ball *a, const box *b)
{
  bool so = true;
  for (int k = 0; k < 3; k++)
    so = so && a->lower[k] <= b->upper[k] && a->upper[k] >= b->lower[k];
  return so;
}

/* Clusters of own particles of a kind, with fluid, walls and faces around them. */
static bw_status clusters(bw_ulph *u, const bw_ulph__kind *kind, bw_ulph__clusters *to,
                          size_t *used)
{
  const box fluid = fluid_box(u);
  to->n = (kind->own + BW_ULPH_LANES - 1) / BW_ULPH_LANES;
  bw_release(&to->of);
  BW_TRY(BW_ALLOCATE(&to->of, to->n));
  for (size_t c = 0; c < to->n; c++) {
    bw_ulph__cluster *q = to->of + c;
    q->first = c * BW_ULPH_LANES;
    q->lanes = kind->own - q->first < BW_ULPH_LANES ? (int)(kind->own - q->first) : BW_ULPH_LANES;
    const ball b = ball_of(u, kind, q->first, q->lanes);
    q->wide[0] = *used;
    if (meets(&b, &fluid)) BW_TRY(collect(u, &u->fluid, &b, used));
    q->wide[1] = *used;
    /* A wall without fluid in reach shows nothing. */
    const bool shows = kind == &u->fluid || q->wide[1] > q->wide[0];
    if (shows) BW_TRY(collect(u, &u->wall, &b, used));
    q->wide[2] = *used;
    if (shows) BW_TRY(collect(u, &u->face, &b, used));
    q->wide[3] = *used;
  }
  return BW_OK;
}

/* Room for all that may be near. */
static bw_status make_list(bw_ulph *u)
{
  if (u->near_room >= u->list_room) return BW_OK;
  u->near_room = u->list_room;
  bw_release(&u->list);
  return BW_ALLOCATE(&u->list, u->near_room);
}

bw_status bw_ulph__lists(bw_ulph *u)
{
  size_t used = 0;
  BW_TRY(clusters(u, &u->fluid, &u->clusters, &used));
  BW_TRY(clusters(u, &u->wall, &u->shading, &used));
  BW_TRY(clusters(u, &u->face, &u->facing, &used));
  return make_list(u);
}

/* ---- what is near now ---- */
/* The lanes of a cluster: where they are and, of walls, normals. */
typedef struct {
  vec x[3], normal[3];
  double reach2, behind;
} lanes;

static lanes lanes_of(const bw_ulph *u, const bw_ulph__kind *kind, const bw_ulph__cluster *c)
{
  const double reach = u->R + u->near_skin;
  lanes o = {.reach2 = reach * reach, .behind = -0.5 * u->config.dx - u->near_skin};
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    for (int k = 0; k < 3; k++) {
      o.x[k][l] = u->near[kind->slot_own[own]].x[k];
      o.normal[k][l] = u->own[kind->first + own].normal[k];
    }
  }
  return o;
}

/* Entries from..to of the wide list that are near a lane, and (`half`) not behind all of them. */
BW_ULPH_PIECE size_t keep(bw_ulph *u, const lanes *o, size_t from, size_t to, size_t used,
                          bool half)
{
  for (size_t e = from; e < to; e++) {
    const double *y = u->near[u->wide[e]].x;
    const vec dx = y[0] - o->x[0], dy = y[1] - o->x[1], dz = y[2] - o->x[2];
    vec_bits near = dx * dx + dy * dy + dz * dz < o->reach2;
    if (half) near &= dx * o->normal[0] + dy * o->normal[1] + dz * o->normal[2] > o->behind;
    u->list[used] = u->wide[e];
    used += vec_any(near);
  }
  return used;
}

/* Of walls only what is not behind them counts for each other (ulph_shade.c). */
static size_t keep_near(bw_ulph *u, const bw_ulph__kind *kind, bw_ulph__clusters *clusters,
                        size_t used)
{
  for (size_t c = 0; c < clusters->n; c++) {
    bw_ulph__cluster *q = clusters->of + c;
    q->begin = q->walls = q->faces = q->end = used;
    if (q->wide[0] == q->wide[3]) continue;
    const lanes o = lanes_of(u, kind, q);
    q->walls = keep(u, &o, q->wide[0], q->wide[1], used, false);
    const bool shows = kind == &u->fluid || q->walls > q->begin;
    q->faces = q->end = used = q->walls;
    if (!shows) continue;
    if (kind == &u->wall)
      q->faces = keep(u, &o, q->wide[1], q->wide[2], used, true);
    else
      q->faces = keep(u, &o, q->wide[1], q->wide[2], used, false);
    q->end = used = keep(u, &o, q->wide[2], q->wide[3], q->faces, false);
  }
  return used;
}

void bw_ulph__keep_near(bw_ulph *u)
{
  size_t used = keep_near(u, &u->fluid, &u->clusters, 0);
  used = keep_near(u, &u->wall, &u->shading, used);
  keep_near(u, &u->face, &u->facing, used);
  u->strayed = 0;
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
  bw_ulph__keep_near(u);
  bw_ulph__turn_faces(u);
  bw_ulph__dry(u);
  /* Particles may be elsewhere by now. */
  u->strayed = INFINITY;
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
  bw_release(&u->wide);
  bw_release(&u->list);
  u->list_room = u->near_room = 0;
}
