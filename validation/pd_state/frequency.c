/* The first bending frequency of a strip, in correspondence.
 *
 * Claim      A cantilever of 10 layers swings at the frequency of plane elasticity.
 * Reference  finite elements with nine nodes (another program, numpy): w L^2 sqrt(rho H/E'I) =
 *            3.49540 at nu = 0.3 and 3.50365 at nu = 0.3975, L/H = 10, plane strain (Euler and
 *            Bernoulli: 3.51602).
 * Measured   from rest with velocities of the first mode; time between the first and the third
 *            passage of the tip through its place, at 0.8 of the largest step. Weights of 1.5
 *            spacings.
 * Tolerance  1 %: half of what the tip's stiffness may be off with 10 layers (pd_state.cantilever);
 *            the step's own error, (w dt)^2/24, is below 1e-6.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "beam.h"

static const double E = 5;

/* First mode of a clamped beam at x from 0 to 1 (Euler and Bernoulli). */
static double mode(double x)
{
  const double k = 1.87510407, ratio = 0.73409551;
  return cosh(k * x) - cos(k * x) - ratio * (sinh(k * x) - sin(k * x));
}

static bw_status swing(bw_validation *v, double nu, double reference)
{
  const bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  const bw_solid_config c = beam_material(BW_PD_PLANE_STRAIN, E, nu, 1.5, &o);
  beam b = {.length = 100, .height = 10};
  BW_TRY(beam_make(bw_validation_comm(v), &c, &b));
  const double L = b.length, H = b.height;
  for (size_t i = 0; i < bw_solid_count(b.pd); i++)
    b.r.V[3 * i + 1] = 1e-5 * fmax(0, mode((b.r.X0[3 * i] - b.clamp) / L));
  for (size_t i = 0; i < bw_solid_count(b.pd); i++)
    if (b.r.X0[3 * i] < b.clamp) b.r.V[3 * i + 1] = 0;
  bw_solid_set_state(b.pd, b.r.X0, b.r.V);
  const double dt = 0.8 * bw_solid_dt_max(b.pd);
  double before = 0, crossing[2] = {0};
  int n = 0;
  for (int step = 1; n < 2 && step < 100000; step++) {
    BW_TRY(bw_solid_step(b.pd, dt));
    bw_solid_get_position(b.pd, b.r.X);
    for (size_t k = 0; k < 3 * bw_solid_count(b.pd); k++)
      b.r.X[k] -= b.r.X0[k];
    const double now = beam_column(&b, b.length - 1, b.r.X, 1);
    if (step > 10 && now * before < 0) crossing[n++] = (step - now / (now - before)) * dt;
    before = now;
  }
  /* Half a period lies between. */
  const double w = STATE_PI / (crossing[1] - crossing[0]);
  const double unit = sqrt(E / (1 - nu * nu) * H * H / 12) / (L * L);
  char extra[40];
  snprintf(extra, sizeof extra, "\"nu\": %g", nu);
  state_claim(v, "beams swing as in elasticity", "omega", w / unit, reference, 0.01,
              BW_INDEPENDENT_CODE, "finite elements", extra);
  beam_release(&b);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(swing(v, 0.3, 3.49540));
  return swing(v, 0.3975, 3.50365);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.frequency", run);
}
