/* The motion of a body goes to one of the same sites and of other levels.
 *
 * Every cell has a home: the rank that gave its site to create. A particle's id tells it, as ids
 * are rows of the ranks' lists joined. Riders go home, where a cell's particles are made of those
 * it had, and from there to whoever owns the new ones. */
#include "bw_exchange.h"
#include "bw_memory.h"
#include "bw_pd_levels.h"
#include "pd_law.h"

#include <math.h>
#include <string.h>

/* The particles of the cells that this rank gave, by id. */
typedef struct {
  int64_t *first;            /* (ranks + 1) id of each rank's first particle */
  int64_t n;                 /* of this rank */
  bw_pd_levels_rider *rider; /* (n) */
  uint8_t *bits;             /* (n, bytes) broken bonds, one bit per direction */
  double *field;             /* (n, fields) saved fields of the law */
} home;

/* What moving needs to know. */
typedef struct {
  const bw_comm *comm;
  const bw_pd_sites *given;
  int dimension;
  size_t bytes;  /* of a row of bits */
  size_t fields; /* of the law that are saved */
} journey;

static void release_home(home *h)
{
  bw_release(&h->first);
  bw_release(&h->rider);
  bw_release(&h->bits);
  bw_release(&h->field);
}

static int level_at(const bw_pd_map *map, const bw_pd_sites *given, int64_t q)
{
  return map->level[bw_pd_levels_cell(map, given->site + 3 * q)];
}

/* Who has which ids, and room for this rank's own. Collective. */
static bw_status make_home(const journey *j, const bw_pd_map *map, home *h)
{
  const int ranks = bw_comm_size(j->comm);
  void *all = NULL;
  size_t total = 0;
  for (int64_t q = 0; q < j->given->n; q++)
    h->n += (int64_t)1 << (j->dimension * level_at(map, j->given, q));
  BW_TRY(bw_comm_allgather(j->comm, sizeof h->n, &h->n, &total, &all));
  bw_status st = BW_ALLOCATE(&h->first, (size_t)ranks + 1);
  for (int r = 0; r < ranks && st == BW_OK; r++)
    h->first[r + 1] = h->first[r] + ((const int64_t *)all)[r];
  bw_release(&all);
  BW_THEN(st, BW_ALLOCATE(&h->rider, (size_t)h->n));
  BW_THEN(st, BW_ALLOCATE(&h->bits, (size_t)h->n * j->bytes));
  BW_THEN(st, BW_ALLOCATE(&h->field, (size_t)h->n * j->fields));
  return bw_comm_agree(j->comm, st);
}

static int rank_of(const journey *j, const home *h, int64_t id)
{
  int low = 0, high = bw_comm_size(j->comm);
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (h->first[middle] <= id)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* A plan from own particles to the homes of their cells. Collective. */
static bw_status plan_home(const journey *j, const bw_pd_body *pd, const home *h,
                           bw_exchange **plan)
{
  int *to = NULL;
  bw_status st = bw_comm_agree(j->comm, BW_ALLOCATE(&to, pd->n));
  for (size_t i = 0; i < pd->n && st == BW_OK; i++)
    to[i] = rank_of(j, h, pd->points.id[i]);
  if (st == BW_OK) st = bw_exchange_create(j->comm, pd->n, to, plan);
  bw_release(&to);
  return st;
}

/* The bonds of an own particle that hold, of one lane of its block: xi, and the difference of a
 * vector of storage. Returns how many. */
static size_t neighbours(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                         bw_real *const f[3], double weight[], double xi[], double df[])
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  const int32_t h = block->first + lane;
  size_t n = 0;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    if (!(slot->mask >> lane & 1)) continue;
    for (int k = 0; k < 3; k++) {
      xi[3 * n + (size_t)k] = level->stencil.xi[3 * slot->direction + k];
      df[3 * n + (size_t)k] = (double)f[k][slot->base + lane] - (double)f[k][h];
    }
    /* By volume, as the parts of a cell count together as it would, and mostly the nearest: over
     * all of a horizon the gradients of short waves come out too small. */
    weight[n++] = pd->level[level->stencil.other[slot->direction]].dv / level->dv /
                  pow(level->stencil.r0[slot->direction] / level->ds, 4);
  }
  return n;
}

