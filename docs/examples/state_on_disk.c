/* Fields and points on disk: pictures for ParaView, a checkpoint, and the way back.
 * BUILD modules=vtk,checkpoint
 * TEST  ranks=3 */
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "bw_vtk.h"
#include <math.h>

enum { MARKS = 100 };

/* Write p and the points to pictures and a checkpoint. Row i of this rank is mark id[i]. */
static bw_status save(const bw_grid *grid, const bw_real *p, size_t n, const int64_t id[],
                      const double X[])
{
  const bw_comm *world = bw_grid_comm(grid);
  const bw_vtk_field field = {.name = "p", .data = {p}};
  const bw_vtk_array array = {"id", BW_VTK_INT64, 1, id};
  BW_TRY(bw_vtk_write_grid(grid, "example-p.vti", 0.0, 1, &field));
  BW_TRY(bw_vtk_write_points(world, "example-marks.vtp", 0.0, n, X, 1, &array));

  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_create(world, "example.h5", &ck));
  bw_status st = bw_checkpoint_put_field(ck, "p", grid, 0, false, p);
  BW_THEN(st, bw_checkpoint_put_table(ck, "X", MARKS, n, id, 3, BW_CK_DOUBLE, X));
  if (st == BW_OK) return bw_checkpoint_close(&ck); /* from here on the file is there */
  bw_checkpoint_abandon(&ck);
  return st;
}

/* Any ranks, any division, any ids: here each rank asks for the last mark. */
static bw_status load(const bw_grid *grid, bw_real *p, double X[3])
{
  const int64_t last = MARKS - 1;
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_open(bw_grid_comm(grid), "example.h5", &ck));
  bw_status st = bw_checkpoint_get_field(ck, "p", grid, 0, false, p);
  BW_THEN(st, bw_checkpoint_get_table(ck, "X", MARKS, 1, &last, 3, BW_CK_DOUBLE, X));
  if (st == BW_OK) return bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  return st;
}

static bw_status there_and_back(const bw_grid *grid, bw_real *p)
{
  const bw_grid_view *g = bw_grid_look(grid);
  const bw_comm *world = bw_grid_comm(grid);
  const ptrdiff_t here = bw_at(g, 2, 1, 1);
  int64_t id[MARKS];
  double X[3 * MARKS], last[3];
  size_t n = 0;
  for (int q = bw_comm_rank(world); q < MARKS; q += bw_comm_size(world), n++) {
    id[n] = q;
    for (int d = 0; d < 3; d++)
      X[3 * n + (size_t)d] = sin(q + d);
  }
  p[here] = (bw_real)(1 + bw_comm_rank(world));
  BW_TRY(save(grid, p, n, id, X));
  p[here] = 0;
  BW_TRY(load(grid, p, last));
  BW_REQUIRE(p[here] == (bw_real)(1 + bw_comm_rank(world)), BW_EIO, "p came back as %g",
             (double)p[here]);
  BW_REQUIRE(last[1] == sin(MARKS - 1 + 1), BW_EIO, "the last mark came back as %g", last[1]);
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_grid *grid = NULL;
  bw_real *p = NULL;
  bw_grid_config box = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    box.n[d] = 8, box.length[d] = 1.0;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, bw_grid_create(world, &box, &grid));
  BW_THEN(st, bw_field_create(grid, &p));
  if (st == BW_OK) st = bw_comm_agree(world, there_and_back(grid, p));
  bw_release(&p);
  bw_grid_destroy(&grid);
  return bw_finish(&world, st);
}
