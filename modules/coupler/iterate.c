/* Iterated coupling: a step is repeated until the surface moves as the fluid was told.
 *
 * V  the markers' velocity during the step; r(V) = velocity with which the solid answers, less V:
 *      theta (X_{n+1} - X_n)/dt + (1 - theta) V_{n+1}.
 *    The displacement sees every motion, also elastic ones shorter than the step, which the
 * velocity at its end does not. But a light body pushed by F_n moves at a mean velocity that
 * changes by dt/(2 m) (F_n + F_{n-1}), and rings for ever like the trapezoidal rule; the velocity
 * at the end changes by dt/m F_n. Together: (1 - theta/2) F_n + theta/2 F_{n-1}, and what rings is
 * left with -theta/(2 - theta) of itself in every step.
 *
 * Interface quasi-Newton with the inverse Jacobian from least squares (Degroote, Bathe &
 * Vierendeels 2009; as a rule of relaxation, Anderson 1965): of two tries of the step the change dV
 * of V and the change dr of r are known. What lies of r in the span of these dr is taken away by
 * the combination of the dV that belongs to it, the rest is relaxed: V <- V - sum_i (q_i.r) d_i +
 * omega (r - sum_i (q_i.r) q_i), q_i the dr made orthonormal, d_i the dV in the same combination. A
 * dr that hardly leaves the span of those before says nothing new and is left out.
 *
 * A step has converged when it is a fixed point of both: the residual of the motion, and that of
 * the load, by which it would change if the surface moved as the solid answers. This is the slope
 * of the load against the motion, as the last two tries show it, times the residual of the motion:
 * the load holds the added mass over dt, and is off by much more than the motion. The motion has to
 * come to coupling_residual and the load to its square root, 1 % of itself by default; the residual
 * of a step is the larger of the first and the second squared. Where both vanish one try will do,
 * else there are two at least.
 *
 * Inertia of the fluid inside. The markers move it, and their reaction holds that force, which is
 * none on the body. It is put on the solid's side (M. Uhlmann, J. Comput. Phys. 209 (2005) 448; T.
 * Kempe and J. Froehlich, J. Comput. Phys. 231 (2012) 3663): m a = R + rho V_h (U - U before)/dt, U
 * the fluid's velocity at each particle, at the end and at the beginning of the step. It has to be
 * that of the fluid: with the body's own acceleration in its place, which the fluid inside follows
 * within some steps only, a body as heavy as the fluid would be thrown about. */
#include "bw_memory.h"
#include "coupler_internal.h"

#include <math.h>
#include <string.h>

static const double LEAST_NEW = 1e-6; /* of a dr */

bw_status bw_coupler__iteration_create(bw_coupler *c)
{
  bw_coupler__iteration *t = &c->iteration;
  /* The last try of a step teaches nothing, so there is a column less than tries. */
  const int most = c->config.coupling_iterations - 1;
  t->room = most < BW_COUPLER__COLUMNS ? most : BW_COUPLER__COLUMNS;
  BW_TRY(bw_coupler__state_create(c, &t->start));
  BW_TRY(BW_ALLOCATE(&t->X, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&t->answer, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&t->guess, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&t->residual, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&t->load, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&t->inside, 3 * c->n));
  for (int i = 0; i < t->room; i++) {
    BW_TRY(BW_ALLOCATE(&t->q[i], 3 * c->n));
    BW_TRY(BW_ALLOCATE(&t->d[i], 3 * c->n));
  }
  return BW_OK;
}

void bw_coupler__iteration_release(bw_coupler *c)
{
  bw_coupler__iteration *t = &c->iteration;
  bw_coupler__state_release(&t->start);
  bw_release(&t->X);
  bw_release(&t->answer);
  bw_release(&t->guess);
  bw_release(&t->residual);
  bw_release(&t->load);
  bw_release(&t->inside);
  for (int i = 0; i < t->room; i++) {
    bw_release(&t->q[i]);
    bw_release(&t->d[i]);
  }
}

/* The markers move at the guess; where they are does not change. */
static bw_status give_guess(bw_coupler *c)
{
  bw_coupler__tell_surface(c, c->iteration.guess);
  memcpy(c->marker_V, c->iteration.guess, 3 * c->n_surface * sizeof *c->marker_V);
  c->markers_moved = true;
  return c->block > 1 ? bw_coupler__blocks_follow(c) : BW_OK;
}

/* The velocity of the fluid in place of each particle, U (n,3). Collective. */
static void look_inside(bw_coupler *c, double U[])
{
  bw_ibm_mdf_interpolate(c->inside_fluid, bw_ns_channel_velocity(c->fluid), U);
}

