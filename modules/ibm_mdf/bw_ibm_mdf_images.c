/* Images: every block gets the force of each marker whose support reaches its cells or its halo,
 * and spreads it itself. Nothing that was spread has to travel, and halos stay what their owners
 * have. */
#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>

/* A support reaches the layers 1-halo..size+halo of a block when its place in cells from there lies
 * in (-BELOW, size + ABOVE): nodes within `radius` of s (faces) and s + 1/2 (centres). */
static double reach_below(const bw_ibm_mdf *ib, int d)
{
  return ib->g->halo[d] + ib->kernel->radius - 0.5;
}

static double reach_above(const bw_ibm_mdf *ib, int d)
{
  return ib->g->halo[d] + ib->kernel->radius;
}

/* Blocks are at least as thick as the halo, so that two further ones on either side are enough. */
static void find_line(const bw_ibm_mdf *ib, int d, bw_ibm_mdf__blocks *b)
{
  static const int steps[IBM_BLOCKS] = {0, -1, 1, -2, 2};
  const bw_grid_view *g = ib->g;
  const int ranks = g->ranks[d];
  *b = (bw_ibm_mdf__blocks){.low = -HUGE_VAL, .high = HUGE_VAL};
  /* This block first, then its neighbours in turn. */
  for (int q = 0; q < IBM_BLOCKS; q++) {
    const int at = g->coord[d] + steps[q], turns = (at + 2 * ranks) / ranks - 2;
    /* Beyond the end of the line: a periodic image, or nothing. */
    if (turns != 0 && (!g->periodic[d] || g->halo[d] == 0)) continue;
    const int c = at - turns * ranks, start = bw_grid_block_start(g, d, c);
    const int size = bw_grid_block_start(g, d, c + 1) - start;
    b->coord[b->n] = c;
    /* Where the block begins as seen from this one, with the turns around the period. */
    b->start[b->n] = start + turns * g->n[d] - g->lo[d];
    b->size[b->n] = size;
    /* Between low and high no other block is reached: most markers need no further test. */
    if (steps[q] < 0) b->low = fmax(b->low, b->start[b->n] + size + reach_above(ib, d));
    if (steps[q] > 0) b->high = fmin(b->high, b->start[b->n] - reach_below(ib, d));
    b->n++;
  }
}

void bw_ibm_mdf__find_blocks(bw_ibm_mdf *ib)
{
  for (int d = 0; d < 3; d++)
    find_line(ib, d, &ib->blocks[d]);
}

/* Bit q: block q of the line is reached from s. */
static unsigned reached(const bw_ibm_mdf *ib, int d, double s)
{
  const bw_ibm_mdf__blocks *b = &ib->blocks[d];
  unsigned bits = 1;
  /* Far from every other block. */
  if (s >= b->low && s <= b->high) return bits;
  for (int q = 1; q < b->n; q++) {
    const double there = s - b->start[q];
    if (there > -reach_below(ib, d) && there < b->size[q] + reach_above(ib, d)) bits |= 1u << q;
  }
  return bits;
}

/* One image of marker m, the q-th of all; those beyond the room are counted only. */
static void cast_one(bw_ibm_mdf *ib, unsigned m, const double s[3], const int at[3], size_t q,
                     bool *changed)
{
  const bw_ibm_mdf__blocks *b = ib->blocks;
  const int rank = b[1].coord[at[1]] + ib->g->ranks[1] * b[2].coord[at[2]];
  /* A new image, or one that goes to another rank than before, asks for a new plan. */
  *changed |= q >= ib->cast;
  if (q >= ib->cast_room) return;
  *changed |= ib->cast_to[q] != rank;
  ib->cast_to[q] = rank;
  ib->cast_from[q] = m;
  /* The place is handed over in the numbering of the block that gets it. */
  for (int d = 0; d < 3; d++)
    ib->cast_item[q].s[d] = s[d] - b[d].start[at[d]];
}

