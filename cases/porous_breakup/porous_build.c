/* The objects of a run of the porous medium, its phases, and what --check prints. */
#include "bw_memory.h"
#include "porous_case.h"

#include <math.h>
#include <string.h>

static bw_status check_combinations(const porous_config *q)
{
  const porous_domain *d = &q->domain;
  const double h = d->length[1] / d->cells[1];
  for (int k = 0; k < 3; k += 2)
    BW_REQUIRE(fabs(d->length[k] / d->cells[k] / h - 1.0) < 1e-9, BW_EINPUT,
               "domain.cells[%d] = %d: cells must be cubes, %g would give the spacing %g m of y", k,
               d->cells[k], d->length[k] / h, h);
  BW_REQUIRE(q->medium.front + q->medium.length < d->length[0], BW_EINPUT,
             "medium.front + medium.length = %g m reaches the outflow at domain.length[0] = %g m",
             q->medium.front + q->medium.length, d->length[0]);
  /* Softer than this even the stream's own pressure would squeeze the solid to nothing. */
  static const double softest = 1e-3;
  const double U = q->fluid.bulk_velocity;
  const double groups = q->solid.young_modulus / (q->fluid.density * U * U);
  BW_REQUIRE(
      groups >= softest, BW_EINPUT,
      "solid.young_modulus = %g Pa is %.3g of the stream's dynamic pressure rho U_b^2 = %g Pa; "
      "at least %g",
      q->solid.young_modulus, groups, q->fluid.density * U * U, softest);
  return BW_OK;
}

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

static bw_status build_fluid(porous_run *p)
{
  const porous_config *q = p->config;
  bw_grid_config grid = bw_grid_config_default();
  memcpy(grid.n, q->domain.cells, sizeof grid.n);
  memcpy(grid.length, q->domain.length, sizeof grid.length);
  /* Markers and probes need a halo of two. */
  grid.periodic[2] = true;
  grid.halo = 2;
  BW_TRY(bw_grid_create(p->comm, &grid, &p->grid));

  /* Laminar inflow, convective outflow, walls in y by default. */
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  flow.nu = q->fluid.viscosity;
  flow.side[0][0] = (bw_ns_side){.kind = BW_SIDE_INFLOW,
                                 .profile = BW_PROFILE_POISEUILLE,
                                 .bulk_velocity = q->fluid.bulk_velocity};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
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
  solid.damping_pair = q->solid.damping_pair;
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
  c.count_work = true;
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
  BW_TRY(check_combinations(p->config));
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

/* Memory as it stands after building; time from nominal costs (the benches' on a quiet machine). */
static bw_status describe_cost(porous_run *p)
{
  static const double fluid_ns = 45.0, bond_ns = 1.8; /* core-ns: cell and sub-step, bond */
  const int *n = p->config->domain.cells;
  const double cells = (double)n[0] * n[1] * n[2];
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  const double bonds = 2.0 * (double)e.bonds;
  double bytes = (double)bw_memory_resident(), seconds = 0.0;
  bw_comm_sum(p->comm, 1, &bytes);
  /* Sub-steps of the solid dominate. */
  for (int k = 0; k < PHASE_COUNT; k++) {
    const porous_phase *f = porous_phase_of(p->config, k);
    const int substeps = k == PHASE_FLOW ? 0 : bw_coupler_substeps(p->coupler, f->time_step);
    seconds += 1e-9 * f->steps * (3.0 * cells * fluid_ns + substeps * bonds * bond_ns);
  }
  bw_log_info(bw_case_log(p->run),
              "cost       %.0f MiB over all ranks; at most about %.1f min on as many quiet cores",
              bytes / 1048576.0, seconds / 60.0 / bw_comm_size(p->comm));
  return BW_OK;
}

/* What the stream does to the solid has to be more than rounding does. */
static bw_status check_strain(const porous_config *q)
{
  static const double least = 1e-15; /* of positions in a channel of length 1: 2^-53 is 1.1e-16 */
  const double h = q->domain.length[1] / q->domain.cells[1], U = q->fluid.bulk_velocity;
  const double stress = q->fluid.density * U * (U + q->fluid.viscosity / h);
  BW_REQUIRE(
      stress / q->solid.young_modulus >= least, BW_EINPUT,
      "solid.young_modulus = %g Pa: the stream's stress, rho U_b (U_b + nu/h) = %g Pa, strains "
      "it by %.3g, which rounding hides; at least %g",
      q->solid.young_modulus, stress, stress / q->solid.young_modulus, least);
  return BW_OK;
}

bw_status porous_describe(porous_run *p)
{
  const porous_config *q = p->config;
  bw_log *log = bw_case_log(p->run);
  const double h = q->domain.length[1], U = q->fluid.bulk_velocity, rho = q->fluid.density;
  const int walls = porous_clamps(&q->medium);
  const double clamped = ((walls & CLAMP_FLOOR ? 1.0 : 0.0) + (walls & CLAMP_CEILING ? 1.0 : 0.0)) *
                         (double)q->medium.clamped_layers *
                         round(p->length / q->domain.length[1] * q->domain.cells[1]) *
                         q->domain.cells[2];
  const int64_t total = bw_solid_total(p->solid);
  /* Sizes. */
  bw_log_info(log, "channel    %d x %d x %d cells, spacing %g m, %d ranks", q->domain.cells[0],
              q->domain.cells[1], q->domain.cells[2], h / q->domain.cells[1],
              bw_comm_size(p->comm));
  /* Then the groups that the physics depends on, and each phase's step against its limit. */
  bw_log_info(log,
              "medium     %lld particles in the channel, %lld with the clamped layers; "
              "horizon/spacing %g",
              (long long)(total - (int64_t)clamped), (long long)total, q->solid.horizon_ratio);
  bw_log_info(log,
              "groups     Re_b = %g, E* = E/(rho U_b^2) = %g, density ratio %g, Cauchy number %g, "
              "s0 = %.4e",
              U * h / q->fluid.viscosity, q->solid.young_modulus / (rho * U * U),
              q->solid.density / rho, rho * U * U / q->solid.young_modulus,
              bw_solid_critical_stretch(p->solid));
  const double fluid_max = bw_ns_channel_dt_max(p->fluid), solid_max = bw_solid_dt_max(p->solid);
  for (int k = 0; k < PHASE_COUNT; k++) {
    const porous_phase *f = porous_phase_of(q, k);
    if (k != PHASE_FLOW) BW_TRY(bw_coupler_check_substeps(p->coupler, f->time_step));
    bw_log_info(log,
                "phase %d    %-11s %d steps of %g s: %.2f of the fluid's limit, %s%d solid "
                "sub-steps each",
                k + 1, porous_phase_name[k], f->steps, f->time_step, f->time_step / fluid_max,
                k == PHASE_FLOW ? "no solid; else " : "",
                bw_coupler_substeps(p->coupler, f->time_step));
  }
  BW_TRY(check_strain(q));
  bw_log_info(log, "solid      stable to %.4g s per sub-step", solid_max);
  return describe_cost(p);
}
