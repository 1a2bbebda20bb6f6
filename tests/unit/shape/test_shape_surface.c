/* Distances, normals and surface points against closed forms.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape_surface.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

#define BOX(...)                                                                                   \
  {                                                                                                \
    .kind = BW_SHAPE_BOX, __VA_ARGS__                                                              \
  }
#define SPHERE(...)                                                                                \
  {                                                                                                \
    .kind = BW_SHAPE_SPHERE, __VA_ARGS__                                                           \
  }
#define TUBE(...)                                                                                  \
  {                                                                                                \
    .kind = BW_SHAPE_CYLINDER, __VA_ARGS__                                                         \
  }
static const bw_shape_frame leaning = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}},
                                       {0.1, 0.2, 0.3}};
static const bw_shape_frame turned = {{{0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}}, {1, -1, 0}};

typedef struct {
  const char *name;
  int count;
  bw_shape shape[4];
  bool planar;
  double area, volume; /* closed forms; planar: length, area */
  bool exact;          /* no edge between two shapes: the area is right to round-off */
} body;

/* A ball of radius 1 cut at the height 0.4: a cap of height 0.6 is missing. Two balls of radius 1,
 * 1.2 apart: each loses a cap of height 0.4. A pit: half a ball of radius 0.5 in a face. */
static const double R = 1.0, CAP = 0.6, LENS = 0.4, PIT = 0.5;
static double cap_volume(double h)
{
  return pi * h * h * (3 * R - h) / 3;
}

enum { BODIES = 16 };
static void make_bodies(body b[BODIES])
{
  const body all[BODIES] = {
      {"box", 1, {BOX(.upper = {1, 2, 3})}, false, 22, 6, true},
      {"box in a frame", 1, {BOX(.upper = {1, 2, 3}, .frame = &leaning)}, false, 22, 6, true},
      {"ball", 1, {SPHERE(.centre = {1, 2, 3}, .radius = 1)}, false, 4 * pi, 4 * pi / 3, true},
      {"rectangle", 1, {BOX(.upper = {1, 2, 0}, .frame = &turned)}, true, 6, 2, true},
      {"disc", 1, {TUBE(.centre = {1, 2, 0}, .radius = 1, .axis = 2)}, true, 2 * pi, pi, true},
      {"cylinder cut by a box",
       2,
       {TUBE(.centre = {0.1, 0, 0.2}, .radius = 1, .axis = 1),
        BOX(.lower = {-9, -1, -9}, .upper = {9, 1, 9}, .remove = true, .outside = true)},
       false,
       6 * pi,
       2 * pi,
       false},
      {"cylinder ended by a box within",
       2,
       {TUBE(.centre = {0.1, 0, 0.2}, .radius = 1, .axis = 0),
        BOX(.lower = {-1, -0.1, -0.1}, .upper = {1, 0.1, 0.1})},
       false,
       6 * pi,
       2 * pi,
       false},
      {"cylinder cut by a box, in a frame",
       2,
       {TUBE(.centre = {0.1, 0, 0.2}, .radius = 1, .axis = 1, .frame = &leaning),
        BOX(.lower = {-9, -1, -9}, .upper = {9, 1, 9}, .remove = true, .outside = true,
            .frame = &leaning)},
       false,
       6 * pi,
       2 * pi,
       false},
      {"ball without a cap",
       2,
       {SPHERE(.radius = 1), BOX(.lower = {-2, -2, 0.4}, .upper = {2, 2, 2}, .remove = true)},
       false,
       4 * pi - 2 * pi * CAP + pi * (1 - 0.16),
       4 * pi / 3 - cap_volume(CAP),
       false},
      {"two balls",
       2,
       {SPHERE(.radius = 1), SPHERE(.centre = {0, 1.2, 0}, .radius = 1)},
       false,
       2 * (4 * pi - 2 * pi * LENS),
       2 * (4 * pi / 3 - cap_volume(LENS)),
       false},
      {"block with a pit",
       2,
       {BOX(.upper = {2, 2, 2}), SPHERE(.centre = {1, 1, 2}, .radius = PIT, .remove = true)},
       false,
       24 - pi * PIT * PIT + 2 * pi * PIT * PIT,
       8 - 2 * pi * PIT * PIT * PIT / 3,
       false},
      {"block with a bubble within",
       2,
       {BOX(.upper = {2, 2, 2}), SPHERE(.centre = {1, 1, 1}, .radius = PIT, .remove = true)},
       false,
       24 + 4 * pi * PIT * PIT,
       8 - 4 * pi * PIT * PIT * PIT / 3,
       true},
      {"blocks that touch, one twice",
       3,
       {BOX(.upper = {1, 1, 1}), BOX(.lower = {1, 0, 0}, .upper = {2, 1, 1}),
        BOX(.lower = {1, 0, 0}, .upper = {2, 1, 1})},
       false,
       10,
       2,
       true},
      {"pores that do not touch",
       2,
       {BOX(.upper = {2, 2, 2}),
        {.kind = BW_SHAPE_PORES_BCC,
         .remove = true,
         .radius = 0.3,
         .pitch = 1,
         .centre = {0.5, 0.5, 0.5}}},
       /* 8 pores within; 27 centres on corners, edges, faces and inside: 8 more pores in all */
       false,
       0,
       8 - 16 * 4 * pi * 0.027 / 3,
       false},
      {"pores that open into each other",
       2,
       {BOX(.upper = {2, 2, 2}),
        {.kind = BW_SHAPE_PORES_SC, .remove = true, .radius = 0.6, .pitch = 1}},
       /* eight cells of balls less the six caps of each; faces lose overlapping discs, see below */
       false,
       0,
       8 - 8 * (4 * pi * 0.216 / 3 - 6 * pi * 0.01 * (1.8 - 0.1) / 3),
       false},
      {"ring in the plane",
       2,
       {TUBE(.radius = 1, .axis = 2), TUBE(.radius = 0.5, .axis = 2, .remove = true)},
       true,
       3 * pi,
       0.75 * pi,
       true}};
  memcpy(b, all, sizeof all);
  /* Faces lose a disc at each centre on them: 4 quarters, 4 halves and 1 whole are 4 discs. */
  b[13].area = 24 - 6 * 4 * pi * 0.09 + 16 * 4 * pi * 0.09;
  /* Discs of 0.6 on the points of a square lattice of 1: two lenses overlap in each square. */
  const double lens = 0.72 * acos(1 / 1.2) - 0.5 * sqrt(0.44);
  b[14].area = 8 * (4 * pi * 0.36 - 6 * 2 * pi * 0.06) + 24 * (1 - pi * 0.36 + 2 * lens);
}

