/* Closed surfaces of triangles, filled by the parity of crossings. */
#include "bw_memory.h"
#include "shape_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  size_t n, room;
  float *corner; /* (n,3,3) */
} surface;

static bw_status push(surface *s, const float corner[9])
{
  if (s->n == s->room) {
    float *more = NULL;
    /* Text files do not say how many there are. */
    BW_TRY(BW_ALLOCATE(&more, 9 * (2 * s->room + 64)));
    if (s->n > 0) memcpy(more, s->corner, 9 * s->n * sizeof *more);
    bw_release(&s->corner);
    s->corner = more;
    s->room = 2 * s->room + 64;
  }
  memcpy(s->corner + 9 * s->n++, corner, 9 * sizeof *corner);
  return BW_OK;
}

/* 80 bytes, a count, 50 bytes a triangle: normal, corners, two bytes. Numbers are little-endian,
 * as this machine's. */
static bw_status read_binary(FILE *file, const char *path, uint32_t count, surface *s)
{
  unsigned char record[50];
  float corner[9];
  for (uint32_t q = 0; q < count; q++) {
    BW_REQUIRE(fread(record, 1, sizeof record, file) == sizeof record, BW_EIO,
               "%s: ends after %u of %u triangles", path, q, count);
    memcpy(corner, record + 12, sizeof corner);
    BW_TRY(push(s, corner));
  }
  return BW_OK;
}

static bw_status read_text(FILE *file, const char *path, surface *s)
{
  char word[128];
  float corner[9];
  int at = 0;
  while (fscanf(file, "%127s", word) == 1) {
    /* Normals are not read: inside and outside follow from the parity of crossings. */
    if (strcmp(word, "endloop") == 0) {
      BW_REQUIRE(at == 3, BW_EINPUT, "%s: facet %zu has %d corners; a triangle has 3", path, s->n,
                 at);
      BW_TRY(push(s, corner));
      at = 0;
    }
    if (strcmp(word, "vertex") != 0) continue;
    BW_REQUIRE(at < 3, BW_EINPUT, "%s: facet %zu has more than 3 corners", path, s->n);
    float *c = corner + 3 * at++;
    BW_REQUIRE(fscanf(file, "%f %f %f", &c[0], &c[1], &c[2]) == 3, BW_EINPUT,
               "%s: a vertex of facet %zu is not three numbers", path, s->n);
  }
  BW_REQUIRE(at == 0, BW_EINPUT, "%s: ends within facet %zu", path, s->n);
  return BW_OK;
}

/* Binary files are exactly as long as their count says; "solid" at the start proves nothing. */
static bw_status read_surface(const char *path, surface *s)
{
  FILE *file = fopen(path, "rb");
  BW_REQUIRE(file != NULL, BW_EIO, "%s: cannot be opened", path);
  /* A binary file tells its number of triangles at byte 80; whether it is one its length tells. */
  unsigned char head[84];
  uint32_t count = 0;
  const bool long_enough = fread(head, 1, sizeof head, file) == sizeof head;
  if (long_enough) memcpy(&count, head + 80, sizeof count);
  fseek(file, 0, SEEK_END);
  const long length = ftell(file);
  bw_status st;
  if (long_enough && length == 84 + 50L * (long)count) {
    fseek(file, 84, SEEK_SET);
    st = read_binary(file, path, count, s);
  } else if (length >= 5 && memcmp(head, "solid", 5) == 0) {
    rewind(file);
    st = read_text(file, path, s);
  } else {
    st = BW_FAIL(BW_EINPUT,
                 "%s: is no STL file: it does not start with solid, and %ld bytes are not those "
                 "of %u triangles",
                 path, length, count);
  }
  fclose(file);
  /* "solid" at the start and no facet: most likely a binary file that was cut off. */
  if (st == BW_OK && s->n == 0)
    st = BW_FAIL(BW_EINPUT,
                 "%s: holds no triangle as text, and as a binary file its %ld bytes are not those "
                 "of %u triangles",
                 path, length, count);
  /* Both forms can hold NaN, with which no point would be inside or outside. */
  for (size_t q = 0; st == BW_OK && q < 9 * s->n; q++)
    if (!isfinite(s->corner[q]))
      st = BW_FAIL(BW_EINPUT, "%s: triangle %zu has a corner that is not finite", path, q / 9);
  return st;
}

/* x where the line (y, z) along x meets the triangle; false when it passes by. */
static bool crosses(const float t[9], double scale, double y, double z, double *x)
{
  /* Areas of the three triangles that the point makes with the sides, seen along x. */
  double p[3][3], area[3], sum = 0;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      p[c][k] = scale * (double)t[3 * c + k];
  for (int c = 0; c < 3; c++) {
    const double *a = p[(c + 1) % 3], *b = p[(c + 2) % 3];
    area[c] = (a[1] - y) * (b[2] - z) - (a[2] - z) * (b[1] - y);
    sum += area[c];
  }
  /* All of one sign: the point is within, whichever way the corners turn. */
  const bool inside =
      (area[0] > 0 && area[1] > 0 && area[2] > 0) || (area[0] < 0 && area[1] < 0 && area[2] < 0);
  if (inside) *x = (area[0] * p[0][0] + area[1] * p[1][0] + area[2] * p[2][0]) / sum;
  return inside;
}

