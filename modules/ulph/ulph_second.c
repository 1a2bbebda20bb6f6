/* The second sweep over pairs: what forces and density diffusion are made of. */
#include "ulph_internal.h"

typedef struct {
  vec x[3], v[3], g[3], rho, m2;
} owners;

static owners load(const bw_ulph *u, const bw_ulph__cluster *c)
{
  owners o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    const bw_ulph__near *n = u->near + u->fluid.slot_own[own];
    const bw_ulph__far *f = u->far + u->fluid.slot_own[own];
    for (int k = 0; k < 3; k++)
      o.x[k][l] = n->x[k], o.v[k][l] = n->v[k], o.g[k][l] = f->g[k];
    o.rho[l] = n->rho, o.m2[l] = f->m2;
  }
  return o;
}

/* x, r^2 and (v_J - v_I).x of a pair. */
BW_ULPH_PIECE vec distance(const owners *o, const bw_ulph__near *n, vec x[3], vec *vx, int d)
{
  vec r2 = {0};
  *vx = (vec){0};
  for (int k = 0; k < d; k++) {
    x[k] = n->x[k] - o->x[k];
    r2 += x[k] * x[k];
    *vx += (n->v[k] - o->v[k]) * x[k];
  }
  return r2;
}

/* P x of a neighbour. */
BW_ULPH_PIECE vec times(const double P[6], const vec x[3], int a, int d)
{
  vec Px = {0};
  for (int b = 0; b < d; b++)
    Px += P[a < b ? bw_ulph__sym(a, b) : bw_ulph__sym(b, a)] * x[b];
  return Px;
}

/* w V p x only where some lane is under tension. */
BW_ULPH_PIECE void add_fluid(bw_ulph__pairs *t, const owners *o, const bw_ulph__near *n,
                             const bw_ulph__far *f, const double R2[2], bool tense, int d)
{
  vec x[3], vx, gx = {0};
  const vec r2 = distance(o, n, x, &vx, d);
  const vec wV = vec_weight(r2, R2[0]) * n->V;
  /* 1/(m2 r^2) by one division; the particle itself has x = 0. */
  const vec m2 = o->m2 + f->m2, r2_safe = r2 + R2[1], over = wV * vec_inverse(m2 * r2_safe);
  const vec viscous = over * vx, wVp = wV * f->p;
  for (int a = 0; a < d; a++) {
    t->A[a] += wV * times(f->P, x, a, d);
    if (tense) t->B[a] += wVp * x[a];
    t->F[a] += viscous * x[a];
    gx += (o->g[a] + f->g[a]) * x[a];
  }
  t->D += (1 - f->surface) * over * r2_safe * (2 * (n->rho - o->rho) - gx);
  t->surface += wV * f->surface;
}

/* Of a face (front, else NULL) the lanes in front of it; walls that move are summed apart, too. */
BW_ULPH_PIECE void add_standing(bw_ulph__pairs *t, int who, const owners *o, const bw_ulph__near *n,
                                const bw_ulph__far *f, const bw_ulph__front *front,
                                const double R2[2], bool moving, int d)
{
  vec x[3], vx, before = {0};
  const vec r2 = distance(o, n, x, &vx, d);
  vec wV = vec_weight(r2, R2[0]) * n->V;
  for (int k = 0; k < d && front != NULL; k++)
    before -= front->normal[k] * x[k];
  if (front != NULL) wV = vec_where(before > front->least, wV);
  const vec wVp = wV * f->p;
  const vec viscous = wV * vx * vec_inverse(2 * o->m2 * (r2 + R2[1]));
  const double moves = f->g[0];
  for (int a = 0; a < d; a++) {
    const vec s = wV * x[a], A = wV * times(f->P, x, a, d), F = viscous * x[a];
    t->by[who].s[a] += s;
    t->by[who].A[a] += A;
    t->by[who].B[a] += wVp * x[a];
    t->by[who].F[a] += F;
    if (!moving) continue;
    t->by[BW_ULPH__MOVING].s[a] += moves * s;
    t->by[BW_ULPH__MOVING].A[a] += moves * A;
    t->by[BW_ULPH__MOVING].F[a] += moves * F;
  }
}

