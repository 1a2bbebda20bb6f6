/* What headers of text have in common: words, numbers, units, and the mask that they lead to. */
#include "bw_number.h"
#include "shape_source.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool bw_shape__same(const char *a, const char *b)
{
  while (*a != 0 && tolower((unsigned char)*a) == tolower((unsigned char)*b))
    a++, b++;
  return *a == 0 && *b == 0;
}

char *bw_shape__trim(char *text)
{
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\r\n", text[n - 1]) != NULL)
    text[--n] = 0;
  return text + strspn(text, " \t\r\n");
}

double bw_shape__unit(const char *word)
{
  static const struct {
    const char *word;
    double metres;
  } units[] = {{"m", 1.0},
               {"meter", 1.0},
               {"metre", 1.0},
               {"meters", 1.0},
               {"metres", 1.0},
               {"dm", 0.1},
               {"cm", 1e-2},
               {"centimeter", 1e-2},
               {"centimetre", 1e-2},
               {"mm", 1e-3},
               {"millimeter", 1e-3},
               {"millimetre", 1e-3},
               {"millimeters", 1e-3},
               {"um", 1e-6},
               {"micron", 1e-6},
               {"microns", 1e-6},
               {"micrometer", 1e-6},
               {"micrometre", 1e-6},
               {"\xc2\xb5m", 1e-6},
               {"\xce\xbcm", 1e-6},
               {"\\u00B5m", 1e-6},
               {"nm", 1e-9},
               {"nanometer", 1e-9},
               {"nanometre", 1e-9},
               {"pm", 1e-12},
               {"km", 1e3},
               {"in", 0.0254},
               {"inch", 0.0254},
               {"inches", 0.0254}};
  char bare[32] = "";
  /* NRRD writes units in quotes. */
  const char *begin = word + strspn(word, " \t\"");
  snprintf(bare, sizeof bare, "%.*s", (int)strcspn(begin, "\""), begin);
  bw_shape__trim(bare);
  for (size_t q = 0; q < sizeof units / sizeof units[0]; q++)
    if (bw_shape__same(units[q].word, bare)) return units[q].metres;
  return NAN;
}

bw_status bw_shape__numbers(const bw_shape__header *h, const char *key, const char *value, int n,
                            double out[])
{
  static const char between[] = " \t,()[]";
  const char *at = value;
  for (int q = 0; q < n; q++) {
    char *end;
    at += strspn(at, between);
    out[q] = strtod(at, &end);
    BW_REQUIRE(end != at && isfinite(out[q]), BW_EINPUT,
               "%s: \"%s\" needs %d finite numbers, found \"%s\"", h->path, key, n, value);
    at = end;
  }
  at += strspn(at, between);
  BW_REQUIRE(*at == 0, BW_EINPUT, "%s: \"%s\" needs %d numbers, found more: \"%s\"", h->path, key,
             n, value);
  return BW_OK;
}

bw_status bw_shape__set_type(bw_shape__header *h, const bw_shape__type_word types[],
                             const char *value)
{
  for (; types->word != NULL; types++)
    if (bw_shape__same(types->word, value)) {
      h->v.type = types->type;
      h->has_type = true;
      return BW_OK;
    }
  return BW_FAIL(BW_EINPUT, "%s: the type \"%s\" is not one of whole or floating numbers", h->path,
                 value);
}

bw_status bw_shape__set_dims(bw_shape__header *h, const char *key, const char *value)
{
  double d;
  BW_TRY(bw_shape__numbers(h, key, value, 1, &d));
  BW_REQUIRE(d == 2 || d == 3, BW_EINPUT, "%s: %g dimensions; images have 2 or 3", h->path, d);
  h->dims = (int)d;
  return BW_OK;
}

