/* The tank as a scene: each block of the case file becomes what a scene calls it. */
#include "dam_case.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The words of bw_scene_material for the rows of bw_solid_law.h. */
static const char *const law_word[] = {[BW_SOLID_BOND] = "bond",
                                       [BW_SOLID_ORDINARY] = "ordinary",
                                       [BW_SOLID_CORRESPONDENCE] = "correspondence"};
static const char *const elastic_word[] = {[BW_PD_MATERIAL_LINEAR] = "linear",
                                           [BW_PD_MATERIAL_SAINT_VENANT] = "saint_venant",
                                           [BW_PD_MATERIAL_NEO_HOOKEAN] = "neo_hookean",
                                           [BW_PD_MATERIAL_HENCKY] = "hencky"};
static const char *const plastic_word[] = {
    [BW_SOLID_ELASTIC] = "", [BW_SOLID_J2] = "j2", [BW_SOLID_DRUCKER_PRAGER] = "drucker_prager"};

/* blank: what item 0 of the list was before any was filled. */
static void add_box(const double lower[3], const double upper[3], bool held,
                    const bw_scene_shape *blank, bw_scene_shape *out)
{
  *out = *blank;
  out->has_box = true;
  out->held = held;
  memcpy(out->box.from, lower, sizeof out->box.from);
  memcpy(out->box.to, upper, sizeof out->box.to);
}

static void set_tank(const dam_config *c, bw_scene_config *s)
{
  for (int k = 0; k < 3; k++) {
    const bool flat = c->tank.size[k] == 0; /* two dimensions: one layer, one deep */
    s->domain.length[k] = flat ? 1 : c->tank.size[k];
    s->domain.cells[k] = flat ? 1 : (int)lrint(c->tank.size[k] / c->fluid.spacing);
  }
  s->has_domain = true;
  snprintf(s->domain.open, sizeof s->domain.open, "y_upper");
  s->domain.has_shake = c->has_motion;
  if (!c->has_motion) return;
  memcpy(s->domain.shake.amplitude, c->motion.amplitude, sizeof c->motion.amplitude);
  s->domain.shake.frequency = 1 / c->motion.period;
}

static void set_fluid(const dam_config *c, bw_scene_config *s)
{
  const bw_scene_shape blank = s->fluid.shape[0];
  bw_scene_fluid *f = &s->fluid;
  s->has_fluid = true;
  f->model = BW_SCENE_PARTICLES;
  f->density = c->fluid.density;
  f->viscosity = c->fluid.viscosity / c->fluid.density;
  f->speed = c->fluid.speed;
  f->walls = c->tank.no_slip ? BW_SCENE_STICK : BW_SCENE_SLIP;
  f->start.hydrostatic = c->hydrostatic;
  for (int q = 0; q < c->n_water; q++)
    add_box(c->water[q].lower, c->water[q].upper, false, &blank, &f->shape[q]);
  f->n_shape = c->n_water;
  s->gravity[1] = -c->fluid.gravity;
  s->numerics.sound_speed = c->fluid.sound_speed;
  s->numerics.artificial_viscosity = c->fluid.alpha;
  s->numerics.wall_viscosity = c->fluid.alpha_wall;
  s->numerics.density_diffusion = c->fluid.delta;
  s->numerics.shifting = c->fluid.shifting;
}

static void set_material(const dam_solid *from, bw_scene_material *m)
{
  const bw_solid_law_choice *c = &from->choice;
  const bool correspondence = c->law == BW_SOLID_CORRESPONDENCE;
  snprintf(m->name, sizeof m->name, "solid");
  snprintf(m->law, sizeof m->law, "%s", law_word[c->law]);
  snprintf(m->plastic, sizeof m->plastic, "%s", plastic_word[c->plastic]);
  m->density = from->density, m->young_modulus = from->young;
  m->poisson_ratio = c->poisson_ratio;
  if (isfinite(from->fracture_energy)) m->fracture_energy = from->fracture_energy;
  if (c->law == BW_SOLID_ORDINARY) m->influence = c->influence;
  if (!correspondence) return;
  snprintf(m->elastic, sizeof m->elastic, "%s", elastic_word[c->elastic]);
  m->weight = c->weight, m->stabilisation = c->stabilisation;
  m->breaks = c->breaks, m->limit = c->limit, m->cone = c->cone;
  m->yield_stress = c->yield_stress, m->hardening = c->hardening, m->cohesion = c->cohesion;
  m->friction_angle = c->friction_angle, m->dilation_angle = c->dilation_angle;
}

