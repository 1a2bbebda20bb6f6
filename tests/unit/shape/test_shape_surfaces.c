/* Closed surfaces: which are closed, what is inside, which files are read. Boxes are known by
 * counting: n cells long, they hold n of them wherever their faces lie between or on centres.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Triangles in making. */
enum { ROOM = 400 };
typedef struct {
  int n;
  float x[ROOM][3][3];
} mesh;

static void add_triangle(mesh *m, const double a[3], const double b[3], const double c[3],
                         bool turned)
{
  ck_assert_int_lt(m->n, ROOM);
  for (int d = 0; d < 3; d++) {
    m->x[m->n][0][d] = (float)a[d];
    m->x[m->n][turned ? 2 : 1][d] = (float)b[d];
    m->x[m->n][turned ? 1 : 2][d] = (float)c[d];
  }
  m->n++;
}

/* The faces of a box, each in `pieces` x `pieces` squares of two triangles on the sides of x and in
 * one square elsewhere; without the squares (skip, skip) of the first `holes` sides of x. `inward`:
 * normals point inwards. */
static void add_box(mesh *m, const double lo[3], const double hi[3], int pieces, int holes,
                    bool inward)
{
  for (int d = 0; d < 3; d++)
    for (int side = 0; side < 2; side++) {
      const int n = d == 0 ? pieces : 1, e = (d + 1) % 3, f = (d + 2) % 3;
      for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
          double p[4][3];
          if (d == 0 && side < holes && a == n / 2 && b == n / 2) continue;
          for (int c = 0; c < 4; c++) {
            p[c][d] = side ? hi[d] : lo[d];
            p[c][e] = lo[e] + (hi[e] - lo[e]) * (a + (c == 1 || c == 2)) / n;
            p[c][f] = lo[f] + (hi[f] - lo[f]) * (b + (c > 1)) / n;
          }
          add_triangle(m, p[0], p[1], p[2], (side == 0) != inward);
          add_triangle(m, p[0], p[2], p[3], (side == 0) != inward);
        }
    }
}

static char path[200];

static void write_mesh(const mesh *m)
{
  const char *folder = getenv("BW_BUILD_DIR");
  snprintf(path, sizeof path, "%s/surface_%d.stl", folder != NULL ? folder : ".", (int)getpid());
  FILE *file = fopen(path, "wb");
  ck_assert_ptr_nonnull(file);
  const char head[80] = "a box";
  const uint32_t n = (uint32_t)m->n;
  const float normal[3] = {0};
  fwrite(head, 1, 80, file), fwrite(&n, 4, 1, file);
  for (int q = 0; q < m->n; q++) {
    fwrite(normal, 4, 3, file);
    fwrite(m->x[q], 4, 9, file);
    fwrite("\0", 1, 2, file);
  }
  fclose(file);
}

/* Solid cells of size 1; the first message where it is refused: -1. */
static int64_t count_cells(const mesh *m)
{
  bw_shape_mask *mask = NULL;
  write_mesh(m);
  if (bw_shape_mask_read_stl(path, 1, 1, &mask) != BW_OK) return -1;
  int64_t n = 0;
  for (int64_t q = 0; q < mask->size[0] * mask->size[1] * mask->size[2]; q++)
    n += mask->solid[q];
  bw_shape_mask_destroy(&mask);
  remove(path);
  return n;
}

static int64_t count_boxes(int n, double lo[][3], double hi[][3])
{
  static mesh m;
  m.n = 0;
  for (int q = 0; q < n; q++)
    add_box(&m, lo[q], hi[q], 1, 0, false);
  return count_cells(&m);
}

