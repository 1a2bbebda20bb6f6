/* Momentum and energy of a body that is shaken until it cracks and its pieces collide.
 *
 * Claim      Bonds, pair damping and contact exchange momentum between particles and create none;
 *            the ledger accounts for every energy.
 * Reference  conservation laws: momentum and angular momentum stay; kinetic + elastic + contact +
 *            damping + fracture is constant.
 * Tolerance  momenta: rounding, 1e-12 of the sum of |m V| (some 1e7 additions of random sign in
 *            double). Energy with Verlet at a tenth of the limit: its error (w dt)^2/8 = 0.5 % of
 *            the elastic energy that passes to and fro, taken of the whole; it has to fall by four
 *            (order 2) with half the step as long as nothing breaks.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

static bw_status make(const bw_comm *comm, double G0, double damping, bw_solid **pd)
{
  enum { NX = 20, NY = 10, NZ = 8 };
  bw_solid_config c = bw_solid_config_default();
  c.ds = 1e-3;
  c.rho = 1200;
  c.E = 1e8;
  c.G0 = G0;
  c.damping.pair = damping;
  c.contact = true;
  int32_t *site = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * NX * NY * NZ));
  for (int32_t q = 0; q < NX * NY * NZ; q++) {
    site[3 * q] = q % NX;
    site[3 * q + 1] = q / NX % NY;
    site[3 * q + 2] = q / NX / NY;
  }
  BW_TRY(bw_solid_create_same(comm, &c, NX * NY * NZ, site, NULL, pd));
  bw_release(&site);

  double *X = NULL, *V = NULL;
  const size_t n = bw_solid_count(*pd);
  BW_TRY(BW_ALLOCATE(&X, 3 * n));
  BW_TRY(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_reference(*pd, X);
  for (size_t i = 0; i < n; i++) {
    const double *x = X + 3 * i;
    V[3 * i] = 5 + 20 * sin(600 * x[0] + 200 * x[1]);
    V[3 * i + 1] = 15 * cos(500 * x[0]) * sin(300 * x[2]);
    V[3 * i + 2] = 10 * sin(400 * x[1] + 100 * x[0]);
  }
  bw_solid_set_state(*pd, X, V);
  bw_release(&X);
  bw_release(&V);
  return BW_OK;
}

static double total(const bw_solid_ledger *l)
{
  return l->kinetic + l->elastic + l->contact + l->damping + l->fracture;
}

static bw_status span(const bw_comm *comm, double G0, double damping, double fraction, double time,
                      bw_solid_ledger *first, bw_solid_ledger *last)
{
  bw_solid *pd = NULL;
  BW_TRY(make(comm, G0, damping, &pd));
  const double dt = fraction * bw_solid_dt_max(pd);
  bw_status st = bw_solid_account(pd, first);
  for (int q = 0; q < (int)lround(time / dt) && st == BW_OK; q++)
    st = bw_solid_step(pd, dt);
  BW_THEN(st, bw_solid_account(pd, last));
  bw_solid_destroy(&pd);
  return st;
}

static bw_status cracking(bw_validation *v)
{
  bw_solid_ledger a, b;
  char extra[80];
  BW_TRY(span(bw_validation_comm(v), 20, 5e13, 0.1, 3e-4, &a, &b));
  const double mass = 1200 * 1600e-9, size = sqrt(2 * mass * a.kinetic);
  snprintf(extra, sizeof extra, "\"broken\": %lld, \"bonds\": %lld", (long long)b.broken,
           (long long)b.bonds);
  double p = 0, h = 0;
  for (int k = 0; k < 3; k++) {
    p = fmax(p, fabs(b.momentum[k] - a.momentum[k]) / size);
    h = fmax(h, fabs(b.angular[k] - a.angular[k]) / (size * 0.02));
  }
  const bw_claim rows[] = {
      {"cracking conserves momentum", "momentum_drift", p, 0, 1e-12, BW_CONSERVATION, "third law",
       extra},
      {"cracking conserves angular momentum", "angular_drift", h, 0, 1e-12, BW_CONSERVATION,
       "central forces", extra},
      {"the energy book closes", "energy_total", total(&b), total(&a), 0.005, BW_CONSERVATION,
       "first law", extra},
      {"there was damping to account for", "damping_share", b.damping / total(&a), 0, INFINITY,
       BW_CONSERVATION, "for information", extra},
      {"there was fracture to account for", "fracture_share", b.fracture / total(&a), 0, INFINITY,
       BW_CONSERVATION, "for information", extra}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_validation_row(v, &rows[q]);
  BW_REQUIRE(b.broken > 1000, BW_EINPUT, "conservation: only %lld bonds broke; nothing was tested",
             (long long)b.broken);
  return BW_OK;
}

static bw_status whole(bw_validation *v)
{
  double error[2];
  for (int q = 0; q < 2; q++) {
    bw_solid_ledger a, b;
    BW_TRY(span(bw_validation_comm(v), INFINITY, 5e13, 0.1 / (1 << q), 5e-5, &a, &b));
    error[q] = fabs(total(&b) - total(&a)) / total(&a);
  }
  bw_validation_row(v, &(bw_claim){.claim = "the energy error falls with the square of the step",
                                   .quantity = "energy_order",
                                   .measured = bw_validation_order(2, error[0], 1, error[1]),
                                   .reference = 2,
                                   .tolerance = 0.2,
                                   .kind = BW_ORDER,
                                   .source = "velocity Verlet"});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(cracking(v));
  return whole(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.conservation", run);
}
