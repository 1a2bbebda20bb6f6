/* Claim: after every step div u vanishes to round-off, whatever the sides, and volume is conserved.
 * Reference: zero; a direct Poisson solver leaves only round-off.
 * Measured: max |div u| dx/U over all cells and steps, 200 steps (--full 10 000), noise at the
 * start and in the inflow; net volume flux through all sides over the inflow. Tolerance: 1e-13 =
 * 450 epsilon: the correction differences p^ over dx, p^ being a sum over n = 24 modes per
 * direction, each rounded once.
 * TEST ranks=1,2,4 */
#include "flow.h"

static void noise(const double x[3], double t, void *context, double u[3])
{
  (void)context;
  for (int c = 0; c < 3; c++) {
    const double a = 43.5453 * sin(1.0 + t + 12.9898 * x[0] + 7.233 * x[1] + 3.719 * x[2] + c);
    u[c] = 0.5 * (a - floor(a)) + (c == 0 ? 0.75 : -0.25);
  }
}

typedef struct {
  const char *name;
  flow_box box;
  bool inflow;
  bw_ns_viscous viscous;
} scene;

static bw_status worst_of(bw_validation *v, const scene *s, double worst[2])
{
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 0.002, c.viscous = s->viscous;
  if (s->inflow) {
    c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].profile = BW_PROFILE_CALLBACK;
    c.side[0][0].function = noise;
    c.side[0][1].kind = BW_SIDE_OUTFLOW;
  }
  if (s->box.periodic[0]) c.forcing = BW_FORCING_FLOW_RATE, c.forcing_value = 1.0;
  BW_TRY(flow_create(bw_validation_comm(v), &s->box, &c, &grid, &ns));
  BW_TRY(bw_ns_channel_set_velocity(ns, noise, NULL, 0.0));
  worst[0] = worst[1] = 0.0;
  for (int step = 0; step < (bw_validation_full(v) ? 10000 : 200); step++) {
    BW_TRY(bw_ns_channel_step(ns, 0.5 * bw_ns_channel_dt_max(ns)));
    const bw_ns_summary sum = bw_ns_channel_summary(ns);
    worst[0] = fmax(worst[0], bw_ns_channel_divergence(ns));
    if (s->inflow) worst[1] = fmax(worst[1], fabs(1.0 - sum.outflow / sum.inflow));
  }
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const scene scenes[] = {{"channel, flow rate",
                           {{24, 20, 16}, {2.0, 1.0, 1.5}, {true, false, true}, 1.5, {0, 0}},
                           false,
                           BW_VISCOUS_EXPLICIT},
                          {"inflow, outflow, walls",
                           {{24, 20, 16}, {2.0, 1.0, 1.5}, {false, false, false}, 1.5, {0, 0}},
                           true,
                           BW_VISCOUS_EXPLICIT},
                          {"inflow, outflow, 2D",
                           {{24, 20, 1}, {2.0, 1.0, 0.1}, {false, false, true}, 0, {0, 0}},
                           true,
                           BW_VISCOUS_EXPLICIT},
                          {"channel, implicit y",
                           {{24, 20, 16}, {2.0, 1.0, 1.5}, {true, false, true}, 1.5, {0, 0}},
                           false,
                           BW_VISCOUS_IMPLICIT_Y},
                          {"inflow, outflow, walls, implicit",
                           {{24, 20, 16}, {2.0, 1.0, 1.5}, {false, false, false}, 1.5, {0, 0}},
                           true,
                           BW_VISCOUS_IMPLICIT}};
  for (size_t q = 0; q < sizeof scenes / sizeof *scenes; q++) {
    double worst[2];
    BW_TRY(worst_of(v, &scenes[q], worst));
    const double tolerance = 450 * BW_REAL_EPSILON;
    bw_validation_row(v, &(bw_claim){scenes[q].name, "max_divergence", worst[0], 0.0, tolerance,
                                     BW_CONSERVATION, "div u = 0", NULL});
    if (scenes[q].inflow)
      bw_validation_row(v, &(bw_claim){scenes[q].name, "max_net_flux_over_inflow", worst[1], 0.0,
                                       tolerance, BW_CONSERVATION, "what enters leaves", NULL});
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.divergence", run);
}
