/* shape_tiff.h -- a TIFF file that is open, and what one of its pages holds. */
#pragma once
#include "shape_source.h"

#include <tiffio.h>

enum { BW_SHAPE__SAID = 200 }; /* bytes of what libtiff says */

/* One file. `page` counts its directories as they are gone through. */
typedef struct {
  const char *path; /* borrowed */
  TIFF *tif;
  int page;
  int64_t length;             /* of the file [bytes] */
  double most;                /* that anything in it may unpack to [bytes] */
  unsigned char *row, *block; /* one row of numbers; what libtiff reads at once */
  char said[BW_SHAPE__SAID];  /* the last error of libtiff; "": none */
} bw_shape__tiff;

/* One page: numbers of `type`, of which there may be eight in a byte (bits = 1). */
typedef struct {
  uint32_t width, height;
  uint16_t bits;
  bw_shape_voxel_type type;
} bw_shape__tiff_page;

/* Receives row j of a page, numbers in this machine's order. */
typedef void (*bw_shape__tiff_take)(void *to, int64_t j, void *row);

/* At the first page. Close it also after a failure. Local. */
bw_status bw_shape__tiff_open(const char *path, bw_shape__tiff *t) BW_MUST_CHECK;
void bw_shape__tiff_close(bw_shape__tiff *t);
/* The present page, checked against the length of the file. Local. */
bw_status bw_shape__tiff_page_of(const bw_shape__tiff *t, bw_shape__tiff_page *p) BW_MUST_CHECK;
/* All rows of the present page. Local. */
bw_status bw_shape__tiff_rows(bw_shape__tiff *t, const bw_shape__tiff_page *p,
                              bw_shape__tiff_take take, void *to) BW_MUST_CHECK;
