/* Images as the tools of the trade write them: every one holds the same 12 voxels, or is refused
 * with what was found.
 * BUILD libs=zlib
 * TEST ranks=1 */
#include "twelve_voxels.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

/* Voxels in two bytes each. */
static void widen(const unsigned char from[], uint16_t to[])
{
  for (int q = 0; q < CELLS; q++)
    to[q] = from[q];
}

#define NRRD "NRRD0004\ndimension: 3\nsizes: 3 2 2\n"
START_TEST(words_of_nrrd)
{
  uint16_t wide[CELLS];
  uint64_t whole[CELLS];
  bw_shape_mask *m;
  widen(CONTENT, wide);
  for (int q = 0; q < CELLS; q++)
    whole[q] = CONTENT[q];
  const char *eight[] = {"uchar", "Unsigned Char", "UINT8", "int8_t", NULL};
  const char *two[] = {"short", "signed short", "unsigned short int", "uint16", NULL};
  const char *long_ones[] = {"int64", "unsigned long long", "LongLong", NULL};
  char head[300];
  for (int q = 0; eight[q] != NULL; q++) {
    snprintf(head, sizeof head, NRRD "TYPE: %s\nencoding: Raw\nspacings: 1 2 3\n\n", eight[q]);
    write_file("a.nrrd", head, CONTENT, CELLS);
    m = must_read("a.nrrd");
    expect_spacing(m, 1, 2, 3);
    ck_assert(isnan(m->about.unit));
    bw_shape_mask_destroy(&m);
  }
  for (int q = 0; two[q] != NULL; q++) {
    snprintf(head, sizeof head, NRRD "type: %s\nEndian: LITTLE\nencoding: raw\n\n", two[q]);
    write_file("a.nrrd", head, wide, sizeof wide);
    m = must_read("a.nrrd");
    ck_assert(!m->about.has_spacing);
    bw_shape_mask_destroy(&m);
  }
  for (int q = 0; long_ones[q] != NULL; q++) {
    snprintf(head, sizeof head, NRRD "type: %s\nendian: little\nencoding: raw\n\n", long_ones[q]);
    write_file("a.nrrd", head, whole, sizeof whole);
    m = must_read("a.nrrd");
    bw_shape_mask_destroy(&m);
  }
  write_file("a.nrrd", NRRD "type: uint8\nfancy: 3\n\n", CONTENT, CELLS);
  must_refuse("a.nrrd", "no field \"fancy\"");
  write_file("a.nrrd", "NRRD0004\nsizes: 3 2 2\ndimension: 3\n\n", CONTENT, CELLS);
  must_refuse("a.nrrd", "before \"dimension\"");
  write_file("a.nrrd", "NRRD0004\ndimension: 3\nsizes: 3 2 2 1\n\n", CONTENT, CELLS);
  must_refuse("a.nrrd", "found more");
  write_file("a.nrrd", NRRD "type: uint8\nkinds: RGB-color domain domain\n\n", CONTENT, CELLS);
  must_refuse("a.nrrd", "RGB-color");
  write_file("a.nrrd", NRRD "type: uint8\nencoding: ascii\n\n", CONTENT, CELLS);
  must_refuse("a.nrrd", "ascii");
  remove(path_of("a.nrrd"));
}
END_TEST

