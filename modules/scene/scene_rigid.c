/* Rigid bodies of a scene.
 *
 * Alone, or with bodies that are fixed or prescribed beside them, all are bw_rigid's, which finds
 * their contacts; bw_coupler_rigid joins them to a flow, bw_coupler_join to particles in it. Beside
 * solids of particles without a flow a rigid body is a solid, too, whose particles are prescribed:
 * contact between lattices loads it, and they follow it, in a Verlet step of all:
 *   kick the bodies dt/2, drift; particles of theirs to where they now are, solids step, contact
 *   there; kick dt/2 with its load. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "pd_body.h"
#include <math.h>
#include <string.h>

void bw_scene__rigid_destroy(bw_scene *s)
{
  bw_coupler_rigid_destroy(&s->floats);
  bw_rigid_destroy(&s->rigid);
  for (int q = 0; s->rigid_shapes != NULL && q < s->config.n_bodies; q++)
    bw_scene__shapes_release(&s->rigid_shapes[q]);
  bw_release(&s->rigid_shapes);
  bw_release(&s->rigid_start);
  bw_release(&s->rigid_before);
  bw_release(&s->rigid_load);
}

/* ---- making them ---- */

/* The bodies of the set, while it is made. */
typedef struct {
  int n;
  int number[BW_SCENE_BODIES]; /* in the file */
  bw_scene__shapes *shapes;    /* (n) those that the scene keeps */
  bw_rigid_body ask[BW_SCENE_BODIES];
} maker;

/* The shapes of a body; images and surfaces of triangles by the surface of their voxels. */
static bw_status find_shapes(const bw_scene *s, int b, bw_scene__shapes *shapes)
{
  BW_TRY(bw_scene__shapes_make(&s->config, b, shapes));
  for (int q = 0; q < shapes->n_masks; q++) {
    const bw_status st = bw_shape_mask_find_surface(shapes->mask[q], s->planar);
    if (st == BW_EINPUT)
      return BW_FAIL(st, "bodies.%s.shape: a rigid body needs its surface; %s",
                     s->config.bodies[b].name, bw_last_message());
    BW_TRY(st);
  }
  return BW_OK;
}

/* Mass, centre and inertia where the file names some: the rest is that of the shapes. */
static bw_status set_mass(const bw_scene *s, const bw_rigid_config *config,
                          const bw_scene_body *body, bw_rigid_body *ask)
{
  const bw_scene_rigid *r = &body->rigid;
  const bool inertia = !isnan(r->inertia[0]), centre = !isnan(r->centre[0]);
  const int m = bw_scene__material_named(&s->config, body->material);
  bw_rigid *trial = NULL;
  /* What is told how to move has no weight and no kinetic energy in the books: next to no mass. */
  static const double told = 1e-60;
  ask->density = m >= 0 ? s->config.materials[m].density : 1.0;
  if (body->motion != BW_SCENE_RIGID) ask->density = told;
  if (isnan(r->mass) && !inertia && !centre) return BW_OK;
  bw_rigid_body sample = *ask;
  memset(sample.held, 0, sizeof sample.held);
  BW_TRY(bw_rigid_create(s->comm, config, 1, &sample, &trial));
  const bw_rigid_state full = bw_rigid_state_of(trial, 0);
  bw_rigid_destroy(&trial);
  const double mass = isnan(r->mass) ? full.mass : r->mass;
  ask->density *= mass / full.mass;
  if (!inertia && !centre) return BW_OK;
  BW_REQUIRE(inertia, BW_EINPUT,
             "bodies.%s.rigid.centre: the mass is not spread evenly then; give inertia, too",
             body->name);
  /* All by the file. */
  ask->density = 0.0;
  ask->mass = mass;
  for (int d = 0; d < 3; d++) {
    ask->centre[d] = centre ? r->centre[d] : full.position[d];
    ask->inertia[d][d] =
        s->planar ? fmax(r->inertia[0], fmax(r->inertia[1], r->inertia[2])) : r->inertia[d];
  }
  return BW_OK;
}

/* Springs and what is held of a rigid body; another one is held altogether. */
static void set_freedom(const bw_scene_body *body, bw_rigid_body *ask)
{
  const bw_scene_rigid *r = &body->rigid;
  char wrong[BW_SCENE_NAME];
  unsigned bits = 63;
  if (body->motion == BW_SCENE_RIGID) (void)bw_scene__held_bits(r->held, &bits, wrong);
  for (int d = 0; d < 6; d++)
    ask->held[d] = bits >> d & 1;
  if (body->motion != BW_SCENE_RIGID) return;
  for (int d = 0; d < 3; d++) {
    ask->stiffness[d] = r->stiffness[d], ask->damping[d] = r->damping[d];
    ask->stiffness[3 + d] = r->turn_stiffness, ask->damping[3 + d] = r->turn_damping;
  }
}

