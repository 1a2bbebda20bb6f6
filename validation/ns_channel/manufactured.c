/* Claim: second order in space between walls on a stretched grid, velocity and pressure, in 3D.
 *
 * Reference: a manufactured steady flow with walls at rest at y = 0 and 1, periodic in x and z,
 *   u = b g' sin x cos z, v = (a - b) g cos x cos z, w = -a g' cos x sin z, g = 16 y^2 (1 - y)^2,
 *   p = c sin(2 y) cos x cos z (its normal derivative at the walls is not zero),
 * free of divergence for any a, b. It is held by the body force f = u.grad u + grad p - nu lap u,
 * given to the fluid as bodies give theirs, gamma_r dt f between predict and project: so no part of
 * the solver knows about it.
 *
 * Measured: from this flow, pressure 0, to t = 2 with nu = 0.2 (what is left of the way to the
 * steady discrete flow: e^(-(pi^2 + 2) nu 2) = 9e-3), steady in time, so that only the error in
 * space is seen. Largest error over all points of u, v, w; largest and rms error of p (its mean
 * taken off). On 12^3 and 24^3 cells, y stretched by tanh 1.5 (neighbours differ by up to 52 % and
 * 25 %); --full 24^3 and 48^3. Explicit: a force that comes after an implicit solve misses the
 * diffusion of that sub-step, -(gamma dt nu/2) lap f, of first order in dt.
 *
 * Tolerance: 0.3 on an order of 2 (15 %): the next term of the expansion is (k h)^2/4 of the first,
 * k = 2 pi of g across y, h = 1/12: 7 % on the coarse grid and 2 % on the fine one, whose
 * difference over log 2 is 0.07; walls add one of the third order, h/12 of k^-1, 0.2. --full: half.
 *
 * TEST ranks=1,2 */
#include "bw_memory.h"
#include "flow.h"

#include <stdio.h>

static const double nu = 0.2, amplitude_a = -0.1, amplitude_b = 0.2, amplitude_p = 0.3;

/* A product A X(x) Y(y) Z(z) with X'' = -X, Z'' = -Z: value, gradient, Laplacian. */
typedef struct {
  double value, d[3], laplacian;
} jet;

static jet product(double A, double X, double dX, const double Y[3], double Z, double dZ)
{
  return (jet){.value = A * X * Y[0] * Z,
               .d = {A * dX * Y[0] * Z, A * X * Y[1] * Z, A * X * Y[0] * dZ},
               .laplacian = A * X * Z * (Y[2] - 2.0 * Y[0])};
}

/* u, v, w, p at a point. */
static void exact(const double x[3], jet q[4])
{
  const double y = x[1], sx = sin(x[0]), cx = cos(x[0]), sz = sin(x[2]), cz = cos(x[2]);
  const double g[4] = {16.0 * y * y * (1.0 - y) * (1.0 - y), 32.0 * y * (1.0 - y) * (1.0 - 2.0 * y),
                       32.0 * (1.0 - 6.0 * y + 6.0 * y * y), 192.0 * (2.0 * y - 1.0)};
  const double h[3] = {sin(2.0 * y), 2.0 * cos(2.0 * y), -4.0 * sin(2.0 * y)};
  q[0] = product(amplitude_b, sx, cx, g + 1, cz, -sz);
  q[1] = product(amplitude_a - amplitude_b, cx, -sx, g, cz, -sz);
  q[2] = product(-amplitude_a, cx, -sx, g + 1, sz, cz);
  q[3] = product(amplitude_p, cx, -sx, h, cz, -sz);
}

static void velocity(const double x[3], double t, void *context, double u[3])
{
  jet q[4];
  (void)t, (void)context;
  exact(x, q);
  for (int c = 0; c < 3; c++)
    u[c] = q[c].value;
}

static double force(const double x[3], int c)
{
  jet q[4];
  exact(x, q);
  double f = q[3].d[c] - nu * q[c].laplacian;
  for (int d = 0; d < 3; d++)
    f += q[d].value * q[c].d[d];
  return f;
}

/* The force at the component's own points. */
static void sample_force(const bw_grid_view *g, int c, bw_real *f)
{
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double x[3];
        flow_point(g, c, i, j, k, x);
        f[bw_at(g, i, j, k)] = (bw_real)force(x, c);
      }
}

