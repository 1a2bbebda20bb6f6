#include "bw_grid.h"
#include "bw_memory.h"
#include "grid_internal.h"

#include <math.h>

static const char axis[] = "xyz";

bw_grid_config bw_grid_config_default(void)
{
  return (bw_grid_config){.length = {NAN, NAN, NAN},
                          .y_stretch = BW_STRETCH_NONE,
                          .y_stretch_strength = 1.5,
                          .halo = 1};
}

/* Cells along d [L]; in y the tallest (of tanh: in the middle), whose row of the pressure's
 * equation says most of what thin cells beside a wall lose. */
static double longest_cell(const bw_grid_config *c, int d)
{
  const double uniform = c->length[d] / c->n[d], s = c->y_stretch_strength;
  if (d != 1 || c->y_stretch == BW_STRETCH_NONE) return uniform;
  if (c->y_stretch == BW_STRETCH_TANH) return uniform * s / tanh(s);
  double tallest = 0.0;
  for (int j = 1; j <= c->n[1]; j++)
    tallest = fmax(tallest, c->y_table[j] - c->y_table[j - 1]);
  return tallest;
}

/* The pressure's equation adds the inverse squares of cells: where they are r times longer in one
 * direction than in another, rounding leaves r^2 epsilon of the velocity's gradient in the
 * divergence (measured: 1e-9, 1e-7, 1e-5 at r = 1e4, 1e5, 1e6 in double precision; at 1e7 nothing
 * is left). */
static bw_status check_aspect(const bw_grid_config *c)
{
  static const double left = 1e-3;
  const double most = sqrt(left / (double)BW_REAL_EPSILON);
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) {
      if (c->n[d] == 1 || c->n[e] == 1) continue;
      const double r = longest_cell(c, d) / longest_cell(c, e);
      BW_REQUIRE(
          r <= most, BW_EINPUT,
          "grid: length[%d] = %g and n[%d] = %d make cells %.3g times as long in %c as in %c "
          "(length[%d] = %g, n[%d] = %d), more than %.3g: rounding would undo the pressure; "
          "take more cells in %c or a shorter box",
          d, c->length[d], d, c->n[d], r, axis[d], axis[e], e, c->length[e], e, c->n[e], most,
          axis[d]);
    }
  return BW_OK;
}

static bw_status check(const bw_grid_config *c)
{
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(c->n[d] >= (d < 2 ? 2 : 1), BW_EINPUT,
               "grid: n[%d] = %d cells in %c; at least %d are needed", d, c->n[d], axis[d],
               d < 2 ? 2 : 1);
    BW_REQUIRE(isfinite(c->length[d]) && c->length[d] > 0, BW_EINPUT,
               "grid: length[%d] = %g in %c is missing or not positive", d, c->length[d], axis[d]);
  }
  /* Numbers of cells are counted in 64 bits, those of one direction, with halos, in 32; the faces
   * in y are held by every rank. */
  static const double most_along = 16777216.0, most = 281474976710656.0; /* 2^24, 2^48 */
  const double all = (double)c->n[0] * c->n[1] * c->n[2];
  BW_REQUIRE(c->n[0] <= most_along && c->n[1] <= most_along && c->n[2] <= most_along && all <= most,
             BW_EINPUT,
             "grid: %d x %d x %d cells are %.3g; at most %.0f in a direction, %.4g in all", c->n[0],
             c->n[1], c->n[2], all, most_along, most);
  BW_REQUIRE(c->halo == 1 || c->halo == 2, BW_EINPUT, "grid: halo = %d; 1 or 2 layers are possible",
             c->halo);
  /* x is never divided: where it is periodic its halo is copied from cells of the same row, which
   * must be there. */
  BW_REQUIRE(c->n[0] >= c->halo, BW_EINPUT, "grid: n[0] = %d cells in x are fewer than halo = %d",
             c->n[0], c->halo);
  BW_TRY(bw_grid__y_check(c));
  return check_aspect(c);
}

