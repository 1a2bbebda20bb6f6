/* splash.h -- a square of water that hits an elastic block, without weight and walls. */
#pragma once
#include "bw_check.h"
#include "bw_coupler_particles.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <math.h>
#include <string.h>

enum { FLUID = 14, SOLID = 6 };

typedef struct {
  bw_ulph *fluid;
  bw_solid *solid;
  bw_coupler_particles *coupler;
} splash;

/* Towards the block, with some shear; C0 is 10. */
static inline void splash_start(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = 0.7 + 0.02 * x[1], v[1] = 0.1, v[2] = 0, *p = 0;
}

/* The block is `fine` times finer than the fluid, at rest beside it. */
static inline bw_solid_config splash_solid(int d, int fine)
{
  bw_solid_config s = bw_solid_config_default();
  s.geometry = d == 2 ? BW_PD_PLANE_STRAIN : BW_PD_3D;
  s.ds = 1.0 / fine, s.rho = 2.5, s.E = 2000, s.horizon_ratio = 2;
  s.origin[0] = FLUID, s.origin[1] = 4;
  return s;
}

static inline splash splash_make_safe(const bw_comm *comm, int d, int fine, double safety)
{
  const int n = SOLID * fine, deep = d == 3 ? n : 1, high = d == 3 ? 8 : FLUID;
  bw_ulph_config c = bw_ulph_config_default();
  bw_coupler_particles_config q = bw_coupler_particles_config_default();
  const bw_solid_config s = splash_solid(d, fine);
  const bw_shape water = {.kind = BW_SHAPE_BOX, .upper = {FLUID, high, d == 3 ? SOLID : 0}};
  const double origin[3] = {0};
  splash p = {NULL, NULL, NULL};
  int32_t *site = NULL;
  double *x = NULL;
  size_t count = 0;
  q.solid_safety = safety;
  c.dimensions = d, c.dx = 1, c.rho0 = 1, c.speed = 1;
  bw_check_ok(BW_ALLOCATE(&site, 3 * (size_t)(n * n * deep)));
  for (int k = 0; k < n * n * deep; k++)
    site[3 * k] = k % n, site[3 * k + 1] = k / n % n, site[3 * k + 2] = k / n / n;
  bw_check_ok(bw_solid_create_same(comm, &s, n * n * deep, site, NULL, &p.solid));
  bw_check_ok(bw_ulph_fill(comm, &c, origin, 1, &water, &count, &x));
  bw_check_ok(bw_ulph_create(comm, &c, count, x, 0, NULL, &p.fluid));
  bw_check_ok(bw_coupler_particles_create(&q, &c, p.fluid, p.solid, 0, NULL, &p.coupler));
  bw_check_ok(bw_ulph_start(p.fluid, splash_start, NULL));
  bw_release(&site);
  bw_release(&x);
  return p;
}

static inline splash splash_make(const bw_comm *comm, int d, int fine)
{
  return splash_make_safe(comm, d, fine, 0.8);
}

static inline void splash_free(splash *p)
{
  bw_coupler_particles_destroy(&p->coupler);
  bw_ulph_destroy(&p->fluid);
  bw_solid_destroy(&p->solid);
}

static inline void splash_advance(splash *p, int steps)
{
  for (int q = 0; q < steps; q++)
    bw_check_ok(bw_coupler_particles_step(p->coupler, bw_coupler_particles_dt_max(p->coupler)));
}
