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
      /* Only the ranks at the end of a direction touch its sides; a periodic side has no plane. */
      p->here = kind != BW_SIDE_PERIODIC && (s == 0 ? g->first[d] : g->last[d]);
      /* A plane covers the halos of the two tangential directions too, so that edges get ghosts. */
      for (int q = 0; q < 2; q++) {
        const int t = bw_ns__tangent(d, q);
        p->low[q] = 1 - g->halo[t];
        p->extent[q] = g->m[t] + 2 * g->halo[t];
      }
      /* Values are stored only where they vary: inflows, what an outflow carries, moving walls. */
      for (int c = 0; c < ns->components && p->here; c++)
        if (kind == BW_SIDE_INFLOW || (kind == BW_SIDE_OUTFLOW && c == d) ||
            (moves(&ns->config.side[d][s]) && c != d))
          BW_TRY(BW_ALLOCATE(&p->value[c], bw_ns__plane_size(p)));
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

bw_ns_walk bw_ns__walk(const bw_ns_channel *ns, int d, int s, int index)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_plane *p = &ns->plane[d][s];
  bw_ns_walk w = {
      .p = p, .step0 = g->stride[bw_ns__tangent(d, 0)], .step1 = g->stride[bw_ns__tangent(d, 1)]};
  /* value[0][0] belongs to the lowest tangential halo indices, so the walk starts there. */
  w.base = g->origin + index * g->stride[d] + p->low[0] * w.step0 + p->low[1] * w.step1;
  return w;
}

int bw_ns__face_index(const bw_ns_channel *ns, int d, int s)
{
  return s == 0 ? 0 : ns->g->m[d];
}

void bw_ns__faces(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      /* No plane of values means a wall or free slip: nothing goes through the face. */
      const bw_real *value = ns->plane[d][s].value[d];
      if (!ns->plane[d][s].here) continue;
      const bw_ns_walk w = bw_ns__walk(ns, d, s, bw_ns__face_index(ns, d, s));
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
  const bw_ns_walk w = bw_ns__walk(ns, d, s, to);
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
  /* A component on faces has its lower boundary value at index 0, a halo place: one layer less is
   * beyond it. */
  for (int q = 1; q <= (face && s == 0 ? h - 1 : h); q++) {
    const int to = s == 1 ? m + q : face ? -q : 1 - q;
    /* Mirror image about the face for what sits on faces, about the side for what sits in cells. */
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
      /* The normal component is odd about its own face, whose value stands there already. */
      for (int c = 0; c < ns->components; c++)
        ghost_layers(ns, d, s, c == d ? &normal[side->kind] : &tangential[side->kind], c == d,
                     ns->plane[d][s].value[c], c == d ? 0 : (bw_real)side->velocity[c], ns->u[c]);
    }
}

void bw_ns__ghosts_eddy(bw_ns_channel *ns, bw_real *nu)
{
  static const ghost_rule wall = {-1, 0, false}, mirror = {1, 0, false};
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++)
      if (ns->plane[d][s].here)
        ghost_layers(ns, d, s, ns->config.side[d][s].kind == BW_SIDE_WALL ? &wall : &mirror, false,
                     NULL, 0, nu);
}

void bw_ns__ghosts_scalar(bw_ns_channel *ns, bw_real *p)
{
  static const ghost_rule mirror = {1, 0, false};
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++)
      if (ns->plane[d][s].here) ghost_layers(ns, d, s, &mirror, false, NULL, 0, p);
}
