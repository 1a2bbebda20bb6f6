/* ns_inflow.c -- what the sides prescribe: planes of values of walls that move and of inflows, and
 * the volume that enters. Steady profiles are filled once, callbacks in every sub-step. */
#include "ns_channel_internal.h"

/* Coordinate of point `i` (local) in direction t, at a face or a centre; beyond the box that of
 * the nearest point inside, or of the periodic image. */
static double coordinate(const bw_grid_view *g, int t, int i, bool face)
{
  const int n = g->n[t], first = face && !g->periodic[t] ? 0 : 1;
  int at = i + g->lo[t];
  /* Halo places get the coordinate of their periodic image, or of the nearest point inside. */
  if (g->periodic[t])
    at = ((at - 1) % n + n) % n + 1;
  else
    at = at < first ? first : at > n ? n : at;
  if (t == 1) return face ? g->y_face[at] : g->y_centre[at];
  return (face ? at : at - 0.5) * g->spacing[t];
}

static void fill_from_function(bw_ns_channel *ns, int d, int s, double t)
{
  const bw_ns_side *side = &ns->config.side[d][s];
  bw_ns_plane *p = &ns->plane[d][s];
  const int t0 = bw_ns__tangent(d, 0), t1 = bw_ns__tangent(d, 1);
  for (int c = 0; c < ns->components; c++)
    for (int b = 0; b < p->extent[1] && p->value[c] != NULL; b++)
      for (int a = 0; a < p->extent[0]; a++) {
        double x[3], u[3] = {0, 0, 0};
        /* All components are asked for on the side itself: ghosts mirror about it. */
        x[d] = s == 0 ? 0.0 : ns->g->length[d];
        x[t0] = coordinate(ns->g, t0, p->low[0] + a, c == t0);
        x[t1] = coordinate(ns->g, t1, p->low[1] + b, c == t1);
        /* Each component at its own staggered point, halos of the plane included. */
        side->function(x, t, side->context, u);
        p->value[c][(size_t)b * (size_t)p->extent[0] + (size_t)a] = (bw_real)u[c];
      }
}

static void fill_uniform(bw_ns_channel *ns, int d, int s)
{
  bw_ns_plane *p = &ns->plane[d][s];
  for (int c = 0; c < ns->components; c++)
    for (size_t q = 0; q < bw_ns__plane_size(p); q++)
      p->value[c][q] = (bw_real)ns->config.side[d][s].velocity[c];
}

/* What the section of direction d has at side (e, s): walls are Dirichlet sides to Poisson's solver
 * (mirror ghosts, as those of the velocity), all else is symmetric. */
static bw_poisson_side section_side(const bw_ns_channel *ns, int d, int e, int s)
{
  if (ns->g->periodic[e]) return BW_POISSON_PERIODIC;
  const bool wall = e != d && e < ns->components && ns->config.side[e][s].kind == BW_SIDE_WALL;
  return wall ? BW_POISSON_DIRICHLET : BW_POISSON_NEUMANN;
}

/* phi <- the steady profile between the walls, D phi = -1 with the scheme's own second differences.
 * Nothing depends on the coordinate along d, so that any layer of the solution is the profile. */
static bw_status solve_section(bw_ns_channel *ns, int d)
{
#define BW_PAIR(e)                                                                                 \
  {                                                                                                \
    section_side(ns, d, e, 0), section_side(ns, d, e, 1)                                           \
  }
  const bw_poisson_side side[3][2] = {BW_PAIR(0), BW_PAIR(1), BW_PAIR(2)};
#undef BW_PAIR
  bw_poisson *section = NULL;
  BW_TRY(bw_poisson_create(ns->grid, side, &section));
  /* Unit pressure gradient and viscosity; the flux is scaled to U_b afterwards. */
  for (size_t q = 0; q < ns->g->size; q++)
    ns->phi[q] = -1;
  bw_poisson_solve(section, ns->phi);
  /* phi is free between projections, so the profile may live there until it is copied. */
  bw_poisson_destroy(&section);
  bw_halo_update(ns->grid, 1, &ns->phi);
  return BW_OK;
}

