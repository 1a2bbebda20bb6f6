/* Headers of NRRD files: lines "field: value" up to an empty one. Fields and words of the format
 * are the same in capitals. */
#include "shape_source.h"

#include <math.h>
#include <string.h>

static const bw_shape__type_word types[] = {{"uchar", BW_SHAPE_VOXEL_U8},
                                            {"unsigned char", BW_SHAPE_VOXEL_U8},
                                            {"uint8", BW_SHAPE_VOXEL_U8},
                                            {"uint8_t", BW_SHAPE_VOXEL_U8},
                                            {"signed char", BW_SHAPE_VOXEL_I8},
                                            {"int8", BW_SHAPE_VOXEL_I8},
                                            {"int8_t", BW_SHAPE_VOXEL_I8},
                                            {"ushort", BW_SHAPE_VOXEL_U16},
                                            {"unsigned short", BW_SHAPE_VOXEL_U16},
                                            {"unsigned short int", BW_SHAPE_VOXEL_U16},
                                            {"uint16", BW_SHAPE_VOXEL_U16},
                                            {"uint16_t", BW_SHAPE_VOXEL_U16},
                                            {"short", BW_SHAPE_VOXEL_I16},
                                            {"short int", BW_SHAPE_VOXEL_I16},
                                            {"signed short", BW_SHAPE_VOXEL_I16},
                                            {"signed short int", BW_SHAPE_VOXEL_I16},
                                            {"int16", BW_SHAPE_VOXEL_I16},
                                            {"int16_t", BW_SHAPE_VOXEL_I16},
                                            {"uint", BW_SHAPE_VOXEL_U32},
                                            {"unsigned int", BW_SHAPE_VOXEL_U32},
                                            {"uint32", BW_SHAPE_VOXEL_U32},
                                            {"uint32_t", BW_SHAPE_VOXEL_U32},
                                            {"int", BW_SHAPE_VOXEL_I32},
                                            {"signed int", BW_SHAPE_VOXEL_I32},
                                            {"int32", BW_SHAPE_VOXEL_I32},
                                            {"int32_t", BW_SHAPE_VOXEL_I32},
                                            {"ulonglong", BW_SHAPE_VOXEL_U64},
                                            {"unsigned long long", BW_SHAPE_VOXEL_U64},
                                            {"unsigned long long int", BW_SHAPE_VOXEL_U64},
                                            {"uint64", BW_SHAPE_VOXEL_U64},
                                            {"uint64_t", BW_SHAPE_VOXEL_U64},
                                            {"longlong", BW_SHAPE_VOXEL_I64},
                                            {"long long", BW_SHAPE_VOXEL_I64},
                                            {"long long int", BW_SHAPE_VOXEL_I64},
                                            {"signed long long", BW_SHAPE_VOXEL_I64},
                                            {"signed long long int", BW_SHAPE_VOXEL_I64},
                                            {"int64", BW_SHAPE_VOXEL_I64},
                                            {"int64_t", BW_SHAPE_VOXEL_I64},
                                            {"float", BW_SHAPE_VOXEL_F32},
                                            {"double", BW_SHAPE_VOXEL_F64},
                                            {NULL, BW_SHAPE_VOXEL_COUNT}};

static bw_status set_encoding(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  h->compressed = bw_shape__same(value, "gzip") || bw_shape__same(value, "gz");
  BW_REQUIRE(h->compressed || bw_shape__same(value, "raw"), BW_EINPUT,
             "%s: the encoding is \"%s\"; raw and gzip are read (unu save -e raw)", h->path, value);
  return BW_OK;
}

static bw_status set_endian(bw_shape__header *h, const char *key, const char *value)
{
  return bw_shape__set_order(h, key, value, "big", "little");
}

static bw_status set_type(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  return bw_shape__set_type(h, types, value);
}

static bw_status set_axes(bw_shape__header *h, const char *key, const char *value)
{
  h->about.has_spacing = true;
  return bw_shape__set_directions(h, key, value, h->v.spacing);
}

static bw_status set_origin(bw_shape__header *h, const char *key, const char *value)
{
  return bw_shape__numbers(h, key, value, h->dims, h->origin);
}

/* One unit in quotes for each axis; empty ones say nothing. */
static bw_status set_units(bw_shape__header *h, const char *key, const char *value)
{
  const char *at = value;
  for (int d = 0; d < h->dims; d++) {
    char one[64];
    at += strspn(at, " \t");
    const char *end = *at == '"' ? strchr(at + 1, '"') : NULL;
    BW_REQUIRE(end != NULL, BW_EINPUT, "%s: \"%s\" needs %d words in quotes, found %s", h->path,
               key, h->dims, value);
    snprintf(one, sizeof one, "%.*s", (int)(end - at) + 1, at);
    at = end + 1;
    if (strspn(one + 1, " \t\"") < strlen(one + 1)) BW_TRY(bw_shape__set_unit(h, key, one));
  }
  return BW_OK;
}

