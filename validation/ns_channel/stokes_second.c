/* Claim: walls may move as a function of time: Stokes' second problem, second order in space.
 *
 * Reference: u = U e^(-k y) cos(w t - k y), k = sqrt(w/(2 nu)), an exact solution for all y; the
 * upper wall moves as this solution does there, so that no domain is cut off.
 *
 * Measured: from the exact field at t = 0 to a quarter beyond one period, k H = 4; largest error
 * over U on 16 and 32 cells; each form of the viscous term; and with the wall in z instead of
 * y.
 *
 * Tolerance: order 2 within 10 % (fourth-order terms at 16 cells: (k dy)^2 = 6 %, twice over two
 * grids 0.06/log 2). Error: the mirror ghost shifts the cells at a wall by dy^2/8 of the curvature,
 * which is at most 2 k^2 U; as much again is left for the truncation inside: dy^2 k^2/2 = 8e-3 on
 * 32 cells.
 *
 * TEST ranks=1,2 */
#include "flow.h"

static const double nu = 0.1, height = 1.0, k = 4.0, pi = 3.141592653589793;

typedef struct {
  int normal; /* direction that the walls bound */
} layer;

static void exact(const double x[3], double t, void *context, double u[3])
{
  const double y = x[((const layer *)context)->normal], w = 2.0 * nu * k * k;
  u[0] = exp(-k * y) * cos(w * t - k * y);
  u[1] = u[2] = 0.0;
}

static bw_status error_of(const bw_comm *comm, int n, int normal, bw_ns_viscous viscous,
                          double *error)
{
  layer l = {normal};
  flow_box box = {.n = {4, n, 1}, .length = {1.0, height, 1.0}, .periodic = {true, false, true}};
  if (normal == 2) box.n[1] = 4, box.n[2] = n, box.periodic[1] = true, box.periodic[2] = false;
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = nu, c.viscous = viscous;
  for (int s = 0; s < 2; s++)
    c.side[normal][s] = (bw_ns_side){
        .kind = BW_SIDE_WALL, .profile = BW_PROFILE_CALLBACK, .function = exact, .context = &l};
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  BW_TRY(bw_ns_channel_set_velocity(ns, exact, &l, 0.0));
  const double period = 2.0 * pi / (2.0 * nu * k * k);
  bw_status st = flow_run(ns, 1.25 * period, 75 * n * n / 64);
  *error = flow_error(ns, exact, &l);
  flow_destroy(&grid, &ns);
  return st;
}

static bw_status run(bw_validation *v)
{
  static const struct {
    const char *name;
    int normal;
    bw_ns_viscous viscous;
  } form[] = {{"walls in y, explicit", 1, BW_VISCOUS_EXPLICIT},
              {"walls in y, implicit y", 1, BW_VISCOUS_IMPLICIT_Y},
              {"walls in y, implicit", 1, BW_VISCOUS_IMPLICIT},
              {"walls in z, explicit", 2, BW_VISCOUS_EXPLICIT},
              {"walls in z, implicit", 2, BW_VISCOUS_IMPLICIT}};
  const char *source = "Stokes' second problem, closed form";
  for (size_t q = 0; q < sizeof form / sizeof *form; q++) {
    double e[2];
    for (int g = 0; g < 2; g++)
      BW_TRY(error_of(bw_validation_comm(v), 16 << g, form[q].normal, form[q].viscous, &e[g]));
    bw_claim c = {form[q].name, "order", bw_validation_order(2.0, e[0], 1.0, e[1]),
                  2.0,          0.1,     BW_ORDER,
                  source,       NULL};
    bw_validation_row(v, &c);
    c = (bw_claim){form[q].name, "max_error", e[1], 0.0, 8e-3, BW_ANALYTIC, source, NULL};
    bw_validation_row(v, &c);
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.stokes_second", run);
}
