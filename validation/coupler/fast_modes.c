/* Claim: explicit coupling feeds elastic motions faster than two steps, as its recurrence says;
 * with the virtual mass it feeds none, and told the mean velocity of the step, neither.
 *
 * One particle stands on a body that is held, in fluid at rest (closed box, plane): an oscillator,
 * undamped, whose frequency times the step, theta, is chosen by Young's modulus, once along the
 * face and once away from it. Fluid and solid meet once in a step, so that the fluid sees a sample
 * of its velocity: a motion with theta between pi and 2 pi looks like a slower one that runs
 * backwards in time, and what damps the one feeds the other (bw_coupler.h).
 * Measured   growth of its energy per step, half the logarithm, over 200 steps, for both loads.
 * Reference  the recurrence: the oscillator by itself, loaded by
 *            -sum_k g_k (V_{n-k} - V_{n-k-1})/dt as the coupler loads it, with g measured on a
 *            particle so heavy that nothing stops it.
 * Tolerance  without virtual mass, by the reaction: 5 %. Couples on the line elements that tell the
 *            particle's spin and markers that move with it, of 1e-3 cells, are not in g; growth is
 *            taken from the largest energies of 20 steps, which hold half a beat of the slowest
 *            alias (theta = 5.8: 13 steps). By probes no claim: they read the acceleration of the
 *            surface from the solid, which a particle that was set moving does not show.
 *            With it: largest growth 0; 1e-4, e in 10 000 steps, is what such windows of an energy
 *            that beats by 1 % leave.
 * Predictor  no virtual mass; the fluid is told the mean velocity that the oscillator would have
 *            in the step under its last load. Largest growth as above; the strongest damping is
 *            that of the recurrence, to the same 5 % by the reaction.
 * BUILD modules=coupler,shape
 * TEST  ranks=1 */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 32, STEPS = 200, MEMORY = STEPS, WINDOW = 20 };
static const double H = 1.0 / CELLS, DT = 2e-3, NU = 1e-2, DENSITY = 3.0, HEAVY = 1e6, W = 0.1,
                    SPEED = 1e-3;
static const double TOP = 20.0 / CELLS; /* of the body that is held */

typedef struct {
  bw_coupler_load_kind load;
  int along; /* direction of the motion */
  double E, virtual_mass;
  bool predictor;
  double density;
} set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  size_t n, tip; /* particles; the one that moves */
  double *X, *V;
} scene;

static void destroy(scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
  bw_release(&s->X);
  bw_release(&s->V);
}

static bw_status make_solid(const bw_comm *comm, const set_up *b, scene *s)
{
  const bw_shape shape[2] = {{.kind = BW_SHAPE_BOX,
                              .lower = {15 * H, TOP},
                              .upper = {16 * H, TOP + H, H},
                              .particle_kind = BW_PD_FREE},
                             {.kind = BW_SHAPE_BOX,
                              .lower = {12 * H, TOP - 8 * H},
                              .upper = {20 * H, TOP, H},
                              .particle_kind = BW_PD_PRESCRIBED}};
  bw_solid_config m = bw_solid_config_default();
  m.geometry = BW_PD_PLANE_STRAIN;
  m.ds = m.thickness = H;
  m.rho = b->density;
  m.E = b->E;
  m.origin[2] = 0.5 * H;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(H, m.origin, true);
  bw_status st = bw_shape_fill(2, shape, &lattice, 0, 1, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create_same(comm, &m, n, site, kind, &s->solid));
  bw_release(&site);
  bw_release(&kind);
  if (st != BW_OK) return st;
  s->n = bw_solid_count(s->solid);
  BW_TRY(BW_ALLOCATE(&s->X, 3 * s->n));
  BW_TRY(BW_ALLOCATE(&s->V, 3 * s->n));
  bw_solid_get_position(s->solid, s->X);
  for (size_t i = 0; i < s->n; i++)
    if (s->X[3 * i + 1] > TOP) s->tip = i;
  s->V[3 * s->tip + (size_t)b->along] = SPEED;
  return BW_OK;
}

