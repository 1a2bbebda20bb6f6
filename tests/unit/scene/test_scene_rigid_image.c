/* Rigid bodies from voxels and from surfaces of triangles: mass, centre and inertia against
 * closed forms, the force of a stream against that on the shape that was cut into voxels,
 * refusals.
 * TEST ranks=1,2 */
#include "scene_text.h"

/* A NRRD of n x n x layers voxels, 255 within the radius of the centre [voxels]. */
static const char *image_of(const char *name, int n, int layers, double radius, int extra)
{
  static char path[128];
  snprintf(path, sizeof path, "%s_np%d.nrrd", name, bw_comm_size(bw_check_world()));
  if (bw_comm_rank(bw_check_world()) == 0) {
    FILE *out = fopen(path, "wb");
    ck_assert_ptr_nonnull(out);
    fprintf(out, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nencoding: raw\n\n", n, n,
            layers);
    for (int q = 0; q < n * n * layers; q++) {
      const double x = q % n + 0.5 - 0.5 * n, y = q / n % n + 0.5 - 0.5 * n;
      const double z = q / n / n + 0.5 - 0.5 * layers;
      fputc(x * x + y * y + z * z < radius * radius || q < extra ? 255 : 0, out);
    }
    ck_assert_int_eq(fclose(out), 0);
  }
  bw_comm_barrier(bw_check_world());
  return path;
}

