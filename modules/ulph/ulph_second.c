/* The second sweep: forces, density diffusion, shifting, and the book. */
#include "ulph_internal.h"

/* Of the shifting: the longest shift per step over dx. */
static const double LONGEST = 0.05;

/* Sums of the lanes of a cluster over fluid, and over what stands in it. */
typedef struct {
  vec A[3], B[3], F[3], D, surface; /* w V P x; w V p x; viscous; diffusion; any surface */
} fluid_sums;
typedef struct {
  vec s[3], A[3], B[3]; /* w V x; w V P x; w V p x */
  vec F[3], Q[3];       /* viscous: physical, artificial */
} wall_sums;

/* What stands in the fluid: all walls, those of them that move, bodies. */
enum { WALLS, MOVING, BODIES, STANDING };

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

BW_ULPH_PIECE void add_fluid(fluid_sums *t, const owners *o, const bw_ulph__near *n,
                             const bw_ulph__far *f, const double R2[2], int d)
{
  vec x[3], vx, gx = {0};
  const vec r2 = distance(o, n, x, &vx, d);
  const vec wV = vec_weight(r2, R2[0]) * n->V;
  /* 1/(m2 r^2) by one division; the particle itself has x = 0. */
  const vec m2 = o->m2 + f->m2, r2_safe = r2 + R2[1], over = wV / (m2 * r2_safe);
  const vec viscous = over * vx, wVp = wV * f->p;
  for (int a = 0; a < d; a++) {
    t->A[a] += wV * times(f->P, x, a, d);
    t->B[a] += wVp * x[a];
    t->F[a] += viscous * x[a];
    gx += (o->g[a] + f->g[a]) * x[a];
  }
  t->D += (1 - f->surface) * over * r2_safe * (2 * (n->rho - o->rho) - gx);
  t->surface += wV * f->surface;
}

/* Of a face (front, else NULL) the lanes in front of it; of a wall those that move (else NULL). */
BW_ULPH_PIECE void add_wall(wall_sums *t, wall_sums *moving, const owners *o,
                            const bw_ulph__near *n, const bw_ulph__far *f,
                            const bw_ulph__front *front, const double R2[2], int d)
{
  vec x[3], vx, before = {0};
  const vec r2 = distance(o, n, x, &vx, d);
  vec wV = vec_weight(r2, R2[0]) * n->V;
  for (int k = 0; k < d && front != NULL; k++)
    before -= front->normal[k] * x[k];
  if (front != NULL) wV = vec_where(before > front->least, wV);
  const vec wVp = wV * f->p;
  const vec over = wV * vx / (2 * o->m2 * (r2 + R2[1]));
  const double moves = f->g[1];
  for (int a = 0; a < d; a++) {
    const vec A = wV * times(f->P, x, a, d);
    t->s[a] += wV * x[a];
    t->A[a] += A;
    t->B[a] += wVp * x[a];
    t->F[a] += f->g[0] * over * x[a];
    t->Q[a] += f->g[2] * over * x[a];
    if (moving == NULL) continue;
    moving->s[a] += moves * wV * x[a];
    moving->A[a] += moves * A;
    moving->F[a] += moves * f->g[0] * over * x[a];
    moving->Q[a] += moves * f->g[2] * over * x[a];
  }
}

BW_ULPH_PIECE void pairs(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,
                         fluid_sums *fluid, wall_sums wall[STANDING], int d)
{
  const double R2[2] = {1 / (u->R * u->R), 1e-6 * u->R * u->R};
  fluid_sums t = {0};
  for (size_t e = c->begin; e < c->walls; e++)
    add_fluid(&t, o, u->near + u->list[e], u->far + u->list[e], R2, d);
  *fluid = t;
  for (size_t e = c->walls; e < c->faces; e++)
    add_wall(&wall[WALLS], &wall[MOVING], o, u->near + u->list[e], u->far + u->list[e], NULL, R2,
             d);
  for (size_t e = c->faces; e < c->end; e++)
    add_wall(&wall[BODIES], NULL, o, u->near + u->list[e], u->far + u->list[e],
             u->front + u->list[e], R2, d);
}

static void pairs_2d(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,
                     fluid_sums *fluid, wall_sums wall[STANDING])
{
  pairs(u, c, o, fluid, wall, 2);
}