/* Axes have to be of space: a first axis of colours would be taken for x. */
static bw_status check_kinds(bw_shape__header *h, const char *key, const char *value)
{
  static const char *const fine[] = {"domain", "space", "none", "???"};
  const char *at = value;
  for (int axis = 0; *(at += strspn(at, " \t")) != 0; axis++) {
    char one[64];
    bool known = false;
    const int n = (int)strcspn(at, " \t");
    snprintf(one, sizeof one, "%.*s", n, at);
    for (size_t q = 0; q < sizeof fine / sizeof fine[0]; q++)
      known = known || bw_shape__same(one, fine[q]);
    BW_REQUIRE(known, BW_EINPUT,
               "%s: \"%s\" calls axis %d %s, which is no direction in space; one number per voxel "
               "is read",
               h->path, key, axis, one);
    at += n;
  }
  return BW_OK;
}

static bw_status set_data(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  snprintf(h->data, sizeof h->data, "%s", value);
  return BW_OK;
}

static bw_status refuse(bw_shape__header *h, const char *key, const char *value)
{
  (void)value;
  return BW_FAIL(BW_EINPUT, "%s: the field \"%s\" is not read", h->path, key);
}

static bw_status ignore(bw_shape__header *h, const char *key, const char *value)
{
  (void)h, (void)key, (void)value;
  return BW_OK;
}

/* All fields that the format has. */
static const struct {
  const char *key;
  bw_status (*set)(bw_shape__header *h, const char *key, const char *value);
  bool after_dimension; /* its value has as many parts as there are axes */
} fields[] = {{"type", set_type, false},
              {"dimension", bw_shape__set_dims, false},
              {"sizes", bw_shape__set_size, true},
              {"spacings", bw_shape__set_spacing, true},
              {"space directions", set_axes, true},
              {"space origin", set_origin, true},
              {"units", set_units, true},
              {"space units", set_units, true},
              {"encoding", set_encoding, false},
              {"endian", set_endian, false},
              {"byte skip", bw_shape__set_skip, false},
              {"byteskip", bw_shape__set_skip, false},
              {"data file", set_data, false},
              {"datafile", set_data, false},
              {"kinds", check_kinds, false},
              {"line skip", refuse, false},
              {"lineskip", refuse, false},
              {"axis mins", refuse, false},
              {"axismins", refuse, false},
              {"axis maxs", refuse, false},
              {"axismaxs", refuse, false},
              {"block size", refuse, false},
              {"blocksize", refuse, false},
              {"content", ignore, false},
              {"space", ignore, false},
              {"space dimension", ignore, false},
              {"measurement frame", ignore, false},
              {"thicknesses", ignore, false},
              {"labels", ignore, false},
              {"centers", ignore, false},
              {"centerings", ignore, false},
              {"min", ignore, false},
              {"max", ignore, false},
              {"old min", ignore, false},
              {"oldmin", ignore, false},
              {"old max", ignore, false},
              {"oldmax", ignore, false},
              {"number", ignore, false},
              {"sample units", ignore, false},
              {"sampleunits", ignore, false}};

static bw_status set_field(bw_shape__header *h, bool dimensioned, const char *key,
                           const char *value)
{
  for (size_t q = 0; q < sizeof fields / sizeof fields[0]; q++) {
    if (!bw_shape__same(fields[q].key, key)) continue;
    BW_REQUIRE(dimensioned || !fields[q].after_dimension, BW_EINPUT,
               "%s: \"%s\" stands before \"dimension\", which the format does not allow", h->path,
               key);
    return fields[q].set(h, key, value);
  }
  return BW_FAIL(BW_EINPUT, "%s: the format has no field \"%.60s\"", h->path, key);
}

/* Lines up to an empty one, behind which attached numbers begin, or to the end of the file. */
static bw_status read_fields(FILE *file, bw_shape__header *h)
{
  char line[4096];
  bool dimensioned = false;
  while (fgets(line, sizeof line, file) != NULL) {
    BW_REQUIRE(strchr(line, '\n') != NULL || feof(file), BW_EINPUT,
               "%s: a line of the header is longer than %zu bytes", h->path, sizeof line);
    char *key = bw_shape__trim(line);
    if (*key == 0) {
      h->attached = h->data[0] == 0;
      h->end = (int64_t)ftello(file);
      return BW_OK;
    }
    char *value = strchr(key, ':');
    /* Comments, and what a user has added as key:=value. */
    if (*key == '#' || (value != NULL && value[1] == '=')) continue;
    BW_REQUIRE(value != NULL, BW_EINPUT, "%s: the header's line \"%.60s\" is no \"field: value\"",
               h->path, key);
    *value++ = 0;
    key = bw_shape__trim(key);
    BW_TRY(set_field(h, dimensioned, key, bw_shape__trim(value)));
    dimensioned = dimensioned || bw_shape__same(key, "dimension");
  }
  return BW_OK;
}

bw_status bw_shape__open_nrrd(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out)
{
  char magic[32];
  bw_shape__header h = {.path = path,
                        .dims = 3,
                        .about = {.format = "NRRD", .unit = NAN},
                        .v = {.size = {1, 1, 1}, .spacing = {1, 1, 1}}};
  *out = NULL;
  BW_REQUIRE(fgets(magic, sizeof magic, file) != NULL, BW_EIO, "%s: is empty", path);
  BW_TRY(read_fields(file, &h));
  return bw_shape__open_header(&h, low, high, out);
}
