/* ns_boundary.c -- the six sides: normal velocity on the faces, ghosts beyond them.
 *
 *              normal velocity               beyond the face       tangential ghosts
 *   wall       0                             2 U - u (odd)         2 U - u (odd about U)
 *   free-slip  0                             odd                   u (even)
 *   inflow     given                         2 U - u               2 U - u
 *   outflow    du/dt + U_c du/dn = 0         last face             last cell (zero gradient)
 * p has mirror ghosts everywhere: its normal derivative is zero where the projection leaves the
 * velocity alone. x first, then y, then z, each over the halos of the others: an edge has the
 * value of the later direction. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <math.h>

typedef struct { /* ghost = sign * mirror image + twice * boundary value */
  bw_real sign, twice;
  bool copy; /* nearest instead of mirror image */
} ghost_rule;

static const ghost_rule tangential[] = {[BW_SIDE_WALL] = {-1, 2, false},
                                        [BW_SIDE_FREE_SLIP] = {1, 0, false},
                                        [BW_SIDE_INFLOW] = {-1, 2, false},
                                        [BW_SIDE_OUTFLOW] = {1, 0, true}};
static const ghost_rule normal[] = {[BW_SIDE_WALL] = {-1, 2, false},
                                    [BW_SIDE_FREE_SLIP] = {-1, 2, false},
                                    [BW_SIDE_INFLOW] = {-1, 2, false},
                                    [BW_SIDE_OUTFLOW] = {1, 0, true}};

static int tangent(int d, int which)
{
  return which == 0 ? (d == 0 ? 1 : 0) : (d == 2 ? 1 : 2);
}

static size_t plane_size(const bw_ns_plane *p)
{
  return (size_t)p->extent[0] * (size_t)p->extent[1];
}

/* A wall whose velocity a function gives. */
static bool moves(const bw_ns_side *side)
{
  return side->kind == BW_SIDE_WALL && side->profile == BW_PROFILE_CALLBACK;
}

bw_status bw_ns__planes_create(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      bw_ns_plane *p = &ns->plane[d][s];
      const bw_ns_side_kind kind = ns->config.side[d][s].kind;
      p->here = kind != BW_SIDE_PERIODIC && (s == 0 ? g->first[d] : g->last[d]);
      for (int q = 0; q < 2; q++) {
        const int t = tangent(d, q);
        p->low[q] = 1 - g->halo[t];
        p->extent[q] = g->m[t] + 2 * g->halo[t];
      }
      for (int c = 0; c < ns->components && p->here; c++)
        if (kind == BW_SIDE_INFLOW || (kind == BW_SIDE_OUTFLOW && c == d) ||
            (moves(&ns->config.side[d][s]) && c != d))
          BW_TRY(BW_ALLOCATE(&p->value[c], plane_size(p)));
    }
  return BW_OK;
}

void bw_ns__planes_destroy(bw_ns_channel *ns)
{
  for (int d = 0; d < 3; d++)
    for (int s = 0; s < 2; s++)
      for (int c = 0; c < 3; c++)
        bw_release(&ns->plane[d][s].value[c]);
}

/* Coordinate of point `i` (local) in direction t, at a face or a centre; beyond the box that of
 * the nearest point inside, or of the periodic image. */
static double coordinate(const bw_grid_view *g, int t, int i, bool face)
{
  const int n = g->n[t], first = face && !g->periodic[t] ? 0 : 1;
  int at = i + g->lo[t];
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
  const int t0 = tangent(d, 0), t1 = tangent(d, 1);
  for (int c = 0; c < ns->components; c++)
    for (int b = 0; b < p->extent[1] && p->value[c] != NULL; b++)
      for (int a = 0; a < p->extent[0]; a++) {
        double x[3], u[3] = {0, 0, 0};
        x[d] = s == 0 ? 0.0 : ns->g->length[d];
        x[t0] = coordinate(ns->g, t0, p->low[0] + a, c == t0);
        x[t1] = coordinate(ns->g, t1, p->low[1] + b, c == t1);
        side->function(x, t, side->context, u);
        p->value[c][(size_t)b * (size_t)p->extent[0] + (size_t)a] = (bw_real)u[c];
      }
}

/* The profile that the scheme itself keeps: its steady solution between walls at rest,
 *   u_1 = G H/2 dy_1/2,  u_{j+1} = u_j + G (H/2 - y_j) (yc_{j+1} - yc_j),
 * scaled so that sum u_j dy_j = U_b H. It is 6 U_b (y/H)(1 - y/H) + O(dy^2). */
