/* What an update does: look where bonds broke or gaps may open, renew what follows from that, and
 * turn the normals with the body. */
#include "bw_memory.h"
#include "pd_interface_internal.h"
#include <string.h>

/* Is h, resolved last, surface where these sectors are empty? In a body of one level those that
 * never held anyone tell open sides. Beside another level a sector may hold nobody though no side
 * is open, and at a step of two fine cells all hold somebody though one is: there sides tell. */
static bool shows(const bw_pd_interface *pi, size_t h, uint32_t empty)
{
  uint32_t not_held, never = 0;
  if (pi->n_stencil > 1) {
    if (bw_pd_interface__has_open_side(pi, h)) return true;
    bw_pd_interface__bare_sectors(pi, h, &not_held, &never);
  }
  return bw_pd_interface__is_open(pi->stencil, empty & ~never, pi->config.n_empty);
}

bool bw_pd_interface__judge(bw_pd_interface *pi, size_t h, const bw_pd_motion *now)
{
  /* POROUS 3.42: mean present distance to broken partners, sector by sector. */
  bw_pd_interface__locate(pi, h, now);
  const uint32_t empty = bw_pd_interface__empty_sectors(pi, h);
  return !pi->wall.outside[h] && shows(pi, h, empty);
}

/* Is h surface whatever the gaps, or never, or does it depend on them? */
static void classify(bw_pd_interface *pi, size_t h)
{
  uint32_t not_held, never;
  /* Without any place: which sectors hold nothing now, and which never held anything. */
  bw_pd_interface__resolve(pi, h, false);
  bw_pd_interface__bare_sectors(pi, h, &not_held, &never);
  /* A sector that never held a partner stays empty; one that lost all may close again. */
  const bool always = shows(pi, h, never), possible = shows(pi, h, not_held);
  pi->surface[h] = always && !pi->wall.outside[h];
  pi->watch.undecided[h] = possible && !always && !pi->wall.outside[h];
  /* Its partners have changed: row, normal and line elements are made anew. */
  pi->rows.stale[h] = true;
}

/* Particles whose bonds broke since the last look, and those that left a wall or met it again.
 * Where nothing broke nothing but the places at the walls is read. Returns whether there are any.
 */
static bool follow_changes(bw_pd_interface *pi, const bw_pd_motion *now)
{
  bool changed = false;
  /* Those that lean on a wall: only their own displacement is read. */
  for (size_t q = 0; q < pi->wall.n_leaning; q++) {
    const size_t h = (size_t)pi->wall.leaning[q];
    const bool off = bw_pd_interface__moved_off(pi, h, now);
    if (off == pi->wall.off[h]) continue;
    pi->wall.off[h] = off;
    classify(pi, h);
    changed = true;
  }
  /* A bond broke somewhere on this rank: who has more broken ones than before? */
  if (bw_solid_events(pi->pd) != pi->watch.events) {
    pi->watch.events = bw_solid_events(pi->pd);
    bw_solid_get_broken(pi->pd, pi->watch.fresh);
    for (size_t h = 0; h < pi->n; h++) {
      if (pi->watch.fresh[h] == pi->watch.broken[h]) continue;
      pi->watch.broken[h] = pi->watch.fresh[h];
      classify(pi, h);
      changed = true;
    }
  }
  if (!changed) return false;
  /* The list of those whose state depends on gaps, for follow_gaps. */
  pi->watch.n_gap = 0;
  for (size_t h = 0; h < pi->n; h++)
    if (pi->watch.undecided[h]) pi->watch.gap[pi->watch.n_gap++] = (int32_t)h;
  return true;
}

/* Returns whether a gap has opened or closed far enough to show. */
static bool follow_gaps(bw_pd_interface *pi, const bw_pd_motion *now)
{
  bool changed = false;
  for (size_t q = 0; q < pi->watch.n_gap; q++) {
    const size_t h = (size_t)pi->watch.gap[q];
    const bool before = pi->surface[h];
    /* The distance to broken partners is that of now. */
    bw_pd_interface__resolve(pi, h, false);
    pi->surface[h] = bw_pd_interface__judge(pi, h, now);
    changed = changed || pi->surface[h] != before;
  }
  return changed;
}

/* Room for `more` rows at the end of the pool. Only new crack faces ever ask for it after the
 * start; when there is no memory the particle goes without a row and is resolved each time. */