/* Lengths in metres by the unit that the file names; axes along x, y, z or against them. */
START_TEST(units_and_axes)
{
  bw_shape_mask *m;
  write_file("u.nrrd",
             NRRD "type: uint8\nspacings: 1 2 4\nunits: \"mm\" \"mm\" \"mm\"\nencoding: raw\n\n",
             CONTENT, CELLS);
  m = must_read("u.nrrd");
  expect_spacing(m, 1e-3, 2e-3, 4e-3);
  ck_assert(m->about.unit == 1e-3);
  bw_shape_mask_destroy(&m);
  write_file("u.nrrd",
             NRRD "type: uint8\nspace directions: (2,1e-19,0) (-0.0,3,0) (0,1e-12,4)\n"
                  "space units: \"microns\" \"\xc2\xb5m\" \"um\"\nspace origin: (10,20,30)\n"
                  "encoding: raw\n\n",
             CONTENT, CELLS);
  m = must_read("u.nrrd");
  expect_spacing(m, 2e-6, 3e-6, 4e-6);
  ck_assert(fabs(m->lower[0] - 9e-6) < 1e-12 && fabs(m->lower[2] - 28e-6) < 1e-12);
  bw_shape_mask_destroy(&m);
  /* x runs backwards: the last number of a row comes first, and the box ends behind the origin. */
  write_file("u.nrrd",
             NRRD "type: uint8\nspace directions: (-2,0,0) (0,3,0) (0,0,4)\nencoding: raw\n"
                  "space origin: (10,0,0)\n\n",
             (const unsigned char[CELLS]){2, 1, 0, 5, 4, 3, 8, 7, 6, 11, 10, 9}, CELLS);
  m = must_read("u.nrrd");
  expect_spacing(m, 2, 3, 4);
  ck_assert(fabs(m->lower[0] - (10 - 5)) < 1e-12);
  bw_shape_mask_destroy(&m);
  write_file("u.nrrd",
             NRRD "type: uint8\nspace directions: (2,1e-3,0) (0,3,0) (0,0,4)\nencoding: raw\n\n",
             CONTENT, CELLS);
  must_refuse("u.nrrd", "axes have to be along");
  /* All words for a unit that are read. */
  static const struct {
    const char *word;
    double metres;
  } words[] = {{"m", 1},         {"meter", 1},   {"metre", 1},     {"dm", 0.1},
               {"cm", 0.01},     {"mm", 1e-3},   {"MM", 1e-3},     {"millimeter", 1e-3},
               {"micron", 1e-6}, {"um", 1e-6},   {"nm", 1e-9},     {"micrometer", 1e-6},
               {"km", 1e3},      {"in", 0.0254}, {"inch", 0.0254}, {"inches", 0.0254},
               {"pm", 1e-12}};
  for (size_t q = 0; q < sizeof words / sizeof words[0]; q++) {
    char head[300];
    snprintf(head, sizeof head,
             NRRD "type: uint8\nspacings: 1 1 1\nunits: \"%s\" \"%s\" \"%s\"\nencoding: raw\n\n",
             words[q].word, words[q].word, words[q].word);
    write_file("u.nrrd", head, CONTENT, CELLS);
    m = must_read("u.nrrd");
    ck_assert_msg(fabs(m->about.unit / words[q].metres - 1) < 1e-15, "%s", words[q].word);
    bw_shape_mask_destroy(&m);
  }
  write_file("u.nrrd", NRRD "type: uint8\nunits: \"mm\" \"mm\" \"cm\"\n\n", CONTENT, CELLS);
  must_refuse("u.nrrd", "all axes need the same unit");
  write_file("u.nrrd", NRRD "type: uint8\nunits: \"mm\" \"mm\" \"s\"\n\n", CONTENT, CELLS);
  must_refuse("u.nrrd", "no unit of length");
  remove(path_of("u.nrrd"));
}
END_TEST

