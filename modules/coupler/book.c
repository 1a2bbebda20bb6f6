/* The book of the coupling: what fluid and solid say of the work between them, over windows of
 * steps, and what is no physics any more.
 *
 * The load L of the flow, at the surface's velocity V that the fluid was told, gives dt L.V in a
 * step. The solid receives the work of what it feels, F' and the drag of the virtual mass, over its
 * own displacement dX; relaxation and drag hold back the rest. So given = received + held back but
 * for sum F'.(V dt - dX): the fluid was told a sample of the motion, or a mean of it, not the
 * motion. This is of the order of the step where the motion is resolved, and what a coupling makes
 * out of nothing where it is not. By probes the load is not the markers' reaction: what the fluid
 * loses and no probe sees is told apart (report: work_unseen), and the book is that of the load.
 *
 * The size of the load is no sign by itself: a small vibration of amplitude x and frequency omega
 * brings rho L omega^2 x, L the body's size, which is L/x times rho (omega x)^2. */
#include "bw_coupler.h"
#include "coupler_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const int LENGTH[BW_COUPLER__WINDOWS] = {50, 500}; /* steps */
static const double CLOSED = 0.05;   /* of the work given or the energy held: closed below */
static const double OPEN = 0.5;      /* above: by all of it, which needs no second look */
static const double SWINGING = -0.8; /* correlation of successive changes of the velocity: -1 where
                                        it changes its sign every step, -0.5 of noise */
static const double STIRRED = 1e-3; /* kinetic energy over the energy held, from which it matters */
static const double GROWN = 1.5;    /* of a window over the one before */
static const double NOTHING = 1e-4; /* of the stream's energy in the solid's volume: waves of the
                                        lattice that a start leaves are less */

enum { MISSED, GIVEN, RECEIVED, CHANGE, PRODUCT, KINETIC, LATE };
enum { BOOK, SWING, KINDS };

void bw_coupler__book_open(bw_coupler *c)
{
  if (!c->config.check_book && !c->config.count_work) return;
  bw_solid_get_position(c->solid, c->book.X);
}

void bw_coupler__book_motion(bw_coupler *c, double dt)
{
  const bool iterated = c->config.coupling_iterations > 1;
  double *X = c->X, *V = c->scratch[0];
  c->book.missed = c->book.received = 0.0;
  if (!c->config.check_book && !c->config.count_work && !c->config.predictor) return;
  bw_solid_get_position(c->solid, X);
  /* The fluid was told the velocity of the beginning; iterated, BW_COUPLER__THETA of the
   * displacement and the rest of the velocity at the end (iterate.c). */
  if (iterated) bw_solid_get_velocity(c->solid, V);
  const double *told = iterated ? V : c->V_before;
  const double share = iterated ? 1.0 - BW_COUPLER__THETA : 1.0;
  for (size_t i = 0; i < 3 * c->n; i++) {
    const double F = bw_solid_volume_of(c->solid, i / 3) * c->F[i], moved = X[i] - c->book.X[i];
    c->book.missed += share * F * (told[i] * dt - moved);
    c->book.received += F * moved;
    if (c->lag != NULL) c->lag[i] += moved - told[i] * dt;
  }
}

/* What the step changed of each particle's velocity, against what the step before did. */
static void add_motion(bw_coupler *c, double sum[])
{
  double *V = c->X, *last = c->book.V, *change = c->book.change;
  bw_solid_get_velocity(c->solid, V);
  for (size_t i = 0; i < c->n; i++) {
    const double mass = bw_solid_volume_of(c->solid, i) * bw_solid_density(c->solid, i);
    for (size_t q = 3 * i; q < 3 * i + 3; q++) {
      const double now = V[q] - last[q];
      sum[CHANGE] += mass * now * now;
      sum[PRODUCT] += mass * now * change[q];
      sum[KINETIC] += 0.5 * mass * V[q] * V[q];
      change[q] = now;
      last[q] = V[q];
    }
  }
}

static void add_step(bw_coupler *c)
{
  double sum[BW_COUPLER__BOOK_SUMS] = {
      [MISSED] = c->book.missed, [GIVEN] = c->book.load, [RECEIVED] = c->book.received};
  add_motion(c, sum);
  for (int w = 0; w < BW_COUPLER__WINDOWS; w++) {
    /* What of CHANGE belongs to the second half of the window tells whether it grows within it. */
    const bool late = c->book.steps % LENGTH[w] >= LENGTH[w] / 2;
    sum[LATE] = late ? sum[CHANGE] : 0.0;
    for (int q = 0; q < BW_COUPLER__BOOK_SUMS; q++)
      c->book.window[w].sum[q] += sum[q];
  }
}

/* What of a window, or of the begun one, is no physics; `before`: the window before, NULL: not
 * known. Collective. */
typedef struct {
  bool wrong[KINDS], open; /* of each kind; the book, by all of it */
} verdict;

