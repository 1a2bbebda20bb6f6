/* A law of two passes that remembers: its second pass reads what the first has found at neighbours,
 * also those of other ranks; what it remembers goes through a checkpoint.
 * BUILD modules=solid_tools,checkpoint
 * TEST  ranks=1,2,3 */
#include "bw_checkpoint.h"
#include "law_test.h"
#include "mean_law.h"

#include <unistd.h>

/* theta^2 stays below a thousandth or so: a particle loses a tenth of K, less than where the force
 * falls while it is stretched (a third). */
static const mean_state ELASTIC = {.c = 2, .K = 5}, REMEMBERS = {.c = 2, .K = 5, .g = 300};

static bw_solid_config with(const mean_state *options)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.law = &mean_law;
  c.law_options = options;
  return c;
}

static void shake(const double X0[3], double v[3])
{
  v[0] = 0.06 * sin(2 * X0[0] + X0[1]);
  v[1] = 0.04 * cos(3 * X0[1]) + 0.02 * X0[0];
  v[2] = 0.04 * sin(X0[2] * X0[0]);
}

static double whole(bw_solid *pd)
{
  return pd_energy(pd) + ledger_of(pd).plastic;
}

START_TEST(force_is_the_derivative_of_energy)
{
  const bw_solid_config c = with(&ELASTIC);
  check_force(&c);
}
END_TEST

START_TEST(rest_by_relaxation_and_by_the_linear_solve)
{
  const bw_solid_config c = with(&ELASTIC);
  check_rest(&c);
}
END_TEST

static double departure(double fraction, double *plastic)
{
  const bw_solid_config c = with(&REMEMBERS);
  pd_body body = pd_box(9, 6, 5);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, shake);
  const double dt = fraction * bw_solid_dt_max(pd), start = whole(pd);
  double worst = 0;
  for (int q = 0; q < (int)(3 / dt); q++) {
    pd_steps(pd, 1, dt);
    worst = fmax(worst, fabs(whole(pd) / start - 1));
  }
  *plastic = ledger_of(pd).plastic / start;
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  return worst;
}

START_TEST(the_book_closes_with_what_particles_dissipate)
{
  double plastic;
  const double coarse = departure(0.1, &plastic), fine = departure(0.05, &plastic);
  ck_assert_double_gt(coarse / fine, 3); /* second order, but for the kink where theta turns */
  ck_assert_double_lt(fine, 0.1 * plastic);
}
END_TEST

/* Steps on one rank and on all; a checkpoint of all ranks is gone on with by each rank alone. */
START_TEST(neighbours_on_other_ranks_and_a_checkpoint)
{
  const bw_solid_config c = with(&REMEMBERS);
  const char *path = "law_fields.h5";
  bw_comm *self = pd_alone();
  bw_checkpoint *ck = NULL;
  pd_body body = pd_box(9, 6, 5);
  bw_solid *all = pd_make(bw_check_world(), &c, &body), *one = pd_make(self, &c, &body);
  bw_solid *next = pd_make(bw_check_world(), &c, &body), *alone = pd_make(self, &c, &body);
  const size_t n = bw_solid_count(all), total = (size_t)body.n, width = bw_solid_restart_row(all);
  const double dt = 0.4 * bw_solid_dt_max(all);
  double *rows = NULL, *read = NULL, sums[BW_SOLID_RESTART_SUMS];
  ck_assert_uint_eq(width, 13 + 1);
  pd_set(all, NULL, shake);
  pd_set(one, NULL, shake);
  pd_steps(all, 50, dt);
  pd_steps(one, 50, dt);
  pd_check_same(all, one, bw_solid_get_position, ROUND_OFF);
  pd_restart_from(all, next);
  /* Written by all, read by each. */
  bw_check_ok(BW_ALLOCATE(&rows, width * n));
  bw_check_ok(BW_ALLOCATE(&read, width * total));
  bw_solid_get_restart(all, rows, sums);
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_checkpoint_put_table(ck, "rows", (int64_t)total, n, bw_solid_id(all), (int)width,
                                      BW_CK_DOUBLE, rows));
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_check_ok(bw_checkpoint_open(self, path, &ck));
  bw_check_ok(bw_checkpoint_get_table(ck, "rows", (int64_t)total, total, bw_solid_id(alone),
                                      (int)width, BW_CK_DOUBLE, read));
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_check_ok(bw_solid_set_restart(alone, read, sums));
  bw_check_near(ledger_of(alone).plastic, ledger_of(all).plastic, ROUND_OFF);
  ck_assert_double_gt(ledger_of(all).plastic, 0);
  pd_steps(all, 50, dt);
  pd_steps(one, 50, dt);
  pd_steps(next, 50, dt);
  pd_steps(alone, 50, dt);
  pd_check_same(all, one, bw_solid_get_position, ROUND_OFF);
  pd_check_same(all, next, bw_solid_get_position, 0);
  pd_check_same(all, next, bw_solid_get_velocity, 0);
  pd_check_same(all, alone, bw_solid_get_position, ROUND_OFF);
  bw_check_near(ledger_of(all).plastic, ledger_of(one).plastic, ROUND_OFF);
  bw_comm_barrier(bw_check_world()); /* all have read it */
  if (bw_comm_rank(bw_check_world()) == 0) unlink(path);
  bw_release(&rows);
  bw_release(&read);
  bw_solid *made[] = {all, one, next, alone};
  for (int q = 0; q < 4; q++)
    bw_solid_destroy(&made[q]);
  pd_body_release(&body);
  bw_comm_destroy(&self);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(force_is_the_derivative_of_energy),
                                      BW_TEST(the_book_closes_with_what_particles_dissipate),
                                      BW_TEST(neighbours_on_other_ranks_and_a_checkpoint),
                                      BW_TEST(rest_by_relaxation_and_by_the_linear_solve)};
BW_CHECK_MAIN("law_fields", tests)
