/* What a crack costs by virtual extension: where the calibration of the state-based laws is from.
 *
 * Claim      A long crack along the lattice of a state-based solid needs the fracture energy that
 *            was asked for.
 * Reference  the energy that an extension of the crack releases at fixed displacements of the rim,
 *            G = -dE/da, E(a) the elastic energy of the body with a flat cut that ends at a
 *            (solved, and a polynomial through five lengths).
 * Measured   a disc (in space: a cylinder, periodic along the front) with a cut from its side to
 *            its middle, its rim displaced by the singular field of a crack. Bonds ahead are broken
 *            one after the other, the weakest first, at rest (linear solve), until the crack has
 *            advanced by eight spacings. The largest G over the last two of them, where the tip is
 *            in the middle of the field, at the length of a flat cut that has the same energy, is
 *            what it costs; before that the broken bonds around the crack are not yet those of a
 *            long one. The laws' tables (pd_state_crack.c) were made so: an entry is the one before
 *            times this. Quick: knots in discs of 24, and plane stress between them; full: all of
 *            it. Also what the crack costs when the field has a stress T along the crack, in units
 *            of K/sqrt(horizon): reported, as no long crack has one, and every specimen has.
 * Tolerance  2 %: straight lines between the knots, and the disc (24 to 40 spacings: 2e-3). In
 *            space 3 %: its knots of correspondence are from discs of 14 and four spacings of the
 *            crack.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 timeout=3600 */
#include "crack.h"

enum { LENGTHS = 5, ADVANCE = 8 }; /* spacings of the crack */

typedef struct {
  int radius, rim; /* cells */
  double start;    /* where the cut ends [cells from the middle] */
  double along;    /* stress along the crack over 2 mu, for K = 2 mu sqrt(2 pi) [1/sqrt(cell)] */
} disc;

