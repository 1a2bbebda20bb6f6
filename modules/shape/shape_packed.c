/* Voxels packed by zlib, bare (MetaImage) or as gzip (NRRD). */
#include "bw_memory.h"
#include "shape_source.h"

#include <stdio.h>
#include <string.h>
#include <zlib.h>

enum { PIECE = 65536 };

/* What the reader keeps: where the packed bytes begin in the file. */
typedef struct {
  int64_t at;
} packed;

/* A file that is being unpacked. */
typedef struct {
  const char *path;
  FILE *file;
  z_stream z;
  bool begun, ended; /* zlib is set up; the last packed byte has been used */
  unsigned char piece[PIECE];
} stream;

static bw_status begin(const char *path, int64_t at, stream *s)
{
  int64_t length;
  memset(&s->z, 0, sizeof s->z);
  s->path = path, s->begun = s->ended = false;
  BW_TRY(bw_shape__open(path, &s->file, &length));
  BW_REQUIRE(fseeko(s->file, (off_t)at, SEEK_SET) == 0, BW_EIO, "%s: has no byte %lld", path,
             (long long)at);
  /* 15: the largest window; 32: zlib or gzip, whichever the first bytes say. */
  BW_REQUIRE(inflateInit2(&s->z, 15 + 32) == Z_OK, BW_EMEM, "%s: no memory to unpack it", path);
  s->begun = true;
  return BW_OK;
}

static void end(stream *s)
{
  if (s->begun) inflateEnd(&s->z);
  if (s->file != NULL) fclose(s->file);
}

/* The next bytes of the file into the piece, if there are any. */
static bool refill(stream *s)
{
  s->z.next_in = s->piece;
  s->z.avail_in = (uInt)fread(s->piece, 1, sizeof s->piece, s->file);
  return s->z.avail_in > 0;
}

/* The next `bytes` unpacked bytes (at most PIECE), or fewer where the stream ends: *got. */
static bw_status unpack(stream *s, size_t bytes, void *to, size_t *got)
{
  s->z.next_out = to;
  s->z.avail_out = (uInt)bytes;
  while (s->z.avail_out > 0 && !s->ended) {
    if (s->z.avail_in == 0 && !refill(s))
      return BW_FAIL(BW_EIO, "%s: the packed voxels break off; the file has been cut", s->path);
    const int said = inflate(&s->z, Z_NO_FLUSH);
    if (said == Z_STREAM_END) {
      /* A gzip file may be several, one behind the other. */
      s->ended = s->z.avail_in == 0 && !refill(s);
      if (!s->ended && inflateReset(&s->z) != Z_OK)
        return BW_FAIL(BW_EIO, "%s: cannot be unpacked", s->path);
    } else if (said != Z_OK && said != Z_BUF_ERROR) {
      return BW_FAIL(BW_EIO, "%s: the packed voxels are damaged: %s", s->path,
                     s->z.msg != NULL ? s->z.msg : "not packed by zlib or gzip");
    }
  }
  *got = bytes - s->z.avail_out;
  return BW_OK;
}

/* As many bytes as are asked for, in pieces; to NULL: they are thrown away, by way of `spare`
 * (PIECE). */
static bw_status take(stream *s, int64_t bytes, unsigned char *to, unsigned char *spare)
{
  while (bytes > 0) {
    const size_t some = bytes < PIECE ? (size_t)bytes : PIECE;
    size_t got = 0;
    BW_TRY(unpack(s, some, to != NULL ? to : spare, &got));
    BW_REQUIRE(got == some, BW_EIO,
               "%s: unpacks to %lld bytes too few; size or type is not that "
               "of the file",
               s->path, (long long)(bytes - (int64_t)got));
    bytes -= (int64_t)some;
    if (to != NULL) to += some;
  }
  return BW_OK;
}