/* What a sweep over pairs has to find. */
typedef struct {
  int d;
  bool tense, moving;
} wanted;

BW_ULPH_PIECE void sum(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,
                       bw_ulph__pairs *pairs, wanted q)
{
  const double R2[2] = {1 / (u->R * u->R), 1e-6 * u->R * u->R};
  bw_ulph__pairs t;
  memset(&t, 0, sizeof t);
  for (size_t e = c->begin; e < c->walls; e++)
    add_fluid(&t, o, u->near + u->list[e], u->far + u->list[e], R2, q.tense, q.d);
  *pairs = t;
  if (c->walls == c->end) return;
  for (size_t e = c->walls; e < c->faces; e++)
    add_standing(&t, BW_ULPH__WALLS, o, u->near + u->list[e], u->far + u->list[e], NULL, R2,
                 q.moving, q.d);
  for (size_t e = c->faces; e < c->end; e++)
    add_standing(&t, BW_ULPH__BODIES, o, u->near + u->list[e], u->far + u->list[e],
                 u->front + u->list[e], R2, false, q.d);
  memcpy(pairs->by, t.by, sizeof t.by);
}

/* One loop each, of which what is wanted is a constant. */
#define SUM(name, d, tense, moving)                                                                \
  static void name(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,                   \
                   bw_ulph__pairs *pairs)                                                          \
  {                                                                                                \
    sum(u, c, o, pairs, (wanted){d, tense, moving});                                               \
  }
SUM(plane, 2, false, false)
SUM(plane_moving, 2, false, true)
SUM(plane_tense, 2, true, false)
SUM(plane_tense_moving, 2, true, true)
SUM(space, 3, false, false)
SUM(space_moving, 3, false, true)
SUM(space_tense, 3, true, false)
SUM(space_tense_moving, 3, true, true)

typedef void sweep(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,
                   bw_ulph__pairs *pairs);
static sweep *const sweeps[2][2][2] = {{{plane, plane_moving}, {plane_tense, plane_tense_moving}},
                                       {{space, space_moving}, {space_tense, space_tense_moving}}};

/* Is a lane of a cluster under tension, so that the cure may be needed? */
static bool under_tension(const bw_ulph *u, const bw_ulph__between *b)
{
  return u->config.tension_cure && vec_sum(vec_where(b->p < 0, (vec){0} + 1)) > 0;
}

static void read_page(const bw_ulph__page *page, bw_ulph__book *to)
{
  const vec *from = (const vec *)page;
  double *numbers = (double *)to;
  for (size_t k = 0; k < sizeof *to / sizeof *numbers; k++)
    numbers[k] += vec_sum(from[k]);
}

void bw_ulph__second(bw_ulph *u, double dt)
{
  const bool moving = u->config.motion != NULL;
  bw_ulph__page rate, jump;
  memset(&rate, 0, sizeof rate);
  memset(&jump, 0, sizeof jump);
  for (size_t c = 0; c < u->clusters.n; c++) {
    const bw_ulph__cluster *cluster = u->clusters.of + c;
    const owners o = load(u, cluster);
    bw_ulph__pairs pairs;
    const bool tense = under_tension(u, u->between + c);
    sweeps[u->config.dimensions - 2][tense][moving](u, cluster, &o, &pairs);
    bw_ulph__forces(u, c, &pairs, dt, &rate, &jump);
  }
  memset(&u->rate, 0, sizeof u->rate);
  read_page(&rate, &u->rate);
  read_page(&jump, &u->jump);
  for (int k = 0; k < 3; k++)
    u->wall_force[k] = -u->rate.push[PUSH_WALLS][k];
}
