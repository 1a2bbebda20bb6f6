/* bw_ns_channel.c -- the object: create, destroy, what it shows. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <math.h>

static bw_status metrics_create(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  bw_ns_metrics *m = &ns->metrics;
  const int h = 2, rows = g->m[1] + 2 * h; /* local j = 1-h .. m+h */
  double *heights = NULL;
  bw_real *reals = NULL;
  BW_TRY(BW_ALLOCATE(&heights, 2 * (size_t)rows));
  m->heights = heights;
  BW_TRY(BW_ALLOCATE(&reals, 4 * (size_t)rows));
  m->reals = reals;
  /* The pointers are shifted so that index j is the local row of cells, from 1 - h to m + h. */
  m->dyf = heights + (h - 1), m->dyc = m->dyf + rows;
  m->rdyf = reals + (h - 1), m->rdyc = m->rdyf + rows;
  m->below = m->rdyc + rows, m->above = m->below + rows;
  m->rdx = (bw_real)(1.0 / g->spacing[0]);
  m->rdz = (bw_real)(1.0 / g->spacing[2]);
  /* Heights of all local cells. Ghost cells get those of their mirror images, also beyond walls. */
  for (int j = 1 - h; j <= g->m[1] + h; j++) {
    const int n = g->n[1], at = j + g->lo[1];
    const int cell = at < 1 ? 1 - at : at > n ? 2 * n + 1 - at : at; /* ghosts mirror */
    m->dyf[j] = g->y_face[cell] - g->y_face[cell - 1];
  }
  /* Distances of centres and the two cells' shares in the volume about the face between them. */
  for (int j = 1 - h; j < g->m[1] + h; j++) {
    m->dyc[j] = 0.5 * (m->dyf[j] + m->dyf[j + 1]);
    m->below[j] = (bw_real)(0.5 * m->dyf[j] / m->dyc[j]);
    m->above[j] = (bw_real)(0.5 * m->dyf[j + 1] / m->dyc[j]);
    m->rdyf[j] = (bw_real)(1.0 / m->dyf[j]);
    m->rdyc[j] = (bw_real)(1.0 / m->dyc[j]);
  }
  m->rdyf[g->m[1] + h] = (bw_real)(1.0 / m->dyf[g->m[1] + h]);
  return BW_OK;
}

static bw_status poisson_create(bw_ns_channel *ns)
{
  bw_poisson_side kind[3];
  for (int d = 0; d < 3; d++)
    kind[d] = ns->g->periodic[d] ? BW_POISSON_PERIODIC : BW_POISSON_NEUMANN;
  const bw_poisson_side side[3][2] = {{kind[0], kind[0]}, {kind[1], kind[1]}, {kind[2], kind[2]}};
  return bw_poisson_create(ns->grid, side, &ns->poisson);
}

static bw_status increment_create(bw_ns_channel *ns)
{
  /* phi holds nothing between two projections, so the first increment may live there. */
  ns->increment[0] = ns->phi;
  for (int c = 1; c < ns->components; c++)
    BW_TRY(bw_field_create(ns->grid, &ns->increment[c]));
  return BW_ALLOCATE(&ns->lanes, (size_t)ns->g->n[0] * BW_NS_LANES);
}

static bw_status fields_create(bw_ns_channel *ns)
{
  for (int c = 0; c < ns->components; c++) {
    BW_TRY(bw_field_create(ns->grid, &ns->u[c]));
    BW_TRY(bw_field_create(ns->grid, &ns->R[c]));
  }
  BW_TRY(bw_field_create(ns->grid, &ns->p));
  BW_TRY(bw_field_create(ns->grid, &ns->phi));
  /* Only the factored scheme keeps u beside its change; all others overwrite u in place. */
  const bool all = ns->config.viscous == BW_VISCOUS_IMPLICIT;
  if (all) BW_TRY(increment_create(ns));
  /* The sweep sees arrays and numbers only; what a sub-step changes is filled in by predict. */
  ns->sweep = (bw_ns_sweep){.g = ns->g,
                            .metrics = &ns->metrics,
                            .u = ns->u,
                            .R = ns->R,
                            .p = ns->p,
                            .tile = bw_ns__momentum_tile(ns->g),
                            .nu = (bw_real)(all ? 0.0 : ns->config.nu),
                            .viscous = ns->config.viscous,
                            .change = all ? ns->increment : ns->u};
  /* The tile decides how many rows of fluxes are kept, so the scratch comes after it. */
  ns->scratch_size = bw_ns__momentum_scratch(&ns->sweep);
  BW_TRY(BW_ALLOCATE(&ns->scratch, ns->scratch_size));
  bw_ns__momentum_place(&ns->sweep, ns->scratch);
  ns->cost.bytes =
      sizeof(bw_real) *
      (ns->g->size * (size_t)((all ? 3 : 2) * ns->components + (all ? 1 : 2)) + ns->scratch_size);
  return BW_OK;
}

