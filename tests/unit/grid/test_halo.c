/* Halo update: every halo cell gets its image, the rest stays; also where messages are cut.
 * TEST ranks=1,2,3,4 */
#include "grid_cases.h"

/* A number for each global cell, ghosts included, distinct and exact also in float. */
static double code(const int at[3])
{
  return 1 + (at[0] + 3) + 20.0 * (at[1] + 3) + 400.0 * (at[2] + 3);
}

static const double untouched = -7;

/* Where the value of a storage cell comes from: false if the cell belongs to this rank or is a
 * physical ghost of its block, else image[] is the global cell (or ghost) it mirrors. */
static bool image_of(const bw_grid_view *v, const int cell[3], int image[3])
{
  bool foreign = false;
  for (int d = 0; d < 3; d++) {
    image[d] = cell[d] + v->lo[d];
    const bool outside = cell[d] < 1 || cell[d] > v->m[d];
    const bool beyond = image[d] < 1 || image[d] > v->n[d];
    if (outside && (!beyond || v->periodic[d])) foreign = true;
    if (beyond && v->periodic[d]) image[d] = (image[d] - 1 + v->n[d]) % v->n[d] + 1;
  }
  return foreign;
}

#define FOR_STORAGE(v, c)                                                                          \
  for (int c[3] = {0, 0, 1 - (v)->halo[2]}; c[2] <= (v)->m[2] + (v)->halo[2]; c[2]++)              \
    for (c[1] = 1 - (v)->halo[1]; c[1] <= (v)->m[1] + (v)->halo[1]; c[1]++)                        \
      for (c[0] = 1 - (v)->halo[0]; c[0] <= (v)->m[0] + (v)->halo[0]; c[0]++)

static void check_update(const grid_case *c, int count)
{
  bw_grid *grid = grid_case_create(c);
  const bw_grid_view *v = bw_grid_look(grid);
  bw_real *f[6];
  bw_grid_sent halo, swap;
  int image[3];
  for (int q = 0; q < count; q++) {
    bw_check_ok(bw_field_create(grid, &f[q]));
    FOR_STORAGE(v, at)
    f[q][bw_at(v, at[0], at[1], at[2])] =
        (bw_real)(image_of(v, at, image) ? untouched : code(image) + 10000.0 * q);
  }
  bw_halo_update(grid, count, f);
  bw_grid_traffic(grid, &halo, &swap);
  ck_assert_uint_eq(halo.bytes, (size_t)count * bw_halo_volume(grid));
  if (c->comm != NULL) ck_assert_uint_le(halo.bytes, (size_t)halo.messages * GRID_SHORT_MESSAGE);
  for (int q = 0; q < count; q++) {
    FOR_STORAGE(v, at)
    {
      image_of(v, at, image);
      const double got = (double)f[q][bw_at(v, at[0], at[1], at[2])];
      ck_assert_msg(got == code(image) + 10000.0 * q,
                    "field %d, cell %d %d %d (global %d %d %d): %g instead of %g", q, at[0], at[1],
                    at[2], image[0], image[1], image[2], got, code(image) + 10000.0 * q);
    }
    bw_release(&f[q]);
  }
  bw_grid_destroy(&grid);
}

START_TEST(update_fills_every_halo_cell_with_its_image)
{
  bw_comm *cut = grid_short_messages();
  for (int q = 0; q < GRID_CASES; q++)
    for (int way = 0; way < GRID_WAYS; way++) {
      grid_case c = grid_case_number(q);
      if (!grid_case_divide(&c, way, bw_comm_size(bw_check_world()))) continue;
      check_update(&c, 1 + q % 6);
      c.comm = cut;
      check_update(&c, 1 + q % 6);
    }
  bw_comm_destroy(&cut);
}
END_TEST

static double pseudo_random(uint64_t *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) / 9007199254740992.0 - 0.5;
}

