/* body.h -- a body of lattice sites for the tests of pd_interface: the solid, its interface, and
 * which sites have an open side (the exact surface), found without either. ds = 1. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_pd_interface.h"
#include "bw_shape.h"
#include <string.h>

typedef struct {
  int64_t n;
  int32_t *site;
  uint8_t *kind;
  int low[3], size[3]; /* bounding box */
  bool *solid;         /* (size) */
  bw_solid *pd;
  bw_pd_interface *pi;
} body;

static inline bool body_has(const body *b, const int at[3])
{
  size_t index = 0;
  for (int d = 2; d >= 0; d--) {
    const int q = at[d] - b->low[d];
    if (q < 0 || q >= b->size[d]) return false;
    index = index * (size_t)b->size[d] + (size_t)q;
  }
  return b->solid[index];
}

static inline void body_mark(body *b)
{
  int high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
  for (int d = 0; d < 3; d++)
    b->low[d] = INT32_MAX;
  for (int64_t q = 0; q < 3 * b->n; q++) {
    const int d = (int)(q % 3);
    if (b->site[q] < b->low[d]) b->low[d] = b->site[q];
    if (b->site[q] > high[d]) high[d] = b->site[q];
  }
  size_t cells = 1;
  for (int d = 0; d < 3; d++)
    b->size[d] = high[d] - b->low[d] + 1, cells *= (size_t)b->size[d];
  bw_check_ok(BW_ALLOCATE(&b->solid, cells));
  for (int64_t q = 0; q < b->n; q++) {
    size_t index = 0;
    for (int d = 2; d >= 0; d--)
      index = index * (size_t)b->size[d] + (size_t)(b->site[3 * q + d] - b->low[d]);
    b->solid[index] = true;
  }
}

/* Open sides of a site: neighbours that are missing, not counting those beyond the walls of ic;
 * periodic directions wrap. */
static inline int body_open_sides(const body *b, const bw_solid_config *c,
                                  const bw_pd_interface_config *ic, const int32_t site[3])
{
  int open = 0;
  for (int d = 0; d < (c->geometry == BW_PD_3D ? 3 : 2); d++)
    for (int side = -1; side <= 1; side += 2) {
      int at[3] = {site[0], site[1], site[2]};
      at[d] += side;
      const double x = c->origin[d] + at[d] + 0.5;
      if (ic->walled[d][0] && x < ic->lower[d]) continue;
      if (ic->walled[d][1] && x > ic->upper[d]) continue;
      bool there = body_has(b, at);
      for (int image = -1; image <= 1 && c->period[d] > 0.0; image += 2) {
        int wrapped[3] = {at[0], at[1], at[2]};
        wrapped[d] += image * (int)lround(c->period[d]);
        there = there || body_has(b, wrapped);
      }
      open += !there;
    }
  return open;
}

static inline bw_solid_config body_config(bool planar)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = planar ? BW_PD_PLANE_STRESS : BW_PD_3D;
  c.ds = 1.0;
  c.rho = 1.0;
  c.E = 1.0;
  return c;
}

static inline body body_create(int count, const bw_shape shape[], const bw_solid_config *c,
                               const bw_pd_interface_config *ic)
{
  body b;
  memset(&b, 0, sizeof b);
  const bw_shape_lattice lattice =
      bw_shape_lattice_straight(c->ds, c->origin, c->geometry != BW_PD_3D);
  bw_check_ok(bw_shape_fill(count, shape, &lattice, 0, 1, &b.n, &b.site, &b.kind, NULL));
  body_mark(&b);
  bw_check_ok(bw_solid_create_same(bw_check_world(), c, b.n, b.site, b.kind, &b.pd));
  bw_check_ok(bw_pd_interface_create(b.pd, ic, &b.pi));
  return b;
}

static inline void body_destroy(body *b)
{
  bw_pd_interface_destroy(&b->pi);
  bw_solid_destroy(&b->pd);
  bw_release(&b->solid);
  bw_release(&b->site);
  bw_release(&b->kind);
}

/* Sums over all ranks. */
static inline double body_sum(double x)
{
  bw_comm_sum(bw_check_world(), 1, &x);
  return x;
}

/* Own particles that are surface without an open side or the other way, of all ranks. */
static inline int body_wrong(const body *b, const bw_pd_interface_config *ic)
{
  const bool *surface = bw_pd_interface_is_surface(b->pi);
  const int64_t *id = bw_solid_id(b->pd);
  double wrong = 0.0;
  for (size_t h = 0; h < bw_solid_count(b->pd); h++) {
    const int open = body_open_sides(b, bw_solid_settings(b->pd), ic, &b->site[3 * id[h]]);
    wrong += surface[h] != (open > 0);
  }
  return (int)body_sum(wrong);
}
