/* The energy book of state-based bodies.
 *
 * Claim      Kinetic and elastic energy, and what broke or flowed, keep their sum: to 1e-4 at a
 *            tenth of the largest step, and to the second order of the step.
 * Reference  conservation of energy.
 * Measured   shaken blocks of 12 x 8 x 5 particles, free, at 0.1 and 0.05 of the largest step, over
 *            the same time; departure of the sum in parts of the energy at the start.
 * Tolerance  Verlet's energy swings by (w dt)^2/8, 5e-3 of what the shortest waves hold at a tenth
 *            of the largest step, and 1e-4 for the body's own longest ones, which are excited here.
 *            What breaks sends out short waves: 5e-3 of a fifth of the energy, 1e-3. Order: 2 to
 *            0.075; with breaking or yield, whose instants shift by steps, it is reported.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "state.h"

static const double E = 3, TIME = 8;

static void shaken(const double x[3], double V[3], const void *data)
{
  const double size = *(const double *)data;
  V[0] = size * 0.3 * sin(0.5 * x[0] + 0.3 * x[1]);
  V[1] = size * (0.2 * cos(0.7 * x[1]) + 0.1 * x[0]);
  V[2] = size * 0.2 * sin(0.2 * x[2] * x[0]);
}

/* Largest departure in parts of the energy at the start. */
static bw_status departure(const bw_comm *comm, const bw_solid_config *c, double size,
                           double fraction, double *worst, bw_solid_ledger *end)
{
  bw_solid *pd = NULL;
  BW_TRY(body_make(comm, c, (int[3]){12, 8, 5}, NULL, NULL, &pd));
  BW_TRY(bw_solid_load_velocity(pd, shaken, &size));
  BW_TRY(bw_solid_account(pd, end));
  const double start = end->kinetic, dt = fraction * bw_solid_dt_max(pd);
  *worst = 0;
  for (double t = 0; t < TIME;) {
    for (int q = 0; q < 4; q++, t += dt)
      BW_TRY(bw_solid_step(pd, dt));
    BW_TRY(bw_solid_account(pd, end));
    const double sum = end->kinetic + end->elastic + end->fracture + end->plastic;
    *worst = fmax(*worst, fabs(sum / start - 1));
  }
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status book(bw_validation *v, const bw_solid_config *c, double size, const char *extra)
{
  double coarse, fine;
  bw_solid_ledger end;
  BW_TRY(departure(bw_validation_comm(v), c, size, 0.1, &coarse, &end));
  BW_TRY(departure(bw_validation_comm(v), c, size, 0.05, &fine, &end));
  const bool broke = end.broken > 0;
  state_claim(v, "no energy is lost or made", "departure", coarse, 0, broke ? 1e-3 : 1e-4,
              BW_CONSERVATION, "conservation of energy", extra);
  state_claim(v, "no energy is lost or made", "order", bw_validation_order(2, coarse, 1, fine), 2,
              broke || end.plastic > 0 ? INFINITY : 0.075, BW_ORDER, "Verlet", extra);
  state_claim(v, "what the body has spent", "fracture_and_plastic",
              (end.fracture + end.plastic) / (end.kinetic + end.elastic), 0, INFINITY,
              BW_CONSERVATION, "the book", extra);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  bw_solid_config c = bw_solid_config_default();
  c.ds = 0.5, c.rho = 2, c.E = E, c.nu = 0.4, c.horizon_ratio = 2;
  c.law = &bw_pd_state_ordinary_law;
  BW_TRY(book(v, &c, 0.05, "\"law\": \"ordinary\""));
  c.G0 = 2e-4;
  BW_TRY(book(v, &c, 0.2, "\"law\": \"ordinary, breaks\""));
  c.law = &bw_pd_state_correspondence_law, c.law_options = &o, c.G0 = INFINITY;
  BW_TRY(book(v, &c, 0.05, "\"law\": \"correspondence\""));
  c.G0 = 2e-4;
  BW_TRY(book(v, &c, 0.2, "\"law\": \"correspondence, breaks\""));
  c.G0 = INFINITY;
  o.yield[0] = bw_pd_material_j2(0.02, 0.3);
  return book(v, &c, 0.2, "\"law\": \"correspondence, yields\"");
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.ledger", run);
}
