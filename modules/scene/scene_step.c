/* Time: phases, the longest step, the step itself. */
#include "scene_impl.h"

#include "bw_number.h"
#include <limits.h>
#include <math.h>
#include <string.h>

/* Steps between two looks at whether a phase has settled. */
enum { SETTLE_EVERY = 20 };

double bw_scene_time(const bw_scene *s)
{
  return s->time;
}

int64_t bw_scene_steps(const bw_scene *s)
{
  return s->steps;
}

double bw_scene_last_step(const bw_scene *s)
{
  return s->dt;
}

int bw_scene_phase_now(const bw_scene *s)
{
  return s->phase;
}

bool bw_scene_done(const bw_scene *s)
{
  return s->phase >= s->config.n_phases;
}

double bw_scene__end(const bw_scene *s)
{
  return s->config.phases[s->config.n_phases - 1].until.time;
}

void bw_scene_expect(bw_scene *s, bool measured)
{
  s->watched = measured;
  if (s->coupler != NULL) bw_coupler_watch(s->coupler, measured);
}

/* What a phase allows: who stands still, damping, breaking. */
bw_status bw_scene__phase_begin(bw_scene *s)
{
  if (bw_scene_done(s)) return BW_OK;
  const bw_scene_phase *p = &s->config.phases[s->phase];
  const bw_scene_numerics *n = &s->config.numerics;
  s->settled_energy = NAN;
  for (int q = 0; q < s->n_solids && !s->sketched; q++) {
    bool breaks = false;
    for (int k = 0; k < s->solid[q].n_bodies; k++)
      breaks = breaks || s->config.bodies[s->solid[q].body[k]].motion == BW_SCENE_BREAKABLE;
    bw_solid_enable_breakage(s->solid[q].solid, breaks && p->breaking != 0);
    bw_solid_set_damping(s->solid[q].solid, n->damping_pair, n->damping_mean,
                         n->damping_absolute + p->damp);
  }
  /* Nothing that deforms: the solid of the coupler stands as it is. */
  const bool held = p->hold[0] != '\0' || !s->alive;
  if (s->coupler != NULL) bw_coupler_hold_solid(s->coupler, held);
  if (s->water != NULL && s->water->both != NULL) bw_coupler_particles_hold(s->water->both, held);
  return BW_OK;
}

/* Longest step of rigid bodies without fluid: of springs and contact, and a spacing's way. */
static double rigid_limit(const bw_scene *s)
{
  double spacing = HUGE_VAL;
  if (s->rigid == NULL) return HUGE_VAL;
  for (int b = 0; b < s->config.n_bodies; b++)
    if (s->rigid_of[b] >= 0) spacing = fmin(spacing, s->config.bodies[b].spacing);
  const double speed = bw_scene__rigid_speed(s);
  return fmin(bw_rigid_dt_max(s->rigid), speed > 0.0 ? spacing / speed : HUGE_VAL);
}

/* Longest step without fluid, before the share. */
static double solid_limit(const bw_scene *s)
{
  double limit = rigid_limit(s);
  if (s->assembly != NULL) return fmin(limit, bw_solid_assembly_dt(s->assembly));
  for (int q = 0; q < s->n_solids; q++) {
    const bw_scene__solid *p = &s->solid[q];
    const double a = s->sketched ? p->sample.dt_max : bw_solid_dt_max(p->solid);
    const double b = s->sketched ? p->sample.dt_contact : bw_solid_dt_contact(p->solid);
    limit = fmin(limit, 1.0 / sqrt(1.0 / (a * a) + 1.0 / (b * b)));
  }
  return limit;
}

/* What the plan of the flow bears at the velocity of the start, which the plan does not know, by
 * the formula of bw_ns_channel_dt_max: with what the plan has of viscosity and a gradient where
 * nothing moves in it yet, else, for even cells, with viscosity. */
