/* Sizes that cannot be meant, by dimensionless groups: what no key can tell by itself. Limits are
 * far beyond what anybody computes, so that they meet slips of the pen and of units alone. */
#include "scene_impl.h"

#include "bw_number.h"
#include <math.h>

/* Spacings passed in a step, or by which a step is accelerated; damped or viscous over undamped;
 * a ramp over the run; densities of a solid over that of its fluid; of a spacing, what sound passes
 * in the whole run. */
static const double MOST_SPACINGS = 1e3, MOST_DAMPING = 1e6, MOST_CELL_REYNOLDS = 1e12,
                    LONGEST_RAMP = 1e6, LEAST_DENSITY = 1e-6, MOST_DENSITY = 1e9,
                    LEAST_SOUND = 1e-6;
/* The drag of a cylinder of 5 cells is a third of what is measured from 90 on. */
static const double BODY_CELL_REYNOLDS = 50.0;

static double length_of(const double v[3])
{
  return hypot(hypot(v[0], v[1]), v[2]);
}

/* Does it move by forces? */
static bool driven(const bw_scene_body *b)
{
  return bw_scene__deforms(b) || b->motion == BW_SCENE_RIGID;
}

/* The step is what cells, stiffness and damping bear. */
static bw_status check_steps(const bw_scene *s, double dt)
{
  const double end = bw_scene__end(s), steps = (end - s->time) / dt;
  BW_REQUIRE(
      isnan(end) || steps <= (double)BW_MOST_STEPS, BW_EINPUT,
      "phases.%d.until.time = %g takes %.3g steps of %g, more than the %g that anybody can "
      "wait for: a speed, a viscosity, a stiffness or a damping is too large for the spacing",
      s->config.n_phases - 1, end, steps, dt, (double)BW_MOST_STEPS);
  return BW_OK;
}

/* What viscosity does in a cell against what the stream does. */
static bw_status check_fluid(const bw_scene *s)
{
  const double h = bw_grid_look(s->grid)->spacing[1], nu = s->config.fluid.viscosity;
  BW_REQUIRE(
      s->speed * h / nu <= MOST_CELL_REYNOLDS, BW_EINPUT,
      "fluid.viscosity = %g: with the speed %g that the file names, the cell Reynolds number "
      "is %.3g; at most %g, beyond which rounding hides the viscosity; check its unit",
      nu, s->speed, s->speed * h / nu, MOST_CELL_REYNOLDS);
  if (s->config.n_bodies > 0 && s->speed * h / nu > BODY_CELL_REYNOLDS)
    bw_log_warn(s->log,
                "the cell Reynolds number is %.3g with the speed %g that the file names: above %g "
                "layers around bodies are thinner than cells, and forces come out too low; take "
                "%.1f times as many cells in each direction, or a larger viscosity",
                s->speed * h / nu, s->speed, BODY_CELL_REYNOLDS,
                s->speed * h / nu / BODY_CELL_REYNOLDS);
  return BW_OK;
}

/* What comes in or moves too late, and what begins too fast. */
static bw_status check_flow(const bw_scene *s, double dt)
{
  const bw_scene_fluid *f = &s->config.fluid;
  const bw_scene_pair *const pair[] = {&f->sides.x, &f->sides.y, &f->sides.z};
  const double end = bw_scene__end(s), h = bw_grid_look(s->grid)->spacing[1];
  for (int d = 0; d < 6; d++) {
    const bw_scene_side *q = d % 2 == 0 ? &pair[d / 2]->lower : &pair[d / 2]->upper;
    BW_REQUIRE(isnan(end) || q->ramp <= LONGEST_RAMP * end, BW_EINPUT,
               "fluid.sides.%c.%s.ramp = %g is %.3g times the run, %g: nothing would move",
               "xyz"[d / 2], d % 2 == 0 ? "lower" : "upper", q->ramp, q->ramp / end, end);
  }
  const double passed = length_of(f->start.velocity) * dt / h;
  BW_REQUIRE(
      passed <= MOST_SPACINGS, BW_EINPUT,
      "fluid.start.velocity: %g passes %.3g cells in a step of %g, at most %g; check its unit",
      length_of(f->start.velocity), passed, dt, MOST_SPACINGS);
  return BW_OK;
}

/* Material m of a body that moves: against the fluid, and how far sound comes in it. */
static bw_status check_material(const bw_scene *s, const bw_scene_body *b, int m)
{
  const bw_scene_material *q = &s->config.materials[m];
  const double end = bw_scene__end(s), sound = sqrt(q->young_modulus / q->density);
  const double ratio = s->grid != NULL ? q->density / s->config.fluid.density : 1.0;
  BW_REQUIRE(ratio >= LEAST_DENSITY && ratio <= MOST_DENSITY, BW_EINPUT,
             "materials.%s.density = %g is %.3g times fluid.density = %g: from %g to %g times is "
             "possible, beyond which rounding hides what one does to the other",
             q->name, q->density, ratio, s->config.fluid.density, LEAST_DENSITY, MOST_DENSITY);
  BW_REQUIRE(
      !bw_scene__deforms(b) || isnan(end) || sound * end / b->spacing >= LEAST_SOUND, BW_EINPUT,
      "materials.%s: sound, of %g by young_modulus and density, passes %.3g of a particle of %s "
      "until the end at %g; at least %g, below which rounding hides what it does",
      q->name, sound, sound * end / b->spacing, b->name, end, LEAST_SOUND);
  return BW_OK;
}