/* Before the first try: where the particles are, and how the fluid moves there. */
static bw_status open_inside(bw_coupler *c)
{
  bw_coupler__iteration *t = &c->iteration;
  double *rest = c->scratch[0], *volume = c->scratch[1];
  if (c->inside_fluid == NULL) return BW_OK;
  memset(rest, 0, 3 * c->n * sizeof *rest);
  for (size_t i = 0; i < c->n; i++)
    volume[i] = bw_solid_volume_of(c->solid, i);
  BW_TRY(bw_ibm_mdf_set_markers(c->inside_fluid, c->n, t->X, rest, volume, NULL));
  look_inside(c, t->inside);
  return BW_OK;
}

void bw_coupler__free_inside(bw_coupler *c, double dt)
{
  double *U = c->scratch[1];
  if (c->inside_fluid == NULL) return;
  look_inside(c, U);
  for (size_t i = 0; i < 3 * c->n; i++)
    c->load[i] +=
        c->config.rho * bw_solid_volume_of(c->solid, i / 3) / dt * (U[i] - c->iteration.inside[i]);
}

/* By how much the load would change, over its own norm, if the surface moved on by the residual:
 * `residual` is its norm, `step` that of what changed the guess since the try before. */
static double load_residual(bw_coupler *c, double residual, double step)
{
  bw_coupler__iteration *t = &c->iteration;
  double sums[2] = {0.0, 0.0};
  for (size_t i = 0; i < 3 * c->n; i++) {
    const double change = c->load[i] - t->load[i];
    sums[0] += change * change;
    sums[1] += c->load[i] * c->load[i];
  }
  bw_comm_sum(bw_solid_comm(c->solid), 2, sums);
  memcpy(t->load, c->load, 3 * c->n * sizeof *t->load);
  if (residual == 0.0) return 0.0;
  /* The first try shows no slope. */
  return c->iterations == 1 ? INFINITY : residual * sqrt(sums[0] / fmax(sums[1], 1e-300)) / step;
}

/* The solid's answer to the guess, less the guess; its norm, and over that of the answer. */
static double compare(bw_coupler *c, double dt, double *norm)
{
  bw_coupler__iteration *t = &c->iteration;
  double *V = c->scratch[0], sums[2] = {0.0, 0.0};
  /* The solid has answered: X_{n+1}, V_{n+1}. */
  bw_solid_get_position(c->solid, c->X);
  bw_coupler__marker_velocity(c, V);
  /* theta (X_{n+1} - X_n)/dt + (1 - theta) V_{n+1}, per particle. */
  for (size_t i = 0; i < 3 * c->n; i++)
    t->answer[i] =
        BW_COUPLER__THETA * (c->X[i] - t->X[i]) / dt + (1.0 - BW_COUPLER__THETA) * c->V[i];
  /* At the markers: the same change as of the particle, on top of what its spin adds. */
  for (size_t q = 0; q < c->n_surface; q++)
    for (size_t d = 0; d < 3; d++) {
      const size_t i = 3 * q + d, p = 3 * (size_t)c->particle[q] + d;
      const double answer = V[i] + t->answer[p] - c->V[p];
      t->residual[i] = answer - t->guess[i];
      sums[0] += t->residual[i] * t->residual[i];
      sums[1] += answer * answer;
    }
  /* Relative to the answer, over all ranks. */
  bw_comm_sum(bw_solid_comm(c->solid), 2, sums);
  *norm = sqrt(sums[0]);
  return sums[0] > 0.0 ? sqrt(sums[0] / fmax(sums[1], 1e-300)) : 0.0;
}

/* out[i] = q_i.a for each column, and a.a behind them, over all ranks. */
static void project(const bw_coupler *c, const double a[], double out[])
{
  const bw_coupler__iteration *t = &c->iteration;
  /* One message for all scalar products, that with itself included. */
  for (int i = 0; i <= t->columns; i++) {
    const double *b = i < t->columns ? t->q[i] : a;
    out[i] = 0.0;
    for (size_t k = 0; k < 3 * c->n_surface; k++)
      out[i] += a[k] * b[k];
  }
  bw_comm_sum(bw_solid_comm(c->solid), t->columns + 1, out);
}

/* a -= sum_i f_i b_i */
static void subtract(const bw_coupler *c, const double f[], double *const b[], double a[])
{
  for (int i = 0; i < c->iteration.columns; i++)
    for (size_t k = 0; k < 3 * c->n_surface; k++)
      a[k] -= f[i] * b[i][k];
}

