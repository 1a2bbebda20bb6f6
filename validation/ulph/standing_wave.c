/* Claim      A small standing wave has the period of linear theory, and its energy falls as
 *            viscosity makes it fall.
 * Reference  omega^2 = g k tanh(k h), energy ~ exp(-4 nu k^2 t) (data/particle_fluid/
 *            standing_wave.csv; free-slip floor).
 * Measured   Half a wave between two free-slip walls, h = L/2, 40 (80) dx per L, velocity of the
 *            potential flow and a flat surface at first. Period: between zeros of the elevation
 *            near a wall, over three periods. Decay, with no artificial viscosity, and nu so that
 *            the energy halves in five periods: what the book has for viscosity over 4 nu k^2
 *            times the integral of the energy; and that of the elevation's scatter.
 * Tolerance  Period 1 % at 40 dx per L; viscosity 5 %. The decay of the elevation is reported: the
 *            images in the walls and the diffusion take a share that falls with dx (26 % of the
 *            viscosity's at 40, 14 % at 80).
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double L = 1, RHO = 1000;
/* Samples in a period of linear theory, and in all. */
enum { EACH = 100, SAMPLES = 400 };

/* The wave at t = 0. */
typedef struct {
  double k, h, amplitude;
} wave;

static void start(const double x[3], void *context, double v[3], double *p)
{
  const wave *w = context;
  const double c = w->amplitude * sqrt(tank_g * w->k * tanh(w->k * w->h)) / sinh(w->k * w->h);
  v[0] = c * sin(w->k * x[0]) * cosh(w->k * x[1]);
  v[1] = -c * cos(w->k * x[0]) * sinh(w->k * x[1]);
  v[2] = 0;
  /* The surface is flat: the weight alone, less the dynamic pressure on average. */
  *p = RHO * tank_g * (w->h - x[1]);
}

/* Zeros of the elevation near the left wall: the time between the first and the last of 7, over 3.
 * */
typedef struct {
  double period, rms[3]; /* of the elevation about its mean, over each period */
  double energy, taken; /* integral of the energy over three periods; what viscosity took in them */
} found;

/* Root of the mean square about the mean. */
static double scatter(int n, const double y[])
{
  double sum = 0, square = 0;
  for (int q = 0; q < n; q++)
    sum += y[q] / n;
  for (int q = 0; q < n; q++)
    square += pow(y[q] - sum, 2) / n;
  return sqrt(square);
}

static bw_status follow(bw_ulph *u, const wave *w, double width, found *f)
{
  const double expected = 2 * acos(-1) / sqrt(tank_g * w->k * tanh(w->k * w->h));
  double eta[SAMPLES], mean = 0, first = 0;
  int zeros = 0;
  memset(f, 0, sizeof *f);
  for (int q = 0; q < SAMPLES; q++) {
    BW_TRY(tank_run(u, expected * (q + 1) / EACH));
    eta[q] = bw_ulph_depth(u, (double[3]){1.01 * width, 0, 0}, width) - w->h;
    mean += eta[q] / SAMPLES;
    /* Over a period half of a wave's energy is kinetic. */
    if (q < 3 * EACH) f->energy += 2 * bw_ulph_account(u).kinetic * expected / EACH;
    if (q == 3 * EACH - 1) f->taken = -bw_ulph_account(u).viscous;
  }
  for (int q = 0; q < 3; q++)
    f->rms[q] = scatter(EACH, eta + EACH * q);
  for (int q = 1; q < SAMPLES; q++) {
    const double a = eta[q - 1] - mean, b = eta[q] - mean;
    if (a * b >= 0) continue;
    /* Linear between samples. */
    const double t = expected / EACH * (q + a / (a - b));
    if (zeros == 0) first = t;
    if (zeros == 6) f->period = (t - first) / 3;
    zeros++;
  }
  return BW_OK;
}

static bw_status make(bw_validation *v, int cells, double nu, double alpha, const wave *w,
                      bw_ulph **u)
{
  bw_ulph_config c = bw_ulph_config_default();
  wave copy = *w;
  c.dimensions = 2, c.dx = L / cells, c.rho0 = RHO, c.gravity[1] = -tank_g;
  c.speed = sqrt(tank_g * w->h), c.mu = RHO * nu, c.alpha = alpha;
  c.alpha_wall = alpha > 0 ? c.alpha_wall : 0;
  const tank t = {.size = {0.5 * L, 0.8 * L, 0}, .upper = {0.5 * L, w->h, 0}};
  BW_TRY(tank_create(bw_validation_comm(v), &c, &t, u));
  return bw_ulph_start(*u, start, &copy);
}

static bw_status run(bw_validation *v)
{
  const int cells = bw_validation_full(v) ? 80 : 40;
  const wave w = {2 * acos(-1) / L, 0.5 * L, 0.02 * L};
  const double omega = sqrt(tank_g * w.k * tanh(w.k * w.h)), period = 2 * acos(-1) / omega;
  const double nu = log(2) / (4 * w.k * w.k * 5 * period);
  found f[2];
  for (int q = 0; q < 2; q++) {
    bw_ulph *u = NULL;
    bw_status st = make(v, cells, q == 0 ? 0 : nu, q == 0 ? 0.02 : 0, &w, &u);
    BW_THEN(st, follow(u, &w, 4.0 * L / cells, &f[q]));
    bw_ulph_destroy(&u);
    BW_TRY(st);
  }
  bw_validation_row(v, &(bw_claim){.claim = "the period is that of linear theory",
                                   .quantity = "period",
                                   .measured = f[0].period / period,
                                   .reference = 1,
                                   .tolerance = 0.01,
                                   .kind = BW_ANALYTIC,
                                   .source = "omega^2 = g k tanh(k h)"});
  const double rate[2] = {log(f[0].rms[0] / f[0].rms[2]) / period,
                          log(f[1].rms[0] / f[1].rms[2]) / period};
  bw_validation_row(v, &(bw_claim){.claim = "viscosity takes the energy that it should",
                                   .quantity = "taken_by_viscosity",
                                   .measured = f[1].taken / (4 * nu * w.k * w.k * f[1].energy),
                                   .reference = 1,
                                   .tolerance = 0.05,
                                   .kind = BW_ANALYTIC,
                                   .source = "energy ~ exp(-4 nu k^2 t)"});
  bw_validation_row(v, &(bw_claim){.claim = "all that takes energy, over viscosity alone",
                                   .quantity = "decay_rate_over_4_nu_k2",
                                   .measured = rate[1] / (4 * nu * w.k * w.k),
                                   .reference = 1,
                                   .tolerance = INFINITY,
                                   .kind = BW_ANALYTIC,
                                   .source = "energy ~ exp(-4 nu k^2 t)"});
  bw_validation_row(v, &(bw_claim){.claim = "numerical viscosity with alpha = 0.02, over that of "
                                            "alpha h c0/8",
                                   .quantity = "numerical_viscosity",
                                   .measured = rate[0] / (4 * w.k * w.k) /
                                               (0.02 * 1.2 * L / cells * 10 *
                                                sqrt(tank_g * (w.h + L / cells)) / 8),
                                   .reference = 1,
                                   .tolerance = INFINITY,
                                   .kind = BW_ANALYTIC,
                                   .source = "ERRATA-ULPH 27"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.standing_wave", run);
}
