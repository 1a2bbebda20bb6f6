// A C++ program makes a grid and asks what the rank holds of it.
#include <breakwater/bw_grid.h>
#include <cstdio>

int main(int argc, char *argv[])
{
  bw_comm *world = nullptr;
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  bw_grid_config box = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    box.n[d] = 8, box.length[d] = 1.0;
  bw_grid *grid = nullptr;
  const bw_status status = bw_grid_create(world, &box, &grid);
  if (status == BW_OK) std::printf("%zu values\n", bw_grid_look(grid)->size);
  bw_grid_destroy(&grid);
  return bw_finish(&world, status);
}
