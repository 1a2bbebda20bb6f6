/* Claim: without viscosity kinetic energy changes only by the time step's error: with dt^3 (RK3's
 * own loss), in periodic boxes and between stretched walls; with viscosity it decays as it should.
 * Reference: d/dt of the semi-discrete energy is zero (test_ns_kernels shows it to round-off); for
 * RK3 with z = i w dt: |1 + z + z^2/2 + z^3/6|^2 = 1 - (w dt)^4/12 + ..., a loss per step of fourth
 * order, so the loss over a fixed time goes with dt^3.
 * Measured: relative change of energy of a noise field over a fixed time, steps 20, 40, 80.
 * Tolerance: order 3 within 10 %: the next term is of relative order (w dt)^2 < 0.1 at 40 steps.
 * The sign: a loss, never a gain.
 * TEST ranks=1,2 */
#include "flow.h"

static void swirls(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  u[0] = sin(6.28318530718 * x[1]) + 0.7 * cos(12.5663706144 * x[2]) + 0.3;
  u[1] = cos(6.28318530718 * x[0]) * sin(3.14159265359 * x[1]);
  u[2] = 0.8 * sin(6.28318530718 * (x[0] + x[1]));
}

static bw_status loss_of(const bw_comm *comm, bool walls, int steps, double *loss)
{
  const flow_box box = {.n = {12, 12, 12},
                        .length = {1.0, 1.0, 1.0},
                        .periodic = {true, !walls, true},
                        .stretch = walls ? 1.2 : 0.0};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 1e-14; /* its decay, nu k^2 t < 1e-11, does not show */
  c.side[1][0].kind = c.side[1][1].kind = BW_SIDE_FREE_SLIP;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  BW_TRY(bw_ns_channel_set_velocity(ns, swirls, NULL, 0.0));
  const double before = bw_ns_channel_summary(ns).kinetic_energy;
  BW_TRY(flow_run(ns, 0.4, steps));
  *loss = 1.0 - bw_ns_channel_summary(ns).kinetic_energy / before;
  flow_destroy(&grid, &ns);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const char *name[] = {"periodic box", "free-slip sides, stretched y"};
  const char *source = "RK3 damps oscillations by (w dt)^4/12 of their energy per step";
  for (int walls = 0; walls < 2; walls++) {
    double loss[3];
    for (int q = 0; q < 3; q++)
      BW_TRY(loss_of(bw_validation_comm(v), walls, 20 << q, &loss[q]));
    bw_validation_row(v, &(bw_claim){name[walls], "order_of_energy_loss",
                                     bw_validation_order(2, loss[1], 1, loss[2]), 3.0, 0.1,
                                     BW_ORDER, source, NULL});
    bw_validation_row(v, &(bw_claim){name[walls], "sign_of_energy_loss", loss[2] > 0 ? 1.0 : -1.0,
                                     1.0, 0.0, BW_CONSERVATION, source, NULL});
    /* w dt of the fastest motion: sum |u|/dx dt = 2.8 12 0.4/80 = 0.17 */
    bw_validation_row(v, &(bw_claim){name[walls], "energy_loss_at_80_steps", loss[2], 0.0,
                                     80 * 0.17 * 0.17 * 0.17 * 0.17 / 12, BW_CONSERVATION, source,
                                     NULL});
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.energy_conservation", run);
}
