/* The surface of voxels: distances, normals, area and volume of bodies that were cut into voxels,
 * against their closed forms; what voxels cannot tell is refused.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape_surface.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

/* A box of voxels in which a shape is cut. */
typedef struct {
  bw_shape_mask mask;
  bw_shape body; /* what was cut */
  double volume; /* of its voxels */
} voxels;

static bool is_in(const bw_shape *s, bool planar, const double x[3])
{
  return bw_shape_distance(1, s, planar, x) < 0.0;
}

static void cut(const bw_shape *s, const int64_t size[3], const double h[3], voxels *v)
{
  const bool planar = size[2] == 1;
  *v = (voxels){.mask = {.held = size[2], .lower = {-0.3, 0.4, 0.1}}, .body = *s};
  memcpy(v->mask.size, size, sizeof v->mask.size);
  memcpy(v->mask.spacing, h, sizeof v->mask.spacing);
  bw_check_ok(BW_ALLOCATE(&v->mask.solid, (size_t)(size[0] * size[1] * size[2])));
  for (int64_t q = 0; q < size[0] * size[1] * size[2]; q++) {
    const int64_t at[3] = {q % size[0], q / size[0] % size[1], q / size[0] / size[1]};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = v->mask.lower[d] + ((double)at[d] + 0.5) * h[d];
    v->mask.solid[q] = is_in(s, planar, x);
    v->volume += v->mask.solid[q] * h[0] * h[1] * (planar ? 1.0 : h[2]);
  }
}

/* The mask without the object around it. */
static void release(voxels *v)
{
  bw_shape_mask *held = NULL;
  bw_check_ok(BW_ALLOCATE(&held, 1));
  *held = v->mask;
  bw_shape_mask_destroy(&held);
}

/* What points say: area, volume by Gauss, the sum of the area vectors, the largest and the
 * mean distance of one from the true surface, the mean of 1 - cosine between the normals. */
typedef struct {
  double area, volume, open, off, mean_off, turned;
} seen;

static seen look(const voxels *v, bool planar, double spacing)
{
  const bw_shape image = {.kind = BW_SHAPE_MASK, .mask = (bw_shape_mask *)(uintptr_t)&v->mask};
  int64_t n = 0;
  double *X = NULL, *N = NULL, *A = NULL, sum[3] = {0};
  seen s = {.area = 0.0};
  bw_check_ok(bw_shape_points(1, &image, planar, spacing, &n, &X, &N, &A));
  for (int64_t i = 0; i < n; i++) {
    double normal[3];
    bw_shape_normal(1, &v->body, planar, X + 3 * i, normal);
    s.area += A[i];
    const double off = fabs(bw_shape_distance(1, &v->body, planar, X + 3 * i));
    s.off = fmax(s.off, off);
    s.mean_off += off * A[i];
    double cosine = 0.0;
    for (int d = 0; d < (planar ? 2 : 3); d++) {
      sum[d] += N[3 * i + d] * A[i];
      s.volume += X[3 * i + d] * N[3 * i + d] * A[i] / (planar ? 2.0 : 3.0);
      cosine += N[3 * i + d] * normal[d];
    }
    s.turned += (1.0 - cosine) * A[i];
  }
  s.turned /= s.area;
  s.mean_off /= s.area;
  s.open = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / s.area;
  bw_release(&X);
  bw_release(&N);
  bw_release(&A);
  return s;
}

static const bw_shape BALL = {.kind = BW_SHAPE_SPHERE, .centre = {0.71, 1.38, 1.13}, .radius = 0.8};

/* A ball of ten voxels of radius, in cubes and in voxels half as long again in z. Where it lies
 * along the voxels their layers are plateaus six wide, up to half a voxel off, of which the mean
 * knows little: a third of a voxel there, much less elsewhere. */
START_TEST(a_ball)
{
  const double h[2][3] = {{0.08, 0.08, 0.08}, {0.08, 0.08, 0.12}};
  for (int q = 0; q < 2; q++) {
    const int64_t size[3] = {26, 26, q == 0 ? 26 : 18};
    voxels v;
    cut(&BALL, size, h[q], &v);
    bw_check_ok(bw_shape_mask_find_surface(&v.mask, false));
    for (int fine = 0; fine < 2; fine++) {
      const seen s = look(&v, false, fine ? 0.04 : 0.1);
      bw_check_near(s.volume / v.volume, 1.0, 5e-3);
      bw_check_near(s.area / (4 * pi * 0.64), 1.0, 0.015);
      bw_check_near(s.open, 0.0, 5e-3);
      ck_assert_msg(s.off < 0.35 * h[q][2], "off by %g", s.off);
      ck_assert_msg(s.mean_off < 0.15 * h[q][2], "off by %g in the mean", s.mean_off);
      ck_assert_msg(s.turned < 3e-3, "normals are turned: %g", s.turned);
    }
    /* Distances, near and far, outside of the image too. */
    const bw_shape image = {.kind = BW_SHAPE_MASK, .mask = &v.mask};
    for (int k = 0; k < 200; k++) {
      const double a = 2.4 * k, z = -1.0 + 0.01 * k, r = 0.3 + 0.011 * k;
      const double x[3] = {BALL.centre[0] + r * sqrt(1 - z * z) * cos(a),
                           BALL.centre[1] + r * sqrt(1 - z * z) * sin(a), BALL.centre[2] + r * z};
      bw_check_near(bw_shape_distance(1, &image, false, x), r - 0.8, fmax(0.2 * h[q][2], 0.05 * r));
    }
    release(&v);
  }
}
END_TEST

