/* A fluid of particles: its walls, its particles, its first state; of a large plan a sample. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_shape_surface.h"
#include <math.h>
#include <string.h>

/* Walls around the box are so many spacings thick, of which the fluid sees three. */
static const double THICK = 4.0;
/* A plan of at most so many particles is made. */
static const double FEW = 1e5;

/* What is made: a box with walls, and bodies that are walls as well. */
typedef struct {
  double size[3];
  bool whole; /* with the bodies of the scene */
  bw_shape tank[2];
  bw_scene__shapes *of; /* (bodies) */
  int n_walls;
  bw_ulph_wall wall[1 + BW_SCENE_BODIES];
} basin;

static int axes_of(const bw_scene *s)
{
  return s->planar ? 2 : 3;
}

static bool sticks(const bw_scene *s)
{
  return s->config.fluid.walls == BW_SCENE_STICK;
}

/* ---- walls ---- */

/* The block around the box, and the box with its open sides opened, which is taken away. */
static void make_tank(const bw_scene *s, basin *b)
{
  const double t = THICK * s->water->config.dx;
  b->tank[0] = (bw_shape){.kind = BW_SHAPE_BOX};
  b->tank[1] = (bw_shape){.kind = BW_SHAPE_BOX, .remove = true};
  for (int d = 0; d < 3; d++) {
    b->tank[0].lower[d] = -t, b->tank[0].upper[d] = b->size[d] + t;
    b->tank[1].lower[d] = bw_scene__is_open(&s->config, d, 0) ? -2.0 * t : 0.0;
    b->tank[1].upper[d] = b->size[d] + (bw_scene__is_open(&s->config, d, 1) ? 2.0 * t : 0.0);
  }
  b->wall[b->n_walls++] = (bw_ulph_wall){
      .count = 2, .shape = b->tank, .no_slip = sticks(s), .moves = s->config.domain.has_shake};
}

static bw_status make_walls(const bw_scene *s, basin *b)
{
  const bw_scene_config *c = &s->config;
  make_tank(s, b);
  BW_TRY(BW_ALLOCATE(&b->of, (size_t)c->n_bodies));
  for (int k = 0; k < c->n_bodies && b->whole; k++) {
    BW_TRY(bw_scene__shapes_make(c, k, &b->of[k]));
    if (!bw_scene__is_wall(c, k)) continue;
    b->wall[b->n_walls++] = (bw_ulph_wall){.count = b->of[k].n,
                                           .shape = b->of[k].shape,
                                           .no_slip = sticks(s),
                                           .moves = c->domain.has_shake};
  }
  return BW_OK;
}

static void release(const bw_scene *s, basin *b)
{
  for (int k = 0; k < s->config.n_bodies && b->of != NULL; k++)
    bw_scene__shapes_release(&b->of[k]);
  bw_release(&b->of);
}

/* ---- particles ---- */

/* No fluid where a body is: what is on its surface is in it, too. Images are shapes of the fluid
 * already. */
static void take_away(const bw_scene *s, const basin *b, size_t *n, double x[])
{
  const double tie = 1e-9 * s->water->config.dx;
  size_t kept = 0;
  for (size_t i = 0; i < *n; i++) {
    bool inside = false;
    for (int k = 0; k < s->config.n_bodies && b->whole && !inside; k++)
      inside = b->of[k].analytic &&
               bw_shape_distance(b->of[k].n, b->of[k].shape, s->planar, x + 3 * i) < tie;
    if (inside) continue;
    memmove(x + 3 * kept++, x + 3 * i, 3 * sizeof *x);
  }
  *n = kept;
}

/* The shapes of the fluid, and behind them those of bodies that are images, taken away. */
static bw_status list_shapes(const bw_scene *s, const basin *b, const bw_scene__shapes *fluid,
                             int *n, bw_shape **shape)
{
  int all = fluid->n;
  for (int k = 0; k < s->config.n_bodies && b->whole; k++)
    all += b->of[k].n;
  BW_TRY(BW_ALLOCATE(shape, (size_t)all));
  memcpy(*shape, fluid->shape, (size_t)fluid->n * sizeof **shape);
  *n = fluid->n;
  for (int k = 0; k < s->config.n_bodies && b->whole; k++)
    for (int q = 0; q < b->of[k].n && !b->of[k].analytic; q++) {
      BW_REQUIRE(!b->of[k].shape[q].remove, BW_EINPUT,
                 "bodies.%s.shape: parts are taken away from an image, which this build cannot "
                 "keep the fluid out of; give an image without them",
                 s->config.bodies[k].name);
      (*shape)[*n] = b->of[k].shape[q];
      (*shape)[(*n)++].remove = true;
    }
  return BW_OK;
}