START_TEST(bodies_that_overlap_are_their_union)
{
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {4, 0, 0}}, (double[][3]){{8, 8, 8}, {12, 8, 8}}),
      768);
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {0, 0, 0}}, (double[][3]){{8, 8, 8}, {8, 8, 8}}),
      512);
  /* They touch along a face, along an edge, at a corner; one lies within the other. */
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {4, 0, 0}}, (double[][3]){{4, 4, 4}, {8, 4, 4}}),
      128);
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {4, 4, 0}}, (double[][3]){{4, 4, 4}, {8, 8, 4}}),
      128);
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {4, 4, 4}}, (double[][3]){{4, 4, 4}, {8, 8, 8}}),
      128);
  ck_assert_int_eq(
      count_boxes(2, (double[][3]){{0, 0, 0}, {1, 1, 1}}, (double[][3]){{6, 6, 6}, {3, 3, 3}}),
      216);
  /* Three, so that the number is 3 in the middle. */
  ck_assert_int_eq(count_boxes(3, (double[][3]){{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
                               (double[][3]){{6, 6, 6}, {5, 5, 5}, {4, 4, 4}}),
                   216);
}
END_TEST

START_TEST(what_points_inwards_is_a_cavity_or_turned)
{
  static mesh m;
  bw_shape_mask *mask = NULL;
  const double lo[3] = {0}, hi[3] = {6, 6, 6}, in[3] = {1, 1, 1}, out[3] = {3, 4, 5};
  const double far[3] = {8, 0, 0}, end[3] = {10, 2, 2};
  m.n = 0;
  add_box(&m, lo, hi, 1, 0, false);
  add_box(&m, in, out, 1, 0, true);
  ck_assert_int_eq(count_cells(&m), 216 - 2 * 3 * 4);
  /* All of it inside out is the body, and the mask says so. */
  m.n = 0;
  add_box(&m, lo, hi, 2, 0, true);
  ck_assert_int_eq(count_cells(&m), 216);
  write_mesh(&m);
  bw_check_ok(bw_shape_mask_read_stl(path, 1, 1, &mask));
  ck_assert(mask->about.inside_out);
  bw_shape_mask_destroy(&mask);
  /* A body beside another one is not what a cavity is. */
  m.n = 0;
  add_box(&m, lo, hi, 1, 0, false);
  add_box(&m, far, end, 1, 0, true);
  ck_assert_int_eq(count_cells(&m), -1);
  ck_assert_msg(strstr(bw_last_message(), "inside out") != NULL, "%s", bw_last_message());
}
END_TEST

/* Faces at all places between centres and on them: n cells long always hold n cells. */
START_TEST(faces_are_all_in_or_all_out)
{
  for (int q = 0; q < 64; q++) {
    const double shift[3] = {(q % 4) / 4.0, (q / 4 % 4) / 4.0, (q / 16) / 4.0};
    double lo[1][3], hi[1][3];
    for (int d = 0; d < 3; d++)
      lo[0][d] = 3.0 + shift[d], hi[0][d] = lo[0][d] + 5 + d;
    ck_assert_int_eq(count_boxes(1, lo, hi), 5 * 6 * 7);
  }
}
END_TEST

/* The same in metres, which corners in single precision hold to seven digits: each face through
 * centres is off by its own rounding. */
START_TEST(rounding_does_not_fray_faces)
{
  static mesh m;
  for (int q = 0; q < 40; q++) {
    bw_shape_mask *mask = NULL;
    bw_shape_surface_config c = bw_shape_surface_config_default();
    bw_shape_solid solid;
    const double h = 0.1 / 16;
    const double lo[3] = {h * (q + 0.5), h * (q % 7 + 0.5), h * (q % 5 + 0.5)};
    const double hi[3] = {lo[0] + 8 * h, lo[1] + 8 * h, lo[2] + 8 * h};
    m.n = 0;
    add_box(&m, lo, hi, 1, 0, false);
    write_mesh(&m);
    c.scale = 1, c.spacing = h;
    bw_check_ok(bw_shape_mask_open_stl(path, &c, &mask));
    bw_check_ok(bw_shape_mask_measure(mask, 0, mask->size[2], lo, hi, &solid));
    ck_assert_int_eq((int)lround(solid.volume / (h * h * h)), 512);
    bw_shape_mask_destroy(&mask);
  }
  remove(path);
}
END_TEST

/* A face that leans, through centres: they are of one side, so that the two halves of a box are the
 * box. */
START_TEST(two_halves_are_the_whole)
{
  static mesh m[2];
  int64_t sum = 0;
  for (int half = 0; half < 2; half++) {
    /* The prism of the triangle (0,0) (8,0) (8,8), or of its mirror image, 4 cells high. */
    double p[6][3] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 0, 4}, {8, 0, 4}, {8, 8, 4}};
    const int face[8][3] = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                            {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    m[half].n = 0;
    for (int q = 0; q < 8; q++) {
      double x[3][3];
      for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
          x[c][d] = p[face[q][c]][half && d < 2 ? 1 - d : d];
      add_triangle(&m[half], x[0], x[1], x[2], half == 1);
    }
    const int64_t n = count_cells(&m[half]);
    ck_assert_int_gt(n, 4 * 27);
    sum += n;
  }
  ck_assert_int_eq(sum, 256);
}
END_TEST

