/* What a scene is before its file is read, and what `accuracy` fills. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_solid.h"
#include "scene_check.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* Item 0 of a list holds the defaults of all its items. */
static void default_shape(bw_scene_shape *s)
{
  s->box = (bw_scene_box){{NAN, NAN, NAN}, {NAN, NAN, NAN}};
  s->cylinder = (bw_scene_cylinder){2, {NAN, NAN}, NAN, NAN, NAN};
  s->sphere = (bw_scene_sphere){{NAN, NAN, NAN}, NAN};
  s->pores = (bw_scene_pores){INT_MIN, {NAN, NAN, NAN}, NAN, NAN};
  s->image = (bw_scene_image){.low = 0.5,
                              .high = BW_CONFIG_LARGEST,
                              .at = {NAN, NAN, NAN},
                              .voxel = NAN,
                              .from = {INT_MIN, INT_MIN, INT_MIN},
                              .to = {INT_MIN, INT_MIN, INT_MIN},
                              .coarsen = {1, 1, 1}};
  s->stl = (bw_scene_stl){"", 1.0, NAN};
}

static void default_body(bw_scene_body *b)
{
  b->motion = INT_MIN;
  b->spacing = NAN;
  b->self_contact = INT_MIN;
  b->rotation = (bw_scene_rotation){NAN, {0, 0, 1}, {NAN, NAN, NAN}};
  b->swing = (bw_scene_swing){{NAN, NAN, NAN}, NAN};
  b->rigid = (bw_scene_rigid){.mass = NAN, .centre = {NAN, NAN, NAN}, .inertia = {NAN, NAN, NAN}};
  b->held[0].layers = 1;
  b->held[0].box = (bw_scene_box){{NAN, NAN, NAN}, {NAN, NAN, NAN}};
  b->cracks[0] = (bw_scene_crack){{NAN, NAN, NAN}, {NAN, NAN, NAN}, {0, 0, 0}};
  b->levels[0] = (bw_scene_level){INT_MIN, {NAN, NAN, NAN}, {NAN, NAN, NAN}};
  b->refine = (bw_scene_refine){INT_MIN, BW_PD_LEVELS_STRETCH, 0.6, 0.2, 1.25, 2.0};
  default_shape(&b->shape[0]);
}

static void default_gauge(bw_scene_gauge_config *g)
{
  for (int d = 0; d < 3; d++)
    g->nearest[d] = g->point[d] = g->minus[d] = g->origin[d] = NAN;
  g->region = (bw_scene_box){{NAN, NAN, NAN}, {NAN, NAN, NAN}};
  g->strength = (bw_scene_strength){INT_MIN, NAN, NAN, NAN, NAN, NAN};
  g->line = (bw_scene_line){{NAN, NAN, NAN}, {NAN, NAN, NAN}, 101};
  g->slice = (bw_scene_slice){INT_MIN, NAN};
  g->width = g->every = NAN;
}

static void default_fluid(bw_scene_config *c)
{
  const bw_scene_side side = {
      .kind = INT_MIN, .profile = BW_PROFILE_UNIFORM, .mean = NAN, .ramp = 0.0};
  const bw_scene_pair pair = {side, side};
  c->domain = (bw_scene_domain){.length = {NAN, NAN, NAN},
                                .cells = {INT_MIN, INT_MIN, INT_MIN},
                                .shake = {{NAN, NAN, NAN}, NAN}};
  c->fluid.model = BW_SCENE_INCOMPRESSIBLE;
  c->fluid.density = c->fluid.viscosity = c->fluid.speed = NAN;
  c->fluid.start.hydrostatic = c->fluid.walls = INT_MIN;
  default_shape(&c->fluid.shape[0]);
  c->fluid.sides = (bw_scene_sides){pair, pair, pair, false};
  c->fluid.start.vortices[0] = (bw_scene_vortex){{NAN, NAN, NAN}, NAN, NAN};
  c->fluid.forcing = (bw_scene_forcing){INT_MIN, 0, NAN};
  c->fluid.film_roughness = c->fluid.film_limit = c->fluid.film_least = NAN;
}

