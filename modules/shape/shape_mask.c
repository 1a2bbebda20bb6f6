/* Masks, and voxels of any type from a file. */
#include "bw_memory.h"
#include "shape_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* From where and how an open mask reads its layers. */
struct bw_shape_source {
  char *path;
  bw_shape_voxels v;
  double low, high;
};

static void close_source(bw_shape_mask *mask)
{
  if (mask->source != NULL) bw_release(&mask->source->path);
  bw_release(&mask->source);
}

void bw_shape_mask_destroy(bw_shape_mask **mask)
{
  if (*mask == NULL) return;
  close_source(*mask);
  bw_release(&(*mask)->solid);
  bw_release(mask);
}

bw_status bw_shape__mask_create(const char *path, const int64_t size[3], const double lower[3],
                                const double spacing[3], bw_shape_mask **out)
{
  *out = NULL;
  /* Cells are numbered in 64 bits; memory is asked for layer by layer. */
  double cells = 1;
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(size[d] > 0, BW_EINPUT, "%s: %lld cells in direction %d", path, (long long)size[d],
               d);
    BW_REQUIRE(spacing[d] > 0 && isfinite(spacing[d]) && isfinite(lower[d]), BW_EINPUT,
               "%s: spacing %g and origin %g in direction %d; they must be positive and finite",
               path, spacing[d], lower[d], d);
    cells *= (double)size[d];
  }
  BW_REQUIRE(cells < 1e18, BW_EINPUT, "%s: %g cells cannot be numbered", path, cells);
  bw_shape_mask *mask = NULL;
  BW_TRY(BW_ALLOCATE(&mask, 1));
  memcpy(mask->size, size, sizeof mask->size);
  memcpy(mask->lower, lower, sizeof mask->lower);
  memcpy(mask->spacing, spacing, sizeof mask->spacing);
  *out = mask;
  return BW_OK;
}

bw_status bw_shape__mask_room(const char *path, int64_t first, int64_t layers, bw_shape_mask *mask)
{
  const double cells = (double)layers * (double)mask->size[0] * (double)mask->size[1];
  BW_REQUIRE(cells < 1e11, BW_EINPUT, "%s: %g cells are more than fit into memory", path, cells);
  /* Layers held before go first: there is never room for both. */
  bw_release(&mask->solid);
  mask->first = mask->held = 0;
  BW_TRY(BW_ALLOCATE(&mask->solid, (size_t)cells));
  mask->first = first;
  mask->held = layers;
  return BW_OK;
}

bool bw_shape_mask_at(const bw_shape_mask *m, int dims, const double x[3])
{
  int64_t at[3] = {0};
  for (int d = 0; d < dims; d++) {
    /* a centre on the face of two cells belongs to the upper one, whatever the rounding */
    const double cell = (x[d] - m->lower[d]) / m->spacing[d] + 1e-9;
    if (!(cell >= 0 && cell < (double)m->size[d])) return false;
    at[d] = (int64_t)cell;
  }
  BW_ASSERT(at[2] >= m->first && at[2] < m->first + m->held);
  return m->solid[at[0] + m->size[0] * (at[1] + m->size[1] * (at[2] - m->first))] != 0;
}

static const size_t BYTES[BW_SHAPE_VOXEL_COUNT] = {1, 1, 2, 2, 4, 4, 4, 8};

/* One number of `type`, in this machine's byte order. */
static double number(bw_shape_voxel_type type, const unsigned char *from)
{
  union {
    uint8_t u8;
    int8_t i8;
    uint16_t u16;
    int16_t i16;
    uint32_t u32;
    int32_t i32;
    float f32;
    double f64;
  } x;
  /* Copied, not cast: a row of voxels need not be aligned. */
  memcpy(&x, from, BYTES[type]);
  switch (type) {
  case BW_SHAPE_VOXEL_U8:
    return x.u8;
  case BW_SHAPE_VOXEL_I8:
    return x.i8;
  case BW_SHAPE_VOXEL_U16:
    return x.u16;
  case BW_SHAPE_VOXEL_I16:
    return x.i16;
  case BW_SHAPE_VOXEL_U32:
    return x.u32;
  case BW_SHAPE_VOXEL_I32:
    return x.i32;
  case BW_SHAPE_VOXEL_F32:
    return (double)x.f32;
  default:
    return x.f64;
  }
}

static bool machine_is_big(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 0;
}

/* One row of voxels to a row of the mask. */
static void threshold(const bw_shape_voxels *v, double low, double high, unsigned char *row,
                      uint8_t *solid)
{
  const size_t bytes = BYTES[v->type];
  /* Bytes are turned in place; the row is read once and not needed again. */
  const bool swap = v->big_endian != machine_is_big();
  for (int64_t i = 0; i < v->size[0]; i++) {
    unsigned char *one = row + (size_t)i * bytes;
    for (size_t a = 0; swap && a < bytes / 2; a++) {
      const unsigned char t = one[a];
      one[a] = one[bytes - 1 - a], one[bytes - 1 - a] = t;
    }
    const double value = number(v->type, one);
    solid[i] = value >= low && value <= high;
  }
}

