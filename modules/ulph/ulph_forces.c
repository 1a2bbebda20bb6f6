/* Forces on the particles of a cluster, and what they do: the last half of the kick, density
 * diffusion, shifting, and the book. */
#include "ulph_internal.h"

enum {
  WALLS = BW_ULPH__WALLS,
  MOVING = BW_ULPH__MOVING,
  BODIES = BW_ULPH__BODIES,
  STANDING = BW_ULPH__STANDING
};

/* Of the shifting: the longest shift per step over dx. */
static const double LONGEST = 0.05;

/* The particles themselves; 1 where a lane is used, else 0. */
typedef struct {
  vec x[3], v[3], m, rho, used;
} particles;

static particles load(const bw_ulph *u, const bw_ulph__cluster *c)
{
  particles o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const bw_ulph__particle *p = u->own + c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    for (int k = 0; k < 3; k++)
      o.x[k][l] = p->x[k], o.v[k][l] = p->v[k];
    o.m[l] = p->m, o.rho[l] = p->rho;
    o.used[l] = l < c->lanes;
  }
  return o;
}

/* ---- forces ---- */
typedef struct {
  vec fluid[3], by[STANDING][3];  /* pressure */
  vec physical[3], artificial[3]; /* viscosity, of all */
  vec drag[STANDING][3];          /* the part of it of what stands in the fluid */
  vec cure[3];                    /* difference form less pair form */
} forces;

/* -V (p M^-1 s + A) */
static void pair_force(const bw_ulph__between *b, const vec s[3], const vec A[3], vec F[3])
{
  vec_times(b->Minv, s, F);
  for (int k = 0; k < 3; k++)
    F[k] = -b->V * (b->p * F[k] + A[k]);
}

/* Under tension away from a surface: the gradient itself, which does not pull neighbours
 * together. */
static void cure(const bw_ulph *u, const bw_ulph__between *b, const bw_ulph__pairs *q, forces *f)
{
  vec sum[3], gradient[3];
  memset(f->cure, 0, sizeof f->cure);
  if (!u->config.tension_cure) return;
  const vec_bits cured = (b->p < 0) & (q->surface == 0) & (b->lone == 0);
  for (int k = 0; k < 3; k++)
    sum[k] = q->B[k] + q->by[WALLS].B[k] + q->by[BODIES].B[k] - b->p * b->s[k];
  vec_times(b->Minv, sum, gradient);
  for (int k = 0; k < 3; k++)
    f->cure[k] =
        vec_where(cured, -b->V * gradient[k] - f->fluid[k] - f->by[WALLS][k] - f->by[BODIES][k]);
}

static void forces_of(const bw_ulph *u, const bw_ulph__between *b, const bw_ulph__pairs *q,
                      forces *f)
{
  const double mu = u->config.mu, mu_wall = u->mu_wall;
  /* Twice, as the sums hold 1/(2 m2). */
  const vec twice = 2 * b->V * 2 * (u->config.dimensions + 2);
  vec rest[3];
  for (int k = 0; k < 3; k++)
    rest[k] = b->s[k] - q->by[WALLS].s[k] - q->by[BODIES].s[k];
  pair_force(b, rest, q->A, f->fluid);
  for (int m = 0; m < STANDING; m++)
    pair_force(b, q->by[m].s, q->by[m].A, f->by[m]);
  for (int k = 0; k < 3; k++) {
    const vec standing = q->by[WALLS].F[k] + q->by[BODIES].F[k];
    f->physical[k] = twice * mu * (q->F[k] + standing);
    f->artificial[k] = twice * ((u->mu_t - mu) * q->F[k] + mu_wall * standing);
    for (int m = 0; m < STANDING; m++)
      f->drag[m][k] = twice * (mu + mu_wall) * q->by[m].F[k];
  }
  cure(u, b, q, f);
}

/* ---- the book ---- */
static void push(bw_ulph__page *to, int who, const particles *p, const vec F[3])
{
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    to->push[who][k] += p->used * F[k];
    to->turn[who][k] += p->used * (p->x[a] * F[b] - p->x[b] * F[a]);
  }
}

/* Energy and momentum that the forces give per time. They make the last kick of this step and the
 * first of the next: the particle has the velocity between the two. */
static void book(const bw_ulph *u, const particles *p, const bw_ulph__between *b, const forces *f,
                 bw_ulph__page *to)
{
  vec walls[3], bodies[3], weight[3], moved = {0}, work = {0};
  for (int k = 0; k < 3; k++) {
    walls[k] = f->by[WALLS][k] + f->drag[WALLS][k];
    bodies[k] = f->by[BODIES][k] + f->drag[BODIES][k];
    weight[k] = p->m * u->config.gravity[k];
    /* The work of bodies is booked over the step (ulph_face.c). */
    moved += f->drag[MOVING][k] * u->wall_v[k];
    work += f->by[MOVING][k] * u->wall_v[k];
  }
  to->line[LINE_WALLS] += p->used * (work + moved);
  to->line[LINE_VISCOUS] += p->used * vec_dot(f->physical, p->v);
  to->line[LINE_ARTIFICIAL] += p->used * (vec_dot(f->artificial, p->v) - moved);
  to->line[LINE_TENSION] += p->used * vec_dot(f->cure, p->v);
  /* A mirror image would take as much from the fluid as its compression returns. */
  to->line[LINE_GHOSTS] += p->used * (vec_dot(f->by[WALLS], p->v) + vec_dot(f->by[BODIES], p->v) -
                                      b->V * b->p_mean * b->div_wall - work);
  push(to, PUSH_GRAVITY, p, weight);
  push(to, PUSH_WALLS, p, walls);
  push(to, PUSH_BODIES, p, bodies);
  for (int k = 0; k < 3; k++)
    to->turn[PUSH_WALLS][k] += p->used * b->couple[k];
  push(to, PUSH_TENSION, p, f->cure);
}