static void default_numerics(bw_scene_numerics *n)
{
  *n = (bw_scene_numerics){.step = NAN,
                           .step_share = NAN,
                           .solid_share = NAN,
                           .integrator = BW_SOLID_VERLET,
                           .horizon_ratio = NAN,
                           .surface_correction = INT_MIN,
                           .volume_fraction = BW_PD_FRACTION_DEFAULT,
                           .family_reach = INT_MIN,
                           .calibration = BW_PD_CALIBRATION_NONE,
                           .viscous = BW_VISCOUS_EXPLICIT,
                           .load = BW_LOAD_PROBES,
                           .kernel = BW_KERNEL_ROMA3,
                           .probe_profile = BW_PROBE_QUADRATIC,
                           .forcing_iterations = INT_MIN,
                           .memory = NAN,
                           .retraction = NAN,
                           .marker_spacing = NAN,
                           .probe_length = NAN,
                           .load_relaxation = NAN,
                           .virtual_mass = NAN,
                           .contact_stiffness = NAN,
                           .sound_speed = NAN,
                           .artificial_viscosity = NAN,
                           .wall_viscosity = NAN,
                           .density_diffusion = NAN,
                           .shifting = NAN,
                           .coupling_residual = NAN,
                           .coupling_iterations = INT_MIN};
}

void bw_scene_config_default(bw_scene_config *c)
{
  memset(c, 0, sizeof *c);
  c->accuracy = BW_SCENE_STANDARD;
  c->plane = INT_MIN;
  c->thickness = NAN;
  default_fluid(c);
  bw_scene_material *m = &c->materials[0];
  snprintf(m->law, sizeof m->law, "bond");
  m->density = m->young_modulus = m->poisson_ratio = m->fracture_energy = NAN;
  m->influence = m->weight = m->breaks = m->cone = INT_MIN;
  m->stabilisation = m->limit = NAN;
  m->cohesion = m->friction_angle = m->dilation_angle = m->yield_stress = m->hardening = NAN;
  default_body(&c->bodies[0]);
  c->loads[0] = (bw_scene_load){.kind = INT_MIN, .value = {NAN, NAN, NAN}};
  c->loads[0].where.layers = 1;
  c->loads[0].where.box = (bw_scene_box){{NAN, NAN, NAN}, {NAN, NAN, NAN}};
  snprintf(c->contact.between, sizeof c->contact.between, "all");
  c->phases[0] = (bw_scene_phase){.until = {NAN, INT_MIN, NAN}, .step = NAN, .breaking = INT_MIN};
  default_gauge(&c->gauges[0]);
  c->watch[0] = (bw_scene_watch){.last_periods = INT_MIN, .above = NAN, .below = NAN};
  c->output.sample_every = NAN;
  snprintf(c->output.checkpoint_every, sizeof c->output.checkpoint_every, "600 s");
  c->output.figures = true;
  default_numerics(&c->numerics);
}

/* Who reads a knob: a fluid of particles, solids in one (both are set first, where there is one),
 * anybody, solids, those of bonds, bodies in a flow, those that move by it, solids in it. */
enum { OF_PARTICLES, OF_WETTED, OF_ALL, OF_SOLIDS, OF_BONDS, OF_MARKERS, OF_MOVING, OF_COUPLING };

/* What `accuracy` sets where the file leaves it open. */
typedef struct {
  const char *key;
  size_t offset;
  bool whole;      /* an int */
  int of;          /* who reads it: OF_ALL ... */
  double value[3]; /* quick, standard, careful */
} knob;
#define D(m) #m, offsetof(bw_scene_numerics, m), false
#define I(m) #m, offsetof(bw_scene_numerics, m), true
static const knob knobs[] = {
    {D(step_share), OF_PARTICLES, {0.95, 0.8, 0.6}},
    {D(solid_share), OF_WETTED, {0.9, 0.8, 0.5}},
    {D(virtual_mass), OF_WETTED, {0.5, 0.5, 0.5}},
    {D(step_share), OF_ALL, {0.8, 0.6, 0.4}},
    {D(solid_share), OF_COUPLING, {0.9, 0.8, 0.5}},
    {D(horizon_ratio), OF_SOLIDS, {3.0, 3.0, 3.0}},
    {I(surface_correction),
     OF_BONDS,
     {BW_PD_SURFACE_TENSOR, BW_PD_SURFACE_TENSOR, BW_PD_SURFACE_TENSOR}},
    {I(forcing_iterations), OF_MARKERS, {1, 1, 2}},
    {D(memory), OF_MARKERS, {0.2, 0.2, 0.2}},
    {D(marker_spacing), OF_COUPLING, {1.0, 1.0, 1.0}},
    {D(probe_length), OF_MARKERS, {2.0, 2.0, 2.0}},
    {D(virtual_mass), OF_MOVING, {1.0, 1.0, 1.0}},
    {I(coupling_iterations), OF_COUPLING, {1, 1, 20}},
    {D(coupling_residual), OF_COUPLING, {1e-3, 1e-4, 1e-5}},
};
#undef D
#undef I
enum { KNOBS = sizeof knobs / sizeof *knobs };

