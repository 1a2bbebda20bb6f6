/* bw_shape.h -- which sites of a lattice are solid: shapes, their unions and differences.
 *
 * A body is a list of shapes applied in order: `add` or `remove`. The lattice sites whose centre
 * lies inside are particles: half-open in a box (lower <= x < upper, so that n ds hold n sites),
 * the surface included in balls; ties within 1e-9 do not depend on rounding. The last shape that
 * holds a site decides, also on its particle kind and group. An endless shape that is added ends
 * where the other added ones end; if none of them does, where it is cut to a shape (a shape removed
 * with `outside`). An extension is one row in the table of shape_table.c.
 * Pore lattices (simple cubic, body-centred, face-centred) are overlapping spherical pores of
 * `radius` on a lattice of `pitch` anchored at `centre`.
 *
 * Lattice  site (i,j,k) has its centre at origin + (i+1/2) ds a0 + (j+1/2) ds a1 + (k+1/2) ds a2,
 *          where a0, a1, a2 are the rows of `axes`. Every body has a lattice of its own.
 * Parts    nobody has to hold the whole body. The rows (sites along i) of the range of sites that
 *          the body may occupy are numbered with j before k; part p of P is a contiguous piece of
 *          them, and memory is in proportion to that piece. The lists of all parts, joined in
 *          order, are the list of the whole: same sites, same order, for any P. The number of a
 *          site in the joined list is the global id of its particle; the first one of a rank is
 *          bw_comm_prefix_sum of what it holds.
 * Planar   only sites with k = 0 exist, z of all shapes is ignored, and turns are about z.
 * Errors   BW_EINPUT names the shape by its number, the value and the remedy; outputs then are
 *          NULL and zero.
 * Units    any one unit of length [L] throughout. */
#pragma once
#include "bw_shape_mask.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_comm bw_comm; /* bw_comm.h */

/* The kinds of shapes, and which members of bw_shape each one reads. */
typedef enum {
  BW_SHAPE_BOX,       /* lower, upper */
  BW_SHAPE_SPHERE,    /* centre, radius */
  BW_SHAPE_CYLINDER,  /* centre, radius, axis (0, 1, 2), endless */
  BW_SHAPE_PORES_SC,  /* centre (of one pore), radius, pitch: simple cubic */
  BW_SHAPE_PORES_BCC, /* the same, body-centred cubic */
  BW_SHAPE_PORES_FCC, /* the same, face-centred cubic */
  BW_SHAPE_MASK,      /* mask: a voxel image or a closed surface, see bw_shape_mask.h */
  BW_SHAPE_COUNT      /* how many there are */
} bw_shape_kind;

/* A frame in which shapes are given: that of a body which has been turned. The point x of space is
 * at y = about + axes (x - about) in it; rows of `axes` are the directions of the frame in space,
 * orthonormal and right-handed to 1e-9 (bw_shape_turn makes them). */
typedef struct {
  double axes[3][3]; /* [-] */
  double about[3];   /* the point that the turn leaves where it is [L] */
} bw_shape_frame;

/* One shape. Members that its kind does not read are ignored; zero is the default of all. */
typedef struct {
  bw_shape_kind kind;          /* which of the members below it reads */
  bool remove;                 /* false: add */
  bool outside;                /* all of space but the shape: removed, it cuts to the shape */
  double lower[3], upper[3];   /* corners of a box [L] */
  double centre[3];            /* [L] */
  double radius, pitch;        /* [L] */
  int axis;                    /* of a cylinder: 0, 1, 2 for x, y, z */
  bw_shape_mask *mask;         /* borrowed; filling lets an open mask read the layers it needs */
  const bw_shape_frame *frame; /* borrowed; NULL: x, y, z */
  uint8_t particle_kind;       /* what the solid calls the sites that it adds: held, ... */
  uint8_t particle_group;      /* material group of the sites that it adds */
} bw_shape;

/* The lattice of one body. */
typedef struct {
  double ds;         /* spacing [L] */
  double origin[3];  /* corner of site (0,0,0) [L] */
  double axes[3][3]; /* rows: its directions, orthonormal and right-handed; all zero: x, y, z */
  bool planar;       /* true: one layer of sites, k = 0 */
} bw_shape_lattice;

/* The word for a kind that case files use: "pores_sc"; "unknown" beyond the table. Local. */
const char *bw_shape_name(bw_shape_kind kind);

/* The lattice along x, y, z with this spacing [L] and origin (3) [L]. Local. */
bw_shape_lattice bw_shape_lattice_straight(double ds, const double origin[3], bool planar);

/* Rows of `axes` (3,3): x, y and z turned by `angle` [rad] about the direction `axis` (3) (any
 * length but zero, else the axes are NaN and refused later), right-handed. Local. */
void bw_shape_turn(const double axis[3], double angle, double axes[3][3]);

/* The sites that a body may occupy, from its shapes alone: lo[d] <= site[d] < hi[d]. Needs no
 * memory and no time that grows with the body. BW_EINPUT for an invalid shape or lattice, for a
 * body that is endless in some direction, for sites that do not fit into 32 bits each and for
 * 2^63 sites or more in all. Local. */
bw_status bw_shape_range(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                         int64_t lo[3], int64_t hi[3]) BW_MUST_CHECK;

/* Part `part` (0 .. parts-1) of the rows of a range: *first is the number of its first row, *rows
 * (may be 0) how many it has. Parts differ by at most one row. Local. */
void bw_shape_part(const int64_t lo[3], const int64_t hi[3], int part, int parts, int64_t *first,
                   int64_t *rows);

/* How many sites of a part are inside; allocates nothing but what masks read. Errors as
 * bw_shape_fill. Local. */
bw_status bw_shape_count(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                         int part, int parts, int64_t *n) BW_MUST_CHECK;

/* The sites of part `part` of `parts` (0, 1: the whole) inside the body, i fastest, then j, then k:
 * site (n,3), kind (n), group (n; NULL: not wanted), owned by the caller (bw_release). BW_EINPUT
 * for what bw_shape_range refuses, for a part that there is not and, when the part is the whole,
 * for an empty body. One empty part of several is no error: whether the body is empty then is a
 * question to all, which bw_shape_fill_shared asks. BW_EMEM, BW_EIO (images). Local. */
bw_status bw_shape_fill(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                        int part, int parts, int64_t *n, int32_t **site, uint8_t **kind,
                        uint8_t **group) BW_MUST_CHECK;

/* The same with one part for each rank of `comm`, all with the same shapes and lattice. Parts are
 * cut between rows so that each holds about the same number of particles, whatever the body: more
 * than one row apart they differ only where rows are longer than a part. An empty body is refused
 * on all ranks; any error is returned by all of them. Collective. */
bw_status bw_shape_fill_shared(const bw_comm *comm, int count, const bw_shape shape[],
                               const bw_shape_lattice *lattice, int64_t *n, int32_t **site,
                               uint8_t **kind, uint8_t **group) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