/* A crossing flips all cells of its line whose centre is behind it: even-odd without sorting. Lines
 * pass beside the cells' centres by a part of 1e-6, so that corners and edges on a lattice are not
 * met; odd[] keeps the parity of every line. */
static void flip(const bw_shape_mask *m, const float t[9], double scale, uint8_t odd[])
{
  /* Lines that may meet the triangle: those in its box, and one more on each side. */
  int64_t lo[2], hi[2];
  for (int d = 1; d < 3; d++) {
    double least = INFINITY, most = -INFINITY;
    for (int c = 0; c < 3; c++) {
      least = fmin(least, scale * (double)t[3 * c + d]);
      most = fmax(most, scale * (double)t[3 * c + d]);
    }
    lo[d - 1] = (int64_t)fmax(0, floor((least - m->lower[d]) / m->spacing[d]) - 1);
    hi[d - 1] = (int64_t)fmin((double)m->size[d], ceil((most - m->lower[d]) / m->spacing[d]) + 1);
  }
  for (int64_t k = lo[1]; k < hi[1]; k++)
    for (int64_t j = lo[0]; j < hi[0]; j++) {
      double x;
      const double y = m->lower[1] + ((double)j + 0.5 + 1.3e-6) * m->spacing[1];
      const double z = m->lower[2] + ((double)k + 0.5 + 0.7e-6) * m->spacing[2];
      if (!crosses(t, scale, y, z, &x)) continue;
      uint8_t *line = m->solid + m->size[0] * (j + m->size[1] * k);
      /* Cells whose centre is beyond the crossing. */
      const double from = ceil((x - m->lower[0]) / m->spacing[0] - 0.5);
      for (int64_t i = (int64_t)fmax(0, from); i < m->size[0]; i++)
        line[i] ^= 1;
      odd[j + m->size[1] * k] ^= 1;
    }
}

static bw_status fill(const char *path, const surface *s, double scale, bw_shape_mask *m)
{
  uint8_t *odd = NULL;
  bw_status st = BW_ALLOCATE(&odd, (size_t)(m->size[1] * m->size[2]));
  for (size_t q = 0; st == BW_OK && q < s->n; q++)
    flip(m, s->corner + 9 * q, scale, odd);
  /* A line that enters as often as it leaves has even parity; any other one found a hole. */
  for (int64_t q = 0; st == BW_OK && q < m->size[1] * m->size[2]; q++)
    if (odd[q])
      st = BW_FAIL(BW_EINPUT,
                   "%s: the surface is not closed: the line along x at y = %g, z = %g crosses it "
                   "an odd number of times",
                   path, m->lower[1] + ((double)(q % m->size[1]) + 0.5) * m->spacing[1],
                   m->lower[2] + ((double)(q / m->size[1]) + 0.5) * m->spacing[2]);
  bw_release(&odd);
  return st;
}

bw_status bw_shape_mask_read_stl(const char *path, double scale, double spacing,
                                 bw_shape_mask **out)
{
  surface s = {0};
  *out = NULL;
  BW_REQUIRE(scale > 0 && isfinite(scale) && spacing > 0 && isfinite(spacing), BW_EINPUT,
             "%s: scale = %g and spacing = %g must be positive", path, scale, spacing);
  bw_status st = read_surface(path, &s);
  /* The box of cells that holds all corners, and not so many that `scale` must be wrong. */
  int64_t size[3] = {0};
  double lower[3] = {0};
  const double cell[3] = {spacing, spacing, spacing};
  for (size_t d = 0; d < 3 && st == BW_OK; d++) {
    double least = INFINITY, most = -INFINITY;
    for (size_t q = 0; q < 3 * s.n; q++) {
      least = fmin(least, scale * (double)s.corner[3 * q + d]);
      most = fmax(most, scale * (double)s.corner[3 * q + d]);
    }
    lower[d] = spacing * floor(least / spacing); /* on the lattice of origin 0 */
    const double cells = ceil((most - lower[d]) / spacing - 1e-9);
    if (cells > 1e6)
      st = BW_FAIL(BW_EINPUT, "%s: %g cells of %g in direction %zu; is scale = %g right?", path,
                   cells, spacing, d, scale);
    size[d] = (int64_t)fmax(1, cells);
  }
  BW_THEN(st, bw_shape__mask_create(path, size, lower, cell, out));
  BW_THEN(st, bw_shape__mask_room(path, 0, size[2], *out));
  BW_THEN(st, fill(path, &s, scale, *out));
  bw_release(&s.corner);
  if (st != BW_OK) bw_shape_mask_destroy(out);
  return st;
}
