/* shape_stl.h -- triangles of a surface, shared by what reads, checks and fills them. */
#pragma once
#include "bw_shape_mask.h"

/* Corners as the file has them; +0 for -0. */
typedef struct {
  uint32_t n, room;
  uint32_t turned; /* facets that pointed to another side than the rest, and were turned */
  float *corner;   /* (n,3,3) */
} bw_shape__triangles;

/* All triangles of a file, the caller's (bw_release of corner), also after a failure. Local. */
bw_status bw_shape__read_triangles(const char *path, bw_shape__triangles *t) BW_MUST_CHECK;

/* Is the surface closed? Facets that turn another way than those around them are turned. Local. */
bw_status bw_shape__check_closed(const char *path, bw_shape__triangles *t) BW_MUST_CHECK;
