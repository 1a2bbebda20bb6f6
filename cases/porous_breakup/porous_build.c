/* The objects of a run of the porous medium, and its phases. */
#include "bw_memory.h"
#include "porous_case.h"

#include <math.h>
#include <string.h>

/* The medium's length as built: planes of sites across the stream. Where medium.length is whole
 * spacings it is that. Collective. */
static void measure_length(porous_run *p, int64_t n, const int32_t site[])
{
  const porous_medium *m = &p->config->medium;
  const double ds = p->config->domain.length[1] / p->config->domain.cells[1];
  /* Without a slab, which has every plane: centres between front and back. */
  double first = ceil(m->front / ds - 0.5), last = floor((m->front + m->length) / ds - 0.5);
  if (porous_clamps(m) != 0) {
    first = HUGE_VAL, last = -HUGE_VAL;
    for (int64_t k = 0; k < n; k++) {
      if (site[3 * k + 1] >= 0 && site[3 * k + 1] < p->config->domain.cells[1]) continue;
      first = fmin(first, site[3 * k]), last = fmax(last, site[3 * k]);
    }
    /* Each rank has its part of the sites. */
    bw_comm_min(p->comm, 1, &first);
    bw_comm_max(p->comm, 1, &last);
  }
  p->length = (last - first + 1.0) * ds;
  if (fabs(p->length / m->length - 1.0) < 1e-9)
    p->length = m->length;
  else
    bw_log_warn(bw_case_log(p->run),
                "medium.length = %g m is no whole number of particles of %g m: the medium is built "
                "%g m long, and porosity and permeability are those of that length",
                m->length, ds, p->length);
}

bw_grid_config porous_grid(const porous_config *q)
{
  bw_grid_config grid = bw_grid_config_default();
  memcpy(grid.n, q->domain.cells, sizeof grid.n);
  memcpy(grid.length, q->domain.length, sizeof grid.length);
  /* Markers and probes need a halo of two. */
  grid.periodic[2] = true;
  grid.halo = 2;
  return grid;
}

bw_ns_channel_config porous_fluid_of(const porous_config *q)
{
  /* Laminar inflow, convective outflow, walls in y by default. */
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  flow.nu = q->fluid.viscosity;
  flow.side[0][0] = (bw_ns_side){.kind = BW_SIDE_INFLOW,
                                 .profile = BW_PROFILE_POISEUILLE,
                                 .bulk_velocity = q->fluid.bulk_velocity};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
  return flow;
}

static bw_status build_fluid(porous_run *p)
{
  const bw_grid_config grid = porous_grid(p->config);
  const bw_ns_channel_config flow = porous_fluid_of(p->config);
  BW_TRY(bw_grid_create(p->comm, &grid, &p->grid));
  return bw_ns_channel_create(p->grid, &flow, &p->fluid);
}

static bw_status build_solid(porous_run *p)
{
  const porous_config *q = p->config;
  bw_solid_config solid = bw_solid_config_default();
  /* Particles at the fluid's spacing: ds = dx (ERRATA 17). */
  solid.ds = q->domain.length[1] / q->domain.cells[1];
  solid.horizon_ratio = q->solid.horizon_ratio;
  solid.rho = q->solid.density;
  solid.E = q->solid.young_modulus;
  solid.G0 = q->solid.fracture_energy;
  solid.surface_correction = (bw_pd_surface_correction)q->solid.surface_correction;
  solid.integrator = (bw_solid_integrator)q->solid.integrator;
  solid.damping.pair = q->solid.damping_pair;
  solid.contact = q->solid.contact;
  /* Bonds cross the periodic seam as the fluid does. */
  solid.period[2] = q->domain.length[2];
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = porous_medium_sites(p->comm, q, p->run, &n, &site, &kind);
  if (st == BW_OK) measure_length(p, n, site);
  /* Each rank gives its part; the solid brings every particle to the rank that owns it. */
  BW_THEN(st, bw_solid_create(p->comm, &solid, &(bw_pd_sites){n, site, kind, NULL}, &p->solid));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static bw_status build_coupler(porous_run *p)
{
  const porous_config *q = p->config;
  bw_coupler_config c = q->coupling;
  c.rho = q->fluid.density;
  c.nu = q->fluid.viscosity;
  c.count_work = c.check_relaxation = true;
  c.walled[1][0] = c.walled[1][1] = true;
  return bw_coupler_create(&c, p->fluid, p->solid, &p->coupler);
}

/* What the phase allows the solid to do. */
void porous_enter_phase(porous_run *p)
{
  const porous_phase *f = porous_phase_of(p->config, p->phase);
  bw_coupler_hold_solid(p->coupler, p->phase == PHASE_FLOW);
  bw_solid_enable_breakage(p->solid, p->phase == PHASE_BREAKAGE);
  bw_solid_set_damping(p->solid, p->config->solid.damping_pair, 0.0,
                       f->settling_rate * p->config->solid.density);
}

static void uniform_stream(const double x[3], double t, void *context, double u[3])
{
  const porous_config *q = context;
  (void)x, (void)t;
  u[0] = q->fluid.bulk_velocity;
  u[1] = u[2] = 0.0;
}

/* Momentum balance over the whole height and span, two cells clear of the medium. */
static bw_status watch_medium(porous_run *p)
{
  const porous_config *q = p->config;
  const double h = q->domain.length[0] / q->domain.cells[0];
  const int first = (int)floor(q->medium.front / h + 0.5), clear = 2;
  const int last = (int)floor((q->medium.front + q->medium.length) / h + 0.5);
  const int n = q->domain.cells[0];
  /* Two cells clear of the medium, where markers spread nothing. */
  const int lo[3] = {first - clear > 0 ? first - clear : 0, 0, 0};
  const int hi[3] = {last + clear < n ? last + clear : n, q->domain.cells[1], q->domain.cells[2]};
  return bw_ns_channel_watch_box(p->fluid, lo, hi);
}

bw_status porous_build(porous_run *p)
{
  /* Refused before anything is allocated. */
  BW_TRY(porous_check(p->config));
  BW_TRY(build_fluid(p));
  BW_TRY(build_solid(p));
  BW_TRY(build_coupler(p));
  BW_TRY(watch_medium(p));
  /* The flow begins uniform; the first phase waits until it has settled. */
  return bw_ns_channel_set_velocity(p->fluid, uniform_stream, (void *)(uintptr_t)p->config, 0.0);
}

void porous_destroy(porous_run *p)
{
  bw_coupler_destroy(&p->coupler);
  bw_solid_destroy(&p->solid);
  bw_ns_channel_destroy(&p->fluid);
  bw_grid_destroy(&p->grid);
}
