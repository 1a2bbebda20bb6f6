/* What holds: how the fluid answers to the motion of this surface, and the relaxation that follows.
 *
 * Explicit steps see the load of the motion before. Let the surface move by the shape v, and jump:
 * in step k after it the load is -G_k v dV/dt. A load L makes the solid move by A L within a step
 * (its own step, with its bonds and sub-steps). Of S_k = A G_k/dt, which have no unit, everything
 * follows: with b the change of the surface's velocity from step to step,
 *   b_{n+1} = y_n,   y_n = (1 - W) y_{n-1} - W sum_k S_k b_{n-k},   W = w E,
 * where the virtual mass m_v = w mu m (bw_coupler.h) lets the share E = (1 - exp(-w mu))/(w mu) of
 * a load through in its own step, and owes the rest, so that it acts like a smaller w:
 * W = (1 - exp(-w mu))/mu. With a predictor there is none, and the fluid is told another b
 * (predictor.c). Held in one mode, S_k = lambda_k: numbers. The trial b_n = z^n, without one, gives
 *   (z - 1 + W) + W sum_k lambda_k z^-k = 0,
 * whose roots have to stay inside the unit circle. All of it in the first step leaves it at z = -1,
 * W = 2/(1 + lambda_0); a late answer leaves it earlier, as a slow swing. An elastic mode of
 * frequency omega has its lambda times sin(omega dt)/(omega dt): the free one is the strictest.
 *
 * Two shapes are looked at, by power iteration from the present state: that of the largest
 * lambda_0 (S_0: a tip against the fluid beside it), and that of the largest sum over LATE steps
 * (sum of S_k: a plate against all that it moves, most of which comes late; A is then that of as
 * many steps, so that what is stiff within them counts as stiff). Displacements tell A: they are
 * positive, however fast a motion is. Of each shape the answer over MEMORY steps is found and its
 * recurrence followed, with a drag behind it that lasts, where its end shows one; the smaller limit
 * counts. What else such a memory cuts off may turn a decay into a growth of less than one over its
 * length a step: that much is let pass (validation: coupler.added_mass).
 *
 * The fluid's answer is that of its own step, with walls, memory of the forcing, other bodies,
 * about the flow of now; what the same steps would have given without v is subtracted. Velocities
 * are 1e-3 cells a step and loads a hundredth of theirs, all of it in single precision.
 *
 * Iterated steps are the user's choice: a thin plate of a tenth of the fluid's density holds with
 * w = 0.005 and does not iterated (docs/verification/coupler).
 *
 * What neither shape knows is tried: steps that are coupled with w, markers staying where they are,
 * with a rough disturbance of the surface's velocity and without, from twice the w that would be
 * taken at most down by halves. So the breathing of a plate between its faces is found, whose load
 * by the reaction is that of the fluid which the grid has inside: stiff, of some five steps, and
 * fed as its answer is late. Where a bond breaks on the way nothing is told by it.
 *
 * Everything is done on the state of the run, which is captured before and put back after. */
#include "bw_memory.h"
#include "bw_mix.h"
#include "coupler_internal.h"
#include "rigid_joined.h"

#include <math.h>
#include <string.h>

enum { MEMORY = 40, LATE = 12, FIRST_TRIES = 8, LATE_TRIES = 4, TRIAL = 120, WINDOW = 30 };
static const double MOVED = 1e-3; /* of a cell in a step: how fast the surface is made to move */

/* Surface points (n_s,3), particles (n,3). */
typedef struct {
  bw_coupler *c;
  double dt, speed, part; /* of the surface; share of a load that is tried */
  bw_coupler__state start;
  double *V0, *v;     /* (n_s,3) velocity of the markers; shape of the disturbance, 1 at most */
  double *base;       /* (TRIAL, n_s,3) forces, or velocities, without it */
  double *sum, *sum0; /* (n,3) loads of the particles, summed over steps; without it */
  double *answer, *answer0; /* (n_s,3) velocities with which the solid answers */
} experiment;

