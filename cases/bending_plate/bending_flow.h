/* bending_flow.h -- an elastic plate on the lower wall of a plane channel, bent by the stream.
 * Shared by the case and by the validation of the coupler.
 *
 * Any consistent units. Two-dimensional, plane strain, one cell deep (depth h); forces and energies
 * are per unit depth. The plate stands at front <= x < front + thickness, 0 <= y < height, on
 * `clamped_layers` rows of held particles under the wall. */
#pragma once
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <limits.h>
#include <math.h>

/* The box of the fluid, one cell deep. */
typedef struct {
  double length, height; /* along the stream, between the walls [L] */
  int cells[2];          /* in x and y; cells are squares */
} bending_channel;
/* The fluid and its stream. */
typedef struct {
  double density;       /* [M/L^3] */
  double viscosity;     /* kinematic [L^2/T] */
  double bulk_velocity; /* mean of the Poiseuille inflow [L/T] */
} bending_fluid;
/* The plate. */
typedef struct {
  double front, thickness,
      height;              /* inflow to the upstream face; along the stream; over the wall [L] */
  int particles_across;    /* of the thickness */
  int clamped_layers;      /*                      default 3 */
  double young_modulus;    /* [M/(L T^2)] */
  double density;          /* [M/L^3] */
  double horizon_ratio;    /* horizon over spacing [-]         default 3 */
  double damping_mean;     /* k_d of FSI 9 [M/(L^3 T)]         default 0 */
  double damping_pair;     /* k_d of POROUS 3.41 [M/(L^6 T)]   default 0 */
  double damping_absolute; /* against rest [M/(L^3 T)]         default 0 */
  int surface_correction;  /* bw_pd_surface_correction         default volume */
  int skin;                /* columns beside either face that are twice as fine    default 0 */
} bending_plate;

/* The whole set-up. */
typedef struct {
  bending_channel channel;
  bending_fluid fluid;
  bending_plate plate;
  bw_coupler_config coupling;
} bending_config;

/* The objects of a run. */
typedef struct {
  bending_config config;
  const bw_comm *comm; /* borrowed */
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  double h, ds;   /* spacing of the grid and of the particles [L] */
  size_t n;       /* particles of this rank */
  double *X0, *X; /* (n,3) reference and present positions [L] */
} bending_flow;

/* What is measured of a step. */
typedef struct {
  double tip[2];                          /* displacement of the middle of the free end */
  double reaction[2], probe[2], box[2];   /* force on the plate per depth, three routes */
  double given, received;                 /* work of the fluid per depth: given by it at the
                                             markers, received by the solid */
  double kinetic, elastic, damping, slip; /* per depth; slip [L/T] */
  bw_coupler_report report;               /* of the coupler, of the whole depth */
  int64_t markers, outside;               /* markers of all ranks; of them outside the box */
  int64_t shortened, blocked;             /* probes */
} bending_measure;

static inline bending_config bending_config_default(void)
{
  bw_coupler_config c = bw_coupler_config_default();
  c.marker_spacing = 1.0;
  return (bending_config){.channel = {.length = NAN, .height = NAN, .cells = {INT_MIN, INT_MIN}},
                          .fluid = {.density = NAN, .viscosity = NAN, .bulk_velocity = NAN},
                          .plate = {.front = NAN,
                                    .thickness = NAN,
                                    .height = NAN,
                                    .particles_across = INT_MIN,
                                    .clamped_layers = 3,
                                    .young_modulus = NAN,
                                    .density = NAN,
                                    .horizon_ratio = 3.0,
                                    .surface_correction = BW_PD_SURFACE_VOLUME},
                          .coupling = c};
}

static inline void bending_destroy(bending_flow *f)
{
  bw_coupler_destroy(&f->coupler);
  bw_solid_destroy(&f->solid);
  bw_ns_channel_destroy(&f->fluid);
  bw_grid_destroy(&f->grid);
  bw_release(&f->X0);
  bw_release(&f->X);
}

