/* Points of a fluid of particles and of its walls, for ParaView. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_vtk.h"

enum { MOST = 4 };
typedef void reader(const bw_ulph *u, bw_ulph_field field, double out[]);

/* What is read of each point: of walls the first two. */
static bw_status write(bw_scene *s, const char *path, size_t n, reader *read, int count)
{
  static const bw_ulph_field field[MOST] = {BW_ULPH_VELOCITY, BW_ULPH_PRESSURE, BW_ULPH_DENSITY,
                                            BW_ULPH_SURFACE};
  static const char *const word[MOST] = {"velocity", "pressure", "density", "surface"};
  const bw_ulph *fluid = s->water->fluid;
  double *x = NULL, *data[MOST] = {NULL};
  bw_vtk_array array[MOST];
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  for (int q = 0; q < count; q++) {
    BW_THEN(st, BW_ALLOCATE(&data[q], (q == 0 ? 3 : 1) * n));
    if (st == BW_OK) read(fluid, field[q], data[q]);
    array[q] = (bw_vtk_array){word[q], BW_VTK_FLOAT64, q == 0 ? 3 : 1, data[q]};
  }
  if (st == BW_OK) read(fluid, BW_ULPH_POSITION, x);
  st = bw_comm_agree(s->comm, st);
  BW_THEN(st, bw_vtk_write_points(s->comm, path, s->time, n, x, count, array));
  bw_release(&x);
  for (int q = 0; q < count; q++)
    bw_release(&data[q]);
  return st;
}

bw_status bw_scene__water_picture(bw_scene *s, int solid, const char *path)
{
  (void)solid;
  return write(s, path, bw_ulph_count(s->water->fluid), bw_ulph_read, MOST);
}

bw_status bw_scene__walls_picture(bw_scene *s, int solid, const char *path)
{
  (void)solid;
  return write(s, path, bw_ulph_wall_count(s->water->fluid), bw_ulph_read_wall, 2);
}