static bw_status fill(bw_scene *s, const basin *b, const bw_scene__shapes *fluid, size_t *n,
                      double **x)
{
  static const double origin[3] = {0};
  bw_shape *shape = NULL;
  int count = 0;
  bw_status st = bw_comm_agree(s->comm, list_shapes(s, b, fluid, &count, &shape));
  BW_THEN(st, bw_ulph_fill(s->comm, &s->water->config, origin, count, shape, n, x));
  if (st == BW_OK) take_away(s, b, n, *x);
  bw_release(&shape);
  return st;
}

/* ---- the first state ---- */

typedef struct {
  const bw_scene *s;
  const bw_scene__shapes *fluid;
} first;

/* Fluid at rest below the top of the last shape that holds the place: p = rho g.(x - x_top). */
static void start(const double x[3], void *context, double v[3], double *p)
{
  const first *f = context;
  const bw_scene_config *c = &f->s->config;
  double lower[3], upper[3];
  memcpy(lower, f->fluid->lower, sizeof lower);
  memcpy(upper, f->fluid->upper, sizeof upper);
  for (int k = 0; k < f->fluid->n; k++)
    if (!f->fluid->shape[k].remove &&
        bw_shape_distance(1, &f->fluid->shape[k], f->s->planar, x) <= 0.0)
      bw_scene__shape_extent(&f->fluid->shape[k], lower, upper);
  *p = 0.0;
  for (int d = 0; d < 3; d++) {
    const double top = c->gravity[d] < 0.0 ? upper[d] : lower[d];
    if (c->gravity[d] != 0.0) *p += c->fluid.density * c->gravity[d] * (x[d] - top);
    v[d] = c->fluid.start.velocity[d];
  }
  if (c->fluid.start.hydrostatic == 0) *p = 0.0;
  if (f->s->planar) v[2] = 0.0;
}

/* ---- the whole, or a sample ---- */

/* Walls that the solid does not go through: the closed sides of the box. */
static bw_status keep_inside(bw_scene *s)
{
  bw_pd_wall wall[BW_PD_WALLS];
  int n = 0;
  for (int d = 0; d < axes_of(s); d++)
    for (int end = 0; end < 2; end++) {
      if (bw_scene__is_open(&s->config, d, end)) continue;
      wall[n] = (bw_pd_wall){.offset = end == 0 ? 0.0 : -s->config.domain.length[d]};
      wall[n++].normal[d] = end == 0 ? 1.0 : -1.0;
    }
  return bw_solid_set_walls(s->solid[0].solid, n, wall);
}

static bw_status join_solid(bw_scene *s, const basin *b)
{
  bw_coupler_particles_config c = bw_coupler_particles_config_default();
  memcpy(c.gravity, s->config.gravity, sizeof c.gravity);
  c.solid_safety = s->config.numerics.solid_share;
  c.virtual_mass = s->config.numerics.virtual_mass;
  c.no_slip = sticks(s);
  if (s->solid[0].contact) BW_TRY(keep_inside(s));
  return bw_coupler_particles_create(&c, &s->water->config, s->water->fluid, s->solid[0].solid,
                                     b->n_walls, b->wall, &s->water->both);
}

static bw_status make(bw_scene *s, basin *b, const bw_scene__shapes *fluid)
{
  bw_scene__water *w = s->water;
  first with = {s, fluid};
  double *x = NULL;
  size_t n = 0;
  bw_status st = bw_comm_agree(s->comm, make_walls(s, b));
  BW_THEN(st, fill(s, b, fluid, &n, &x));
  BW_THEN(st, bw_ulph_create(s->comm, &w->config, n, x, b->n_walls, b->wall, &w->fluid));
  /* The solid before the start: its particles are part of the first forces. */
  if (b->whole && s->n_solids > 0) BW_THEN(st, join_solid(s, b));
  BW_THEN(st, bw_ulph_start(w->fluid, start, &with));
  bw_release(&x);
  release(s, b);
  return st;
}

