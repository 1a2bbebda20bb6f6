#include "bw_particles_map.h"
#include "bw_memory.h"
#include "bw_particles_order.h"
#include "particles_key.h"

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

static bw_status allocate(bw_particles_map *map)
{
  BW_TRY(BW_ALLOCATE(&map->value, map->capacity));
  memset(map->value, 0xff, map->capacity * sizeof *map->value); /* all -1 */
  return map->dense ? BW_OK : BW_ALLOCATE(&map->key, map->capacity);
}

bw_status bw_particles_map_create(size_t n, const int32_t lower[3], const int32_t upper[3],
                                  bw_particles_map *map)
{
  double cells = 1;
  memset(map, 0, sizeof *map);
  for (int k = 0; k < 3; k++) {
    map->lower[k] = lower[k];
    map->size[k] = (int64_t)upper[k] - lower[k] + 1;
    BW_REQUIRE(map->size[k] <= BW_PARTICLES_MOST + 1, BW_EINPUT,
               "particles: sites from %d to %d in direction %d; the limit is 2^21 steps", lower[k],
               upper[k], k);
    cells *= (double)map->size[k];
  }
  /* Well filled: a table by place, without keys. Else hashed, at most half full. */
  map->dense = cells <= (double)CELLS_PER_ENTRY * (double)n + CELLS_FREE;
  map->capacity = map->dense ? (size_t)cells : power_of_two(3 * n);
  return allocate(map);
}

bw_status bw_particles_map_create_own(size_t n, const int32_t site[], int32_t margin,
                                      bw_particles_map *map)
{
  int32_t lower[3], upper[3], found;
  memset(map, 0, sizeof *map);
  BW_REQUIRE(n <= INT32_MAX, BW_EINPUT,
             "particles: one rank has %zu of them; below 2^31 can be numbered: take more ranks", n);
  bw_particles_extent(n, site, lower, upper);
  for (int k = 0; k < 3; k++) {
    /* Room for places around the own ones, which the caller adds. */
    lower[k] -= margin;
    upper[k] += margin;
  }
  BW_TRY(bw_particles_map_create(n, lower, upper, map));
  for (size_t q = 0; q < n; q++) {
    const int32_t *s = site + 3 * q;
    BW_TRY(bw_particles_map_put(map, s, (int32_t)q, &found));
    BW_REQUIRE(found < 0, BW_EINPUT,
               "particles: two of them (%d and %zu of their rank) are on the site (%d,%d,%d): "
               "leave one out",
               found, q, s[0], s[1], s[2]);
  }
  return BW_OK;
}

void bw_particles_map_destroy(bw_particles_map *map)
{
  bw_release(&map->value);
  bw_release(&map->key);
  memset(map, 0, sizeof *map);
}

static uint64_t key_of(const bw_particles_map *map, const int32_t site[3])
{
  static const int axis[3] = {0, 1, 2};
  const int64_t above[3] = {site[0] - map->lower[0], site[1] - map->lower[1],
                            site[2] - map->lower[2]};
  return bw_particles__key(axis, above);
}

/* Multiplicative hashing (Knuth), linear probing: where the key is or would go. */
static size_t find(const bw_particles_map *map, uint64_t key)
{
  const size_t last = map->capacity - 1;
  size_t q = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & last;
  while (map->value[q] >= 0 && map->key[q] != key)
    q = (q + 1) & last;
  return q;
}

static bool inside(const bw_particles_map *map, const int32_t site[3])
{
  for (int k = 0; k < 3; k++)
    if (site[k] < map->lower[k] || site[k] >= map->lower[k] + map->size[k]) return false;
  return true;
}

static size_t place(const bw_particles_map *map, const int32_t site[3])
{
  if (!map->dense) return find(map, key_of(map, site));
  return (size_t)((site[0] - map->lower[0]) +
                  map->size[0] *
                      ((site[1] - map->lower[1]) + map->size[1] * (site[2] - map->lower[2])));
}

int32_t bw_particles_map_get(const bw_particles_map *map, const int32_t site[3])
{
  return inside(map, site) ? map->value[place(map, site)] : -1;
}

static bw_status grow(bw_particles_map *map)
{
  bw_particles_map old = *map;
  map->capacity *= 2;
  map->value = NULL;
  map->key = NULL;
  const bw_status st = allocate(map);
  for (size_t q = 0; q < old.capacity && st == BW_OK; q++)
    /* Places depend on the capacity: every entry is put anew. */
    if (old.value[q] >= 0) {
      const size_t at = find(map, old.key[q]);
      map->key[at] = old.key[q];
      map->value[at] = old.value[q];
    }
  bw_particles_map_destroy(&old);
  return st;
}

bw_status bw_particles_map_put(bw_particles_map *map, const int32_t site[3], int32_t value,
                               int32_t *found)
{
  BW_ASSERT(inside(map, site));
  /* Half of a hashed map stays empty, so that a search ends after a few places. */
  if (!map->dense && 2 * map->used >= map->capacity) BW_TRY(grow(map));
  const size_t at = place(map, site);
  *found = map->value[at];
  if (*found >= 0) return BW_OK;
  map->value[at] = value;
  if (!map->dense) map->key[at] = key_of(map, site);
  map->used++;
  return BW_OK;
}

void bw_particles_map_replace(bw_particles_map *map, const int32_t site[3], int32_t value)
{
  BW_ASSERT(bw_particles_map_get(map, site) >= 0);
  map->value[place(map, site)] = value;
}
