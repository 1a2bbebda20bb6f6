/* The relaxation of the load that is taken, where nobody gives one: by what was found to hold
 * (stability.c). */
#include "bw_coupler.h"
#include "coupler_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double CHANGED = 0.02; /* of the bonds broken since: the body is another */

static const double SLUGGISH = 0.01; /* of a load in a step: a hundred steps are a motion */

double bw_coupler__most(const bw_coupler *c)
{
  /* Loads of ten steps, without the noise of one; told the motion of each step, the fluid answers
   * with less of it, and what is held back of a load falls with the steps that it takes. */
  return c->config.predictor ? 0.3 : 0.1;
}

/* Ends of bonds that are broken, of all ranks; the load's share changes with them. Collective. */
static double count_broken(const bw_coupler *c)
{
  double broken = 0.0;
  for (size_t i = 0; i < c->n; i++)
    broken += c->broken[i];
  bw_comm_sum(bw_solid_comm(c->solid), 1, &broken);
  return broken;
}

/* What was left open is set; the load that is taken over belongs to the w of before. Local. */
static void use(bw_coupler *c, double w)
{
  const double before = c->config.load_relaxation;
  c->config.load_relaxation = w;
  for (size_t i = 0; before < 1.0 && i < 3 * c->n; i++)
    c->F[i] *= (1.0 - w) / (1.0 - before);
}

void bw_coupler__adopt_choice(bw_coupler *c, const double choice[BW_COUPLER__CHOICE])
{
  bw_coupler__choice *o = &c->choice;
  if (!o->open || choice[0] == 0.0) return;
  o->made = true, o->told = false;
  c->config.load_relaxation = choice[1]; /* the load taken over comes with it */
  o->dt = choice[2], o->broken = choice[3];
  o->limit.relaxation = choice[4], o->limit.added = choice[5];
}

void bw_coupler__get_choice(const bw_coupler *c, double choice[BW_COUPLER__CHOICE])
{
  const bw_coupler__choice *o = &c->choice;
  const double now[BW_COUPLER__CHOICE] = {
      o->open && o->made, c->config.load_relaxation, o->dt,
      o->broken,          o->limit.relaxation,       o->limit.added};
  memcpy(choice, now, sizeof now);
}

/* Does what was found hold for the step and the body of now? Collective. */
static bool is_known(const bw_coupler *c, double dt, double broken)
{
  static const double other = 1.5; /* step */
  const bw_coupler__choice *o = &c->choice;
  if (!o->made) return false;
  const double bonds = c->bonds * bw_comm_size(bw_solid_comm(c->solid));
  const bool step_known = dt < other * o->dt && o->dt < other * dt;
  return !o->open || (step_known && broken - o->broken <= CHANGED * bonds);
}

bw_status bw_coupler__choose(bw_coupler *c, double dt)
{
  bw_coupler__choice *o = &c->choice;
  if (!(o->open || c->config.check_relaxation) || c->config.coupling_iterations > 1) return BW_OK;
  const double broken = count_broken(c);
  if (is_known(c, dt, broken)) return BW_OK;
  BW_TRY(bw_coupler_find_limit(c, dt, &o->limit));
  o->made = true, o->told = false;
  o->dt = dt, o->broken = broken;
  const double limit = o->limit.relaxation; /* NaN: nothing could be measured */
  if (!o->open || isnan(limit)) return BW_OK;
  use(c, fmin(bw_coupler__most(c), BW_COUPLER__MARGIN * limit));
  return BW_OK;
}

void bw_coupler_tell_limit(bw_coupler *c, bw_log *log)
{
  bw_coupler__choice *o = &c->choice;
  const double w = c->config.load_relaxation, limit = o->limit.relaxation;
  if (!o->made || o->told || isnan(limit)) return;
  o->told = true;
  char found[192];
  snprintf(found, sizeof found,
           "explicit coupling holds below load_relaxation = %.3g (measured: in 12 steps the fluid "
           "adds %.3g times the mass that resists)",
           limit, o->limit.added);
  if (o->open && w < SLUGGISH)
    bw_log_warn(log,
                "%s: %.2g is taken, so that loads come in over %.0f steps, and motions of fewer "
                "feel but a part of them; take coupling_iterations of 50, or shorter steps",
                found, w, 1.0 / w);
  else if (o->open && w < bw_coupler__most(c))
    bw_log_info(log, "%s: %.2g is taken, so that loads come in over %.0f steps", found, w, 1.0 / w);
  else if (o->open)
    bw_log_info(log, "%s: %g is taken", found, w);
  else if (w > limit)
    bw_log_warn(log,
                "%s, and coupling.load_relaxation is %.3g: motions will grow; leave it out, "
                "or take %.2g or less",
                found, w, BW_COUPLER__MARGIN * limit);
  else if (w > BW_COUPLER__MARGIN * limit)
    bw_log_warn(log,
                "%s, and coupling.load_relaxation is %.3g, nearer than a factor of two; leave "
                "it out, or take %.2g or less",
                found, w, BW_COUPLER__MARGIN * limit);
}
