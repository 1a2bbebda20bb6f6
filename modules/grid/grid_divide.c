/* The choice of blocks in y and z. */
#include "grid_internal.h"

/* Can n cells be cut into r blocks of at least `halo` cells? */
static bool fits(int n, int r, int halo)
{
  return r >= 1 && (r == 1 || n / r >= halo);
}

static bool both_fit(const bw_grid_config *c, int r1, int r2)
{
  return fits(c->n[1], r1, c->halo) && (c->n[2] == 1 ? r2 == 1 : fits(c->n[2], r2, c->halo));
}

/* Halo cells of the largest block, in units of 2 n[0] halo. */
static long halo_area(const bw_grid_config *c, int r1, int r2)
{
  const long m1 = (c->n[1] + r1 - 1) / r1, m2 = (c->n[2] + r2 - 1) / r2;
  return (r1 > 1 ? m2 : 0) + (r2 > 1 ? m1 : 0);
}

/* Least halo; of equals the one with the fewest blocks in y (tridiagonal systems stay whole). */
static bool best(const bw_grid_config *c, int size, int ranks[3])
{
  bool found = false;
  long least = 0;
  for (int r1 = 1; r1 <= size; r1++) {
    /* Every pair of factors of `size` is tried, fewest blocks in y first. */
    if (size % r1 != 0 || !both_fit(c, r1, size / r1)) continue;
    const long area = halo_area(c, r1, size / r1);
    /* Of equals the earlier one stays: the one with fewer blocks in y. */
    if (found && area >= least) continue;
    found = true;
    least = area;
    ranks[1] = r1;
    ranks[2] = size / r1;
  }
  return found;
}

bw_status bw_grid__divide(const bw_grid_config *c, int size, int ranks[3])
{
  BW_REQUIRE(c->n[1] >= c->halo && (c->n[2] == 1 || c->n[2] >= c->halo), BW_EINPUT,
             "grid: %d x %d cells in y and z are thinner than halo = %d", c->n[1], c->n[2],
             c->halo);
  ranks[0] = 1;
  /* No wish of the caller: the division that sends least. */
  if (c->ranks[0] == 0 && c->ranks[1] == 0) {
    if (best(c, size, ranks)) return BW_OK;
    /* Too many ranks for these cells: the message says how many would do. */
    int most = size;
    while (!best(c, most, ranks)) /* ends: 1 rank fits */
      most--;
    return BW_FAIL(BW_EINPUT,
                   "grid: %d ranks do not fit %d x %d cells in y and z with blocks of at least "
                   "halo = %d; %d ranks would",
                   size, c->n[1], c->n[2], c->halo, most);
  }
  /* The caller has named the blocks: they must use all ranks and be as thick as a halo. */
  BW_REQUIRE(c->ranks[0] >= 1 && c->ranks[1] >= 1 && (long)c->ranks[0] * (long)c->ranks[1] == size,
             BW_EINPUT,
             "grid: ranks = %d x %d, but the communicator has %d; use 0, 0 to let it "
             "choose",
             c->ranks[0], c->ranks[1], size);
  ranks[1] = c->ranks[0];
  ranks[2] = c->ranks[1];
  BW_REQUIRE(both_fit(c, ranks[1], ranks[2]), BW_EINPUT,
             "grid: ranks = %d x %d cut %d x %d cells in y and z into blocks thinner than "
             "halo = %d; at most %d x %d would fit",
             ranks[1], ranks[2], c->n[1], c->n[2], c->halo, c->n[1] / c->halo,
             c->n[2] == 1 ? 1 : c->n[2] / c->halo);
  return BW_OK;
}