static bw_status ask_for(const bw_scene *s, const bw_rigid_config *config, maker *m)
{
  for (int b = 0; b < s->config.n_bodies; b++) {
    const bw_scene_body *body = &s->config.bodies[b];
    if (!bw_scene__in_rigid(&s->config, b)) continue;
    bw_scene__shapes *shapes = &m->shapes[m->n];
    bw_rigid_body *ask = &m->ask[m->n];
    m->number[m->n++] = b;
    BW_TRY(find_shapes(s, b, shapes));
    *ask = (bw_rigid_body){.count = shapes->n, .shape = shapes->shape};
    set_freedom(body, ask);
    BW_TRY(bw_scene__of_body(&s->config, b, set_mass(s, config, body, ask)));
  }
  return BW_OK;
}

/* Stiffness of the contact: a ball of radius R that is pressed d into a wall has the energy
 * pi R k d^3/3 of an elastic foundation; with d = half a spacing it takes up m v^2/2, v being the
 * fastest velocity of the file and that of a fall through all of the scene. */
static double stiffness_of(const bw_scene *s, const maker *m, double spacing)
{
  const bw_scene_config *c = &s->config;
  const double *g = c->gravity, weight = hypot(hypot(g[0], g[1]), g[2]), d = 0.5 * spacing;
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double most = 0.0, span = 0.0;
  /* Outside of flows contact between lattices does it. */
  const bool lattices = bw_scene__any_deforms(c) && !bw_scene__has_fluid(c);
  if (lattices || strcmp(c->contact.between, "none") == 0) return 0.0;
  if (!isnan(c->numerics.contact_stiffness)) return c->numerics.contact_stiffness;
  for (int q = 0; q < m->n; q++)
    for (int k = 0; k < (s->planar ? 2 : 3); k++) {
      lower[k] = fmin(lower[k], c->has_domain ? 0.0 : m->shapes[q].lower[k]);
      upper[k] = fmax(upper[k], c->has_domain ? c->domain.length[k] : m->shapes[q].upper[k]);
      span = fmax(span, upper[k] - lower[k]);
    }
  for (int q = 0; q < m->n; q++) {
    const bw_scene_body *b = &c->bodies[m->number[q]];
    double R = 0.0, V[3];
    if (b->motion != BW_SCENE_RIGID) continue;
    for (int k = 0; k < (s->planar ? 2 : 3); k++)
      R = fmax(R, 0.5 * (m->shapes[q].upper[k] - m->shapes[q].lower[k]));
    bw_scene__velocity(b, m->shapes[q].upper, 0.0, V);
    const double v = fmax(s->speed, hypot(hypot(V[0], V[1]), V[2]));
    const int own = bw_scene__material_named(c, b->material);
    const double volume = s->planar ? acos(-1.0) * R * R * c->thickness : 4.0 * R * R * R;
    const double rho = isnan(b->rigid.mass) ? c->materials[own].density : b->rigid.mass / volume;
    const double energy = 0.5 * rho * (v * v + 2.0 * weight * span); /* per volume */
    /* Of a disc: 4/15 k sqrt(2 R d) d^2 sqrt(...) per depth; the ball's form is near enough. */
    most = fmax(most, 4.0 * energy * R * R / (d * d * d));
  }
  return most;
}

static void configure(const bw_scene *s, bw_rigid_config *config)
{
  const bw_scene_config *c = &s->config;
  *config = bw_rigid_config_default();
  config->planar = s->planar;
  config->depth = c->thickness;
  config->friction = c->contact.friction;
  config->spacing = HUGE_VAL;
  for (int b = 0; b < c->n_bodies; b++)
    if (bw_scene__in_rigid(c, b)) config->spacing = fmin(config->spacing, c->bodies[b].spacing);
  if (s->grid != NULL) {
    /* Weight is the coupler's there, which knows the fluid displaced. */
    config->spacing = bw_grid_look(s->grid)->spacing[0];
    for (int d = 0; d < (s->planar ? 2 : 3); d++) {
      config->upper[d] = c->domain.length[d];
      for (int end = 0; end < 2; end++)
        config->walled[d][end] = s->flow.side[d][end].kind == BW_SIDE_WALL ||
                                 s->flow.side[d][end].kind == BW_SIDE_FREE_SLIP;
    }
    return;
  }
  for (int d = 0; d < (s->planar ? 2 : 3); d++)
    config->gravity[d] = c->gravity[d];
}

