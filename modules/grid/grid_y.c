/* Where the faces in y are: uniform, tanh, or as a table says. */
#include "bw_file.h"
#include "bw_memory.h"
#include "grid_internal.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Heights of neighbours: second order needs faces on a smooth curve of j. Chebyshev's have a factor
 * of 3 at the wall; more is a slip of the pen. */
static const double largest_ratio = 4.0;

static bw_status table_check(const char *name, int n, double length, const double y[])
{
  BW_REQUIRE(y != NULL, BW_EINPUT, "grid: y_stretch is a table, but y_table is NULL; give %d faces",
             n + 1);
  /* A comparison with NaN is false: numbers are looked at before any order is asked for. */
  for (int j = 0; j <= n; j++)
    BW_REQUIRE(isfinite(y[j]), BW_EINPUT, "%s: face %d is %g; give a finite number", name, j, y[j]);
  /* The table spans the box exactly; its unit is the one of the box. */
  BW_REQUIRE(y[0] == 0.0, BW_EINPUT, "%s: the first face is at %.17g; it must be at 0", name, y[0]);
  BW_REQUIRE(fabs(y[n] - length) <= 1e-12 * length, BW_EINPUT,
             "%s: the last face is at %.17g; it must be at the height of the box, %.17g", name,
             y[n], length);
  for (int j = 1; j <= n; j++)
    BW_REQUIRE(y[j] > y[j - 1], BW_EINPUT,
               "%s: face %d at %.17g is not above face %d at %.17g; faces increase", name, j, y[j],
               j - 1, y[j - 1]);
  /* The faces increase, so that every height below is positive. */
  for (int j = 2; j <= n; j++) {
    const double ratio = (y[j] - y[j - 1]) / (y[j - 1] - y[j - 2]);
    BW_REQUIRE(
        ratio <= largest_ratio && 1.0 / ratio <= largest_ratio, BW_EINPUT,
        "%s: cells %d and %d differ by the factor %.3g in height; neighbours may differ by %g",
        name, j - 1, j, fmax(ratio, 1.0 / ratio), largest_ratio);
  }
  return BW_OK;
}

bw_status bw_grid__y_check(const bw_grid_config *c)
{
  BW_REQUIRE(c->y_stretch >= BW_STRETCH_NONE && c->y_stretch <= BW_STRETCH_TABLE, BW_EINPUT,
             "grid: y_stretch = %d is no kind of stretching", (int)c->y_stretch);
  if (c->y_stretch == BW_STRETCH_NONE) return BW_OK;
  /* Ghost centres mirror about the boundary face, which is the periodic image only where cells are
   * equal. */
  BW_REQUIRE(!c->periodic[1], BW_EINPUT,
             "grid: y is periodic and stretched; choose one (the mirror image would not fit)");
  if (c->y_stretch == BW_STRETCH_TABLE)
    return table_check("grid: y_table", c->n[1], c->length[1], c->y_table);
  BW_REQUIRE(isfinite(c->y_stretch_strength) && c->y_stretch_strength > 0 &&
                 c->y_stretch_strength <= 10,
             BW_EINPUT, "grid: y_stretch_strength = %g; a number above 0 and up to 10 is needed",
             c->y_stretch_strength);
  return BW_OK;
}

static double face_of(const bw_grid_config *c, int j)
{
  const double part = (double)j / c->n[1], s = c->y_stretch_strength;
  switch (c->y_stretch) {
  case BW_STRETCH_TANH:
    return 0.5 * c->length[1] * (1.0 + tanh(s * (2.0 * part - 1.0)) / tanh(s));
  case BW_STRETCH_TABLE:
    return c->y_table[j];
  case BW_STRETCH_NONE:
    break;
  }
  return c->length[1] * j / c->n[1];
}

/* 0 and L exactly; ghosts mirror about the boundary faces (which is the periodic image too, as
 * that grid is uniform). */
bw_status bw_grid__y_create(bw_grid *g, const bw_grid_config *c)
{
  const int n = c->n[1];
  const double length = c->length[1];
  BW_TRY(BW_ALLOCATE(&g->y_face, (size_t)n + 1));
  BW_TRY(BW_ALLOCATE(&g->y_centre_store, (size_t)n + 4));
  double *face = g->y_face, *centre = g->y_centre_store + 1;
  for (int j = 0; j <= n; j++)
    face[j] = face_of(c, j);
  /* The formula may be off by rounding at the ends; the box is not. */
  face[0] = 0.0;
  face[n] = length;
  for (int j = 1; j <= n; j++)
    centre[j] = 0.5 * (face[j - 1] + face[j]);
  /* Two mirrored ghosts on either side, enough for the widest halo. */
  for (int q = 0; q < 2; q++) {
    centre[-q] = -centre[1 + q];
    centre[n + 1 + q] = 2.0 * length - centre[n - q];
  }
  g->view.y_face = face;
  g->view.y_centre = centre;
  /* Strong stretching may round two faces to the same number. */
  for (int j = 1; j <= n; j++)
    BW_REQUIRE(face[j] > face[j - 1], BW_EINPUT,
               "grid: y_stretch_strength = %g makes the cell %d in y empty; use a smaller one",
               c->y_stretch_strength, j);
  return BW_OK;
}

/* Numbers of a text, the rest of a line behind # left out; more than n + 1 are counted, not kept.
 */
static bw_status parse(const char *path, char *text, int n, double y[])
{
  int count = 0, line = 1;
  for (char *at = text; *at != 0;) {
    /* A remark lasts to the end of its line. */
    if (*at == '#') {
      at += strcspn(at, "\n");
    } else if (isspace((unsigned char)*at)) {
      line += *at++ == '\n';
    } else {
      char *end = at;
      const double value = strtod(at, &end);
      BW_REQUIRE(end != at && (*end == 0 || *end == '#' || isspace((unsigned char)*end)), BW_EINPUT,
                 "%s, line %d: \"%.*s\" is no number; give the faces in y, one a line", path, line,
                 (int)strcspn(at, " \t\r\n"), at);
      if (count <= n) y[count] = value;
      count++, at = end;
    }
  }
  /* All numbers have been read, so that the message can say how many there are. */
  BW_REQUIRE(count == n + 1, BW_EINPUT,
             "%s: %d faces, but %d cells in y have %d; give as many or change the cells", path,
             count, n, n + 1);
  return BW_OK;
}

bw_status bw_grid_read_table(const bw_comm *comm, const char *path, int n, double length,
                             double **out)
{
  char *text = NULL;
  *out = NULL;
  BW_TRY(bw_file_read_text(comm, path, NULL, &text));
  /* Every rank has the same text and finds the same fault; only memory may fail on one of them. */
  bw_status st = BW_ALLOCATE(out, (size_t)n + 1);
  BW_THEN(st, parse(path, text, n, *out));
  BW_THEN(st, table_check(path, n, length, *out));
  bw_release(&text);
  st = bw_comm_agree(comm, st);
  if (st != BW_OK) bw_release(out);
  return st;
}
