/* Points of any rank into the cells that hold them. */
#include "bw_exchange.h"
#include "bw_memory.h"
#include "grid_internal.h"

/* What a cell is told: which one it is, and its value. */
typedef struct {
  int cell[3];
  double value;
} mark;

bw_status bw_grid_mark(const bw_grid *grid, size_t n, const double x[], const double value[],
                       bw_real *field)
{
  const bw_grid_view *v = &grid->view;
  mark *send = NULL, *receive = NULL;
  int *owner = NULL;
  bw_exchange *plan = NULL;
  size_t sent = 0;
  bw_status st = BW_ALLOCATE(&send, n);
  BW_THEN(st, BW_ALLOCATE(&owner, n));
  for (size_t i = 0; st == BW_OK && i < n; i++) {
    /* In two dimensions no point is above or below. */
    const double z = v->n[2] == 1 ? 0.5 * v->length[2] : x[3 * i + 2];
    const double at[3] = {x[3 * i], x[3 * i + 1], z};
    if (!bw_grid__cell(v, at, send[sent].cell)) continue;
    send[sent].value = value != NULL ? value[i] : 1.0;
    owner[sent++] = bw_grid_owner(grid, at);
  }
  st = bw_comm_agree(grid->comm, st);
  BW_THEN(st, bw_exchange_create(grid->comm, sent, owner, &plan));
  BW_THEN(st, bw_comm_agree(grid->comm, BW_ALLOCATE(&receive, bw_exchange_received(plan))));
  if (st == BW_OK) {
    bw_exchange_forward(plan, sizeof *send, send, receive);
    /* All of them are cells of this rank. */
    for (size_t i = 0; i < bw_exchange_received(plan); i++) {
      const int *c = receive[i].cell;
      field[bw_at(v, c[0] - v->lo[0], c[1] - v->lo[1], c[2] - v->lo[2])] =
          (bw_real)receive[i].value;
    }
  }
  bw_exchange_destroy(&plan);
  bw_release(&send);
  bw_release(&receive);
  bw_release(&owner);
  return st;
}