typedef struct {
  int64_t n;
  double *point, *normal, *area;
  double sum, flux[3], volume;
} cover;

static cover cover_of(const body *b, double spacing)
{
  cover c = {0};
  const int dims = b->planar ? 2 : 3;
  bw_check_ok(
      bw_shape_points(b->count, b->shape, b->planar, spacing, &c.n, &c.point, &c.normal, &c.area));
  for (int64_t q = 0; q < c.n; q++) {
    c.sum += c.area[q];
    for (int d = 0; d < dims; d++) {
      c.flux[d] += c.normal[3 * q + d] * c.area[q];
      c.volume += c.normal[3 * q + d] * c.point[3 * q + d] * c.area[q] / dims;
    }
  }
  return c;
}

static void release(cover *c)
{
  bw_release(&c->point);
  bw_release(&c->normal);
  bw_release(&c->area);
}

/* From one spacing to an eighth of it. Areas of whole patches are exact; an edge is cut by straight
 * lines over parts of a patch: second order, of which 1.9 is asked over three halvings, as the
 * error depends a little on where edges lie in the patches. At 0.2/8 it is bound by the sagitta of
 * an eighth of a patch along the edge, s^2/(8 R) with s = 0.025 sqrt(2)/8, R >= 0.3, times an edge
 * of up to 24 x 2 pi 0.3: 4e-4; the volume, by midpoints of curved patches, by h^2/R: 2e-3. */