static void fill_poiseuille(bw_ns_channel *ns, int s)
{
  const bw_grid_view *g = ns->g;
  bw_ns_plane *p = &ns->plane[0][s];
  const double height = g->length[1], bulk = ns->config.side[0][s].bulk_velocity;
  double shape = 0.25 * height * g->y_face[1], flow = shape * g->y_face[1];
  for (int j = 1; j < g->n[1]; j++) {
    shape += (0.5 * height - g->y_face[j]) * (g->y_centre[j + 1] - g->y_centre[j]);
    flow += shape * (g->y_face[j + 1] - g->y_face[j]);
  }
  shape = 0.25 * height * g->y_face[1];
  for (int j = 1; j <= g->n[1]; j++) {
    const int a = j - g->lo[1] - p->low[0]; /* global to plane */
    for (int b = 0; b < p->extent[1] && a >= 0 && a < p->extent[0]; b++)
      p->value[0][b * p->extent[0] + a] = (bw_real)(bulk * height / flow * shape);
    if (j < g->n[1]) shape += (0.5 * height - g->y_face[j]) * (g->y_centre[j + 1] - g->y_centre[j]);
  }
}

static void fill_uniform(bw_ns_channel *ns, int d, int s)
{
  bw_ns_plane *p = &ns->plane[d][s];
  for (int c = 0; c < ns->components; c++)
    for (size_t q = 0; q < plane_size(p); q++)
      p->value[c][q] = (bw_real)ns->config.side[d][s].velocity[c];
}

/* sum over the interior of a side of value dA; NULL: of dA. */
static double plane_flux(const bw_ns_channel *ns, int d, int s, const bw_real *value)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_plane *p = &ns->plane[d][s];
  const int t0 = tangent(d, 0), t1 = tangent(d, 1);
  double sum = 0.0;
  for (int b = 1; b <= g->m[t1]; b++)
    for (int a = 1; a <= g->m[t0]; a++) {
      const double h0 = t0 == 1 ? ns->metrics.dyf[a] : g->spacing[t0];
      const double h1 = t1 == 1 ? ns->metrics.dyf[b] : g->spacing[t1];
      const ptrdiff_t at = (ptrdiff_t)(b - p->low[1]) * p->extent[0] + (a - p->low[0]);
      sum += h0 * h1 * (value != NULL ? (double)value[at] : 1.0);
    }
  return sum;
}

double bw_ns__side_flux(const bw_ns_channel *ns, int d, int s)
{
  const bw_ns_plane *p = &ns->plane[d][s];
  if (!p->here || p->value[d] == NULL) return 0.0;
  return (s == 0 ? -1.0 : 1.0) * plane_flux(ns, d, s, p->value[d]);
}

double bw_ns__inflow(bw_ns_channel *ns, double t)
{
  double net[2] = {0.0, 0.0}; /* influx, outflow area */
  bool any = false;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &ns->config.side[d][s];
      const bool here = ns->plane[d][s].here;
      any |= side->kind == BW_SIDE_OUTFLOW;
      if (side->kind == BW_SIDE_OUTFLOW && here) net[1] += plane_flux(ns, d, s, NULL);
      if (moves(side) && here) fill_from_function(ns, d, s, t);
      if (side->kind != BW_SIDE_INFLOW || !here) continue;
      if (side->profile == BW_PROFILE_CALLBACK) fill_from_function(ns, d, s, t);
      if (side->profile == BW_PROFILE_POISEUILLE) fill_poiseuille(ns, s);
      if (side->profile == BW_PROFILE_UNIFORM) fill_uniform(ns, d, s);
      net[0] -= bw_ns__side_flux(ns, d, s);
    }
  if (!any) return 0.0;
  bw_comm_sum(ns->comm, 2, net);
  ns->outflow_area = net[1];
  return net[0];
}

/* Visit the face plane of a side: value[at of plane], field[at of field]. */
typedef struct {
  const bw_ns_plane *p;
  ptrdiff_t base, step0, step1; /* of the field */
} side_walk;

static side_walk walk(const bw_ns_channel *ns, int d, int s, int index)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_plane *p = &ns->plane[d][s];
  side_walk w = {.p = p, .step0 = g->stride[tangent(d, 0)], .step1 = g->stride[tangent(d, 1)]};
  w.base = g->origin + index * g->stride[d] + p->low[0] * w.step0 + p->low[1] * w.step1;
  return w;
}

static int face_index(const bw_ns_channel *ns, int d, int s)
{
  return s == 0 ? 0 : ns->g->m[d];
}

static void plane_from_field(bw_ns_channel *ns, int d, int s, int index, bw_real weight,
                             bw_real *value)
{
  const side_walk w = walk(ns, d, s, index);
  for (int b = 0; b < w.p->extent[1]; b++)
    for (int a = 0; a < w.p->extent[0]; a++) {
      bw_real *v = &value[b * w.p->extent[0] + a];
      *v = (1 - weight) * *v + weight * ns->u[d][w.base + a * w.step0 + b * w.step1];
    }
}

