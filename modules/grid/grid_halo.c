/* Halo update, direction by direction.
 *
 * Update goes x, y, z and each step takes along what the earlier ones filled, so edges and
 * corners arrive without diagonal messages. A step covers in the later directions the interior plus
 * ghosts beyond a physical boundary: those are values like any other, and a halo cell over the edge
 * of a block and of the box is its neighbour's ghost. */
#include "bw_memory.h"
#include "grid_internal.h"

#include <string.h>

enum { BELOW, ABOVE };

/* Index range of a piece of a field, both ends included. */
typedef struct {
  int lo[3], hi[3];
} box;

static bool wrapped(const bw_grid_view *v, int d)
{
  return v->ranks[d] == 1 && v->periodic[d];
}

static bool crosses(const bw_grid_view *v, int d)
{
  return v->ranks[d] > 1;
}

/* Everything a step in direction d moves along, itself aside. */
static box step_box(const bw_grid_view *v, int d)
{
  box b;
  for (int e = 0; e < 3; e++) {
    /* Directions before d are up to date already, halo included. Of the later ones only the ghosts
     * beyond a physical boundary hold a value yet: those travel along. */
    const bool ghosts_below = e < d || (v->first[e] && !v->periodic[e]);
    const bool ghosts_above = e < d || (v->last[e] && !v->periodic[e]);
    b.lo[e] = ghosts_below ? 1 - v->halo[e] : 1;
    b.hi[e] = ghosts_above ? v->m[e] + v->halo[e] : v->m[e];
  }
  return b;
}

static box owned_layers(const bw_grid_view *v, int d, int side)
{
  box b = step_box(v, d);
  b.lo[d] = side == BELOW ? 1 : v->m[d] - v->halo[d] + 1;
  b.hi[d] = side == BELOW ? v->halo[d] : v->m[d];
  return b;
}

static box halo_layers(const bw_grid_view *v, int d, int side)
{
  box b = step_box(v, d);
  b.lo[d] = side == BELOW ? 1 - v->halo[d] : v->m[d] + 1;
  b.hi[d] = side == BELOW ? 0 : v->m[d] + v->halo[d];
  return b;
}

static size_t volume(const box *b)
{
  size_t n = 1;
  for (int d = 0; d < 3; d++)
    n *= (size_t)(b->hi[d] - b->lo[d] + 1);
  return n;
}

/* The four movers work row by row; rows are contiguous. */
static bw_real *pack(const bw_grid_view *v, const box *b, const bw_real *f, bw_real *to)
{
  const size_t n = (size_t)(b->hi[0] - b->lo[0] + 1);
  for (int k = b->lo[2]; k <= b->hi[2]; k++)
    for (int j = b->lo[1]; j <= b->hi[1]; j++, to += n)
      memcpy(to, f + bw_at(v, b->lo[0], j, k), n * sizeof *to);
  return to;
}

static const bw_real *unpack(const bw_grid_view *v, const box *b, const bw_real *from, bw_real *f)
{
  const size_t n = (size_t)(b->hi[0] - b->lo[0] + 1);
  for (int k = b->lo[2]; k <= b->hi[2]; k++)
    for (int j = b->lo[1]; j <= b->hi[1]; j++, from += n)
      memcpy(f + bw_at(v, b->lo[0], j, k), from, n * sizeof *f);
  return from;
}

/* Rows of `to` become rows of `from` (boxes of one shape inside one field). */
static void copy_box(const bw_grid_view *v, const box *from, const box *to, bw_real *f)
{
  const int n = to->hi[0] - to->lo[0] + 1;
  for (int k = to->lo[2], kk = from->lo[2]; k <= to->hi[2]; k++, kk++)
    for (int j = to->lo[1], jj = from->lo[1]; j <= to->hi[1]; j++, jj++) {
      const bw_real *a = f + bw_at(v, from->lo[0], jj, kk);
      bw_real *b = f + bw_at(v, to->lo[0], j, k);
      for (int i = 0; i < n; i++)
        b[i] = a[i];
    }
}

static void wrap(const bw_grid_view *v, int d, bw_real *f)
{
  for (int side = BELOW; side <= ABOVE; side++) {
    /* A periodic direction in one block: below the first cell lies the last one, and the other way
     * round. */
    const box image = owned_layers(v, d, 1 - side), ghost = halo_layers(v, d, side);
    copy_box(v, &image, &ghost, f);
  }
}

/* One message each way per neighbour. The tag is the side of the halo it fills, so that two
 * messages between the same pair of ranks cannot be confused. */
