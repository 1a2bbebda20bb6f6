/* Claim: the largest step that dt_max allows is stable, and the limits it is built from are sharp;
 * with an implicit viscous term viscosity does not limit it.
 * Reference: |1 + z + z^2/2 + z^3/6| <= 1 ends at z = -2.5127 and z = +-i sqrt(3); the scheme's
 * eigenvalues reach -4 nu sum 1/dx_i^2 (mode pi in every direction, n even) and
 * i sum |U_i|/dx_i (mode pi/2, n a multiple of 4). ERRATA 22 uses 1.65 for 2.51.
 * Measured: dt at which noise of amplitude 1e-10 stops to decay over 200 steps, by bisection, on a
 * periodic 8^3 box: viscous alone; a uniform stream alone; then both, and walls, at dt_max itself,
 * which in implicit runs is up to 4000 times the explicit limit.
 * Tolerance: 1 % on the limits: growth by exp(200 x) with x = 2 x 1 % is 50-fold, far from the
 * factor of the noise's transient; the convective amplification starts with the fourth order of
 * the excess, hence 10 % there from above and never below. dt_max: noise must not grow, factor 3.
 * TEST ranks=1,2 */
#include "flow.h"

typedef struct {
  double nu, stream[3];
  bool walls;
  bw_ns_viscous viscous;
} setting;

static void noisy(const double x[3], double t, void *context, double u[3])
{
  const setting *s = context;
  for (int c = 0; c < 3; c++) {
    const double a = 437.5453 * sin(1.0 + t + 12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + c);
    u[c] = s->stream[c] + 1e-10 * (2.0 * (a - floor(a)) - 1.0);
  }
}

static void smooth_stream(const double x[3], double t, void *context, double u[3])
{
  (void)x, (void)t;
  for (int c = 0; c < 3; c++)
    u[c] = ((const setting *)context)->stream[c];
}

/* Deviation from the stream after `steps` steps over that at the start. dt < 0: -dt times
 * dt_max. The parts are called, since step would refuse what is over the limit. */
static bw_status growth(const bw_comm *comm, const setting *s, double dt, int steps, double *factor)
{
  const flow_box box = {
      .n = {8, 8, 8}, .length = {1.0, 1.0, 1.0}, .periodic = {true, !s->walls, true}};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = s->nu, c.viscous = s->viscous;
  for (int q = 0; q < 2; q++) /* walls that go with the stream: it stays uniform */
    for (int d = 0; d < 3; d += 2)
      c.side[1][q].velocity[d] = s->stream[d];
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  BW_TRY(bw_ns_channel_set_velocity(ns, noisy, (void *)(uintptr_t)s, 0.0));
  const double start = flow_error(ns, smooth_stream, (void *)(uintptr_t)s);
  if (dt < 0) dt = -dt * bw_ns_channel_dt_max(ns);
  for (int step = 0; step < steps; step++)
    for (int r = 0; r < 3; r++) {
      bw_ns_channel_predict(ns, r, dt);
      bw_ns_channel_project(ns, r, dt);
    }
  *factor = flow_error(ns, smooth_stream, (void *)(uintptr_t)s) / start;
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status threshold(const bw_comm *comm, const setting *s, double low, double high,
                           int steps, double *dt)
{
  for (int q = 0; q < 9; q++) {
    const double middle = 0.5 * (low + high);
    double factor;
    BW_TRY(growth(comm, s, middle, steps, &factor));
    if (factor < 3.0)
      low = middle;
    else
      high = middle;
  }
  *dt = 0.5 * (low + high);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  const setting viscous = {.nu = 1.0}, convective = {.nu = 1e-9, .stream = {1.0, 0.0, 0.5}};
  const char *source = "stability function of three-stage third-order Runge-Kutta";
  double dt, factor;
  BW_TRY(threshold(comm, &viscous, 1.0 / (12 * 64), 4.0 / (12 * 64), 200, &dt));
  bw_validation_row(v, &(bw_claim){"viscous limit dt 12 nu/dx^2", "limit", dt * 12 * 64, 2.5127453,
                                   0.01, BW_ANALYTIC, source, NULL});
  BW_TRY(threshold(comm, &convective, 1.0 / 12, 2.5 / 12, 1000, &dt));
  bw_validation_row(v, &(bw_claim){"convective limit dt sum |U|/dx", "limit", dt * 12, 1.7320508,
                                   0.1, BW_ANALYTIC, source, NULL});
  const setting mixed[] = {{.nu = 0.005, .stream = {1.0, 0.0, 0.5}, .walls = true},
                           {.nu = 0.03, .stream = {1.0, 0.0, 0.5}, .walls = true},
                           {.nu = 0.5, .stream = {1.0, 0.0, 0.5}, .walls = true},
                           {.nu = 0.03, .stream = {1.0, 0.7, 0.5}, .walls = false}};
  for (int kind = BW_VISCOUS_EXPLICIT; kind <= BW_VISCOUS_IMPLICIT; kind++)
    for (size_t q = 0; q < sizeof mixed / sizeof *mixed; q++) {
      setting s = mixed[q];
      s.viscous = (bw_ns_viscous)kind;
      if (kind == BW_VISCOUS_IMPLICIT) s.nu *= 100.0;
      BW_TRY(growth(comm, &s, -1.0, 400, &factor));
      bw_validation_row(v, &(bw_claim){"at dt_max noise does not grow", "growth", factor, 0.0, 3.0,
                                       BW_ANALYTIC, source, flow_viscous_name[kind]});
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.stability_limit", run);
}
