/* What a run would refuse, found in the file alone: fluid, materials, phases. */
#include "scene_check.h"

#include "bw_ns_channel.h"
#include "bw_solid.h"
#include "bw_solid_words.h"
#include <limits.h>
#include <math.h>
#include <string.h>

bool bw_scene__has_fluid(const bw_scene_config *c)
{
  return c->has_fluid && c->fluid.model == BW_SCENE_INCOMPRESSIBLE;
}

bool bw_scene__has_particles(const bw_scene_config *c)
{
  return c->has_fluid && c->fluid.model == BW_SCENE_PARTICLES;
}

bool bw_scene__has_flow(const bw_scene_config *c)
{
  return bw_scene__has_fluid(c) || bw_scene__has_particles(c);
}

bool bw_scene__deforms(const bw_scene_body *b)
{
  return b->motion == BW_SCENE_ELASTIC || b->motion == BW_SCENE_BREAKABLE;
}

bool bw_scene__joined(const bw_scene_config *c, int a, int b)
{
  const bw_scene_body *pair[2] = {&c->bodies[a], &c->bodies[b]};
  for (int q = 0; q < 2; q++)
    for (int k = 0; k < pair[q]->n_held; k++)
      if (strcmp(pair[q]->held[k].by, pair[1 - q]->name) == 0) return true;
  return false;
}

bool bw_scene__any_deforms(const bw_scene_config *c)
{
  for (int b = 0; b < c->n_bodies; b++)
    if (bw_scene__deforms(&c->bodies[b])) return true;
  return false;
}