static void cross(bw_grid *g, int d, int count, bw_real *const field[])
{
  const bw_grid_view *v = &g->view;
  MPI_Request request[4];
  int n = 0;
  for (int side = BELOW; side <= ABOVE; side++) {
    if (g->neighbour[d][side] == MPI_PROC_NULL) continue;
    const box b = halo_layers(v, d, side);
    MPI_Irecv(g->receive[side], (int)(volume(&b) * (size_t)count * sizeof(bw_real)), MPI_BYTE,
              g->neighbour[d][side], side, g->mpi, &request[n++]);
  }
  for (int side = BELOW; side <= ABOVE; side++) {
    if (g->neighbour[d][side] == MPI_PROC_NULL) continue;
    const box b = owned_layers(v, d, side);
    bw_real *to = g->send[side];
    for (int q = 0; q < count; q++)
      to = pack(v, &b, field[q], to);
    const size_t bytes = volume(&b) * (size_t)count * sizeof(bw_real);
    MPI_Isend(g->send[side], (int)bytes, MPI_BYTE, g->neighbour[d][side], 1 - side, g->mpi,
              &request[n++]);
    bw_grid__count(&g->halo, bytes);
  }
  MPI_Waitall(n, request, MPI_STATUSES_IGNORE);
  for (int side = BELOW; side <= ABOVE; side++) {
    if (g->neighbour[d][side] == MPI_PROC_NULL) continue;
    const box b = halo_layers(v, d, side);
    const bw_real *from = g->receive[side];
    for (int q = 0; q < count; q++)
      from = unpack(v, &b, from, field[q]);
  }
}

static void step(bw_grid *g, int d, int count, bw_real *const field[])
{
  /* One cell in z has no halo. */
  if (g->view.halo[d] == 0) return;
  if (crosses(&g->view, d))
    cross(g, d, count, field);
  else if (wrapped(&g->view, d))
    for (int q = 0; q < count; q++)
      wrap(&g->view, d, field[q]);
}

void bw_halo_update(bw_grid *grid, int count, bw_real *const field[])
{
  for (int start = 0; start < count; start += BW_GRID__BATCH) {
    const int n = count - start < BW_GRID__BATCH ? count - start : BW_GRID__BATCH;
    /* In this order: what x filled travels with y, what both filled with z, and corners arrive. */
    for (int d = 0; d < 3; d++)
      step(grid, d, n, field + start);
  }
}

/* One layer at index `at` of direction d, owned cells of the others. */
static box layer(const bw_grid_view *v, int d, int at)
{
  box b = {{1, 1, 1}, {v->m[0], v->m[1], v->m[2]}};
  b.lo[d] = b.hi[d] = at;
  return b;
}

void bw_halo_update_faces(bw_grid *g, bw_real *const u[3])
{
  const bw_grid_view *v = &g->view;
  for (int d = 0; d < 3; d++) {
    const box top = layer(v, d, v->m[d]), below = layer(v, d, 0);
    const size_t bytes = volume(&top) * sizeof(bw_real);
    if (v->halo[d] == 0) continue;
    if (wrapped(v, d)) copy_box(v, &top, &below, u[d]);
    if (!crosses(v, d)) continue;
    if (g->neighbour[d][ABOVE] != MPI_PROC_NULL) {
      pack(v, &top, u[d], g->send[ABOVE]);
      bw_grid__count(&g->halo, bytes);
    }
    MPI_Sendrecv(g->send[ABOVE], (int)bytes, MPI_BYTE, g->neighbour[d][ABOVE], BELOW,
                 g->receive[BELOW], (int)bytes, MPI_BYTE, g->neighbour[d][BELOW], BELOW, g->mpi,
                 MPI_STATUS_IGNORE);
    if (g->neighbour[d][BELOW] != MPI_PROC_NULL) unpack(v, &below, g->receive[BELOW], u[d]);
  }
}

size_t bw_halo_volume(const bw_grid *grid)
{
  size_t n = 0;
  for (int d = 1; d < 3; d++)
    for (int side = BELOW; side <= ABOVE; side++) {
      if (!crosses(&grid->view, d) || grid->neighbour[d][side] == MPI_PROC_NULL) continue;
      const box b = owned_layers(&grid->view, d, side);
      n += volume(&b);
    }
  return n * sizeof(bw_real);
}

static int neighbour(const bw_grid_view *v, int d, int step_)
{
  int at[3] = {0, v->coord[1], v->coord[2]};
  at[d] += step_;
  if (at[d] < 0 || at[d] >= v->ranks[d]) {
    if (!v->periodic[d]) return MPI_PROC_NULL;
    at[d] = (at[d] + v->ranks[d]) % v->ranks[d];
  }
  return at[1] + v->ranks[1] * at[2];
}

bw_status bw_grid__halo_create(bw_grid *g)
{
  size_t largest = 0;
  for (int d = 1; d < 3; d++)
    for (int side = BELOW; side <= ABOVE; side++) {
      g->neighbour[d][side] = neighbour(&g->view, d, side == BELOW ? -1 : 1);
      /* The thickest message of any direction decides the length of the buffers. */
      const box b = owned_layers(&g->view, d, side);
      if (crosses(&g->view, d) && volume(&b) > largest) largest = volume(&b);
    }
  BW_REQUIRE(largest * BW_GRID__BATCH * sizeof(bw_real) < 2147483647u, BW_EINPUT,
             "grid: a halo message of %zu cells is too long for MPI; use more ranks", largest);
  if (largest == 0) return BW_OK;
  for (int side = BELOW; side <= ABOVE; side++) {
    BW_TRY(BW_ALLOCATE(&g->send[side], largest * BW_GRID__BATCH));
    BW_TRY(BW_ALLOCATE(&g->receive[side], largest * BW_GRID__BATCH));
  }
  return BW_OK;
}

void bw_grid__halo_destroy(bw_grid *g)
{
  for (int side = BELOW; side <= ABOVE; side++) {
    bw_release(&g->send[side]);
    bw_release(&g->receive[side]);
  }
}