static bw_status make(bw_scene *s, maker *m)
{
  bw_rigid_config config;
  configure(s, &config);
  BW_TRY(bw_comm_agree(s->comm, ask_for(s, &config, m)));
  config.stiffness = stiffness_of(s, m, config.spacing);
  const bw_status st = bw_rigid_create(s->comm, &config, m->n, m->ask, &s->rigid);
  for (int q = 0; q < m->n; q++)
    s->rigid_of[m->number[q]] = q;
  return bw_scene__rigid_named(s, st);
}

/* The modules count, the file has names. */
bw_status bw_scene__rigid_named(const bw_scene *s, bw_status st)
{
  int number = 0;
  char words[1024];
  snprintf(words, sizeof words, "%s", bw_last_message());
  if (st != BW_EINPUT || sscanf(words, "rigid body %d", &number) != 1) return st;
  for (int b = 0; b < s->config.n_bodies; b++)
    if (s->rigid_of[b] == number)
      return BW_FAIL(st, "bodies.%s: %s", s->config.bodies[b].name, words);
  return st;
}

/* Velocity of the centre and spin of a body that is told, or starts, at a time. */
static void motion_of(const bw_scene_body *b, const double centre[3], double time, double V[3],
                      double W[3])
{
  const double *e = b->rotation.axis;
  const double size = hypot(hypot(e[0], e[1]), e[2]);
  bw_scene__velocity(b, centre, time, V);
  for (int d = 0; d < 3; d++)
    W[d] = b->has_rotation ? b->rotation.rate * e[d] / size : 0.0;
}

static bw_status allocate(bw_scene *s)
{
  const size_t n = (size_t)bw_rigid_count(s->rigid);
  BW_TRY(BW_ALLOCATE(&s->rigid_start, n));
  BW_TRY(BW_ALLOCATE(&s->rigid_before, n));
  return BW_ALLOCATE(&s->rigid_load, 6 * n);
}

static bw_status join(bw_scene *s)
{
  const bw_scene_numerics *n = &s->config.numerics;
  bw_coupler_rigid_config c = bw_coupler_rigid_config_default();
  c.rho = s->config.fluid.density, c.nu = s->config.fluid.viscosity;
  c.virtual_mass = n->virtual_mass;
  c.body.kernel = (bw_kernel_delta_id)n->kernel;
  c.body.n_iter = n->forcing_iterations;
  c.body.memory = n->memory;
  c.films.on = !isnan(s->config.fluid.film_roughness);
  c.films.limit = s->config.fluid.film_limit, c.films.roughness = s->config.fluid.film_roughness;
  memcpy(c.gravity, s->config.gravity, sizeof c.gravity);
  return bw_scene__rigid_named(s, bw_coupler_rigid_create(&c, s->fluid, s->rigid, &s->floats));
}

bw_status bw_scene__rigid_create(bw_scene *s)
{
  maker *m = NULL;
  for (int b = 0; b < s->config.n_bodies; b++)
    s->rigid_of[b] = -1;
  if (!bw_scene__any_rigid(&s->config)) return BW_OK;
  bw_status st = BW_ALLOCATE(&m, 1);
  BW_THEN(st, BW_ALLOCATE(&s->rigid_shapes, (size_t)s->config.n_bodies));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK) m->shapes = s->rigid_shapes;
  BW_THEN(st, make(s, m));
  BW_THEN(st, bw_comm_agree(s->comm, allocate(s)));
  for (int q = 0; st == BW_OK && q < m->n; q++) {
    const bw_scene_body *body = &s->config.bodies[m->number[q]];
    double V[3], W[3];
    motion_of(body, bw_rigid_state_of(s->rigid, q).position, 0.0, V, W);
    bw_rigid_set_motion(s->rigid, q, V, W);
    s->rigid_start[q] = s->rigid_before[q] = bw_rigid_state_of(s->rigid, q);
  }
  if (st == BW_OK) s->rigid_weight = bw_rigid_energy_of(s->rigid).weight;
  if (st == BW_OK && s->fluid != NULL) st = join(s);
  bw_release(&m);
  return st;
}

/* ---- steps ---- */

void bw_scene__rigid_place(const bw_scene *s, int q, const bw_rigid_state *now, const double X0[3],
                           double X[3])
{
  const double *start = s->rigid_start[q].position;
  for (int i = 0; i < 3; i++) {
    X[i] = now->position[i];
    for (int j = 0; j < 3; j++)
      X[i] += now->turn[i][j] * (X0[j] - start[j]);
  }
}

