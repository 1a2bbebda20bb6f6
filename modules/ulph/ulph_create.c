/* A fluid comes into being: particles, walls, lists, the state at the start. */
#include "bw_memory.h"
#include "bw_shape_surface.h"
#include "ulph_internal.h"

/* The weight reaches 3 dx; lists reach further by a skin, and particles nearer than this (of dx)
 * overlap. */
static const double REACH = 3, SKIN = 0.8, NEAR_SKIN = 0.12, OVERLAP = 0.5;
/* Length in the terms of viscosity and diffusion, of dx: ULPH's h. */
static const double SMOOTHING = 1.2;

bw_status bw_ulph_fill(const bw_comm *comm, const bw_ulph_config *config, const double origin[3],
                       int count, const bw_shape shape[], size_t *n, double **x)
{
  int64_t sites = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice =
      bw_shape_lattice_straight(config->dx, origin, config->dimensions == 2);
  *n = 0, *x = NULL;
  BW_TRY(bw_shape_fill_shared(comm, count, shape, &lattice, &sites, &site, &kind, NULL));
  const bw_status st = bw_comm_agree(comm, BW_ALLOCATE(x, 3 * (size_t)sites));
  if (st == BW_OK) {
    *n = (size_t)sites;
    for (size_t i = 0; i < *n; i++)
      for (int k = 0; k < config->dimensions; k++)
        (*x)[3 * i + (size_t)k] = origin[k] + (site[3 * i + (size_t)k] + 0.5) * config->dx;
  } else {
    bw_release(x);
  }
  bw_release(&site);
  bw_release(&kind);
  return st;
}

double bw_ulph_artificial_nu(const bw_ulph *u)
{
  return u->config.alpha * u->h * u->config.c0 / (2 * (u->config.dimensions + 2));
}

double bw_ulph_c0(const bw_ulph *u)
{
  return u->config.c0;
}

/* ---- what is refused ---- */
static bw_status check_places(const bw_ulph *u, int n_walls, const bw_ulph_wall wall[])
{
  const bool planar = u->config.dimensions == 2;
  for (size_t i = 0; i < u->n && u->own[i].wall < 0; i++) {
    const double *x = u->own[i].x;
    BW_REQUIRE(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]) && (!planar || x[2] == 0),
               BW_EINPUT, "ulph: a particle at (%g, %g, %g); places are finite, in 2D with z = 0",
               x[0], x[1], x[2]);
    for (int w = 0; w < n_walls; w++)
      BW_REQUIRE(bw_shape_distance(wall[w].count, wall[w].shape, planar, x) >= -1e-6 * u->config.dx,
                 BW_EINPUT,
                 "ulph: the fluid particle at (%g, %g, %g) is inside wall %d: cut the wall out of "
                 "the fluid",
                 x[0], x[1], x[2], w);
  }
  return BW_OK;
}

