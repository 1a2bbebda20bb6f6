/* block.h -- a body in fluid at rest in a closed box, plane: free, or moved by force.
 * Units: box 1 x 1, density of the fluid 1. Block and cylinder are stiff against a step: bending
 * does not matter, sound crosses them four times in a step, slowed down by the fluid they carry
 * too, and oscillations die out within one. (By their own density alone a light one is soft against
 * the fluid's inertia: a cylinder loaded by the reaction at w = 0.2 then holds down to 0.163, not
 * to the 0.187 of a rigid one.) Iterated ones are left soft. The plate, 2 x 12 cells on the floor,
 * held under it, is elastic: sound goes one spacing in a step, and pair damping takes the waves of
 * the lattice (as fast as c/ds) within some steps. */
#pragma once
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <math.h>

enum { CELLS = 32, BLOCK = 8 };
static const double H = 1.0 / CELLS, DT = 2e-3, NU = 1e-2;
static const double CARRIED = 3.4; /* most added mass, and fluid inside, over that displaced */

typedef enum { A_BLOCK, A_CYLINDER, A_PLATE } block_body;

typedef struct {
  block_body body;
  double ratio; /* density of the block over the fluid's */
  double w;     /* load relaxation; NaN: left to the coupler */
  double virtual_mass;
  bool predictor;
  double dt; /* of the steps to come: says what is stiff */
  bw_coupler_load_kind load;
  double speed;
  int iterations; /* 0: explicit */
  bool moved;     /* by force; else free, and starting with `speed` */
  double spacing; /* of markers, in cells; 0: one a particle */
} block_set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  size_t n;
  double mass; /* of the fluid that the body displaces */
  double *X, *V;
} block_scene;

static inline void block_destroy(block_scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
  bw_release(&s->X);
  bw_release(&s->V);
}

/* Returns how many of the two shapes are used: the body, and what holds it under the floor. */
static inline int block_shapes(const block_set_up *b, bw_shape shape[2])
{
  const double size = BLOCK * H, first = 0.5 - 0.5 * size, thin = 2 * H, tall = 12 * H;
  const uint8_t kind = b->moved ? BW_PD_PRESCRIBED : BW_PD_FREE;
  shape[0] = (bw_shape){.kind = b->body == A_CYLINDER ? BW_SHAPE_CYLINDER : BW_SHAPE_BOX,
                        .lower = {first, first},
                        .upper = {first + size, first + size, H},
                        .centre = {0.5, 0.5},
                        .radius = 0.5 * size,
                        .axis = 2,
                        .particle_kind = kind};
  if (b->body != A_PLATE) return 1;
  shape[0].lower[1] = 0.0, shape[0].upper[1] = tall;
  shape[0].lower[0] = 0.5 - 0.5 * thin, shape[0].upper[0] = 0.5 + 0.5 * thin;
  shape[1] = shape[0];
  shape[1].lower[1] = -3.0 * H, shape[1].upper[1] = 0.0;
  shape[1].particle_kind = BW_PD_PRESCRIBED;
  return 2;
}

static inline bw_status block_make_solid(const bw_comm *comm, const block_set_up *b, block_scene *s)
{
  const double size = BLOCK * H;
  const double speed_of_sound = (b->body == A_PLATE ? H : 4.0 * size) / b->dt;
  bw_shape shape[2];
  const int shapes = block_shapes(b, shape);
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRAIN;
  c.ds = c.thickness = H;
  c.rho = b->ratio;
  const double carried = b->body == A_PLATE || b->iterations > 0 ? 0.0 : CARRIED;
  c.E = (b->ratio + carried) * speed_of_sound * speed_of_sound;
  if (b->body == A_PLATE)
    c.damping.pair = b->ratio * 0.1 / (b->dt * 30.0 * H * H * H); /* 30 h^3: the family */
  else
    c.damping.mean = sqrt(c.E * b->ratio) / size; /* rests within a step */
  c.origin[2] = 0.5 * H;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(H, c.origin, true);
  bw_status st = bw_shape_fill(shapes, shape, &lattice, 0, 1, &n, &site, &kind, NULL);
  s->mass = 0.0;
  for (int64_t q = 0; st == BW_OK && q < n; q++)
    s->mass += site[3 * q + 1] >= 0 ? H * H * H : 0.0;
  BW_THEN(st, bw_solid_create_same(comm, &c, n, site, kind, &s->solid));
  bw_release(&site);
  bw_release(&kind);
  if (st != BW_OK) return st;
  s->n = bw_solid_count(s->solid);
  st = BW_ALLOCATE(&s->X, 3 * s->n);
  BW_THEN(st, BW_ALLOCATE(&s->V, 3 * s->n));
  if (st == BW_OK) bw_solid_get_position(s->solid, s->X);
  return bw_comm_agree(comm, st);
}

/* Destroy also after a failure. Collective. */
static inline bw_status block_create(const bw_comm *comm, const block_set_up *b, block_scene *s)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  bw_coupler_config c = bw_coupler_config_default();
  *s = (block_scene){0};
  grid.n[0] = grid.n[1] = CELLS, grid.n[2] = 1;
  grid.length[0] = grid.length[1] = 1.0, grid.length[2] = H;
  grid.periodic[2] = true;
  grid.halo = 2;
  fluid.nu = NU;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  c.rho = 1.0;
  c.nu = NU;
  c.load = b->load;
  c.load_relaxation = b->w;
  c.virtual_mass = b->virtual_mass;
  c.predictor = b->predictor;
  c.count_work = true;
  c.marker_spacing = b->spacing;
  c.walled[1][0] = b->body == A_PLATE;
  if (b->iterations > 0) {
    c.coupling_iterations = b->iterations;
    c.load_relaxation = 0.1;    /* of what earlier tries do not tell */
    c.coupling_residual = 1e-8; /* noise far below the motions that are judged */
  }
  BW_TRY(bw_grid_create(comm, &grid, &s->grid));
  BW_TRY(bw_ns_channel_create(s->grid, &fluid, &s->fluid));
  BW_TRY(block_make_solid(comm, b, s));
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
  for (size_t i = 0; i < s->n; i++)
    s->V[3 * i] = s->X[3 * i + 1] > 0.0 ? b->speed : 0.0;
  if (b->moved)
    bw_solid_set_prescribed(s->solid, s->V);
  else
    bw_solid_set_state(s->solid, s->X, s->V);
  return BW_OK;
}
