/* Water that hits an elastic block: what one loses the other gets, on any number of ranks, and
 * after a restart; bad input.
 * BUILD modules=shape,solid,checkpoint
 * TEST ranks=1,2,3 */
#include "bw_ulph_body.h"
#include "splash.h"

/* Momentum of the fluid changes by what the block, the cure of the tension and the shifting give;
 * the block has received all of the first but what is on its way; its book has the same work. */
static void check_exchange(int d, int fine, int steps)
{
  splash p = splash_make(bw_check_world(), d, fine);
  bw_solid_ledger s;
  const bw_ulph_ledger first = bw_ulph_account(p.fluid);
  splash_advance(&p, steps);
  const bw_ulph_ledger f = bw_ulph_account(p.fluid);
  const bw_coupler_particles_report r = bw_coupler_particles_measure(p.coupler);
  bw_check_ok(bw_solid_account(p.solid, &s));
  const double all = fabs(first.momentum[0]);
  /* The block has been hit. */
  ck_assert_double_gt(r.impulse[0], 0.01 * all);
  ck_assert_double_gt(r.wetted, 0.5 * (d == 2 ? SOLID : SOLID * SOLID));
  for (int k = 0; k < 3; k++) {
    const double own = f.push[2][k] + f.push[3][k] + f.push[4][k];
    bw_check_near(f.momentum[k] - first.momentum[k], own, 1e-12 * all);
    bw_check_near(f.push[4][k], -r.impulse[k] - r.pending[k], 1e-12 * all);
    bw_check_near(s.momentum[k], r.impulse[k], 1e5 * BW_REAL_EPSILON * all);
  }
  bw_check_near(r.given + r.late, r.received, 1e-12 * first.kinetic);
  /* The load comes a step late; that is small. */
  ck_assert_double_gt(r.given, 0.001 * first.kinetic);
  ck_assert_double_lt(fabs(r.late), 0.2 * r.given);
  ck_assert_double_lt(fabs(f.gap), 1e-3 * first.kinetic);
  splash_free(&p);
}

START_TEST(what_the_fluid_loses_the_block_gets)
{
  check_exchange(2, 1, 200);
  check_exchange(2, 2, 60);
  check_exchange(3, 1, 40);
}
END_TEST

/* The solid's own book counts a force with the mean velocities of its kicks, the coupler's with the
 * displacement: they agree to second order in the solid's step. */
static double books_differ(double safety)
{
  splash p = splash_make_safe(bw_check_world(), 2, 1, safety);
  bw_solid_ledger s;
  splash_advance(&p, 60);
  const bw_coupler_particles_report r = bw_coupler_particles_measure(p.coupler);
  bw_check_ok(bw_solid_account(p.solid, &s));
  splash_free(&p);
  return fabs(s.external / r.received - 1);
}

START_TEST(the_solid_has_the_same_work_in_its_book)
{
  const double coarse = books_differ(0.8), fine = books_differ(0.1);
  ck_assert_double_lt(coarse, 0.1);
  /* At least six times as many steps, as their number is whole: 36 times less at second order, six
   * times at first. */
  ck_assert_double_lt(fine, coarse / 16);
}
END_TEST

/* Rows of the fluid by their numbers, places of the block, all on every rank. */
static double *all_rows(const splash *p, const bw_comm *comm, size_t *n)
{
  const size_t fluid = (size_t)bw_ulph_total(p->fluid), solid = (size_t)bw_solid_total(p->solid);
  const size_t own = bw_ulph_count(p->fluid), mine = bw_solid_count(p->solid);
  double *rows = NULL, *x = NULL, *X = NULL;
  int64_t *id = NULL;
  *n = 3 * (fluid + solid);
  bw_check_ok(BW_ALLOCATE(&rows, *n));
  bw_check_ok(BW_ALLOCATE(&x, 3 * own));
  bw_check_ok(BW_ALLOCATE(&X, 3 * mine));
  bw_check_ok(BW_ALLOCATE(&id, own));
  bw_ulph_ids(p->fluid, id);
  bw_ulph_read(p->fluid, BW_ULPH_POSITION, x);
  bw_solid_get_position(p->solid, X);
  for (size_t i = 0; i < own; i++)
    memcpy(rows + 3 * id[i], x + 3 * i, 3 * sizeof *rows);
  for (size_t i = 0; i < mine; i++)
    memcpy(rows + 3 * (fluid + (size_t)bw_solid_id(p->solid)[i]), X + 3 * i, 3 * sizeof *rows);
  bw_comm_sum(comm, *n, rows);
  bw_release(&x);
  bw_release(&X);
  bw_release(&id);
  return rows;
}