static verdict judge(bw_coupler *c, const double sum[], const double before[], double steps)
{
  const double U = bw_coupler__reference_speed(c), held = bw_solid_held(c->solid);
  const double solid = bw_solid_volume(c->solid) * (double)bw_solid_total(c->solid);
  const double nothing = NOTHING * 0.5 * c->config.rho * U * U * solid;
  const double turned = fmax(fabs(sum[GIVEN]), held) + nothing, missed = fabs(sum[MISSED]);
  const bool known = before != NULL, stirred = sum[KINETIC] > steps * (STIRRED * held + nothing);
  /* A body that rings while it settles also misses work, but less and less of it. */
  const bool rises = sum[LATE] > GROWN * (sum[CHANGE] - sum[LATE]);
  verdict v = {.open = missed > OPEN * turned && stirred && rises};
  v.wrong[BOOK] = known && stirred && missed > CLOSED * turned && missed > fabs(before[MISSED]);
  v.wrong[SWING] = known && stirred && sum[PRODUCT] < SWINGING * sum[CHANGE] &&
                   sum[CHANGE] > GROWN * before[CHANGE];
  return v;
}

static const char *remedy(const bw_coupler *c)
{
  return c->config.coupling_iterations > 1
             ? "take smaller steps or a smaller coupling_residual"
             : "take a smaller load_relaxation, or coupling_iterations of 50, or smaller steps";
}

static bw_status stop(const bw_coupler *c, int kind, const double sum[], int steps)
{
  char what[256];
  const long long since = (long long)c->book.steps - (kind == BOOK ? 1 : 2) * steps;
  if (kind == BOOK)
    snprintf(what, sizeof what,
             "in the last %d steps the fluid's load gave %.3g and the solid received %.3g; %.3g of "
             "work comes from nowhere",
             steps, sum[GIVEN], sum[RECEIVED], -sum[MISSED]);
  else
    snprintf(what, sizeof what,
             "velocities of the solid change their sign with every step and grow: its mean kinetic "
             "energy in the last %d steps was %.3g",
             steps, sum[KINETIC] / steps);
  return BW_FAIL(BW_EDIVERGED,
                 "the coupling of fluid and solid is no physics since step %lld of this run or "
                 "before: %s; %s",
                 since > 0 ? since : 0, what, remedy(c));
}

/* A window ends. */
static bw_status end_window(bw_coupler *c, int which)
{
  enum { IN_A_ROW = 2 };
  bw_coupler__window *w = &c->book.window[which];
  double sum[BW_COUPLER__BOOK_SUMS];
  memcpy(sum, w->sum, sizeof sum);
  bw_comm_sum(bw_solid_comm(c->solid), BW_COUPLER__BOOK_SUMS, sum);
  memset(w->sum, 0, sizeof w->sum);
  /* The first window has none before it to compare with. */
  const bool first = c->book.steps == LENGTH[which];
  const verdict v = judge(c, sum, first ? NULL : w->last, LENGTH[which]);
  memcpy(w->last, sum, sizeof sum);
  for (int kind = 0; kind < KINDS; kind++) {
    w->strikes[kind] = v.wrong[kind] ? w->strikes[kind] + 1 : 0;
    if (w->strikes[kind] >= IN_A_ROW || (kind == BOOK && v.open))
      return stop(c, kind, sum, LENGTH[which]);
  }
  return BW_OK;
}

bw_status bw_coupler__book_close(bw_coupler *c)
{
  c->work.received += c->book.received;
  if (!c->config.check_book) return BW_OK;
  add_step(c);
  c->book.steps++;
  for (int w = 0; w < BW_COUPLER__WINDOWS; w++)
    if (c->book.steps % LENGTH[w] == 0) BW_TRY(end_window(c, w));
  return BW_OK;
}

bw_status bw_coupler__book_explain(bw_coupler *c, bw_status cause)
{
  const bool diverged = cause == BW_EDIVERGED || cause == BW_ECFL;
  if (!diverged || c->held || !c->config.check_book || c->book.steps == 0) return cause;
  char what[512];
  double sum[BW_COUPLER__BOOK_SUMS];
  const int64_t begun = c->book.steps % LENGTH[0];
  /* The window that has begun, or the one that has just ended. */
  const bool fresh = begun > 0;
  memcpy(sum, fresh ? c->book.window[0].sum : c->book.window[0].last, sizeof sum);
  if (fresh) bw_comm_sum(bw_solid_comm(c->solid), BW_COUPLER__BOOK_SUMS, sum);
  const double missed = fabs(sum[MISSED]), given = fabs(sum[GIVEN]);
  const bool swings = sum[PRODUCT] < SWINGING * sum[CHANGE];
  if (!swings && !(missed > OPEN * given)) return cause;
  snprintf(what, sizeof what, "%s", bw_last_message());
  return BW_FAIL(cause,
                 "%s. The coupling of fluid and solid is the likely cause: in the last steps the "
                 "load gave %.3g, %.3g of work came from nowhere%s; %s",
                 what, sum[GIVEN], -sum[MISSED],
                 swings ? ", velocities changed their sign with every step" : "", remedy(c));
}

bool bw_coupler_sound(const bw_coupler *c)
{
  for (int w = 0; w < BW_COUPLER__WINDOWS; w++)
    for (int kind = 0; kind < KINDS; kind++)
      if (c->book.window[w].strikes[kind] > 0) return false;
  return true;
}
