/* tank.h -- a box with fluid in a part of it, for the claims about particles. */
#pragma once
#include "bw_memory.h"
#include "bw_ulph.h"
#include "bw_validation.h"
#include <math.h>
#include <string.h>

static const double tank_g = 9.81;

/* A tank 0 .. size with walls on all sides but the top (and, in 2D, but z), fluid from `lower` to
 * `upper`, and an obstacle where its upper corner is above its lower one. */
typedef struct {
  double size[3];
  double lower[3], upper[3];
  double obstacle[2][3];
  bool no_slip, moves;
} tank;

/* The walls: a box around the inside, which goes up without end; and the obstacle. */
static inline bw_status tank_create(const bw_comm *comm, const bw_ulph_config *c, const tank *t,
                                    bw_ulph **out)
{
  const double thick = 4 * c->dx;
  const bw_shape fluid = {.kind = BW_SHAPE_BOX,
                          .lower = {t->lower[0], t->lower[1], t->lower[2]},
                          .upper = {t->upper[0], t->upper[1], t->upper[2]}};
  const bw_shape wall[2] = {
      {.kind = BW_SHAPE_BOX,
       .lower = {-thick, -thick, -thick},
       .upper = {t->size[0] + thick, t->size[1], t->size[2] + thick}},
      {.kind = BW_SHAPE_BOX,
       .remove = true,
       .upper = {t->size[0], t->size[1] + 10 * thick, t->size[2]}},
  };
  const bw_shape block = {.kind = BW_SHAPE_BOX,
                          .lower = {t->obstacle[0][0], t->obstacle[0][1], t->obstacle[0][2]},
                          .upper = {t->obstacle[1][0], t->obstacle[1][1], t->obstacle[1][2]}};
  const bw_ulph_wall walls[2] = {
      {.count = 2, .shape = wall, .no_slip = t->no_slip, .moves = t->moves},
      {.count = 1, .shape = &block, .no_slip = t->no_slip}};
  const double origin[3] = {0, 0, 0};
  size_t n = 0;
  double *x = NULL;
  *out = NULL;
  bw_status st = bw_ulph_fill(comm, c, origin, 1, &fluid, &n, &x);
  const int count = t->obstacle[1][0] > t->obstacle[0][0] ? 2 : 1;
  BW_THEN(st, bw_ulph_create(comm, c, n, x, count, walls, out));
  bw_release(&x);
  return st;
}

/* Hydrostatic pressure below the surface at *(double *)context, with gravity along -y. */
typedef struct {
  double surface, rho;
} tank_water;

static inline void tank_rest(const double x[3], void *context, double v[3], double *p)
{
  const tank_water *w = context;
  v[0] = v[1] = v[2] = 0;
  *p = w->rho * tank_g * (w->surface - x[1]);
}

/* To the time `end` in steps of the recommended length, the last one shorter. */
static inline bw_status tank_run(bw_ulph *u, double end)
{
  while (bw_ulph_time(u) < end * (1 - 1e-12)) {
    const double left = end - bw_ulph_time(u), dt = bw_ulph_dt_max(u);
    BW_TRY(bw_ulph_step(u, dt < left ? dt : left));
  }
  return BW_OK;
}
