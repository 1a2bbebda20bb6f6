/* The table of what gauges can measure, and what a run would refuse of gauges. */
#include "scene_quantity.h"

#include "bw_coupler.h"
#include "bw_ns_channel.h"
#include "scene_check.h"
#include <math.h>
#include <string.h>

#define XYZ                                                                                        \
  {                                                                                                \
    "x", "y", "z"                                                                                  \
  }
const bw_scene__quantity bw_scene__quantities[] = {
    {"displacement", BW_SCENE__OF_PLACE, 3, true, false, XYZ, "L"},
    {"position", BW_SCENE__OF_PLACE, 3, true, false, XYZ, "L"},
    {"velocity", BW_SCENE__OF_PLACE, 3, true, false, XYZ, "L/T"},
    {"velocity", BW_SCENE__OF_POINT, 3, true, false, XYZ, "L/T"},
    {"damage", BW_SCENE__OF_PLACE, 2, false, false, {"mean", "largest"}, "-"},
    {"turn", BW_SCENE__OF_RIGID, 3, false, true, XYZ, "rad"},
    {"spin", BW_SCENE__OF_RIGID, 3, false, true, XYZ, "1/T"},
    {"torque", BW_SCENE__OF_RIGID, 3, false, true, XYZ, "M L2/T2"},
    {"force",
     BW_SCENE__OF_BODIES,
     9,
     false,
     false,
     {"reaction.x", "reaction.y", "reaction.z", "probe.x", "probe.y", "probe.z", "box.x", "box.y",
      "box.z"},
     "M L/T2"},
    {"force_on_support", BW_SCENE__OF_BODIES, 3, true, false, XYZ, "M L/T2"},
    {"crack_tip", BW_SCENE__OF_BODIES, 4, false, false, {"x", "y", "z", "reach"}, "L"},
    {"filled_area", BW_SCENE__OF_BODIES, 1, false, false, {""}, "L2"},
    {"filled_volume", BW_SCENE__OF_BODIES, 1, false, false, {""}, "L3"},
    {"fragments", BW_SCENE__OF_SOLIDS, 1, false, false, {""}, "-"},
    {"broken_bonds", BW_SCENE__OF_SOLIDS, 1, false, false, {""}, "-"},
    {"energy",
     BW_SCENE__OF_SOLIDS,
     8,
     false,
     false,
     {"kinetic", "elastic", "contact", "fracture", "damping", "external", "plastic", "regrid"},
     "M L2/T2"},
    {"failure", BW_SCENE__OF_PLACE, 1, false, false, {""}, "-"},
    {"failure_place", BW_SCENE__OF_PLACE, 3, true, false, XYZ, "L"},
    {"pressure", BW_SCENE__OF_POINT, 1, false, false, {""}, "M/(L T2)"},
    {"flow_rate", BW_SCENE__OF_FLUID, 2, false, false, {"in", "out"}, "L3/T"},
    {"bulk_velocity", BW_SCENE__OF_FLUID, 1, false, false, {""}, "L/T"},
    {"kinetic_energy", BW_SCENE__OF_FLUID, 1, false, false, {""}, "M L2/T2"},
    {"tortuosity", BW_SCENE__OF_FLUID, 3, true, false, XYZ, "-"},
    {"film_energy", BW_SCENE__OF_FLUID, 1, false, false, {""}, "M L2/T2"},
    {"film_gap", BW_SCENE__OF_FLUID, 1, false, false, {""}, "L"},
    {"divergence", BW_SCENE__OF_FLUID, 1, false, false, {""}, "-"},
    {"depth", BW_SCENE__OF_COLUMN, 1, false, false, {""}, "L"},
    {"front", BW_SCENE__OF_WATER, 1, false, false, {""}, "L"},
    {"height", BW_SCENE__OF_WATER, 1, false, false, {""}, "L"},
    {"wall_pressure", BW_SCENE__OF_WATER, 1, false, false, {""}, "M/(L T2)"},
    {"wall_force", BW_SCENE__OF_WATER, 3, true, false, XYZ, "M L/T2"},
    {"mass", BW_SCENE__OF_WATER, 1, false, false, {""}, "M"},
    {"outside", BW_SCENE__OF_WATER, 1, false, false, {""}, "-"},
    {"work", BW_SCENE__OF_WATER, 3, false, false, {"given", "late", "received"}, "M L2/T2"},
    {"fluid_energy",
     BW_SCENE__OF_WATER,
     12,
     false,
     false,
     {"kinetic", "potential", "compression", "walls", "viscosity", "artificial", "diffusion",
      "tension", "shifting", "images", "bodies", "gap"},
     "M L2/T2"},
    {NULL, BW_SCENE__OF_FLUID, 0, false, false, {NULL}, NULL}};

