/* What films between particles are to the grid: slits that it does not see through.
 *
 * The velocity along a film is braked to that of its faces, on the faces of cells in and beside the
 * gap, in every sub-step, before and after the markers,
 *   du/dt = -r (I - n n)(u - V),   V the mean of both faces' velocities, n across,
 *   r = 12 nu/h^2 b/(1 - b),
 * which leaves 1 - b of what would flow in a slit, b the share of the network (bw_film_net.h):
 * all of it at the limit, nothing below five sixths of that. Across it stays free: there the
 * markers of the faces ask for their velocity. The share b flows in the film, by the cubic law. It
 * leaves the grid where the film takes it and enters where it comes out,
 *   div u = (volume that the film of the step before has brought)/(dt dV),
 * out at the edges a cell in front of them, inside in the middle of the gap: what both faces
 * squeeze out goes into the film there. All of it adds up to nothing. The force of the brake is put
 * on both faces, half on each (a load by the reaction has it, probes see their own). */
#include "bw_memory.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

/* How far beyond the faces, in cells: the markers on either side of a mouth leave that much. */
static const double BESIDE = 0.75;
/* How far from its node along the film, in cells or spacings: tiles meet. */
static const double ALONG = 0.75;
/* How far in front of an edge the film comes out, in cells: beyond the markers' own. */
static const double OUTSIDE = 1.0;

/* Where the fluid of node a is. */
static void middle_of(const bw_coupler__solid_films *f, size_t a, double x[3])
{
  const bw_film_node *node = f->node + a;
  for (size_t d = 0; d < 3; d++)
    x[d] =
        f->X[3 * (size_t)node->point + d] + (f->H[node->point] + 0.5 * node->gap) * node->normal[d];
}

/* ---- the brake ---- */

static bw_status make_braked(bw_coupler__solid_films *f)
{
  if (f->n_braked < f->room_braked) return BW_OK;
  const size_t room = 2 * f->n_braked + 256;
  BW_TRY(BW_ENLARGE(&f->braked, f->n_braked, room));
  f->room_braked = room;
  return BW_OK;
}

/* The face of component d at `at`, r from the middle of node a: braked, if it is near; by the
 * nearest node where several are. */
static bw_status take(bw_coupler__solid_films *f, size_t a, double along, double h, int d,
                      ptrdiff_t at, const double r[3])
{
  const double *n = f->node[a].normal, *x = r;
  const double across = x[0] * n[0] + x[1] * n[1] + x[2] * n[2];
  const double away = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  int32_t *known = &f->braked_at[d][at];
  if (fabs(across) > 0.5 * f->node[a].gap + BESIDE * h) return BW_OK;
  if (away - across * across > along * along) return BW_OK;
  if (*known < 0) {
    BW_TRY(make_braked(f));
    *known = (int32_t)f->n_braked;
    f->braked[f->n_braked++] = (bw_coupler__braked){.at = at, .d = d, .away = HUGE_VAL};
  }
  bw_coupler__braked *b = f->braked + *known;
  if (away < b->away) b->away = away, b->node = (int32_t)a;
  return BW_OK;
}

/* Global cells lo .. hi within `far` of x along d; of a direction with one cell that. */
static void range_of(const bw_grid_view *g, int d, double x, double far, int range[2])
{
  range[0] = g->n[d] == 1 ? 1 : (int)floor((x - far) / g->spacing[d]);
  range[1] = g->n[d] == 1 ? 1 : (int)ceil((x + far) / g->spacing[d]) + 1;
}

/* Local number of the global cell i (from 1) along d, 0 where this rank does not have it. */
static int local_of(const bw_grid_view *g, int d, int i)
{
  if (g->periodic[d]) i = ((i - 1) % g->n[d] + g->n[d]) % g->n[d] + 1;
  const int here = i - g->lo[d];
  return here >= 1 && here <= g->m[d] ? here : 0;
}

/* The faces that node a brakes. */
static bw_status brake_node(bw_coupler *c, size_t a)
{
  bw_coupler__solid_films *f = c->films;
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const double along = ALONG * fmax(c->h, bw_solid_settings(c->solid)->ds);
  const double far = hypot(0.5 * f->node[a].gap + BESIDE * c->h, along);
  double x[3], r[3];
  int range[3][2];
  middle_of(f, a, x);
  for (int d = 0; d < 3; d++)
    range_of(g, d, x[d], far, range[d]);
  for (int k = range[2][0]; k <= range[2][1]; k++)
    for (int j = range[1][0]; j <= range[1][1]; j++)
      for (int i = range[0][0]; i <= range[0][1]; i++) {
        const int global[3] = {i, j, k};
        int here[3];
        for (int d = 0; d < 3; d++)
          here[d] = local_of(g, d, global[d]);
        if (here[0] == 0 || here[1] == 0 || here[2] == 0) continue;
        for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++) {
          /* Component d is on the upper face of the cell. */
          for (int e = 0; e < 3; e++)
            r[e] = g->n[e] == 1 ? 0.0 : (global[e] - (e == d ? 0.0 : 0.5)) * g->spacing[e] - x[e];
          BW_TRY(take(f, a, along, c->h, d, bw_at(g, here[0], here[1], here[2]), r));
        }
      }
  return BW_OK;
}

