/* Sizes that cannot be meant, by dimensionless groups: what no key can tell by itself. Limits are
 * far beyond what anybody computes, so that they meet slips of the pen and of units alone. */
#include "scene_impl.h"

#include "bw_number.h"
#include <math.h>

/* Spacings passed in a step, or by which a step is accelerated; damped or viscous over undamped. */
static const double MOST_SPACINGS = 1e3, MOST_DAMPING = 1e6, MOST_CELL_REYNOLDS = 1e12;

static double length_of(const double v[3])
{
  return hypot(hypot(v[0], v[1]), v[2]);
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
  const double dt = bw_scene__solid_limit(s);
  BW_TRY(bw_scene__phase_begin(s));
  for (int b = 0; b < c->n_bodies; b++) {
    const int m = bw_scene__material_named(c, c->bodies[b].material);
    if (!bw_scene__deforms(&c->bodies[b]) || m < 0) continue;
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
  BW_REQUIRE(bw_scene__deforms(b) == false || fall <= MOST_SPACINGS, BW_EINPUT,
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
  if (s->n_solids > 0) BW_TRY(check_damping(s));
  /* Nothing limits the step: that of a phase does, later. */
  if (!isfinite(dt)) return BW_OK;
  BW_TRY(check_steps(s, dt));
  if (s->grid != NULL) BW_TRY(check_fluid(s));
  for (int b = 0; b < s->config.n_bodies; b++)
    BW_TRY(check_motion(s, &s->config.bodies[b], dt));
  return check_loads(s, dt);
}
