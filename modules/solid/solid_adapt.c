/* When cells are refined, and when they may be coarser again.
 *
 * A cell is hot where a bond is beyond `at` of its limit, and scarred where one has broken. Around
 * hot cells `buffer` horizons have to be as fine as can be, around scars one: then nothing can
 * break above the finest level before the next look (solid_levels.c tells when). What is made fine
 * reaches `ahead` horizons farther, so that a crack does not ask for it at every look. A fine cell
 * that is not needed stays for some looks, and longer if it alone would be worth no new body. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

enum { LOOKS = 4 };              /* that a fine cell stays when it is not needed */
static const double WORTH = 0.1; /* part of the particles that coarsening alone has to save */

/* What a look finds, by cell. */
typedef struct {
  uint8_t *scan; /* bits */
  uint8_t *need; /* has to be fine now */
  uint8_t *want; /* would be fine in a new body */
  bw_pd_map now; /* that body's levels */
} look;

static int cells_of(const bw_solid *s, double horizons)
{
  return (int)ceil(horizons * s->body->config.horizon_ratio);
}

static bw_status room(const bw_solid *s, look *l)
{
  const size_t cells = bw_pd_levels_cells(&s->levels->map);
  l->now = s->levels->map;
  l->now.level = NULL;
  BW_TRY(BW_ALLOCATE(&l->scan, cells));
  BW_TRY(BW_ALLOCATE(&l->need, cells));
  BW_TRY(BW_ALLOCATE(&l->want, cells));
  return BW_ALLOCATE(&l->now.level, cells);
}

/* need, ages, want. Local: all ranks know the scan. */
static bw_status judge(bw_solid *s, look *l)
{
  const bw_solid_refine *r = &s->config.finer.refine;
  bw_solid__levels *levels = s->levels;
  const size_t cells = bw_pd_levels_cells(&l->now);
  const int scar = cells_of(s, 1), buffer = cells_of(s, r->buffer);
  BW_TRY(bw_solid__levels_around(s, l->scan, BW_PD_LEVELS_HOT, buffer, l->need));
  BW_TRY(bw_solid__levels_around(s, l->scan, BW_SOLID__SCAR, scar, l->need));
  memcpy(l->want, l->need, cells);
  BW_TRY(bw_solid__levels_around(s, l->scan, BW_PD_LEVELS_HOT, buffer + cells_of(s, r->ahead),
                                 l->want));
  for (size_t q = 0; q < cells; q++) {
    const bool fine = levels->map.level[q] == levels->map.finest;
    const bool busy = l->need[q] || (l->scan[q] & BW_PD_LEVELS_WARM) != 0;
    levels->age[q] = busy || !fine ? 0 : levels->age[q] < 255 ? levels->age[q] + 1 : 255;
    if (fine && levels->age[q] < LOOKS) l->want[q] = 1;
  }
  return BW_OK;
}

/* Particles of the occupied cells of a map. */
static double particles(const bw_solid *s, const look *l, const bw_pd_map *map)
{
  double n = 0;
  for (size_t q = 0; q < bw_pd_levels_cells(map); q++)
    if (l->scan[q] & BW_SOLID__OCCUPIED) n += ldexp(1, s->body->dimension * map->level[q]);
  return n;
}

/* The levels of a new body, and whether there has to be one. Local. */
static bw_status decide(const bw_solid *s, look *l, bool *change)
{
  const bw_solid__levels *levels = s->levels;
  const size_t cells = bw_pd_levels_cells(&l->now);
  bool lacking = false;
  for (size_t q = 0; q < cells; q++) {
    lacking = lacking || (l->need[q] && (l->scan[q] & BW_SOLID__OCCUPIED) &&
                          levels->map.level[q] < levels->map.finest);
    l->now.level[q] = l->want[q] ? (uint8_t)l->now.finest : levels->least[q];
  }
  BW_TRY(bw_pd_levels_balance(&s->body->config, &l->now));
  const double had = particles(s, l, &levels->map), has = particles(s, l, &l->now);
  *change = lacking || has < (1 - WORTH) * had;
  return BW_OK;
}

bw_status bw_solid_adapt(bw_solid *s, bool *changed)
{
  look l = {0};
  bool change = false;
  *changed = false;
  if (s->levels == NULL || (s->levels->dt > 0 && !bw_solid__levels_due(s))) return BW_OK;
  if (!s->body->current) BW_TRY(bw_solid_evaluate(s));
  bw_status st = bw_comm_agree(s->body->comm, room(s, &l));
  if (st == BW_OK) st = bw_solid__levels_scan(s, l.scan);
  BW_THEN(st, judge(s, &l));
  BW_THEN(st, decide(s, &l, &change));
  st = bw_comm_agree(s->body->comm, st);
  if (st == BW_OK && change) st = bw_solid__remap(s, &l.now);
  if (st == BW_OK) {
    s->levels->since = 0;
    *changed = change;
  }
  void *all[] = {&l.scan, &l.need, &l.want, &l.now.level};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  return st;
}