static void pairs_3d(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o,
                     fluid_sums *fluid, wall_sums wall[STANDING])
{
  pairs(u, c, o, fluid, wall, 3);
}

/* The sums of one lane, as numbers. */
typedef struct {
  double A[3], B[3], F[3], D, surface;
  struct {
    double s[3], A[3], B[3], F[3], Q[3];
  } by[STANDING];
} lane;

static lane lane_of(const fluid_sums *t, const wall_sums w[STANDING], int l)
{
  lane q = {.D = t->D[l], .surface = t->surface[l]};
  for (int k = 0; k < 3; k++) {
    q.A[k] = t->A[k][l], q.B[k] = t->B[k][l], q.F[k] = t->F[k][l];
    for (int m = 0; m < STANDING; m++) {
      q.by[m].s[k] = w[m].s[k][l], q.by[m].A[k] = w[m].A[k][l], q.by[m].B[k] = w[m].B[k][l];
      q.by[m].F[k] = w[m].F[k][l], q.by[m].Q[k] = w[m].Q[k][l];
    }
  }
  return q;
}

/* Forces on one particle. */
typedef struct {
  double fluid[3], by[STANDING][3];  /* pressure */
  double physical[3], artificial[3]; /* viscosity, of all */
  double drag[STANDING][3];          /* the part of it of what stands in the fluid */
  double cure[3];                    /* difference form less pair form */
} forces;

/* -V (p M^-1 s + A) */
static void pair_force(const bw_ulph__between *b, double p, const double s[3], const double A[3],
                       double F[3])
{
  bw_ulph__times(b->Minv, s, F);
  for (int k = 0; k < 3; k++)
    F[k] = -b->V * (p * F[k] + A[k]);
}

static forces forces_of(const bw_ulph *u, const bw_ulph__particle *p, const bw_ulph__between *b,
                        const lane *q)
{
  const int d = u->config.dimensions;
  /* Twice, as the sums hold 1/(2 m2). */
  const double twice = 2 * b->V * 2 * (d + 2);
  forces f = {0};
  double rest[3];
  for (int k = 0; k < 3; k++)
    rest[k] = b->s[k] - q->by[WALLS].s[k] - q->by[BODIES].s[k];
  pair_force(b, p->p, rest, q->A, f.fluid);
  for (int m = 0; m < STANDING; m++)
    pair_force(b, p->p, q->by[m].s, q->by[m].A, f.by[m]);
  for (int k = 0; k < 3; k++) {
    f.physical[k] = twice * (u->config.mu * q->F[k] + q->by[WALLS].F[k] + q->by[BODIES].F[k]);
    f.artificial[k] =
        twice * ((u->mu_t - u->config.mu) * q->F[k] + q->by[WALLS].Q[k] + q->by[BODIES].Q[k]);
    for (int m = 0; m < STANDING; m++)
      f.drag[m][k] = twice * (q->by[m].F[k] + q->by[m].Q[k]);
  }
  /* Under tension away from a surface: the gradient itself, which does not pull neighbours
   * together. */
  if (u->config.tension_cure && p->p < 0 && q->surface == 0 && !p->lone) {
    double sum[3], gradient[3];
    for (int k = 0; k < 3; k++)
      sum[k] = q->B[k] + q->by[WALLS].B[k] + q->by[BODIES].B[k] - p->p * b->s[k];
    bw_ulph__times(b->Minv, sum, gradient);
    for (int k = 0; k < 3; k++)
      f.cure[k] = -b->V * gradient[k] - f.fluid[k] - f.by[WALLS][k] - f.by[BODIES][k];
  }
  return f;
}

/* Against clustering: down the gradient of the concentration, as fast as the flow distorts. */
static void shift_of(const bw_ulph *u, const lane *q, const bw_ulph__between *b, double dt,
                     bw_ulph__particle *p)
{
  double rate = 0, length = 0;
  memset(p->shift, 0, sizeof p->shift);
  if (u->config.shifting == 0 || q->surface > 0 || p->lone) return;
  for (int k = 0; k < 9; k++)
    rate += b->L[k] * b->L[k];
  for (int k = 0; k < 3; k++) {
    p->shift[k] = -u->config.shifting * sqrt(rate) * u->h * u->h * dt * b->s[k] / u->m2;
    length += p->shift[k] * p->shift[k];
  }
  length = sqrt(length);
  const double most = LONGEST * u->config.dx;
  for (int k = 0; k < 3 && length > most; k++)
    p->shift[k] *= most / length;
}

