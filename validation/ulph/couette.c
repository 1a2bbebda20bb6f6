/* Claim      Between a floor that is set in motion and a wall at rest the flow starts as the
 *            equation of diffusion says, with the viscosity that pairs on a lattice have.
 * Reference  u/U = 1 - y/H - sum 2/(n pi) sin(n pi y/H) exp(-n^2 pi^2 nu t/H^2). Central pair
 *            forces are isotropic in disorder; along a square lattice their viscosity is nu times
 *            4 sum w x^2 y^2/r^2/sum w x^2 = 0.886 (summed here), across the diagonals 1.114.
 * Measured   No slip, Re = U H/nu = 1, 10 (20) dx across, U = c0/20, in a box 8 H long, closed by
 *            free-slip walls whose sound does not reach the middle before the end, nu t/H^2 = 0.1.
 *            Velocity along the floor of the particles of the middle twentieth, the largest
 *            difference from the profile over U.
 * Tolerance  1 % at 20 dx (reference of the method), 4 % at 10 (second order). The difference from
 *            the profile with nu itself is reported: 2.6 % of U, whatever dx is.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double H = 1, U = 1, RHO = 1;

static void glide(double t, void *context, double x[3], double v[3], double a[3])
{
  (void)context;
  x[0] = U * t, v[0] = U;
  x[1] = x[2] = v[1] = v[2] = a[0] = a[1] = a[2] = 0;
}

static double profile(double y, double t)
{
  const double pi = acos(-1);
  double u = 1 - y;
  for (int n = 1; n < 40; n++)
    u -= 2 / (n * pi) * sin(n * pi * y) * exp(-n * n * pi * pi * t);
  return u;
}

/* Viscosity of shear along a square lattice over that of a disordered cloud. */
static double lattice_viscosity(void)
{
  double sum = 0, m2 = 0;
  for (int j = -3; j <= 3; j++)
    for (int i = -3; i <= 3; i++) {
      const double r2 = i * i + j * j, q = sqrt(r2) / 3;
      if (r2 == 0 || q >= 1) continue;
      const double w = pow(1 - q, 4) * (1 + 4 * q);
      sum += w * i * i * j * j / r2, m2 += w * i * i;
    }
  return 4 * sum / m2;
}

static bw_status make(bw_validation *v, int cells, bw_ulph **u)
{
  const double dx = H / cells, t = 4 * dx, L = 8 * H;
  const bw_shape fluid = {.upper = {L, H, 1}};
  const bw_shape floor = {.lower = {-H, -t, 0}, .upper = {L + H, 0, 1}};
  const bw_shape ceiling = {.lower = {-t, H, 0}, .upper = {L + t, H + t, 1}};
  const bw_shape sides[2] = {{.lower = {-t, 0, 0}, .upper = {L + t, H, 1}},
                             {.lower = {0, -H, 0}, .upper = {L, 2 * H, 1}, .remove = true}};
  const bw_ulph_wall walls[] = {{.count = 1, .shape = &floor, .no_slip = true, .moves = true},
                                {.count = 1, .shape = &ceiling, .no_slip = true},
                                {.count = 2, .shape = sides}};
  const double origin[3] = {0};
  bw_ulph_config c = bw_ulph_config_default();
  size_t n = 0;
  double *x = NULL;
  c.dimensions = 2, c.dx = dx, c.rho0 = RHO, c.speed = 2 * U, c.mu = RHO * U * H;
  c.alpha = c.alpha_wall = 0, c.motion = glide;
  bw_status st = bw_ulph_fill(bw_validation_comm(v), &c, origin, 1, &fluid, &n, &x);
  BW_THEN(st, bw_ulph_create(bw_validation_comm(v), &c, n, x, 3, walls, u));
  bw_release(&x);
  return st;
}

/* Largest differences in the middle, over U, from the profiles of nu and of the lattice. */
static bw_status misfit(const bw_ulph *u, double most[2])
{
  const size_t n = bw_ulph_count(u);
  double *x = NULL, *v = NULL;
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&v, 3 * n));
  const double times[2] = {1, lattice_viscosity()};
  most[0] = most[1] = 0;
  if (st == BW_OK) {
    bw_ulph_read(u, BW_ULPH_POSITION, x);
    bw_ulph_read(u, BW_ULPH_VELOCITY, v);
    for (size_t i = 0; i < n; i++)
      for (int q = 0; q < 2 && fabs(x[3 * i] - 4 * H) < 0.2 * H; q++)
        most[q] = fmax(most[q], fabs(v[3 * i] - profile(x[3 * i + 1], times[q] * bw_ulph_time(u))));
  }
  bw_release(&x);
  bw_release(&v);
  return st;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  bw_ulph *u = NULL;
  double most[2] = {NAN, NAN};
  bw_status st = make(v, full ? 20 : 10, &u);
  BW_THEN(st, tank_run(u, 0.1));
  BW_THEN(st, misfit(u, most));
  bw_ulph_destroy(&u);
  BW_TRY(st);
  for (int q = 0; q < 2; q++)
    bw_validation_row(v, &(bw_claim){.claim = "a wall without slip drags the fluid as it should",
                                     .quantity = q == 0 ? "largest_difference_over_U"
                                                        : "with_the_viscosity_of_the_lattice",
                                     .measured = most[q],
                                     .reference = 0,
                                     .tolerance = q == 0 ? INFINITY
                                                  : full ? 0.01
                                                         : 0.04,
                                     .kind = BW_ANALYTIC,
                                     .source = "start of plane Couette flow"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.couette", run);
}