static int choose(const int32_t site[3], const void *data, uint8_t *group)
{
  const disc *d = data;
  const double x = site[0] + 0.5 - d->radius, y = site[1] + 0.5 - d->radius, r = hypot(x, y);
  if (r > d->radius) return -1;
  /* What breaks is around the middle, away from the rim. */
  *group = fabs(y) > d->rim + 1 || x < d->start - 3 * d->rim || x > 0.6 * d->radius;
  return r > d->radius - d->rim ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

/* The field of a crack tip in the middle, for K = 2 mu sqrt(2 pi), and a uniform stress along it;
 * nu of plane strain. */
static void singular(const crack_body *b, const disc *d, double nu)
{
  for (size_t i = 0; i < bw_solid_count(b->pd); i++) {
    const double x = b->r.X0[3 * i] - d->radius, y = b->r.X0[3 * i + 1] - d->radius;
    const double r = hypot(x, y), angle = atan2(y, x), a = sqrt(r) * (3 - 4 * nu - cos(angle));
    b->U[3 * i] = a * cos(0.5 * angle) + d->along * (1 - nu) * x;
    b->U[3 * i + 1] = a * sin(0.5 * angle) - d->along * nu * y;
  }
}

static bw_status make(const bw_comm *comm, const crack_material *a, const disc *d, double G0,
                      crack_body *b)
{
  double lam, mu;
  bw_solid_config c = crack_config(a, &lam, &mu);
  const int deep = a->geometry == BW_PD_3D ? 2 * d->rim : 1;
  c.G0 = G0;
  BW_TRY(crack_make(comm, &c, (int[3]){2 * d->radius, 2 * d->radius, deep}, choose, d, b));
  singular(b, d, lam / (2 * (lam + mu)));
  return crack_cut(b, -1, d->radius + d->start, d->radius);
}

/* Energies for cuts that end before, in and beyond the middle. */
static bw_status lengths(const bw_comm *comm, const crack_material *a, const disc *d,
                         double energy[LENGTHS], double at[LENGTHS])
{
  crack_body b = {0};
  BW_TRY(make(comm, a, d, INFINITY, &b));
  for (int q = 0; q < LENGTHS; q++) {
    at[q] = d->start * (1 - 2.0 * q / (LENGTHS - 1));
    BW_TRY(crack_cut(&b, -1, d->radius + at[q], d->radius));
    BW_TRY(crack_rest(&b));
    BW_TRY(crack_energy(&b, CRACK_STRAIN, &energy[q]));
  }
  crack_release(&b);
  return BW_OK;
}

/* Lagrange's polynomial through the lengths and its slope. */
static double through(const double at[], const double value[], double x, double *slope)
{
  double sum = 0;
  *slope = 0;
  for (int k = 0; k < LENGTHS; k++) {
    double w = 1, dw = 0;
    for (int j = 0; j < LENGTHS; j++) {
      if (j == k) continue;
      dw = (dw * (x - at[j]) + w) / (at[k] - at[j]);
      w *= (x - at[j]) / (at[k] - at[j]);
    }
    sum += w * value[k], *slope += dw * value[k];
  }
  return sum;
}

/* -dE/da of the flat cut that has this energy, found by Newton's method. */
static double released_at(const double at[], const double value[], double energy)
{
  double x = at[1], slope = 0;
  for (int q = 0; q < 30; q++)
    x -= (through(at, value, x, &slope) - energy) / slope;
  return -slope;
}

/* What a crack costs over the G0 that the law was given, at its first bond and at its hardest. */
typedef struct {
  double first, hardest;
  int breaks;
} crack_cost;

static bw_status cost(const bw_comm *comm, const crack_material *a, const disc *d, crack_cost *c)
{
  const double G0 = 1e-9;
  const int deep = a->geometry == BW_PD_3D ? 2 * d->rim : 1;
  double value[LENGTHS], at[LENGTHS], energy, load = 1e-6, tip = 0;
  crack_body b = {0};
  *c = (crack_cost){0};
  BW_TRY(lengths(comm, a, d, value, at));
  BW_TRY(make(comm, a, d, G0, &b));
  const double start = crack_tip(&b);
  for (; c->breaks < 1000 && tip < ADVANCE; c->breaks++) {
    BW_TRY(crack_rest(&b));
    BW_TRY(crack_energy(&b, CRACK_STRAIN, &energy));
    BW_TRY(crack_advance(&b, &load));
    const double G = load * load * released_at(at, value, energy) / (deep * G0);
    if (c->breaks == 0) c->first = G;
    if (tip >= ADVANCE - 2) c->hardest = fmax(c->hardest, G);
    tip = crack_tip(&b) - start;
  }
  crack_release(&b);
  return BW_OK;
}

/* along: the stress along the crack over K/sqrt(horizon). */
static bw_status row(bw_validation *v, const crack_material *a, int radius, double along,
                     double tolerance)
{
  const disc d = {.radius = radius,
                  .rim = (int)ceil(a->m + 0.5),
                  .start = -ADVANCE,
                  .along = along * sqrt(2 * STATE_PI / a->m)};
  crack_cost c;
  char extra[240], more[100];
  BW_TRY(cost(bw_validation_comm(v), a, &d, &c));
  snprintf(more, sizeof more, ", \"T_sqrt_horizon_over_K\": %g, \"radius\": %d, \"breaks\": %d",
           along, radius, c.breaks);
  crack_words(a, extra, sizeof extra, more);
  state_claim(v, "a crack costs the fracture energy", "G_start_over_G0", c.first, 1, INFINITY,
              BW_ANALYTIC, "G = -dE/da", extra);
  state_claim(v, "a crack costs the fracture energy", "G_over_G0", c.hardest, 1, tolerance,
              BW_ANALYTIC, "G = -dE/da", extra);
  return BW_OK;
}

/* The tables of a law once more: all knots of a geometry. */
static bw_status table(bw_validation *v, bw_pd_geometry geometry, int law)
{
  static const double nu[] = {-0.2, 0, 0.1, 0.2, 0.3, 0.4, 0.45}, m[] = {2, 2.5, 3, 4};
  for (int w = 0; w < 2; w++)
    for (int k = 0; k < 4; k++)
      for (int q = 0; q < 7; q++) {
        const crack_material a = {geometry, law, w, nu[q], m[k]};
        if (geometry == BW_PD_3D && (k == 1 || k == 3)) continue;
        const bool space = geometry == BW_PD_3D;
        /* Where the volume hardly gives way a crack feels the rim of a small disc. */
        const int plane = (int)fmax(24, nu[q] > 0.35 ? fmin(12 * m[k], 40) : 7 * m[k]);
        BW_TRY(row(v, &a, space ? 20 : plane, 0, space ? 0.03 : 0.02));
      }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bw_pd_geometry plane = BW_PD_PLANE_STRAIN;
  crack_material knot = {plane, BW_SOLID_ORDINARY, BW_PD_STATE_CONSTANT, 0.3, 3};
  const crack_material between = {BW_PD_PLANE_STRESS, BW_SOLID_ORDINARY, BW_PD_STATE_INVERSE, 0.35,
                                  3};
  BW_TRY(row(v, &knot, 24, 0, 0.02));
  BW_TRY(row(v, &between, 24, 0, 0.02));
  knot.law = BW_SOLID_CORRESPONDENCE;
  BW_TRY(row(v, &knot, 24, 0, 0.02));
  if (!bw_validation_full(v)) return BW_OK;
  for (knot.law = BW_SOLID_ORDINARY; knot.law <= BW_SOLID_CORRESPONDENCE; knot.law++) {
    for (int q = -3; q <= 3; q++)
      BW_TRY(row(v, &knot, 28, 0.1 * q, INFINITY));
    BW_TRY(table(v, plane, knot.law));
    BW_TRY(table(v, BW_PD_3D, knot.law));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.crack_tip", run);
}