static void forget_braked(bw_coupler__solid_films *f)
{
  for (size_t q = 0; q < f->n_braked; q++)
    f->braked_at[f->braked[q].d][f->braked[q].at] = -1;
  f->n_braked = 0;
}

/* Which faces of this rank's cells are braked by which node. */
static bw_status find_braked(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  forget_braked(f);
  for (size_t a = 0; a < f->n_nodes; a++)
    BW_TRY(brake_node(c, a));
  return BW_OK;
}

/* u of component e where component d has its points at `at`. */
static double beside(const bw_grid_view *g, bw_real *const u[3], int e, int d, ptrdiff_t at)
{
  if (e == d) return (double)u[d][at];
  const ptrdiff_t up = g->stride[d], down = g->stride[e];
  return 0.25 * ((double)u[e][at] + (double)u[e][at + up] + (double)u[e][at - down] +
                 (double)u[e][at + up - down]);
}

/* Part of a velocity that the brake of a node takes in the time t, implicit. */
static double taken(const bw_coupler *c, const bw_film_node *node, double t)
{
  const double rate = 12.0 * c->config.nu / (node->gap * node->gap) * node->share * t;
  return rate / (rate + 1.0 - node->share);
}

static void renew_halos(bw_coupler *c)
{
  bw_grid *grid = bw_ns_channel_grid(c->fluid);
  bw_halo_update(grid, bw_grid_look(grid)->n[2] == 1 ? 2 : 3, bw_ns_channel_velocity(c->fluid));
  bw_ns_channel_ghosts(c->fluid);
}

void bw_coupler__solid_films_brake(bw_coupler *c, double dt, bool after)
{
  enum { TIMES = 6 }; /* in a step */
  bw_coupler__solid_films *f = c->films;
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  const int components = g->n[2] == 1 ? 2 : 3;
  const double mass = c->config.rho * g->spacing[0] * g->spacing[1] * g->spacing[2];
  if (!bw_coupler__solid_films_flow(c)) return;
  /* Markers have changed u on all ranks; before them they will read what is changed here. */
  if (after) renew_halos(c);
  for (size_t q = 0; q < f->n_braked; q++) {
    bw_coupler__braked *b = f->braked + q;
    const double *n = f->node[b->node].normal, *V = f->told + 3 * (ptrdiff_t)b->node;
    double across = 0.0;
    for (int e = 0; e < components; e++)
      across += n[e] * (beside(g, u, e, b->d, b->at) - V[e]);
    b->change = taken(c, f->node + b->node, dt / TIMES) *
                (across * n[b->d] - ((double)u[b->d][b->at] - V[b->d]));
  }
  for (size_t q = 0; q < f->n_braked; q++) {
    const bw_coupler__braked *b = f->braked + q;
    const double force = -mass * b->change / dt;
    u[b->d][b->at] += (bw_real)b->change;
    f->brake[3 * b->node + b->d] += force;
    c->work.given += dt * force * f->told[3 * b->node + b->d];
  }
  if (!after) renew_halos(c);
}

void bw_coupler__solid_films_bear(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  memset(f->L, 0, 3 * f->n * sizeof *f->L);
  bw_comm_sum(bw_solid_comm(c->solid), 3 * f->n_nodes, f->brake);
  bw_film_net_give(f->net, f->brake, f->L);
  for (size_t u = 0; u < f->n_used; u++) {
    const int32_t s = f->used[u];
    if (!bw_coupler__film_own(f, s)) continue;
    for (ptrdiff_t d = 0; d < 3; d++)
      c->load[3 * f->list[s].particle + d] += f->L[3 * s + d];
  }
}

/* ---- what the film brings ---- */

/* Adds `volume` at x to the sources, shared by the cells around; those of this rank alone. */
static void pour(bw_coupler__solid_films *f, const bw_grid_view *g, const double x[3], double rate)
{
  int low[3] = {1, 1, 1};
  double part[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < 3; d++) {
    if (g->n[d] == 1) continue;
    const double s = x[d] / g->spacing[d] + 0.5;
    low[d] = (int)floor(s), part[d] = s - floor(s);
  }
  for (int corner = 0; corner < 8; corner++) {
    double weight = 1.0;
    int here[3];
    for (int d = 0; d < 3; d++) {
      const int up = corner >> d & 1;
      int global = low[d] + up;
      weight *= up ? part[d] : 1.0 - part[d];
      /* Beyond a side there is no cell: the one before it. */
      if (!g->periodic[d]) global = global < 1 ? 1 : global > g->n[d] ? g->n[d] : global;
      here[d] = local_of(g, d, global);
    }
    if (weight == 0.0 || here[0] == 0 || here[1] == 0 || here[2] == 0) continue;
    f->source_cell[f->n_sources] = bw_at(g, here[0], here[1], here[2]);
    f->source_rate[f->n_sources++] = weight * rate;
  }
}

