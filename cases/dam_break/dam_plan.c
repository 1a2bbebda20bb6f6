/* What of a tank can be known before it is built: what is refused, sizes, step, memory. */
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "dam_case.h"

#include <math.h>
#include <stdlib.h>

/* A tank of so few particles is built to be checked. */
static const double FEW = 1e5;
static const int LAYERS = 4; /* of the tank's walls (dam_run.c) */

static int axes_of(const dam_config *c)
{
  return c->tank.size[2] > 0 ? 3 : 2;
}

/* Sites of the lattice between two places along one axis. */
static double sites(double lower, double upper, double dx)
{
  return fmax(0, floor(upper / dx - 0.5 + 1e-9) - ceil(lower / dx - 0.5 - 1e-9) + 1);
}

static double sites_in(const dam_config *c, const double lower[3], const double upper[3])
{
  double n = 1;
  for (int k = 0; k < axes_of(c); k++)
    n *= sites(lower[k], upper[k], c->fluid.spacing);
  return n;
}

/* Particles of the water, where its boxes do not overlap, and of the walls. */
static void count(const dam_config *c, double *water, double *walls)
{
  const double *size = c->tank.size, thick = LAYERS * c->fluid.spacing;
  const double lower[3] = {0, 0, 0}, outer[3] = {-thick, -thick, -thick};
  double upper[3], beyond[3];
  for (int k = 0; k < 3; k++)
    beyond[k] = size[k] + thick, upper[k] = size[k] + (k == 1 ? thick : 0);
  *water = 0, *walls = sites_in(c, outer, beyond) - sites_in(c, lower, upper);
  for (int q = 0; q < c->n_water; q++)
    *water += sites_in(c, c->water[q].lower, c->water[q].upper);
  for (int q = 0; q < c->n_obstacles; q++)
    *walls += sites_in(c, c->obstacles[q].lower, c->obstacles[q].upper);
}

/* What is refused of a tank that is built. */
static bw_status check_obstacles(const dam_config *c)
{
  static const double most = 2147483647.0; /* sites along an axis (bw_shape_fill_shared) */
  for (int k = 0; k < axes_of(c); k++)
    BW_REQUIRE(c->tank.size[k] / c->fluid.spacing + 2 * LAYERS <= most, BW_EINPUT,
               "tank.size[%d] = %g is %.3g spacings of %g, more than 2^31: take a larger spacing",
               k, c->tank.size[k], c->tank.size[k] / c->fluid.spacing, c->fluid.spacing);
  for (int q = 0; q < c->n_obstacles; q++) {
    const dam_box *o = &c->obstacles[q];
    for (int k = 0; k < axes_of(c); k++)
      BW_REQUIRE(sites(o->lower[k], o->upper[k], c->fluid.spacing) >= 3, BW_EINPUT,
                 "obstacles.%d is %g thick in direction %d, thinner than 3 spacings of %g", q,
                 o->upper[k] - o->lower[k], k, c->fluid.spacing);
    for (int w = 0; w < c->n_water; w++) {
      double lower[3] = {0}, upper[3] = {0};
      for (int k = 0; k < axes_of(c); k++) {
        lower[k] = fmax(o->lower[k], c->water[w].lower[k]);
        upper[k] = fmin(o->upper[k], c->water[w].upper[k]);
      }
      BW_REQUIRE(sites_in(c, lower, upper) == 0, BW_EINPUT,
                 "water.%d is inside obstacles.%d: cut the obstacle out of the water", w, q);
    }
  }
  return BW_OK;
}

/* Sound is ten times as fast as anything else: of the whole depth, which a small tank has not. */
static bw_status set_sound(const dam_config *c, bw_ulph_config *fluid)
{
  double low = INFINITY, high = -INFINITY;
  for (int q = 0; q < c->n_water; q++)
    low = fmin(low, c->water[q].lower[1]), high = fmax(high, c->water[q].upper[1]);
  const double needed = 10 * fmax(fluid->speed, sqrt(c->fluid.gravity * (high - low)));
  if (isnan(fluid->c0)) fluid->c0 = needed;
  BW_REQUIRE(
      fluid->c0 >= needed * (1 - 1e-9), BW_EINPUT,
      "fluid.sound_speed is %g; it must be at least %g, 10 times the largest of the expected "
      "speed, %g, and sqrt(g height)",
      fluid->c0, needed, fluid->speed);
  return BW_OK;
}

/* Water of the case in the corner of a tank that is as small as can be. */
static void make_small(const dam_config *c, dam_config *small)
{
  const int edge = axes_of(c) == 3 ? 16 : 60; /* spacings */
  *small = *c;
  small->n_water = 1, small->n_obstacles = small->n_gauges = 0;
  small->has_solid = false; /* small beside so much water */
  small->water[0] = (dam_box){{0, 0, 0}, {0, 0, 0}};
  for (int k = 0; k < axes_of(c); k++) {
    small->tank.size[k] = fmin(c->tank.size[k], edge * c->fluid.spacing);
    small->water[0].upper[k] = (k == 1 ? 0.5 : 1) * small->tank.size[k];
  }
}

/* Memory of `water` and `walls` particles on each of `ranks`, where `held` is that of those of u; a
 * checkpoint on its way is added. */
static double weigh(const bw_ulph *u, double held, double water, double walls, int ranks)
{
  const double own = (double)bw_ulph_count(u) + (double)bw_ulph_wall_count(u), n = water / ranks;
  const double row = BW_ULPH_ROW * sizeof(double);
  return held / own * (n + walls / ranks) + n * (row + sizeof(int64_t)) +
         bw_checkpoint_table_bytes(n, row) + bw_checkpoint_file_bytes();
}

bw_status dam_plan(const dam_run *d, const bw_ulph_config *fluid)
{
  const dam_config *c = d->config;
  dam_config *small = NULL;
  bw_comm *self = NULL;
  double water, walls;
  count(c, &water, &walls);
  const bool whole = water + walls <= FEW;
  bw_ulph_config with = *fluid;
  if (!whole) BW_TRY(check_obstacles(c));
  if (!whole) BW_TRY(set_sound(c, &with));
  bw_status st = BW_ALLOCATE(&small, 1);
  BW_THEN(st, bw_comm_self(&self));
  st = bw_comm_agree(d->comm, st);
  /* Each rank builds its own. */
  if (st == BW_OK) {
    *small = *c;
    if (!whole) make_small(c, small);
    dam_run run = {.config = small, .comm = self};
    const double before = (double)bw_memory_in_use();
    st = dam_create(&run, &with);
    if (st == BW_OK && whole) {
      water = (double)bw_ulph_count(run.fluid);
      walls = (double)bw_ulph_wall_count(run.fluid);
    }
    const double held = (double)bw_memory_in_use() - before;
    const int ranks = bw_comm_size(d->comm);
    if (st == BW_OK)
      dam_describe(d, &with, run.fluid, water, walls, weigh(run.fluid, held, water, walls, ranks));
    dam_destroy(&run);
    st = bw_comm_agree(d->comm, st);
  }
  bw_comm_destroy(&self);
  bw_release(&small);
  return st;
}
