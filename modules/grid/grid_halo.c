/* Halo update, direction by direction.
 *
 * Update goes x, y, z and each step takes along what the earlier ones filled, so edges and
 * corners arrive without diagonal messages. A step covers in the later directions the interior plus
 * ghosts beyond a physical boundary: those are values like any other, and a halo cell over the edge
 * of a block and of the box is its neighbour's ghost. */
#include "bw_memory.h"
#include "bw_message.h"
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

static void pack_fields(const bw_grid_view *v, int d, int side, int count, bw_real *const field[],
                        bw_real *to)
{
  const box b = owned_layers(v, d, side);
  for (int q = 0; q < count; q++)
    to = pack(v, &b, field[q], to);
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

/* Bytes of what `count` fields send to the neighbour on one side, or receive from it; 0 without
 * one. */
static size_t bytes_across(const bw_grid *g, int d, int side, int count)
{
  const box b = owned_layers(&g->view, d, side); /* of the shape of the halo there */
  if (g->neighbour[d][side] == MPI_PROC_NULL) return 0;
  return volume(&b) * (size_t)count * sizeof(bw_real);
}

/* The tag is the side of the halo that a message fills, so that two messages between the same pair
 * of ranks cannot be confused. */
static bw_message_way way(const bw_grid *g, int tag)
{
  return (bw_message_way){g->mpi, tag, bw_comm_message_limit(g->comm)};
}

/* One message each way per neighbour, in pieces where it is longer than one can be. */
static void cross(bw_grid *g, int d, int count, bw_real *const field[])
{
  const bw_grid_view *v = &g->view;
  MPI_Request request[4];
  /* All fields behind each other are one message each way. Receives are posted before anything is
   * sent, so that no message has to wait in a buffer. */
  for (size_t piece = 0, n = 1; n > 0; piece++) {
    n = 0;
    for (int side = BELOW; side <= ABOVE; side++) {
      const bw_message_way in = way(g, side);
      n += (size_t)bw_message_receive(&in, g->neighbour[d][side], bytes_across(g, d, side, count),
                                      g->receive[side], piece, &request[n]);
    }
    for (int side = BELOW; side <= ABOVE; side++) {
      const bw_message_way out = way(g, 1 - side);
      const size_t bytes = bytes_across(g, d, side, count);
      if (piece == 0 && bytes > 0) pack_fields(v, d, side, count, field, g->send[side]);
      if (bw_message_send(&out, g->neighbour[d][side], bytes, g->send[side], piece, &request[n])) {
        bw_grid__count(&g->halo, bw_message_piece(bytes, out.limit, piece));
        n++;
      }
    }
    if (n > 0) MPI_Waitall((int)n, request, MPI_STATUSES_IGNORE);
  }
  /* All messages are here; the fields are taken apart in the order in which the neighbour put
   * them. */
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

/* The top layer of the block to the neighbour above, who takes it for the layer below its own. */
static void cross_upwards(bw_grid *g, int d, bw_real *f)
{
  const bw_grid_view *v = &g->view;
  const bw_message_way up = way(g, BELOW);
  const box top = layer(v, d, v->m[d]), below = layer(v, d, 0);
  const size_t bytes = volume(&top) * sizeof(bw_real); /* the same all along the line of blocks */
  const size_t out = g->neighbour[d][ABOVE] != MPI_PROC_NULL ? bytes : 0;
  const size_t in = g->neighbour[d][BELOW] != MPI_PROC_NULL ? bytes : 0;
  MPI_Request request[2];
  /* Beyond a physical boundary there is no neighbour: the face there belongs to the boundary
   * condition. */
  if (out > 0) pack(v, &top, f, g->send[ABOVE]);
  for (size_t piece = 0, n = 1; n > 0; piece++) {
    n = (size_t)bw_message_receive(&up, g->neighbour[d][BELOW], in, g->receive[BELOW], piece,
                                   &request[0]);
    if (bw_message_send(&up, g->neighbour[d][ABOVE], out, g->send[ABOVE], piece, &request[n])) {
      bw_grid__count(&g->halo, bw_message_piece(bytes, up.limit, piece));
      n++;
    }
    if (n > 0) MPI_Waitall((int)n, request, MPI_STATUSES_IGNORE);
  }
  if (in > 0) unpack(v, &below, g->receive[BELOW], f);
}

void bw_halo_update_faces(bw_grid *g, bw_real *const u[3])
{
  const bw_grid_view *v = &g->view;
  for (int d = 0; d < 3; d++) {
    if (v->halo[d] == 0) continue;
    /* The divergence in cell 1 reads the component on face 0, which is the top face of the
     * block below (or, where one block spans a periodic direction, its own): values travel
     * upwards only. */
    if (wrapped(v, d)) {
      const box top = layer(v, d, v->m[d]), below = layer(v, d, 0);
      copy_box(v, &top, &below, u[d]);
    }
    if (crosses(v, d)) cross_upwards(g, d, u[d]);
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
  /* Nothing is divided: no message is ever sent and no buffer needed. */
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
