/* Levels that change while a body moves: what stays, and when; ranks, restart, refusals.
 * TEST ranks=1,2,3,4 */
#include "bw_solid_levels.h"
#include "levels_test.h"
#include "pd_body.h"

/* A plate or block of which boxes become finer and coarser. */
static bw_solid_config changing(bw_pd_geometry geometry, int level)
{
  bw_solid_config c = pd_soft(geometry);
  c.surface_correction = BW_PD_SURFACE_NONE;
  if (geometry == BW_PD_3D) c.horizon_ratio = 2;
  c.finer.refine.level = level;
  return c;
}

static void shake(const double X0[3], double v[3])
{
  v[0] = 0.3 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.2 * cos(3 * X0[1]) + 0.1 * X0[0];
  v[2] = 0;
}

/* All energy there is and was, with what changes of levels took. */
static double all_energy(bw_solid *pd)
{
  return pd_energy(pd) + ledger_of(pd).regrid;
}

/* Mass times place of all particles. */
static void centre(const bw_solid *pd, double sum[3])
{
  const size_t n = bw_solid_count(pd);
  double *X = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_solid_get_position(pd, X);
  memset(sum, 0, 3 * sizeof *sum);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++)
      sum[k] += bw_solid_volume_of(pd, i) * bw_solid_density(pd, i) * X[3 * i + k];
  bw_comm_sum(bw_solid_comm(pd), 3, sum);
  bw_release(&X);
}

/* Boxes that come, move and go: momentum and centre of mass stay, and the book is closed. */
START_TEST(momentum_and_book_are_kept)
{
  for (int way = 0; way < 4; way++) {
    const bool space = way % 2 == 1;
    const bw_solid_config c =
        changing(space ? BW_PD_3D : BW_PD_PLANE_STRESS, way < 2 ? 2 - space : 1);
    pd_body body = space ? pd_box(10, 8, 6) : pd_box(17, 13, 1);
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    pd_set(pd, levels_shift, shake);
    const double dt = 0.2 * bw_solid_dt_max(pd);
    const int64_t few = bw_solid_total(pd);
    for (int turn = 0; turn < 4; turn++) {
      const double x = 1 + 1.5 * turn;
      const bw_pd_box box = {c.finer.refine.level, {x, 1, 1}, {x + 1.6, 3, 3}};
      double from[3], to[3];
      pd_steps(pd, 1, dt);
      bw_check_ok(bw_solid_evaluate(pd));
      const bw_solid_ledger before = ledger_of(pd);
      const double energy = all_energy(pd);
      const int64_t revision = bw_solid_revision(pd);
      centre(pd, from);
      bw_check_ok(bw_solid_regrid(pd, turn < 3, &box));
      centre(pd, to);
      const bw_solid_ledger after = ledger_of(pd);
      ck_assert(turn == 3 ? bw_solid_total(pd) == few : bw_solid_total(pd) > few);
      ck_assert_int_gt(bw_solid_revision(pd), revision);
      bw_check_near(all_energy(pd), energy, 1e2 * BW_REAL_EPSILON);
      ck_assert_double_ne(after.regrid, before.regrid);
      for (int k = 0; k < 3; k++) {
        bw_check_near(after.momentum[k], before.momentum[k], 1e2 * BW_REAL_EPSILON);
        bw_check_near(to[k], from[k], 1e3 * BW_REAL_EPSILON);
      }
      bool changed = false;
      bw_check_ok(bw_solid_adapt(pd, &changed)); /* counts as looked at */
    }
    bw_solid_destroy(&pd);
    pd_body_release(&body);
  }
}
END_TEST

static void strain(const double X0[3], double u[3])
{
  u[0] = 0.01 * X0[0] - 0.02 * X0[1];
  u[1] = 0.03 * X0[0] + 0.015 * X0[1];
  u[2] = 0;
}

/* All of a body is refined: where nothing is strained nothing is after it, across periods too; a
 * wave keeps its kinetic energy to second order; parts are where a uniform strain has them. */
