/* What of a run can be known before it is built: what is refused, sizes, limits, memory, time. */
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "porous_case.h"

#include <math.h>
#include <string.h>

bw_status porous_check(const porous_config *q)
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

/* ---- a small run of the same kind ----
 * Cells, particles, material, coupling and stream are those of the case; the channel is as small as
 * cubes of pores allow. What it costs per cell and particle the case costs, too. */
enum { EDGE = 24, BESIDE = 6, FEW = 4 * EDGE * EDGE * EDGE };

static double cells_of(const porous_config *q)
{
  return (double)q->domain.cells[0] * q->domain.cells[1] * q->domain.cells[2];
}

/* A case that is small itself is its own. */
static porous_config small_of(const porous_config *q)
{
  porous_config s = *q;
  const double h = q->domain.length[1] / q->domain.cells[1];
  if (cells_of(q) <= FEW) return s;
  const int cells[3] = {EDGE + 2 * BESIDE, EDGE, EDGE};
  for (int d = 0; d < 3; d++)
    s.domain.cells[d] = cells[d], s.domain.length[d] = cells[d] * h;
  s.medium.has_image = s.medium.has_surface = s.medium.has_random = false;
  s.medium.lattice = BW_SHAPE_PORES_SC;
  s.medium.front = BESIDE * h;
  s.medium.length = s.medium.pitch = EDGE * h;
  /* Pores that just join. */
  s.medium.radius_over_pitch = 0.55;
  for (int d = 0; d < 3; d++)
    s.medium.offset[d] = 0.5;
  return s;
}

/* What is known of the case from its small run and its medium. */
typedef struct {
  double particles, clamped; /* in the channel; behind its walls */
  bool exact;                /* are the particles counted? */
  double bytes, fluid_bytes; /* of a rank; of its fluid alone */
  double porosity;           /* of the medium */
  double fluid_max;          /* no flow through the medium bears a longer step [s] */
  double bonds;              /* from both ends */
} porous_estimate;

/* Memory of a rank. That of the fluid is known; `held` is what the small run holds after its first
 * step: beside its own fluid, fields of the coupler and of the last good state (two and four), and
 * what grows with the particles. Added is the larger of a checkpoint on its way and of what the
 * measurement of the load's relaxation takes. */
static bw_status weigh(const porous_run *small, const porous_config *q, int ranks, double held,
                       porous_estimate *e)
{
  const bw_ns_channel_config flow = porous_fluid_of(small->config);
  const double share = cells_of(q) / cells_of(small->config) / ranks;
  const double n = (double)bw_solid_total(small->solid), all = e->particles + e->clamped;
  const double row = 8.0 * (double)bw_solid_restart_row(small->solid);
  const double fields = 6.0 * sizeof(bw_real) * (double)bw_grid_look(small->grid)->size;
  bw_ns_plan own;
  bw_solid_ledger ledger;
  BW_TRY(bw_ns_channel_plan(small->grid, &flow, &own));
  BW_TRY(bw_solid_account(small->solid, &ledger));
  const double particles = fmax(0.0, held - own.bytes - fields) / n;
  const double rows = bw_checkpoint_table_bytes(all / ranks, row);
  const double field = cells_of(q) / ranks * (double)sizeof(bw_real);
  const double checkpoint = bw_checkpoint_file_bytes() + fmax(rows, field);
  const double limit =
      4.0 / 6.0 * share * fields + all / ranks / n * bw_coupler_limit_bytes(small->coupler);
  e->bytes = e->fluid_bytes + share * fields + all / ranks * particles + fmax(checkpoint, limit);
  e->bonds = 2.0 * (double)ledger.bonds / n * all;
  return BW_OK;
}

/* Buffers grow in the first step and when it is measured; a short one changes nothing else that is
 * asked here. The last good state is kept from the start on. */
static bw_status first_step(porous_run *small)
{
  static const double brief = 1e-3;
  double row[COL_COUNT];
  BW_TRY(bw_coupler_step(small->coupler, brief * bw_ns_channel_dt_max(small->fluid)));
  BW_TRY(porous_measure(small, row));
  return bw_coupler_keep(small->coupler);
}