static double planned_limit(bw_scene *s)
{
  static const double imaginary = 1.7320508075688772;
  const bw_ns_viscous viscous = (bw_ns_viscous)s->config.numerics.viscous;
  const double real = viscous == BW_VISCOUS_EXPLICIT ? 2.5127453 : 2.47; /* ERRATA 37 */
  const double *h = bw_grid_look(s->grid)->spacing, c = bw_scene__start_rate(s) / imaginary;
  double v = 0.0;
  for (int d = 0; d < (s->planar ? 2 : 3) && viscous != BW_VISCOUS_IMPLICIT; d++)
    if (d != 1 || viscous == BW_VISCOUS_EXPLICIT)
      v += 4.0 * s->config.fluid.viscosity / (h[d] * h[d]) / real;
  const double own = 1.0 / s->flow_plan.dt_max;
  return 1.0 / (s->speed > 0.0 ? fmax(own, hypot(c, v)) : hypot(c, own));
}

double bw_scene__fluid_limit(bw_scene *s)
{
  return s->planned ? planned_limit(s) : bw_ns_channel_dt_max(s->fluid);
}

/* Longest step of the fluid: of its field, and of what sides and bodies will bring. */
static double fluid_limit(bw_scene *s)
{
  const double h = bw_grid_look(s->grid)->spacing[0];
  const double speed = fmax(s->speed, bw_scene__rigid_speed(s));
  const double coming = speed > 0.0 ? h / speed : INFINITY;
  return fmin(bw_scene__fluid_limit(s), coming);
}

double bw_scene__solid_limit(const bw_scene *s)
{
  return solid_limit(s);
}

double bw_scene__limit(bw_scene *s)
{
  const bw_scene_numerics *n = &s->config.numerics;
  const double own = bw_scene_done(s) ? NAN : s->config.phases[s->phase].step;
  if (!isnan(own)) return own;
  if (!isnan(n->step)) return n->step;
  return n->step_share * (s->water != NULL  ? bw_scene__water_limit(s)
                          : s->grid != NULL ? fluid_limit(s)
                                            : solid_limit(s));
}

/* Where the step has to end at the latest. */
static double next_end(const bw_scene *s, double until)
{
  const double end = s->config.phases[s->phase].until.time;
  return isnan(end) ? until : fmin(end, until);
}

/* Steps of equal length to the end; *last: this is the last of them. */
static bw_status choose_step(bw_scene *s, double end, double *dt, bool *last)
{
  const double longest = bw_scene__limit(s), span = end - s->time;
  int64_t left = 0;
  *last = false;
  BW_REQUIRE(
      isfinite(longest) || isfinite(end), BW_EINPUT,
      "phases.%d.until: nothing limits the step and the phase has no time; give until.time or "
      "numerics.step",
      s->phase);
  if (!isfinite(end)) {
    *dt = longest;
    return BW_OK;
  }
  const double count = fmax(1.0, ceil(span / longest * (1.0 - 1e-12)));
  BW_REQUIRE(
      bw_to_int64(count, &left) && left <= BW_MOST_STEPS && s->time + span / count > s->time,
      BW_EDIVERGED,
      "at t = %g the largest step is %.3g: %.3g steps to t = %g; velocities are too large, or "
      "a body too stiff, for its spacing",
      s->time, longest, count, end);
  *dt = span / (double)left;
  *last = left == 1;
  return BW_OK;
}

/* Solids without fluid. */
static bw_status solids_step(bw_scene *s, double dt)
{
  BW_TRY(bw_scene__solids_adapt(s));
  BW_TRY(bw_scene__loads_apply(s, dt));
  if (s->assembly != NULL) return bw_solid_assembly_step(s->assembly, dt);
  for (int q = 0; q < s->n_solids; q++)
    BW_TRY(bw_solid_step(s->solid[q].solid, dt));
  return BW_OK;
}

