/* STL files, binary and text. */
#include "shape_stl.h"
#include "bw_memory.h"
#include "shape_source.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t MOST = UINT32_MAX / 3; /* triangles whose corners can be numbered */

static bw_status make_room(const char *path, uint32_t room, bw_shape__triangles *t)
{
  BW_REQUIRE(room <= MOST, BW_EINPUT, "%s: more than %u triangles", path, MOST);
  BW_TRY(BW_ENLARGE(&t->corner, 9 * (size_t)t->n, 9 * (size_t)room));
  t->room = room;
  return BW_OK;
}

static bw_status push(const char *path, const float corner[9], bw_shape__triangles *t)
{
  /* Text files do not say how many there are. */
  if (t->n == t->room) BW_TRY(make_room(path, t->room < MOST / 2 ? 2 * t->room + 64 : MOST + 1, t));
  float *to = t->corner + 9 * (size_t)t->n++;
  for (int c = 0; c < 9; c++)
    to[c] = corner[c] + 0.0f; /* -0 and 0 are the same place */
  return BW_OK;
}

/* 80 bytes, a count, 50 bytes a triangle: normal, corners, two bytes. Numbers are little-endian,
 * as this machine's. */
static bw_status read_binary(FILE *file, const char *path, uint32_t count, bw_shape__triangles *t)
{
  unsigned char record[50];
  float corner[9];
  BW_TRY(make_room(path, count, t));
  for (uint32_t q = 0; q < count; q++) {
    BW_REQUIRE(fread(record, 1, sizeof record, file) == sizeof record, BW_EIO,
               "%s: ends after %u of %u triangles", path, q, count);
    memcpy(corner, record + 12, sizeof corner);
    BW_TRY(push(path, corner, t));
  }
  return BW_OK;
}

/* ---- text ---- */

/* The next word in small letters; false at the end. A longer one than `room` is cut. */
static bool next_word(FILE *file, size_t room, char word[])
{
  int c = fgetc(file);
  size_t n = 0;
  while (c != EOF && isspace(c))
    c = fgetc(file);
  for (; c != EOF && !isspace(c); c = fgetc(file))
    if (n + 1 < room) word[n++] = (char)tolower(c);
  word[n] = 0;
  if (c != EOF) ungetc(c, file); /* the end of a line counts behind `solid` */
  return n > 0;
}

/* The rest of the line is a name, whatever words are in it. */
static void skip_line(FILE *file)
{
  int c = fgetc(file);
  while (c != EOF && c != '\n' && c != '\r')
    c = fgetc(file);
}

static bw_status read_corner(FILE *file, const char *path, uint32_t facet, float corner[3])
{
  char word[64], *end;
  for (int d = 0; d < 3; d++) {
    const bool any = next_word(file, sizeof word, word);
    corner[d] = any ? strtof(word, &end) : 0.0f;
    BW_REQUIRE(any && end != word && *end == 0, BW_EINPUT,
               "%s: a vertex of facet %u is not three numbers", path, facet);
  }
  return BW_OK;
}

static bw_status read_text(FILE *file, const char *path, bw_shape__triangles *t)
{
  char word[64];
  float corner[9];
  int at = 0;
  while (next_word(file, sizeof word, word)) {
    if (strcmp(word, "solid") == 0 || strcmp(word, "endsolid") == 0) skip_line(file);
    /* Normals are not read: which side is outside follows from the order of the corners. */
    if (strcmp(word, "endloop") == 0) {
      BW_REQUIRE(at == 3, BW_EINPUT, "%s: facet %u has %d corners; a triangle has 3", path, t->n,
                 at);
      BW_TRY(push(path, corner, t));
      at = 0;
    }
    if (strcmp(word, "vertex") != 0) continue;
    BW_REQUIRE(at < 3, BW_EINPUT, "%s: facet %u has more than 3 corners", path, t->n);
    BW_TRY(read_corner(file, path, t->n, corner + 3 * at++));
  }
  BW_REQUIRE(at == 0, BW_EINPUT, "%s: ends within facet %u", path, t->n);
  return BW_OK;
}

/* Where the text begins: behind a byte-order mark and blanks; -1 where the first word is not
 * `solid`. */
static long begin_of_text(FILE *file)
{
  char word[8];
  long at = 0;
  rewind(file);
  if (fgetc(file) == 0xEF && fgetc(file) == 0xBB && fgetc(file) == 0xBF) at = 3;
  if (fseek(file, at, SEEK_SET) != 0 || !next_word(file, sizeof word, word)) return -1;
  return strcmp(word, "solid") == 0 ? at : -1;
}

/* Binary files are exactly as long as their count says; "solid" at the start proves nothing. */
static bw_status read_either(FILE *file, const char *path, int64_t length, bw_shape__triangles *t)
{
  unsigned char head[84];
  uint32_t count = 0;
  const bool long_enough = fread(head, 1, sizeof head, file) == sizeof head;
  if (long_enough) memcpy(&count, head + 80, sizeof count);
  if (long_enough && length == 84 + 50 * (int64_t)count) {
    BW_REQUIRE(count > 0, BW_EINPUT, "%s: holds no triangle", path);
    return read_binary(file, path, count, t);
  }
  const long begin = begin_of_text(file);
  BW_REQUIRE(begin >= 0 && fseek(file, begin, SEEK_SET) == 0, BW_EINPUT,
             "%s: is no STL file: it does not start with solid, and %lld bytes are not those of %u "
             "triangles, %lld",
             path, (long long)length, count, 84 + 50 * (long long)count);
  BW_TRY(read_text(file, path, t));
  /* "solid" at the start and no facet: most likely a binary file that was cut off. */
  BW_REQUIRE(t->n > 0, BW_EINPUT,
             "%s: holds no triangle as text, and as a binary file its %lld bytes are not those of "
             "%u triangles",
             path, (long long)length, count);
  return BW_OK;
}

bw_status bw_shape__read_triangles(const char *path, bw_shape__triangles *t)
{
  FILE *file = NULL;
  int64_t length;
  BW_TRY(bw_shape__open(path, &file, &length));
  const bw_status st = read_either(file, path, length, t);
  fclose(file);
  BW_TRY(st);
  /* Both forms can hold NaN, with which no point would be inside or outside. */
  for (size_t q = 0; q < 9 * (size_t)t->n; q++)
    BW_REQUIRE(isfinite(t->corner[q]), BW_EINPUT,
               "%s: triangle %zu has a corner that is not finite", path, q / 9);
  return BW_OK;
}