bool bw_scene__names_all(const bw_scene_config *c, const bw_scene_gauge_config *g)
{
  for (int b = 0; b < c->n_bodies && g->body[0] != '\0'; b++)
    if (!bw_scene__listed(g->body, c->bodies[b].name)) return false;
  return true;
}

/* Does it name all bodies but those that are bw_rigid's? */
static bool names_all_others(const bw_scene_config *c, const bw_scene_gauge_config *g)
{
  for (int b = 0; b < c->n_bodies && g->body[0] != '\0'; b++)
    if (!bw_scene__in_rigid(c, b) && !bw_scene__listed(g->body, c->bodies[b].name)) return false;
  return true;
}

bool bw_scene__some_of_coupled(const bw_scene_config *c, const bw_scene_gauge_config *g)
{
  const bool coupled =
      bw_scene__has_fluid(c) && (bw_scene__any_deforms(c) || bw_scene__any_image(c));
  return coupled && !names_all_others(c, g) &&
         !bw_scene__of_rigid(c, g, bw_scene__quantity_named(g, "force"));
}

bool bw_scene__force_holds(const bw_scene_config *c, const bw_scene_gauge_config *g,
                           bw_scene__route route)
{
  const bw_scene__quantity *force = bw_scene__quantity_named(g, "force");
  if (bw_scene__some_of_coupled(c, g))
    return (route == BW_SCENE__BY_PROBES) == (c->numerics.load == BW_LOAD_PROBES) &&
           route != BW_SCENE__BY_BOX;
  if (route == BW_SCENE__BY_REACTION) return true;
  if (bw_scene__has_particles(c) || bw_scene__of_rigid(c, g, force)) return false;
  if (route == BW_SCENE__BY_PROBES) return true;
  /* The implicit viscous term and an eddy viscosity keep no fluxes of which a box could make a
   * balance. */
  return c->numerics.viscous != BW_VISCOUS_IMPLICIT && c->fluid.eddy == BW_EDDY_NONE &&
         bw_scene__names_all(c, g);
}

bool bw_scene__of_rigid(const bw_scene_config *c, const bw_scene_gauge_config *g,
                        const bw_scene__quantity *what)
{
  char name[BW_SCENE_NAME];
  const char *rest = g->body;
  if (what->source == BW_SCENE__OF_RIGID) return true;
  const bool known = what->vector && what->source <= BW_SCENE__OF_BODIES;
  if ((!known && strcmp(what->word, "force") != 0) || !bw_scene__any_rigid(c)) return false;
  if (!bw_scene__next_name(&rest, name)) return false;
  const int b = bw_scene__body_named(c, name);
  return b >= 0 && bw_scene__in_rigid(c, b);
}

bool bw_scene__given(const double x[3])
{
  return !isnan(x[0]);
}

static bool in_fluid(const bw_scene_gauge_config *g)
{
  return bw_scene__given(g->point) || g->has_line || g->has_slice;
}

const bw_scene__quantity *bw_scene__quantity_named(const bw_scene_gauge_config *g, const char *word)
{
  for (const bw_scene__quantity *q = bw_scene__quantities; q->word != NULL; q++)
    if (strcmp(q->word, word) == 0 &&
        (q->source == BW_SCENE__OF_POINT || q->source == BW_SCENE__OF_COLUMN || !in_fluid(g)) &&
        !(q->source == BW_SCENE__OF_POINT && strcmp(word, "velocity") == 0 && !in_fluid(g)))
      return q;
  return NULL;
}