/* The stream is squeezed into the pores: somewhere it is at least so fast as their share says. */
static void bound_step(const porous_run *small, const porous_config *q, porous_estimate *e)
{
  static const double convective = 1.7320508; /* of bw_ns_channel_dt_max */
  const double h = q->domain.length[1] / q->domain.cells[1];
  const double volume = q->medium.length * q->domain.length[1] * q->domain.length[2];
  e->porosity = fmax(1e-3, 1.0 - e->particles * h * h * h / volume);
  const double pores = convective * h * e->porosity / q->fluid.bulk_velocity;
  e->fluid_max = fmin(bw_ns_channel_dt_max(small->fluid), pores);
}

/* A step that the stream alone does not bear is not begun with. */
static bw_status check_steps(const porous_run *p, porous_run *small, const porous_estimate *e)
{
  static const double most = 1e6; /* rates of damping per step that stiffness bears */
  const double stable = bw_solid_dt_max(small->solid);
  for (int k = 0; k < PHASE_COUNT; k++) {
    const porous_phase *f = porous_phase_of(p->config, k);
    BW_REQUIRE(f->settling_rate * stable <= most, BW_EINPUT,
               "%s.settling_rate = %g 1/s is %.3g per stable step of the solid, %g s: at most %g, "
               "beyond which nothing moves; take less",
               porous_phase_name[k], f->settling_rate, f->settling_rate * stable, stable, most);
    /* Damping of the phase shortens its sub-steps. */
    small->phase = k;
    porous_enter_phase(small);
    if (k != PHASE_FLOW) BW_TRY(bw_coupler_check_substeps(small->coupler, f->time_step));
    BW_REQUIRE(f->steps == 0 || f->time_step <= e->fluid_max * (1.0 + 1e-12), BW_EINPUT,
               "%s.time_step = %g s is over the fluid's limit: the stream of fluid.bulk_velocity = "
               "%g m/s through a porosity of %.2f bears %.3g s at most; take a shorter step",
               porous_phase_name[k], f->time_step, p->config->fluid.bulk_velocity, e->porosity,
               e->fluid_max);
  }
  small->phase = PHASE_FLOW;
  porous_enter_phase(small);
  return BW_OK;
}

/* Time from nominal costs (the benches' on a quiet machine). */
static void describe_cost(const porous_run *p, const porous_run *small, const porous_estimate *e)
{
  static const double fluid_ns = 45.0, bond_ns = 1.8; /* core-ns: cell and sub-step, bond */
  const int ranks = bw_comm_size(p->comm);
  double seconds = 0.0;
  /* Sub-steps of the solid dominate. */
  for (int k = 0; k < PHASE_COUNT; k++) {
    const porous_phase *f = porous_phase_of(p->config, k);
    const int passes = k == PHASE_FLOW ? 0 : p->config->coupling.predictor ? 2 : 1;
    const int substeps = passes * bw_coupler_substeps(small->coupler, f->time_step);
    seconds += 1e-9 * f->steps *
               (3.0 * cells_of(p->config) * fluid_ns + (double)substeps * e->bonds * bond_ns);
  }
  bw_log_info(
      bw_case_log(p->run),
      "cost       about %.3g MiB for each of %d ranks; at most about %.1f min on as many quiet "
      "cores",
      e->bytes / 1048576.0, ranks, seconds / 60.0 / ranks);
}

