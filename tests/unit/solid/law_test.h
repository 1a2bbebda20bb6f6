/* law_test.h -- what every law has to hold, for the tests of laws of their own. */
#pragma once
#include "bw_solid_static.h"
#include "pd_test.h"

static const double ROUND_OFF = 200 * BW_REAL_EPSILON;

/* A body; of two materials where the config has two: from the third layer along x on the other. */
static inline bw_solid *law_make(const bw_comm *comm, const bw_solid_config *c, const pd_body *body)
{
  bw_solid *s = NULL;
  uint8_t *group = NULL;
  if (c->more.n == 0) return pd_make(comm, c, body);
  bw_check_ok(BW_ALLOCATE(&group, (size_t)body->n));
  for (int64_t q = 0; q < body->n; q++)
    group[q] = body->site[3 * q] > 1;
  const int64_t n = bw_comm_rank(comm) == 0 ? body->n : 0;
  bw_check_ok(bw_solid_create(comm, c, &(bw_pd_sites){n, body->site, body->kind, group}, &s));
  bw_release(&group);
  return s;
}

static void wave(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = 0.05 * sin(1.3 * X0[(k + 1) % 3] + k);
}

/* Central differences of the elastic energy. */
static void check_force(const bw_solid_config *c)
{
  const double h = 1e-4 * 0.5;
  bw_comm *self = pd_alone();
  pd_body body = pd_box(4, 4, 3);
  bw_solid *pd = law_make(self, c, &body);
  double X[3 * 48], V[3 * 48] = {0}, a[3 * 48], most = 0, difference = 0;
  pd_set(pd, wave, NULL);
  bw_check_ok(bw_solid_evaluate(pd));
  bw_solid_get_acceleration(pd, a);
  bw_solid_get_position(pd, X);
  for (size_t q = 0; q < 3 * 48; q += 7) {
    double E[2];
    for (int side = 0; side < 2; side++) {
      X[q] += side == 0 ? h : -2 * h;
      bw_solid_set_state(pd, X, V);
      E[side] = ledger_of(pd).elastic;
    }
    X[q] += h;
    const double force = c->rho * bw_solid_volume(pd) * a[q];
    most = fmax(most, fabs(force));
    difference = fmax(difference, fabs(force + (E[0] - E[1]) / (2 * h)));
  }
  /* Third derivatives over h/ds = 1e-4, and rounding of displacements near 0.05 over h. */
  ck_assert_double_gt(most, 0);
  ck_assert_double_lt(difference, fmax(1e-6, 1e4 * BW_REAL_EPSILON) * most);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}

/* A bar that is held at both ends, drawn by a strain of 1e-4 and bent: relaxation and the linear
 * solve agree to the strain, or in single precision to the residual times what bending multiplies
 * it by. */
static void check_rest(const bw_solid_config *c)
{
  pd_body body = pd_box(10, 4, 4);
  for (int64_t q = 0; q < body.n; q++)
    if (body.site[3 * q] < 2 || body.site[3 * q] > 7) body.kind[q] = BW_PD_PRESCRIBED;
  bw_solid *pd = law_make(bw_check_world(), c, &body);
  const size_t n = bw_solid_count(pd);
  double *U = NULL, *X = NULL, *X0 = NULL, *V = NULL, *F = NULL;
  double **array[] = {&U, &X, &X0, &V, &F};
  for (int q = 0; q < 5; q++)
    bw_check_ok(BW_ALLOCATE(array[q], 3 * n));
  bw_solid_get_reference(pd, X0);
  for (size_t i = 0; i < n; i++) {
    U[3 * i] = bw_solid_kind(pd)[i] & BW_PD_PRESCRIBED ? 1e-4 * X0[3 * i] : 0;
    F[3 * i + 1] = 1e-4; /* and bent by a force */
    for (size_t k = 0; k < 3; k++)
      X[3 * i + k] = X0[3 * i + k] + U[3 * i + k];
  }
  bw_solid_set_state(pd, X, V);
  bw_solid_set_force(pd, F);
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  const bool loose = BW_REAL_EPSILON > 1e-10;
  how.tolerance = loose ? 1e-4 : 1e-8;
  bw_check_ok(bw_solid_static_linear(pd, &how, U, &report));
  bw_check_ok(bw_solid_static_relax(pd, &how, &report));
  bw_solid_get_position(pd, X);
  double difference = 0, size = 0;
  for (size_t q = 0; q < 3 * n; q++) {
    difference = fmax(difference, fabs(X[q] - X0[q] - U[q]));
    size = fmax(size, fabs(U[q]));
  }
  bw_comm_max(bw_check_world(), 1, &difference);
  bw_comm_max(bw_check_world(), 1, &size);
  ck_assert_double_lt(difference,
                      (loose ? 100 : 10) * 1e-4 * size); /* terms of second order in the strain */
  for (int q = 0; q < 5; q++)
    bw_release(array[q]);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
