/* Walls: particles inside solid shapes. */
#include "bw_memory.h"
#include "bw_shape_surface.h"
#include "ulph_internal.h"

/* Layers of wall particles: as deep as the weight reaches. */
enum { LAYERS = 3 };

static bw_shape_lattice lattice_of(const bw_ulph *u, const bw_ulph_wall *w)
{
  bw_shape_lattice lattice =
      bw_shape_lattice_straight(u->config.dx, w->origin, u->config.dimensions == 2);
  memcpy(lattice.axes, w->axes, sizeof lattice.axes);
  return lattice;
}

static void centre_of(const bw_shape_lattice *g, const int32_t site[3], double x[3])
{
  const bool straight = g->axes[0][0] == 0 && g->axes[0][1] == 0 && g->axes[0][2] == 0;
  for (int k = 0; k < 3; k++) {
    x[k] = g->origin[k];
    for (int a = 0; a < 3; a++) {
      const double axis = straight ? (a == k ? 1 : 0) : g->axes[a][k];
      x[k] += axis * (site[a] + 0.5) * g->ds;
    }
  }
  if (g->planar) x[2] = 0;
}

/* Behind a particle of the first layer the wall goes on for the reach of the weight. */
static bw_status check_thick(const bw_ulph *u, int number, const bw_ulph_wall *w,
                             const bw_ulph__particle *p)
{
  const bool planar = u->config.dimensions == 2;
  const double dx = u->config.dx, back = (LAYERS - 0.05) * dx - p->depth;
  double y[3];
  if (p->depth > dx) return BW_OK;
  for (int k = 0; k < 3; k++)
    y[k] = p->x[k] - back * p->normal[k];
  if (bw_shape_distance(w->count, w->shape, planar, y) <= 1e-6 * dx) return BW_OK;
  return BW_FAIL(BW_EINPUT,
                 "ulph: wall %d is thinner than %d dx = %g behind its surface near (%g, %g, %g): "
                 "thicken it, or take dx below %.3g of its thickness",
                 number, LAYERS, LAYERS * dx, p->x[0], p->x[1], p->x[2], 1.0 / LAYERS);
}

/* All walls, and the one that is built. */
typedef struct {
  int n, number;
  const bw_ulph_wall *of;
} walls;

/* Where walls meet, the fluid nearest to a particle of one of them is outside of all that move with
 * it: out of one after the other. An image across one of them alone would be none across the others
 * and feed the water beside the corner. */
static void look_out(const walls *all, bool planar, bw_ulph__particle *p)
{
  enum { TURNS = 8 };
  double y[3], way[3], far = 0;
  memcpy(y, p->x, sizeof y);
  for (int turn = 0; turn < TURNS; turn++)
    for (int q = 0; q < all->n; q++) {
      const bw_ulph_wall *w = all->of + q;
      const double out = bw_shape_distance(w->count, w->shape, planar, y);
      double normal[3];
      if (w->moves != all->of[all->number].moves || out >= 0) continue;
      bw_shape_normal(w->count, w->shape, planar, y, normal);
      for (int k = 0; k < 3; k++)
        y[k] -= out * normal[k];
    }
  for (int k = 0; k < 3; k++) {
    way[k] = y[k] - p->x[k];
    far += way[k] * way[k];
  }
  far = sqrt(far);
  /* Of a wall alone this is what it was. */
  if (far < p->depth * (1 + 1e-6)) return;
  p->depth = far;
  for (int k = 0; k < 3; k++)
    p->normal[k] = way[k] / far;
}

/* Sites within reach of the surface, but not in a wall that was built before. */
static bw_status keep_near(bw_ulph *u, const walls *all, int64_t n, const int32_t site[])
{
  const bw_ulph_wall *wall = all->of;
  const int number = all->number;
  const bw_ulph_wall *w = wall + number;
  const bool planar = u->config.dimensions == 2;
  const bw_shape_lattice lattice = lattice_of(u, w);
  for (int64_t i = 0; i < n; i++) {
    bw_ulph__particle p = {.wall = number, .m = u->config.rho0 * pow(u->config.dx, planar ? 2 : 3)};
    centre_of(&lattice, site + 3 * i, p.x);
    const double inside = -bw_shape_distance(w->count, w->shape, planar, p.x);
    bool kept = inside > 0 && inside < LAYERS * u->config.dx;
    for (int q = 0; q < number && kept; q++)
      kept = bw_shape_distance(wall[q].count, wall[q].shape, planar, p.x) > 0;
    if (!kept) continue;
    p.depth = inside;
    memcpy(p.at, p.x, sizeof p.at);
    p.rho = u->config.rho0;
    bw_shape_normal(w->count, w->shape, planar, p.x, p.normal);
    BW_TRY(check_thick(u, number, w, &p));
    look_out(all, planar, &p);
    if (p.depth < LAYERS * u->config.dx) u->own[u->n++] = p;
  }
  return BW_OK;
}

/* The particles of one wall. Its parts, joined over ranks, are in the order of the whole: so are
 * the numbers. */
static bw_status build_one(bw_ulph *u, const walls *all)
{
  const int number = all->number;
  const bw_ulph_wall *w = all->of + number;
  const bw_shape_lattice lattice = lattice_of(u, w);
  const size_t before = u->n;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  BW_TRY(bw_shape_fill_shared(u->comm, w->count, w->shape, &lattice, &n, &site, &kind, NULL));
  bw_status st = BW_ENLARGE(&u->own, u->n, u->n + (size_t)n);
  BW_THEN(st, keep_near(u, all, n, site));
  bw_release(&site);
  bw_release(&kind);
  BW_TRY(bw_comm_agree(u->comm, st));
  const int64_t first = bw_comm_prefix_sum(u->comm, (int64_t)(u->n - before));
  for (size_t i = before; i < u->n; i++)
    u->own[i].id = ((int64_t)number << 40) + first + (int64_t)(i - before);
  return BW_OK;
}

bw_status bw_ulph__build_walls(bw_ulph *u, int n_walls, const bw_ulph_wall wall[])
{
  for (int w = 0; w < n_walls; w++)
    BW_TRY(build_one(u, &(walls){n_walls, w, wall}));
  return BW_OK;
}

void bw_ulph__move_walls(bw_ulph *u, double t)
{
  if (u->config.motion != NULL)
    u->config.motion(t, u->config.motion_context, u->wall_x, u->wall_v, u->wall_a);
  for (size_t i = u->wall.first; i < u->wall.first + u->wall.own && u->config.motion != NULL; i++) {
    bw_ulph__particle *p = u->own + i;
    bw_ulph__where(u, p, p->x);
  }
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++)
    memcpy(u->own[i].x, u->body.x + 3 * bw_ulph__body_particle(u->own + i), sizeof u->own[i].x);
}