START_TEST(all_of_a_body_is_refined)
{
  bw_solid_config c = changing(BW_PD_PLANE_STRESS, 1);
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  c.period[0] = 16 * c.ds, c.period[1] = 14 * c.ds;
  pd_body body = pd_box(16, 14, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, shake);
  const bw_pd_box all = {1, {-9, -9, -9}, {99, 99, 99}};
  const double kinetic = ledger_of(pd).kinetic;
  bw_check_ok(bw_solid_regrid(pd, 1, &all));
  ck_assert_int_eq(bw_solid_total(pd), 4 * body.n);
  bw_check_near(ledger_of(pd).elastic, 0, BW_REAL_EPSILON);
  /* Second order in the spacing over the wave: 3 rad per length, spacing 0.5. */
  bw_check_near(ledger_of(pd).kinetic, kinetic, 0.1 * kinetic);
  bw_solid_destroy(&pd);
  /* A free body, strained uniformly. */
  c.period[0] = c.period[1] = 0;
  pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, strain, NULL);
  bw_check_ok(bw_solid_regrid(pd, 1, &all));
  double *X0 = NULL, *X = NULL;
  const size_t n = bw_solid_count(pd);
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_solid_get_reference(pd, X0);
  bw_solid_get_position(pd, X);
  for (size_t i = 0; i < n; i++) {
    double u[3];
    strain(X0 + 3 * i, u);
    for (size_t k = 0; k < 3; k++)
      bw_check_near(X[3 * i + k], X0[3 * i + k] + u[k], 1e2 * BW_REAL_EPSILON);
  }
  bw_release(&X0);
  bw_release(&X);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* A blow that breaks the plate where it hits. */
static void blow(const double X0[3], double v[3])
{
  const double r2 = pow(X0[0] - 3.1, 2) + pow(X0[1] - 3.3, 2);
  v[0] = 0.6 * (X0[0] - 3.1) * exp(-r2 / 1.5);
  v[1] = 0.45 * (X0[1] - 3.3) * exp(-r2 / 1.5);
  v[2] = 0;
}

static bw_solid_config breaking(int way)
{
  bw_solid_config c = changing(BW_PD_PLANE_STRESS, 1 + way % 2);
  c.horizon_ratio = 2;
  c.G0 = 0.02;
  c.surface_correction = way < 2 ? BW_PD_SURFACE_NONE : BW_PD_SURFACE_TENSOR;
  c.finer.refine.buffer = 2.5;
  c.finer.refine.trigger = way == 1 ? BW_PD_LEVELS_ENERGY : BW_PD_LEVELS_STRETCH;
  /* The share of the largest energy says nothing of breaking: what is pressed bears most. */
  if (way == 1) c.G0 = INFINITY;
  return c;
}

/* n steps, each with a look; how often levels changed. */
static int adaptive_steps(bw_solid *pd, int n, double dt)
{
  int changes = 0;
  for (int q = 0; q < n; q++) {
    bool changed = false;
    bw_check_ok(bw_solid_adapt(pd, &changed));
    changes += changed;
    bw_check_ok(bw_solid_step(pd, dt));
  }
  return changes;
}

