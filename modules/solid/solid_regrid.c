/* A solid gets a body of other levels: the motion goes over, the change of energy is booked. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

/* What counts on from one body to the next. */
static void hand_over(const bw_pd_body *from, bw_pd_body *to)
{
  to->breakage = from->breakage;
  bw_pd_body_set_damping(to, from->damping.pair, from->damping.mean, from->damping.absolute);
  to->bonds.released = from->bonds.released;
  to->bonds.events = from->bonds.events + 1;
  to->revision = from->revision;
}

/* What of a new body's law follows from the old one. Collective. */
static bw_status settle(const bw_solid *s, const bw_pd_map *now)
{
  const bw_pd_body *pd = s->body;
  bool *fresh = NULL;
  BW_TRY(bw_comm_agree(pd->comm, BW_ALLOCATE(&fresh, pd->n)));
  for (size_t i = 0; i < pd->n; i++) {
    const size_t cell = bw_pd_levels_cell_of(pd, now, i);
    fresh[i] = now->level[cell] != s->levels->map.level[cell];
  }
  const bw_status st = bw_pd_body_settle(s->body, fresh);
  bw_release(&fresh);
  return st;
}

/* The old body's arrays go, those of the new one come, with its cuts and its motion. */
static bw_status dress(bw_solid *s, bw_pd_body *old, const bw_pd_map *now)
{
  bw_solid__release_own_arrays(s);
  s->book.precracked = 0;
  BW_TRY(bw_comm_agree(old->comm, bw_solid__own_arrays(s)));
  /* Nothing has moved in it yet, so that a pre-crack's bonds hold nothing that would be booked. */
  BW_TRY(bw_solid__cut_again(s));
  hand_over(old, s->body);
  BW_TRY(bw_pd_levels_move(old, &s->levels->map, &s->levels->given, now, s->body));
  BW_TRY(settle(s, now));
  bw_solid__renew_kinds(s);
  bw_pd_body_touch(s->body);
  s->restored = false;
  s->loaded = s->contact != NULL || bw_pd_body_damped(s->body);
  return bw_solid_set_drag(s, 0, NULL, NULL, NULL);
}

bw_status bw_solid__remap(bw_solid *s, bw_pd_map *now)
{
  bw_solid__levels *l = s->levels;
  bw_pd_body *old = s->body, *body = NULL;
  if (!old->current) BW_TRY(bw_solid_evaluate(s));
  const double before = bw_solid_held(s);
  BW_TRY(bw_solid__body(s, old->comm, &l->given, now, &body));
  s->body = body;
  const bw_status st = dress(s, old, now);
  bw_pd_body_destroy(&old);
  BW_TRY(st);
  memcpy(l->map.level, now->level, bw_pd_levels_cells(now));
  l->changes++;
  BW_TRY(bw_solid_evaluate(s));
  /* Sums of all ranks, booked by one. */
  const double taken = before - bw_solid_held(s);
  if (bw_comm_rank(body->comm) == 0) s->book.regrid += taken;
  return BW_OK;
}

/* The levels of boxes, of the solid's own ones, and around what has broken. */
static bw_status levels_of(const bw_solid *s, int n, const bw_pd_box box[], const uint8_t scan[],
                           bw_pd_map *now)
{
  const bw_pd_body_config *c = &s->body->config;
  const size_t cells = bw_pd_levels_cells(now);
  uint8_t *scarred = NULL;
  memcpy(now->level, s->levels->least, cells);
  for (int b = 0; b < n; b++)
    bw_pd_levels_fill(c, &box[b], now);
  BW_TRY(BW_ALLOCATE(&scarred, cells));
  const bw_status st =
      bw_solid__levels_around(s, scan, BW_SOLID__SCAR, (int)ceil(c->horizon_ratio), scarred);
  for (size_t q = 0; q < cells && st == BW_OK; q++)
    if (scarred[q]) now->level[q] = (uint8_t)now->finest;
  bw_release(&scarred);
  BW_TRY(st);
  return bw_pd_levels_balance(c, now);
}