static bw_status step(bw_ns_channel *ns, bw_real *const f[3], double dt)
{
  static const double gamma[3] = {8.0 / 15.0, 2.0 / 15.0, 1.0 / 3.0}; /* bw_ns_channel.h */
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  BW_TRY(bw_ns_channel_check(ns, dt));
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(ns, r, dt);
    for (int c = 0; c < 3; c++)
      for (size_t q = 0; q < g->size; q++)
        bw_ns_channel_velocity(ns)[c][q] += (bw_real)(gamma[r] * dt) * f[c][q];
    bw_ns_channel_project(ns, r, dt);
  }
  return bw_ns_channel_check(ns, 0.0);
}

typedef struct {
  double u, p, p_rms; /* largest, largest, rms */
} errors;

static void pressure_errors(bw_ns_channel *ns, errors *e)
{
  const bw_grid *grid = bw_ns_channel_grid(ns);
  const bw_grid_view *g = bw_grid_look(grid);
  double sum[3] = {0.0, 0.0, 0.0}; /* error, its square, volume */
  double ends[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double x[3];
        jet q[4];
        flow_point(g, 3, i, j, k, x);
        exact(x, q);
        const double off = (double)bw_ns_channel_pressure(ns)[bw_at(g, i, j, k)] - q[3].value;
        const double height = g->y_face[j + g->lo[1]] - g->y_face[j + g->lo[1] - 1];
        sum[0] += off * height, sum[1] += off * off * height, sum[2] += height;
        ends[0] = fmax(ends[0], off), ends[1] = fmax(ends[1], -off);
      }
  bw_comm_sum(bw_grid_comm(grid), 3, sum);
  bw_comm_max(bw_grid_comm(grid), 2, ends);
  const double mean = sum[0] / sum[2];
  e->p = fmax(ends[0] - mean, ends[1] + mean);
  e->p_rms = sqrt(sum[1] / sum[2] - mean * mean);
}

static bw_status steady(const bw_comm *comm, int n, errors *e)
{
  const double two_pi = 2.0 * acos(-1.0);
  const flow_box box = {.n = {n, n, n},
                        .length = {two_pi, 1.0, two_pi},
                        .periodic = {true, false, true},
                        .stretch = 1.5};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_real *f[3] = {NULL, NULL, NULL};
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  bw_status st = bw_ns_channel_set_velocity(ns, velocity, NULL, 0.0);
  for (int q = 0; q < 3; q++) {
    BW_THEN(st, bw_field_create(grid, &f[q]));
    if (st == BW_OK) sample_force(bw_grid_look(grid), q, f[q]);
  }
  st = bw_comm_agree(comm, st);
  while (st == BW_OK && bw_ns_channel_time(ns) < 2.0)
    st = step(ns, f, 0.8 * bw_ns_channel_dt_max(ns));
  if (st == BW_OK) {
    e->u = flow_error(ns, velocity, NULL);
    pressure_errors(ns, e);
  }
  for (int q = 0; q < 3; q++)
    bw_release(&f[q]);
  flow_destroy(&grid, &ns);
  return st;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  const char *source = "manufactured solution between walls";
  const double tolerance = full ? 0.075 : 0.15;
  errors coarse, fine;
  char extra[96];
  BW_TRY(steady(bw_validation_comm(v), full ? 24 : 12, &coarse));
  BW_TRY(steady(bw_validation_comm(v), full ? 48 : 24, &fine));
  snprintf(extra, sizeof extra, "\"errors\": [%.3e, %.3e, %.3e]", fine.u, fine.p, fine.p_rms);
  const bw_claim claims[] = {
      {"velocity between walls, stretched: order in space", "order_velocity",
       bw_validation_order(2.0, coarse.u, 1.0, fine.u), 2.0, tolerance, BW_ORDER, source, extra},
      {"pressure between walls, stretched: order of the largest error", "order_pressure",
       bw_validation_order(2.0, coarse.p, 1.0, fine.p), 2.0, tolerance, BW_ORDER, source, extra},
      {"pressure between walls, stretched: order of the rms error", "order_pressure_rms",
       bw_validation_order(2.0, coarse.p_rms, 1.0, fine.p_rms), 2.0, tolerance, BW_ORDER, source,
       extra}};
  for (size_t q = 0; q < sizeof claims / sizeof *claims; q++)
    bw_validation_row(v, &claims[q]);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.manufactured", run);
}