static void set_solid(const dam_config *c, const bw_scene_body *blank, bw_scene_config *s)
{
  const dam_solid *from = &c->solid;
  const bool breaks = isfinite(from->fracture_energy) || isfinite(from->choice.limit);
  const bool nearest = from->choice.law == BW_SOLID_CORRESPONDENCE && !breaks;
  bw_scene_body *b = &s->bodies[s->n_bodies++];
  *b = *blank;
  snprintf(b->name, sizeof b->name, "solid");
  snprintf(b->material, sizeof b->material, "solid");
  b->motion = breaks ? BW_SCENE_BREAKABLE : BW_SCENE_ELASTIC;
  b->spacing = from->spacing;
  b->self_contact = from->contact;
  for (int q = 0; q < from->n_parts; q++)
    add_box(from->parts[q].lower, from->parts[q].upper, from->parts[q].held, &blank->shape[0],
            &b->shape[q]);
  b->n_shape = from->n_parts;
  set_material(from, &s->materials[s->n_materials++]);
  if (!from->contact) snprintf(s->contact.between, sizeof s->contact.between, "none");
  /* The least families for correspondence, which bends right with few layers; 2 where bonds may
   * break and elsewhere. */
  const double ratio = isnan(from->horizon_ratio) ? (nearest ? 1.5 : 2.0) : from->horizon_ratio;
  s->numerics.horizon_ratio = ratio;
  s->numerics.family_reach = ratio < 2.0 ? BW_PD_REACH_HORIZON : BW_PD_REACH_HALF_CELL;
  if (from->choice.law == BW_SOLID_BOND)
    s->numerics.surface_correction = bw_solid_config_default().surface_correction;
  s->numerics.damping_pair = from->damping_pair;
}

/* Blocks are one fixed body, without what the solid takes. */
static void set_obstacles(const dam_config *c, const bw_scene_body *blank, bw_scene_config *s)
{
  if (c->n_obstacles == 0) return;
  bw_scene_body *b = &s->bodies[s->n_bodies++];
  *b = *blank;
  snprintf(b->name, sizeof b->name, "obstacles");
  b->motion = BW_SCENE_FIXED;
  for (int q = 0; q < c->n_obstacles; q++)
    add_box(c->obstacles[q].lower, c->obstacles[q].upper, false, &blank->shape[0], &b->shape[q]);
  b->n_shape = c->n_obstacles;
  if (!c->has_solid) return;
  b->shape[b->n_shape] = blank->shape[0];
  snprintf(b->shape[b->n_shape++].minus, BW_SCENE_NAME, "solid");
}

static bw_scene_gauge_config *add_gauge(bw_scene_config *s, const bw_scene_gauge_config *blank,
                                        const char *name, const char *of)
{
  bw_scene_gauge_config *g = &s->gauges[s->n_gauges++];
  *g = *blank;
  snprintf(g->name, sizeof g->name, "%s", name);
  snprintf(g->of, sizeof g->of, "%s", of);
  return g;
}

static void set_gauges(const dam_config *c, bw_scene_config *s)
{
  static const char *const word[] = {
      [DAM_DEPTH] = "depth",   [DAM_PRESSURE] = "wall_pressure", [DAM_FRONT] = "front",
      [DAM_HEIGHT] = "height", [DAM_ASIDE] = "displacement",     [DAM_UP] = "displacement"};
  const bw_scene_gauge_config blank = s->gauges[0];
  (void)add_gauge(s, &blank, "energy", "fluid_energy");
  (void)add_gauge(s, &blank, "water", "front height mass outside");
  for (int q = 0; q < c->n_gauges; q++) {
    const dam_gauge *from = &c->gauges[q];
    const bool moves = from->kind == DAM_ASIDE || from->kind == DAM_UP;
    bw_scene_gauge_config *g = add_gauge(s, &blank, from->name, word[from->kind]);
    if (moves) snprintf(g->body, sizeof g->body, "solid");
    if (from->kind == DAM_DEPTH) {
      memcpy(g->point, from->at, sizeof g->point);
      if (from->width > 0) g->width = from->width;
      continue;
    }
    g->has_region = true;
    memcpy(g->region.from, from->lower, sizeof g->region.from);
    memcpy(g->region.to, from->upper, sizeof g->region.to);
  }
  if (!c->has_solid) return;
  bw_scene_gauge_config *solid = add_gauge(s, &blank, "solid", "force energy broken_bonds");
  snprintf(solid->body, sizeof solid->body, "solid");
  (void)add_gauge(s, &blank, "work", "work");
}

void dam_to_scene(const dam_config *c, bw_scene_config *s)
{
  const bw_scene_body blank = s->bodies[0];
  snprintf(s->name, sizeof s->name, "water in a tank");
  set_tank(c, s);
  set_fluid(c, s);
  if (c->has_solid) set_solid(c, &blank, s);
  set_obstacles(c, &blank, s);
  set_gauges(c, s);
  s->phases[0].has_until = true;
  s->phases[0].until.time = c->time.end;
  s->n_phases = 1;
  s->numerics.step_share = c->time.step_share;
  s->output.sample_every = c->output.sample_every;
  s->output.picture_every = c->output.picture_every;
  snprintf(s->output.checkpoint_every, sizeof s->output.checkpoint_every, "%.17g",
           c->output.checkpoint_every);
}
