/* bw_bench_porous.h -- the porous medium of POROUS chapter 5, for benchmarks: 46 080 particles and
 * the ghost layers under it. */
#pragma once
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid.h"

static const double bw_bench_height = 0.1; /* of the channel [m] */
enum { BW_BENCH_CELLS = 64 };              /* over it */

/* G0: fracture energy [J/m2]; 0.05 in S1. Collective. */
static inline bw_status bw_bench_porous(const bw_comm *comm, double G0, bw_solid **solid)
{
  const double h = bw_bench_height, ds = h / BW_BENCH_CELLS, pitch = h / 4;
  const bw_shape body[] = {
      {.kind = BW_SHAPE_BOX, .lower = {0.25 * h, 0, 0}, .upper = {h, h, h}},
      {.kind = BW_SHAPE_PORES_SC,
       .remove = true,
       .radius = 0.5825 * pitch,
       .pitch = pitch,
       .centre = {0.25 * h + 0.5 * pitch, 0.5 * pitch, 0.5 * pitch}},
      {.kind = BW_SHAPE_BOX,
       .lower = {0.25 * h, -3 * ds, 0},
       .upper = {h, 0, h},
       .particle_kind = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE},
  };
  bw_solid_config c = bw_solid_config_default();
  c.ds = ds, c.rho = 3000, c.E = 1.0e8, c.G0 = G0, c.contact = true, c.period[2] = h;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(ds, c.origin, false);
  bw_status st = bw_shape_fill_shared(comm, 3, body, &lattice, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create(comm, &c, &(bw_pd_sites){n, site, kind, NULL}, solid));
  bw_release(&site);
  bw_release(&kind);
  return st;
}
