/* grid_internal.h -- shared by the sources of grid only. */
#pragma once
#include "bw_comm_mpi.h"
#include "bw_grid.h"

/* Fields that travel in one message; more are sent in turns, which bounds the buffers. */
enum { BW_GRID__BATCH = 4 };

struct bw_grid {
  const bw_comm *comm;
  MPI_Comm mpi; /* duplicate of comm's: our messages never meet those of others */
  bw_grid_view view;
  double *y_face;         /* [0..n1] */
  double *y_centre_store; /* [0..n1+3]; view.y_centre points at its entry 1 (index 0) */
  int neighbour[3][2];    /* rank below and above, MPI_PROC_NULL beyond a physical boundary */
  bw_real *send[2], *receive[2]; /* one face of BW_GRID__BATCH fields each; NULL when serial */
  MPI_Comm line[3];              /* ranks of this line of blocks in y and in z; line[0] unused */
  MPI_Request *request;          /* for a swap within a line */
  bw_grid_sent halo, swap;       /* since create */
};

static inline void bw_grid__count(bw_grid_sent *sent, size_t bytes)
{
  sent->messages++;
  sent->bytes += bytes;
}

/* Cells before block c of r blocks over n cells: sizes differ by at most one, larger ones first. */
static inline int bw_grid__block_start(int n, int r, int c)
{
  const int base = n / r, extra = n % r;
  return c * base + (c < extra ? c : extra);
}

/* The cell (1..n) that contains the point x[3], periodic directions wrapped; false: none does. */
bool bw_grid__cell(const bw_grid_view *view, const double x[3], int cell[3]);

/* y: is its stretching possible; faces and centres. Local. */
bw_status bw_grid__y_check(const bw_grid_config *config);
bw_status bw_grid__y_create(bw_grid *grid, const bw_grid_config *config);

/* Neighbours and buffers of the halo exchange. Local. */
bw_status bw_grid__halo_create(bw_grid *grid);
void bw_grid__halo_destroy(bw_grid *grid);

/* Requests of the line swaps (local), and after them the communicators (collective). */
bw_status bw_grid__line_create(bw_grid *grid);
void bw_grid__line_connect(bw_grid *grid);
void bw_grid__line_destroy(bw_grid *grid);

/* Blocks in y and z (ranks[1], ranks[2] of the view) for `size` ranks. Local. */
bw_status bw_grid__divide(const bw_grid_config *config, int size, int ranks[3]);
