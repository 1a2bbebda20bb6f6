/* A fluid of particles: what it is, its step with or without a solid, its state in a checkpoint. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_number.h"
#include <math.h>
#include <string.h>

void bw_scene__water_destroy(bw_scene *s)
{
  if (s->water == NULL) return;
  bw_coupler_particles_destroy(&s->water->both);
  bw_ulph_destroy(&s->water->fluid);
  bw_release(&s->water);
}

/* The walls begin at rest where they were built. */
static void shake(double t, void *context, double x[3], double v[3], double a[3])
{
  const bw_scene_shake *m = context;
  const double w = 2.0 * acos(-1.0) * m->frequency;
  for (int k = 0; k < 3; k++) {
    x[k] = m->amplitude[k] * (cos(w * t) - 1.0);
    v[k] = -m->amplitude[k] * w * sin(w * t);
    a[k] = -m->amplitude[k] * w * w * cos(w * t);
  }
}

/* 2 sqrt(g H): what a dam break reaches, with the height H of the fluid along gravity; no less than
 * the speed that the fluid begins with. */
static bw_status expected_speed(const bw_scene *s, double *speed)
{
  bw_scene__shapes *fluid = NULL;
  double fall = 0.0;
  const double *v = s->config.fluid.start.velocity, first = hypot(hypot(v[0], v[1]), v[2]);
  *speed = s->config.fluid.speed;
  BW_REQUIRE(!(*speed < first), BW_EINPUT,
             "fluid.speed = %g: fluid.start.velocity is %g already; give at least that", *speed,
             first);
  if (!isnan(*speed)) return BW_OK;
  bw_status st = BW_ALLOCATE(&fluid, 1);
  BW_THEN(st, bw_scene__shapes_make(&s->config, BW_SCENE__FLUID, fluid));
  for (int d = 0; st == BW_OK && d < 3; d++)
    if (s->config.gravity[d] != 0.0)
      fall += fabs(s->config.gravity[d]) * (fluid->upper[d] - fluid->lower[d]);
  if (fluid != NULL) bw_scene__shapes_release(fluid);
  bw_release(&fluid);
  BW_TRY(st);
  *speed = fmax(2.0 * sqrt(fall), first);
  BW_REQUIRE(*speed > 0.0, BW_EINPUT,
             "fluid.speed is missing: without gravity nothing says how fast the fluid will be");
  return BW_OK;
}

static double or_default(double given, double otherwise)
{
  return isnan(given) ? otherwise : given;
}

static bw_status configure(bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  const bw_scene_numerics *n = &c->numerics;
  bw_ulph_config *f = &s->water->config;
  *f = bw_ulph_config_default();
  f->dimensions = s->planar ? 2 : 3;
  f->dx = c->domain.length[1] / c->domain.cells[1];
  f->rho0 = c->fluid.density;
  f->mu = c->fluid.density * c->fluid.viscosity;
  f->c0 = n->sound_speed;
  f->alpha = or_default(n->artificial_viscosity, f->alpha);
  f->alpha_wall = or_default(n->wall_viscosity, f->alpha_wall);
  f->delta = or_default(n->density_diffusion, f->delta);
  f->shifting = or_default(n->shifting, f->shifting);
  memcpy(f->gravity, c->gravity, sizeof f->gravity);
  if (c->domain.has_shake) {
    f->motion = shake;
    f->motion_context = &s->config.domain.shake;
  }
  return expected_speed(s, &f->speed);
}

bw_status bw_scene__water_create(bw_scene *s)
{
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&s->water, 1)));
  BW_TRY(bw_comm_agree(s->comm, configure(s)));
  return bw_scene__water_make(s);
}

double bw_scene__water_limit(bw_scene *s)
{
  const bw_scene__water *w = s->water;
  /* Of a plan with a solid there may be the fluid alone. */
  const double share =
      w->both == NULL && s->n_solids > 0 ? bw_coupler_particles_config_default().step_share : 1.0;
  return w->both != NULL ? bw_coupler_particles_dt_max(w->both) : share * bw_ulph_dt_max(w->fluid);
}

/* Has more than one particle in a hundred left the box, by more than a spacing (a thin sheet lies
 * some tenths of one in its wall)? Looked at now and then. */
static bw_status look_outside(const bw_scene *s)
{
  enum { EVERY = 64 };
  const double margin = s->water->config.dx;
  double at[3], lower[3], upper[3];
  if (s->steps % EVERY != 0) return BW_OK;
  bw_scene__water_where(s, at);
  for (int d = 0; d < 3; d++) {
    lower[d] = bw_scene__is_open(&s->config, d, 0) ? -1e30 : at[d] - margin;
    upper[d] =
        bw_scene__is_open(&s->config, d, 1) ? 1e30 : at[d] + s->config.domain.length[d] + margin;
  }
  const int64_t outside = bw_ulph_outside(s->water->fluid, lower, upper);
  const int64_t total = bw_ulph_total(s->water->fluid);
  BW_REQUIRE(outside <= total / 100, BW_EDIVERGED,
             "at t = %g %lld of %lld particles of the fluid have left the box: over the rim of its "
             "walls (make it higher: domain.length) or through them (take smaller steps: "
             "numerics.step_share, or more particles)",
             s->time, (long long)outside, (long long)total);
  return BW_OK;
}

bw_status bw_scene__water_step(bw_scene *s, double dt)
{
  bw_scene__water *w = s->water;
  BW_TRY(look_outside(s));
  /* Prescribed particles are told where to go; the coupler knows all other loads. */
  if (w->both != NULL) BW_TRY(bw_scene__loads_apply(s, dt));
  BW_TRY(w->both != NULL ? bw_coupler_particles_step(w->both, dt) : bw_ulph_step(w->fluid, dt));
  bw_scene__water_gather(s, dt);
  return BW_OK;
}

bw_status bw_scene__water_save(bw_scene *s, bw_checkpoint *ck)
{
  bw_scene__water *w = s->water;
  BW_TRY(bw_checkpoint_put_numbers(ck, "scene/patches", BW_SCENE_GAUGES, w->patch));
  BW_TRY(bw_checkpoint_put_numbers(ck, "scene/covered", 1, &w->covered));
  return w->both != NULL ? bw_coupler_particles_save(w->both, ck)
                         : bw_coupler_particles_save_fluid(s->comm, w->fluid, ck);
}

bw_status bw_scene__water_restore(bw_scene *s, bw_checkpoint *ck)
{
  bw_scene__water *w = s->water;
  BW_TRY(bw_checkpoint_get_numbers(ck, "scene/patches", BW_SCENE_GAUGES, w->patch));
  BW_TRY(bw_checkpoint_get_numbers(ck, "scene/covered", 1, &w->covered));
  return w->both != NULL ? bw_coupler_particles_restore(w->both, ck)
                         : bw_coupler_particles_restore_fluid(s->comm, w->fluid, ck);
}