static void check_same(const splash *a, const bw_comm *comm_a, const splash *b,
                       const bw_comm *comm_b, double tolerance)
{
  size_t n, m;
  double *x = all_rows(a, comm_a, &n), *y = all_rows(b, comm_b, &m);
  ck_assert_uint_eq(n, m);
  for (size_t q = 0; q < n; q++)
    if (fabs(x[q] - y[q]) > tolerance) ck_abort_msg("number %zu: %.17g, %.17g", q, x[q], y[q]);
  bw_release(&x);
  bw_release(&y);
}

START_TEST(ranks_agree)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  splash one = splash_make(self, 2, 1), all = splash_make(bw_check_world(), 2, 1);
  splash_advance(&one, 150);
  splash_advance(&all, 150);
  /* The solid's sums are in another order on other ranks: round-off, which chaos has not raised. */
  check_same(&one, self, &all, bw_check_world(), 1e5 * BW_REAL_EPSILON);
  splash_free(&one);
  splash_free(&all);
  bw_comm_destroy(&self);
}
END_TEST

START_TEST(a_restart_goes_on_to_the_last_bit)
{
  const bw_comm *comm = bw_check_world();
  char path[64];
  bw_checkpoint *ck = NULL;
  snprintf(path, sizeof path, "coupler_particles_%d.h5", bw_comm_size(comm));
  splash whole = splash_make(comm, 2, 1), part = splash_make(comm, 2, 1);
  splash rest = splash_make(comm, 2, 1), other = splash_make(comm, 2, 2);
  splash_advance(&whole, 150);
  splash_advance(&part, 73);
  bw_check_ok(bw_checkpoint_create(comm, path, &ck));
  bw_check_ok(bw_coupler_particles_save(part.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_check_ok(bw_checkpoint_open(comm, path, &ck));
  bw_check_ok(bw_coupler_particles_restore(rest.coupler, ck));
  /* Of another solid it is refused. */
  bw_check_status(bw_coupler_particles_restore(other.coupler, ck), BW_EINPUT);
  bw_check_ok(bw_checkpoint_close(&ck));
  splash_advance(&rest, 150 - 73);
  check_same(&whole, comm, &rest, comm, 0);
  const bw_coupler_particles_report a = bw_coupler_particles_measure(whole.coupler);
  const bw_coupler_particles_report b = bw_coupler_particles_measure(rest.coupler);
  bw_check_near(a.received, b.received, 1e-13 * fabs(a.received));
  bw_check_near(a.given, b.given, 1e-13 * fabs(a.given));
  const double all = hypot(hypot(a.impulse[0], a.impulse[1]), a.impulse[2]);
  for (int k = 0; k < 3; k++)
    bw_check_near(b.impulse[k], a.impulse[k], 1e-13 * all);
  splash_free(&whole);
  splash_free(&part);
  splash_free(&rest);
  splash_free(&other);
  bw_comm_barrier(comm);
  if (bw_comm_rank(comm) == 0) remove(path);
}
END_TEST

/* Pressure on a block that is held: the force on it is the pressure times its face. */
static void uniform(const double x[3], void *context, double v[3], double *p)
{
  (void)x, (void)context;
  v[0] = v[1] = v[2] = 0, *p = 0.5;
}

START_TEST(a_pressure_pushes_as_much_as_it_should)
{
  splash p = splash_make(bw_check_world(), 2, 1);
  const size_t n = bw_solid_count(p.solid);
  double *F = NULL, sum[3] = {0};
  bw_check_ok(BW_ALLOCATE(&F, 3 * n));
  bw_coupler_particles_hold(p.coupler, true);
  bw_check_ok(bw_ulph_start(p.fluid, uniform, NULL));
  bw_check_ok(bw_coupler_particles_step(p.coupler, 1e-9));
  bw_coupler_particles_load(p.coupler, F);
  for (size_t i = 0; i < 3 * n; i++)
    sum[i % 3] += F[i];
  bw_comm_sum(bw_check_world(), 3, sum);
  /* SOLID rows; where the block ends, the free surface begins, and half a spacing or so of it has
   * the pressure 0. */
  bw_check_near(sum[0], 0.5 * SOLID, 0.5);
  bw_check_near(sum[1], 0, 1e-3 * sum[0]);
  bw_release(&F);
  splash_free(&p);
}
END_TEST

START_TEST(what_cannot_be_is_refused)
{
  splash p = splash_make(bw_check_world(), 2, 1);
  const double V = 1, x[3] = {5.5, 5.5, 0}, off[3] = {20.5, 5.5, 0};
  bw_ulph_config c = bw_ulph_config_default();
  bw_coupler_particles_config q = bw_coupler_particles_config_default();
  bw_coupler_particles *none = NULL;
  bw_ulph *u = NULL;
  c.dimensions = 2, c.dx = 1, c.rho0 = 1, c.speed = 1;
  const double place[3] = {5.2, 5.5, 0};
  const size_t n = bw_comm_rank(bw_check_world()) == 0 ? 1 : 0;
  bw_check_ok(bw_ulph_create(bw_check_world(), &c, n, place, 0, NULL, &u));
  bw_check_status(bw_ulph_add_body(u, 1, &V, off, 0.7, false, 0, NULL), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "finer by a whole number"));
  bw_check_status(bw_ulph_add_body(u, 1, &V, off, 2, false, 0, NULL), BW_EINPUT);
  bw_check_status(bw_ulph_add_body(u, 1, &V, x, 1, false, 0, NULL), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "inside the solid"));
  /* A second solid, other dimensions, values out of range. */
  bw_check_status(bw_coupler_particles_create(&q, &c, p.fluid, p.solid, 0, NULL, &none), BW_EINPUT);
  static const struct {
    double safety, mass, share;
    const char *word;
  } wrong[] = {{2, 1, 0.9, "solid_safety is 2"},     {0, 1, 0.9, "solid_safety is 0"},
               {0.8, -1, 0.9, "virtual_mass is -1"}, {0.8, 11, 0.9, "virtual_mass is 11"},
               {0.8, 1, 0, "step_share is 0"},       {0.8, 1, 1.5, "step_share is 1.5"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    q.solid_safety = wrong[k].safety, q.virtual_mass = wrong[k].mass;
    q.step_share = wrong[k].share;
    bw_check_status(bw_coupler_particles_create(&q, &c, u, p.solid, 0, NULL, &none), BW_EINPUT);
    ck_assert_ptr_nonnull(strstr(bw_last_message(), wrong[k].word));
  }
  q = bw_coupler_particles_config_default(), c.dimensions = 3;
  bw_check_status(bw_coupler_particles_create(&q, &c, u, p.solid, 0, NULL, &none), BW_EINPUT);
  ck_assert_ptr_null(none);
  bw_ulph_destroy(&u);
  splash_free(&p);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(what_the_fluid_loses_the_block_gets),
                                      BW_TEST(the_solid_has_the_same_work_in_its_book),
                                      BW_TEST(ranks_agree),
                                      BW_TEST(a_restart_goes_on_to_the_last_bit),
                                      BW_TEST(a_pressure_pushes_as_much_as_it_should),
                                      BW_TEST(what_cannot_be_is_refused)};
BW_CHECK_MAIN("coupler_particles", tests)