static bw_status create(const bw_comm *comm, const set_up *b, scene *s)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  bw_coupler_config c = bw_coupler_config_default();
  *s = (scene){0};
  grid.n[0] = grid.n[1] = CELLS, grid.n[2] = 1;
  grid.length[0] = grid.length[1] = 1.0, grid.length[2] = H;
  grid.periodic[2] = true;
  grid.halo = 2;
  fluid.nu = NU;
  fluid.side[2][0].kind = fluid.side[2][1].kind = BW_SIDE_PERIODIC;
  c.rho = 1.0;
  c.nu = NU;
  c.load = b->load;
  c.load_relaxation = b->density == HEAVY ? 1.0 : W;
  c.virtual_mass = b->virtual_mass;
  c.predictor = b->predictor;
  c.check_book = false; /* growth is what is measured */
  BW_TRY(bw_grid_create(comm, &grid, &s->grid));
  BW_TRY(bw_ns_channel_create(s->grid, &fluid, &s->fluid));
  BW_TRY(make_solid(comm, b, s));
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
  bw_solid_set_state(s->solid, s->X, s->V);
  return BW_OK;
}

/* Square of the particle's frequency over Young's modulus. */
static bw_status stiffness(const bw_comm *comm, int along, double *out)
{
  static const double small = 1e-6; /* of a spacing: far below what bends the bonds */
  scene s;
  bw_status st = create(comm, &(set_up){.along = along, .E = 1.0, .density = DENSITY}, &s);
  if (st == BW_OK) {
    memset(s.V, 0, 3 * s.n * sizeof *s.V);
    s.X[3 * s.tip + (size_t)along] += small * H;
    bw_solid_set_state(s.solid, s.X, s.V);
    st = bw_solid_evaluate(s.solid);
    bw_solid_get_acceleration(s.solid, s.V);
    *out = -s.V[3 * s.tip + (size_t)along] / (small * H);
  }
  destroy(&s);
  return st;
}

/* g_k over the particle's mass: the answer to a jump of its velocity, told from what it does to a
 * particle so heavy that it goes on all but undisturbed, with bonds that do not hold it. */
static bw_status answer(const bw_comm *comm, set_up b, double g[MEMORY])
{
  scene s;
  b.density = HEAVY, b.E = 1.0;
  bw_status st = create(comm, &b, &s);
  const size_t at = 3 * s.tip + (size_t)b.along;
  BW_THEN(st, bw_coupler_step(s.coupler, DT)); /* the markers take the velocity at its end */
  for (int k = 0; st == BW_OK && k < MEMORY; k++) {
    bw_solid_get_velocity(s.solid, s.V);
    const double before = s.V[at];
    st = bw_coupler_step(s.coupler, DT);
    bw_solid_get_velocity(s.solid, s.V);
    g[k] = -(s.V[at] - before) / SPEED * HEAVY / DENSITY;
  }
  destroy(&s);
  return st;
}

/* Growth per step from the largest energies in two windows. */
typedef struct {
  double early, late;
} windows;

static void look(windows *w, int step, double energy)
{
  if (step >= STEPS / 10 && step < STEPS / 10 + WINDOW) w->early = fmax(w->early, energy);
  if (step >= STEPS - WINDOW) w->late = fmax(w->late, energy);
}

static double growth(const windows *w)
{
  return 0.5 * log(w->late / w->early) / (STEPS - WINDOW - STEPS / 10);
}

/* K steps of Verlet under F. */
static void swing(double F, double omega2, int K, double *x, double *v)
{
  const double dt = DT / K;
  for (int q = 0; q < K; q++) {
    *v += 0.5 * dt * (F - omega2 * *x);
    *x += dt * *v;
    *v += 0.5 * dt * (F - omega2 * *x);
  }
}

/* The recurrence: the oscillator with the load that the coupler would bring. */
static double foresee(const double g[MEMORY], double omega2, int K, bool predictor)
{
  double x = 0.0, v = SPEED, F = 0.0, lag = 0.0, told = 0.0, jump[STEPS]; /* of what is told */
  windows w = {0.0, 0.0};
  for (int n = 0; n < STEPS; n++) {
    double sum = 0.0, X = x, V = v;
    swing(F, omega2, K, &X, &V);
    const double now = predictor ? (X - x + 0.2 * lag) / DT : v, before = x;
    jump[n] = now - told;
    told = now;
    for (int k = 0; k < MEMORY && k <= n; k++)
      sum += g[k] * jump[n - k];
    F = (1.0 - W) * F - W * sum / DT;
    swing(F, omega2, K, &x, &v);
    lag += x - before - now * DT;
    look(&w, n, 0.5 * (v * v + omega2 * x * x));
  }
  return growth(&w);
}