bw_status bw_shape__set_size(bw_shape__header *h, const char *key, const char *value)
{
  double size[3] = {1, 1, 1};
  BW_TRY(bw_shape__numbers(h, key, value, h->dims, size));
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(size[d] >= 1 && size[d] < 1e9 && bw_to_int64(size[d], &h->v.size[d]) &&
                   size[d] == floor(size[d]),
               BW_EINPUT, "%s: %g voxels in direction %d", h->path, size[d], d);
  h->has_size = true;
  return BW_OK;
}

bw_status bw_shape__set_spacing(bw_shape__header *h, const char *key, const char *value)
{
  h->about.has_spacing = true;
  return bw_shape__numbers(h, key, value, h->dims, h->v.spacing);
}

bw_status bw_shape__set_directions(bw_shape__header *h, const char *key, const char *value,
                                   double out[3])
{
  /* Programs compute the axes, and leave behind what rounding leaves of a zero. */
  static const double nothing = 1e-6;
  double m[9], least = INFINITY;
  BW_TRY(bw_shape__numbers(h, key, value, h->dims * h->dims, m));
  for (int a = 0; a < h->dims; a++)
    least = fmin(least, fabs(m[a * h->dims + a]));
  for (int a = 0; a < h->dims; a++)
    for (int b = 0; b < h->dims; b++) {
      const double x = m[a * h->dims + b];
      BW_REQUIRE(a == b ? x != 0 : fabs(x) <= nothing * least, BW_EINPUT,
                 "%s: \"%s\" is \"%s\"; the axes have to be along x, y and z, or against them: "
                 "resample the image",
                 h->path, key, value);
      if (a == b) out[a] = fabs(x), h->reversed[a] = x < 0;
    }
  return BW_OK;
}

bw_status bw_shape__set_order(bw_shape__header *h, const char *key, const char *value,
                              const char *big, const char *little)
{
  h->ordered = true;
  h->v.big_endian = bw_shape__same(value, big);
  BW_REQUIRE(h->v.big_endian || bw_shape__same(value, little), BW_EINPUT,
             "%s: \"%s\" is \"%s\"; it has to be %s or %s", h->path, key, value, big, little);
  return BW_OK;
}

bw_status bw_shape__set_skip(bw_shape__header *h, const char *key, const char *value)
{
  double x;
  BW_TRY(bw_shape__numbers(h, key, value, 1, &x));
  /* Both formats define -1: whatever comes before, the numbers are the end of the file. */
  h->at_end = x == -1;
  BW_REQUIRE(h->at_end || (x >= 0 && x < 1e15 && x == floor(x)), BW_EINPUT,
             "%s: \"%s\" is %g; data start at 0 bytes or later (-1: they end the file)", h->path,
             key, x);
  h->v.skip = h->at_end ? 0 : (int64_t)x;
  return BW_OK;
}

bw_status bw_shape__set_unit(bw_shape__header *h, const char *key, const char *value)
{
  const double metres = bw_shape__unit(value);
  BW_REQUIRE(!isnan(metres), BW_EINPUT,
             "%s: \"%s\" is %s, which is no unit of length that is known; one of m, cm, mm, um, "
             "nm, inch",
             h->path, key, value);
  BW_REQUIRE(isnan(h->about.unit) || h->about.unit == metres, BW_EINPUT,
             "%s: \"%s\" is %s: all axes need the same unit", h->path, key, value);
  h->about.unit = metres;
  return BW_OK;
}

void bw_shape__not_read(bw_shape__header *h, const char *key)
{
  char *list = h->about.not_read;
  const size_t used = strlen(list), room = sizeof h->about.not_read;
  /* As many whole words as there is room for. */
  if (used + strlen(key) + 3 > room) return;
  snprintf(list + used, room - used, "%s%s", used > 0 ? ", " : "", key);
  for (char *c = list + used; *c != 0; c++)
    if (!isprint((unsigned char)*c)) *c = '?';
}

/* ---- from the header to the mask ---- */

