/* wet.h -- a solid in a fluid of particles with walls, from shapes, for the claims about both. */
#pragma once
#include "bw_coupler_particles.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_validation.h"

#include <math.h>
#include <string.h>

static const double wet_g = 9.81;

enum { WET_SHAPES = 6 };

/* What there is: a composition of shapes each; shapes of the solid say which of it is held. */
typedef struct {
  bw_ulph_config fluid;
  bw_solid_config solid;
  bw_coupler_particles_config coupler;
  int n_fluid, n_wall, n_solid;
  bw_shape in_fluid[WET_SHAPES], in_wall[WET_SHAPES], in_solid[WET_SHAPES];
  double surface; /* pressure of water at rest below this height; NaN: no pressure */
} wet_scene;

typedef struct {
  bw_ulph *fluid;
  bw_solid *solid;
  bw_coupler_particles *coupler;
  double *X, *X0; /* (n,3) of this rank's solid particles: places, where they were */
  size_t n;
} wet;

static inline bw_shape wet_box(double x0, double y0, double x1, double y1)
{
  return (bw_shape){.kind = BW_SHAPE_BOX, .lower = {x0, y0, 0}, .upper = {x1, y1, 1}};
}

/* The scene of a box of water in SI units without walls and solid, gravity along -y. */
static inline wet_scene wet_water(double dx, double speed)
{
  wet_scene s = {.fluid = bw_ulph_config_default(),
                 .solid = bw_solid_config_default(),
                 .coupler = bw_coupler_particles_config_default(),
                 .surface = NAN};
  s.fluid.dimensions = 2, s.fluid.dx = dx, s.fluid.rho0 = 1000, s.fluid.speed = speed;
  s.fluid.gravity[1] = s.coupler.gravity[1] = -wet_g;
  s.solid.geometry = BW_PD_PLANE_STRAIN;
  return s;
}

/* Correspondence with the shortest weights, which bends right with few layers. */
static inline void wet_rubber(wet_scene *s, double ds, double rho, double E, double nu)
{
  s->solid.ds = ds, s->solid.rho = rho, s->solid.E = E;
  s->solid.choice.law = BW_SOLID_CORRESPONDENCE, s->solid.choice.poisson_ratio = nu;
  s->solid.horizon_ratio = 1.5, s->solid.family_reach = BW_PD_REACH_HORIZON;
}

/* Walls around 0 .. width, open at the top. */
static inline void wet_tank(wet_scene *s, double width, double height)
{
  const double t = 4 * s->fluid.dx;
  s->n_wall = 2;
  s->in_wall[0] = wet_box(-t, -t, width + t, height);
  s->in_wall[1] = wet_box(0, 0, width, 9 * height);
  s->in_wall[1].remove = true;
}

static inline void wet_rest(const double x[3], void *context, double v[3], double *p)
{
  const wet_scene *s = context;
  v[0] = v[1] = v[2] = 0;
  *p = isnan(s->surface) ? 0 : fmax(0, s->fluid.rho0 * wet_g * (s->surface - x[1]));
}

static inline bw_status wet_solid(const bw_comm *comm, const wet_scene *s, bw_solid **out)
{
  const bw_shape_lattice lattice =
      bw_shape_lattice_straight(s->solid.ds, s->solid.origin, s->fluid.dimensions == 2);
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = bw_shape_fill(s->n_solid, s->in_solid, &lattice, 0, 1, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create_same(comm, &s->solid, n, site, kind, out));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static inline bw_status wet_make(const bw_comm *comm, wet_scene *s, wet *w)
{
  const double origin[3] = {0};
  const bw_ulph_wall wall = {.count = s->n_wall, .shape = s->in_wall};
  size_t count = 0;
  double *x = NULL;
  memset(w, 0, sizeof *w);
  bw_status st = wet_solid(comm, s, &w->solid);
  BW_THEN(st, bw_ulph_fill(comm, &s->fluid, origin, s->n_fluid, s->in_fluid, &count, &x));
  BW_THEN(st, bw_ulph_create(comm, &s->fluid, count, x, 1, &wall, &w->fluid));
  BW_THEN(st, bw_coupler_particles_create(&s->coupler, &s->fluid, w->fluid, w->solid, 1, &wall,
                                          &w->coupler));
  BW_THEN(st, bw_ulph_start(w->fluid, wet_rest, s));
  if (st == BW_OK) {
    w->n = bw_solid_count(w->solid);
    BW_THEN(st, BW_ALLOCATE(&w->X, 3 * w->n));
    BW_THEN(st, BW_ALLOCATE(&w->X0, 3 * w->n));
    if (st == BW_OK) bw_solid_get_reference(w->solid, w->X0);
  }
  bw_release(&x);
  return bw_comm_agree(comm, st);
}

static inline void wet_free(wet *w)
{
  bw_coupler_particles_destroy(&w->coupler);
  bw_ulph_destroy(&w->fluid);
  bw_solid_destroy(&w->solid);
  bw_release(&w->X);
  bw_release(&w->X0);
}

/* To the time `end`, the last step shorter. */
static inline bw_status wet_run(wet *w, double end)
{
  while (bw_ulph_time(w->fluid) < end * (1 - 1e-12)) {
    const double left = end - bw_ulph_time(w->fluid), dt = bw_coupler_particles_dt_max(w->coupler);
    BW_TRY(bw_coupler_particles_step(w->coupler, dt < left ? dt : left));
  }
  return BW_OK;
}

/* Mean displacement [L] of the solid particles that were within lower <= X0 < upper. */
static inline void wet_moved(wet *w, const double lower[2], const double upper[2], double u[2])
{
  double sum[3] = {0};
  bw_solid_get_position(w->solid, w->X);
  for (size_t i = 0; i < w->n; i++) {
    const double *X0 = w->X0 + 3 * i, *X = w->X + 3 * i;
    if (X0[0] < lower[0] || X0[0] >= upper[0] || X0[1] < lower[1] || X0[1] >= upper[1]) continue;
    sum[0] += X[0] - X0[0], sum[1] += X[1] - X0[1], sum[2] += 1;
  }
  bw_comm_sum(bw_solid_comm(w->solid), 3, sum);
  u[0] = sum[0] / sum[2], u[1] = sum[1] / sum[2];
}

/* Rows of every claim: the exchange, which has to be exact; how late loads came; the fluid's
 * book, to `gap`.
 */
static inline void wet_book(bw_validation *v, const wet *w, double gap)
{
  const bw_coupler_particles_report r = bw_coupler_particles_measure(w->coupler);
  const bw_ulph_ledger l = bw_ulph_account(w->fluid);
  const double work = fmax(fabs(r.given), fabs(r.received)), all = fmax(work, 1e-300);
  double momentum = 0, size = 0;
  for (int k = 0; k < 3; k++) {
    momentum += fabs(l.push[4][k] + r.impulse[k] + r.pending[k]);
    size += fabs(r.impulse[k]);
  }
  const struct {
    const char *quantity;
    double measured, tolerance;
  } row[] = {{"momentum_between", momentum / size, 1e-11},
             {"work_between", (r.given + r.late - r.received) / all, 1e-11},
             {"late_work", r.late / all, INFINITY},
             {"book_gap_of_the_fluid", l.gap / l.first, gap}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++)
    bw_validation_row(v, &(bw_claim){.claim = "what the fluid loses the solid gets",
                                     .quantity = row[q].quantity,
                                     .measured = row[q].measured,
                                     .reference = 0,
                                     .tolerance = row[q].tolerance,
                                     .kind = BW_CONSERVATION,
                                     .source = "pair forces"});
}
