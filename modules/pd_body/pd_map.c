/* Lattice site -> number: a table over the box where that is not wasteful, else hashing. */
#include "pd_map.h"
#include "bw_memory.h"

#include <string.h>

/* A dense table may have this many cells per entry expected, and this many anyway. */
enum { CELLS_PER_ENTRY = 8, CELLS_FREE = 1 << 20 };

static size_t power_of_two(size_t least)
{
  size_t p = 64;
  while (p < least)
    p *= 2;
  return p;
}

static bw_status allocate(bw_pd_map *map)
{
  BW_TRY(BW_ALLOCATE(&map->value, map->capacity));
  memset(map->value, 0xff, map->capacity * sizeof *map->value); /* all -1 */
  return map->dense ? BW_OK : BW_ALLOCATE(&map->key, map->capacity);
}

bw_status bw_pd_map_create(size_t n, const int32_t lower[3], const int32_t upper[3], bw_pd_map *map)
{
  double cells = 1;
  for (int k = 0; k < 3; k++) {
    map->lower[k] = lower[k];
    map->size[k] = (int64_t)upper[k] - lower[k] + 1;
    cells *= (double)map->size[k];
  }
  map->dense = cells <= (double)CELLS_PER_ENTRY * (double)n + CELLS_FREE;
  map->capacity = map->dense ? (size_t)cells : power_of_two(3 * n);
  return allocate(map);
}

void bw_pd_map_destroy(bw_pd_map *map)
{
  bw_release(&map->value);
  bw_release(&map->key);
}

/* 21 bits per direction: create refuses lattices that are larger. */
static uint64_t key_of(const bw_pd_map *map, const int32_t site[3])
{
  uint64_t key = 0;
  for (int k = 2; k >= 0; k--)
    key = key << 21 | ((uint64_t)(site[k] - map->lower[k]) & 0x1fffff);
  return key;
}

/* Multiplicative hashing (Knuth), linear probing: where the key is or would go. */
static size_t find(const bw_pd_map *map, uint64_t key)
{
  const size_t last = map->capacity - 1;
  size_t q = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & last;
  while (map->value[q] >= 0 && map->key[q] != key)
    q = (q + 1) & last;
  return q;
}

static bool inside(const bw_pd_map *map, const int32_t site[3])
{
  for (int k = 0; k < 3; k++)
    if (site[k] < map->lower[k] || site[k] >= map->lower[k] + map->size[k]) return false;
  return true;
}

static size_t place(const bw_pd_map *map, const int32_t site[3])
{
  if (!map->dense) return find(map, key_of(map, site));
  return (size_t)((site[0] - map->lower[0]) +
                  map->size[0] *
                      ((site[1] - map->lower[1]) + map->size[1] * (site[2] - map->lower[2])));
}

int32_t bw_pd_map_get(const bw_pd_map *map, const int32_t site[3])
{
  return inside(map, site) ? map->value[place(map, site)] : -1;
}

static bw_status grow(bw_pd_map *map)
{
  bw_pd_map old = *map;
  map->capacity *= 2;
  map->value = NULL;
  map->key = NULL;
  const bw_status st = allocate(map);
  for (size_t q = 0; q < old.capacity && st == BW_OK; q++)
    if (old.value[q] >= 0) {
      const size_t at = find(map, old.key[q]);
      map->key[at] = old.key[q];
      map->value[at] = old.value[q];
    }
  bw_pd_map_destroy(&old);
  return st;
}

bw_status bw_pd_map_put(bw_pd_map *map, const int32_t site[3], int32_t value, int32_t *found)
{
  if (!map->dense && 2 * map->used >= map->capacity) BW_TRY(grow(map));
  const size_t at = place(map, site);
  *found = map->value[at];
  if (*found >= 0) return BW_OK;
  map->value[at] = value;
  if (!map->dense) map->key[at] = key_of(map, site);
  map->used++;
  return BW_OK;
}

void bw_pd_map_replace(bw_pd_map *map, const int32_t site[3], int32_t value)
{
  map->value[place(map, site)] = value;
}