/* Fluid that overlaps with fluid, by the lists. */
static bw_status check_pairs(const bw_ulph *u)
{
  const double least = OVERLAP * u->config.dx;
  for (size_t c = 0; c < u->clusters.n; c++)
    for (int l = 0; l < u->clusters.of[c].lanes; l++) {
      const int32_t me = u->fluid.slot_own[u->clusters.of[c].first + (size_t)l];
      const double *x = u->near[me].x;
      for (size_t e = u->clusters.of[c].begin; e < u->clusters.of[c].walls; e++) {
        const double *y = u->near[u->list[e]].x;
        const double d[3] = {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
        BW_REQUIRE(u->list[e] == me || bw_ulph__dot(d, d) >= least * least, BW_EINPUT,
                   "ulph: particles at (%g, %g, %g) and (%g, %g, %g) overlap: they are nearer than "
                   "half of dx = %g; is a part of the fluid given twice?",
                   x[0], x[1], x[2], y[0], y[1], y[2], u->config.dx);
      }
    }
  return BW_OK;
}

/* ---- creating ---- */
static bw_status add_fluid(bw_ulph *u, size_t n, const double x[])
{
  const double m = u->config.rho0 * pow(u->config.dx, u->config.dimensions);
  int64_t first = bw_comm_prefix_sum(u->comm, (int64_t)n);
  BW_TRY(BW_ALLOCATE(&u->own, n));
  for (size_t i = 0; i < n; i++) {
    bw_ulph__particle *p = u->own + u->n++;
    *p = (bw_ulph__particle){.id = first++, .wall = -1, .m = m, .rho = u->config.rho0};
    memcpy(p->x, x + 3 * i, sizeof p->x);
    memcpy(p->at, p->x, sizeof p->at);
  }
  return BW_OK;
}

static void settle_constants(bw_ulph *u)
{
  const bw_ulph_config *c = &u->config;
  u->R = REACH * c->dx;
  u->skin = SKIN * c->dx;
  u->near_skin = NEAR_SKIN * c->dx;
  u->h = SMOOTHING * c->dx;
  u->m2 = bw_ulph__lattice_moment(c->dimensions, c->dx, u->R);
  for (int k = 0; k < 4; k++)
    u->half_space[k] = bw_ulph__half_space(c->dimensions, c->dx, u->R, k);
  u->mu_t = c->mu + c->rho0 * bw_ulph_artificial_nu(u);
  u->mu_wall = c->alpha_wall * c->rho0 * u->h * c->c0 / (2 * (c->dimensions + 2));
}

static bw_status copy_flags(bw_ulph *u, int n_walls, const bw_ulph_wall wall[])
{
  BW_TRY(BW_ALLOCATE(&u->no_slip, (size_t)n_walls + 1));
  BW_TRY(BW_ALLOCATE(&u->moves, (size_t)n_walls + 1));
  for (int w = 0; w < n_walls; w++) {
    u->no_slip[w] = wall[w].no_slip;
    u->moves[w] = wall[w].moves;
    BW_REQUIRE(!wall[w].moves || u->config.motion != NULL, BW_EINPUT,
               "ulph: wall %d moves, but the configuration has no motion", w);
  }
  u->n_walls = n_walls;
  return BW_OK;
}

static bw_status build(bw_ulph *u, size_t n, const double x[], int n_walls,
                       const bw_ulph_wall wall[])
{
  u->total = (int64_t)n;
  bw_comm_sum_int(u->comm, 1, &u->total);
  BW_REQUIRE(u->total > 0, BW_EINPUT, "ulph: there is no fluid: no site lies inside its shapes");
  BW_TRY(bw_comm_agree(u->comm, bw_ulph__check_sound(u->comm, &u->config, n, x)));
  settle_constants(u);
  BW_TRY(bw_comm_agree(u->comm, copy_flags(u, n_walls, wall)));
  BW_TRY(bw_comm_agree(u->comm, add_fluid(u, n, x)));
  BW_TRY(bw_comm_agree(u->comm, check_places(u, n_walls, wall)));
  BW_TRY(bw_ulph__build_walls(u, n_walls, wall));
  /* Lists show who overlaps. */
  bw_ulph__move_walls(u, 0);
  BW_TRY(bw_ulph__rebuild(u));
  return bw_comm_agree(u->comm, check_pairs(u));
}

bw_status bw_ulph_create(const bw_comm *comm, const bw_ulph_config *config, size_t n,
                         const double x[], int n_walls, const bw_ulph_wall wall[], bw_ulph **out)
{
  bw_ulph *u = NULL;
  *out = NULL;
  BW_TRY(bw_comm_agree(comm, bw_ulph__check(config)));
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&u, 1));
  if (st == BW_OK) {
    u->comm = comm;
    u->config = *config;
    st = build(u, n, x, n_walls, wall);
  }
  if (st != BW_OK) bw_ulph_destroy(&u);
  *out = u;
  return st;
}

void bw_ulph_destroy(bw_ulph **u)
{
  if (*u == NULL) return;
  bw_ulph__release_lists(*u);
  bw_particles_space_destroy(&(*u)->space);
  bw_release(&(*u)->own);
  bw_release(&(*u)->no_slip);
  bw_release(&(*u)->moves);
  bw_release(&(*u)->body.volume);
  bw_release(&(*u)->body.x);
  bw_release(&(*u)->body.v);
  bw_release(u);
}

/* ---- the start ---- */
static bw_status start_one(bw_ulph *u, bw_ulph__particle *p, bw_ulph_start_fn *start, void *context)
{
  const double c0 = u->config.c0;
  double v[3] = {0}, pressure = 0;
  if (start != NULL) start(p->x, context, v, &pressure);
  const double speed = sqrt(bw_ulph__dot(v, v));
  BW_REQUIRE(isfinite(pressure) && speed <= 0.1 * c0 * (1 + 1e-12), BW_EINPUT,
             "ulph: at (%g, %g, %g) the start has the speed %g and the pressure %g; c0 is %g: give "
             "a speed of at least that, so that c0 becomes 10 times it",
             p->x[0], p->x[1], p->x[2], speed, pressure, c0);
  memcpy(p->v, v, sizeof v);
  memset(p->shift, 0, sizeof p->shift);
  p->rho = u->config.rho0 + pressure / (c0 * c0);
  p->p = pressure;
  p->m = p->rho * pow(u->config.dx, u->config.dimensions);
  return BW_OK;
}

bw_status bw_ulph_start(bw_ulph *u, bw_ulph_start_fn *start, void *context)
{
  bw_status st = BW_OK;
  for (size_t i = 0; i < u->fluid.own && st == BW_OK; i++)
    st = start_one(u, u->own + i, start, context);
  BW_TRY(bw_comm_agree(u->comm, st));
  u->time = u->time_built = 0;
  u->steps = 0;
  bw_ulph__move_walls(u, 0);
  /* Places may have moved since the lists were made. */
  bw_ulph__mark_places(u);
  BW_TRY(bw_ulph__rebuild(u));
  bw_ulph__move_walls(u, 0);
  bw_ulph__evaluate(u, 0);
  memset(&u->book, 0, sizeof u->book);
  bw_ulph__join_books(u);
  u->first_energy = bw_ulph__energy(u);
  u->started = true;
  return BW_OK;
}
