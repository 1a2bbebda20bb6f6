/* shape_field.h -- the surface of a mask as a signed distance at its voxels; inside `shape`
 * only. */
#pragma once
#include "shape_internal.h"

/* Nodes are the centres of voxels, with PAD layers of empty ones around the mask (in 2D one
 * layer in z, without). */
enum { BW_SHAPE__PAD = 3 };
struct bw_shape_field {
  int dims;
  int64_t n[3];    /* nodes */
  double first[3]; /* place of node (0,0,0) [L] */
  double h[3];     /* their distance [L] */
  float *away;     /* (n[2], n[1], n[0]) signed distance [L], x fastest; negative inside */
};

void bw_shape__field_destroy(bw_shape_field **field); /* NULL is fine. Local. */
/* Signed distance at x (3) and its gradient g (3), a unit vector: linear between nodes; beyond them
 * that of the nearest place among them, and the way there. Local. */
double bw_shape__field_at(const bw_shape_field *f, const double x[3], double g[3]);
