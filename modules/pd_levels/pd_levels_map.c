/* Which cells are of which level: the map, its belts, boxes in it. */
#include "bw_memory.h"
#include "bw_pd_levels.h"
#include "pd_body.h"

#include <math.h>
#include <string.h>

static int axes_of(const bw_pd_body_config *c)
{
  return c->geometry == BW_PD_3D ? 3 : 2;
}

/* Cells of a period; 0: none. */
static int32_t period_of(const bw_pd_body_config *c, int k)
{
  return (int32_t)lround(c->period[k] / c->ds);
}

size_t bw_pd_levels_cells(const bw_pd_map *map)
{
  return (size_t)map->size[0] * (size_t)map->size[1] * (size_t)map->size[2];
}

bw_status bw_pd_levels_map_create(const bw_comm *comm, const bw_pd_body_config *c,
                                  const bw_pd_sites *given, int finest, bw_pd_map *map)
{
  /* One maximum for both ends: that of the lower one is taken with its sign turned. */
  double most[6] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY}, cells = 1;
  *map = (bw_pd_map){.finest = finest};
  for (int64_t q = 0; q < given->n; q++)
    for (int k = 0; k < 3; k++) {
      most[k] = fmax(most[k], -given->site[3 * q + k]);
      most[3 + k] = fmax(most[3 + k], given->site[3 * q + k]);
    }
  bw_comm_max(comm, 6, most);
  for (int k = 0; k < 3; k++) {
    double size = fmax(1, most[3 + k] + most[k] + 1);
    if (period_of(c, k) > 0) size = fmax(size, period_of(c, k));
    BW_REQUIRE(
        size < 1 << 20 && cells * size < INT32_MAX, BW_EINPUT,
        "solid: sites reach over %.0f cells in direction %d; a body whose levels change takes "
        "2^20 each way and 2^31 in all",
        size, k);
    cells *= size;
    map->lower[k] = isfinite(most[k]) ? (int32_t)-most[k] : 0;
    map->size[k] = (int32_t)size;
  }
  return bw_comm_agree(comm, BW_ALLOCATE(&map->level, bw_pd_levels_cells(map)));
}

void bw_pd_levels_map_release(bw_pd_map *map)
{
  bw_release(&map->level);
}

size_t bw_pd_levels_cell(const bw_pd_map *map, const int32_t site[3])
{
  size_t at = 0;
  for (int k = 2; k >= 0; k--)
    at = at * (size_t)map->size[k] + (size_t)(site[k] - map->lower[k]);
  return at;
}

size_t bw_pd_levels_cell_of(const bw_pd_body *pd, const bw_pd_map *map, size_t i)
{
  /* Places count half spacings of the finest level (pd_level.h). */
  int32_t site[3];
  for (int k = 0; k < 3; k++)
    site[k] = k < pd->dimension ? pd->points.site[3 * i + (size_t)k] >> (pd->finest + 1)
                                : pd->points.site[3 * i + (size_t)k];
  return bw_pd_levels_cell(map, site);
}

/* One line of n cells, `stride` apart; scratch (n). */
static void widen_line(uint8_t *x, size_t stride, int32_t n, int width, bool wraps,
                       uint8_t *scratch)
{
  memset(scratch, 0, (size_t)n);
  for (int32_t i = 0; i < n; i++) {
    if (x[(size_t)i * stride] == 0) continue;
    for (int32_t j = i - width; j <= i + width; j++)
      if (j >= 0 && j < n)
        scratch[j] = 1;
      else if (wraps)
        scratch[((j % n) + n) % n] = 1;
  }
  for (int32_t i = 0; i < n; i++)
    x[(size_t)i * stride] = scratch[i];
}

bw_status bw_pd_levels_widen(const bw_pd_body_config *c, const bw_pd_map *map, int width,
                             uint8_t flag[])
{
  const size_t n = bw_pd_levels_cells(map);
  uint8_t *scratch = NULL;
  BW_TRY(BW_ALLOCATE(&scratch, n));
  size_t stride = 1;
  /* Axis by axis: a square, or a cube, around each flag. */
  for (int k = 0; k < axes_of(c); k++) {
    const size_t size = (size_t)map->size[k];
    const bool wraps = period_of(c, k) > 0;
    for (size_t first = 0; first < n; first++)
      if (first / stride % size == 0)
        widen_line(flag + first, stride, map->size[k], width, wraps, scratch);
    stride *= size;
  }
  bw_release(&scratch);
  return BW_OK;
}

bw_status bw_pd_levels_balance(const bw_pd_body_config *c, bw_pd_map *map)
{
  const size_t n = bw_pd_levels_cells(map);
  uint8_t *near = NULL;
  BW_TRY(BW_ALLOCATE(&near, n));
  bw_status st = BW_OK;
  /* From the finest one down, so that each belt stands when the next one is laid around it. */
  for (int l = map->finest; l >= 2 && st == BW_OK; l--) {
    for (size_t q = 0; q < n; q++)
      near[q] = map->level[q] >= l;
    /* The horizon of level l - 2 in cells of level 0. */
    st = bw_pd_levels_widen(c, map, (int)ceil(ldexp(c->horizon_ratio, 2 - l)), near);
    for (size_t q = 0; q < n && st == BW_OK; q++)
      if (near[q] && map->level[q] < l - 1) map->level[q] = (uint8_t)(l - 1);
  }
  bw_release(&near);
  return st;
}

/* Cells lower .. upper - 1 along axis k that a box meets; one that it only touches, to rounding, is
 * left. */
static void range_of(const bw_pd_body_config *c, const bw_pd_box *box, int k, double range[2])
{
  static const double TOUCH = 1e-6;
  double from = 0;
  for (int q = 0; q < 3; q++)
    from += c->axes[k][q] * c->origin[q];
  range[0] = floor((box->lower[k] - from) / c->ds + TOUCH);
  range[1] = ceil((box->upper[k] - from) / c->ds - TOUCH);
}

static bool inside(double x, const double range[2], int32_t period)
{
  /* A box has an image in every period. */
  for (int image = period > 0 ? -1 : 0; image <= (period > 0); image++)
    if (x + image * period >= range[0] && x + image * period < range[1]) return true;
  return false;
}

void bw_pd_levels_fill(const bw_pd_body_config *c, const bw_pd_box *box, bw_pd_map *map)
{
  double range[3][2] = {{0}};
  for (int k = 0; k < axes_of(c); k++)
    range_of(c, box, k, range[k]);
  const uint8_t level = (uint8_t)(box->level < map->finest ? box->level : map->finest);
  const size_t n = bw_pd_levels_cells(map);
  for (size_t q = 0; q < n; q++) {
    size_t rest = q;
    bool in = true;
    for (int k = 0; k < axes_of(c); k++) {
      const size_t size = (size_t)map->size[k];
      in = in && inside(map->lower[k] + (double)(rest % size), range[k], period_of(c, k));
      rest /= size;
    }
    if (in && map->level[q] < level) map->level[q] = level;
  }
}