/* A leaning box of twenty voxels: its faces are planes that cross the voxels in steps. An edge that
 * is rounded with the radius r loses (2 - pi/2) r of its two faces, all twelve 9 % of the area
 * with two voxels, which bounds what the mean's width of one does; the volume is kept. */
START_TEST(a_leaning_box)
{
  static const bw_shape_frame leaning = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}},
                                         {0.7, 1.4, 1.1}};
  const bw_shape box = {
      .kind = BW_SHAPE_BOX, .lower = {0.3, 1.0, 0.7}, .upper = {1.1, 1.8, 1.5}, .frame = &leaning};
  const int64_t size[3] = {50, 50, 50};
  const double h[3] = {0.04, 0.04, 0.04};
  voxels v;
  cut(&box, size, h, &v);
  bw_check_ok(bw_shape_mask_find_surface(&v.mask, false));
  const bw_shape image = {.kind = BW_SHAPE_MASK, .mask = &v.mask};
  const seen s = look(&v, false, 0.05);
  bw_check_near(s.volume / 0.512, 1.0, 0.01);
  bw_check_near(s.area / (6 * 0.64), 0.955, 0.045);
  for (int k = 0; k < 100; k++) {
    /* On the face, three voxels and more from its edges, and up to two voxels off it. */
    const double u = -0.28 + 0.056 * (k % 10), w = -0.28 + 0.056 * (k / 10),
                 off = 0.016 * (k % 11 - 5);
    double x[3], normal[3], cosine = 0.0;
    for (int d = 0; d < 3; d++)
      x[d] = leaning.about[d] + (0.4 + off) * leaning.axes[0][d] + u * leaning.axes[1][d] +
             w * leaning.axes[2][d];
    bw_shape_normal(1, &image, false, x, normal);
    for (int d = 0; d < 3; d++)
      cosine += normal[d] * leaning.axes[0][d];
    bw_check_near(bw_shape_distance(1, &image, false, x), off, 0.2 * 0.04);
    ck_assert_double_gt(cosine, 0.95);
  }
  release(&v);
}
END_TEST

START_TEST(a_disc)
{
  const bw_shape disc = {
      .kind = BW_SHAPE_CYLINDER, .centre = {0.71, 1.38, 0.0}, .radius = 0.8, .axis = 2};
  const int64_t size[3] = {26, 26, 1};
  const double h[3] = {0.08, 0.08, 0.08};
  voxels v;
  cut(&disc, size, h, &v);
  bw_check_ok(bw_shape_mask_find_surface(&v.mask, true));
  const seen s = look(&v, true, 0.1);
  bw_check_near(s.volume / v.volume, 1.0, 5e-3);
  bw_check_near(s.area / (2 * pi * 0.8), 1.0, 0.015);
  ck_assert_msg(s.off < 0.35 * 0.08, "off by %g", s.off);
  ck_assert_msg(s.mean_off < 0.15 * 0.08, "off by %g in the mean", s.mean_off);
  release(&v);
}
END_TEST

/* Taken away from a box it leaves a pit as any other shape does. */
START_TEST(composed_with_others)
{
  const int64_t size[3] = {26, 26, 26};
  const double h[3] = {0.08, 0.08, 0.08};
  voxels v;
  cut(&BALL, size, h, &v);
  bw_check_ok(bw_shape_mask_find_surface(&v.mask, false));
  const bw_shape both[2] = {
      {.kind = BW_SHAPE_BOX, .lower = {-0.5, 0.2, -0.1}, .upper = {2, 2.6, 1.13}},
      {.kind = BW_SHAPE_MASK, .mask = &v.mask, .remove = true}};
  int64_t n = 0;
  double *X = NULL, *N = NULL, *A = NULL, volume = 0.0;
  bw_check_ok(bw_shape_points(2, both, false, 0.05, &n, &X, &N, &A));
  for (int64_t i = 0; i < n; i++)
    for (int d = 0; d < 3; d++)
      volume += X[3 * i + d] * N[3 * i + d] * A[i] / 3.0;
  bw_check_near(volume / (2.5 * 2.4 * 1.23 - 2.0 / 3.0 * pi * 0.512), 1.0, 5e-3);
  bw_release(&X);
  bw_release(&N);
  bw_release(&A);
  release(&v);
}
END_TEST

START_TEST(refused)
{
  const int64_t size[3] = {26, 26, 26};
  const double h[3] = {0.08, 0.08, 0.08};
  voxels v;
  cut(&BALL, size, h, &v);
  ck_assert_int_eq(bw_shape_mask_find_surface(&v.mask, true), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "26 layers"));
  v.mask.solid[0] = 1;
  ck_assert_int_eq(bw_shape_mask_find_surface(&v.mask, false), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "2 pieces that do not touch, the largest with"));
  memset(v.mask.solid, 0, 26 * 26 * 26);
  ck_assert_int_eq(bw_shape_mask_find_surface(&v.mask, false), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no voxel is solid"));
  /* A sheet one voxel thick. */
  for (int64_t k = 0; k < 26 * 26; k++)
    v.mask.solid[26 * k + 13] = 1;
  ck_assert_int_eq(bw_shape_mask_find_surface(&v.mask, false), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "take a finer image"));
  release(&v);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_ball), BW_TEST(a_leaning_box), BW_TEST(a_disc),
                                      BW_TEST(composed_with_others), BW_TEST(refused)};
BW_CHECK_MAIN("shape.field", tests)
