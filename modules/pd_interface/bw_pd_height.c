/* How far above its particles the surface is, in the reference shape.
 *
 * A smooth slanted surface is a staircase of lattice sides. ERRATA 33 puts the surface at the mean
 * height of the sides of one particle; particles of the same terrace are at different depths below
 * the surface all the same, up to ds/2 off. Where it is smooth the surface goes through the mean of
 * what the surface particles say that h has intact bonds with, by their areas: corners of steps
 * stand for more of it. On a sphere or circle the way from one point to another is normal to the
 * sum of their normals, wherever they are: what the way has along it is the difference of their
 * heights, whatever the curvature. */
#include "pd_interface_internal.h"
#include <math.h>

/* ERRATA 33, by the settled normal. */
static double mean_of_sides(const bw_pd_interface *pi, size_t h)
{
  const bw_solid_config *c = bw_solid_settings(pi->pd);
  double sum = 0.0;
  for (int d = 0; d < pi->stencil->dims; d++)
    sum += fabs(bw_pd_interface__dot(c->axes[d], &pi->fit.own_normal[3 * h]));
  /* On ridges and edges there is no plane that the sides are steps of. */
  if (!bw_pd_interface__is_smooth(pi, h)) sum = 1.0;
  return 0.5 * bw_solid_spacing(pi->pd, h) / fmax(sum, 1.0);
}

/* How far above h's own height the mean of those about it is, nearer ones counting more. */
static double mean_about(const bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__near *near = &pi->rows.pool[pi->rows.row[h]];
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  const double *all = pi->fit.told[BW_PD_INTERFACE__PASSES], *n = &all[3 * h];
  const size_t count = pi->rows.stale[h] ? 0 : pi->rows.row_n[h];
  const double *mine = pi->fit.side[h];
  double sum = 0.0, weight = mine[1];
  for (size_t q = 0; q < count; q++) {
    if (near[q].partner < 0) continue;
    const double *xi = &s->xi[3 * near[q].slot];
    const double *its = pi->fit.side[near[q].partner];
    const double w = its[1] * (1.0 - bw_pd_interface__dot(xi, xi) / (s->family * s->family));
    double m[3], along = 0.0;
    bw_pd_interface__partner_normal(&near[q], all, m);
    if (!(w > 0.0 && bw_pd_interface__dot(n, m) > 0.7))
      continue; /* 45 degrees; 0 where it is not smooth */
    for (int d = 0; d < 3; d++)
      along += 0.5 * (xi[d] + its[0] * m[d] - mine[0] * n[d]) * (n[d] + m[d]);
    sum += w * along;
    weight += w;
  }
  return sum / weight;
}

void bw_pd_interface__settle_heights(bw_pd_interface *pi)
{
  double *normal = pi->fit.told[BW_PD_INTERFACE__PASSES];
  for (size_t row = 0; row < pi->now.n_list; row++) {
    double *side = pi->fit.side[pi->now.list[row]];
    side[0] = mean_of_sides(pi, (size_t)pi->now.list[row]), side[1] = pi->now.area[row];
  }
  bw_solid_fill_extended(pi->pd, sizeof *pi->fit.side, pi->fit.side, pi->fit.side);
  bw_solid_fill_extended(pi->pd, 3 * sizeof *normal, normal, normal);
  bw_pd_interface__spread_change(pi);
  for (size_t row = 0; row < pi->now.n_list; row++) {
    const size_t h = (size_t)pi->now.list[row];
    const bool smooth = bw_pd_interface__is_smooth(pi, h);
    /* Nothing near it has changed: it is what it was. */
    if (pi->fit.touched[h]) pi->fit.lift[h] = smooth ? mean_about(pi, h) : 0.0;
    pi->now.smooth[row] = smooth;
    pi->now.bend[row] = smooth ? pi->fit.bend[h] : 0.0;
    pi->now.height[row] = pi->fit.side[h][0] + pi->fit.lift[h];
  }
}