/* Where what comes to point s is on the grid: in the middle of a slit, or in front of its edge. */
static void outlet_of(const bw_coupler *c, size_t s, const int32_t node_of[], double x[3])
{
  const bw_coupler__solid_films *f = c->films;
  if (node_of[s] >= 0) {
    middle_of(f, (size_t)node_of[s], x);
    return;
  }
  for (size_t d = 0; d < 3; d++)
    x[d] = f->X[3 * s + d] + (f->H[s] + OUTSIDE * c->h) * f->N[3 * s + d];
}

/* Volumes of all points, from the ranks that have them. What has left the surface since is missing:
 * the others bear it, so that all of it adds up to nothing. */
static void gather_moved(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  double sum = 0.0, size = 0.0;
  for (size_t s = 0; s < f->n; s++)
    f->moved[s] = bw_coupler__film_own(f, (int32_t)s) ? f->carried[f->list[s].particle] : 0.0;
  bw_comm_sum(bw_solid_comm(c->solid), f->n, f->moved);
  for (size_t s = 0; s < f->n; s++)
    sum += f->moved[s], size += fabs(f->moved[s]);
  for (size_t s = 0; s < f->n && size > 0.0; s++)
    f->moved[s] -= sum * fabs(f->moved[s]) / size;
}

static bw_status set_sources(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const double volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  gather_moved(c);
  for (size_t s = 0; s < f->n; s++)
    f->point_node[s] = -1;
  for (size_t a = 0; a < f->n_nodes; a++)
    f->point_node[f->node[a].point] = (int32_t)a;
  f->n_sources = 0;
  for (size_t s = 0; s < f->n; s++) {
    double x[3];
    if (f->moved[s] == 0.0) continue;
    outlet_of(c, s, f->point_node, x);
    pour(f, g, x, f->moved[s] / (volume * dt));
  }
  return bw_ns_channel_set_sources(c->fluid, f->n_sources, f->source_cell, f->source_rate);
}

/* Films that answer faster than a fluid does: see bw_coupler_films.h. */
static bw_status check_step(const bw_coupler *c, double dt)
{
  static const double MOST = 25.0; /* cells; 28 hold, 44 do not, in slits of 4 and 40 cells */
  const bw_coupler__solid_films *f = c->films;
  for (size_t a = 0; a < f->n_nodes; a++) {
    const double h = f->node[a].gap;
    const double cells = f->node[a].share * h * h * h / (12.0 * c->config.nu * dt * c->h);
    BW_REQUIRE(
        cells <= MOST, BW_EINPUT,
        "films: what flows in a gap of %g takes %g to answer the pressure, %.3g steps of %g, "
        "and films.flux has it answer at once, which this step does not bear: leave "
        "films.flux out, or take longer steps or a smaller films.limit",
        h, h * h / (12.0 * c->config.nu), h * h / (12.0 * c->config.nu * dt), dt);
  }
  return BW_OK;
}

bw_status bw_coupler__solid_films_open(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  const bw_comm *comm = bw_solid_comm(c->solid);
  BW_TRY(check_step(c, dt));
  memset(f->brake, 0, 3 * f->n_nodes * sizeof *f->brake);
  /* V of the faces, as markers are told it: that of the beginning of the step. */
  bw_solid_get_velocity(c->solid, f->v);
  bw_coupler__solid_films_tell(c, f->v);
  bw_film_net_mean(f->net, f->V, f->told);
  /* A solid that is held has no film of a step before. */
  if (c->held) memset(f->carried, 0, c->n * sizeof *f->carried);
  bw_status st = find_braked(c);
  BW_THEN(st, set_sources(c, dt));
  return bw_comm_agree(comm, st);
}

void bw_coupler__solid_films_bring(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  memset(f->moved, 0, f->n * sizeof *f->moved);
  bw_film_net_bring(f->net, dt, f->moved);
  for (size_t s = 0; s < f->n; s++)
    if (bw_coupler__film_own(f, (int32_t)s)) f->carried[f->list[s].particle] += f->moved[s];
}

double *bw_coupler__solid_films_carried(const bw_coupler *c)
{
  return c->films == NULL ? NULL : c->films->carried;
}

bw_status bw_coupler__solid_films_grid_create(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++) {
    BW_TRY(BW_ALLOCATE(&f->braked_at[d], g->size));
    for (size_t q = 0; q < g->size; q++)
      f->braked_at[d][q] = -1;
  }
  return BW_OK;
}

void bw_coupler__solid_films_grid_release(bw_coupler__solid_films *f)
{
  for (int d = 0; d < 3; d++)
    bw_release(&f->braked_at[d]);
  bw_release(&f->braked);
}
