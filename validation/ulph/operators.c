/* Claim      The dilation of a linear velocity is exact on a disordered cloud with a surface all
 *            round; that of a wave has the error of the operator's symbol, which is of second order
 *            in space; forces keep momentum and angular momentum to round-off.
 * Reference  Closed forms. The symbol of the gradient along x on a lattice,
 *            sum w sin(k x) x/(k m2) - 1, is summed here from the weight alone.
 * Measured   What a step of 1e-6 dx/c0 does to the density, over the step.
 * Tolerance  Linear: 1e-6, the round-off of a density near 1 that changes by 1e-9 in the step over
 *            that change. Symbol: 1 % of
 *            itself. Order: the next term is (k dx)^2/10, a hundredth at 20 dx, over log 2. Sums:
 *            1e-13 of the sum of absolutes, round-off.
 * BUILD modules=shape
 * TEST  ranks=1,2 */
#include "tank.h"

/* Velocity gradients, and waves along x. */
typedef struct {
  double slope[2][2], k;
} flow;

static void move(const double x[3], void *context, double v[3], double *p)
{
  const flow *f = context;
  *p = 0;
  v[2] = 0;
  for (int a = 0; a < 2; a++)
    v[a] = f->slope[a][0] * x[0] + f->slope[a][1] * x[1];
  if (f->k > 0) v[0] = sin(f->k * x[0]) / f->k;
}

/* A number of [-1, 1) for a particle. */
static double noise(uint64_t key)
{
  uint64_t z = key * UINT64_C(0x9E3779B97F4A7C15) + UINT64_C(0x632BE59BD9B4E019);
  z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
  return 2 * ((double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0) - 1;
}

/* n x n particles about the origin, dx = 1, each moved by up to `disorder`. */
static bw_status cloud(const bw_comm *comm, int n, double disorder, double speed, bw_ulph **u)
{
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm), total = n * n;
  const int first = total * me / size, last = total * (me + 1) / size;
  bw_ulph_config c = bw_ulph_config_default();
  double *x = NULL;
  c.dimensions = 2, c.dx = 1, c.rho0 = 1, c.speed = speed;
  c.alpha = c.delta = c.shifting = 0, c.tension_cure = false;
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&x, 3 * (size_t)(last - first)));
  for (int q = first; q < last && st == BW_OK; q++) {
    x[3 * (q - first)] = q % n - (n - 1) / 2 + disorder * noise((uint64_t)(2 * q));
    x[3 * (q - first) + 1] = q / n - (n - 1) / 2 + disorder * noise((uint64_t)(2 * q + 1));
  }
  BW_THEN(st, bw_ulph_create(comm, &c, (size_t)(last - first), x, 0, NULL, u));
  bw_release(&x);
  return st;
}

/* Largest error of the dilation at particles within `within` of the origin. */
static bw_status dilation_error(const bw_comm *comm, bw_ulph *u, flow *f, double expected,
                                double within, double *error)
{
  BW_TRY(bw_ulph_start(u, move, f));
  const double dt = 1e-6 / bw_ulph_c0(u);
  BW_TRY(bw_ulph_step(u, dt));
  const size_t n = bw_ulph_count(u);
  double *x = NULL, *rho = NULL;
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&rho, n));
  st = bw_comm_agree(comm, st);
  *error = 0;
  if (st == BW_OK) {
    bw_ulph_read(u, BW_ULPH_POSITION, x);
    bw_ulph_read(u, BW_ULPH_DENSITY, rho);
    for (size_t i = 0; i < n; i++)
      if (fmax(fabs(x[3 * i]), fabs(x[3 * i + 1])) < within)
        *error = fmax(*error, fabs(-log(rho[i]) / dt / expected - 1));
    bw_comm_max(comm, 1, error);
  }
  bw_release(&x);
  bw_release(&rho);
  return st;
}

/* The symbol's relative error, from the weight. */
static double symbol_error(double k)
{
  double sum = 0, m2 = 0;
  for (int j = -3; j <= 3; j++)
    for (int i = -3; i <= 3; i++) {
      const double q = sqrt(i * i + j * j) / 3;
      const double w = q < 1 ? pow(1 - q, 4) * (1 + 4 * q) : 0;
      sum += w * sin(k * i) * i / k;
      m2 += w * i * i;
    }
  return sum / m2 - 1;
}

