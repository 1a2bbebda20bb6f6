/* cylinder_of_particles.h -- a solid whose particles are those of a lattice within a cylinder. */
#pragma once
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid.h"

/* Of diameter 1 about an axis along z; c: its lattice and material, in the plane. Collective. */
static inline bw_status cylinder_of_particles(const bw_comm *comm, double x, double y,
                                              const bw_solid_config *c, bw_solid **solid)
{
  const bw_shape cylinder = {.kind = BW_SHAPE_CYLINDER, .centre = {x, y}, .radius = 0.5, .axis = 2};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(c->ds, c->origin, true);
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = bw_shape_fill(1, &cylinder, &lattice, 0, 1, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create_same(comm, c, n, site, kind, solid));
  bw_release(&site);
  bw_release(&kind);
  return st;
}
