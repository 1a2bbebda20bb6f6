/* Surface points: where they are, what acts there; contact between bodies and with walls. */
#include "bw_memory.h"
#include "rigid_internal.h"

#include <math.h>
#include <string.h>

size_t bw_rigid_points(const bw_rigid *r)
{
  return r->points;
}

const int64_t *bw_rigid_point_id(const bw_rigid *r)
{
  return r->id;
}

const int *bw_rigid_point_body(const bw_rigid *r)
{
  return r->of;
}

const double *bw_rigid_point_area(const bw_rigid *r)
{
  return r->area;
}

/* Room for `more` points behind those that there are. */
static bw_status grow(bw_rigid *r, size_t more)
{
  const size_t n = r->points, room = n + more;
  int64_t *id = NULL;
  int *of = NULL;
  double *area = NULL, *y = NULL, *m = NULL;
  bw_status st = BW_ALLOCATE(&id, room);
  BW_THEN(st, BW_ALLOCATE(&of, room));
  BW_THEN(st, BW_ALLOCATE(&area, room));
  BW_THEN(st, BW_ALLOCATE(&y, 3 * room));
  BW_THEN(st, BW_ALLOCATE(&m, 3 * room));
  if (st == BW_OK && n > 0) {
    memcpy(id, r->id, n * sizeof *id);
    memcpy(of, r->of, n * sizeof *of);
    memcpy(area, r->area, n * sizeof *area);
    memcpy(y, r->y, 3 * n * sizeof *y);
    memcpy(m, r->m, 3 * n * sizeof *m);
  }
  bw_release(&r->id);
  bw_release(&r->of);
  bw_release(&r->area);
  bw_release(&r->y);
  bw_release(&r->m);
  r->id = id, r->of = of, r->area = area, r->y = y, r->m = m;
  return st;
}

/* This rank's share of the points of body q. */
static bw_status add_points(bw_rigid *r, int q)
{
  bw_rigid__body *b = &r->body[q];
  const bool planar = r->config.planar;
  const int64_t rank = bw_comm_rank(r->comm), size = bw_comm_size(r->comm);
  int64_t n = 0;
  double *X = NULL, *N = NULL, *A = NULL;
  BW_TRY(bw_shape_points(b->count, b->shape, planar, r->config.spacing, &n, &X, &N, &A));
  const int64_t begin = n * rank / size, end = n * (rank + 1) / size;
  const bw_status st = grow(r, (size_t)(end - begin));
  b->radius = 0.0;
  for (int64_t p = 0; p < n && st == BW_OK; p++) {
    double from[3];
    for (int d = 0; d < 3; d++)
      from[d] = planar && d == 2 ? 0.0 : X[3 * p + d] - b->start[d];
    b->radius = fmax(b->radius, sqrt(rigid_dot(from, from)) + r->config.spacing);
    if (p < begin || p >= end) continue;
    /* In the frame of the principal axes nothing moves any more. */
    const size_t i = r->points++;
    r->id[i] = r->all + p;
    r->of[i] = q;
    r->area[i] = A[p] * (planar ? r->config.depth : 1.0);
    rigid_turn_back((const double(*)[3])b->axes, from, r->y + 3 * i);
    rigid_turn_back((const double(*)[3])b->axes, N + 3 * p, r->m + 3 * i);
  }
  r->all += n;
  bw_release(&X);
  bw_release(&N);
  bw_release(&A);
  return st;
}

bw_status bw_rigid__make_points(bw_rigid *r)
{
  for (int q = 0; q < r->n; q++)
    BW_TRY(add_points(r, q));
  return BW_OK;
}

