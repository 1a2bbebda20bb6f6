/* bodies_scene.h -- a plane channel with square blocks in it, for tests of free bodies. */
#pragma once
#include "bw_check.h"
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"

enum { HEIGHT = 16 };                 /* cells */
static const double H = 1.0 / HEIGHT; /* height of the channel 1, density of the fluid 1 */

typedef struct {
  int length;               /* of the channel, in cells */
  bool periodic;            /* along x, driven by a gradient; else inflow and outflow */
  double ratio, gravity;    /* density of the blocks; along -y */
  int n_block, block[4][4]; /* lower and upper corner in cells */
  int held_block;           /* number (from 1) of the block that is prescribed; 0: none */
  bool no_contact, still;   /* still: fluid at rest */
  bw_coupler_load_kind load;
  int iterations; /* of the coupling; 0: explicit */
  bw_coupler_films films;
  double lower[4];     /* how far the particles of each block are moved down [cells] */
  const bw_comm *comm; /* NULL: the world */
} bodies_set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  size_t n, total;
  const bw_comm *comm;
} bodies_scene;

static inline void bodies_destroy(bodies_scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

static inline void bodies_stream(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = 6.0 * x[1] * (1.0 - x[1]);
  u[1] = u[2] = 0.0;
}

static inline void bodies_make_fluid(const bodies_set_up *b, bodies_scene *s)
{
  s->comm = b->comm != NULL ? b->comm : bw_check_world();
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  grid.n[0] = b->length, grid.n[1] = HEIGHT, grid.n[2] = 1;
  for (int d = 0; d < 3; d++)
    grid.length[d] = grid.n[d] * H;
  grid.periodic[0] = b->periodic;
  grid.periodic[2] = true;
  grid.halo = 2;
  flow.nu = 0.02;
  flow.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 1.0};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  if (b->periodic) {
    flow.side[0][0].kind = flow.side[0][1].kind = BW_SIDE_PERIODIC;
    flow.forcing = BW_FORCING_GRADIENT;
    flow.forcing_value = b->still ? 0.0 : 12.0 * flow.nu;
  }
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
  bw_check_ok(bw_grid_create(s->comm, &grid, &s->grid));
  bw_check_ok(bw_ns_channel_create(s->grid, &flow, &s->fluid));
  if (!b->still) bw_check_ok(bw_ns_channel_set_velocity(s->fluid, bodies_stream, NULL, 0.0));
}

/* Stiff and well damped: a block turns and moves, and hardly bends. */
static inline void bodies_make_solid(const bodies_set_up *b, bodies_scene *s)
{
  bw_solid_config c = bw_solid_config_default();
  bw_shape shape[4];
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  c.geometry = BW_PD_PLANE_STRAIN;
  c.ds = c.thickness = H;
  c.rho = b->ratio;
  c.E = b->ratio * 4e4; /* sound crosses it four times in a step */
  c.damping.mean = b->ratio * 800.0;
  c.contact = !b->no_contact;
  c.origin[2] = 0.5 * H;
  for (int q = 0; q < b->n_block; q++) {
    shape[q] = (bw_shape){.kind = BW_SHAPE_BOX,
                          .particle_kind = q + 1 == b->held_block ? BW_PD_PRESCRIBED : BW_PD_FREE};
    for (int d = 0; d < 2; d++) {
      shape[q].lower[d] = b->block[q][d] * H;
      shape[q].upper[d] = b->block[q][2 + d] * H;
    }
    shape[q].upper[2] = H;
  }
  const bw_shape_lattice lattice = bw_shape_lattice_straight(H, c.origin, true);
  bw_check_ok(bw_shape_fill(b->n_block, shape, &lattice, 0, 1, &n, &site, &kind, NULL));
  bw_check_ok(bw_solid_create_same(s->comm, &c, n, site, kind, &s->solid));
  bw_release(&site);
  bw_release(&kind);
  s->n = bw_solid_count(s->solid);
  s->total = (size_t)n;
}

/* Each block down by what it is lowered. */
static inline void bodies_lower(const bodies_set_up *b, bodies_scene *s)
{
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * s->n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * s->n));
  bw_solid_get_position(s->solid, X);
  bool moved = false;
  for (size_t i = 0; i < s->n; i++)
    for (int q = 0; q < b->n_block; q++) {
      const int *k = b->block[q];
      const double x = X[3 * i] / H, y = X[3 * i + 1] / H;
      if (b->lower[q] == 0.0 || x < k[0] || x > k[2] || y < k[1] || y > k[3]) continue;
      X[3 * i + 1] -= b->lower[q] * H;
      moved = true;
      break;
    }
  int64_t any = moved;
  bw_comm_sum_int(s->comm, 1, &any);
  if (any > 0) bw_solid_set_state(s->solid, X, V);
  bw_release(&X);
  bw_release(&V);
}

static inline bw_coupler_config bodies_coupling(const bodies_set_up *b)
{
  bw_coupler_config c = bw_coupler_config_default();
  c.rho = 1.0;
  c.nu = 0.02;
  c.load = b->load;
  c.load_relaxation = 0.3;
  if (b->iterations > 0) c.coupling_iterations = b->iterations;
  c.gravity[1] = -b->gravity;
  if (b->films.on) c.films = b->films;
  return c;
}

static inline bodies_scene bodies_build(const bodies_set_up *b)
{
  bodies_scene s = {0};
  const bw_coupler_config c = bodies_coupling(b);
  bodies_make_fluid(b, &s);
  bodies_make_solid(b, &s);
  bodies_lower(b, &s);
  bw_check_ok(bw_coupler_create(&c, s.fluid, s.solid, &s.coupler));
  bw_coupler_hold_solid(s.coupler, false);
  return s;
}

static inline bw_coupler_report bodies_step(bodies_scene *s, int steps, double dt)
{
  bw_coupler_report r;
  for (int q = 0; q < steps; q++)
    bw_check_ok(bw_coupler_step(s->coupler, dt));
  bw_check_ok(bw_coupler_measure(s->coupler, &r));
  return r;
}

/* all (total,3) on every rank, by global id. */
static inline void bodies_gather(const bodies_scene *s, void (*get)(const bw_solid *, double[]),
                                 double all[])
{
  double *mine = NULL;
  bw_check_ok(BW_ALLOCATE(&mine, 3 * s->n));
  get(s->solid, mine);
  for (size_t q = 0; q < 3 * s->total; q++)
    all[q] = 0;
  for (size_t i = 0; i < s->n; i++)
    for (size_t k = 0; k < 3; k++)
      all[3 * (size_t)bw_solid_id(s->solid)[i] + k] = mine[3 * i + k];
  bw_comm_sum(s->comm, 3 * s->total, all);
  bw_release(&mine);
}
