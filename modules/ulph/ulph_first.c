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
  vec x[3], v[3], rho;
} owners;

static owners load(const bw_ulph *u, const bw_ulph__cluster *c)
{
  owners o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    const bw_ulph__near *q = u->near + u->fluid.slot_own[own];
    for (int k = 0; k < 3; k++)
      o.x[k][l] = q->x[k], o.v[k][l] = q->v[k];
    o.rho[l] = q->rho;
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

/* tr(G Minv), with L = G Minv where it is wanted. */
static double velocity_gradient(const double G[9], const double Minv[6], double L[9])
{
  for (int a = 0; a < 3; a++)
    bw_ulph__times(Minv, G + 3 * a, L + 3 * a);
  return L[0] + L[4] + L[8];
}

/* Density and pressure of one particle at the end of the step. The gradients belong to its end and
 * the velocity to its middle, so that L = L' (1 + dt L')^-1 of the gradient L' at its beginning;
 * the mean dilation is tr L + dt/2 tr L L but for dt^2. */
static void finish(bw_ulph *u, bw_ulph__particle *p, bw_ulph__between *b, double dt)
{
  const double c2 = u->config.c0 * u->config.c0, before = c2 * (p->rho - u->config.rho0);
  const double *L = b->L;
  double mean = L[0] + L[4] + L[8];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      mean += 0.5 * dt * L[3 * i + k] * L[3 * k + i];
  p->rho *= (1 - 0.5 * dt * mean) / (1 + 0.5 * dt * mean);
  p->p = c2 * (p->rho - u->config.rho0);
  b->p_mean = 0.5 * (before + p->p);
}

/* A pair leaves the torque V_I w V_J x cross (P_I x); all pairs of a particle, those with walls
 * among them, V eps:(P M) = 0. */
static void couple_of(const double P[6], const double M_fluid[6], double V, double couple[3])
{
  double PM[3][3], column[3], product[3];
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      column[b] = M_fluid[a < b ? bw_ulph__sym(a, b) : bw_ulph__sym(b, a)];
    bw_ulph__times(P, column, product);
    for (int b = 0; b < 3; b++)
      PM[b][a] = product[b];
  }
  for (int k = 0; k < 3; k++)
    couple[k] = V * (PM[(k + 2) % 3][(k + 1) % 3] - PM[(k + 1) % 3][(k + 2) % 3]);
}

/* What the second sweep of this particle and of its neighbours needs. */
static void close_one(bw_ulph *u, size_t own, const double M[6], const double G[9],
                      const double M_fluid[6], const double G_fluid[9], const double r[3],
                      double dt)
{
  const int d = u->config.dimensions;
  bw_ulph__particle *p = u->own + own;
  bw_ulph__between *b = u->between + own;
  bw_ulph__far *f = u->far + u->fluid.slot_own[own];
  double L_fluid[9];
  /* A cloud without volume has no gradient: then the central form. */
  p->lone = bw_ulph__moment(u, M, b->Minv);
  p->surface = bw_ulph__above(d, M, SURFACE * u->m2) ? 0 : 1;
  f->m2 = p->lone ? u->m2 : (M[0] + M[3] + M[5]) / d;
  const double div = velocity_gradient(G, b->Minv, b->L);
  b->div_wall = div - velocity_gradient(G_fluid, b->Minv, L_fluid);
  bw_ulph__times(b->Minv, r, b->g);
  b->V = u->near[u->fluid.slot_own[own]].V;
  finish(u, p, b, dt);
  /* The pair forces are made of p M^-1 of either end. */
  for (int k = 0; k < 6; k++)
    f->P[k] = p->p * b->Minv[k];
  couple_of(f->P, M_fluid, b->V, b->couple);
  f->p = p->p;
  memcpy(f->g, b->g, sizeof f->g);
  f->surface = p->surface;
}

static void close_cluster(bw_ulph *u, const bw_ulph__cluster *c, const sums *fluid, const sums *all,
                          double dt)
{
  for (int l = 0; l < c->lanes; l++) {
    double M[6], M_fluid[6], G[9], G_fluid[9], r[3];
    for (int k = 0; k < 6; k++)
      M[k] = all->M[k][l], M_fluid[k] = fluid->M[k][l];
    for (int k = 0; k < 9; k++)
      G[k] = all->G[k][l], G_fluid[k] = fluid->G[k][l];
    for (int k = 0; k < 3; k++) {
      r[k] = all->r[k][l];
      u->between[c->first + (size_t)l].s[k] = all->s[k][l];
    }
    close_one(u, c->first + (size_t)l, M, G, M_fluid, G_fluid, r, dt);
  }
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
    close_cluster(u, c, &fluid, &all, dt);
  }
}
