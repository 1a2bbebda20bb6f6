/* Free bodies: the walls they meet, the weight they have, and what becomes of those that leave. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <stdlib.h>
#include <string.h>

/* Sides that turn a body back. Through an inflow only fluid comes: its profile is given, a body in
 * it would be run through. */
static bool turns_back(bw_ns_side_kind kind)
{
  return kind == BW_SIDE_WALL || kind == BW_SIDE_FREE_SLIP || kind == BW_SIDE_INFLOW;
}

bw_status bw_coupler__bodies_create(bw_coupler *c)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_ns_channel_config *fluid = bw_ns_channel_settings(c->fluid);
  const bool planar = bw_solid_settings(c->solid)->geometry != BW_PD_3D;
  bw_pd_wall wall[BW_PD_WALLS];
  int n = 0;
  /* The box lies where n.x > offset. Outflows let bodies pass, periodic sides are no walls. */
  for (int d = 0; d < (planar ? 2 : 3); d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side_kind kind = fluid->side[d][s].kind;
      if (kind == BW_SIDE_OUTFLOW) c->open[d][s] = c->has_outflow = true;
      if (!turns_back(kind)) continue;
      wall[n] = (bw_pd_wall){.offset = s == 0 ? 0.0 : -g->length[d]};
      wall[n++].normal[d] = s == 0 ? 1.0 : -1.0;
    }
  bw_status st = BW_ALLOCATE(&c->stays, bw_solid_get_extended(c->solid).n);
  BW_THEN(st, BW_ALLOCATE(&c->gone, c->n));
  BW_THEN(st, BW_ALLOCATE(&c->link, (size_t)bw_solid_max_family(c->solid)));
  /* Walls act through contact; without it there is nothing to tell the solid. */
  st = bw_comm_agree(bw_solid_comm(c->solid), st);
  if (st != BW_OK || !bw_solid_settings(c->solid)->contact) return st;
  return bw_solid_set_walls(c->solid, n, wall);
}

static int by_label(const void *a, const void *b)
{
  const int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
  return (p > q) - (p < q);
}

/* The bodies' labels, rising, the same on all ranks; owned by the caller. A body has one particle
 * whose id is its label. Collective. */
static bw_status list_labels(bw_coupler *c, const int64_t label[], int64_t **all, size_t *n)
{
  const bw_comm *comm = bw_solid_comm(c->solid);
  int64_t *mine = NULL;
  size_t own = 0, bytes = 0;
  void *raw = NULL;
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&mine, c->n));
  for (size_t i = 0; st == BW_OK && i < c->n; i++)
    if (label[i] == bw_solid_id(c->solid)[i]) mine[own++] = label[i];
  BW_THEN(st, bw_comm_allgather(comm, own * sizeof *mine, mine, &bytes, &raw));
  bw_release(&mine);
  *all = raw;
  *n = bytes / sizeof **all;
  if (st == BW_OK && *n > 0) qsort(*all, *n, sizeof **all, by_label);
  return st;
}

bw_status bw_coupler__bodies_number(bw_coupler *c)
{
  int64_t *label = NULL, *all = NULL;
  size_t n = 0;
  bw_status st = bw_comm_agree(bw_solid_comm(c->solid), BW_ALLOCATE(&label, c->n));
  BW_THEN(st, bw_pd_interface_bodies(c->interface, label));
  BW_THEN(st, list_labels(c, label, &all, &n));
  c->n_bodies = (int)n;
  for (size_t i = 0; st == BW_OK && i < c->n; i++) {
    const int64_t *found = bsearch(&label[i], all, n, sizeof *all, by_label);
    c->body[i] = (int)(found - all);
  }
  bw_release(&label);
  bw_release(&all);
  return st;
}

void bw_coupler__bodies_release(bw_coupler *c)
{
  bw_release(&c->stays);
  bw_release(&c->gone);
  bw_release(&c->link);
}

/* Load of the fluid and weight less buoyancy: the fluid's pressure has no hydrostatic part, nor has
 * it the gradient that drives it. Probes miss both; the markers hold the fluid inside against the
 * latter, so that their reaction has it. */
void bw_coupler__push_solid(bw_coupler *c)
{
  const bool probed = c->config.load == BW_LOAD_PROBES;
  /* The gradient that drives the fluid pushes the solid's volume as well (ERRATA 31). */
  const int axis = bw_ns_channel_settings(c->fluid)->forcing_axis;
  const double driven = probed ? c->config.rho * bw_ns_channel_driving(c->fluid) : 0.0;
  /* V is scratch here: velocities are read anew after the solid has moved. */
  for (size_t i = 0; i < c->n; i++) {
    const double excess = bw_solid_density(c->solid, i) - c->config.rho;
    for (int d = 0; d < 3; d++) {
      /* Weight less buoyancy. */
      double more = excess * c->config.gravity[d];
      if (d == axis && probed) more += driven;
      c->V[3 * i + d] = c->F[3 * i + d] + more;
    }
  }
  bw_solid_set_force(c->solid, c->V);
  if (c->films != NULL) bw_coupler__solid_films_base(c, c->V);
}

