/* Pre-cracks: cut now, and again in bodies of other levels; their tips are fine from the start. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

static bw_status remember(bw_solid__levels *l, const bw_solid__precrack *cut)
{
  bw_solid__precrack *all = NULL;
  BW_TRY(BW_ALLOCATE(&all, (size_t)l->n_cut + 1));
  for (int q = 0; q < l->n_cut; q++)
    all[q] = l->cut[q];
  all[l->n_cut++] = *cut;
  bw_release(&l->cut);
  l->cut = all;
  return BW_OK;
}

/* The cell of a point in space is set, where the map has one. */
static void mark(const bw_pd_body *pd, const bw_pd_map *map, const double x[3], uint8_t flag[])
{
  const bw_pd_body_config *c = &pd->config;
  int32_t site[3] = {0};
  for (int k = 0; k < pd->dimension; k++) {
    double at = 0;
    for (int d = 0; d < 3; d++)
      at += c->axes[k][d] * (x[d] - c->origin[d]);
    at = floor(at / c->ds);
    if (!(at >= map->lower[k] && at < map->lower[k] + map->size[k])) return;
    site[k] = (int32_t)at;
  }
  flag[bw_pd_levels_cell(map, site)] = 1;
}

/* The cells that a line from p to q meets, to half a spacing. */
static void mark_line(const bw_pd_body *pd, const bw_pd_map *map, const double p[3],
                      const double q[3], uint8_t flag[])
{
  const double length = sqrt(pow(q[0] - p[0], 2) + pow(q[1] - p[1], 2) + pow(q[2] - p[2], 2));
  const double n = fmin(1e7, ceil(2 * length / pd->config.ds));
  for (double i = 0; i <= n; i++) {
    double x[3];
    for (int k = 0; k < 3; k++)
      x[k] = p[k] + (n > 0 ? i / n : 0) * (q[k] - p[k]);
    mark(pd, map, x, flag);
  }
}

/* Flags the cells at the rim of a cut: in the plane its two ends. */
static void mark_rim(const bw_pd_body *pd, const bw_pd_map *map, const bw_solid__precrack *cut,
                     uint8_t flag[])
{
  double d[3];
  if (pd->dimension == 2) {
    mark(pd, map, cut->a, flag);
    mark(pd, map, cut->b, flag);
    return;
  }
  for (int k = 0; k < 3; k++)
    d[k] = cut->b[k] + cut->c[k] - cut->a[k];
  mark_line(pd, map, cut->a, cut->b, flag);
  mark_line(pd, map, cut->a, cut->c, flag);
  mark_line(pd, map, cut->b, d, flag);
  mark_line(pd, map, cut->c, d, flag);
}

/* What would be refined there later would meet a crack that has begun to open: within a horizon of
 * the rim cells are as fine as can be, always. */
static bw_status raise_rim(const bw_solid *s, const bw_solid__precrack *cut, uint8_t flag[],
                           bw_pd_map *now)
{
  const bw_pd_body_config *c = &s->body->config;
  bw_solid__levels *l = s->levels;
  const size_t cells = bw_pd_levels_cells(now);
  bw_pd_map least = l->map;
  least.level = l->least;
  mark_rim(s->body, now, cut, flag);
  BW_TRY(bw_pd_levels_widen(c, now, (int)ceil(c->horizon_ratio), flag));
  for (size_t q = 0; q < cells; q++)
    if (flag[q]) l->least[q] = (uint8_t)now->finest;
  BW_TRY(bw_pd_levels_balance(c, &least));
  for (size_t q = 0; q < cells; q++)
    now->level[q] = l->least[q] > l->map.level[q] ? l->least[q] : l->map.level[q];
  return BW_OK;
}

/* Collective. */
static bw_status refine_rim(bw_solid *s, const bw_solid__precrack *cut)
{
  bw_pd_map now = s->levels->map;
  const size_t cells = bw_pd_levels_cells(&now);
  uint8_t *flag = NULL;
  now.level = NULL;
  bw_status st = BW_ALLOCATE(&now.level, cells);
  BW_THEN(st, BW_ALLOCATE(&flag, cells));
  BW_THEN(st, raise_rim(s, cut, flag, &now));
  st = bw_comm_agree(s->body->comm, st);
  if (st == BW_OK && memcmp(now.level, s->levels->map.level, cells) != 0)
    st = bw_solid__remap(s, &now);
  bw_release(&flag);
  bw_pd_levels_map_release(&now);
  return st;
}

bw_status bw_solid_precrack(bw_solid *s, const double a[3], const double b[3], const double c[3])
{
  bw_solid__precrack cut = {{0}, {0}, {0}};
  BW_TRY(bw_solid__cut(s, a, b, c));
  if (s->levels == NULL) return BW_OK;
  memcpy(cut.a, a, sizeof cut.a);
  memcpy(cut.b, b, sizeof cut.b);
  if (c != NULL) memcpy(cut.c, c, sizeof cut.c);
  BW_TRY(bw_comm_agree(s->body->comm, remember(s->levels, &cut)));
  return refine_rim(s, &cut);
}
