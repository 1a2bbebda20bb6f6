/* ns_summary.c -- what a history line wants to know. */
#include "ns_channel_internal.h"

#include <math.h>
#include <string.h>

/* Largest |div u| but for sources, and largest |u| of this rank. */
static void extremes(bw_ns_channel *ns, double most[2])
{
  const bw_grid_view *g = ns->g;
  /* phi is free between the sub-steps. */
  memset(ns->phi, 0, g->size * sizeof *ns->phi);
  bw_ns__sources_take(ns, 1.0, ns->phi);
  most[0] = most[1] = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double div = (double)ns->phi[bw_at(g, i, j, k)];
        /* Both faces of a cell are looked at, so that the lowest ones count as well. */
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
        /* Values sit on faces: a cell has half of each of its two. */
        for (int c = 0; c < ns->components; c++) {
          const double here = (double)ns->u[c][at], below = (double)ns->u[c][at - g->stride[c]];
          squares += here * here + below * below;
          if (c == ns->config.forcing_axis) sum[BULK] += 0.5 * (here + below) * volume;
        }
        sum[ENERGY] += 0.25 * squares * volume; /* each face's half belongs to this cell */
      }
      /* Fluxes through the x sides of this rank, which has all of x. */
      sum[INFLOW] += (double)ns->u[0][bw_at(g, 0, j, k)] * side;
      sum[OUTFLOW] += (double)ns->u[0][bw_at(g, g->m[0], j, k)] * side;
    }
  /* One message for all sums. */
  bw_comm_sum(ns->comm, COUNT, sum);
  return (bw_ns_summary){.bulk_velocity = sum[BULK] / (g->length[0] * g->length[1] * g->length[2]),
                         .kinetic_energy = sum[ENERGY],
                         .pressure_gradient = ns->applied,
                         .inflow = sum[INFLOW],
                         .outflow = sum[OUTFLOW]};
}

double bw_ns_channel_tortuosity(bw_ns_channel *ns, int axis, const double lower[3],
                                const double upper[3])
{
  const bw_grid_view *g = ns->g;
  double sum[2] = {0.0, 0.0}; /* of |u| and of its part along the axis, times volumes */
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const double x[3] = {(g->lo[0] + i - 0.5) * g->spacing[0], g->y_centre[g->lo[1] + j],
                             (g->lo[2] + k - 0.5) * g->spacing[2]};
        bool inside = true;
        for (int c = 0; c < ns->components; c++)
          inside = inside && x[c] > lower[c] && x[c] < upper[c];
        if (!inside) continue;
        /* At the centre: the mean of both faces of each component. */
        const ptrdiff_t at = bw_at(g, i, j, k);
        double square = 0.0, along = 0.0;
        for (int c = 0; c < ns->components; c++) {
          const double u = 0.5 * ((double)ns->u[c][at] + (double)ns->u[c][at - g->stride[c]]);
          square += u * u;
          if (c == axis) along = u;
        }
        sum[0] += sqrt(square) * ns->metrics.dyf[j];
        sum[1] += along * ns->metrics.dyf[j];
      }
  bw_comm_sum(ns->comm, 2, sum);
  return sum[1] != 0.0 ? sum[0] / fabs(sum[1]) : (double)NAN;
}

/* This rank's sum of du_c/dn (into the fluid) over the cells of a side, times their areas. A cell
 * has the mean of the component's two points. */
static double slope(const bw_ns_channel *ns, int d, int s, int c)
{
  const bw_grid_view *g = ns->g;
  const int face = bw_ns__face_index(ns, d, s), which = c == bw_ns__tangent(d, 0) ? 0 : 1;
  const bw_ns_walk w = bw_ns__walk(ns, d, s, s == 0 ? 1 : face);
  /* The ghost beyond the side mirrors the wall's velocity, so the difference is over one cell. */
  const ptrdiff_t outwards = s == 0 ? -g->stride[d] : g->stride[d];
  const ptrdiff_t previous = which == 0 ? w.step0 : w.step1;
  const double distance = d == 1 ? ns->metrics.dyc[face] : g->spacing[d];
  double sum = 0.0;
  for (int b = 1; b <= g->m[bw_ns__tangent(d, 1)]; b++)
    for (int a = 1; a <= g->m[bw_ns__tangent(d, 0)]; a++) {
      const bw_real *u =
          ns->u[c] + w.base + (a - w.p->low[0]) * w.step0 + (b - w.p->low[1]) * w.step1;
      /* The component sits on cell faces along itself: a cell has the mean of two slopes. */
      const double here = (double)u[0] - (double)u[outwards];
      const double before = (double)u[-previous] - (double)u[outwards - previous];
      sum += 0.5 * (here + before) / distance * bw_ns__side_area(ns, d, a, b);
    }
  return sum;
}

bw_ns_side_report bw_ns_channel_side(bw_ns_channel *ns, int d, int s)
{
  const bw_grid_view *g = ns->g;
  const bool here = ns->plane[d][s].here;
  double sum[4] = {0.0, 0.0, 0.0, 0.0}; /* slopes, flux */
  for (int c = 0; c < ns->components && here; c++)
    if (c != d) sum[c] = slope(ns, d, s, c);
  if (here) sum[3] = bw_ns__side_flux(ns, d, s);
  /* Ranks that do not touch the side add nothing. */
  bw_comm_sum(ns->comm, 4, sum);
  /* Area of the side: the box's volume over its length along d. */
  const double per_area =
      ns->config.nu * g->length[d] / (g->length[0] * g->length[1] * g->length[2]);
  return (bw_ns_side_report){.flux = sum[3],
                             .stress = {per_area * sum[0], per_area * sum[1], per_area * sum[2]}};
}