static void release(experiment *e)
{
  double **const all[] = {&e->V0, &e->v, &e->base, &e->sum, &e->sum0, &e->answer, &e->answer0};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_coupler__state_release(&e->start);
}

static bw_status make_room(experiment *e)
{
  const size_t n_s = 3 * e->c->n_surface, n = 3 * e->c->n;
  BW_TRY(bw_coupler__state_create(e->c, &e->start));
  BW_TRY(BW_ALLOCATE(&e->V0, n_s));
  BW_TRY(BW_ALLOCATE(&e->v, n_s));
  BW_TRY(BW_ALLOCATE(&e->base, TRIAL * n_s));
  BW_TRY(BW_ALLOCATE(&e->sum, n));
  BW_TRY(BW_ALLOCATE(&e->sum0, n));
  BW_TRY(BW_ALLOCATE(&e->answer, n_s));
  return BW_ALLOCATE(&e->answer0, n_s);
}

double bw_coupler_limit_bytes(const bw_coupler *c)
{
  /* As make_room has it, all particles surface; a state's rows of the solid are its restart's. */
  const double vectors = (3.0 * (TRIAL + 4.0) + 15.0) * (double)c->n;
  const double rows = (double)bw_solid_restart_row(c->solid) * (double)c->n;
  return sizeof(double) * (vectors + rows) +
         (double)(c->n * bw_solid_bits_bytes(c->solid)); /* fields: four of the grid's */
}

/* The markers move by V0 + speed v from now on. Collective. */
static bw_status move(experiment *e, double speed)
{
  bw_coupler *c = e->c;
  double *V = c->force; /* scratch until the load is read */
  for (size_t q = 0; q < 3 * c->n_surface; q++)
    V[q] = e->V0[q] + speed * e->v[q];
  bw_coupler__tell_surface(c, V);
  memcpy(c->marker_V, V, 3 * c->n_surface * sizeof *V);
  c->markers_moved = true;
  return c->block > 1 ? bw_coupler__blocks_follow(c) : BW_OK;
}

/* So many steps of the fluid from the state of now, around a surface that moves by V0 + speed v
 * where it is: e->sum <- the loads of all of them; with p (steps), NULL: not, power of step k's
 * force along v less that without v; without, forces are kept as those without v. Collective. */
static bw_status flow(experiment *e, double speed, int steps, double p[])
{
  bw_coupler *c = e->c;
  const bool probes = c->config.load == BW_LOAD_PROBES;
  const size_t n_s = 3 * c->n_surface;
  BW_TRY(bw_coupler__state_restore(c, &e->start));
  memset(e->sum, 0, 3 * c->n * sizeof *e->sum);
  for (int k = 0; k < steps; k++) {
    BW_TRY(move(e, speed));
    BW_TRY(bw_coupler__advance_fluid(c, e->dt));
    if (probes) BW_TRY(bw_coupler__probe_force(c, e->dt));
    if (!probes) bw_coupler__reaction_force(c);
    double *base = e->base + (size_t)k * n_s;
    if (speed == 0.0 && n_s > 0) memcpy(base, c->force, n_s * sizeof *base);
    if (p != NULL) p[k] = 0.0;
    for (size_t q = 0; p != NULL && q < n_s; q++)
      p[k] += (c->force[q] - base[q]) * e->v[q] / speed;
    bw_coupler__carry_force(c, !probes);
    for (size_t i = 0; i < 3 * c->n; i++)
      e->sum[i] += c->load[i];
    bw_coupler__remember(c);
    /* The jump is over: what probes take for its acceleration was that of one step. */
    if (c->n > 0) memcpy(c->V_before, c->V, 3 * c->n * sizeof *c->V);
  }
  if (p != NULL) bw_comm_sum(bw_solid_comm(c->solid), steps, p);
  return BW_OK;
}