void bw_rigid_surface(const bw_rigid *r, double X[], double V[], double N[])
{
  for (size_t i = 0; i < r->points; i++) {
    const bw_rigid__body *b = &r->body[r->of[i]];
    const double(*R)[3] = (const double(*)[3])b->R;
    double from[3], turn[3];
    rigid_turn(R, r->y + 3 * i, from);
    rigid_cross(b->W, from, turn);
    for (size_t d = 0; d < 3; d++) {
      if (X != NULL) X[3 * i + d] = b->X[d] + from[d];
      if (V != NULL) V[3 * i + d] = b->V[d] + turn[d];
    }
    if (N != NULL) rigid_turn(R, r->m + 3 * i, N + 3 * i);
  }
}

/* Force at the place x on body q, into sum (n,6). */
static void add_force(const bw_rigid *r, int q, const double x[3], const double force[3],
                      double sum[])
{
  const bw_rigid__body *b = &r->body[q];
  const double from[3] = {x[0] - b->X[0], x[1] - b->X[1], x[2] - b->X[2]};
  double torque[3];
  rigid_cross(from, force, torque);
  for (int d = 0; d < 3; d++) {
    sum[6 * q + d] += force[d];
    sum[6 * q + 3 + d] += torque[d];
  }
}

void bw_rigid_sum(const bw_rigid *r, const double f[], double F[], double T[])
{
  memset(r->sum, 0, 6 * (size_t)r->n * sizeof *r->sum);
  for (size_t i = 0; i < r->points; i++) {
    const bw_rigid__body *b = &r->body[r->of[i]];
    double x[3];
    rigid_turn((const double(*)[3])b->R, r->y + 3 * i, x);
    for (int d = 0; d < 3; d++)
      x[d] += b->X[d];
    add_force(r, r->of[i], x, f + 3 * i, r->sum);
  }
  bw_comm_sum(r->comm, 6 * (size_t)r->n, r->sum);
  for (int q = 0; q < r->n; q++)
    for (int d = 0; d < 3; d++) {
      F[3 * q + d] = r->sum[6 * q + d];
      T[3 * q + d] = r->sum[6 * q + 3 + d];
    }
}

double bw_rigid_distance(const bw_rigid *r, int q, const double x[3])
{
  double start[3];
  bw_rigid__at_start(&r->body[q], x, start);
  return bw_shape_distance(r->body[q].count, r->body[q].shape, r->config.planar, start);
}

/* The normal of the shape at the start, turned with the body. */
static void normal_at(const bw_rigid *r, int q, const double start[3], double n[3])
{
  const bw_rigid__body *b = &r->body[q];
  double at_start[3], in_frame[3];
  bw_shape_normal(b->count, b->shape, r->config.planar, start, at_start);
  rigid_turn_back((const double(*)[3])b->axes, at_start, in_frame);
  rigid_turn((const double(*)[3])b->R, in_frame, n);
}

void bw_rigid_normal(const bw_rigid *r, int q, const double x[3], double normal[3])
{
  double start[3];
  bw_rigid__at_start(&r->body[q], x, start);
  normal_at(r, q, start, normal);
}

double bw_rigid_area(const bw_rigid *r, int q)
{
  return r->body[q].area;
}

double bw_rigid_radius(const bw_rigid *r, int q)
{
  return r->body[q].radius;
}

/* Velocity of a place x that moves with body q. */
static void velocity_at(const bw_rigid *r, int q, const double x[3], double v[3])
{
  const bw_rigid__body *b = &r->body[q];
  const double from[3] = {x[0] - b->X[0], x[1] - b->X[1], x[2] - b->X[2]};
  rigid_cross(b->W, from, v);
  for (int d = 0; d < 3; d++)
    v[d] += b->V[d];
}

static const double LOSS = 0.02; /* damping of contact along its normal, of the critical one */

/* Friction at x on body q, and the other way on body other (-1: a wall at rest), which it
 * presses on with `push` along the unit vector n, `deep` inside. */