/* Images of marker m, the first of them the q-th of all; returns the number after the last. */
static size_t cast_marker(bw_ibm_mdf *ib, unsigned m, size_t q, bool *changed)
{
  const double *s = ib->place[m].s;
  unsigned bits[3];
  for (int d = 0; d < 3; d++)
    bits[d] = reached(ib, d, s[d]);
  /* Only its own block: no image. */
  if (bits[0] == 1 && bits[1] == 1 && bits[2] == 1) return q;
  int at[3];
  /* Every combination of reached blocks in x, y and z but the marker's own. */
  for (at[2] = 0; bits[2] >> at[2] != 0; at[2]++)
    for (at[1] = 0; bits[1] >> at[1] != 0; at[1]++)
      for (at[0] = 0; bits[0] >> at[0] != 0; at[0]++) {
        if ((bits[0] >> at[0] & bits[1] >> at[1] & bits[2] >> at[2] & 1u) == 0) continue;
        if (at[0] + at[1] + at[2] > 0) cast_one(ib, m, s, at, q++, changed);
      }
  return q;
}

static size_t cast_all(bw_ibm_mdf *ib, bool *changed)
{
  size_t n = 0;
  for (unsigned m = 0; m < ib->held; m++)
    n = cast_marker(ib, m, n, changed);
  *changed |= n != ib->cast;
  return n;
}

static bw_status reserve_cast(bw_ibm_mdf *ib, size_t n)
{
  const size_t some = n + n / 8; /* markers come and go */
  ib->cast = ib->cast_room = 0;  /* stays so if an allocation fails */
  IBM_RENEW(&ib->cast_from, some);
  IBM_RENEW(&ib->cast_to, some);
  IBM_RENEW(&ib->cast_item, some);
  IBM_RENEW(&ib->cast_F, 3 * some);
  ib->cast_room = some;
  return BW_OK;
}

static bw_status reserve_stencils(bw_ibm_mdf *ib, size_t n)
{
  if (n <= ib->stencil_room) return BW_OK;
  const size_t some = n + n / 8;
  ib->stencil_room = 0;
  IBM_RENEW(&ib->image, some);
  IBM_RENEW(&ib->weights, some);
  IBM_RENEW(&ib->nodes, some + IBM_AHEAD);
  IBM_RENEW(&ib->U, 3 * some);
  ib->stencil_room = some;
  return BW_OK;
}

/* A new plan for `n` images of the markers held here. Collective. */
static bw_status plan_images(bw_ibm_mdf *ib, size_t n)
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  bw_status st = BW_OK;
  bool changed = true;
  /* The list was only counted beyond its room; it is made again with enough. */
  if (n > ib->cast_room) {
    st = reserve_cast(ib, n);
    if (st == BW_OK) cast_all(ib, &changed);
  }
  BW_TRY(bw_comm_agree(comm, st));
  /* The old plan is of no use, whatever happens from here on. */
  ib->cast = n;
  ib->images = 0;
  bw_exchange_destroy(&ib->image_plan);
  BW_TRY(bw_exchange_create(comm, ib->cast, ib->cast_to, &ib->image_plan));
  ib->images = bw_exchange_received(ib->image_plan);
  return bw_comm_agree(comm, reserve_stencils(ib, ib->held + ib->images));
}

bw_status bw_ibm_mdf__cast_images(bw_ibm_mdf *ib)
{
  bool changed = ib->image_plan == NULL || ib->held + ib->images > ib->stencil_room;
  const size_t n = cast_all(ib, &changed);
  /* One rank with news makes all of them take part in a new plan. */
  int64_t news = changed;
  bw_comm_sum_int(bw_grid_comm(ib->grid), 1, &news);
  if (news > 0) BW_TRY(plan_images(ib, n));
  /* Places travel once per set of markers; forces in every iteration. */
  bw_exchange_forward(ib->image_plan, sizeof *ib->cast_item, ib->cast_item, ib->image);
  return BW_OK;
}

void bw_ibm_mdf__give_images(bw_ibm_mdf *ib)
{
  /* Behind the held markers U has room for the images of others. */
  for (size_t q = 0; q < ib->cast; q++)
    for (int c = 0; c < 3; c++)
      ib->cast_F[3 * q + c] = ib->U[3 * (size_t)ib->cast_from[q] + c];
  bw_exchange_forward(ib->image_plan, 3 * sizeof *ib->U, ib->cast_F, ib->U + 3 * ib->held);
}
