/* Arrays of NumPy (.npy): a magic word, the version, the length of a header that is a dictionary of
 * Python, and the numbers. */
#include "shape_source.h"

#include <math.h>
#include <string.h>

/* The type as numpy writes it, without the mark for the order of bytes. */
static const bw_shape__type_word types[] = {
    {"u1", BW_SHAPE_VOXEL_U8},  {"b1", BW_SHAPE_VOXEL_U8},  {"i1", BW_SHAPE_VOXEL_I8},
    {"u2", BW_SHAPE_VOXEL_U16}, {"i2", BW_SHAPE_VOXEL_I16}, {"u4", BW_SHAPE_VOXEL_U32},
    {"i4", BW_SHAPE_VOXEL_I32}, {"u8", BW_SHAPE_VOXEL_U64}, {"i8", BW_SHAPE_VOXEL_I64},
    {"f4", BW_SHAPE_VOXEL_F32}, {"f8", BW_SHAPE_VOXEL_F64}, {NULL, BW_SHAPE_VOXEL_COUNT}};

/* The value behind 'key': in the dictionary, up to the comma or bracket that ends it. */
static bw_status find(const bw_shape__header *h, const char *text, const char *key, size_t room,
                      char value[])
{
  char quoted[32];
  snprintf(quoted, sizeof quoted, "'%s':", key);
  const char *at = strstr(text, quoted);
  BW_REQUIRE(at != NULL, BW_EINPUT, "%s: the header has no %s", h->path, key);
  at += strlen(quoted);
  at += strspn(at, " ");
  const size_t n = *at == '(' ? strcspn(at, ")") + 1 : strcspn(at, ",}");
  BW_REQUIRE(n < room && n <= strlen(at), BW_EINPUT, "%s: the header's %s has no end", h->path,
             key);
  memcpy(value, at, n);
  value[n] = 0;
  return BW_OK;
}

static bw_status set_type(bw_shape__header *h, char *value)
{
  char *word = bw_shape__trim(value);
  const size_t n = strlen(word);
  BW_REQUIRE(n == 5 && word[0] == '\'' && word[4] == '\'' && strchr("<>|=", word[1]) != NULL,
             BW_EINPUT, "%s: the type %s is not one of whole or floating numbers", h->path, word);
  word[4] = 0;
  h->v.big_endian = word[1] == '>' || (word[1] == '=' && bw_shape__machine_is_big());
  h->ordered = true;
  return bw_shape__set_type(h, types, word + 2);
}

/* (z, y, x) or (y, x): the last index is the fastest. */
static bw_status set_shape(bw_shape__header *h, const char *value)
{
  double n[3];
  int commas = 0;
  for (const char *c = value; *c != 0; c++)
    commas += *c == ',';
  /* One behind the last number is allowed. */
  const char *last = strrchr(value, ',');
  if (last != NULL && strspn(last + 1, " )") == strlen(last + 1)) commas--;
  BW_REQUIRE(commas == 1 || commas == 2, BW_EINPUT,
             "%s: an array of shape %s; images have 2 or 3 dimensions", h->path, value);
  h->dims = commas + 1;
  BW_TRY(bw_shape__numbers(h, "shape", value, h->dims, n));
  for (int d = 0; d < h->dims; d++) {
    const double size = n[h->dims - 1 - d];
    BW_REQUIRE(size >= 1 && size < 1e9 && size == floor(size), BW_EINPUT,
               "%s: %g voxels in direction %d", h->path, size, d);
    h->v.size[d] = (int64_t)size;
  }
  h->has_size = true;
  return BW_OK;
}

static bw_status read_dictionary(bw_shape__header *h, const char *text)
{
  char value[128];
  BW_TRY(find(h, text, "descr", sizeof value, value));
  BW_TRY(set_type(h, value));
  BW_TRY(find(h, text, "fortran_order", sizeof value, value));
  BW_REQUIRE(strncmp(value, "False", 5) == 0, BW_EINPUT,
             "%s: the array lies in Fortran's order, so that z is fastest: save "
             "numpy.ascontiguousarray of it",
             h->path);
  BW_TRY(find(h, text, "shape", sizeof value, value));
  return set_shape(h, value);
}

bw_status bw_shape__open_npy(const char *path, FILE *file, double low, double high,
                             bw_shape_mask **out)
{
  unsigned char begin[12] = {0};
  char text[4096] = "";
  bw_shape__header h = {.path = path,
                        .dims = 3,
                        .attached = true,
                        .about = {.format = "npy", .unit = NAN},
                        .v = {.size = {1, 1, 1}, .spacing = {1, 1, 1}}};
  *out = NULL;
  /* Version 1 has two bytes for the length, later ones four; all little-endian. */
  size_t wide = 2;
  bool whole = fread(begin, 1, 8, file) == 8;
  if (begin[6] > 1) wide = 4;
  whole = whole && fread(begin + 8, 1, wide, file) == wide;
  size_t length = 0;
  for (size_t b = 0; b < wide; b++)
    length += (size_t)begin[8 + b] << (8 * b);
  BW_REQUIRE(whole && length < sizeof text && fread(text, 1, length, file) == length, BW_EINPUT,
             "%s: the header of %zu bytes is cut off or too long", path, length);
  h.end = (int64_t)ftello(file);
  BW_TRY(read_dictionary(&h, text));
  return bw_shape__open_header(&h, low, high, out);
}
