/* Claim      A drop that a central force holds together oscillates with the period of the exact
 *            solution, as wide as it does, and loses little in a period.
 * Reference  Exact ellipse (problem of Monaghan & Rafiee 2013): circle of radius 1, u = -A x,
 *            v = A y, A(0) = 0.4 Omega, force -Omega^2 r: A' = (A^2 + Omega^2)(a^2 - b^2)/
 *            (a^2 + b^2), a' = -A a, b' = A b. Integrated to 1e-12: period 4.52560/Omega, largest
 *            half-axis 1.32206.
 * Measured   A disc of 12 (25) dx per radius over one (two) periods. The force is given as kicks
 *            on both sides of every fourth step (Strang's splitting, (4 Omega dt)^2/24 = 2e-5):
 *            the fluid itself knows none. Half-axes 2 sqrt(moment of the mass); the period is
 *            between zeros of log(b/a), the last two of which are half a period apart.
 * Tolerance  Period 0.5 % at 25 dx; largest half-axis 1 %. At 12 dx twice that (first order at the
 *            surface). What is lost per period is reported: alpha = 0.02 alone takes
 *            2 mu A^2 per area and time.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double RHO = 1000, A0 = 0.4, PERIOD = 4.52560, LARGEST = 1.32206;
enum { EVERY = 4 };

static void stretch(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = -A0 * x[0], v[1] = A0 * x[1], v[2] = 0;
  *p = 0.5 * RHO * (1 + A0 * A0) * (1 - x[0] * x[0] - x[1] * x[1]);
}

/* The state of all particles (one rank). */
typedef struct {
  size_t n;
  double *rows, numbers[BW_ULPH_NUMBERS];
  int64_t *id;
} state;

/* Velocities by the force through dt; half-axes and energy without compression. */
static bw_status kick(bw_ulph *u, state *s, double dt, double axis[2], double *energy)
{
  double sum[3] = {0};
  bw_ulph_ids(u, s->id);
  bw_ulph_state_get(u, s->rows, s->numbers);
  *energy = 0;
  for (size_t i = 0; i < s->n; i++) {
    double *row = s->rows + BW_ULPH_ROW * i, *x = row, *v = row + 3;
    const double m = row[16];
    for (int k = 0; k < 2; k++) {
      *energy += 0.5 * m * (v[k] * v[k] + x[k] * x[k]);
      sum[k] += m * x[k] * x[k];
      v[k] -= dt * x[k];
    }
    sum[2] += m;
  }
  for (int k = 0; k < 2; k++)
    axis[k] = 2 * sqrt(sum[k] / sum[2]);
  return bw_ulph_state_set(u, s->n, s->id, s->rows, s->numbers);
}

/* What is found in so many periods. */
typedef struct {
  double period, largest, lost;
} found;

static bw_status follow(bw_ulph *u, int periods, found *f)
{
  state s = {.n = bw_ulph_count(u)};
  double axis[2], energy, first = 0, before = 0, sign = 0;
  int zeros = 0;
  f->largest = 0;
  bw_status st = BW_ALLOCATE(&s.rows, BW_ULPH_ROW * s.n);
  BW_THEN(st, BW_ALLOCATE(&s.id, s.n));
  const double dt = st == BW_OK ? bw_ulph_dt_max(u) : 1;
  BW_THEN(st, kick(u, &s, 0.5 * EVERY * dt, axis, &first));
  while (st == BW_OK && zeros < 2 * periods) {
    for (int q = 0; q < EVERY && st == BW_OK; q++)
      st = bw_ulph_step(u, dt);
    BW_THEN(st, kick(u, &s, EVERY * dt, axis, &energy));
    /* The kick is half before and half behind this time: axes do not depend on it. */
    const double now = log(axis[1] / axis[0]), t = bw_ulph_time(u);
    f->largest = fmax(f->largest, fmax(axis[0], axis[1]));
    if (sign * now < 0 && t > 1)
      f->period = (t - EVERY * dt * now / (now - before)) / (0.5 * ++zeros);
    if (t > 1) sign = now;
    before = now;
  }
  f->lost = 1 - energy / first;
  bw_release(&s.rows);
  bw_release(&s.id);
  return st;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  const int cells = full ? 25 : 12, periods = full ? 2 : 1;
  const double origin[3] = {-2, -2, 0};
  const bw_shape disc = {.kind = BW_SHAPE_CYLINDER, .axis = 2, .radius = 1, .upper = {0, 0, 1}};
  bw_ulph_config c = bw_ulph_config_default();
  bw_ulph *u = NULL;
  double *x = NULL;
  size_t n = 0;
  found f = {0};
  c.dimensions = 2, c.dx = 1.0 / cells, c.rho0 = RHO, c.speed = 1;
  bw_status st = bw_ulph_fill(bw_validation_comm(v), &c, origin, 1, &disc, &n, &x);
  BW_THEN(st, bw_ulph_create(bw_validation_comm(v), &c, n, x, 0, NULL, &u));
  BW_THEN(st, bw_ulph_start(u, stretch, NULL));
  BW_THEN(st, follow(u, periods, &f));
  bw_release(&x);
  bw_ulph_destroy(&u);
  BW_TRY(st);
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } rows[] = {{"period_Omega", f.period, PERIOD, full ? 0.005 : 0.01},
              {"largest_half_axis", f.largest, LARGEST, full ? 0.01 : 0.02},
              {"energy_lost_per_period", f.lost / periods, 0, INFINITY}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_validation_row(v, &(bw_claim){.claim = "a drop oscillates under a central force",
                                     .quantity = rows[q].quantity,
                                     .measured = rows[q].measured,
                                     .reference = rows[q].reference,
                                     .tolerance = rows[q].tolerance,
                                     .kind = BW_ANALYTIC,
                                     .source = "ellipse of Monaghan & Rafiee 2013, ODE to 1e-12"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.oscillating_drop", run);
}