static bool make_room(bw_pd_interface *pi, size_t more)
{
  if (pi->rows.pool_n + more <= pi->rows.pool_room) return true;
  /* Half as much again, so that a growing crack asks rarely. */
  const size_t room = pi->rows.pool_n + more + pi->rows.pool_room / 2 + 1024;
  if (BW_ENLARGE(&pi->rows.pool, pi->rows.pool_n, room) != BW_OK) return false;
  pi->rows.pool_room = room;
  return true;
}

/* Write the row of h, resolved last: its present partners. */
static void write_row(bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  size_t count = 0;
  /* How many partners hold; a row that has become too short is written at the end of the pool. */
  for (int q = 0; q < s->slots; q++)
    count += pi->seen.state[q] == BW_PD_INTERFACE__INTACT;
  if (count > pi->rows.row_room[h]) {
    pi->rows.row_room[h] = 0;
    if (!make_room(pi, count)) return;
    pi->rows.row[h] = pi->rows.pool_n;
    pi->rows.row_room[h] = (uint16_t)count;
    pi->rows.pool_n += count;
  }
  size_t at = pi->rows.row[h];
  pi->fit.border[h] = false;
  for (int q = 0; q < s->slots; q++) {
    if (pi->seen.state[q] != BW_PD_INTERFACE__INTACT) continue;
    const bw_pd_interface__near near = pi->seen.near[q];
    /* Images and copies do not know h as a partner, nor do finer ones beyond whose horizon it is:
     * change has to reach h from them. */
    pi->fit.border[h] = pi->fit.border[h] || near.cross != 0 || near.partner >= (int32_t)pi->n ||
                        s->other[q] != s->level;
    pi->rows.pool[at++] = near;
  }
  pi->rows.row_n[h] = (uint16_t)count;
  pi->rows.stale[h] = false;
}

void bw_pd_interface__renew(bw_pd_interface *pi, bool reference)
{
  pi->now.n_list = 0;
  for (size_t h = 0; h < pi->n; h++) {
    /* What settle_normals has to look at again. */
    pi->fit.changed[h] = pi->surface[h] && pi->rows.stale[h];
    if (!pi->surface[h]) continue;
    /* Only the stale ones are resolved; in most updates nobody is. */
    if (pi->rows.stale[h]) {
      uint32_t not_held, never;
      bw_pd_interface__resolve(pi, h, reference);
      bw_pd_interface__bare_sectors(pi, h, &not_held, &never);
      bw_pd_interface__tell_normal(pi, h, not_held);
      bw_pd_interface__anchor(pi, h);
      write_row(pi, h);
    }
    /* The reference shape's own area, or a new crack face's (ERRATA 10). */
    pi->now.area[pi->now.n_list] =
        pi->first[h] ? pi->area_first[h] : bw_pd_interface__side_area(pi, h);
    pi->now.list[pi->now.n_list++] = (int32_t)h;
  }
}

bw_status bw_pd_interface_update(bw_pd_interface *pi)
{
  if (pi->revision != bw_solid_revision(pi->pd)) BW_TRY(bw_pd_interface__rebuild(pi));
  const bw_pd_motion now = bw_solid_get_motion(pi->pd, false);
  /* What broke, then what opened: both may make or end a surface. */
  const bool broken = follow_changes(pi, &now), shown = follow_gaps(pi, &now);
  int64_t changed = pi->fresh_start || broken || shown;
  pi->fresh_start = false;
  /* Normals are fitted across ranks, so all renew or none. */
  bw_comm_max_int(bw_solid_comm(pi->pd), 1, &changed);
  if (changed) {
    bw_pd_interface__renew(pi, false);
    bw_pd_interface__settle_normals(pi);
    bw_pd_interface__lay_lines(pi, &now);
    bw_pd_interface__settle_heights(pi);
  }
  /* From here on every update: present places ... */
  for (size_t row = 0; row < pi->now.n_list; row++) {
    const size_t h = (size_t)pi->now.list[row], place = (size_t)now.place[h];
    for (size_t d = 0; d < 3; d++)
      pi->now.position[3 * row + d] = pi->X0[3 * h + d] + (double)now.u[d][place];
  }
  /* ... and normals turned with the body. */
  bw_pd_interface__carry_normals(pi, &now);
  return BW_OK;
}
