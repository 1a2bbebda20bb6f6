/* Where the faces of bodies look, and the forces on them. */
#include "ulph_internal.h"

/* A body is thin where the sum of directions is less than this part of what its moment allows, and
 * its moment across less than that part of the one along. */
static const double BALANCED = 0.05, FLAT = 0.6;
/* On an edge it is the moment along the surface that is so small. */
static const double EDGE = 0.3;
/* Ties of fluid in the plane of a particle go to its first face: so much of dx. */
static const double TIE = 1e-9;

/* ---- which way they look ---- */
/* Of what is solid around a particle. */
typedef struct {
  double weight, N[3], C[6]; /* sum w V; w V x; w V x x */
} around;

static double weight_of(double r2, double R)
{
  const double q = sqrt(r2) / R, up = 1 - q;
  return up > 0 ? up * up * up * up * (1 + 4 * q) : 0;
}

static around look_around(const bw_ulph *u, const bw_ulph__cluster *c, const double at[3])
{
  around t = {0};
  for (size_t e = c->walls; e < c->end; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    double x[3];
    for (int k = 0; k < 3; k++)
      x[k] = n->x[k] - at[k];
    const double wV = weight_of(bw_ulph__dot(x, x), u->R) * n->V;
    t.weight += wV;
    for (int a = 0; a < 3; a++) {
      t.N[a] += wV * x[a];
      for (int b = a; b < 3; b++)
        t.C[bw_ulph__sym(a, b)] += wV * x[a] * x[b];
    }
  }
  return t;
}

/* The direction in which C is least, and C there over its mean along the others: by powers of tr C
 * less C, whose largest direction it is. */
static double least_axis(int d, const double C[6], double n[3])
{
  const double trace = C[0] + C[3] + C[5];
  double next[3], size = 0;
  n[0] = 0.6, n[1] = 0.8, n[2] = d == 3 ? 0.5 : 0;
  for (int q = 0; q < 60; q++) {
    bw_ulph__times(C, n, next);
    for (int k = 0; k < d; k++)
      next[k] = trace * n[k] - next[k];
    size = sqrt(bw_ulph__dot(next, next));
    if (size == 0) return 1;
    for (int k = 0; k < d; k++)
      n[k] = next[k] / size;
  }
  const double least = trace - size;
  return least * (d - 1) / fmax(trace - least, 1e-300);
}

/* What the surroundings of a particle say: the normal (any direction will do for a particle that is
 * alone), how flat the surface is (0: an edge), and whether there is another side within reach. */
typedef struct {
  double n[3], flat;
  bool thin;
} shape;

static shape shape_of(int d, const around *t)
{
  const double length = sqrt(bw_ulph__dot(t->N, t->N));
  const double most = sqrt(t->weight * (t->C[0] + t->C[3] + t->C[5]));
  shape s = {.n = {0, 1, 0}, .thin = true};
  double axis[3];
  if (most == 0) return s;
  for (int k = 0; k < 3 && length > 0; k++)
    s.n[k] = -t->N[k] / length;
  /* C is least across something thin and along an edge; of a flat surface it is alike. */
  const double ratio = least_axis(d, t->C, axis), across = bw_ulph__dot(axis, s.n);
  s.thin = ratio < FLAT && (length < BALANCED * most || fabs(across) > 0.7);
  s.flat = s.thin || fabs(across) > 0.7 ? 1 : fmax(0, fmin(1, (ratio - EDGE) / (FLAT - EDGE)));
  for (int k = 0; k < 3 && s.thin; k++)
    s.n[k] = across < 0 ? -axis[k] : axis[k];
  return s;
}

/* Depth below a flat surface, from what a half-space of whole layers would have; only how velocity
 * goes through a surface without slip depends on it. */
static double depth_of(const bw_ulph *u, double length)
{
  enum { LAYERS = 3 };
  double s = 0.5;
  while (s < LAYERS - 0.6 && length < u->half_space[(int)s + 1])
    s += 1;
  const double above = u->half_space[(int)s], below = u->half_space[(int)s + 1];
  const double part = above > below ? (above - length) / (above - below) : 0;
  return u->config.dx * fmax(0, fmin(LAYERS, s + part));
}

