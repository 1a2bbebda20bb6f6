/* TIFF: the pages of one file, or one file for each layer. What is compressed is unpacked by
 * libtiff. */
#include "shape_tiff.h"
#include "bw_memory.h"
#include "shape_source.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* How many bytes a compressed one can become: PackBits repeats a byte 128 times by two, deflate 258
 * by two bits, LZW 3838 by twelve bits; bilevel codes pack a row into a bit. Others are for
 * photographs and pack less than deflate. */
static double most_of(uint16_t compression)
{
  switch (compression) {
  case COMPRESSION_NONE:
    return 1.0;
  case COMPRESSION_LZW:
    return 2600.0;
  case COMPRESSION_CCITTRLE:
  case COMPRESSION_CCITTFAX3:
  case COMPRESSION_CCITTFAX4:
    return 65536.0;
  default:
    return 1100.0;
  }
}

/* What libtiff has to say is kept, for the message that follows. */
static int keep_message(TIFF *tif, void *context, const char *module, const char *format,
                        va_list arguments)
{
  char *said = context;
  (void)tif, (void)module;
  vsnprintf(said, BW_SHAPE__SAID, format, arguments);
  return 1;
}

static int ignore_warning(TIFF *tif, void *context, const char *module, const char *format,
                          va_list arguments)
{
  (void)tif, (void)context, (void)module, (void)format, (void)arguments;
  return 1;
}

bw_status bw_shape__tiff_open(const char *path, bw_shape__tiff *t)
{
  FILE *file = NULL;
  int64_t length;
  memset(t, 0, sizeof *t);
  t->path = path;
  BW_TRY(bw_shape__open(path, &file, &length));
  fclose(file);
  TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
  BW_REQUIRE(options != NULL, BW_EMEM, "%s: no memory to open it", path);
  /* Nothing that libtiff asks for may be larger than what the file can unpack to. */
  t->length = length;
  t->most = 65536.0 + 2600.0 * (double)length;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, (tmsize_t)fmin(t->most, (double)(LONG_MAX / 2)));
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, t->said);
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, NULL);
  /* m: not mapped into memory, where a file that shrinks would end the program. */
  t->tif = TIFFOpenExt(path, "rm", options);
  TIFFOpenOptionsFree(options);
  BW_REQUIRE(t->tif != NULL, BW_EIO, "%s: is no TIFF file that can be read: %s", path, t->said);
  return BW_OK;
}

void bw_shape__tiff_close(bw_shape__tiff *t)
{
  if (t->tif != NULL) TIFFClose(t->tif);
  bw_release(&t->row);
  bw_release(&t->block);
  memset(t, 0, sizeof *t);
}

/* ---- what a page is ---- */