static void refuse(const mesh *m, const char *word)
{
  ck_assert_int_eq(count_cells(m), -1);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "message \"%s\" lacks \"%s\"",
                bw_last_message(), word);
}

START_TEST(closedness_is_a_matter_of_edges)
{
  static mesh m;
  const double lo[3] = {0}, hi[3] = {8, 8, 8};
  /* Sides of x in pieces, the others not: still closed. */
  m.n = 0;
  add_box(&m, lo, hi, 4, 0, false);
  ck_assert_int_eq(count_cells(&m), 512);
  /* Holes, one or two that face each other. */
  for (int holes = 1; holes <= 2; holes++) {
    m.n = 0;
    add_box(&m, lo, hi, 4, holes, false);
    refuse(&m, "not closed");
  }
  m.n = 0;
  add_box(&m, lo, hi, 1, 0, false);
  memcpy(m.x[m.n], m.x[5], sizeof m.x[5]);
  m.n++;
  refuse(&m, "triangles 5 and 12 are the same");
  /* A sheet has no inside. */
  m.n = 0;
  add_triangle(&m, lo, hi, (double[3]){0, 8, 0}, false);
  refuse(&m, "not closed");
}
END_TEST

/* Facets whose normals point to the wrong side, in a body and in a cavity, one and a whole side
 * with edges of its own: each comes right by its neighbours. */
START_TEST(single_facets_are_turned)
{
  static mesh m;
  bw_shape_mask *mask = NULL;
  for (int pieces = 1; pieces <= 2; pieces++)
    for (int wrong = 1; wrong <= 2 * pieces * pieces; wrong++) {
      m.n = 0;
      add_box(&m, (double[3]){0}, (double[3]){8, 8, 8}, pieces, 0, false);
      add_box(&m, (double[3]){2, 2, 2}, (double[3]){4, 4, 4}, pieces, 0, true);
      for (int q = 0; q < wrong; q++)
        for (int part = 0; part < 2; part++)
          for (int d = 0; d < 3; d++) {
            float(*x)[3] = m.x[q + part * m.n / 2];
            const float t = x[0][d];
            x[0][d] = x[1][d], x[1][d] = t;
          }
      ck_assert_msg(count_cells(&m) == 512 - 8, "%d of %d: %s", wrong, pieces, bw_last_message());
      write_mesh(&m);
      bw_check_ok(bw_shape_mask_read_stl(path, 1, 1, &mask));
      ck_assert_int_eq(mask->about.turned, 2 * wrong);
      bw_shape_mask_destroy(&mask);
    }
  remove(path);
}
END_TEST