/* out (n_s,3) <- twice the displacement over so many steps under the load of now and `part` of
 * e->sum less e->sum0, over their number and time: what a free mass would change its velocity by in
 * one. Collective. */
static bw_status answer(experiment *e, int steps, double part, double out[])
{
  bw_coupler *c = e->c;
  BW_TRY(bw_solid_set_bits(c->solid, e->start.bits));
  BW_TRY(bw_solid_set_restart(c->solid, e->start.rows, e->start.sums));
  for (size_t i = 0; i < 3 * c->n; i++)
    c->F[i] = e->start.F[i] + part * (e->sum[i] - e->sum0[i]) / bw_solid_volume_of(c->solid, i / 3);
  bw_coupler__push_solid(c);
  BW_TRY(bw_solid_set_drag(c->solid, 0, NULL, NULL, NULL));
  const int n = steps * bw_coupler_substeps(c, e->dt);
  bw_solid_get_position(c->solid, c->X);
  for (size_t q = 0; q < 3 * c->n_surface; q++)
    out[q] = -c->X[3 * (size_t)c->particle[q / 3] + q % 3];
  for (int q = 0; q < n; q++)
    BW_TRY(bw_coupler__step_solid(c, steps * e->dt / n));
  bw_solid_get_position(c->solid, c->X);
  for (size_t q = 0; q < 3 * c->n_surface; q++)
    out[q] =
        2.0 * (out[q] + c->X[3 * (size_t)c->particle[q / 3] + q % 3]) / (steps * steps * e->dt);
  c->motion_known = false;
  return BW_OK;
}

/* Sums over all ranks and surface points of v.v, v.s, and the largest |s|. Collective. */
static void compare(const experiment *e, const double s[], double sum[2], double *most)
{
  sum[0] = sum[1] = *most = 0.0;
  for (size_t q = 0; q < 3 * e->c->n_surface; q++) {
    sum[0] += e->v[q] * e->v[q];
    sum[1] += e->v[q] * s[q];
    *most = fmax(*most, fabs(s[q]));
  }
  bw_comm_sum(bw_solid_comm(e->c->solid), 2, sum);
  bw_comm_max(bw_solid_comm(e->c->solid), 1, most);
}

/* *lambda <- that of v under the sum of S_k over so many steps, v <- what came of it, of which 1 is
 * the largest component. v stays where nothing moves. Collective. */
static bw_status power(experiment *e, int steps, double *lambda)
{
  double sum[2], most;
  BW_TRY(flow(e, e->speed, steps, NULL));
  BW_TRY(answer(e, steps, e->part, e->answer));
  for (size_t q = 0; q < 3 * e->c->n_surface; q++)
    e->answer[q] = (e->answer[q] - e->answer0[q]) / (e->part * e->speed);
  compare(e, e->answer, sum, &most);
  *lambda = sum[0] > 0.0 ? -sum[1] / sum[0] : 0.0;
  for (size_t q = 0; most > 0.0 && q < 3 * e->c->n_surface; q++)
    e->v[q] = -e->answer[q] / most;
  return BW_OK;
}

/* A shape to begin with: the same on any number of ranks, of all directions, partly rough. */
static void begin_shape(experiment *e, double rough)
{
  const bw_coupler *c = e->c;
  const bool planar = bw_ns_channel_velocity(c->fluid)[2] == NULL;
  for (size_t q = 0; q < c->n_surface; q++)
    for (size_t d = 0; d < 3; d++) {
      const uint64_t id = 3 * (uint64_t)c->id[c->particle[q]] + d + 1;
      const double noise = (double)(bw_mix(id) >> 11) * 0x1p-52 - 1.0;
      e->v[3 * q + d] = d == 2 && planar ? 0.0 : (1.0 - rough) * 0.6 + rough * noise;
    }
}