#define META "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\n"
START_TEST(keys_of_metaimage)
{
  bw_shape_mask *m;
  write_file("a.mha",
             META "BinaryData = true\nElementSpacing = 1 2 3\nDistanceUnits = mm\n"
                  "CompressedData = FALSE\nITK_Filter = none\nElementDataFile = local\n",
             CONTENT, CELLS);
  m = must_read("a.mha");
  expect_spacing(m, 1e-3, 2e-3, 3e-3);
  ck_assert_str_eq(m->about.not_read, "ITK_Filter");
  bw_shape_mask_destroy(&m);
  /* Whatever comes before: the numbers are the end. */
  write_file("a.mha", META "HeaderSize = -1\nElementDataFile = LOCAL\nmore than these", CONTENT,
             CELLS);
  m = must_read("a.mha");
  bw_shape_mask_destroy(&m);
  write_file("a.mha", META "elementspacing = 1 2 3\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "is ElementSpacing meant?");
  write_file("a.mha", META "Element Spacing = 1 2 3\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "is ElementSpacing meant?");
  write_file("a.mha", META "ElementSpacng = 1 2 3\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "is ElementSpacing meant?");
  write_file("a.mha", META "BinaryData = False\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "as text");
  write_file("a.mha", META "CompressedData = Perhaps\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "True or False");
  write_file("a.mha", META "HeaderSize = -2\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  must_refuse("a.mha", "HeaderSize");
  remove(path_of("a.mha"));
}
END_TEST

/* zlib's wrapper around the packed bytes: gzip's or its own. */
static size_t pack(bool gzip, const void *from, size_t bytes, unsigned char to[200])
{
  z_stream z = {0};
  ck_assert_int_eq(deflateInit2(&z, 9, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY),
                   Z_OK);
  z.next_in = (unsigned char *)(uintptr_t)from, z.avail_in = (unsigned)bytes;
  z.next_out = to, z.avail_out = 200;
  ck_assert_int_eq(deflate(&z, Z_FINISH), Z_STREAM_END);
  deflateEnd(&z);
  return 200 - z.avail_out;
}

START_TEST(packed_voxels)
{
  unsigned char packed[400];
  uint16_t wide[CELLS];
  bw_shape_mask *m = NULL;
  widen(CONTENT, wide);
  size_t n = pack(true, wide, sizeof wide, packed);
  const char *head = NRRD "type: ushort\nendian: little\nencoding: gzip\n\n";
  write_file("z.nrrd", head, packed, n);
  m = must_read("z.nrrd");
  bw_shape_mask_destroy(&m);
  /* One layer of it. */
  bw_check_ok(bw_shape_mask_open_image(path_of("z.nrrd"), 5, 8, &m));
  bw_check_ok(bw_shape_mask_hold(m, 1, 1));
  for (int q = 0; q < 6; q++)
    ck_assert_int_eq(m->solid[q], q + 6 <= 8);
  bw_shape_mask_destroy(&m);
  /* Two streams, one behind the other, are one file of gzip. */
  n = pack(true, wide, 10, packed);
  n += pack(true, (char *)wide + 10, sizeof wide - 10, packed + n);
  write_file("z.nrrd", head, packed, n);
  m = must_read("z.nrrd");
  bw_shape_mask_destroy(&m);
  n = pack(true, wide, sizeof wide, packed);
  write_file("z.nrrd", head, packed, n - 3);
  must_refuse("z.nrrd", "break off");
  packed[n - 6] ^= 1; /* in the check sum */
  write_file("z.nrrd", head, packed, n);
  must_refuse("z.nrrd", "damaged");
  n = pack(true, wide, sizeof wide - 2, packed);
  write_file("z.nrrd", head, packed, n);
  must_refuse("z.nrrd", "too few");
  write_file("z.nrrd",
             "NRRD0004\ndimension: 3\nsizes: 3 2 1\ntype: ushort\nendian: little\n"
             "encoding: gz\n\n",
             packed, n);
  must_refuse("z.nrrd", "more than 3 x 2 x 1");
  n = pack(false, CONTENT, CELLS, packed);
  write_file("z.mha", META "CompressedData = True\nElementDataFile = LOCAL\n", packed, n);
  m = must_read("z.mha");
  bw_shape_mask_destroy(&m);
  remove(path_of("z.mha"));
  remove(path_of("z.nrrd"));
}
END_TEST

/* What a header claims is not asked for: with little memory left, the file's size
 * decides. */
START_TEST(headers_that_claim_too_much)
{
  struct rlimit was, low;
  ck_assert_int_eq(getrlimit(RLIMIT_AS, &was), 0);
  low = was;
#if !defined(__SANITIZE_ADDRESS__)
  low.rlim_cur = (rlim_t)4 << 30;
#endif
  ck_assert_int_eq(setrlimit(RLIMIT_AS, &low), 0);
  const char *big = "NRRD0004\ndimension: 3\nsizes: 100000 100000 900000\ntype: uint8\nencoding: ";
  char head[200];
  snprintf(head, sizeof head, "%sraw\n\n", big);
  write_file("big.nrrd", head, CONTENT, CELLS);
  must_refuse("big.nrrd", "ends after 0");
  snprintf(head, sizeof head, "%sgzip\n\n", big);
  write_file("big.nrrd", head, CONTENT, CELLS);
  must_refuse("big.nrrd", "cannot unpack to");
  snprintf(head, sizeof head, "%sraw\nbyte skip: -1\n\n", big);
  write_file("big.nrrd", head, CONTENT, CELLS);
  must_refuse("big.nrrd", "fewer than");
  remove(path_of("big.nrrd"));
  ck_assert_int_eq(setrlimit(RLIMIT_AS, &was), 0);
}
END_TEST

static void write_npy(const char *dictionary, const void *data, size_t bytes)
{
  char head[200];
  FILE *file = fopen(path_of("a.npy"), "wb");
  ck_assert_ptr_nonnull(file);
  const int n = snprintf(head, sizeof head, "%s\n", dictionary);
  fwrite("\x93NUMPY\x01", 1, 7, file);
  fputc(0, file), fputc(n, file), fputc(0, file);
  fwrite(head, 1, (size_t)n, file);
  fwrite(data, 1, bytes, file);
  fclose(file);
}

START_TEST(arrays_of_numpy)
{
  bw_shape_mask *m;
  unsigned char big[2 * CELLS];
  for (int q = 0; q < CELLS; q++)
    big[2 * q] = 0, big[2 * q + 1] = CONTENT[q];
  write_npy("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 3), }", CONTENT, CELLS);
  m = must_read("a.npy");
  ck_assert(!m->about.has_spacing);
  bw_shape_mask_destroy(&m);
  write_npy("{'shape': (2, 2, 3), 'descr': '>i2', 'fortran_order': False}", big, sizeof big);
  m = must_read("a.npy");
  bw_shape_mask_destroy(&m);
  write_npy("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 2, 3), }", CONTENT, CELLS);
  must_refuse("a.npy", "ascontiguousarray");
  write_npy("{'descr': '<c8', 'fortran_order': False, 'shape': (2, 2, 3), }", CONTENT, CELLS);
  must_refuse("a.npy", "type");
  write_npy("{'descr': '|u1', 'fortran_order': False, 'shape': (12,), }", CONTENT, CELLS);
  must_refuse("a.npy", "2 or 3 dimensions");
  write_npy("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 4), }", CONTENT, CELLS);
  must_refuse("a.npy", "ends after 3 of 4 rows");
  remove(path_of("a.npy"));
}
END_TEST

/* A part, and its mirror images: by cell, as counted in the whole. */
START_TEST(crop_and_flip)
{
  write_file("c.mha", META "ElementSpacing = 1 2 4\nElementDataFile = LOCAL\n", CONTENT, CELLS);
  for (int q = 0; q < 8; q++)
    for (int first = 0; first < 2; first++) {
      /* Flipped before and after it is cropped: which cell of the file lies at (0, 0, 0). */
      bw_shape_mask *m = NULL;
      const int64_t from[3] = {1, 0, 1}, to[3] = {3, 2, 2};
      int64_t cell[3];
      bw_check_ok(bw_shape_mask_open_image(path_of("c.mha"), 0, 11, &m));
      const double corner = m->lower[0];
      if (first == 0) bw_check_ok(bw_shape_mask_crop(m, from, to));
      for (int d = 0; d < 3; d++)
        if (q >> d & 1) bw_check_ok(bw_shape_mask_flip(m, d));
      if (first == 1) bw_check_ok(bw_shape_mask_crop(m, from, to));
      const int whole[3] = {NX, NY, NZ};
      for (int d = 0; d < 3; d++) {
        cell[d] = first == 0 || !(q >> d & 1) ? from[d] : whole[d] - to[d];
        if (q >> d & 1) cell[d] += to[d] - from[d] - 1;
      }
      const double value = (double)(cell[0] + NX * (cell[1] + NY * cell[2]));
      ck_assert(m->size[0] == 2 && m->size[1] == 2 && m->size[2] == 1);
      ck_assert(fabs(m->lower[0] - corner - 1.0) < 1e-12);
      bw_shape_mask_destroy(&m);
      /* That value alone is solid: it lies at the mask's first cell. */
      bw_check_ok(bw_shape_mask_open_image(path_of("c.mha"), value, value, &m));
      if (first == 0) bw_check_ok(bw_shape_mask_crop(m, from, to));
      for (int d = 0; d < 3; d++)
        if (q >> d & 1) bw_check_ok(bw_shape_mask_flip(m, d));
      if (first == 1) bw_check_ok(bw_shape_mask_crop(m, from, to));
      bw_check_ok(bw_shape_mask_hold(m, 0, 1));
      for (int k = 0; k < 4; k++)
        ck_assert_int_eq(m->solid[k], k == 0);
      bw_shape_mask_destroy(&m);
    }
  remove(path_of("c.mha"));
}
END_TEST

/* Blocks of voxels, solid where half of them are, also of a part and its mirror image, read layer
 * by layer; what makes no whole block is left out. */
START_TEST(blocks_of_voxels)
{
  enum { EDGE = 11 };
  static const int factor[][3] = {{1, 1, 1}, {2, 2, 2}, {3, 1, 2}, {5, 4, 3}};
  static unsigned char fine[EDGE * EDGE * EDGE];
  for (int q = 0; q < EDGE * EDGE * EDGE; q++)
    fine[q] = (unsigned char)(q * q % 251 > 120);
  write_file("c.raw", "", fine, sizeof fine);
  const bw_shape_voxels v = {.size = {EDGE, EDGE, EDGE}, .spacing = {1, 2, 3}};
  const int64_t from[3] = {1, 0, 0}, to[3] = {EDGE, EDGE, EDGE};
  for (int q = 0; q < 4; q++) {
    const int *c = factor[q];
    bw_shape_mask *m = NULL;
    bw_check_ok(bw_shape_mask_open_raw(path_of("c.raw"), &v, 1, 1, &m));
    bw_check_ok(bw_shape_mask_crop(m, from, to));
    bw_check_ok(bw_shape_mask_flip(m, 2));
    bw_check_ok(bw_shape_mask_coarsen(m, c));
    bw_check_near(m->lower[0], 1, 1e-12);
    for (int d = 0; d < 3; d++) {
      ck_assert_int_eq(m->size[d], (EDGE - from[d]) / c[d]);
      bw_check_near(m->spacing[d], v.spacing[d] * c[d], 1e-12);
    }
    for (int64_t k = 0; k < m->size[2]; k++) {
      bw_check_ok(bw_shape_mask_hold(m, k, 1));
      for (int64_t j = 0; j < m->size[1]; j++)
        for (int64_t i = 0; i < m->size[0]; i++) {
          int solid = 0;
          for (int64_t z = k * c[2]; z < (k + 1) * c[2]; z++)
            for (int64_t y = j * c[1]; y < (j + 1) * c[1]; y++)
              for (int64_t x = i * c[0]; x < (i + 1) * c[0]; x++)
                solid += fine[x + 1 + EDGE * (y + EDGE * (EDGE - 1 - z))];
          ck_assert_int_eq(m->solid[i + m->size[0] * j], 2 * solid >= c[0] * c[1] * c[2]);
        }
    }
    bw_check_status(bw_shape_mask_coarsen(m, factor[1]), BW_EINPUT);
    bw_check_status(bw_shape_mask_flip(m, 0), BW_EINPUT);
    bw_shape_mask_destroy(&m);
  }
  bw_shape_mask *m = NULL;
  bw_check_ok(bw_shape_mask_open_raw(path_of("c.raw"), &v, 1, 1, &m));
  bw_check_status(bw_shape_mask_coarsen(m, (const int[3]){1, 12, 1}), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "blocks of 12 cells along y"));
  bw_shape_mask_destroy(&m);
  remove(path_of("c.raw"));
}
END_TEST

START_TEST(the_system_says_why)
{
  must_refuse("gone.nrrd", "No such file");
  ck_assert_int_eq(symlink("nowhere", path_of("link.nrrd")), 0);
  must_refuse("link.nrrd", "No such file");
  remove(path_of("link.nrrd"));
  /* A pipe that nobody writes into would keep us waiting. */
  ck_assert_int_eq(mkfifo(path_of("pipe.nrrd"), 0600), 0);
  must_refuse("pipe.nrrd", "pipe");
  remove(path_of("pipe.nrrd"));
  bw_shape_mask *m = NULL;
  bw_check_status(bw_shape_mask_read_stl(".", 1, 1, &m), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "is a folder"));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(words_of_nrrd),
                                      BW_TEST(units_and_axes),
                                      BW_TEST(keys_of_metaimage),
                                      BW_TEST(packed_voxels),
                                      BW_TEST(headers_that_claim_too_much),
                                      BW_TEST(arrays_of_numpy),
                                      BW_TEST(crop_and_flip),
                                      BW_TEST(blocks_of_voxels),
                                      BW_TEST(the_system_says_why)};
BW_CHECK_MAIN("shape.formats", tests)
