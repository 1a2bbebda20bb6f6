/* Headers of NRRD and MetaImage files. */
#include "shape_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096 };

typedef struct {
  const char *path;
  bw_shape_voxels v;
  int dims;
  bool has_type, has_size, has_end, attached, ordered;
  double origin[3];
  char data[LINE];
} header;

typedef struct {
  const char *word;
  bw_shape_voxel_type type;
} type_word;

static const type_word nrrd_types[] = {{"uchar", BW_SHAPE_VOXEL_U8},
                                       {"unsigned char", BW_SHAPE_VOXEL_U8},
                                       {"uint8", BW_SHAPE_VOXEL_U8},
                                       {"uint8_t", BW_SHAPE_VOXEL_U8},
                                       {"signed char", BW_SHAPE_VOXEL_I8},
                                       {"int8", BW_SHAPE_VOXEL_I8},
                                       {"int8_t", BW_SHAPE_VOXEL_I8},
                                       {"ushort", BW_SHAPE_VOXEL_U16},
                                       {"unsigned short", BW_SHAPE_VOXEL_U16},
                                       {"uint16", BW_SHAPE_VOXEL_U16},
                                       {"uint16_t", BW_SHAPE_VOXEL_U16},
                                       {"short", BW_SHAPE_VOXEL_I16},
                                       {"int16", BW_SHAPE_VOXEL_I16},
                                       {"int16_t", BW_SHAPE_VOXEL_I16},
                                       {"uint", BW_SHAPE_VOXEL_U32},
                                       {"unsigned int", BW_SHAPE_VOXEL_U32},
                                       {"uint32", BW_SHAPE_VOXEL_U32},
                                       {"uint32_t", BW_SHAPE_VOXEL_U32},
                                       {"int", BW_SHAPE_VOXEL_I32},
                                       {"int32", BW_SHAPE_VOXEL_I32},
                                       {"int32_t", BW_SHAPE_VOXEL_I32},
                                       {"float", BW_SHAPE_VOXEL_F32},
                                       {"double", BW_SHAPE_VOXEL_F64},
                                       {NULL, BW_SHAPE_VOXEL_COUNT}};

static const type_word meta_types[] = {
    {"MET_UCHAR", BW_SHAPE_VOXEL_U8},   {"MET_CHAR", BW_SHAPE_VOXEL_I8},
    {"MET_USHORT", BW_SHAPE_VOXEL_U16}, {"MET_SHORT", BW_SHAPE_VOXEL_I16},
    {"MET_UINT", BW_SHAPE_VOXEL_U32},   {"MET_INT", BW_SHAPE_VOXEL_I32},
    {"MET_FLOAT", BW_SHAPE_VOXEL_F32},  {"MET_DOUBLE", BW_SHAPE_VOXEL_F64},
    {NULL, BW_SHAPE_VOXEL_COUNT}};

static bw_status set_type(header *h, const type_word types[], const char *value)
{
  for (; types->word != NULL; types++)
    if (strcmp(types->word, value) == 0) {
      h->v.type = types->type;
      h->has_type = true;
      return BW_OK;
    }
  return BW_FAIL(BW_EINPUT, "%s: the type \"%s\" is not one of whole or floating numbers", h->path,
                 value);
}

/* `n` numbers, with any of " ,()" between them. */
static bw_status numbers(const header *h, const char *key, const char *value, int n, double out[])
{
  const char *at = value;
  for (int q = 0; q < n; q++) {
    char *end;
    at += strspn(at, " ,()");
    out[q] = strtod(at, &end);
    BW_REQUIRE(end != at && isfinite(out[q]), BW_EINPUT,
               "%s: \"%s\" needs %d numbers, found \"%s\"", h->path, key, n, value);
    at = end;
  }
  return BW_OK;
}

static bw_status set_dims(header *h, const char *key, const char *value)
{
  double d;
  BW_TRY(numbers(h, key, value, 1, &d));
  BW_REQUIRE(d == 2 || d == 3, BW_EINPUT, "%s: %g dimensions; images have 2 or 3", h->path, d);
  h->dims = (int)d;
  return BW_OK;
}

static bw_status set_size(header *h, const char *key, const char *value)
{
  double size[3] = {1, 1, 1};
  BW_TRY(numbers(h, key, value, h->dims, size));
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(size[d] >= 1 && size[d] < 1e9 && size[d] == floor(size[d]), BW_EINPUT,
               "%s: %g voxels in direction %d", h->path, size[d], d);
    h->v.size[d] = (int64_t)size[d];
  }
  h->has_size = true;
  return BW_OK;
}