/* Particles of the fluid where its shapes do not overlap, and of the walls around it. */
static bw_status count(bw_scene *s)
{
  static const double origin[3] = {0};
  bw_scene__water *w = s->water;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(w->config.dx, origin, s->planar);
  double outer = 1.0, inner = 1.0, one;
  for (int d = 0; d < axes_of(s); d++) {
    const double cells = s->config.domain.cells[d];
    outer *= cells + 2.0 * THICK;
    inner *=
        cells + THICK * (bw_scene__is_open(&s->config, d, 0) + bw_scene__is_open(&s->config, d, 1));
  }
  w->walls = outer - inner;
  for (int k = 0; k < s->config.n_bodies; k++) {
    if (!bw_scene__is_wall(&s->config, k)) continue;
    BW_TRY(bw_scene__count_body(s, k, &lattice, &one));
    w->walls += one;
  }
  return bw_scene__count_body(s, BW_SCENE__FLUID, &lattice, &w->sites);
}

/* Sound is ten times as fast as anything else: of the whole depth, which a sample does not have. */
static bw_status set_sound(bw_scene *s, const double depth)
{
  bw_ulph_config *f = &s->water->config;
  const double *g = s->config.gravity, weight = hypot(hypot(g[0], g[1]), g[2]);
  const double needed = 10.0 * fmax(f->speed, sqrt(weight * depth));
  if (isnan(f->c0)) f->c0 = needed;
  BW_REQUIRE(f->c0 >= needed * (1.0 - 1e-9), BW_EINPUT,
             "numerics.sound_speed = %g: it must be at least %g, 10 times the largest of the "
             "expected speed, %g, and sqrt(gravity depth)",
             f->c0, needed, f->speed);
  return BW_OK;
}

/* A corner of the box, half full: what a particle costs, and which step it bears. */
static bw_status make_sample(bw_scene *s)
{
  const int edge = s->planar ? 60 : 16; /* spacings */
  bw_scene__water *w = s->water;
  bw_scene__shapes water = {.n = 1, .analytic = true};
  basin b = {.whole = false};
  water.shape[0] = (bw_shape){.kind = BW_SHAPE_BOX};
  for (int d = 0; d < axes_of(s); d++) {
    b.size[d] = fmin(s->config.domain.length[d], edge * w->config.dx);
    water.shape[0].upper[d] = (d == 1 ? 0.5 : 1.0) * b.size[d];
  }
  memcpy(water.upper, water.shape[0].upper, sizeof water.upper);
  w->sampled = true;
  return make(s, &b, &water);
}

/* Bytes of a rank: by what was made, with a checkpoint on its way. A particle of a wall holds about
 * half of what one of the fluid does (tests/robustness/memory.sh tells two sizes of a tank). */
static void weigh(bw_scene *s, double held)
{
  static const double wall = 0.5;
  bw_scene__water *w = s->water;
  const double ranks = bw_comm_size(s->comm), n = w->sites / ranks;
  const double own = (double)bw_ulph_count(w->fluid) + wall * (double)bw_ulph_wall_count(w->fluid);
  const double row = BW_ULPH_ROW * sizeof(double);
  w->bytes = held / fmax(own, 1.0) * (n + wall * w->walls / ranks) + n * (row + sizeof(int64_t)) +
             bw_checkpoint_table_bytes(n, row) + bw_checkpoint_file_bytes();
}

bw_status bw_scene__water_make(bw_scene *s)
{
  bw_scene__water *w = s->water;
  bw_scene__shapes *fluid = NULL;
  basin b = {.whole = true};
  const double before = (double)bw_memory_in_use();
  memcpy(b.size, s->config.domain.length, sizeof b.size);
  bw_status st = BW_ALLOCATE(&fluid, 1);
  BW_THEN(st, bw_scene__shapes_make(&s->config, BW_SCENE__FLUID, fluid));
  /* A plan is counted first; one that is large is judged by a sample. */
  if (s->planned) BW_THEN(st, count(s));
  const bool large = s->planned && (s->sketched || w->sites + w->walls > FEW);
  double depth = 0.0;
  for (int d = 0; st == BW_OK && d < 3; d++)
    if (s->config.gravity[d] != 0.0) depth = fmax(depth, fluid->upper[d] - fluid->lower[d]);
  if (large || !isnan(w->config.c0)) BW_THEN(st, set_sound(s, depth));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK) st = large ? make_sample(s) : make(s, &b, fluid);
  if (fluid != NULL) bw_scene__shapes_release(fluid);
  bw_release(&fluid);
  if (st != BW_OK) return st;
  if (!large) {
    int64_t walls = (int64_t)bw_ulph_wall_count(w->fluid);
    bw_comm_sum_int(s->comm, 1, &walls);
    w->sites = (double)bw_ulph_total(w->fluid), w->walls = (double)walls;
  }
  if (s->planned) weigh(s, (double)bw_memory_in_use() - before);
  return BW_OK;
}
