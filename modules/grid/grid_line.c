/* What the ranks of one row of blocks (a line through the division in y or z) exchange. */
#include "bw_memory.h"
#include "bw_message.h"
#include "grid_internal.h"

enum { TAG_SWAP = 8 };

bw_status bw_grid__line_create(bw_grid *g)
{
  const int *r = g->view.ranks;
  return BW_ALLOCATE(&g->request, 2 * (size_t)(r[1] > r[2] ? r[1] : r[2]));
}

void bw_grid__line_connect(bw_grid *g)
{
  for (int d = 1; d < 3; d++) /* rank in the line = coord[d] */
    MPI_Comm_split(g->mpi, g->view.coord[3 - d], g->view.coord[d], &g->line[d]);
}

void bw_grid__line_destroy(bw_grid *g)
{
  for (int d = 1; d < 3; d++)
    if (g->line[d] != MPI_COMM_NULL) MPI_Comm_free(&g->line[d]);
  bw_release(&g->request);
}

void bw_grid_swap(bw_grid *g, int d, const size_t send_start[], const size_t send_count[],
                  const bw_real *send, const size_t receive_start[], const size_t receive_count[],
                  bw_real *receive)
{
  const bw_grid_view *v = &g->view;
  const int r = v->ranks[d], me = v->coord[d];
  const bw_message_way way = {g->line[d], TAG_SWAP, bw_comm_message_limit(g->comm)};
  for (size_t piece = 0, n = 1; n > 0; piece++) { /* nearly always all is in the first pieces */
    n = 0;
    /* Receives first, in the order in which the partners send to this rank. */
    for (int q = 1; q < r; q++) {
      const int p = (me + r - q) % r;
      n += (size_t)bw_message_receive(&way, p, receive_count[p] * sizeof *receive,
                                      receive + receive_start[p], piece, &g->request[n]);
    }
    for (int q = 1; q < r; q++) { /* everyone starts with another partner */
      const int p = (me + q) % r;
      const size_t bytes = send_count[p] * sizeof *send;
      if (bw_message_send(&way, p, bytes, send + send_start[p], piece, &g->request[n]) == 0)
        continue;
      bw_grid__count(&g->swap, bw_message_piece(bytes, way.limit, piece));
      n++;
    }
    /* When no pieces are left `receive` is complete and `send` may be changed again. */
    if (n > 0) MPI_Waitall((int)n, g->request, MPI_STATUSES_IGNORE);
  }
}

void bw_grid_line_sum(bw_grid *g, int d, int n, double x[])
{
  if (g->view.ranks[d] > 1) MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_DOUBLE, MPI_SUM, g->line[d]);
}
