/* What walls and bodies show to the fluid: velocity, pressure, moment. */
#include "ulph_internal.h"

/* The mean fluid particle counts as at least so far from the wall (of dx), and the velocity is
 * extrapolated at most so many times that distance. */
static const double NEAREST = 0.25, STEEPEST = 3;
/* Fluid whose mean place is so far aside (of dx) is in front of the wall, or not. */
static const double WET = 0.75, DRY = 1.05;

/* One kind of those that show something, and its part of the shades. */
typedef struct {
  bw_ulph__kind *kind;
  const bw_ulph__clusters *clusters;
  bw_ulph__shade *shade;
} showing;

static showing walls_of(bw_ulph *u)
{
  return (showing){&u->wall, &u->shading, u->shade};
}

static showing faces_of(bw_ulph *u)
{
  return (showing){&u->face, &u->facing, u->shade + u->wall.own};
}

/* The lanes of a cluster. */
typedef struct {
  vec x[3], normal[3], least;
} lanes;

static lanes load(const bw_ulph *u, const bw_ulph__kind *kind, const bw_ulph__cluster *c)
{
  lanes o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    const bw_ulph__particle *p = u->own + kind->first + own;
    for (int k = 0; k < 3; k++)
      o.x[k][l] = p->x[k], o.normal[k][l] = p->normal[k];
    o.least[l] = u->front[kind->slot_own[own]].least;
  }
  return o;
}

/* Distance of a neighbour from the lanes; its square. */
BW_ULPH_PIECE vec distance(const lanes *o, const bw_ulph__near *n, vec x[3])
{
  vec r2 = {0};
  for (int k = 0; k < 3; k++) {
    x[k] = n->x[k] - o->x[k];
    r2 += x[k] * x[k];
  }
  return r2;
}

/* Sums over the fluid near one lane of walls. */
typedef struct {
  vec w, p, x[3], v[3], hydrostatic[3]; /* w; w p; w (x_J - x); w v; w rho (x - x_J) */
} sums;