static bw_status page_type(const bw_shape__tiff *t, bw_shape__tiff_page *p)
{
  static const struct {
    uint16_t format, bits;
    bw_shape_voxel_type type;
  } types[] = {
      {SAMPLEFORMAT_UINT, 1, BW_SHAPE_VOXEL_U8},    {SAMPLEFORMAT_UINT, 8, BW_SHAPE_VOXEL_U8},
      {SAMPLEFORMAT_UINT, 16, BW_SHAPE_VOXEL_U16},  {SAMPLEFORMAT_UINT, 32, BW_SHAPE_VOXEL_U32},
      {SAMPLEFORMAT_UINT, 64, BW_SHAPE_VOXEL_U64},  {SAMPLEFORMAT_INT, 8, BW_SHAPE_VOXEL_I8},
      {SAMPLEFORMAT_INT, 16, BW_SHAPE_VOXEL_I16},   {SAMPLEFORMAT_INT, 32, BW_SHAPE_VOXEL_I32},
      {SAMPLEFORMAT_INT, 64, BW_SHAPE_VOXEL_I64},   {SAMPLEFORMAT_IEEEFP, 32, BW_SHAPE_VOXEL_F32},
      {SAMPLEFORMAT_IEEEFP, 64, BW_SHAPE_VOXEL_F64}};
  uint16_t format = SAMPLEFORMAT_UINT, samples = 1;
  /* What the page says of its numbers; a page that says nothing has whole ones without sign. */
  TIFFGetFieldDefaulted(t->tif, TIFFTAG_BITSPERSAMPLE, &p->bits);
  TIFFGetFieldDefaulted(t->tif, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(t->tif, TIFFTAG_SAMPLESPERPIXEL, &samples);
  if (format == SAMPLEFORMAT_VOID) format = SAMPLEFORMAT_UINT;
  BW_REQUIRE(samples == 1, BW_EINPUT,
             "%s: page %d has %d numbers per voxel; one is read: save it in "
             "shades of grey",
             t->path, t->page, samples);
  /* One number per voxel: is it of a kind that the masks know? */
  for (size_t q = 0; q < sizeof types / sizeof types[0]; q++)
    if (types[q].format == format && types[q].bits == p->bits) {
      p->type = types[q].type;
      return BW_OK;
    }
  return BW_FAIL(BW_EINPUT,
                 "%s: page %d has numbers of %d bits and sample format %d; whole ones of "
                 "1, 8, 16, 32, 64 bits and floating ones of 32, 64 are read",
                 t->path, t->page, p->bits, format);
}

/* Is there as much in the file as the page claims? Before anything is allocated for it. */
static bw_status check_room(const bw_shape__tiff *t, const bw_shape__tiff_page *p)
{
  uint16_t compression = COMPRESSION_NONE;
  TIFFGetFieldDefaulted(t->tif, TIFFTAG_COMPRESSION, &compression);
  BW_REQUIRE(TIFFIsCODECConfigured(compression), BW_EINPUT,
             "%s: page %d is compressed by method %d, which libtiff does not read here; save it "
             "with deflate, LZW or without",
             t->path, t->page, compression);
  const double need = (double)p->width * (double)p->height * p->bits / 8.0;
  double have = 0.0;
  const uint32_t pieces =
      TIFFIsTiled(t->tif) ? TIFFNumberOfTiles(t->tif) : TIFFNumberOfStrips(t->tif);
  for (uint32_t q = 0; q < pieces && have * most_of(compression) < need; q++)
    have += (double)TIFFGetStrileByteCount(t->tif, q);
  have = fmin(have, (double)t->length);
  BW_REQUIRE(have * most_of(compression) >= need * (1.0 - 1e-12), BW_EIO,
             "%s: page %d claims %u x %u voxels, %g bytes, which the %g in the file cannot be",
             t->path, t->page, p->width, p->height, need, have);
  const double block =
      TIFFIsTiled(t->tif) ? (double)TIFFTileSize64(t->tif) : (double)TIFFScanlineSize64(t->tif);
  BW_REQUIRE(block > 0.0 && block <= t->most, BW_EIO,
             "%s: page %d has pieces of %g bytes, more than the file can hold", t->path, t->page,
             block);
  return BW_OK;
}

bw_status bw_shape__tiff_page_of(const bw_shape__tiff *t, bw_shape__tiff_page *p)
{
  *p = (bw_shape__tiff_page){0};
  TIFFGetField(t->tif, TIFFTAG_IMAGEWIDTH, &p->width);
  TIFFGetField(t->tif, TIFFTAG_IMAGELENGTH, &p->height);
  BW_REQUIRE(p->width > 0 && p->height > 0, BW_EIO, "%s: page %d has no size", t->path, t->page);
  BW_TRY(page_type(t, p));
  return check_room(t, p);
}

/* ---- rows of a page ---- */

/* A row of `n` numbers of one bit each, the highest bit of a byte first, to bytes. */
static void spread_bits(const unsigned char *bits, uint32_t n, unsigned char *to)
{
  for (uint32_t i = 0; i < n; i++)
    to[i] = bits[i / 8] >> (7 - i % 8) & 1;
}

static bw_status damaged(const bw_shape__tiff *t, uint32_t j)
{
  return BW_FAIL(BW_EIO, "%s: page %d cannot be read at row %u: %s", t->path, t->page, j, t->said);
}

static bw_status read_strips(bw_shape__tiff *t, const bw_shape__tiff_page *p,
                             bw_shape__tiff_take take, void *to)
{
  bw_release(&t->block);
  BW_TRY(BW_ALLOCATE(&t->block, (size_t)TIFFScanlineSize64(t->tif)));
  for (uint32_t j = 0; j < p->height; j++) {
    if (TIFFReadScanline(t->tif, t->block, j, 0) < 0) return damaged(t, j);
    if (p->bits == 1) spread_bits(t->block, p->width, t->row);
    take(to, (int64_t)j, p->bits == 1 ? t->row : t->block);
  }
  return BW_OK;
}

/* A row of tiles at a time: each is read once for every row of the page that it holds, so that one
 * tile is all that is kept. */
static bw_status read_tiles(bw_shape__tiff *t, const bw_shape__tiff_page *p,
                            bw_shape__tiff_take take, void *to)
{
  uint32_t wide = 0, high = 0;
  TIFFGetField(t->tif, TIFFTAG_TILEWIDTH, &wide);
  TIFFGetField(t->tif, TIFFTAG_TILELENGTH, &high);
  const size_t bytes = p->bits / 8u, tile_row = (size_t)TIFFTileRowSize64(t->tif);
  const size_t band = (size_t)p->width * bytes;
  BW_REQUIRE(wide > 0 && high > 0 && p->bits >= 8, BW_EINPUT,
             "%s: page %d has tiles that are not read; save it in strips", t->path, t->page);
  const uint32_t rows = high < p->height ? high : p->height;
  BW_REQUIRE((double)rows * (double)band <= t->most, BW_EIO,
             "%s: page %d has tiles of %u rows, more than the file can hold", t->path, t->page,
             high);
  bw_release(&t->block);
  BW_TRY(BW_ALLOCATE(&t->block, (size_t)TIFFTileSize64(t->tif) + band * rows));
  unsigned char *rows_at = t->block + TIFFTileSize64(t->tif);
  for (uint32_t y = 0; y < p->height; y += rows) {
    const uint32_t here = p->height - y < rows ? p->height - y : rows;
    for (uint32_t x = 0; x < p->width; x += wide) {
      if (TIFFReadTile(t->tif, t->block, x, y, 0, 0) < 0) return damaged(t, y);
      const size_t part = (p->width - x < wide ? p->width - x : wide) * bytes;
      for (uint32_t j = 0; j < here; j++)
        memcpy(rows_at + j * band + x * bytes, t->block + j * tile_row, part);
      if (p->width - x <= wide) break; /* x + wide may pass what 32 bits hold */
    }
    for (uint32_t j = 0; j < here; j++) {
      /* Aligned as numbers of its type are: the mask reads them as such. */
      memcpy(t->row, rows_at + j * band, band);
      take(to, (int64_t)y + j, t->row);
    }
    if (p->height - y <= rows) break;
  }
  return BW_OK;
}

bw_status bw_shape__tiff_rows(bw_shape__tiff *t, const bw_shape__tiff_page *p,
                              bw_shape__tiff_take take, void *to)
{
  bw_release(&t->row);
  BW_TRY(BW_ALLOCATE(&t->row, (size_t)p->width * (p->bits < 8 ? 1u : p->bits / 8u)));
  return TIFFIsTiled(t->tif) ? read_tiles(t, p, take, to) : read_strips(t, p, take, to);
}