static bw_status measured(const bw_comm *comm, const set_up *b, double *rate, int *K)
{
  scene s;
  windows w = {0.0, 0.0};
  bw_solid_ledger e = {.kinetic = NAN};
  bw_status st = create(comm, b, &s);
  if (st == BW_OK) *K = bw_coupler_substeps(s.coupler, DT);
  for (int n = 0; st == BW_OK && n < STEPS; n++) {
    st = bw_coupler_step(s.coupler, DT);
    BW_THEN(st, bw_solid_account(s.solid, &e));
    look(&w, n, e.kinetic + e.elastic);
  }
  *rate = growth(&w);
  destroy(&s);
  return st;
}

static const char *const load_name[] = {"probes", "reaction"};
static const char *const along_name[] = {"along the face", "away from it"};

/* The largest growth over all frequencies. */
static bw_status sweep(bw_validation *v, set_up b)
{
  static const double theta[] = {0.5, 1.0, 1.6, 2.2, 2.8, 3.1, 3.4, 4.0, 4.6, 5.2, 5.8, 6.6, 7.6};
  const bw_comm *comm = bw_validation_comm(v);
  double g[MEMORY], unit = NAN, plain = -INFINITY, foretold = -INFINITY, cured = -INFINITY;
  double damped = INFINITY, damped_foretold = INFINITY, fed = -INFINITY; /* with a predictor */
  char text[96], extra[64];
  BW_TRY(stiffness(comm, b.along, &unit));
  BW_TRY(answer(comm, b, g));
  for (size_t q = 0; q < sizeof theta / sizeof *theta; q++) {
    double rate = NAN;
    int K = 1;
    const double omega2 = theta[q] * theta[q] / (DT * DT);
    b.E = omega2 / unit;
    b.virtual_mass = 0.0;
    BW_TRY(measured(comm, &b, &rate, &K));
    plain = fmax(plain, rate);
    foretold = fmax(foretold, foresee(g, omega2, K, false));
    b.virtual_mass = bw_coupler_config_default().virtual_mass;
    BW_TRY(measured(comm, &b, &rate, &K));
    cured = fmax(cured, rate);
    b.predictor = true;
    BW_TRY(measured(comm, &b, &rate, &K));
    b.predictor = false;
    fed = fmax(fed, rate);
    damped = fmin(damped, rate);
    damped_foretold = fmin(damped_foretold, foresee(g, omega2, K, true));
  }
  snprintf(extra, sizeof extra, "\"load\": \"%s\", \"along\": %d", load_name[b.load], b.along);
  snprintf(text, sizeof text, "largest growth per step, no virtual mass, %s, %s", load_name[b.load],
           along_name[b.along]);
  bw_validation_row(v, &(bw_claim){text, "growth", plain, foretold,
                                   b.load == BW_LOAD_REACTION ? 0.05 : INFINITY, BW_ANALYTIC,
                                   "recurrence with the fluid's answer", extra});
  snprintf(text, sizeof text, "largest growth per step, %s, %s", load_name[b.load],
           along_name[b.along]);
  bw_validation_row(v, &(bw_claim){text, "growth_virtual_mass", fmax(cured, 0.0), 0.0, 1e-4,
                                   BW_ANALYTIC, "none is fed", extra});
  snprintf(text, sizeof text, "largest growth per step, predictor, %s, %s", load_name[b.load],
           along_name[b.along]);
  bw_validation_row(v, &(bw_claim){text, "growth_predictor", fmax(fed, 0.0), 0.0, 1e-4, BW_ANALYTIC,
                                   "none is fed", extra});
  snprintf(text, sizeof text, "strongest damping per step, predictor, %s, %s", load_name[b.load],
           along_name[b.along]);
  bw_validation_row(v, &(bw_claim){text, "damping_predictor", -damped, -damped_foretold,
                                   b.load == BW_LOAD_REACTION ? 0.05 : INFINITY, BW_ANALYTIC,
                                   "recurrence with the fluid's answer", extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int load = BW_LOAD_PROBES; load <= BW_LOAD_REACTION; load++)
    for (int along = 0; along < 2; along++)
      BW_TRY(sweep(
          v, (set_up){.load = (bw_coupler_load_kind)load, .along = along, .density = DENSITY}));
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.fast_modes", run);
}
