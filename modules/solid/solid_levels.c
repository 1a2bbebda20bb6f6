/* Levels that change: what a solid keeps of them, and what it sees in its cells. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

/* What the ranks gave to create, for bodies to come. */
static bw_status keep_sites(bw_solid__levels *l, const bw_pd_sites *given)
{
  const size_t n = (size_t)given->n;
  BW_TRY(BW_ALLOCATE(&l->site, 3 * n));
  memcpy(l->site, given->site, 3 * n * sizeof *l->site);
  if (given->kind != NULL) {
    BW_TRY(BW_ALLOCATE(&l->kind, n));
    memcpy(l->kind, given->kind, n);
  }
  if (given->group != NULL) {
    BW_TRY(BW_ALLOCATE(&l->group, n));
    memcpy(l->group, given->group, n);
  }
  l->given = (bw_pd_sites){.n = given->n, .site = l->site, .kind = l->kind, .group = l->group};
  return BW_OK;
}

/* What the map reads of a body's configuration. */
static bw_pd_body_config lattice_of(const bw_solid_config *c)
{
  bw_pd_body_config b = {.geometry = c->geometry, .ds = c->ds, .horizon_ratio = c->horizon_ratio};
  memcpy(b.origin, c->origin, sizeof b.origin);
  memcpy(b.axes, c->axes, sizeof b.axes);
  memcpy(b.period, c->period, sizeof b.period);
  return b;
}

static bw_status fill(bw_solid__levels *l, const bw_solid_config *c)
{
  const bw_pd_body_config lattice = lattice_of(c);
  const size_t cells = bw_pd_levels_cells(&l->map);
  BW_TRY(BW_ALLOCATE(&l->least, cells));
  BW_TRY(BW_ALLOCATE(&l->age, cells));
  for (int b = 0; b < c->finer.n; b++)
    bw_pd_levels_fill(&lattice, &c->finer.box[b], &l->map);
  BW_TRY(bw_pd_levels_balance(&lattice, &l->map));
  memcpy(l->least, l->map.level, cells);
  return BW_OK;
}

bw_status bw_solid__levels_create(bw_solid *s, const bw_comm *comm, const bw_pd_sites *given)
{
  const bw_pd_body_config lattice = lattice_of(&s->config);
  /* What a body would refuse has to be refused before its sites are read. */
  const bool sound = s->config.ds > 0 && isfinite(s->config.ds) && given->n >= 0 &&
                     (given->n == 0 || given->site != NULL);
  BW_TRY(bw_comm_agree(comm, sound ? BW_ALLOCATE(&s->levels, 1)
                                   : BW_FAIL(BW_EINPUT, "solid: ds = %g, %lld particles given",
                                             s->config.ds, (long long)given->n)));
  bw_solid__levels *l = s->levels;
  BW_TRY(bw_pd_levels_map_create(comm, &lattice, given, s->config.finer.refine.level, &l->map));
  bw_status st = keep_sites(l, given);
  BW_THEN(st, fill(l, &s->config));
  return bw_comm_agree(comm, st);
}

void bw_solid__levels_release(bw_solid *s)
{
  bw_solid__levels *l = s->levels;
  if (l == NULL) return;
  bw_pd_levels_map_release(&l->map);
  void *all[] = {&l->least, &l->age, &l->site, &l->kind, &l->group, &l->cut};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_release(&s->levels);
}

void bw_solid__levels_bound(bw_solid *s)
{
  bw_solid__levels *l = s->levels;
  const size_t cells = bw_pd_levels_cells(&l->map);
  int finest = 0;
  for (size_t q = 0; q < cells; q++)
    finest = l->map.level[q] > finest ? l->map.level[q] : finest;
  /* Frequencies of one shape of families go with 1/ds. */
  l->frequency2 = ldexp(s->body->frequency2, 2 * (l->map.finest - finest));
}

/* Speed of P waves in the fastest group [L/T]. */
static double speed_of(const bw_pd_body *pd)
{
  double most = 0;
  for (int g = 0; g < pd->config.n_group; g++) {
    const bw_pd_material *m = &pd->config.material[g];
    const double stiff = pd->config.geometry == BW_PD_PLANE_STRESS
                             ? 1 / (1 - m->nu * m->nu)
                             : (1 - m->nu) / ((1 + m->nu) * (1 - 2 * m->nu));
    most = fmax(most, sqrt(m->E * stiff / m->rho));
  }
  return most;
}

/* A wave from a hot cell has not come nearer than a horizon to what is coarser until then [T]. */
static double patience_of(const bw_solid *s)
{
  return (s->config.finer.refine.buffer - 1) * s->body->level->horizon / speed_of(s->body) *
         (1 + 1e-9);
}