/* Riders of the own particles, with gradients where their cell is refined. Copies are current. */
static bw_status fill_riders(const bw_pd_body *pd, const bw_pd_map *old, const bw_pd_map *now,
                             bw_pd_levels_rider rider[])
{
  const size_t most = (size_t)pd->directions;
  double *weight = NULL, *xi = NULL, *df = NULL;
  bw_status st = BW_ALLOCATE(&weight, most);
  BW_THEN(st, BW_ALLOCATE(&xi, 3 * most));
  BW_THEN(st, BW_ALLOCATE(&df, 3 * most));
  for (size_t b = 0; b < pd->bonds.n_block && st == BW_OK; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(block, lane);
      const size_t cell = bw_pd_levels_cell_of(pd, old, i);
      bw_pd_levels_rider *r = &rider[i];
      *r = (bw_pd_levels_rider){.kind = pd->points.kind[i]};
      for (int k = 0; k < 3; k++) {
        r->f[0][k] = (double)pd->u[k][pd->points.place[i]];
        r->f[1][k] = (double)pd->v[k][i];
        r->f[2][k] = (double)pd->load.f[k][i];
      }
      if (now->level[cell] <= old->level[cell]) continue;
      size_t n = neighbours(pd, block, lane, pd->u, weight, xi, df);
      bw_pd_levels_gradient(pd->dimension, n, weight, xi, df, r->G[0]);
      n = neighbours(pd, block, lane, pd->vs, weight, xi, df);
      bw_pd_levels_gradient(pd->dimension, n, weight, xi, df, r->G[1]);
    }
  }
  bw_release(&weight);
  bw_release(&xi);
  bw_release(&df);
  return st;
}

/* Broken bonds (n, bytes), by direction, as slots differ with the number of ranks. */
static void fill_bits(const bw_pd_body *pd, size_t bytes, uint8_t bits[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++) {
      const bw_pd_slot *slot = &pd->bonds.slot[q];
      const unsigned broken = slot->family & ~(unsigned)slot->mask;
      for (int lane = 0; broken != 0 && lane < BW_PD_LANES; lane++)
        if (broken >> lane & 1)
          bits[(size_t)bw_pd_body_owner(&pd->bonds.block[b], lane) * bytes +
               (size_t)slot->direction / 8] |= (uint8_t)(1u << slot->direction % 8);
    }
}

/* Saved fields of the own particles (n, fields), out of the body or into it. */
static void copy_fields(bw_pd_body *pd, bool in, double rows[])
{
  size_t width = 0, column = 0;
  for (int q = 0; q < pd->fields.n; q++)
    width += pd->fields.row[q].saved;
  for (int q = 0; q < pd->fields.n; q++) {
    bw_real *value = pd->fields.row[q].value;
    if (!pd->fields.row[q].saved) continue;
    for (size_t i = 0; i < pd->n; i++) {
      double *at = &rows[width * i + column];
      if (in)
        value[pd->points.place[i]] = (bw_real)*at;
      else
        *at = (double)value[pd->points.place[i]];
    }
    column++;
  }
}

/* A row on its way home: where it belongs there, and what it is. */
typedef struct {
  int64_t id;
  bw_pd_levels_rider rider;
} passenger;

/* What arrived to its place by id. */
static void settle(const journey *j, home *h, size_t n, const passenger row[], const uint8_t bits[],
                   const double field[])
{
  const int64_t first = h->first[bw_comm_rank(j->comm)];
  for (size_t q = 0; q < n; q++) {
    const size_t at = (size_t)(row[q].id - first);
    h->rider[at] = row[q].rider;
    memcpy(h->bits + at * j->bytes, bits + q * j->bytes, j->bytes);
    memcpy(h->field + at * j->fields, field + q * j->fields, j->fields * sizeof *field);
  }
}

