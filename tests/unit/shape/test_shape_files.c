/* Bodies from files.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The whole body on a straight lattice. */
static bw_status fill(int count, const bw_shape shape[], double ds, const double origin[3],
                      bool planar, int64_t *n, int32_t **site, uint8_t **kind)
{
  const bw_shape_lattice lattice = bw_shape_lattice_straight(ds, origin, planar);
  return bw_shape_fill(count, shape, &lattice, 0, 1, n, site, kind, NULL);
}

/* Names in a folder of this process. */
static char *path_of(const char *name)
{
  static char path[2][200];
  static int which;
  which = 1 - which;
  const char *folder = getenv("BW_BUILD_DIR");
  snprintf(path[which], sizeof path[which], "%s/shape_%d_%s", folder != NULL ? folder : ".",
           (int)getpid(), name);
  return path[which];
}

static void write_file(const char *name, const char *head, const void *data, size_t bytes)
{
  FILE *file = fopen(path_of(name), "wb");
  ck_assert_ptr_nonnull(file);
  ck_assert_uint_eq(fwrite(head, 1, strlen(head), file), strlen(head));
  ck_assert_uint_eq(fwrite(data, 1, bytes, file), bytes);
  fclose(file);
}

/* 3 x 2 x 2 voxels with the values 0..11; solid where 5 <= v <= 8: cells 5, 6, 7, 8. */
enum { CELLS = 12 };
static void check_cells(const bw_shape_mask *m, const double lower[3], const double spacing[3])
{
  for (int q = 0; q < CELLS; q++) {
    ck_assert_int_eq(m->solid[q], q >= 5 && q <= 8);
    const double x[3] = {lower[0] + (q % 3 + 0.4) * spacing[0],
                         lower[1] + (q / 3 % 2 + 0.6) * spacing[1],
                         lower[2] + (q / 6 + 0.5) * spacing[2]};
    ck_assert_int_eq(bw_shape_mask_at(m, 3, x), q >= 5 && q <= 8);
  }
  const double beyond[3] = {lower[0] + 3.01 * spacing[0], lower[1], lower[2]};
  ck_assert(!bw_shape_mask_at(m, 3, beyond));
}

/* Every type in both byte orders, after three bytes of something else. */
START_TEST(raw_voxels_of_every_type)
{
  const size_t bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  for (int type = 0; type < BW_SHAPE_VOXEL_COUNT; type++)
    for (int big = 0; big < 2; big++) {
      unsigned char data[8 * CELLS], one[8];
      for (int q = 0; q < CELLS; q++) {
        const float f = (float)q;
        const double d = q;
        memset(one, 0, sizeof one);
        one[0] = (unsigned char)q;
        if (type == BW_SHAPE_VOXEL_F32) memcpy(one, &f, sizeof f);
        if (type == BW_SHAPE_VOXEL_F64) memcpy(one, &d, sizeof d);
        for (size_t b = 0; b < bytes[type]; b++)
          data[bytes[type] * (size_t)q + b] = one[big ? bytes[type] - 1 - b : b];
      }
      write_file("v.raw", "abc", data, bytes[type] * CELLS);
      const bw_shape_voxels v = {.type = (bw_shape_voxel_type)type,
                                 .big_endian = big == 1,
                                 .size = {3, 2, 2},
                                 .lower = {1, 2, 3},
                                 .spacing = {0.5, 1, 2},
                                 .skip = 3};
      bw_shape_mask *m = NULL;
      bw_check_ok(bw_shape_mask_read_raw(path_of("v.raw"), &v, 5, 8, &m));
      check_cells(m, v.lower, v.spacing);
      bw_shape_mask_destroy(&m);
    }
  remove(path_of("v.raw"));
}
END_TEST

