/* The keys of box_flow.yaml, their defaults, and every contradiction between them. */
#include "box_case.h"

#include "bw_ns_words.h"
#include "bw_number.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#define V BW_CONFIG_VALUE
static const bw_config_field domain_fields[] = {
    V(box_domain, length, BW_REQUIRED, BW_ABOVE(0), "L", "edges of the box in x, y and z"),
    V(box_domain, cells, BW_REQUIRED, BW_AT_LEAST(1), "",
      "cells in x, y and z; one cell in z: two dimensions"),
    V(box_domain, stretch, BW_OPTIONAL, BW_FROM_TO(0, 10), "",
      "strength of the stretching in y by tanh, thin cells at both sides; 0: uniform"),
    V(box_domain, faces, BW_OPTIONAL, BW_FILE, "",
      "path of a text file with the faces in y, from 0 to length[1]"),
    BW_CONFIG_END};
static const bw_config_field fluid_fields[] = {
    V(box_fluid, viscosity, BW_REQUIRED, BW_ABOVE(0), "L2/T", "kinematic viscosity of the fluid"),
    BW_CONFIG_WORD(box_fluid, viscous, BW_OPTIONAL, bw_ns_viscous_words,
                   "how the viscous term advances in time"),
    BW_CONFIG_END};
static const bw_config_field side_fields[] = {
    BW_CONFIG_WORD(box_side, kind, BW_REQUIRED, bw_ns_side_words, "what the side is to the fluid"),
    BW_CONFIG_WORD(box_side, profile, BW_OPTIONAL, bw_ns_profile_words,
                   "velocity profile of an inflow"),
    V(box_side, velocity, BW_OPTIONAL, BW_ANY, "L/T",
      "velocity of a wall in its plane, or of a uniform inflow"),
    V(box_side, bulk_velocity, BW_OPTIONAL, BW_ANY, "L/T",
      "mean velocity of a poiseuille inflow along +x, +y or +z; negative through an upper side"),
    BW_CONFIG_END};
static const bw_config_field pair_fields[] = {
    BW_CONFIG_MAP(box_pair, lower, side_fields, "the side at 0"),
    BW_CONFIG_MAP(box_pair, upper, side_fields, "the side at the length"), BW_CONFIG_END};
static const bw_config_field sides_fields[] = {
    BW_CONFIG_MAP(box_sides, x, pair_fields, "the sides normal to x"),
    BW_CONFIG_MAP(box_sides, y, pair_fields, "the sides normal to y"),
    BW_CONFIG_MAP_IF(box_sides, z, has_z, pair_fields,
                     "the sides normal to z; left out in two dimensions"),
    BW_CONFIG_END};
static const bw_config_field forcing_fields[] = {
    BW_CONFIG_WORD(box_forcing, kind, BW_REQUIRED, bw_ns_forcing_words,
                   "what is held constant along periodic x"),
    V(box_forcing, value, BW_REQUIRED, BW_ANY, "L/T or L/T2",
      "the bulk velocity, or the gradient -dp/dx over the density"),
    BW_CONFIG_END};
static const bw_config_field vortex_fields[] = {
    V(box_vortex, centre, BW_REQUIRED, BW_ANY, "L",
      "place of the axis in x and y; the axis is along z"),
    V(box_vortex, radius, BW_REQUIRED, BW_ABOVE(0), "L", "radius at which the vortex is fastest"),
    V(box_vortex, swirl, BW_REQUIRED, BW_ANY, "L/T",
      "largest velocity of the vortex; > 0: counterclockwise"),
    BW_CONFIG_END};
static const bw_config_field start_fields[] = {
    V(box_start, velocity, BW_OPTIONAL, BW_ANY, "L/T", "uniform velocity at the start"),
    BW_CONFIG_LIST(box_start, vortices, n_vortices, BW_OPTIONAL, vortex_fields,
                   "vortices added to it"),
    BW_CONFIG_END};
static const bw_config_field time_fields[] = {
    V(box_time, end, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "T", "end of the run"),
    V(box_time, step, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE(0), "T",
      "fixed time step; left out: limit_share decides"),
    V(box_time, limit_share, BW_OPTIONAL | BW_MAY_CHANGE, BW_ABOVE_TO(0, 1), "",
      "time step over the largest stable one; 0.8 where step is left out, too"),
    BW_CONFIG_END};
static const bw_config_field output_fields[] = {
    V(box_output, sample_every, BW_REQUIRED, BW_ABOVE(0), "T", "time between rows of history.csv"),
    V(box_output, picture_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T",
      "time between VTK files of fluid.pvd; 0: at the end only"),
    V(box_output, checkpoint_every, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "T",
      "time between checkpoint.h5; 0: at the end only"),
    BW_CONFIG_END};
