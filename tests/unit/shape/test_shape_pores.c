/* Widths of pores and throats in media whose widths are known: slits, a plate with holes, walls.
 * TEST ranks=1,3 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape_pores.h"

enum { N = 12 };

/* The box's solid cells, those of every rank in turn, as said by `is`. */
static bw_shape_pores look(const bw_shape_pores_box *box, bool (*is)(int i, int j, int k))
{
  const bw_comm *world = bw_check_world();
  int32_t *site = NULL;
  int64_t n = 0;
  bw_shape_pores p;
  bw_check_ok(BW_ALLOCATE(&site, (size_t)(3 * (N + 2) * (N + 2) * (N + 2))));
  int q = 0;
  /* Sites around the box are none of it. */
  for (int k = -1; k <= N; k++)
    for (int j = -1; j <= N; j++)
      for (int i = -1; i <= N; i++) {
        const bool out = i < 0 || j < 0 || k < 0 || i >= box->cells[0] || j >= box->cells[1] ||
                         k >= box->cells[2];
        if ((!out && !is(i, j, k)) || q++ % bw_comm_size(world) != bw_comm_rank(world)) continue;
        site[3 * n] = i, site[3 * n + 1] = j, site[3 * n + 2] = k;
        n++;
      }
  bw_check_ok(bw_shape_find_pores(world, box, n, site, &p));
  bw_release(&site);
  ck_assert(p.known);
  return p;
}

static bool slit(int i, int j, int k)
{
  (void)i, (void)k;
  return j < 3 || j > 7; /* 5 cells wide */
}

START_TEST(a_slit_is_as_wide_as_it_is)
{
  const bw_shape_pores_box box = {.cells = {N, N, N}};
  const bw_shape_pores p = look(&box, slit);
  ck_assert(p.throat[0] == 5 && p.throat[1] == 0 && p.throat[2] == 5);
  ck_assert(p.largest == 5 && p.typical == 5);
}
END_TEST

/* A plate across x with a hole of 3 x 3 and one of one cell. */
static bool plate(int i, int j, int k)
{
  const bool large = j >= 2 && j <= 4 && k >= 6 && k <= 8, small = j == 9 && k == 1;
  return i == 5 && !large && !small;
}

START_TEST(the_wider_of_two_ways_counts)
{
  const bw_shape_pores_box box = {.cells = {N, N, N}};
  const bw_shape_pores p = look(&box, plate);
  ck_assert(p.throat[0] == 3);
  ck_assert(p.at[0][0] == 5 && p.at[0][1] == 3 && p.at[0][2] == 7);
  /* Along the plate a ball keeps to the larger half, 6 cells wide and open at its end: its centre
   * may be 6 cells from the plate. */
  ck_assert(p.throat[1] == 11 && p.throat[2] == 11);
}
END_TEST

static bool nothing(int i, int j, int k)
{
  (void)i, (void)j, (void)k;
  return false;
}

START_TEST(walls_bound_what_is_open)
{
  /* Between walls in y the box is a slit of 7; along y they are open, and nothing is left. */
  bw_shape_pores_box box = {.cells = {N, 7, N}, .wall = {false, true, false}};
  bw_shape_pores p = look(&box, nothing);
  ck_assert(p.throat[0] == 7 && p.throat[2] == 7 && p.throat[1] > 1000);
  box.cells[1] = 0;
  bw_check_status(bw_shape_find_pores(bw_check_world(), &box, 0, NULL, &p), BW_EINPUT);
}
END_TEST

/* Open at both ends of y, 2 and 3 cells. */
static bool bar(int i, int j, int k)
{
  (void)i, (void)k;
  return j >= 2 && j < N - 3;
}

START_TEST(a_seam_joins_two_halves)
{
  bw_shape_pores_box box = {.cells = {N, N, N}, .periodic = {false, true, false}};
  ck_assert(look(&box, bar).throat[0] == 5);
  box.periodic[1] = false;
  box.wall[1] = true;
  ck_assert(look(&box, bar).throat[0] == 3);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_slit_is_as_wide_as_it_is), BW_TEST(the_wider_of_two_ways_counts),
    BW_TEST(walls_bound_what_is_open), BW_TEST(a_seam_joins_two_halves)};
BW_CHECK_MAIN("shape.pores", tests)
