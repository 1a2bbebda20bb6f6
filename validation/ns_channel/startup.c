/* Claim: transients between walls follow the exact series: start-up of Poiseuille and of Couette
 * flow, and the oscillating (Womersley) channel; second order in space.
 * Reference: start-up from rest under G, y from the centre, half-height h:
 *   u = G/(2 nu) (h^2 - y^2)
 *       - 16 G h^2/(nu pi^3) sum (-1)^n/(2n+1)^3 cos((2n+1) pi y/2h) exp(-(2n+1)^2 pi^2 nu t/4h^2);
 * Couette: u/U = y/H + sum 2 (-1)^n/(n pi) sin(n pi y/H) exp(-n^2 pi^2 nu t/H^2);
 * Womersley: u = Re{A/(i w) [1 - cosh(sqrt(i w/nu) y)/cosh(sqrt(i w/nu) h)] e^(i w t)}, alpha = 6.
 * Measured: largest error over U_max on 16 and 32 cells, each form of the viscous term.
 * Tolerance: order 2 to 5 % (fourth-order terms at 16 cells). Error: the mirror ghost shifts the
 * profile by dy^2/8 of its curvature (validation poiseuille.c); half as much is left for the
 * truncation inside. Curvatures over the scale: G/nu = 8; Couette 2 pi sum n exp(..) < 7 at the
 * end; Womersley, where nu u'' = -A at the wall: w/nu = 144.
 * TEST ranks=1,2 */
#include "flow.h"

#include <complex.h>

static const double pi = 3.141592653589793, height = 1.0, nu = 0.1;

static void poiseuille(const double x[3], double t, void *context, double u[3])
{
  const double h = 0.5 * height, y = x[1] - h, g = 8.0 * nu; /* U_max = 1 */
  (void)context;
  double s = 0.0;
  for (int n = 0; n < 40; n++) {
    const double m = 2 * n + 1;
    s += (n % 2 ? -1.0 : 1.0) / (m * m * m) * cos(m * pi * y / (2 * h)) *
         exp(-m * m * pi * pi * nu * t / (4 * h * h));
  }
  u[0] = g / (2 * nu) * (h * h - y * y) - 16 * g * h * h / (nu * pi * pi * pi) * s;
  u[1] = u[2] = 0.0;
}

static void couette(const double x[3], double t, void *context, double u[3])
{
  (void)context;
  u[0] = x[1] / height;
  for (int n = 1; n < 60; n++)
    u[0] += 2.0 * (n % 2 ? -1.0 : 1.0) / (n * pi) * sin(n * pi * x[1] / height) *
            exp(-n * n * pi * pi * nu * t / (height * height));
  u[1] = u[2] = 0.0;
}

static const double amplitude = 1.0, alpha = 6.0;

static double omega(void)
{
  return nu * alpha * alpha / (0.25 * height * height);
}

static void womersley(const double x[3], double t, void *context, double u[3])
{
  const double w = omega(), h = 0.5 * height;
  (void)context;
  const double complex root = csqrt(I * w / nu);
  const double complex shape = 1.0 - ccosh(root * (x[1] - h)) / ccosh(root * h);
  u[0] = creal(amplitude / (I * w) * shape * cexp(I * w * t));
  u[1] = u[2] = 0.0;
}

typedef struct {
  const char *name;
  bw_ns_velocity_fn exact;
  double gradient, lid, scale, curvature; /* curvature: max |u''|/scale [1/L^2] */
  bool oscillates;
} transient;

static bw_status error_of(const bw_comm *comm, const transient *f, int n, bw_ns_viscous viscous,
                          double *error)
{
  const flow_box box = {
      .n = {4, n, 1}, .length = {1.0, height, 1.0}, .periodic = {true, false, true}};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu, c.viscous = viscous;
  c.forcing = BW_FORCING_GRADIENT, c.forcing_value = f->gradient;
  c.side[1][1].velocity[0] = f->lid;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  const double period = 2 * pi / omega(), end = f->oscillates ? 0.8 * period : 0.4;
  if (f->oscillates) BW_TRY(bw_ns_channel_set_velocity(ns, f->exact, NULL, 0.0));
  const int steps = 40 * n; /* below the explicit limit at 32 cells; time error negligible */
  for (int step = 0; step < steps; step++) {
    const double dt = end / steps, middle = bw_ns_channel_time(ns) + 0.5 * dt;
    if (f->oscillates) bw_ns_channel_set_forcing(ns, amplitude * cos(omega() * middle));
    BW_TRY(bw_ns_channel_step(ns, dt));
  }
  *error = flow_error(ns, f->exact, NULL) / f->scale;
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const transient flows[] = {
      {"start-up of Poiseuille flow", poiseuille, 8.0 * nu, 0.0, 1.0, 8.0, false},
      {"start-up of Couette flow", couette, 0.0, 1.0, 1.0, 7.0, false},
      {"oscillating channel, alpha = 6", womersley, 0.0, 0.0, amplitude / omega(), 144.0, true}};
  for (size_t q = 0; q < sizeof flows / sizeof *flows; q++)
    for (int viscous = BW_VISCOUS_EXPLICIT; viscous <= BW_VISCOUS_IMPLICIT; viscous++) {
      const bw_ns_viscous kind = (bw_ns_viscous)viscous;
      const bw_comm *comm = bw_validation_comm(v);
      const char *extra = flow_viscous_name[viscous];
      double coarse, fine;
      BW_TRY(error_of(comm, &flows[q], 16, kind, &coarse));
      BW_TRY(error_of(comm, &flows[q], 32, kind, &fine));
      bw_validation_row(v, &(bw_claim){flows[q].name, "error_over_scale", fine, 0.0,
                                       1.5 * flows[q].curvature / (8.0 * 32 * 32), BW_ANALYTIC,
                                       "exact series", extra});
      bw_validation_row(v,
                        &(bw_claim){flows[q].name, "order", bw_validation_order(2, coarse, 1, fine),
                                    2.0, 0.05, BW_ORDER, "exact series", extra});
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.startup", run);
}