/* In every row i = 1 lies on 16 bytes, as vectorised transforms want it. (Whole cache lines made no
 * stencil faster and cost 4 % of the memory.) */
static void set_storage(bw_grid_view *v)
{
  const ptrdiff_t unit = 16 / (ptrdiff_t)sizeof(bw_real), line = 4 * unit, h = v->halo[0];
  ptrdiff_t row = (v->n[0] + 2 * h + unit - 1) / unit * unit;
  if (row * (ptrdiff_t)sizeof(bw_real) % 4096 == 0) row += line; /* rows would share cache sets */
  const ptrdiff_t rows = v->m[1] + 2 * v->halo[1], planes = v->m[2] + 2 * v->halo[2];
  v->stride[0] = 1;
  v->stride[1] = row;
  /* 2D: the planes k - 1, k and k + 1 are the same memory, so that differences in z vanish by
   * themselves. */
  v->stride[2] = v->n[2] == 1 ? 0 : row * rows;
  /* The entry (1, 1-halo, 1-halo) stands one cache line behind the beginning; the lower halo of its
   * row fits in that line. */
  v->origin = line - 1 + row * (v->halo[1] - 1) + v->stride[2] * (v->halo[2] - 1);
  v->size = (size_t)(line + row * rows * planes);
}

static void set_view(bw_grid *g, const bw_grid_config *c)
{
  bw_grid_view *v = &g->view;
  const int rank = bw_comm_rank(g->comm);
  /* Ranks count through the blocks of y first: rank = coord[1] + ranks[1] coord[2], as
   * bw_grid_owner returns it. */
  v->coord[0] = 0;
  v->coord[1] = rank % v->ranks[1];
  v->coord[2] = rank / v->ranks[1];
  for (int d = 0; d < 3; d++) {
    v->n[d] = c->n[d];
    v->lo[d] = bw_grid__block_start(c->n[d], v->ranks[d], v->coord[d]);
    v->m[d] = bw_grid__block_start(c->n[d], v->ranks[d], v->coord[d] + 1) - v->lo[d];
    v->halo[d] = d == 2 && c->n[2] == 1 ? 0 : c->halo;
    v->periodic[d] = c->periodic[d];
    v->first[d] = v->coord[d] == 0;
    v->last[d] = v->coord[d] == v->ranks[d] - 1;
    v->length[d] = c->length[d];
    v->spacing[d] = c->length[d] / c->n[d];
  }
  v->uniform_y = c->y_stretch == BW_STRETCH_NONE;
  set_storage(v);
}

/* Sizes, blocks and faces. *out has to be destroyed also after a failure. Local. */
static bw_status begin(const bw_comm *comm, const bw_grid_config *config, bw_grid **out)
{
  BW_TRY(BW_ALLOCATE(out, 1));
  bw_grid *g = *out;
  g->mpi = g->line[1] = g->line[2] = MPI_COMM_NULL;
  g->comm = comm;
  BW_TRY(check(config));
  BW_TRY(bw_grid__divide(config, bw_comm_size(comm), g->view.ranks));
  set_view(g, config);
  return bw_grid__y_create(g, config);
}

bw_status bw_grid_plan(const bw_comm *comm, const bw_grid_config *config, bw_grid **out)
{
  *out = NULL;
  const bw_status st = bw_comm_agree(comm, begin(comm, config, out));
  if (st != BW_OK) bw_grid_destroy(out);
  return st;
}

bw_status bw_grid_create(const bw_comm *comm, const bw_grid_config *config, bw_grid **out)
{
  bw_grid *g = NULL;
  *out = NULL;
  /* All that can fail on one rank alone comes first; nothing is sent before the ranks have
   * agreed. */
  bw_status st = begin(comm, config, &g);
  BW_THEN(st, bw_grid__halo_create(g));
  BW_THEN(st, bw_grid__line_create(g));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    /* The set-up has succeeded everywhere: from here on only collective calls. */
    MPI_Comm_dup(bw_comm_mpi(comm), &g->mpi);
    bw_grid__line_connect(g);
  } else
    bw_grid_destroy(&g);
  *out = g;
  return st;
}

