/* state_test.h -- motions and checks that the state-based laws share. */
#pragma once
#include "law_test.h"

static inline void state_shake(const double X0[3], double v[3])
{
  v[0] = 0.3 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.2 * cos(3 * X0[1]) + 0.1 * X0[0];
  v[2] = 0.2 * sin(X0[2] * X0[0]);
}

static inline void state_tremble(const double X0[3], double v[3])
{
  state_shake(X0, v);
  for (int k = 0; k < 3; k++)
    v[k] *= 0.2;
}

/* All that is booked, with what particles dissipate. */
static inline double state_energy(bw_solid *pd)
{
  return pd_energy(pd) + ledger_of(pd).plastic;
}

/* Verlet's energy of an oscillation swings by (w dt)^2/8 to either side: w dt is at most twice the
 * part of the largest step. */
#define STATE_SWING(fraction) (0.5 * (fraction) * (fraction))

/* Largest departure of the energy over a time, in parts of it; momenta are kept. */
static inline double state_departure(const bw_solid_config *c, double fraction, double time,
                                     bw_solid_ledger *end)
{
  pd_body body = pd_box(9, 6, c->geometry == BW_PD_3D ? 5 : 1);
  bw_solid *pd = law_make(bw_check_world(), c, &body);
  pd_set(pd, NULL, state_tremble);
  const bw_solid_ledger first = ledger_of(pd);
  const double dt = fraction * bw_solid_dt_max(pd), start = state_energy(pd);
  double worst = 0;
  for (int q = 0; q < (int)(time / dt); q++) {
    pd_steps(pd, 1, dt);
    worst = fmax(worst, fabs(state_energy(pd) / start - 1));
  }
  *end = ledger_of(pd);
  for (int k = 0; k < 3; k++) {
    bw_check_near(first.momentum[k], end->momentum[k], ROUND_OFF);
    bw_check_near(first.angular[k], end->angular[k], 10 * ROUND_OFF);
  }
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  return worst;
}

/* A shaken, breaking block on one rank, on all, and gone on with from a restart. */
static inline void state_check_ranks(const bw_solid_config *c)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(9, 6, c->geometry == BW_PD_3D ? 5 : 1);
  bw_solid *all = law_make(bw_check_world(), c, &body), *one = law_make(self, c, &body);
  bw_solid *next = law_make(bw_check_world(), c, &body);
  const double dt = 0.4 * bw_solid_dt_max(one);
  bw_check_near(bw_solid_dt_max(all) / bw_solid_dt_max(one), 1, 1e-5);
  pd_set(all, NULL, state_shake);
  pd_set(one, NULL, state_shake);
  pd_steps(all, 40, dt);
  pd_steps(one, 40, dt);
  pd_restart_from(all, next);
  ck_assert_int_gt(ledger_of(all).broken, 5);
  pd_steps(all, 20, dt);
  pd_steps(one, 20, dt);
  pd_steps(next, 20, dt);
  pd_check_same(all, one, bw_solid_get_position, 10 * ROUND_OFF);
  ck_assert_int_eq(ledger_of(all).broken, ledger_of(one).broken);
  bw_check_near(ledger_of(all).fracture, ledger_of(one).fracture, 10 * ROUND_OFF);
  pd_check_same(all, next, bw_solid_get_position, 0);
  pd_check_same(all, next, bw_solid_get_velocity, 0);
  bw_solid_destroy(&all);
  bw_solid_destroy(&one);
  bw_solid_destroy(&next);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}

/* Of a body turned by a large angle no force is left. */
static inline void state_turn(const double X0[3], double u[3])
{
  const double c = cos(2.1), s = sin(2.1);
  u[0] = (c - 1) * X0[0] - s * X0[1];
  u[1] = s * X0[0] + (c - 1) * X0[1];
  u[2] = 0;
}

static inline void state_check_turn(const bw_solid_config *c)
{
  pd_body body = pd_box(7, 6, c->geometry == BW_PD_3D ? 5 : 1);
  bw_solid *pd = law_make(bw_check_world(), c, &body);
  double *a = NULL;
  bw_check_ok(BW_ALLOCATE(&a, 3 * bw_solid_count(pd)));
  pd_set(pd, state_turn, NULL);
  bw_check_ok(bw_solid_evaluate(pd));
  bw_solid_get_acceleration(pd, a);
  for (size_t k = 0; k < 3 * bw_solid_count(pd); k++)
    bw_check_near(a[k] * c->rho * c->ds / c->E, 0, ROUND_OFF);
  /* W of a law that is not quadratic is rounded as its terms are. */
  bw_check_near(ledger_of(pd).elastic / (c->E * bw_solid_volume(pd) * (double)body.n), 0,
                ROUND_OFF);
  bw_release(&a);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
