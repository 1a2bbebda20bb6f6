/* Ways through labyrinths, against a flood that one rank does alone, in the plainest way.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape_way.h"

#include <string.h>

typedef struct {
  bw_shape_way_box box;
  uint8_t *solid; /* (cells), the same on all ranks */
} labyrinth;

static int64_t cells_of(const labyrinth *l)
{
  return l->box.cells[0] * l->box.cells[1] * l->box.cells[2];
}

static labyrinth labyrinth_of(int nx, int ny, int nz, int axis)
{
  labyrinth l = {.box = {.cells = {nx, ny, nz}, .axis = axis}};
  bw_check_ok(BW_ALLOCATE(&l.solid, (size_t)cells_of(&l)));
  return l;
}

static int64_t at(const labyrinth *l, int64_t i, int64_t j, int64_t k)
{
  return i + l->box.cells[0] * (j + l->box.cells[1] * k);
}

/* Is the neighbour of cell (place p) on this side reached? */
static bool neighbour_reached(const labyrinth *l, const uint8_t *reached, const int64_t p[3],
                              int side)
{
  const int d = side / 2;
  int64_t q[3] = {p[0], p[1], p[2]};
  q[d] += side % 2 == 0 ? 1 : -1;
  if (q[d] < 0 || q[d] >= l->box.cells[d]) {
    if (!l->box.periodic[d]) return false;
    q[d] = (q[d] + l->box.cells[d]) % l->box.cells[d];
  }
  return reached[at(l, q[0], q[1], q[2])];
}

/* Sweeps over all cells until nothing changes. */
static bw_shape_way plain_flood(const labyrinth *l)
{
  const int64_t *n = l->box.cells;
  bw_shape_way way = {0};
  uint8_t *reached = NULL;
  bw_check_ok(BW_ALLOCATE(&reached, (size_t)cells_of(l)));
  for (bool changed = true; changed;) {
    changed = false;
    for (int64_t cell = 0; cell < cells_of(l); cell++) {
      const int64_t p[3] = {cell % n[0], cell / n[0] % n[1], cell / n[0] / n[1]};
      if (l->solid[cell] || reached[cell]) continue;
      bool here = p[l->box.axis] == 0;
      for (int side = 0; side < 6; side++)
        here = here || neighbour_reached(l, reached, p, side);
      reached[cell] = here;
      changed = changed || here;
    }
  }
  for (int64_t cell = 0; cell < cells_of(l); cell++) {
    const int64_t p[3] = {cell % n[0], cell / n[0] % n[1], cell / n[0] / n[1]};
    way.open += !l->solid[cell];
    way.reached += reached[cell];
    way.through = way.through || (reached[cell] && p[l->box.axis] == n[l->box.axis] - 1);
  }
  bw_release(&reached);
  return way;
}

/* How the solid cells are dealt out to the ranks. */
enum { IN_TURN, ALL_ON_ONE, ALL_ON_ALL, DEALS };

static bw_shape_way found_way(const labyrinth *l, int deal)
{
  const int rank = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  const int64_t *n = l->box.cells;
  int32_t *site = NULL;
  int64_t m = 0, seen = 0;
  bw_shape_way way;
  bw_check_ok(BW_ALLOCATE(&site, 3 * (size_t)(cells_of(l) + 2)));
  for (int64_t cell = 0; cell < cells_of(l); cell++) {
    if (!l->solid[cell]) continue;
    seen++;
    if (deal == IN_TURN ? seen % size != rank : deal == ALL_ON_ONE && rank != size - 1) continue;
    site[3 * m] = (int32_t)(cell % n[0]);
    site[3 * m + 1] = (int32_t)(cell / n[0] % n[1]);
    site[3 * m + 2] = (int32_t)(cell / n[0] / n[1]);
    m++;
  }
  /* Two that lie outside and must not count. */
  memcpy(site + 3 * m++, (int32_t[3]){0, -1, 0}, 3 * sizeof *site);
  memcpy(site + 3 * m++, (int32_t[3]){(int32_t)n[0], 0, 0}, 3 * sizeof *site);
  bw_check_ok(bw_shape_find_way(bw_check_world(), &l->box, m, site, &way));
  bw_release(&site);
  return way;
}

static bw_shape_way check(const labyrinth *l)
{
  const bw_shape_way want = plain_flood(l);
  for (int deal = 0; deal < DEALS; deal++) {
    const bw_shape_way way = found_way(l, deal);
    ck_assert_int_eq(way.open, want.open);
    ck_assert_int_eq(way.reached, want.reached);
    ck_assert_int_eq(way.through, want.through);
  }
  return want;
}

