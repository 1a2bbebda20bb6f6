/* bw_shape_mask.h -- bodies from files: voxel images and closed surfaces of triangles.
 *
 * A mask says for every cell of a box of cells whether it is solid; as a shape (BW_SHAPE_MASK) it
 * is added and removed like any other, and holds the sites whose centre lies in a solid cell. In 2D
 * its first layer counts. Files that are not what they say are refused by name, with what was
 * found; what cannot be opened, with the system's reason.
 *
 * Memory   one byte a cell. A mask that is opened (`open`) holds nothing until it is asked:
 *          bw_shape_fill then reads the layers in z that its part meets, so that the memory of a
 *          rank, and what it reads, falls with the number of ranks. A mask that is read (`read`) is
 *          held whole by each rank that reads it. Before anything is allocated the size that a
 *          header claims is compared with that of the file; packed numbers are unpacked once
 *          without being kept. A surface holds its triangles, 88 bytes each, on every rank.
 * Surfaces the winding number decides: how often the surface encloses the point, +1 for each body
 *          whose facets turn counterclockwise seen from outside. Bodies that touch or overlap are
 *          their union, a surface that points inwards within another one is a cavity. A surface
 *          that is inside out as a whole is turned. A point on a face is inside where the face is a
 *          lower one along x, y and z and outside where it is an upper one, as in a box.
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
typedef struct bw_shape_field bw_shape_field;   /* distances of a surface; opaque */

/* What a file said about itself. */
typedef struct {
  const char *format; /* "NRRD", "MetaImage", "TIFF", "npy", "raw", "STL"; static */
  bool has_spacing;   /* false: it says nothing of the size of a voxel, `spacing` is 1 */
  double unit;        /* its unit of length [m], by which `spacing` and `lower` are in metres; NaN:
                       * it names none, and they are its own numbers */
  double length[3];   /* of the box of a surface [L]; 0: an image's is that of its cells */
  uint32_t turned;    /* facets of a surface that pointed to the other side than those around them
                       * and have been turned */
  bool inside_out;    /* a surface is, all of it; known once a layer has been held */
  char not_read[192]; /* keys of its header that mean nothing here, with commas; "": none */
} bw_shape_about;

/* `lower` and `spacing` may be changed before the first use: that moves and scales the body. */
typedef struct {
  int64_t size[3];         /* cells */
  double lower[3];         /* corner of the first cell [L] */
  double spacing[3];       /* size of a cell [L] */
  int64_t first, held;     /* layers in z that are held: first <= k < first + held */
  uint8_t *solid;          /* (held, size[1], size[0]), x fastest; 0: empty */
  bw_shape_source *source; /* where other layers are read from; NULL: all layers are held */
  bw_shape_field *surface; /* where bw_shape_mask_find_surface has found it; else NULL */
  bw_shape_about about;    /* what the file said */
} bw_shape_mask;

/* Free *mask and what it holds, and set it to NULL; NULL is fine. Local. */
void bw_shape_mask_destroy(bw_shape_mask **mask);

/* Is x (dims; [L]) in a solid cell? Outside the box: no. The layer of x has to be held. Local. */
bool bw_shape_mask_at(const bw_shape_mask *mask, int dims, const double x[3]);

/* Hold the layers first <= k < first + layers in place of those held before. Layers already held
 * are not read again when all that is asked is there. BW_EINPUT for layers that the mask does not
 * have, BW_EIO, BW_EMEM. Local. */
bw_status bw_shape_mask_hold(bw_shape_mask *mask, int64_t first, int64_t layers) BW_MUST_CHECK;

/* Of an open mask only the cells from[d] <= cell[d] < to[d] (3 each) are left; `lower` moves with
 * the first of them. BW_EINPUT for cells that it does not have, and for a mask without a file.
 * Local. */
bw_status bw_shape_mask_crop(bw_shape_mask *mask, const int64_t from[3],
                             const int64_t to[3]) BW_MUST_CHECK;

/* The first cell of an open mask along `axis` (0, 1, 2) becomes its last; the box stays where it
 * is. BW_EINPUT for a mask without a file. Local. */
bw_status bw_shape_mask_flip(bw_shape_mask *mask, int axis) BW_MUST_CHECK;

/* Cells of an open mask become blocks of factor[d] >= 1 of them, solid where at least half of them
 * are; at the upper ends what makes no whole block is left out. So an image is brought to the
 * spacing of the particles, where taking the voxel at each centre would miss what lies between.
 * Crop and flip first. BW_EINPUT for a factor that is none or longer than the mask, for a mask
 * without a file, or coarsened before. Local. */