START_TEST(areas_and_volumes_converge)
{
  body all[BODIES];
  make_bodies(all);
  for (int k = 0; k < BODIES; k++) {
    const body *b = &all[k];
    double area[4], volume[4];
    for (int q = 0; q < 4; q++) {
      cover c = cover_of(b, 0.2 / (1 << q));
      area[q] = fabs(c.sum - b->area);
      volume[q] = fabs(c.volume - b->volume);
      /* A closed surface has no mean normal: as good as its area and midpoints. */
      for (int d = 0; d < 3; d++)
        ck_assert_msg(fabs(c.flux[d]) < 0.02 / (1 << q), "%s: flux %g in %d", b->name, c.flux[d],
                      d);
      release(&c);
    }
    const double order = log2(area[0] / area[3]) / 3;
    if (b->exact)
      ck_assert_msg(area[0] < 1e-11 && area[3] < 1e-10, "%s: area off by %g", b->name, area[3]);
    else
      ck_assert_msg(area[3] < 4e-4 && order > 1.9, "%s: area off by %g, order %g", b->name, area[3],
                    order);
    ck_assert_msg(volume[3] < 2e-3 && (volume[3] < 1e-9 || volume[0] / volume[3] > 20),
                  "%s: volume off by %g, then %g", b->name, volume[0], volume[3]);
  }
}
END_TEST

/* Points lie where the distance is zero, normals are its gradient, and a step along the normal of a
 * convex body is a step of the distance. No point of the surface is nearer than the distance. */
START_TEST(points_lie_on_the_surface)
{
  body all[BODIES];
  make_bodies(all);
  for (int k = 0; k < BODIES; k++) {
    const body *b = &all[k];
    cover c = cover_of(b, 0.15);
    for (int64_t q = 0; q < c.n; q++) {
      const double *p = c.point + 3 * q, *n = c.normal + 3 * q;
      double out[3], in[3], g[3];
      for (int d = 0; d < 3; d++)
        out[d] = p[d] + 1e-4 * n[d], in[d] = p[d] - 1e-4 * n[d];
      bw_check_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0, 1e-12);
      ck_assert_double_lt(fabs(bw_shape_distance(b->count, b->shape, b->planar, p)), 1e-9);
      bw_check_near(bw_shape_distance(b->count, b->shape, b->planar, out), 1e-4, 1e-9);
      /* The point of a sliver (a percent of a patch) may lie on the edge itself. */
      const double depth = bw_shape_distance(b->count, b->shape, b->planar, in);
      if (c.area[q] < 0.01 * 0.15 * 0.15)
        ck_assert(depth <= 0 && depth >= -1e-4 - 1e-9);
      else
        bw_check_near(depth, -1e-4, 1e-9);
      bw_shape_normal(b->count, b->shape, b->planar, out, g);
      for (int d = 0; d < 3; d++)
        bw_check_near(g[d], n[d], 1e-9);
    }
    for (int64_t q = 0; q < 500; q++) {
      const double x[3] = {-1 + 0.37 * (double)(q % 11), -1 + 0.29 * (double)(q % 13),
                           b->planar ? 0.0 : -1 + 0.31 * (double)(q % 17)};
      const double d = fabs(bw_shape_distance(b->count, b->shape, b->planar, x));
      for (int64_t a = 0; a < c.n; a++) {
        double squared = 0;
        for (int e = 0; e < (b->planar ? 2 : 3); e++)
          squared += pow(x[e] - c.point[3 * a + e], 2);
        ck_assert_msg(squared >= d * d * (1 - 1e-9), "%s: a point is at %g, the distance is %g",
                      b->name, sqrt(squared), d);
      }
    }
    release(&c);
  }
}
END_TEST

/* Closed forms, inside, outside, beyond edges and corners. */
START_TEST(distances_of_single_shapes)
{
  const bw_shape box = BOX(.lower = {-1, -2, -3}, .upper = {1, 2, 3});
  const bw_shape ball = SPHERE(.centre = {1, 0, 0}, .radius = 2);
  const bw_shape tube = TUBE(.centre = {1, 9, 2}, .radius = 1, .axis = 1);
  const struct {
    const bw_shape *shape;
    double x[3], distance, normal[3];
  } want[] = {
      {&box, {4, 6, 3 + 12}, 13, {3 / 13.0, 4 / 13.0, 12 / 13.0}},
      {&box, {-4, 6, 0}, 5, {-0.6, 0.8, 0}},
      {&box, {0, -2.5, 1}, 0.5, {0, -1, 0}},
      {&box, {0.5, 0, 0}, -0.5, {1, 0, 0}},
      {&box, {0, 0, -2.9}, -0.1, {0, 0, -1}},
      {&ball, {1, 3, 4}, 3, {0, 0.6, 0.8}},
      {&ball, {0, 0, 0}, -1, {-1, 0, 0}},
      {&tube, {4, -70, 6}, 4, {0.6, 0, 0.8}},
      {&tube, {1, 3, 1.5}, -0.5, {0, 0, -1}},
  };
  for (size_t q = 0; q < sizeof want / sizeof want[0]; q++)
    for (int outside = 0; outside < 2; outside++) {
      bw_shape s = *want[q].shape;
      double n[3];
      s.outside = outside == 1;
      const double sign = outside ? -1 : 1;
      bw_check_near(bw_shape_distance(1, &s, false, want[q].x), sign * want[q].distance, 1e-14);
      bw_shape_normal(1, &s, false, want[q].x, n);
      for (int d = 0; d < 3; d++)
        bw_check_near(n[d], sign * want[q].normal[d], 1e-14);
    }
  const double centre[3] = {1, 0, 0};
  double n[3];
  bw_shape_normal(1, &ball, false, centre, n);
  bw_check_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0, 1e-14);
}
END_TEST