static void set_knob(const knob *k, int accuracy, bw_scene_numerics *n, unsigned bit)
{
  char *at = (char *)n + k->offset;
  double x;
  int i;
  memcpy(&x, at, k->whole ? 0 : sizeof x);
  memcpy(&i, at, k->whole ? sizeof i : 0);
  if (k->whole ? i != INT_MIN : !isnan(x)) return;
  x = k->value[accuracy];
  i = (int)x;
  memcpy(at, k->whole ? (const void *)&i : (const void *)&x, k->whole ? sizeof i : sizeof x);
  n->set |= bit;
}

/* Families: within the horizon and half a cell; of the correspondence law, where nothing breaks,
 * the nearest neighbours alone, which are the most accurate (bw_pd_state_law.h). */
static void set_families(bw_scene_config *c)
{
  bool nearest = c->n_materials > 0;
  for (int q = 0; q < c->n_materials; q++)
    nearest = nearest && strcmp(c->materials[q].law, "correspondence") == 0;
  for (int b = 0; b < c->n_bodies; b++)
    nearest = nearest && c->bodies[b].motion != BW_SCENE_BREAKABLE;
  bw_scene_numerics *n = &c->numerics;
  if (nearest && isnan(n->horizon_ratio) && n->family_reach == INT_MIN) {
    n->horizon_ratio = 1.5;
    n->family_reach = BW_PD_REACH_HORIZON;
  }
  if (n->family_reach == INT_MIN) n->family_reach = BW_PD_REACH_HALF_CELL;
}

void bw_scene_resolve(bw_scene_config *c)
{
  set_families(c);
  /* The one in place of the other: who asks for a predictor does not repeat steps. */
  if (c->numerics.predictor && c->numerics.coupling_iterations == INT_MIN)
    c->numerics.coupling_iterations = 1;
  int *surface = &c->numerics.surface_correction;
  if (*surface == INT_MIN && !bw_scene__corrects_surfaces(c)) *surface = BW_PD_SURFACE_NONE;
  for (int q = 0; q < KNOBS; q++)
    if (knobs[q].of >= OF_ALL || bw_scene__has_particles(c))
      set_knob(&knobs[q], c->accuracy, &c->numerics, 1u << q);
  const bool flat = c->has_domain && c->domain.cells[2] == 1;
  if (c->plane == INT_MIN) c->plane = flat ? BW_SCENE_STRAIN : BW_SCENE_SPACE;
  if (isnan(c->thickness)) c->thickness = flat ? c->domain.length[2] : 1.0;
  for (int b = 0; b < c->n_bodies; b++) {
    bw_scene_body *body = &c->bodies[b];
    if (body->self_contact == INT_MIN) body->self_contact = body->motion == BW_SCENE_BREAKABLE;
    /* Particles at the fluid's spacing where nothing else is asked for. */
    if (isnan(body->spacing) && c->has_domain)
      body->spacing = c->domain.length[1] / c->domain.cells[1];
  }
}

/* Does the scene have somebody who reads it? */
static bool is_read(const bw_scene_config *c, const knob *k)
{
  const bool flow = bw_scene__has_fluid(c), deforms = bw_scene__any_deforms(c);
  const bool read[] = {[OF_PARTICLES] = true,
                       [OF_WETTED] = deforms,
                       [OF_ALL] = true,
                       [OF_SOLIDS] = deforms,
                       [OF_BONDS] = deforms && bw_scene__corrects_surfaces(c),
                       [OF_MARKERS] = flow && c->n_bodies > 0,
                       [OF_MOVING] = flow && (deforms || bw_scene__any_rigid(c)),
                       [OF_COUPLING] = flow && deforms};
  return read[k->of];
}

void bw_scene_knobs(const bw_scene_config *c, FILE *out)
{
  for (int q = 0; q < KNOBS; q++)
    if ((c->numerics.set & 1u << q) && is_read(c, &knobs[q])) {
      const bw_config_field *f = bw_scene__numerics_fields;
      while (strcmp(f->key, knobs[q].key) != 0)
        f++;
      const double value = knobs[q].value[c->accuracy];
      if (f->words != NULL)
        fprintf(out, "  numerics.%s = %s\n", f->key, bw_scene__word(f->words, (int)value));
      else
        fprintf(out, "  numerics.%s = %g\n", f->key, value);
    }
}