/* The box from 0 to (a, b, c) as text, two facets a side. */
static const char *box_of(double a, double b, double c)
{
  static const int corner[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                    {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                    {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  static char path[128];
  snprintf(path, sizeof path, "box_np%d.stl", bw_comm_size(bw_check_world()));
  if (bw_comm_rank(bw_check_world()) == 0) {
    FILE *out = fopen(path, "w");
    ck_assert_ptr_nonnull(out);
    fputs("solid box\n", out);
    for (int f = 0; f < 12; f++) {
      fputs("facet normal 0 0 0\nouter loop\n", out);
      for (int k = 0; k < 3; k++)
        fprintf(out, "vertex %g %g %g\n", a * (corner[f][k] & 1), b * (corner[f][k] >> 1 & 1),
                c * (corner[f][k] >> 2));
      fputs("endloop\nendfacet\n", out);
    }
    fputs("endsolid box\n", out);
    ck_assert_int_eq(fclose(out), 0);
  }
  bw_comm_barrier(bw_check_world());
  return path;
}

#define SOLID                                                                                      \
  "materials: {m: {density: 3, young_modulus: 100}}\ngravity: [0, 0, -1]\nphases: {until: 0.2}\n"  \
  "gauges: {a: {body: a, of: [position, velocity]}}\n"

/* A ball of ten voxels: two fifths of m r^2; it falls as everything does. */
START_TEST(a_ball_of_voxels)
{
#ifdef __SANITIZE_ADDRESS__ /* a minute; the disc and test_shape_field go the same ways */
  return;
#endif
  char text[1024];
  snprintf(text, sizeof text,
           SOLID "bodies: {a: {shape: {image: {file: %s, low: 128, voxel: 0.05, at: [1, 2, 3]}}, "
                 "material: m, motion: rigid, spacing: 0.1}}\n",
           image_of("ball", 26, 26, 10.0, 0));
  bw_scene *s = made(text);
  const bw_rigid_state a = bw_rigid_state_of(s->rigid, 0);
  const double volume = 4.0 / 3.0 * acos(-1.0) * 0.125, moment = 0.4 * 3 * volume * 0.25;
  /* Voxels count a ball of ten to 1 %; its surface holds what they do. */
  bw_check_near(a.volume / volume, 1.0, 0.012);
  bw_check_near(a.mass / (3 * volume), 1.0, 0.012);
  for (int d = 0; d < 3; d++) {
    bw_check_near(a.position[d], 1.0 + d + 0.65, 0.002);
    bw_check_near(a.inertia[d] / moment, 1.0, 0.02);
  }
  run(s);
  bw_check_near(gauge(s, "a.velocity.z"), -0.2, 1e-6);
  bw_scene_destroy(&s);
}
END_TEST

/* A box of triangles, filled with cells of a fortieth of its length. */
START_TEST(a_box_of_triangles)
{
#ifdef __SANITIZE_ADDRESS__ /* a minute; the disc and test_shape_field go the same ways */
  return;
#endif
  char text[1024];
  snprintf(text, sizeof text,
           SOLID "bodies: {a: {shape: {stl: {file: %s, unit: 1, cell: 0.02}}, "
                 "material: m, motion: rigid, spacing: 0.06}}\n",
           box_of(0.8, 0.4, 0.2));
  bw_scene *s = made(text);
  const bw_rigid_state a = bw_rigid_state_of(s->rigid, 0);
  const double m = 3 * 0.8 * 0.4 * 0.2, L[3] = {0.8, 0.4, 0.2};
  double found[3] = {a.inertia[0], a.inertia[1], a.inertia[2]};
  bw_check_near(a.mass / m, 1.0, 5e-3);
  /* Principal moments come in any order: they are told apart by their size. Edges that are rounded
   * take 2 % of the shortest. */
  for (int d = 0; d < 3; d++) {
    const double right =
        m / 12.0 * (L[(d + 1) % 3] * L[(d + 1) % 3] + L[(d + 2) % 3] * L[(d + 2) % 3]);
    double least = HUGE_VAL;
    for (int e = 0; e < 3; e++)
      least = fmin(least, fabs(found[e] / right - 1.0));
    bw_check_near(least, 0.0, 0.025);
    bw_check_near(a.position[d], 0.5 * L[d], 2e-3);
  }
  bw_scene_destroy(&s);
}
END_TEST

/* The mean force of a stream on a held disc from t = 0.3 on. */
static double force_on(const char *shape)
{
  char text[2048];
  snprintf(text, sizeof text,
           "domain: {length: [2, 1, 0.0625], cells: [32, 16, 1]}\n"
           "fluid:\n  density: 1\n  viscosity: 0.02\n  start: {velocity: [1, 0, 0]}\n  sides:\n"
           "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
           "    y: {lower: {kind: free_slip}, upper: {kind: free_slip}}\n"
           "bodies:\n  disc: {shape: %s, motion: rigid, rigid: {mass: 1, held: [x, y, turn]}}\n"
           "phases: {until: 0.6}\nnumerics: {step: 0.01}\ngauges: {d: {body: disc, of: force}}\n",
           shape);
  bw_scene *s = made(text);
  double sum = 0.0;
  while (!bw_scene_done(s)) {
    bw_check_ok(bw_scene_step(s, INFINITY));
    if (bw_scene_time(s) > 0.3) sum += gauge(s, "d.reaction.x");
  }
  bw_scene_destroy(&s);
  return sum;
}

/* A disc of ten voxels of radius and the true one, 6.4 cells across: a tenth of a voxel, which
 * the surface is off, is 1 % of the width; in a channel that it closes by two fifths the force
 * grows with some three times that. */
START_TEST(a_disc_in_a_stream)
{
  char shape[256];
  snprintf(shape, sizeof shape, "{image: {file: %s, low: 128, voxel: 0.02, at: [0.74, 0.24, 0]}}",
           image_of("disc", 26, 1, 10.0, 0));
  const double voxels = force_on(shape);
  const double disc = force_on("{sphere: {centre: [1, 0.5], radius: 0.2}}");
  ck_assert_double_gt(disc, 0.0);
  bw_check_near(voxels / disc, 1.0, 0.04);
}
END_TEST

START_TEST(refused)
{
  static const struct {
    int layers, extra;
    double radius;
    const char *says;
  } cases[] = {{26, 1, 10.0, "are 2 pieces that do not touch"},
               {26, 0, 0.2, "no voxel is solid"},
               {26, 0, 1.1, "take a finer image"}};
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    char text[1024];
    snprintf(text, sizeof text,
             SOLID "bodies: {a: {shape: {image: {file: %s, low: 128, voxel: 0.05, at: [1, 2, 3]}}, "
                   "material: m, motion: rigid, spacing: 0.1}}\n",
             image_of("bad", 26, cases[q].layers, cases[q].radius, cases[q].extra));
    ck_assert_ptr_null(scene_of(text));
    ck_assert_msg(strstr(bw_last_message(), cases[q].says) != NULL, "%s", bw_last_message());
    ck_assert_msg(strstr(bw_last_message(), "bodies.a.shape") != NULL, "%s", bw_last_message());
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_ball_of_voxels), BW_TEST(a_box_of_triangles),
                                      BW_TEST(a_disc_in_a_stream), BW_TEST(refused)};
BW_CHECK_MAIN("scene.rigid_image", tests)