/* Rows of a matrix that has to be diagonal and positive; its diagonal to out. */
static bw_status diagonal(const header *h, const char *key, const char *value, double out[3])
{
  double m[9];
  BW_TRY(numbers(h, key, value, h->dims * h->dims, m));
  for (int a = 0; a < h->dims; a++)
    for (int b = 0; b < h->dims; b++) {
      const double x = m[a * h->dims + b];
      BW_REQUIRE(a == b ? x > 0 : x == 0, BW_EINPUT,
                 "%s: \"%s\" is \"%s\"; the axes have to be along x, y and z", h->path, key, value);
      if (a == b) out[a] = x;
    }
  return BW_OK;
}

/* Which end of a number comes first: `value` is one of two words. */
static bw_status set_order(header *h, const char *key, const char *value, const char *big,
                           const char *little)
{
  h->ordered = true;
  h->v.big_endian = strcmp(value, big) == 0;
  BW_REQUIRE(h->v.big_endian || strcmp(value, little) == 0, BW_EINPUT,
             "%s: \"%s\" is \"%s\"; it has to be %s or %s", h->path, key, value, big, little);
  return BW_OK;
}

static bw_status set_skip(header *h, const char *key, const char *value)
{
  double x;
  BW_TRY(numbers(h, key, value, 1, &x));
  BW_REQUIRE(x >= 0 && x < 1e15, BW_EINPUT, "%s: \"%s\" is %g; data start at 0 bytes or later",
             h->path, key, x);
  h->v.skip = (int64_t)x;
  return BW_OK;
}

/* Fields that say where the numbers are or where they belong, in a way that is not read. */
static const char *const nrrd_not_read[] = {"line skip", "lineskip", "axis mins", "axismins",
                                            "axis maxs", "axismaxs", NULL};

static bw_status nrrd_field(header *h, const char *key, const char *value)
{
  if (strcmp(key, "type") == 0) return set_type(h, nrrd_types, value);
  if (strcmp(key, "dimension") == 0) return set_dims(h, key, value);
  if (strcmp(key, "sizes") == 0) return set_size(h, key, value);
  if (strcmp(key, "spacings") == 0) return numbers(h, key, value, h->dims, h->v.spacing);
  if (strcmp(key, "space directions") == 0) return diagonal(h, key, value, h->v.spacing);
  if (strcmp(key, "space origin") == 0) return numbers(h, key, value, h->dims, h->origin);
  if (strcmp(key, "encoding") == 0)
    BW_REQUIRE(strcmp(value, "raw") == 0, BW_EINPUT,
               "%s: the encoding is \"%s\"; only raw is read (unu save -e raw)", h->path, value);
  if (strcmp(key, "endian") == 0) return set_order(h, key, value, "big", "little");
  if (strcmp(key, "byte skip") == 0 || strcmp(key, "byteskip") == 0) return set_skip(h, key, value);
  for (const char *const *other = nrrd_not_read; *other != NULL; other++)
    BW_REQUIRE(strcmp(key, *other) != 0, BW_EINPUT, "%s: the field \"%s\" is not read", h->path,
               key);
  if (strcmp(key, "data file") == 0 || strcmp(key, "datafile") == 0)
    snprintf(h->data, sizeof h->data, "%s", value);
  return BW_OK;
}

static bw_status meta_field(header *h, const char *key, const char *value)
{
  double one[3];
  if (strcmp(key, "ElementType") == 0) return set_type(h, meta_types, value);
  if (strcmp(key, "NDims") == 0) return set_dims(h, key, value);
  if (strcmp(key, "DimSize") == 0) return set_size(h, key, value);
  if (strcmp(key, "ElementSpacing") == 0) return numbers(h, key, value, h->dims, h->v.spacing);
  if (strcmp(key, "Offset") == 0 || strcmp(key, "Position") == 0 || strcmp(key, "Origin") == 0)
    return numbers(h, key, value, h->dims, h->origin);
  if (strcmp(key, "TransformMatrix") == 0) return diagonal(h, key, value, one);
  if (strcmp(key, "CompressedData") == 0)
    BW_REQUIRE(strcmp(value, "False") == 0, BW_EINPUT, "%s: compressed data are not read", h->path);
  if (strcmp(key, "ElementNumberOfChannels") == 0)
    BW_REQUIRE(strcmp(value, "1") == 0, BW_EINPUT, "%s: %s numbers per voxel; one is read", h->path,
               value);
  if (strcmp(key, "ElementByteOrderMSB") == 0 || strcmp(key, "BinaryDataByteOrderMSB") == 0)
    return set_order(h, key, value, "True", "False");
  if (strcmp(key, "HeaderSize") == 0) return set_skip(h, key, value);
  if (strcmp(key, "ElementDataFile") == 0) { /* the last line of the header */
    h->has_end = true;
    h->attached = strcmp(value, "LOCAL") == 0;
    snprintf(h->data, sizeof h->data, "%s", value);
  }
  return BW_OK;
}

