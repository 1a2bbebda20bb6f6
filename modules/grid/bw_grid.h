/* bw_grid.h -- staggered Cartesian grid, its division into pencils, fields and halos.
 *
 * x streamwise, y wall-normal, z spanwise; spacing uniform in x and z, uniform or stretched
 * (tanh, or a table of faces) in y. Global cells 1..n[d]. Cell i covers ((i-1) dx, i dx); its
 * centre is at (i-1/2) dx. On the staggered grid u[i] sits on the face x = i dx between cells i and
 * i+1 (so u[0] is on the lower boundary), v and w likewise in y and z; scalars at centres.
 *
 * Decomposition: x-pencils. Every rank holds all of x and a block of y and z (ranks[1] x
 * ranks[2] blocks). Local cells 1..m[d], global index = local + lo[d], with lo[d] the number of
 * cells before this rank.
 *
 * Storage of a field: x fastest; `halo` extra layers below and above each direction (halo[2] = 0
 * when n[2] == 1, and then stride[2] = 0: k-1, k, k+1 address the same cell, so that spanwise
 * differences vanish by themselves). Use bw_at for indices: valid i is 1-halo .. m+halo.
 * Units: lengths in [L]. */
#pragma once
#include "bw_comm.h"
#include "bw_real.h"
#include <stdbool.h>

typedef struct bw_grid bw_grid;

typedef enum { BW_STRETCH_NONE, BW_STRETCH_TANH, BW_STRETCH_TABLE } bw_stretch;

typedef struct {
  int n[3];                  /* cells                                        required */
  double length[3];          /* box [L], lower corner at the origin          required */
  bool periodic[3];          /*                                              default false */
  bw_stretch y_stretch;      /*                                           default none */
  double y_stretch_strength; /* tanh parameter [-], > 0              default 1.5 */
  const double *y_table;     /* table: the faces y_0 = 0 < .. < y_n = length [L]; read by create */
  int halo;                  /* layers, 1 or 2 (2 where markers are)         default 1 */
  int ranks[2];              /* blocks in y and z; 0,0: chosen for the least halo */
} bw_grid_config;

bw_grid_config bw_grid_config_default(void);

/* y faces: L j/n, or L/2 (1 + tanh(s (2j/n - 1)) / tanh s) with s = y_stretch_strength (<= 10), or
 * a table, which for second order has to be smooth: neighbouring cells may differ by the factor 4
 * in height at most. */

/* *y (allocated, owned by the caller: bw_release) = the n + 1 faces of a text file: numbers
 * between blanks or on lines of their own, what follows # is left out. BW_EIO when it cannot be
 * read, BW_EINPUT (file and place named) for another count, for what is no number, does not go
 * from 0 to `length`, does not increase, or jumps in height by more than that factor. Collective.
 */
bw_status bw_grid_read_table(const bw_comm *comm, const char *path, int n, double length,
                             double **y) BW_MUST_CHECK;

/* What kernels need to know; read-only, owned by the grid. Arrays of y are indexed globally:
 * y_face[0..n1] faces, y_centre[1-2..n1+2] centres with two mirrored ghosts on either side. */
typedef struct {
  int n[3], m[3], lo[3], halo[3]; /* halo[2] = 0 for n[2] == 1 */
  int ranks[3], coord[3];         /* blocks per direction (ranks[0] = 1), and this rank's */
  bool periodic[3];
  bool first[3], last[3]; /* does this rank touch the lower / upper boundary? */
  bool uniform_y;
  double length[3];
  double spacing[3]; /* dx, length/n in y (exact when uniform_y), dz [L] */
  const double *y_face, *y_centre;
  ptrdiff_t stride[3]; /* 1, row (padded: i = 1 is 16-byte aligned in every row), plane;
                          plane = 0 for n[2] == 1 */
  ptrdiff_t origin;    /* offset of (0,0,0): bw_at(g,0,0,0) */
  size_t size;         /* bw_reals in one field, halos and padding included */
} bw_grid_view;

/* Divide the box over the ranks of `comm` (borrowed until destroy): blocks differ by at most one
 * cell per direction; rank = coord[1] + ranks[1] coord[2]. Fails with BW_EINPUT when a
 * size is not positive (n[0], n[1] >= 2), when ranks do not fit (at most n[1] x n[2], and each
 * block at least `halo` thick; the message says how many would) or the stretching is invalid.
 * Collective. */
bw_status bw_grid_create(const bw_comm *comm, const bw_grid_config *config,
                         bw_grid **out) BW_MUST_CHECK;
void bw_grid_destroy(bw_grid **grid); /* NULL is fine. Collective. */

const bw_grid_view *bw_grid_look(const bw_grid *grid); /* borrowed. Local. */
const bw_comm *bw_grid_comm(const bw_grid *grid);      /* borrowed. Local. */

static inline ptrdiff_t bw_at(const bw_grid_view *g, int i, int j, int k)
{
  return g->origin + i + g->stride[1] * j + g->stride[2] * k;
}

/* Rank whose cells contain the point x[3] [L] (periodic directions wrapped); -1 when it lies
 * outside the box in a direction that is not periodic. Local. */
int bw_grid_owner(const bw_grid *grid, const double x[3]);

/* Cells before block c, 0 <= c <= ranks[d], of direction d. Local. */
int bw_grid_block_start(const bw_grid_view *view, int d, int c);

/* A zeroed field with halos; free with bw_release. Local. */
bw_status bw_field_create(const bw_grid *grid, bw_real **out) BW_MUST_CHECK;

/* Fill the halos of `count` fields: between ranks, and over periodic directions (no message where
 * one block spans it). Halos beyond a physical boundary stay as they are. Edges and corners are
 * filled too; one that is over a physical boundary and also over a block's edge gets the
 * neighbour's ghost value, so set the physical ghosts first. Allocates nothing. Collective. */
void bw_halo_update(bw_grid *grid, int count, bw_real *const field[]);

/* Only what a divergence reads: the layer just below the block, u[d] in direction d (no corners;
 * u[2] may be NULL in 2D). Collective. */
void bw_halo_update_faces(bw_grid *grid, bw_real *const u[3]);

/* Bytes one bw_halo_update of one field sends to other ranks, from this rank. Local. */
size_t bw_halo_volume(const bw_grid *grid);

/* Sent to other ranks by this one since create: in halos, in the swaps of solvers on lines. Local.
 */
typedef struct {
  long messages;
  size_t bytes;
} bw_grid_sent;
void bw_grid_traffic(const bw_grid *grid, bw_grid_sent *halo, bw_grid_sent *swap);

/* All-to-all among the ranks of this rank's line of blocks in direction d (1: y, 2: z), in order of
 * their coord[d]: receive[receive_start[p] ..] <- send[send_start[me] ..] of rank p. Counts are in
 * bw_reals and agree pairwise; this rank's own entries are skipped. Any number of entries; what is
 * longer than bw_comm_message_limit of the grid's communicator travels in several messages. For
 * solvers that work on lines. Collective over the line. */
void bw_grid_swap(bw_grid *grid, int d, const size_t send_start[], const size_t send_count[],
                  const bw_real *send, const size_t receive_start[], const size_t receive_count[],
                  bw_real *receive);

/* Element-wise sum over that line, in place, on all of its ranks. Collective over the line. */
void bw_grid_line_sum(bw_grid *grid, int d, int n, double x[]);