/* Walls across x at 1, 3, 5, ..., each with one gap, at either end of z in turn. */
static labyrinth serpentine(int nz, bool closed)
{
  labyrinth l = labyrinth_of(12, 3, nz, 0);
  for (int i = 1; i < 12; i += 2)
    for (int k = 0; k < nz; k++)
      for (int j = 0; j < 3; j++)
        l.solid[at(&l, i, j, k)] = 1;
  for (int i = 1; i < 12; i += 2)
    if (!closed || i != 7) l.solid[at(&l, i, i % 3, i % 4 == 1 ? nz - 1 : 0)] = 0;
  return l;
}

/* The way goes through all slabs six times; closed, it ends after three. */
START_TEST(ways_wind_through_all_ranks)
{
  for (int nz = 13; nz <= 40; nz += 9)
    for (int closed = 0; closed < 2; closed++) {
      labyrinth l = serpentine(nz, closed == 1);
      const bw_shape_way way = check(&l);
      ck_assert_int_eq(way.through, closed == 0);
      ck_assert(closed == 1 || way.reached == way.open);
      bw_release(&l.solid);
    }
}
END_TEST

/* A box cut by a wall along the way, and one across it with a gap on the far side: through only
 * where the box is periodic, along the axis that is cut and along one that is not. */
START_TEST(ways_over_periodic_sides)
{
  for (int axis = 1; axis < 3; axis++)
    for (int periodic = 0; periodic < 2; periodic++) {
      labyrinth l = labyrinth_of(9, 10, 20, 0);
      l.box.periodic[axis] = periodic == 1;
      const int64_t middle = l.box.cells[axis] / 2;
      for (int64_t cell = 0; cell < cells_of(&l); cell++) {
        const int64_t p[3] = {cell % 9, cell / 9 % 10, cell / 90};
        const bool along = p[axis] == middle;
        const bool entry = p[0] == 0 && p[axis] < middle; /* only the upper half lets in */
        const bool across = p[0] == 4 && p[axis] > middle;
        l.solid[cell] = along || entry || across;
      }
      const bw_shape_way way = check(&l);
      ck_assert_int_eq(way.through, periodic);
      bw_release(&l.solid);
    }
}
END_TEST

static uint32_t random_of(uint32_t *state)
{
  *state = *state * 1664525u + 1013904223u;
  return *state >> 8;
}

/* Near the fraction of open cells where ways begin to be found (0.312 on this lattice), clusters
 * are as ragged as can be. Every axis, all sides periodic or not, flat and thin boxes. */
START_TEST(random_media)
{
  const int size[][3] = {{11, 12, 13}, {24, 7, 5}, {6, 30, 1}, {2, 1, 3}, {1, 1, 1}};
  int through = 0, all = 0;
  uint32_t state = 7;
  for (int q = 0; q < 5; q++)
    for (int axis = 0; axis < 3; axis++)
      for (int bits = 0; bits < 8; bits++)
        for (int open = 30; open < 70; open += 13) {
          labyrinth l = labyrinth_of(size[q][0], size[q][1], size[q][2], axis);
          for (int d = 0; d < 3; d++)
            l.box.periodic[d] = d != axis && (bits >> d & 1);
          for (int64_t cell = 0; cell < cells_of(&l); cell++)
            l.solid[cell] = random_of(&state) % 100 >= (uint32_t)open;
          through += check(&l).through;
          all++;
          bw_release(&l.solid);
        }
  ck_assert_int_gt(through, all / 5);
  ck_assert_int_lt(through, 4 * all / 5);
}
END_TEST

START_TEST(impossible_boxes_are_refused)
{
  const bw_comm *comm = bw_check_world();
  const int32_t none[3] = {0};
  const bw_shape_way_box good = {.cells = {4, 4, 4}, .axis = 1};
  bw_shape_way way;
  bw_shape_way_box b = good;
  bw_check_ok(bw_shape_find_way(comm, &good, 0, none, &way));
  ck_assert(way.through && way.open == 64 && way.reached == 64);
  b.cells[2] = 0;
  bw_check_status(bw_shape_find_way(comm, &b, 0, none, &way), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "cells[2] = 0"));
  b = good, b.axis = 3;
  bw_check_status(bw_shape_find_way(comm, &b, 0, none, &way), BW_EINPUT);
  b = good, b.periodic[1] = true;
  bw_check_status(bw_shape_find_way(comm, &b, 0, none, &way), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "periodic along axis 1"));
  b = good;
  for (int d = 0; d < 3; d++)
    b.cells[d] = INT32_MAX;
  bw_check_status(bw_shape_find_way(comm, &b, 0, none, &way), BW_EINPUT);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(ways_wind_through_all_ranks),
    BW_TEST(ways_over_periodic_sides),
    BW_TEST(random_media),
    BW_TEST(impossible_boxes_are_refused),
};
BW_CHECK_MAIN("shape.way", tests)
