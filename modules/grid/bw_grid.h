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

BW_BEGIN_DECLS

/* A grid, its division over ranks, and the buffers of its messages. */
typedef struct bw_grid bw_grid;

/* How cells lie in y: with L = length[1], n = n[1], s = y_stretch_strength the faces are */
typedef enum {
  BW_STRETCH_NONE, /* y_j = L j/n */
  BW_STRETCH_TANH, /* y_j = L/2 (1 + tanh(s (2j/n - 1)) / tanh s): fine at both walls */
  BW_STRETCH_TABLE /* y_table; second order wants it smooth: cells side by side may differ in height
                      by the factor 4 at most */
} bw_stretch;

/* What a grid is made from; start from bw_grid_config_default. Blocks that are not given are those
 * with the least halo; of equals the ones with the fewest blocks in y. */
typedef struct {
  int n[3];                  /* cells                                        required */
  double length[3];          /* box [L], lower corner at the origin          required */
  bool periodic[3];          /* per direction; y only where it is uniform    default false */
  bw_stretch y_stretch;      /* how cells lie in y                           default none */
  double y_stretch_strength; /* s of tanh [-], above 0 and up to 10          default 1.5 */
  const double *y_table;     /* (n[1]+1) table: the faces y_0 = 0 < .. < y_n = length[1] [L]; read
                                by create, not kept */
  int halo;                  /* layers, 1 or 2 (2 where markers are)         default 1 */
  int ranks[2];              /* blocks in y and z              default 0, 0: chosen by create */
} bw_grid_config;

/* The defaults named above; lengths are NaN and cells 0, so that what is missing is an error by
 * name. Local. */
bw_grid_config bw_grid_config_default(void);

/* *y (allocated, owned by the caller: bw_release) = the n + 1 faces of a text file: numbers
 * between blanks or on lines of their own, what follows # is left out. BW_EIO when it cannot be
 * read, BW_EINPUT (file and place named) for another count, for what is no number, does not go
 * from 0 to `length`, does not increase, or jumps in height by more than the factor of bw_stretch.
 * Collective. */
bw_status bw_grid_read_table(const bw_comm *comm, const char *path, int n, double length,
                             double **y) BW_MUST_CHECK;

/* What kernels need to know; read-only, owned by the grid. Arrays of y are indexed globally:
 * y_face[0..n1] faces, y_centre[1-2..n1+2] centres with two mirrored ghosts on either side. */
typedef struct {
  int n[3], m[3], lo[3];           /* cells: of all, of this rank, before this rank's */
  int halo[3];                     /* extra layers on either side; halo[2] = 0 for n[2] == 1 */
  int ranks[3], coord[3];          /* blocks per direction (ranks[0] = 1), and this rank's */
  bool periodic[3];                /* as in the config */
  bool first[3], last[3];          /* does this rank touch the lower / upper boundary? */
  bool uniform_y;                  /* are all cells of one height? */
  double length[3];                /* of the box [L] */
  double spacing[3];               /* dx, length/n in y (exact when uniform_y), dz [L] */
  const double *y_face, *y_centre; /* [0..n1], [1-2..n1+2] [L], indexed globally */
  ptrdiff_t stride[3];             /* 1, row (padded: i = 1 is 16-byte aligned in every row), plane;
                          plane = 0 for n[2] == 1 */
  ptrdiff_t origin;                /* offset of (0,0,0): bw_at(g,0,0,0) */
  size_t size;                     /* bw_reals in one field, halos and padding included */
} bw_grid_view;

/* A grid that is only looked at: sizes, blocks and faces, checked as bw_grid_create does, with no
 * memory but for the faces in y. Nothing is created on it; destroy as usual. Collective. */
bw_status bw_grid_plan(const bw_comm *comm, const bw_grid_config *config,
                       bw_grid **out) BW_MUST_CHECK;

/* Divide the box over the ranks of `comm` (borrowed until destroy): blocks differ by at most one
 * cell per direction; rank = coord[1] + ranks[1] coord[2]. Fails with BW_EINPUT when a
 * size is not positive (n[0], n[1] >= 2), when ranks do not fit (at most n[1] x n[2], and each
 * block at least `halo` thick; the message says how many would) or the stretching is invalid.
 * Collective. */