/* Squares for cells, whole particles over the height, no holes, all of it in the channel. */
static inline bw_status bending_check(const bending_config *c)
{
  const double h = c->channel.height / c->channel.cells[1];
  const double ds = c->plate.thickness / c->plate.particles_across, rows = c->plate.height / ds;
  BW_REQUIRE(fabs(c->channel.length / c->channel.cells[0] / h - 1.0) < 1e-9, BW_EINPUT,
             "channel.cells[0] = %d: cells must be squares, %g would give the spacing %g of y",
             c->channel.cells[0], c->channel.length / h, h);
  /* The plate has to be a whole number of particles high. */
  BW_REQUIRE(fabs(rows - round(rows)) < 1e-6, BW_EINPUT,
             "plate.particles_across = %d: the spacing %g has to divide plate.height = %g",
             c->plate.particles_across, ds, c->plate.height);
  BW_REQUIRE(
      ds < 1.5 * h, BW_EINPUT,
      "plate.particles_across = %d: the spacing %g leaves holes in a grid of %g; at least %.0f",
      c->plate.particles_across, ds, h, ceil(c->plate.thickness / h));
  /* Finer ones cost without end and carry nothing that the fluid could see. */
  BW_REQUIRE(h <= 100.0 * ds, BW_EINPUT,
             "plate.thickness = %g with plate.particles_across = %d: the spacing %g is %.3g of the "
             "grid's, %g; at least 0.01",
             c->plate.thickness, c->plate.particles_across, ds, ds / h, h);
  BW_REQUIRE(c->plate.height < c->channel.height &&
                 c->plate.front + c->plate.thickness < c->channel.length,
             BW_EINPUT, "plate.height = %g, plate.front = %g: the plate leaves the channel",
             c->plate.height, c->plate.front);
  return BW_OK;
}

/* Poiseuille flow everywhere; context: the configuration. */
static inline void bending_stream(const double x[3], double t, void *context, double u[3])
{
  const bending_config *c = context;
  const double y = x[1] / c->channel.height;
  (void)t;
  u[0] = 6.0 * c->fluid.bulk_velocity * y * (1.0 - y);
  u[1] = u[2] = 0.0;
}

/* One cell deep: its depth is h, so that cells are cubes. */
static inline bw_grid_config bending_grid(const bending_config *c)
{
  const double h = c->channel.height / c->channel.cells[1];
  bw_grid_config grid = bw_grid_config_default();
  grid.n[0] = c->channel.cells[0], grid.n[1] = c->channel.cells[1], grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = grid.n[d] * h;
  grid.periodic[2] = true;
  grid.halo = 2;
  return grid;
}

static inline bw_ns_channel_config bending_fluid_of(const bending_config *c)
{
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  /* Laminar inflow, convective outflow; floor and ceiling are walls by default. */
  fluid.nu = c->fluid.viscosity;
  fluid.side[0][0] = (bw_ns_side){.kind = BW_SIDE_INFLOW,
                                  .profile = BW_PROFILE_POISEUILLE,
                                  .bulk_velocity = c->fluid.bulk_velocity};
  fluid.side[0][1].kind = BW_SIDE_OUTFLOW;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  return fluid;
}

static inline bw_status bending_make_fluid(bending_flow *f)
{
  const bending_config *c = &f->config;
  const bw_grid_config grid = bending_grid(c);
  const bw_ns_channel_config fluid = bending_fluid_of(c);
  f->h = c->channel.height / c->channel.cells[1];
  BW_TRY(bw_grid_create(f->comm, &grid, &f->grid));
  BW_TRY(bw_ns_channel_create(f->grid, &fluid, &f->fluid));
  /* The stream starts as it enters, everywhere; the plate is met in the first step. */
  BW_TRY(bw_ns_channel_set_velocity(f->fluid, bending_stream, &f->config, 0.0));
  /* the whole height, from half a plate's height before it to one and a half behind */
  const double H = c->plate.height, x[2] = {c->plate.front - 0.5 * H, c->plate.front + 1.5 * H};
  const int lo = (int)fmax(1.0, round(x[0] / f->h));
  const int hi = (int)fmin(grid.n[0] - 1.0, round(x[1] / f->h));
  return bw_ns_channel_watch_box(f->fluid, (int[3]){lo, 0, 0}, (int[3]){hi, grid.n[1], 1});
}

static inline bw_solid_config bending_material(const bending_flow *f)
{
  const bending_plate *p = &f->config.plate;
  bw_solid_config s = bw_solid_config_default();
  s.geometry = BW_PD_PLANE_STRAIN;
  s.ds = f->ds;
  s.thickness = f->h;
  s.horizon_ratio = p->horizon_ratio;
  s.rho = p->density;
  s.E = p->young_modulus;
  s.surface_correction = (bw_pd_surface_correction)p->surface_correction;
  s.damping.mean = p->damping_mean;
  s.damping.pair = p->damping_pair;
  s.damping.absolute = p->damping_absolute;
  s.origin[0] = p->front;
  for (int q = 0; q < (p->skin > 0 ? 2 : 0); q++) {
    const double out = q == 0 ? p->front : p->front + p->thickness, in = (p->skin - 0.5) * f->ds;
    s.finer.box[s.finer.n++] = (bw_pd_box){
        .level = 1, .lower = {out - in, -p->height}, .upper = {out + in, 2 * p->height}};
  }
  s.origin[2] = 0.5 * f->h;
  return s;
}