static bw_status waves(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  double error[2];
  for (int q = 0; q < 2; q++) {
    const double length = q == 0 ? 20 : 40;
    flow f = {.k = 2 * acos(-1) / length};
    bw_ulph *u = NULL;
    bw_status st = cloud(comm, 25, 0, 8, &u);
    BW_THEN(st, dilation_error(comm, u, &f, 1, 0.5, &error[q]));
    bw_ulph_destroy(&u);
    BW_TRY(st);
    bw_validation_row(v, &(bw_claim){.claim = "a wave has the error of the symbol",
                                     .quantity = q == 0 ? "error_20_dx" : "error_40_dx",
                                     .measured = error[q],
                                     .reference = fabs(symbol_error(f.k)),
                                     .tolerance = 0.01,
                                     .kind = BW_ANALYTIC,
                                     .source = "sum w sin(k x) x/(k m2) on a lattice"});
  }
  bw_validation_row(v, &(bw_claim){.claim = "the gradient is of second order inside",
                                   .quantity = "order",
                                   .measured = bw_validation_order(2, error[0], 1, error[1]),
                                   .reference = 2,
                                   .tolerance = 0.015,
                                   .kind = BW_ORDER,
                                   .source = "expansion of the symbol"});
  return BW_OK;
}

static bw_status linear(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  flow f = {.slope = {{0.03, -0.02}, {0.01, 0.02}}};
  double error;
  bw_ulph *u = NULL;
  bw_status st = cloud(comm, 25, 0.25, 2, &u);
  /* All but the outermost two rows, where single corners have too few neighbours. */
  BW_THEN(st, dilation_error(comm, u, &f, 0.05, 10.5, &error));
  bw_ulph_destroy(&u);
  BW_TRY(st);
  /* tr L + dt/2 tr L L is what a step takes: a relative 1e-9 here. */
  bw_validation_row(v, &(bw_claim){.claim = "a linear velocity has its dilation on any cloud",
                                   .quantity = "largest_error",
                                   .measured = error,
                                   .reference = 0,
                                   .tolerance = 1e-6,
                                   .kind = BW_ANALYTIC,
                                   .source = "linear completeness"});
  return BW_OK;
}

static void random_pressure(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = v[1] = v[2] = 0;
  *p = 0.5 * noise((uint64_t)(int64_t)rint(1e6 * x[0] + 1e10 * x[1]));
}

static bw_status sums(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  bw_ulph *u = NULL;
  double *x = NULL, *F = NULL, s[5] = {0};
  BW_TRY(cloud(comm, 25, 0.25, 2, &u));
  bw_status st = bw_ulph_start(u, random_pressure, NULL);
  if (st == BW_OK) st = BW_ALLOCATE(&x, 3 * bw_ulph_count(u));
  BW_THEN(st, BW_ALLOCATE(&F, 3 * bw_ulph_count(u)));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    bw_ulph_read(u, BW_ULPH_POSITION, x);
    bw_ulph_read(u, BW_ULPH_FORCE, F);
    for (size_t i = 0; i < 3 * bw_ulph_count(u); i += 3) {
      const double torque = x[i] * F[i + 1] - x[i + 1] * F[i];
      s[0] += F[i], s[1] += F[i + 1], s[2] += torque;
      s[3] += fabs(F[i]) + fabs(F[i + 1]), s[4] += fabs(torque);
    }
    bw_comm_sum(comm, 5, s);
  }
  bw_release(&x);
  bw_release(&F);
  bw_ulph_destroy(&u);
  BW_TRY(st);
  const double size[2] = {fmax(fabs(s[0]), fabs(s[1])) / s[3], fabs(s[2]) / s[4]};
  for (int q = 0; q < 2; q++)
    bw_validation_row(v, &(bw_claim){.claim = "pair forces keep momentum and angular momentum",
                                     .quantity = q == 0 ? "momentum" : "angular_momentum",
                                     .measured = size[q],
                                     .reference = 0,
                                     .tolerance = 1e-13,
                                     .kind = BW_CONSERVATION,
                                     .source = "ERRATA-ULPH 19 to 23"});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(linear(v));
  BW_TRY(waves(v));
  return sums(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.operators", run);
}