bw_status bw_grid_create(const bw_comm *comm, const bw_grid_config *config,
                         bw_grid **out) BW_MUST_CHECK;

/* Free *grid and set it to NULL; NULL inside is fine. After everything that borrows it.
 * Collective. */
void bw_grid_destroy(bw_grid **grid);

/* The view of the grid; borrowed, valid until destroy. Local. */
const bw_grid_view *bw_grid_look(const bw_grid *grid);

/* The ranks of the grid, as given to create; borrowed. Local. */
const bw_comm *bw_grid_comm(const bw_grid *grid);

/* Index in a field of the cell (i, j, k), local: 1 - halo .. m + halo in each direction. Local. */
static inline ptrdiff_t bw_at(const bw_grid_view *g, int i, int j, int k)
{
  return g->origin + i + g->stride[1] * j + g->stride[2] * k;
}

/* Rank whose cells contain the point x[3] [L] (periodic directions wrapped); -1 when it lies
 * outside the box in a direction that is not periodic. Local. */
int bw_grid_owner(const bw_grid *grid, const double x[3]);

/* field <- value[i] in the cell that holds the point x[i] (n,3) of this rank, whichever rank the
 * cell is on; `value` NULL: 1. Other cells stay as they are, points outside the box are left out,
 * and of several points in a cell one counts. One cell deep, every z is in it. BW_EMEM.
 * Collective. */
bw_status bw_grid_mark(const bw_grid *grid, size_t n, const double x[], const double value[],
                       bw_real *field) BW_MUST_CHECK;

/* Cells before block c, 0 <= c <= ranks[d], of direction d. Local. */
int bw_grid_block_start(const bw_grid_view *view, int d, int c);

/* *out = a zeroed field of view.size reals, halos and padding included, owned by the caller
 * (bw_release). BW_EMEM. Local. */
bw_status bw_field_create(const bw_grid *grid, bw_real **out) BW_MUST_CHECK;

/* Fill the halos of `count` fields: between ranks, and over periodic directions (no message where
 * one block spans it). Halos beyond a physical boundary stay as they are. Edges and corners are
 * filled too; one that is over a physical boundary and also over a block's edge gets the
 * neighbour's ghost value, so set the physical ghosts first. field[count] as bw_field_create makes
 * them. Allocates nothing. Collective. */
void bw_halo_update(bw_grid *grid, int count, bw_real *const field[]);

/* Only what a divergence reads: the layer just below the block, u[d] in direction d (no corners;
 * u[2] may be NULL in 2D). Collective. */
void bw_halo_update_faces(bw_grid *grid, bw_real *const u[3]);

/* Bytes one bw_halo_update of one field sends to other ranks, from this rank. Local. */
size_t bw_halo_volume(const bw_grid *grid);

/* What this rank has sent to others. */
typedef struct {
  long messages; /* number of them */
  size_t bytes;  /* in all */
} bw_grid_sent;

/* Sent to other ranks by this one since create: in halos, in the swaps of solvers on lines.
 * Local. */
void bw_grid_traffic(const bw_grid *grid, bw_grid_sent *halo, bw_grid_sent *swap);

/* All-to-all among the ranks of this rank's line of blocks in direction d (1: y, 2: z), in order of
 * their coord[d]: receive[receive_start[p] ..] <- send[send_start[me] ..] of rank p. Counts are in
 * bw_reals and agree pairwise; this rank's own entries are skipped. Any number of entries; what is
 * longer than bw_comm_message_limit of the grid's communicator travels in several messages. For
 * solvers that work on lines. Collective over the line. */
void bw_grid_swap(bw_grid *grid, int d, const size_t send_start[], const size_t send_count[],
                  const bw_real *send, const size_t receive_start[], const size_t receive_count[],
                  bw_real *receive);

/* Element-wise sum of x[n] over that line of blocks, in place, on all of its ranks. Collective over
 * the line. */
void bw_grid_line_sum(bw_grid *grid, int d, int n, double x[]);

BW_END_DECLS