void bw_ns__outflow_capture(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components && ns->has_outflow; d++)
    if (ns->config.side[d][1].kind == BW_SIDE_OUTFLOW && ns->plane[d][1].here)
      plane_from_field(ns, d, 1, ns->g->m[d], 1, ns->plane[d][1].value[d]);
}

void bw_ns__outflow_balance(bw_ns_channel *ns, double influx)
{
  if (!ns->has_outflow) return;
  double out = 0.0;
  for (int d = 0; d < ns->components; d++)
    if (ns->config.side[d][1].kind == BW_SIDE_OUTFLOW) out += bw_ns__side_flux(ns, d, 1);
  bw_comm_sum(ns->comm, 1, &out);
  const bw_real shift = (bw_real)((influx - out) / ns->outflow_area);
  for (int d = 0; d < ns->components; d++) {
    bw_ns_plane *p = &ns->plane[d][1];
    if (ns->config.side[d][1].kind != BW_SIDE_OUTFLOW || !p->here) continue;
    for (size_t q = 0; q < plane_size(p); q++)
      p->value[d][q] += shift;
  }
}

/* Upwind, Euler over the sub-step: u_n <- u_n - c (u_n - u_{n-1}), c = U_c dt/dn clipped to 1. */
void bw_ns__outflow_advance(bw_ns_channel *ns, double dt, double influx)
{
  if (!ns->has_outflow) return;
  for (int d = 0; d < ns->components; d++) {
    const bw_ns_plane *p = &ns->plane[d][1];
    if (ns->config.side[d][1].kind != BW_SIDE_OUTFLOW || !p->here) continue;
    const double dn = d == 1 ? ns->metrics.dyf[ns->g->m[1]] : ns->g->spacing[d];
    const double c = fmax(0.0, fmin(1.0, influx / ns->outflow_area * dt / dn));
    plane_from_field(ns, d, 1, ns->g->m[d], 1, p->value[d]);
    plane_from_field(ns, d, 1, ns->g->m[d] - 1, (bw_real)c, p->value[d]);
  }
  bw_ns__outflow_balance(ns, influx);
}

void bw_ns__faces(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_real *value = ns->plane[d][s].value[d];
      if (!ns->plane[d][s].here) continue;
      const side_walk w = walk(ns, d, s, face_index(ns, d, s));
      for (int b = 0; b < w.p->extent[1]; b++)
        for (int a = 0; a < w.p->extent[0]; a++)
          ns->u[d][w.base + a * w.step0 + b * w.step1] =
              value != NULL ? value[b * w.p->extent[0] + a] : 0;
    }
}

/* One layer of ghosts: field[to] = sign field[from] + twice value. */
static void ghost_layer(const bw_ns_channel *ns, int d, int s, const ghost_rule *rule, int to,
                        int from, const bw_real *value, bw_real constant, bw_real *field)
{
  const side_walk w = walk(ns, d, s, to);
  const ptrdiff_t shift = (from - to) * ns->g->stride[d];
  const bw_real sign = rule->sign, twice = rule->twice;
  for (int b = 0; b < w.p->extent[1]; b++)
    for (int a = 0; a < w.p->extent[0]; a++) {
      bw_real *ghost = field + w.base + a * w.step0 + b * w.step1;
      const bw_real u = value != NULL ? value[b * w.p->extent[0] + a] : constant;
      *ghost = sign * ghost[shift] + twice * u;
    }
}

/* Layer q = 1, 2 beyond side (d, s) and its source: about the centre-line of the face for
 * centred values, about the face itself (index 0 or m) for the normal velocity. */
static void ghost_layers(const bw_ns_channel *ns, int d, int s, const ghost_rule *rule, bool face,
                         const bw_real *value, bw_real constant, bw_real *field)
{
  const int m = ns->g->m[d], h = ns->g->halo[d];
  for (int q = 1; q <= (face && s == 0 ? h - 1 : h); q++) {
    const int to = s == 1 ? m + q : face ? -q : 1 - q;
    const int mirror = s == 1 ? (face ? m - q : m + 1 - q) : q;
    const int nearest = s == 1 ? m : face ? 0 : 1;
    ghost_layer(ns, d, s, rule, to, rule->copy ? nearest : mirror, value, constant, field);
  }
}

void bw_ns__ghosts_velocity(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &ns->config.side[d][s];
      if (!ns->plane[d][s].here) continue;
      for (int c = 0; c < ns->components; c++)
        ghost_layers(ns, d, s, c == d ? &normal[side->kind] : &tangential[side->kind], c == d,
                     ns->plane[d][s].value[c], c == d ? 0 : (bw_real)side->velocity[c], ns->u[c]);
    }
}

void bw_ns__ghosts_scalar(bw_ns_channel *ns, bw_real *p)
{
  static const ghost_rule mirror = {1, 0, false};
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++)
      if (ns->plane[d][s].here) ghost_layers(ns, d, s, &mirror, false, NULL, 0, p);
}
