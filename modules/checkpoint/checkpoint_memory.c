/* What writing takes, for estimates; beside the calls whose arrays it counts. */
#include "checkpoint_internal.h"

double bw_checkpoint_file_bytes(void)
{
  /* Caches and buffers of HDF5 and of MPI's files, whatever is written: measured. */
  return 1.2 * 1048576.0;
}

double bw_checkpoint_field_bytes(const bw_grid *grid)
{
  const bw_grid_view *g = bw_grid_look(grid);
  /* The interior and a layer, packed. */
  return (double)sizeof(bw_real) * (g->m[0] + 1.0) * (g->m[1] + 1.0) * (g->m[2] + 1.0);
}

double bw_checkpoint_table_bytes(double n, double row)
{
  /* Rows packed by their way, as they arrive, and as they lie in the file; of every row its id,
   * its place in the order, and a mark. */
  return n * (3.0 * row + sizeof(int64_t) + sizeof(size_t) + sizeof(uint8_t));
}
