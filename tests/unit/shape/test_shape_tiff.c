/* Images as TIFF: pages of one file, or one file for each layer; all forms that tools choose from.
 * BUILD libs=libtiff-4
 * TEST ranks=1 */
#include "twelve_voxels.h"

#include <sys/stat.h>
#include <tiffio.h>

/* A page of a TIFF: rows of layer z. */
static void write_page(TIFF *tif, int z, int compression, bool tiled, bool wide, const char *about)
{
  unsigned char tile[16 * 16] = {0};
  TIFFSetField(tif, TIFFTAG_IMAGEWIDTH, NX);
  TIFFSetField(tif, TIFFTAG_IMAGELENGTH, NY);
  TIFFSetField(tif, TIFFTAG_BITSPERSAMPLE, wide ? 16 : 8);
  TIFFSetField(tif, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tif, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tif, TIFFTAG_COMPRESSION, compression);
  if (about != NULL) {
    TIFFSetField(tif, TIFFTAG_IMAGEDESCRIPTION, about);
    TIFFSetField(tif, TIFFTAG_XRESOLUTION, 0.5);
    TIFFSetField(tif, TIFFTAG_YRESOLUTION, 0.25);
  }
  if (tiled) {
    TIFFSetField(tif, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tif, TIFFTAG_TILELENGTH, 16);
    for (int q = 0; q < NX * NY; q++)
      tile[q / NX * 16 + q % NX] = CONTENT[q + NX * NY * z];
    ck_assert(TIFFWriteTile(tif, tile, 0, 0, 0, 0) > 0);
  }
  for (int y = 0; y < NY && !tiled; y++) {
    uint16_t row[NX];
    unsigned char small[NX];
    for (int x = 0; x < NX; x++)
      row[x] = small[x] = CONTENT[x + NX * (y + NY * z)];
    ck_assert_int_eq(TIFFWriteScanline(tif, wide ? (void *)row : (void *)small, (uint32_t)y, 0), 1);
  }
}

static void write_tiff(const char *name, const char *mode, int compression, bool tiled, bool wide,
                       const char *about)
{
  TIFF *tif = TIFFOpen(path_of(name), mode);
  ck_assert_ptr_nonnull(tif);
  for (int z = 0; z < NZ; z++) {
    write_page(tif, z, compression, tiled, wide, about);
    ck_assert_int_eq(TIFFWriteDirectory(tif), 1);
  }
  TIFFClose(tif);
}

START_TEST(pages_of_tiff)
{
  bw_shape_mask *m = NULL;
  const int compressions[] = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                              COMPRESSION_PACKBITS};
  const char *modes[] = {"w", "wb", "w8"}; /* this machine's order, the other one, BigTIFF */
  for (int q = 0; q < 4 * 3 * 3; q++) {
    const int form = q / 12;
    write_tiff("a.tif", modes[q / 4 % 3], compressions[q % 4], form == 1, form == 2, NULL);
    m = must_read("a.tif");
    ck_assert(!m->about.has_spacing);
    bw_shape_mask_destroy(&m);
  }
  bw_check_ok(bw_shape_mask_open_image(path_of("a.tif"), 5, 8, &m));
  bw_check_ok(bw_shape_mask_hold(m, 1, 1));
  ck_assert(m->solid[0] == 1 && m->solid[2] == 1 && m->solid[3] == 0);
  bw_shape_mask_destroy(&m);
  /* Sizes of ImageJ: 0.5 and 0.25 voxels to the unit, and the way between pages. */
  write_tiff("a.tif", "w", COMPRESSION_NONE, false, false,
             "ImageJ=1.53t\nimages=2\nslices=2\nunit=micron\nspacing=5.0\nloop=false\n");
  m = must_read("a.tif");
  expect_spacing(m, 2e-6, 4e-6, 5e-6);
  bw_shape_mask_destroy(&m);
  write_tiff("a.tif", "w", COMPRESSION_NONE, false, false,
             "<OME><Pixels PhysicalSizeX=\"3\" PhysicalSizeXUnit=\"nm\" PhysicalSizeY=\"2.0\" "
             "PhysicalSizeZ=\"1\" PhysicalSizeZUnit=\"mm\"/></OME>");
  m = must_read("a.tif");
  expect_spacing(m, 3e-9, 2e-6, 1e-3);
  bw_shape_mask_destroy(&m);
  write_tiff("a.tif", "w", COMPRESSION_NONE, false, false, "ImageJ=1.53t\nimages=500\n");
  must_refuse("a.tif", "500 images");
  ck_assert_int_eq(truncate(path_of("a.tif"), 100), 0);
  must_refuse("a.tif", "a.tif");
  remove(path_of("a.tif"));
}
END_TEST