bw_status bw_shape_mask_coarsen(bw_shape_mask *mask, const int factor[3]) BW_MUST_CHECK;

/* The surface of the body that the voxels are, for bw_shape_surface.h: a smooth one, which holds
 * as much as they do; planes and spheres come out to a tenth of a voxel, edges are rounded by
 * one. All layers are held, with 29 bytes a voxel while it is found and 5 after; `lower` and
 * `spacing` may not be changed any more. planar: of a mask of one layer, in two dimensions.
 * BW_EINPUT where voxels tell no surface: none are solid, pieces that do not touch, most of it
 * fewer than about four voxels thick, more than 1e8 of them; BW_EIO, BW_EMEM. Local. */
bw_status bw_shape_mask_find_surface(bw_shape_mask *mask, bool planar) BW_MUST_CHECK;

/* The solid of a mask. */
typedef struct {
  double volume; /* of its solid cells [L^3] */
  double inside; /* of that, the part in the box that was asked about [L^3] */
} bw_shape_solid;

/* The solid of the layers first <= k < first + layers, and how much of it lies in the box between
 * the corners lower and upper (3 each; [L]); cells that the box cuts count by their part. Layers
 * are held a few at a time. Sums over ranks that look at different layers are the whole. Errors as
 * bw_shape_mask_hold. Local. */
bw_status bw_shape_mask_measure(bw_shape_mask *mask, int64_t first, int64_t layers,
                                const double lower[3], const double upper[3],
                                bw_shape_solid *solid) BW_MUST_CHECK;

/* Types of a voxel's number: whole without and with sign, floating; 8 to 64 bits. */
typedef enum {
  BW_SHAPE_VOXEL_U8,
  BW_SHAPE_VOXEL_I8,
  BW_SHAPE_VOXEL_U16,
  BW_SHAPE_VOXEL_I16,
  BW_SHAPE_VOXEL_U32,
  BW_SHAPE_VOXEL_I32,
  BW_SHAPE_VOXEL_U64,
  BW_SHAPE_VOXEL_I64,
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

/* The same from a file that says itself how it is laid out, one number per voxel:
 * - NRRD (.nrrd, or .nhdr with a data file) and MetaImage (.mhd with a data file, .mha), as they
 *   are or packed by gzip; axes along x, y, z or against them. Both give the centre of the first
 *   voxel as the origin. Data files are looked for beside the header;
 * - TIFF, one layer a page; or a folder of TIFF files, or a pattern of the shell that they match
 *   ("slices/ct_*.tif"), one a layer in the order of the numbers in their names. Sizes are those of
 *   ImageJ or OME where they are written. Values are as stored, also where 0 is shown as white;
 * - npy, an array of NumPy indexed [z, y, x] in C's order.
 * Local. */
bw_status bw_shape_mask_open_image(const char *path, double low, double high,
                                   bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape_mask_read_image(const char *path, double low, double high,
                                   bw_shape_mask **out) BW_MUST_CHECK;

/* How a surface is put on a lattice of cells. */
typedef struct {
  double scale;     /* a unit of length of the file [L]                       required */
  double spacing;   /* edge of a cell [L]                                     required */
  double origin[3]; /* a corner of a cell [L]                                 default 0 */
  bool placed;      /* the body is moved ...                                  default false */
  double at[3];     /* ... so that the lower corner of its box is here [L] */
} bw_shape_surface_config;

/* Defaults; what is required is NaN and refused by name where it stays so. Local. */
bw_shape_surface_config bw_shape_surface_config_default(void);

/* Cells whose centre is inside the closed surface of an STL file, binary or text. Each edge has to
 * belong to as many facets that run along it as against it, in pieces where it is cut: what is open
 * is refused with an edge. Facets that point to the other side than those around them are turned; a
 * part that is inside out and outside of every other is refused. BW_EINPUT, BW_EIO, BW_EMEM name
 * the file. *out is the caller's. Local. */
bw_status bw_shape_mask_open_stl(const char *path, const bw_shape_surface_config *config,
                                 bw_shape_mask **out) BW_MUST_CHECK;
/* The same where all is held, on the lattice of origin 0, the body where the file puts it. Local.
 */
bw_status bw_shape_mask_read_stl(const char *path, double scale, double spacing,
                                 bw_shape_mask **out) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