/* Everybody home. Collective. */
static bw_status go_home(const journey *j, bw_pd_body *pd, const bw_pd_map *old,
                         const bw_pd_map *now, home *h)
{
  bw_exchange *plan = NULL;
  bw_pd_levels_rider *rider = NULL;
  passenger *out = NULL, *in = NULL;
  uint8_t *bits = NULL, *bits_in = NULL;
  double *field = NULL, *field_in = NULL;
  BW_TRY(plan_home(j, pd, h, &plan));
  const size_t arrive = bw_exchange_received(plan);
  bw_status st = BW_ALLOCATE(&rider, pd->n);
  BW_THEN(st, BW_ALLOCATE(&out, pd->n));
  BW_THEN(st, BW_ALLOCATE(&bits, pd->n * j->bytes));
  BW_THEN(st, BW_ALLOCATE(&in, arrive));
  BW_THEN(st, BW_ALLOCATE(&bits_in, arrive * j->bytes));
  BW_THEN(st, BW_ALLOCATE(&field, pd->n * j->fields));
  BW_THEN(st, BW_ALLOCATE(&field_in, arrive * j->fields));
  BW_THEN(st, fill_riders(pd, old, now, rider));
  st = bw_comm_agree(j->comm, st);
  if (st == BW_OK) {
    fill_bits(pd, j->bytes, bits);
    for (size_t i = 0; i < pd->n; i++)
      out[i] = (passenger){.id = pd->points.id[i], .rider = rider[i]};
    bw_exchange_forward(plan, sizeof *out, out, in);
    bw_exchange_forward(plan, j->bytes, bits, bits_in);
    copy_fields(pd, false, field);
    if (j->fields > 0) bw_exchange_forward(plan, j->fields * sizeof *field, field, field_in);
    settle(j, h, arrive, in, bits_in, field_in);
  }
  bw_exchange_destroy(&plan);
  void *all[] = {&rider, &out, &in, &bits, &bits_in, &field, &field_in};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  return st;
}

/* Cell by cell, in the order of their ids. Bonds of a cell that was made anew are whole: nothing
 * has broken where cells are split or joined. */
static void recast(const journey *j, const bw_pd_body *pd, const bw_pd_map *old,
                   const bw_pd_map *now, const home *before, home *after)
{
  const bw_pd_body_config *c = &pd->config;
  size_t a = 0, b = 0;
  for (int64_t q = 0; q < j->given->n; q++) {
    const int from = level_at(old, j->given, q), to = level_at(now, j->given, q);
    const size_t had = (size_t)1 << (j->dimension * from), has = (size_t)1 << (j->dimension * to);
    bw_pd_levels_recast(j->dimension, c->ds, c->axes, from, to, before->rider + a,
                        after->rider + b);
    if (from == to) {
      memcpy(after->bits + b * j->bytes, before->bits + a * j->bytes, had * j->bytes);
      memcpy(after->field + b * j->fields, before->field + a * j->fields,
             had * j->fields * sizeof *after->field);
    }
    a += had;
    b += has;
  }
}

/* Bonds that were broken are so again. */
static void cut(bw_pd_body *pd, size_t bytes, const uint8_t bits[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    bw_pd_block *block = &pd->bonds.block[b];
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      bw_pd_slot *slot = &pd->bonds.slot[q];
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        if (!(slot->mask >> lane & 1)) continue;
        const uint8_t *row = bits + (size_t)bw_pd_body_owner(block, lane) * bytes;
        if (!(row[slot->direction / 8] >> slot->direction % 8 & 1)) continue;
        slot->mask = (uint8_t)(slot->mask & ~(1u << lane));
        block->broken = true;
      }
    }
  }
}