/* The data file lies beside the header, unless its path is absolute. */
static bw_status beside(const bw_shape__header *h, size_t room, char out[])
{
  BW_REQUIRE(strncmp(h->data, "LIST", 4) != 0 && strchr(h->data, '%') == NULL, BW_EINPUT,
             "%s: the data are in more than one file, \"%s\"; one is read", h->path, h->data);
  const char *slash = strrchr(h->path, '/');
  const int folder = slash == NULL || h->data[0] == '/' ? 0 : (int)(slash - h->path) + 1;
  const int n = snprintf(out, room, "%.*s%s", folder, h->path, h->data);
  BW_REQUIRE(n > 0 && (size_t)n < room, BW_EINPUT, "%s: the data file's name is too long", h->path);
  return BW_OK;
}

/* Spacing and corner, in metres where the unit is known. */
static void place(bw_shape__header *h)
{
  bw_shape_voxels *v = &h->v;
  const double metres = isnan(h->about.unit) ? 1.0 : h->about.unit;
  /* An image in a plane is as thick as its voxels are long. */
  if (h->dims == 2) v->spacing[2] = v->spacing[0];
  for (int d = 0; d < 3; d++) {
    /* The origin is the centre of the first voxel, from which the others go either way. */
    const double back = h->reversed[d] ? (double)v->size[d] - 0.5 : 0.5;
    v->lower[d] = metres * (h->origin[d] - back * v->spacing[d]);
    v->spacing[d] *= metres;
  }
}

/* Where the numbers begin when they are the end of the file. */
static bw_status seek_end(const char *path, bw_shape_voxels *v)
{
  FILE *file = NULL;
  int64_t length;
  BW_TRY(bw_shape__open(path, &file, &length));
  fclose(file);
  const double need = (double)v->size[0] * (double)v->size[1] * (double)v->size[2] *
                      (double)bw_shape__bytes(v->type);
  BW_REQUIRE(need <= (double)length, BW_EIO,
             "%s: has %lld bytes, fewer than the %g of its voxels; size or type is not that of the "
             "file",
             path, (long long)length, need);
  v->skip = length - (int64_t)need;
  return BW_OK;
}

bw_status bw_shape__open_header(bw_shape__header *h, double low, double high, bw_shape_mask **out)
{
  char data[2 * sizeof h->data];
  const char *path = h->path;
  *out = NULL;
  /* Is all said that is needed to read the voxels? */
  BW_REQUIRE(h->has_type && h->has_size, BW_EINPUT, "%s: the header lacks %s%s%s", h->path,
             h->has_type ? "the size" : "the type of the voxels",
             h->about.not_read[0] != 0 ? "; it has keys that are not known: " : "",
             h->about.not_read);
  BW_REQUIRE(h->attached || h->data[0] != 0, BW_EINPUT, "%s: the header names no data", h->path);
  BW_REQUIRE(h->ordered || bw_shape__bytes(h->v.type) == 1, BW_EINPUT,
             "%s: the header does not say in which order the bytes of a number are", h->path);
  BW_REQUIRE(!h->compressed || !h->at_end, BW_EINPUT,
             "%s: packed voxels do not tell where they begin, as they end the file", h->path);
  /* Where they are: in a file beside the header, at the end of a file, or behind the header. */
  if (!h->attached) {
    BW_TRY(beside(h, sizeof data, data));
    path = data;
  }
  place(h);
  if (h->at_end) BW_TRY(seek_end(path, &h->v));
  if (h->attached && !h->compressed && !h->at_end) h->v.skip += h->end;
  if (h->compressed)
    BW_TRY(bw_shape__open_packed(path, h->attached ? h->end : 0, &h->v, low, high, out));
  else
    BW_TRY(bw_shape_mask_open_raw(path, &h->v, low, high, out));
  /* The mask keeps what the header told of its place and its directions. */
  (*out)->about = h->about;
  for (int d = 0; d < 3; d++)
    (*out)->source->flipped[d] = h->reversed[d];
  return BW_OK;
}