static void describe(const porous_run *p, const porous_run *small, const porous_estimate *e)
{
  const porous_config *q = p->config;
  bw_log *log = bw_case_log(p->run);
  const double h = q->domain.length[1], U = q->fluid.bulk_velocity, rho = q->fluid.density;
  bw_log_info(log, "channel    %d x %d x %d cells, spacing %g m, %d ranks", q->domain.cells[0],
              q->domain.cells[1], q->domain.cells[2], h / q->domain.cells[1],
              bw_comm_size(p->comm));
  bw_log_info(log,
              "medium     %s%.0f particles in the channel, %.0f with the clamped layers, porosity "
              "%.3f; horizon/spacing %g",
              e->exact ? "" : "about ", e->particles, e->particles + e->clamped, e->porosity,
              q->solid.horizon_ratio);
  /* The groups that the physics depends on, and each phase's step against its limit. */
  bw_log_info(log,
              "groups     Re_b = %g, E* = E/(rho U_b^2) = %g, density ratio %g, Cauchy number %g, "
              "s0 = %.4e",
              U * h / q->fluid.viscosity, q->solid.young_modulus / (rho * U * U),
              q->solid.density / rho, rho * U * U / q->solid.young_modulus,
              bw_solid_critical_stretch(small->solid));
  for (int k = 0; k < PHASE_COUNT; k++) {
    const porous_phase *f = porous_phase_of(q, k);
    bw_log_info(log,
                "phase %d    %-11s %d steps of %g s: %.2f of what the stream bears at most, %s%d "
                "solid sub-steps each",
                k + 1, porous_phase_name[k], f->steps, f->time_step, f->time_step / e->fluid_max,
                k == PHASE_FLOW ? "no solid; else " : "",
                bw_coupler_substeps(small->coupler, f->time_step));
  }
  bw_log_info(log, "solid      stable to about %.4g s per sub-step", bw_solid_dt_max(small->solid));
  describe_cost(p, small, e);
}

static bw_status plan(porous_run *p, porous_run *small, double fluid_bytes)
{
  const porous_config *q = p->config;
  porous_estimate e = {.fluid_bytes = fluid_bytes};
  const double h = q->domain.length[1] / q->domain.cells[1];
  const int walls = porous_clamps(&q->medium), slabs = (walls & 1) + (walls >> 1);
  e.clamped =
      slabs * (double)q->medium.clamped_layers * round(q->medium.length / h) * q->domain.cells[2];
  BW_TRY(porous_medium_try(p->comm, q, p->run, &e.particles, &e.exact));
  /* Each rank builds its own small run. */
  const double before = (double)bw_memory_in_use();
  BW_TRY(bw_comm_agree(p->comm, porous_build(small)));
  bound_step(small, q, &e);
  bw_status st = check_steps(p, small, &e);
  BW_THEN(st, first_step(small));
  BW_THEN(st, weigh(small, q, bw_comm_size(p->comm), (double)bw_memory_in_use() - before, &e));
  BW_THEN(st, check_strain(q));
  BW_TRY(bw_comm_agree(p->comm, st));
  describe(p, small, &e);
  return BW_OK;
}

bw_status porous_plan(porous_run *p)
{
  bw_grid *grid = NULL;
  bw_comm *self = NULL;
  BW_TRY(porous_check(p->config));
  /* Ranks have to fit the grid. */
  const bw_grid_config sizes = porous_grid(p->config);
  const bw_ns_channel_config flow = porous_fluid_of(p->config);
  bw_ns_plan fluid;
  bw_status st = bw_grid_plan(p->comm, &sizes, &grid);
  BW_THEN(st, bw_ns_channel_plan(grid, &flow, &fluid));
  bw_grid_destroy(&grid);
  const porous_config config = small_of(p->config);
  BW_THEN(st, bw_comm_agree(p->comm, bw_comm_self(&self)));
  porous_run small = {.config = &config, .comm = self};
  BW_THEN(st, plan(p, &small, fluid.bytes));
  porous_destroy(&small);
  bw_comm_destroy(&self);
  return st;
}

bw_status porous_describe(porous_run *p)
{
  const double limit = bw_ns_channel_dt_max(p->fluid), step = p->config->flow.time_step;
  bw_log_info(bw_case_log(p->run),
              "built      %lld particles; the first step of the flow %.2f of "
              "the fluid's limit",
              (long long)bw_solid_total(p->solid), step / limit);
  return BW_OK;
}
