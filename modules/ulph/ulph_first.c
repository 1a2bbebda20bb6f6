/* The first sweep: moments and gradients, then density and pressure. */
#include "ulph_internal.h"

/* A particle is of the surface where the least eigenvalue of M is below this part of a full one. */
static const double SURFACE = 0.75;

/* Sums of the lanes of a cluster. */
typedef struct {
  vec M[6], s[3], G[9], r[3]; /* w V x x; w V x; w V (v_J - v_I) x; w V (rho_J - rho_I) x */
} sums;

/* The lanes themselves. */
typedef struct {
  vec x[3], v[3], rho, V;
} owners;

static owners load(const bw_ulph *u, const bw_ulph__cluster *c)
{
  owners o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    const bw_ulph__near *q = u->near + u->fluid.slot_own[own];
    for (int k = 0; k < 3; k++)
      o.x[k][l] = q->x[k], o.v[k][l] = q->v[k];
    o.rho[l] = q->rho, o.V[l] = q->V;
  }
  return o;
}

/* One neighbour, all lanes; of a face (else NULL) those that are in front of it. */
BW_ULPH_PIECE void add(sums *t, const owners *o, const bw_ulph__near *q,
                       const bw_ulph__front *front, double inverse_R2, int d)
{
  vec x[3], r2 = {0}, before = {0};
  for (int k = 0; k < d; k++) {
    x[k] = q->x[k] - o->x[k];
    r2 += x[k] * x[k];
    if (front != NULL) before -= front->normal[k] * x[k];
  }
  vec wV = vec_weight(r2, inverse_R2) * q->V;
  const vec drho = q->rho - o->rho;
  if (front != NULL) wV = vec_where(before > front->least, wV);
  for (int a = 0; a < d; a++) {
    const vec wx = wV * x[a];
    t->s[a] += wx;
    t->r[a] += drho * wx;
    for (int b = 0; b < d; b++)
      t->G[3 * b + a] += (q->v[b] - o->v[b]) * wx;
    for (int b = a; b < d; b++)
      t->M[bw_ulph__sym(a, b)] += wx * x[b];
  }
}

/* Walls and faces are added to what the fluid alone gives, which the book needs. */
BW_ULPH_PIECE void pairs(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o, sums *fluid,
                         sums *all, int d)
{
  const double inverse_R2 = 1 / (u->R * u->R);
  sums t = {0};
  for (size_t e = c->begin; e < c->walls; e++)
    add(&t, o, u->near + u->list[e], NULL, inverse_R2, d);
  *fluid = t;
  for (size_t e = c->walls; e < c->faces; e++)
    add(&t, o, u->near + u->list[e], NULL, inverse_R2, d);
  for (size_t e = c->faces; e < c->end; e++)
    add(&t, o, u->near + u->list[e], u->front + u->list[e], inverse_R2, d);
  *all = t;
}

static void pairs_2d(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o, sums *fluid,
                     sums *all)
{
  pairs(u, c, o, fluid, all, 2);
}

static void pairs_3d(const bw_ulph *u, const bw_ulph__cluster *c, const owners *o, sums *fluid,
                     sums *all)
{
  pairs(u, c, o, fluid, all, 3);
}

/* L = G Minv, and its trace. */
static vec velocity_gradient(const vec G[9], const vec Minv[6], vec L[9])
{
  for (int a = 0; a < 3; a++)
    vec_times(Minv, G + 3 * a, L + 3 * a);
  return L[0] + L[4] + L[8];
}

/* Density at the end of the step. The gradients belong to its end and the velocity to its middle,
 * so that L = L' (1 + dt L')^-1 of the gradient L' at its beginning; the mean dilation is
 * tr L + dt/2 tr L L but for dt^2. */
static vec density(vec before, const vec L[9], double dt)
{
  vec mean = L[0] + L[4] + L[8];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      mean += 0.5 * dt * L[3 * i + k] * L[3 * k + i];
  return before * (1 - 0.5 * dt * mean) / (1 + 0.5 * dt * mean);
}

/* A pair leaves the torque V_I w V_J x cross (P_I x); all pairs of a particle, those with walls
 * among them, V eps:(P M) = 0. */
static void couple_of(const vec P[6], const vec M_fluid[6], vec V, vec couple[3])
{
  vec PM[3][3], column[3], product[3];
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      column[b] = M_fluid[a < b ? bw_ulph__sym(a, b) : bw_ulph__sym(b, a)];
    vec_times(P, column, product);
    for (int b = 0; b < 3; b++)
      PM[b][a] = product[b];
  }
  for (int k = 0; k < 3; k++)
    couple[k] = V * (PM[(k + 2) % 3][(k + 1) % 3] - PM[(k + 1) % 3][(k + 2) % 3]);
}

/* What particles keep, and what their neighbours see of them in the second sweep. */
static void store(bw_ulph *u, const bw_ulph__cluster *c, const bw_ulph__between *b, vec rho, vec m2,
                  const vec P[6])
{
  for (int l = 0; l < c->lanes; l++) {
    const size_t own = c->first + (size_t)l;
    bw_ulph__particle *p = u->own + own;
    bw_ulph__far *f = u->far + u->fluid.slot_own[own];
    p->rho = rho[l], p->p = f->p = b->p[l];
    p->lone = b->lone[l] > 0, p->surface = f->surface = b->surface[l];
    f->m2 = m2[l];
    for (int k = 0; k < 6; k++)
      f->P[k] = P[k][l];
    for (int k = 0; k < 3; k++)
      f->g[k] = b->g[k][l];
  }
}

static void close_cluster(bw_ulph *u, size_t number, const owners *o, const sums *fluid,
                          const sums *all, double dt)
{
  const int d = u->config.dimensions;
  const double c2 = u->config.c0 * u->config.c0, rho0 = u->config.rho0;
  bw_ulph__between *b = u->between + number;
  const vec one = (vec){0} + 1;
  vec L_fluid[9], P[6];
  /* A cloud without volume has no gradient: then the central form. */
  const vec_bits lone = bw_ulph__moment(u, all->M, b->Minv);
  b->lone = vec_where(lone, one);
  b->surface = vec_where(~bw_ulph__above(d, all->M, SURFACE * u->m2), one);
  const vec m2 = vec_choose(lone, one * u->m2, (all->M[0] + all->M[3] + all->M[5]) / d);
  b->div_wall = velocity_gradient(all->G, b->Minv, b->L);
  b->div_wall -= velocity_gradient(fluid->G, b->Minv, L_fluid);
  vec_times(b->Minv, all->r, b->g);
  memcpy(b->s, all->s, sizeof b->s);
  b->V = o->V;
  const vec rho = density(o->rho, b->L, dt);
  b->p = c2 * (rho - rho0);
  b->p_mean = 0.5 * (c2 * (o->rho - rho0) + b->p);
  /* The pair forces are made of p M^-1 of either end. */
  for (int k = 0; k < 6; k++)
    P[k] = b->p * b->Minv[k];
  couple_of(P, fluid->M, b->V, b->couple);
  store(u, u->clusters.of + number, b, rho, m2, P);
}

void bw_ulph__first(bw_ulph *u, double dt)
{
  for (size_t q = 0; q < u->clusters.n; q++) {
    const bw_ulph__cluster *c = u->clusters.of + q;
    const owners o = load(u, c);
    sums fluid, all;
    if (u->config.dimensions == 2)
      pairs_2d(u, c, &o, &fluid, &all);
    else
      pairs_3d(u, c, &o, &fluid, &all);
    close_cluster(u, q, &o, &fluid, &all, dt);
  }
}