/* ---- what they do ---- */
/* Density diffusion, between particles that are not of the surface. */
static void diffuse(const bw_ulph *u, particles *p, bw_ulph__between *b, vec D, double dt,
                    bw_ulph__page *jump)
{
  const double c2 = u->config.c0 * u->config.c0;
  /* Twice, as the sums hold 1/(2 m2). */
  b->D = (1 - b->surface) * 2 * u->config.delta * u->h * u->config.c0 * D;
  const vec drho = dt * b->D;
  jump->line[LINE_DIFFUSION] +=
      p->used * p->m * (b->p + 0.5 * c2 * drho) * drho / (p->rho * p->rho);
  p->rho += drho;
}

/* Against clustering: down the gradient of the concentration, as fast as the flow distorts. */
static void shift_of(const bw_ulph *u, const bw_ulph__between *b, vec surface, double dt,
                     vec shift[3])
{
  const double most = LONGEST * u->config.dx;
  vec rate = {0}, length = {0};
  for (int k = 0; k < 9; k++)
    rate += b->L[k] * b->L[k];
  const vec_bits shifted = (surface == 0) & (b->lone == 0);
  const vec factor = -u->config.shifting * vec_sqrt(rate) * u->h * u->h * dt / u->m2;
  for (int k = 0; k < 3; k++) {
    shift[k] = vec_where(shifted, factor * b->s[k]);
    length += shift[k] * shift[k];
  }
  length = vec_sqrt(length);
  const vec shorter = vec_choose(length > most, most / length, (vec){0} + 1);
  for (int k = 0; k < 3; k++)
    shift[k] *= shorter;
}

/* What moves a particle to another place without a force, and its energy. */
static void move(const bw_ulph *u, particles *p, const bw_ulph__between *b, const vec shift[3],
                 bw_ulph__page *jump)
{
  vec dv[3], x[3], v[3], energy = {0}, drho = {0};
  for (int a = 0; a < 3; a++) {
    dv[a] = vec_dot(b->L + 3 * a, shift);
    drho += b->g[a] * shift[a];
    energy += p->m * (dv[a] * (p->v[a] + 0.5 * dv[a]) - u->config.gravity[a] * shift[a]);
    x[a] = p->x[a] + shift[a], v[a] = p->v[a] + dv[a];
    jump->push[PUSH_SHIFTING][a] += p->used * p->m * dv[a];
  }
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, c = (k + 2) % 3;
    jump->turn[PUSH_SHIFTING][k] +=
        p->used * p->m * (x[a] * v[c] - p->x[a] * p->v[c] - x[c] * v[a] + p->x[c] * p->v[a]);
  }
  jump->line[LINE_SHIFTING] += p->used * (energy + p->m * b->p * drho / (p->rho * p->rho));
  memcpy(p->x, x, sizeof x);
  memcpy(p->v, v, sizeof v);
  p->rho += drho;
}

static void store(bw_ulph *u, const bw_ulph__cluster *c, const particles *o, const vec a[3],
                  const vec shift[3])
{
  for (int l = 0; l < c->lanes; l++) {
    bw_ulph__particle *p = u->own + c->first + (size_t)l;
    for (int k = 0; k < 3; k++) {
      p->x[k] = o->x[k][l], p->v[k] = o->v[k][l];
      p->a[k] = a[k][l], p->shift[k] = shift[k][l];
    }
    p->rho = o->rho[l];
  }
}

void bw_ulph__forces(bw_ulph *u, size_t cluster, const bw_ulph__pairs *pairs, double dt,
                     bw_ulph__page *rate, bw_ulph__page *jump)
{
  const bw_ulph__cluster *c = u->clusters.of + cluster;
  bw_ulph__between *b = u->between + cluster;
  particles p = load(u, c);
  forces f;
  vec a[3], shift[3] = {{0}};
  forces_of(u, b, pairs, &f);
  for (int k = 0; k < 3; k++) {
    a[k] = (f.fluid[k] + f.by[WALLS][k] + f.by[BODIES][k] + f.physical[k] + f.artificial[k] +
            f.cure[k]) /
           p.m;
    p.v[k] += 0.5 * dt * (a[k] + u->config.gravity[k]);
  }
  book(u, &p, b, &f, rate);
  diffuse(u, &p, b, pairs->D, dt, jump);
  if (u->config.shifting > 0) {
    shift_of(u, b, pairs->surface, dt, shift);
    move(u, &p, b, shift, jump);
  }
  store(u, c, &p, a, shift);
}
