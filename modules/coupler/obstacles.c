/* Which cells are in the solid: what probes must not end in. */
#include "bw_coupler.h"
#include "bw_exchange.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "rigid_joined.h"

#include <math.h>
#include <string.h>

/* Does `inside` still describe where the solid is, to a tenth of a cell? Its surface tells. The
 * same on all ranks. */
static bool inside_is_stale(bw_coupler *c)
{
  const size_t n = c->n_surface;
  /* Another set of particles is news at once; the same set as soon as it has moved. */
  const bool known = c->inside_known && n == c->n_inside &&
                     memcmp(c->particle_inside, c->particle, n * sizeof *c->particle) == 0;
  double moved = known ? 0.0 : INFINITY;
  for (size_t i = 0; known && i < 3 * n; i++) {
    const double far = fabs(c->root[i] - c->root_inside[i]);
    moved = far > moved ? far : moved;
  }
  if (c->floats != NULL) moved = fmax(moved, bw_coupler__rigid_moved(c->floats));
  /* All ranks mark anew or none does. */
  bw_comm_max(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 1, &moved);
  return moved > 0.1 * c->h;
}

/* Local cell index of a point this rank owns (periodic directions wrapped). */
static ptrdiff_t cell_of(const bw_grid_view *g, const double x[3])
{
  int i[3];
  for (int d = 0; d < 3; d++) {
    const int global = (int)floor(x[d] / g->spacing[d]);
    const int wrapped = g->periodic[d] ? ((global % g->n[d]) + g->n[d]) % g->n[d] : global;
    i[d] = wrapped + 1 - g->lo[d];
    i[d] = i[d] < 1 ? 1 : i[d] > g->m[d] ? g->m[d] : i[d]; /* a point on the very side */
  }
  return bw_at(g, i[0], i[1], i[2]);
}

/* Is the centre of the cell that own particle p is in within p's cube of matter, however that is
 * turned? Where particles are as large as cells all of their cells are: no centre is missed. */
static bool fills_cell(const bw_coupler *c, const bw_grid_view *g, size_t p)
{
  const double s = bw_solid_spacing(c->solid, p);
  double far = 0.0, reach = 0.0;
  for (int d = 0; d < 3; d++) {
    if (g->n[d] == 1) continue;
    const double x = c->X[3 * p + (size_t)d] / g->spacing[d];
    far += pow((x - floor(x) - 0.5) * g->spacing[d], 2);
    reach += 0.25 * s * s;
  }
  return far <= reach * (1.0 + 1e-9);
}

/* Mark the cells whose centres are in the solid: probes must not end in them. */
static bw_status mark_inside(bw_coupler *c)
{
  bw_grid *grid = bw_ns_channel_grid(c->fluid);
  const bw_grid_view *g = bw_grid_look(grid);
  int *owner = NULL;
  double *send = NULL, *receive = NULL;
  bw_exchange *plan = NULL;
  size_t n = 0;
  bw_solid_get_position(c->solid, c->X);
  bw_status st = BW_ALLOCATE(&owner, c->n);
  BW_THEN(st, BW_ALLOCATE(&send, 3 * c->n));
  /* Every particle, not only the surface, to the rank that owns its cell. */
  for (size_t p = 0; st == BW_OK && p < c->n; p++) {
    if (!bw_coupler__within_box(g, c->X + 3 * p) || !fills_cell(c, g, p)) continue;
    memcpy(send + 3 * n, c->X + 3 * p, 3 * sizeof *send);
    owner[n++] = bw_grid_owner(grid, c->X + 3 * p);
  }
  /* Only now may collective calls follow: an allocation may have failed on one rank. */
  st = bw_comm_agree(bw_grid_comm(grid), st);
  BW_THEN(st, bw_exchange_create(bw_grid_comm(grid), n, owner, &plan));
  BW_THEN(st,
          bw_comm_agree(bw_grid_comm(grid), BW_ALLOCATE(&receive, 3 * bw_exchange_received(plan))));
  if (st == BW_OK) {
    bw_exchange_forward(plan, 3 * sizeof *send, send, receive);
    /* Halos too, as tips look there. */
    memset(c->inside, 0, g->size * sizeof *c->inside);
    for (size_t q = 0; q < bw_exchange_received(plan); q++)
      c->inside[cell_of(g, receive + 3 * q)] = 1;
    if (c->floats != NULL) bw_coupler__rigid_mark(c->floats, c->inside);
    bw_halo_update(grid, 1, &c->inside);
    st = bw_comm_agree(bw_grid_comm(grid), bw_probe_set_obstacles(c->probe, c->inside));
    /* What inside_is_stale will compare with. */
    memcpy(c->root_inside, c->root, 3 * c->n_surface * sizeof *c->root);
    memcpy(c->particle_inside, c->particle, c->n_surface * sizeof *c->particle);
    c->n_inside = c->n_surface;
    c->inside_known = true;
  }
  bw_exchange_destroy(&plan);
  bw_release(&owner);
  bw_release(&send);
  bw_release(&receive);
  return st;
}

bw_status bw_coupler__find_obstacles(bw_coupler *c)
{
  return inside_is_stale(c) ? mark_inside(c) : BW_OK;
}