static const unsigned char CONTENT[CELLS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

/* The centre of the first voxel is at (1, 2, 3). */
static void check_image(const char *name, const char *head, bool attached)
{
  bw_shape_mask *m = NULL;
  char data[64];
  snprintf(data, sizeof data, "%s.raw", name);
  write_file(name, head, CONTENT, attached ? CELLS : 0);
  if (!attached) {
    /* the header names the data file by the last part of its path */
    const char *full = path_of(data), *last = strrchr(full, '/');
    char whole[600];
    snprintf(whole, sizeof whole, head, last != NULL ? last + 1 : full);
    write_file(name, whole, CONTENT, 0);
    write_file(data, "", CONTENT, CELLS);
  }
  bw_check_ok(bw_shape_mask_read_image(path_of(name), 5, 8, &m));
  check_cells(m, (double[3]){0.75, 1.5, 2}, (double[3]){0.5, 1, 2});
  bw_shape_mask_destroy(&m);
  remove(path_of(name));
  remove(path_of(data));
}

START_TEST(images_in_four_forms)
{
  check_image("a.nrrd",
              "NRRD0004\n# a comment\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n"
              "space directions: (0.5,0,0) (0,1,0) (0,0,2)\nspace origin: (1,2,3)\n"
              "key:=value\n\n",
              true);
  check_image("b.nhdr",
              "NRRD0001\ntype: unsigned char\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n"
              "spacings: 0.5 1 2\nspace origin: (1,2,3)\ndata file: %s\n",
              false);
  check_image("c.mhd",
              "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\n"
              "ElementSpacing = 0.5 1 2\nOffset = 1 2 3\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
              "ElementDataFile = %s\n",
              false);
  check_image("d.mha",
              "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementSpacing = 0.5 1 2\n"
              "Position = 1 2 3\nCompressedData = False\nElementDataFile = LOCAL\n",
              true);
}
END_TEST

static void refuse(const char *name, const char *head, size_t bytes, const char *word)
{
  bw_shape_mask *m = NULL;
  write_file(name, head, CONTENT, bytes);
  ck_assert_int_ne(bw_shape_mask_read_image(path_of(name), 5, 8, &m), BW_OK);
  ck_assert_ptr_null(m);
  ck_assert_msg(strstr(bw_last_message(), name) != NULL && strstr(bw_last_message(), word) != NULL,
                "%s: message \"%s\" lacks \"%s\"", name, bw_last_message(), word);
  remove(path_of(name));
}

#define NRRD_START "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\n"
START_TEST(bad_images_are_refused_by_name)
{
  bw_shape_mask *m = NULL;
  refuse("short.nrrd", NRRD_START "encoding: raw\n\n", CELLS - 1, "ends after 3 of 4 rows");
  refuse("long.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n\n", CELLS,
         "goes on");
  refuse("zip.nrrd", NRRD_START "encoding: gzip\n\n", CELLS, "damaged");
  refuse("turned.nrrd", NRRD_START "space directions: (0,1,0) (1,0,0) (0,0,1)\n\n", CELLS, "axes");
  refuse("type.nrrd", "NRRD0004\ntype: block\ndimension: 3\nsizes: 3 2 2\n\n", CELLS, "block");
  refuse("lacks.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\n\n", CELLS, "size");
  refuse("four.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 1\n\n", CELLS, "4 dim");
  refuse("order.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n\n",
         CELLS, "order");
  refuse("skip.nrrd", NRRD_START "line skip: 2\nencoding: raw\n\n", CELLS, "line skip");
  refuse("mins.nrrd", NRRD_START "axis mins: 0 0 0\nencoding: raw\n\n", CELLS, "axis mins");
  refuse("back.nrrd", NRRD_START "byte skip: -2\nencoding: raw\n\n", CELLS, "byte skip");
  refuse("endian.nrrd", NRRD_START "endian: middle\nencoding: raw\n\n", CELLS, "middle");
  refuse("flat.nrrd", NRRD_START "spacings: 1 0 1\nencoding: raw\n\n", CELLS, "spacing 0");
  refuse("where.nrrd", NRRD_START "space origin: (0,nan,0)\nencoding: raw\n\n", CELLS, "origin");
  refuse("order2.mhd", "NDims = 3\nElementByteOrderMSB = Maybe\n", CELLS, "Maybe");
  refuse("list.mhd",
         "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = LIST\n", CELLS,
         "LIST");
  refuse("turned.mha", "NDims = 3\nTransformMatrix = 0 1 0 1 0 0 0 0 1\n", CELLS, "axes");
  refuse("short.mha",
         "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n", 5,
         "ends after 1 of 4 rows");
  refuse("zero.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 0 2\n\n", CELLS, "0 voxels");
  refuse("comp.mha",
         "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nCompressedData = True\n"
         "ElementDataFile = LOCAL\n",
         CELLS, "damaged");
  refuse("rgb.mhd", "NDims = 3\nElementNumberOfChannels = 3\n", CELLS, "3 numbers");
  refuse("gone.mhd",
         "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = gone.mhd.absent\n",
         0, "cannot be opened");
  refuse("other.png", "PNG", CELLS, "neither");
  bw_check_status(bw_shape_mask_read_image(path_of("absent.nrrd"), 5, 8, &m), BW_EIO);
}
END_TEST

static void refuse_raw(const bw_shape_voxels *v, double low, double high, const char *word)
{
  bw_shape_mask *m = NULL;
  ck_assert_int_ne(bw_shape_mask_read_raw(path_of("r.raw"), v, low, high, &m), BW_OK);
  ck_assert_ptr_null(m);
  ck_assert_msg(strstr(bw_last_message(), "r.raw") != NULL &&
                    strstr(bw_last_message(), word) != NULL,
                "message \"%s\" lacks \"%s\"", bw_last_message(), word);
}

/* A raw file of 12 bytes against layouts that are not its own. */
START_TEST(wrong_layouts_are_refused_by_name)
{
  const bw_shape_voxels good = {.size = {3, 2, 2}, .spacing = {1, 1, 1}};
  bw_shape_voxels v = good;
  write_file("r.raw", "", CONTENT, CELLS);
  refuse_raw(&v, 8, 5, "low = 8");
  refuse_raw(&v, NAN, 5, "low = nan");
  v.size[2] = 3;
  refuse_raw(&v, 5, 8, "ends after 4 of 6 rows");
  v.size[2] = 1;
  refuse_raw(&v, 5, 8, "goes on after 3 x 2 x 1");
  v.size[2] = -2;
  refuse_raw(&v, 5, 8, "-2 cells");
  v = good, v.type = BW_SHAPE_VOXEL_U16;
  refuse_raw(&v, 5, 8, "size or type");
  v = good, v.type = BW_SHAPE_VOXEL_COUNT;
  refuse_raw(&v, 5, 8, "voxel type");
  v = good, v.skip = -1;
  refuse_raw(&v, 5, 8, "skip = -1");
  v = good, v.skip = 40;
  refuse_raw(&v, 5, 8, "ends after 0");
  v = good, v.spacing[1] = 0;
  refuse_raw(&v, 5, 8, "spacing 0");
  v = good, v.lower[0] = NAN;
  refuse_raw(&v, 5, 8, "origin nan");
  for (int d = 0; d < 3; d++)
    v.size[d] = 100000, v.lower[d] = 0;
  refuse_raw(&v, 5, 8, "ends after 0");
  for (int d = 0; d < 3; d++)
    v.size[d] = 2000000;
  refuse_raw(&v, 5, 8, "numbered");
  remove(path_of("r.raw"));
  refuse_raw(&good, 5, 8, "cannot be opened");
}
END_TEST

/* A tetrahedron 0, (a,0,0), (0,b,0), (0,0,c), corners counterclockwise seen from outside. */
static void tetrahedron(float a, float b, float c, int faces, const char *name, bool text)
{
  const float p[4][3] = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  FILE *file = fopen(path_of(name), "wb");
  ck_assert_ptr_nonnull(file);
  const char head[80] = "solid in name only";
  const float normal[3] = {0, 0, 0};
  const uint32_t n = (uint32_t)faces;
  if (text) fprintf(file, "solid t\n");
  if (!text) fwrite(head, 1, 80, file), fwrite(&n, 4, 1, file);
  for (int f = 0; f < faces; f++) {
    if (text) fprintf(file, "facet normal 0 0 0\nouter loop\n");
    if (!text) fwrite(normal, 4, 3, file);
    for (int k = 0; k < 3; k++) {
      const float *x = p[face[f][k]];
      if (text) fprintf(file, "vertex %g %g %g\n", (double)x[0], (double)x[1], (double)x[2]);
      if (!text) fwrite(x, 4, 3, file);
    }
    if (text) fprintf(file, "endloop\nendfacet\n");
    if (!text) fwrite("", 1, 1, file), fwrite("", 1, 1, file);
  }
  if (text) fprintf(file, "endsolid t\n");
  fclose(file);
}

/* Cells with x/a + y/b + z/c < 1 at their centre. */
START_TEST(surfaces_are_filled)
{
  for (int text = 0; text < 2; text++) {
    bw_shape_mask *m = NULL;
    tetrahedron(7.1f, 5.3f, 6.2f, 4, "t.stl", text == 1);
    bw_check_ok(bw_shape_mask_read_stl(path_of("t.stl"), 2, 0.5, &m));
    int64_t want = 0, found = 0;
    for (int64_t q = 0; q < m->size[0] * m->size[1] * m->size[2]; q++)
      found += m->solid[q];
    for (int k = 0; k < 40; k++)
      for (int j = 0; j < 40; j++)
        for (int i = 0; i < 40; i++) {
          const double x[3] = {0.5 * i + 0.25, 0.5 * j + 0.25, 0.5 * k + 0.25};
          const bool in = x[0] / 14.2 + x[1] / 10.6 + x[2] / 12.4 < 1;
          ck_assert_int_eq(bw_shape_mask_at(m, 3, x), in);
          want += in;
        }
    ck_assert_int_eq(found, want);
    ck_assert_int_gt(found, 2000);
    const bw_shape shape = {.kind = BW_SHAPE_MASK, .mask = m};
    int64_t n;
    int32_t *site;
    uint8_t *kind;
    bw_check_ok(fill(1, &shape, 0.5, (double[3]){0}, false, &n, &site, &kind));
    ck_assert_int_eq(n, want);
    bw_release(&site);
    bw_release(&kind);
    bw_shape_mask_destroy(&m);
  }
  remove(path_of("t.stl"));
}
END_TEST

static void refuse_surface(double scale, double spacing, bw_status status, const char *word)
{
  bw_shape_mask *m = NULL;
  bw_check_status(bw_shape_mask_read_stl(path_of("bad.stl"), scale, spacing, &m), status);
  ck_assert_ptr_null(m);
  ck_assert_msg(strstr(bw_last_message(), "bad.stl") != NULL &&
                    strstr(bw_last_message(), word) != NULL,
                "message \"%s\" lacks \"%s\"", bw_last_message(), word);
}

static void refuse_text(const char *text, const char *word)
{
  write_file("bad.stl", text, CONTENT, 0);
  refuse_surface(1, 0.5, BW_EINPUT, word);
}

START_TEST(bad_surfaces_are_refused_by_name)
{
  tetrahedron(7, 5, 6, 3, "bad.stl", false);
  refuse_surface(1, 0.5, BW_EINPUT, "not closed");
  refuse_surface(0, 0.5, BW_EINPUT, "scale = 0");
  refuse_surface(1, -0.5, BW_EINPUT, "spacing = -0.5");
  tetrahedron(7, 5, 6, 4, "bad.stl", false);
  refuse_surface(1, 1e-4, BW_EINPUT, "more than fit into memory");
  refuse_surface(1e9, 0.5, BW_EINPUT, "is scale = 1e+09 right?");
  tetrahedron(7, NAN, 6, 4, "bad.stl", false);
  refuse_surface(1, 0.5, BW_EINPUT, "not finite");
  tetrahedron(7, 5, 6, 4, "bad.stl", false);
  ck_assert_int_eq(truncate(path_of("bad.stl"), 84 + 3 * 50 + 20), 0);
  refuse_surface(1, 0.5, BW_EINPUT, "are not those of 4 triangles");
  refuse_text("no surface at all", "is no STL file");
  refuse_text("", "is no STL file");
  refuse_text("solid\nouter loop\nvertex 1 2\nvertex", "not three numbers");
  refuse_text("solid\nvertex 0 0 0\nvertex 1 0 0\nendloop", "2 corners");
  refuse_text("solid\nvertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0", "more than 3");
  refuse_text("solid\nvertex 0 0 0 vertex 1 0 0 vertex 1 1 0", "ends within facet 0");
  refuse_text("solid nothing\nendsolid", "no triangle");
  remove(path_of("bad.stl"));
  refuse_surface(1, 0.5, BW_EIO, "cannot be opened");
  const bw_shape shape = {.kind = BW_SHAPE_MASK};
  int64_t n;
  int32_t *site;
  uint8_t *kind;
  bw_check_status(fill(1, &shape, 1, (double[3]){0}, false, &n, &site, &kind), BW_EINPUT);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(raw_voxels_of_every_type),         BW_TEST(images_in_four_forms),
    BW_TEST(bad_images_are_refused_by_name),   BW_TEST(surfaces_are_filled),
    BW_TEST(bad_surfaces_are_refused_by_name), BW_TEST(wrong_layouts_are_refused_by_name)};
BW_CHECK_MAIN("shape.files", tests)