static bool just_below(const bw_grid_view *v, int q, const int at[3])
{
  bool below = at[q] == 0;
  for (int d = 0; d < 3; d++)
    below = below && (d == q || (at[d] >= 1 && at[d] <= v->m[d]));
  return below;
}

/* The layer below the block in its own direction, for u, v, w: what update gives there, and nothing
 * else is touched. Also what both sent. */
static void check_faces(const grid_case *c)
{
  bw_grid *grid = grid_case_create(c);
  const bw_grid_view *v = bw_grid_look(grid);
  const int components = v->n[2] == 1 ? 2 : 3;
  bw_real *whole[3] = {NULL, NULL, NULL}, *faces[3] = {NULL, NULL, NULL};
  bw_grid_sent halo[3], swap;
  uint64_t state = 1;
  for (int q = 0; q < components; q++) {
    bw_check_ok(bw_field_create(grid, &whole[q]));
    bw_check_ok(bw_field_create(grid, &faces[q]));
    FOR_STORAGE(v, at)
    whole[q][bw_at(v, at[0], at[1], at[2])] = faces[q][bw_at(v, at[0], at[1], at[2])] =
        (bw_real)pseudo_random(&state);
  }
  bw_grid_traffic(grid, &halo[0], &swap);
  bw_halo_update_faces(grid, faces);
  bw_grid_traffic(grid, &halo[1], &swap);
  for (int q = 0; q < components; q++)
    FOR_STORAGE(v, at)
    {
      const ptrdiff_t here = bw_at(v, at[0], at[1], at[2]);
      if (!just_below(v, q, at)) ck_assert(faces[q][here] == whole[q][here]);
    }
  bw_halo_update(grid, components, whole);
  bw_grid_traffic(grid, &halo[2], &swap);
  for (int q = 0; q < components; q++)
    FOR_STORAGE(v, at)
    {
      const ptrdiff_t here = bw_at(v, at[0], at[1], at[2]);
      if (just_below(v, q, at)) ck_assert(faces[q][here] == whole[q][here]);
    }
  ck_assert_uint_eq(halo[0].bytes + swap.bytes, 0);
  ck_assert_uint_eq(halo[2].bytes - halo[1].bytes, (size_t)components * bw_halo_volume(grid));
  ck_assert_uint_le(halo[1].bytes, bw_halo_volume(grid)); /* of a field; the whole: of each */
  for (int q = 0; q < 3; q++)
    bw_release(&whole[q]), bw_release(&faces[q]);
  bw_grid_destroy(&grid);
}

START_TEST(faces_are_those_of_update)
{
  bw_comm *cut = grid_short_messages();
  for (int q = 0; q < GRID_CASES; q++)
    for (int way = 0; way < GRID_WAYS; way++) {
      grid_case c = grid_case_number(q);
      if (!grid_case_divide(&c, way, bw_comm_size(bw_check_world()))) continue;
      check_faces(&c);
      c.comm = cut;
      check_faces(&c);
    }
  bw_comm_destroy(&cut);
}
END_TEST

/* Bytes of one field between blocks, counted by hand for z cut in two of a periodic box:
 * two faces of (n0 + 2h) (m1 + 2h) h cells. */
START_TEST(volume_counts_messages_only)
{
  const grid_case c = {.n = {5, 8, 9}, .periodic = 7, .halo = 2};
  bw_grid *grid = grid_case_create(&c);
  const size_t size = (size_t)bw_comm_size(bw_check_world());
  if (size == 1) ck_assert_uint_eq(bw_halo_volume(grid), 0);
  if (size == 2) ck_assert_uint_eq(bw_halo_volume(grid), 2u * (9 * 12) * 2u * sizeof(bw_real));
  bw_grid_destroy(&grid);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(update_fills_every_halo_cell_with_its_image),
                                      BW_TEST(faces_are_those_of_update),
                                      BW_TEST(volume_counts_messages_only)};
BW_CHECK_MAIN("grid.halo", tests)