static void put_riders(bw_pd_body *pd, const bw_pd_levels_rider rider[])
{
  for (size_t i = 0; i < pd->n; i++) {
    for (int k = 0; k < 3; k++) {
      pd->u[k][pd->points.place[i]] = (bw_real)rider[i].f[0][k];
      pd->v[k][i] = (bw_real)rider[i].f[1][k];
      pd->load.f[k][i] = (bw_real)rider[i].f[2][k];
    }
    pd->points.kind[i] = rider[i].kind;
  }
}

/* From home to the new owners, who ask by id. Collective. */
static bw_status go_out(const journey *j, const home *h, bw_pd_body *pd)
{
  bw_exchange *plan = NULL;
  bw_pd_levels_rider *rider = NULL, *reply = NULL;
  int64_t *asked = NULL;
  uint8_t *bits = NULL, *bits_out = NULL;
  double *field = NULL, *field_out = NULL;
  BW_TRY(plan_home(j, pd, h, &plan));
  const size_t ask = bw_exchange_received(plan);
  bw_status st = BW_ALLOCATE(&rider, pd->n);
  BW_THEN(st, BW_ALLOCATE(&bits, pd->n * j->bytes));
  BW_THEN(st, BW_ALLOCATE(&asked, ask));
  BW_THEN(st, BW_ALLOCATE(&reply, ask));
  BW_THEN(st, BW_ALLOCATE(&bits_out, ask * j->bytes));
  BW_THEN(st, BW_ALLOCATE(&field, pd->n * j->fields));
  BW_THEN(st, BW_ALLOCATE(&field_out, ask * j->fields));
  st = bw_comm_agree(j->comm, st);
  if (st == BW_OK) {
    bw_exchange_forward(plan, sizeof *asked, pd->points.id, asked);
    for (size_t q = 0; q < ask; q++) {
      const size_t at = (size_t)(asked[q] - h->first[bw_comm_rank(j->comm)]);
      reply[q] = h->rider[at];
      memcpy(bits_out + q * j->bytes, h->bits + at * j->bytes, j->bytes);
      memcpy(field_out + q * j->fields, h->field + at * j->fields, j->fields * sizeof *field);
    }
    bw_exchange_backward(plan, sizeof *reply, reply, rider);
    bw_exchange_backward(plan, j->bytes, bits_out, bits);
    if (j->fields > 0) bw_exchange_backward(plan, j->fields * sizeof *field, field_out, field);
    put_riders(pd, rider);
    copy_fields(pd, true, field);
    cut(pd, j->bytes, bits);
  }
  bw_exchange_destroy(&plan);
  void *all[] = {&rider, &reply, &asked, &bits, &bits_out, &field, &field_out};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  return st;
}

bw_status bw_pd_levels_move(bw_pd_body *from, const bw_pd_map *old, const bw_pd_sites *given,
                            const bw_pd_map *now, bw_pd_body *to)
{
  journey j = {.comm = from->comm,
               .given = given,
               .dimension = from->dimension,
               .bytes = ((size_t)from->directions + 7) / 8};
  for (int q = 0; q < from->fields.n; q++)
    j.fields += from->fields.row[q].saved;
  home before = {0}, after = {0};
  /* Gradients read the neighbours' velocities, too. */
  bw_pd_body_refresh(from, true);
  bw_status st = make_home(&j, old, &before);
  if (st == BW_OK) st = make_home(&j, now, &after);
  if (st == BW_OK) st = go_home(&j, from, old, now, &before);
  if (st == BW_OK) {
    recast(&j, from, old, now, &before, &after);
    st = go_out(&j, &after, to);
  }
  /* Who is held moves on as it did. */
  if (st == BW_OK) bw_pd_body_adopt_prescribed(to);
  release_home(&before);
  release_home(&after);
  return st;
}
