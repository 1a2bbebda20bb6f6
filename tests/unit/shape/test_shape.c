/* Shapes: which sites are particles. Counts are from exact enumeration by hand or symmetry, or
 * from POROUS chapter 5's set-up counted by an independent brute-force enumeration.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include <string.h>

static const double zero[3] = {0.0, 0.0, 0.0};

/* The whole body on a straight lattice. */
static bw_status fill(int count, const bw_shape shape[], double ds, const double origin[3],
                      bool planar, int64_t *n, int32_t **site, uint8_t **kind)
{
  const bw_shape_lattice lattice = bw_shape_lattice_straight(ds, origin, planar);
  return bw_shape_fill(count, shape, &lattice, 0, 1, n, site, kind, NULL);
}

static int64_t sites_of(int count, const bw_shape shape[], double ds, bool planar)
{
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_check_ok(fill(count, shape, ds, zero, planar, &n, &site, &kind));
  bw_release(&site);
  bw_release(&kind);
  return n;
}

/* POROUS chapter 5: 0.375 L x h x h, h = 0.1, pores of pitch h/4 and radius 0.5825 pitch. */
static int64_t porous(int cells, double shift, bool with_foot, bw_shape_kind pores, double radius)
{
  const double h = 0.1, pitch = h / 4, ds = h / cells;
  const bw_shape body[] = {
      {.kind = BW_SHAPE_BOX, .lower = {0.25 * h, 0, 0}, .upper = {h, h, h}},
      {.kind = pores,
       .remove = true,
       .centre = {0.25 * h + shift * pitch, shift * pitch, shift * pitch},
       .radius = radius * pitch,
       .pitch = pitch},
      {.kind = BW_SHAPE_BOX,
       .lower = {0.25 * h, -3 * ds, 0},
       .upper = {h, 0, h},
       .particle_kind = 1},
  };
  return sites_of(with_foot ? 3 : 2, body, ds, false);
}

/* The box holds whole pitches in every direction and the lattice is mirror-symmetric, so pore
 * centres at k pitch (corner of the medium) and at (k + 1/2) pitch give the same count. */
START_TEST(porous_medium_of_the_thesis)
{
  ck_assert_int_eq(porous(64, 0.5, false, BW_SHAPE_PORES_SC, 0.5825), 46080);
  ck_assert_int_eq(porous(64, 0.0, false, BW_SHAPE_PORES_SC, 0.5825), 46080);
  ck_assert_int_eq(porous(64, 0.5, true, BW_SHAPE_PORES_SC, 0.5825), 55296);
  ck_assert_int_eq(porous(32, 0.5, false, BW_SHAPE_PORES_SC, 0.5825), 4992);
  ck_assert_int_eq(porous(32, 0.5, true, BW_SHAPE_PORES_SC, 0.5825), 4992 + 24 * 32 * 3);
}
END_TEST

/* Pores that do not overlap remove their number times one ball: 1, 2, 4 per cell of the lattice;
 * 48 cells. One ball is counted as a sphere of its own at each kind of place it takes. */
START_TEST(pore_lattices_remove_their_number_of_balls)
{
  const int cells = 64;
  const double pitch = 16.0, radius = 0.3;
  bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {0, 0, 0}, .radius = radius * pitch};
  const int64_t one = sites_of(1, &ball, 1.0, false);
  const int64_t all = 48 * 64 * 64;
  ck_assert_int_eq(porous(cells, 0.0, false, BW_SHAPE_PORES_SC, radius), all - 48 * one);
  ck_assert_int_eq(porous(cells, 0.0, false, BW_SHAPE_PORES_BCC, radius), all - 96 * one);
  ck_assert_int_eq(porous(cells, 0.0, false, BW_SHAPE_PORES_FCC, radius), all - 192 * one);
}
END_TEST

START_TEST(order_origin_and_kind)
{
  const bw_shape body[] = {
      {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {3, 2, 2}, .particle_kind = 2},
      {.kind = BW_SHAPE_BOX, .remove = true, .lower = {2, 1, 1}, .upper = {3, 2, 2}},
      {.kind = BW_SHAPE_BOX, .lower = {0, 0, 1}, .upper = {1, 1, 3}, .particle_kind = 1},
  };
  const double origin[3] = {-0.5, 10.0, 0.0}; /* moves the first box out of reach in y */
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_check_ok(fill(3, body, 1.0, zero, false, &n, &site, &kind));
  ck_assert_int_eq(n, 12 - 1 + 1);
  int64_t before = -1;
  int marked = 0;
  for (int64_t q = 0; q < n; q++) {
    const int64_t at = site[3 * q] + 10 * (site[3 * q + 1] + 10 * (int64_t)site[3 * q + 2]);
    ck_assert_int_gt(at, before); /* x fastest, then y, then z; none twice */
    before = at;
    marked += kind[q] == 1;
    ck_assert_int_eq(kind[q], site[3 * q] == 0 && site[3 * q + 1] == 0 && site[3 * q + 2] ? 1 : 2);
  }
  ck_assert_int_eq(marked, 2);
  bw_release(&site);
  bw_release(&kind);
  /* sites are counted from the origin, shapes are not: y in 0 .. 2 is site -10 .. -9 */
  bw_check_ok(fill(1, body, 1.0, origin, false, &n, &site, &kind));
  ck_assert_int_eq(site[1], -10);
  ck_assert_int_eq(site[0], 0); /* centre at x = 0 is inside, at x = 3 (site 3) it is not */
  ck_assert_int_eq(n, 12);
  bw_release(&site);
  bw_release(&kind);
}
END_TEST

