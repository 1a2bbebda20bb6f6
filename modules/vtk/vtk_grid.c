/* Cell data of a grid: .vti when uniform, .vtr when y is stretched. */
#include "bw_memory.h"
#include "vtk_internal.h"

#include <math.h>
#include <string.h>

/* Planes of z are packed and written together up to this many values per component. */
enum { BATCH_VALUES = 1 << 22 };

const char *bw_vtk_grid_extension(const bw_grid *grid)
{
  return bw_grid_look(grid)->uniform_y ? ".vti" : ".vtr";
}

static const char *file_type(const bw_grid_view *g)
{
  return g->uniform_y ? "ImageData" : "RectilinearGrid";
}

static int components(const bw_vtk_field *field)
{
  return field->data[1] == NULL ? 1 : 3;
}

static bw_status check(const bw_grid *grid, const char *path, int count, const bw_vtk_field field[])
{
  const char *extension = bw_vtk_grid_extension(grid);
  const size_t length = strlen(path), tail = strlen(extension);
  BW_REQUIRE(length > tail && strcmp(path + length - tail, extension) == 0, BW_EINPUT,
             "%s: a file of this grid has to end in %s", path, extension);
  /* A missing name or array is the caller's slip: found before any file is begun. */
  for (int q = 0; q < count; q++)
    BW_REQUIRE(field[q].name != NULL && field[q].data[0] != NULL, BW_EINPUT,
               "%s: field %d of %d has no %s", path, q + 1, count,
               field[q].name == NULL ? "name" : "data");
  return BW_OK;
}

static void declare_coordinates(bw_vtk__writer *writer, bw_vtk__text *text, const bw_grid_view *g)
{
  static const char *const axis[] = {"x", "y", "z"};
  bw_vtk__add(text, "      <Coordinates>\n");
  for (int d = 0; d < 3; d++)
    bw_vtk__declare(writer, text, axis[d], BW_VTK_FLOAT64, 1, (uint64_t)g->n[d] + 1);
  bw_vtk__add(text, "      </Coordinates>\n");
}

static void describe(bw_vtk__writer *writer, bw_vtk__text *text, const bw_grid_view *g, double time,
                     int count, const bw_vtk_field field[])
{
  const char *type = file_type(g);
  const uint64_t cells = (uint64_t)g->n[0] * (uint64_t)g->n[1] * (uint64_t)g->n[2];
  bw_vtk__begin(text, type);
  bw_vtk__add(text, "  <%s WholeExtent=\"0 %d 0 %d 0 %d\"", type, g->n[0], g->n[1], g->n[2]);
  /* ImageData has its geometry in the head; RectilinearGrid has arrays of coordinates. */
  if (g->uniform_y)
    bw_vtk__add(text, " Origin=\"0 0 0\" Spacing=\"%.17g %.17g %.17g\"", g->spacing[0],
                g->spacing[1], g->spacing[2]);
  bw_vtk__add(text, ">\n");
  bw_vtk__time(text, time);
  bw_vtk__add(text, "    <Piece Extent=\"0 %d 0 %d 0 %d\">\n", g->n[0], g->n[1], g->n[2]);
  if (!g->uniform_y) declare_coordinates(writer, text, g);
  /* The order in which arrays are declared is the order in which their blocks follow in the
   * file. */
  bw_vtk__add(text, "      <CellData>\n");
  for (int q = 0; q < count; q++) {
    const int nc = components(&field[q]);
    bw_vtk__declare(writer, text, field[q].name, BW_VTK_FLOAT32, nc, cells * (uint64_t)nc);
  }
  bw_vtk__add(text, "      </CellData>\n    </Piece>\n");
  bw_vtk__end(text, type);
}

/* The corners of the cells along direction d, (n[d]+1). */
static void coordinates(const bw_grid_view *g, int d, double x[])
{
  for (int i = 0; i <= g->n[d]; i++)
    x[i] = d == 1 ? g->y_face[i] : i * g->spacing[d];
}

static bw_status write_coordinates(bw_vtk__writer *writer, const bw_grid_view *g)
{
  const bool first = bw_comm_rank(writer->comm) == 0;
  for (int d = 0; d < 3; d++) {
    const size_t bytes = ((size_t)g->n[d] + 1) * sizeof(double);
    int64_t start = 0;
    double *x = NULL;
    /* Every rank knows all coordinates; the first one writes them, the others take part in the
     * call. */
    bw_status st = bw_comm_agree(writer->comm, BW_ALLOCATE(&x, (size_t)g->n[d] + 1));
    BW_THEN(st, bw_vtk__block(writer, bytes, &start));
    if (st == BW_OK) {
      coordinates(g, d, x);
      st = bw_file_write_at_all(writer->file, start, first ? bytes : 0, x);
    }
    bw_release(&x);
    BW_TRY(st);
  }
  return BW_OK;
}

/* out[stride c] = scale (a[c] + a[c - back]) / 2 over one row of m cells; back = 0: a itself. */
static void pack_row(int m, const bw_real *restrict a, ptrdiff_t back, double scale, int stride,
                     float *restrict out)
{
  for (int i = 0; i < m; i++)
    out[(ptrdiff_t)stride * i] = (float)(0.5 * scale * ((double)a[i] + (double)a[i - back]));
}