/* A page of three by three tiles, the last ones cut. */
START_TEST(pages_of_several_tiles)
{
  enum { WIDE = 40, HIGH = 35, TILE = 16 };
  TIFF *tif = TIFFOpen(path_of("t.tif"), "w");
  bw_shape_mask *m = NULL;
  ck_assert_ptr_nonnull(tif);
  TIFFSetField(tif, TIFFTAG_IMAGEWIDTH, WIDE);
  TIFFSetField(tif, TIFFTAG_IMAGELENGTH, HIGH);
  TIFFSetField(tif, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tif, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tif, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tif, TIFFTAG_TILEWIDTH, TILE);
  TIFFSetField(tif, TIFFTAG_TILELENGTH, TILE);
  for (uint32_t y = 0; y < HIGH; y += TILE)
    for (uint32_t x = 0; x < WIDE; x += TILE) {
      unsigned char tile[TILE * TILE];
      for (uint32_t q = 0; q < TILE * TILE; q++)
        tile[q] = (x + q % TILE) * (x + q % TILE) % 7 > (y + q / TILE) % 5;
      ck_assert(TIFFWriteTile(tif, tile, x, y, 0, 0) > 0);
    }
  TIFFClose(tif);
  bw_check_ok(bw_shape_mask_open_image(path_of("t.tif"), 1, 1, &m));
  ck_assert(m->size[0] == WIDE && m->size[1] == HIGH && m->size[2] == 1);
  bw_check_ok(bw_shape_mask_hold(m, 0, 1));
  for (int y = 0; y < HIGH; y++)
    for (int x = 0; x < WIDE; x++)
      ck_assert_int_eq(m->solid[x + WIDE * y], x * x % 7 > y % 5);
  bw_shape_mask_destroy(&m);
  remove(path_of("t.tif"));
}
END_TEST

/* One file a layer: 9 before 10, whatever the order of the letters is. */
START_TEST(stacks_of_tiff)
{
  const char *names[NZ] = {"s/ct_9.TIF", "s/ct_10.tif"};
  bw_shape_mask *m = NULL;
  ck_assert_int_eq(mkdir(path_of("s"), 0700), 0);
  must_refuse("s", "no file whose name ends with .tif");
  for (int z = 0; z < NZ; z++) {
    TIFF *tif = TIFFOpen(path_of(names[z]), "w");
    ck_assert_ptr_nonnull(tif);
    write_page(tif, z, COMPRESSION_LZW, false, false, NULL);
    TIFFClose(tif);
  }
  m = must_read("s");
  ck_assert_str_eq(m->about.format, "TIFF");
  bw_shape_mask_destroy(&m);
  m = must_read("s/ct_*");
  bw_shape_mask_destroy(&m);
  must_refuse("s/mr_*.tif", "no file has such a name");
  write_tiff("s/ct_11.tif", "w", COMPRESSION_NONE, false, false, NULL);
  must_refuse("s", "has 2 pages");
  remove(path_of("s/ct_11.tif"));
  for (int z = 0; z < NZ; z++)
    remove(path_of(names[z]));
  rmdir(path_of("s"));
}
END_TEST

/* Bits: eight voxels a byte, of which the last are not in the row. */
START_TEST(bits_of_tiff)
{
  bw_shape_mask *m = NULL;
  TIFF *tif = TIFFOpen(path_of("b.tif"), "w");
  ck_assert_ptr_nonnull(tif);
  TIFFSetField(tif, TIFFTAG_IMAGEWIDTH, 11);
  TIFFSetField(tif, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tif, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tif, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tif, TIFFTAG_COMPRESSION, COMPRESSION_CCITTFAX4);
  unsigned char bits[2] = {0xB1, 0x5F};
  ck_assert_int_eq(TIFFWriteScanline(tif, bits, 0, 0), 1);
  TIFFClose(tif);
  bw_check_ok(bw_shape_mask_read_image(path_of("b.tif"), 1, 1, &m));
  for (int q = 0; q < 11; q++)
    ck_assert_int_eq(m->solid[q], bits[q / 8] >> (7 - q % 8) & 1);
  bw_shape_mask_destroy(&m);
  remove(path_of("b.tif"));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(pages_of_tiff), BW_TEST(pages_of_several_tiles),
                                      BW_TEST(stacks_of_tiff), BW_TEST(bits_of_tiff)};
BW_CHECK_MAIN("shape.tiff", tests)