/* A site is filled where the distance is negative: the same body, asked in two ways. */
START_TEST(distances_agree_with_sites)
{
  body all[BODIES];
  make_bodies(all);
  for (int k = 0; k < BODIES; k++) {
    const body *b = &all[k];
    const double origin[3] = {0.0123, -0.0271, 0.0317}; /* no centre on a surface */
    const bw_shape_lattice l = bw_shape_lattice_straight(0.09, origin, b->planar);
    int64_t n, lo[3], hi[3], within = 0;
    int32_t *site;
    uint8_t *kind;
    bw_check_ok(bw_shape_fill(b->count, b->shape, &l, 0, 1, &n, &site, &kind, NULL));
    bw_check_ok(bw_shape_range(b->count, b->shape, &l, lo, hi));
    for (int64_t z = lo[2] - 1; z <= hi[2]; z++)
      for (int64_t y = lo[1] - 1; y <= hi[1]; y++)
        for (int64_t x = lo[0] - 1; x <= hi[0]; x++) {
          if (b->planar && z != 0) continue;
          const double at[3] = {origin[0] + 0.09 * ((double)x + 0.5),
                                origin[1] + 0.09 * ((double)y + 0.5),
                                origin[2] + 0.09 * ((double)z + 0.5)};
          if (bw_shape_distance(b->count, b->shape, b->planar, at) >= 0) continue;
          ck_assert_msg(within < n, "%s: more than the %lld sites", b->name, (long long)n);
          ck_assert(site[3 * within] == x && site[3 * within + 1] == y &&
                    site[3 * within + 2] == z);
          within++;
        }
    ck_assert_msg(within == n, "%s: %lld of %lld sites", b->name, (long long)within, (long long)n);
    bw_release(&site);
    bw_release(&kind);
  }
}
END_TEST

START_TEST(surfaces_that_are_none_are_refused)
{
  int64_t n;
  double *p, *m, *a;
  uint8_t cell = 1;
  bw_shape_mask mask = {.size = {1, 1, 1}, .spacing = {1, 1, 1}, .held = 1, .solid = &cell};
  const bw_shape image = {.kind = BW_SHAPE_MASK, .mask = &mask}, box = BOX(.upper = {1, 1, 1});
  const bw_shape endless = TUBE(.radius = 1, .axis = 2);
  bw_shape none[2] = {box, BOX(.lower = {-1, -1, -1}, .upper = {2, 2, 2}, .remove = true)};
  bw_check_status(bw_shape_points(1, &image, false, 0.5, &n, &p, &m, &a), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "mask"));
  ck_assert(isnan(bw_shape_distance(1, &image, false, (double[3]){0})));
  bw_check_status(bw_shape_points(1, &endless, false, 0.5, &n, &p, &m, &a), BW_EINPUT);
  bw_check_status(bw_shape_points(2, none, false, 0.5, &n, &p, &m, &a), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "removed"));
  bw_check_status(bw_shape_points(1, &box, false, 0, &n, &p, &m, &a), BW_EINPUT);
  ck_assert_ptr_null(p);
  const bw_shape lying[2] = {TUBE(.radius = 1, .axis = 0), box};
  bw_check_status(bw_shape_points(2, lying, true, 0.5, &n, &p, &m, &a), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "along z"));
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(areas_and_volumes_converge),         BW_TEST(points_lie_on_the_surface),
    BW_TEST(distances_of_single_shapes),         BW_TEST(distances_agree_with_sites),
    BW_TEST(surfaces_that_are_none_are_refused),
};
BW_CHECK_MAIN("shape.surface", tests)