/* Where the caller wants it: the box's corner on the lattice, of which any part may be held. */
START_TEST(a_surface_is_put_and_held_by_layers)
{
  static mesh m;
  bw_shape_mask *mask = NULL;
  bw_shape_surface_config c = bw_shape_surface_config_default();
  bw_shape_solid solid;
  const double length[3] = {2.0, 1.5, 2.5};
  m.n = 0;
  add_box(&m, (double[3]){-7.3, 100.1, 5}, (double[3]){-3.3, 103.1, 10}, 3, 0, false);
  write_mesh(&m);
  bw_check_status(bw_shape_mask_open_stl(path, &c, &mask), BW_EINPUT);
  c.scale = 0.5, c.spacing = 0.25, c.placed = true;
  for (int d = 0; d < 3; d++)
    c.at[d] = d + 1.0, c.origin[d] = 0.0;
  bw_check_ok(bw_shape_mask_open_stl(path, &c, &mask));
  ck_assert_int_eq(mask->held, 0);
  for (int d = 0; d < 3; d++)
    ck_assert_double_eq_tol(mask->about.length[d], length[d], 1e-5);
  bw_check_ok(bw_shape_mask_hold(mask, 3, 2));
  ck_assert_int_eq(mask->held, 2);
  for (int q = 0; q < 40 * 40; q++) {
    const double x[3] = {0.25 * (q % 40) + 0.125, 0.25 * (q / 40) + 0.125,
                         mask->lower[2] + 3.5 * 0.25};
    const bool in = x[0] > 1 && x[0] < 3 && x[1] > 2 && x[1] < 3.5;
    ck_assert_int_eq(bw_shape_mask_at(mask, 3, x), in);
  }
  /* Volume 2 x 1.5 x 2.5, of which a box takes a quarter along x and half along z. */
  bw_check_ok(bw_shape_mask_measure(mask, 0, mask->size[2], (double[3]){2.5, 0, 3},
                                    (double[3]){9, 9, 4.25}, &solid));
  ck_assert_double_eq_tol(solid.volume, 7.5, 1e-12);
  ck_assert_double_eq_tol(solid.inside, 7.5 / 8, 1e-5);
  bw_shape_mask_destroy(&mask);
  remove(path);
}
END_TEST

/* A cube in text, written by hand in ways that tools have. */
static void check_text(const char *head, const char *keyword, const char *tail)
{
  bw_shape_mask *mask = NULL;
  static mesh m;
  m.n = 0;
  add_box(&m, (double[3]){0}, (double[3]){3, 3, 3}, 1, 0, false);
  write_mesh(&m);
  FILE *file = fopen(path, "wb");
  fputs(head, file);
  for (int q = 0; q < m.n; q++) {
    fprintf(file, "facet normal 0 0 0\n outer loop\n");
    for (int c = 0; c < 3; c++)
      fprintf(file, "  %s %g %.3e %f\n", keyword, (double)m.x[q][c][0], (double)m.x[q][c][1],
              (double)m.x[q][c][2]);
    fprintf(file, " EndLoop\nendfacet\n");
  }
  fputs(tail, file);
  fclose(file);
  bw_check_ok(bw_shape_mask_read_stl(path, 1, 1, &mask));
  ck_assert_int_eq(mask->size[0] * mask->size[1] * mask->size[2], 27);
  for (int q = 0; q < 27; q++)
    ck_assert_int_eq(mask->solid[q], 1);
  bw_shape_mask_destroy(&mask);
  remove(path);
}

START_TEST(text_of_other_tools_is_read)
{
  check_text("solid\n", "vertex", "endsolid\n");
  check_text("SOLID Part\n", "VERTEX", "ENDSOLID Part\n");
  check_text("\xEF\xBB\xBFsolid a\n", "vertex", "endsolid a");
  check_text("\n \r\nsolid a\r\n", "vertex", "endsolid a\r\n");
  check_text("solid my vertex cloud\n", "vertex", "endsolid my vertex cloud\n");
  check_text("solid outer endloop facet\n", "Vertex", "endsolid outer endloop facet\n");
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(bodies_that_overlap_are_their_union),
                                      BW_TEST(what_points_inwards_is_a_cavity_or_turned),
                                      BW_TEST(faces_are_all_in_or_all_out),
                                      BW_TEST(rounding_does_not_fray_faces),
                                      BW_TEST(two_halves_are_the_whole),
                                      BW_TEST(closedness_is_a_matter_of_edges),
                                      BW_TEST(single_facets_are_turned),
                                      BW_TEST(a_surface_is_put_and_held_by_layers),
                                      BW_TEST(text_of_other_tools_is_read)};
BW_CHECK_MAIN("shape.surfaces", tests)
