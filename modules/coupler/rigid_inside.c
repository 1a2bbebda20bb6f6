/* The cells inside rigid bodies: the momentum of their fluid, and marks for probes. */
#include "rigid_impl.h"

#include <math.h>
#include <string.h>

/* Cells lo <= i <= hi of this rank in direction d that the ball of radius R about x may reach; with
 * the ball across a periodic side all of them. */
static void reach(const bw_grid_view *g, int d, double x, double R, int lo[3], int hi[3])
{
  const double h = g->spacing[d], from = (x - R) / h, to = (x + R) / h;
  lo[d] = 1, hi[d] = g->m[d];
  if (g->n[d] == 1 || (g->periodic[d] && (from < 1.0 || to > g->n[d] - 1.0))) return;
  lo[d] = (int)fmax(1.0, floor(from) - g->lo[d]);
  hi[d] = (int)fmin(g->m[d], ceil(to) + 1.0 - g->lo[d]);
}

/* int (u - U) dV over body q where it is, or will be after dt at its present velocity and spin, and
 * its moment about the centre there, into sum (6): component d of the velocity in the cells of its
 * own points, by the share of each that is inside. U is the body's own motion, which does not
 * change in a step: without it the shares, whose sum changes as the body passes through the cells,
 * would push. Local. */
static void add_inside(const bw_coupler_rigid *c, int q, double dt, double sum[6])
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  const bw_rigid_state s = bw_rigid_state_of(c->rigid, q);
  const double R = bw_rigid_radius(c->rigid, q) + g->spacing[0];
  const double volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  const int dims = g->n[2] == 1 ? 2 : 3;
  int lo[3], hi[3];
  double X[3];
  for (int d = 0; d < 3; d++) {
    X[d] = s.position[d] + dt * s.velocity[d];
    reach(g, d, X[d], R, lo, hi);
  }
  for (int d = 0; d < dims; d++)
    for (int k = lo[2]; k <= hi[2]; k++)
      for (int j = lo[1]; j <= hi[1]; j++)
        for (int i = lo[0]; i <= hi[0]; i++) {
          const int cell[3] = {i, j, k};
          double x[3], r[3] = {0.0, 0.0, 0.0};
          /* From the centre to the nearest image of the point. */
          for (int e = 0; e < dims; e++) {
            r[e] = (cell[e] + g->lo[e] - (e == d ? 0.0 : 0.5)) * g->spacing[e] - X[e];
            if (g->periodic[e]) r[e] -= g->length[e] * round(r[e] / g->length[e]);
          }
          /* The shape is known where it is now: back from there, and turned back. */
          for (int e = 0; e < 3; e++)
            x[e] =
                s.position[e] + r[e] -
                dt * (s.spin[(e + 1) % 3] * r[(e + 2) % 3] - s.spin[(e + 2) % 3] * r[(e + 1) % 3]);
          const double away = bw_rigid_distance(c->rigid, q, x) / g->spacing[0];
          const double share = fmin(1.0, fmax(0.0, 0.5 - away)) * volume;
          if (share == 0.0) continue;
          /* (r x u e_d): e_e gets r_f u_d by the cyclic sign. */
          const int a = (d + 1) % 3, b = (d + 2) % 3;
          const double own = s.velocity[d] + s.spin[a] * r[b] - s.spin[b] * r[a];
          const double momentum = share * ((double)u[d][bw_at(g, i, j, k)] - own);
          sum[d] += momentum;
          sum[3 + a] += r[b] * momentum;
          sum[3 + b] -= r[a] * momentum;
        }
}

/* The same of all bodies, over all ranks. Collective. */
void bw_coupler__rigid_inside(const bw_coupler_rigid *c, double dt, double sum[])
{
  const int n = bw_rigid_count(c->rigid);
  memset(sum, 0, 6 * (size_t)n * sizeof *sum);
  for (int q = 0; q < n; q++)
    add_inside(c, q, dt, sum + 6 * (ptrdiff_t)q);
  bw_comm_sum(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 6 * (size_t)n, sum);
}

void bw_coupler__rigid_mark(bw_coupler_rigid *c, bw_real *inside)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const int dims = g->n[2] == 1 ? 2 : 3;
  bw_rigid_surface(c->rigid, c->marked, NULL, NULL);
  c->is_marked = true;
  for (int q = 0; q < bw_rigid_count(c->rigid); q++) {
    const bw_rigid_state s = bw_rigid_state_of(c->rigid, q);
    int lo[3], hi[3];
    for (int d = 0; d < 3; d++)
      reach(g, d, s.position[d], bw_rigid_radius(c->rigid, q), lo, hi);
    for (int k = lo[2]; k <= hi[2]; k++)
      for (int j = lo[1]; j <= hi[1]; j++)
        for (int i = lo[0]; i <= hi[0]; i++) {
          const int cell[3] = {i, j, k};
          double x[3] = {0.0, 0.0, 0.0};
          for (int d = 0; d < dims; d++) {
            double r = (cell[d] + g->lo[d] - 0.5) * g->spacing[d] - s.position[d];
            if (g->periodic[d]) r -= g->length[d] * round(r / g->length[d]);
            x[d] = s.position[d] + r;
          }
          if (bw_rigid_distance(c->rigid, q, x) < 0.0) inside[bw_at(g, i, j, k)] = 1;
        }
  }
}

double bw_coupler__rigid_moved(const bw_coupler_rigid *c)
{
  double most = 0.0;
  if (!c->is_marked) return INFINITY;
  bw_rigid_surface(c->rigid, c->Q, NULL, NULL); /* scratch */
  for (size_t i = 0; i < 3 * c->n; i++)
    most = fmax(most, fabs(c->Q[i] - c->marked[i]));
  return most;
}