static bw_status advance(bw_scene *s, double dt)
{
  if (s->water != NULL) return bw_scene__water_step(s, dt);
  if (s->coupler != NULL) {
    BW_TRY(bw_scene__loads_apply(s, dt));
    BW_TRY(bw_coupler_step(s->coupler, dt));
    bw_coupler_tell_limit(s->coupler, s->log);
    return BW_OK;
  }
  if (s->floats != NULL) {
    bw_scene__rigid_tell(s, dt);
    return bw_coupler_rigid_step(s->floats, dt);
  }
  if (s->markers != NULL) return bw_scene__surfaces_step(s, dt);
  if (s->fluid != NULL) return bw_ns_channel_step(s->fluid, dt);
  return s->rigid != NULL ? bw_scene__rigid_step(s, dt, solids_step) : solids_step(s, dt);
}

/* Has what moves come to rest? Collective. */
static bw_status settled(bw_scene *s, double level, bool *rest)
{
  *rest = false;
  if (s->phase_steps % SETTLE_EVERY != 0) return BW_OK;
  if (s->fluid != NULL) {
    const double energy = bw_ns_channel_summary(s->fluid).kinetic_energy;
    *rest = fabs(energy - s->settled_energy) <= level * fabs(energy);
    s->settled_energy = energy;
    return BW_OK;
  }
  if (s->water != NULL) {
    /* What starts from rest has still to move, and a swell is at rest twice in its period: the
     * largest of late, which fades. */
    static const double fades = 0.95; /* from look to look */
    const bw_ulph_ledger l = bw_ulph_account(s->water->fluid);
    const double before = isnan(s->settled_energy) ? fabs(l.potential) : s->settled_energy;
    s->settled_energy = fmax(l.kinetic, fades * before);
    *rest = s->settled_energy <= level * fabs(l.potential);
    return BW_OK;
  }
  double kinetic = 0.0, elastic = 0.0;
  for (int q = 0; q < s->n_solids; q++) {
    bw_solid_ledger book;
    BW_TRY(bw_solid_account(s->solid[q].solid, &book));
    kinetic += book.kinetic, elastic += book.elastic;
  }
  if (s->rigid != NULL) {
    const bw_rigid_energy e = bw_rigid_energy_of(s->rigid);
    kinetic += e.kinetic, elastic += e.spring + e.contact;
  }
  *rest = elastic > 0.0 && kinetic <= level * elastic;
  return BW_OK;
}

/* Has the phase ended? Then the next one begins. Collective. */
static bw_status turn_phase(bw_scene *s)
{
  const bw_scene_until *u = &s->config.phases[s->phase].until;
  bool over = s->time >= u->time || (u->steps != INT_MIN && s->phase_steps >= u->steps);
  if (!over && !isnan(u->settled)) BW_TRY(settled(s, u->settled, &over));
  if (!over) return BW_OK;
  s->phase++;
  s->phase_steps = 0;
  s->phase_start = s->time;
  return bw_scene__phase_begin(s);
}

bw_status bw_scene_step(bw_scene *s, double until)
{
  double dt = 0.0;
  bool last = false;
  BW_REQUIRE(!bw_scene_done(s), BW_EINPUT, "scene: all phases have ended at t = %g", s->time);
  const double end = next_end(s, until);
  BW_REQUIRE(end > s->time, BW_EINPUT, "scene: a step to t = %g, but it is %g", end, s->time);
  BW_TRY(choose_step(s, end, &dt, &last));
  BW_TRY(advance(s, dt));
  s->dt = dt;
  /* Exactly the end: rounding does not add up. */
  s->time = last ? end : s->time + dt;
  if (s->fluid != NULL) bw_ns_channel_set_time(s->fluid, s->time);
  if (s->water != NULL) bw_ulph_set_time(s->water->fluid, s->time);
  s->steps++;
  s->phase_steps++;
  bw_scene__cost_add(s, dt);
  BW_TRY(bw_scene__look(s));
  return turn_phase(s);
}