/* Is the whole cube of particle i, at x, beyond an outflow (open), or any side of the box? */
static bool is_beyond(const bw_coupler *c, size_t i, const double x[3], bool open_only)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  /* To leave, all of the cube has to be outside; to be inside, its centre. */
  const double half = open_only ? 0.5 * bw_solid_spacing(c->solid, i) : 0.0;
  for (int d = 0; d < 3; d++) {
    if (g->periodic[d] || (g->n[d] == 1 && g->halo[d] == 0)) continue;
    if ((!open_only || c->open[d][0]) && x[d] < -half) return true;
    if ((!open_only || c->open[d][1]) && x[d] > g->length[d] + half) return true;
  }
  return false;
}

double bw_coupler__wetted(bw_coupler *c)
{
  double wet = 0.0;
  bw_solid_get_position(c->solid, c->X);
  for (size_t i = 0; i < c->n; i++)
    if (!is_beyond(c, i, c->X + 3 * i, false)) wet += bw_solid_volume_of(c->solid, i);
  return wet;
}

/* c->gone: particles beyond an outflow. Returns how many on all ranks. */
static int64_t find_beyond(bw_coupler *c)
{
  const uint8_t *kind = bw_solid_kind(c->solid), settled = BW_PD_PRESCRIBED | BW_PD_RETIRED;
  int64_t n = 0;
  bw_solid_get_position(c->solid, c->X);
  /* Held particles stay, retired ones are gone already. */
  for (size_t i = 0; i < c->n; i++) {
    c->gone[i] = !(kind[i] & settled) && is_beyond(c, i, c->X + 3 * i, true);
    n += c->gone[i];
  }
  bw_comm_sum_int(bw_solid_comm(c->solid), 1, &n);
  return n;
}

/* Does a bond that holds join particle i to one that stays? */
static bool is_kept(bw_coupler *c, size_t i)
{
  const int n = bw_solid_links(c->solid, i, c->link);
  for (int q = 0; q < n; q++)
    if (c->link[q].intact && c->stays[c->link[q].neighbour]) return true;
  return false;
}

/* Takes from c->gone what is joined, directly or through others, to what stays in the box.
 * Returns how many are left in it on all ranks. */
static int64_t keep_joined(bw_coupler *c)
{
  int64_t count[2]; /* kept in this round, gone */
  /* At first everything that is not beyond an outflow stays. */
  for (size_t i = 0; i < c->n; i++)
    c->stays[i] = !c->gone[i];
  /* Staying spreads along bonds that hold, also to copies
   * on other ranks, until it reaches nobody new. */
  do {
    bw_solid_fill_extended(c->solid, sizeof *c->stays, c->stays, c->stays);
    memset(count, 0, sizeof count);
    for (size_t i = 0; i < c->n; i++) {
      if (!c->gone[i]) continue;
      c->stays[i] = is_kept(c, i);
      c->gone[i] = !c->stays[i];
      count[c->gone[i]]++;
    }
    bw_comm_sum_int(bw_solid_comm(c->solid), 2, count);
  } while (count[0] > 0);
  return count[1];
}

/* Pieces that are wholly beyond an outflow are retired: they fly on and cost nothing. */
bw_status bw_coupler__let_go(bw_coupler *c)
{
  /* Most steps end at the first of these questions. */
  if (!c->has_outflow || find_beyond(c) == 0 || keep_joined(c) == 0) return BW_OK;
  return bw_solid_retire(c->solid, c->gone);
}

/* Mass in the box (held particles under its walls too), beyond its sides, and retired. */
void bw_coupler__count_mass(bw_coupler *c, double mass[3])
{
  const uint8_t *kind = bw_solid_kind(c->solid);
  const double of_one = bw_solid_settings(c->solid)->rho * bw_solid_volume(c->solid);
  double count[3] = {0};
  bw_solid_get_position(c->solid, c->X);
  /* Counted by the first group's particles of level 0: with one kind of them the three add up to
   * all particles to the last bit. */
  for (size_t i = 0; i < c->n; i++) {
    const bool out = !(kind[i] & BW_PD_PRESCRIBED) && is_beyond(c, i, c->X + 3 * i, false);
    const int where = kind[i] & BW_PD_RETIRED ? 2 : out ? 1 : 0;
    count[where] += bw_solid_density(c->solid, i) * bw_solid_volume_of(c->solid, i) / of_one;
  }
  bw_comm_sum(bw_solid_comm(c->solid), 3, count);
  for (int q = 0; q < 3; q++)
    mass[q] = of_one * count[q];
}