/* Damping of a phase: its rate times the step that stiffness bears. Collective. */
static bw_status check_damping(bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  /* The step without what phases add, and back. */
  for (int q = 0; q < s->n_solids && !s->sketched; q++)
    bw_solid_set_damping(s->solid[q].solid, c->numerics.damping_pair, c->numerics.damping_mean,
                         c->numerics.damping_absolute);
  const double alone = bw_scene__solid_limit(s), dt = isfinite(alone) ? alone : bw_scene__limit(s);
  BW_TRY(bw_scene__phase_begin(s));
  for (int b = 0; b < c->n_bodies; b++) {
    const int m = bw_scene__material_named(c, c->bodies[b].material);
    if (!driven(&c->bodies[b]) || m < 0) continue;
    for (int p = 0; p < c->n_phases; p++) {
      const double rate = c->phases[p].damp / c->materials[m].density;
      BW_REQUIRE(rate * dt <= MOST_DAMPING, BW_EINPUT,
                 "phases.%d.damp = %g over materials.%s.density is the rate %.3g, %.3g per stable "
                 "step of %g: at most %g, beyond which nothing moves; take less",
                 p, c->phases[p].damp, c->materials[m].name, rate, rate * dt, dt, MOST_DAMPING);
    }
  }
  return BW_OK;
}

/* Velocity, turning and swinging of a body. */
static bw_status check_motion(const bw_scene *s, const bw_scene_body *b, double dt)
{
  const double passed = length_of(b->velocity) * dt / b->spacing;
  BW_REQUIRE(
      passed <= MOST_SPACINGS, BW_EINPUT,
      "bodies.%s.velocity: %g is %.3g of its spacings in a step of %g, at most %g; check its "
      "unit",
      b->name, length_of(b->velocity), passed, dt, MOST_SPACINGS);
  const double turned = b->has_rotation ? fabs(b->rotation.rate) * dt : 0.0;
  BW_REQUIRE(turned <= MOST_SPACINGS, BW_EINPUT,
             "bodies.%s.rotation.rate = %g turns it by %.3g in a step of %g, at most %g; check its "
             "unit",
             b->name, b->rotation.rate, turned, dt, MOST_SPACINGS);
  const double fall = length_of(s->config.gravity) * dt * dt / b->spacing;
  BW_REQUIRE(!driven(b) || fall <= MOST_SPACINGS, BW_EINPUT,
             "gravity: by %g, %s falls %.3g of its spacings in a step of %g, at most %g; check its "
             "unit",
             length_of(s->config.gravity), b->name, fall, dt, MOST_SPACINGS);
  return BW_OK;
}

/* By how many spacings a load moves, in a step, the particles that take it. */
static double moved_by(const bw_scene *s, const bw_scene_load *l, const bw_scene_body *b,
                       double rho, double dt)
{
  const double size = length_of(l->value), ds = b->spacing, square = dt * dt / ds;
  const double particle = rho * ds * ds * (s->planar ? s->config.thickness : ds);
  switch ((bw_scene_load_kind)l->kind) {
  case BW_SCENE_TRACTION:
  case BW_SCENE_PRESSURE:
    return size / (rho * ds) * square;
  case BW_SCENE_FORCE: {
    /* It is shared among the body's particles, or some of them. */
    double volume = 1.0;
    bw_scene__shapes shapes;
    const int q = (int)(b - s->config.bodies);
    if (bw_scene__shapes_make(&s->config, q, &shapes) == BW_OK)
      for (int d = 0; d < (s->planar ? 2 : 3); d++)
        volume *= fmax(1.0, (shapes.upper[d] - shapes.lower[d]) / ds);
    bw_scene__shapes_release(&shapes);
    return size / (particle * volume) * square;
  }
  case BW_SCENE_GRAVITY:
    return size * square;
  case BW_SCENE_VELOCITY:
    return size * dt / ds;
  }
  return 0.0;
}

static bw_status check_loads(const bw_scene *s, double dt)
{
  const bw_scene_config *c = &s->config;
  for (int q = 0; q < c->n_loads; q++) {
    const bw_scene_load *l = &c->loads[q];
    const int b = bw_scene__body_named(c, l->on);
    const int m = b < 0 ? -1 : bw_scene__material_named(c, c->bodies[b].material);
    if (m < 0) continue;
    const double end = bw_scene__end(s);
    BW_REQUIRE(isnan(end) || l->ramp <= LONGEST_RAMP * end, BW_EINPUT,
               "loads.%d.ramp = %g is %.3g times the run, %g: nothing would be loaded", q, l->ramp,
               l->ramp / end, end);
    const double moved = moved_by(s, l, &c->bodies[b], c->materials[m].density, dt);
    BW_REQUIRE(
        moved <= MOST_SPACINGS, BW_EINPUT,
        "loads.%d.value: %g moves particles of %s by %.3g of their spacings in a step of %g, "
        "at most %g; check its unit",
        q, length_of(l->value), l->on, moved, dt, MOST_SPACINGS);
  }
  return BW_OK;
}

bw_status bw_scene__check_sizes(bw_scene *s)
{
  const double dt = bw_scene__limit(s);
  if (s->n_solids > 0 || s->rigid != NULL) BW_TRY(check_damping(s));
  /* Nothing limits the step: that of a phase does, later. */
  if (!isfinite(dt)) return BW_OK;
  BW_TRY(check_steps(s, dt));
  if (s->grid != NULL) BW_TRY(check_fluid(s));
  if (s->grid != NULL) BW_TRY(check_flow(s, dt));
  for (int b = 0; b < s->config.n_bodies; b++) {
    const bw_scene_body *body = &s->config.bodies[b];
    const int m = bw_scene__material_named(&s->config, body->material);
    if (driven(body) && m >= 0) BW_TRY(check_material(s, body, m));
    BW_TRY(check_motion(s, body, dt));
  }
  return check_loads(s, dt);
}