/* Who breaks above the finest level ends a step: these runs say that nothing did. */
START_TEST(same_levels_motion_and_bonds_on_any_number_of_ranks)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(15, 14, 1);
  for (int way = 0; way < 3; way++) {
    const bw_solid_config c = breaking(way);
    bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
    pd_set(many, NULL, blow);
    pd_set(one, NULL, blow);
    const double dt = 0.5 * bw_solid_dt_max(one), energy = all_energy(one);
    const int a = adaptive_steps(many, 120, dt), b = adaptive_steps(one, 120, dt);
    ck_assert_int_ge(b, 1);
    ck_assert_int_eq(a, b);
    ck_assert_int_eq(bw_solid_total(many), bw_solid_total(one));
    if (way != 1) ck_assert_int_gt(ledger_of(one).broken, 10);
    ck_assert_int_eq(ledger_of(many).broken, ledger_of(one).broken);
    pd_check_same(many, one, bw_solid_get_position, 0);
    pd_check_same(many, one, bw_solid_get_velocity, 0);
    bw_check_near(all_energy(one), energy, 0.02 * energy);
    bw_solid_destroy(&many);
    bw_solid_destroy(&one);
  }
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* The largest of all energies is of rounding where nothing is strained yet. */
START_TEST(what_only_moves_is_not_refined_by_energy)
{
  pd_body body = pd_box(15, 14, 1);
  const bw_solid_config c = breaking(1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, blow);
  bool changed = true;
  bw_check_ok(bw_solid_adapt(pd, &changed));
  ck_assert(!changed);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Stop on many ranks, go on with one; levels change before and after, pre-cracks are cut again. */
START_TEST(restart_across_a_change)
{
  bw_comm *self = pd_alone();
  pd_body body = pd_box(15, 14, 1);
  const bw_solid_config c = breaking(2);
  const double from[3] = {0.2, 3.6, 0}, to[3] = {2.2, 3.6, 0};
  bw_solid *many = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  bw_check_ok(bw_solid_precrack(many, from, to, NULL));
  bw_check_ok(bw_solid_precrack(one, from, to, NULL));
  pd_set(many, NULL, blow);
  const double dt = 0.5 * bw_solid_dt_max(one);
  ck_assert_int_ge(adaptive_steps(many, 40, dt), 1);
  const size_t numbers = bw_solid_levels_numbers(many);
  double *state = NULL;
  bw_check_ok(BW_ALLOCATE(&state, numbers));
  bw_solid_get_levels(many, state);
  bw_check_ok(bw_solid_set_levels(one, state));
  ck_assert_int_eq(bw_solid_total(many), bw_solid_total(one));
  pd_restart_from(many, one);
  ck_assert_int_eq(ledger_of(many).bonds, ledger_of(one).bonds);
  ck_assert_double_eq(ledger_of(many).regrid, ledger_of(one).regrid);
  /* All of it anew: levels change after the restart, too. */
  const bw_pd_box box = {1, {4, 1, 0}, {6, 3, 1}};
  bw_check_ok(bw_solid_regrid(many, 1, &box));
  bw_check_ok(bw_solid_regrid(one, 1, &box));
  adaptive_steps(many, 60, dt);
  adaptive_steps(one, 60, dt);
  ck_assert_int_gt(ledger_of(many).broken, 5);
  ck_assert_int_eq(ledger_of(many).broken, ledger_of(one).broken);
  pd_check_same(many, one, bw_solid_get_position, 0);
  pd_check_same(many, one, bw_solid_get_velocity, 0);
  state[5] = 99;
  ck_assert_int_eq(bw_solid_set_levels(one, state), BW_EINPUT);
  bw_release(&state);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

/* Whoever asks for coarse cells everywhere gets them, but around what has broken. */
START_TEST(broken_bonds_are_never_lost)
{
  pd_body body = pd_box(15, 14, 1);
  bw_solid_config c = breaking(0);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(bw_solid_precrack(pd, (double[]){5, -1, 0}, (double[]){5, 2, 0}, NULL));
  pd_set(pd, NULL, blow);
  adaptive_steps(pd, 120, 0.5 * bw_solid_dt_max(pd));
  const bw_solid_ledger before = ledger_of(pd);
  const int64_t total = bw_solid_total(pd);
  ck_assert_int_gt(before.broken, 10);
  for (int turn = 0; turn < 3; turn++) {
    const bw_pd_box box = {1, {4, 1, 0}, {6, 3, 1}};
    bw_check_ok(bw_solid_regrid(pd, turn == 1, &box));
    ck_assert_int_eq(ledger_of(pd).broken, before.broken);
    ck_assert_double_eq(ledger_of(pd).fracture, before.fracture);
  }
  ck_assert_int_lt(bw_solid_total(pd), total);
  ck_assert_int_gt(bw_solid_total(pd), body.n);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Nobody looks, or a trigger comes too late: the run ends before anything can go wrong. */
START_TEST(overdue_looks_and_thin_buffers_are_told)
{
  pd_body body = pd_box(15, 14, 1);
  bw_solid_config c = breaking(0);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_status st = BW_OK;
  for (int q = 0; q < 500 && st == BW_OK; q++)
    st = bw_solid_step(pd, 0.5 * bw_solid_dt_max(pd));
  ck_assert_int_eq(st, BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "bw_solid_adapt"));
  bw_solid_destroy(&pd);
  /* Damage tells of a crack when it is there. */
  c.finer.refine.trigger = BW_PD_LEVELS_DAMAGE;
  pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, blow);
  st = BW_OK;
  for (int q = 0; q < 500 && st == BW_OK; q++) {
    bool changed = false;
    st = bw_solid_adapt(pd, &changed);
    BW_THEN(st, bw_solid_step(pd, 0.5 * bw_solid_dt_max(pd)));
  }
  ck_assert_int_eq(st, BW_EDIVERGED);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "buffer"));
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

