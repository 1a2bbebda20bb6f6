/* Points with their values: PolyData vertices. */
#include "bw_memory.h"
#include "vtk_internal.h"

#include <inttypes.h>

static bw_status check(const char *path, int count, const bw_vtk_array array[], size_t n)
{
  for (int q = 0; q < count; q++) {
    const bw_vtk_array *a = &array[q];
    BW_REQUIRE(a->name != NULL && (a->data != NULL || n == 0), BW_EINPUT,
               "%s: array %d of %d has no %s", path, q + 1, count,
               a->name == NULL ? "name" : "data");
    BW_REQUIRE(bw_vtk__kind_of(a->type) != NULL, BW_EINPUT,
               "%s: array '%s' has type %d, not one "
               "of bw_vtk_type",
               path, a->name, (int)a->type);
    BW_REQUIRE(a->components == 1 || a->components == 3, BW_EINPUT,
               "%s: array '%s' has %d components, possible are 1 and 3", path, a->name,
               a->components);
  }
  return BW_OK;
}

static void describe(bw_vtk__writer *writer, bw_vtk__text *text, double time, uint64_t total,
                     int count, const bw_vtk_array array[])
{
  bw_vtk__begin(text, "PolyData");
  bw_vtk__add(text, "  <PolyData>\n");
  bw_vtk__time(text, time);
  bw_vtk__add(text,
              "    <Piece NumberOfPoints=\"%" PRIu64 "\" NumberOfVerts=\"%" PRIu64
              "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
              "      <PointData>\n",
              total, total);
  /* Values first, then positions, then the vertices: the blocks follow in this order. */
  for (int q = 0; q < count; q++)
    bw_vtk__declare(writer, text, array[q].name, array[q].type, array[q].components,
                    total * (uint64_t)array[q].components);
  bw_vtk__add(text, "      </PointData>\n      <Points>\n");
  bw_vtk__declare(writer, text, "Points", BW_VTK_FLOAT32, 3, 3 * total);
  /* Each point is a cell of its own, a vertex: ParaView's filters by value keep or drop cells. */
  bw_vtk__add(text, "      </Points>\n      <Verts>\n");
  bw_vtk__declare(writer, text, "connectivity", BW_VTK_INT64, 1, total);
  bw_vtk__declare(writer, text, "offsets", BW_VTK_INT64, 1, total);
  bw_vtk__add(text, "      </Verts>\n    </Piece>\n");
  bw_vtk__end(text, "PolyData");
}

/* A block of `size` bytes per point, those of this rank's n points in `data`. */
static bw_status write_array(bw_vtk__writer *writer, uint64_t total, uint64_t before, size_t n,
                             size_t size, const void *data)
{
  int64_t start = 0;
  BW_TRY(bw_vtk__block(writer, total * size, &start));
  return bw_file_write_at_all(writer->file, start + (int64_t)(before * size), n * size, data);
}

static bw_status write_blocks(bw_vtk__writer *writer, uint64_t total, uint64_t before, size_t n,
                              const double position[], int count, const bw_vtk_array array[])
{
  float *x = NULL;
  int64_t *index = NULL;
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&index, n));
  /* Scratch memory is there on all ranks: what follows is collective. */
  st = bw_comm_agree(writer->comm, st);
  for (int q = 0; q < count; q++)
    BW_THEN(st, write_array(writer, total, before, n,
                            bw_vtk__kind_of(array[q].type)->bytes * (size_t)array[q].components,
                            array[q].data));
  /* Positions as Float32, which is what the head declares. */
  for (size_t i = 0; st == BW_OK && i < 3 * n; i++)
    x[i] = (float)position[i];
  BW_THEN(st, write_array(writer, total, before, n, 3 * sizeof *x, x));
  /* Connectivity: a vertex refers to the point of its own number, counted over all ranks. */
  for (size_t i = 0; st == BW_OK && i < n; i++)
    index[i] = (int64_t)(before + i);
  BW_THEN(st, write_array(writer, total, before, n, sizeof *index, index));
  for (size_t i = 0; st == BW_OK && i < n; i++)
    index[i]++; /* each vertex ends one after where it begins */
  BW_THEN(st, write_array(writer, total, before, n, sizeof *index, index));
  bw_release(&x);
  bw_release(&index);
  return st;
}

bw_status bw_vtk_write_points(const bw_comm *comm, const char *path, double time, size_t n,
                              const double position[], int count, const bw_vtk_array array[])
{
  bw_vtk__writer writer = {.comm = comm};
  bw_vtk__text text = {0};
  BW_TRY(bw_comm_agree(comm, check(path, count, array, n)));
  int64_t total = (int64_t)n;
  /* Points lie in the file in rank order: behind those of all lower ranks. */
  const int64_t before = bw_comm_prefix_sum(comm, total);
  bw_comm_sum_int(comm, 1, &total);
  describe(&writer, &text, time, (uint64_t)total, count, array);
  bw_status st = bw_vtk__open(&writer, path, &text);
  bw_release(&text.chars);
  BW_THEN(st, write_blocks(&writer, (uint64_t)total, (uint64_t)before, n, position, count, array));
  return bw_vtk__close(&writer, st);
}

double bw_vtk_points_bytes(double n)
{
  /* Positions and numbers of vertices; vectors of doubles once more in MPI's buffers. */
  return n * (3.0 * sizeof(float) + sizeof(int64_t) + 3.0 * sizeof(double)) + BW_VTK__FILE_BYTES;
}