static void trim(char *text)
{
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\r\n", text[n - 1]) != NULL)
    text[--n] = 0;
}

/* Lines "key SEPARATOR value" up to the end of the header. */
static bw_status read_header(FILE *file, header *h, bool nrrd)
{
  char line[LINE];
  while (!h->has_end && fgets(line, sizeof line, file) != NULL) {
    trim(line);
    if (nrrd && line[0] == 0) h->has_end = h->attached = true;
    char *value = strstr(line, nrrd ? ":" : "=");
    if (value == NULL || line[0] == '#') continue;
    *value++ = 0;
    value += strspn(value, " \t=");
    trim(line);
    BW_TRY(nrrd ? nrrd_field(h, line, value) : meta_field(h, line, value));
  }
  if (nrrd && h->data[0] != 0) h->attached = false;
  if (h->attached) h->v.skip += ftell(file);
  BW_REQUIRE(h->has_type && h->has_size, BW_EINPUT, "%s: the header lacks %s", h->path,
             h->has_type ? "the size" : "the type of the voxels");
  BW_REQUIRE(h->attached || h->data[0] != 0, BW_EINPUT, "%s: the header names no data", h->path);
  BW_REQUIRE(h->ordered || h->v.type <= BW_SHAPE_VOXEL_I8, BW_EINPUT,
             "%s: the header does not say in which order the bytes of a number are", h->path);
  for (int d = 0; d < 3; d++)
    h->v.lower[d] = h->origin[d] - 0.5 * h->v.spacing[d];
  return BW_OK;
}

/* The data file lies beside the header, unless its path is absolute. */
static bw_status beside(const header *h, size_t room, char out[])
{
  BW_REQUIRE(strncmp(h->data, "LIST", 4) != 0 && strchr(h->data, '%') == NULL, BW_EINPUT,
             "%s: the data are in more than one file, \"%s\"; one is read", h->path, h->data);
  const char *slash = strrchr(h->path, '/');
  const int folder = slash == NULL || h->data[0] == '/' ? 0 : (int)(slash - h->path) + 1;
  const int n = snprintf(out, room, "%.*s%s", folder, h->path, h->data);
  BW_REQUIRE(n > 0 && (size_t)n < room, BW_EINPUT, "%s: the data file's name is too long", h->path);
  return BW_OK;
}

bw_status bw_shape_mask_open_image(const char *path, double low, double high, bw_shape_mask **out)
{
  *out = NULL;
  header h = {.path = path, .dims = 3, .v = {.size = {1, 1, 1}, .spacing = {1, 1, 1}}};
  char first[16] = "", data[2 * LINE];
  FILE *file = fopen(path, "rb");
  BW_REQUIRE(file != NULL, BW_EIO, "%s: cannot be opened", path);
  const bool any = fgets(first, sizeof first, file) != NULL;
  const bool nrrd = any && strncmp(first, "NRRD000", 7) == 0;
  const char *suffix = strrchr(path, '.');
  const bool meta = suffix != NULL && (strcmp(suffix, ".mhd") == 0 || strcmp(suffix, ".mha") == 0);
  bw_status st = BW_OK;
  if (!nrrd && !meta)
    st = BW_FAIL(BW_EINPUT, "%s: neither starts with NRRD000 nor is called .mhd or .mha", path);
  if (meta && !nrrd) rewind(file);
  BW_THEN(st, read_header(file, &h, nrrd));
  fclose(file);
  if (st == BW_OK && !h.attached) st = beside(&h, sizeof data, data);
  BW_THEN(st, bw_shape_mask_open_raw(h.attached ? path : data, &h.v, low, high, out));
  return st;
}

bw_status bw_shape_mask_read_image(const char *path, double low, double high, bw_shape_mask **out)
{
  return bw_shape__mask_all(bw_shape_mask_open_image(path, low, high, out), out);
}
