/* A porous block over all ranks: its sites, its porosity, whether anything can flow through it, and
 * the points of a grain's true surface.
 * BUILD modules=shape
 * TEST ranks=1,2 */
#include "bw_comm.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_shape_surface.h"
#include "bw_shape_way.h"
#include <stdio.h>

enum { CELLS = 40 };

static bw_status porous(const bw_comm *world)
{
  int64_t n;
  int32_t *site;
  uint8_t *kind;
  bw_shape_way way;

  const bw_shape block[] = {
      {.kind = BW_SHAPE_BOX, .upper = {1, 1, 1}},
      {.kind = BW_SHAPE_PORES_SC, .remove = true, .radius = 0.15, .pitch = 0.25}};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(1.0 / CELLS, (double[3]){0}, false);
  BW_TRY(bw_shape_fill_shared(world, 2, block, &lattice, &n, &site, &kind, NULL));
  const bw_shape_way_box box = {.cells = {CELLS, CELLS, CELLS}, .periodic = {false, true, true}};
  const bw_status st = bw_shape_find_way(world, &box, n, site, &way);

  bw_release(&site);
  bw_release(&kind);
  BW_TRY(st);
  if (bw_comm_rank(world) == 0)
    printf("porosity %.3f, %s, %.1f %% of the pores connected\n",
           (double)way.open / (CELLS * CELLS * CELLS), way.through ? "a way through" : "closed",
           100.0 * (double)way.reached / (double)way.open);
  return BW_OK;
}

static bw_status grain(const bw_comm *world)
{
  int64_t n;
  double *point, *normal, *area, sum = 0.0;
  const bw_shape dented[] = {
      {.kind = BW_SHAPE_SPHERE, .radius = 1},
      {.kind = BW_SHAPE_BOX, .lower = {-1, -1, 0.5}, .upper = {1, 1, 1}, .remove = true}};
  BW_TRY(bw_shape_points(2, dented, false, 0.1, &n, &point, &normal, &area));
  for (int64_t q = 0; q < n; q++)
    sum += area[q];
  if (bw_comm_rank(world) == 0) printf("%d points, area %.4f\n", (int)n, sum);
  bw_release(&point);
  bw_release(&normal);
  bw_release(&area);
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, porous(world));
  BW_THEN(st, grain(world));
  return bw_finish(&world, st);
}