static void push(bw_ulph *u, int who, const bw_ulph__particle *p, const double F[3])
{
  double *to = u->rate.push[who], *turn = u->rate.turn[who];
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    to[k] += F[k];
    turn[k] += p->x[a] * F[b] - p->x[b] * F[a];
  }
}

/* Energy and momentum that the forces give per time. They make the last kick of this step and the
 * first of the next: the particle has the velocity between the two. */
static void book(bw_ulph *u, const bw_ulph__particle *p, const bw_ulph__between *b, const forces *f)
{
  double *line = u->rate.line, walls[3], bodies[3], weight[3];
  for (int k = 0; k < 3; k++) {
    walls[k] = f->by[WALLS][k] + f->drag[WALLS][k];
    bodies[k] = f->by[BODIES][k] + f->drag[BODIES][k];
    weight[k] = p->m * u->config.gravity[k];
  }
  /* The work of bodies is booked over the step (ulph_face.c). */
  const double moved = bw_ulph__dot(f->drag[MOVING], u->wall_v);
  const double work = bw_ulph__dot(f->by[MOVING], u->wall_v);
  line[LINE_WALLS] += work + moved;
  line[LINE_VISCOUS] += bw_ulph__dot(f->physical, p->v);
  line[LINE_ARTIFICIAL] += bw_ulph__dot(f->artificial, p->v) - moved;
  line[LINE_TENSION] += bw_ulph__dot(f->cure, p->v);
  /* A mirror image would take as much from the fluid as its compression returns. */
  line[LINE_GHOSTS] += bw_ulph__dot(f->by[WALLS], p->v) + bw_ulph__dot(f->by[BODIES], p->v) -
                       b->V * b->p_mean * b->div_wall - work;
  push(u, PUSH_GRAVITY, p, weight);
  push(u, PUSH_WALLS, p, walls);
  push(u, PUSH_BODIES, p, bodies);
  for (int k = 0; k < 3; k++)
    u->rate.turn[PUSH_WALLS][k] += b->couple[k];
  push(u, PUSH_TENSION, p, f->cure);
}

/* The second half of the kick. */
static void kick(bw_ulph *u, bw_ulph__particle *p, const forces *f, double dt)
{
  for (int k = 0; k < 3; k++) {
    p->a[k] = (f->fluid[k] + f->by[WALLS][k] + f->by[BODIES][k] + f->physical[k] +
               f->artificial[k] + f->cure[k]) /
              p->m;
    p->v[k] += 0.5 * dt * (p->a[k] + u->config.gravity[k]);
    u->wall_force[k] -= f->by[WALLS][k] + f->drag[WALLS][k];
  }
}

void bw_ulph__second(bw_ulph *u, double dt)
{
  const int d = u->config.dimensions;
  memset(u->wall_force, 0, sizeof u->wall_force);
  memset(&u->rate, 0, sizeof u->rate);
  for (size_t c = 0; c < u->clusters.n; c++) {
    const bw_ulph__cluster *cluster = u->clusters.of + c;
    const owners o = load(u, cluster);
    fluid_sums fluid;
    wall_sums wall[STANDING];
    memset(wall, 0, sizeof wall);
    if (d == 2)
      pairs_2d(u, cluster, &o, &fluid, wall);
    else
      pairs_3d(u, cluster, &o, &fluid, wall);
    for (int l = 0; l < cluster->lanes; l++) {
      const size_t own = cluster->first + (size_t)l;
      bw_ulph__particle *p = u->own + own;
      bw_ulph__between *b = u->between + own;
      const lane q = lane_of(&fluid, wall, l);
      const forces f = forces_of(u, p, b, &q);
      kick(u, p, &f, dt);
      book(u, p, b, &f);
      /* Twice, as the sums hold 1/(2 m2). */
      b->D = (1 - p->surface) * 2 * u->config.delta * u->h * u->config.c0 * q.D;
      shift_of(u, &q, b, dt, p);
    }
  }
}