/* The limit of the shape that power iteration over sums of `steps` steps leads to. Collective. */
static bw_status limit_of_shape(experiment *e, int steps, int tries, double *limit, double *sum)
{
  const bw_coupler *c = e->c;
  double lambda = 0.0, p[MEMORY], l[MEMORY], area = 0.0, whole = 0.0;
  *limit = 1.0, *sum = 0.0;
  /* What the solid does by itself. The forces without v are known by now, not their sum. */
  BW_TRY(flow(e, 0.0, steps, NULL));
  memcpy(e->sum0, e->sum, 3 * c->n * sizeof *e->sum);
  BW_TRY(answer(e, steps, 0.0, e->answer0));
  for (int q = 0; q < tries; q++)
    BW_TRY(power(e, steps, &lambda));
  BW_TRY(flow(e, e->speed, MEMORY, p));
  for (int k = 0; k < steps; k++)
    whole += p[k];
  /* Nothing moves, or nothing resists. */
  if (!(lambda > 0.0) || !(whole < 0.0) || !(p[0] < 0.0)) return BW_OK;
  for (int k = 0; k < MEMORY; k++)
    l[k] = lambda * p[k] / whole;
  for (size_t q = 0; q < 3 * c->n_surface; q++)
    area += c->area[q / 3] * e->v[q] * e->v[q];
  bw_comm_sum(bw_solid_comm(c->solid), 1, &area);
  const double virtual_mass = c->config.predictor ? 0.0 : c->config.virtual_mass;
  const double mu = virtual_mass * c->config.rho * c->h * area * l[0] / (-p[0] * e->dt);
  *limit = bw_coupler__relaxation_limit(MEMORY, l, mu, c->config.predictor);
  *sum = 0.0;
  for (int k = 0; k < LATE; k++)
    *sum += l[k];
  return BW_OK;
}

/* Coupled steps with w from the state of now, markers staying where they are, the surface's
 * particles first faster by speed v: velocities of the surface without v are kept, with it square
 * sums of its second differences, in which slow motions do not count, over windows. *broke: did a
 * bond break? Collective. */
static bw_status run_coupled(experiment *e, double w, double speed, double square[], bool *broke)
{
  bw_coupler *c = e->c;
  const size_t n_s = 3 * c->n_surface;
  double *V = e->sum0, *X = e->sum; /* (n,3) */
  memset(square, 0, TRIAL / WINDOW * sizeof *square);
  BW_TRY(bw_coupler__state_restore(c, &e->start));
  bw_solid_get_position(c->solid, X);
  bw_solid_get_velocity(c->solid, V);
  for (size_t q = 0; q < n_s; q++)
    V[3 * (size_t)c->particle[q / 3] + q % 3] += speed * e->v[q];
  bw_solid_set_state(c->solid, X, V);
  double events = (double)bw_solid_events(c->solid);
  for (int k = 0; k < TRIAL; k++) {
    bw_coupler__marker_velocity(c, c->marker_V);
    c->markers_moved = true;
    if (c->block > 1) BW_TRY(bw_coupler__blocks_follow(c));
    BW_TRY(bw_coupler__predict(c, e->dt));
    BW_TRY(bw_coupler__advance_fluid(c, e->dt));
    BW_TRY(bw_coupler__load_solid(c, e->dt, w));
    BW_TRY(bw_coupler__advance_solid(c, e->dt, w));
    bw_coupler__remember(c);
    bw_solid_get_velocity(c->solid, V);
    double *base = e->base + (size_t)k * n_s;
    for (size_t q = 0; q < n_s; q++) {
      const double now = V[3 * (size_t)c->particle[q / 3] + q % 3];
      if (speed == 0.0) {
        base[q] = now;
        continue;
      }
      const double more = now - base[q], bend = more - 2.0 * e->answer[q] + e->answer0[q];
      if (k > 1) square[k / WINDOW] += bend * bend;
      e->answer0[q] = e->answer[q], e->answer[q] = more;
    }
  }
  events = (double)bw_solid_events(c->solid) - events;
  bw_comm_max(bw_solid_comm(c->solid), 1, &events);
  *broke = *broke || events > 0.0;
  bw_comm_sum(bw_solid_comm(c->solid), TRIAL / WINDOW, square);
  return BW_OK;
}

