/* Walls: particles inside solid shapes, and what they show to the fluid. */
#include "bw_memory.h"
#include "bw_shape_surface.h"
#include "ulph_internal.h"

/* Layers of wall particles: as deep as the weight reaches. */
enum { LAYERS = 3 };
/* The mean fluid particle counts as at least so far from the wall (of dx), and the velocity is
 * extrapolated at most so many times that distance. */
static const double NEAREST = 0.25, STEEPEST = 3;
/* Fluid whose mean place is so far aside (of dx) is in front of the wall, or not. */
static const double WET = 0.75, DRY = 1.05;

/* ---- building ---- */
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

/* Sites within reach of the surface, but not in a wall that was built before. */
static bw_status keep_near(bw_ulph *u, int number, const bw_ulph_wall wall[], int64_t n,
                           const int32_t site[])
{
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
    u->own[u->n++] = p;
  }
  return BW_OK;
}

static bw_status grow_own(bw_ulph *u, size_t more)
{
  bw_ulph__particle *larger = NULL;
  BW_TRY(BW_ALLOCATE(&larger, u->n + more));
  if (u->n > 0) memcpy(larger, u->own, u->n * sizeof *larger);
  bw_release(&u->own);
  u->own = larger;
  return BW_OK;
}

/* The particles of one wall. Its parts, joined over ranks, are in the order of the whole: so are
 * the numbers. */
static bw_status build_one(bw_ulph *u, int number, const bw_ulph_wall wall[])
{
  const bw_ulph_wall *w = wall + number;
  const bw_shape_lattice lattice = lattice_of(u, w);
  const size_t before = u->n;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  BW_TRY(bw_shape_fill_shared(u->comm, w->count, w->shape, &lattice, &n, &site, &kind, NULL));
  bw_status st = grow_own(u, (size_t)n);
  BW_THEN(st, keep_near(u, number, wall, n, site));
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
    BW_TRY(build_one(u, w, wall));
  return BW_OK;
}

void bw_ulph__move_walls(bw_ulph *u, double t)
{
  if (u->config.motion != NULL)
    u->config.motion(t, u->config.motion_context, u->wall_x, u->wall_v, u->wall_a);
  for (size_t i = u->wall.first; i < u->wall.first + u->wall.own; i++) {
    bw_ulph__particle *p = u->own + i;
    bw_ulph__where(u, p, p->x);
  }
}

/* ---- what they show ---- */
/* Sums over the fluid near one lane of walls. */
typedef struct {
  vec w, p, x[3], v[3], hydrostatic[3]; /* w; w p; w (x_J - x); w v; w rho (x - x_J) */
} sums;

static void load(const bw_ulph *u, const bw_ulph__cluster *c, vec x[3])
{
  double place[3][BW_ULPH_LANES];
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    for (int k = 0; k < 3; k++)
      place[k][l] = u->own[u->wall.first + own].x[k];
  }
  memcpy(x, place, sizeof place);
}

static void load_normal(const bw_ulph *u, const bw_ulph__cluster *c, vec normal[3])
{
  double n[3][BW_ULPH_LANES];
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    for (int k = 0; k < 3; k++)
      n[k][l] = u->own[u->wall.first + own].normal[k];
  }
  memcpy(normal, n, sizeof n);
}

static sums sum_velocity(const bw_ulph *u, const bw_ulph__cluster *c)
{
  const double inverse_R2 = 1 / (u->R * u->R), c2 = u->config.c0 * u->config.c0;
  vec at[3];
  sums t;
  memset(&t, 0, sizeof t);
  load(u, c, at);
  for (size_t e = c->begin; e < c->walls; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    vec x[3], r2 = {0};
    for (int k = 0; k < 3; k++) {
      x[k] = n->x[k] - at[k];
      r2 += x[k] * x[k];
    }
    const vec w = vec_weight(r2, inverse_R2);
    t.w += w;
    t.p += w * (c2 * (n->rho - u->config.rho0));
    for (int k = 0; k < 3; k++) {
      t.x[k] += w * x[k];
      t.v[k] += w * n->v[k];
      t.hydrostatic[k] -= w * x[k] * n->rho;
    }
  }
  return t;
}

/* Sums for the pressure: w p over fluid; moments. */
typedef struct {
  vec p, M[6];
} moments;

/* x of a neighbour and its image in the plane through the wall particle along the wall; M of both,
 * as far as the neighbour is before that plane. */
static void add_moment(moments *t, const vec x[3], const vec normal[3], vec wV, double dx)
{
  vec image[3], nx = {0};
  for (int k = 0; k < 3; k++)
    nx += normal[k] * x[k];
  for (int k = 0; k < 3; k++)
    image[k] = x[k] - 2 * nx * normal[k];
  const vec before = vec_above_0(1 - vec_above_0(0.5 - nx / dx)) * wV;
  for (int a = 0; a < 3; a++)
    for (int b = a; b < 3; b++)
      t->M[bw_ulph__sym(a, b)] += before * (x[a] * x[b] + image[a] * image[b]);
}

/* The moment of a wall particle is that of a fluid particle in its place: what lies deeper in the
 * wall, of which there are too few layers, is the image of what lies before it. */
