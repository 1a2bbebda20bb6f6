/* Turned and spinning bodies.
 *
 * Claim      A body that is turned rigidly has no force and no energy; one that is deformed and
 *            turned has the energy of the deformed one and forces that turn with it; a free body
 *            that spins keeps momentum and angular momentum, for all state-based laws.
 * Reference  objectivity; conservation of momentum.
 * Measured   clouds of 8 x 7 x 6 particles, turned by 2.1 rad about z; forces over mu times the
 *            square of the spacing. Spin: 1000 steps, one turn.
 * Tolerance  1e-12: sums of some 100 bonds, each rounded to 1e-16 of places ten spacings from the
 *            axis. Momenta: 1e-13 of the sum of what all
 *            particles carry, 1000 steps of rounding.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "state.h"

static const double E = 5, NU = 0.4, ANGLE = 2.1;

static void turned(const double x[3], double out[3])
{
  const double c = cos(ANGLE), s = sin(ANGLE), y[3] = {x[0], x[1], x[2]};
  out[0] = c * y[0] - s * y[1];
  out[1] = s * y[0] + c * y[1];
  out[2] = y[2];
}

/* Energy, and forces over density to r->F, of the present r->X. */
static bw_status evaluate(bw_solid *pd, body_rows *r, double *energy)
{
  bw_solid_ledger e;
  memset(r->V, 0, 3 * bw_solid_count(pd) * sizeof *r->V);
  bw_solid_set_state(pd, r->X, r->V);
  BW_TRY(bw_solid_account(pd, &e));
  bw_solid_get_acceleration(pd, r->F);
  *energy = e.elastic;
  return BW_OK;
}

static double largest(const bw_solid *pd, const double F[])
{
  double most = 0;
  for (size_t k = 0; k < 3 * bw_solid_count(pd); k++)
    most = fmax(most, fabs(F[k]));
  bw_comm_max(bw_solid_comm(pd), 1, &most);
  return most;
}

static bw_status turn(bw_validation *v, bw_solid *pd, body_rows *r, const char *law)
{
  double rigid, strained, both, *F = NULL;
  const double mu = E / (2 * (1 + NU));
  const size_t n = bw_solid_count(pd);
  BW_TRY(BW_ALLOCATE(&F, 3 * n));
  for (size_t i = 0; i < n; i++)
    turned(r->X0 + 3 * i, r->X + 3 * i);
  BW_TRY(evaluate(pd, r, &rigid));
  state_claim(v, "rigid turns cost nothing", "force", largest(pd, r->F) / mu, 0, 1e-12,
              BW_CONSERVATION, "objectivity", law);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++)
      r->X[3 * i + k] = r->X0[3 * i + k] + 0.1 * sin(r->X0[3 * i + (k + 1) % 3]);
  BW_TRY(evaluate(pd, r, &strained));
  memcpy(F, r->F, 3 * n * sizeof *F);
  for (size_t i = 0; i < n; i++)
    turned(r->X + 3 * i, r->X + 3 * i);
  BW_TRY(evaluate(pd, r, &both));
  for (size_t i = 0; i < n; i++) {
    turned(F + 3 * i, F + 3 * i);
    for (size_t k = 0; k < 3; k++)
      F[3 * i + k] -= r->F[3 * i + k];
  }
  state_claim(v, "rigid turns cost nothing", "energy", rigid / strained, 0, 1e-12, BW_CONSERVATION,
              "objectivity", law);
  state_claim(v, "what is turned keeps its energy and turns its forces", "energy", both / strained,
              1, 1e-12, BW_CONSERVATION, "objectivity", law);
  state_claim(v, "what is turned keeps its energy and turns its forces", "force",
              largest(pd, F) / largest(pd, r->F), 0, 1e-12, BW_CONSERVATION, "objectivity", law);
  bw_release(&F);
  return BW_OK;
}

static bw_status spin(bw_validation *v, bw_solid *pd, body_rows *r, const char *law)
{
  enum { STEPS = 1000 };
  const double dt = 0.5 * bw_solid_dt_max(pd), rate = 2 * STATE_PI / (STEPS * dt);
  bw_solid_ledger first, last;
  bw_solid_set_state(pd, r->X0, r->V);
  BW_TRY(bw_solid_load_launch(pd, (double[3]){0.01, 0, 0}, (double[3]){0, 0, rate},
                              (double[3]){4, 3.5, 3}));
  BW_TRY(bw_solid_account(pd, &first));
  for (int q = 0; q < STEPS; q++)
    BW_TRY(bw_solid_step(pd, dt));
  BW_TRY(bw_solid_account(pd, &last));
  /* What all particles would carry if none cancelled. */
  const double scale = sqrt(2 * first.kinetic * (double)bw_solid_total(pd));
  for (int k = 0; k < 3; k++) {
    state_claim(v, "momenta are kept", "momentum", (last.momentum[k] - first.momentum[k]) / scale,
                0, 1e-13, BW_CONSERVATION, "free body", law);
    state_claim(v, "momenta are kept", "angular_momentum",
                (last.angular[k] - first.angular[k]) / (10 * scale), 0, 1e-13, BW_CONSERVATION,
                "free body", law);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  const bw_pd_law *law[] = {&bw_pd_state_ordinary_law, &bw_pd_state_correspondence_law,
                            &bw_pd_state_correspondence_law};
  static const char *const extra[] = {"\"law\": \"ordinary\"",
                                      "\"law\": \"correspondence, neo-Hookean\"",
                                      "\"law\": \"correspondence, Hencky\""};
  for (int q = 0; q < 3; q++) {
    bw_solid_config c = bw_solid_config_default();
    bw_solid *pd = NULL;
    body_rows r;
    c.ds = c.rho = 1, c.E = E, c.nu = NU, c.horizon_ratio = 2, c.disorder = 0.3;
    c.law = law[q];
    o.elastic = q == 2 ? BW_PD_MATERIAL_HENCKY : BW_PD_MATERIAL_NEO_HOOKEAN;
    if (q > 0) c.law_options = &o;
    BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){8, 7, 6}, NULL, NULL, &pd));
    BW_TRY(body_rows_make(pd, &r));
    BW_TRY(turn(v, pd, &r, extra[q]));
    BW_TRY(spin(v, pd, &r, extra[q]));
    body_rows_release(&r);
    bw_solid_destroy(&pd);
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.objectivity", run);
}