BW_ULPH_PIECE sums sum_velocity(const bw_ulph *u, const bw_ulph__cluster *c, const lanes *o,
                                bool faces)
{
  const double inverse_R2 = 1 / (u->R * u->R), c2 = u->config.c0 * u->config.c0;
  sums t;
  memset(&t, 0, sizeof t);
  for (size_t e = c->begin; e < c->walls; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    vec x[3];
    const vec r2 = distance(o, n, x);
    vec w = vec_weight(r2, inverse_R2);
    /* The other face of a thin body sees the fluid behind. */
    if (faces) w = vec_where(vec_dot(o->normal, x) > o->least, w);
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

/* Sums for the pressure: w p over fluid; w V x x of what lies before the plane through the wall
 * particle along the wall. */
typedef struct {
  vec p, M[6];
} moments;

BW_ULPH_PIECE void add_moment(moments *t, const vec x[3], const vec normal[3], vec wV, double over)
{
  const vec nx = vec_dot(normal, x);
  const vec before = vec_above_0(1 - vec_above_0(0.5 - nx * over)) * wV;
  for (int a = 0; a < 3; a++) {
    const vec wx = before * x[a];
    for (int b = a; b < 3; b++)
      t->M[bw_ulph__sym(a, b)] += wx * x[b];
  }
}

BW_ULPH_PIECE moments sum_pressure(const bw_ulph *u, const bw_ulph__cluster *c, const lanes *o,
                                   bool faces)
{
  const double inverse_R2 = 1 / (u->R * u->R), over = 1 / u->config.dx;
  moments t;
  memset(&t, 0, sizeof t);
  for (size_t e = c->begin; e < c->walls; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    vec x[3];
    const vec w = vec_weight(distance(o, n, x), inverse_R2);
    vec wp = w * u->far[u->list[e]].p;
    if (faces) wp = vec_where(vec_dot(o->normal, x) > o->least, wp);
    t.p += wp;
    add_moment(&t, x, o->normal, w * n->V, over);
  }
  for (size_t e = c->walls; e < c->end; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    vec x[3], aligned = {0};
    vec w = vec_weight(distance(o, n, x), inverse_R2);
    if (faces && e >= c->faces) {
      /* Of the two faces of a particle not that which looks the other way. */
      for (int k = 0; k < 3; k++)
        aligned += u->front[u->list[e]].normal[k] * o->normal[k];
      w = vec_where(aligned > -0.5, w);
    }
    add_moment(&t, x, o->normal, w * n->V, over);
  }
  return t;
}

/* The moment of a wall particle is that of a fluid particle in its place: what lies deeper in the
 * wall, of which there are too few layers, is the image of what lies before it. M + H M H with the
 * reflection H = 1 - 2 n n^T. */
static void add_image(const vec n[3], vec M[6])
{
  vec q[3];
  vec_times(M, n, q);
  const vec across = vec_dot(n, q);
  for (int a = 0; a < 3; a++)
    for (int b = a; b < 3; b++) {
      vec *m = M + bw_ulph__sym(a, b);
      *m = 2 * (*m - n[a] * q[b] - q[a] * n[b]) + 4 * n[a] * n[b] * across;
    }
}

/* Linear from the fluid's mean through the wall's velocity `still` on the surface. */
static void mirror(const bw_ulph *u, bw_ulph__particle *p, const double still[3], double flat,
                   double weight, const double x[3], const double v[3])
{
  double slip[3], normal = 0;
  memcpy(p->v, still, sizeof p->v);
  if (weight <= 0) return;
  const double far = bw_ulph__dot(x, p->normal) / weight - p->depth;
  const double times = fmin(STEEPEST, p->depth / fmax(far, NEAREST * u->config.dx));
  const double along = u->no_slip[p->wall] ? -times : 1;
  for (int k = 0; k < 3; k++) {
    slip[k] = v[k] / weight - still[k];
    normal += slip[k] * p->normal[k];
  }
  /* On an edge the normal is that of neither side: the image there goes with the fluid. */
  const double across = 1 - 2 * flat;
  for (int k = 0; k < 3; k++)
    p->v[k] = still[k] + along * (slip[k] - normal * p->normal[k]) + across * normal * p->normal[k];
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

static void show_velocity(bw_ulph *u, const showing *s, size_t own, const sums *t, int l)
{
  bw_ulph__particle *p = u->own + s->kind->first + own;
  bw_ulph__shade *q = s->shade + own;
  bw_ulph__near *n = u->near + s->kind->slot_own[own];
  const double c2 = u->config.c0 * u->config.c0, still[3] = {0};
  const double *moving = u->moves[p->wall] ? u->wall_v : still;
  if (p->wall == u->n_walls) moving = u->body.v + 3 * bw_ulph__body_particle(p);
  double x[3], v[3];
  q->weight = t->w[l];
  q->hydrostatic = 0;
  for (int k = 0; k < 3; k++) {
    /* The acceleration of bodies is left out: an answer to the last one feeds itself. */
    const double a = u->moves[p->wall] ? u->wall_a[k] : 0;
    x[k] = t->x[k][l], v[k] = t->v[k][l];
    q->hydrostatic += (u->config.gravity[k] - a) * t->hydrostatic[k][l];
  }
  mirror(u, p, moving, p->wall == u->n_walls ? q->flat : 1, q->weight, x, v);
  p->p = pressure(q->weight, t->p[l], q->hydrostatic);
  p->rho = u->config.rho0 + p->p / c2;
  memcpy(n->x, p->x, sizeof n->x);
  memcpy(n->v, p->v, sizeof n->v);
  n->rho = p->rho;
  n->V = wet(u, p, q->weight, x) * p->m / p->rho;
}

void bw_ulph__dry(bw_ulph *u)
{
  for (size_t i = u->wall.first; i < u->face.first + u->face.own; i++)
    u->own[i].p = 0;
  for (size_t s = u->wall.base; s < u->slots; s++)
    u->near[s].V = 0;
}

void bw_ulph__shade_velocity(bw_ulph *u)
{
  const showing both[] = {walls_of(u), faces_of(u)};
  for (int b = 0; b < 2; b++) {
    const showing *s = both + b;
    for (size_t c = 0; c < s->clusters->n; c++) {
      const bw_ulph__cluster *q = s->clusters->of + c;
      if (q->begin == q->walls) continue;
      const lanes o = load(u, s->kind, q);
      const sums t = b == 0 ? sum_velocity(u, q, &o, false) : sum_velocity(u, q, &o, true);
      for (int l = 0; l < q->lanes; l++)
        show_velocity(u, s, q->first + (size_t)l, &t, l);
    }
    bw_ulph__send(s->kind, sizeof *u->near, u->near);
  }
}

/* Pressure over moment, as of a fluid particle there: pairs across the wall are then those of a
 * mirror image, which leave a free-slip wall no force along it. */
static void show_pressure(bw_ulph *u, const showing *s, const bw_ulph__cluster *c, const lanes *o,
                          moments *t)
{
  vec Minv[6];
  add_image(o->normal, t->M);
  bw_ulph__moment(u, t->M, Minv);
  for (int l = 0; l < c->lanes; l++) {
    const size_t own = c->first + (size_t)l;
    bw_ulph__particle *p = u->own + s->kind->first + own;
    bw_ulph__far *f = u->far + s->kind->slot_own[own];
    p->p = f->p = pressure(s->shade[own].weight, t->p[l], s->shade[own].hydrostatic);
    for (int k = 0; k < 6; k++)
      f->P[k] = p->p * Minv[k][l];
    f->g[0] = u->moves[p->wall] ? 1 : 0;
  }
}

void bw_ulph__shade_pressure(bw_ulph *u)
{
  const showing both[] = {walls_of(u), faces_of(u)};
  for (int b = 0; b < 2; b++) {
    const showing *s = both + b;
    for (size_t c = 0; c < s->clusters->n; c++) {
      const bw_ulph__cluster *q = s->clusters->of + c;
      if (q->begin == q->walls) continue;
      const lanes o = load(u, s->kind, q);
      moments t = b == 0 ? sum_pressure(u, q, &o, false) : sum_pressure(u, q, &o, true);
      show_pressure(u, s, q, &o, &t);
    }
    bw_ulph__send(s->kind, sizeof *u->far, u->far);
  }
}
