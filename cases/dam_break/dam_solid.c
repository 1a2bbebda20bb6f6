/* The solid in the tank: its keys become a body, its motion columns and a picture. */
#include "bw_memory.h"
#include "bw_number.h"
#include "bw_vtk.h"
#include "dam_case.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Reach of the families over the spacing: the least for correspondence, which bends right with few
 * layers; 2 where bonds may break and elsewhere. */
static const double SHORT = 1.5, LONG = 2;

static bool breaks(const dam_solid *s)
{
  return isfinite(s->fracture_energy) || isfinite(s->choice.limit);
}

static bw_solid_config settings(const dam_config *c)
{
  const dam_solid *s = &c->solid;
  bw_solid_config q = bw_solid_config_default();
  const bool shortest = s->choice.law == BW_SOLID_CORRESPONDENCE && !breaks(s);
  q.geometry = c->tank.size[2] > 0 ? BW_PD_3D : BW_PD_PLANE_STRAIN;
  q.ds = s->spacing, q.rho = s->density, q.E = s->young, q.choice = s->choice;
  q.nu = s->choice.poisson_ratio;
  q.G0 = s->fracture_energy;
  q.horizon_ratio = isnan(s->horizon_ratio) ? (shortest ? SHORT : LONG) : s->horizon_ratio;
  if (q.horizon_ratio < LONG) q.family_reach = BW_PD_REACH_HORIZON;
  q.damping.pair = s->damping_pair, q.contact = s->contact;
  return q;
}

/* Parts of the body in the order of the list: the last one that holds a site says whether it is
 * held. */
static int parts(const dam_config *c, bw_shape shape[DAM_BOXES])
{
  for (int q = 0; q < c->solid.n_parts; q++) {
    dam_box_shape(c->solid.parts[q].lower, c->solid.parts[q].upper, &shape[q]);
    shape[q].particle_kind = c->solid.parts[q].held ? BW_PD_PRESCRIBED : BW_PD_FREE;
  }
  return c->solid.n_parts;
}

/* Pieces that are let loose stay in the tank. */
static bw_status stay_inside(const dam_run *d)
{
  const double *size = d->config->tank.size;
  bw_pd_wall wall[BW_PD_WALLS];
  int n = 0;
  if (!d->config->solid.contact) return BW_OK;
  for (int k = 0; k < (size[2] > 0 ? 3 : 2); k++)
    for (int side = 0; side < (k == 1 ? 1 : 2); side++) {
      wall[n] = (bw_pd_wall){.offset = side == 0 ? 0 : -size[k]};
      wall[n++].normal[k] = side == 0 ? 1 : -1;
    }
  return bw_solid_set_walls(d->solid, n, wall);
}

bw_status dam_solid_create(dam_run *d, const bw_ulph_config *fluid, int n_walls,
                           const bw_ulph_wall wall[])
{
  const dam_config *c = d->config;
  const bw_solid_config q = settings(c);
  const double origin[3] = {0};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(q.ds, origin, c->tank.size[2] <= 0);
  bw_coupler_particles_config between = bw_coupler_particles_config_default();
  bw_shape shape[DAM_BOXES];
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  between.gravity[1] = -c->fluid.gravity, between.no_slip = c->tank.no_slip;
  bw_status st =
      bw_shape_fill_shared(d->comm, parts(c, shape), shape, &lattice, &n, &site, &kind, NULL);
  const bw_pd_sites sites = {.n = n, .site = site, .kind = kind};
  BW_THEN(st, bw_solid_create(d->comm, &q, &sites, &d->solid));
  bw_release(&site);
  bw_release(&kind);
  BW_TRY(st);
  bw_solid_enable_breakage(d->solid, breaks(&c->solid));
  BW_TRY(stay_inside(d));
  return bw_coupler_particles_create(&between, fluid, d->fluid, d->solid, n_walls, wall, &d->both);
}

/* ---- what is seen of it ---- */
static bool within(const dam_gauge *g, const double X0[3], int dimensions)
{
  bool inside = true;
  for (int k = 0; k < dimensions; k++)
    inside = inside && X0[k] >= g->lower[k] && X0[k] < g->upper[k];
  return inside;
}

/* Mean displacement along an axis of the particles that were within the gauge's box. */
double dam_moved(const dam_run *d, const dam_gauge *g, int axis)
{
  const size_t n = bw_solid_count(d->solid);
  double *X = NULL, *X0 = NULL, sum[2] = {0, 0};
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&X0, 3 * n));
  if (st == BW_OK) {
    bw_solid_get_position(d->solid, X);
    bw_solid_get_reference(d->solid, X0);
    for (size_t i = 0; i < n; i++)
      if (within(g, X0 + 3 * i, d->config->tank.size[2] > 0 ? 3 : 2))
        sum[0] += X[3 * i + (size_t)axis] - X0[3 * i + (size_t)axis], sum[1] += 1;
  }
  bw_release(&X);
  bw_release(&X0);
  bw_comm_sum(d->comm, 2, sum);
  return sum[1] > 0 ? sum[0] / sum[1] : NAN;
}

const char *const dam_solid_columns[DAM_SOLID_COLUMNS] = {
    "force_on_solid_x[M L/T2]", "force_on_solid_y[M L/T2]",   "work_given_to_solid[-]",
    "work_that_came_late[-]",   "elastic_energy_of_solid[-]", "broken_bonds[-]"};

bw_status dam_solid_row(dam_run *d, double unit, double row[DAM_SOLID_COLUMNS])
{
  bw_solid_ledger l;
  const bw_coupler_particles_report r = bw_coupler_particles_measure(d->both);
  BW_TRY(bw_solid_account(d->solid, &l));
  row[0] = r.force[0], row[1] = r.force[1];
  row[2] = r.given / unit, row[3] = r.late / unit, row[4] = l.elastic / unit;
  row[5] = l.bonds > 0 ? (double)l.broken / (double)l.bonds : 0;
  return BW_OK;
}

/* Displacement, velocity, force by the fluid, damage, pressure of the fluid, as solid.pvd. */
bw_status dam_solid_picture(dam_run *d)
{
  enum { VECTORS = 3, SCALARS = 2 };
  static const char *const words[] = {"displacement", "velocity", "force", "damage", "pressure"};
  const size_t n = bw_solid_count(d->solid);
  double *x = NULL, *data[VECTORS + SCALARS] = {NULL};
  bw_vtk_array array[VECTORS + SCALARS];
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  for (int q = 0; q < VECTORS + SCALARS; q++) {
    const int wide = q < VECTORS ? 3 : 1;
    BW_THEN(st, BW_ALLOCATE(&data[q], (size_t)wide * n));
    array[q] = (bw_vtk_array){words[q], BW_VTK_FLOAT64, wide, data[q]};
  }
  st = bw_comm_agree(d->comm, st);
  if (st == BW_OK) {
    bw_solid_get_position(d->solid, x);
    bw_solid_get_reference(d->solid, data[0]);
    for (size_t i = 0; i < 3 * n; i++)
      data[0][i] = x[i] - data[0][i];
    bw_solid_get_velocity(d->solid, data[1]);
    bw_coupler_particles_load(d->both, data[2]);
    bw_solid_get_damage(d->solid, data[3]);
    bw_coupler_particles_pressure(d->both, data[4]);
    st = dam_write_points(d, "solid", n, x, VECTORS + SCALARS, array);
  }
  bw_release(&x);
  for (int q = 0; q < VECTORS + SCALARS; q++)
    bw_release(&data[q]);
  return st;
}
