/* Voxels of any type, and files that hold them as they are. */
#include "bw_memory.h"
#include "shape_internal.h"
#include "shape_source.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

size_t bw_shape__bytes(bw_shape_voxel_type type)
{
  static const size_t bytes[BW_SHAPE_VOXEL_COUNT] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return bytes[type];
}

bool bw_shape__machine_is_big(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 0;
}

/* Values of a row: n numbers of `type` in this machine's order of bytes at `from`. */
#define BETWEEN(name, number)                                                                      \
  static void between_##name(const void *from, int64_t n, double low, double high, uint8_t *solid) \
  {                                                                                                \
    const number *value = from;                                                                    \
    for (int64_t i = 0; i < n; i++)                                                                \
      solid[i] = (double)value[i] >= low && (double)value[i] <= high;                              \
  }
BETWEEN(u8, uint8_t)
BETWEEN(i8, int8_t)
BETWEEN(u16, uint16_t)
BETWEEN(i16, int16_t)
BETWEEN(u32, uint32_t)
BETWEEN(i32, int32_t)
BETWEEN(u64, uint64_t)
BETWEEN(i64, int64_t)
BETWEEN(f32, float)
BETWEEN(f64, double)
#undef BETWEEN

typedef void (*between)(const void *from, int64_t n, double low, double high, uint8_t *solid);
static const between compare[BW_SHAPE_VOXEL_COUNT] = {
    [BW_SHAPE_VOXEL_U8] = between_u8,   [BW_SHAPE_VOXEL_I8] = between_i8,
    [BW_SHAPE_VOXEL_U16] = between_u16, [BW_SHAPE_VOXEL_I16] = between_i16,
    [BW_SHAPE_VOXEL_U32] = between_u32, [BW_SHAPE_VOXEL_I32] = between_i32,
    [BW_SHAPE_VOXEL_U64] = between_u64, [BW_SHAPE_VOXEL_I64] = between_i64,
    [BW_SHAPE_VOXEL_F32] = between_f32, [BW_SHAPE_VOXEL_F64] = between_f64,
};

static void turn_bytes(unsigned char *row, int64_t n, size_t bytes)
{
  for (int64_t i = 0; i < n; i++) {
    unsigned char *one = row + (size_t)i * bytes;
    for (size_t a = 0; a < bytes / 2; a++) {
      const unsigned char t = one[a];
      one[a] = one[bytes - 1 - a], one[bytes - 1 - a] = t;
    }
  }
}

/* The place of a voxel of the file in a mask; what is cropped off falls outside of 0 .. size-1. */
static int64_t place(const bw_shape_source *s, const bw_shape_mask *m, int d, int64_t at)
{
  const int64_t q = at - s->first[d];
  return s->flipped[d] ? m->size[d] - 1 - q : q;
}

void bw_shape__put_row(const bw_shape_source *s, int64_t j, int64_t k, void *row,
                       bw_shape_mask *into)
{
  const int64_t y = place(s, into, 1, j), z = place(s, into, 2, k) - into->first;
  if (y < 0 || y >= into->size[1] || z < 0 || z >= into->held) return;
  const size_t bytes = bw_shape__bytes(s->v.type);
  const int64_t n = into->size[0];
  unsigned char *begin = (unsigned char *)row + (size_t)s->first[0] * bytes;
  uint8_t *solid = into->solid + n * (y + into->size[1] * z);
  /* The row is read once and not needed again, so that its bytes are turned in place. */
  if (bytes > 1 && s->v.big_endian != bw_shape__machine_is_big()) turn_bytes(begin, n, bytes);
  compare[s->v.type](begin, n, s->low, s->high, solid);
  for (int64_t a = 0, b = n - 1; s->flipped[0] && a < b; a++, b--) {
    const uint8_t t = solid[a];
    solid[a] = solid[b], solid[b] = t;
  }
}

/* ---- numbers as they are ---- */

bw_status bw_shape__open(const char *path, FILE **file, int64_t *length)
{
  struct stat about;
  *file = NULL;
  BW_REQUIRE(stat(path, &about) == 0, BW_EIO, "%s: cannot be opened: %s", path, strerror(errno));
  BW_REQUIRE(!S_ISDIR(about.st_mode), BW_EIO, "%s: is a folder, not a file", path);
  /* A pipe would keep us waiting, a device could give bytes for ever. */
  BW_REQUIRE(S_ISREG(about.st_mode), BW_EIO, "%s: is a pipe, socket or device, not a file", path);
  *file = fopen(path, "rb");
  BW_REQUIRE(*file != NULL, BW_EIO, "%s: cannot be opened: %s", path, strerror(errno));
  *length = (int64_t)about.st_size;
  return BW_OK;
}

