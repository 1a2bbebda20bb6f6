/* Forces, the step, energies. */
#include "rigid_internal.h"

#include <math.h>
#include <string.h>

void bw_rigid__find_spin(bw_rigid__body *b)
{
  double M[3];
  rigid_turn_back((const double(*)[3])b->R, b->L, M);
  for (int a = 0; a < 3; a++)
    M[a] /= b->inertia[a];
  rigid_turn((const double(*)[3])b->R, M, b->W);
}

/* Inertia about the axis d of space now. */
static double inertia_about(const bw_rigid__body *b, int d)
{
  double I = 0.0;
  for (int a = 0; a < 3; a++)
    I += b->inertia[a] * b->R[d][a] * b->R[d][a];
  return I;
}

void bw_rigid__at_start(const bw_rigid__body *b, const double x[3], double start[3])
{
  const double from[3] = {x[0] - b->X[0], x[1] - b->X[1], x[2] - b->X[2]};
  double y[3];
  rigid_turn_back((const double(*)[3])b->R, from, y);
  rigid_turn((const double(*)[3])b->axes, y, start);
  for (int d = 0; d < 3; d++)
    start[d] += b->start[d];
}

/* Q = R axes^T. */
static void turn_of(const bw_rigid__body *b, double Q[3][3])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      Q[i][j] = rigid_dot(b->R[i], b->axes[j]);
}

void bw_rigid__turned(const bw_rigid__body *b, double angle[3])
{
  if (b->turns != RIGID_FREE) {
    memcpy(angle, b->angle, sizeof b->angle);
    return;
  }
  /* sin(angle) axis is the skew part of Q, the trace is 1 + 2 cos(angle). */
  double Q[3][3];
  turn_of(b, Q);
  const double axis[3] = {0.5 * (Q[2][1] - Q[1][2]), 0.5 * (Q[0][2] - Q[2][0]),
                          0.5 * (Q[1][0] - Q[0][1])};
  const double s = sqrt(rigid_dot(axis, axis)), c = 0.5 * (Q[0][0] + Q[1][1] + Q[2][2] - 1.0);
  const double scale = s > 1e-12 ? atan2(s, c) / s : 1.0;
  for (int d = 0; d < 3; d++)
    angle[d] = scale * axis[d];
}

void bw_rigid__forces(bw_rigid *r)
{
  const bool meets = r->config.stiffness > 0.0;
  const bool rubs = meets && r->config.friction > 0.0;
  const size_t n = (size_t)r->n, rows = rubs ? 12 * n : 6 * n;
  memset(r->sum, 0, (12 * n + 1) * sizeof *r->sum);
  if (meets) {
    r->sum[rows] = bw_rigid__contact(r, r->sum);
    bw_comm_sum(r->comm, rows + 1, r->sum);
  }
  r->contact = r->sum[rows];
  for (int q = 0; q < r->n; q++) {
    bw_rigid__body *b = &r->body[q];
    double angle[3];
    bw_rigid__turned(b, angle);
    for (int d = 0; d < 3; d++) {
      b->f[d] = r->sum[6 * q + d] + b->mass * r->config.gravity[d] -
                b->stiffness[d] * (b->X[d] - b->start[d]);
      b->t[d] = r->sum[6 * q + 3 + d] - b->stiffness[3 + d] * angle[d];
    }
    for (size_t d = 0; d < 6 && rubs; d++)
      b->rub[d] = r->sum[6 * (n + (size_t)q) + d];
  }
}

void bw_rigid_answer(const bw_rigid *r, int q, const double impulse[6], double change[6])
{
  const bw_rigid__body *b = &r->body[q];
  double M[3];
  for (int d = 0; d < 3; d++) {
    change[d] = b->held[d] ? 0.0 : impulse[d] / b->mass;
    change[3 + d] = b->turns == d ? impulse[3 + d] / inertia_about(b, d) : 0.0;
  }
  if (b->turns != RIGID_FREE) return;
  rigid_turn_back((const double(*)[3])b->R, impulse + 3, M);
  for (int a = 0; a < 3; a++)
    M[a] /= b->inertia[a];
  rigid_turn((const double(*)[3])b->R, M, change + 3);
}

/* Half a step of the velocities. Damping is taken with the old velocity in the first half of a step
 * and with the new one in the second, so that the whole is of second order. */
static void kick(bw_rigid__body *b, double half, bool second)
{
  for (int d = 0; d < 3; d++) {
    const double c = half * b->damping[d] / b->mass;
    if (b->held[d]) continue;
    const double V = b->V[d] + half * (b->F[d] + b->f[d]) / b->mass;
    b->V[d] = second ? V / (1.0 + c) : V - c * b->V[d];
  }
  if (b->turns == RIGID_FREE) {
    for (int d = 0; d < 3; d++)
      b->L[d] += half * (b->T[d] + b->t[d] - b->damping[3 + d] * b->W[d]);
    bw_rigid__find_spin(b);
  } else if (b->turns != RIGID_TOLD) {
    const int d = b->turns;
    const double I = inertia_about(b, d), c = half * b->damping[3 + d] / I;
    const double W = b->W[d] + half * (b->T[d] + b->t[d]) / I;
    b->W[d] = second ? W / (1.0 + c) : W - c * b->W[d];
  }
}

/* Half a step of all; what friction takes is its force times the mean of the velocities before and
 * after. */