START_TEST(what_changing_levels_do_not_go_with_is_refused)
{
  const bw_solid_config good = breaking(0);
  bw_solid_config c = good;
  c.finer.refine.level = 99;
  levels_refused(&c, "refine.level = 99");
  c = good, c.finer.refine.at = 1.5;
  levels_refused(&c, "refine.at = 1.5");
  c = good, c.finer.refine.coarsen_at = 0.7;
  levels_refused(&c, "coarsen_at = 0.7");
  c = good, c.finer.refine.buffer = 1;
  levels_refused(&c, "buffer = 1");
  c = good, c.contact = true;
  levels_refused(&c, "contact");
  c = good, c.ds = NAN;
  levels_refused(&c, "ds");
  c = good, c.choice.law = BW_SOLID_ORDINARY, c.surface_correction = BW_PD_SURFACE_VOLUME;
  levels_refused(&c, "law = ordinary");
  /* A solid of one level has none that change. */
  pd_body body = pd_box(6, 5, 1);
  c = good, c.finer.refine.level = 0;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const bw_pd_box box = {1, {0, 0, 0}, {1, 1, 1}};
  ck_assert_int_eq(bw_solid_regrid(pd, 1, &box), BW_EINPUT);
  ck_assert_uint_eq(bw_solid_levels_numbers(pd), 0);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Looks come in time for a step that is longer than all before it. */
START_TEST(steps_may_grow)
{
  bw_solid_config c = changing(BW_PD_PLANE_STRESS, 1);
  c.finer.refine.buffer = 2;
  pd_body body = pd_box(9, 8, 1);
  for (int small = 1; small < 30; small++) {
    bw_solid *pd = pd_make(bw_check_world(), &c, &body);
    const double longest = bw_solid_dt_max(pd);
    for (int q = 0; q <= small; q++) {
      bool changed = false;
      bw_check_ok(bw_solid_adapt(pd, &changed));
      bw_check_ok(bw_solid_step(pd, (q < small ? 0.1 : 0.95) * longest));
    }
    bw_solid_destroy(&pd);
  }
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(momentum_and_book_are_kept),
                                      BW_TEST(all_of_a_body_is_refined),
                                      BW_TEST(same_levels_motion_and_bonds_on_any_number_of_ranks),
                                      BW_TEST(what_only_moves_is_not_refined_by_energy),
                                      BW_TEST(restart_across_a_change),
                                      BW_TEST(broken_bonds_are_never_lost),
                                      BW_TEST(overdue_looks_and_thin_buffers_are_told),
                                      BW_TEST(what_changing_levels_do_not_go_with_is_refused),
                                      BW_TEST(steps_may_grow)};
BW_CHECK_MAIN("solid.regrid", tests)