static bw_status lines_create(bw_ns_channel *ns)
{
  const bw_ns_viscous viscous = ns->config.viscous;
  for (int d = 0; d < ns->components; d++)
    if (viscous == BW_VISCOUS_IMPLICIT || (viscous == BW_VISCOUS_IMPLICIT_Y && d == 1))
      BW_TRY(bw_ns__lines_create(ns, d, &ns->lines[d]));
  return BW_OK;
}

static bw_status local_create(bw_ns_channel *ns)
{
  BW_TRY(metrics_create(ns));
  BW_TRY(fields_create(ns));
  BW_TRY(bw_ns__eddy_create(ns));
  return bw_ns__planes_create(ns);
}

bw_status bw_ns_channel_create(bw_grid *grid, const bw_ns_channel_config *config,
                               bw_ns_channel **out)
{
  *out = NULL;
  bw_ns_channel *ns = NULL;
  const bw_comm *comm = bw_grid_comm(grid);
  bw_status st = bw_ns__config_check(bw_grid_look(grid), config);
  BW_THEN(st, BW_ALLOCATE(&ns, 1));
  if (st == BW_OK) {
    ns->grid = grid, ns->g = bw_grid_look(grid), ns->comm = comm, ns->config = *config;
    ns->components = ns->g->n[2] == 1 ? 2 : 3;
    st = local_create(ns);
  }
  /* Up to here a rank may have failed alone; what follows is collective. */
  st = bw_comm_agree(comm, st);
  BW_THEN(st, bw_ns__inflow_create(ns)); /* before the pressure's solver: its own is gone by then */
  /* The step's limit needs the heights, which are known now on every rank. */
  if (st == BW_OK) {
    bw_ns__limits_create(ns);
    st = poisson_create(ns);
  }
  BW_THEN(st, lines_create(ns));
  st = bw_comm_agree(comm, st);
  /* Fluid at rest, with valid halos: the state that the header promises after create. */
  BW_THEN(st, bw_ns_channel_set_velocity(ns, NULL, NULL, 0.0));
  if (st != BW_OK) bw_ns_channel_destroy(&ns);
  *out = ns;
  return st;
}

void bw_ns_channel_destroy(bw_ns_channel **pointer)
{
  bw_ns_channel *ns = *pointer;
  if (ns == NULL) return;
  /* Every member may still be NULL: create calls this for an object that is half built. */
  bw_poisson_destroy(&ns->poisson);
  bw_ns__planes_destroy(ns);
  bw_ns__eddy_destroy(ns);
  bw_ns__sources_destroy(ns);
  for (int c = 0; c < 3; c++) {
    bw_release(&ns->u[c]);
    bw_release(&ns->R[c]);
    bw_ns__lines_destroy(&ns->lines[c]);
    if (c > 0) bw_release(&ns->increment[c]);
  }
  bw_release(&ns->lanes);
  bw_release(&ns->p);
  bw_release(&ns->phi);
  bw_release(&ns->scratch);
  bw_release(&ns->metrics.heights);
  bw_release(&ns->metrics.reals);
  bw_release(pointer);
}

bw_real *const *bw_ns_channel_velocity(bw_ns_channel *ns)
{
  return ns->u;
}

bw_real *bw_ns_channel_pressure(bw_ns_channel *ns)
{
  return ns->p;
}

const bw_real *bw_ns_channel_eddy_viscosity(const bw_ns_channel *ns)
{
  return ns->eddy.nu;
}

bw_grid *bw_ns_channel_grid(bw_ns_channel *ns)
{
  return ns->grid;
}

const bw_ns_channel_config *bw_ns_channel_settings(const bw_ns_channel *ns)
{
  return &ns->config;
}

double bw_ns_channel_time(const bw_ns_channel *ns)
{
  return ns->time;
}

void bw_ns_channel_set_time(bw_ns_channel *ns, double t)
{
  ns->time = t;
}

double bw_ns_channel_driving(const bw_ns_channel *ns)
{
  return ns->applied;
}

double bw_ns_channel_gradient(const bw_ns_channel *ns)
{
  return ns->gradient;
}

void bw_ns_channel_set_gradient(bw_ns_channel *ns, double gradient)
{
  ns->gradient = gradient;
  ns->impulsive = false;
}

void bw_ns_channel_set_forcing(bw_ns_channel *ns, double value)
{
  ns->config.forcing_value = value;
}

bw_ns_cost bw_ns_channel_cost(const bw_ns_channel *ns)
{
  return ns->cost;
}

void bw_ns_channel_cost_reset(bw_ns_channel *ns)
{
  ns->cost = (bw_ns_cost){.bytes = ns->cost.bytes};
}
