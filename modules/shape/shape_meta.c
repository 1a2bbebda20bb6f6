/* Headers of MetaImage files: lines "Key = value", of which ElementDataFile is the last. */
#include "shape_source.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

/* MET_LONG has four bytes there, whatever machine wrote it. */
static const bw_shape__type_word types[] = {{"MET_UCHAR", BW_SHAPE_VOXEL_U8},
                                            {"MET_CHAR", BW_SHAPE_VOXEL_I8},
                                            {"MET_USHORT", BW_SHAPE_VOXEL_U16},
                                            {"MET_SHORT", BW_SHAPE_VOXEL_I16},
                                            {"MET_UINT", BW_SHAPE_VOXEL_U32},
                                            {"MET_INT", BW_SHAPE_VOXEL_I32},
                                            {"MET_ULONG", BW_SHAPE_VOXEL_U32},
                                            {"MET_LONG", BW_SHAPE_VOXEL_I32},
                                            {"MET_ULONG_LONG", BW_SHAPE_VOXEL_U64},
                                            {"MET_LONG_LONG", BW_SHAPE_VOXEL_I64},
                                            {"MET_FLOAT", BW_SHAPE_VOXEL_F32},
                                            {"MET_DOUBLE", BW_SHAPE_VOXEL_F64},
                                            {NULL, BW_SHAPE_VOXEL_COUNT}};

static bw_status set_type(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  return bw_shape__set_type(h, types, value);
}

static bw_status set_origin(bw_shape__header *h, const char *key, const char *value)
{
  return bw_shape__numbers(h, key, value, h->dims, h->origin);
}

static bw_status check_matrix(bw_shape__header *h, const char *key, const char *value)
{
  double size[3];
  BW_TRY(bw_shape__set_directions(h, key, value, size));
  for (int d = 0; d < h->dims; d++)
    BW_REQUIRE(fabs(size[d] - 1.0) < 1e-6, BW_EINPUT,
               "%s: \"%s\" is \"%s\"; its rows have to be of length 1", h->path, key, value);
  return BW_OK;
}

static bw_status set_yes(const bw_shape__header *h, const char *key, const char *value, bool *yes)
{
  *yes = bw_shape__same(value, "True") || strcmp(value, "1") == 0;
  BW_REQUIRE(*yes || bw_shape__same(value, "False") || strcmp(value, "0") == 0, BW_EINPUT,
             "%s: \"%s\" is \"%s\"; it has to be True or False", h->path, key, value);
  return BW_OK;
}

static bw_status set_compressed(bw_shape__header *h, const char *key, const char *value)
{
  return set_yes(h, key, value, &h->compressed);
}

static bw_status check_binary(bw_shape__header *h, const char *key, const char *value)
{
  bool binary;
  BW_TRY(set_yes(h, key, value, &binary));
  BW_REQUIRE(binary, BW_EINPUT,
             "%s: the voxels are written as text (%s = False); save them as binary", h->path, key);
  return BW_OK;
}

static bw_status check_channels(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  BW_REQUIRE(strcmp(value, "1") == 0, BW_EINPUT, "%s: %s numbers per voxel; one is read", h->path,
             value);
  return BW_OK;
}

static bw_status set_order(bw_shape__header *h, const char *key, const char *value)
{
  return bw_shape__set_order(h, key, value, "True", "False");
}

static bw_status set_unit(bw_shape__header *h, const char *key, const char *value)
{
  return strcmp(value, "?") == 0 ? BW_OK : bw_shape__set_unit(h, key, value);
}

static bw_status set_data(bw_shape__header *h, const char *key, const char *value)
{
  (void)key;
  h->attached = bw_shape__same(value, "LOCAL");
  snprintf(h->data, sizeof h->data, "%s", value);
  return BW_OK;
}

static bw_status ignore(bw_shape__header *h, const char *key, const char *value)
{
  (void)h, (void)key, (void)value;
  return BW_OK;
}

