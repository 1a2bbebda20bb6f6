/* Weights and nodes of markers and images, computed once per position. */
#include "ibm_mdf_internal.h"

#include <string.h>

enum { BATCH = 64, LINES = 3 * IBM_PLACES }; /* weights of a batch are made together */

/* One direction of a batch: places in cells, then lowest node and weights. */
typedef struct {
  double s[LINES][BATCH], w[BW_KERNEL_MAX_SUPPORT][LINES][BATCH];
  int first[LINES][BATCH];
} batch;

/* Nodes beyond a physical boundary among the IBM_WIDTH from `lowest` (global) with weight: bits. */
static uint32_t kept(const bw_grid_view *g, int place, int d, int lowest, const bw_real w[])
{
  const int n_inside = place == IBM_FACE ? g->n[d] - 1 : g->n[d];
  uint32_t bits = (1u << IBM_WIDTH) - 1;
  /* No node of the window can be beyond a side. */
  if (g->periodic[d] || (lowest >= 1 && lowest + IBM_WIDTH - 1 <= n_inside)) return bits;
  /* A face on the side is no place to force: its velocity is given. */
  for (int q = 0; q < IBM_WIDTH; q++)
    if (w[q] > 0 && (lowest + q < 1 || lowest + q > n_inside)) bits &= ~(1u << q);
  return bits;
}

/* Weights that begin `by` nodes after the window does; those outside it are dropped. */
static void move_window(int by, int width, bw_real w[IBM_WIDTH])
{
  bw_real moved[IBM_WIDTH] = {0};
  for (int q = 0; q < IBM_WIDTH; q++)
    if (q + by >= 0 && q + by < width) moved[q + by] = w[q];
  memcpy(w, moved, sizeof moved);
}

/* Row `line` of marker i of a batch. The window of nodes is moved where it would leave the halo: x
 * rows of narrow kernels, and images, of which only what lies in reach has weights here. Returns
 * the lowest node. */
static int fill_line(const bw_ibm_mdf *ib, const batch *b, int line, int i, bw_real w[IBM_WIDTH])
{
  const bw_grid_view *g = ib->g;
  const int d = line % 3, support = ib->kernel->support, width = d == 0 ? IBM_WIDTH : support;
  const int first = b->first[line][i];
  const int lowest = 1 - g->halo[d], highest = g->m[d] + g->halo[d] - width + 1;
  /* The window stays within the halo, which is all that this rank may read. */
  const int start = first < lowest ? lowest : first > highest ? highest : first;
  for (int q = 0; q < IBM_WIDTH; q++) /* beyond the support: zero */
    w[q] = (bw_real)b->w[q][line][i];
  if (start != first) move_window(first - start, width, w);
  return start;
}

static void fill(const bw_ibm_mdf *ib, const batch *b, int i, bw_ibm_mdf__weights *weights,
                 bw_ibm_mdf__nodes *nodes)
{
  const bw_grid_view *g = ib->g;
  int start[LINES];
  nodes->keep = 0;
  for (int line = 0; line < LINES; line++) {
    const int d = line % 3, place = line / 3;
    bw_real *w = weights->w[place][d];
    /* Two dimensions. */
    if (d == 2 && g->n[2] == 1) { /* one cell: no weight is read */
      memset(w, 0, IBM_WIDTH * sizeof *w);
      start[line] = 1;
      nodes->keep |= ((1u << IBM_WIDTH) - 1) << (IBM_WIDTH * line);
      continue;
    }
    start[line] = fill_line(ib, b, line, i, w);
    /* Which nodes may be written: decided here, once per position. */
    nodes->keep |= kept(g, place, d, start[line] + g->lo[d], w) << (IBM_WIDTH * line);
  }
  /* Lowest node of each component: the face window along its own direction, centres across. */
  for (int c = 0; c < 3; c++)
    nodes->at[c] =
        (int32_t)bw_at(g, start[3 * (c == 0)], start[3 * (c == 1) + 1], start[3 * (c == 2) + 2]);
}

/* Marker or image m: place in cells from this block's lower corner. */
static void place_of(const bw_ibm_mdf *ib, size_t m, double s[3])
{
  for (int d = 0; d < 3; d++)
    s[d] = m < ib->held ? ib->place[m].s[d] : ib->image[m - ib->held].s[d];
}

void bw_ibm_mdf__weigh(bw_ibm_mdf *ib)
{
  const size_t all = ib->held + ib->images;
  batch b = {.s = {{0.0}}}; /* weights beyond the support stay zero */
  /* In batches, as the kernel's roots are vectorised over many places. */
  for (size_t start = 0; start < all; start += BATCH) {
    const int n = all - start < BATCH ? (int)(all - start) : BATCH;
    for (int i = 0; i < n; i++) {
      double s[3];
      place_of(ib, start + (size_t)i, s);
      /* Faces stand at whole places, centres half a cell further on. */
      for (int line = 0; line < LINES; line++)
        b.s[line][i] = s[line % 3] + (line / 3 == IBM_CENTRE ? 0.5 : 0.0);
    }
    /* POROUS 3.76 to 3.78, one direction at a time. */
    bw_kernel_delta_weights(ib->kernel, (size_t)LINES * BATCH, b.s[0], b.first[0], b.w[0][0]);
    for (int i = 0; i < n; i++)
      fill(ib, &b, i, &ib->weights[start + (size_t)i], &ib->nodes[start + (size_t)i]);
  }
}