double bw_scene__rigid_speed(const bw_scene *s)
{
  double most = 0.0;
  for (int q = 0; s->rigid != NULL && q < bw_rigid_count(s->rigid); q++) {
    const bw_rigid_state a = bw_rigid_state_of(s->rigid, q);
    most = fmax(most,
                hypot(hypot(a.velocity[0], a.velocity[1]), a.velocity[2]) +
                    bw_rigid_radius(s->rigid, q) * hypot(hypot(a.spin[0], a.spin[1]), a.spin[2]));
  }
  return most;
}

void bw_scene__rigid_tell(bw_scene *s, double dt)
{
  for (int b = 0; b < s->config.n_bodies; b++) {
    const bw_scene_body *body = &s->config.bodies[b];
    const int q = s->rigid_of[b];
    if (q < 0 || body->motion != BW_SCENE_PRESCRIBED) continue;
    double from[3], to[3], V[3], W[3];
    const double *start = s->rigid_start[q].position;
    motion_of(body, start, s->time, V, W);
    /* The velocity that brings the centre where it belongs at the end of the step. */
    bw_scene__motion(body, start, s->time, from);
    bw_scene__motion(body, start, s->time + dt, to);
    for (int d = 0; d < 3; d++)
      V[d] = (to[d] - from[d]) / dt;
    bw_rigid_set_motion(s->rigid, q, V, W);
  }
}

/* Damping against rest, of the run and of the phase: -c V per volume; of the turn with the mean of
 * the principal moments, which in two dimensions is the moment. */
static void damp(bw_scene *s)
{
  const int n = bw_rigid_count(s->rigid);
  const double c = s->config.numerics.damping_absolute + s->config.phases[s->phase].damp;
  for (int q = 0; q < n && c > 0.0; q++) {
    const bw_rigid_state *a = &s->rigid_before[q];
    const double I = (a->inertia[0] + a->inertia[1] + a->inertia[2]) / 3.0;
    for (int d = 0; d < 3; d++) {
      s->rigid_load[3 * q + d] -= c * a->volume * a->velocity[d];
      s->rigid_load[3 * (n + q) + d] -= c * a->volume / a->mass * I * a->spin[d];
    }
  }
}

/* The sums over the particles of each rigid body of what presses on them; rigid_before holds the
 * present states. Collective. */
static void gather_load(bw_scene *s)
{
  const int n = bw_rigid_count(s->rigid);
  double *load = s->rigid_load;
  memset(load, 0, 6 * (size_t)n * sizeof *load);
  for (int k = 0; k < s->n_solids; k++) {
    const bw_scene__solid *p = &s->solid[k];
    const bw_pd_body *pd = bw_solid_body(p->solid);
    for (size_t i = 0; i < p->n; i++) {
      const int q = s->rigid_of[bw_scene__body_of(p, i)];
      if (q < 0) continue;
      const double mass = bw_solid_density(p->solid, i) * bw_solid_volume_of(p->solid, i);
      double X[3], r[3], f[3] = {0};
      bw_scene__rigid_place(s, q, &s->rigid_before[q], p->X0 + 3 * i, X);
      for (int d = 0; d < 3; d++)
        r[d] = X[d] - s->rigid_before[q].position[d];
      for (int d = 0; d < pd->dimension; d++)
        f[d] = mass * (double)(pd->a[d][i] + pd->load.extra[d][i]);
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, h = (d + 2) % 3;
        load[3 * q + d] += f[d];
        load[3 * (n + q) + d] += r[e] * f[h] - r[h] * f[e];
      }
    }
  }
  bw_comm_sum(s->comm, 6 * (size_t)n, load);
}

static void remember(bw_scene *s)
{
  for (int q = 0; q < bw_rigid_count(s->rigid); q++)
    s->rigid_before[q] = bw_rigid_state_of(s->rigid, q);
}

bw_status bw_scene__rigid_step(bw_scene *s, double dt, bw_status (*solids)(bw_scene *s, double dt))
{
  const size_t n = (size_t)bw_rigid_count(s->rigid);
  double *F = s->rigid_load, *T = F + 3 * n;
  remember(s);
  if (s->n_solids == 0) {
    memset(F, 0, 6 * n * sizeof *F);
    bw_scene__rigid_tell(s, dt);
    damp(s);
    bw_rigid_load(s->rigid, F, T);
    return bw_rigid_step(s->rigid, dt);
  }
  /* What pressed at the end of the last step, then what presses at the end of this one. */
  bw_rigid_load(s->rigid, F, T);
  BW_TRY(bw_rigid_begin(s->rigid, dt));
  BW_TRY(solids(s, dt));
  remember(s);
  gather_load(s);
  damp(s);
  bw_rigid_load(s->rigid, F, T);
  return bw_rigid_end(s->rigid, dt);
}