/* Keys of a fluid of particles must not look as if they did something to a flow on a grid. */
static bw_status check_no_water(const bw_scene_config *c)
{
  const bw_scene_fluid *f = &c->fluid;
  const struct {
    const char *key;
    bool given;
  } rows[] = {{"domain.open", c->domain.open[0] != '\0'},
              {"domain.shake", c->domain.has_shake},
              {"fluid.shape", f->n_shape > 0},
              {"fluid.speed", !isnan(f->speed)},
              {"fluid.walls", f->walls != INT_MIN},
              {"fluid.start.hydrostatic", f->start.hydrostatic != INT_MIN}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    BW_REQUIRE(!rows[q].given, BW_EINPUT,
               "%s: it belongs to fluid.model: particles; leave it out, or give that model",
               rows[q].key);
  return BW_OK;
}

/* Films are those of bodies in a flow, and thinner than the grid. */
static bw_status check_films(const bw_scene_config *c)
{
  const double h = c->domain.length[1] / c->domain.cells[1], limit = c->fluid.film_limit;
  const double roughness = c->fluid.film_roughness;
  const double least = c->fluid.film_least;
  BW_REQUIRE(isnan(least) || !isnan(roughness), BW_EINPUT,
             "fluid.film_least = %g: films have a fluid.film_roughness; give it, or leave both out",
             least);
  BW_REQUIRE(isnan(limit) || !isnan(roughness), BW_EINPUT,
             "fluid.film_limit = %g: films have a fluid.film_roughness; give it, or leave both out",
             limit);
  BW_REQUIRE(c->fluid.film_flux == 0 || (!isnan(roughness) && bw_scene__any_deforms(c)), BW_EINPUT,
             "fluid.film_flux: it is that of films (fluid.film_roughness) between bodies that "
             "deform; leave it out");
  if (isnan(roughness)) return BW_OK;
  BW_REQUIRE(bw_scene__any_rigid(c) || bw_scene__any_deforms(c), BW_EINPUT,
             "fluid.film_roughness = %g: films brake bodies that are rigid or deform, and there is "
             "none; leave it out",
             roughness);
  BW_REQUIRE(isnan(least) || !bw_scene__any_rigid(c), BW_EINPUT,
             "fluid.film_least = %g: films between rigid bodies bear any pressure; leave it out",
             least);
  BW_REQUIRE(isnan(least) || least <= 0.0, BW_EINPUT,
             "fluid.film_least = %g: a film bears the pressure 0; give 0, or less", least);
  BW_REQUIRE(roughness <= h, BW_EINPUT,
             "fluid.film_roughness = %g: must be at most a cell, %g: the grid resolves the gap of "
             "rougher faces; leave it out",
             roughness, h);
  BW_REQUIRE(isnan(limit) || limit >= h, BW_EINPUT,
             "fluid.film_limit = %g: must be at least a cell, %g; leave it out for three", limit,
             h);
  return BW_OK;
}

bw_status bw_scene__check_fluid(const bw_scene_config *c)
{
  const bw_scene_fluid *f = &c->fluid;
  BW_REQUIRE(bw_scene__has_flow(c) == c->has_domain, BW_EINPUT,
             c->has_domain ? "domain is given without a fluid; leave it out for solids alone, or "
                             "give fluid"
                           : "fluid is given without its box; give domain: length and cells");
  if (!c->has_domain) return BW_OK;
  const bool flat = c->domain.cells[2] == 1;
  BW_REQUIRE(
      flat == (c->plane == BW_SCENE_STRAIN) && c->plane != BW_SCENE_STRESS, BW_EINPUT,
      "plane: a fluid in two dimensions (domain.cells[2] = 1) goes with plane: strain, one in "
      "space with plane: none; leave plane out");
  if (bw_scene__has_particles(c)) return bw_scene__check_water(c);
  BW_TRY(check_no_water(c));
  BW_REQUIRE(f->has_sides, BW_EINPUT,
             "fluid.sides is missing: what the sides of the box are to a flow on a grid");
  BW_REQUIRE(f->start.file[0] == '\0', BW_EINPUT,
             "fluid.start.file = %s: not in this build; start from velocity and vortices",
             f->start.file);
  BW_REQUIRE(!f->start.developed || (f->sides.x.lower.kind == BW_SIDE_INFLOW &&
                                     f->sides.x.lower.profile == BW_PROFILE_POISEUILLE),
             BW_EINPUT,
             "fluid.start.developed: there is no poiseuille inflow at the lower x side to take the "
             "profile of; leave it out");
  BW_REQUIRE(
      c->domain.stretch == 0.0 || c->n_bodies == 0, BW_EINPUT,
      "domain.stretch = %g: bodies in a flow need a uniform grid; leave it out, or the bodies",
      c->domain.stretch);
  BW_TRY(check_films(c));
  if (c->n_bodies == 0) return BW_OK;
  /* Markers need cells of one edge. */
  const double h = c->domain.length[1] / c->domain.cells[1];
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(fabs(c->domain.length[d] / c->domain.cells[d] / h - 1.0) < 1e-6, BW_EINPUT,
               "domain.cells[%d] = %d: with bodies, cells are cubes; %g would give the spacing %g "
               "of y%s",
               d, c->domain.cells[d], c->domain.length[d] / h, h,
               d == 2 && flat ? " (or set domain.length[2] to that spacing)" : "");
  return BW_OK;
}

static bw_status check_name(const char *what, const char *name)
{
  BW_REQUIRE(name[0] != '\0' && strpbrk(name, " \t.,:[]") == NULL, BW_EINPUT,
             "%s.%s: a name is one word of letters, digits, - and _", what, name);
  return BW_OK;
}

static bw_status check_law(const bw_scene_material *m)
{
  char known[256] = "";
  for (const bw_pd_law *const *law = bw_solid_laws; *law != NULL; law++) {
    const size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "",
             bw_scene__law_name(*law));
  }
  BW_REQUIRE(bw_solid_law_by_name(m->law) != NULL, BW_EINPUT,
             "materials.%s.law = %s: not in this build; this build has: %s", m->name, m->law,
             known);
  return bw_scene__check_state(m);
}

bw_status bw_scene__check_materials(const bw_scene_config *c)
{
  for (int q = 0; q < c->n_materials; q++) {
    BW_TRY(check_name("materials", c->materials[q].name));
    BW_TRY(check_law(&c->materials[q]));
  }
  return BW_OK;
}

