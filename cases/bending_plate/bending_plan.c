/* What of a run can be known before it is built: what is refused, sizes, limits, memory. */
#include "bending_case.h"
#include "bw_checkpoint.h"

#include <math.h>

/* What the stream does to the plate has to be more than rounding does. */
static bw_status check_strain(const bending_config *c, double h)
{
  static const double least = 1e-15; /* of positions in a channel of length 1: 2^-53 is 1.1e-16 */
  const double U = c->fluid.bulk_velocity;
  const double stress = c->fluid.density * U * (U + c->fluid.viscosity / h);
  BW_REQUIRE(stress / c->plate.young_modulus >= least, BW_EINPUT,
             "physics.plate.young_modulus = %g Pa: the stream's stress, rho U_b (U_b + nu/h) = %g "
             "Pa, strains it by %.3g, which rounding hides; at least %g",
             c->plate.young_modulus, stress, stress / c->plate.young_modulus, least);
  return BW_OK;
}

/* A set-up that is small itself; else one with cells, particles, material and stream of the case,
 * in a channel and with a plate that are as small as they can be. */
static bending_config small_of(const bending_config *c)
{
  enum { CELLS_X = 96, CELLS_Y = 48, FEW = 60000, ROWS = 48, ACROSS = 48 };
  bending_config s = *c;
  const double h = c->channel.height / c->channel.cells[1];
  const double ds = c->plate.thickness / c->plate.particles_across;
  const double particles = c->plate.thickness * c->plate.height / (ds * ds);
  const double cells = (double)c->channel.cells[0] * c->channel.cells[1];
  if (cells <= FEW && particles <= FEW) return s;
  s.channel.cells[0] = CELLS_X, s.channel.cells[1] = CELLS_Y;
  s.channel.length = CELLS_X * h, s.channel.height = CELLS_Y * h;
  if (s.plate.particles_across > ACROSS) s.plate.particles_across = ACROSS;
  s.plate.thickness = s.plate.particles_across * ds;
  s.plate.height = fmin(ROWS, fmax(1.0, floor(0.5 * s.channel.height / ds))) * ds;
  s.plate.front = 0.25 * s.channel.length;
  return s;
}

/* Steps that neither the stream over the plate bears nor the coupler could divide. */
static bw_status check_step(const bending_run *p, bending_flow *small, double *limit)
{
  static const double convective = 1.7320508; /* of bw_ns_channel_dt_max */
  const bending_config *c = &p->config->physics;
  const double dt = p->config->time.step;
  /* What flows over the plate is squeezed between it and the other wall. */
  const double open = 1.0 - c->plate.height / c->channel.height;
  const double over = convective * small->h * open / c->fluid.bulk_velocity;
  *limit = fmin(bw_ns_channel_dt_max(small->fluid), over);
  BW_REQUIRE(
      dt <= *limit * (1.0 + 1e-12), BW_EINPUT,
      "time.step = %g s is over the fluid's limit: the stream of physics.fluid.bulk_velocity "
      "= %g m/s over the plate bears %.3g s at most; take a shorter step",
      dt, c->fluid.bulk_velocity, *limit);
  return bw_coupler_check_substeps(small->coupler, dt);
}

/* Memory of a rank. That of the fluid is known; `held` is what the small set-up holds after its
 * first step: beside its own fluid, fields of the coupler and of the last good state (two and
 * three), and what grows with the n particles. A checkpoint on its way is added. */