void bw_ulph__turn_faces(bw_ulph *u)
{
  for (size_t c = 0; c < u->facing.n; c++) {
    const bw_ulph__cluster *q = u->facing.of + c;
    for (int l = 0; l < q->lanes; l++) {
      const size_t own = q->first + (size_t)l;
      bw_ulph__particle *p = u->own + u->face.first + own;
      bw_ulph__front *f = u->front + u->face.slot_own[own];
      const around t = look_around(u, q, p->at);
      const shape s = shape_of(u->config.dimensions, &t);
      /* The second face looks back, if there is anything to see. */
      const double side = (p->id & 1) == 0 ? 1 : -1;
      u->shade[u->wall.own + own].flat = s.flat;
      p->depth = depth_of(u, sqrt(bw_ulph__dot(t.N, t.N)));
      for (int k = 0; k < 3; k++)
        f->normal[k] = p->normal[k] = side * s.n[k];
      f->least = -side * (s.thin ? TIE * u->config.dx : 1e3 * u->R);
    }
  }
  bw_ulph__send(&u->face, sizeof *u->front, u->front);
}

/* ---- forces on them ---- */
/* The lanes of a cluster of faces, and sums over the fluid in front. */
typedef struct {
  vec x[3], v[3], normal[3], least, P[6];
} faces;
typedef struct {
  vec F[3], D[3], s[3]; /* w V (P + P) x; viscous; w V x */
} sums;

static faces load(const bw_ulph *u, const bw_ulph__cluster *c)
{
  faces o;
  for (int l = 0; l < BW_ULPH_LANES; l++) {
    const size_t own = c->first + (size_t)(l < c->lanes ? l : c->lanes - 1);
    const int32_t slot = u->face.slot_own[own];
    for (int k = 0; k < 3; k++) {
      o.x[k][l] = u->near[slot].x[k], o.v[k][l] = u->near[slot].v[k];
      o.normal[k][l] = u->front[slot].normal[k];
    }
    for (int k = 0; k < 6; k++)
      o.P[k][l] = u->far[slot].P[k];
    o.least[l] = u->front[slot].least;
  }
  return o;
}

/* The pairs of ulph_second.c, seen from the body. */
static sums sum(const bw_ulph *u, const bw_ulph__cluster *c, const faces *o)
{
  const double over_R2 = 1 / (u->R * u->R), least_r2 = 1e-6 * u->R * u->R;
  const double mu = u->config.mu + u->mu_wall;
  sums t = {0};
  for (size_t e = c->begin; e < c->walls; e++) {
    const bw_ulph__near *n = u->near + u->list[e];
    const bw_ulph__far *f = u->far + u->list[e];
    vec x[3], r2 = {0}, vx = {0}, before = {0};
    for (int k = 0; k < 3; k++) {
      x[k] = n->x[k] - o->x[k];
      r2 += x[k] * x[k];
      vx += (n->v[k] - o->v[k]) * x[k];
      before += o->normal[k] * x[k];
    }
    const vec wV = vec_where(before > o->least, vec_weight(r2, over_R2) * n->V);
    const vec drag = mu * wV * vx * vec_inverse(f->m2 * (r2 + least_r2));
    for (int a = 0; a < 3; a++) {
      vec Px = {0};
      for (int b = 0; b < 3; b++) {
        const int ab = a < b ? bw_ulph__sym(a, b) : bw_ulph__sym(b, a);
        Px += (f->P[ab] + o->P[ab]) * x[b];
      }
      t.F[a] += wV * Px;
      t.D[a] += drag * x[a];
      t.s[a] += wV * x[a];
    }
  }
  return t;
}

void bw_ulph__load_faces(bw_ulph *u)
{
  const int d = u->config.dimensions;
  for (size_t c = 0; c < u->facing.n; c++) {
    const bw_ulph__cluster *q = u->facing.of + c;
    const faces o = load(u, q);
    const sums t = sum(u, q, &o);
    for (int l = 0; l < q->lanes; l++) {
      const size_t own = q->first + (size_t)l;
      bw_ulph__particle *p = u->own + u->face.first + own;
      const double V = u->near[u->face.slot_own[own]].V;
      double s2 = 0;
      for (int k = 0; k < 3; k++) {
        p->a[k] = -V * t.F[k][l];
        p->shift[k] = 2 * (d + 2) * V * t.D[k][l];
        s2 += t.s[k][l] * t.s[k][l];
      }
      /* Twice, as both ends' M^-1 act: the load of a pressure of 1 from all around. */
      p->surface = 2 * V * sqrt(s2) / u->m2;
    }
  }
}

void bw_ulph__book_bodies(bw_ulph *u, double half)
{
  double work[2] = {0, 0};
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++) {
    const double *v = u->body.v + 3 * bw_ulph__body_particle(u->own + i);
    work[0] += half * bw_ulph__dot(u->own[i].a, v);
    work[1] += half * bw_ulph__dot(u->own[i].shift, v);
  }
  /* What the body takes is not lost by images or by friction. */
  u->jump.line[LINE_BODIES] -= work[0] + work[1];
  u->jump.line[LINE_GHOSTS] += work[0];
  u->jump.line[LINE_ARTIFICIAL] += work[1];
}