/* Does a rough disturbance decay with w? Where bonds break on the way nothing is said against it.
 * Collective. */
static bw_status try_relaxation(experiment *e, double w, bool *holds)
{
  static const double grown = 1.5, nothing = 1e-6; /* of squares: 0.7 % a step; of the first */
  enum { LAST = TRIAL / WINDOW - 1 };
  double square[TRIAL / WINDOW];
  bool broke = false;
  begin_shape(e, 0.9);
  bw_status st = run_coupled(e, w, 0.0, square, &broke);
  BW_THEN(st, run_coupled(e, w, e->part * e->speed, square, &broke));
  *holds = broke || (st == BW_OK && (square[LAST] <= grown * square[LAST - 1] ||
                                     square[LAST] <= nothing * square[0]));
  return st == BW_ECFL || st == BW_EDIVERGED ? BW_OK : st;
}

static bw_status experiment_run(experiment *e, bw_coupler_limit *out)
{
  static const int steps[2] = {1, LATE}, tries[2] = {FIRST_TRIES, LATE_TRIES};
  BW_TRY(flow(e, 0.0, MEMORY, NULL));
  out->relaxation = 1.0;
  for (int q = 0; q < 2; q++) {
    double limit, added;
    begin_shape(e, q == 0 ? 0.7 : 0.3);
    BW_TRY(limit_of_shape(e, steps[q], tries[q], &limit, &added));
    if (q > 0 && limit >= out->relaxation) continue;
    *out = (bw_coupler_limit){.relaxation = limit, .added = added, .late = q > 0};
  }
  /* What neither shape knows: down by halves from twice what would be taken at most. */
  bool holds = false;
  double w = fmin(out->relaxation, bw_coupler__most(e->c) / BW_COUPLER__MARGIN);
  for (int halves = 0; halves < 8 && !holds; halves++) {
    BW_TRY(try_relaxation(e, w, &holds));
    if (!holds) out->relaxation = w *= 0.5;
  }
  return BW_OK;
}

bw_status bw_coupler_find_limit(bw_coupler *c, double dt, bw_coupler_limit *out)
{
  const bw_comm *comm = bw_solid_comm(c->solid);
  const bool stepped = c->stepped, fine = BW_REAL_EPSILON < 1e-10;
  const bw_coupler__work work = c->work; /* a restore leaves it */
  experiment e = {.c = c, .dt = dt, .speed = MOVED * c->h / dt, .part = fine ? 0.01 : 1.0};
  *out = (bw_coupler_limit){.relaxation = NAN, .added = NAN};
  bw_status st = bw_comm_agree(comm, make_room(&e));
  if (st == BW_OK) {
    bw_coupler__state_capture(c, &e.start);
    memcpy(e.V0, c->marker_V, 3 * c->n_surface * sizeof *e.V0);
    st = experiment_run(&e, out);
    /* A flow or a solid that is about to fail is not judged here: the step will tell. */
    if (st == BW_ECFL || st == BW_EDIVERGED) st = BW_OK;
    BW_THEN(st, bw_coupler__state_restore(c, &e.start));
    memcpy(c->marker_V, e.V0, 3 * c->n_surface * sizeof *e.V0);
    if (st == BW_OK) bw_coupler__know_motion(c); /* velocities of now, too */
    if (st == BW_OK && c->block > 1) st = bw_coupler__blocks_follow(c);
    c->markers_moved = true;
    c->stepped = stepped;
    c->work = work;
  }
  release(&e);
  return st;
}
