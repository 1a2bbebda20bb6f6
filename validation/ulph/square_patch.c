/* Claim      A square patch that rotates keeps its angular momentum, and no voids open where its
 *            pressure is negative. Without the cure of the tension they do.
 * Reference  Exact: angular momentum; pressure at the centre of a square, -0.147343 rho w^2 L^2
 *            (double sine series, data/particle_fluid/square_patch_pressure.csv).
 * Measured   30 (50) dx along a side. Without shifting, to w t = 4: angular momentum less what the
 *            cure books; mean pressure of the middle fifth over the first w t = 0.1. With shifting,
 *            to w t = 3 (4): particles in the middle fifth that call themselves of the surface.
 * Tolerance  Angular momentum 1e-12, round-off; pressure 2 % at 50 dx, 4 % at 30; no void.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double RHO = 1000;

/* The pressure of an incompressible square, p = 0 on its sides. */
static double series(double X, double Y)
{
  const double pi = acos(-1);
  double sum = 0;
  for (int m = 1; m < 60; m += 2)
    for (int n = 1; n < 60; n += 2)
      sum -=
          32 / (m * n * pi * pi) / (pi * pi * (m * m + n * n)) * sin(m * pi * X) * sin(n * pi * Y);
  return RHO * sum;
}

static void rotate(const double x[3], void *context, double v[3], double *p)
{
  (void)context;
  v[0] = x[1], v[1] = -x[0], v[2] = 0;
  *p = series(x[0] + 0.5, x[1] + 0.5);
}

/* Of the particles in the middle: mean pressure, how many are of the surface. */
typedef struct {
  double pressure, voids, n;
} middle;

static bw_status look(const bw_ulph *u, middle *m)
{
  const size_t n = bw_ulph_count(u);
  double *x = NULL, *p = NULL, *s = NULL;
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&p, n));
  BW_THEN(st, BW_ALLOCATE(&s, n));
  memset(m, 0, sizeof *m);
  if (st == BW_OK) {
    bw_ulph_read(u, BW_ULPH_POSITION, x);
    bw_ulph_read(u, BW_ULPH_PRESSURE, p);
    bw_ulph_read(u, BW_ULPH_SURFACE, s);
    for (size_t i = 0; i < n; i++)
      if (fmax(fabs(x[3 * i]), fabs(x[3 * i + 1])) < 0.1)
        m->pressure += p[i], m->voids += s[i], m->n += 1;
    m->pressure /= m->n;
  }
  bw_release(&x);
  bw_release(&p);
  bw_release(&s);
  return st;
}

static bw_status make(bw_validation *v, int cells, double shifting, bool cure, bw_ulph **u)
{
  const double origin[3] = {-0.5, -0.5, 0};
  const bw_shape square = {.lower = {-0.5, -0.5, 0}, .upper = {0.5, 0.5, 0}};
  bw_ulph_config c = bw_ulph_config_default();
  double *x = NULL;
  size_t n = 0;
  c.dimensions = 2, c.dx = 1.0 / cells, c.rho0 = RHO, c.speed = 0.75, c.shifting = shifting;
  c.tension_cure = cure;
  bw_status st = bw_ulph_fill(bw_validation_comm(v), &c, origin, 1, &square, &n, &x);
  BW_THEN(st, bw_ulph_create(bw_validation_comm(v), &c, n, x, 0, NULL, u));
  BW_THEN(st, bw_ulph_start(*u, rotate, NULL));
  bw_release(&x);
  return st;
}

static void claim(bw_validation *v, const char *quantity, double measured, double reference,
                  double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "a rotating square stays whole",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "double sine series; conservation"});
}

static bw_status with_cure(bw_validation *v, int cells)
{
  bw_ulph *u = NULL;
  middle m;
  double mean = 0, exact = 0;
  BW_TRY(make(v, cells, 0, true, &u));
  const double spin = bw_ulph_account(u).spin[2];
  for (int q = 1; q <= 20; q++) {
    BW_TRY(tank_run(u, 0.005 * q));
    BW_TRY(look(u, &m));
    mean += m.pressure / 20;
  }
  /* The mean of the series over the same square, by its value at 5 x 5 points. */
  for (int q = 0; q < 25; q++)
    exact += series(0.42 + 0.04 * (q % 5), 0.42 + 0.04 * (q / 5)) / 25;
  BW_TRY(tank_run(u, 4));
  BW_TRY(look(u, &m));
  const bw_ulph_ledger l = bw_ulph_account(u);
  claim(v, "centre_pressure", mean / exact, 1, cells >= 50 ? 0.02 : 0.04);
  claim(v, "angular_momentum_less_cure", (l.spin[2] - l.turn[2][2]) / spin, 1, 1e-12);
  claim(v, "angular_momentum", l.spin[2] / spin, 1, INFINITY);
  claim(v, "kinetic_energy", l.kinetic / l.first, 1, INFINITY);
  bw_ulph_destroy(&u);
  return BW_OK;
}

static bw_status with_shifting(bw_validation *v, int cells)
{
  bw_ulph *u = NULL;
  middle m;
  double most = 0;
  BW_TRY(make(v, cells, 2, true, &u));
  const double spin = bw_ulph_account(u).spin[2];
  for (int q = 1; q <= (cells >= 50 ? 40 : 30); q++) {
    BW_TRY(tank_run(u, 0.1 * q));
    BW_TRY(look(u, &m));
    most = fmax(most, m.voids);
  }
  const bw_ulph_ledger l = bw_ulph_account(u);
  claim(v, "voids_in_the_middle", most, 0, 0);
  claim(v, "angular_momentum_with_shifting", l.spin[2] / spin, 1, INFINITY);
  bw_ulph_destroy(&u);
  return BW_OK;
}

static bw_status without_cure(bw_validation *v, int cells)
{
  bw_ulph *u = NULL;
  middle m;
  double most = 0;
  BW_TRY(make(v, cells, 2, false, &u));
  for (int q = 1; q <= 20 && most == 0; q++) {
    BW_TRY(tank_run(u, 0.1 * q));
    BW_TRY(look(u, &m));
    most = fmax(most, m.voids);
  }
  claim(v, "voids_without_cure", most > 0, 1, 0);
  bw_ulph_destroy(&u);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const int cells = bw_validation_full(v) ? 50 : 30;
  BW_TRY(with_cure(v, cells));
  BW_TRY(with_shifting(v, cells));
  return without_cure(v, cells);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.square_patch", run);
}