static void kick_all(bw_rigid *r, double half, bool second)
{
  for (int q = 0; q < r->n; q++) {
    bw_rigid__body *b = &r->body[q];
    double before[6];
    memcpy(before, b->V, sizeof b->V);
    memcpy(before + 3, b->W, sizeof b->W);
    kick(b, half, second);
    for (int d = 0; d < 3; d++)
      r->rubbed -= 0.5 * half *
                   (b->rub[d] * (before[d] + b->V[d]) + b->rub[3 + d] * (before[3 + d] + b->W[d]));
  }
}

/* R <- R (turn by `angle` about principal axis a). */
static void turn_about_own(double R[3][3], int a, double angle)
{
  const double c = cos(angle), s = sin(angle);
  const int i = (a + 1) % 3, j = (a + 2) % 3;
  for (int d = 0; d < 3; d++) {
    const double x = R[d][i], y = R[d][j];
    R[d][i] = c * x + s * y;
    R[d][j] = c * y - s * x;
  }
}

/* R <- (turn by the vector `angle`) R, Rodrigues. */
static void turn_by(double R[3][3], const double angle[3])
{
  const double size = sqrt(rigid_dot(angle, angle));
  if (size == 0.0) return;
  const double e[3] = {angle[0] / size, angle[1] / size, angle[2] / size};
  for (int a = 0; a < 3; a++) {
    const double x[3] = {R[0][a], R[1][a], R[2][a]};
    double cross[3];
    rigid_cross(e, x, cross);
    for (int d = 0; d < 3; d++)
      R[d][a] =
          cos(size) * x[d] + sin(size) * cross[d] + (1.0 - cos(size)) * rigid_dot(e, x) * e[d];
  }
}

/* Columns orthonormal again: what rounding has done to them. */
static void straighten(double R[3][3])
{
  double c[3][3];
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++)
      c[a][d] = R[d][a];
  const double first = 1.0 / sqrt(rigid_dot(c[0], c[0]));
  for (int d = 0; d < 3; d++)
    c[0][d] *= first;
  const double along = rigid_dot(c[0], c[1]);
  for (int d = 0; d < 3; d++)
    c[1][d] -= along * c[0][d];
  const double second = 1.0 / sqrt(rigid_dot(c[1], c[1]));
  for (int d = 0; d < 3; d++)
    c[1][d] *= second;
  rigid_cross(c[0], c[1], c[2]);
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++)
      R[d][a] = c[a][d];
}

/* Places and turns at the present velocities. L stands still in space, and with it the body turns
 * about one principal axis after the other, there and back. */
static void drift(bw_rigid__body *b, double dt)
{
  static const int axis[] = {0, 1, 2, 1, 0};
  static const double part[] = {0.5, 0.5, 1.0, 0.5, 0.5};
  for (int d = 0; d < 3; d++)
    b->X[d] += dt * b->V[d];
  if (b->turns == RIGID_FREE) {
    for (int q = 0; q < 5; q++) {
      double M[3];
      rigid_turn_back((const double(*)[3])b->R, b->L, M);
      turn_about_own(b->R, axis[q], part[q] * dt * M[axis[q]] / b->inertia[axis[q]]);
    }
    straighten(b->R);
    bw_rigid__find_spin(b);
    return;
  }
  const double angle[3] = {dt * b->W[0], dt * b->W[1], dt * b->W[2]};
  turn_by(b->R, angle);
  straighten(b->R);
  for (int d = 0; d < 3; d++)
    b->angle[d] += angle[d];
}

bw_status bw_rigid_begin(bw_rigid *r, double dt)
{
  const double most = bw_rigid_dt_max(r);
  BW_REQUIRE(dt > 0.0 && dt <= most, BW_ECFL, "rigid: dt = %g: must be > 0 and at most %g", dt,
             most);
  /* f, t are those of the places at the beginning; friction was of the velocities within the step
   * before, and a restart does not know them. */
  if (r->config.friction > 0.0) bw_rigid__forces(r);
  kick_all(r, 0.5 * dt, false);
  for (int q = 0; q < r->n; q++)
    drift(&r->body[q], dt);
  return BW_OK;
}

bw_status bw_rigid_end(bw_rigid *r, double dt)
{
  bool finite = true;
  bw_rigid__forces(r);
  kick_all(r, 0.5 * dt, true);
  for (int q = 0; q < r->n; q++) {
    const bw_rigid__body *b = &r->body[q];
    for (int d = 0; d < 3; d++)
      finite = finite && isfinite(b->X[d]) && isfinite(b->V[d]) && isfinite(b->W[d]);
  }
  r->time += dt;
  /* All ranks have the same numbers, so they agree. */
  BW_REQUIRE(finite, BW_EDIVERGED, "rigid: the motion is not finite at t = %g", r->time);
  return BW_OK;
}

bw_status bw_rigid_step(bw_rigid *r, double dt)
{
  BW_TRY(bw_rigid_begin(r, dt));
  return bw_rigid_end(r, dt);
}

bw_rigid_energy bw_rigid_energy_of(const bw_rigid *r)
{
  bw_rigid_energy e = {.contact = r->contact, .rubbed = r->rubbed};
  for (int q = 0; q < r->n; q++) {
    const bw_rigid__body *b = &r->body[q];
    double M[3], angle[3];
    rigid_turn_back((const double(*)[3])b->R, b->W, M);
    bw_rigid__turned(b, angle);
    for (int d = 0; d < 3; d++) {
      const double off = b->X[d] - b->start[d];
      e.kinetic += 0.5 * (b->mass * b->V[d] * b->V[d] + b->inertia[d] * M[d] * M[d]);
      e.weight -= b->mass * r->config.gravity[d] * b->X[d];
      e.spring += 0.5 * (b->stiffness[d] * off * off + b->stiffness[3 + d] * angle[d] * angle[d]);
    }
  }
  return e;
}