static inline bw_status bending_make_solid(bending_flow *f)
{
  const bending_plate *p = &f->config.plate;
  f->ds = p->thickness / p->particles_across;
  const double end = p->front + p->thickness, under = -p->clamped_layers * f->ds;
  /* The plate, and the rows under the wall that hold it. */
  const bw_shape body[2] = {
      {.kind = BW_SHAPE_BOX, .lower = {p->front}, .upper = {end, p->height, f->h}},
      {.kind = BW_SHAPE_BOX,
       .lower = {p->front, under},
       .upper = {end, 0.0, f->h},
       .particle_kind = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE}};
  const bw_solid_config s = bending_material(f);
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(f->ds, s.origin, true);
  bw_status st = bw_shape_fill_shared(f->comm, p->clamped_layers > 0 ? 2 : 1, body, &lattice, &n,
                                      &site, &kind, NULL);
  /* Each rank gives its part; the solid brings every particle to the rank that owns it. */
  BW_THEN(st, bw_solid_create(f->comm, &s, &(bw_pd_sites){n, site, kind, NULL}, &f->solid));
  bw_release(&site);
  bw_release(&kind);
  if (st != BW_OK) return st;
  f->n = bw_solid_count(f->solid);
  st = BW_ALLOCATE(&f->X0, 3 * f->n);
  BW_THEN(st, BW_ALLOCATE(&f->X, 3 * f->n));
  if (st == BW_OK) bw_solid_get_reference(f->solid, f->X0);
  return bw_comm_agree(f->comm, st);
}

/* Everything, with Poiseuille flow and the plate held. Destroy also after a failure. Collective. */
static inline bw_status bending_create(const bw_comm *comm, const bending_config *config,
                                       bending_flow *f)
{
  *f = (bending_flow){.config = *config, .comm = comm};
  BW_TRY(bending_check(config));
  BW_TRY(bending_make_fluid(f));
  BW_TRY(bending_make_solid(f));
  /* What the case file leaves to the case: the fluid's
   * numbers, the floor that the plate leans on. */
  bw_coupler_config c = f->config.coupling;
  c.rho = config->fluid.density;
  c.nu = config->fluid.viscosity;
  c.count_work = c.check_relaxation = true;
  c.walled[1][0] = true;
  return bw_coupler_create(&c, f->fluid, f->solid, &f->coupler);
}

/* Displacement of the middle of the free end: mean over the particles about the middle line,
 * carried from the uppermost row (centre ds/2 below the end) along the slope over three rows. */
static inline void bending_tip(bending_flow *f, double tip[2])
{
  const bending_plate *p = &f->config.plate;
  double sum[6] = {0};
  bw_solid_get_position(f->solid, f->X);
  for (size_t i = 0; i < f->n; i++) {
    const double *x = f->X + 3 * i, *x0 = f->X0 + 3 * i;
    /* Only columns about the middle line, in the reference shape. */
    if (fabs(x0[0] - p->front - 0.5 * p->thickness) > 0.6 * f->ds) continue;
    const double below = (p->height - x0[1]) / f->ds - 0.5; /* rows below the uppermost */
    const int row = below < 0.5 ? 0 : fabs(below - 3.0) < 0.5 ? 3 : -1;
    if (row < 0) continue;
    for (int d = 0; d < 2; d++)
      sum[row + d] += x[d] - x0[d];
    sum[row + 2] += 1.0;
  }
  /* Uppermost row and the third below it: means, and the slope between them. */
  bw_comm_sum(f->comm, 6, sum);
  for (int d = 0; d < 2; d++) {
    const double top = sum[d] / sum[2], lower = sum[3 + d] / sum[5];
    tip[d] = top + (top - lower) / 6.0;
  }
}

/* Of the last step. Collective. */
static inline bw_status bending_look(bending_flow *f, bending_measure *m)
{
  bw_coupler_report r;
  BW_TRY(bw_coupler_measure(f->coupler, &r));
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(f->solid, &e));
  /* The report is of the whole depth; per unit depth it compares with two dimensions. */
  *m = (bending_measure){.given = r.work_given / f->h,
                         .received = e.external / f->h,
                         .kinetic = e.kinetic / f->h,
                         .elastic = e.elastic / f->h,
                         .damping = e.damping / f->h,
                         .slip = r.slip_rms,
                         .report = r,
                         .markers = r.markers,
                         .outside = r.markers_outside,
                         .shortened = r.probes_shortened,
                         .blocked = r.probes_blocked};
  for (int d = 0; d < 2; d++) {
    m->reaction[d] = r.force_reaction[d] / f->h;
    m->probe[d] = r.force_probe[d] / f->h;
    m->box[d] = r.force_control_volume[d] / f->h;
  }
  bending_tip(f, m->tip);
  return BW_OK;
}