static bw_status check_boxes(const bw_solid *s, int n, const bw_pd_box box[])
{
  BW_REQUIRE(s->levels != NULL, BW_EINPUT,
             "solid_regrid: the levels of this solid stay as they are; create it with "
             "finer.refine.level");
  for (int b = 0; b < n; b++) {
    BW_REQUIRE(box[b].level >= 1 && box[b].level <= s->levels->map.finest, BW_EINPUT,
               "solid_regrid: level %d of box %d must be from 1 to %d", box[b].level, b,
               s->levels->map.finest);
    for (int k = 0; k < s->body->dimension; k++)
      BW_REQUIRE(box[b].lower[k] < box[b].upper[k], BW_EINPUT,
                 "solid_regrid: box %d reaches from %g to %g in direction %d: lower must be less "
                 "than upper",
                 b, box[b].lower[k], box[b].upper[k], k);
  }
  return BW_OK;
}

bw_status bw_solid_regrid(bw_solid *s, int n, const bw_pd_box box[])
{
  BW_TRY(check_boxes(s, n, box));
  bw_pd_map now = s->levels->map;
  const size_t cells = bw_pd_levels_cells(&now);
  uint8_t *scan = NULL;
  now.level = NULL;
  if (!s->body->current) BW_TRY(bw_solid_evaluate(s));
  bw_status st = BW_ALLOCATE(&now.level, cells);
  BW_THEN(st, BW_ALLOCATE(&scan, cells));
  st = bw_comm_agree(s->body->comm, st);
  if (st == BW_OK) st = bw_solid__levels_scan(s, scan);
  if (st == BW_OK) st = bw_comm_agree(s->body->comm, levels_of(s, n, box, scan, &now));
  if (st == BW_OK && memcmp(now.level, s->levels->map.level, cells) != 0)
    st = bw_solid__remap(s, &now);
  bw_release(&scan);
  bw_pd_levels_map_release(&now);
  return st;
}

/* Behind the state's numbers: level and age of each cell. */
enum { NUMBERS = 4, AGES = 16 };

size_t bw_solid_levels_numbers(const bw_solid *s)
{
  return s->levels == NULL ? 0 : NUMBERS + bw_pd_levels_cells(&s->levels->map);
}

void bw_solid_get_levels(const bw_solid *s, double state[])
{
  const bw_solid__levels *l = s->levels;
  if (l == NULL) return;
  state[0] = l->since;
  state[1] = l->dt;
  state[2] = s->book.regrid;
  state[3] = (double)l->changes;
  /* Booked by one rank. */
  bw_comm_broadcast(s->body->comm, sizeof state[2], &state[2]);
  for (size_t q = 0; q < bw_pd_levels_cells(&l->map); q++)
    state[NUMBERS + q] = l->map.level[q] + AGES * l->age[q];
}

bw_status bw_solid_set_levels(bw_solid *s, const double state[])
{
  bw_solid__levels *l = s->levels;
  if (l == NULL) return BW_OK;
  const size_t cells = bw_pd_levels_cells(&l->map);
  bw_pd_map now = l->map;
  now.level = NULL;
  bw_status st = bw_comm_agree(s->body->comm, BW_ALLOCATE(&now.level, cells));
  for (size_t q = 0; q < cells && st == BW_OK; q++) {
    const double x = state[NUMBERS + q];
    if (!(x >= 0 && x < 256 * AGES && fmod(x, AGES) <= now.finest && x == floor(x)))
      st = BW_FAIL(BW_EINPUT, "solid: cell %zu of stored levels is %g; the finest level is %d", q,
                   x, now.finest);
    else
      now.level[q] = (uint8_t)fmod(x, AGES);
  }
  if (st == BW_OK && memcmp(now.level, l->map.level, cells) != 0) st = bw_solid__remap(s, &now);
  bw_pd_levels_map_release(&now);
  BW_TRY(st);
  l->since = state[0];
  l->dt = state[1];
  l->changes = (int64_t)state[3];
  s->book.regrid = bw_comm_rank(s->body->comm) == 0 ? state[2] : 0;
  for (size_t q = 0; q < cells; q++)
    l->age[q] = (uint8_t)(state[NUMBERS + q] / AGES);
  return BW_OK;
}
