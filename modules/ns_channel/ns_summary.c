/* ns_summary.c -- what a history line wants to know. */
#include "ns_channel_internal.h"

#include <math.h>

/* Largest |div u| and largest |u| of this rank. */
static void extremes(const bw_ns_channel *ns, double most[2])
{
  const bw_grid_view *g = ns->g;
  most[0] = most[1] = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double div = 0.0;
        for (int c = 0; c < ns->components; c++) {
          const ptrdiff_t at = bw_at(g, i, j, k);
          const double here = (double)ns->u[c][at], below = (double)ns->u[c][at - g->stride[c]];
          div += (here - below) / (c == 1 ? ns->metrics.dyf[j] : g->spacing[c]);
          most[1] = fmax(most[1], fmax(fabs(here), fabs(below)));
        }
        most[0] = fmax(most[0], fabs(div));
      }
}

double bw_ns_channel_divergence(bw_ns_channel *ns)
{
  double most[2];
  extremes(ns, most);
  bw_comm_max(ns->comm, 2, most);
  return most[1] > 0.0 ? most[0] * ns->g->spacing[0] / most[1] : 0.0;
}

bw_ns_summary bw_ns_channel_summary(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  enum { BULK, ENERGY, INFLOW, OUTFLOW, COUNT };
  double sum[COUNT] = {0.0};
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const double side = ns->metrics.dyf[j] * g->spacing[2], volume = side * g->spacing[0];
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k);
        double squares = 0.0;
        for (int c = 0; c < ns->components; c++) {
          const double here = (double)ns->u[c][at], below = (double)ns->u[c][at - g->stride[c]];
          squares += here * here + below * below;
          if (c == 0) sum[BULK] += 0.5 * (here + below) * volume;
        }
        sum[ENERGY] += 0.25 * squares * volume; /* each face's half belongs to this cell */
      }
      sum[INFLOW] += (double)ns->u[0][bw_at(g, 0, j, k)] * side;
      sum[OUTFLOW] += (double)ns->u[0][bw_at(g, g->m[0], j, k)] * side;
    }
  bw_comm_sum(ns->comm, COUNT, sum);
  return (bw_ns_summary){.bulk_velocity = sum[BULK] / (g->length[0] * g->length[1] * g->length[2]),
                         .kinetic_energy = sum[ENERGY],
                         .pressure_gradient = ns->applied,
                         .inflow = sum[INFLOW],
                         .outflow = sum[OUTFLOW]};
}