bool bw_solid__levels_due(const bw_solid *s)
{
  /* The next step may be longer than all so far: as long as is stable, within reason. */
  const double patience = patience_of(s), longer = fmin(bw_solid_dt_max(s), 0.5 * patience);
  return s->levels->since + fmax(s->levels->dt, longer) > patience;
}

bw_status bw_solid__levels_time(bw_solid *s, double dt)
{
  bw_solid__levels *l = s->levels;
  if (l == NULL) return BW_OK;
  BW_REQUIRE(l->since == 0 || l->since + dt <= patience_of(s), BW_EINPUT,
             "solid_step: %g since bw_solid_adapt looked where cells have to be refined, and waves "
             "cross the buffer in %g; call it before every step",
             l->since, patience_of(s));
  l->dt = fmax(l->dt, dt);
  l->since += dt;
  return BW_OK;
}

/* Bonds of the lanes of a block that are broken. */
static void count_broken(const bw_pd_body *pd, const bw_pd_block *block, int count[BW_PD_LANES])
{
  memset(count, 0, BW_PD_LANES * sizeof *count);
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    const unsigned gone = slot->family & ~(unsigned)slot->mask;
    for (int lane = 0; gone != 0 && lane < BW_PD_LANES; lane++)
      count[lane] += gone >> lane & 1;
  }
}

void bw_solid_get_precut(const bw_solid *s, double part[])
{
  const bw_pd_body *pd = s->body;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    int family[BW_PD_LANES] = {0};
    for (uint32_t q = block->slot; q < block[1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        family[lane] += pd->bonds.slot[q].family >> lane & 1;
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(block, lane);
      part[i] = s->levels == NULL ? 0 : (double)s->levels->precut[i] / fmax(1, family[lane]);
    }
  }
}

/* Adds BW_SOLID__SCAR to own particles with bonds that broke; returns whether all of these are of
 * the finest level. */
static bool find_scars(const bw_solid *s, uint8_t flag[])
{
  const bw_pd_body *pd = s->body;
  bool fine = true;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    int count[BW_PD_LANES];
    if (!block->broken) continue;
    count_broken(pd, block, count);
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const size_t i = (size_t)bw_pd_body_owner(block, lane);
      /* What pre-cracks cut is cut again in every body: it is geometry. */
      if (count[lane] <= s->levels->precut[i]) continue;
      flag[i] |= BW_SOLID__SCAR;
      fine = fine && block->level == pd->finest;
    }
  }
  return fine;
}

/* Bits of cells from those of the own particles: any of them will do, so that it is the same on any
 * number of ranks. Collective. */
static bw_status gather(const bw_solid *s, const uint8_t own[], uint8_t flag[])
{
  const bw_pd_body *pd = s->body;
  const size_t cells = bw_pd_levels_cells(&s->levels->map), words = (cells + 7) / 8;
  uint64_t *all = NULL;
  BW_TRY(bw_comm_agree(pd->comm, BW_ALLOCATE(&all, words)));
  uint8_t *byte = (uint8_t *)all;
  for (size_t i = 0; i < pd->n; i++)
    byte[bw_pd_levels_cell_of(pd, &s->levels->map, i)] |= (uint8_t)(own[i] | BW_SOLID__OCCUPIED);
  bw_comm_or(pd->comm, words, all);
  memcpy(flag, byte, cells);
  bw_release(&all);
  return BW_OK;
}

bw_status bw_solid__levels_scan(const bw_solid *s, uint8_t flag[])
{
  bw_pd_body *pd = s->body;
  const bw_solid_refine *r = &s->config.finer.refine;
  const bw_pd_levels_glance glance = {
      .trigger = r->trigger, .hot = r->at, .warm = r->coarsen_at, .time = patience_of(s)};
  uint8_t *own = NULL;
  bw_status st = bw_comm_agree(pd->comm, BW_ALLOCATE(&own, pd->n));
  BW_THEN(st, bw_pd_levels_look(pd, &glance, own));
  const bool fine = st != BW_OK || find_scars(s, own);
  st = bw_comm_agree(pd->comm, fine ? st
                                    : BW_FAIL(BW_EDIVERGED,
                                              "solid: a bond is broken outside the finest level, "
                                              "which none may be where levels change"));
  if (st == BW_OK) st = gather(s, own, flag);
  bw_release(&own);
  return st;
}

bw_status bw_solid__levels_around(const bw_solid *s, const uint8_t scan[], int bit, int width,
                                  uint8_t flag[])
{
  const size_t cells = bw_pd_levels_cells(&s->levels->map);
  uint8_t *near = NULL;
  BW_TRY(BW_ALLOCATE(&near, cells));
  for (size_t q = 0; q < cells; q++)
    near[q] = (scan[q] & bit) != 0;
  const bw_status st = bw_pd_levels_widen(&s->body->config, &s->levels->map, width, near);
  for (size_t q = 0; q < cells && st == BW_OK; q++)
    flag[q] |= near[q];
  bw_release(&near);
  return st;
}