static bw_status weigh(const bending_run *p, const bending_flow *small, double n,
                       double fluid_bytes, double held)
{
  const bending_config *c = &p->config->physics;
  const bw_ns_channel_config flow = bending_fluid_of(&small->config);
  const int *of = small->config.channel.cells, ranks = bw_comm_size(p->comm);
  const double cells = (double)c->channel.cells[0] * c->channel.cells[1];
  const double fields = 5.0 * sizeof(bw_real) * (double)bw_grid_look(small->grid)->size;
  const double row = 8.0 * (double)bw_solid_restart_row(small->solid);
  bw_ns_plan own;
  BW_TRY(bw_ns_channel_plan(small->grid, &flow, &own));
  const double each = fmax(0.0, held - own.bytes - fields) / (double)bw_solid_total(small->solid);
  const double writing =
      bw_checkpoint_file_bytes() +
      fmax(bw_checkpoint_table_bytes(n / ranks, row), cells / ranks * (double)sizeof(bw_real));
  bw_log_info(bw_case_log(p->run), "memory     about %.3g MiB for each of %d ranks",
              (fluid_bytes + cells / of[0] / of[1] / ranks * fields + n / ranks * each + writing) /
                  1048576.0,
              ranks);
  return BW_OK;
}

/* Buffers grow in the first step, a short one, and when it is measured; the last good state is kept
 * from the start on. */
static bw_status first_step(bending_flow *small)
{
  static const double brief = 1e-3;
  bending_measure m;
  BW_TRY(bw_coupler_step(small->coupler, brief * bw_ns_channel_dt_max(small->fluid)));
  BW_TRY(bending_look(small, &m));
  return bw_coupler_keep(small->coupler);
}

static bw_status describe(const bending_run *p, bending_flow *small, double fluid_bytes,
                          double before)
{
  const bending_config *c = &p->config->physics;
  const double U = c->fluid.bulk_velocity, rho = c->fluid.density, H = c->plate.height;
  const double ds = c->plate.thickness / c->plate.particles_across, dt = p->config->time.step;
  const double rows = H / ds + c->plate.clamped_layers, n = rows * c->plate.particles_across;
  bw_log *log = bw_case_log(p->run);
  double limit = 0.0;
  BW_TRY(check_step(p, small, &limit));
  bw_log_info(log, "channel    %d x %d cells of %g m; plate %g x %g m, %.4g particles of %g m",
              c->channel.cells[0], c->channel.cells[1], small->h, c->plate.thickness, H, n, ds);
  /* The numbers that the physics depends on. */
  bw_log_info(log, "groups     Re = U_b H/nu = %g, E* = E/(rho_f U_b^2) = %g, density ratio %g",
              U * H / c->fluid.viscosity, c->plate.young_modulus / (rho * U * U),
              c->plate.density / rho);
  bw_log_info(log,
              "time step  %g s, %.2f of what the stream bears at most; solid %d sub-steps (limit "
              "%.3g s); %.0f steps, H/U_b = %g s",
              dt, dt / limit, bw_coupler_substeps(small->coupler, dt),
              bw_solid_dt_max(small->solid), p->config->time.end / dt, H / U);
  BW_TRY(first_step(small));
  return weigh(p, small, n, fluid_bytes, (double)bw_memory_in_use() - before);
}

static bw_status plan(const bending_run *p, bending_flow *small, double fluid_bytes)
{
  const bending_config config = small_of(&p->config->physics);
  bw_comm *self = NULL;
  bw_status st = bw_comm_self(&self);
  const double before = (double)bw_memory_in_use();
  BW_THEN(st, bending_create(self, &config, small));
  BW_THEN(st, describe(p, small, fluid_bytes, before));
  bending_destroy(small);
  bw_comm_destroy(&self);
  return st;
}

bw_status bending_plan(bending_run *p)
{
  const bending_config *c = &p->config->physics;
  bending_flow small = {.h = 0.0};
  bw_grid *grid = NULL;
  bw_ns_plan fluid;
  BW_TRY(bending_count_steps(p));
  BW_TRY(bending_check(c));
  BW_TRY(check_strain(c, c->channel.height / c->channel.cells[1]));
  /* Ranks have to fit the grid. */
  const bw_grid_config sizes = bending_grid(c);
  const bw_ns_channel_config flow = bending_fluid_of(c);
  bw_status st = bw_grid_plan(p->comm, &sizes, &grid);
  BW_THEN(st, bw_ns_channel_plan(grid, &flow, &fluid));
  bw_grid_destroy(&grid);
  BW_THEN(st, bw_comm_agree(p->comm, plan(p, &small, fluid.bytes)));
  return st;
}
