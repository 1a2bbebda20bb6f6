#include "bw_particles_cells.h"
#include "bw_memory.h"

/* Cells are numbered this far from the first point. */
static const double FARTHEST = 1e9;

static bw_status check(size_t n, double least, const double period[3])
{
  BW_REQUIRE(n <= INT32_MAX, BW_EINPUT,
             "particles: %zu points on one rank; below 2^31 can be numbered: take more ranks", n);
  BW_REQUIRE(isfinite(least) && least > 0, BW_EINPUT,
             "particles: cells with an edge of %g; it must be above 0", least);
  for (int k = 0; k < 3; k++)
    BW_REQUIRE(isfinite(period[k]) && period[k] >= 0, BW_EINPUT,
               "particles: the period %g in direction %d; it must be above 0, or 0 for none",
               period[k], k);
  return BW_OK;
}

static void lay_out(size_t n, const double y[], double least, const double period[3],
                    bw_particles_cells *g)
{
  g->n = n;
  g->least = least;
  for (int k = 0; k < 3; k++) {
    const double p = period[k], first = n > 0 ? y[k] : 0;
    /* A first point that is lost would put all others into the outermost cell. */
    g->lower[k] = fabs(first) <= FARTHEST * least ? first : 0;
    g->period[k] = p;
    g->count[k] = p > 0 ? (int32_t)fmin(FARTHEST, fmax(1, floor(p / least))) : 0;
    g->edge[k] = p > 0 ? p / g->count[k] : least;
  }
  /* A power of two, about one point to a bucket. */
  for (g->buckets = 64; g->buckets < n;)
    g->buckets *= 2;
}

bw_status bw_particles_cells_create(size_t n, const double y[], double least,
                                    const double period[3], bw_particles_cells *cells)
{
  bw_particles_cells *g = cells;
  memset(g, 0, sizeof *g);
  BW_TRY(check(n, least, period));
  lay_out(n, y, least, period, g);
  BW_TRY(BW_ALLOCATE(&g->head, g->buckets));
  BW_TRY(BW_ALLOCATE(&g->next, n));
  BW_TRY(BW_ALLOCATE(&g->cell, 3 * n));
  memset(g->head, 0xff, g->buckets * sizeof *g->head); /* all -1 */
  for (size_t q = 0; q < n; q++) {
    bw_particles_cells_of(g, y + 3 * q, g->cell + 3 * q);
    /* What is nowhere is near nothing: a run that diverged must not fill one cell with its
     * points. */
    g->next[q] = -1;
    if (isnan(y[3 * q]) || isnan(y[3 * q + 1]) || isnan(y[3 * q + 2])) continue;
    const size_t b = bw_particles_cells_bucket(g, g->cell + 3 * q);
    g->next[q] = g->head[b];
    g->head[b] = (int32_t)q;
  }
  return BW_OK;
}

void bw_particles_cells_destroy(bw_particles_cells *cells)
{
  bw_release(&cells->head);
  bw_release(&cells->next);
  bw_release(&cells->cell);
  memset(cells, 0, sizeof *cells);
}

void bw_particles_cells_of(const bw_particles_cells *g, const double y[3], int32_t cell[3])
{
  for (int k = 0; k < 3; k++) {
    /* fmin and fmax leave out what is not a number: it goes to the outermost cell. */
    const double x = floor((y[k] - g->lower[k]) / g->edge[k]);
    cell[k] = (int32_t)fmax(-FARTHEST, fmin(FARTHEST, x));
    const int32_t n = g->count[k];
    if (n > 0) cell[k] = (cell[k] % n + n) % n;
  }
}

int bw_particles_cells_around(const bw_particles_cells *g, const int32_t cell[3],
                              int32_t out[27][3])
{
  int first[3], last[3], step[3], n = 0;
  /* With one or two cells in a period, left and right neighbour are the same or the cell itself. */
  for (int k = 0; k < 3; k++) {
    first[k] = g->count[k] == 1 || g->count[k] == 2 ? 0 : -1;
    last[k] = g->count[k] == 1 ? 0 : 1;
  }
  for (step[2] = first[2]; step[2] <= last[2]; step[2]++)
    for (step[1] = first[1]; step[1] <= last[1]; step[1]++)
      for (step[0] = first[0]; step[0] <= last[0]; step[0]++, n++)
        for (int k = 0; k < 3; k++) {
          out[n][k] = cell[k] + step[k];
          if (g->count[k] > 0) out[n][k] = (out[n][k] + g->count[k]) % g->count[k];
        }
  return n;
}

bw_status bw_particles_cells_near(const bw_particles_cells *g, const double y[], const double x[3],
                                  double r, size_t room, int32_t near[], size_t *found)
{
  int32_t own[3], cell[27][3];
  *found = 0;
  BW_REQUIRE(r > 0 && r <= g->least, BW_EINPUT,
             "particles: neighbours nearer than %g in cells made for %g at most", r, g->least);
  bw_particles_cells_of(g, x, own);
  /* A ball of the cells' edge reaches into these cells and no further. */
  const int count = bw_particles_cells_around(g, own, cell);
  for (int c = 0; c < count; c++)
    for (int32_t q = g->head[bw_particles_cells_bucket(g, cell[c])]; q >= 0; q = g->next[q]) {
      double d[3];
      /* Buckets are shared by cells whose keys fall together. */
      if (!bw_particles_cells_holds(g, cell[c], q)) continue;
      bw_particles_difference(g->period, x, y + 3 * (size_t)q, d);
      if (!(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < r * r)) continue;
      if (*found < room) near[*found] = q;
      ++*found;
    }
  return BW_OK;
}