double bw_ns__side_area(const bw_ns_channel *ns, int d, int a, int b)
{
  const int t0 = bw_ns__tangent(d, 0), t1 = bw_ns__tangent(d, 1);
  const double *h = ns->g->spacing;
  return (t0 == 1 ? ns->metrics.dyf[a] : h[t0]) * (t1 == 1 ? ns->metrics.dyf[b] : h[t1]);
}

/* Sum over the interior of a side of value dA; NULL: of dA. */
static double plane_flux(const bw_ns_channel *ns, int d, int s, const bw_real *value)
{
  const bw_ns_plane *p = &ns->plane[d][s];
  double sum = 0.0;
  for (int b = 1; b <= ns->g->m[bw_ns__tangent(d, 1)]; b++)
    for (int a = 1; a <= ns->g->m[bw_ns__tangent(d, 0)]; a++) {
      const ptrdiff_t at = (ptrdiff_t)(b - p->low[1]) * p->extent[0] + (a - p->low[0]);
      sum += bw_ns__side_area(ns, d, a, b) * (value != NULL ? (double)value[at] : 1.0);
    }
  return sum;
}

/* The section's own profile, scaled so that its discrete flux is U_b times the area. */
static bw_status fill_laminar(bw_ns_channel *ns, int d, int s)
{
  bw_ns_plane *p = &ns->plane[d][s];
  double sum[2] = {0.0, 0.0}; /* flux of the profile, area */
  BW_TRY(solve_section(ns, d));
  /* Any layer serves; the one beside the side is on this rank. */
  if (p->here) {
    const bw_ns_walk w = bw_ns__walk(ns, d, s, s == 0 ? 1 : ns->g->m[d]);
    for (int b = 0; b < p->extent[1]; b++)
      for (int a = 0; a < p->extent[0]; a++)
        p->value[d][b * p->extent[0] + a] = ns->phi[w.base + a * w.step0 + b * w.step1];
    sum[0] = plane_flux(ns, d, s, p->value[d]);
    sum[1] = plane_flux(ns, d, s, NULL);
  }
  /* The side may be divided over ranks, the bulk velocity is that of all of it. */
  bw_comm_sum(ns->comm, 2, sum);
  /* Scaled by the discrete flux, so that exactly U_b times the area enters. */
  const double scale = ns->config.side[d][s].bulk_velocity * sum[1] / sum[0];
  for (size_t q = 0; p->here && q < bw_ns__plane_size(p); q++)
    p->value[d][q] *= (bw_real)scale;
  return BW_OK;
}

double bw_ns__side_flux(const bw_ns_channel *ns, int d, int s)
{
  const bw_ns_plane *p = &ns->plane[d][s];
  if (!p->here || p->value[d] == NULL) return 0.0;
  return (s == 0 ? -1.0 : 1.0) * plane_flux(ns, d, s, p->value[d]);
}

bw_status bw_ns__inflow_create(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &ns->config.side[d][s];
      const bool here = ns->plane[d][s].here;
      /* The area of all outflows together decides U_c. */
      if (side->kind == BW_SIDE_OUTFLOW && here) ns->outflow_area += plane_flux(ns, d, s, NULL);
      if (side->kind != BW_SIDE_INFLOW) continue;
      /* Collective also on ranks that do not touch the side. */
      if (side->profile == BW_PROFILE_POISEUILLE) BW_TRY(fill_laminar(ns, d, s));
      if (side->profile == BW_PROFILE_UNIFORM && here) fill_uniform(ns, d, s);
    }
  bw_comm_sum(ns->comm, 1, &ns->outflow_area);
  return BW_OK;
}

double bw_ns__inflow(bw_ns_channel *ns, double t)
{
  double net = 0.0;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &ns->config.side[d][s];
      const bool prescribed = side->kind == BW_SIDE_INFLOW || side->kind == BW_SIDE_WALL;
      if (!prescribed || !ns->plane[d][s].here) continue;
      /* Only what depends on time is filled again. */
      if (side->profile == BW_PROFILE_CALLBACK) fill_from_function(ns, d, s, t);
      if (side->kind == BW_SIDE_INFLOW) net -= bw_ns__side_flux(ns, d, s);
    }
  /* Only an outflow asks how much enters; without one no message is sent. */
  if (ns->outflow_area > 0.0) bw_comm_sum(ns->comm, 1, &net);
  return net;
}
