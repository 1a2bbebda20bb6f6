/* flow.h -- set-ups and norms shared by the validations of ns_channel. */
#pragma once
#include "bw_ns_channel.h"
#include "bw_validation.h"
#include <math.h>

typedef struct {
  int n[3];
  double length[3];
  bool periodic[3];
  double stretch; /* of y; 0: uniform */
  int ranks[2];
} flow_box;

/* A member for the rows' `extra`. */
static const char *const flow_viscous_name[] = {
    [BW_VISCOUS_EXPLICIT] = "\"viscous\": \"explicit\"",
    [BW_VISCOUS_IMPLICIT_Y] = "\"viscous\": \"implicit_y\"",
    [BW_VISCOUS_IMPLICIT] = "\"viscous\": \"implicit\""};

/* config: periodic sides are set here, the others as given. */
static inline bw_status flow_create(const bw_comm *comm, const flow_box *box,
                                    bw_ns_channel_config *config, bw_grid **grid,
                                    bw_ns_channel **ns)
{
  bw_grid_config g = bw_grid_config_default();
  for (int d = 0; d < 3; d++) {
    g.n[d] = box->n[d], g.length[d] = box->length[d], g.periodic[d] = box->periodic[d];
    for (int s = 0; s < 2 && box->periodic[d]; s++)
      config->side[d][s].kind = BW_SIDE_PERIODIC;
  }
  g.ranks[0] = box->ranks[0], g.ranks[1] = box->ranks[1];
  if (box->stretch > 0) g.y_stretch = BW_STRETCH_TANH, g.y_stretch_strength = box->stretch;
  BW_TRY(bw_grid_create(comm, &g, grid));
  return bw_ns_channel_create(*grid, config, ns);
}

static inline void flow_destroy(bw_grid **grid, bw_ns_channel **ns)
{
  bw_ns_channel_destroy(ns);
  bw_grid_destroy(grid);
}

static inline void flow_point(const bw_grid_view *g, int c, int i, int j, int k, double x[3])
{
  const int y = j + g->lo[1];
  x[0] = (c == 0 ? i : i - 0.5) * g->spacing[0];
  x[1] = c == 1 ? g->y_face[y] : g->y_centre[y];
  x[2] = (k + g->lo[2] - (c == 2 ? 0.0 : 0.5)) * g->spacing[2];
}

/* Largest |u_c - exact| over all points and components of the interior; infinite when one is
 * not finite. */
static inline double flow_error(bw_ns_channel *ns, bw_ns_velocity_fn exact, void *context)
{
  const bw_grid *grid = bw_ns_channel_grid(ns);
  const bw_grid_view *g = bw_grid_look(grid);
  bw_real *const *u = bw_ns_channel_velocity(ns);
  double most = 0.0;
  for (int c = 0; c < 3 && u[c] != NULL; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          double x[3], v[3] = {0, 0, 0};
          flow_point(g, c, i, j, k, x);
          exact(x, bw_ns_channel_time(ns), context, v);
          const double error = fabs((double)u[c][bw_at(g, i, j, k)] - v[c]);
          most = isfinite(error) ? fmax(most, error) : (double)INFINITY;
        }
  bw_comm_max(bw_grid_comm(grid), 1, &most);
  return most;
}

/* `steps` equal steps to time t. */
static inline bw_status flow_run(bw_ns_channel *ns, double t, int steps)
{
  const double dt = (t - bw_ns_channel_time(ns)) / steps;
  for (int step = 0; step < steps; step++)
    BW_TRY(bw_ns_channel_step(ns, dt));
  return BW_OK;
}

/* As many steps as `share` of the largest stable one (of the start) needs. */
static inline bw_status flow_run_share(bw_ns_channel *ns, double t, double share)
{
  const double span = t - bw_ns_channel_time(ns);
  return flow_run(ns, t, (int)ceil(span / (share * bw_ns_channel_dt_max(ns))));
}