/* Bodies whose numbers come from different places, or from nowhere, do not go together. */
static bw_status check_bodies(const bw_scene_config *c, const bw_scene_gauge_config *g,
                              const bw_scene__quantity *q)
{
  char name[BW_SCENE_NAME];
  int rigid = 0, others = 0;
  for (const char *rest = g->body; bw_scene__next_name(&rest, name);) {
    const int b = bw_scene__body_named(c, name);
    if (b < 0) continue; /* said by check_gauge */
    bw_scene__in_rigid(c, b) ? rigid++ : others++;
  }
  const bool support = q->source == BW_SCENE__OF_BODIES;
  BW_REQUIRE(q->source != BW_SCENE__OF_RIGID || others == 0, BW_EINPUT,
             "gauges.%s.of = %s: that of a body that moves as one piece, and not all of %s do; "
             "leave it out, or make it rigid",
             g->name, q->word, g->body);
  BW_REQUIRE(q->source != BW_SCENE__OF_RIGID || rigid == 1, BW_EINPUT,
             "gauges.%s.of = %s: that of one body of a scene with rigid ones; name one", g->name,
             q->word);
  BW_REQUIRE(!bw_scene__of_rigid(c, g, q) || others == 0, BW_EINPUT,
             "gauges.%s.body = %s: rigid bodies and others; give each a gauge of its own", g->name,
             g->body);
  BW_REQUIRE(!bw_scene__of_rigid(c, g, q) || rigid == 1 || support, BW_EINPUT,
             "gauges.%s.body = %s: %s is that of one rigid body; give each a gauge of its own",
             g->name, g->body, q->word);
  return BW_OK;
}

/* Quantities of a fluid on a grid and of one of particles are not those of the other. */
static bw_status check_model(const bw_scene_config *c, const bw_scene_gauge_config *g,
                             const bw_scene__quantity *q)
{
  const bool water = bw_scene__has_particles(c), both = strcmp(q->word, "kinetic_energy") == 0;
  char name[BW_SCENE_NAME];
  if (q->source < BW_SCENE__OF_POINT && strcmp(q->word, "force") != 0) return BW_OK;
  BW_REQUIRE(both || q->source < BW_SCENE__OF_POINT || water == (q->source >= BW_SCENE__OF_COLUMN),
             BW_EINPUT, "gauges.%s.of = %s: that of a fluid %s; leave it out", g->name, q->word,
             water ? "on a grid, and this one is of particles"
                   : "of particles, and this one is on a grid");
  BW_REQUIRE(q->source != BW_SCENE__OF_COLUMN || bw_scene__given(g->point), BW_EINPUT,
             "gauges.%s.point is missing: %s is that of the column at a place", g->name, q->word);
  BW_REQUIRE(strcmp(q->word, "wall_pressure") != 0 || g->has_region, BW_EINPUT,
             "gauges.%s.region is missing: the part of a wall whose mean pressure is asked for",
             g->name);
  BW_REQUIRE(
      strcmp(q->word, "work") != 0 || bw_scene__any_deforms(c), BW_EINPUT,
      "gauges.%s.of = work: that of the fluid on bodies that deform, of which there is none; "
      "leave it out",
      g->name);
  BW_REQUIRE(
      strncmp(q->word, "film_", 5) != 0 || !isnan(c->fluid.film_roughness), BW_EINPUT,
      "gauges.%s.of = %s: films are asked for by fluid.film_roughness; give it, or leave the "
      "gauge out",
      g->name, q->word);
  for (const char *rest = g->body; water && bw_scene__next_name(&rest, name);) {
    const int b = bw_scene__body_named(c, name);
    BW_REQUIRE(
        b < 0 || !bw_scene__is_wall(c, b), BW_EINPUT,
        "gauges.%s.body = %s: a fixed body is a wall of a fluid of particles, whose force is "
        "not told apart; ask for wall_force, of all walls together",
        g->name, name);
  }
  return BW_OK;
}

