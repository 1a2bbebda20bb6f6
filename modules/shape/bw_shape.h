/* bw_shape.h -- which lattice sites are solid: shapes, their unions and differences.
 *
 * A body is a list of shapes applied in order: `add` or `remove`. The lattice sites whose centre
 * lies inside are particles: half-open in a box (lower <= x < upper, so that n ds hold n sites),
 * the surface included in balls; ties within 1e-9 do not depend on rounding. The last shape that
 * holds a site decides, also on its particle kind. An endless shape that is added ends where the
 * other added ones end. An extension is one row in the table of bw_shape.c.
 * Pore lattices (simple cubic, body-centred, face-centred) are overlapping spherical pores of
 * `radius` on a lattice of `pitch` anchored at `centre`. */
#pragma once
#include "bw_shape_mask.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
  BW_SHAPE_BOX,      /* lower, upper */
  BW_SHAPE_SPHERE,   /* centre, radius */
  BW_SHAPE_CYLINDER, /* centre, radius, axis (0, 1, 2), endless */
  BW_SHAPE_PORES_SC, /* centre (of one pore), radius, pitch */
  BW_SHAPE_PORES_BCC,
  BW_SHAPE_PORES_FCC,
  BW_SHAPE_MASK, /* mask: a voxel image or a closed surface, see bw_shape_mask.h */
  BW_SHAPE_COUNT
} bw_shape_kind;

typedef struct {
  bw_shape_kind kind;
  bool remove;  /* false: add */
  bool outside; /* the shape is all of space but the body: removed, it cuts to the body */
  double lower[3], upper[3], centre[3], radius, pitch; /* [L]; unused ones ignored */
  int axis;
  const bw_shape_mask *mask; /* borrowed */
  uint8_t particle_kind;     /* BW_PD_FREE, ... given to the sites it adds */
} bw_shape;

const char *bw_shape_name(bw_shape_kind kind); /* "pores_sc": the word used in YAML. Local. */

/* All sites inside the body, x fastest, then y, then z: site (n,3), kind (n); owned by the
 * caller (bw_release). `planar`: only site[2] = 0, and z of the shapes is ignored. BW_EINPUT for an
 * invalid shape (named by its number) or an empty body. Local. */
bw_status bw_shape_fill(int count, const bw_shape shape[], double ds, const double origin[3],
                        bool planar, int64_t *n, int32_t **site, uint8_t **kind) BW_MUST_CHECK;