static void rub(const bw_rigid *r, int q, int other, const double x[3], const double n[3],
                double push, double deep, double sum[])
{
  const double mu = r->config.friction;
  double u[3], back[3] = {0.0, 0.0, 0.0}, force[3], slip[3] = {0.0, 0.0, 0.0};
  if (mu == 0.0) return;
  velocity_at(r, q, x, u);
  if (other >= 0) velocity_at(r, other, x, slip);
  for (int d = 0; d < 3; d++)
    u[d] -= slip[d];
  const double along = rigid_dot(u, n);
  for (int d = 0; d < 3; d++)
    u[d] -= along * n[d];
  const double creep = mu * deep / r->lag, size = sqrt(rigid_dot(u, u) + creep * creep);
  /* Without it sliding feeds the bouncing of bodies; it never pulls. */
  const double damp = fmin(fmax(2.0 * LOSS * r->lag / deep * along, -1.0), 1.0);
  for (int d = 0; d < 3; d++) {
    force[d] = -push * (mu * u[d] / size + damp * n[d]);
    back[d] = -force[d];
  }
  /* Of all contact, and once more by itself, for the book. */
  for (int part = 0; part < 2; part++) {
    double *to = sum + (part == 0 ? 0 : 6 * (ptrdiff_t)r->n);
    add_force(r, q, x, force, to);
    if (other >= 0) add_force(r, other, x, back, to);
  }
}

/* Walls against point i at x: full pressure -k d. */
static double meet_walls(const bw_rigid *r, size_t i, const double x[3], double sum[])
{
  const bw_rigid_config *c = &r->config;
  double energy = 0.0;
  for (int d = 0; d < 3; d++)
    for (int side = 0; side < 2; side++) {
      if (!c->walled[d][side]) continue;
      const double inward = side == 0 ? 1.0 : -1.0;
      const double away = inward * (x[d] - (side == 0 ? c->lower[d] : c->upper[d])) - c->gap;
      if (away >= 0.0) continue;
      double force[3] = {0.0, 0.0, 0.0};
      force[d] = -inward * c->stiffness * away * r->area[i];
      add_force(r, r->of[i], x, force, sum);
      const double n[3] = {d == 0, d == 1, d == 2};
      rub(r, r->of[i], -1, x, n, fabs(force[d]), -away, sum);
      energy += 0.5 * c->stiffness * away * away * r->area[i];
    }
  return energy;
}

/* Point i at x inside body q: half the pressure, as q's points do the other half. */
static double meet_body(const bw_rigid *r, size_t i, const double x[3], int q, double sum[])
{
  const bw_rigid__body *b = &r->body[q];
  double start[3], n[3], force[3], back[3];
  const double from[3] = {x[0] - b->X[0], x[1] - b->X[1], x[2] - b->X[2]};
  const double near = b->radius + r->config.gap;
  if (rigid_dot(from, from) > near * near) return 0.0;
  bw_rigid__at_start(b, x, start);
  const double away =
      bw_shape_distance(b->count, b->shape, r->config.planar, start) - r->config.gap;
  if (!(away < 0.0)) return 0.0;
  normal_at(r, q, start, n);
  for (int d = 0; d < 3; d++) {
    force[d] = -0.5 * r->config.stiffness * away * r->area[i] * n[d];
    back[d] = -force[d];
  }
  add_force(r, r->of[i], x, force, sum);
  add_force(r, q, x, back, sum);
  rub(r, r->of[i], q, x, n, -0.5 * r->config.stiffness * away * r->area[i], -away, sum);
  return 0.25 * r->config.stiffness * away * away * r->area[i];
}

double bw_rigid__contact(const bw_rigid *r, double sum[])
{
  double energy = 0.0;
  for (size_t i = 0; i < r->points; i++) {
    const bw_rigid__body *b = &r->body[r->of[i]];
    double x[3];
    rigid_turn((const double(*)[3])b->R, r->y + 3 * i, x);
    for (int d = 0; d < 3; d++)
      x[d] += b->X[d];
    energy += meet_walls(r, i, x, sum);
    for (int q = 0; q < r->n; q++)
      if (q != r->of[i]) energy += meet_body(r, i, x, q, sum);
  }
  return energy;
}