static size_t bytes_of_row(const bw_shape_voxels *v)
{
  return (size_t)v->size[0] * BYTES[v->type];
}

/* Rows of voxels from the place in the file that comes next, to the layers of the mask. */
static bw_status read_rows(FILE *file, const bw_shape_source *from, int64_t rows, uint8_t *solid)
{
  unsigned char *row = NULL;
  const size_t bytes = bytes_of_row(&from->v);
  BW_TRY(BW_ALLOCATE(&row, bytes));
  bw_status st = BW_OK;
  for (int64_t q = 0; q < rows && st == BW_OK; q++) {
    if (fread(row, 1, bytes, file) == bytes)
      threshold(&from->v, from->low, from->high, row, solid + q * from->v.size[0]);
    else
      st = BW_FAIL(BW_EIO, "%s: cannot be read on; it has become shorter, or the disk fails",
                   from->path);
  }
  bw_release(&row);
  return st;
}

bw_status bw_shape_mask_hold(bw_shape_mask *mask, int64_t first, int64_t layers)
{
  const bw_shape_source *from = mask->source;
  BW_REQUIRE(first >= 0 && layers >= 0 && first <= mask->size[2] - layers, BW_EINPUT,
             "mask: there are no layers %lld .. %lld of %lld", (long long)first,
             (long long)(first + layers), (long long)mask->size[2]);
  /* What is asked for may be here already. */
  if (first >= mask->first && first + layers <= mask->first + mask->held) return BW_OK;
  BW_TRY(bw_shape__mask_room(from->path, first, layers, mask));
  FILE *file = fopen(from->path, "rb");
  BW_REQUIRE(file != NULL, BW_EIO, "%s: cannot be opened", from->path);
  /* From the first of these layers on: the file's other layers are not touched. */
  const int64_t row = first * mask->size[1], rows = layers * mask->size[1];
  const int64_t at = from->v.skip + row * (int64_t)bytes_of_row(&from->v);
  bw_status st = fseeko(file, (off_t)at, SEEK_SET) == 0
                     ? BW_OK
                     : BW_FAIL(BW_EIO, "%s: has no byte %lld", from->path, (long long)at);
  BW_THEN(st, read_rows(file, from, rows, mask->solid));
  fclose(file);
  /* Half read is not held. */
  if (st != BW_OK) mask->held = 0;
  return st;
}

/* Exactly as many bytes as the voxels need, or a message that says which way it differs. */
static bw_status check_length(FILE *file, const char *path, const bw_shape_voxels *v)
{
  /* The length tells whether size, type and skip are those of the file. */
  const bool sought = fseeko(file, 0, SEEK_END) == 0;
  const int64_t length = sought ? (int64_t)ftello(file) : -1;
  BW_REQUIRE(length >= 0, BW_EIO, "%s: its length cannot be told; is it a file?", path);
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
             BYTES[v->type]);
  return BW_OK;
}

static bw_status remember(const char *path, const bw_shape_voxels *v, double low, double high,
                          bw_shape_mask *mask)
{
  const size_t room = strlen(path) + 1;
  BW_TRY(BW_ALLOCATE(&mask->source, 1));
  BW_TRY(BW_ALLOCATE(&mask->source->path, room));
  memcpy(mask->source->path, path, room);
  mask->source->v = *v;
  mask->source->low = low;
  mask->source->high = high;
  return BW_OK;
}

bw_status bw_shape_mask_open_raw(const char *path, const bw_shape_voxels *v, double low,
                                 double high, bw_shape_mask **out)
{
  *out = NULL;
  BW_REQUIRE((unsigned)v->type < BW_SHAPE_VOXEL_COUNT, BW_EINPUT, "%s: voxel type %d is unknown",
             path, (int)v->type);
  BW_REQUIRE(low <= high, BW_EINPUT, "%s: no value lies between low = %g and high = %g", path, low,
             high);
  BW_REQUIRE(v->skip >= 0, BW_EINPUT, "%s: skip = %lld is negative", path, (long long)v->skip);
  FILE *file = fopen(path, "rb");
  BW_REQUIRE(file != NULL, BW_EIO, "%s: cannot be opened", path);
  /* No layer is read yet: who needs some asks for them (bw_shape_mask_hold). */
  bw_status st = bw_shape__mask_create(path, v->size, v->lower, v->spacing, out);
  BW_THEN(st, check_length(file, path, v));
  BW_THEN(st, remember(path, v, low, high, *out));
  fclose(file);
  if (st != BW_OK) bw_shape_mask_destroy(out);
  return st;
}

bw_status bw_shape__mask_all(bw_status st, bw_shape_mask **mask)
{
  BW_THEN(st, bw_shape_mask_hold(*mask, 0, (*mask)->size[2]));
  /* All layers are here: the file is not needed any more. */
  if (st == BW_OK)
    close_source(*mask);
  else
    bw_shape_mask_destroy(mask);
  return st;
}

bw_status bw_shape_mask_read_raw(const char *path, const bw_shape_voxels *v, double low,
                                 double high, bw_shape_mask **out)
{
  return bw_shape__mask_all(bw_shape_mask_open_raw(path, v, low, high, out), out);
}
