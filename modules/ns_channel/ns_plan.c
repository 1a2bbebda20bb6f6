/* ns_plan.c -- what a fluid costs and which step it bears, from small ones with the same cells and
 * sides. */
#include "bw_memory.h"
#include "bw_ns_channel.h"

#include <math.h>
#include <string.h>

enum { EDGE_3D = 16, EDGE_2D = 48 };

/* First of `rows` rows of cells in y of which one is the thinnest of all. */
static int thin_rows(const bw_grid_view *g, int rows)
{
  int thinnest = 1;
  for (int j = 2; j <= g->n[1]; j++)
    if (g->y_face[j] - g->y_face[j - 1] < g->y_face[thinnest] - g->y_face[thinnest - 1])
      thinnest = j;
  const int first = thinnest - rows / 2, last = g->n[1] - rows;
  return first < 0 ? 0 : first > last ? last : first;
}

/* A fluid of `edge` cells along each side at most, of the size of the planned one's. */
static bw_status make_small(const bw_comm *self, const bw_grid_view *g,
                            const bw_ns_channel_config *config, int edge, bw_grid **grid,
                            bw_ns_channel **fluid)
{
  bw_grid_config c = bw_grid_config_default();
  bw_ns_channel_config flow = *config;
  double *face = NULL;
  for (int d = 0; d < 3; d++) {
    c.n[d] = g->n[d] < edge ? g->n[d] : edge;
    c.length[d] = c.n[d] * g->spacing[d];
    c.periodic[d] = g->periodic[d];
    /* A laminar inflow is as fast as its mean somewhere, whatever the section. */
    for (int s = 0; s < 2; s++)
      if (flow.side[d][s].profile == BW_PROFILE_POISEUILLE) {
        flow.side[d][s].profile = BW_PROFILE_UNIFORM;
        flow.side[d][s].velocity[d] = flow.side[d][s].bulk_velocity;
      }
  }
  c.halo = g->halo[0];
  BW_TRY(BW_ALLOCATE(&face, (size_t)c.n[1] + 1));
  if (!g->uniform_y) {
    const int first = thin_rows(g, c.n[1]);
    for (int j = 0; j <= c.n[1]; j++)
      face[j] = g->y_face[first + j] - g->y_face[first];
    c.length[1] = face[c.n[1]];
    c.y_stretch = BW_STRETCH_TABLE, c.y_table = face;
  }
  bw_status st = bw_grid_create(self, &c, grid);
  bw_release(&face);
  BW_THEN(st, bw_ns_channel_create(*grid, &flow, fluid));
  return st;
}

/* One small fluid: its memory, the values of a field of it, its step. */
static bw_status try_small(const bw_comm *self, const bw_grid_view *g,
                           const bw_ns_channel_config *config, int edge, double result[3])
{
  bw_grid *grid = NULL;
  bw_ns_channel *fluid = NULL;
  const double before = (double)bw_memory_in_use();
  const bw_status st = make_small(self, g, config, edge, &grid, &fluid);
  if (st == BW_OK) {
    result[0] = (double)bw_memory_in_use() - before;
    result[1] = (double)bw_grid_look(grid)->size;
    result[2] = bw_ns_channel_dt_max(fluid);
  }
  bw_ns_channel_destroy(&fluid);
  bw_grid_destroy(&grid);
  return st;
}

bw_status bw_ns_channel_plan(const bw_grid *grid, const bw_ns_channel_config *config,
                             bw_ns_plan *plan)
{
  const bw_grid_view *g = bw_grid_look(grid);
  const int edge = g->n[2] == 1 ? EDGE_2D : EDGE_3D;
  double small[3] = {0.0, 0.0, 0.0}, large[3] = {0.0, 1.0, 0.0};
  bw_grid_config sizes = bw_grid_config_default();
  bw_comm *self = NULL;
  *plan = (bw_ns_plan){.bytes = NAN, .dt_max = NAN};
  for (int d = 0; d < 3; d++)
    sizes.n[d] = g->n[d], sizes.length[d] = g->length[d], sizes.periodic[d] = g->periodic[d];
  bw_status st = bw_ns_channel_config_check(&sizes, config);
  BW_THEN(st, bw_comm_self(&self));
  /* The first one pays for what libraries set up once; it is not counted. */
  BW_THEN(st, try_small(self, g, config, edge, small));
  BW_THEN(st, try_small(self, g, config, edge, small));
  BW_THEN(st, try_small(self, g, config, edge + edge / 2, large));
  bw_comm_destroy(&self);
  BW_TRY(bw_comm_agree(bw_grid_comm(grid), st));
  /* What the two differ in grows with the cells; where they hardly differ, the fluid is small. */
  const double values = (double)g->size, more = large[1] - small[1];
  const double each = more > 0.25 * small[1] ? (large[0] - small[0]) / more : large[0] / large[1];
  plan->dt_max = large[2];
  plan->bytes = each * values;
  bw_comm_max(bw_grid_comm(grid), 1, &plan->bytes);
  return BW_OK;
}