const bw_config_field box_fields[] = {
    BW_CONFIG_MAP(box_config, domain, domain_fields, "the box and its cells"),
    BW_CONFIG_MAP(box_config, fluid, fluid_fields, "the fluid"),
    BW_CONFIG_MAP(box_config, sides, sides_fields, "the six sides of the box"),
    BW_CONFIG_MAP_IF(box_config, forcing, has_forcing, forcing_fields,
                     "what drives a flow that is periodic in x"),
    BW_CONFIG_MAP(box_config, start, start_fields,
                  "the first velocity, which is made free of divergence"),
    BW_CONFIG_MAP(box_config, time, time_fields, "how long the run is, in which steps"),
    BW_CONFIG_MAP(box_config, output, output_fields, "when files are written"),
    BW_CONFIG_END};
#undef V

box_config box_config_default(void)
{
  const box_side side = {.kind = INT_MIN, .profile = BW_PROFILE_UNIFORM, .bulk_velocity = NAN};
  const box_pair pair = {side, side};
  return (box_config){.domain = {.length = {NAN, NAN, NAN}, .cells = {INT_MIN, INT_MIN, INT_MIN}},
                      .fluid = {.viscosity = NAN, .viscous = BW_VISCOUS_EXPLICIT},
                      .sides = {.x = pair, .y = pair, .z = pair},
                      .forcing = {.kind = INT_MIN, .value = NAN},
                      .start.vortices[0] = {.centre = {NAN, NAN}, .radius = NAN, .swirl = NAN},
                      .time = {.end = NAN, .step = NAN, .limit_share = NAN},
                      .output = {.sample_every = NAN}};
}

static const char *const direction_name[] = {"x", "y", "z"};
static const char *const end_name[] = {"lower", "upper"};
static const char *word_of(const bw_config_word *words, int value)
{
  while (words->word != NULL && words->value != value)
    words++;
  return words->word;
}

/* What is given has to have a meaning. */
static bw_status side_resolve(const box_side *q, bool planar, int d, int s, bw_ns_side *side)
{
  const char *dn = direction_name[d], *sn = end_name[s], *kind = word_of(bw_ns_side_words, q->kind);
  const bool moves = q->velocity[0] != 0.0 || q->velocity[1] != 0.0 || q->velocity[2] != 0.0;
  const bool laminar = q->profile == BW_PROFILE_POISEUILLE;
  /* A key that has no meaning for this kind of side is refused, not ignored. */
  BW_REQUIRE(q->kind == BW_SIDE_INFLOW || (!laminar && isnan(q->bulk_velocity)), BW_EINPUT,
             "sides.%s.%s: profile and bulk_velocity belong to an inflow, but kind is %s; leave "
             "them out",
             dn, sn, kind);
  BW_REQUIRE(laminar == isfinite(q->bulk_velocity) || q->kind != BW_SIDE_INFLOW, BW_EINPUT,
             "sides.%s.%s: bulk_velocity is %s the profile %s; give it with poiseuille, and "
             "velocity with uniform",
             dn, sn, laminar ? "missing for" : "given with",
             word_of(bw_ns_profile_words, q->profile));
  BW_REQUIRE(
      !moves || q->kind == BW_SIDE_WALL || (q->kind == BW_SIDE_INFLOW && !laminar), BW_EINPUT,
      "sides.%s.%s.velocity: [%g, %g, %g] belongs to a wall or a uniform inflow, this is %s "
      "%s; leave it out",
      dn, sn, q->velocity[0], q->velocity[1], q->velocity[2], laminar ? "a poiseuille " : "", kind);
  BW_REQUIRE(!planar || q->velocity[2] == 0.0, BW_EINPUT,
             "sides.%s.%s.velocity: %g along z, but domain.cells has one cell there; give 0", dn,
             sn, q->velocity[2]);
  /* Along the axis; through the lower side it has to be positive to come in. */
  const double speed = laminar ? q->bulk_velocity : q->velocity[d];
  BW_REQUIRE(q->kind != BW_SIDE_INFLOW || (s == 0 ? speed > 0.0 : speed < 0.0), BW_EINPUT,
             "sides.%s.%s: nothing comes in through this inflow, %s is %g along %s; give a %s one "
             "(fluid leaves through an outflow)",
             dn, sn, laminar ? "bulk_velocity" : "velocity", speed, dn,
             s == 0 ? "positive" : "negative");
  /* What is given makes sense; whether it fits the other sides the solver says. */
  *side = (bw_ns_side){.kind = (bw_ns_side_kind)q->kind,
                       .profile = (bw_ns_profile)q->profile,
                       .bulk_velocity = q->bulk_velocity};
  memcpy(side->velocity, q->velocity, sizeof side->velocity);
  return BW_OK;
}