static bw_status check_quantity(const bw_scene_config *c, const bw_scene_gauge_config *g,
                                const char *word)
{
  const bw_scene__quantity *q = bw_scene__quantity_named(g, word);
  BW_REQUIRE(q != NULL, BW_EINPUT,
             "gauges.%s.of = %s: there is no such quantity%s; `--help gauges` lists them", g->name,
             word, in_fluid(g) ? " of a place in the fluid" : "");
  const bool bodies = q->source <= BW_SCENE__OF_SOLIDS;
  BW_REQUIRE(bodies ? c->n_bodies > 0 : bw_scene__has_flow(c), BW_EINPUT,
             "gauges.%s.of = %s: the scene has no %s; leave the gauge out", g->name, word,
             bodies ? "body" : "fluid");
  BW_REQUIRE(q->source > BW_SCENE__OF_BODIES || g->body[0] != '\0', BW_EINPUT,
             "gauges.%s.body is missing: %s is that of a body", g->name, word);
  BW_REQUIRE(q->source != BW_SCENE__OF_POINT || in_fluid(g), BW_EINPUT,
             "gauges.%s.point is missing: %s is that of a place; give point, line or slice",
             g->name, word);
  BW_REQUIRE(strcmp(word, "force") != 0 || bw_scene__has_flow(c), BW_EINPUT,
             "gauges.%s.of = force: that of a fluid, of which there is none; use force_on_support",
             g->name);
  BW_TRY(check_model(c, g, q));
  if (strncmp(word, "failure", strlen("failure")) == 0) BW_TRY(bw_scene__check_failure(c, g));
  BW_TRY(check_bodies(c, g, q));
  BW_REQUIRE(strcmp(word, "crack_tip") != 0 || bw_scene__given(g->origin), BW_EINPUT,
             "gauges.%s.origin is missing: where the crack begins, from which its reach counts",
             g->name);
  return BW_OK;
}

static bw_status check_place(const bw_scene_config *c, const bw_scene_gauge_config *g,
                             const char *key, const double x[3])
{
  for (int d = 0; bw_scene__given(x) && d < (bw_scene__planar(c) ? 2 : 3); d++)
    BW_REQUIRE(x[d] >= 0.0 && x[d] <= c->domain.length[d], BW_EINPUT,
               "gauges.%s.%s[%d] = %g: outside the domain, 0 to %g", g->name, key, d, x[d],
               c->domain.length[d]);
  return BW_OK;
}

static bw_status check_gauge(const bw_scene_config *c, const bw_scene_gauge_config *g)
{
  char name[BW_SCENE_NAME], known[256];
  bw_scene__body_names(c, sizeof known, known);
  for (const char *rest = g->of; bw_scene__next_name(&rest, name);)
    BW_TRY(check_quantity(c, g, name));
  for (const char *rest = g->body; bw_scene__next_name(&rest, name);)
    BW_REQUIRE(bw_scene__body_named(c, name) >= 0, BW_EINPUT,
               "gauges.%s.body = %s: there is no such body; there are: %s", g->name, name, known);
  BW_REQUIRE(!(g->has_line || g->has_slice) || g->every > 0.0, BW_EINPUT,
             "gauges.%s.every is missing: the time between files of a line or slice", g->name);
  BW_REQUIRE(!bw_scene__given(g->minus) || bw_scene__given(g->point), BW_EINPUT,
             "gauges.%s.minus: there is no point that it is taken away from; give point", g->name);
  if (!c->has_domain) return BW_OK;
  BW_TRY(check_place(c, g, "point", g->point));
  BW_TRY(check_place(c, g, "minus", g->minus));
  BW_TRY(check_place(c, g, "line.from", g->line.from));
  return check_place(c, g, "line.to", g->line.to);
}

bw_status bw_scene__check_gauges(const bw_scene_config *c)
{
  for (int q = 0; q < c->n_gauges; q++)
    BW_TRY(check_gauge(c, &c->gauges[q]));
  for (int q = 0; q < c->n_watch; q++) {
    char name[BW_SCENE_NAME];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(c->watch[q].name, "."), c->watch[q].name);
    BW_REQUIRE(bw_scene__gauge_named(c, name) >= 0, BW_EINPUT,
               "watch.%s: there is no gauge %s; give it in gauges", c->watch[q].name, name);
  }
  return BW_OK;
}