/* Volume of a ball and a cylinder within the lattice-point error O(R^1) of R = 20. */
START_TEST(round_shapes_have_their_volume)
{
  const double R = 20.0, pi = acos(-1.0);
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {0.3, -0.2, 0.1}, .radius = R};
  bw_check_near((double)sites_of(1, &ball, 1.0, false) / (4 * pi * R * R * R / 3), 1.0, 0.005);
  for (int axis = 0; axis < 3; axis++) {
    bw_shape tube[2] = {
        {.kind = BW_SHAPE_CYLINDER, .centre = {0.3, -0.2, 0.1}, .radius = R, .axis = axis},
        {.kind = BW_SHAPE_BOX, .lower = {-1, -1, -1}, .upper = {1, 1, 1}}};
    tube[1].lower[axis] = -5, tube[1].upper[axis] = 5;
    bw_check_near((double)sites_of(2, tube, 1.0, false) / (10 * pi * R * R), 1.0, 0.005);
  }
  const bw_shape disc = {.kind = BW_SHAPE_CYLINDER, .centre = {0, 0, 99}, .radius = R, .axis = 2};
  bw_check_near((double)sites_of(1, &disc, 1.0, true) / (pi * R * R), 1.0, 0.01);
}
END_TEST

/* What is taken away from a ball outside a box and inside it are its two parts. */
START_TEST(outside_is_the_rest_of_space)
{
  bw_shape body[2] = {
      {.kind = BW_SHAPE_SPHERE, .centre = {0.1, 0.2, 0.3}, .radius = 6.0},
      {.kind = BW_SHAPE_BOX, .lower = {-2, -9, -1}, .upper = {9, 3, 9}, .remove = true}};
  const int64_t whole = sites_of(1, body, 1.0, false), beside = sites_of(2, body, 1.0, false);
  body[1].outside = true;
  const int64_t within = sites_of(2, body, 1.0, false);
  ck_assert_int_gt(within, 0);
  ck_assert_int_gt(beside, 0);
  ck_assert_int_eq(within + beside, whole);
}
END_TEST

/* An endless cylinder ends with what else is added, also when all is then cut to something larger;
 * alone it ends where it is cut, which is the same as cutting the box to the cylinder. */
START_TEST(endless_shapes_end)
{
  const bw_shape tube = {
      .kind = BW_SHAPE_CYLINDER, .centre = {0.1, 0.2, 0}, .radius = 4, .axis = 2};
  const bw_shape short_box = {.kind = BW_SHAPE_BOX, .lower = {-1, -1, -3}, .upper = {1, 1, 3}};
  bw_shape cut = {.kind = BW_SHAPE_BOX, .lower = {-9, -9, -9}, .upper = {9, 9, 9}};
  const bw_shape whole_box = cut;
  cut.remove = cut.outside = true;
  const bw_shape three[3] = {tube, short_box, cut};
  ck_assert_int_eq(sites_of(3, three, 0.5, false), sites_of(2, three, 0.5, false));
  bw_shape around = tube;
  around.remove = around.outside = true;
  const bw_shape cut_tube[2] = {tube, cut}, cut_box[2] = {whole_box, around};
  const int64_t found = sites_of(2, cut_tube, 0.5, false);
  ck_assert_int_eq(found, sites_of(2, cut_box, 0.5, false));
  ck_assert_int_gt(found, 3 * sites_of(3, three, 0.5, false) / 2);
}
END_TEST

START_TEST(impossible_shapes_are_refused_by_number)
{
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape good = {.kind = BW_SHAPE_BOX, .upper = {2, 2, 2}};
  bw_shape list[2] = {good, good};
  list[1].upper[1] = -1;
  bw_check_status(fill(2, list, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "shape 1"));
  list[1] = (bw_shape){.kind = BW_SHAPE_PORES_SC, .radius = 1.0};
  bw_check_status(fill(2, list, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  list[1] = (bw_shape){.kind = BW_SHAPE_CYLINDER, .radius = 1.0, .axis = 3};
  bw_check_status(fill(2, list, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  list[0] = (bw_shape){.kind = BW_SHAPE_CYLINDER, .radius = 1.0, .axis = 1};
  bw_check_status(fill(1, list, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  list[0] = list[1] = good;
  list[1].remove = true;
  bw_check_status(fill(2, list, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  bw_check_status(fill(1, &good, NAN, zero, false, &n, &site, &kind), BW_EINPUT);
  bw_check_status(fill(0, &good, 1.0, zero, false, &n, &site, &kind), BW_EINPUT);
  ck_assert_ptr_null(site);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(porous_medium_of_the_thesis),
    BW_TEST(pore_lattices_remove_their_number_of_balls),
    BW_TEST(order_origin_and_kind),
    BW_TEST(round_shapes_have_their_volume),
    BW_TEST(outside_is_the_rest_of_space),
    BW_TEST(endless_shapes_end),
    BW_TEST(impossible_shapes_are_refused_by_number),
};
BW_CHECK_MAIN("shape.bodies", tests)