static moments sum_pressure(const bw_ulph *u, const bw_ulph__cluster *c)
{
  const double inverse_R2 = 1 / (u->R * u->R);
  vec at[3], normal[3];
  moments t;
  memset(&t, 0, sizeof t);
  load(u, c, at);
  load_normal(u, c, normal);
  for (size_t e = c->begin; e < c->end; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    vec x[3], r2 = {0};
    for (int k = 0; k < 3; k++) {
      x[k] = n->x[k] - at[k];
      r2 += x[k] * x[k];
    }
    const vec w = vec_weight(r2, inverse_R2);
    if (e < c->walls) t.p += w * u->far[u->list[e]].p;
    add_moment(&t, x, normal, w * n->V, u->config.dx);
  }
  return t;
}

/* Linear from the fluid's mean through the wall's velocity on the surface. */
static void mirror(const bw_ulph *u, bw_ulph__particle *p, double weight, const double x[3],
                   const double v[3])
{
  double still[3] = {0}, slip[3], normal = 0;
  if (u->moves[p->wall]) memcpy(still, u->wall_v, sizeof still);
  memcpy(p->v, still, sizeof still);
  if (weight <= 0) return;
  const double far = bw_ulph__dot(x, p->normal) / weight - p->depth;
  const double times = fmin(STEEPEST, p->depth / fmax(far, NEAREST * u->config.dx));
  const double along = u->no_slip[p->wall] ? -times : 1;
  for (int k = 0; k < 3; k++) {
    slip[k] = v[k] / weight - still[k];
    normal += slip[k] * p->normal[k];
  }
  for (int k = 0; k < 3; k++)
    p->v[k] = still[k] + along * (slip[k] - normal * p->normal[k]) - normal * p->normal[k];
}

/* Equation 52: the fluid's pressure and the weight of what is between, at least 0. */
static double pressure(double weight, double wp, double hydrostatic)
{
  return weight > 0 ? fmax(0, (wp + hydrostatic) / weight) : 0;
}

/* A wall particle counts as far as there is fluid in front of it and not to one side only: a wall
 * above the surface is dry, and nothing pushes from there. */
static double wet(const bw_ulph *u, const bw_ulph__particle *p, double weight, const double x[3])
{
  if (weight <= 0) return 0;
  const double normal = bw_ulph__dot(x, p->normal) / weight;
  double aside = 0;
  for (int k = 0; k < 3; k++) {
    const double t = x[k] / weight - normal * p->normal[k];
    aside += t * t;
  }
  return fmax(0, fmin(1, (DRY - sqrt(aside) / u->config.dx) / (DRY - WET)));
}

static void show_velocity(bw_ulph *u, size_t own, const sums *t, int l)
{
  bw_ulph__particle *p = u->own + u->wall.first + own;
  bw_ulph__shade *q = u->shade + own;
  bw_ulph__near *n = u->near + u->wall.slot_own[own];
  const double c2 = u->config.c0 * u->config.c0;
  double x[3], v[3];
  q->weight = t->w[l];
  q->hydrostatic = 0;
  for (int k = 0; k < 3; k++) {
    const double a = u->moves[p->wall] ? u->wall_a[k] : 0;
    x[k] = t->x[k][l], v[k] = t->v[k][l];
    q->hydrostatic += (u->config.gravity[k] - a) * t->hydrostatic[k][l];
  }
  mirror(u, p, q->weight, x, v);
  p->p = pressure(q->weight, t->p[l], q->hydrostatic);
  p->rho = u->config.rho0 + p->p / c2;
  memcpy(n->x, p->x, sizeof n->x);
  memcpy(n->v, p->v, sizeof n->v);
  n->rho = p->rho;
  n->V = wet(u, p, q->weight, x) * p->m / p->rho;
}

void bw_ulph__shade_velocity(bw_ulph *u)
{
  for (size_t c = 0; c < u->n_shades; c++) {
    const sums t = sum_velocity(u, u->shading + c);
    for (int l = 0; l < u->shading[c].lanes; l++)
      show_velocity(u, u->shading[c].first + (size_t)l, &t, l);
  }
  bw_ulph__send(&u->wall, sizeof *u->near, u->near);
}

/* Pressure over moment, as of a fluid particle there: pairs across the wall are then those of a
 * mirror image, which leave a free-slip wall no force along it. */
static void show_pressure(bw_ulph *u, size_t own, const moments *t, int l)
{
  bw_ulph__particle *p = u->own + u->wall.first + own;
  bw_ulph__far *f = u->far + u->wall.slot_own[own];
  double M[6], Minv[6];
  for (int k = 0; k < 6; k++)
    M[k] = t->M[k][l];
  bw_ulph__moment(u, M, Minv);
  p->p = f->p = pressure(u->shade[own].weight, t->p[l], u->shade[own].hydrostatic);
  for (int k = 0; k < 6; k++)
    f->P[k] = p->p * Minv[k];
  f->g[0] = u->config.mu;
  f->g[2] = u->mu_wall;
  f->g[1] = u->moves[p->wall] ? 1 : 0;
}

void bw_ulph__shade_pressure(bw_ulph *u)
{
  for (size_t c = 0; c < u->n_shades; c++) {
    const bw_ulph__cluster *q = u->shading + c;
    const moments t = sum_pressure(u, q);
    for (int l = 0; l < q->lanes; l++)
      show_pressure(u, q->first + (size_t)l, &t, l);
  }
  bw_ulph__send(&u->wall, sizeof *u->far, u->far);
}
