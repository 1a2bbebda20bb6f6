/* pd_map.h -- lattice site -> number. Dense over a box, or a hash table when the box is too empty. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
  bool dense;
  int64_t lower[3], size[3];
  int32_t *value; /* (cells) or (capacity); -1: none */
  uint64_t *key;  /* hash only */
  size_t capacity, used;
} bw_pd_map;

bw_status bw_pd_map_create(size_t n, const int32_t lower[3], const int32_t upper[3],
                           bw_pd_map *map);
void bw_pd_map_destroy(bw_pd_map *map);
int32_t bw_pd_map_get(const bw_pd_map *map, const int32_t site[3]);
/* Returns in *found what was there (then nothing changes) or -1 (then value is stored). */
bw_status bw_pd_map_put(bw_pd_map *map, const int32_t site[3], int32_t value, int32_t *found);
void bw_pd_map_replace(bw_pd_map *map, const int32_t site[3], int32_t value);
