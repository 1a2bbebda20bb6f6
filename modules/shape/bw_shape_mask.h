/* bw_shape_mask.h -- bodies from files: voxel images and closed surfaces of triangles.
 *
 * A mask says for every cell of a box of cells whether it is solid; as a shape (BW_SHAPE_MASK) it
 * is added and removed like any other, and holds the sites whose centre lies in a solid cell. In 2D
 * its first layer counts. Files that are not what they say are refused by name, with what was
 * found. Every rank that calls reads the file. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
  int64_t size[3];             /* cells */
  double lower[3], spacing[3]; /* corner of the first cell, size of a cell [L] */
  uint8_t *solid;              /* (size[2], size[1], size[0]), x fastest */
} bw_shape_mask;
void bw_shape_mask_destroy(bw_shape_mask **mask); /* NULL is fine. Local. */
bool bw_shape_mask_at(const bw_shape_mask *mask, int dims, const double x[3]); /* Local. */

typedef enum {
  BW_SHAPE_VOXEL_U8,
  BW_SHAPE_VOXEL_I8,
  BW_SHAPE_VOXEL_U16,
  BW_SHAPE_VOXEL_I16,
  BW_SHAPE_VOXEL_U32,
  BW_SHAPE_VOXEL_I32,
  BW_SHAPE_VOXEL_F32,
  BW_SHAPE_VOXEL_F64,
  BW_SHAPE_VOXEL_COUNT
} bw_shape_voxel_type;

/* What a header says of the numbers in a file, x fastest. */
typedef struct {
  bw_shape_voxel_type type;
  bool big_endian;
  int64_t size[3];             /* voxels; 2D: size[2] = 1 */
  double lower[3], spacing[3]; /* corner of the first voxel, size of a voxel [L] */
  int64_t skip;                /* bytes before the numbers */
} bw_shape_voxels;

/* Voxels whose value v has low <= v <= high are solid. The file must be exactly as long as the
 * layout says (bytes after the last voxel too are an error). BW_EINPUT, BW_EIO, BW_EMEM name the
 * file. *out is the caller's. Local. */
bw_status bw_shape_mask_read_raw(const char *path, const bw_shape_voxels *layout, double low,
                                 double high, bw_shape_mask **out) BW_MUST_CHECK;

/* The same from a NRRD (.nrrd, or .nhdr with a data file) or MetaImage (.mhd with a data file,
 * .mha): raw encoding, axes along x, y, z, one number per voxel. Both formats give the centre of
 * the first voxel as the origin. Data files are looked for beside the header. */
bw_status bw_shape_mask_read_image(const char *path, double low, double high,
                                   bw_shape_mask **out) BW_MUST_CHECK;

/* Cells of size `spacing` whose centre is inside the closed surface of an STL file (binary or text;
 * lengths times `scale`), by the parity of crossings along x. A surface with holes is refused: a
 * ray that crosses it an odd number of times is named. */
bw_status bw_shape_mask_read_stl(const char *path, double scale, double spacing,
                                 bw_shape_mask **out) BW_MUST_CHECK;
