/* What an update does: look where bonds broke or gaps may open, then renew normals and rows. */
#include "bw_memory.h"
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

/* A stand-in where the neighbours balance: the middle of the lowest group of empty sectors (one
 * of the sides of a sheet), or of the lowest one when they surround the particle. */
static void guess_normal(const bw_pd_interface__stencil *s, uint32_t empty, double n[3])
{
  const uint32_t group = bw_pd_interface__group(s, empty);
  double sum[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  int lowest = -1;
  for (int k = 0; k < s->sectors; k++) {
    if (!(group >> (unsigned)k & 1u)) continue;
    if (lowest < 0) lowest = k;
    for (int d = 0; d < 3; d++)
      sum[d] += s->direction[k][d];
  }
  for (int d = 0; d < 3; d++)
    squared += sum[d] * sum[d];
  for (int d = 0; d < 3; d++)
    n[d] = squared > 1e-6 ? sum[d] / sqrt(squared) : s->direction[lowest][d];
}

bool bw_pd_interface__judge(bw_pd_interface *pi, size_t h, const bw_real *X)
{
  const bw_pd_interface__stencil *s = &pi->stencil;
  bw_pd_interface__locate(pi, h, X);
  const uint32_t empty = bw_pd_interface__empty_sectors(pi);
  if (pi->outside[h] || !bw_pd_interface__is_open(s, empty, pi->config.n_empty)) return false;
  double *n = &pi->normal[3 * h];
  const bool known = n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0;
  if (!bw_pd_interface__normal_of(pi, h, X, n) && !known) guess_normal(s, empty, n);
  return true;
}

/* Is h surface whatever the gaps, or never, or does it depend on them? */
static void classify(bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = &pi->stencil;
  uint32_t not_held, never;
  bw_pd_interface__resolve(pi, h, false);
  bw_pd_interface__bare_sectors(pi, &not_held, &never);
  const bool always = bw_pd_interface__is_open(s, never, pi->config.n_empty);
  const bool possible = bw_pd_interface__is_open(s, not_held, pi->config.n_empty);
  pi->surface[h] = always && !pi->outside[h];
  pi->undecided[h] = possible && !always && !pi->outside[h];
  pi->stale[h] = true;
}

/* Particles whose bonds broke since the last look, and those that left a wall or met it again.
 * Where nothing broke nothing but the places at the walls is read. */
static void follow_changes(bw_pd_interface *pi, const bw_real *X)
{
  bool changed = false;
  for (size_t q = 0; q < pi->n_leaning; q++) {
    const size_t h = (size_t)pi->leaning[q];
    const bool off = bw_pd_interface__moved_off(pi, h, X);
    if (off == pi->off[h]) continue;
    pi->off[h] = off;
    classify(pi, h);
    changed = true;
  }
  if (bw_pd_bond_events(pi->pd) != pi->events) {
    pi->events = bw_pd_bond_events(pi->pd);
    bw_pd_bond_get_broken(pi->pd, pi->fresh);
    for (size_t h = 0; h < pi->n; h++) {
      if (pi->fresh[h] == pi->broken[h]) continue;
      pi->broken[h] = pi->fresh[h];
      classify(pi, h);
      changed = true;
    }
  }
  if (!changed) return;
  pi->n_gap = 0;
  for (size_t h = 0; h < pi->n; h++)
    if (pi->undecided[h]) pi->gap[pi->n_gap++] = (int32_t)h;
}

static void follow_gaps(bw_pd_interface *pi, const bw_real *X)
{
  for (size_t q = 0; q < pi->n_gap; q++) {
    const size_t h = (size_t)pi->gap[q];
    bw_pd_interface__resolve(pi, h, false);
    pi->surface[h] = bw_pd_interface__judge(pi, h, X);
  }
}

/* Room for `more` rows at the end of the pool. Only new crack faces ever ask for it after the
 * start; when there is no memory the particle goes without a row and is resolved each time. */
static bool make_room(bw_pd_interface *pi, size_t more)
{
  if (pi->pool_n + more <= pi->pool_room) return true;
  const size_t room = pi->pool_n + more + pi->pool_room / 2 + 1024;
  bw_pd_interface__near *pool = NULL;
  if (BW_ALLOCATE(&pool, room) != BW_OK) return false;
  if (pi->pool_n > 0) memcpy(pool, pi->pool, pi->pool_n * sizeof *pool);
  bw_release(&pi->pool);
  pi->pool = pool;
  pi->pool_room = room;
  return true;
}

/* Write the row of h, resolved last: its present partners. */
static void write_row(bw_pd_interface *pi, size_t h)
{
  size_t count = 0;
  for (int q = 0; q < pi->stencil.slots; q++)
    count += pi->state[q] == BW_PD_INTERFACE__INTACT;
  if (count > pi->row_room[h]) {
    pi->row_room[h] = 0;
    if (!make_room(pi, count)) return;
    pi->row[h] = pi->pool_n;
    pi->row_room[h] = (uint16_t)count;
    pi->pool_n += count;
  }
  size_t at = pi->row[h];
  for (int q = 0; q < pi->stencil.slots; q++)
    if (pi->state[q] == BW_PD_INTERFACE__INTACT) pi->pool[at++] = pi->near[q];
  pi->row_n[h] = (uint16_t)count;
  pi->stale[h] = false;
}

/* The normal of h now; it stays the last one where the neighbours balance. */
static void renew_normal(bw_pd_interface *pi, size_t h, const bw_real *X)
{
  if (pi->stale[h]) {
    bw_pd_interface__resolve(pi, h, false);
    write_row(pi, h);
  }
  double *n = &pi->normal[3 * h];
  const bool told = pi->stale[h]
                        ? bw_pd_interface__normal_of(pi, h, X, n)
                        : bw_pd_interface__normal(pi, h, X, pi->row_n[h], &pi->pool[pi->row[h]], n);
  if (told || n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0) return;
  uint32_t not_held, never;
  bw_pd_interface__resolve(pi, h, false);
  bw_pd_interface__bare_sectors(pi, &not_held, &never);
  guess_normal(&pi->stencil, not_held, n);
}

/* Particle h at the end of the list. */
static void append(bw_pd_interface *pi, size_t h, const bw_real *X)
{
  const size_t row = pi->n_list++;
  pi->list[row] = (int32_t)h;
  pi->area[row] = pi->first[h] ? pi->area_first[h] : pi->area_new;
  for (size_t d = 0; d < 3; d++) {
    pi->position[3 * row + d] = (double)X[3 * h + d];
    pi->velocity[3 * row + d] = pi->all_velocity[3 * h + d];
    pi->list_normal[3 * row + d] = pi->normal[3 * h + d];
  }
}

/* Mean of the normals of the surface particles a surface particle has intact bonds with. Those
 * on the other side of a sheet or an edge look elsewhere (more than 60 degrees) and stay out.
 * Collective. */
static void smooth(bw_pd_interface *pi)
{
  memset(pi->own_normal, 0, 3 * pi->n * sizeof *pi->own_normal);
  for (size_t row = 0; row < pi->n_list; row++)
    memcpy(&pi->own_normal[3 * pi->list[row]], &pi->list_normal[3 * row], 3 * sizeof(double));
  bw_pd_bond_fill_extended(pi->pd, 3 * sizeof(double), pi->own_normal, pi->all_normal);
  for (size_t row = 0; row < pi->n_list; row++) {
    const size_t h = (size_t)pi->list[row];
    const double *mine = &pi->all_normal[3 * h];
    double sum[3] = {mine[0], mine[1], mine[2]}, squared = 0.0;
    const int family = bw_pd_bond_links(pi->pd, h, pi->link);
    for (int q = 0; q < family; q++) {
      const double *n = &pi->all_normal[3 * (size_t)pi->link[q].neighbour];
      const double cosine = mine[0] * n[0] + mine[1] * n[1] + mine[2] * n[2];
      if (!pi->link[q].intact || !(cosine > 0.5)) continue;
      for (int d = 0; d < 3; d++)
        sum[d] += n[d];
    }
    for (int d = 0; d < 3; d++)
      squared += sum[d] * sum[d];
    for (size_t d = 0; d < 3; d++)
      pi->list_normal[3 * row + d] = sum[d] / sqrt(squared);
  }
}

bw_status bw_pd_interface_update(bw_pd_interface *pi)
{
  const bw_pd_bond_extended all = bw_pd_bond_get_extended(pi->pd);
  bw_pd_bond_get_velocity(pi->pd, pi->all_velocity);
  follow_changes(pi, all.X);
  follow_gaps(pi, all.X);
  pi->n_list = 0;
  for (size_t h = 0; h < pi->n; h++) {
    if (!pi->surface[h]) continue;
    renew_normal(pi, h, all.X);
    append(pi, h, all.X);
  }
  if (pi->config.smooth_normals) smooth(pi);
  return BW_OK;
}