/* Planes k0 .. k0+planes-1 of one field, (planes, m[1], m[0], nc). */
static void pack(const bw_grid_view *g, const bw_vtk_field *field, int k0, int planes, float *out)
{
  const int nc = components(field);
  const double scale = field->scale == 0.0 ? 1.0 : field->scale;
  for (int k = k0; k < k0 + planes; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      for (int c = 0; c < nc; c++) {
        const bw_real *a = field->data[c];
        /* A component on faces becomes a value at the centre: (a[i-1] + a[i])/2, second order as
         * the flow is. */
        const ptrdiff_t back = field->staggered ? g->stride[c] : 0;
        if (a != NULL)
          pack_row(g->m[0], a + bw_at(g, 1, j, k), back, scale, nc, out + c);
        else
          /* VTK has no vectors of two components: the third is zero in 2D. */
          for (int i = 0; i < g->m[0]; i++)
            out[(ptrdiff_t)nc * i + c] = 0.0f;
      }
      out += (ptrdiff_t)nc * g->m[0];
    }
}

/* One field, in batches of planes: a rank's planes are contiguous in the file when it holds all
 * of y, else each plane is a piece of its own. All ranks make the same number of calls. */
static bw_status write_field(bw_vtk__writer *writer, const bw_grid_view *g,
                             const bw_vtk_field *field, int most_planes, float *buffer)
{
  const int nc = components(field);
  const int64_t row = (int64_t)g->n[0] * nc * (int64_t)sizeof(float), plane = row * g->n[1];
  const int64_t whole = (int64_t)g->n[0] * g->n[1];
  int batch = 1;
  /* Where a rank holds whole planes, many of them go out in one call. */
  if (g->ranks[1] == 1 && whole < BATCH_VALUES) batch = (int)(BATCH_VALUES / whole);
  int64_t start = 0;
  /* The whole field's length stands before it; each rank then writes at offsets of its own. */
  BW_TRY(bw_vtk__block(writer, (uint64_t)(plane * g->n[2]), &start));
  /* As many rounds as the rank with most planes has: the write is collective, and may be empty. */
  for (int k0 = 1; k0 <= most_planes; k0 += batch) {
    const int left = g->m[2] - k0 + 1;
    const int planes = left < 0 ? 0 : left < batch ? left : batch;
    const int64_t offset = start + plane * (g->lo[2] + k0 - 1) + row * g->lo[1];
    pack(g, field, k0, planes, buffer);
    const size_t bytes = (size_t)row * (size_t)g->m[1] * (size_t)planes;
    BW_TRY(bw_file_write_at_all(writer->file, planes > 0 ? offset : 0, bytes, buffer));
  }
  return BW_OK;
}

/* Values of the buffer for planes of this rank. */
static size_t buffer_values(const bw_grid_view *g)
{
  const size_t plane = (size_t)g->m[0] * (size_t)g->m[1];
  const size_t slab = plane * (size_t)g->m[2];
  return 3 * (slab < BATCH_VALUES ? slab : (plane < BATCH_VALUES ? BATCH_VALUES : plane));
}

double bw_vtk_grid_bytes(const bw_grid *grid)
{
  return (double)sizeof(float) * (double)buffer_values(bw_grid_look(grid)) + BW_VTK__FILE_BYTES;
}

static bw_status write_blocks(bw_vtk__writer *writer, const bw_grid_view *g, int count,
                              const bw_vtk_field field[])
{
  int64_t planes = g->m[2];
  float *buffer = NULL;
  /* The ranks divide z unevenly: the thickest block tells how many rounds there are. */
  bw_comm_max_int(writer->comm, 1, &planes);
  bw_status st = BW_OK;
  if (!g->uniform_y) st = write_coordinates(writer, g);
  BW_THEN(st, bw_comm_agree(writer->comm, BW_ALLOCATE(&buffer, buffer_values(g))));
  /* In the order of the declarations, for the offsets in the head say so. */
  for (int q = 0; q < count; q++)
    BW_THEN(st, write_field(writer, g, &field[q], (int)planes, buffer));
  bw_release(&buffer);
  return st;
}

bw_status bw_vtk_write_grid(const bw_grid *grid, const char *path, double time, int count,
                            const bw_vtk_field field[])
{
  const bw_grid_view *g = bw_grid_look(grid);
  bw_vtk__writer writer = {.comm = bw_grid_comm(grid)};
  bw_vtk__text text = {0};
  /* Nothing is written for arguments that make no file. */
  bw_status st = bw_comm_agree(writer.comm, check(grid, path, count, field));
  if (st == BW_OK) {
    describe(&writer, &text, g, time, count, field);
    st = bw_vtk__open(&writer, path, &text);
  }
  bw_release(&text.chars);
  BW_THEN(st, write_blocks(&writer, g, count, field));
  /* Complete, the file gets its name; after a failure on any rank it disappears. */
  return bw_vtk__close(&writer, st);
}
