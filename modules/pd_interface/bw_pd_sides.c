/* The sides on which rough parts of the surface meet the fluid. */
#include "bw_memory.h"
#include "pd_interface_internal.h"
#include <string.h>

enum { ROWS = BW_PD_INTERFACE__ROWS, SIDES = 6 };

/* How many points stand for particle h at most. */
static size_t most(const bw_pd_interface *pi, size_t h)
{
  size_t sides = 0;
  for (unsigned bits = pi->sides.open[h]; bits != 0; bits &= bits - 1)
    sides++;
  return sides > 0 ? sides : 1;
}

bw_status bw_pd_interface__sides_create(bw_pd_interface *pi)
{
  bw_pd_interface__sides *s = &pi->sides;
  for (size_t h = 0; h < pi->n; h++)
    s->room += most(pi, h);
  bw_status st = BW_ALLOCATE(&s->row, s->room);
  BW_THEN(st, BW_ALLOCATE(&s->N, 3 * s->room));
  BW_THEN(st, BW_ALLOCATE(&s->A, s->room));
  BW_THEN(st, BW_ALLOCATE(&s->H, s->room));
  BW_THEN(st, BW_ALLOCATE(&s->step, s->room));
  return st;
}

static void add(bw_pd_interface__sides *s, size_t row, const double N[3], double A, double H,
                bool step)
{
  s->row[s->n] = (int32_t)row;
  memcpy(s->N + 3 * s->n, N, 3 * sizeof *N);
  s->A[s->n] = A, s->H[s->n] = H, s->step[s->n] = step;
  s->n++;
}

/* A sheet of one layer. */
static bool has_opposite(const bw_pd_interface *pi, size_t row)
{
  const unsigned open = pi->sides.open[pi->now.list[row]], lower = 0x15;
  return (open & open >> 1 & lower) != 0;
}

/* Sides of a row that is not smooth. */
static void add_open(bw_pd_interface *pi, size_t row, double N[SIDES][3])
{
  const size_t h = (size_t)pi->now.list[row];
  for (int side = 0; side < SIDES; side++)
    if (pi->sides.open[h] >> side & 1u)
      add(&pi->sides, row, N[side], bw_pd_interface__side_area(pi, h),
          0.5 * bw_solid_spacing(pi->pd, h), !has_opposite(pi, row));
}

/* Does the row have its sides, or one point? A sheet is smooth, and has two. */
static bool is_split(const bw_pd_interface *pi, size_t row)
{
  return pi->config.area == BW_PD_AREA_OPEN_SIDES && pi->sides.open[pi->now.list[row]] != 0 &&
         (has_opposite(pi, row) || !pi->now.smooth[row]);
}

static void tell_block(bw_pd_interface *pi, size_t block, const bw_pd_motion *now)
{
  const size_t first = block * ROWS;
  const size_t end = first + ROWS < pi->now.n_list ? first + ROWS : pi->now.n_list;
  double N[ROWS][SIDES][3];
  bool any = false;
  for (size_t row = first; row < end; row++)
    any = any || is_split(pi, row);
  if (any) bw_pd_interface__carry_sides(pi, block, now, N);
  for (size_t row = first; row < end; row++)
    if (is_split(pi, row))
      add_open(pi, row, N[row - first]);
    else
      add(&pi->sides, row, pi->now.list_normal + 3 * row, pi->now.area[row], pi->now.height[row],
          false);
}

bw_pd_sides bw_pd_interface_sides(bw_pd_interface *pi)
{
  const bw_pd_motion now = bw_solid_get_motion(pi->pd, false);
  pi->sides.n = 0;
  for (size_t block = 0; block * ROWS < pi->now.n_list; block++)
    tell_block(pi, block, &now);
  return (bw_pd_sides){.n = pi->sides.n,
                       .row = pi->sides.row,
                       .N = pi->sides.N,
                       .A = pi->sides.A,
                       .H = pi->sides.H,
                       .step = pi->sides.step};
}

size_t bw_pd_interface_most_sides(const bw_pd_interface *pi)
{
  return pi->sides.room;
}
