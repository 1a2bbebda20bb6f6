/* bw_shape_mask.h -- bodies from files: voxel images and closed surfaces of triangles.
 *
 * A mask says for every cell of a box of cells whether it is solid; as a shape (BW_SHAPE_MASK) it
 * is added and removed like any other, and holds the sites whose centre lies in a solid cell. In 2D
 * its first layer counts. Files that are not what they say are refused by name, with what was
 * found.
 *
 * Memory   one byte a cell. An image that is opened (`open`) holds nothing until it is asked:
 *          bw_shape_fill then reads the layers in z that its part meets, so that the memory of a
 *          rank, and what it reads, falls with the number of ranks. An image that is read (`read`)
 *          and every surface are held whole by each rank that reads them: a surface is filled by
 *          the parity of crossings, which needs all of its triangles.
 * Life     open or read -> bw_shape with .mask -> destroy, after the last fill that uses it. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_shape_source bw_shape_source; /* the file of an open mask; opaque */

/* `lower` and `spacing` may be changed before the first use: that moves and scales the body. */
typedef struct {
  int64_t size[3];         /* cells */
  double lower[3];         /* corner of the first cell [L] */
  double spacing[3];       /* size of a cell [L] */
  int64_t first, held;     /* layers in z that are held: first <= k < first + held */
  uint8_t *solid;          /* (held, size[1], size[0]), x fastest; 0: empty */
  bw_shape_source *source; /* where other layers are read from; NULL: all layers are held */
} bw_shape_mask;

/* Free *mask and what it holds, and set it to NULL; NULL is fine. Local. */
void bw_shape_mask_destroy(bw_shape_mask **mask);

/* Is x (dims; [L]) in a solid cell? Outside the box: no. The layer of x has to be held. Local. */
bool bw_shape_mask_at(const bw_shape_mask *mask, int dims, const double x[3]);

/* Hold the layers first <= k < first + layers in place of those held before. Layers already held
 * are not read again when all that is asked is there. BW_EINPUT for layers that the mask does not
 * have, BW_EIO, BW_EMEM. Local. */
bw_status bw_shape_mask_hold(bw_shape_mask *mask, int64_t first, int64_t layers) BW_MUST_CHECK;

/* Types of a voxel's number: whole without and with sign, floating; 8 to 64 bits. */
typedef enum {
  BW_SHAPE_VOXEL_U8,
  BW_SHAPE_VOXEL_I8,
  BW_SHAPE_VOXEL_U16,
  BW_SHAPE_VOXEL_I16,
  BW_SHAPE_VOXEL_U32,
  BW_SHAPE_VOXEL_I32,
  BW_SHAPE_VOXEL_F32,
  BW_SHAPE_VOXEL_F64,
  BW_SHAPE_VOXEL_COUNT /* how many there are */
} bw_shape_voxel_type;

/* What a header says of the numbers in a file, x fastest. */
typedef struct {
  bw_shape_voxel_type type; /* of a number */
  bool big_endian;          /* false: the first byte of a number is the least */
  int64_t size[3];          /* voxels; 2D: size[2] = 1 */
  double lower[3];          /* corner of the first voxel [L] */
  double spacing[3];        /* size of a voxel [L] */
  int64_t skip;             /* bytes before the numbers */
} bw_shape_voxels;

/* Voxels whose value v has low <= v <= high are solid. The file must be exactly as long as the
 * layout says (bytes after the last voxel too are an error). BW_EINPUT, BW_EIO, BW_EMEM name the
 * file. *out is the caller's. `open` holds no layer, `read` all of them. Local. */
bw_status bw_shape_mask_open_raw(const char *path, const bw_shape_voxels *layout, double low,
                                 double high, bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape_mask_read_raw(const char *path, const bw_shape_voxels *layout, double low,
                                 double high, bw_shape_mask **out) BW_MUST_CHECK;

/* The same from a NRRD (.nrrd, or .nhdr with a data file) or MetaImage (.mhd with a data file,
 * .mha): raw encoding, axes along x, y, z, one number per voxel. Both formats give the centre of
 * the first voxel as the origin. Data files are looked for beside the header. Local. */
bw_status bw_shape_mask_open_image(const char *path, double low, double high,
                                   bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape_mask_read_image(const char *path, double low, double high,
                                   bw_shape_mask **out) BW_MUST_CHECK;

/* Cells of size `spacing` [L] whose centre is inside the closed surface of an STL file (binary or
 * text; its lengths times `scale` are [L]), by the parity of crossings along x. A surface with
 * holes is refused: a ray that crosses it an odd number of times is named. BW_EINPUT, BW_EIO,
 * BW_EMEM name the file. *out is the caller's. Every rank that calls holds the triangles while it
 * reads (36 bytes each) and all cells. Local. */
bw_status bw_shape_mask_read_stl(const char *path, double scale, double spacing,
                                 bw_shape_mask **out) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