static size_t bytes_of_row(const bw_shape_voxels *v)
{
  return (size_t)v->size[0] * bw_shape__bytes(v->type);
}

static bw_status read_rows(FILE *file, bw_shape_source *s, int64_t from, int64_t to,
                           bw_shape_mask *into)
{
  unsigned char *row = NULL;
  const size_t bytes = bytes_of_row(&s->v);
  BW_TRY(BW_ALLOCATE(&row, bytes));
  bw_status st = BW_OK;
  for (int64_t k = from; k < to && st == BW_OK; k++)
    for (int64_t j = 0; j < s->v.size[1] && st == BW_OK; j++) {
      if (fread(row, 1, bytes, file) == bytes)
        bw_shape__put_row(s, j, k, row, into);
      else
        st = BW_FAIL(BW_EIO, "%s: cannot be read on; it has become shorter, or the disk fails",
                     s->path);
    }
  bw_release(&row);
  return st;
}

static bw_status read_plain(bw_shape_source *s, int64_t from, int64_t to, bw_shape_mask *into)
{
  FILE *file = NULL;
  int64_t length;
  BW_TRY(bw_shape__open(s->path, &file, &length));
  /* From the first of these layers on: the file's other layers are not touched. */
  const int64_t at = s->v.skip + from * s->v.size[1] * (int64_t)bytes_of_row(&s->v);
  bw_status st = fseeko(file, (off_t)at, SEEK_SET) == 0
                     ? BW_OK
                     : BW_FAIL(BW_EIO, "%s: has no byte %lld", s->path, (long long)at);
  BW_THEN(st, read_rows(file, s, from, to, into));
  fclose(file);
  return st;
}

static const bw_shape__reader plain = {.read = read_plain};

bw_status bw_shape__check_length(const char *path, const bw_shape_voxels *v, int64_t length)
{
  /* All products fit: at most 1e18 voxels, and `have` is compared row by row. */
  const int64_t row = (int64_t)bytes_of_row(v), rows = v->size[1] * v->size[2];
  const int64_t have = length > v->skip ? length - v->skip : 0;
  BW_REQUIRE(have / row >= rows, BW_EIO,
             "%s: ends after %lld of %lld rows of %lld voxels; size or type is not that of "
             "the file",
             path, (long long)(have / row), (long long)rows, (long long)v->size[0]);
  BW_REQUIRE(have == rows * row, BW_EIO,
             "%s: goes on after %lld x %lld x %lld voxels of %zu bytes; size, type or skip is "
             "not that of the file",
             path, (long long)v->size[0], (long long)v->size[1], (long long)v->size[2],
             bw_shape__bytes(v->type));
  return BW_OK;
}

bw_status bw_shape__check_voxels(const char *path, const bw_shape_voxels *v, double low,
                                 double high)
{
  BW_REQUIRE((unsigned)v->type < BW_SHAPE_VOXEL_COUNT, BW_EINPUT, "%s: voxel type %d is unknown",
             path, (int)v->type);
  BW_REQUIRE(low <= high, BW_EINPUT, "%s: no value lies between low = %g and high = %g", path, low,
             high);
  BW_REQUIRE(v->skip >= 0, BW_EINPUT, "%s: skip = %lld is negative", path, (long long)v->skip);
  return BW_OK;
}

bw_status bw_shape_mask_open_raw(const char *path, const bw_shape_voxels *v, double low,
                                 double high, bw_shape_mask **out)
{
  FILE *file = NULL;
  int64_t length;
  *out = NULL;
  BW_TRY(bw_shape__check_voxels(path, v, low, high));
  BW_TRY(bw_shape__open(path, &file, &length));
  fclose(file);
  /* No layer is read yet: who needs some asks for them (bw_shape_mask_hold). */
  bw_status st = bw_shape__source_create(path, v, low, high, &plain, NULL, out);
  BW_THEN(st, bw_shape__check_length(path, v, length));
  if (st != BW_OK) bw_shape_mask_destroy(out);
  return st;
}

bw_status bw_shape_mask_read_raw(const char *path, const bw_shape_voxels *v, double low,
                                 double high, bw_shape_mask **out)
{
  return bw_shape__mask_all(bw_shape_mask_open_raw(path, v, low, high, out), out);
}
