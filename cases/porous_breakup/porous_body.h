/* porous_body.h -- the medium in making: shared by the sources that describe its body. */
#pragma once
#include "porous_case.h"

enum { POROUS_SLABS = 2 }; /* that hold the medium, at most: room for them behind `shape` */

typedef struct {
  int count;
  bw_shape *shape;
  bw_shape_mask *mask;
  char key[1100]; /* that decides how much of it is pores, with its value: for messages */
} porous_body;

extern const double porous_units[]; /* what the words of medium.image.unit are in metres */

bw_shape porous_box(const porous_config *q); /* the medium's box */
/* A body from voxels and one from a surface, cut to the medium's box. Local. */
bw_status porous_image_body(const porous_config *q, porous_body *b) BW_MUST_CHECK;
bw_status porous_surface_body(const porous_config *q, porous_body *b) BW_MUST_CHECK;
/* What the file holds and what the medium's box cuts off, into the log. Reads all of it.
 * Collective.
 */
bw_status porous_tell_mask(const bw_comm *comm, const porous_config *q, porous_body *b,
                           bw_case *run) BW_MUST_CHECK;
/* Porosity, connectivity and pore sizes of the medium made of these sites (n,3), into the log.
 * Collective. */
bw_status porous_tell_pores(const bw_comm *comm, const porous_config *q, int64_t n,
                            const int32_t site[], bw_case *run) BW_MUST_CHECK;