static bw_status take_rows(stream *s, bw_shape_source *from, int64_t first, int64_t to,
                           bw_shape_mask *into)
{
  const int64_t *size = from->v.size;
  const int64_t bytes = size[0] * (int64_t)bw_shape__bytes(from->v.type);
  unsigned char *row = NULL, *spare = NULL;
  bw_status st = BW_ALLOCATE(&row, (size_t)bytes);
  BW_THEN(st, BW_ALLOCATE(&spare, PIECE));
  /* What comes before these layers has to be unpacked too. */
  BW_THEN(st, take(s, from->v.skip + first * size[1] * bytes, NULL, spare));
  for (int64_t k = first; k < to; k++)
    for (int64_t j = 0; j < size[1] && st == BW_OK; j++) {
      st = take(s, bytes, row, NULL);
      if (st == BW_OK) bw_shape__put_row(from, j, k, row, into);
    }
  bw_release(&row);
  bw_release(&spare);
  return st;
}

static bw_status read_packed(bw_shape_source *from, int64_t first, int64_t to, bw_shape_mask *into)
{
  const packed *state = from->state;
  stream *s = NULL;
  BW_TRY(BW_ALLOCATE(&s, 1));
  bw_status st = begin(from->path, state->at, s);
  BW_THEN(st, take_rows(s, from, first, to, into));
  end(s);
  bw_release(&s);
  return st;
}

static void forget(void *state)
{
  bw_release(&state);
}

static const bw_shape__reader reader = {.read = read_packed, .destroy = forget};

/* Unpack all of it once without keeping anything: the file holds as many voxels as its header says,
 * neither more nor fewer, and its check sums are right. */
static bw_status check_all(const char *path, int64_t at, const bw_shape_voxels *v)
{
  stream *s = NULL;
  unsigned char *spare = NULL, one;
  size_t more = 0;
  const int64_t bytes = v->size[0] * (int64_t)bw_shape__bytes(v->type) * v->size[1] * v->size[2];
  BW_TRY(BW_ALLOCATE(&s, 1));
  bw_status st = BW_ALLOCATE(&spare, PIECE);
  BW_THEN(st, begin(path, at, s));
  BW_THEN(st, take(s, v->skip + bytes, NULL, spare));
  /* The end of the stream, where its sum is checked, lies behind the last byte. */
  BW_THEN(st, unpack(s, 1, &one, &more));
  if (st == BW_OK && more > 0)
    st = BW_FAIL(BW_EIO,
                 "%s: unpacks to more than %lld x %lld x %lld voxels of %zu bytes; size, "
                 "type or skip is not that of the file",
                 path, (long long)v->size[0], (long long)v->size[1], (long long)v->size[2],
                 bw_shape__bytes(v->type));
  end(s);
  bw_release(&s);
  bw_release(&spare);
  return st;
}

bw_status bw_shape__open_packed(const char *path, int64_t skip, const bw_shape_voxels *v,
                                double low, double high, bw_shape_mask **out)
{
  /* deflate packs 258 bytes into two bits at most: what is claimed beyond that cannot be there. */
  static const double most = 1032.0;
  FILE *file = NULL;
  int64_t length;
  packed *state = NULL;
  *out = NULL;
  BW_TRY(bw_shape__check_voxels(path, v, low, high));
  BW_TRY(bw_shape__open(path, &file, &length));
  fclose(file);
  const double need = (double)v->size[0] * (double)v->size[1] * (double)v->size[2] *
                      (double)bw_shape__bytes(v->type);
  BW_REQUIRE(need + (double)v->skip <= most * (double)length, BW_EIO,
             "%s: %lld bytes cannot unpack to the %g that the header speaks of", path,
             (long long)length, need);
  BW_TRY(BW_ALLOCATE(&state, 1));
  state->at = skip;
  BW_TRY(bw_shape__source_create(path, v, low, high, &reader, state, out));
  const bw_status st = check_all(path, skip, v);
  if (st != BW_OK) bw_shape_mask_destroy(out);
  return st;
}