void bw_grid_destroy(bw_grid **grid)
{
  bw_grid *g = *grid;
  if (g == NULL) return;
  if (g->mpi != MPI_COMM_NULL) MPI_Comm_free(&g->mpi);
  bw_grid__halo_destroy(g);
  bw_grid__line_destroy(g);
  bw_release(&g->y_face);
  bw_release(&g->y_centre_store);
  bw_release(grid);
}

const bw_grid_view *bw_grid_look(const bw_grid *grid)
{
  return &grid->view;
}

const bw_comm *bw_grid_comm(const bw_grid *grid)
{
  return grid->comm;
}

void bw_grid_traffic(const bw_grid *grid, bw_grid_sent *halo, bw_grid_sent *swap)
{
  *halo = grid->halo;
  *swap = grid->swap;
}

bw_status bw_field_create(const bw_grid *grid, bw_real **out)
{
  return BW_ALLOCATE(out, grid->view.size);
}

/* Cell of y with face[cell-1] <= y < face[cell], by bisection: exact for any stretching. */
static int cell_in_y(const bw_grid_view *v, double y)
{
  int below = 0, above = v->n[1];
  if (v->uniform_y) { /* up to one by rounding */
    const int near = (int)(y / v->spacing[1]);
    below = near > 1 ? near - 1 : 0;
    above = near + 2 < above ? near + 2 : above;
  }
  /* Held throughout: face[below] <= y < face[above] (y = L apart, which the caller puts into the
   * last cell). */
  while (above - below > 1) {
    const int middle = (below + above) / 2;
    if (v->y_face[middle] <= y)
      below = middle;
    else
      above = middle;
  }
  return below + 1;
}

/* Block of r blocks over n cells that holds the cell (1..n). */
static int block_of(int n, int r, int cell)
{
  if (r == 1) return 0;
  int c = (int)((long)(cell - 1) * r / n); /* exact up to one where the blocks are uneven */
  /* The guess may be one block off to either side. */
  while (c > 0 && bw_grid__block_start(n, r, c) >= cell)
    c--;
  while (c < r - 1 && bw_grid__block_start(n, r, c + 1) < cell)
    c++;
  return c;
}

int bw_grid_block_start(const bw_grid_view *v, int d, int c)
{
  return bw_grid__block_start(v->n[d], v->ranks[d], c);
}

bool bw_grid__cell(const bw_grid_view *v, const double x[3], int cell[3])
{
  for (int d = 0; d < 3; d++) {
    double at = x[d];
    /* Beyond a periodic side lies the image of a point inside. */
    if (v->periodic[d] && !(at >= 0.0 && at < v->length[d]))
      at -= v->length[d] * floor(at / v->length[d]);
    if (!(at >= 0.0 && at <= v->length[d])) return false; /* NaN too */
    /* A point on a face belongs to the cell above that face. */
    cell[d] = d == 1 ? cell_in_y(v, at) : 1 + (int)(at / v->spacing[d]);
    if (cell[d] > v->n[d]) cell[d] = v->n[d]; /* the upper boundary belongs to the last cell */
  }
  return true;
}

int bw_grid_owner(const bw_grid *grid, const double x[3])
{
  const bw_grid_view *v = &grid->view;
  int cell[3], block[3];
  if (!bw_grid__cell(v, x, cell)) return -1;
  for (int d = 0; d < 3; d++) {
    /* Most points that are asked for lie on this rank: they need no search for their block. */
    const bool here = cell[d] > v->lo[d] && cell[d] <= v->lo[d] + v->m[d];
    block[d] = here ? v->coord[d] : block_of(v->n[d], v->ranks[d], cell[d]);
  }
  return block[1] + v->ranks[1] * block[2];
}