/* All keys that MetaIO's images have. */
static const struct {
  const char *key;
  bw_status (*set)(bw_shape__header *h, const char *key, const char *value);
} keys[] = {{"ElementType", set_type},
            {"NDims", bw_shape__set_dims},
            {"DimSize", bw_shape__set_size},
            {"ElementSpacing", bw_shape__set_spacing},
            {"Offset", set_origin},
            {"Position", set_origin},
            {"Origin", set_origin},
            {"TransformMatrix", check_matrix},
            {"Rotation", check_matrix},
            {"Orientation", check_matrix},
            {"CompressedData", set_compressed},
            {"BinaryData", check_binary},
            {"ElementNumberOfChannels", check_channels},
            {"ElementByteOrderMSB", set_order},
            {"BinaryDataByteOrderMSB", set_order},
            {"HeaderSize", bw_shape__set_skip},
            {"DistanceUnits", set_unit},
            {"ElementDataFile", set_data},
            {"ObjectType", ignore},
            {"ObjectSubType", ignore},
            {"TransformType", ignore},
            {"Comment", ignore},
            {"Name", ignore},
            {"ID", ignore},
            {"ParentID", ignore},
            {"Color", ignore},
            {"CenterOfRotation", ignore},
            {"AnatomicalOrientation", ignore},
            {"CompressedDataSize", ignore},
            {"CompressionLevel", ignore},
            {"ElementSize", ignore},
            {"ElementMin", ignore},
            {"ElementMax", ignore},
            {"ElementNBits", ignore},
            {"ElementToIntensityFunctionSlope", ignore},
            {"ElementToIntensityFunctionOffset", ignore},
            {"Modality", ignore},
            {"ImagePosition", ignore},
            {"SequenceID", ignore},
            {"AcquisitionDate", ignore}};

/* Does a word mean a key that it does not spell: other capitals, blanks or underscores, or one
 * letter more, less or wrong? */
static bool resembles(const char *word, const char *key)
{
  char bare[64];
  size_t n = 0;
  for (; *word != 0 && n + 1 < sizeof bare; word++)
    if (isalnum((unsigned char)*word)) bare[n++] = (char)tolower((unsigned char)*word);
  bare[n] = 0;
  /* What is the same at the begin and at the end may leave one letter between. */
  const size_t m = strlen(key), most = m > n ? m : n;
  size_t a = 0, b = 0;
  while (a < n && a < m && bare[a] == tolower((unsigned char)key[a]))
    a++;
  while (b + a < n && b + a < m && bare[n - 1 - b] == tolower((unsigned char)key[m - 1 - b]))
    b++;
  return m > 3 && a + b + 1 >= most;
}

static bw_status set_key(bw_shape__header *h, const char *key, const char *value)
{
  const size_t all = sizeof keys / sizeof keys[0];
  for (size_t q = 0; q < all; q++)
    if (strcmp(keys[q].key, key) == 0) return keys[q].set(h, key, value);
  /* Programs add keys of their own, which is fine; one that is misspelt would be overlooked. */
  for (size_t q = 0; q < all; q++)
    BW_REQUIRE(!resembles(key, keys[q].key), BW_EINPUT,
               "%s: the key \"%.60s\" is not known; is %s meant?", h->path, key, keys[q].key);
  bw_shape__not_read(h, key);
  return BW_OK;
}

bw_status bw_shape__open_meta(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out)
{
  char line[4096];
  bw_shape__header h = {.path = path,
                        .dims = 3,
                        .about = {.format = "MetaImage", .unit = NAN},
                        .v = {.size = {1, 1, 1}, .spacing = {1, 1, 1}}};
  *out = NULL;
  /* Numbers that are attached begin behind the line that says so. */
  while (h.data[0] == 0 && fgets(line, sizeof line, file) != NULL) {
    BW_REQUIRE(strchr(line, '\n') != NULL || feof(file), BW_EINPUT,
               "%s: a line of the header is longer than %zu bytes", path, sizeof line);
    char *value = strchr(line, '=');
    if (value == NULL) continue;
    *value++ = 0;
    BW_TRY(set_key(&h, bw_shape__trim(line), bw_shape__trim(value)));
  }
  h.end = (int64_t)ftello(file);
  return bw_shape__open_header(&h, low, high, out);
}