static bw_status check_until(const bw_scene_phase *p, int q, double *end)
{
  const bw_scene_until *u = &p->until;
  BW_REQUIRE(!isnan(u->time) || u->steps != INT_MIN || !isnan(u->settled), BW_EINPUT,
             "phases.%d.until: it ends never; give time, steps or settled", q);
  BW_REQUIRE(
      isnan(u->time) || u->time > *end, BW_EINPUT,
      "phases.%d.until.time = %g: times are of the run, and phase %d ends at %g; give a later "
      "one",
      q, u->time, q - 1, *end);
  if (!isnan(u->time)) *end = u->time;
  return BW_OK;
}

bw_status bw_scene__check_phases(const bw_scene_config *c)
{
  double end = 0.0;
  char name[BW_SCENE_NAME], known[256];
  bw_scene__body_names(c, sizeof known, known);
  for (int q = 0; q < c->n_phases; q++) {
    const bw_scene_phase *p = &c->phases[q];
    /* Phases follow each other: the end of this one is where the next one may begin. */
    BW_TRY(check_until(p, q, &end));
    /* Who is held in this phase, and how many of them deform: those share one solid of the coupler,
     * which is held as a whole. */
    int held = 0;
    for (const char *rest = p->hold; bw_scene__next_name(&rest, name);) {
      const int b = bw_scene__body_named(c, name);
      BW_REQUIRE(b >= 0, BW_EINPUT, "phases.%d.hold = %s: there is no such body; there are: %s", q,
                 name, known);
      BW_REQUIRE(c->bodies[b].motion != BW_SCENE_RIGID, BW_EINPUT,
                 "phases.%d.hold = %s: this build does not hold rigid bodies for a phase; leave it "
                 "out, or give rigid.held for the whole run",
                 q, name);
      held += bw_scene__deforms(&c->bodies[b]);
    }
    int all = 0;
    for (int b = 0; b < c->n_bodies; b++)
      all += bw_scene__deforms(&c->bodies[b]);
    BW_REQUIRE(
        held == 0 || (held == all && bw_scene__has_flow(c)), BW_EINPUT,
        "phases.%d.hold = %s: this build holds all bodies that deform in a flow or none; name "
        "all of them, or leave it out",
        q, p->hold);
  }
  return BW_OK;
}

bw_status bw_scene_check(const bw_scene_config *c)
{
  BW_REQUIRE(c->n_bodies > 0 || bw_scene__has_flow(c), BW_EINPUT,
             "the scene holds neither a body nor a fluid; give bodies, or domain and fluid");
  /* Around a body the fluid may speed up by a fifth within the first steps. */
  BW_REQUIRE(
      !(c->numerics.step_share > 0.8) || !bw_scene__has_fluid(c) || c->n_bodies == 0, BW_EINPUT,
      "numerics.step_share = %g: with bodies in a flow at most 0.8, as velocities around them "
      "rise within a step when they begin to move",
      c->numerics.step_share);
  BW_REQUIRE(!c->numerics.predictor || c->numerics.coupling_iterations == 1, BW_EINPUT,
             "numerics.predictor: steps that are repeated (numerics.coupling_iterations = %d) find "
             "the motion themselves; leave one of the two out",
             c->numerics.coupling_iterations);
  BW_TRY(bw_scene__check_fluid(c));
  BW_TRY(bw_scene__check_materials(c));
  BW_REQUIRE(
      c->numerics.surface_correction == BW_PD_SURFACE_NONE || bw_scene__corrects_surfaces(c),
      BW_EINPUT,
      "numerics.surface_correction = %s: it is of bonds; families at faces are whole in laws "
      "ordinary and correspondence, leave it out",
      bw_scene__word(bw_solid_correction_words, c->numerics.surface_correction));
  for (int b = 0; b < c->n_bodies; b++)
    BW_TRY(check_name("bodies", c->bodies[b].name));
  for (int q = 0; q < c->n_gauges; q++)
    BW_TRY(check_name("gauges", c->gauges[q].name));
  BW_TRY(bw_scene__check_bodies(c));
  BW_TRY(bw_scene__check_loads(c));
  BW_TRY(bw_scene__check_phases(c));
  return bw_scene__check_gauges(c);
}