/* Behind the last column stand dV and the residual before: they join the columns. */
static void learn(bw_coupler *c)
{
  bw_coupler__iteration *t = &c->iteration;
  double f[BW_COUPLER__COLUMNS + 1], whole = 0.0, *q = t->q[t->columns], *d = t->d[t->columns];
  /* dr: the new residual less the one before. */
  for (size_t k = 0; k < 3 * c->n_surface; k++)
    q[k] = t->residual[k] - q[k];
  for (int pass = 0; pass < 2; pass++) { /* Gram and Schmidt; once more for their rounding */
    project(c, q, f);
    if (pass == 0) whole = sqrt(f[t->columns]);
    subtract(c, f, t->q, q);
    subtract(c, f, t->d, d);
  }
  project(c, q, f);
  /* What dr has that earlier columns do not. */
  const double left = sqrt(f[t->columns]);
  if (!(left > LEAST_NEW * whole)) return;
  /* q of length 1; d in the same combination, so that d is still the dV of this dr. */
  for (size_t k = 0; k < 3 * c->n_surface; k++)
    q[k] /= left, d[k] /= left;
  t->columns++;
}

/* Makes room for a column: the oldest goes. */
static void forget(bw_coupler__iteration *t)
{
  if (t->columns < t->room) return;
  double *q = t->q[0], *d = t->d[0];
  t->columns--;
  memmove(t->q, t->q + 1, (size_t)t->columns * sizeof *t->q);
  memmove(t->d, t->d + 1, (size_t)t->columns * sizeof *t->d);
  t->q[t->columns] = q, t->d[t->columns] = d;
}

/* The next guess; returns the norm of what it changes. */
static double improve(bw_coupler *c)
{
  bw_coupler__iteration *t = &c->iteration;
  const double omega = c->config.load_relaxation;
  double f[BW_COUPLER__COLUMNS + 1];
  forget(t);
  /* The next column's place takes this try's dV and residual, from which `learn` makes it. */
  double *rest = t->q[t->columns], *dV = t->d[t->columns];
  /* r = sum_i f_i q_i + rest: the first part is known to vanish with - sum_i f_i d_i. */
  project(c, t->residual, f);
  memcpy(rest, t->residual, 3 * c->n_surface * sizeof *rest);
  subtract(c, f, t->q, rest);
  /* Of the rest nothing is known: it is relaxed. */
  for (size_t k = 0; k < 3 * c->n_surface; k++)
    dV[k] = omega * rest[k];
  /* The quasi-Newton step for what is known. */
  subtract(c, f, t->d, dV);
  double squared = 0.0;
  for (size_t k = 0; k < 3 * c->n_surface; k++) {
    t->guess[k] += dV[k];
    squared += dV[k] * dV[k];
  }
  bw_comm_sum(bw_solid_comm(c->solid), 1, &squared);
  /* Kept for the difference with the residual of the next try. */
  memcpy(rest, t->residual, 3 * c->n_surface * sizeof *rest);
  return fmax(sqrt(squared), 1e-300);
}

/* Tries without a smaller residual than before them, after which there will be none: what is left
 * is rounding, and differences of rounding teach nothing but steps without bound. */
enum { STALLED = 8 };

bw_status bw_coupler__iterate(bw_coupler *c, double dt)
{
  bw_coupler__iteration *t = &c->iteration;
  const bw_coupler__work work = c->work;
  double norm = 0.0, step = 0.0, least = INFINITY;
  int best = 0; /* the try that had it */
  /* Every try begins here: fluid and solid at t, markers at the old surface. */
  bw_coupler__state_capture(c, &t->start);
  bw_solid_get_position(c->solid, t->X);
  /* The first guess: the surface moves on as it does. */
  memcpy(t->guess, c->marker_V, 3 * c->n_surface * sizeof *t->guess);
  BW_TRY(open_inside(c));
  /* Columns of earlier steps are not used, so that a restart repeats the step exactly. */
  t->columns = 0;
  for (c->iterations = 1;; c->iterations++) {
    /* Work is that of the try that counts, the last one. */
    c->work = work;
    BW_TRY(give_guess(c));
    BW_TRY(bw_coupler__advance_fluid(c, dt));
    BW_TRY(bw_coupler__load_solid(c, dt, 1.0));
    BW_TRY(bw_coupler__advance_solid(c, dt, 1.0));
    /* Does the surface move as the fluid was told, and is its load that of this motion? */
    c->residual = compare(c, dt, &norm);
    const double load = load_residual(c, norm, step);
    c->residual = fmax(c->residual, load * load);
    if (c->residual <= c->config.coupling_residual) break;
    if (c->residual < least) least = c->residual, best = c->iterations;
    if (c->iterations - best == STALLED) break;
    if (c->iterations == c->config.coupling_iterations) break;
    /* From the second try on there is a difference to learn from. */
    if (c->iterations > 1) learn(c);
    step = improve(c);
    /* Back to t for another try; the last one is not undone. */
    BW_TRY(bw_coupler__state_restore(c, &t->start));
  }
  /* A step that used up its tries, or came no nearer, is counted, not refused: the report tells. */
  c->unconverged += c->residual > c->config.coupling_residual;
  memcpy(c->V_before, t->answer, 3 * c->n * sizeof *c->V_before); /* what the fluid was told */
  return BW_OK;
}