static bw_status sides_resolve(const box_config *c, bw_grid_config *grid,
                               bw_ns_channel_config *fluid)
{
  const box_pair *pair[3] = {&c->sides.x, &c->sides.y, &c->sides.z};
  const bool planar = c->domain.cells[2] == 1;
  /* Two dimensions have no sides in z, three need both. */
  BW_REQUIRE(planar != c->sides.has_z, BW_EINPUT, "sides.z is %s, but domain.cells has %d in z; %s",
             c->sides.has_z ? "given" : "missing", c->domain.cells[2],
             planar ? "leave sides.z out in two dimensions"
                    : "give sides.z.lower and sides.z.upper, or one cell for two dimensions");
  for (int d = 0; d < (planar ? 2 : 3); d++) {
    const box_side *side[2] = {&pair[d]->lower, &pair[d]->upper};
    const bool lower = side[0]->kind == BW_SIDE_PERIODIC, upper = side[1]->kind == BW_SIDE_PERIODIC;
    BW_REQUIRE(lower == upper, BW_EINPUT,
               "sides.%s: lower is %s and upper is %s; make both periodic or neither",
               direction_name[d], word_of(bw_ns_side_words, side[0]->kind),
               word_of(bw_ns_side_words, side[1]->kind));
    grid->periodic[d] = lower;
    for (int s = 0; s < 2; s++)
      BW_TRY(side_resolve(side[s], planar, d, s, &fluid->side[d][s]));
  }
  if (!planar) return BW_OK;
  /* One cell in z is a periodic direction of its own. */
  grid->periodic[2] = true;
  fluid->side[2][0].kind = fluid->side[2][1].kind = BW_SIDE_PERIODIC;
  return BW_OK;
}

static bw_status times_divide(const char *whole_key, double whole, const char *part_key,
                              double part)
{
  int64_t times = 0;
  BW_REQUIRE(
      whole / part <= (double)BW_MOST_STEPS, BW_EINPUT,
      "%s is %g, %.3g times %s, %g: more than the %g that anybody can wait for; take a larger "
      "%s",
      whole_key, whole, whole / part, part_key, part, (double)BW_MOST_STEPS, part_key);
  BW_REQUIRE(bw_divides(whole, part, &times), BW_EINPUT, "%s is %g, no whole number of %s, %g",
             whole_key, whole, part_key, part);
  return BW_OK;
}

static bw_status times_check(const box_config *c)
{
  const box_time *t = &c->time;
  const box_output *o = &c->output;
  BW_REQUIRE(isnan(t->step) || isnan(t->limit_share), BW_EINPUT,
             "time.step is %g and time.limit_share is %g; give one of them", t->step,
             t->limit_share);
  /* Intervals have to divide each other, as the steps end on samples. */
  BW_TRY(times_divide("time.end", t->end, "output.sample_every", o->sample_every));
  if (!isnan(t->step)) {
    BW_TRY(times_divide("output.sample_every", o->sample_every, "time.step", t->step));
    BW_TRY(times_divide("time.end", t->end, "time.step", t->step));
  }
  if (o->picture_every != 0.0)
    BW_TRY(times_divide("output.picture_every", o->picture_every, "output.sample_every",
                        o->sample_every));
  if (o->checkpoint_every != 0.0)
    BW_TRY(times_divide("output.checkpoint_every", o->checkpoint_every, "output.sample_every",
                        o->sample_every));
  return BW_OK;
}

bw_status box_resolve(box_config *c, bw_grid_config *grid, bw_ns_channel_config *fluid)
{
  *grid = bw_grid_config_default();
  *fluid = bw_ns_channel_config_default();
  /* The case's numbers become those of grid and solver ... */
  memcpy(grid->n, c->domain.cells, sizeof grid->n);
  memcpy(grid->length, c->domain.length, sizeof grid->length);
  if (c->domain.stretch > 0.0) {
    grid->y_stretch = BW_STRETCH_TANH;
    grid->y_stretch_strength = c->domain.stretch;
  }
  fluid->nu = c->fluid.viscosity;
  fluid->viscous = (bw_ns_viscous)c->fluid.viscous;
  if (c->has_forcing) {
    fluid->forcing = (bw_ns_forcing)c->forcing.kind;
    fluid->forcing_value = c->forcing.value;
  }
  /* ... after what contradicts itself has been refused by its key. */
  BW_REQUIRE(c->domain.stretch == 0.0 || c->domain.faces[0] == 0, BW_EINPUT,
             "domain.stretch is %g and domain.faces is %s; give one of them", c->domain.stretch,
             c->domain.faces);
  BW_TRY(times_check(c));
  if (isnan(c->time.step) && isnan(c->time.limit_share)) c->time.limit_share = 0.8;
  BW_TRY(sides_resolve(c, grid, fluid));
  BW_REQUIRE(!c->has_forcing || grid->periodic[0], BW_EINPUT,
             "forcing is %s, but sides.x is not periodic: there the sides drive the flow; leave "
             "forcing out or make x periodic",
             word_of(bw_ns_forcing_words, c->forcing.kind));
  /* The solver's own check, before anything is allocated. */
  return bw_ns_channel_config_check(grid, fluid);
}
